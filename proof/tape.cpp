// Flattening: nodes in schedule order, one scope a function body and a loop body.
// Long: one flattener, whose looks at nodes share its scopes.
#include "proof/tape.h"

#include "proof/borders.h"
#include "proof/continuity.h"
#include "proof/discontinuities.h"
#include "proof/forms.h"
#include "proof/linear_maps.h"
#include "proof/polar.h"
#include "proof/segments.h"
#include "proof/smooth.h"
#include "proof/supports.h"

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
    Root,
    Length,
    Product,
    Quotient,
    Vector,
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
    {Op::Sqrt, Look::Root},
    {Op::Pow, Look::Root},
    {Op::Length, Look::Length},
    {Op::Mul, Look::Product},
    {Op::Div, Look::Quotient},
    {Op::Make, Look::Vector},
    {Op::MatMul, Look::Vector},
    {Op::Select, Look::Choice},
};

bool holds_infinity(const ir::Graph &graph, NodeId id) {
    const ir::Constant &c = graph.constant_of(id);
    return std::any_of(c.value.begin(), c.value.end(), [](double x) { return std::isinf(x); });
}

struct Scope {
    Scope *outer = nullptr;                    // a loop's surroundings; none for a function's body
    std::vector<Instruction> *block = nullptr; // where what depends on this scope's variables goes
    std::unordered_map<NodeId, Slot> slots;
    std::unordered_map<NodeId, bool> depends; // on the loop's variables
    bool loop = false;
};

struct Flattener {
    Flattening &context;
    ir::Graph &graph;
    Tape tape;
    std::vector<bool> varies; // by slot
    std::size_t count = 0;
    std::unordered_set<NodeId> cancelling; // steps and choices
    std::unordered_set<NodeId> stepped;    // angles that steps alone read
    std::unordered_set<NodeId> known_linear;
    int steps_of_pieces = 0;
    Supports supports{tape};

    explicit Flattener(Flattening &c) : context(c), graph(c.graph) {}

    Slot fresh(ir::Type type, bool varying) {
        int n = ir::components(type);
        tape.first.push_back(tape.components);
        tape.size.push_back(static_cast<std::uint8_t>(n));
        tape.components += static_cast<std::uint32_t>(n);
        varies.push_back(varying);
        return static_cast<Slot>(tape.first.size() - 1);
    }

    // Leaves single precision for arguments as scenes have them.
    bool grows(const Instruction &instruction) const {
        constexpr ir::OpSet growing{Op::Exp, Op::Exp2, Op::Sinh, Op::Cosh, Op::Pow};
        return growing[instruction.op] ||
               (instruction.op == Op::Const && holds_infinity(graph, instruction.node));
    }

    Slot emit(Scope &scope, Instruction instruction) {
        if (++count > max_instructions) tape.too_large = true;
        for (Slot s : instruction.args) instruction.varies = instruction.varies || varies[s];
        instruction.out = fresh(instruction.type, instruction.varies);
        Slot out = instruction.out;
        if (instruction.op == Op::Make || instruction.form == Form::Norm ||
            instruction.form == Form::PNorm)
            instruction.groups = supports.groups(instruction.args);
        supports.follow(instruction);
        tape.grows = tape.grows || grows(instruction);
        bool hoisted = !scope.loop && !instruction.varies;
        (hoisted ? tape.once : *scope.block).push_back(std::move(instruction));
        return out;
    }

    // Does the node read the variables of this loop?
    bool depends(Scope &scope, NodeId id) {
        if (auto found = scope.depends.find(id); found != scope.depends.end()) return found->second;
        bool result = false;
        for (NodeId a : graph.args(id)) result = result || depends(scope, a);
        const ir::Node &node = graph[id];
        if (!result && node.op == Op::Loop)
            for (NodeId v : graph.free_vars(id)) result = result || depends(scope, v);
        scope.depends.emplace(id, result);
        return result;
    }

    const Slot *find(Scope &scope, NodeId id) {
        for (Scope *s = &scope; s; s = s->outer)
            if (auto found = s->slots.find(id); found != s->slots.end()) return &found->second;
        return nullptr;
    }

