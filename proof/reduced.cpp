#include "proof/reduced.h"

#include <cmath>

namespace fathom::proof {

std::array<bool, 3> to_one_period(const Periods &periods, Cell &whole) {
    std::array<bool, 3> shifted{};
    for (std::size_t i = 0; i < 3; ++i) {
        const double period = periods.period[i];
        if (periods.reads[i] && period > 0 && whole.p[i].width() > period) {
            whole.p[i] = Interval(-period / 2, period / 2 * (1 + 1e-9));
            shifted[i] = true;
        }
        if (!periods.reads[i] && !whole.p[i].finite()) whole.p[i] = 0.0;
    }
    return shifted;
}

void to_domain(const Periods &periods, const std::array<bool, 3> &shifted, const Cell &domain,
               FieldBound &found) {
    for (std::size_t i = 0; i < 3; ++i) {
        const double at = found.where[i], period = periods.period[i];
        if (!shifted[i] || domain.p[i].contains(at)) continue;
        const double turns = at < domain.p[i].lo ? std::ceil((domain.p[i].lo - at) / period)
                                                 : std::floor((domain.p[i].hi - at) / period);
        for (auto *point : {&found.where, &found.side_a, &found.side_b})
            (*point)[i] += turns * period;
    }
}

bool keep_half(const Tape &tape, Cell &whole, const Zone *zone) {
    auto centred = [&](std::size_t i) {
        if (zone && (!zone->less.empty() || zone->kind == ir::RegionKind::Everywhere ||
                     (zone->kind != ir::RegionKind::Tube && !(zone->center[i] == Interval(0.0)))))
            return false;
        // Of a period the upper end lies a little further out.
        return whole.p[i].lo < 0 && -whole.p[i].lo <= whole.p[i].hi;
    };
    bool halved = false, negated = false;
    auto try_axes = [&](const std::array<bool, 3> &axes, std::size_t cut) {
        const Reflected how = reflected(tape, axes);
        if (how == Reflected::Unknown) return;
        whole.p[cut].lo = 0;
        halved = true;
        negated = negated || how == Reflected::Negated;
    };
    for (std::size_t i = 0; i < 3; ++i)
        if (centred(i)) try_axes({i == 0, i == 1, i == 2}, i);
    if (!halved && centred(0) && centred(1) && centred(2)) try_axes({true, true, true}, 0);
    return negated;
}

} // namespace fathom::proof
