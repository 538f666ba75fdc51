#define REACH 5.0
#define COLORED

vec3 rod(vec3 p) { return vec3(p.x - 0.65 * clamp(round(p.x / 0.65), -6.0, 6.0), p.yz); }

float bead(vec3 p) { return capped_cone(vec3(p.x, abs(p.y) - 0.08, p.z), 0.3, 0.12, 0.08); }

// Five beads below the beam and one above it; q is the point beside its rod.
float beads(vec3 q) {
    float y = q.y + 0.6;
    float below = bead(vec3(q.x, y - 0.34 * clamp(round(y / 0.34), -2.0, 2.0), q.z));
    return min(below, bead(q - vec3(0.0, 0.9, 0.0)));
}

float rods(vec3 q) { return cylinder(q + vec3(0.0, 0.15, 0.0), 0.04, 1.7); }

float frame(vec3 p) {
    vec3 q = vec3(abs(p.x), abs(p.y + 0.15), p.z);
    float d = box(q - vec3(0.0, 1.75, 0.0), vec3(4.45, 0.1, 0.25));
    d = min(d, box(p - vec3(0.0, 0.45, 0.0), vec3(4.45, 0.06, 0.15)));
    return min(d, box(q - vec3(4.4, 0.0, 0.0), vec3(0.1, 1.85, 0.25)));
}

float map(vec3 p) {
    vec3 q = rod(p);
    return min(min(beads(q), rods(q)), frame(p));
}

vec3 albedo(vec3 p) {
    vec3 q = rod(p);
    float a = beads(q), b = rods(q), c = frame(p), least = min(a, min(b, c));
    if (a == least) return vec3(0.46, 0.13, 0.02);
    return b == least ? vec3(0.69, 0.53, 0.28) : vec3(0.04, 0.02, 0.01);
}
