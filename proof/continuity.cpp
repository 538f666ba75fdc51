// Borders by substitution: where the condition compares u with v, the arms are rewritten for u = v
// and compared as polynomials in whatever they are made of.
#include "proof/continuity.h"

#include "ir/passes/walk.h"
#include "proof/enclosed.h"
#include "proof/exact.h"
#include "proof/polynomials.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace fathom::proof {

// Sums of products of doubles that are equal in exact arithmetic may differ by rounding of this
// relative size.
constexpr double rounding = 1e-12;

// Is what is left of two polynomials no more than their rounding, at all distances from the origin?
bool is_rounding(const Graph &graph, const Polynomial &rest, const Polynomial &p,
                 const Polynomial &q) {
    const auto of = [](const Polynomial &sum, const Monomial &m) {
        const auto it = sum.find(m);
        return it == sum.end() ? 0 : std::fabs(it->second);
    };
    const auto is_finite = [](const auto &term) { return std::isfinite(term.second); };
    if (!std::ranges::all_of(rest, is_finite)) return false; // inf - inf is no number, and not 0
    const bool is_nothing = std::ranges::all_of(rest, [&](const auto &term) {
        const auto &[m, c] = term;
        return std::fabs(c) <= lost_by_doubles * (of(p, m) + of(q, m));
    });
    if (is_nothing) return true;
    for (int scale = least_scale; scale <= far_scale; ++scale) {
        const double distance = distance_at(scale);
        const Interval side(-distance, distance);
        Enclosed enclosed(graph, nullptr, {side, side, side});
        const auto factor = [&](NodeId f) {
            const Interval range = enclosed.of(f);
            return KnownFactor{range.finite() ? std::optional(range) : std::nullopt};
        };
        if (!is_rounding_beside(rest, p, q, rounding, rounding, most_size_at(distance), factor))
            return false;
    }
    return true;
}

bool same(Graph &graph, NodeId a, NodeId b, Work *work) {
    if (a == b) return true;
    const ir::Node x = graph[a], y = graph[b];
    if (x.type != y.type) return false;
    const bool alike = x.op == y.op && x.count == y.count && x.payload == y.payload && x.count > 0;
    // of one op of one argument, or of vectors: the same of the same
    if (alike && (x.count == 1 || x.type != ir::Type::Float)) {
        bool all = true;
        for (int i = 0; i < int(x.count); ++i) {
            const NodeId u = graph.arg(a, i), v = graph.arg(b, i);
            all = all && (tells_apart[x.op] ? exactly_same(graph, u, v) : same(graph, u, v, work));
        }
        if (all) return true;
    }
    if (x.type != ir::Type::Float) return false;
    Expansion expansion(graph, work);
    const auto &p = expansion.of(a), &q = expansion.of(b);
    if (!p || !q) return false;
    Polynomial rest = *p;
    for (const auto &[m, c] : *q) rest[m] -= c;
    return is_rounding(graph, rest, *p, *q);
}

namespace {

// The same where a polynomial is 0: polynomials that differ by a multiple of it, lengths whose squares
// do, and what is made of such in the same way.
class SameWhereZero {
  public:
    SameWhereZero(Graph &graph, Polynomial zero, Work &work)
        : graph_(graph), zero_(std::move(zero)), expansion_(graph, &work), work_(work) {}

    bool operator()(NodeId a, NodeId b, int depth = 0) {
        constexpr int max_depth = 8;
        if (a == b) return true;
        const ir::Node x = graph_[a], y = graph_[b];
        if (x.type != ir::Type::Float || y.type != x.type || depth > max_depth || work_.spent())
            return false;
        work_.take(1);
        if (x.op == Op::Length && y.op == Op::Length) {
            const NodeId u = graph_.arg(a, 0), v = graph_.arg(b, 0);
            return differ_by_multiple(graph_.make(Op::Dot, {u, u}), graph_.make(Op::Dot, {v, v}));
        }
        if (differ_by_multiple(a, b)) return true;
        if (x.op != y.op || x.count != y.count || x.count == 0 || x.payload != y.payload ||
            tells_apart[x.op])
            return false;
        for (int i = 0; i < int(x.count); ++i)
            if (!(*this)(graph_.arg(a, i), graph_.arg(b, i), depth + 1)) return false;
        return true;
    }

