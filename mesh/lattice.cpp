#include "mesh/lattice.h"

#include <algorithm>
#include <cmath>

namespace fathom::mesh {

std::optional<Lattice> make_lattice(const ir::Box &box, double side, int extra, int deeper) {
    constexpr double fewest = 32, enough = 128; // ulps in half a cell of the finest level
    double longest = 0, largest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        longest = std::max(longest, box.hi[i] - box.lo[i]);
        largest = std::max({largest, std::fabs(box.lo[i]), std::fabs(box.hi[i])});
    }
    const double count = std::ceil(longest / side) + 4;
    if (!(side > 0) || !(count <= std::ldexp(1.0, max_level))) return std::nullopt;
    Lattice lattice;
    lattice.level = static_cast<int>(std::ceil(std::log2(count)));
    // All that matters is below 2^24 ulps.
    lattice.ulp = std::ldexp(1.0, std::ilogb(1.01 * (largest + 4 * side)) - 23);
    for (int below = extra + deeper; below >= 0; --below) {
        const double halves = std::floor(std::ldexp(side, -below - 1) / lattice.ulp);
        if (halves < (below > extra ? enough : fewest)) continue;
        const double odd = std::fmod(halves, 2) == 1 ? halves : halves - 1;
        lattice.unit = odd * lattice.ulp;
        lattice.depth = lattice.level + below;
        for (std::size_t i = 0; i < 3; ++i) {
            // The box lies in the middle.
            const double middle = 0.5 * (box.lo[i] + box.hi[i]) / (2 * lattice.unit);
            lattice.first[i] =
                static_cast<std::int32_t>(std::floor(middle - std::ldexp(0.5, lattice.depth)));
        }
        return lattice;
    }
    return std::nullopt;
}

} // namespace fathom::mesh
