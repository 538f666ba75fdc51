#include "proof/half_waves.h"

#include "ir/passes/walk.h"
#include "proof/continuity.h"
#include "proof/exact.h"
#include "proof/lattices.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_map>
#include <unordered_set>

namespace fathom::proof {
namespace {

using ir::Graph;
using ir::NodeId;
using ir::Op;

// What a component becomes where one component of a node is negated, and all else stays.
enum class Answer : std::uint8_t { Same, Negated, Either, Other };

class Negation {
  public:
    Negation(const Graph &graph, NodeId of, int component)
        : graph_(graph), of_(of), component_(component) {}

    Answer at(NodeId id, int c) {
        const int size = ir::components(graph_.type(id));
        if (id == of_) return c == component_ ? Answer::Negated : Answer::Same;
        if (graph_[id].count == 0) return Answer::Same;
        const std::uint64_t key = std::uint64_t(id.index) * 16 + std::uint64_t(std::min(c, 15));
        if (const auto known = known_.find(key); known != known_.end()) return known->second;
        if (depth_ > max_depth || known_.size() > max_known || c >= size) return Answer::Other;
        ++depth_;
        const Answer found = found_at(id, c);
        --depth_;
        return known_[key] = found;
    }

  private:
    static constexpr int max_depth = 300;
    static constexpr std::size_t max_known = 4000;

    static Answer square(Answer a) { return a == Answer::Other ? a : Answer::Same; }
    static Answer sum(Answer a, Answer b) {
        return a == b && a != Answer::Either ? a : Answer::Other;
    }
    static Answer product(Answer a, Answer b) {
        if (a == Answer::Other || b == Answer::Other) return Answer::Other;
        if (a == Answer::Either || b == Answer::Either) return Answer::Either;
        return a == b ? Answer::Same : Answer::Negated;
    }
    // The same of the same.
    Answer unless_changed(NodeId id) {
        for (NodeId arg : graph_.args(id))
            for (int c = 0; c < ir::components(graph_.type(arg)); ++c)
                if (at(arg, c) != Answer::Same) return Answer::Other;
        return Answer::Same;
    }
    Answer of_squares(NodeId vector) {
        for (int c = 0; c < ir::components(graph_.type(vector)); ++c)
            if (at(vector, c) == Answer::Other) return Answer::Other;
        return Answer::Same;
    }
    Answer either_of(NodeId condition, Answer a, Answer b) {
        if (at(condition, 0) != Answer::Same || a == Answer::Other || b == Answer::Other)
            return Answer::Other;
        return a == b ? a : Answer::Either;
    }

    Answer found_at(NodeId id, int c) {
        constexpr ir::OpSet opaque{Op::Call, Op::Cached, Op::Loop, Op::LoopResult};
        const ir::Node node = graph_[id];
        if (opaque[node.op]) return Answer::Other;
        const auto arg = [&](int i) {
            const NodeId of = graph_.arg(id, i);
            return at(of, ir::components(graph_.type(of)) == 1 ? 0 : c);
        };
        if (node.op == Op::Select) return either_of(graph_.arg(id, 0), arg(1), arg(2));
        switch (ir::info(node.op).parity) {
        case ir::OpParity::Odd: return arg(0);
        case ir::OpParity::Even: return square(arg(0));
        case ir::OpParity::Sum: return sum(arg(0), arg(1));
        case ir::OpParity::Product:
            return graph_.arg(id, 0) == graph_.arg(id, 1) ? square(arg(0))
                                                          : product(arg(0), arg(1));
        case ir::OpParity::Parts: return part(id, c);
        case ir::OpParity::Own: return own(id);
        case ir::OpParity::None: break;
        }
        return unless_changed(id);
    }
    Answer own(NodeId id) {
        const Op op = graph_[id].op;
        const bool by_itself = op == Op::Dot && graph_.arg(id, 0) == graph_.arg(id, 1);
        return op == Op::Length || by_itself ? of_squares(graph_.arg(id, 0)) : unless_changed(id);
    }
    Answer part(NodeId id, int c) {
        const ir::Node node = graph_[id];
        if (node.op == Op::Splat && !ir::is_matrix(node.type)) return at(graph_.arg(id, 0), 0);
        if (node.op == Op::Swizzle)
            return at(graph_.arg(id, 0), ir::swizzle_component(node.payload, c));
        if (node.op == Op::Make && !ir::is_matrix(node.type)) return at(graph_.arg(id, c), 0);
        return unless_changed(id);
    }

