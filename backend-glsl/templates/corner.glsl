
$# Drivers write a function out at each of its calls. So the points of a gradient are evaluated in one
$# loop, whose bound the compiler cannot see, and what goes with them in the same.
vec3 fathom_corner(int i) {
    return 0.577350269 * (2.0 * vec3(float(((i + 3) >> 1) & 1), float((i >> 1) & 1), float(i & 1)) - 1.0);
}
$if MANY_SLOPES

// Nothing, then two axes across a ray, to and fro.
vec3 fathom_beside(int i, vec3 direction) {
    vec3 a = normalize(cross(direction, abs(direction.x) < 0.6 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0)));
    return float(i == 0 ? 0 : 2 * (i & 1) - 1) * (i < 3 ? a : cross(direction, a));
}
$end
