// The bound of a field as it stands; where that is refused for a border that is not seen to be met or
// for a singular place, of the field with its loops written out, and for each value of a whole param alone. Proofs:
// docs/lipschitz.md, 2.12.
#include "ir/passes/inline.h"
#include "ir/passes/walk.h"
#include "proof/majorants.h"
#include "proof/ordered.h"
#include "proof/prover.h"

#include <algorithm>
#include <cmath>

namespace fathom::proof {

using ir::NodeId;
using ir::Op;

namespace {

constexpr std::size_t max_nodes_written = 4'000;
constexpr int most_values = 24; // of a param

// The first whole param that an expression reads outside of loops and calls.
std::optional<NodeId> whole_param(const ir::Graph &graph, NodeId root) {
    std::vector<NodeId> todo{root};
    std::unordered_set<NodeId> seen;
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!graph.reads(id).params || !seen.insert(id).second) continue;
        if (graph[id].op == Op::Param && graph[id].type == ir::Type::Int) return id;
        todo.insert(todo.end(), graph.args(id).begin(), graph.args(id).end());
    }
    return {};
}

} // namespace

FieldBound Prover::bound_written(NodeId field, const Domain &domain, const Budget &budget) {
    if (!flattening.written.contains(field))
        if (const auto by_scale = bound_by_scale(field, domain, budget)) return *by_scale;
    FieldBound out = bound_field(flattening, ranges, field, domain, budget);
    if (std::isfinite(out.lipschitz) || flattening.written.contains(field)) return out;
    // of each power that a whole param can be it may be known that it is not singular
    const bool jumps = out.trouble == Trouble::Jump, singular = out.trouble == Trouble::Singular,
               has_powers = singular && out.cause == Op::Pow;
    if (!jumps && !singular) return out;
    work.take(max_nodes_written);
    ir::WithoutCalls written = ir::without_loops(graph, field, max_nodes_written);
    if (!written.all) return out;
    written.root = with_extremes_for_choices(graph, written.root);
    if (written.root != field) {
        flattening.written[field] = written.root;
        const FieldBound again = bound_field(flattening, ranges, field, domain, budget);
        if (std::isfinite(again.lipschitz)) return again;
        flattening.written.erase(field);
        if (again.trouble == Trouble::Jump) out = again; // rather than a place that no turn meets
    }
    if (!jumps && !has_powers) return out;
    const FieldBound by_values = bound_by_values(written.root, domain, budget);
    return std::isfinite(by_values.lipschitz) ? by_values : out;
}

// Of a field that divides by a scale which its loops carry along: what they multiply is seen where
// they are written out (2.45).
std::optional<FieldBound> Prover::bound_by_scale(NodeId field, const Domain &domain,
                                                 const Budget &budget) {
    if (!may_divide_by_scale(graph, field)) return {};
    const ir::WithoutCalls written = ir::without_loops(graph, field, max_nodes_written);
    work.take(max_nodes_written);
    if (!written.all || !divides_by_scale(graph, written.root, work)) return {};
    flattening.written[field] = written.root;
    FieldBound out = bound_field(flattening, ranges, field, domain, budget);
    if (std::isfinite(out.lipschitz)) return out;
    flattening.written.erase(field);
    return {};
}

// The greatest over the values that a whole param can have.
FieldBound Prover::bound_by_values(NodeId field, const Domain &domain, const Budget &budget) {
    FieldBound out;
    out.lipschitz = ir::rounding::infinity;
    const auto param = whole_param(graph, field);
    if (!param) return out;
    const Interval range = ranges.params[graph[*param].payload][0];
    if (!range.finite() || !(range.width() < most_values)) return out;
    FieldBound most;
    most.value = Interval{ir::rounding::infinity, -ir::rounding::infinity};
    for (double value = std::ceil(range.lo); value <= range.hi; ++value) {
        const NodeId one =
            ir::substitute(graph, field, {{*param, graph.integer(static_cast<int>(value))}});
        const FieldBound here = bound_field(flattening, ranges, one, domain, budget);
        if (!std::isfinite(here.lipschitz)) return out;
        most.lipschitz = std::max(most.lipschitz, here.lipschitz);
        most.sampled = std::max(most.sampled, here.sampled);
        most.value = hull(most.value, here.value);
        most.evaluations += here.evaluations;
    }
    return most;
}

} // namespace fathom::proof
