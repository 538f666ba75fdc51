$# Of a scene that says no background.

vec3 fathom_background(vec3 direction) {
    return $COLOR;
}
