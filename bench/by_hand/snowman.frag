#define REACH 2.1
#define COLORED

float capsule(vec3 p, vec3 a, vec3 b, float r) {
    vec3 q = p - a, way = b - a;
    return length(q - clamp(dot(q, way) / dot(way, way), 0.0, 1.0) * way) - r;
}

float snow(vec3 p) {
    float d = smooth_min(length(p) - 0.6, length(p - vec3(0.0, 0.8, 0.0)) - 0.43, 0.08);
    return smooth_min(d, length(p - vec3(0.0, 1.38, 0.0)) - 0.3, 0.08);
}

float coal(vec3 p) {
    float d = length(p - vec3(0.0, 1.0, 0.42)) - 0.05;
    d = min(d, length(p - vec3(0.0, 0.8, 0.46)) - 0.05);
    d = min(d, length(p - vec3(0.0, 0.6, 0.5)) - 0.05);
    d = min(d, length(vec3(abs(p.x), p.yz) - vec3(0.1, 1.46, 0.27)) - 0.04);
    d = min(d, cylinder(p - vec3(0.0, 1.63, 0.0), 0.3, 0.02));
    return min(d, cylinder(p - vec3(0.0, 1.8, 0.0), 0.2, 0.175));
}

float arms(vec3 p) { return capsule(vec3(abs(p.x), p.yz), vec3(0.3, 0.9, 0.0), vec3(0.9, 1.3, 0.1), 0.04); }

float nose(vec3 p) {
    vec3 q = p - vec3(0.0, 1.38, 0.42);
    return capped_cone(vec3(q.x, q.z, -q.y), 0.06, 0.01, 0.15);
}

float map(vec3 p) { return min(min(snow(p), coal(p)), min(arms(p), nose(p))); }

vec3 albedo(vec3 p) {
    float a = snow(p), b = coal(p), c = arms(p), d = nose(p), least = min(min(a, b), min(c, d));
    if (a == least) return vec3(0.9, 0.92, 1.0);
    if (b == least) return vec3(0.014);
    return c == least ? vec3(0.14, 0.06, 0.02) : vec3(1.0, 0.19, 0.01);
}
