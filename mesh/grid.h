// Points and triangles in double precision, and things found by where they are: what proofs of
// distances are made of.
#pragma once

#include "mesh/octree.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <unordered_set>

namespace fathom::mesh {

using Real3 = std::array<double, 3>;
using Triangle3 = std::array<Real3, 3>;

inline Real3 real(const Point &p) { return {p[0], p[1], p[2]}; }
inline Real3 minus(const Real3 &a, const Real3 &b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Real3 along(const Real3 &a, const Real3 &d, double t) {
    return {a[0] + t * d[0], a[1] + t * d[1], a[2] + t * d[2]};
}
inline double inner(const Real3 &a, const Real3 &b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Real3 outer(const Real3 &a, const Real3 &b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double distance(const Real3 &a, const Real3 &b) {
    const Real3 d = minus(a, b);
    return std::sqrt(inner(d, d));
}

inline double to_segment(const Real3 &p, const Real3 &a, const Real3 &b) {
    const Real3 d = minus(b, a);
    const double squares = inner(d, d);
    const double t = squares > 0 ? std::clamp(inner(minus(p, a), d) / squares, 0.0, 1.0) : 0;
    return distance(p, along(a, d, t));
}

// No less than the distance: to the foot on the plane where that is in the triangle, else to a side.
inline double to_triangle(const Real3 &p, const Triangle3 &t) {
    double best =
        std::min({to_segment(p, t[0], t[1]), to_segment(p, t[1], t[2]), to_segment(p, t[2], t[0])});
    const Real3 u = minus(t[1], t[0]), v = minus(t[2], t[0]), w = minus(p, t[0]);
    const Real3 n = outer(u, v);
    const double squares = inner(n, n);
    if (!(squares > 0)) return best;
    const double b = inner(outer(w, v), n) / squares, c = inner(outer(u, w), n) / squares;
    if (b >= 0 && c >= 0 && b + c <= 1)
        best = std::min(best, distance(p, along(along(t[0], u, b), v, c)));
    return best;
}

// One number for a cell of a grid, by its place along each axis: -8 to 2^21 - 9.
inline std::uint64_t key_of(const std::array<std::int64_t, 3> &at) {
    return std::uint64_t(at[0] + 8) << 42 | std::uint64_t(at[1] + 8) << 21 |
           std::uint64_t(at[2] + 8);
}

// Things by the cells of a grid that they touch.
class Grid {
  public:
    Grid(const Point &origin, double side) : origin_(origin), side_(side) {}
    void add(const Real3 &lo, const Real3 &hi, std::uint32_t what) {
        each_column(lo, hi, [&](std::uint64_t first, std::uint64_t last) {
            for (std::uint64_t key = first; key <= last; ++key) entries_.push_back({key, what});
        });
    }
    void sort() { std::ranges::sort(entries_); }
    // All that touch a box, each once.
    void find(const Real3 &lo, const Real3 &hi, std::vector<std::uint32_t> &found) const {
        found.clear();
        each_column(lo, hi, [&](std::uint64_t first, std::uint64_t last) {
            auto at = std::ranges::lower_bound(entries_, std::pair{first, std::uint32_t{0}});
            for (; at != entries_.end() && at->first <= last; ++at) found.push_back(at->second);
        });
        std::ranges::sort(found);
        found.erase(std::unique(found.begin(), found.end()), found.end());
    }

  private:
    // The cells that a box touches: those in a line along the last axis have one key after the other.
    template <class Do> void each_column(const Real3 &lo, const Real3 &hi, Do what) const {
        std::array<std::int64_t, 3> from{}, to{};
        for (std::size_t i = 0; i < 3; ++i) {
            from[i] = static_cast<std::int64_t>(std::floor((lo[i] - origin_[i]) / side_));
            to[i] = static_cast<std::int64_t>(std::floor((hi[i] - origin_[i]) / side_));
        }
        for (std::int64_t x = from[0]; x <= to[0]; ++x)
            for (std::int64_t y = from[1]; y <= to[1]; ++y)
                if (from[2] <= to[2]) what(key_of({x, y, from[2]}), key_of({x, y, to[2]}));
    }
    Point origin_;
    double side_;
    std::vector<std::pair<std::uint64_t, std::uint32_t>> entries_;
};

// Where cells were divided: the blocks of space about them.
class Region {
  public:
    // `few`: drawing cells, half of what is beside a divided one.
    explicit Region(const Lattice &lattice, double few = 2)
        : lattice_(lattice), side_(lattice.side(lattice.level)), few_(few), more_(2 * few) {}
    void add(const Cell &cell) {
        const Real3 at = real(point_of(lattice_, corner(cell.at, 1, 0)));
        if (!changed_.insert(key_of(block_of(at, few_))).second) return;
        add_about(block_of(at, few_), beside_);
        add_about(block_of(at, more_), around_);
    }
    // Whether a point is no more than twice so many drawing cells from a divided one, or four times: it
    // may be of those that are a little farther.
    bool beside(const Real3 &p) const { return beside_.contains(key_of(block_of(p, few_))); }
    bool around(const Real3 &p) const { return around_.contains(key_of(block_of(p, more_))); }

  private:
    using Block = std::array<std::int64_t, 3>;
    Block block_of(const Real3 &p, double cells) const {
        const Real3 origin = real(point_of(lattice_, {0, 0, 0}));
        Block at{};
        for (std::size_t i = 0; i < 3; ++i)
            at[i] = static_cast<std::int64_t>(std::floor((p[i] - origin[i]) / (cells * side_)));
        return at;
    }
    static void add_about(const Block &at, std::unordered_set<std::uint64_t> &blocks) {
        for (std::int64_t x = -2; x <= 2; ++x)
            for (std::int64_t y = -2; y <= 2; ++y)
                for (std::int64_t z = -2; z <= 2; ++z)
                    blocks.insert(key_of(Block{at[0] + x, at[1] + y, at[2] + z}));
    }
    const Lattice lattice_;
    double side_, few_, more_; // the last two: the sides of blocks, in drawing cells
    std::unordered_set<std::uint64_t> changed_, beside_, around_;
};

} // namespace fathom::mesh
