// The instructions of sums, products, quotients, vectors and choices: the forms that they are, what
// they are turned from, and the pieces that they are affine in.
#include "proof/flattener.h"

#include "proof/around.h"
#include "proof/continuity.h"
#include "proof/field.h"
#include "proof/forms.h"
#include "proof/guarded.h"
#include "proof/interpolation.h"
#include "proof/linear_maps.h"
#include "proof/majorants.h"
#include "proof/means.h"
#include "proof/polar.h"
#include "proof/radial.h"
#include "proof/segments.h"
#include "proof/smooth.h"

#include <algorithm>

namespace fathom::proof {

std::vector<NodeId> Flattener::by_vector(std::vector<NodeId> parts) {
    std::vector<NodeId> out;
    while (!parts.empty()) {
        const NodeId first = parts.front();
        const NodeId vector = graph[first].op == Op::Swizzle ? graph.arg(first, 0) : NodeId();
        std::vector<int> own;
        std::erase_if(parts, [&](NodeId part) {
            if (part != first &&
                (!vector || graph[part].op != Op::Swizzle || graph.arg(part, 0) != vector))
                return false;
            if (vector) own.push_back(ir::swizzle_component(graph[part].payload, 0));
            return true;
        });
        out.push_back(own.size() > 1 ? graph.swizzle(vector, own) : first);
    }
    for (std::size_t i = 0; i < out.size(); ++i) // m cos(b) and m sin(b)
        for (std::size_t k = i + 1; k < out.size(); ++k) {
            if (graph[out[i]].op != Op::Mul || graph[out[k]].op != Op::Mul) continue;
            const NodeId both = graph.make(Op::Make, ir::Type::Vec2, {out[i], out[k]});
            if (!is_polar_vector(graph, both)) continue;
            out[i] = both;
            out.erase(out.begin() + std::ptrdiff_t(k));
            break;
        }
    return out;
}

std::optional<Pieces> Flattener::pieces_of(NodeId id, const std::vector<NodeId> &of) {
    const auto [known, fresh] = context.pieces.try_emplace(id);
    if (fresh) {
        const int before = steps_of_pieces;
        known->second = by_pieces(graph, of, steps_of_pieces);
        context.work.take(std::size_t(steps_of_pieces - before));
    }
    return known->second;
}

Slot Flattener::emit_by_pieces(Scope &scope, NodeId id, Instruction out,
                               const std::vector<NodeId> &of) {
    if (out.op == Op::MatMul) return emit(scope, std::move(out)); // whose norm is the matrix'
    const auto found = pieces_of(id, of);
    if (!found) return emit(scope, std::move(out));
    const Pieces &pieces = *found;
    NodeId base = pieces.parts[0];
    if (pieces.parts.size() > 1)
        base = graph.make(Op::Make, ir::vector_type(int(pieces.parts.size())),
                          by_vector(pieces.parts));
    if (base != out.node) {
        out.norm = pieces.norm;
        out.turned = {slot(scope, base)};
    }
    return emit(scope, std::move(out));
}

Slot Flattener::emit_turned(Scope &scope, NodeId id, Instruction out) {
    if (const auto way = moved_along(graph, id)) {
        out.norm = way->norm;
        out.turned = {slot(scope, way->v), slot(scope, way->b)};
        return emit(scope, out);
    }
    const auto may_be = [&](NodeId v) { return varies[slot(scope, v)]; };
    const bool is_matrix = out.op == Op::MatMul; // whose rule has the matrix' norm
    const auto t =
        ir::is_vector(out.type) ? turned(graph, id, may_be, known_linear) : turned_part(graph, id);
    if (!t && is_matrix) return emit(scope, out);
    if (!t) return emit_by_pieces(scope, id, std::move(out), {id});
    bool still = true;
    std::vector<Slot> constants;
    for (NodeId c : t->constants) {
        constants.push_back(slot(scope, c));
        still = still && !varies[constants.back()];
    }
    const bool is_scalar = out.type == ir::Type::Float;
    if (is_scalar && !still && cancelling.empty())
        return emit_by_pieces(scope, id, std::move(out), {id});
    const Slot of = slot(scope, t->of);
    if (t->turning && !is_scalar) out.turning = turning_of(scope, *t);
    const bool may_stand_still = scope.loop || !cancelling.empty(); // as steps do
    if (!still && (!may_stand_still || (!is_matrix && !is_scalar && pieces_of(id, {id}))))
        return emit_by_pieces(scope, id, std::move(out), {id});
    if (!is_matrix) {
        out.norm = t->norm;
        out.turned = {of};
        out.turned.insert(out.turned.end(), constants.begin(), constants.end());
    }
    if (!is_scalar) known_linear.insert(id);
    const Slot made = emit(scope, out);
    if (still && t->whole && supports.is_base(of)) supports.make_base(made);
    return made;
}

Instruction::Turning Flattener::turning_of(Scope &scope, const LinearMap &map) {
    using Way = Instruction::Turning::Way;
    Instruction::Turning out{slot(scope, map.of),
                             slot(scope, map.turning->angle),
                             map.norm,
                             map.turning->norm,
                             map.turning->moving,
                             Way::Any};
    if (supports.apart(out.angle, out.vector, map.turning->columns))
        out.way = Way::Apart;
    else if (map.whole && supports.is_base(out.vector) &&
             supports.apart(out.angle, out.vector, out.moving))
        out.way = Way::Shear;
    return out;
}

bool Flattener::step_cancels(NodeId wave) const {
    bool any = false, all = true;
    const auto meet = [&](NodeId step) { any = true, all = all && cancelling.contains(step); };
    // x - m round(x/m), also held: a factor may be a clamp of the step, and m may be made of steps
    // itself; which of these the wave's is does not matter where all cancel.
    std::vector<NodeId> todo{graph.arg(wave, 1)};
    std::unordered_set<NodeId> seen;
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!seen.insert(id).second) continue;
        if (graph[id].op == Op::Round) meet(id);
        if (graph[id].op == Op::Clamp) todo.push_back(graph.arg(id, 0));
        if (graph[id].op == Op::Mul)
            todo.insert(todo.end(), graph.args(id).begin(), graph.args(id).end());
    }
    if (any) return all;
    return std::ranges::any_of(graph.args(wave), [&](NodeId arg) {
        return (graph[arg].op == Op::Mod || graph[arg].op == Op::Fract) && cancelling.contains(arg);
    });
}

