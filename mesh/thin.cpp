#include "mesh/thin.h"

#include "mesh/grid.h"

#include <algorithm>
#include <cmath>

namespace fathom::mesh {
namespace {

constexpr int look_steps = 128;    // samples of a look, less one
constexpr int most_looks = 7;      // each 8 times closer than the one before
constexpr double closer = 1.0 / 8; // … at where the field was nearest to 0
constexpr int sharp = 8;           // steps: what is that thick is measured well enough
constexpr double near_zero = 4;    // steps: a field that is farther from 0 does not come to it
constexpr double farthest = 1.25;  // sides: no look ends so far from its place

// Holds where all looks from a place are.
TapePtr tape_about(Evaluator &evaluator, const Lattice &lattice, double side, const Point &at) {
    Point lo{}, hi{};
    const double far = farthest * side + 4 * lattice.ulp;
    for (std::size_t i = 0; i < 3; ++i) {
        lo[i] = static_cast<float>(at[i] - far);
        hi[i] = static_cast<float>(at[i] + far);
    }
    cpu::Boxes boxes;
    return tape_in(evaluator, boxes, evaluator.field.whole, lo, hi);
}

} // namespace

Thin thin_at(Evaluator &evaluator, const Lattice &lattice, double side, const Point &at) {
    const TapePtr shorter = tape_about(evaluator, lattice, side, at);
    const cpu::ShortTape &tape = *shorter;
    Points points;
    points.add(at);
    std::array<std::vector<float>, 4> slope;
    gradients_at(evaluator, tape, points, slope);
    Real3 way{slope[1][0], slope[2][0], slope[3][0]};
    const double rate = std::sqrt(inner(way, way));
    if (!(rate > 0 && std::isfinite(rate))) return {};
    for (double &x : way) x /= rate;
    double middle = 0, step = 2 * side / look_steps, thickness = 0; // as far as it is known
    bool gap = false;
    std::vector<float> values;
    for (int look = 0; look < most_looks && step > 4 * lattice.ulp; ++look, step *= closer) {
        points.clear();
        for (int k = -look_steps / 2; k <= look_steps / 2; ++k) {
            const Real3 p = along(real(at), way, middle + k * step);
            points.add(
                {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
        }
        values_at(evaluator, tape, points, values);
        int thinnest = 0, thin_from = 0, from = -1, nearest = 0; // between two changes of sign
        for (int k = 0; k <= look_steps; ++k) {
            const auto j = static_cast<std::size_t>(k);
            if (std::fabs(values[j]) < std::fabs(values[static_cast<std::size_t>(nearest)]))
                nearest = k;
            if (k == 0 || (values[j] <= 0) == (values[j - 1] <= 0)) continue;
            if (from >= 0 && (thinnest == 0 || k - from < thinnest)) {
                thinnest = k - from, thin_from = from;
                gap = values[j - 1] > 0;
            }
            from = k;
        }
        if (thinnest > 0) thickness = thinnest * step;
        if (thinnest >= sharp) break;
        if (thinnest == 0) {
            if (thickness > 0) break;
            if (from >= 0) return {}; // surface that is seen
            if (std::fabs(values[static_cast<std::size_t>(nearest)]) > near_zero * step * rate)
                return {};
        }
        middle += ((thinnest > 0 ? thin_from : nearest) - look_steps / 2) * step;
    }
    return {thickness, gap && thickness > 0, thickness == 0};
}

std::vector<Thin> thin_in(const Field &field, const Lattice &lattice, std::span<const Cell> cells,
                          unsigned threads, Progress &progress, std::size_t most) {
    const std::size_t count = std::min(cells.size(), most);
    std::vector<Thin> found(count);
    in_parallel(
        count, threads, progress, [&] { return Evaluator(field); },
        [&](Evaluator &evaluator, std::size_t k) {
            const Cell &cell = cells[k * cells.size() / count];
            const std::int32_t side = lattice.cells(cell.level);
            Point middle{};
            for (std::size_t i = 0; i < 3; ++i)
                middle[i] = 0.5f * (lattice.at(i, cell.at[i]) + lattice.at(i, cell.at[i] + side));
            found[k] = thin_at(evaluator, lattice, lattice.side(lattice.level), middle);
        });
    return found;
}

bool thinner_in(const Field &field, const Octree &octree, std::span<const Cell> cells,
                std::size_t few, double showing, unsigned threads, Progress &progress) {
    if (cells.size() < few || octree.settled == octree.lattice.level) return false;
    const double finest = octree.lattice.side(octree.settled);
    std::size_t vain = 0, seen = 0;
    for (const Thin &thin : thin_in(field, octree.lattice, cells, threads, progress)) {
        seen += thin.touches || thin.thickness > 0;
        vain += thin.touches || (thin.thickness > 0 && thin.thickness < showing * finest);
    }
    return 2 * seen > most_places && 4 * vain > 3 * seen;
}

} // namespace fathom::mesh
