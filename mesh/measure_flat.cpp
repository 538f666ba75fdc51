#include "mesh/measure_flat.h"

#include "mesh/section_files.h"
#include "mesh/walk.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fathom::mesh {
namespace {

// The squares of a level that may hold border, below one that does.
void find_open(Splitter &splitter, OpenBlock open, int levels, const Walk &walk, CellSums &sums,
               std::vector<OpenBlock> &found) {
    constexpr int levels_of_tape = 3;
    if (levels == 0) {
        found.push_back(std::move(open));
        return;
    }
    if (levels % levels_of_tape == 0) open.tape = tape_in(splitter, open.tape, open.piece);
    for (const Block &part : divided(splitter, *open.tape, {open.piece}, walk, sums))
        find_open(splitter, {part, open.tape}, levels - 1, walk, sums, found);
}

} // namespace

FlatMeasures measure_flat(const Cut &cut, double thick, unsigned threads, Progress &progress,
                          const MeasureEffort &effort) {
    FlatMeasures measures;
    ir::Box box = cut.box;
    box.lo[2] = box.hi[2] = 0;
    const std::optional<Lattice> lattice = make_lattice(box, cut.side, 0);
    if (!lattice) {
        measures.failure = Failure::TooFine;
        return measures;
    }
    // As thick as a part of a square, so that little is lost by boxes' diagonals.
    const double part = std::min(thick, lattice->side(lattice->level) / 16);
    const auto half = static_cast<float>(std::exp2(std::floor(std::log2(part))));
    const std::int32_t end = lattice->cells(0);
    const Block whole{{lattice->at(0, 0), lattice->at(1, 0), -half},
                      {lattice->at(0, end), lattice->at(1, end), half}};
    Walk walk;
    walk.middle = {0.5 * (box.lo[0] + box.hi[0]), 0.5 * (box.lo[1] + box.hi[1]), 0};
    walk.ulp = lattice->ulp;
    walk.thin = seam_thickness(*lattice);
    walk.flat = true;
    Splitter splitter(cut.field);
    CellSums sums;
    std::vector<OpenBlock> open;
    find_open(splitter, {whole, cut.field.whole}, lattice->level, walk, sums, open);
    sums.add(sums_of_open(cut.field, open, walk, threads, progress, effort));

    // Of a solid that is so thick.
    const Measures all = measures_of(sums, walk.middle);
    const double thickness = 2.0 * half;
    measures.used_bound = cut.field.proved;
    measures.area = {all.volume.lo / thickness, all.volume.hi / thickness};
    // No drawing of that area has a shorter border than a disc.
    const double disc = 2 * std::sqrt(std::numbers::pi * measures.area.lo) * (1 - rounding_share);
    measures.perimeter = {std::max(all.area.lo / thickness, disc), all.area.hi / thickness};
    measures.open_places = all.open_places;
    for (std::size_t i = 0; i < 2; ++i) {
        measures.open_place[i] = all.open_place[i];
        measures.center[i] = all.center[i];
        measures.least[i] = all.least[i];
        measures.greatest[i] = all.greatest[i];
    }
    return measures;
}

ContourSums sums_of(const Contours &contours) {
    ContourSums sums;
    if (contours.empty()) return sums;
    const Flat &origin = contours[0][0]; // so that nothing is lost far from the scene's
    sums.box = {origin, origin};
    std::array<double, 2> moment{};
    for (const std::vector<Flat> &contour : contours) {
        double area = 0;
        for (std::size_t k = 0; k < contour.size(); ++k) {
            const Flat &a = contour[k], &b = contour[(k + 1) % contour.size()];
            const std::array<double, 2> p{double(a[0]) - origin[0], double(a[1]) - origin[1]},
                q{double(b[0]) - origin[0], double(b[1]) - origin[1]};
            const double part = 0.5 * (p[0] * q[1] - p[1] * q[0]);
            area += part;
            sums.perimeter += std::hypot(q[0] - p[0], q[1] - p[1]);
            for (std::size_t i = 0; i < 2; ++i) {
                moment[i] += part * (p[i] + q[i]) / 3;
                sums.box.lo[i] = std::min(sums.box.lo[i], a[i]);
                sums.box.hi[i] = std::max(sums.box.hi[i], a[i]);
            }
        }
        sums.area += area;
        ++(area < 0 ? sums.holes : sums.outlines);
    }
    for (std::size_t i = 0; i < 2; ++i)
        sums.center[i] = origin[i] + (sums.area != 0 ? moment[i] / sums.area : 0);
    return sums;
}

} // namespace fathom::mesh