Slot Flattener::sum(Scope &scope, NodeId id, Instruction out) {
    if (const auto parts = wave(graph, id)) {
        out.cancels = out.cancels || step_cancels(id);
        return emit(scope, out, Form::Wave, {parts->x, parts->m});
    }
    if (const auto parts = held_wave(graph, id)) {
        out.cancels = out.cancels || step_cancels(id);
        return emit(scope, out, Form::HeldWave, {parts->x, parts->m, parts->lo, parts->hi});
    }
    if (const auto scaled = scaled_wave(graph, id); scaled && *scaled != id)
        return slot(scope, *scaled);
    if (const auto smooth = smooth_extremum(graph, id);
        smooth && !varies[slot(scope, smooth->k)] && !varies[slot(scope, smooth->divisor)]) {
        out.payload =
            (smooth->greater ? 1u : 0u) + (smooth->divides ? 2u : 0u) + (smooth->clipped ? 4u : 0u);
        return emit(scope, out, Form::Smooth, {smooth->x, smooth->y, smooth->k});
    }
    if (const auto logs = log_sum(graph, id)) {
        out.op = logs->log;
        return emit(scope, out, Form::LogSum, {logs->a, logs->b});
    }
    if (ir::is_vector(out.type)) {
        for (NodeId a : args_of(id)) out.args.push_back(slot(scope, a));
        return emit_turned(scope, id, std::move(out));
    }
    if (const auto edge = round_edge(graph, id); edge && *edge != id) return slot(scope, *edge);
    if (const auto v = corner(graph, id)) return emit(scope, out, Form::Corner, {*v});
    for (NodeId a : args_of(id)) out.args.push_back(slot(scope, a));
    if (out.type != ir::Type::Float) return emit(scope, std::move(out));
    find_mean(scope, id, out);
    find_interpolation(scope, id, out);
    find_beside_turn(scope, id, out);
    return emit_turned(scope, id, std::move(out));
}

Slot Flattener::mix(Scope &scope, NodeId id, Instruction out) {
    if (out.type == ir::Type::Float) {
        find_mean(scope, id, out);
        find_interpolation(scope, id, out);
    }
    return emit_plain(scope, id, std::move(out));
}

void Flattener::find_interpolation(Scope &scope, NodeId id, Instruction &out) {
    if (cancelling.empty()) return; // it jumps
    const auto found = interpolation(graph, id, context.weights, context.work);
    if (!found) return;
    const std::vector<NodeId> parts = by_vector(found->along);
    const ir::Type type = ir::vector_type(int(found->along.size()));
    Instruction::Between between{0, {}, found->steepness};
    between.vector = slot(scope, parts.size() > 1 ? graph.make(Op::Make, type, parts) : parts[0]);
    for (NodeId corner : found->corners) between.corners.push_back(slot(scope, corner));
    out.between = std::move(between);
}

