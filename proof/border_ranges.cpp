// What numbers are between on one side of a border (border_sides.h). Of unknown steps the range is
// known, and how far what is rounded is from the whole number; of what was a square, a product or a
// length before it was a sum of products, the range as that (docs/lipschitz.md, 2.29).
#include "proof/border_ranges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_set>

namespace fathom::proof {

void Notes::keep(NodeId form, NodeId made) {
    constexpr std::size_t enough = 4;
    std::vector<NodeId> &all = as[form];
    if (form != made && all.size() < enough && std::ranges::find(all, made) == all.end())
        all.push_back(made);
}

Interval SideRanges::of(NodeId id) {
    if (const auto number = graph.as_number(id)) return *number;
    if (work.spent()) return Interval::everything();
    const auto [it, fresh] = notes.found.try_emplace(id, Interval::everything());
    if (!fresh) return it->second;
    if (const auto given = notes.given.find(id); given != notes.given.end())
        return it->second = given->second;
    work.take(1);
    Interval out = found(id); // asks for others, and for this one where it is its own part
    if (const auto as = notes.as.find(id); as != notes.as.end())
        for (const NodeId made : std::vector<NodeId>(as->second)) out = meet(as_made(made), out);
    return notes.found[id] = out;
}

// A sum also term by term, as a sum of products.
Interval SideRanges::found(NodeId id) {
    const Op op = graph[id].op;
    if (graph[id].type == ir::Type::Float && (op == Op::Add || op == Op::Sub)) {
        const auto terms = terms_of(forms, id);
        if (!terms) return as_made(id);
        const Interval sum = of_terms(*terms);
        return sum.finite() ? sum : meet(by_rounded(*terms), sum);
    }
    return as_made(id);
}

Interval SideRanges::as_made(NodeId id) {
    constexpr ir::OpSet waves{Op::Sin, Op::Cos}, parts{Op::Smoothstep, Op::Fract, Op::Step};
    const ir::Node node = graph[id];
    if (const auto number = graph.as_number(id)) return *number;
    if (node.op == Op::Length || node.op == Op::Dot) {
        const NodeId v = graph.arg(id, 0), w = graph.arg(id, int(node.count) - 1);
        Interval sum(0.0);
        std::vector<NodeId> all;
        for (int i = 0; i < ir::components(graph[v].type); ++i) {
            all.push_back(component_of(graph, v, i));
            const Interval x = of(all.back());
            sum = sum + (v == w ? square(x) : x * of(component_of(graph, w, i)));
        }
        if (node.op == Op::Dot) return sum;
        const Interval length = sqrt(sum);
        return {std::max(length.lo, by_cores(all, false).lo), length.hi};
    }
    if (waves[node.op]) return {-1, 1};
    if (parts[node.op]) return {0, 1};
    if (node.op == Op::Hash) return {0, 1 - 0x1p-24}; // a whole number of 2^-24 below 1
    if (node.op == Op::Sign) return {-1, 1};
    if (node.type != ir::Type::Float) return Interval::everything();
    return as_made_of_parts(id);
}

Interval SideRanges::as_made_of_parts(NodeId id) {
    const ir::Node node = graph[id];
    const auto arg = [&](int i) { return of(graph.arg(id, i)); };
    if (node.op == Op::Add) return arg(0) + arg(1);
    if (node.op == Op::Sub) return arg(0) - arg(1);
    if (node.op == Op::Mul)
        return graph.arg(id, 0) == graph.arg(id, 1) ? square(arg(0)) : arg(0) * arg(1);
    if (node.op == Op::Neg) return -arg(0);
    if (node.op == Op::Abs) return abs(arg(0));
    if (node.op == Op::Min) return min(arg(0), arg(1));
    if (node.op == Op::Max) {
        std::vector<NodeId> all{id};
        for (std::size_t i = 0; i < all.size() && all.size() < 8;)
            if (graph[all[i]].op == Op::Max) {
                const NodeId both = all[i];
                all[i] = graph.arg(both, 0);
                all.push_back(graph.arg(both, 1));
            } else {
                ++i;
            }
        const Interval greater = max(arg(0), arg(1));
        return {std::max(greater.lo, by_cores(all, true).lo), greater.hi};
    }
    if (node.op == Op::Clamp) return min(max(arg(0), arg(1)), arg(2));
    if (node.op == Op::Select) return hull(arg(1), arg(2));
    if (node.op == Op::Sqrt) return sqrt(max(arg(0), Interval(0.0)));
    if (node.op == Op::Floor) return floor(arg(0));
    if (node.op == Op::Round) return floor(arg(0) + Interval(0.5));
    if (const auto width = node.op == Op::Mod ? graph.as_number(graph.arg(id, 1)) : std::nullopt)
        return {std::min(*width, 0.0), std::max(*width, 0.0)};
    return Interval::everything();
}

// A sum term by term, but the square of a number and the number together: x^2 + m x is
// (x + m/2)^2 - m^2/4.
Interval SideRanges::of_terms(const std::vector<Term> &terms) {
    std::map<NodeId, std::array<double, 2>> squares; // of x, and of x^2
    Interval sum(0.0);
    for (const Term &term : terms) {
        const auto &x = term.factors;
        if (x.size() == 1 || (x.size() == 2 && x[0] == x[1])) {
            squares[x[0]][x.size() - 1] += term.by;
            continue;
        }
        Interval product(term.by);
        for (NodeId factor : x) product = product * of(factor);
        sum = sum + product;
    }
    for (const auto &[x, by] : squares) {
        const Interval range = of(x), a(by[1]), b(by[0]), half = b / (Interval(2.0) * a);
        sum = sum + (by[1] == 0 ? b * range : a * (square(range + half) - square(half)));
    }
    return sum;
}

// With each whole number n that was rounded of t as t + d, of which the range of d is known.
Interval SideRanges::by_rounded(const std::vector<Term> &terms) {
    NodeId sum = graph.number(0);
    bool any = false;
    for (const Term &term : terms) {
        NodeId product = graph.number(term.by);
        for (NodeId factor : term.factors) {
            const auto rounded = notes.rounded.find(factor);
            any = any || rounded != notes.rounded.end();
            product = graph.mul(product, rounded == notes.rounded.end() ? factor : rounded->second);
        }
        sum = graph.add(sum, product);
    }
    if (!any) return Interval::everything();
    const NodeId form = in_one_form(graph, sum, &work);
    return work.spent() ? Interval::everything() : of(form);
}

// A sine, a cosine, or the size of a sum that has such for factors.
bool SideRanges::is_wave(NodeId factor) const {
    constexpr ir::OpSet waves{Op::Sin, Op::Cos};
    if (waves[graph[factor].op] || graph[factor].op != Op::Abs) return waves[graph[factor].op];
    const auto terms = terms_of(forms, graph.arg(factor, 0));
    return terms && std::ranges::any_of(*terms, [&](const Term &term) {
               return std::ranges::any_of(term.factors,
                                          [&](NodeId f) { return waves[graph[f].op]; });
           });
}

// |x| >= |of| - off; from below: x >= |of| - off.
std::optional<Core> SideRanges::core_of(NodeId x, bool from_below, int depth) {
    constexpr int max_depth = 6;
    if (depth > max_depth || work.spent()) return {};
    const Op op = graph[x].op;
    if (op == Op::Abs) return core_of(graph.arg(x, 0), false, depth + 1);
    if (op ==
        Op::Max) { // the greater is at least each, and where it is not negative, so is its size
        if (!from_below && !(of(x).lo >= 0)) return {};
        for (int i = 0; i < 2; ++i)
            if (!graph.is_constant(graph.arg(x, i)))
                if (const auto core = core_of(graph.arg(x, i), true, depth + 1)) return core;
        return {};
    }
    const auto terms = terms_of(forms, x);
    if (!terms) return {};
    Interval off(0.0);
    std::vector<Term> rest;
    bool turned = false;
    for (const Term &term : *terms) {
        Interval product(term.by);
        bool has_wave = false;
        for (NodeId factor : term.factors) {
            product = product * of(factor);
            has_wave = has_wave || is_wave(factor);
        }
        turned = turned || has_wave;
        if (has_wave || !product.finite())
            rest.push_back(term);
        else
            off = off + product;
    }
    if (rest.empty()) return {};
    if (rest.size() == 1 && rest[0].factors.size() == 1 &&
        graph[rest[0].factors[0]].op == Op::Abs) {
        const double by = rest[0].by;
        if (from_below && by < 0) return {};
        auto core = core_of(rest[0].factors[0], false, depth + 1);
        if (!core) return {};
        const Interval all = Interval(std::fabs(by)) * Interval(core->off) + abs(off);
        return Core{graph.mul(graph.number(by), core->of), all.hi, core->turned};
    }
    NodeId sum = graph.number(0);
    for (const Term &term : rest) {
        NodeId product = graph.number(term.by);
        for (NodeId factor : term.factors) product = graph.mul(product, factor);
        sum = graph.add(sum, product);
    }
    if (from_below && !(of(sum).lo >= 0)) return {};
    return Core{sum, off.magnitude(), turned};
}

// |x| >= |of| - |off| of vectors, and of n numbers the greatest is at least that over sqrt n, where
// it is not negative. Asked where sines turn the vector, with all of its parts and those alone.
Interval SideRanges::by_cores(const std::vector<NodeId> &parts, bool greatest) {
    std::vector<Core> cores;
    for (NodeId part : parts)
        if (const auto core = core_of(part, greatest)) cores.push_back(*core);
    Interval out = Interval::everything();
    if (std::ranges::none_of(cores, &Core::turned)) return out;
    for (const bool turned_alone : {false, true}) {
        NodeId squares = graph.number(0);
        Interval off(0.0);
        double n = 0;
        for (const Core &core : cores) {
            if (turned_alone && !core.turned) continue;
            squares = graph.add(squares, graph.mul(core.of, core.of));
            off = off + square(Interval(core.off));
            ++n;
        }
        const NodeId form = in_one_form(graph, squares, &work);
        if (work.spent()) return out;
        const Interval apart = sqrt(max(of(form), Interval(0.0))) - sqrt(off);
        if (!greatest)
            out.lo = std::max(out.lo, apart.lo);
        else if (apart.lo > 0)
            out.lo = std::max(out.lo, (Interval(apart.lo) / sqrt(Interval(n))).lo);
    }
    return out;
}

// The greatest number of a sum, whose rounding its range has.
double SideRanges::size_of_terms(NodeId id) const {
    double size = 0;
    if (const auto terms = terms_of(forms, id))
        for (const Term &term : *terms)
            if (term.factors.empty()) size = std::max(size, std::fabs(term.by));
    return size;
}

namespace {

bool is_coordinate(const Graph &graph, NodeId id) {
    return graph[id].op == Op::Swizzle && graph[id].type == ir::Type::Float &&
           graph[graph.arg(id, 0)].op == Op::Point;
}

// Does it read that coordinate, or an unknown number, which may?
bool may_read(const Graph &graph, NodeId root, NodeId coordinate) {
    std::vector<NodeId> todo{root};
    std::unordered_set<NodeId> seen;
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!seen.insert(id).second) continue;
        if (id == coordinate || graph[id].op == Op::Point) return true;
        if (graph[id].op == Op::Var && graph[id].type != ir::Type::Int) return true;
        if (is_coordinate(graph, id)) continue;
        todo.insert(todo.end(), graph.args(id).begin(), graph.args(id).end());
    }
    return false;
}

} // namespace