    // All of `roots`, arguments first. A loop's body is walked when its Loop is met.
    void walk(Scope &scope, const std::vector<NodeId> &roots) {
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

    Slot slot(Scope &scope, NodeId id) {
        if (const Slot *s = find(scope, id)) return *s;
        walk(scope, {id});
        const Slot *s = find(scope, id);
        return s ? *s : 0;
    }

    // What is affine by pieces, in what it is made of.
    // Scalars, but those of one vector together: their norm is no more than the vector's.
    std::vector<NodeId> by_vector(std::vector<NodeId> parts) {
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
        return out;
    }
    std::optional<Pieces> pieces_of(NodeId id, const std::vector<NodeId> &of) {
        const auto [known, fresh] = context.pieces.try_emplace(id);
        if (fresh) {
            const int before = steps_of_pieces;
            known->second = by_pieces(graph, of, steps_of_pieces);
            context.work.take(std::size_t(steps_of_pieces - before));
        }
        return known->second;
    }
    Slot emit_by_pieces(Scope &scope, NodeId id, Instruction out, const std::vector<NodeId> &of) {
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

    // A vector that may be another one turned, or moved along a direction.
    Slot emit_turned(Scope &scope, NodeId id, Instruction out) {
        if (const auto way = moved_along(graph, id)) {
            out.norm = way->norm;
            out.turned = {slot(scope, way->v), slot(scope, way->b)};
            return emit(scope, out);
        }
        const auto may_be = [&](NodeId v) { return varies[slot(scope, v)]; };
        const bool is_matrix = out.op == Op::MatMul; // whose rule has the matrix' norm
        const auto t = ir::is_vector(out.type) ? turned(graph, id, may_be, known_linear)
                                               : std::optional<LinearMap>();
        if (!t && is_matrix) return emit(scope, out);
        if (!t) return emit_by_pieces(scope, id, std::move(out), {id});
        bool still = true;
        std::vector<Slot> constants;
        for (NodeId c : t->constants) {
            constants.push_back(slot(scope, c));
            still = still && !varies[constants.back()];
        }
        const Slot of = slot(scope, t->of);
        const bool may_stand_still = scope.loop || !cancelling.empty(); // as steps do
        if (!still && (!may_stand_still || (!is_matrix && pieces_of(id, {id}))))
            return emit_by_pieces(scope, id, std::move(out), {id});
        if (!is_matrix) {
            out.norm = t->norm;
            out.turned = {of};
            out.turned.insert(out.turned.end(), constants.begin(), constants.end());
        }
        known_linear.insert(id);
        const Slot made = emit(scope, out);
        if (still && t->whole && supports.is_base(of)) supports.make_base(made);
        return made;
    }
    std::vector<NodeId> args_of(NodeId id) const { // a copy: flattening may add nodes
        return {graph.args(id).begin(), graph.args(id).end()};
    }
    Slot emit(Scope &scope, Instruction out, Form form, const std::vector<NodeId> &args) {
        out.form = form;
        out.args.clear();
        for (NodeId a : args) out.args.push_back(slot(scope, a));
        return emit(scope, std::move(out));
    }
    Slot emit_plain(Scope &scope, NodeId id, Instruction out) {
        return emit(scope, std::move(out), Form::Plain, args_of(id));
    }

    Slot flatten_node(Scope &scope, NodeId id) {
        const ir::Node node = graph[id]; // a copy: recognising a form may add nodes
        Instruction out;
        out.op = node.op;
        out.type = node.type;
        out.payload = node.payload;
        out.node = id;
        out.cancels = cancelling.contains(id);
        out.stepped = stepped.contains(id);
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
        case Look::Root:
            if (const auto inward = root_inward(graph, id)) {
                if (cancelling.contains(inward->from)) cancelling.insert(inward->choice);
                return slot(scope, inward->choice);
            }
            if (auto parts = norm_parts(graph, id)) {
                out.form = Form::Norm;
                for (NodeId a : *parts) out.args.push_back(slot(scope, a));
                return parts->size() > 1 ? emit_by_pieces(scope, id, std::move(out), *parts)
                                         : emit(scope, std::move(out));
            }
            if (auto parts = p_norm(graph, id)) {
                parts->parts.push_back(parts->power);
                return emit(scope, out, Form::PNorm, parts->parts);
            }
            break;
        case Look::Length: return emit(scope, out, Form::Norm, {graph.arg(id, 0)});
        case Look::Product: return product(scope, id, std::move(out));
        case Look::Quotient: return quotient(scope, id, std::move(out));
        case Look::Vector: return vector(scope, id, std::move(out));
        case Look::Choice: return choice(scope, id, std::move(out));
        case Look::Plain: break;
        }
        return emit_plain(scope, id, std::move(out));
    }

    // Does the step that a wave is made with? x - m*round(x/m), held or not, x % m - m/2, …
    bool step_cancels(NodeId wave) const {
        if (const auto rounded = rounding_in(graph.arg(wave, 1)))
            return cancelling.contains(*rounded);
        return std::ranges::any_of(graph.args(wave), [&](NodeId arg) {
            return (graph[arg].op == Op::Mod || graph[arg].op == Op::Fract) &&
                   cancelling.contains(arg);
        });
    }
    std::optional<NodeId> rounding_in(NodeId id) const {
        if (graph[id].op == Op::Round) return id;
        if (graph[id].op == Op::Clamp) return rounding_in(graph.arg(id, 0));
        if (graph[id].op != Op::Mul) return {};
        for (NodeId factor : graph.args(id))
            if (const auto found = rounding_in(factor)) return found;
        return {};
    }

    Slot sum(Scope &scope, NodeId id, Instruction out) {
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
            out.payload = (smooth->greater ? 1u : 0u) + (smooth->divides ? 2u : 0u) +
                          (smooth->clipped ? 4u : 0u);
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
        return emit_by_pieces(scope, id, std::move(out), {id});
    }

    Slot product(Scope &scope, NodeId id, Instruction out) {
        if (const auto smooth = hermite(graph, id)) return slot(scope, *smooth);
        if (graph.arg(id, 0) == graph.arg(id, 1))
            return emit(scope, out, Form::Square, {graph.arg(id, 0)});
        if (const auto parts = odd_power(graph, id))
            return emit(scope, out, Form::OddPower, {parts->x, parts->exponent});
        for (NodeId a : args_of(id)) out.args.push_back(slot(scope, a));
        if (out.type != ir::Type::Float && !ir::is_vector(out.type))
            return emit(scope, std::move(out));
        return emit_by_pieces(scope, id, std::move(out), {id});
    }

    Slot quotient(Scope &scope, NodeId id, Instruction out) {
        const NodeId a = graph.arg(id, 0), b = graph.arg(id, 1);
        if (graph[a].op == Op::Sin && graph.arg(a, 0) == b)
            return emit(scope, out, Form::Sinc, {b});
        if (graph[b].op == Op::Splat && graph[graph.arg(b, 0)].op == Op::Length &&
            graph.arg(graph.arg(b, 0), 0) == a) {
            out.op = Op::Normalize;
            return emit(scope, out, Form::Plain, {a});
        }
        return emit_plain(scope, id, std::move(out));
    }

    Slot vector(Scope &scope, NodeId id, Instruction out) {
        if (out.op == Op::MatMul && ir::is_vector(out.type))
            for (int i = 0; i < 2; ++i)
                if (const NodeId m = graph.arg(id, i); ir::is_matrix(graph[m].type))
                    out.norm = matrix_norm(graph, m).value_or(out.norm);
        for (NodeId a : args_of(id)) out.args.push_back(slot(scope, a));
        return emit_turned(scope, id, std::move(out));
    }

    // A choice of vectors as a vector of choices, where components differ.
    NodeId by_component(const std::vector<NodeId> &choice) {
        std::vector<NodeId> parts;
        const ir::Type type = graph[choice[1]].type;
        for (int i = 0; i < ir::components(type); ++i) {
            const NodeId a = graph.component(choice[1], i), b = graph.component(choice[2], i);
            parts.push_back(same(graph, a, b) ? b : graph.make(Op::Select, {choice[0], a, b}));
        }
        return graph.make(Op::Make, type, parts);
    }

    Slot choice(Scope &scope, NodeId id, Instruction out) {
        const std::vector<NodeId> args = args_of(id);
        for (NodeId a : args) out.args.push_back(slot(scope, a));
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
        return emit(scope, std::move(out));
    }

    Slot call(Scope &scope, NodeId id, ir::FunctionId which) {
        const ir::Function function = graph.function(which);
        Scope inner;
        inner.block = scope.block;
        inner.loop = scope.loop; // so that nothing of a loop's body is hoisted
        const std::vector<NodeId> args(graph.args(id).begin(), graph.args(id).end());
        for (std::size_t i = 0; i < function.params.size(); ++i)
            inner.slots[function.params[i]] = slot(scope, args[i]);
        return slot(inner, function.result);
    }

    std::unordered_map<NodeId, std::vector<Slot>> loop_results;

    Slot loop(Scope &scope, NodeId id) {
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
        inner.depends[loop.index] = true;
        for (NodeId var : loop.vars) {
            Slot s = fresh(graph[var].type, true);
            plan.vars.push_back(s);
            plan.scratch.push_back(fresh(graph[var].type, true));
            plan.ends.push_back(fresh(graph[var].type, true));
            inner.slots[var] = s;
            inner.depends[var] = true;
        }
        std::vector<NodeId> roots = loop.next;
        plan.has_condition = static_cast<bool>(loop.condition);
        if (plan.has_condition) roots.push_back(loop.condition);
        walk(inner, roots);
        if (tape.too_large) return 0;
        for (NodeId next : loop.next) plan.next.push_back(slot(inner, next));
        if (plan.has_condition) {
            plan.condition = slot(inner, loop.condition);
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
};

} // namespace

std::size_t Tape::length() const {
    std::size_t n = each.size();
    for (const Loop &loop : loops)
        n += loop.body.size() * static_cast<std::size_t>(std::max(loop.most, 1));
    return n;
}

Tape flatten(Flattening &context, NodeId root) {
    Flattener flattener(context);
    const bool steps = has_steps(context.graph, root),
               choices = context.borders && has_choices(context.graph, root);
    if (steps || choices) {
        NodeId whole = written_out(context.graph, root);
        if (steps) {
            flattener.cancelling = cancelling_steps(context.graph, whole);
            const Turned turned = without_angles(context.graph, whole);
            for (const auto &[wave, step] : turned.steps)
                if (flattener.cancelling.contains(wave)) flattener.cancelling.insert(step);
            whole = turned.root;
            flattener.stepped = stepped_angles(context.graph, whole, flattener.cancelling);
        }
        if (choices) {
            Meeting meeting = meeting_choices(context, whole);
            flattener.cancelling.merge(meeting.choices);
            flattener.tape.near = meeting.near;
        }
        if (!flattener.cancelling.empty()) root = whole;
    }
    Scope scope;
    scope.block = &flattener.tape.each;
    flattener.tape.result = flattener.slot(scope, root);
    return std::move(flattener.tape);
}

} // namespace fathom::proof