void Flattener::find_mean(Scope &scope, NodeId id, Instruction &out) {
    if (const auto mean = mean_of(context, id))
        out.mean = {slot(scope, mean->a), slot(scope, mean->b), mean->by_a,
                    mean->by_b,           mean->beyond,         mean->reach};
}

namespace {

// A vector or a number as a polynomial of another, by component.
struct OfOne {
    std::optional<NodeId> x; // none: a number
    std::vector<double> by;
};
std::optional<OfOne> of_one(ir::Graph &graph, NodeId id, int depth = 0) {
    constexpr int max_depth = 10;
    constexpr std::size_t max_powers = 10;
    const ir::Node node = graph[id];
    if (const auto c = number(graph, id)) return OfOne{{}, {*c}};
    constexpr ir::OpSet sums{Op::Add, Op::Sub, Op::Neg};
    const auto itself = [&] { return OfOne{id, {0, 1}}; };
    if (depth > max_depth || (!sums[node.op] && node.op != Op::Mul)) return itself();
    std::vector<OfOne> args;
    for (NodeId a : std::vector<NodeId>(graph.args(id).begin(), graph.args(id).end())) {
        if (graph[a].type != node.type) return itself();
        const auto arg = of_one(graph, a, depth + 1);
        if (!arg) return {};
        args.push_back(*arg);
    }
    OfOne out;
    if (node.op == Op::Neg) {
        out = args[0];
        for (double &c : out.by) c = -c;
        return out;
    }
    if (args[0].x && args[1].x && args[0].x != args[1].x) {
        if (node.op == Op::Mul) return {};
        return itself();
    }
    out.x = args[0].x ? args[0].x : args[1].x;
    const std::size_t n = args[0].by.size(), m = args[1].by.size();
    if (node.op == Op::Mul) {
        if (n + m - 1 > max_powers) return {};
        out.by.assign(n + m - 1, 0);
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t k = 0; k < m; ++k) out.by[i + k] += args[0].by[i] * args[1].by[k];
        return out;
    }
    out.by.assign(std::max(n, m), 0);
    for (std::size_t i = 0; i < n; ++i) out.by[i] += args[0].by[i];
    for (std::size_t i = 0; i < m; ++i) out.by[i] += (node.op == Op::Add ? 1 : -1) * args[1].by[i];
    return out;
}

} // namespace

// f*f*f*(f*(f*6 - 15) + 10): by the rule for products f's parts are any numbers of its range.
void Flattener::find_univariate(Scope &scope, NodeId id, Instruction &out) {
    constexpr std::size_t least_powers = 4; // else the product says as much
    const auto found = of_one(graph, id);
    if (!found || !found->x || *found->x == id || found->by.size() < least_powers) return;
    for (double c : found->by)
        if (!std::isfinite(c)) return;
    out.univariate = {slot(scope, *found->x), found->by};
}

// A product as one of scalars; of mix(a, b, a), a (1 + b - a).
NodeId Flattener::in_scalar_factors(NodeId id, int depth) {
    constexpr int max_depth = 6;
    if (depth > max_depth) return id;
    const ir::Node node = graph[id];
    const auto again = [&](NodeId other) { return in_scalar_factors(other, depth + 1); };
    if (node.op == Op::Mul) return graph.mul(again(graph.arg(id, 0)), again(graph.arg(id, 1)));
    if (node.op == Op::Swizzle && node.type == ir::Type::Float)
        if (const NodeId own = component_of(graph, id, 0); own != id) return again(own);
    if (node.op == Op::Mix && graph.arg(id, 0) == graph.arg(id, 2)) {
        const NodeId a = graph.arg(id, 0), b = graph.arg(id, 1);
        const bool from_1 = graph[a].op == Op::Sub && graph.as_number(graph.arg(a, 0)) == 1.0;
        const NodeId rest =
            from_1 ? graph.add(graph.arg(a, 1), b) : graph.add(graph.number(1), graph.sub(b, a));
        return graph.mul(again(a), rest);
    }
    return id;
}

