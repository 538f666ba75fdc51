#define REACH 1.75
// Four levels of holes, cut out of a cube.
float map(vec3 p) {
    vec3 q = abs(p) - 1.0;
    float d = max(q.x, max(q.y, q.z)), s = 1.0;
    for (int i = 0; i < 4; ++i) {
        vec3 r = abs(1.0 - 3.0 * abs(mod(p * s, 2.0) - 1.0));
        s *= 3.0;
        d = max(d, (min(max(r.x, r.y), min(max(r.y, r.z), max(r.z, r.x))) - 1.0) / s);
    }
    return d;
}
