$# Sampled data, filtered here, because samplers filter with 8 bits.

$helper fathom_image
vec4 fathom_image(sampler2D image, vec2 uv) {
    ivec2 size = textureSize(image, 0);
    vec2 turn = uv - floor(uv);
    vec2 place = vec2(turn.x, 1.0 - turn.y) * vec2(size) - 0.5;
    vec2 t = fract(place);
    ivec2 a = ivec2(floor(place));
    ivec2 b = (a + 1) % size;
    a = (a + size) % size;
    vec4 low = mix(texelFetch(image, a, 0), texelFetch(image, ivec2(b.x, a.y), 0), t.x);
    vec4 high = mix(texelFetch(image, ivec2(a.x, b.y), 0), texelFetch(image, b, 0), t.x);
    return mix(low, high, t.y);
}

$helper fathom_grid
float fathom_grid(sampler3D grid, vec3 p) {
    ivec3 last = textureSize(grid, 0) - 1;
    vec3 place = clamp(p, 0.0, 1.0) * vec3(last);
    ivec3 a = min(ivec3(place), max(last - 1, 0));
    ivec3 b = min(a + 1, last);
    vec3 t = place - vec3(a);
    float x00 = mix(texelFetch(grid, a, 0).x, texelFetch(grid, ivec3(b.x, a.y, a.z), 0).x, t.x);
    float x10 = mix(texelFetch(grid, ivec3(a.x, b.y, a.z), 0).x, texelFetch(grid, ivec3(b.x, b.y, a.z), 0).x, t.x);
    float x01 = mix(texelFetch(grid, ivec3(a.x, a.y, b.z), 0).x, texelFetch(grid, ivec3(b.x, a.y, b.z), 0).x, t.x);
    float x11 = mix(texelFetch(grid, ivec3(a.x, b.y, b.z), 0).x, texelFetch(grid, b, 0).x, t.x);
    return mix(mix(x00, x10, t.y), mix(x01, x11, t.y), t.z);
}
