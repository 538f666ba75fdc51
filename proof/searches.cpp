// Choices are followed from the innermost one out: the nearest so far is the lesser of two lengths, so
// the next comparison is one of lengths as well (docs/lipschitz.md, 2.2, 2.44).
#include "proof/searches.h"

#include "ir/passes/walk.h"
#include "proof/continuity.h"
#include "proof/enclosed.h"
#include "proof/roots.h"

#include <algorithm>
#include <cmath>

namespace fathom::proof {

using ir::Graph;
using ir::NodeId;
using ir::Op;

namespace {

// The one choice of vectors that a vector is made of, by component or whole.
NodeId choice_in(const Graph &graph, NodeId vector, int depth = 0) {
    constexpr int max_depth = 6;
    constexpr ir::OpSet made{Op::Make, Op::Swizzle, Op::Add, Op::Sub, Op::Mul, Op::Div, Op::Neg};
    if (graph[vector].op == Op::Select && ir::is_vector(graph.type(vector))) return vector;
    if (!made[graph[vector].op] || depth > max_depth) return {};
    NodeId found;
    for (NodeId arg : graph.args(vector)) {
        const NodeId own = choice_in(graph, arg, depth + 1);
        if (own && found && own != found) return {};
        if (own) found = own;
    }
    return found;
}

// Is the number x `of`, its square, or what it is the square of, all over least and greatest numbers?
enum class Power { Same, Square, Root };
bool is_power_of(const Graph &graph, NodeId x, NodeId of, Power power, int &left) {
    if (--left < 0) return false;
    if (x == of) return power == Power::Same;
    const ir::Node a = graph[x], b = graph[of];
    if (power == Power::Root) return is_power_of(graph, of, x, Power::Square, left);
    const auto is_square = [&] {
        const NodeId v = graph.arg(x, 0);
        return power == Power::Square && v == graph.arg(x, 1) && v == graph.arg(of, 0);
    };
    if (a.op == Op::Dot && b.op == Op::Length) return is_square();
    if (a.op != b.op || (a.op != Op::Min && a.op != Op::Max)) return false;
    const auto fits = [&](int i, int k) {
        return is_power_of(graph, graph.arg(x, i), graph.arg(of, k), power, left);
    };
    return (fits(0, 0) && fits(1, 1)) || (fits(0, 1) && fits(1, 0));
}

// `if x < y { a } else { b }` of lengths or their squares a and b that x and y are, or their squares
// or roots: the lesser; with b and a, the greater.
NodeId extremum_of(Graph &graph, NodeId condition, NodeId a, NodeId b) {
    if (graph[condition].op != Op::Less && graph[condition].op != Op::LessEqual) return {};
    const NodeId x = graph.arg(condition, 0), y = graph.arg(condition, 1);
    for (const Power power : {Power::Same, Power::Square, Power::Root}) {
        int left = 400;
        const auto are = [&](NodeId first, NodeId second) {
            return is_power_of(graph, x, first, power, left) &&
                   is_power_of(graph, y, second, power, left);
        };
        if (are(a, b)) return graph.make(Op::Min, {b, a});
        if (are(b, a)) return graph.make(Op::Max, {b, a});
    }
    return {};
}

// The length of a choice of vectors, or its square, as a choice of what these are of the arms, the
// innermost choice first; none where the vectors themselves agree, or these do not.
NodeId choice_of_lengths(Graph &graph, NodeId id, Work &work, int depth = 0) {
    constexpr int max_depth = 64;
    const NodeId choice = choice_in(graph, graph.arg(id, 0));
    if (!choice || depth > max_depth || work.spent()) return {};
    work.take(64);
    const NodeId condition = graph.arg(choice, 0), first = graph.arg(choice, 1),
                 second = graph.arg(choice, 2);
    if (!graph.reads(condition).point || arms_agree(graph, condition, first, second, work))
        return {};
    NodeId a = ir::substitute(graph, id, {{choice, first}}),
           b = ir::substitute(graph, id, {{choice, second}});
    for (NodeId *arm : {&a, &b}) {
        if (graph[*arm].op != graph[id].op) continue;
        if (const NodeId inner = choice_of_lengths(graph, *arm, work, depth + 1)) *arm = inner;
    }
    if (const NodeId extremum = extremum_of(graph, condition, a, b)) return extremum;
    return arms_agree(graph, condition, a, b, work) ? graph.make(Op::Select, {condition, a, b})
                                                    : NodeId{};
}

// In what is compared, too.
NodeId with_choices_of_lengths(Graph &graph, NodeId root, Work &work) {
    ir::Substitution map;
    for (NodeId id : nodes_below(graph, root)) {
        const ir::Node node = graph[id];
        const bool is_square = node.op == Op::Dot && graph.arg(id, 0) == graph.arg(id, 1);
        if (node.op != Op::Length && !is_square) continue;
        if (const NodeId other = choice_of_lengths(graph, id, work)) map[id] = other;
    }
    return map.empty() ? root : ir::substitute(graph, root, map);
}

// A row of a table by a choice of numbers, as the choice of the rows.
NodeId chosen_row(Graph &graph, NodeId read, NodeId row, int depth = 0) {
    constexpr int max_depth = 64;
    const ir::Node node = graph[read];
    if (graph[row].op == Op::Select && depth < max_depth) {
        const NodeId a = chosen_row(graph, read, graph.arg(row, 1), depth + 1),
                     b = a ? chosen_row(graph, read, graph.arg(row, 2), depth + 1) : NodeId{};
        return b ? graph.make(Op::Select, {graph.arg(row, 0), a, b}) : NodeId{};
    }
    const auto number = graph.as_number(row);
    const ir::Table &table = graph.table(ir::table_of(node.payload));
    if (!number || *number < 0 || *number >= table.rows) return {};
    ir::Constant numbers{node.type, {}};
    for (int c = 0; c < ir::components(node.type); ++c)
        numbers.value[std::size_t(c)] = double(
            table.data[std::size_t(int(*number) * table.stride + ir::column_of(node.payload) + c)]);
    return graph.constant(numbers);
}

// Comparisons, least and greatest numbers that are decided at all points of the region, as they are:
// a search begins with a number that is larger than all that is compared with it. For fields that
// choose among vectors, or rows.
NodeId with_searches_begun(Graph &graph, NodeId root, const std::array<Interval, 3> &region,
                           const Ranges *ranges, Work &work) {
    std::vector<NodeId> nodes = nodes_below(graph, root);
    ir::Substitution map;
    bool chooses = false;
    for (NodeId id : nodes) {
        const ir::Node node = graph[id];
        chooses = chooses || (node.op == Op::Select && ir::is_vector(node.type));
        if (node.op != Op::TableRead || graph[graph.arg(id, 0)].op != Op::Select) continue;
        if (const NodeId row = chosen_row(graph, id, graph.arg(id, 0))) map[id] = row;
    }
    if (!chooses && map.empty()) return root;
    if (!map.empty()) root = ir::substitute(graph, root, map), nodes = nodes_below(graph, root);
    work.take(4 * nodes.size());
    map.clear();
    Enclosed values(graph, ranges, region);
    for (NodeId id : nodes) {
        const ir::Node node = graph[id];
        constexpr ir::OpSet decides{Op::Less, Op::LessEqual, Op::Min, Op::Max};
        if (!decides[node.op] || graph[graph.arg(id, 0)].type != ir::Type::Float) continue;
        const NodeId a = graph.arg(id, 0), b = graph.arg(id, 1);
        if (!graph.is_constant(a) && !graph.is_constant(b)) continue;
        const Interval x = values.of(a), y = values.of(b);
        // beyond what single precision makes of them
        const double apart = 1e-3 * std::min(x.magnitude() + y.magnitude(), 1e30);
        const bool lesser = x.hi + apart<y.lo, greater = x.lo - apart> y.hi;
        if (!lesser && !greater) continue;
        const bool truth = node.op == Op::Less || node.op == Op::LessEqual;
        map[id] = truth ? graph.boolean(lesser) : lesser == (node.op == Op::Min) ? a : b;
    }
    return map.empty() ? root : ir::substitute(graph, root, map);
}

} // namespace

NodeId with_chosen_lengths(Graph &graph, NodeId root, const std::array<Interval, 3> *region,
                           const Ranges *ranges, Work &work) {
    constexpr int max_rounds = 8;
    if (region) root = with_searches_begun(graph, root, *region, ranges, work);
    for (int round = 0; round < max_rounds; ++round) {
        const NodeId next = with_choices_of_lengths(graph, root, work);
        if (next == root) break;
        root = next;
    }
    return root;
}

} // namespace fathom::proof
