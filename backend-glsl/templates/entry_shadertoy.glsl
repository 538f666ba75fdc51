$# The Image tab of shadertoy.com: the mouse turns the camera about the first view's target.

void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    fathom_resolution = iResolution.xy;
$include first_view
    if (iMouse.x > 0.0) {
    vec2 turn = (iMouse.xy / iResolution.xy - 0.5) * vec2(6.2831853, 3.0);
    float around = atan($BACK_X, $BACK_Z) - turn.x;
    float above = clamp(-turn.y, -1.5, 1.5);
    vec3 back = vec3(cos(above) * sin(around), sin(above), cos(above) * cos(around));
$include turned_view
    }
    fragColor = fathom_picture(vec2(fragCoord.x, iResolution.y - fragCoord.y));
}
