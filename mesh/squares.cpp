#include "mesh/squares.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace fathom::mesh {
namespace {

constexpr int bisections = 20;
constexpr double edge_margin = 1.0 / 1024; // of a side, that vertices keep from the ends
constexpr double apart_normals = 0.9;      // cosine, below which two crossings see a corner

void sign_corners(const Plane2 &plane, Squares &squares, Evaluator &evaluator) {
    std::vector<Square> corners;
    for (const Square &s : squares.open)
        for (int c = 0; c < 4; ++c) corners.push_back({s.i + (c == 1 || c == 2), s.j + c / 2});
    std::ranges::sort(corners);
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    Points points;
    for (const Square &c : corners)
        points.add(plane.point(plane.place(0, c.i), plane.place(1, c.j)));
    std::vector<float> values;
    values_at(evaluator, *plane.field.whole, points, values);
    for (Square &s : squares.open)
        for (int c = 0; c < 4; ++c) {
            const Square at{s.i + (c == 1 || c == 2), s.j + c / 2};
            const auto found = std::ranges::lower_bound(corners, at);
            if (values[static_cast<std::size_t>(found - corners.begin())] <= 0)
                s.signs |= static_cast<std::uint8_t>(1 << c);
        }
}

// The edge from corner c of a square to the next one, counterclockwise.
Crossing2 edge_of(const Square &s, int c) {
    Crossing2 edge;
    edge.i = s.i + (c == 1);
    edge.j = s.j + (c == 2);
    edge.upright = c % 2 == 1;
    const int low = c == 0 ? 0 : c == 1 ? 1 : c == 2 ? 3 : 0;
    edge.low_inside = s.signs >> low & 1;
    return edge;
}

using EdgeKey = std::array<std::int32_t, 3>;
EdgeKey key_of_edge(const Crossing2 &edge) { return {edge.j, edge.i, edge.upright}; }

// Joins the crossed edges of each square: where the border, counterclockwise, leaves the solid, to
// where it came into it before.
void join(const Squares &squares, std::map<EdgeKey, std::int32_t> &numbers, Ways &ways) {
    const auto number_of = [&](const Crossing2 &edge) {
        const auto [at, added] =
            numbers.emplace(key_of_edge(edge), static_cast<std::int32_t>(ways.crossings.size()));
        if (added) ways.crossings.push_back(edge);
        return at->second;
    };
    for (std::size_t k = 0; k < squares.open.size(); ++k) {
        const Square &s = squares.open[k];
        if (!s.crossed()) continue;
        const auto solid = [&](int c) { return (s.signs >> (c & 3) & 1) != 0; };
        for (int c = 0; c < 4; ++c) {
            if (!solid(c) || solid(c + 1)) continue;
            int first = c; // of the solid corners that end here
            while (solid(first + 3)) first = (first + 3) & 3;
            const std::int32_t from = number_of(edge_of(s, c)),
                               to = number_of(edge_of(s, (first + 3) & 3));
            ways.crossings[static_cast<std::size_t>(from)].next = to;
            ways.crossings[static_cast<std::size_t>(from)].through = static_cast<std::int32_t>(k);
        }
    }
}

void find_roots(const Plane2 &plane, Ways &ways, Evaluator &evaluator) {
    const std::size_t n = ways.crossings.size();
    std::vector<float> in(n), out(n), values; // along the edge: in the solid, and not
    for (std::size_t k = 0; k < n; ++k) {
        const Crossing2 &c = ways.crossings[k];
        const float low = plane.place(c.upright, c.upright ? c.j : c.i),
                    high = plane.place(c.upright, (c.upright ? c.j : c.i) + 1);
        in[k] = c.low_inside ? low : high;
        out[k] = c.low_inside ? high : low;
    }
    for (int round = 0; round < bisections; ++round) {
        Points points;
        for (std::size_t k = 0; k < n; ++k) {
            const Crossing2 &c = ways.crossings[k];
            const float middle = 0.5f * (in[k] + out[k]);
            points.add(c.upright ? plane.point(plane.place(0, c.i), middle)
                                 : plane.point(middle, plane.place(1, c.j)));
        }
        values_at(evaluator, *plane.field.whole, points, values);
        for (std::size_t k = 0; k < n; ++k)
            (values[k] <= 0 ? in[k] : out[k]) = 0.5f * (in[k] + out[k]);
    }
    const double margin = std::max(edge_margin * plane.side(), 2 * plane.lattice.ulp);
    for (std::size_t k = 0; k < n; ++k) {
        Crossing2 &c = ways.crossings[k];
        const double low = plane.place(c.upright, c.upright ? c.j : c.i),
                     high = plane.place(c.upright, (c.upright ? c.j : c.i) + 1);
        const float root = 0.5f * (in[k] + out[k]);
        c.slack = std::fabs(in[k] - out[k]);
        const float vertex =
            static_cast<float>(std::clamp<double>(root, low + margin, high - margin));
        const float other = plane.place(!c.upright, c.upright ? c.i : c.j);
        c.root = c.upright ? Flat{other, root} : Flat{root, other};
        c.vertex = c.upright ? Flat{other, vertex} : Flat{vertex, other};
    }
}

// Where the tangents of two crossings of a square meet in it, if they see a corner.
void find_corners(const Plane2 &plane, const Squares &squares, Ways &ways, Evaluator &evaluator) {
    const std::size_t n = ways.crossings.size();
    Points points;
    const auto nudge = static_cast<float>(plane.side() / 64);
    for (const Crossing2 &c : ways.crossings) { // outside, where fields are as smooth as inside
        Flat at = c.root;
        at[c.upright] += c.low_inside ? nudge : -nudge;
        points.add(plane.point(at[0], at[1]));
    }
    std::array<std::vector<float>, 4> slopes;
    gradients_at(evaluator, *plane.field.whole, points, slopes);
    ways.corners.assign(n, {});
    const double margin = std::max(edge_margin * plane.side(), 2 * plane.lattice.ulp);
    for (std::size_t k = 0; k < n; ++k) {
        const Crossing2 &c = ways.crossings[k];
        const Square &s = squares.open[static_cast<std::size_t>(c.through)];
        if (!s.alone()) continue;
        const auto other = static_cast<std::size_t>(c.next);
        const double ax = slopes[1 + plane.a][k], ay = slopes[1 + plane.b][k],
                     bx = slopes[1 + plane.a][other], by = slopes[1 + plane.b][other];
        const double la = std::hypot(ax, ay), lb = std::hypot(bx, by);
        if (!(la > 0 && lb > 0) || ax * bx + ay * by > apart_normals * la * lb) continue;
        const Flat &p = c.root, &q = ways.crossings[other].root;
        const double det = ax * by - ay * bx;
        if (!(std::fabs(det) > 1e-3 * la * lb)) continue;
        const double u = ax * p[0] + ay * p[1], v = bx * q[0] + by * q[1];
        const double x = (u * by - v * ay) / det, y = (ax * v - bx * u) / det;
        if (!(x >= plane.place(0, s.i) + margin && x <= plane.place(0, s.i + 1) - margin &&
              y >= plane.place(1, s.j) + margin && y <= plane.place(1, s.j + 1) - margin))
            continue;
        ways.corners[k] = {true, {static_cast<float>(x), static_cast<float>(y)}};
    }
}

} // namespace

