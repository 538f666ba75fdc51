// What a mesh of triangles is, counted from its triangles alone: borders, edges and vertices that
// are no surface, parts, genus, volume, and pairs of triangles that cross.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <set>
#include <span>
#include <unordered_map>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>

namespace fathom::test {

using MeshPoint = std::array<float, 3>;
using MeshTriangle = std::array<std::uint32_t, 3>;

struct Survey {
    std::size_t border_edges = 0;  // of one triangle
    std::size_t crowded_edges = 0; // of more than two
    std::size_t turned_edges = 0;  // two triangles that disagree on the outside
    std::size_t pinched = 0;       // vertices whose triangles are not one ring
    std::size_t degenerate = 0;    // triangles without an area, or with a corner twice
    std::size_t equal_points = 0;  // vertices at another one's place
    std::size_t components = 0;
    long euler = 0; // vertices - edges + triangles, of used vertices
    long genus = 0; // of all parts together
    double volume = 0, area = 0;
    bool closed() const {
        return border_edges + crowded_edges + turned_edges + pinched + degenerate == 0;
    }
};

using Real = long double;
using Exact = std::array<Real, 3>;
inline Exact exact(const MeshPoint &p) { return {p[0], p[1], p[2]}; }
inline Exact minus(const Exact &a, const Exact &b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Exact cross_of(const Exact &a, const Exact &b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline Real dot_of(const Exact &a, const Exact &b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
// 1, 0 or -1: the sign of (b - a) x (c - a) . (p - a) in whole numbers: floats are such, of 2^-149.
inline int exact_side(const Exact &a, const Exact &b, const Exact &c, const Exact &p) {
    for (std::size_t i = 0; i < 3; ++i)
        if (a[i] == b[i] && a[i] == c[i] && a[i] == p[i]) return 0;
    using boost::multiprecision::cpp_int_backend;
    using Whole = boost::multiprecision::number<
        cpp_int_backend<1024, 1024, boost::multiprecision::signed_magnitude,
                        boost::multiprecision::unchecked, void>>;
    const auto whole = [](Real x) {
        int exponent = 0;
        const auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(x, &exponent), 24));
        return mantissa == 0 ? Whole(0) : Whole(mantissa) << (exponent - 24 + 149);
    };
    std::array<Whole, 3> u, v, w;
    for (std::size_t i = 0; i < 3; ++i) {
        const Whole from = whole(a[i]);
        u[i] = whole(b[i]) - from, v[i] = whole(c[i]) - from, w[i] = whole(p[i]) - from;
    }
    const Whole sum = (u[1] * v[2] - u[2] * v[1]) * w[0] + (u[2] * v[0] - u[0] * v[2]) * w[1] +
                      (u[0] * v[1] - u[1] * v[0]) * w[2];
    return sum.sign();
}
// 1, 0 or -1: on which side of the plane of a, b and c the point p lies, without rounding. All are
// floats.
inline int side_of(const Exact &a, const Exact &b, const Exact &c, const Exact &p) {
    const Exact u = minus(b, a), v = minus(c, a), w = minus(p, a);
    const Exact n = cross_of(u, v);
    const Real value = dot_of(n, w);
    Real size = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
        size += (std::fabs(u[j] * v[k]) + std::fabs(u[k] * v[j])) * std::fabs(w[i]);
    }
    if (std::fabs(value) <= 1e-17L * size) return exact_side(a, b, c, p);
    return value > 0 ? 1 : -1;
}

inline Survey survey(std::span<const MeshPoint> points, std::span<const MeshTriangle> triangles) {
    Survey found;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::array<int, 2>> edges; // each way
    std::vector<std::uint32_t> parent(points.size());
    std::iota(parent.begin(), parent.end(), 0u);
    const auto root = [&](std::uint32_t v) {
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    };
    std::vector<std::vector<std::array<std::uint32_t, 2>>> links(points.size());
    for (const MeshTriangle &t : triangles) {
        const Exact a = exact(points[t[0]]), b = exact(points[t[1]]), c = exact(points[t[2]]);
        const Exact n = cross_of(minus(b, a), minus(c, a));
        const Real twice = std::sqrt(dot_of(n, n));
        if (!(twice > 0) || t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) ++found.degenerate;
        found.area += static_cast<double>(twice / 2);
        found.volume += static_cast<double>(dot_of(a, cross_of(b, c)) / 6);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t from = t[k], to = t[(k + 1) % 3];
            ++edges[std::minmax(from, to)][from < to];
            parent[root(from)] = root(to);
            links[from].push_back({to, t[(k + 2) % 3]});
        }
    }
    for (const auto &[edge, ways] : edges) {
        const int all = ways[0] + ways[1];
        found.border_edges += all == 1;
        found.crowded_edges += all > 2;
        found.turned_edges += all == 2 && ways[0] != 1;
    }
    std::set<std::uint32_t> roots;
    long used = 0;
    for (std::uint32_t v = 0; v < points.size(); ++v) {
        if (links[v].empty()) continue;
        ++used;
        roots.insert(root(v));
        // Follow the ring once; all triangles have to be on it.
        std::map<std::uint32_t, std::uint32_t> next;
        for (const auto &[from, to] : links[v]) next[from] = to;
        std::size_t steps = 0;
        std::uint32_t at = links[v].front()[0];
        do {
            const auto found_next = next.find(at);
            if (found_next == next.end()) break;
            at = found_next->second;
            ++steps;
        } while (at != links[v].front()[0] && steps <= links[v].size());
        found.pinched += steps != links[v].size();
    }
    std::set<MeshPoint> places(points.begin(), points.end());
    found.equal_points = points.size() - places.size();
    found.components = roots.size();
    found.euler = used - static_cast<long>(edges.size()) + static_cast<long>(triangles.size());
    found.genus = static_cast<long>(found.components) - found.euler / 2;
    return found;
}

