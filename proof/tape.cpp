// Flattening: nodes in schedule order, one scope a function body and a loop body.
#include "proof/tape.h"

#include "proof/continuity.h"
#include "proof/discontinuities.h"
#include "proof/linear_maps.h"
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
    std::unordered_set<NodeId> cancelling; // steps
    std::unordered_set<NodeId> known_linear;
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
        if (instruction.op == Op::Make || instruction.form == Form::Norm)
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

    std::optional<double> number(NodeId id) {
        const ir::Node &node = graph[id];
        if (node.op == Op::Splat) return number(graph.arg(id, 0));
        if (node.op == Op::Neg) {
            if (auto x = number(graph.arg(id, 0))) return -*x;
            return {};
        }
        if (node.op != Op::Const) return {};
        const ir::Constant &c = graph.constant_of(id);
        for (int i = 1; i < ir::components(c.type); ++i)
            if (c.value[static_cast<std::size_t>(i)] != c.value[0]) return {};
        return c.value[0];
    }

    bool is_half(NodeId half, NodeId whole) {
        auto a = number(half), b = number(whole);
        if (a && b) return *a == *b / 2;
        if (graph[half].op == Op::Splat && graph[whole].op == Op::Splat)
            return is_half(graph.arg(half, 0), graph.arg(whole, 0));
        if (graph[half].op == Op::Const && graph[whole].op == Op::Const) {
            const auto &x = graph.constant_of(half), &y = graph.constant_of(whole);
            for (int i = 0; i < ir::components(x.type); ++i)
                if (x.value[static_cast<std::size_t>(i)] !=
                    y.value[static_cast<std::size_t>(i)] / 2)
                    return false;
            return x.type == y.type;
        }
        if (graph[half].op == Op::Div && graph.arg(half, 0) == whole &&
            number(graph.arg(half, 1)) == 2.0)
            return true;
        if (graph[half].op == Op::Mul)
            for (int i = 0; i < 2; ++i)
                if (graph.arg(half, i) == whole && number(graph.arg(half, 1 - i)) == 0.5)
                    return true;
        return false;
    }

    // x and m where the node is x % m - m/2, fract(x) - 1/2, or x - m*round(x/m).
    struct WaveParts {
        NodeId x, m;
    };
    std::optional<WaveParts> wave(NodeId id) {
        const ir::Node node = graph[id]; // a copy: nodes are added below
        if (node.op != Op::Sub && node.op != Op::Add) return {};
        NodeId a = graph.arg(id, 0), b = graph.arg(id, 1);
        auto less_half = [&](NodeId part, NodeId m) {
            if (node.op == Op::Sub) return is_half(part, m);
            if (graph[part].op == Op::Neg) return is_half(graph.arg(part, 0), m);
            auto x = number(part), y = number(m);
            return x && y && *x == -*y / 2;
        };
        for (int i = 0; i < (node.op == Op::Add ? 2 : 1); ++i, std::swap(a, b)) {
            if (graph[a].op == Op::Mod && less_half(b, graph.arg(a, 1))) {
                NodeId m = graph.arg(a, 1);
                // x % m - m/2 = w(x - m/2), w the wave that passes through 0 at 0.
                return WaveParts{graph.sub(graph.arg(a, 0), node.op == Op::Sub ? b : graph.neg(b)),
                                 m};
            }
            if (graph[a].op == Op::Fract) {
                auto half = number(b);
                if (half && *half == (node.op == Op::Sub ? 0.5 : -0.5)) {
                    NodeId one = graph.number(1);
                    if (ir::components(node.type) > 1) one = graph.splat(one, node.type);
                    return WaveParts{
                        graph.sub(graph.arg(a, 0), graph.splat(graph.number(0.5), node.type)), one};
                }
            }
        }
        if (node.op == Op::Sub && graph[b].op == Op::Round && graph.arg(b, 0) == a)
            return WaveParts{a, graph.splat(graph.number(1), node.type)};
        if (node.op == Op::Sub && graph[b].op == Op::Mul)
            for (int i = 0; i < 2; ++i) {
                NodeId m = graph.arg(b, i), r = graph.arg(b, 1 - i);
                if (graph[r].op != Op::Round) continue;
                NodeId q = graph.arg(r, 0);
                if (graph[q].op == Op::Div && graph.arg(q, 0) == a && graph.arg(q, 1) == m)
                    return WaveParts{a, m};
                auto step = number(m); // x/m may have become x*(1/m)
                if (step && graph[q].op == Op::Mul)
                    for (int k = 0; k < 2; ++k) {
                        auto inverse = number(graph.arg(q, 1 - k));
                        if (graph.arg(q, k) == a && inverse && *inverse * *step == 1)
                            return WaveParts{a, m};
                    }
            }
        return {};
    }

    // The parts whose squares the sum is made of; a constant c >= 0 is the square of its root.
    bool squares(NodeId sum, std::vector<NodeId> &parts) {
        const ir::Node node = graph[sum];
        if (node.op == Op::Add)
            return squares(graph.arg(sum, 0), parts) && squares(graph.arg(sum, 1), parts);
        if ((node.op == Op::Mul || node.op == Op::Dot) && graph.arg(sum, 0) == graph.arg(sum, 1)) {
            parts.push_back(graph.arg(sum, 0));
            return true;
        }
        if (node.op == Op::Pow && number(graph.arg(sum, 1)) == 2.0) {
            parts.push_back(graph.arg(sum, 0));
            return true;
        }
        if (auto c = graph.as_number(sum); c && *c >= 0) {
            parts.push_back(graph.number(std::sqrt(*c)));
            return true;
        }
        return false;
    }
    std::optional<std::vector<NodeId>> norm_parts(NodeId id) {
        const ir::Node node = graph[id];
        if (node.type != ir::Type::Float) return {};
        std::vector<NodeId> parts;
        bool root = node.op == Op::Sqrt || (node.op == Op::Pow && number(graph.arg(id, 1)) == 0.5);
        if (root && squares(graph.arg(id, 0), parts)) return parts;
        return {};
    }

    // |max(v, 0)| + min(max of all components of v, 0), as everyone writes a box.
    std::optional<NodeId> corner(NodeId id) {
        if (graph[id].op != Op::Add || graph[id].type != ir::Type::Float) return {};
        for (int i = 0; i < 2; ++i) {
            const NodeId length = graph.arg(id, i), inside = graph.arg(id, 1 - i);
            if (graph[length].op != Op::Length || graph[inside].op != Op::Min) continue;
            const auto v = above_zero(Op::Max, graph.arg(length, 0)),
                       most = above_zero(Op::Min, inside);
            if (!v || !most) continue;
            std::vector<NodeId> found, wanted;
            greatest_of(*most, found);
            for (int c = 0; c < ir::components(graph[*v].type); ++c)
                wanted.push_back(graph.component(*v, c));
            std::sort(found.begin(), found.end());
            std::sort(wanted.begin(), wanted.end());
            if (found == wanted) return v;
        }
        return {};
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
        if (!t) return emit(scope, out);
        bool still = true;
        std::vector<Slot> constants;
        for (NodeId c : t->constants) {
            constants.push_back(slot(scope, c));
            still = still && !varies[constants.back()];
        }
        const Slot of = slot(scope, t->of);
        if (!still && !scope.loop) return emit(scope, out);
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
    // x of max(x, 0), or of min(x, 0).
    std::optional<NodeId> above_zero(Op op, NodeId id) {
        if (graph[id].op != op) return {};
        for (int i = 0; i < 2; ++i)
            if (all_zero(graph.arg(id, i))) return graph.arg(id, 1 - i);
        return {};
    }
    bool all_zero(NodeId id) {
        if (!graph.is_constant(id)) return false;
        const ir::Constant &c = graph.constant_of(id);
        for (int i = 0; i < ir::components(c.type); ++i)
            if (c.value[static_cast<std::size_t>(i)] != 0) return false;
        return true;
    }
    void greatest_of(NodeId id, std::vector<NodeId> &out) {
        if (graph[id].op == Op::Max && graph[id].type == ir::Type::Float) {
            greatest_of(graph.arg(id, 0), out);
            greatest_of(graph.arg(id, 1), out);
        } else if (out.size() < 4) {
            out.push_back(id);
        }
    }

    Slot flatten_node(Scope &scope, NodeId id) {
        const ir::Node node = graph[id]; // a copy: recognising a form may add nodes
        Instruction out;
        out.op = node.op;
        out.type = node.type;
        out.payload = node.payload;
        out.node = id;
        out.cancels = cancelling.contains(id);
        switch (look_of_op[node.op]) {
        case Look::Point: out.varies = true; return emit(scope, out);
        case Look::Call: return call(scope, id, ir::FunctionId{node.payload});
        case Look::Cached:
            if (node.payload < context.cached.size() && context.cached[node.payload]) break;
            return call(scope, id, graph.cache(ir::CacheId{node.payload}).field);
        case Look::Loop: return loop(scope, id);
        case Look::LoopResult: {
            slot(scope, graph.arg(id, 0));
            return loop_results.at(graph.arg(id, 0))[node.payload];
        }
        case Look::Sum:
            if (auto parts = wave(id)) {
                out.form = Form::Wave;
                out.args = {slot(scope, parts->x), slot(scope, parts->m)};
                for (NodeId arg : std::vector<NodeId>(graph.args(id).begin(), graph.args(id).end()))
                    out.cancels = out.cancels || cancelling.contains(arg);
                return emit(scope, out);
            }
            if (auto smooth = smooth_extremum(graph, id); smooth &&
                                                          !varies[slot(scope, smooth->k)] &&
                                                          !varies[slot(scope, smooth->divisor)]) {
                out.form = Form::Smooth;
                out.payload = (smooth->greater ? 1u : 0u) + (smooth->divides ? 2u : 0u) +
                              (smooth->clipped ? 4u : 0u);
                out.args = {slot(scope, smooth->x), slot(scope, smooth->y), slot(scope, smooth->k)};
                return emit(scope, out);
            }
            if (const auto sum = log_sum(graph, id)) {
                out.form = Form::LogSum;
                out.op = sum->log;
                out.args = {slot(scope, sum->a), slot(scope, sum->b)};
                return emit(scope, out);
            }
            if (ir::is_vector(node.type)) {
                for (NodeId a : std::vector<NodeId>(graph.args(id).begin(), graph.args(id).end()))
                    out.args.push_back(slot(scope, a));
                return emit_turned(scope, id, std::move(out));
            }
            if (auto v = corner(id)) {
                out.form = Form::Corner;
                out.args = {slot(scope, *v)};
                return emit(scope, out);
            }
            break;
        case Look::Root:
            if (auto parts = norm_parts(id)) {
                out.form = Form::Norm;
                for (NodeId part : *parts) out.args.push_back(slot(scope, part));
                return emit(scope, out);
            }
            break;
        case Look::Length:
            out.form = Form::Norm;
            out.args = {slot(scope, graph.arg(id, 0))};
            return emit(scope, out);
        case Look::Product:
            if (graph.arg(id, 0) == graph.arg(id, 1)) {
                out.form = Form::Square;
                out.args = {slot(scope, graph.arg(id, 0))};
                return emit(scope, out);
            }
            for (int i = 0; i < 2; ++i) {
                NodeId x = graph.arg(id, i), power = graph.arg(id, 1 - i);
                if (graph[power].op != Op::Pow || graph[graph.arg(power, 0)].op != Op::Abs)
                    continue;
                auto exponent = number(graph.arg(power, 1));
                if (graph.arg(graph.arg(power, 0), 0) != x || !exponent || *exponent <= 0) continue;
                out.form = Form::OddPower;
                out.args = {slot(scope, x), slot(scope, graph.arg(power, 1))};
                return emit(scope, out);
            }
            break;
        case Look::Quotient: {
            NodeId a = graph.arg(id, 0), b = graph.arg(id, 1);
            if (graph[a].op == Op::Sin && graph.arg(a, 0) == b) {
                out.form = Form::Sinc;
                out.args = {slot(scope, b)};
                return emit(scope, out);
            }
            if (graph[b].op == Op::Splat && graph[graph.arg(b, 0)].op == Op::Length &&
                graph.arg(graph.arg(b, 0), 0) == a) {
                out.op = Op::Normalize;
                out.args = {slot(scope, a)};
                return emit(scope, out);
            }
            break;
        }
        case Look::Vector: {
            if (out.op == Op::MatMul && ir::is_vector(node.type))
                for (int i = 0; i < 2; ++i)
                    if (const NodeId m = graph.arg(id, i); ir::is_matrix(graph[m].type))
                        out.norm = matrix_norm(graph, m).value_or(out.norm);
            for (NodeId a : std::vector<NodeId>(graph.args(id).begin(), graph.args(id).end()))
                out.args.push_back(slot(scope, a));
            return emit_turned(scope, id, std::move(out));
        }
        case Look::Choice: {
            NodeId condition = graph.arg(id, 0);
            for (NodeId a : std::vector<NodeId>(graph.args(id).begin(), graph.args(id).end()))
                out.args.push_back(slot(scope, a));
            if (!varies[out.args[0]]) {
                out.form = Form::Joined; // either arm, the same for all points
            } else {
                auto [known, is_new] = context.joined.emplace(id, false);
                if (is_new) {
                    bool agrees = arms_agree(graph, condition, graph.arg(id, 1), graph.arg(id, 2));
                    context.joined[id] = agrees;
                }
                if (context.joined[id]) out.form = Form::Joined;
            }
            return emit(scope, out);
        }
        case Look::Plain: break;
        }
        for (NodeId a : std::vector<NodeId>(graph.args(id).begin(), graph.args(id).end()))
            out.args.push_back(slot(scope, a));
        return emit(scope, out);
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
    if (has_steps(context.graph, root)) {
        const NodeId whole = written_out(context.graph, root);
        flattener.cancelling = cancelling_steps(context.graph, whole);
        if (!flattener.cancelling.empty()) root = whole;
    }
    Scope scope;
    scope.block = &flattener.tape.each;
    flattener.tape.result = flattener.slot(scope, root);
    return std::move(flattener.tape);
}

} // namespace fathom::proof
