$# What shadertoy.com puts around the text of the Image tab, for the check.
#version 300 es
precision highp float;
precision highp int;
uniform vec3 iResolution;
uniform float iTime;
uniform vec4 iMouse;
uniform int iFrame;
$TEXT
$if PICTURE

out vec4 fathom_color;
void main() {
    mainImage(fathom_color, gl_FragCoord.xy);
}
$end
