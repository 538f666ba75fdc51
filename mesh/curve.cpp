#include "mesh/curve.h"

#include <algorithm>
#include <utility>

namespace fathom::mesh {
namespace {

// The bits of a number, two zeros after each.
std::uint64_t spread(std::uint64_t x) {
    x = (x | x << 32) & 0x1f00000000ffff;
    x = (x | x << 16) & 0x1f0000ff0000ff;
    x = (x | x << 8) & 0x100f00f00f00f00f;
    x = (x | x << 4) & 0x10c30c30c30c30c3;
    return (x | x << 2) & 0x1249249249249249;
}

} // namespace

std::vector<std::uint32_t> order_along_curve(const std::vector<std::array<double, 3>> &places) {
    constexpr double steps = 1 << 21; // along each axis
    std::vector<std::uint32_t> numbers;
    if (places.empty()) return numbers;
    std::array<double, 3> lo = places[0], hi = lo;
    for (const auto &p : places)
        for (std::size_t i = 0; i < 3; ++i)
            lo[i] = std::min(lo[i], p[i]), hi[i] = std::max(hi[i], p[i]);
    const double longest = std::max({hi[0] - lo[0], hi[1] - lo[1], hi[2] - lo[2]});
    const double scale = longest > 0 ? (steps - 1) / longest : 0;
    std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
    order.reserve(places.size());
    for (std::uint32_t k = 0; k < places.size(); ++k) {
        std::uint64_t key = 0;
        for (std::size_t i = 0; i < 3; ++i)
            key |= spread(static_cast<std::uint64_t>(scale * (places[k][i] - lo[i]))) << i;
        order.push_back({key, k});
    }
    std::ranges::sort(order);
    numbers.reserve(order.size());
    for (const auto &[key, k] : order) numbers.push_back(k);
    return numbers;
}

} // namespace fathom::mesh
