#include "mesh/squares.h"

#include <algorithm>
#include <cmath>

namespace fathom::mesh {
namespace {

// From the lattice's axes to those of who looks at the plane (section.h).
Flat seen(const Flat &p, std::size_t axis) {
    return axis == 2 ? p : axis == 1 ? Flat{p[0], -p[1]} : Flat{-p[1], p[0]};
}
// The lattice's axes: of axis 0 y and z, so that a turn by a quarter gives (-z, y).
std::array<std::size_t, 2> axes_of(std::size_t axis) {
    return axis == 2   ? std::array<std::size_t, 2>{0, 1}
           : axis == 1 ? std::array<std::size_t, 2>{0, 2}
                       : std::array<std::size_t, 2>{1, 2};
}
Rectangle seen(const Rectangle &r, std::size_t axis) {
    const Flat p = seen(r.lo, axis), q = seen(r.hi, axis);
    return {{std::min(p[0], q[0]), std::min(p[1], q[1])},
            {std::max(p[0], q[0]), std::max(p[1], q[1])}};
}

Section section_of(const Cut &cut, std::size_t axis, float at, double side) {
    Section made;
    const std::optional<Lattice> lattice = make_lattice(cut.box, side, 0);
    if (!lattice) {
        made.failure = Failure::TooFine;
        return made;
    }
    const auto [a, b] = axes_of(axis);
    const Plane2 plane{cut.field, *lattice, a, b, axis, at};
    Evaluator evaluator(cut.field);
    const Squares squares = find_squares(plane, evaluator);
    const Ways ways = find_ways(plane, squares, evaluator);
    if (ways.torn) {
        made.failure = Failure::Contradicted;
        made.place = plane.point(ways.torn_at[0], ways.torn_at[1]);
        return made;
    }
    Lines lines = straightened(plane, squares, ways);
    made.side = plane.side();
    made.used_bound = cut.field.proved;
    certify(plane, squares, ways, lines, evaluator, made);
    made.contours = std::move(lines.contours);
    // (x, -z) is a reflection of (x, z), (-z, y) a turn of (y, z).
    for (std::vector<Flat> &contour : made.contours) {
        for (Flat &p : contour) p = seen(p, axis);
        if (axis == 1) std::ranges::reverse(contour);
    }
    for (Rectangle &r : made.undecided) r = seen(r, axis);
    return made;
}

} // namespace

Cut::Cut(const ir::Scene &scene, const Settings &settings, const ir::Box &solid_box)
    : field(scene, settings.time, settings.bounds), box(solid_box) {
    double longest = 0;
    for (std::size_t i = 0; i < 3; ++i) longest = std::max(longest, box.hi[i] - box.lo[i]);
    side = settings.side > 0 ? settings.side : longest / std::max(settings.resolution, 1);
}

Section section(const Cut &cut, std::size_t axis, float at) {
    Section best = section_of(cut, axis, at, cut.side);
    // Smaller squares help where few are undecided: along a thin wall, not over a face that lies in
    // the plane.
    double longest = 0;
    for (std::size_t i = 0; i < 3; ++i) longest = std::max(longest, cut.box.hi[i] - cut.box.lo[i]);
    const auto few = [&] {
        return static_cast<double>(best.undecided.size()) < 8 * longest / best.side;
    };
    for (int k = 1; k <= cut.halvings && best.failure == Failure::None && !best.undecided.empty();
         ++k) {
        if (!few()) break;
        Section finer = section_of(cut, axis, at, std::ldexp(cut.side, -k));
        if (finer.failure == Failure::TooFine) break;
        best = std::move(finer);
    }
    return best;
}

Rectangle outline_of(const ir::Box &box, std::size_t axis) {
    const auto [a, b] = axes_of(axis);
    const Rectangle r{{static_cast<float>(box.lo[a]), static_cast<float>(box.lo[b])},
                      {static_cast<float>(box.hi[a]), static_cast<float>(box.hi[b])}};
    return seen(r, axis);
}

} // namespace fathom::mesh
