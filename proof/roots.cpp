// Squares are found on the nodes as written, factors in either order; a sum of products of degree 2
// is made a sum of squares as on paper, by completing one after another.
#include "proof/roots.h"

#include "ir/passes/walk.h"
#include "proof/continuity.h"
#include "proof/forms.h"
#include "proof/guarded.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_set>

namespace fathom::proof {

using ir::Graph;

namespace {

constexpr std::size_t max_atoms_of_squares = 12;
// Of the terms: what numbers in double precision lose. More would not do: where a sum of squares is
// 0, its root turns an error e into sqrt(e).
constexpr double granted_to_squares = 3e-14;

// A sum of products of at most two atoms each; the number is that of the empty product.
struct Quadratic {
    std::vector<NodeId> atoms;
    struct Number {
        double is = 0, size = 0; // of all that was added up to it
        bool is_nothing() const { return std::fabs(is) <= granted_to_squares * size; }
    };
    std::map<std::pair<std::size_t, std::size_t>, Number> products; // the lesser index first

    static constexpr std::size_t one = std::size_t(-1); // beside an atom: no other factor
    std::size_t index(NodeId atom) {
        const auto it = std::find(atoms.begin(), atoms.end(), atom);
        if (it != atoms.end()) return std::size_t(it - atoms.begin());
        atoms.push_back(atom);
        return atoms.size() - 1;
    }
    Number &at(std::size_t i, std::size_t k) { return products[{std::min(i, k), std::max(i, k)}]; }
    void add(std::size_t i, std::size_t k, double x) {
        at(i, k).is += x;
        at(i, k).size += std::fabs(x);
    }
    bool add(const std::vector<Term> &terms, double times) {
        for (const Term &term : terms) {
            if (term.factors.size() > 2) return false;
            const std::size_t i = term.factors.empty() ? one : index(term.factors[0]),
                              k = term.factors.size() < 2 ? one : index(term.factors[1]);
            add(i, k, times * term.by);
        }
        return atoms.size() <= max_atoms_of_squares;
    }
};

// What the square of an atom is: of a length, a size, a root.
std::optional<std::vector<Term>> square_of(Graph &graph, NodeId atom) {
    const ir::Node node = graph[atom];
    if (node.op == Op::Length) {
        const NodeId q = graph.arg(atom, 0);
        return terms_of(graph, graph.make(Op::Dot, {q, q}));
    }
    if (node.op == Op::Abs) {
        const NodeId x = graph.arg(atom, 0);
        return terms_of(graph, graph.mul(x, x));
    }
    return {};
}

// x*x + y*y + r*r - 2*r*length([x, y]) as (length([x, y]) - r)^2: sizes and lengths that stand
// alone take the place of what their squares are made of.
bool lengths_for_squares(Graph &graph, Quadratic &sum) {
    for (std::size_t a = 0; a < sum.atoms.size(); ++a) {
        const bool alone = std::ranges::any_of(sum.products, [&](const auto &product) {
            const auto [i, k] = product.first;
            return !product.second.is_nothing() && i != k && (i == a || k == a);
        });
        const bool has_own = sum.at(a, a).is > 0;
        const auto square = alone && !has_own ? square_of(graph, sum.atoms[a]) : std::nullopt;
        if (!square) continue;
        double times = 0;
        for (const Term &term : *square)
            if (term.factors.size() == 2 && term.factors[0] == term.factors[1] && term.by > 0) {
                const std::size_t i = sum.index(term.factors[0]);
                const double fits = sum.at(i, i).is / term.by;
                times = times == 0 ? fits : std::min(times, fits);
            }
        if (!(times > 0)) continue;
        if (!sum.add(*square, -times)) return false;
        sum.add(a, a, times);
    }
    return sum.atoms.size() <= max_atoms_of_squares;
}

// The parts of whose squares a sum of products is the sum; nothing where it may be below 0.
std::optional<std::vector<NodeId>> completed_squares(Graph &graph, NodeId id) {
    const auto terms = terms_of(graph, id);
    Quadratic sum;
    if (!terms || !sum.add(*terms, 1) || !lengths_for_squares(graph, sum)) return {};
    std::vector<NodeId> parts;
    for (std::size_t i = 0; i < sum.atoms.size(); ++i) {
        std::vector<std::size_t> others{Quadratic::one};
        for (std::size_t k = i + 1; k < sum.atoms.size(); ++k) others.push_back(k);
        const Quadratic::Number lead = sum.at(i, i);
        if (lead.is_nothing()) {
            for (const std::size_t k : others)
                if (!sum.at(i, k).is_nothing()) return {};
            continue;
        }
        if (lead.is < 0) return {};
        const double root = std::sqrt(lead.is);
        NodeId part = graph.mul(sum.atoms[i], graph.number(root));
        std::vector<double> row;
        for (const std::size_t k : others)
            row.push_back(sum.at(i, k).is_nothing() ? 0 : sum.at(i, k).is / 2 / root);
        for (std::size_t n = 0; n < others.size(); ++n) {
            if (row[n] == 0) continue;
            for (std::size_t m = n; m < others.size(); ++m)
                sum.add(others[n], others[m], -row[n] * row[m] * (n == m ? 1 : 2));
            const NodeId by = graph.number(row[n]);
            part = graph.add(
                part, others[n] == Quadratic::one ? by : graph.mul(sum.atoms[others[n]], by));
        }
        parts.push_back(part);
    }
    const Quadratic::Number rest = sum.at(Quadratic::one, Quadratic::one);
    if (parts.empty() || (rest.is < 0 && !rest.is_nothing())) return {};
    if (!rest.is_nothing()) parts.push_back(graph.number(std::sqrt(rest.is)));
    return parts;
}

// The parts whose squares the sum is made of; a constant c >= 0 is the square of its root.
bool squares_as_written(Graph &graph, NodeId sum, std::vector<NodeId> &parts) {
    constexpr std::size_t most = 64; // a sum may stand in both parts of another, again and again
    const ir::Node node = graph[sum];
    if (parts.size() > most) return false;
    if (node.op == Op::Add)
        return squares_as_written(graph, graph.arg(sum, 0), parts) &&
               squares_as_written(graph, graph.arg(sum, 1), parts);
    if ((node.op == Op::Mul || node.op == Op::Dot) && graph.arg(sum, 0) == graph.arg(sum, 1)) {
        parts.push_back(graph.arg(sum, 0));
        return true;
    }
    if (node.op == Op::Pow && number(graph, graph.arg(sum, 1)) == 2.0) {
        parts.push_back(graph.arg(sum, 0));
        return true;
    }
    if (auto c = graph.as_number(sum); c && *c >= 0) {
        parts.push_back(graph.number(std::sqrt(*c)));
        return true;
    }
    return false;
}
std::optional<std::vector<NodeId>> squares(Graph &graph, NodeId sum) {
    std::vector<NodeId> parts;
    if (squares_as_written(graph, sum, parts)) return parts;
    constexpr ir::OpSet sums{Op::Add, Op::Sub, Op::Neg, Op::Mul, Op::Div};
    return sums[graph[sum].op] ? completed_squares(graph, sum) : std::nullopt;
}

// The choice that a sum is made of, and the sum with either of its arms in its place.
struct Arms {
    NodeId choice, first, second;
    Op op = Op::Select; // or Min, Max: of the two sums
};
std::optional<Arms> arms_of(Graph &graph, NodeId sum, int depth = 0) {
    if (depth > 8) return {};
    const ir::Node node = graph[sum];
    if (node.op == Op::Min || node.op == Op::Max)
        return Arms{sum, graph.arg(sum, 0), graph.arg(sum, 1), node.op};
    if (node.op == Op::Select) return Arms{sum, graph.arg(sum, 1), graph.arg(sum, 2)};
    if (node.op == Op::Swizzle && node.type == ir::Type::Float) {
        const NodeId own = component_of(graph, sum, 0);
        return own == sum ? std::nullopt : arms_of(graph, own, depth + 1);
    }
    const bool scales = node.op == Op::Mul || node.op == Op::Div;
    if (node.op != Op::Add && node.op != Op::Sub && !scales) return {};
    for (int i = 0; i < (node.op == Op::Div ? 1 : 2); ++i) {
        const NodeId other = graph.arg(sum, 1 - i);
        const auto factor = scales ? number(graph, other) : std::optional(1.0);
        if (!factor || *factor == 0) continue;
        auto arms = arms_of(graph, graph.arg(sum, i), depth + 1);
        if (!arms) continue;
        const auto with = [&](NodeId arm) {
            return i == 0 ? graph.make(node.op, {arm, other}) : graph.make(node.op, {other, arm});
        };
        const bool falls = *factor < 0 || (node.op == Op::Sub && i == 1);
        if (falls && arms->op != Op::Select) arms->op = arms->op == Op::Min ? Op::Max : Op::Min;
        arms->first = with(arms->first);
        arms->second = with(arms->second);
        return arms;
    }
    return {};
}
NodeId chosen(Graph &graph, const Arms &arms, NodeId first, NodeId second) {
    if (arms.op == Op::Select)
        return graph.make(Op::Select, {graph.arg(arms.choice, 0), first, second});
    return graph.make(arms.op, {first, second});
}

// Is a choice of sums of squares, so that no root of it is singular? `left`: choices that are still
// looked at.
bool chooses_squares(Graph &graph, NodeId sum, int &left) {
    if (squares(graph, sum)) return true;
    if (--left < 0) return false;
    const auto arms = arms_of(graph, sum);
    return arms && chooses_squares(graph, arms->first, left) &&
           chooses_squares(graph, arms->second, left);
}

// sign(d)*sqrt(|d|), if d chooses among sums of squares and their negatives.
std::optional<NodeId> signed_root(Graph &graph, NodeId d, int depth = 0) {
    if (depth > 8) return {};
    const ir::Node node = graph[d];
    if (node.op == Op::Neg) {
        const auto root = signed_root(graph, graph.arg(d, 0), depth + 1);
        return root ? std::optional(graph.neg(*root)) : std::nullopt;
    }
    if (squares(graph, d)) return graph.make(Op::Sqrt, {d});
    const auto arms = arms_of(graph, d);
    if (arms) {
        const auto a = signed_root(graph, arms->first, depth + 1),
                   b = a ? signed_root(graph, arms->second, depth + 1) : std::nullopt;
        if (b) return chosen(graph, *arms, *a, *b);
    }
    const NodeId less = graph.neg(d);
    return squares(graph, less) ? std::optional(graph.neg(graph.make(Op::Sqrt, {less})))
                                : std::nullopt;
}

} // namespace

std::optional<RootOfChoice> root_inward(Graph &graph, NodeId id) {
    if (graph[id].op != Op::Sqrt || graph[id].type != ir::Type::Float) return {};
    int left = 100; // edges of a polygon, say
    if (!chooses_squares(graph, graph.arg(id, 0), left)) return {};
    const auto arms = arms_of(graph, graph.arg(id, 0));
    if (!arms) return {};
    const NodeId a = graph.make(Op::Sqrt, {arms->first}), b = graph.make(Op::Sqrt, {arms->second});
    return RootOfChoice{chosen(graph, *arms, a, b), arms->choice};
}

std::optional<std::vector<NodeId>> norm_parts(Graph &graph, NodeId id) {
    const ir::Node node = graph[id];
    if (node.type != ir::Type::Float) return {};
    const bool root =
        node.op == Op::Sqrt || (node.op == Op::Pow && number(graph, graph.arg(id, 1)) == 0.5);
    return root ? squares(graph, graph.arg(id, 0)) : std::nullopt;
}

std::optional<NodeId> rounded_sizes(Graph &graph, NodeId id) {
    const ir::Node node = graph[id];
    if (node.op != Op::Sqrt || !ir::is_vector(node.type)) return {};
    const NodeId sum = graph.arg(id, 0);
    if (graph[sum].op != Op::Add) return {};
    for (int i = 0; i < 2; ++i) {
        const NodeId square = graph.arg(sum, i), rest = graph.arg(sum, 1 - i);
        const ir::Graph::Reads reads = graph.reads(rest);
        if (graph[square].op != Op::Mul || graph.arg(square, 0) != graph.arg(square, 1) ||
            reads.point || reads.free_vars || !is_never_negative(graph, rest))
            continue;
        return graph.arg(square, 0);
    }
    return {};
}

std::vector<NodeId> nodes_below(const Graph &graph, NodeId root) {
    constexpr std::size_t max_nodes = 1500;
    std::vector<NodeId> todo{root}, nodes;
    std::map<NodeId, bool> seen;
    while (!todo.empty() && nodes.size() <= max_nodes) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!seen.emplace(id, true).second) continue;
        nodes.push_back(id);
        todo.insert(todo.end(), graph.args(id).begin(), graph.args(id).end());
    }
    return nodes;
}