  private:
    bool differ_by_multiple(NodeId a, NodeId b) {
        const auto &p = expansion_.of(a), &q = expansion_.of(b);
        if (!p || !q) return false;
        Polynomial rest = *p;
        for (const auto &[m, c] : *q) rest[m] -= c;
        // the multiple that leaves nothing of the zero's largest term
        const auto largest = std::ranges::max_element(
            zero_, {}, [](const auto &term) { return std::fabs(term.second); });
        if (largest == zero_.end()) return false;
        const double times = rest[largest->first] / largest->second;
        for (const auto &[m, c] : zero_) rest[m] -= times * c;
        return is_rounding(graph_, rest, *p, *q);
    }

    Graph &graph_;
    Polynomial zero_;
    Expansion expansion_;
    Work &work_;
};

constexpr ir::OpSet is_step_of_arms{Op::Floor, Op::Ceil, Op::Round, Op::Trunc,
                                    Op::Fract, Op::Mod,  Op::Atan2};

std::vector<NodeId> steps_in(const Graph &graph, NodeId a, NodeId b, Work &work) { // the outermost
    std::vector<NodeId> todo{a, b}, out;
    std::vector<bool> seen(graph.size());
    std::size_t visited = 0;
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (seen[id.index] || !graph.reads(id).point) continue;
        seen[id.index] = true;
        ++visited;
        if (is_step_of_arms[graph[id].op])
            out.push_back(id);
        else
            todo.insert(todo.end(), graph.args(id).begin(), graph.args(id).end());
    }
    work.take(visited);
    return out;
}

// Is a step of these numbers, its arguments, continuous there?
bool is_between_turns(const Graph &graph, Op op, const std::vector<NodeId> &args) {
    constexpr double near = 1e-6;
    if (!std::ranges::all_of(args, [&](NodeId arg) { return graph.is_constant(arg); }))
        return false;
    const ir::Constant &x = graph.constant_of(args[0]);
    for (int i = 0; i < ir::components(x.type); ++i) {
        const auto k = static_cast<std::size_t>(i);
        if (op == Op::Atan2) { // y, x
            if (std::fabs(x.value[k]) < near && graph.constant_of(args[1]).value[k] < near)
                return false;
            continue;
        }
        const double turns = op == Op::Mod ? x.value[k] / graph.constant_of(args[1]).value[k]
                                           : x.value[k] - (op == Op::Round ? 0.5 : 0.0);
        if (!(std::fabs(turns - std::round(turns)) > near)) return false;
    }
    return true;
}

} // namespace

// Tried with u replaced by v, v by u, or one atom of u - v by what the others make it.
bool agree_where_equal(Graph &graph, NodeId u, NodeId v, NodeId a, NodeId b, Work &work) {
    const std::vector<NodeId> steps = steps_in(graph, a, b, work);
    auto agree = [&](NodeId from, NodeId to) {
        if (work.spent()) return false;
        ir::Substitution map{{from, to}};
        std::size_t visited = 0;
        // A step may turn on the border itself, and what it is there is not what it is beside it.
        for (const NodeId step : steps) {
            std::vector<NodeId> args(graph.args(step).begin(), graph.args(step).end());
            bool moved = false;
            for (NodeId &arg : args) {
                const NodeId there = ir::substitute(graph, arg, {{from, to}}, visited);
                moved = moved || there != arg;
                arg = there;
            }
            if (moved && !is_between_turns(graph, graph[step].op, args))
                map[step] = graph.fresh_var(graph[step].type);
        }
        const NodeId first = ir::substitute(graph, a, map, visited),
                     second = ir::substitute(graph, b, map, visited);
        work.take(2 * visited); // dearer than an operation on intervals
        return same(graph, first, second, &work);
    };
    if (same(graph, a, b, &work)) return true;
    if (!graph.is_constant(u) && agree(u, v)) return true;
    if (!graph.is_constant(v) && agree(v, u)) return true;
    auto p = polynomial(graph, u), q = polynomial(graph, v);
    if (!p || !q) return false;
    double size = 0, left = 0;
    for (const auto &[m, c] : *p) size = std::max(size, std::fabs(c));
    for (const auto &[m, c] : *q) (*p)[m] -= c;
    for (const auto &[m, c] : *p) left = std::max(left, std::fabs(c));
    if (left > 1e-6 * size && SameWhereZero(graph, *p, work)(a, b)) return true;
    for (const auto &[atom, c] : *p) {
        if (atom.size() != 1 || c == 0 || graph.is_constant(atom[0])) continue;
        bool elsewhere = false; // the atom must occur in this one term only
        for (const auto &[m, k] : *p)
            if (m != atom && k != 0)
                for (NodeId f : m) elsewhere = elsewhere || f == atom[0];
        if (elsewhere) continue;
        NodeId rest = graph.number(0);
        for (const auto &[m, k] : *p) {
            if (m == atom || k == 0) continue;
            NodeId term = graph.number(-k / c);
            for (NodeId f : m) term = graph.mul(term, f);
            rest = graph.add(rest, term);
        }
        if (agree(atom[0], rest)) return true;
    }
    return false;
}

