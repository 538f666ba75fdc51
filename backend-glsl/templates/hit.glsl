$# fathom_hit, where the scene's own function does not bear that name: hits that are MARKED tell
$# their part; a scene may be UNPAINTED.
$if MARKED

int fathom_part;

// A marked hit's paint is code + stride * part; the last code is no paint.
Hit fathom_hit(vec3 p) {
    Hit s = fathom_marked_hit(p);
    fathom_part = s.paint < 0 ? 0 : s.paint / $STRIDE;
    s.paint = s.paint < 0 ? -1 : s.paint - fathom_part * $STRIDE;
    if (s.paint == $STRIDE - 1) s.paint = -1;
    return s;
}
$else
$if PICK

const int fathom_part = 0;
$end
$if UNPAINTED

Hit fathom_hit(vec3 p) {
    return Hit(sdf(p), -1, p, vec4(0.0));
}
$end
$end
