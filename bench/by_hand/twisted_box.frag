#define REACH 1.25
#define STEP 0.5
// Turned by 3 radians a unit.
float map(vec3 p) {
    float c = cos(3.0 * p.y), s = sin(3.0 * p.y);
    vec3 q = vec3(c * p.x - s * p.z, p.y, s * p.x + c * p.z);
    return box(q, vec3(0.5, 1.0, 0.5));
}
