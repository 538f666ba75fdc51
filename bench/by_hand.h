// What an expert would write for one scene each, as the measure of the interpreter: one fused loop,
// vectorised.
#pragma once

#include <cstddef>
#include <vector>

namespace fathom::bench {

struct Spheres {
    std::vector<float> x, y, z, r;
};
Spheres hundred_spheres(); // about a shell of radius 1

void smooth_spheres_by_hand(const Spheres &spheres, float k, const float *x, const float *y,
                            const float *z, float *out, std::size_t n);

} // namespace fathom::bench