std::optional<Solved> solved(Graph &graph, NodeId scalar, NodeId is) {
    const auto sum = polynomial(graph, scalar);
    if (!sum) return {};
    for (const auto &[atom, c] : *sum) {
        if (atom.size() != 1 || c == 0) continue;
        const ir::Node node = graph[atom[0]];
        if (node.op != Op::Swizzle) continue;
        bool elsewhere = false; // the coordinate must occur in this one term only
        for (const auto &[m, k] : *sum)
            for (NodeId f : m) elsewhere = elsewhere || (m != atom && k != 0 && f == atom[0]);
        if (elsewhere) continue;
        Polynomial rest;
        for (const auto &[m, k] : *sum)
            if (m != atom && k != 0) rest[m] = -k / c;
        const NodeId value = graph.add({graph.mul(is, graph.number(1 / c)), rebuilt(graph, rest)});
        return Solved{graph.arg(atom[0], 0), ir::swizzle_component(node.payload, 0), value};
    }
    return {};
}

std::optional<std::vector<double>> combination(Expansion &forms, NodeId scalar,
                                               std::span<const NodeId> atoms) {
    const auto &sum = forms.of_next(scalar);
    if (!sum) return {};
    std::vector<double> out(atoms.size() + 1, 0.0);
    for (const auto &[factors, c] : *sum) {
        if (c == 0) continue;
        if (factors.size() > 1) return {};
        const auto at =
            factors.empty() ? atoms.end() : std::find(atoms.begin(), atoms.end(), factors[0]);
        if (at == atoms.end() && !factors.empty()) return {};
        out[static_cast<std::size_t>(at - atoms.begin())] += c;
    }
    return out;
}

std::optional<Linear> linear_in(Graph &graph, NodeId scalar, NodeId atom) {
    const auto sum = polynomial(graph, scalar), alone = polynomial(graph, atom);
    if (!sum || !alone || alone->size() != 1 || alone->begin()->first.size() != 1) return {};
    const NodeId own = alone->begin()->first[0];
    const double one = alone->begin()->second;
    if (one != 1) return {};
    Linear out;
    Polynomial rest;
    for (const auto &[factors, c] : *sum) {
        const auto times = std::count(factors.begin(), factors.end(), own);
        if (times > 0 && factors.size() > 1) return {};
        if (times > 0)
            out.by = c;
        else
            rest[factors] = c;
    }
    out.rest = rebuilt(graph, rest);
    return out;
}

std::optional<std::vector<Term>> terms_of(Graph &graph, NodeId scalar) {
    Expansion forms(graph);
    return terms_of(forms, scalar);
}

std::optional<std::vector<Term>> terms_of(Expansion &forms, NodeId scalar) {
    const auto &sum = forms.of_next(scalar);
    if (!sum) return {};
    std::vector<Term> out;
    for (const auto &[factors, c] : *sum)
        if (c != 0) out.push_back({c, factors});
    return out;
}

