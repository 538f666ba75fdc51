// What several of the fields are made of.

float box(vec3 p, vec3 b) {
    vec3 q = abs(p) - b;
    return length(max(q, 0.0)) + min(max(q.x, max(q.y, q.z)), 0.0);
}

// Along y, h to each side.
float cylinder(vec3 p, float r, float h) {
    vec2 side = vec2(length(p.xz) - r, abs(p.y) - h);
    return length(max(side, 0.0)) + min(max(side.x, side.y), 0.0);
}

// Along y, from radius a at -h to b at h.
float capped_cone(vec3 p, float a, float b, float h) {
    vec2 q = vec2(length(p.xz), p.y), slant = vec2(b - a, 2.0 * h);
    vec2 cap = vec2(q.x - min(q.x, q.y < 0.0 ? a : b), abs(q.y) - h);
    vec2 side = q - vec2(b, h) + slant * clamp(dot(vec2(b, h) - q, slant) / dot(slant, slant), 0.0, 1.0);
    return (side.x < 0.0 && cap.y < 0.0 ? -1.0 : 1.0) * sqrt(min(dot(cap, cap), dot(side, side)));
}

float smooth_min(float a, float b, float k) {
    float h = max(k - abs(a - b), 0.0);
    return min(a, b) - h * h * 0.25 / k;
}
