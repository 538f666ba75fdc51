// Displacements that are sums, as octaves of noise are: with the first terms alone, and the most
// that the others can add, a ray may step by a bound that is less steep (lipschitz.md, 3,
// nested octaves).
#include "ir/passes/inline.h"
#include "proof/prover.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace fathom::proof {

using ir::NodeId;
using ir::Op;
using ir::Shape;
using ir::ShapeId;
using ir::rounding::up;

namespace {

constexpr std::size_t max_octaves = 16, max_of_a_sum = 1'000;
constexpr double worth = 0.95; // a partial sum is used where its bound is that much less

// Calls and short loops written out, so that the turns of a sum are its terms. Nothing where a loop
// is long, or does not run a known number of turns.
struct Unrolled {
    ir::Graph &graph;
    std::map<NodeId, NodeId> known{};
    bool failed = false;

    NodeId of(NodeId id) {
        if (failed || !graph.reads(id).point) return id;
        if (const auto found = known.find(id); found != known.end()) return found->second;
        if (known.size() > max_of_a_sum) failed = true;
        const ir::Node node = graph[id];
        std::vector<NodeId> args(graph.args(id).begin(), graph.args(id).end());
        NodeId out = id;
        if (node.op == Op::LoopResult ||
            node.op == Op::Loop) { // the loop itself is its first value
            const bool first = node.op == Op::Loop;
            const std::vector<NodeId> ends = final_values(first ? id : args[0]);
            if (failed) return id;
            out = ends[first ? 0 : node.payload];
        } else if (node.type == ir::Type::Float &&
                   (node.op == Op::Add || node.op == Op::Sub || node.op == Op::Neg ||
                    node.op == Op::Mul || node.op == Op::Div)) {
            for (NodeId &arg : args) arg = of(arg);
            out = graph.make(node.op, node.type, args, node.payload);
        } else if (node.op == Op::Call) {
            if (sums(graph.function(ir::FunctionId{node.payload}).result))
                out = of(ir::called(graph, id));
        }
        return known[id] = out;
    }
    // What is worth writing out: sums and loops, not what a term calls.
    bool sums(NodeId id) const {
        const Op op = graph[id].op;
        return op == Op::Add || op == Op::Sub || op == Op::Neg || op == Op::Mul || op == Op::Div ||
               op == Op::LoopResult || op == Op::Loop;
    }
    // The loop's values after its last iteration.
    std::vector<NodeId> final_values(NodeId loop_node) {
        const ir::Loop loop = graph.loop(ir::LoopId{graph[loop_node].payload});
        const auto count = graph.as_number(loop.count);
        std::vector<NodeId> state(graph.args(loop_node).begin(), graph.args(loop_node).end());
        failed = failed || !count || *count < 0 || *count > double(max_octaves) || loop.condition;
        for (int iteration = 0; !failed && iteration < int(*count); ++iteration)
            state = ir::after_iteration(graph, loop, iteration, state);
        return state;
    }
};

// The terms of a sum, numbers before a bracket multiplied out.
void split_sum(ir::Graph &graph, NodeId id, NodeId factor, std::vector<NodeId> &out) {
    const ir::Node node = graph[id];
    const auto arg = [&](int i) { return graph.arg(id, i); };
    const auto still = [&](NodeId a) { // a number, params apart
        return graph.type(a) == ir::Type::Float && !graph.reads(a).point &&
               !graph.reads(a).free_vars;
    };
    if (out.size() <= max_octaves && node.type == ir::Type::Float && graph.reads(id).point) {
        if (node.op == Op::Add || node.op == Op::Sub) {
            split_sum(graph, arg(0), factor, out);
            split_sum(graph, arg(1), node.op == Op::Add ? factor : graph.neg(factor), out);
            return;
        }
        if (node.op == Op::Neg) return split_sum(graph, arg(0), graph.neg(factor), out);
        if (node.op == Op::Mul && still(arg(0)))
            return split_sum(graph, arg(1), graph.mul(factor, arg(0)), out);
        if (node.op == Op::Mul && still(arg(1)))
            return split_sum(graph, arg(0), graph.mul(factor, arg(1)), out);
        if (node.op == Op::Div && still(arg(1)))
            return split_sum(graph, arg(0), graph.div(factor, arg(1)), out);
    }
    out.push_back(graph.mul(factor, id));
}

} // namespace

std::vector<ir::PartialSum> Prover::partial_sums(ShapeId id, double slope) {
    const Shape shape = scene.shapes[id];
    std::vector<ir::PartialSum> out;
    std::vector<NodeId> terms;
    Unrolled unrolled{graph};
    const NodeId whole = unrolled.of(shape.args[0]);
    if (unrolled.failed) return out;
    split_sum(graph, whole, graph.number(1), terms);
    if (terms.size() < 2 || terms.size() > max_octaves) return out;
    // One look at all of the place: what noise says of itself does not depend on where it is.
    const Cell box = to_cell(place(id).box);
    const auto measured = [&](NodeId field, Interval &value) {
        const Tape tape = flatten(flattening, field);
        if (tape.too_large) return ir::rounding::infinity;
        Machine machine(tape, ranges);
        machine.run(box);
        value = machine.value(0);
        return machine.norm();
    };
    std::vector<Interval> rest(terms.size() + 1); // of the terms from here on
    for (std::size_t i = terms.size(); i-- > 0;) {
        Interval value;
        measured(terms[i], value);
        rest[i] = rest[i + 1] + value;
    }
    const double own = child(shape).fact.lipschitz_sup;
    NodeId sum = terms[0];
    for (std::size_t i = 1; i < terms.size(); ++i) {
        Interval value;
        ir::PartialSum partial{sum, 0, rest[i].hi, rest[i].lo};
        partial.slope = measured(sum, value) * options.rules[Rule::Displace];
        const double shorter = own + (out.empty() ? 0 : out.back().slope);
        if (rest[i].finite() && own + partial.slope <= worth * (own + slope) &&
            (out.empty() || shorter <= worth * (own + partial.slope))) {
            const double loose = 1e-5 * rest[i].magnitude(); // as of the range shell: float32
            partial.maximum = up(partial.maximum + loose) * options.rules[Rule::Octaves];
            partial.minimum = -up(-partial.minimum + loose);
            out.push_back(partial);
        }
        sum = graph.add(sum, terms[i]);
    }
    if (!out.empty()) out.push_back({sum, slope, 0, 0}); // so that all share their terms
    return out;
}

} // namespace fathom::proof
