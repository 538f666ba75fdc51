#include "mesh/shape_area.h"

#include <algorithm>
#include <cmath>

namespace fathom::mesh {

SteadyBox steady_box(const Linear &linear, const Real3 &along, double least) {
    constexpr double rounding = 1 + 1e-9;
    double across = 0, sideways = 0,
           spread = 0; // of the mean slope, and of what may be added to it
    for (std::size_t i = 0; i < 3; ++i) across += linear.slope[i] * along[i];
    for (std::size_t i = 0; i < 3; ++i) {
        sideways += std::pow(linear.slope[i] - across * along[i], 2);
        spread += std::pow(linear.spread[i], 2);
    }
    const double beside = (std::sqrt(sideways) + std::sqrt(spread)) / least;
    SteadyBox made{linear, {along, rounding * std::sqrt(1 + beside * beside)}};
    const std::optional<Slant> mean = slant_of(linear);
    if (mean && mean->most < made.slant.most) made.slant = *mean;
    return made;
}

double whole_of(const Block &box) {
    double volume = 1;
    for (std::size_t i = 0; i < 3; ++i) volume *= double(box.hi[i]) - box.lo[i];
    return volume;
}

void ShapeSums::add(const ShapeSums &other) {
    area.lo += other.area.lo, area.hi += other.area.hi;
    volume.lo += other.volume.lo, volume.hi += other.volume.hi;
    whole += other.whole, looks += other.looks;
}

namespace {

// Across an edge the surface may lie along the direction, all but: what its sheets have together is less.
Enclosure area_by_sheets(Splitter &splitter, const cpu::ShortTape &tape, const Block &part) {
    const auto &[lo, hi] = part;
    const Border border = border_over(splitter.evaluator, tape, splitter.boxes, lo, hi);
    Enclosure area{0, unbounded};
    if (border.linear)
        if (const std::optional<Slant> slant = slant_of(*border.linear)) {
            Graph graph{lo, hi, {}};
            graph.add_open(lo, hi, *border.linear);
            area = graph.area(*slant);
        }
    if (!border.zeros.known) return area;
    double sheets = 0;
    for (const Linear &sheet : border.zeros.sheets) sheets += area_of_sheet(lo, hi, sheet).hi;
    return {area.lo, std::min(area.hi, sheets)};
}

} // namespace

ShapeSums sums_in_parts(Splitter &splitter, const cpu::ShortTape &tape, const SteadyBox &box,
                        std::span<const Block> parts, bool closely) {
    Points middles;
    for (const Block &part : parts) middles.add(middle_point(part.lo, part.hi));
    std::vector<float> values;
    values_at(splitter.evaluator, tape, middles, values);
    ShapeSums sums;
    for (std::size_t k = 0; k < parts.size(); ++k) {
        const auto &[lo, hi] = parts[k];
        Linear linear = box.linear;
        linear.value = values[k];
        linear.off = linear.rounding;
        const double volume = whole_of(parts[k]);
        for (std::size_t i = 0; i < 3; ++i) {
            const double at = middles[k][i], reach = std::max(hi[i] - at, at - lo[i]);
            linear.off += linear.spread[i] * reach * (1 + 1e-9);
        }
        Graph graph{lo, hi, {}};
        graph.add_open(lo, hi, linear);
        constexpr double poor = 6; // faces of a cube
        Enclosure area = graph.area(box.slant);
        const Enclosure share = share_of(lo, hi, linear);
        const bool looks = closely && area.hi > poor * std::cbrt(volume * volume);
        if (looks) {
            const Enclosure other = area_by_sheets(splitter, tape, parts[k]);
            area = {std::max(area.lo, other.lo), std::min(area.hi, other.hi)};
        }
        sums.add({area, {share.lo * volume, share.hi * volume}, volume, looks});
    }
    return sums;
}

} // namespace fathom::mesh
