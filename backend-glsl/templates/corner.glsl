
$# Drivers write a function out at each of its calls. So the points of a gradient are evaluated in one
$# loop, whose bound the compiler cannot see, and what goes with them in the same.
vec3 fathom_corner(int i) {
    return 0.577350269 * (2.0 * vec3(float(((i + 3) >> 1) & 1), float((i >> 1) & 1), float(i & 1)) - 1.0);
}
