#define REACH 1.5

float map(vec3 p) {
    float d = box(p, vec3(0.6, 0.4, 0.5));
    d = smooth_min(d, length(p - vec3(0.7, 0.4, 0.1)) - 0.5, 0.3);
    return smooth_min(d, cylinder(p + vec3(0.3, 0.0, 0.0), 0.25, 1.1), 0.3);
}
