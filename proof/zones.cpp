// Regions: their boxes, what of them a cell holds, what of them is the same when shifted or turned.
#include "proof/zones.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace fathom::proof {

Cell outer_box(const Zone &zone) {
    Cell cell;
    switch (zone.kind) {
    case ir::RegionKind::Everywhere: break;
    case ir::RegionKind::Ball:
        for (std::size_t i = 0; i < 3; ++i)
            cell.p[i] = zone.center[i] + Interval(-zone.half[0].hi, zone.half[0].hi);
        break;
    case ir::RegionKind::Box:
        for (std::size_t i = 0; i < 3; ++i)
            cell.p[i] = zone.center[i] + Interval(-zone.half[i].hi, zone.half[i].hi);
        break;
    case ir::RegionKind::Tube:
        for (std::size_t i = 0; i < 3; ++i)
            if (int(i) != zone.axis) cell.p[i] = Interval(-zone.half[0].hi, zone.half[0].hi);
        break;
    }
    return cell;
}

namespace {

Interval distance_squared(const Zone &zone, const Cell &cell) {
    Interval sum;
    for (std::size_t i = 0; i < 3; ++i)
        if (zone.kind != ir::RegionKind::Tube || int(i) != zone.axis)
            sum +=
                square(zone.kind == ir::RegionKind::Tube ? cell.p[i] : cell.p[i] - zone.center[i]);
    return sum;
}
bool inside(const Zone &zone, const Cell &cell) { // certainly all of the cell
    switch (zone.kind) {
    case ir::RegionKind::Everywhere: return true;
    case ir::RegionKind::Ball:
    case ir::RegionKind::Tube:
        return distance_squared(zone, cell).hi < zone.half[0].lo * zone.half[0].lo * (1 - 1e-12);
    case ir::RegionKind::Box:
        for (std::size_t i = 0; i < 3; ++i)
            if ((cell.p[i] - zone.center[i]).magnitude() >= zone.half[i].lo) return false;
        return true;
    }
    return false;
}

} // namespace

bool misses(const Zone &zone, const Cell &cell) {
    switch (zone.kind) {
    case ir::RegionKind::Everywhere: break;
    case ir::RegionKind::Ball:
    case ir::RegionKind::Tube:
        if (distance_squared(zone, cell).lo > zone.half[0].hi * zone.half[0].hi * (1 + 1e-12))
            return true;
        break;
    case ir::RegionKind::Box:
        for (std::size_t i = 0; i < 3; ++i)
            if ((cell.p[i] - zone.center[i]).mignitude() > zone.half[i].hi) return true;
        break;
    }
    return std::any_of(zone.less.begin(), zone.less.end(),
                       [&](const Zone &z) { return inside(z, cell); });
}

std::optional<Zone> zone_along(const Zone &zone, const std::array<bool, 3> &shifted) {
    const auto stays = [&](const Zone &tube) {
        if (tube.kind != ir::RegionKind::Tube) return false;
        for (std::size_t i = 0; i < 3; ++i)
            if (shifted[i] && int(i) != tube.axis) return false;
        return true;
    };
    const auto tube_about = [&](int axis) -> std::optional<Zone> {
        for (std::size_t i = 0; i < 3; ++i)
            if (shifted[i] != (int(i) == axis) ||
                (!shifted[i] && !(zone.center[i] == Interval(0.0))))
                return {};
        Zone tube;
        tube.kind = ir::RegionKind::Tube;
        tube.half = zone.half;
        tube.axis = axis;
        return tube;
    };
    Zone out;
    if (stays(zone)) out = zone;
    for (int axis = 0; axis < 3 && zone.kind == ir::RegionKind::Ball; ++axis)
        if (const auto tube = tube_about(axis)) out = *tube;
    out.less.clear();
    std::ranges::copy_if(zone.less, std::back_inserter(out.less), stays);
    if (out.kind == ir::RegionKind::Everywhere && out.less.empty()) return {};
    return out;
}

Distances distances_of(const Zone &zone) {
    constexpr double slack = 1e-12; // as in `misses`
    Distances out;
    const auto keep = [&](const Zone &round, bool inside) {
        const bool is_ball = round.kind == ir::RegionKind::Ball;
        if (!is_ball && round.kind != ir::RegionKind::Tube) return;
        for (const Interval &x : round.center)
            if (is_ball && !(x == Interval(0.0))) return;
        if (inside) {
            const double most = round.half[0].hi * (1 + slack);
            for (std::size_t i = 0; i < 3; ++i)
                if (is_ball || int(i) == round.axis)
                    out.from_axis[i].hi = std::min(out.from_axis[i].hi, most);
            if (is_ball) out.from_origin.hi = most;
        } else {
            const double least = round.half[0].lo * (1 - slack);
            Interval &of = is_ball ? out.from_origin : out.from_axis[std::size_t(round.axis)];
            of.lo = std::max(of.lo, least);
        }
    };
    keep(zone, true);
    for (const Zone &hole : zone.less) keep(hole, false);
    return out;
}

std::optional<Zone> turned_about(const Domain &domain, int axis) {
    const std::size_t along = std::size_t(axis), u = (along + 1) % 3, v = (along + 2) % 3;
    const auto is_same = [&](const Zone &zone) {
        return zone.kind == ir::RegionKind::Tube
                   ? zone.axis == axis
                   : zone.kind == ir::RegionKind::Ball && zone.center[u] == Interval(0.0) &&
                         zone.center[v] == Interval(0.0);
    };
    Zone out;
    if (domain.zone && is_same(*domain.zone)) {
        out = *domain.zone;
    } else {
        const Interval across = square(Interval(domain.box.p[u].magnitude())) +
                                square(Interval(domain.box.p[v].magnitude()));
        out.kind = ir::RegionKind::Tube;
        out.axis = axis;
        out.half[0] = sqrt(across).hi;
        if (!out.half[0].finite()) return {};
    }
    if (domain.zone) {
        out.less.clear();
        std::ranges::copy_if(domain.zone->less, std::back_inserter(out.less), is_same);
    }
    return out;
}

} // namespace fathom::proof
