$# The field of a scene without shapes.

float sdf(vec3 p) {
    return 1e9;
}
