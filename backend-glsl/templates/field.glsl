$# The whole text of a field alone.
$BEGIN

$INPUTS

// The largest slope of a shape's field before it was divided by it; that of sdf is at most 1.
const float sdf_lipschitz = $BOUND;
$FUNCTIONS
$HIT
$SHADING

// What p, on or near a surface with that normal, is made of.
fathom_Material material(vec3 p, vec3 normal) {
    return fathom_material(fathom_hit(p), normal);
}
