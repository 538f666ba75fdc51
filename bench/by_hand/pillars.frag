#define REACH 8.8
// One pillar in its cell; head and foot are one box, mirrored.
float map(vec3 p) {
    vec2 cell = clamp(round(p.xz / 1.6), vec2(-4.0, -2.0), vec2(4.0, 2.0));
    vec3 q = vec3(p.x - 1.6 * cell.x, abs(p.y), p.z - 1.6 * cell.y);
    float d = cylinder(q, 0.22, 1.2);
    d = min(d, box(q - vec3(0.0, 1.2, 0.0), vec3(0.35, 0.075, 0.35)));
    return min(d, box(p + vec3(0.0, 1.4, 0.0), vec3(7.5, 0.1, 4.3)));
}
