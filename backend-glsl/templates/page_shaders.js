"use strict";
// The page's own shaders. A tile's pixels have an alpha of 2 where a ray goes on (entry_page.glsl); the
// picture's have 0 where nothing is drawn yet.
const head = "#version 300 es\nprecision highp float;\nprecision highp int;\nprecision highp sampler2D;\n";
const shaders = {
  corner: "#version 300 es\nvoid main() { gl_Position = vec4(vec2(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1), 0.0, 1.0); }",
  left: head + `uniform sampler2D tile;
out vec4 color;
void main() {
  if (texelFetch(tile, ivec2(gl_FragCoord.xy), 0).a < 1.5) discard;
  color = vec4(1.0);
}`,
  mean: head + `uniform sampler2D tile, picture;
uniform vec2 corner;
uniform float share;
out vec4 color;
void main() {
  vec3 now = texelFetch(tile, ivec2(gl_FragCoord.xy), 0).rgb;
  vec3 before = texelFetch(picture, ivec2(gl_FragCoord.xy + corner), 0).rgb;
  color = vec4(before + (now - before) * share, 1.0);
}`,
  show: head + `uniform sampler2D picture, coarse;
uniform vec2 size, rough; // of the canvas, and of what is drawn of the coarse picture
out vec4 color;
vec3 at(ivec2 place) { return texelFetch(coarse, clamp(place, ivec2(0), ivec2(rough) - 1), 0).rgb; }
void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 fine = texelFetch(picture, pixel, 0);
  vec3 c = fine.rgb;
  if (fine.a < 0.5) {
    vec2 place = gl_FragCoord.xy * rough / size - 0.5;
    ivec2 low = ivec2(floor(place));
    vec2 t = fract(place);
    c = mix(mix(at(low), at(low + ivec2(1, 0)), t.x), mix(at(low + ivec2(0, 1)), at(low + 1), t.x), t.y);
  }
  c = clamp(c, 0.0, 1.0);
  ivec2 cell = ivec2(pixel.x, int(size.y) - 1 - pixel.y);
  int order = 0;
  for (int bit = 0; bit < 3; ++bit) order = order * 4 + (((cell.x ^ cell.y) >> bit & 1) * 2 + (cell.y >> bit & 1));
  float dither = (0.02 + 0.96 / 63.0 * float(order) - 0.5) / 255.0;
  color = vec4(mix(1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, 12.92 * c, lessThanEqual(c, vec3(0.0031308))) + dither, 1.0);
}`
};
