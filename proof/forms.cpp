// Forms are found on the nodes as written, factors in either order; nothing is expanded here.
#include "proof/forms.h"

#include "proof/continuity.h"
#include "proof/guarded.h"

#include <algorithm>
#include <cmath>

namespace fathom::proof {

using ir::Graph;

std::optional<double> number(Graph &graph, NodeId id) {
    const ir::Node &node = graph[id];
    if (node.op == Op::Splat) return number(graph, graph.arg(id, 0));
    if (node.op == Op::Neg) {
        if (auto x = number(graph, graph.arg(id, 0))) return -*x;
        return {};
    }
    if (node.op != Op::Const) return {};
    const ir::Constant &c = graph.constant_of(id);
    for (int i = 1; i < ir::components(c.type); ++i)
        if (c.value[static_cast<std::size_t>(i)] != c.value[0]) return {};
    return c.value[0];
}

namespace {

bool all_zero(Graph &graph, NodeId id) {
    if (!graph.is_constant(id)) return false;
    const ir::Constant &c = graph.constant_of(id);
    for (int i = 0; i < ir::components(c.type); ++i)
        if (c.value[static_cast<std::size_t>(i)] != 0) return false;
    return true;
}

// x of max(x, 0), or of min(x, 0).
std::optional<NodeId> above_zero(Graph &graph, Op op, NodeId id) {
    if (graph[id].op != op) return {};
    for (int i = 0; i < 2; ++i)
        if (all_zero(graph, graph.arg(id, i))) return graph.arg(id, 1 - i);
    return {};
}
void greatest_of(Graph &graph, NodeId id, std::vector<NodeId> &out, Op op = Op::Max) {
    if (out.size() >= 4) return;
    if (graph[id].op == op && graph[id].type == ir::Type::Float) {
        greatest_of(graph, graph.arg(id, 0), out, op);
        greatest_of(graph, graph.arg(id, 1), out, op);
    } else {
        out.push_back(id);
    }
}

bool is_half(Graph &graph, NodeId half, NodeId whole) {
    auto a = number(graph, half), b = number(graph, whole);
    if (a && b) return *a == *b / 2;
    if (graph[half].op == Op::Splat && graph[whole].op == Op::Splat)
        return is_half(graph, graph.arg(half, 0), graph.arg(whole, 0));
    if (graph[half].op == Op::Const && graph[whole].op == Op::Const) {
        const auto &x = graph.constant_of(half), &y = graph.constant_of(whole);
        for (int i = 0; i < ir::components(x.type); ++i)
            if (x.value[static_cast<std::size_t>(i)] != y.value[static_cast<std::size_t>(i)] / 2)
                return false;
        return x.type == y.type;
    }
    if (graph[half].op == Op::Div && graph.arg(half, 0) == whole &&
        number(graph, graph.arg(half, 1)) == 2.0)
        return true;
    if (graph[half].op == Op::Mul)
        for (int i = 0; i < 2; ++i)
            if (graph.arg(half, i) == whole && number(graph, graph.arg(half, 1 - i)) == 0.5)
                return true;
    return false;
}

// q = x/m, which may have become x*(1/m)
bool is_ratio(Graph &graph, NodeId q, NodeId x, NodeId m) {
    if (graph[q].op == Op::Div && graph.arg(q, 0) == x && graph.arg(q, 1) == m) return true;
    const auto step = number(graph, m);
    if (step && *step == 1 && q == x) return true;
    if (step && graph[q].op == Op::Mul)
        for (int k = 0; k < 2; ++k) {
            const auto inverse = number(graph, graph.arg(q, 1 - k));
            if (graph.arg(q, k) == x && inverse && *inverse * *step == 1) return true;
        }
    return false;
}

bool all_whole(Graph &graph, NodeId id) {
    if (graph[id].op == Op::Splat) return all_whole(graph, graph.arg(id, 0));
    if (!graph.is_constant(id)) return false;
    const ir::Constant &c = graph.constant_of(id);
    for (int i = 0; i < ir::components(c.type); ++i)
        if (c.value[static_cast<std::size_t>(i)] !=
            std::floor(c.value[static_cast<std::size_t>(i)]))
            return false;
    return true;
}

} // namespace

namespace {

// x - c, and of y + c or c + y just y.
NodeId without_term(Graph &graph, NodeId x, NodeId c) {
    if (graph[x].op == Op::Add)
        for (int i = 0; i < 2; ++i)
            if (graph.arg(x, i) == c) return graph.arg(x, 1 - i);
    return graph.sub(x, c);
}

} // namespace

std::optional<WaveParts> wave(Graph &graph, NodeId id) {
    const ir::Node node = graph[id]; // a copy: nodes are added below
    if (node.op != Op::Sub && node.op != Op::Add) return {};
    NodeId a = graph.arg(id, 0), b = graph.arg(id, 1);
    auto less_half = [&](NodeId part, NodeId m) {
        if (node.op == Op::Sub) return is_half(graph, part, m);
        if (graph[part].op == Op::Neg) return is_half(graph, graph.arg(part, 0), m);
        auto x = number(graph, part), y = number(graph, m);
        return x && y && *x == -*y / 2;
    };
    for (int i = 0; i < (node.op == Op::Add ? 2 : 1); ++i, std::swap(a, b)) {
        if (graph[a].op == Op::Mod && less_half(b, graph.arg(a, 1))) {
            NodeId m = graph.arg(a, 1);
            // x % m - m/2 = w(x - m/2), w the wave that passes through 0 at 0.
            const NodeId middle = node.op == Op::Sub ? b : graph.neg(b);
            return WaveParts{without_term(graph, graph.arg(a, 0), middle), m};
        }
        if (graph[a].op == Op::Fract) {
            auto half = number(graph, b);
            if (half && *half == (node.op == Op::Sub ? 0.5 : -0.5)) {
                NodeId one = graph.number(1);
                if (ir::components(node.type) > 1) one = graph.splat(one, node.type);
                const NodeId middle = graph.splat(graph.number(0.5), node.type);
                return WaveParts{without_term(graph, graph.arg(a, 0), middle), one};
            }
        }
    }
    a = graph.arg(id, 0), b = graph.arg(id, 1); // the loop has swapped them
    if (node.op == Op::Sub && graph[b].op == Op::Round && graph.arg(b, 0) == a)
        return WaveParts{a, graph.splat(graph.number(1), node.type)};
    if (node.op == Op::Sub && graph[b].op == Op::Mul)
        for (int i = 0; i < 2; ++i) {
            NodeId m = graph.arg(b, i), r = graph.arg(b, 1 - i);
            if (graph[r].op == Op::Round && is_ratio(graph, graph.arg(r, 0), a, m))
                return WaveParts{a, m};
        }
    return {};
}

std::optional<HeldWaveParts> held_wave(Graph &graph, NodeId id) {
    if (graph[id].op != Op::Sub) return {};
    const NodeId a = graph.arg(id, 0), b = graph.arg(id, 1);
    const auto held = [&](NodeId clamp, NodeId m) -> std::optional<HeldWaveParts> {
        if (graph[clamp].op != Op::Clamp) return {};
        const NodeId r = graph.arg(clamp, 0), lo = graph.arg(clamp, 1), hi = graph.arg(clamp, 2);
        if (graph[r].op != Op::Round || !all_whole(graph, lo) || !all_whole(graph, hi)) return {};
        if (!is_ratio(graph, graph.arg(r, 0), a, m)) return {};
        return HeldWaveParts{a, m, lo, hi};
    };
    if (graph[b].op == Op::Mul)
        for (int i = 0; i < 2; ++i)
            if (auto parts = held(graph.arg(b, i), graph.arg(b, 1 - i))) return parts;
    return held(b, graph.splat(graph.number(1), graph[id].type));
}

std::optional<NodeId> scaled_wave(Graph &graph, NodeId id) {
    const ir::Node node = graph[id];
    if (node.op != Op::Add && node.op != Op::Sub) return {};
    for (int i = 0; i < 2; ++i) {
        const NodeId product = graph.arg(id, i), offset = graph.arg(id, 1 - i);
        if (graph[product].op != Op::Mul) continue;
        for (int k = 0; k < 2; ++k) {
            const NodeId wave = graph.arg(product, k);
            auto by = number(graph, graph.arg(product, 1 - k)), add = number(graph, offset);
            if (graph[wave].op != Op::Fract || !by || !add) continue;
            if (node.op == Op::Sub && i == 0) *add = -*add;
            if (node.op == Op::Sub && i == 1) *by = -*by;
            if (*by == 0 || *add != -*by / 2) continue;
            const auto whole = [&](double x) { return graph.splat(graph.number(x), node.type); };
            return graph.make(Op::Mul, {graph.sub(wave, whole(0.5)), whole(*by)});
        }
    }
    return {};
}

namespace {

// x and n of x^n, also of products of x by itself.
struct PowerOf {
    NodeId base;
    double exponent = 1;
};
std::optional<PowerOf> norm_below(Graph &graph, NodeId sum, int depth);
PowerOf power_of(Graph &graph, NodeId id, int depth = 0) {
    constexpr int max_depth = 10; // a factor may stand in both parts of another, again and again
    const ir::Node node = graph[id];
    if (depth > max_depth) return {id, 1};
    const auto of = [&](NodeId part) { return power_of(graph, part, depth + 1); };
    if (node.op == Op::Mul && graph.arg(id, 0) == graph.arg(id, 1)) {
        const PowerOf inner = of(graph.arg(id, 0));
        return {inner.base, 2 * inner.exponent};
    }
    if (node.op == Op::Mul) {
        const PowerOf a = of(graph.arg(id, 0)), b = of(graph.arg(id, 1));
        if (a.base == b.base) return {a.base, a.exponent + b.exponent};
    }
    if (node.op == Op::Pow)
        if (const auto n = number(graph, graph.arg(id, 1)); n && *n > 0) {
            const PowerOf inner = of(graph.arg(id, 0));
            if (*n == std::floor(*n) || graph[inner.base].op == Op::Abs)
                return {inner.base, *n * inner.exponent};
            if (const auto sum = norm_below(graph, graph.arg(id, 0), depth + 1))
                return {sum->base, *n * sum->exponent};
        }
    if (node.op == Op::Swizzle && node.type == ir::Type::Float)
        if (const NodeId own = component_of(graph, id, 0); own != id) return of(own);
    if (node.op == Op::Abs) { // |x^n| = |x|^n
        const PowerOf inner = of(graph.arg(id, 0));
        const bool size = graph[inner.base].op == Op::Abs;
        if (inner.exponent > 1)
            return {size ? inner.base : graph.make(Op::Abs, {inner.base}), inner.exponent};
    }
    return {id, 1};
}

bool is_1(Graph &graph, NodeId vector) {
    for (int c = 0; c < ir::components(graph[vector].type); ++c)
        if (number(graph, component_of(graph, vector, c)) != 1.0) return false;
    return true;
}

bool powers(Graph &graph, NodeId sum, std::vector<PowerOf> &out, int depth = 0) {
    const ir::Node node = graph[sum];
    if (node.op == Op::Add)
        return powers(graph, graph.arg(sum, 0), out, depth) &&
               powers(graph, graph.arg(sum, 1), out, depth);
    if (node.op == Op::Dot && graph.arg(sum, 0) == graph.arg(sum, 1)) {
        for (int i = 0; i < ir::components(graph[graph.arg(sum, 0)].type); ++i) {
            PowerOf part = power_of(graph, component_of(graph, graph.arg(sum, 0), i), depth);
            part.exponent *= 2;
            out.push_back(part);
        }
        return true;
    }
    for (int i = 0; i < 2 && node.op == Op::Dot; ++i) // of 1, 1, …: the sum of all components
        if (const NodeId v = graph.arg(sum, 1 - i); is_1(graph, graph.arg(sum, i))) {
            for (int c = 0; c < ir::components(graph[v].type); ++c)
                out.push_back(power_of(graph, component_of(graph, v, c), depth));
            return true;
        }
    out.push_back(power_of(graph, sum, depth));
    return out.size() <= 15;
}

// The exponent that all terms have, of sizes or even; nothing where there is no such one.
std::optional<double> one_exponent(const Graph &graph, const std::vector<PowerOf> &terms) {
    const double n = terms[0].exponent;
    const bool even = std::fmod(n, 2) == 0;
    const bool all = std::ranges::all_of(terms, [&](const PowerOf &term) {
        return term.exponent == n && (even || is_never_negative(graph, term.base));
    });
    return terms.size() > 1 && all && n >= 1 ? std::optional(n) : std::nullopt;
}

// A sum of sizes to one power n as (their norm)^n.
std::optional<PowerOf> norm_below(Graph &graph, NodeId sum, int depth) {
    std::vector<PowerOf> terms;
    if (graph[sum].op != Op::Add || !powers(graph, sum, terms, depth)) return {};
    const auto n = one_exponent(graph, terms);
    if (!n) return {};
    const NodeId norm = graph.make(Op::Pow, {sum, graph.number(1 / *n)});
    return PowerOf{graph.make(Op::Abs, {norm}), *n};
}

// |x|, |y|, … of (|x|^n + |y|^n + …)^(1/n), where n does not vary but is no number.
std::optional<PNormParts> norm_of_unknown(Graph &graph, NodeId id) {
    if (graph[id].op != Op::Pow) return {};
    const NodeId below = graph.arg(id, 1);
    if (graph[below].op != Op::Div || graph.as_number(graph.arg(below, 0)) != 1.0) return {};
    PNormParts out;
    out.power = graph.arg(below, 1);
    if (graph.reads(out.power).point || graph.reads(out.power).free_vars) return {};
    std::vector<NodeId> todo{graph.arg(id, 0)};
    while (!todo.empty()) {
        NodeId term = todo.back();
        todo.pop_back();
        if (graph[term].op == Op::Swizzle) term = component_of(graph, term, 0);
        const ir::Node node = graph[term];
        if (node.op != Op::Add && node.op != Op::Pow) return {};
        const NodeId first = graph.arg(term, 0), second = graph.arg(term, 1);
        if (node.op == Op::Add) {
            todo.insert(todo.end(), {second, first});
            continue;
        }
        if (second != out.power || !is_never_negative(graph, first) || out.parts.size() == 15)
            return {};
        out.parts.push_back(first);
    }
    return out.parts.size() > 1 ? std::optional(out) : std::nullopt;
}

} // namespace

std::optional<PNormParts> p_norm(Graph &graph, NodeId id) {
    if (graph[id].type != ir::Type::Float) return {};
    if (const auto parts = norm_of_unknown(graph, id)) return parts;
    double exponent = 1; // of the roots, one of another
    NodeId sum = id;
    while (exponent > 1e-3) {
        const ir::Node node = graph[sum];
        const auto e = node.op == Op::Sqrt  ? std::optional(0.5)
                       : node.op == Op::Pow ? number(graph, graph.arg(sum, 1))
                                            : std::nullopt;
        if (!e || !(*e > 0 && *e < 1)) break;
        exponent *= *e;
        sum = graph.arg(sum, 0);
    }
    std::vector<PowerOf> terms;
    if (exponent == 1 || !powers(graph, sum, terms)) return {};
    const auto n = one_exponent(graph, terms);
    if (!n || std::fabs(*n * exponent - 1) > 2e-7) return {};
    PNormParts out;
    for (const PowerOf &term : terms) out.parts.push_back(term.base);
    out.power = graph.number(*n);
    return out;
}

std::optional<NodeId> corner(Graph &graph, NodeId id) {
    if (graph[id].op != Op::Add || graph[id].type != ir::Type::Float) return {};
    for (int i = 0; i < 2; ++i) {
        const NodeId length = graph.arg(id, i), inside = graph.arg(id, 1 - i);
        const Op op = graph[inside].op;
        if (graph[length].op != Op::Length || (op != Op::Min && op != Op::Max)) continue;
        const auto v = above_zero(graph, Op::Max, graph.arg(length, 0));
        const auto most = op == Op::Max ? inside : above_zero(graph, Op::Min, inside);
        if (!v || !most) continue;
        std::vector<NodeId> found, wanted;
        greatest_of(graph, *most, found);
        NodeId of = *v; // or min(v, 0), of which hg_sdf takes the greatest component
        if (op == Op::Max && graph[found.front()].op == Op::Swizzle) {
            of = graph.arg(found.front(), 0);
            if (above_zero(graph, Op::Min, of) != v) continue;
        } else if (op == Op::Max) {
            continue;
        }
        for (int c = 0; c < ir::components(graph[*v].type); ++c)
            wanted.push_back(graph.component(of, c));
        std::sort(found.begin(), found.end());
        std::sort(wanted.begin(), wanted.end());
        if (found == wanted) return v;
    }
    return {};
}

std::optional<NodeId> round_edge(Graph &graph, NodeId id) {
    const ir::Node node = graph[id];
    if (node.type != ir::Type::Float || (node.op != Op::Add && node.op != Op::Sub)) return {};
    const bool outside = node.op == Op::Add; // of an intersection
    for (int i = outside ? 0 : 1; i < 2; ++i) {
        const NodeId length = graph.arg(id, i), inside = graph.arg(id, 1 - i);
        if (graph[length].op != Op::Length || graph[inside].op != (outside ? Op::Min : Op::Max))
            continue;
        const auto v = above_zero(graph, Op::Max, graph.arg(length, 0));
        for (int k = 0; v && k < 2; ++k) {
            const NodeId c = graph.arg(inside, k);
            std::vector<NodeId> terms;
            greatest_of(graph, graph.arg(inside, 1 - k), terms, outside ? Op::Max : Op::Min);
            const int n = ir::components(graph[*v].type);
            const ir::Graph::Reads reads = graph.reads(c);
            if (reads.point || reads.free_vars || graph.as_number(c) == 0.0) continue;
            if (int(terms.size()) != n) continue;
            NodeId most;
            for (int m = 0; m < n; ++m) {
                const NodeId part = component_of(graph, *v, m);
                const auto found = std::find_if(terms.begin(), terms.end(), [&](NodeId t) {
                    return same(graph, part, outside ? graph.sub(t, c) : graph.sub(c, t));
                });
                if (found == terms.end()) break;
                terms.erase(found);
                const NodeId own = graph.component(*v, m);
                most = most ? graph.make(Op::Max, {most, own}) : own;
            }
            if (!terms.empty()) continue;
            const NodeId corner = graph.add(length, graph.make(Op::Min, {most, graph.number(0)}));
            return outside ? graph.add(corner, c) : graph.sub(c, corner);
        }
    }
    return {};
}

std::optional<NodeId> hermite(Graph &graph, NodeId id) {
    std::vector<NodeId> factors{id};
    for (std::size_t i = 0; i < factors.size();)
        if (const NodeId f = factors[i]; graph[f].op == Op::Mul && factors.size() < 4) {
            factors[i] = graph.arg(f, 0);
            factors.push_back(graph.arg(f, 1));
        } else {
            ++i;
        }
    if (factors.size() != 3) return {};
    for (std::size_t i = 0; i < 3; ++i) {
        const NodeId rest = factors[i], u = factors[(i + 1) % 3];
        if (factors[(i + 2) % 3] != u || graph[rest].op != Op::Sub) continue;
        const ir::Node node = graph[u];
        const bool in_unit = node.op == Op::Fract ||
                             (node.op == Op::Clamp && number(graph, graph.arg(u, 1)) == 0.0 &&
                              number(graph, graph.arg(u, 2)) == 1.0);
        const NodeId twice = graph.arg(rest, 1);
        if (!in_unit || number(graph, graph.arg(rest, 0)) != 3.0 || graph[twice].op != Op::Mul)
            continue;
        for (int k = 0; k < 2; ++k)
            if (graph.arg(twice, k) == u && number(graph, graph.arg(twice, 1 - k)) == 2.0) {
                const auto whole = [&](double x) {
                    return graph.splat(graph.number(x), node.type);
                };
                return graph.make(Op::Smoothstep, {whole(0), whole(1), u});
            }
    }
    return {};
}

std::optional<OddPowerParts> odd_power(Graph &graph, NodeId id) {
    if (graph[id].op != Op::Mul) return {};
    for (int i = 0; i < 2; ++i) {
        const NodeId x = graph.arg(id, i), power = graph.arg(id, 1 - i);
        if (graph[power].op != Op::Pow || graph[graph.arg(power, 0)].op != Op::Abs) continue;
        const NodeId exponent = graph.arg(power, 1);
        const auto c = number(graph, exponent);
        if (graph.arg(graph.arg(power, 0), 0) == x && c && *c > 0)
            return OddPowerParts{x, exponent};
    }
    return {};
}

} // namespace fathom::proof