namespace {

// Written anew until nothing changes: choices may read one another.
template <class Rewrite> NodeId in_rounds(NodeId root, Rewrite rewrite) {
    constexpr int max_rounds = 8;
    for (int round = 0; round < max_rounds; ++round) {
        const NodeId next = rewrite(root);
        if (next == root) break;
        root = next;
    }
    return root;
}

NodeId with_some_squares_compared(Graph &graph, NodeId root) {
    ir::Substitution map;
    for (NodeId id : nodes_below(graph, root)) {
        const ir::Node node = graph[id];
        if (node.op != Op::Less && node.op != Op::LessEqual) continue;
        const NodeId a = graph.arg(id, 0), b = graph.arg(id, 1);
        if (graph[a].op != Op::Length || graph[b].op != Op::Length) continue;
        const NodeId u = graph.arg(a, 0), v = graph.arg(b, 0);
        map[id] = graph.make(node.op, {graph.make(Op::Dot, {u, u}), graph.make(Op::Dot, {v, v})});
    }
    return map.empty() ? root : ir::substitute(graph, root, map);
}

} // namespace

NodeId with_squares_compared(Graph &graph, NodeId root) {
    return in_rounds(root, [&](NodeId now) { return with_some_squares_compared(graph, now); });
}

NodeId with_signed_roots(Graph &graph, NodeId root) {
    ir::Substitution map;
    for (NodeId id : nodes_below(graph, root)) {
        const ir::Node node = graph[id];
        if (node.op != Op::Mul || node.type != ir::Type::Float) continue;
        for (int i = 0; i < 2; ++i) {
            const NodeId sign = graph.arg(id, i), size = graph.arg(id, 1 - i);
            if (graph[sign].op != Op::Sign || graph[size].op != Op::Sqrt) continue;
            const NodeId below = graph.arg(size, 0), d = graph.arg(sign, 0);
            if (graph[below].op != Op::Abs || graph.arg(below, 0) != d) continue;
            if (const auto other = signed_root(graph, d)) map[id] = *other;
        }
    }
    return map.empty() ? root : ir::substitute(graph, root, map);
}

NodeId with_chosen_factors(Graph &graph, NodeId root) {
    constexpr std::size_t max_nodes = 4000;
    ir::Substitution map;
    std::vector<NodeId> todo{root};
    std::unordered_set<NodeId> seen;
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!seen.insert(id).second) continue;
        if (seen.size() > max_nodes) return root;
        todo.insert(todo.end(), graph.args(id).begin(), graph.args(id).end());
        if (graph[id].op != Op::Mul) continue;
        for (int i = 0; i < 2; ++i) {
            NodeId factor = graph.arg(id, i);
            const NodeId other = graph.arg(id, 1 - i);
            if (graph[factor].op == Op::Splat) factor = graph.arg(factor, 0);
            if (graph[factor].op != Op::ToFloat || !graph.reads(other).point) continue;
            const NodeId truth = graph.arg(factor, 0);
            if (graph[truth].type != ir::Type::Bool || !graph.reads(truth).point) continue;
            map[factor] = graph.make(Op::Select, {truth, graph.number(1), graph.number(0)});
        }
    }
    return map.empty() ? root : ir::substitute(graph, root, map);
}

} // namespace fathom::proof
