$# The materials: VARYING, the functions of those that vary, and the choice of one by the hit's paint.

struct fathom_Material {
    vec3 diffuse;
    vec3 specular;
    float exponent;
    vec3 emission;
};
$VARYING

fathom_Material fathom_material(Hit s, vec3 normal) {
$if PAINTED
    int paint = s.paint < 0 || s.paint >= $COUNT ? $LAST : s.paint;
$CHOICES
$else
    return fathom_Material(vec3(0.8), vec3(1.0), 32.0, vec3(0.0));
$end
}
