#include "mesh/simplify_checks.h"

#include "mesh/exact.h"
#include "mesh/nearest.h"
#include "mesh/pieces.h"

#include <algorithm>

namespace fathom::mesh {
namespace {

constexpr double past_rounding = 1 + 1e-9; // what rounding in double precision may take
constexpr std::size_t most_pieces = 4'000; // of a triangle
constexpr std::size_t checks_at_once = 256;

// An edge as one triangle has it, from below: of the lower number first.
struct Side {
    std::uint32_t low = 0, high = 0, triangle = 0;
    bool up = false; // the triangle goes from low to high
};

std::vector<Side> sides_of(const Mesh &mesh) {
    std::vector<Side> sides;
    sides.reserve(3 * mesh.triangles.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t from = mesh.triangles[t][k], to = mesh.triangles[t][(k + 1) % 3];
            sides.push_back({std::min(from, to), std::max(from, to), t, from < to});
        }
    std::ranges::sort(
        sides, {}, [](const Side &side) { return std::tuple(side.low, side.high, side.triangle); });
    return sides;
}

// Vertices whose triangles do not make one ring.
void find_pinched(const Mesh &mesh, std::vector<Point> &found) {
    std::vector<std::vector<std::array<std::uint32_t, 2>>> links(mesh.vertices.size());
    for (const auto &t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k) links[t[k]].push_back({t[(k + 1) % 3], t[(k + 2) % 3]});
    for (std::size_t v = 0; v < links.size(); ++v) {
        auto &ring = links[v];
        if (ring.empty()) continue;
        std::ranges::sort(ring);
        std::uint32_t at = ring.front()[0];
        std::size_t steps = 0;
        do {
            const auto next = std::ranges::lower_bound(ring, std::array{at, 0u});
            if (next == ring.end() || (*next)[0] != at) break;
            at = (*next)[1];
            ++steps;
        } while (at != ring.front()[0] && steps <= ring.size());
        if (steps != ring.size()) found.push_back(mesh.vertices[v]);
    }
}

// Boxes over triangles, each half of those above it.
class Halves {
  public:
    explicit Halves(const Mesh &mesh) : Halves(mesh, all_of(mesh)) {}
    // Of some of its triangles.
    Halves(const Mesh &mesh, std::vector<std::uint32_t> among)
        : mesh_(mesh), order_(std::move(among)) {
        for (const auto &t : mesh.triangles) {
            Point m{};
            for (const std::uint32_t v : t)
                for (std::size_t i = 0; i < 3; ++i) m[i] += mesh.vertices[v][i] / 3;
            middles_.push_back(m);
        }
        if (order_.empty()) return;
        parts_.push_back({{}, {}, 0, static_cast<std::uint32_t>(order_.size()), 0});
        for (std::uint32_t k = 0; k < parts_.size(); ++k) divide(k);
    }
    // All triangles of higher number whose box touches that of triangle t.
    void above(std::uint32_t t, std::vector<std::uint32_t> &found) const {
        touching(t, t + 1, found);
    }
    // … of other numbers, from `least` on.
    void touching(std::uint32_t t, std::uint32_t least, std::vector<std::uint32_t> &found) const {
        found.clear();
        Point lo, hi;
        box_of(t, lo, hi);
        std::vector<std::uint32_t> stack{0};
        while (!stack.empty()) {
            const Part &part = parts_[stack.back()];
            stack.pop_back();
            if (!touch(part.lo, part.hi, lo, hi)) continue;
            if (part.children != 0) {
                stack.push_back(part.children), stack.push_back(part.children + 1);
                continue;
            }
            for (std::uint32_t k = part.first; k < part.first + part.count; ++k) {
                Point from, to;
                if (order_[k] < least || order_[k] == t) continue;
                box_of(order_[k], from, to);
                if (touch(from, to, lo, hi)) found.push_back(order_[k]);
            }
        }
    }