FlatBoxes::FlatBoxes(const Plane2 &of, Evaluator &by) : plane(of), evaluator(by) {}

void FlatBoxes::put(std::size_t k, const Rectangle &r) {
    const std::size_t slot = 16 * (k / 8) + k % 8, middle = slot + 8;
    const Point lo = plane.point(r.lo[0], r.lo[1]), hi = plane.point(r.hi[0], r.hi[1]);
    for (std::size_t i = 0; i < 3; ++i) {
        boxes.lo[i][slot] = lo[i], boxes.hi[i][slot] = hi[i];
        boxes.lo[i][middle] = boxes.hi[i][middle] = lo[i] == hi[i] ? lo[i] : 0.5f * (lo[i] + hi[i]);
    }
}

void FlatBoxes::run(std::size_t count, const cpu::ShortTape &tape) {
    const std::size_t blocks = (count + 7) / 8;
    for (std::size_t k = count; k < 8 * blocks; ++k)
        for (std::size_t i = 0; i < 3; ++i)
            for (const std::size_t slot : {16 * (k / 8) + k % 8, 16 * (k / 8) + k % 8 + 8})
                boxes.lo[i][slot] = boxes.lo[i][0], boxes.hi[i][slot] = boxes.hi[i][0];
    boxes.count = 16 * blocks;
    ranges_over(evaluator, tape, boxes);
}

Space FlatBoxes::space(std::size_t k, const Rectangle &r, SolidArea &solid) const {
    const std::size_t slot = 16 * (k / 8) + k % 8;
    const auto of = [&](bool closed) {
        return space_of(evaluator, slot, half_diagonal_of(r), plane.lattice.ulp, true, closed);
    };
    const Space space = of(true);
    if (space == Space::Inside)
        (of(false) == Space::Inside ? solid.inside : solid.touched) += area_of(r);
    return space;
}

double half_diagonal_of(const Rectangle &r) {
    return 0.5 * std::hypot(double(r.hi[0]) - r.lo[0], double(r.hi[1]) - r.lo[1]);
}
double area_of(const Rectangle &r) {
    return (double(r.hi[0]) - r.lo[0]) * (double(r.hi[1]) - r.lo[1]);
}

