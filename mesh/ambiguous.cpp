#include "mesh/ambiguous.h"

#include <algorithm>

namespace fathom::mesh {
namespace {

// Whether the corners of a cell's face have two signs by turns: those without the axis' bit, moved to
// the face. The first and the second of each diagonal.
struct FaceCorners {
    std::array<int, 2> even{}, odd{};
    FaceCorners(std::size_t axis, bool high) {
        const int at = high ? 1 << axis : 0, b = 1 << (axis + 1) % 3, c = 1 << (axis + 2) % 3;
        even = {at, at | b | c}, odd = {at | b, at | c};
    }
    bool by_turns(std::uint8_t signs) const {
        const auto is = [&](int corner) { return signs >> corner & 1; };
        return is(even[0]) == is(even[1]) && is(odd[0]) == is(odd[1]) && is(even[0]) != is(odd[0]);
    }
};

// The ends of an edge that is the cell's own, as numbers of its corners.
std::optional<std::array<int, 2>> ends_in(const Lattice &lattice, const Cell &cell,
                                          const Crossing &crossing) {
    const std::int32_t side = lattice.cells(cell.level);
    if (crossing.length != side) return std::nullopt;
    int low = 0;
    for (std::size_t i = 0; i < 3; ++i) low |= (crossing.low[i] != cell.at[i]) << i;
    return std::array{low, low | 1 << crossing.axis};
}

using Ends = std::vector<std::array<int, 2>>;
std::optional<Ends> ends_of(const Lattice &lattice, const Loops &loops, const Patch &patch) {
    Ends all;
    for (std::uint32_t k = patch.first; k < patch.first + patch.count; ++k) {
        const auto ends = ends_in(lattice, patch.cell,
                                  loops.crossings[static_cast<std::size_t>(loops.members[k])]);
        if (!ends) return std::nullopt;
        all.push_back(*ends);
    }
    return all;
}

// Whether the insides of edges are all above a plane, or with sign -1 below.
bool all_beyond(const Across &plane, int sign, const Ends &edges) {
    return std::ranges::all_of(edges, [&](const std::array<int, 2> &ends) {
        std::array<double, 2> height{};
        for (std::size_t k = 0; k < 2; ++k)
            height[k] = sign * plane.height({double(ends[k] & 1), double(ends[k] >> 1 & 1),
                                             double(ends[k] >> 2 & 1)});
        return height[0] >= 0 && height[1] >= 0 && height[0] + height[1] > 0;
    });
}

} // namespace

void join_corners(Evaluator &evaluator, const cpu::ShortTape &tape, const Lattice &lattice,
                  const std::vector<Cell> &cells, std::vector<Node> &nodes) {
    constexpr int parts = 8;
    struct Asked {
        std::int32_t node;
        std::size_t axis;
        bool high, even_solid;
    };
    std::vector<Asked> asked;
    Points points;
    for (const Cell &cell : cells) {
        const std::uint8_t signs = nodes[static_cast<std::size_t>(cell.node)].signs;
        if (signs == 0 || signs == 0xff) continue;
        const std::int32_t side = lattice.cells(cell.level);
        const Point lo = point_of(lattice, cell.at),
                    hi = point_of(lattice, corner(cell.at, side, 7));
        for (std::size_t face = 0; face < 6; ++face) {
            const std::size_t axis = face / 2;
            const FaceCorners corners(axis, face % 2);
            if (!corners.by_turns(signs)) continue;
            asked.push_back({cell.node, axis, face % 2 != 0, (signs >> corners.even[0] & 1) != 0});
            for (const std::array<int, 2> &diagonal : {corners.even, corners.odd})
                for (int k = 1; k < parts; ++k) {
                    Point at{};
                    for (std::size_t i = 0; i < 3; ++i) {
                        const int from = diagonal[0] >> i & 1, to = diagonal[1] >> i & 1;
                        const int share = parts * from + k * (to - from);
                        at[i] = lo[i] + (hi[i] - lo[i]) * (static_cast<float>(share) / parts);
                    }
                    points.add(at);
                }
        }
    }
    if (asked.empty()) return;
    std::vector<float> values;
    values_at(evaluator, tape, points, values);
    constexpr std::size_t samples = parts - 1;
    for (std::size_t n = 0; n < asked.size(); ++n) {
        const auto all = [&](bool odd, bool solid) {
            const std::size_t first = (2 * n + odd) * samples;
            for (std::size_t k = first; k < first + samples; ++k)
                if ((values[k] <= 0) != solid) return false;
            return true;
        };
        const auto bit = static_cast<unsigned>(2 * asked[n].axis + asked[n].high);
        const bool joined = all(!asked[n].even_solid, true),
                   apart = all(asked[n].even_solid, false);
        std::uint16_t &faces = nodes[static_cast<std::size_t>(asked[n].node)].faces;
        if (joined != apart)
            faces = static_cast<std::uint16_t>(faces | unsigned(joined) << bit);
        else
            faces = static_cast<std::uint16_t>(faces | 1u << (6 + bit));
    }
}

std::optional<Across> plane_between(const Lattice &lattice, const Loops &loops, const Patch &x,
                                    const Patch &y) {
    const std::optional<Ends> above = ends_of(lattice, loops, x),
                              below = ends_of(lattice, loops, y);
    if (!above || !below) return std::nullopt;
    for (int k = 0; k < 27; ++k) {
        Across plane{{k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1}, 0};
        if (k == 13) continue; // no direction
        for (plane.offset = -2.5; plane.offset <= 2.5; plane.offset += 0.5)
            if (all_beyond(plane, 1, *above) && all_beyond(plane, -1, *below)) return plane;
    }
    return std::nullopt;
}

bool share_face(const Loops &loops, const Patch &x, const Patch &y) {
    const auto faces_of = [&](const Patch &patch) {
        std::uint32_t faces = 0;
        for (std::uint32_t k = patch.first; k < patch.first + patch.count; ++k) {
            const Crossing &crossing = loops.crossings[static_cast<std::size_t>(loops.members[k])];
            for (std::size_t i = 0; i < 3; ++i)
                if (i != crossing.axis)
                    faces |= 1u << (2 * i + (crossing.low[i] != patch.cell.at[i]));
        }
        return faces;
    };
    return (faces_of(x) & faces_of(y)) != 0;
}

} // namespace fathom::mesh