  private:
    static std::vector<std::uint32_t> all_of(const Mesh &mesh) {
        std::vector<std::uint32_t> all(mesh.triangles.size());
        for (std::uint32_t t = 0; t < all.size(); ++t) all[t] = t;
        return all;
    }
    struct Part {
        Point lo{}, hi{};
        std::uint32_t first = 0, count = 0, children = 0; // the first of two; 0: none
    };
    static bool touch(const Point &a, const Point &b, const Point &c, const Point &d) {
        for (std::size_t i = 0; i < 3; ++i)
            if (a[i] > d[i] || c[i] > b[i]) return false;
        return true;
    }
    void box_of(std::uint32_t t, Point &lo, Point &hi) const {
        lo = hi = mesh_.vertices[mesh_.triangles[t][0]];
        for (const std::uint32_t v : mesh_.triangles[t])
            for (std::size_t i = 0; i < 3; ++i) {
                lo[i] = std::min(lo[i], mesh_.vertices[v][i]);
                hi[i] = std::max(hi[i], mesh_.vertices[v][i]);
            }
    }
    void divide(std::uint32_t number) {
        Part part = parts_[number];
        box_of(order_[part.first], part.lo, part.hi);
        for (std::uint32_t k = part.first; k < part.first + part.count; ++k) {
            Point lo, hi;
            box_of(order_[k], lo, hi);
            for (std::size_t i = 0; i < 3; ++i) {
                part.lo[i] = std::min(part.lo[i], lo[i]);
                part.hi[i] = std::max(part.hi[i], hi[i]);
            }
        }
        if (part.count > 4) {
            std::size_t axis = 0;
            for (std::size_t i = 1; i < 3; ++i)
                if (part.hi[i] - part.lo[i] > part.hi[axis] - part.lo[axis]) axis = i;
            const auto begin = order_.begin() + part.first;
            const std::uint32_t half = part.count / 2;
            std::nth_element(
                begin, begin + half, begin + part.count, [&](std::uint32_t a, std::uint32_t b) {
                    return std::pair(middles_[a][axis], a) < std::pair(middles_[b][axis], b);
                });
            part.children = static_cast<std::uint32_t>(parts_.size());
            parts_.push_back({{}, {}, part.first, half, 0});
            parts_.push_back({{}, {}, part.first + half, part.count - half, 0});
        }
        parts_[number] = part;
    }
    const Mesh &mesh_;
    std::vector<Part> parts_;
    std::vector<std::uint32_t> order_;
    std::vector<Point> middles_;
};

using Polygon = std::vector<Real3>; // convex, and flat but for rounding

// Cuts a polygon at the plane of the points p with n·(p - at) = 0: what lies above it, and the rest.
std::array<Polygon, 2> cut(const Polygon &polygon, const Real3 &at, const Real3 &n) {
    std::array<Polygon, 2> parts;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Real3 &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
        const double here = inner(n, minus(p, at)), there = inner(n, minus(q, at));
        parts[here > 0 ? 0 : 1].push_back(p);
        if ((here > 0) == (there > 0)) continue;
        const Real3 between = along(p, minus(q, p), here / (here - there));
        for (Polygon &part : parts) part.push_back(between);
    }
    for (Polygon &part : parts)
        if (part.size() < 3) part.clear();
    return parts;
}

bool within(const Polygon &polygon, const Triangle3 &other, double tolerance) {
    return std::ranges::all_of(polygon, [&](const Real3 &corner) {
        return to_triangle(corner, other) * past_rounding <= tolerance;
    });
}

// Takes the part of a polygon away that lies over a triangle, if all of it is near enough: what lies
// beyond its sides goes to `pieces`.
bool cover(const Polygon &polygon, const Triangle3 &other, double tolerance,
           std::vector<Polygon> &pieces) {
    const Real3 n = outer(minus(other[1], other[0]), minus(other[2], other[0]));
    Polygon over = polygon;
    std::vector<Polygon> beyond;
    for (std::size_t k = 0; k < 3 && !over.empty(); ++k) {
        Real3 out = outer(minus(other[(k + 1) % 3], other[k]), n);
        const double length = std::sqrt(inner(out, out));
        if (!(length > 0)) return false;
        auto parts = cut(over, along(other[k], out, 0.25 * tolerance / length), out);
        if (!parts[0].empty()) beyond.push_back(std::move(parts[0]));
        over = std::move(parts[1]);
    }
    if (over.empty() || !within(over, other, tolerance)) return false;
    pieces.insert(pieces.end(), beyond.begin(), beyond.end());
    return true;
}

// Whether all of a fine triangle is shown to be within the tolerance: pieces of it whose corners are
// within it of one triangle are so all over, since what is so near to a triangle is convex. Pieces
// are cut at the sides of what lies next to their middles, or where that does not do divided by
// halves, as far as a counted amount of work goes.
bool is_near(const Triangle3 &whole, const Mesh &mesh, const TriangleTree &tree, double tolerance) {
    std::vector<Polygon> pieces{{whole[0], whole[1], whole[2]}};
    for (std::size_t count = 0; !pieces.empty(); ++count) {
        if (count == most_pieces) return false;
        const Polygon piece = std::move(pieces.back());
        pieces.pop_back();
        Real3 middle{};
        for (const Real3 &corner : piece)
            middle = along(middle, corner, 1 / static_cast<double>(piece.size()));
        const auto near = tree.nearest(middle, tolerance);
        if (!near) return false;
        Triangle3 other;
        for (std::size_t k = 0; k < 3; ++k)
            other[k] = real(mesh.vertices[mesh.triangles[near->triangle][k]]);
        if (within(piece, other, tolerance) || cover(piece, other, tolerance, pieces)) continue;
        for (std::size_t n = 1; n + 1 < piece.size(); ++n) {
            const Triangle3 part{piece[0], piece[n], piece[n + 1]};
            Triangle3 m; // the middles of its sides
            for (std::size_t k = 0; k < 3; ++k)
                for (std::size_t i = 0; i < 3; ++i)
                    m[k][i] = 0.5 * (part[k][i] + part[(k + 1) % 3][i]);
            pieces.push_back({m[0], m[1], m[2]});
            for (std::size_t k = 0; k < 3; ++k) pieces.push_back({part[k], m[k], m[(k + 2) % 3]});
        }
    }
    return true;
}

// The border of a piece of a mesh: its edges of one triangle, sorted; none of another number.
std::optional<std::vector<std::array<std::uint32_t, 2>>> border_of(const Mesh &mesh) {
    std::vector<std::array<std::uint32_t, 2>> border;
    const std::vector<Side> sides = sides_of(mesh);
    for (std::size_t k = 0, end = 0; k < sides.size(); k = end) {
        for (end = k; end < sides.size() && sides[end].low == sides[k].low &&
                      sides[end].high == sides[k].high;)
            ++end;
        if (end - k > 2 || (end - k == 2 && sides[k].up == sides[k + 1].up)) return std::nullopt;
        if (end - k == 1)
            border.push_back(sides[k].up ? std::array{sides[k].low, sides[k].high}
                                         : std::array{sides[k].high, sides[k].low});
    }
    std::ranges::sort(border);
    return border;
}

// Its vertices less its edges and its triangles, and how many pieces it is in.
std::pair<long, std::size_t> shape_of(const Mesh &mesh) {
    std::vector<std::uint8_t> used(mesh.vertices.size(), 0);
    for (const auto &t : mesh.triangles)
        for (const std::uint32_t v : t) used[v] = 1;
    const std::vector<std::uint32_t> piece = pieces_of(mesh);
    long vertices = 0, edges = 0;
    std::size_t pieces = 0;
    for (std::uint32_t v = 0; v < piece.size(); ++v)
        if (used[v]) ++vertices, pieces += piece[v] == v;
    const std::vector<Side> sides = sides_of(mesh);
    for (std::size_t k = 0; k < sides.size(); ++k)
        edges += k == 0 || sides[k].low != sides[k - 1].low || sides[k].high != sides[k - 1].high;
    return {vertices - edges + static_cast<long>(mesh.triangles.size()), pieces};
}

// For each vertex how its triangles lie about it: one ring, or fans from border to border, so many.
bool has_pinched(const Mesh &mesh, const Mesh &like) {
    const auto fans = [](const Mesh &of) {
        // Each fan but a ring begins at an edge that no other triangle there ends at.
        std::vector<std::vector<std::array<std::uint32_t, 2>>> links(of.vertices.size());
        for (const auto &t : of.triangles)
            for (std::size_t k = 0; k < 3; ++k)
                links[t[k]].push_back({t[(k + 1) % 3], t[(k + 2) % 3]});
        std::vector<std::uint32_t> count(links.size(), 0);
        for (std::size_t v = 0; v < links.size(); ++v) {
            auto &ring = links[v];
            std::ranges::sort(ring);
            std::vector<std::uint8_t> seen(ring.size(), 0);
            const auto follow = [&](std::size_t k) {
                while (!seen[k]) {
                    seen[k] = 1;
                    const auto next = std::ranges::lower_bound(ring, std::array{ring[k][1], 0u});
                    if (next == ring.end() || (*next)[0] != ring[k][1]) break;
                    k = static_cast<std::size_t>(next - ring.begin());
                }
            };
            std::vector<std::uint32_t> ends;
            for (const auto &link : ring) ends.push_back(link[1]);
            std::ranges::sort(ends);
            for (std::size_t k = 0; k < ring.size(); ++k)
                if (!std::ranges::binary_search(ends, ring[k][0])) ++count[v], follow(k);
            for (std::size_t k = 0; k < ring.size(); ++k)
                if (!seen[k]) ++count[v], follow(k);
        }
        return count;
    };
    const std::vector<std::uint32_t> now = fans(mesh), before = fans(like);
    for (std::size_t v = 0; v < now.size(); ++v)
        if (now[v] > before[v]) return true;
    return false;
}

bool has_flat(const Mesh &mesh) {
    return std::ranges::any_of(mesh.triangles, [&](const auto &t) {
        return is_flat(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
    });
}

} // namespace

std::vector<Point> flaws_of(const Mesh &mesh) {
    std::vector<Point> found;
    const std::vector<Side> sides = sides_of(mesh);
    for (std::size_t k = 0, end = 0; k < sides.size(); k = end) {
        for (end = k; end < sides.size() && sides[end].low == sides[k].low &&
                      sides[end].high == sides[k].high;)
            ++end;
        if (end - k == 2 && sides[k].up != sides[k + 1].up) continue;
        found.push_back(mesh.vertices[sides[k].low]);
        found.push_back(mesh.vertices[sides[k].high]);
    }
    find_pinched(mesh, found);
    for (const auto &t : mesh.triangles)
        if (is_flat(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]))
            for (const std::uint32_t v : t) found.push_back(mesh.vertices[v]);
    return found;
}

