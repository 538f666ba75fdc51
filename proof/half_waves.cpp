#include "proof/half_waves.h"

#include "ir/passes/walk.h"
#include "proof/forms.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_map>
#include <unordered_set>

namespace fathom::proof {
namespace {

using ir::Graph;

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

using Numbers = std::array<double, 4>;
std::optional<Numbers> numbers(Graph &graph, NodeId id) {
    Numbers out{};
    const bool is_splat = graph[id].op == Op::Splat;
    if (is_splat) id = graph.arg(id, 0);
    if (!graph.is_constant(id) || ir::is_matrix(graph.type(id))) return {};
    for (std::size_t i = 0; i < out.size(); ++i)
        out[i] = graph.constant_of(id).value[is_splat ? 0 : i];
    return out;
}

// x as a base and numbers beside it.
struct Shifted {
    NodeId base;
    Numbers by{};
};
Shifted shifted(Graph &graph, NodeId x) {
    constexpr int max_depth = 8;
    Shifted out{x};
    for (int depth = 0; depth < max_depth; ++depth) {
        const Op op = graph[out.base].op;
        if (op != Op::Add && op != Op::Sub) break;
        const NodeId a = graph.arg(out.base, 0), b = graph.arg(out.base, 1);
        const auto right = numbers(graph, b), left = op == Op::Add ? numbers(graph, a) : right;
        if (!right && !left) break;
        for (std::size_t i = 0; i < out.by.size(); ++i)
            out.by[i] += right ? (op == Op::Add ? (*right)[i] : -(*right)[i]) : (*left)[i];
        out.base = right ? a : b;
    }
    return out;
}

struct Lattice {
    NodeId node, x, m;
    Numbers period;
    Shifted at;
};

// Is the one half a period, and whole ones, beside the other?
bool is_half_beside(const Lattice &a, const Lattice &b, int components) {
    if (a.m != b.m || a.at.base != b.at.base) return false;
    for (std::size_t i = 0; i < std::size_t(components); ++i) {
        if (!(a.period[i] > 0)) return false;
        const double periods = (a.at.by[i] - b.at.by[i]) / a.period[i];
        if (!(std::fabs(std::fabs(periods - std::round(periods)) - 0.5) <= 1e-12)) return false;
    }
    return true;
}

} // namespace

NodeId with_half_waves(Graph &graph, NodeId root) {
    constexpr std::size_t max_nodes = 1500, max_lattices = 16;
    constexpr ir::OpSet steps{Op::Mod, Op::Fract, Op::Round};
    std::vector<NodeId> todo{root}, sums;
    std::unordered_set<NodeId> seen;
    std::size_t stepping = 0;
    bool chooses = false;
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!seen.insert(id).second) continue;
        if (seen.size() > max_nodes) return root;
        const Op op = graph[id].op;
        if (op == Op::Add || op == Op::Sub) sums.push_back(id);
        stepping += steps[op] ? 1 : 0;
        chooses |= op == Op::Select;
        todo.insert(todo.end(), graph.args(id).begin(), graph.args(id).end());
    }
    if (!chooses || stepping < 2) return root;
    std::vector<Lattice> lattices;
    for (NodeId id : sums) {
        const auto found = wave(graph, id);
        if (!found || lattices.size() >= max_lattices) continue;
        const auto period = numbers(graph, found->m);
        if (!period) continue;
        lattices.push_back({id, found->x, found->m, *period, shifted(graph, found->x)});
    }
    for (const Lattice &a : lattices)
        for (const Lattice &b : lattices) {
            const ir::Type type = graph.type(a.node);
            if (a.node.index >= b.node.index || type != graph.type(b.node) ||
                !is_half_beside(a, b, ir::components(type)) || !is_even_in(graph, root, a.node) ||
                !is_even_in(graph, root, b.node))
                continue;
            const NodeId turns = graph.make(Op::Round, {graph.div(a.x, a.m)});
            const NodeId size = graph.make(Op::Abs, {graph.sub(a.x, graph.mul(a.m, turns))});
            const NodeId other = graph.sub(graph.mul(a.m, graph.number(0.5)), size);
            return with_half_waves(graph,
                                   ir::substitute(graph, root, {{a.node, size}, {b.node, other}}));
        }
    return root;
}

} // namespace fathom::proof