// An exponent that is not known: k, -k, 1/k or -1/k, as they are written.
Slot Flattener::power(Scope &scope, NodeId id, Instruction out) {
    if (const auto e = graph.as_number(graph.arg(id, 1)); e && *e > 0 && *e < 1) {
        const NodeId base = graph.arg(id, 0), apart = in_scalar_factors(base);
        if (apart != base) return slot(scope, graph.make(Op::Pow, {apart, graph.arg(id, 1)}));
    }
    const auto still = [&](NodeId x) { return !graph.as_number(x) && !varies[slot(scope, x)]; };
    NodeId of = graph.arg(id, 1);
    Instruction::Exponent exponent;
    const auto negated = [&] {
        for (; graph[of].op == Op::Neg; of = graph.arg(of, 0)) exponent.negative ^= true;
    };
    if (!still(of)) return emit_plain(scope, id, std::move(out));
    negated();
    if (const auto above =
            graph[of].op == Op::Div ? graph.as_number(graph.arg(of, 0)) : std::nullopt;
        above && std::fabs(*above) == 1) {
        exponent.inverse = true;
        exponent.negative ^= *above < 0;
        of = graph.arg(of, 1);
        negated();
    }
    exponent.of = slot(scope, of);
    out.exponent = exponent;
    return emit_plain(scope, id, std::move(out));
}

// A product over the sum of what it is without each of its factors.
void Flattener::find_parallel(Scope &scope, NodeId id, Instruction &out) {
    constexpr std::size_t most_factors = 4;
    const NodeId above = graph.arg(id, 0), below = graph.arg(id, 1);
    if (out.type != ir::Type::Float || graph[above].op != Op::Mul || graph[below].op != Op::Add)
        return;
    std::vector<NodeId> factors, todo{above};
    double by = 1;
    while (!todo.empty()) {
        const NodeId factor = todo.back();
        todo.pop_back();
        if (const auto x = graph.as_number(factor))
            by *= *x;
        else if (graph[factor].op == Op::Mul)
            todo.insert(todo.end(), {graph.arg(factor, 0), graph.arg(factor, 1)});
        else
            factors.push_back(factor);
        if (factors.size() > most_factors) return;
    }
    if (factors.size() < 2 || !(by > 0) || !std::isfinite(by)) return;
    NodeId sum;
    for (std::size_t i = 0; i < factors.size(); ++i) {
        NodeId rest;
        for (std::size_t k = 0; k < factors.size(); ++k)
            if (k != i) rest = rest ? graph.mul(rest, factors[k]) : factors[k];
        sum = sum ? graph.add(sum, rest) : rest;
    }
    if (!same(graph, sum, below, &context.work)) return;
    for (const NodeId factor : factors) out.parallel.push_back(slot(scope, factor));
    out.parallel_by = by;
}

void Flattener::find_radial(Scope &scope, NodeId id, Instruction &out) {
    if (const auto found = radial(graph, id))
        out.along = {slot(scope, found->vector), slot(scope, found->factor), found->divides};
}

// s f(p/s) as f(p) would be, of a larger solid.
std::optional<NodeId> Flattener::without_factors(Scope &scope, NodeId id) {
    if (!context.ranges) return {};
    NodeId left, value;
    const bool divides = graph[id].op == Op::Div;
    for (int i = 0; i < 2 && !value; ++i) { // one stands still, and one does not
        const NodeId still = graph.arg(id, i), other = graph.arg(id, 1 - i);
        if (divides && i == 0) continue;
        if (!varies[slot(scope, still)] && varies[slot(scope, other)]) left = still, value = other;
    }
    if (!value) return {};
    bool any = false;
    for (Factor factor : factors_of(graph, left)) {
        if (divides) factor.divides = !factor.divides;
        const Interval range = range_of(context, *context.ranges, factor.number, Cell{})[0];
        if (!(range.lo > 0) || !range.finite()) continue;
        RescaledNodes of_rest;
        const Factor inverse{factor.number, factor.divides == divides};
        const auto moved = rescaled(graph, factor, value, met[{factor.number, factor.divides}],
                                    context.work),
                   rest = rescaled(graph, inverse, left, of_rest, context.work);
        if (!moved || !rest) continue;
        for (const auto &[old, made] : moved->made) {
            cancel_like(old, made);
            if (const auto joined = context.joined.find(old);
                joined != context.joined.end() && joined->second)
                context.joined[made] = true;
        }
        left = rest->value, value = moved->value, any = true;
    }
    if (!any) return {};
    return divides ? graph.div(value, left) : graph.mul(value, left);
}

void Flattener::find_around(Scope &scope, NodeId id, Instruction &out) {
    const auto around =
        out.type == ir::Type::Float ? around_axis(context, id) : vector_around_axis(context, id);
    if (!around || !cancelling.contains(around->angle)) return;
    out.around = {.vector = slot(scope, around->vector), .by = around->by};
    if (!around->rest) return;
    out.around->vanishing = slot(scope, around->vanishing);
    out.around->rest = slot(scope, around->rest);
    out.around->rest_by = around->rest_by;
}

