#define REACH 1.5

float box(vec3 p, vec3 b) {
    vec3 q = abs(p) - b;
    return length(max(q, 0.0)) + min(max(q.x, max(q.y, q.z)), 0.0);
}

float smooth_min(float a, float b, float k) {
    float h = max(k - abs(a - b), 0.0);
    return min(a, b) - h * h * 0.25 / k;
}

float map(vec3 p) {
    float d = box(p, vec3(0.6, 0.4, 0.5));
    d = smooth_min(d, length(p - vec3(0.7, 0.4, 0.1)) - 0.5, 0.3);
    vec2 side = vec2(length(p.xz - vec2(-0.3, 0.0)) - 0.25, abs(p.y) - 1.1);
    return smooth_min(d, length(max(side, 0.0)) + min(max(side.x, side.y), 0.0), 0.3);
}
