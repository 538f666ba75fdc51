// Flattening: nodes in schedule order, one scope a function body and a loop body.
#include "proof/tape.h"

#include "ir/passes/inline.h"
#include "proof/around.h"
#include "proof/borders.h"
#include "proof/discontinuities.h"
#include "proof/ellipsoids.h"
#include "proof/exact.h"
#include "proof/flattener.h"
#include "proof/forms.h"
#include "proof/half_waves.h"
#include "proof/machine.h"
#include "proof/polar.h"
#include "proof/roots.h"
#include "proof/searches.h"
#include "proof/steadiness.h"

#include <algorithm>
#include <cmath>

namespace fathom::proof {
namespace {

constexpr std::size_t max_instructions = 100'000;

// What an op's node is looked at for, before it becomes an instruction as it stands (Plain).
enum class Look : std::uint8_t {
    Plain,
    Point,
    Call,
    Cached,
    Loop,
    LoopResult,
    Sum,
    Mix,
    Root,
    Length,
    Product,
    Quotient,
    Vector,
    Angle,
    Choice,
};
constexpr ir::OpTable<Look> look_of_op{
    {Op::Point, Look::Point},
    {Op::Call, Look::Call},
    {Op::Cached, Look::Cached},
    {Op::Loop, Look::Loop},
    {Op::LoopResult, Look::LoopResult},
    {Op::Sub, Look::Sum},
    {Op::Add, Look::Sum},
    {Op::Mix, Look::Mix},
    {Op::Sqrt, Look::Root},
    {Op::Pow, Look::Root},
    {Op::Length, Look::Length},
    {Op::Mul, Look::Product},
    {Op::Div, Look::Quotient},
    {Op::Make, Look::Vector},
    {Op::MatMul, Look::Vector},
    {Op::Acos, Look::Angle},
    {Op::Asin, Look::Angle},
    {Op::Select, Look::Choice},
};

bool holds_infinity(const ir::Graph &graph, NodeId id) {
    const ir::Constant &c = graph.constant_of(id);
    return std::any_of(c.value.begin(), c.value.end(), [](double x) { return std::isinf(x); });
}

} // namespace

Slot Flattener::fresh(ir::Type type, bool varying) {
    int n = ir::components(type);
    tape.first.push_back(tape.components);
    tape.size.push_back(static_cast<std::uint8_t>(n));
    tape.components += static_cast<std::uint32_t>(n);
    varies.push_back(varying);
    return static_cast<Slot>(tape.first.size() - 1);
}

bool Flattener::grows(const Instruction &instruction) const {
    constexpr ir::OpSet growing{Op::Exp, Op::Exp2, Op::Sinh, Op::Cosh, Op::Pow};
    return growing[instruction.op] ||
           (instruction.op == Op::Const && holds_infinity(graph, instruction.node));
}

Slot Flattener::emit(Scope &scope, Instruction instruction) {
    if (++count > max_instructions) tape.too_large = true;
    for (Slot s : instruction.args) instruction.varies = instruction.varies || varies[s];
    instruction.out = fresh(instruction.type, instruction.varies);
    Slot out = instruction.out;
    constexpr ir::OpSet sums{Op::Make, Op::Add, Op::Sub, Op::Mix, Op::Atan2};
    if (sums[instruction.op] || instruction.form == Form::Norm || instruction.form == Form::PNorm)
        instruction.groups = supports.groups(instruction.args);
    supports.follow(instruction);
    tape.grows = tape.grows || grows(instruction);
    bool hoisted = !scope.loop && !instruction.varies;
    (hoisted ? tape.once : *scope.block).push_back(std::move(instruction));
    return out;
}

bool Flattener::depends(Scope &scope, NodeId id) {
    if (auto found = scope.depends.find(id); found != scope.depends.end()) return found->second;
    bool result = false;
    for (NodeId a : graph.args(id)) result = result || depends(scope, a);
    const ir::Node &node = graph[id];
    if (!result && node.op == Op::Loop)
        for (NodeId v : graph.free_vars(id)) result = result || depends(scope, v);
    scope.depends.emplace(id, result);
    return result;
}

const Slot *Flattener::find(Scope &scope, NodeId id) {
    for (Scope *s = &scope; s; s = s->outer)
        if (auto found = s->slots.find(id); found != s->slots.end()) return &found->second;
    return nullptr;
}

void Flattener::walk(Scope &scope, const std::vector<NodeId> &roots) {
    std::vector<NodeId> reached, pending = roots;
    std::unordered_map<NodeId, bool> seen;
    while (!pending.empty()) {
        NodeId id = pending.back();
        pending.pop_back();
        if (!seen.emplace(id, true).second || find(scope, id)) continue;
        reached.push_back(id);
        for (NodeId a : graph.args(id)) pending.push_back(a);
    }
    std::sort(reached.begin(), reached.end());
    for (NodeId id : reached) {
        if (tape.too_large) return;
        Scope *home = &scope;
        while (home->loop && home->outer && !depends(*home, id)) home = home->outer;
        if (!find(*home, id)) home->slots.emplace(id, flatten_node(*home, id));
    }
}

Slot Flattener::slot(Scope &scope, NodeId id) {
    if (const Slot *s = find(scope, id)) return *s;
    walk(scope, {id});
    const Slot *s = find(scope, id);
    return s ? *s : 0;
}

Slot Flattener::emit(Scope &scope, Instruction out, Form form, const std::vector<NodeId> &args) {
    out.form = form;
    out.args.clear();
    for (NodeId a : args) out.args.push_back(slot(scope, a));
    return emit(scope, std::move(out));
}

Slot Flattener::emit_plain(Scope &scope, NodeId id, Instruction out) {
    return emit(scope, std::move(out), Form::Plain, args_of(id));
}

void Flattener::find_ellipsoid(Scope &scope, NodeId id, Instruction &out) {
    const auto found = ellipsoid(graph, id);
    if (!found) return;
    const ir::Type type = ir::vector_type(int(found->vector.size()));
    const NodeId vector = graph.make(Op::Make, type, found->vector);
    Instruction::EllipsoidOf of{
        slot(scope, vector), slot(scope, found->k0), slot(scope, found->k1), {}, found->by};
    for (const NodeId one : found->inverse) of.inverse.push_back(slot(scope, one));
    out.ellipsoid = std::move(of);
}

Slot Flattener::emit_unwound(Scope &scope, NodeId id, Instruction out) {
    if (!winding->waves.contains(id)) tape.too_large = true; // made since: of which angle?
    const NodeId angle = graph.arg(id, 0);
    const auto at = winding->angles.find(angle);
    if (at == winding->angles.end()) return emit_plain(scope, id, std::move(out));
    Instruction turned;
    turned.op = Op::Add;
    turned.type = ir::Type::Float;
    turned.node = angle;
    turned.args = {slot(scope, angle), slot(scope, graph.number(0))};
    turned.stands_at = at->second;
    out.args = {emit(scope, std::move(turned))};
    return emit(scope, std::move(out));
}

void Flattener::find_beside_turn(Scope &scope, NodeId id, Instruction &out) {
    if (!context.ranges || cancelling.empty()) return; // its angle jumps
    const auto found = beside_turn(context, id);
    if (!found || !cancelling.contains(found->turns.angle)) return;
    const Around &turns = found->turns;
    Instruction::BesideTurn made;
    made.still = slot(scope, found->still);
    made.radial = found->by * turns.radial, made.across = found->by * turns.across;
    if (turns.rest) {
        made.vanishing = slot(scope, turns.vanishing), made.rest = slot(scope, turns.rest);
        made.rest_by = found->by * turns.rest_by;
    }
    out.beside_turn = made;
}

// From the exponent 2 on it is no steeper than the vector of its parts.
Slot Flattener::norm_of_powers(Scope &scope, NodeId id, Instruction out, const PNormParts &found) {
    out.form = Form::PNorm;
    for (const NodeId part : found.parts) out.args.push_back(slot(scope, part));
    out.args.push_back(slot(scope, found.power));
    const auto power = graph.as_number(found.power);
    if (!power || *power < 2) return emit(scope, std::move(out));
    std::vector<NodeId> parts = found.parts; // their signs do not matter
    for (NodeId &part : parts)
        while (graph[part].op == Op::Abs) part = graph.arg(part, 0);
    return emit_by_pieces(scope, id, std::move(out), parts);
}

Slot Flattener::flatten_node(Scope &scope, NodeId id) {
    const ir::Node node = graph[id]; // a copy: recognising a form may add nodes
    Instruction out;
    out.op = node.op;
    out.type = node.type;
    out.payload = node.payload;
    out.node = id;
    out.cancels = cancelling.contains(id);
    out.stepped = stepped.contains(id);
    if (node.op == Op::Fract || node.op == Op::Mod)
        out.scatters = single_is_far_off(graph, graph.arg(id, 0));
    if (node.op == Op::Mod)
        out.whole = is_whole_power_of_two(graph, graph.arg(id, 1)) &&
                    is_made_whole(graph, graph.arg(id, 0));
    if (node.op == Op::Hash) out.whole = counts_turns(graph.arg(id, 0));
    if (winding && (node.op == Op::Sin || node.op == Op::Cos) && graph.reads(id).point)
        return emit_unwound(scope, id, std::move(out));
    switch (look_of_op[node.op]) {
    case Look::Point: out.varies = true; return emit(scope, out);
    case Look::Call: return call(scope, id, ir::FunctionId{node.payload});
    case Look::Cached:
        if (node.payload < context.cached.size() && context.cached[node.payload]) break;
        return call(scope, id, graph.cache(ir::CacheId{node.payload}).field);
    case Look::Loop: return loop(scope, id);
    case Look::LoopResult:
        slot(scope, graph.arg(id, 0));
        return loop_results.at(graph.arg(id, 0))[node.payload];
    case Look::Sum: return sum(scope, id, std::move(out));
    case Look::Mix: return mix(scope, id, std::move(out));
    case Look::Root:
        if (const auto inward = root_inward(graph, id)) {
            cancel_like(inward->from, inward->choice);
            return slot(scope, inward->choice);
        }
        if (auto parts = norm_parts(graph, id)) {
            out.form = Form::Norm;
            for (NodeId a : *parts) out.args.push_back(slot(scope, a));
            return parts->size() > 1 ? emit_by_pieces(scope, id, std::move(out), *parts)
                                     : emit(scope, std::move(out));
        }
        if (const auto x = rounded_sizes(graph, id)) {
            out.norm = 1;
            out.turned = {slot(scope, *x)};
            return emit_plain(scope, id, std::move(out));
        }
        if (auto found = p_norm(graph, id))
            return norm_of_powers(scope, id, std::move(out), *found);
        if (node.op == Op::Pow && node.type == ir::Type::Float)
            return power(scope, id, std::move(out));
        break;
    case Look::Length: return emit(scope, out, Form::Norm, {graph.arg(id, 0)});
    case Look::Product: return product(scope, id, std::move(out));
    case Look::Quotient: return quotient(scope, id, std::move(out));
    case Look::Vector: return vector(scope, id, std::move(out));
    case Look::Angle: return inverse_cosine(scope, id, std::move(out));
    case Look::Choice: return choice(scope, id, std::move(out));
    case Look::Plain: break;
    }
    return emit_plain(scope, id, std::move(out));
}

Slot Flattener::call(Scope &scope, NodeId id, ir::FunctionId which) {
    const ir::Function function = graph.function(which);
    Scope inner;
    inner.block = scope.block;
    inner.loop = scope.loop; // so that nothing of a loop's body is hoisted
    const std::vector<NodeId> args(graph.args(id).begin(), graph.args(id).end());
    for (std::size_t i = 0; i < function.params.size(); ++i)
        inner.slots[function.params[i]] = slot(scope, args[i]);
    return slot(inner, function.result);
}

// Made of whole numbers and of loops' numbers alone: known in each turn. Of what else is one number,
// as floor(x) in a cell that is looked at, others are looked at with it: those of its period.
bool Flattener::counts_turns(NodeId id) const {
    constexpr ir::OpSet made{Op::Add, Op::Sub, Op::Mul, Op::Neg, Op::ToFloat, Op::Make, Op::Splat};
    constexpr std::size_t most = 16;
    std::vector<NodeId> todo{id};
    for (std::size_t seen = 0; !todo.empty(); ++seen) {
        const NodeId at = todo.back();
        todo.pop_back();
        if (seen == most) return false;
        if (indices.contains(at)) continue;
        if (const auto number = graph.as_number(at); number && *number == std::round(*number))
            continue;
        if (!made[graph[at].op]) return false;
        todo.insert(todo.end(), graph.args(at).begin(), graph.args(at).end());
    }
    return true;
}

Slot Flattener::loop(Scope &scope, NodeId id) {
    const ir::Loop loop = graph.loop(ir::LoopId{graph[id].payload});
    Loop plan;
    plan.most = loop.max_count;
    plan.count = slot(scope, loop.count);
    for (NodeId a : std::vector<NodeId>(graph.args(id).begin(), graph.args(id).end()))
        plan.start.push_back(slot(scope, a));
    Scope inner;
    inner.outer = &scope;
    inner.loop = true;
    inner.block = &plan.body;
    plan.index = fresh(ir::Type::Int, false);
    inner.slots[loop.index] = plan.index;
    indices.insert(loop.index);
    inner.depends[loop.index] = true;
    for (NodeId var : loop.vars) {
        Slot s = fresh(graph[var].type, true);
        plan.vars.push_back(s);
        plan.scratch.push_back(fresh(graph[var].type, true));
        plan.ends.push_back(fresh(graph[var].type, true));
        inner.slots[var] = s;
        inner.depends[var] = true;
    }
    std::vector<NodeId> roots;
    for (NodeId next : loop.next) roots.push_back(written_out(graph, next));
    plan.has_condition = static_cast<bool>(loop.condition);
    if (plan.has_condition) roots.push_back(written_out(graph, loop.condition));
    walk(inner, roots);
    if (tape.too_large) return 0;
    for (std::size_t i = 0; i < loop.next.size(); ++i) plan.next.push_back(slot(inner, roots[i]));
    if (plan.has_condition) {
        plan.condition = slot(inner, roots.back());
        plan.condition_varies = varies[plan.condition];
    }

    Instruction out;
    out.op = Op::Loop;
    out.form = Form::Loop;
    out.node = id;
    out.varies = true;
    out.type = graph[id].type;
    out.payload = static_cast<std::uint32_t>(tape.loops.size());
    loop_results[id] = plan.ends;
    out.args = plan.start;
    const Slot plan_result = plan.ends.front();
    tape.loops.push_back(std::move(plan));
    out.out = plan_result;
    if (++count > max_instructions) tape.too_large = true;
    scope.block->push_back(std::move(out));
    return plan_result; // the Loop itself is its first value
}

std::size_t Tape::length() const {
    std::size_t n = each.size();
    for (const Loop &loop : loops)
        n += loop.body.size() * static_cast<std::size_t>(std::max(loop.most, 1));
    return n;
}

namespace {

constexpr std::size_t max_nodes_unwound = 600;

// Loops' bodies too.
std::unordered_set<NodeId> all_nodes_of(const ir::Graph &graph, NodeId root) {
    std::unordered_set<NodeId> seen;
    std::vector<NodeId> todo{root};
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!id || !seen.insert(id).second) continue;
        todo.insert(todo.end(), graph.args(id).begin(), graph.args(id).end());
        if (graph[id].op != Op::Loop) continue;
        const ir::Loop &loop = graph.loop(ir::LoopId{graph[id].payload});
        todo.insert(todo.end(), loop.next.begin(), loop.next.end());
        todo.insert(todo.end(), {loop.count, loop.condition});
    }
    return seen;
}

