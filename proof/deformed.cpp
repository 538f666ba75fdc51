// With f the field as it was, g its gradient at q, and n >= |g|, the deformed field's gradient is,
// up to a turn,
//   twist about a by rate k:   g - k m e_a,              m = (q x g)_a
//   bend about a by rate k:    g + k m e,                e a unit vector across a
//   taper by c(q_a):           (g across a, c g_a + c'(f - g.q across a))
// So no angle and no quotient has to be followed: intervals for q, f and g are all that is needed,
// and what the products of a composed expression would lose (c' stands twice in a taper, and
// cancels) is kept.
#include "proof/deformed.h"

#include "ir/maps.h"
#include "proof/question.h"

#include <algorithm>
#include <cmath>
#include <queue>

namespace fathom::proof {

using ir::MapKind;
using ir::rounding::infinity;
using ir::rounding::up;

namespace {

// The cross-section's factor and its slope for heights in `y` (ir::taper_factor).
struct Section {
    Interval factor, slope;
};
Section section(const Deformation &d, const Interval &y) {
    const Interval length = d.to - d.from;
    Interval t = (y - d.from) / length;
    t = {std::clamp(t.lo, 0.0, 1.0), std::clamp(t.hi, 0.0, 1.0)};
    Interval factor = Interval(1) + (d.ratio - Interval(1)) * t;
    const Interval slope = (d.ratio - Interval(1)) / length;
    const bool between = y.lo > d.from.hi && y.hi < d.to.lo && factor.lo > ir::min_taper;
    const bool beyond = y.hi < d.from.lo || y.lo > d.to.hi;
    factor = {std::max(factor.lo, ir::min_taper), std::max(factor.hi, ir::min_taper)};
    return {factor, beyond ? Interval(0) : between ? slope : hull(slope, Interval(0))};
}

// The largest |(w, c t + e)| for w^2 + t^2 <= n^2, t in `along`. In t it is a parabola, for every
// c and e; the largest lies at an extreme of each.
double longest(double n, const Interval &along, const Interval &c, const Interval &e) {
    const double lo = std::max(along.lo, -n), hi = std::min(along.hi, n);
    double most = 0;
    for (double by : {c.lo, c.hi})
        for (double add : {e.lo, e.hi}) {
            const auto at = [&](double t) {
                return n * n - t * t + (by * t + add) * (by * t + add);
            };
            most = std::max({most, at(lo), at(hi)});
            if (by * by < 1)
                most = std::max(most, at(std::clamp(by * add / (1 - by * by), lo, hi)));
        }
    return up(std::sqrt(most), 16);
}

double slope_in(Machine &machine, const Deformation &d, const Cell &q) {
    machine.run(q);
    const double n = machine.norm();
    if (!std::isfinite(n)) return infinity;
    Row g = machine.row(0);
    for (Interval &part : g) part = meet(Interval(-n, n), part);
    const auto a = std::size_t(d.axis), u = (a + 1) % 3, v = (a + 2) % 3;
    const double box = sqrt(square(g[u]) + square(g[v])).hi;
    const double least = g[a].mignitude();
    const double across = std::min(box, up(std::sqrt(std::max(n * n - least * least, 0.0)), 4));
    if (d.map == MapKind::Bend) {
        const double add = (d.rate * (q.p[u] * g[v] - q.p[v] * g[u])).magnitude();
        const double most = std::min(n, sqrt(square(g[a]) + square(Interval(across))).hi);
        return up(std::sqrt(most * most + 2 * across * add + add * add), 16);
    }
    Interval by = 1, add;
    if (d.map == MapKind::Twist) {
        add = d.rate * (q.p[v] * g[u] - q.p[u] * g[v]); // turned back (ir/maps.h)
    } else {
        const Section here = section(d, q.p[a]);
        by = here.factor;
        add = here.slope * (machine.value(0) - (g[u] * q.p[u] + g[v] * q.p[v]));
    }
    if (!add.finite()) return infinity;
    const double boxed = (sqrt(square(Interval(across)) + square(by * g[a] + add))).hi;
    return std::min(boxed, longest(n, g[a], by, add));
}

// The points that the box's points come from lie in here.
Cell preimage(const Deformation &d, double &radius) {
    Cell q = d.box;
    const auto a = std::size_t(d.axis), u = (a + 1) % 3, v = (a + 2) % 3;
    if (d.map == MapKind::Taper) {
        const Interval sizes = section(d, q.p[a]).factor;
        q.p[u] = q.p[u] / sizes, q.p[v] = q.p[v] / sizes;
        return q;
    }
    radius = up(std::hypot(q.p[u].magnitude(), q.p[v].magnitude()), 4);
    q.p[u] = q.p[v] = {-radius, radius};
    return q;
}

bool misses(const Deformation &d, double radius, const Cell &q) {
    const auto a = std::size_t(d.axis), u = (a + 1) % 3, v = (a + 2) % 3;
    if (d.map != MapKind::Taper)
        return std::hypot(q.p[u].mignitude(), q.p[v].mignitude()) > radius * (1 + 1e-12);
    const Interval size = section(d, q.p[a]).factor;
    for (std::size_t i : {u, v}) {
        const Interval p = q.p[i] * size;
        if (p.lo > d.box.p[i].hi || p.hi < d.box.p[i].lo) return true;
    }
    return false;
}

struct Undivided {
    double bound;
    std::uint32_t at;
    bool operator<(const Undivided &other) const { return bound < other.bound; }
};

FieldBound search_deformed(Flattening &context, const Ranges &ranges, NodeId field,
                           const Deformation &d, const Budget &budget) {
    FieldBound out;
    out.lipschitz = infinity;
    const Tape tape = flatten(context, field);
    if (tape.too_large) return out;
    Machine machine(tape, ranges);
    double radius = infinity;
    Cell whole = preimage(d, radius);
    for (const Interval &side : whole.p)
        if (!side.finite()) return out;
    // A taper is as steep on both sides of a mirror plane through its axis.
    if (d.map == MapKind::Taper)
        for (std::size_t i = 0; i < 3; ++i)
            if (int(i) != d.axis && whole.p[i].lo == -whole.p[i].hi &&
                reflected(tape, {i == 0, i == 1, i == 2}) != Reflected::Unknown)
                whole.p[i].lo = 0;

    Dice dice{0xdef0};
    auto sample = [&](const Cell &cell) { // inside, off the planes where kinks like to be
        Cell point;
        for (std::size_t i = 0; i < 3; ++i)
            point.p[i] = cell.p[i].lo + cell.p[i].width() * (0.3 + 0.4 * dice.next());
        if (misses(d, radius, point)) return;
        const double slope = slope_in(machine, d, point);
        if (slope != infinity) out.sampled = std::max(out.sampled, slope * (1 - 1e-9));
    };
    std::priority_queue<Undivided> queue;
    std::vector<Cell> cells;
    auto push = [&](const Cell &cell) {
        if (misses(d, radius, cell)) return;
        queue.push({slope_in(machine, d, cell), std::uint32_t(cells.size())});
        cells.push_back(cell);
    };
    for (int i = 0; i < 16; ++i) sample(whole);
    push(whole);
    double settled = 0; // of cells that cannot be cut any more
    while (!queue.empty()) {
        const Undivided top = queue.top();
        if (top.bound <= std::max(out.sampled * budget.tolerance, settled)) break;
        if (out.sampled > budget.hopeless || machine.work() > budget.instructions) break;
        queue.pop();
        const Cell cell = cells[top.at];
        std::size_t widest = 0;
        double size = 1;
        for (std::size_t i = 0; i < 3; ++i) {
            if (cell.p[i].width() > cell.p[widest].width()) widest = i;
            size = std::max(size, cell.p[i].magnitude());
        }
        if (cell.p[widest].width() <= 1e-7 * size) {
            settled = std::max(settled, top.bound);
            continue;
        }
        sample(cell);
        Cell left = cell, right = cell;
        left.p[widest].hi = right.p[widest].lo = cell.p[widest].middle();
        push(left), push(right);
    }
    out.lipschitz = queue.empty() ? settled : std::max(settled, queue.top().bound);
    out.evaluations = cells.size();
    return out;
}

} // namespace

FieldBound bound_deformed(Flattening &context, const Ranges &ranges, NodeId field,
                          const Deformation &d, const Budget &budget) {
    Question question(context, ranges, field, Wanted::Deformed);
    question.add(static_cast<double>(d.map));
    question.add(static_cast<double>(d.axis));
    for (const Interval &number : {d.rate, d.ratio, d.from, d.to}) question.add(number);
    question.add(d.box);
    question.add(budget);
    return std::move(question).answer([&](Flattening &own, const Ranges &all, NodeId copy) {
        return search_deformed(own, all, copy, d, budget);
    });
}

} // namespace fathom::proof
