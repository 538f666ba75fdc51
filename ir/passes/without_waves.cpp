// Sums are written out by component, each wave as what it is of less its steps; what is left of a term
// that was added and taken off is nothing. Looks at few nodes, as it is asked when a node is made.
#include "ir/passes/without_waves.h"

#include "ir/passes/inline.h"

#include <cmath>
#include <compare>
#include <map>
#include <unordered_map>

namespace fathom::ir {
namespace {

constexpr int max_depth = 14, max_visits = 200; // of a sum, and of what sums are looked for in
constexpr std::size_t max_visits_in_all = 2000;
constexpr OpSet sums{Op::Add,  Op::Sub,     Op::Neg,   Op::Mul,   Op::Div, Op::Mod,
                     Op::Make, Op::Swizzle, Op::Splat, Op::Fract, Op::Call};

// In which sums are looked for.
constexpr OpSet through{Op::Sin,  Op::Cos,   Op::Dot,     Op::Length, Op::Add,    Op::Sub,
                        Op::Mul,  Op::Div,   Op::Neg,     Op::Abs,    Op::Min,    Op::Max,
                        Op::Make, Op::Splat, Op::Swizzle, Op::Clamp,  Op::MatMul, Op::Call};

struct Amount {
    double is = 0, size = 0; // of all that was added up to it
    bool is_nothing() const { return std::fabs(is) <= 1e-14 * size; }
};

// A component of a node; or, where `period` is not 0, how often a wave's period fits in it. No node is
// made of it before it is known to be left.
struct Part {
    NodeId of;
    int component = 0;
    double period = 0;
    friend auto operator<=>(const Part &, const Part &) = default;
};

// What all sums of a number share.
struct Work {
    Graph &graph;
    std::size_t visits = 0; // of nodes; one that is made is one
    std::unordered_map<NodeId, NodeId> bodies{};

    NodeId body(NodeId call) {
        if (const auto known = bodies.find(call); known != bodies.end()) return known->second;
        const std::size_t before = graph.size();
        const NodeId body = called(graph, call);
        visits += graph.size() - before;
        return bodies[call] = body;
    }
};

struct Sum {
    Work &work;
    std::map<NodeId, bool> ways; // of a choice, by its condition: the arm that is taken
    Graph &graph = work.graph;
    std::map<Part, Amount> terms{};
    double number = 0;
    NodeId open{}; // the condition of a choice that is met
    int left = max_visits;
    bool failed = false;

    int place(NodeId id, int c) const { return is_vector(graph.type(id)) ? c : 0; }
    std::optional<double> constant(NodeId id, int c) const {
        if (graph[id].op == Op::Splat) return constant(graph.arg(id, 0), 0);
        if (!graph.is_constant(id)) return {};
        return graph.constant_of(id).value[static_cast<std::size_t>(place(id, c))];
    }
    void term(Part part, double by) {
        terms[part].is += by;
        terms[part].size += std::fabs(by);
    }
    NodeId made(const Part &part) {
        const bool vector = is_vector(graph.type(part.of));
        NodeId scalar = vector ? graph.component(part.of, part.component) : part.of;
        if (part.period == 0) return scalar;
        if (part.period != 1) scalar = graph.div(scalar, graph.number(part.period));
        return graph.make(Op::Floor, {scalar});
    }
    // x less its wave of period m, times `by`.
    void steps(NodeId x, double m, int c, double by) { term({x, place(x, c), m}, by * m); }
    void add_part(NodeId made, int c, double by, int depth) {
        for (NodeId part : graph.args(made)) {
            const int size = components(graph.type(part));
            if (c < size) return add(part, c, by, depth);
            c -= size;
        }
        failed = true;
    }
    void add(NodeId id, int c, double by, int depth) {
        if (--left < 0 || depth > max_depth || ++work.visits > max_visits_in_all) failed = true;
        if (failed) return;
        const Node node = graph[id];
        if (const auto known = constant(id, c)) {
            number += by * *known;
            return;
        }
        const auto of = [&](int a, double times) {
            const NodeId arg = graph.arg(id, a);
            add(arg, place(arg, c), times, depth + 1);
        };
        if (node.op == Op::Call) return add(work.body(id), c, by, depth + 1);
        const auto factor = [&](int a) { return constant(graph.arg(id, a), c); };
        if (node.op == Op::Add || node.op == Op::Sub) {
            of(0, by);
            return of(1, node.op == Op::Add ? by : -by);
        }
        if (node.op == Op::Neg || node.op == Op::Splat) return of(0, node.op == Op::Neg ? -by : by);
        if (node.op == Op::Make && is_vector(node.type)) return add_part(id, c, by, depth + 1);
        if (node.op == Op::Swizzle)
            return add(graph.arg(id, 0), swizzle_component(node.payload, c), by, depth + 1);
        if (node.op == Op::Mul)
            for (int a = 0; a < 2; ++a)
                if (const auto k = factor(a)) return of(1 - a, by * *k);
        if (node.op == Op::Div)
            if (const auto k = factor(1); k && *k != 0) return of(0, by / *k);
        if (node.op == Op::Fract || node.op == Op::Mod)
            if (const auto m = node.op == Op::Fract ? std::optional(1.0) : factor(1);
                m && *m != 0) {
                of(0, by);
                return steps(graph.arg(id, 0), *m, c, -by);
            }
        if (node.op == Op::Select) {
            const NodeId condition = graph.arg(id, 0);
            if (const auto way = ways.find(condition); way != ways.end())
                return of(way->second ? 1 : 2, by);
            if (!open) open = condition;
        }
        term({id, place(id, c), 0}, by);
    }
    // Whether something was added and taken off.
    bool cancels() const {
        bool some = false;
        for (const auto &[part, amount] : terms) some = some || amount.is_nothing();
        return some;
    }
    NodeId written() {
        NodeId out;
        const auto with = [&](NodeId one) { out = out ? graph.add(out, one) : one; };
        for (const auto &[part, amount] : terms) {
            if (amount.is_nothing()) continue;
            const NodeId one = made(part);
            with(amount.is == 1 ? one : graph.mul(one, graph.number(amount.is)));
        }
        if (number != 0 || !out) with(graph.number(number));
        return out;
    }
};

// By component; none where nothing cancels.
NodeId cancelled(Work &work, NodeId id, int c, const std::map<NodeId, bool> &ways) {
    constexpr std::size_t max_choices = 2;
    Sum sum{work, ways};
    sum.add(id, c, 1, 0);
    if (sum.failed) return {};
    if (sum.cancels() && !sum.open) return sum.written();
    if (!sum.open || ways.size() >= max_choices) return sum.cancels() ? sum.written() : NodeId{};
    auto first = ways, second = ways;
    first[sum.open] = true;
    second[sum.open] = false;
    const NodeId a = cancelled(work, id, c, first),
                 b = a ? cancelled(work, id, c, second) : NodeId{};
    if (b) return work.graph.make(Op::Select, {sum.open, a, b});
    return sum.cancels() ? sum.written() : NodeId{};
}

struct Rewriter {
    Graph &graph;
    Work work{graph};
    std::unordered_map<NodeId, NodeId> known{};
    int left = max_visits;