// Of an instruction that no search runs again: flattening it takes as long as so many steps of one.
constexpr std::size_t steps_of_flattening = 32;

Tape flattened(Flattening &context, NodeId root, bool unwound, const Cell *region) {
    Flattener flattener(context);
    if (context.work.spent()) {
        flattener.tape.too_large = true;
        return std::move(flattener.tape);
    }
    if (const auto it = context.written.find(root); it != context.written.end()) root = it->second;
    root = written_out(context.graph, root); // forms are seen through calls
    if (unwound) root = ir::without_loops(context.graph, root, max_nodes_unwound).root;
    root = with_chosen_factors(context.graph, root);
    root = with_half_waves(context.graph, with_squares_compared(context.graph, root));
    root = with_chosen_lengths(context.graph, root, region ? &region->p : nullptr, context.ranges,
                               context.work);
    const bool steps = has_steps(context.graph, root),
               choices = context.borders && has_choices(context.graph, root);
    if (steps || choices) {
        NodeId whole = with_signed_roots(context.graph, root);
        const bool has_signed_roots = whole != root;
        flattener.own = all_nodes_of(context.graph, whole);
        if (steps) {
            flattener.cancelling = cancelling_steps(context.graph, whole, region, context.work);
            const Turned turned = without_angles(context.graph, whole);
            for (const auto &[wave, step] : turned.steps) flattener.cancel_like(wave, step);
            whole = turned.root;
            flattener.stepped = stepped_angles(context.graph, whole, flattener.cancelling);
        }
        if (choices) {
            Meeting meeting = meeting_choices(context, whole);
            if (!is_unseen(meeting.moved, region ? &region->p : nullptr)) meeting = {};
            flattener.cancelling.merge(meeting.choices);
            flattener.tape.near = meeting.near;
        }
        if (!flattener.cancelling.empty() || has_signed_roots) root = whole;
    }
    if (unwound) {
        flattener.winding = winding_of(context.graph, root);
        if (!flattener.winding) return {};
        flattener.tape.winds_about = flattener.winding->axis;
        root = flattener.winding->field;
    }
    Scope scope;
    scope.block = &flattener.tape.each;
    flattener.tape.result = flattener.slot(scope, root);
    context.work.take(flattener.tape.once.size() * steps_of_flattening);
    if (!flattener.tape.too_large) mark_wavering(flattener.tape);
    return std::move(flattener.tape);
}

} // namespace

Tape flatten(Flattening &context, NodeId root, const Cell *region) {
    return flattened(context, root, false, region);
}
Tape flatten_unwound(Flattening &context, NodeId root) {
    return flattened(context, root, true, nullptr);
}

} // namespace fathom::proof
