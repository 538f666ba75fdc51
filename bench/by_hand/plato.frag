#define REACH 3.7

const float golden = 1.618034;

// The greatest of the distances from planes along the normals and their mirrors.
float cube(vec3 p) { return max(p.x, max(p.y, p.z)); }
float octahedron(vec3 p) { return (p.x + p.y + p.z) * 0.57735027; }
float dodecahedron(vec3 p) {
    const vec2 n = vec2(1.0, golden) / sqrt(1.0 + golden * golden);
    return max(dot(p.yz, n), max(dot(p.zx, n), dot(p.xy, n)));
}
float icosahedron(vec3 p) {
    const vec2 n = vec2(golden, 1.0 / golden) * 0.57735027;
    return max(octahedron(p), max(dot(p.yz, n), max(dot(p.zx, n), dot(p.xy, n))));
}

float map(vec3 p) {
    vec3 q = p + vec3(2.6, 0.0, 0.0);
    float d = max(max(-q.x - q.y - q.z, -q.x + q.y + q.z), max(q.x - q.y + q.z, q.x + q.y - q.z)) * 0.57735027 - 0.3;
    d = min(d, cube(abs(p + vec3(1.2, 0.0, 0.0))) - 0.5);
    d = min(d, octahedron(abs(p - vec3(0.1, 0.0, 0.0))) - 0.45);
    d = min(d, dodecahedron(abs(p - vec3(1.4, 0.0, 0.0))) - 0.6);
    return min(d, icosahedron(abs(p - vec3(2.8, 0.0, 0.0))) - 0.6);
}
