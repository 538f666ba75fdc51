// What is read: the point, params, tables, noise, images. Proofs: docs/lipschitz.md, 2.
#include "ir/noise.h"
#include "ir/passes/fold.h"
#include "proof/instruction_rules.h"

#include <algorithm>
#include <cmath>

namespace fathom::proof {

using ir::rounding::infinity;
using ir::rounding::times;
using ir::rounding::up;

void Step::constant() {
    const ir::Constant &k = machine.ranges_.scene->graph.constant_of(in.node);
    for (int c = 0; c < n; ++c) set(c, k.value[static_cast<std::size_t>(c)], none);
    finish(0, false);
}

void Step::point() {
    for (int c = 0; c < n; ++c) {
        Row g{};
        g[static_cast<std::size_t>(c)] = 1.0;
        set(c, machine.cell_.p[static_cast<std::size_t>(c)], g);
    }
    finish(1, false);
}

void Step::unit_vector() {
    for (int c = 0; c < n; ++c) set(c, {-1, 1}, none);
    finish(0, false);
}

void Step::time() {
    set(0, machine.ranges_.time, none);
    return finish(0, false);
}

void Step::param() {
    for (int c = 0; c < n; ++c)
        set(c, machine.ranges_.params[in.payload][static_cast<std::size_t>(c)], none);
    finish(0, false);
}

void Step::variable() {
    auto found = machine.ranges_.vars.find(in.payload);
    for (int c = 0; c < n; ++c)
        set(c,
            found == machine.ranges_.vars.end() ? Interval::everything()
                                                : found->second[static_cast<std::size_t>(c)],
            none);
    finish(0, false);
}

void Step::table_read() {
    const ir::Table &table = machine.ranges_.scene->graph.table(ir::table_of(in.payload));
    int column = ir::column_of(in.payload);
    Interval row = value(0, 0);
    int last = std::max(table.rows - 1, 0);
    int from = int(std::clamp(row.lo, 0.0, double(last))),
        to = int(std::clamp(row.hi, 0.0, double(last)));
    for (int c = 0; c < n; ++c) {
        Interval v{infinity, -infinity};
        for (int r = from; r <= to; ++r)
            v = hull(v, Interval(double(
                            table.data[static_cast<std::size_t>(r * table.stride + column + c)])));
        set(c, v, none);
    }
    if (norm(0) > 0 && from != to) return fail(Trouble::Jump);
    finish(0, any_odd);
}

// The value itself of what is else known by its range alone.
void Step::read() {
    constexpr ir::OpSet ranged{Op::Hash,       Op::Perlin, Op::Simplex,
                               Op::ValueNoise, Op::Worley, Op::SpotNoise};
    if (!ranged[in.op]) return;
    const ir::Graph &graph = machine.ranges_.scene->graph;
    std::vector<ir::Constant> args;
    for (int a = 0; a < int(in.args.size()); ++a) {
        args.push_back({graph[graph.arg(in.node, a)].type, {}});
        for (int c = 0; c < size(a); ++c)
            args.back().value[static_cast<std::size_t>(c)] = value(a, c).middle();
    }
    if (const auto made = ir::evaluate_single(in.op, in.type, args, in.payload))
        machine.value_[at] = made->value[0];
}

// A hash of a loop's number is known in each turn: single precision has it exactly.
Interval Step::hash_of_turn() const {
    constexpr double exact_below = 0x1p24;
    const ir::Graph &graph = machine.ranges_.scene->graph;
    ir::Constant whole{graph[graph.arg(in.node, 0)].type, {}};
    for (int c = 0; c < size(0); ++c) {
        const Interval v = value(0, c);
        const double only = std::round(v.middle());
        if (!(v.lo > only - 1 && v.hi < only + 1 && std::fabs(only) < exact_below)) return {0, 1};
        whole.value[static_cast<std::size_t>(c)] = only;
    }
    const auto made = ir::evaluate_single(in.op, in.type, {&whole, 1}, in.payload);
    return made ? Interval(made->value[0]) : Interval(0, 1);
}

void Step::hash() {
    bool fixed = true;
    for (int c = 0; c < size(0); ++c)
        fixed = fixed && zero(grad(0, c)) && (!in.wavers || value(0, c).is_point());
    set(0, in.whole ? hash_of_turn() : Interval(0, 1), none);
    if (!fixed || norm(0) > 0) return fail(Trouble::Jump);
    finish(0, any_odd);
}

void Step::perlin() {
    set(0, {-ir::sem::perlin_range, ir::sem::perlin_range}, through(ir::sem::perlin_slope, 0));
    finish(times(ir::sem::perlin_slope, norm(0)), any_odd);
}

void Step::simplex() {
    set(0, {-ir::sem::simplex_range, ir::sem::simplex_range}, through(ir::sem::simplex_slope, 0));
    finish(times(ir::sem::simplex_slope, norm(0)), any_odd);
}

void Step::value_noise() {
    set(0, {0, 1}, through(ir::sem::value_noise_slope, 0));
    finish(times(ir::sem::value_noise_slope, norm(0)), any_odd);
}

void Step::worley() {
    set(0, {0, 1}, through(ir::sem::worley_slope, 0));
    finish(times(ir::sem::worley_slope, norm(0)), any_odd);
}

void Step::spot_noise() {
    double radius = std::max(value(1, 0).lo, 1e-6),
           density = std::clamp(value(2, 0).hi, 0.0, double(ir::sem::spot_maximum));
    double spots = std::ceil(density),
           scale = std::sqrt(std::max(std::clamp(value(2, 0).lo, 0.0, 8.0), 1.0));
    double slope = up(ir::sem::spot_slope * spots / (radius * scale), 8),
           range = up(ir::sem::spot_range * spots / scale, 8);
    set(0, {-range, range}, through(slope, 0));
    if (norm(1) > 0 || norm(2) > 0) return fail(Trouble::Jump);
    finish(times(slope, norm(0)), any_odd);
}

void Step::sampled() {
    const auto &all = in.op == Op::Image ? machine.ranges_.images : machine.ranges_.grids;
    Ranges::Sampled data = in.payload < all.size()
                               ? all[in.payload]
                               : Ranges::Sampled{Interval::everything(), infinity};
    for (int c = 0; c < n; ++c) set(c, data.values, through(data.slope, 0));
    finish(up(times(data.slope * std::sqrt(double(n)), norm(0)), 4), any_odd);
}

// only where it may be kept
void Step::cached() {
    const Ranges::Cached &kept = machine.ranges_.caches[in.payload];
    for (int c = 0; c < n; ++c)
        set(c, kept.values[static_cast<std::size_t>(c)], through(kept.slope, 0));
    finish(times(kept.slope, norm(0)), any_odd);
}

} // namespace fathom::proof
