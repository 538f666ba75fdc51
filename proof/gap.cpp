// How far two distances differ. Proof: docs/lipschitz.md, 3.
#include "proof/gap.h"

#include "ir/passes/inline.h"
#include "proof/continuity.h"
#include "proof/crossings.h"
#include "proof/forms.h"
#include "proof/polynomials.h"
#include "proof/question.h"

#include <algorithm>
#include <cmath>
#include <queue>

namespace fathom::proof {

using ir::rounding::infinity;
using ir::rounding::up;

namespace {

// The values of f, g and f - g, with the mean value theorem from the middle; f and g are
// 1-Lipschitz.
class GapSearch {
  public:
    GapSearch(const Tape &tape, const Ranges &ranges, bool inside)
        : machine_(tape, ranges), inside_(inside) {
        machine_.narrow_still();
    }

    double run(const Cell &domain, const Budget &budget) {
        push(domain);
        while (!queue_.empty()) {
            const auto [bound, at] = queue_.top();

            if (bound <= std::max(seen_ * budget.tolerance, budget.enough) ||
                machine_.work() > budget.instructions || seen_ > budget.hopeless)
                return bound;
            queue_.pop();
            const auto [cell, axis] = cells_[at];
            if (cell.p[axis].width() <= 1e-9) return bound;
            Cell left = cell, right = cell;
            left.p[axis].hi = right.p[axis].lo = cell.p[axis].middle();
            push(left);
            push(right);
        }
        return 0;
    }

  private:
    static constexpr double least_share = 1.0 / 16;
    struct Part {
        Cell cell;
        std::size_t axis; // along which it is cut: the one that adds most to the bound
    };

    // Both above 0, or both below it where both are distances there.
    bool is_of_no_account(const Interval &f, const Interval &g) const {
        return (f.lo > 0 && g.lo > 0) || (inside_ && f.hi < 0 && g.hi < 0);
    }

    void push(const Cell &cell) {
        machine_.run(cell);
        Interval f = machine_.value(0), g = machine_.value(1), gap = machine_.value(2);
        double squares = 0, reach = 0, most_of = -1;
        std::size_t axis = 0;
        Cell middle;
        for (std::size_t i = 0; i < 3; ++i) {
            middle.p[i] = cell.p[i].middle();
            const double half = (cell.p[i] - middle.p[i]).magnitude();
            squares = up(squares + up(half * half));
            const double steep = machine_.row(2)[i].magnitude();
            reach = up(reach + ir::rounding::times(steep, half));
            const double share = half * (std::min(steep, 2.0) + least_share);
            if (share > most_of) most_of = share, axis = i;
        }
        const bool is_bounded = machine_.norm() != infinity;
        const double radius = up(std::sqrt(squares), 2);
        machine_.run(middle);
        f = meet(f, machine_.value(0) + Interval(-radius, radius));
        g = meet(g, machine_.value(1) + Interval(-radius, radius));
        if (is_of_no_account(f, g)) return;
        const Interval here = machine_.value(2);
        if (!is_of_no_account(machine_.value(0), machine_.value(1)))
            seen_ = std::max(seen_, here.mignitude());
        const double most = std::min(is_bounded ? reach : infinity, 2 * radius);
        gap = meet(meet(gap, f - g), here + Interval(-most, most));
        queue_.push({gap.magnitude(), std::uint32_t(cells_.size())});
        cells_.push_back({cell, axis});
    }

    Machine machine_;
    const bool inside_;
    double seen_ = 0;
    std::priority_queue<std::pair<double, std::uint32_t>> queue_;
    std::vector<Part> cells_;
};

// Of a domain that is its own mirror image one half, as far as both have equal values on both sides.
Cell half_of(const Tape &tape, Cell domain) {
    for (std::size_t i = 0; i < 3; ++i)
        if (domain.p[i].lo < 0 && -domain.p[i].lo <= domain.p[i].hi &&
            reflected(tape, {i == 0, i == 1, i == 2}) == Reflected::Same)
            domain.p[i].lo = 0;
    return domain;
}

// |f - g| from outside in: what both do alike, and with no more than a slope of 1, leaves the
// difference of what they do it to.
class Likeness {
  public:
    Likeness(Flattening &context, const Ranges &ranges, const Cell &domain)
        : context_(context), graph_(context.graph), ranges_(ranges), domain_(domain) {}

    double of(NodeId f, NodeId g, int depth = 0) {
        if (f == g) return 0;
        const auto key = std::pair(f, g);
        if (const auto found = known_.find(key); found != known_.end()) return found->second;
        if (depth > max_depth || known_.size() >= max_pairs || graph_[f].type != graph_[g].type)
            return infinity;
        const auto [a, more] = without_number(f);
        const auto [b, less] = without_number(g);
        double out = by_terms(f, g);
        if (more || less) {
            const NodeId rest =
                graph_.sub(more ? more : graph_.number(0), less ? less : graph_.number(0));
            out = std::min(out, up(of(a, b, depth + 1) + size_of(rest)));
        } else {
            out = std::min(out, by_parts(f, g, depth + 1));
        }
        known_[key] = out;
        return out;
    }

  private:
    static constexpr int max_depth = 40;
    static constexpr std::size_t max_pairs = 300;

