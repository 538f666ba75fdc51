#include "proof/polynomials.h"

#include "proof/continuity.h"
#include "proof/exact.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fathom::proof {

namespace {

constexpr std::size_t max_terms = 160, max_factors = 12;

// A factor that stands twice in a product, and what its square is: |a|^2 = a^2, cos^2 = 1 - sin^2.
bool has_square(const Graph &graph, NodeId factor) {
    return graph[factor].op == Op::Abs || graph[factor].op == Op::Cos;
}

bool by_component(Op op) {
    return ir::info(op).rule == ir::TypeRule::Same && op != Op::Cross && op != Op::Normalize &&
           op != Op::Transpose;
}

// Is the first coefficient negative? Of a sum and its negative one is, and equal ones are alike.
bool leads_below_zero(const Polynomial &sum) {
    const auto lead = std::ranges::find_if(sum, [](const auto &term) { return term.second != 0; });
    return lead != sum.end() && lead->second < 0;
}

} // namespace

NodeId rebuilt(Graph &graph, const Polynomial &polynomial) {
    NodeId sum = graph.number(0);
    for (const auto &[m, c] : polynomial) {
        if (c == 0) continue;
        NodeId term = graph.number(c);
        for (NodeId f : m) term = graph.mul(term, f);
        sum = graph.add(sum, term);
    }
    return sum;
}

std::optional<Polynomial> polynomial(Graph &graph, NodeId id, Work *work) {
    return Expansion(graph, work).of(id);
}

bool Expansion::take(std::size_t steps) {
    constexpr std::size_t dearer = 16; // than an operation on intervals
    left_ -= std::min(left_, steps);
    if (work_ && counts_ == Counts::Steps) work_->take(dearer * steps);
    if (work_ && counts_ == Counts::Nothing) work_->pass(dearer * steps);
    const bool goes_on = left_ > 0 && !(work_ && work_->spent());
    gave_up_ = gave_up_ || !goes_on;
    return goes_on;
}

std::optional<Polynomial> Expansion::squared(NodeId factor) {
    const NodeId x = graph_.arg(factor, 0);
    if (graph_[factor].op == Op::Cos) {
        const NodeId sine = graph_.make(Op::Sin, {x});
        return Polynomial{{{}, 1.0}, {{sine, sine}, -1.0}};
    }
    const auto &inner = of(x);
    return inner ? multiply(*inner, *inner) : std::nullopt;
}

std::optional<Polynomial> Expansion::multiply(const Polynomial &a, const Polynomial &b) {
    if (!take(a.size() * b.size())) return {};
    Polynomial out;
    for (const auto &[m, x] : a)
        for (const auto &[n, y] : b) {
            Monomial product = m;
            product.insert(product.end(), n.begin(), n.end());
            std::sort(product.begin(), product.end());
            const auto twice =
                std::adjacent_find(product.begin(), product.end(), [&](NodeId u, NodeId v) {
                    return u == v && has_square(graph_, u);
                });
            if (twice != product.end()) {
                const NodeId factor = *twice;
                product.erase(twice, twice + 2);
                const auto square = squared(factor);
                if (!square) return {};
                auto whole = multiply(*square, Polynomial{{product, x * y}});
                if (!whole) return {};
                for (const auto &[k, z] : *whole) out[k] += z;
            } else {
                out[product] += x * y;
            }
            if (out.size() > max_terms || product.size() > max_factors) return {};
        }
    return out;
}

const std::optional<Polynomial> &Expansion::of(NodeId id) {
    static const std::optional<Polynomial> nothing;
    if (const auto it = known_.find(id); it != known_.end()) return it->second;
    if (auto c = graph_.as_number(id))
        return known_.emplace(id, Polynomial{{{}, *c}}).first->second;
    gave_up_ = gave_up_ || depth_ >= 256;
    if (depth_ >= 256 || !take(1)) return nothing;
    ++depth_;
    auto out = written(id);
    --depth_;
    return known_.emplace(id, std::move(out)).first->second;
}

