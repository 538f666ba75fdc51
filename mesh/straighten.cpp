// Contours from the ways of the border: vertices are left out where the contour may as well go
// straight on.
#include "mesh/squares.h"

#include <algorithm>
#include <cmath>

namespace fathom::mesh {
namespace {

// How far a contour may pass from a place where the border crosses an edge, of a square's side.
constexpr double passing = 1.0 / 256;
constexpr double least_margin = 1e-9; // of a side, to the ends of edges that a chord crosses
constexpr std::size_t longest_run = 4096;

struct Way { // a vertex on a contour's way
    Flat at{};
    bool kept = false;    // a corner, or beside a square with two pieces of border
    bool upright = false; // of an edge that may be crossed elsewhere: between low and high
    double low = 0, high = 0;
    std::int32_t square = none; // that lies behind it
};

std::vector<Way> way_of(const Plane2 &plane, const Squares &squares, const Ways &ways,
                        std::int32_t first, std::vector<bool> &seen) {
    std::vector<Way> way;
    const double side = plane.side();
    const auto alone = [&](std::int32_t square) {
        return squares.open[static_cast<std::size_t>(square)].alone();
    };
    std::int32_t before = none;
    for (std::int32_t k = first; !seen[static_cast<std::size_t>(k)];) {
        const Crossing2 &c = ways.crossings[static_cast<std::size_t>(k)];
        seen[static_cast<std::size_t>(k)] = true;
        const double at = c.vertex[c.upright], low = plane.place(c.upright, c.upright ? c.j : c.i),
                     high = plane.place(c.upright, (c.upright ? c.j : c.i) + 1);
        Way point{c.vertex,
                  !alone(c.through) || before == none || !alone(before),
                  c.upright,
                  std::max(at - passing * side, low + least_margin * side),
                  std::min(at + passing * side, high - least_margin * side),
                  c.through};
        way.push_back(point);
        if (const Corner &corner = ways.corners[static_cast<std::size_t>(k)]; corner.there)
            way.push_back({corner.at, true, false, 0, 0, c.through});
        before = c.through;
        k = c.next;
    }
    return way;
}

double turn(const std::array<double, 2> &a, const std::array<double, 2> &b) {
    return a[0] * b[1] - a[1] * b[0];
}

// From a kept vertex: the farthest one that is seen through all edges between.
std::size_t farthest_seen(const std::vector<Way> &way, std::size_t from) {
    const Flat &eye = way[from].at;
    const auto towards = [&](double x, double y) {
        return std::array<double, 2>{x - eye[0], y - eye[1]};
    };
    std::array<double, 2> right{}, left{}; // all of what is seen lies between
    bool open = false;
    std::size_t seen = from + 1;
    for (std::size_t k = from + 1; k < way.size() && k < from + longest_run; ++k) {
        const Way &w = way[k];
        const std::array<double, 2> d = towards(w.at[0], w.at[1]);
        if (!open ||
            (turn(right, d) > 0 && turn(d, left) > 0 && right[0] * d[0] + right[1] * d[1] > 0))
            seen = k;
        if (w.kept) break;
        std::array<double, 2> p = w.upright ? towards(w.at[0], w.low) : towards(w.low, w.at[1]),
                              q = w.upright ? towards(w.at[0], w.high) : towards(w.high, w.at[1]);
        if (turn(p, q) < 0) std::swap(p, q);
        if (!(turn(p, q) > 0)) break; // the edge is seen from its own line
        if (!open) {
            right = p, left = q, open = true;
        } else {
            if (turn(right, p) > 0) right = p;
            if (turn(q, left) > 0) left = q;
            if (!(turn(right, left) > 0)) break;
        }
    }
    return seen;
}

} // namespace

Lines straightened(const Plane2 &plane, const Squares &squares, const Ways &ways) {
    Lines lines;
    std::vector<bool> seen(ways.crossings.size(), false);
    for (std::size_t k = 0; k < ways.crossings.size(); ++k) {
        if (seen[k]) continue;
        std::vector<Way> way = way_of(plane, squares, ways, static_cast<std::int32_t>(k), seen);
        // It begins where a vertex is kept, if there is one, and ends there again.
        const auto kept = std::ranges::find_if(way, [](const Way &w) { return w.kept; });
        if (kept != way.end()) std::rotate(way.begin(), kept, way.end());
        way[0].kept = true;
        way.push_back(way[0]);
        std::vector<Flat> contour;
        std::vector<std::size_t> stops{0};
        while (stops.back() + 1 < way.size()) stops.push_back(farthest_seen(way, stops.back()));
        // Fewer than three vertices bound nothing: then all of them stay.
        if (stops.size() < 4) {
            stops.clear();
            for (std::size_t n = 0; n < way.size(); ++n) stops.push_back(n);
        }
        for (std::size_t n = 0; n + 1 < stops.size(); ++n) {
            Chord chord{way[stops[n]].at, way[stops[n + 1]].at, {}};
            for (std::size_t m = stops[n]; m < stops[n + 1]; ++m)
                if (chord.squares.empty() || chord.squares.back() != way[m].square)
                    chord.squares.push_back(way[m].square);
            contour.push_back(chord.from);
            lines.chords.push_back(std::move(chord));
        }
        lines.contours.push_back(std::move(contour));
    }
    return lines;
}

} // namespace fathom::mesh