bool SideRanges::is_sloped(NodeId sum) const {
    const auto terms = terms_of(forms, sum);
    return terms && std::ranges::any_of(*terms, [&](const Term &one) {
               if (one.factors.size() != 1 || !is_coordinate(graph, one.factors[0])) return false;
               return std::ranges::none_of(*terms, [&](const Term &other) {
                   return &other != &one && std::ranges::any_of(other.factors, [&](NodeId factor) {
                       return may_read(graph, factor, one.factors[0]);
                   });
               });
           });
}

// Term by term: where the sum is at the end of its range each term is at one.
bool SideRanges::is_0_at_ends_alone(NodeId sum, double rounding) {
    const auto terms = terms_of(forms, sum);
    if (!terms) return false;
    bool at_end = false;
    Interval range(0.0);
    for (const Term &term : *terms) {
        Interval product(term.by);
        for (NodeId factor : term.factors) product = product * of(factor);
        range = range + product;
        at_end =
            at_end ||
            (term.by != 0 && term.factors.size() == 1 &&
             (is_coordinate(graph, term.factors[0]) || notes.sloped.contains(term.factors[0])));
    }
    return at_end && range.lo >= -rounding;
}

std::optional<NodeId> SideRanges::outermost(Op extreme, NodeId a, NodeId b) {
    constexpr double rounding = 1e-13;
    const Interval of_a = of(a), of_b = of(b);
    const double size = std::max(size_of_terms(a), size_of_terms(b));
    const auto below = [&](const Interval &x, const Interval &y) {
        const double known = std::max({std::fabs(x.hi), std::fabs(y.lo), size});
        return std::isfinite(x.hi) && std::isfinite(y.lo) && x.hi - y.lo <= rounding * known;
    };
    if (below(of_a, of_b)) return extreme == Op::Max ? b : a;
    if (below(of_b, of_a)) return extreme == Op::Max ? a : b;
    return {};
}

std::optional<double> SideRanges::faded(NodeId from, NodeId to, NodeId x) {
    for (const bool rises : {true, false}) {
        const NodeId least = rises ? from : to, most = rises ? to : from;
        if (!(of(least).hi < of(most).lo)) continue;
        if (outermost(Op::Min, x, most) == most) return rises;
        if (outermost(Op::Max, x, least) == least) return !rises;
    }
    return {};
}

std::optional<NodeId> SideRanges::beyond(NodeId x, NodeId least, NodeId most) {
    if (outermost(Op::Min, x, most) == most) return most;
    if (outermost(Op::Max, x, least) == least) return graph.make(Op::Min, {least, most});
    return {};
}

} // namespace fathom::proof