    static double length_of(const std::vector<double> &parts) {
        double squares = 0;
        for (double x : parts) squares = x == 0 ? squares : up(squares + up(x * x));
        return squares == 0 ? 0 : up(std::sqrt(squares));
    }
    double size_of(NodeId scalar) {
        return range_of(context_, ranges_, scalar, domain_)[0].magnitude();
    }
    // A scalar as another and a number that is the same at all points, or none.
    std::pair<NodeId, NodeId> without_number(NodeId f) {
        const ir::Node node = graph_[f];
        if (node.type != ir::Type::Float || corner(graph_, f)) return {f, NodeId()};
        if (node.op != Op::Add && node.op != Op::Sub) return {f, NodeId()};
        const NodeId a = graph_.arg(f, 0), b = graph_.arg(f, 1);
        if (!graph_.reads(b).point) return {a, node.op == Op::Add ? b : graph_.neg(b)};
        if (!graph_.reads(a).point && node.op == Op::Add) return {b, a};
        return {f, NodeId()};
    }
    // As sums of products.
    double by_terms(NodeId f, NodeId g) {
        const int n = ir::components(graph_[f].type);
        std::vector<double> parts;
        for (int i = 0; i < n; ++i) {
            const NodeId a = n == 1 ? f : component_of(graph_, f, i),
                         b = n == 1 ? g : component_of(graph_, g, i);
            const auto terms = polynomial(graph_, graph_.sub(a, b), &context_.work);
            if (!terms) return infinity;
            parts.push_back(size_of(rebuilt(graph_, *terms)));
        }
        return length_of(parts);
    }
    double by_parts(NodeId f, NodeId g, int depth) {
        const auto u = corner(graph_, f), v = corner(graph_, g);
        if (u && v) return of(*u, *v, depth);
        const ir::Node a = graph_[f], b = graph_[g];
        if (a.op != b.op || a.payload != b.payload ||
            graph_.args(f).size() != graph_.args(g).size())
            return infinity;
        if (a.op == Op::Mul) return by_factor(f, g, depth);
        if (a.op == Op::MatMul) return by_matrix(f, g, depth);
        std::vector<double> parts;
        constexpr ir::OpSet of_one{Op::Neg, Op::Abs, Op::Sin, Op::Cos, Op::Length};
        constexpr ir::OpSet of_all{Op::Make, Op::Min, Op::Max, Op::Add, Op::Sub};
        const bool one = of_one[a.op] || (a.op == Op::Swizzle && a.type == ir::Type::Float);
        if (!one && !of_all[a.op]) return infinity;
        for (std::size_t i = 0; i < graph_.args(f).size(); ++i)
            parts.push_back(of(graph_.arg(f, int(i)), graph_.arg(g, int(i)), depth));
        if (one) return parts[0];
        if (a.op == Op::Add || a.op == Op::Sub) {
            double sum = 0;
            for (double x : parts) sum = x == 0 ? sum : up(sum + x);
            return sum;
        }
        const bool chosen = a.op != Op::Make && a.type == ir::Type::Float;
        return chosen ? *std::ranges::max_element(parts) : length_of(parts);
    }
    double by_factor(NodeId f, NodeId g, int depth) {
        for (int same : {0, 1}) {
            const NodeId by = graph_.arg(f, same);
            if (by != graph_.arg(g, same) || graph_[by].type != ir::Type::Float) continue;
            const double rest = of(graph_.arg(f, 1 - same), graph_.arg(g, 1 - same), depth);
            const double out = ir::rounding::times(size_of(by), rest);
            return out == 0 ? 0 : up(out);
        }
        return infinity;
    }

    double by_matrix(NodeId f, NodeId g, int depth) {
        // M v, or v M, whose norm is the same
        const int at = ir::is_matrix(graph_[graph_.arg(f, 0)].type) ? 0 : 1;
        const NodeId by = graph_.arg(f, at);
        if (by != graph_.arg(g, at) || !ir::is_vector(graph_[f].type)) return infinity;
        const std::array<Interval, 16> numbers = range_of(context_, ranges_, by, domain_);
        const int n = ir::components(graph_[f].type);
        if (n > 3) return infinity;
        Row rows[3];
        for (int i = 0; i < n; ++i)
            for (int k = 0; k < n; ++k) rows[i][std::size_t(k)] = numbers[std::size_t(k * n + i)];
        const double rest = of(graph_.arg(f, 1 - at), graph_.arg(g, 1 - at), depth);
        const double out = ir::rounding::times(spectral_norm(rows, n), rest);
        return out == 0 ? 0 : up(out);
    }

    Flattening &context_;
    Graph &graph_;
    const Ranges &ranges_;
    const Cell domain_;
    std::map<std::pair<NodeId, NodeId>, double> known_;
};

NodeId without_calls(Flattening &context, NodeId field) {
    constexpr std::size_t max_nodes = 2'000;
    context.work.take(max_nodes);
    const ir::WithoutCalls out = ir::without_calls(context.graph, field, max_nodes);
    return out.all ? out.root : field;
}

} // namespace

double bound_difference(Flattening &context, const Ranges &ranges, NodeId f, NodeId g,
                        const Cell &domain) {
    return Likeness(context, ranges, domain)
        .of(without_calls(context, f), without_calls(context, g));
}

double bound_gap(Flattening &context, const Ranges &ranges, NodeId f, NodeId g, bool inside,
                 const Cell &domain, const Budget &budget) {
    Graph &graph = context.graph;
    const NodeId difference = graph.sub(f, g);
    const auto terms = polynomial(graph, difference, &context.work);
    const NodeId all =
        graph.make(Op::Make, ir::Type::Vec3, {f, g, terms ? rebuilt(graph, *terms) : difference});
    Question question(context, ranges, all, inside ? Wanted::GapInside : Wanted::Gap);
    question.add(domain);
    question.add(budget);
    return std::move(question)
        .answer([&](Flattening &own, const Ranges &known, NodeId copy) {
            FieldBound out;
            const Tape tape = flatten(own, copy, &domain);
            out.lipschitz = tape.too_large
                                ? infinity
                                : GapSearch(tape, known, inside).run(half_of(tape, domain), budget);
            return out;
        })
        .lipschitz;
}

} // namespace fathom::proof
