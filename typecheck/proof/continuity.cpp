// Borders by substitution: where the condition compares u with v, the arms are rewritten for u = v and compared as
// polynomials in whatever they are made of.
#include "typecheck/proof/continuity.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

namespace fathom::proof {
namespace {

using ir::Graph;
using ir::NodeId;
using ir::Op;

// Sum of coefficient * product of atoms; an atom is a node that is not itself a sum or product of numbers.
using Monomial = std::vector<NodeId>; // sorted, repeats allowed
using Polynomial = std::map<Monomial, double>;
constexpr std::size_t most_terms = 64;

std::optional<Polynomial> multiply(const Polynomial &a, const Polynomial &b) {
    Polynomial out;
    for (const auto &[m, x] : a)
        for (const auto &[n, y] : b) {
            Monomial product = m;
            product.insert(product.end(), n.begin(), n.end());
            std::sort(product.begin(), product.end());
            out[product] += x * y;
            if (out.size() > most_terms || product.size() > 8) return {};
        }
    return out;
}

std::optional<Polynomial> polynomial(const Graph &graph, NodeId id, int depth = 0) {
    const ir::Node &node = graph[id];
    if (auto c = graph.as_number(id)) return Polynomial{{{}, *c}};
    if (depth > 32) return {};
    auto sub = [&](int i) { return polynomial(graph, graph.arg(id, i), depth + 1); };
    if (node.type == ir::Type::Float) {
        if (node.op == Op::Neg) {
            auto a = sub(0);
            if (!a) return {};
            for (auto &[m, x] : *a) x = -x;
            return a;
        }
        if (node.op == Op::Add || node.op == Op::Sub) {
            auto a = sub(0), b = sub(1);
            if (!a || !b) return {};
            for (auto &[m, x] : *b) (*a)[m] += node.op == Op::Add ? x : -x;
            return a->size() > most_terms ? std::optional<Polynomial>() : a;
        }
        if (node.op == Op::Mul) {
            auto a = sub(0), b = sub(1);
            if (!a || !b) return {};
            return multiply(*a, *b);
        }
        if (node.op == Op::Div)
            if (auto c = graph.as_number(graph.arg(id, 1)); c && *c != 0) {
                auto a = sub(0);
                if (!a) return {};
                for (auto &[m, x] : *a) x /= *c;
                return a;
            }
        if (node.op == Op::Pow)
            if (auto c = graph.as_number(graph.arg(id, 1)); c && std::floor(*c) == *c && *c >= 1 && *c <= 6) {
                auto a = sub(0);
                auto out = a;
                for (int i = 1; a && out && i < int(*c); ++i) out = multiply(*out, *a);
                return out;
            }
    }
    return Polynomial{{{id}, 1.0}};
}

// Sums of products of doubles that are equal in exact arithmetic may differ by rounding of this relative size.
constexpr double rounding = 1e-12;

bool same(const Graph &graph, NodeId a, NodeId b) {
    if (a == b) return true;
    const ir::Node &x = graph[a], &y = graph[b];
    if (x.type != y.type) return false;
    if (x.type != ir::Type::Float) { // by component, where both are made of them
        if (x.op != y.op || x.count != y.count || x.payload != y.payload || x.count == 0) return false;
        for (int i = 0; i < int(x.count); ++i)
            if (!same(graph, graph.arg(a, i), graph.arg(b, i))) return false;
        return true;
    }
    auto p = polynomial(graph, a), q = polynomial(graph, b);
    if (!p || !q) return false;
    double size = 0;
    for (const auto &[m, c] : *p) size = std::max(size, std::fabs(c));
    for (const auto &[m, c] : *q) (*p)[m] -= c;
    for (const auto &[m, c] : *p)
        if (std::fabs(c) > rounding * std::max(size, 1e-30)) return false;
    return true;
}

// The arms for u = v: u replaced by v, v by u, or one atom of u - v by what the others make it.
bool agree_where_equal(Graph &graph, NodeId u, NodeId v, NodeId a, NodeId b) {
    auto agree = [&](NodeId from, NodeId to) {
        ir::Substitution map{{from, to}};
        return same(graph, ir::substitute(graph, a, map), ir::substitute(graph, b, map));
    };
    if (same(graph, a, b)) return true;
    if (!graph.is_constant(u) && agree(u, v)) return true;
    if (!graph.is_constant(v) && agree(v, u)) return true;
    auto p = polynomial(graph, u), q = polynomial(graph, v);
    if (!p || !q) return false;
    for (const auto &[m, c] : *q) (*p)[m] -= c;
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

} // namespace

std::optional<NodeId> difference(Graph &graph, NodeId a, NodeId b) {
    auto p = polynomial(graph, a), q = polynomial(graph, b);
    if (!p || !q) return {};
    for (const auto &[m, c] : *q) (*p)[m] -= c;
    NodeId sum = graph.number(0);
    for (const auto &[m, c] : *p) {
        if (c == 0) continue;
        NodeId term = graph.number(c);
        for (NodeId f : m) term = graph.mul(term, f);
        sum = graph.add(sum, term);
    }
    return sum;
}

bool arms_agree(Graph &graph, NodeId condition, NodeId a, NodeId b) {
    const ir::Node node = graph[condition];
    switch (node.op) {
    case Op::Less:
    case Op::LessEqual: {
        NodeId u = graph.arg(condition, 0), v = graph.arg(condition, 1);
        return graph[u].type == ir::Type::Float && agree_where_equal(graph, u, v, a, b);
    }
    case Op::Not: return arms_agree(graph, graph.arg(condition, 0), b, a);
    case Op::And:
    case Op::Or: { // the border is part of the two borders together
        NodeId left = graph.arg(condition, 0), right = graph.arg(condition, 1);
        return arms_agree(graph, left, a, b) && arms_agree(graph, right, a, b);
    }
    default: return false; // a border that is not given by a comparison
    }
}

} // namespace fathom::proof