const std::optional<Polynomial> &Expansion::of_next(NodeId id) {
    if (std::exchange(gave_up_, false) || known_.size() > most_known) known_.clear();
    left_ = most_steps;
    return of(id);
}

// a + by*b.
std::optional<Polynomial> Expansion::sum_of(NodeId a, double by, NodeId b) {
    auto sum = of(a);
    const auto &more = of(b);
    if (!sum || !more || !take(more->size())) return {};
    for (const auto &[m, x] : *more) (*sum)[m] += by * x;
    return sum->size() > max_terms ? std::optional<Polynomial>() : sum;
}

std::optional<Polynomial> Expansion::written(NodeId id) {
    const ir::Node node = graph_[id];
    const auto alone = Polynomial{{{id}, 1.0}};
    if (node.type != ir::Type::Float) return alone;
    const auto arg = [&](int i) { return graph_.arg(id, i); };
    const auto times = [](std::optional<Polynomial> sum, double by) {
        if (sum)
            for (auto &[m, x] : *sum) x *= by;
        return sum;
    };
    if (node.op == Op::Neg) return times(of(arg(0)), -1);
    if (node.op == Op::Add || node.op == Op::Sub)
        return sum_of(arg(0), node.op == Op::Add ? 1 : -1, arg(1));
    if (node.op == Op::Mul) {
        const auto &a = of(arg(0)), &b = of(arg(1));
        return a && b ? multiply(*a, *b) : std::nullopt;
    }
    if (node.op == Op::Div) {
        const auto c = graph_.as_number(arg(1));
        if (c && *c != 0) {
            auto a = of(arg(0));
            if (!a) return {};
            for (auto &[m, x] : *a) x /= *c;
            return a;
        }
        const auto &above = of(arg(0));
        const bool nothing =
            above && std::ranges::all_of(*above, [](const auto &term) { return term.second == 0; });
        if (nothing) return Polynomial(); // wherever it is a number
    }
    if (node.op == Op::Pow)
        if (auto c = graph_.as_number(arg(1)); c && std::floor(*c) == *c && *c >= 1 && *c <= 6) {
            const auto a = of(arg(0));
            auto out = a;
            for (int i = 1; a && out && i < int(*c); ++i) out = multiply(*out, *a);
            return out;
        }
    if (node.op == Op::Dot) {
        const NodeId u = arg(0), v = arg(1);
        Polynomial sum;
        for (int i = 0; i < ir::components(graph_[u].type); ++i) {
            const auto &a = of(component_of(graph_, u, i)), &b = of(component_of(graph_, v, i));
            if (!a || !b) return {};
            const auto product = multiply(*a, *b);
            if (!product) return {};
            for (const auto &[m, x] : *product) sum[m] += x;
        }
        return sum;
    }
    if (node.op == Op::Swizzle) {
        const NodeId inner = component_of(graph_, arg(0), ir::swizzle_component(node.payload, 0));
        if (inner != id) return of(inner);
    }
    if (!by_component(node.op) || node.count == 0) return alone;
    // The same function of arguments in one form.
    constexpr ir::OpSet mirrored{Op::Abs, Op::Cos, Op::Sin}; // f(-x) is f(x) or -f(x)
    std::vector<NodeId> args;
    double sign = 1;
    for (int i = 0; i < int(node.count); ++i) {
        auto a = of(arg(i));
        if (tells_apart[node.op] && !(a && is_exact(graph_, *a))) return alone;
        if (a && !a->empty() && mirrored[node.op] && leads_below_zero(*a)) {
            for (auto &[m, x] : *a) x = -x;
            sign = node.op == Op::Sin ? -sign : sign;
        }
        args.push_back(a && take(a->size()) ? rebuilt(graph_, *a) : arg(i));
    }
    const NodeId made = graph_.make(node.op, node.type, args, node.payload);
    if (const auto c = graph_.as_number(made)) return Polynomial{{{}, sign * *c}};
    return Polynomial{{{made}, sign}};
}

} // namespace fathom::proof