    NodeId of_sum(NodeId id) {
        const Type type = graph.type(id);
        if (type != Type::Float && !is_vector(type)) return {};
        std::vector<NodeId> parts;
        bool some = false;
        for (int c = 0; c < components(type); ++c) {
            parts.push_back(cancelled(work, id, c, {}));
            some = some || parts.back();
        }
        if (!some) return {};
        for (int c = 0; c < components(type); ++c)
            if (NodeId &part = parts[static_cast<std::size_t>(c)]; !part)
                part = graph.component(id, c);
        return parts.size() == 1 ? parts.front() : graph.make(Op::Make, type, parts);
    }
    NodeId rewritten(NodeId id, int depth) {
        if (const auto it = known.find(id); it != known.end()) return it->second;
        if (!graph.reads(id).point && !graph.reads(id).free_vars) return id;
        if (!through[graph[id].op] || --left < 0 || depth > max_depth) return id;
        NodeId out = sums[graph[id].op] ? of_sum(id) : NodeId{};
        if (!out && graph[id].op == Op::Call) out = id;
        if (!out) {
            std::vector<NodeId> args(graph.args(id).begin(), graph.args(id).end());
            bool changes = false;
            for (NodeId &arg : args) {
                const NodeId other = rewritten(arg, depth + 1);
                changes = changes || other != arg;
                arg = other;
            }
            out = changes ? graph.make(graph[id].op, graph.type(id), args, graph[id].payload) : id;
        }
        known[id] = out;
        return out;
    }
};

// Is there a wave, or a rounded number that one may be made of, to be seen at all?
bool has_waves(const Graph &graph, NodeId root, std::size_t &visits) {
    constexpr OpSet waves{Op::Fract, Op::Mod, Op::Floor, Op::Ceil, Op::Round, Op::Trunc},
        ends{Op::Loop, Op::LoopResult, Op::Hash};
    std::vector<NodeId> todo{root};
    for (int left = max_visits; !todo.empty() && left > 0; --left) {
        const NodeId id = todo.back();
        todo.pop_back();
        ++visits;
        if (waves[graph[id].op]) return true;
        if (ends[graph[id].op]) continue;
        if (graph[id].op == Op::Call)
            todo.push_back(graph.function(FunctionId{graph[id].payload}).result);
        todo.insert(todo.end(), graph.args(id).begin(), graph.args(id).end());
    }
    return false;
}

} // namespace

NodeId without_waves(Graph &graph, NodeId id, std::size_t &visits) {
    if (!sums[graph[id].op] && !through[graph[id].op]) return id;
    if (!has_waves(graph, id, visits)) return id;
    Rewriter rewriter{graph};
    const NodeId written = rewriter.rewritten(id, 0);
    visits += rewriter.work.visits;
    return written;
}

} // namespace fathom::ir