    const Graph &graph_;
    NodeId of_;
    int component_;
    int depth_ = 0;
    std::unordered_map<std::uint64_t, Answer> known_;
};

bool is_even_in(const Graph &graph, NodeId root, NodeId of) {
    for (int c = 0; c < ir::components(graph.type(of)); ++c)
        if (Negation(graph, of, c).at(root, 0) != Answer::Same) return false;
    return true;
}

// x less `place`, where that is numbers.
std::optional<NodeId> numbers_beside(Graph &graph, NodeId x, NodeId place) {
    const int size = ir::components(graph.type(x));
    std::vector<NodeId> parts;
    for (int i = 0; i < size; ++i) {
        const auto rest =
            difference(graph, component_of(graph, x, i), component_of(graph, place, i));
        if (!rest || !graph.is_constant(*rest)) return {};
        parts.push_back(*rest);
    }
    return size == 1 ? parts[0] : graph.make(Op::Make, graph.type(x), parts);
}

// x less the way from the nearest point of a lattice, or one of two such ways, as the point: it is
// read by what is told of a cell, and there the way's sign is not seen. Choices among choices are
// opened a few times and no more: their arms may be shared.
std::optional<NodeId> as_point(Graph &graph, NodeId x, NodeId way, int depth = 0) {
    constexpr int most = 3;
    const ir::Node node = graph[way];
    if (node.op == Op::Select) {
        if (depth == most) return {};
        const auto a = as_point(graph, x, graph.arg(way, 1), depth + 1);
        if (!a) return {};
        const auto b = as_point(graph, x, graph.arg(way, 2), depth + 1);
        if (!b) return {};
        return graph.make(Op::Select, {graph.arg(way, 0), *a, *b});
    }
    const auto found = lattice(graph, way);
    if (!found || found->beyond != Numbers{}) return {};
    const NodeId place = place_of(graph, *found), m = period_of(graph, *found);
    const auto beside = numbers_beside(graph, x, place);
    if (!beside) return {};
    return graph.add({*beside, graph.mul(m, graph.make(Op::Round, {graph.div(place, m)}))});
}

// Is one of the nodes read by what tells numbers apart, which rounding alone may then turn?
bool tells_one_apart(const Graph &graph, NodeId root, const ir::Substitution &nodes) {
    std::vector<std::pair<NodeId, bool>> todo{{root, false}}; // and whether it is told apart
    std::unordered_set<NodeId> seen, told;
    while (!todo.empty()) {
        const auto [id, apart] = todo.back();
        todo.pop_back();
        if (!(apart ? told : seen).insert(id).second) continue;
        if (apart && nodes.contains(id)) return true;
        for (const NodeId arg : graph.args(id))
            todo.emplace_back(arg, apart || tells_apart[graph[id].op]);
    }
    return false;
}

// All `x - way` as what they are, where that is seen. They are no lattice's points for single
// precision, but for these and rounding: no hash of them is one number for all of a cell.
NodeId with_points(Graph &graph, NodeId root, const std::vector<NodeId> &nodes) {
    ir::Substitution map;
    for (const NodeId id : nodes) {
        if (graph[id].op != Op::Sub) continue;
        if (const auto point = as_point(graph, graph.arg(id, 0), graph.arg(id, 1)))
            map[id] = *point;
    }
    if (map.empty() || tells_one_apart(graph, root, map)) return root;
    return ir::substitute(graph, root, map);
}

// x less one of two points of lattices, as one of two ways from them.
std::optional<NodeId> as_ways(Graph &graph, NodeId x, NodeId point) {
    const bool is_part = graph[point].op == Op::Swizzle && graph.type(point) == ir::Type::Float;
    const NodeId choice = is_part ? graph.arg(point, 0) : point;
    if (graph[choice].op != Op::Select) return {};
    std::vector<NodeId> arms{graph.arg(choice, 0)};
    for (const int arm : {1, 2}) {
        NodeId own = graph.arg(choice, arm);
        if (is_part) own = component_of(graph, own, ir::swizzle_component(graph[point].payload, 0));
        arms.push_back(graph.sub(x, own));
        if (!lattice(graph, arms.back())) return {};
    }
    return graph.make(Op::Select, graph.type(x), arms);
}

// All of these among the nodes as such ways.
NodeId with_ways(Graph &graph, NodeId root, const std::vector<NodeId> &nodes) {
    ir::Substitution map;
    for (const NodeId id : nodes)
        if (graph[id].op == Op::Sub)
            if (const auto ways = as_ways(graph, graph.arg(id, 0), graph.arg(id, 1)))
                map[id] = *ways;
    return map.empty() ? root : ir::substitute(graph, root, map);
}

// The only choice that an expression reads, but for those in what tells numbers apart.
std::optional<NodeId> only_choice(const Graph &graph, NodeId root) {
    std::vector<NodeId> todo{root};
    std::unordered_set<NodeId> seen;
    std::optional<NodeId> out;
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!seen.insert(id).second) continue;
        const Op op = graph[id].op;
        if (op == Op::Select && out) return {};
        if (op == Op::Select)
            out = id;
        else if (tells_apart[op])
            return {};
        else
            todo.insert(todo.end(), graph.args(id).begin(), graph.args(id).end());
    }
    return out;
}

