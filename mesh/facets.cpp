#include "mesh/facets.h"

#include "mesh/walk.h"

#include <algorithm>
#include <cmath>

namespace fathom::mesh {

Facet facet_of(const Mesh &mesh, const std::array<std::uint32_t, 3> &triangle) {
    Facet facet;
    for (std::size_t k = 0; k < 3; ++k) facet.at[k] = real(mesh.vertices[triangle[k]]);
    facet.normal = unit_of(outer(minus(facet.at[1], facet.at[0]), minus(facet.at[2], facet.at[0])))
                       .value_or(Real3{});
    facet.lo = facet.hi = facet.at[0];
    for (const Real3 &p : facet.at)
        for (std::size_t i = 0; i < 3; ++i) {
            facet.lo[i] = std::min(facet.lo[i], p[i]);
            facet.hi[i] = std::max(facet.hi[i], p[i]);
        }
    return facet;
}

bool may_touch(const Triangle3 &t, const Real3 &middle, const Real3 &half) {
    Triangle3 p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = minus(t[k], middle);
    const auto apart = [&](const Real3 &axis) {
        double lo = unbounded, hi = -unbounded, reach = 0;
        for (const Real3 &at : p) {
            const double s = inner(at, axis);
            lo = std::min(lo, s), hi = std::max(hi, s);
        }
        for (std::size_t i = 0; i < 3; ++i) reach += std::fabs(axis[i]) * half[i];
        const double spare = by_rounding * (std::fabs(lo) + std::fabs(hi) + reach);
        return lo > reach + spare || hi < -reach - spare;
    };
    for (std::size_t i = 0; i < 3; ++i) {
        Real3 axis{};
        axis[i] = 1;
        if (apart(axis)) return false;
    }
    const std::array<Real3, 3> sides{minus(t[1], t[0]), minus(t[2], t[1]), minus(t[0], t[2])};
    if (apart(outer(sides[0], sides[1]))) return false;
    for (std::size_t i = 0; i < 3; ++i)
        for (const Real3 &side : sides) {
            Real3 axis{};
            axis[i] = 1;
            if (apart(outer(axis, side))) return false;
        }
    return true;
}

std::optional<Real3> unit_of(const Real3 &way) {
    const double length = std::sqrt(inner(way, way));
    if (!(length > 0 && std::isfinite(length))) return std::nullopt;
    return Real3{way[0] / length, way[1] / length, way[2] / length};
}

std::optional<Real3> way_along(std::span<const Real3> directions) {
    constexpr int most_turns = 32;
    constexpr double enough = 0.7; // a cosine
    Real3 sum{};
    for (const Real3 &one : directions) sum = along(sum, one, 1);
    std::optional<Real3> way = unit_of(sum), best = way;
    double most = -unbounded;
    for (int turn = 0; way && turn < most_turns && most < enough; ++turn) {
        double least = unbounded;
        const Real3 *worst = nullptr;
        for (const Real3 &one : directions)
            if (const double share = inner(one, *way); share < least) least = share, worst = &one;
        if (least > most) most = least, best = way;
        if (worst) way = unit_of(along(*way, *worst, 1.0 / (2 + turn)));
    }
    return best;
}

std::optional<bool> crosses(const Real3 &from, const Real3 &to, const Triangle3 &t) {
    const auto volume = [](const Real3 &a, const Real3 &b, const Real3 &c, const Real3 &d) {
        const Real3 u = minus(b, a), v = minus(c, a), w = minus(d, a);
        const double size = std::sqrt(inner(u, u) * inner(v, v) * inner(w, w));
        const double six = inner(outer(u, v), w);
        return std::fabs(six) > by_rounding * size ? six : 0;
    };
    const double start = volume(t[0], t[1], t[2], from), end = volume(t[0], t[1], t[2], to);
    if (start == 0 || end == 0) return std::nullopt;
    if ((start > 0) == (end > 0)) return false;
    std::array<double, 3> about{};
    for (std::size_t k = 0; k < 3; ++k) about[k] = volume(from, to, t[k], t[(k + 1) % 3]);
    for (const double v : about)
        if (v == 0) return std::nullopt;
    return (about[0] > 0) == (about[1] > 0) && (about[1] > 0) == (about[2] > 0);
}

} // namespace fathom::mesh
