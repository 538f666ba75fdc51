// x - m*(S((x + c)/m) + d) with S one of floor, round and ceil is w(x + at) + beyond: floor(u + h)
// is round(u + h - 1/2), but at its borders, where both are m/2 or -m/2 beside `beyond`.
#include "proof/lattices.h"

#include "ir/passes/walk.h"
#include "proof/continuity.h"

#include <algorithm>
#include <cmath>

namespace fathom::proof {
namespace {

using ir::Graph;
using ir::NodeId;
using ir::Op;

struct Added {
    double number = 0;
    SignedTerms terms;
};

constexpr std::size_t max_terms = 6;

void add_up(Graph &graph, NodeId id, double sign, Added &out, int depth = 0) {
    constexpr int max_depth = 10;
    if (out.terms.size() > max_terms) return;
    if (graph[id].op == Op::Swizzle) id = component_of(graph, id, 0);
    const Op op = graph[id].op;
    if (const auto number = graph.as_number(id)) {
        out.number += sign * *number;
    } else if (op == Op::Neg && depth < max_depth) {
        add_up(graph, graph.arg(id, 0), -sign, out, depth + 1);
    } else if ((op == Op::Add || op == Op::Sub) && depth < max_depth) {
        const NodeId a = graph.arg(id, 0), b = graph.arg(id, 1);
        add_up(graph, a, sign, out, depth + 1);
        add_up(graph, b, op == Op::Sub ? -sign : sign, out, depth + 1);
    } else {
        out.terms.emplace_back(id, sign);
    }
}
Added sum_of(Graph &graph, NodeId id) {
    Added out;
    add_up(graph, id, 1, out);
    std::sort(out.terms.begin(), out.terms.end());
    return out;
}

// k and x of k*x, x/(1/k) and x, k a number.
struct Multiple {
    double by = 1;
    NodeId of;
};
Multiple multiple_of(Graph &graph, NodeId id) {
    const Op op = graph[id].op;
    for (int i = op == Op::Mul ? 0 : 1; i < 2 && (op == Op::Mul || op == Op::Div); ++i)
        if (const auto by = graph.as_number(graph.arg(id, i)))
            return {op == Op::Div ? 1 / *by : *by, graph.arg(id, 1 - i)};
    return {.of = id};
}

// What a step rounds down: (base + at)/period + more.
struct RoundedDown {
    SignedTerms base;
    double at = 0;
};
std::optional<RoundedDown> rounded_down(Graph &graph, NodeId argument, double period, double more) {
    Added sum = sum_of(graph, argument);
    double by = 1, inside = 0;
    if (sum.terms.size() == 1 && sum.terms[0].second == 1)
        if (const Multiple ratio = multiple_of(graph, sum.terms[0].first);
            ratio.of != sum.terms[0].first) {
            Added above = sum_of(graph, ratio.of);
            by = ratio.by, inside = above.number, sum.terms = std::move(above.terms);
        }
    if (!(std::fabs(by * period - 1) <= 1e-12)) return {};
    return RoundedDown{std::move(sum.terms), inside + period * (sum.number + more)};
}

// A term that steps: by times a fraction or a count, and a number.
struct Stepping {
    Op op;
    NodeId argument;
    double by = 0, number = 0;
};
std::optional<Stepping> stepping(Graph &graph, NodeId term, double sign) {
    constexpr ir::OpSet steps{Op::Floor, Op::Ceil, Op::Round, Op::Fract};
    const Multiple product = multiple_of(graph, term);
    const Added inside = sum_of(graph, product.of);
    if (inside.terms.size() != 1) return {};
    const auto [step, own] = inside.terms[0];
    if (!steps[graph[step].op]) return {};
    const double by = sign * product.by;
    return Stepping{graph[step].op, graph.arg(step, 0), by * own, by * inside.number};
}

// base + number - period*floor((base + at)/period), as w(base + at - period/2) and a number.
struct Centred {
    SignedTerms base;
    double period = 0, at = 0, beyond = 0;
};
std::optional<Centred> centred(RoundedDown step, double number, double period) {
    const double scale = std::fabs(number) + std::fabs(step.at) + period;
    if (!(period > 0) || !(scale < 1e6)) return {};
    const double at = step.at - period / 2, beyond = number - at;
    const bool is_none = std::fabs(beyond) <= 1e-14 * scale;
    return Centred{std::move(step.base), period, at, is_none ? 0 : beyond};
}

std::optional<Centred> of_remainder(Graph &graph, const Added &sum) {
    const auto [term, sign] = sum.terms[0];
    if (graph[term].op == Op::Mod) {
        const auto period = graph.as_number(graph.arg(term, 1));
        if (!period || sign != 1) return {};
        Added x = sum_of(graph, graph.arg(term, 0));
        return centred({std::move(x.terms), x.number}, sum.number + x.number, *period);
    }
    const auto step = stepping(graph, term, sign);
    if (!step || step->op != Op::Fract) return {};
    auto below = rounded_down(graph, step->argument, step->by, 0);
    if (!below) return {};
    const double number = sum.number + step->number + below->at;
    return centred(std::move(*below), number, step->by);
}

std::optional<Centred> of_count(Graph &graph, const Added &sum) {
    for (const auto &[term, sign] : sum.terms) {
        const auto step = stepping(graph, term, sign);
        if (!step || step->op == Op::Fract) continue;
        const double more = step->op == Op::Floor ? 0 : step->op == Op::Round ? 0.5 : 1;
        auto below = rounded_down(graph, step->argument, -step->by, more);
        SignedTerms base = sum.terms;
        std::erase(base, std::pair(term, sign));
        if (below && below->base == base)
            return centred(std::move(*below), sum.number + step->number, -step->by);
    }
    return {};
}

std::optional<Centred> centred(Graph &graph, NodeId scalar) {
    const Added sum = sum_of(graph, scalar);
    if (sum.terms.empty() || sum.terms.size() > max_terms) return {};
    return sum.terms.size() == 1 ? of_remainder(graph, sum) : of_count(graph, sum);
}

NodeId joined(Graph &graph, ir::Type type, const std::vector<NodeId> &parts) {
    return parts.size() == 1 ? parts[0] : graph.make(Op::Make, type, parts);
}

// v of |v|, or of v.v
std::optional<NodeId> vector_of_size(const Graph &graph, NodeId id) {
    const Op op = graph[id].op;
    if (op != Op::Length && (op != Op::Dot || graph.arg(id, 0) != graph.arg(id, 1))) return {};
    return graph.arg(id, 0);
}

bool is_centred(const Lattice &lattice) { return lattice.beyond == Numbers{}; }

// Is `near` the shorter wherever `far` is not its lattice's nearest, or would be with borders midway?
bool is_hidden(const Lattice &near, const Lattice &far, int size) {
    double all = 0;
    for (std::size_t i = 0; i < std::size_t(size); ++i) all += far.period[i] * far.period[i] / 4;
    for (std::size_t i = 0; i < std::size_t(size); ++i) {
        const double beyond = std::fabs(far.beyond[i]), own = far.period[i] * far.period[i] / 4;
        if (beyond == 0) continue;
        if (!(beyond < far.period[i] / 2)) return false;
        if (!(own - far.period[i] * beyond > (all - own) + 1e-6 * all)) return false;
    }
    return is_centred(near);
}

Lattice with_borders_midway(Lattice lattice) {
    for (std::size_t c = 0; c < lattice.at.size(); ++c) {
        lattice.at[c] += lattice.beyond[c];
        lattice.beyond[c] = 0;
    }
    return lattice;
}

// The way from the nearest point of a lattice with borders midway, made as its vector is.
NodeId nearest(Graph &graph, const Lattice &lattice) {
    const NodeId x = place_of(graph, lattice), m = period_of(graph, lattice);
    if (graph[lattice.node].op != Op::Make)
        return graph.sub(x, graph.mul(m, graph.make(Op::Round, {graph.div(x, m)})));
    std::vector<NodeId> parts;
    const ir::Type type = graph.type(lattice.node);
    for (int c = 0; c < ir::components(type); ++c) {
        const NodeId own = component_of(graph, x, c), period = component_of(graph, m, c);
        const NodeId turns = graph.make(Op::Round, {graph.div(own, period)});
        parts.push_back(graph.sub(own, graph.mul(period, turns)));
    }
    return joined(graph, type, parts);
}

} // namespace

std::optional<Lattice> lattice(Graph &graph, NodeId id) {
    const ir::Type type = graph.type(id);
    if (type != ir::Type::Float && !ir::is_vector(type)) return {};
    Lattice out{id, {}, {}, {}, {}};
    for (int i = 0; i < ir::components(type); ++i) {
        auto part = centred(graph, ir::is_vector(type) ? component_of(graph, id, i) : id);
        if (!part) return {};
        const auto c = std::size_t(i);
        out.base[c] = std::move(part->base);
        out.period[c] = part->period, out.at[c] = part->at, out.beyond[c] = part->beyond;
    }
    return out;
}

NodeId place_of(Graph &graph, const Lattice &lattice) {
    const ir::Type type = graph.type(lattice.node);
    std::vector<NodeId> parts;
    for (std::size_t i = 0; i < std::size_t(ir::components(type)); ++i) {
        NodeId sum = graph.number(lattice.at[i]);
        for (const auto &[term, sign] : lattice.base[i])
            sum = sign > 0 ? graph.add(sum, term) : graph.sub(sum, term);
        parts.push_back(sum);
    }
    return joined(graph, type, parts);
}
NodeId period_of(Graph &graph, const Lattice &lattice) {
    const ir::Type type = graph.type(lattice.node);
    std::vector<NodeId> parts;
    for (std::size_t i = 0; i < std::size_t(ir::components(type)); ++i)
        parts.push_back(graph.number(lattice.period[i]));
    return joined(graph, type, parts);
}

bool is_half_beside(const Lattice &a, const Lattice &b, int components) {
    if (a.base != b.base) return false;
    for (std::size_t i = 0; i < std::size_t(components); ++i) {
        if (a.period[i] != b.period[i] || a.beyond[i] != 0 || b.beyond[i] != 0) return false;
        const double periods = (a.at[i] - b.at[i]) / a.period[i];
        if (!(std::fabs(std::fabs(periods - std::round(periods)) - 0.5) <= 1e-12)) return false;
    }
    return true;
}

std::optional<NodeId> with_borders_midway(Graph &graph, NodeId choice) {
    if (graph[choice].op != Op::Select) return {};
    const NodeId condition = graph.arg(choice, 0);
    const Op op = graph[condition].op;
    if (op != Op::Less && op != Op::LessEqual) return {};
    std::array<NodeId, 2> sides{graph.arg(condition, 0), graph.arg(condition, 1)},
        arms{graph.arg(choice, 1), graph.arg(choice, 2)};
    if (graph[sides[0]].op != graph[sides[1]].op) return {};
    for (std::size_t i = 0; i < 2; ++i) { // the side with borders aside
        const auto u = vector_of_size(graph, sides[i]), v = vector_of_size(graph, sides[1 - i]);
        if (!u || !v || graph.type(*u) != graph.type(*v)) return {};
        const auto far = lattice(graph, *u), near = lattice(graph, *v);
        const int size = ir::components(graph.type(*u));
        if (!far || !near || is_centred(*far) || !is_hidden(*near, *far, size)) continue;
        const Lattice midway = with_borders_midway(*far);
        if (!is_half_beside(*near, midway, size)) continue;
        const NodeId own = nearest(graph, midway);
        ir::Substitution instead{{*u, own}};
        for (int c = 0; c < size; ++c)
            if (const NodeId part = component_of(graph, *u, c); !graph.is_constant(part))
                instead[part] = component_of(graph, own, c);
        const ir::Node square = graph[sides[i]];
        sides[i] = square.op == Op::Length ? graph.make(Op::Length, {own})
                                           : graph.make(Op::Dot, {own, own});
        // The first side is the shorter where the first arm is taken.
        arms[i] = ir::substitute(graph, arms[i], instead);
        return graph.make(Op::Select, graph.type(choice),
                          {graph.make(op, {sides[0], sides[1]}), arms[0], arms[1]});
    }
    return {};
}

} // namespace fathom::proof