// A hash of one of two cells as one of two hashes, so that on either side of the choice it is of one
// cell alone; likewise a fraction, of which hashes are made.
NodeId with_chosen_hashes(Graph &graph, NodeId root) {
    constexpr ir::OpSet hashes{Op::Hash, Op::Fract};
    std::vector<NodeId> todo{root};
    std::unordered_set<NodeId> seen;
    ir::Substitution map;
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!seen.insert(id).second) continue;
        todo.insert(todo.end(), graph.args(id).begin(), graph.args(id).end());
        const ir::Node node = graph[id];
        if (!hashes[node.op]) continue;
        const NodeId of = graph.arg(id, 0);
        const auto choice = only_choice(graph, of);
        if (!choice) continue;
        std::vector<NodeId> arms{graph.arg(*choice, 0)};
        for (const int arm : {1, 2})
            arms.push_back(graph.make(
                node.op, node.type,
                std::vector{ir::substitute(graph, of, {{*choice, graph.arg(*choice, arm)}})},
                node.payload));
        map[id] = graph.make(Op::Select, node.type, arms);
    }
    return map.empty() ? root : ir::substitute(graph, root, map);
}

} // namespace

NodeId with_half_waves(Graph &graph, NodeId root) {
    constexpr std::size_t max_nodes = 1500, max_lattices = 16;
    constexpr ir::OpSet steps{Op::Mod, Op::Fract, Op::Round, Op::Floor, Op::Ceil},
        made{Op::Add, Op::Sub, Op::Mul};
    std::vector<NodeId> todo{root}, found, choices;
    std::unordered_set<NodeId> seen;
    int stepping = 0; // numbers
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!seen.insert(id).second) continue;
        if (seen.size() > max_nodes) return root;
        const Op op = graph[id].op;
        if (made[op]) found.push_back(id);
        stepping += steps[op] ? ir::components(graph.type(id)) : 0;
        if (op == Op::Select) choices.push_back(id);
        todo.insert(todo.end(), graph.args(id).begin(), graph.args(id).end());
    }
    if (choices.empty() || stepping < 2) return root;
    for (NodeId choice : choices)
        if (const auto midway = with_borders_midway(graph, choice))
            return with_half_waves(graph, ir::substitute(graph, root, {{choice, *midway}}));
    if (const NodeId ways = with_ways(graph, root, found); ways != root)
        return with_half_waves(graph, ways);
    std::vector<Lattice> lattices;
    for (NodeId id : found)
        if (auto own = lattice(graph, id); own && lattices.size() < max_lattices)
            lattices.push_back(std::move(*own));
    for (const Lattice &a : lattices)
        for (const Lattice &b : lattices) {
            const ir::Type type = graph.type(a.node);
            if (a.node.index >= b.node.index || type != graph.type(b.node) ||
                !is_half_beside(a, b, ir::components(type)))
                continue;
            NodeId whole = with_chosen_hashes(graph, root);
            const auto is_even = [&] {
                return is_even_in(graph, whole, a.node) && is_even_in(graph, whole, b.node);
            };
            if (!is_even()) whole = with_points(graph, whole, found);
            if (!is_even()) continue;
            const NodeId x = place_of(graph, a), m = period_of(graph, a);
            const NodeId turns = graph.make(Op::Round, {graph.div(x, m)});
            const NodeId size = graph.make(Op::Abs, {graph.sub(x, graph.mul(m, turns))});
            const NodeId other = graph.sub(graph.mul(m, graph.number(0.5)), size);
            return with_half_waves(graph,
                                   ir::substitute(graph, whole, {{a.node, size}, {b.node, other}}));
        }
    return root;
}

} // namespace fathom::proof