bool is_like(const Mesh &fine, const Mesh &mesh) {
    const auto border = border_of(mesh);
    return border && border == border_of(fine) && shape_of(mesh) == shape_of(fine) &&
           !has_flat(mesh) && !has_pinched(mesh, fine);
}

bool crosses_itself(const Mesh &mesh) {
    const Halves halves(mesh);
    std::vector<std::uint32_t> near;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        halves.above(t, near);
        for (const std::uint32_t other : near)
            if (crossing_of(mesh.vertices, mesh.triangles[t], mesh.triangles[other])) return true;
    }
    return false;
}

bool strays(const Mesh &fine, const Mesh &mesh, double tolerance) {
    const TriangleTree tree(mesh);
    return std::ranges::any_of(fine.triangles, [&](const auto &t) {
        return !is_near(
            {real(fine.vertices[t[0]]), real(fine.vertices[t[1]]), real(fine.vertices[t[2]])}, mesh,
            tree, tolerance);
    });
}

std::vector<std::uint32_t> strays_of(const Mesh &fine, const Mesh &mesh, double tolerance,
                                     unsigned threads, Progress &progress) {
    const TriangleTree tree(mesh);
    const std::size_t count = fine.triangles.size();
    std::vector<std::vector<std::uint32_t>> found((count + checks_at_once - 1) / checks_at_once);
    in_parallel(
        found.size(), threads, progress, [] { return 0; },
        [&](int, std::size_t number) {
            const std::size_t end = std::min(count, (number + 1) * checks_at_once);
            for (std::size_t k = number * checks_at_once; k < end; ++k) {
                Triangle3 whole;
                for (std::size_t c = 0; c < 3; ++c)
                    whole[c] = real(fine.vertices[fine.triangles[k][c]]);
                if (!is_near(whole, mesh, tree, tolerance))
                    found[number].push_back(static_cast<std::uint32_t>(k));
            }
        });
    std::vector<std::uint32_t> all;
    for (const auto &some : found) all.insert(all.end(), some.begin(), some.end());
    return all;
}