bool same_with_mixes_as_sums(Graph &graph, NodeId a, NodeId b, Work *work) {
    std::unordered_map<NodeId, NodeId> known;
    const auto written = [&](auto &&self, NodeId id) -> NodeId {
        if (const auto it = known.find(id); it != known.end()) return it->second;
        const ir::Node node = graph[id];
        std::vector<NodeId> args(graph.args(id).begin(), graph.args(id).end());
        for (NodeId &arg : args) arg = self(self, arg);
        NodeId out = id;
        if (node.op == Op::Mix)
            out = graph.add({args[0], graph.mul(args[2], graph.sub(args[1], args[0]))});
        else if (node.count > 0)
            out = graph.make(node.op, node.type, args, node.payload);
        return known[id] = out;
    };
    return same(graph, written(written, a), written(written, b), work);
}

std::optional<NodeId> difference(Graph &graph, NodeId a, NodeId b) {
    auto p = polynomial(graph, a), q = polynomial(graph, b);
    if (!p || !q) return {};
    for (const auto &[m, c] : *q) (*p)[m] -= c;
    return rebuilt(graph, *p);
}

namespace {

NodeId component_within(Graph &graph, NodeId vector, int i, int &left) {
    const ir::Node node = graph[vector];
    if (node.op == Op::Swizzle)
        return component_within(graph, graph.arg(vector, 0), ir::swizzle_component(node.payload, i),
                                left);
    if (node.op == Op::Splat) return graph.arg(vector, 0);
    if (ir::is_vector(node.type) && node.count > 0 && left > 0 &&
        ir::info(node.op).rule == ir::TypeRule::Same && node.op != Op::Cross &&
        node.op != Op::Normalize) {
        --left;
        std::vector<NodeId> parts;
        for (int k = 0; k < int(node.count); ++k)
            parts.push_back(component_within(graph, graph.arg(vector, k), i, left));
        return graph.make(node.op, ir::Type::Float, parts, node.payload);
    }
    return graph.component(vector, i);
}

} // namespace

NodeId component_of(Graph &graph, NodeId vector, int i) {
    int left =
        1000; // vectors that are written so: one may stand in both parts of another, again and again
    return component_within(graph, vector, i, left);
}

std::optional<NodeId> entry_of(Graph &graph, NodeId matrix, int row, int column) {
    const ir::Node node = graph[matrix];
    const int side = ir::side(node.type), at = column * side + row;
    if (graph.is_constant(matrix))
        return graph.number(graph.constant_of(matrix).value[static_cast<std::size_t>(at)]);
    if (node.op != Op::Make) return {};
    if (int(node.count) == side * side) return graph.arg(matrix, at);
    if (int(node.count) == side) return component_of(graph, graph.arg(matrix, column), row);
    return {};
}

NodeId in_one_form(Graph &graph, NodeId scalar, Work *work) {
    auto p = polynomial(graph, scalar, work);
    return p ? rebuilt(graph, *p) : scalar;
}

NodeId without_rounding(Graph &graph, NodeId scalar, Work *work) {
    auto sum = polynomial(graph, scalar, work);
    if (!sum) return scalar;
    double size = 0;
    for (const auto &[factors, c] : *sum) size = std::max(size, std::fabs(c));
    std::erase_if(*sum,
                  [&](const auto &term) { return std::fabs(term.second) <= rounding * size; });
    return rebuilt(graph, *sum);
}

NodeId with_round_numbers(Graph &graph, NodeId scalar) {
    auto sum = polynomial(graph, scalar);
    if (!sum) return scalar;
    constexpr int bits = 44;
    for (auto &[factors, c] : *sum) {
        int exponent = 0;
        const double mantissa = std::frexp(c, &exponent);
        c = std::ldexp(std::round(std::ldexp(mantissa, bits)), exponent - bits);
    }
    return rebuilt(graph, *sum);
}

