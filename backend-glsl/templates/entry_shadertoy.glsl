$# The Image tab of shadertoy.com: a drag turns the camera about the first view's target, from the first view
$# each time. iMouse: where the pointer is or was, and with a sign where the button went down.

void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    fathom_resolution = iResolution.xy;
$include first_view
    if (iMouse.x > 0.0) {
    vec2 turn = (iMouse.xy - abs(iMouse.zw)) / iResolution.xy * vec2(6.2831853, 3.0);
    float around = $AROUND - turn.x;
    float above = clamp($ABOVE - turn.y, -1.57, 1.57);
    vec3 back = vec3(cos(above) * sin(around), sin(above), cos(above) * cos(around));
$include turned_view
    }
    fragColor = fathom_picture(vec2(fragCoord.x, iResolution.y - fragCoord.y));
}
