// One rule an op: the value's interval, and how far single precision may be from it.
#include "proof/rounding_rule.h"

namespace fathom::proof {

// Long: a case for each op.
Rounded RoundingRule::component(int c) {
    const auto of = [&](int a) -> const Rounded & { return arg(a, c); };
    switch (node.op) {
    case Op::Const: {
        const double x = graph.constant_of(id).value[static_cast<std::size_t>(c)];
        return {x, 0, std::isinf(x) || to_single(x) == x ? 0 : unit_roundoff, true, {}};
    }
    case Op::Time: return {machine.time_, 0, 0, true, {}};
    case Op::Param:
        return {machine.params_[node.payload][static_cast<std::size_t>(c)], 0, 0, true, {}};
    case Op::Var: return machine.vars_[node.payload][static_cast<std::size_t>(c)];
    case Op::Neg: {
        Rounded r = of(0);
        r.value = -r.value;
        for (double &g : r.gradient) g = -g;
        r.root_error = infinity;
        return r;
    }
    case Op::Add:
    case Op::Sub: return sum(of(0), of(1), node.op == Op::Add ? 1 : -1, whole());
    case Op::Mul: return product(of(0), of(1), whole());
    case Op::Div:
        if (!whole()) {
            Rounded r = quotient(of(0), of(1));
            if (std::isinf(r.error) && never_negative(graph.arg(id, 1)))
                r.above = std::max(0.0, widened(of(0)).lo) / widened(of(1)).hi * (1 - 1e-6);
            return r;
        }
        return made(of(1).value.contains(0) ? hull(0.0, hull(of(0).value, -of(0).value))
                                            : trunc(of(0).value / of(1).value),
                    0);
    case Op::Mod: {
        const Rounded &x = of(0), &m = of(1);
        if (whole() || (m.value == Interval(0.0) && total(m) == 0))
            return made(hull(hull(m.value, -m.value), x.value), 0);
        const Interval range{std::min(m.value.lo, 0.0), std::max(m.value.hi, 0.0)};
        // The turns are exact, and the rest is rounded once.
        if (power_of_two(m) && total(x) == 0)
            return made(range, unit_roundoff * m.value.magnitude());
        const Rounded turns = quotient(x, m);
        const Interval times_m = floor(widened(turns));
        if (!times_m.is_point()) decide(total(turns), turns);
        const double size = times_m.magnitude();
        return made(range, total(x) + times(size, total(m)) + 3 * rounded_by(x.value, total(x)) +
                               3 * unit_roundoff * m.value.magnitude());
    }
    case Op::Pow: return power(of(0), of(1));
    case Op::Min: return extremum(of(0), of(1), -1);
    case Op::Max: return extremum(of(0), of(1), 1);
    case Op::Union:
    case Op::Intersection: {
        Rounded r = arg(0);
        for (int a = 1; a < count(); ++a)
            r = extremum(r, arg(a), node.op == Op::Intersection ? 1 : -1);
        return r;
    }
    case Op::Clamp: return extremum(extremum(of(0), of(1), 1), of(2), -1);
    case Op::Blend: { // (r, n, a, b, …): within r of the least, a mean of them; beyond, the least
        const double r = arg(0).value.magnitude(), steps = count() - 3;
        const bool columns = static_cast<ir::Profile>(node.payload) == ir::Profile::Columns;
        Rounded out_value = bent(arg(2).value, 0);
        for (int a = 2; a < count(); ++a) {
            const Rounded &x = arg(a);
            out_value.value = min(out_value.value, x.value);
            double &e = out_value.error;
            e = columns ? std::hypot(e, x.error) : std::max(e, x.error);
            out_value.relative = std::max(out_value.relative, x.relative);
        }
        out_value.value.lo -= r * steps;
        out_value.error += total(arg(0)) + (32 * unit_roundoff * steps + out_value.relative) * r;
        out_value.relative += 2 * unit_roundoff * steps;
        return out_value;
    }
    case Op::Step: {
        const Rounded way = sum(of(1), of(0), -1, true);
        return stepped(way, [](Interval x) { return Interval(x.lo >= 0, x.hi >= 0); });
    }
    case Op::Sign:
        return stepped(of(0), [](Interval x) {
            return Interval((x.lo > 0) - (x.lo < 0), (x.hi > 0) - (x.hi < 0));
        });
    case Op::Floor: return stepped(of(0), [](Interval x) { return floor(x); });
    case Op::Ceil: return stepped(of(0), [](Interval x) { return ceil(x); });
    case Op::Trunc:
    case Op::ToInt: return stepped(of(0), [](Interval x) { return trunc(x); });
    case Op::Round:
        return stepped(sum(of(0), {0.5, 0, 0, true, {}}, 1, false),
                       [](Interval x) { return floor(x); });
    case Op::Fract: { // its value follows the evaluator's decision
        const Rounded whole_part = stepped(of(0), [](Interval x) { return floor(x); });
        Rounded r = sum(of(0), whole_part, -1, true);
        r.value = meet(r.value, {0, 1});
        return r;
    }
    case Op::Atan2: {
        const Interval y = widened(of(0)), x = widened(of(1));
        const double e = std::hypot(total(of(0)), total(of(1)));
        const double r = std::hypot(x.mignitude(), y.mignitude());
        if (x.lo <= 0 && y.contains(0)) decide(total(of(0)), of(0));
        Interval v(-3.1415926535897936, 3.1415926535897936);
        if (x.lo > 0 || !y.contains(0)) {
            double lo = v.hi, hi = v.lo;
            for (const double p : {y.lo, y.hi})
                for (const double q : {x.lo, x.hi})
                    lo = std::min(lo, std::atan2(p, q)), hi = std::max(hi, std::atan2(p, q));
            v = ir::outward(lo, hi, ir::rounding::library);
        }
        Rounded angle = made(v, std::min(e == 0 ? 0 : 1.6 * e / r, 6.3) + 32 * unit_roundoff);
        const double slope = std::min(slope_of(of(0)), slope_of(of(1)));
        angle.reach = std::hypot(of(0).value.magnitude(), of(1).value.magnitude()) / slope;
        angle.off = 1.6 * e / slope + 32 * unit_roundoff * angle.reach;
        return angle;
    }
    case Op::Abs: {
        Rounded r = of(0);
        if (r.value.hi <= 0)
            for (double &g : r.gradient) g = -g;
        else if (r.value.lo < 0)
            r.linear = still(r);
        r.value = abs(r.value);
        return r;
    }
#define FATHOM_FUNCTION(name, function, ...)                                                       \
    case Op::name:                                                                                 \
        return smooth(of(0), ir::function(of(0).value), ir::slope::function(widened(of(0))));
#include "ir/ops.def"
    case Op::Mix: {
        const Rounded one{1, 0, 0, true, {}};
        Rounded r = sum(product(of(0), sum(one, of(2), -1, false), false),
                        product(of(1), of(2), false), 1, false);
        const Interval t = of(2).value, gap = of(1).value - of(0).value;
        if (t.lo >= 0 && t.hi <= 1) {
            const double size = std::max(of(0).value.magnitude(), of(1).value.magnitude());
            r.value = meet(hull(of(0).value, of(1).value), r.value);
            const double e = std::max(total(of(0)), total(of(1))) +
                             times(gap.magnitude() + 2 * total(of(1)), total(of(2))) +
                             6 * unit_roundoff * size + smallest_normal;
            if (!(total(r) <= e)) r.error = e, r.relative = 0;
        }
        return r;
    }
    case Op::Smoothstep: {
        const Rounded width = sum(of(1), of(0), -1, false), way = sum(of(2), of(0), -1, false),
                      part = quotient(way, width);
        return made({0, 1}, std::min(1.0, 1.5 * total(part) + 8 * unit_roundoff));
    }
    case Op::Dot: return dot(0, 1);
    case Op::Length: return length();
    case Op::Less:
    case Op::LessEqual:
    case Op::Equal:
    case Op::NotEqual: return compare();
    case Op::And: return made(min(arg(0).value, arg(1).value), 0);
    case Op::Or: return made(max(arg(0).value, arg(1).value), 0);
    case Op::Not: return made({1 - arg(0).value.hi, 1 - arg(0).value.lo}, 0);
    case Op::Select: {
        const Interval which = arg(0).value;
        if (which.lo > 0.5) return of(1);
        if (which.hi < 0.5) return of(2);
        Rounded r = bent(hull(of(1).value, of(2).value), std::max(of(1).error, of(2).error));
        r.relative = std::max(of(1).relative, of(2).relative);
        r.linear = still(of(1)) && still(of(2)) && still(arg(0));
        r.root_error = std::max(of(1).root_error, of(2).root_error);
        r.root_relative = std::max(of(1).root_relative, of(2).root_relative);
        return r;
    }
    case Op::ToFloat: return made(arg(0).value, arg(0).value.magnitude() > 0x1p24 ? 128 : 0);
    case Op::Splat: return arg(0);
    case Op::Swizzle: return args[0][ir::swizzle_component(node.payload, c)];
    case Op::TableRead: return table_read(c);
    case Op::Hash: return made({0, 1}, 0); // of whole numbers, which are exact
    case Op::Perlin:
        return noise(ir::sem::perlin_slope, ir::sem::perlin_range, -ir::sem::perlin_range);
    case Op::Simplex:
        return noise(ir::sem::simplex_slope, ir::sem::simplex_range, -ir::sem::simplex_range);
    case Op::ValueNoise: return noise(ir::sem::value_noise_slope, 1, 0);
    case Op::Worley: return noise(ir::sem::worley_slope, 1, 0);
    case Op::SpotNoise: {
        const double radius = std::max(arg(1).value.lo, 1e-6),
                     density = std::clamp(arg(2).value.hi, 0.0, double(ir::sem::spot_maximum)),
                     range = ir::sem::spot_range * std::ceil(density);
        return noise(ir::sem::spot_slope * std::ceil(density) / radius, range, -range);
    }
    case Op::Image:
    case Op::Grid: {
        const Ranges::Sampled data = machine.sampled(node.op, node.payload);
        Rounded r = noise(data.slope, data.values.magnitude(), 0);
        r.value = data.values;
        return r;
    }
    case Op::FillPaint:
    case Op::HitDistance:
    case Op::MakeHit: return arg(0); // of a hit its distance alone is followed
    case Op::HitWith: return arg(1);
    case Op::NearestHit:
    case Op::FarthestHit: {
        Rounded r = arg(0);
        for (int a = 1; a < count(); ++a)
            r = extremum(r, arg(a), node.op == Op::FarthestHit ? 1 : -1);
        return r;
    }
    case Op::Point: // those of functions are variables
    case Op::Normal:
    case Op::Direction:
    case Op::HitPaint:
    case Op::HitPoint:
    case Op::HitExtra: return bent(Interval::everything(), 0);
    case Op::Cross:
    case Op::Normalize:
    case Op::MatMul:
    case Op::Make:
    case Op::Column:
    case Op::Transpose: // of all components together: run
    case Op::Call:
    case Op::Loop:
    case Op::LoopResult:
    case Op::Cached: break; // rounding_machine.cpp
    }
    return unknown();
}

void RoundingRule::run() {
    if (overflows()) {
        for (int c = 0; c < n; ++c) out[c] = unknown();
        return;
    }
    if (node.op == Op::Normalize) return normalize();
    if (node.op == Op::MatMul) return multiply_matrices();
    if (node.op == Op::Cross) return cross();
    if (node.op == Op::Transpose) {
        const int side = ir::side(node.type);
        for (int i = 0; i < n; ++i) out[i] = args[0][(i % side) * side + i / side];
        return;
    }
    if (node.op == Op::Column) {
        for (int c = 0; c < n; ++c) out[c] = args[0][int(node.payload) * n + c];
        return;
    }
    if (node.op == Op::Make) {
        int c = 0;
        for (int a = 0; a < count(); ++a)
            for (int k = 0; k < sizes[static_cast<std::size_t>(a)]; ++k)
                out[c++] = args[static_cast<std::size_t>(a)][k];
        return;
    }
    for (int c = 0; c < n; ++c) out[c] = component(c);
}

void RoundingMachine::run_step(Plan &plan, const Step &step) {
    std::array<const Rounded *, 8> few{};
    std::vector<const Rounded *> many;
    const std::size_t count = step.args.size();
    if (count > few.size()) many.resize(count);
    const Rounded **args = count > few.size() ? many.data() : few.data();
    for (std::size_t a = 0; a < count; ++a) args[a] = &plan.frame[step.args[a]];
    const ir::Graph &graph = scene_.graph;
    RoundingRule rule{
        *this, graph, step.id, graph[step.id], {args, count}, step.sizes, &plan.frame[step.out],
        step.n};
    rule.run();
    // A number that is the same for all points is what evaluators make of it: the field is proved
    // for all of them.
    for (int c = 0; c < step.n; ++c) {
        Rounded &x = plan.frame[step.out + static_cast<std::uint32_t>(c)];
        if (!still(x) || !std::isfinite(total(x))) continue;
        x.error = x.relative = 0;
        if (x.value.lo >= 0) x.root_error = x.root_relative = 0;
        if (x.value.is_point()) x.value = to_single(x.value.lo);
    }
}

} // namespace fathom::proof