NodeId without_iterations(Graph &graph, NodeId angle) {
    auto sum = polynomial(graph, angle);
    if (!sum) return angle;
    constexpr double turn = 2 * std::numbers::pi, grain = 4294967296.0;
    for (auto &[factors, c] : *sum) {
        const bool whole = std::all_of(factors.begin(), factors.end(), [&](NodeId f) {
            return graph[f].op == Op::ToFloat && graph[graph.arg(f, 0)].type == ir::Type::Int;
        });
        if (!whole || std::fabs(c) > 1e6) continue;
        c = std::round((c - turn * std::round(c / turn)) * grain) / grain;
        if (c == -std::round(turn / 2 * grain) / grain) c = -c; // half a turn, either way
    }
    return rebuilt(graph, *sum);
}

std::optional<double> number_of(Graph &graph, NodeId scalar) {
    const auto sum = polynomial(graph, scalar);
    if (!sum) return {};
    double number = 0, rest = 0;
    for (const auto &[factors, c] : *sum) {
        const bool small = std::all_of(factors.begin(), factors.end(), [&](NodeId f) {
            return graph[f].op == Op::Sin || graph[f].op == Op::Cos;
        });
        if (!small) {
            if (c == 0) continue;
            return {};
        }
        (factors.empty() ? number : rest) += factors.empty() ? c : std::fabs(c);
    }
    if (rest > rounding * std::max(std::fabs(number), 1e-3)) return {};
    return number < 0 ? number - rest : number + rest;
}

bool keeps_length(Graph &graph, NodeId q) {
    NodeId p = graph.point(graph[q].type);
    Expansion expansion(graph);
    Polynomial sum;
    for (int i = 0; i < ir::components(graph[q].type); ++i) {
        const auto &a = expansion.of(component_of(graph, q, i)),
                   &b = expansion.of(graph.component(p, i));
        if (!a || !b) return false;
        auto x = expansion.multiply(*a, *a), y = expansion.multiply(*b, *b);
        if (!x || !y) return false;
        for (const auto &[m, c] : *x) sum[m] += c;
        for (const auto &[m, c] : *y) sum[m] -= c;
    }
    for (const auto &[m, c] : sum)
        if (std::fabs(c) > rounding) return false;
    return true;
}

namespace {

// |q| of dot(q, q) and q*q.
std::optional<NodeId> length_of_square(Graph &graph, NodeId id) {
    const ir::Node node = graph[id];
    if (node.type != ir::Type::Float || (node.op != Op::Dot && node.op != Op::Mul)) return {};
    const NodeId q = graph.arg(id, 0);
    if (q != graph.arg(id, 1)) return {};
    return graph.make(node.op == Op::Dot ? Op::Length : Op::Abs, {q});
}

} // namespace

bool arms_agree(Graph &graph, NodeId condition, NodeId a, NodeId b, Work &work) {
    const auto agree_on_border = [&](const ir::Node &node, NodeId id) {
        constexpr ir::OpSet ordered{Op::Less, Op::LessEqual}, equal{Op::Equal, Op::NotEqual};
        if (!ordered[node.op] && !equal[node.op]) return false; // not given by a comparison
        const NodeId u = graph.arg(id, 0), v = graph.arg(id, 1);
        const int parts = ir::components(graph[a].type);
        if (graph[u].type != ir::Type::Float) return false;
        if (equal[node.op]) // one arm is met on the border alone
            return parts == 1 && agree_where_equal(graph, u, v, a, b, work);
        if (agree_where_equal(graph, u, v, a, b, work)) return true;
        const auto long_u = length_of_square(graph, u), long_v = length_of_square(graph, v);
        if (long_u && long_v && agree_where_equal(graph, *long_u, *long_v, a, b, work)) return true;
        for (int i = 0; i < parts && parts > 1; ++i)
            if (!agree_where_equal(graph, u, v, component_of(graph, a, i),
                                   component_of(graph, b, i), work))
                return false;
        return parts > 1;
    };
    constexpr ir::OpSet of_truths{Op::And, Op::Or,
                                  Op::Not}; // the border is part of theirs together
    std::vector<NodeId> todo{condition};
    std::unordered_set<NodeId> seen;
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!seen.insert(id).second) continue;
        const ir::Node node = graph[id];
        if (of_truths[node.op])
            todo.insert(todo.end(), graph.args(id).begin(), graph.args(id).end());
        else if (!agree_on_border(node, id))
            return false;
    }
    return true;
}

} // namespace fathom::proof
