// The hand-fused loops.
#include "bench/by_hand.h"

#include <cmath>

namespace fathom::bench {

Spheres hundred_spheres() {
    Spheres spheres; // a Fibonacci lattice on the sphere
    for (int i = 0; i < 100; ++i) {
        const float z = 1 - (2 * float(i) + 1) / 100, ring = std::sqrt(1 - z * z),
                    turn = 2.39996323f * float(i);
        spheres.x.push_back(ring * std::cos(turn));
        spheres.y.push_back(ring * std::sin(turn));
        spheres.z.push_back(z);
        spheres.r.push_back(0.1f + 0.002f * float(i % 20));
    }
    return spheres;
}

namespace {

constexpr std::size_t block = 64; // points kept in registers while the spheres go by

void fused(const Spheres &s, float k, const float *x, const float *y, const float *z, float *out) {
    float acc[block];
    for (std::size_t i = 0; i < block; ++i) acc[i] = 1e9f;
    const float quarter = 1 / (4 * k);
    for (std::size_t b = 0; b < s.x.size(); ++b) {
        const float cx = s.x[b], cy = s.y[b], cz = s.z[b], r = s.r[b];
        for (std::size_t i = 0; i < block; ++i) {
            const float dx = x[i] - cx, dy = y[i] - cy, dz = z[i] - cz;
            const float d = std::sqrt(dx * dx + dy * dy + dz * dz) - r, a = acc[i];
            const float gap = std::fabs(a - d), over = k - gap, h = over > 0 ? over : 0;
            acc[i] = (a < d ? a : d) - h * h * quarter;
        }
    }
    for (std::size_t i = 0; i < block; ++i) out[i] = acc[i];
}

} // namespace

void smooth_spheres_by_hand(const Spheres &s, float k, const float *x, const float *y,
                            const float *z, float *out, std::size_t n) {
    for (std::size_t i = 0; i + block <= n; i += block) fused(s, k, x + i, y + i, z + i, out + i);
}

} // namespace fathom::bench