Slot Flattener::product(Scope &scope, NodeId id, Instruction out) {
    if (const auto smooth = hermite(graph, id)) return slot(scope, *smooth);
    if (graph.arg(id, 0) == graph.arg(id, 1))
        return emit(scope, out, Form::Square, {graph.arg(id, 0)});
    if (const auto parts = odd_power(graph, id))
        return emit(scope, out, Form::OddPower, {parts->x, parts->exponent});
    if (const auto larger = without_factors(scope, id)) return slot(scope, *larger);
    for (NodeId a : args_of(id)) out.args.push_back(slot(scope, a));
    if (out.type != ir::Type::Float && !ir::is_vector(out.type)) return emit(scope, std::move(out));
    find_around(scope, id, out);
    find_radial(scope, id, out);
    find_ellipsoid(scope, id, out);
    find_univariate(scope, id, out);
    return emit_by_pieces(scope, id, std::move(out), {id});
}

Slot Flattener::quotient(Scope &scope, NodeId id, Instruction out) {
    const NodeId a = graph.arg(id, 0), b = graph.arg(id, 1);
    if (graph[a].op == Op::Sin && graph.arg(a, 0) == b) return emit(scope, out, Form::Sinc, {b});
    if (graph[b].op == Op::Tanh && graph.arg(b, 0) == a)
        return emit(scope, out, Form::Hyperbolic, {a});
    if (graph[b].op == Op::Splat && graph[graph.arg(b, 0)].op == Op::Length &&
        graph.arg(graph.arg(b, 0), 0) == a) {
        out.op = Op::Normalize, out.divides = true;
        return emit(scope, out, Form::Plain, {a});
    }
    if (const auto larger = without_factors(scope, id)) return slot(scope, *larger);
    find_radial(scope, id, out);
    find_ellipsoid(scope, id, out);
    find_parallel(scope, id, out);
    if (!scope.loop && are_scaled_alike(graph, a, b, context.work))
        out.has_majorant = tape.has_majorants = true;
    return emit_plain(scope, id, std::move(out));
}

Slot Flattener::vector(Scope &scope, NodeId id, Instruction out) {
    if (out.op == Op::MatMul && ir::is_vector(out.type))
        for (int i = 0; i < 2; ++i)
            if (const NodeId m = graph.arg(id, i); ir::is_matrix(graph[m].type))
                out.norm = matrix_norm(graph, m).value_or(out.norm);
    for (NodeId a : args_of(id)) out.args.push_back(slot(scope, a));
    if (out.op == Op::Make) find_around(scope, id, out);
    return emit_turned(scope, id, std::move(out));
}

Slot Flattener::inverse_cosine(Scope &scope, NodeId id, Instruction out) {
    if (const auto length = angle_to_axis(graph, id))
        out.from_axis = {slot(scope, graph.arg(*length, 0)), slot(scope, *length)};
    return emit_plain(scope, id, std::move(out));
}

NodeId Flattener::by_component(const std::vector<NodeId> &choice) {
    std::vector<NodeId> parts;
    const ir::Type type = graph[choice[1]].type;
    for (int i = 0; i < ir::components(type); ++i) {
        const NodeId a = graph.component(choice[1], i), b = graph.component(choice[2], i);
        parts.push_back(same(graph, a, b) ? b : graph.make(Op::Select, {choice[0], a, b}));
    }
    return graph.make(Op::Make, type, parts);
}

Slot Flattener::choice(Scope &scope, NodeId id, Instruction out) {
    const std::vector<NodeId> args = args_of(id);
    const auto arm = [&](NodeId value, bool holds) {
        return slot(scope, on_its_side(graph, args[0], holds, value, context.work));
    };
    out.args = {slot(scope, args[0]), arm(args[1], true), arm(args[2], false)};
    if (!varies[out.args[0]]) {
        out.form = Form::Joined; // either arm, the same for all points
    } else if (out.cancels) {
        out.form = Form::Joined;
    } else {
        const auto [known, is_new] = context.joined.emplace(id, false);
        if (is_new) {
            const bool agree = arms_agree(graph, args[0], args[1], args[2], context.work);
            context.joined[id] = agree;
        }
        if (context.joined[id])
            out.form = Form::Joined;
        else if (out.type == ir::Type::Float &&
                 arms_agree(graph, args[0], args[1], graph.neg(args[2]), context.work))
            out.form = Form::Opposite;
        else if (ir::is_vector(out.type))
            return slot(scope, by_component(args));
    }
    find_mean(scope, id, out);
    return emit(scope, std::move(out));
}

} // namespace fathom::proof