std::vector<std::pair<std::uint32_t, std::uint32_t>>
crossings_with(const Mesh &mesh, const std::vector<std::uint32_t> &asked, unsigned threads,
               Progress &progress) {
    using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;
    // The boxes are of those that are asked about, so that few of them take little.
    const Halves halves(mesh, asked);
    std::vector<std::uint8_t> is_asked(mesh.triangles.size(), 0);
    for (const std::uint32_t t : asked) is_asked[t] = 1;
    const std::size_t count = asked.empty() ? 0 : mesh.triangles.size();
    std::vector<Pairs> found((count + checks_at_once - 1) / checks_at_once);
    in_parallel(
        found.size(), threads, progress, [] { return std::vector<std::uint32_t>(); },
        [&](std::vector<std::uint32_t> &near, std::size_t number) {
            const std::size_t end = std::min(count, (number + 1) * checks_at_once);
            for (std::size_t k = number * checks_at_once; k < end; ++k) {
                const auto t = static_cast<std::uint32_t>(k);
                halves.touching(t, is_asked[t] ? t + 1 : 0, near);
                std::ranges::sort(near);
                for (const std::uint32_t other : near)
                    if (crossing_of(mesh.vertices, mesh.triangles[t], mesh.triangles[other]))
                        found[number].push_back({t, other});
            }
        });
    Pairs all;
    for (const Pairs &some : found) all.insert(all.end(), some.begin(), some.end());
    return all;
}

std::vector<std::pair<std::uint32_t, std::uint32_t>>
crossings_between(const Mesh &mesh, const std::vector<std::uint32_t> &owner, unsigned threads,
                  Progress &progress) {
    using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;
    const Halves halves(mesh);
    const std::size_t count = mesh.triangles.size();
    std::vector<Pairs> found((count + checks_at_once - 1) / checks_at_once);
    in_parallel(
        found.size(), threads, progress, [] { return std::vector<std::uint32_t>(); },
        [&](std::vector<std::uint32_t> &near, std::size_t number) {
            const std::size_t end = std::min(count, (number + 1) * checks_at_once);
            for (std::size_t k = number * checks_at_once; k < end; ++k) {
                const auto t = static_cast<std::uint32_t>(k);
                halves.above(t, near);
                std::ranges::sort(near);
                for (const std::uint32_t other : near)
                    if (owner[t] != owner[other] &&
                        crossing_of(mesh.vertices, mesh.triangles[t], mesh.triangles[other]))
                        found[number].push_back({t, other});
            }
        });
    Pairs all;
    for (const Pairs &some : found) all.insert(all.end(), some.begin(), some.end());
    return all;
}

} // namespace fathom::mesh
