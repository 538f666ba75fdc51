#define LIPSCHITZ_DIVIDED
const vec3 LO = vec3(-0.7085, -1.0014, -0.7085), HI = -LO;

float box(vec3 p, vec3 b) {
    vec3 q = abs(p) - b;
    return length(max(q, 0.0)) + min(max(q.x, max(q.y, q.z)), 0.0);
}

// Turned by 3 radians a unit; half the distance is a safe step, and outside of its box the box.
float map(vec3 p) {
    float c = cos(3.0 * p.y), s = sin(3.0 * p.y);
    vec3 q = vec3(c * p.x - s * p.z, p.y, s * p.x + c * p.z);
    return max(0.5 * box(q, vec3(0.5, 1.0, 0.5)), box(p, vec3(0.70711, 1.0, 0.70711)));
}
