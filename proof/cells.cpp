// Bounds of a field that is steep in places, cell by cell (semantics.md, 13): a slope of 1,000 in a
// corner of its region does not slow the surface down.
#include "proof/field.h"

#include <algorithm>
#include <cmath>

namespace fathom::proof {

using ir::rounding::infinity;

namespace {

constexpr int fewest = 4, finest = 16; // cells along the longest side
constexpr double lead = 0.25;          // the margin, in the smallest side of a cell
constexpr double flattest = 1e-6;      // of the bound for all of the region

} // namespace

ir::CellBounds bound_cells(Flattening &context, const Ranges &ranges, NodeId field,
                           const Zone &zone, double whole, const Budget &budget) {
    ir::CellBounds out;
    const Cell box = outer_box(zone);
    double longest = 0, shortest = infinity;
    for (const Interval &side : box.p) {
        if (!side.finite() || !(side.width() > 0)) return out;
        longest = std::max(longest, side.width());
    }
    const Tape tape = flatten(context, field);
    if (tape.too_large) return out;
    Machine machine(tape, ranges, true);
    // Where it is everywhere about as steep, one bound says as much.
    std::vector<double> slopes;
    Dice dice{0xce11};
    for (int i = 0; i < 64; ++i) {
        Cell point;
        for (std::size_t a = 0; a < 3; ++a)
            point.p[a] = box.p[a].lo + box.p[a].width() * dice.next();
        if (misses(zone, point)) continue;
        machine.run(point);
        slopes.push_back(machine.norm());
    }
    if (slopes.empty()) return out;
    std::nth_element(slopes.begin(), slopes.begin() + std::ptrdiff_t(slopes.size() / 2),
                     slopes.end());
    if (slopes[slopes.size() / 2] * 3 > whole) return out;

    // As many cells as the budget has evaluations for.
    const double most =
        double(budget.instructions) / double(std::max<std::size_t>(tape.length(), 1));
    const double along = std::clamp(std::floor(std::cbrt(most)), double(fewest), double(finest));
    std::array<double, 3> size{};
    for (std::size_t i = 0; i < 3; ++i) {
        const double width = box.p[i].width();
        out.box.lo[i] = box.p[i].lo, out.box.hi[i] = box.p[i].hi;
        out.count[i] = std::max(int(std::lround(along * width / longest)), 1);
        size[i] = width / out.count[i];
        shortest = std::min(shortest, size[i]);
    }
    out.margin = lead * shortest;
    const double grown = out.margin * 1.001; // what float32 makes of the cell's number and walls
    const auto [nx, ny, nz] = out.count;
    out.lipschitz.assign(std::size_t(nx + 1) * std::size_t(ny + 1) * std::size_t(nz + 1), 0);
    out.bend = out.lipschitz;
    bool bends_known = false;
    for (int z = 0; z < nz; ++z)
        for (int y = 0; y < ny; ++y)
            for (int x = 0; x < nx; ++x) {
                const std::array<int, 3> at{x, y, z};
                Cell cell;
                for (std::size_t i = 0; i < 3; ++i)
                    cell.p[i] = {
                        std::max(out.box.lo[i] + at[i] * size[i] - grown, out.box.lo[i]),
                        std::min(out.box.lo[i] + (at[i] + 1) * size[i] + grown, out.box.hi[i])};
                if (misses(zone, cell)) continue;
                machine.run(cell);
                const double bound = std::min(machine.norm(), whole) * (1 + 1e-6),
                             bend = machine.bend() * (1 + 1e-4); // float32 in the root
                bends_known = bends_known || std::isfinite(bend);
                for (int corner = 0; corner < 8; ++corner) {
                    const int row = (z + corner / 4) * (ny + 1) + y + corner / 2 % 2;
                    const auto there = std::size_t(row * (nx + 1) + x + corner % 2);
                    out.lipschitz[there] = std::max(out.lipschitz[there], bound);
                    out.bend[there] = std::max(out.bend[there], bend);
                }
            }
    // Not near 0: where a field is flat, steps end with the cell.
    for (double &bound : out.lipschitz) bound = std::max(bound, flattest * whole);
    for (double &bend : out.bend) bend = std::max(bend, flattest * whole / shortest);
    if (!bends_known) out.bend.clear();
    return out;
}

} // namespace fathom::proof
