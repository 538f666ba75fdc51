#include "mesh/seams.h"

#include <algorithm>
#include <limits>

namespace fathom::mesh {
namespace {

constexpr std::size_t cuts = 8;      // that a slab is cut into
constexpr std::size_t most_open = 3; // at one time: a plane lies in two at most
constexpr double most_thin = 8;      // all gaps together
constexpr int most_cuttings = 24;    // floats cannot tell more cuts of cuts apart

struct Slab {
    std::size_t axis = 0; // which it is at right angles to
    float lo = 0, hi = 0;
};

// Parts of a slab. Round planes, 0 above all, are where things are put: where it lies in the slab it
// is between two of them.
void cut_up(const Slab &slab, std::vector<Slab> &to) {
    float from = slab.lo;
    bool zero = slab.lo < 0 && slab.hi > 0;
    const auto add = [&](float until) {
        if (!(from < until)) return;
        to.push_back({slab.axis, from, until});
        from = until;
    };
    for (std::size_t k = 1; k < cuts; ++k) {
        const double share = double(k) / cuts;
        const auto cut = static_cast<float>(slab.lo + share * (double(slab.hi) - slab.lo));
        if (zero && cut >= 0) add(0), zero = false;
        add(std::min(cut, slab.hi));
    }
    if (zero) add(0);
    add(slab.hi);
}

// Takes those away that are solid.
void leave_open(Evaluator &evaluator, const cpu::ShortTape &tape, cpu::Boxes &boxes,
                const Point &lo, const Point &hi, std::vector<Slab> &slabs) {
    boxes.count = slabs.size();
    for (std::size_t k = 0; k < slabs.size(); ++k) {
        for (std::size_t i = 0; i < 3; ++i) boxes.lo[i][k] = lo[i], boxes.hi[i][k] = hi[i];
        boxes.lo[slabs[k].axis][k] = slabs[k].lo, boxes.hi[slabs[k].axis][k] = slabs[k].hi;
    }
    ranges_over(evaluator, tape, boxes);
    std::vector<Slab> left;
    for (std::size_t k = 0; k < slabs.size(); ++k)
        if (!(evaluator.ranges.result_hi[k] <= 0)) left.push_back(slabs[k]);
    slabs = std::move(left);
}

} // namespace

std::optional<double> seam_in(Evaluator &evaluator, const cpu::ShortTape &tape, cpu::Boxes &boxes,
                              const Point &lo, const Point &hi, double thin) {
    std::vector<Slab> slabs;
    std::array<std::size_t, 3> open{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        cut_up({axis, lo[axis], hi[axis]}, slabs);
        if (!(lo[axis] < hi[axis])) open[axis] = std::numeric_limits<std::size_t>::max();
    }
    leave_open(evaluator, tape, boxes, lo, hi, slabs);
    for (const Slab &slab : slabs) ++open[slab.axis];
    const auto axis =
        static_cast<std::size_t>(std::min_element(open.begin(), open.end()) - open.begin());
    std::erase_if(slabs, [&](const Slab &slab) { return slab.axis != axis; });
    double width = 0;
    for (int round = 0; round < most_cuttings && !slabs.empty(); ++round) {
        if (slabs.size() > most_open) return std::nullopt;
        std::vector<Slab> next;
        for (const Slab &slab : slabs)
            if (double(slab.hi) - slab.lo <= thin)
                width += double(slab.hi) - slab.lo;
            else
                cut_up(slab, next);
        if (width > most_thin * thin) return std::nullopt;
        slabs = std::move(next);
        if (!slabs.empty()) leave_open(evaluator, tape, boxes, lo, hi, slabs);
    }
    return slabs.empty() ? std::optional(width) : std::nullopt;
}

} // namespace fathom::mesh