// Whether the way from p to q meets the triangle; not where all lie in one plane.
inline bool meets(const Exact &p, const Exact &q, const std::array<Exact, 3> &t) {
    const int from = side_of(t[0], t[1], t[2], p), to = side_of(t[0], t[1], t[2], q);
    if (from * to > 0 || (from == 0 && to == 0)) return false;
    const int a = side_of(p, q, t[0], t[1]), b = side_of(p, q, t[1], t[2]),
              c = side_of(p, q, t[2], t[0]);
    return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

// Whether two triangles in one plane overlap: no side of one has the other all beyond it.
inline bool overlap_flat(const std::array<Exact, 3> &a, const std::array<Exact, 3> &b) {
    const Exact n = cross_of(minus(a[1], a[0]), minus(a[2], a[0]));
    std::size_t axis = 0; // down which it is seen best
    for (std::size_t i = 1; i < 3; ++i)
        if (std::fabs(n[i]) > std::fabs(n[axis])) axis = i;
    const auto turn = [&](const Exact &p, const Exact &q, const Exact &r) {
        Exact above = p; // side_of of a plane along the axis is the turn of its three points
        above[axis] = p[axis] < 0 ? 1 : -1;
        return side_of(p, q, above, r) * (p[axis] < 0 ? 1 : -1);
    };
    for (const bool swap : {false, true}) {
        const auto &s = swap ? b : a, &t = swap ? a : b;
        for (std::size_t k = 0; k < 3; ++k) {
            const Exact &p = s[k], &q = s[(k + 1) % 3];
            const int own = turn(p, q, s[(k + 2) % 3]);
            if (std::ranges::all_of(t, [&](const Exact &r) { return own * turn(p, q, r) <= 0; }))
                return false;
        }
    }
    return true;
}

// Whether two triangles have more in common than the vertices and the edge that they share.
inline bool crossing_pair(std::span<const MeshPoint> points, const MeshTriangle &s,
                          const MeshTriangle &t) {
    std::array<Exact, 3> a, b;
    for (std::size_t k = 0; k < 3; ++k) a[k] = exact(points[s[k]]), b[k] = exact(points[t[k]]);
    for (std::size_t i = 0; i < 3; ++i)
        if (std::max({a[0][i], a[1][i], a[2][i]}) < std::min({b[0][i], b[1][i], b[2][i]}) ||
            std::max({b[0][i], b[1][i], b[2][i]}) < std::min({a[0][i], a[1][i], a[2][i]}))
            return false;
    if (std::ranges::all_of(b, [&](const Exact &p) { return side_of(a[0], a[1], a[2], p) == 0; }))
        return overlap_flat(a, b);
    std::vector<std::pair<std::size_t, std::size_t>> shared;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            if (s[i] == t[j]) shared.push_back({i, j});
    const auto away = [](const MeshTriangle &t, std::size_t k, std::uint32_t v) {
        return t[k] != v && t[(k + 1) % 3] != v;
    };
    if (shared.empty()) {
        for (std::size_t k = 0; k < 3; ++k)
            if (meets(a[k], a[(k + 1) % 3], b) || meets(b[k], b[(k + 1) % 3], a)) return true;
        return false;
    }
    if (shared.size() == 1) {
        const std::uint32_t v = s[shared[0].first];
        for (std::size_t k = 0; k < 3; ++k)
            if ((away(s, k, v) && meets(a[k], a[(k + 1) % 3], b)) ||
                (away(t, k, v) && meets(b[k], b[(k + 1) % 3], a)))
                return true;
        return false;
    }
    return shared.size() == 3; // else an edge in common, and no plane
}

// Pairs of triangles that cross, by a grid of boxes.
inline std::size_t crossings(std::span<const MeshPoint> points,
                             std::span<const MeshTriangle> triangles) {
    if (triangles.empty()) return 0;
    double side = 0;
    for (const MeshTriangle &t : triangles)
        for (std::size_t i = 0; i < 3; ++i)
            side += std::fabs(double(points[t[0]][i]) - points[t[1]][i]);
    side = std::max(side / static_cast<double>(triangles.size()), 1e-9);
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells;
    const auto range = [&](const MeshTriangle &t, std::size_t i) {
        const auto [lo, hi] = std::minmax({points[t[0]][i], points[t[1]][i], points[t[2]][i]});
        return std::array<long, 2>{static_cast<long>(std::floor(lo / side)),
                                   static_cast<long>(std::floor(hi / side))};
    };
    const auto key = [](long x, long y, long z) {
        return (static_cast<std::uint64_t>(x) & 0x1fffff) << 42 |
               (static_cast<std::uint64_t>(y) & 0x1fffff) << 21 |
               (static_cast<std::uint64_t>(z) & 0x1fffff);
    };
    std::set<std::pair<std::uint32_t, std::uint32_t>> bad;
    for (std::uint32_t k = 0; k < triangles.size(); ++k) {
        const auto x = range(triangles[k], 0), y = range(triangles[k], 1),
                   z = range(triangles[k], 2);
        for (long i = x[0]; i <= x[1]; ++i)
            for (long j = y[0]; j <= y[1]; ++j)
                for (long l = z[0]; l <= z[1]; ++l) {
                    std::vector<std::uint32_t> &here = cells[key(i, j, l)];
                    for (const std::uint32_t other : here)
                        if (crossing_pair(points, triangles[k], triangles[other]))
                            bad.insert({other, k});
                    here.push_back(k);
                }
    }
    return bad.size();
}

} // namespace fathom::test