std::vector<Rectangle> open_quarters(FlatBoxes &boxes, const cpu::ShortTape &tape,
                                     const std::vector<Rectangle> &whole, SolidArea &solid) {
    std::vector<Rectangle> open, parts;
    const auto flush = [&] {
        for (std::size_t k = 0; k < parts.size(); ++k) boxes.put(k, parts[k]);
        boxes.run(parts.size(), tape);
        for (std::size_t k = 0; k < parts.size(); ++k)
            if (boxes.space(k, parts[k], solid) == Space::Open) open.push_back(parts[k]);
        parts.clear();
    };
    for (const Rectangle &r : whole) {
        const Flat cut{0.5f * (r.lo[0] + r.hi[0]), 0.5f * (r.lo[1] + r.hi[1])};
        for (std::size_t k = 0; k < 4; ++k) {
            Rectangle part = r;
            for (std::size_t i = 0; i < 2; ++i) (k >> i & 1 ? part.lo : part.hi)[i] = cut[i];
            parts.push_back(part);
        }
        if (parts.size() == FlatBoxes::at_once) flush();
    }
    if (!parts.empty()) flush();
    return open;
}

const Square *find(const Squares &squares, std::int32_t i, std::int32_t j) {
    const auto at = std::ranges::lower_bound(squares.open, Square{i, j});
    return at != squares.open.end() && at->i == i && at->j == j ? &*at : nullptr;
}

Squares find_squares(const Plane2 &plane, Evaluator &evaluator) {
    constexpr int tile_levels = 4; // of a tile, which has a tape of its own
    FlatBoxes boxes(plane, evaluator);
    Squares squares;
    struct Tile {
        TapePtr tape;
        std::vector<Square> cells; // of one level
    };
    std::vector<Tile> tiles{{plane.field.whole, {{0, 0}}}};
    for (int level = 1; level <= plane.lattice.level; ++level) {
        const std::int32_t width = plane.lattice.cells(level);
        const bool apart = level + tile_levels <= plane.lattice.level;
        const auto place = [&](std::size_t which, std::int32_t n) {
            return plane.lattice.at(which == 0 ? plane.a : plane.b, n * width);
        };
        std::vector<Tile> below;
        for (Tile &tile : tiles) {
            std::vector<Square> open;
            for (std::size_t begin = 0; begin < tile.cells.size();) {
                std::vector<Square> parts;
                for (; begin < tile.cells.size() && parts.size() + 4 <= FlatBoxes::at_once; ++begin)
                    for (int k = 0; k < 4; ++k)
                        parts.push_back(
                            {2 * tile.cells[begin].i + k % 2, 2 * tile.cells[begin].j + k / 2});
                const auto rectangle = [&](const Square &s) {
                    return Rectangle{{place(0, s.i), place(1, s.j)},
                                     {place(0, s.i + 1), place(1, s.j + 1)}};
                };
                for (std::size_t k = 0; k < parts.size(); ++k) boxes.put(k, rectangle(parts[k]));
                boxes.run(parts.size(), *tile.tape);
                std::uint64_t apart_in = 0; // of the first eight
                for (std::size_t k = 0; k < parts.size(); ++k) {
                    if (boxes.space(k, rectangle(parts[k]), squares.solid) != Space::Open) continue;
                    if (apart)
                        apart_in |= std::uint64_t{1} << k;
                    else
                        open.push_back(parts[k]);
                }
                if (apart_in == 0) continue;
                const auto tapes = shortened(evaluator, tile.tape, apart_in);
                for (std::size_t k = 0; k < parts.size(); ++k)
                    if (tapes[k]) below.push_back({tapes[k], {parts[k]}});
            }
            if (!apart && !open.empty()) below.push_back({tile.tape, std::move(open)});
        }
        tiles = std::move(below);
    }
    for (const Tile &tile : tiles) {
        for (Square square : tile.cells) {
            square.tile = static_cast<std::int32_t>(squares.tapes.size());
            squares.open.push_back(square);
        }
        squares.tapes.push_back(tile.tape);
    }
    std::ranges::sort(squares.open);
    sign_corners(plane, squares, evaluator);
    return squares;
}

Ways find_ways(const Plane2 &plane, const Squares &squares, Evaluator &evaluator) {
    Ways ways;
    std::map<EdgeKey, std::int32_t> numbers;
    join(squares, numbers, ways);
    std::vector<bool> reached(ways.crossings.size(), false);
    for (const Crossing2 &c : ways.crossings)
        if (c.next != none) reached[static_cast<std::size_t>(c.next)] = true;
    for (std::size_t k = 0; k < ways.crossings.size(); ++k) {
        const Crossing2 &c = ways.crossings[k];
        if (c.next != none && reached[k]) continue;
        ways.torn = true; // a square beside this edge was left out, although its corners differ
        ways.torn_at = {plane.place(0, c.i), plane.place(1, c.j)};
        return ways;
    }
    if (ways.crossings.empty()) return ways;
    find_roots(plane, ways, evaluator);
    find_corners(plane, squares, ways, evaluator);
    return ways;
}

} // namespace fathom::mesh
