// A case says what comparisons and whole numbers are that stand still between steps (those of a
// hash), and which part of its range each unknown number is in. In a case whatever is decided by
// ranges is written as what it is; then both sides are compared, where a `min` may have arguments
// that are never the least. Else the case is split. A point at which both sides differ ends it.
#include "proof/agreement.h"

#include "proof/exact.h"
#include "proof/polynomials.h"
#include "proof/pruned_sides.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>

namespace fathom::proof {
namespace {

class Agreement {
  public:
    Agreement(Graph &graph, const Notes &notes, Work &work)
        : graph_(graph), work_(work), pruned_(graph, notes, work) {}

    bool hold(NodeId a, NodeId b, const Assumed &given, int depth);

  private:
    static constexpr int max_cases = 600, max_splits = 60, max_depth = 12;
    static constexpr std::size_t max_leaves = 200, max_values = 8;
    static constexpr ir::OpSet of_sums{Op::Add, Op::Sub, Op::Mul, Op::Neg};

    bool alike_in(NodeId &a, NodeId &b, const Assumed &given);
    bool alike(NodeId a, NodeId b, int depth = 0);
    bool alike_sums(NodeId a, NodeId b, int depth);
    bool alike_extremes(Op op, NodeId a, NodeId b, int depth);
    std::vector<NodeId> leaves(Op op, NodeId id) const;
    const std::vector<NodeId> &hashes_in(NodeId root);

    bool at_least(NodeId u, NodeId v);
    bool at_least_by_roots(NodeId u, NodeId v, double rounding);

    std::vector<NodeId> parts(NodeId a, NodeId b) const; // but for the arguments of hashes
    Interval range_of_whole(NodeId rounded);
    std::vector<NodeId> values_of(NodeId choice);

    Graph &graph_;
    Work &work_;
    PrunedSides pruned_;
    std::unordered_map<NodeId, std::vector<NodeId>> hashes_;
    int cases_ = 0;
};

bool Agreement::alike_in(NodeId &a, NodeId &b, const Assumed &given) {
    pruned_.enter(given);
    a = pruned_.of(a), b = pruned_.of(b);
    return alike(a, b) && !work_.spent();
}

bool Agreement::hold(NodeId a, NodeId b, const Assumed &given, int depth) {
    if (++cases_ > max_cases || depth > max_splits || work_.spent()) return false;
    if (alike_in(a, b, given)) return true;
    if (work_.spent()) return false;
    const std::vector<NodeId> all = parts(a, b);
    std::optional<NodeId> open;
    std::vector<NodeId> values;
    for (NodeId part : all) {
        if (open && !pruned_.moves(*open)) break;
        if (open && pruned_.moves(part)) continue;
        if (auto found = values_of(part); !found.empty()) open = part, values = std::move(found);
    }
    if (open)
        return std::ranges::all_of(values, [&](NodeId value) {
            Assumed next = given;
            next.is[*open] = value;
            return hold(a, b, next, depth + 1);
        });
    std::optional<NodeId> widest;
    double width = 0;
    Assumed point = given;
    for (NodeId part : all)
        if (const auto range = pruned_.halved(part)) {
            constexpr double beside_middle =
                0.47; // where two numbers are equal neither is the less
            point.within[part] = range->lo + beside_middle * range->width();
            if (range->width() > width) widest = part, width = range->width();
        }
    NodeId a_there = a, b_there = b;
    if (!widest || width < 1e-3 || !alike_in(a_there, b_there, point)) return false;
    pruned_.enter(given);
    const Interval range = *pruned_.halved(*widest);
    for (const bool upper : {false, true}) {
        Assumed next = given;
        next.within[*widest] =
            upper ? Interval(range.middle(), range.hi) : Interval(range.lo, range.middle());
        if (!hold(a, b, next, depth + 1)) return false;
    }
    return true;
}

std::vector<NodeId> Agreement::parts(NodeId a, NodeId b) const {
    std::vector<NodeId> out, todo{a, b};
    std::unordered_set<NodeId> seen;
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!seen.insert(id).second) continue;
        out.push_back(id);
        if (pruned_.halved(id) || (tells_apart[graph_[id].op] && graph_[id].op != Op::Mod))
            continue;
        todo.insert(todo.end(), graph_.args(id).begin(), graph_.args(id).end());
    }
    return out;
}

// Of n times a hash, n whole, single precision has no number that is rounded up to n.
Interval Agreement::range_of_whole(NodeId rounded) {
    const NodeId of = graph_.arg(rounded, 0);
    const Interval range = pruned_.ranges().of(of);
    const auto terms = terms_of(pruned_.forms(), of);
    const bool is_hash = terms && terms->size() == 1 && terms->front().factors.size() == 1 &&
                         graph_[terms->front().factors[0]].op == Op::Hash &&
                         std::floor(terms->front().by) == terms->front().by;
    const double lost = is_hash ? 0 : pruned_.lost_of_single(of, of);
    const double shift = graph_[rounded].op == Op::Floor  ? 0
                         : graph_[rounded].op == Op::Ceil ? 1
                                                          : 0.5;
    return floor(range + Interval(-lost, lost) + Interval(shift));
}

// What a comparison, a sign or a whole number can be, where that is not known.
std::vector<NodeId> Agreement::values_of(NodeId choice) {
    constexpr ir::OpSet compares{Op::Less, Op::LessEqual, Op::Equal, Op::NotEqual},
        whole{Op::Floor, Op::Ceil, Op::Round};
    const ir::Node node = graph_[choice];
    if (compares[node.op]) return {graph_.boolean(true), graph_.boolean(false)};
    if (node.type != ir::Type::Float) return {};
    Interval range = Interval::everything();
    if (node.op == Op::Step || node.op == Op::Sign)
        range = pruned_.ranges().of(choice);
    else if (whole[node.op] && !pruned_.moves(choice))
        range = range_of_whole(choice);
    else if (node.op == Op::Mod && !pruned_.moves(choice) &&
             is_made_whole(graph_, graph_.arg(choice, 0)) &&
             is_made_whole(graph_, graph_.arg(choice, 1)))
        range = pruned_.ranges().of(choice);
    if (!range.finite() || !(range.width() <= double(max_values))) return {};
    std::vector<NodeId> out;
    for (double value = std::ceil(range.lo); value <= range.hi; ++value)
        out.push_back(graph_.number(value));
    return out;
}

bool Agreement::alike(NodeId a, NodeId b, int depth) {
    if (a == b) return true;
    const ir::Node x = graph_[a], y = graph_[b];
    if (x.type != y.type || depth > max_depth || work_.spent()) return false;
    work_.take(1);
    if (same(graph_, a, b, &work_)) return true;
    for (const Op op : {Op::Min, Op::Max})
        if ((x.op == op || y.op == op) && x.type == ir::Type::Float &&
            alike_extremes(op, a, b, depth))
            return true;
    if (x.op == y.op && x.count == y.count && x.payload == y.payload && x.count > 0 &&
        !tells_apart[x.op] && !of_sums[x.op]) {
        bool all = true;
        for (int i = 0; all && i < int(x.count); ++i)
            all = alike(graph_.arg(a, i), graph_.arg(b, i), depth + 1);
        if (all) return true;
    }
    return x.type == ir::Type::Float && alike_sums(a, b, depth);
}

// Sums of products of which each factor that is in one alone is like one that is in the other.
bool Agreement::alike_sums(NodeId a, NodeId b, int depth) {
    constexpr std::size_t most = 6;
    const auto p = polynomial(graph_, a, &work_), q = polynomial(graph_, b, &work_);
    if (!p || !q) return false;
    const auto factors = [](const Polynomial &sum) {
        std::vector<NodeId> out;
        for (const auto &[m, c] : sum)
            if (c != 0) out.insert(out.end(), m.begin(), m.end());
        std::sort(out.begin(), out.end());
        out.erase(std::unique(out.begin(), out.end()), out.end());
        return out;
    };
    const std::vector<NodeId> of_a = factors(*p), of_b = factors(*q);
    std::vector<NodeId> left, right;
    std::ranges::set_difference(of_a, of_b, std::back_inserter(left));
    std::ranges::set_difference(of_b, of_a, std::back_inserter(right));
    if (left.empty() || left.size() != right.size() || left.size() > most) return false;
    if (left.front() == a || right.front() == b) return false; // a factor alone
    std::map<NodeId, NodeId> instead;
    for (NodeId f : left) {
        const auto like = std::ranges::find_if(
            right, [&](NodeId g) { return !instead.contains(g) && alike(f, g, depth + 1); });
        if (like == right.end()) return false;
        instead[*like] = f;
    }
    Polynomial sum;
    for (const auto &[m, c] : *q) {
        Monomial product = m;
        for (NodeId &f : product)
            if (const auto it = instead.find(f); it != instead.end()) f = it->second;
        std::sort(product.begin(), product.end());
        sum[product] += c;
    }
    return same(graph_, a, rebuilt(graph_, sum), &work_);
}

std::vector<NodeId> Agreement::leaves(Op op, NodeId id) const {
    std::vector<NodeId> out, todo{id};
    while (!todo.empty() && out.size() < max_leaves) {
        const NodeId one = todo.back();
        todo.pop_back();
        if (graph_[one].op == op)
            todo.insert(todo.end(), graph_.args(one).begin(), graph_.args(one).end());
        else if (std::ranges::find(out, one) == out.end())
            out.push_back(one);
    }
    return todo.empty() ? out : std::vector<NodeId>();
}

const std::vector<NodeId> &Agreement::hashes_in(NodeId root) {
    const auto [it, fresh] = hashes_.try_emplace(root);
    if (!fresh) return it->second;
    std::vector<NodeId> todo{root}, out;
    std::unordered_set<NodeId> seen;
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!seen.insert(id).second) continue;
        if (graph_[id].op == Op::Hash) out.push_back(id);
        todo.insert(todo.end(), graph_.args(id).begin(), graph_.args(id).end());
    }
    work_.take(seen.size());
    std::sort(out.begin(), out.end());
    return it->second = std::move(out);
}

// What only one of them has is never beyond what both have. What other hashes are in is another
// number.
bool Agreement::alike_extremes(Op op, NodeId a, NodeId b, int depth) {
    const std::vector<NodeId> of_a = leaves(op, a), of_b = leaves(op, b);
    if (of_a.empty() || of_b.empty()) return false;
    std::vector<NodeId> both, left, right;
    for (NodeId u : of_a) (std::ranges::find(of_b, u) != of_b.end() ? both : left).push_back(u);
    for (NodeId v : of_b)
        if (std::ranges::find(of_a, v) == of_a.end()) right.push_back(v);
    std::erase_if(left, [&](NodeId u) {
        const auto like = std::ranges::find_if(right, [&](NodeId v) {
            return hashes_in(u) == hashes_in(v) && alike(u, v, depth + 1);
        });
        if (like == right.end()) return false;
        right.erase(like);
        both.push_back(u);
        return true;
    });
    left.insert(left.end(), right.begin(), right.end());
    return std::ranges::all_of(left, [&](NodeId u) {
        return std::ranges::any_of(both, [&](NodeId v) {
            return !work_.spent() && (op == Op::Min ? at_least(u, v) : at_least(v, u));
        });
    });
}

// u >= v, but for rounding.
bool Agreement::at_least(NodeId u, NodeId v) {
    constexpr double lost = 1e-13;
    SideRanges &ranges = pruned_.ranges();
    const Interval x = ranges.of(u), y = ranges.of(v);
    const double size = std::max(ranges.size_of_terms(u), ranges.size_of_terms(v));
    const double rounding = lost * std::max({size, std::isfinite(x.lo) ? std::fabs(x.lo) : 0,
                                             std::isfinite(y.hi) ? std::fabs(y.hi) : 0});
    if (x.lo >= y.hi - rounding) return true;
    if (ranges.of(pruned_.formed(graph_.sub(u, v))).lo >= -rounding) return true;
    return at_least_by_roots(u, v, rounding);
}

// sqrt(X) - sqrt(Y) = (X - Y) / (sqrt(X) + sqrt(Y))
bool Agreement::at_least_by_roots(NodeId u, NodeId v, double rounding) {
    SideRanges &ranges = pruned_.ranges();
    struct Root {
        double by = 0;
        NodeId root, rest;
    };
    const auto split = [&](NodeId sum) -> std::optional<Root> {
        const auto terms = terms_of(pruned_.forms(), sum);
        if (!terms) return {};
        Root out;
        out.rest = graph_.number(0);
        for (const Term &term : *terms) {
            if (term.factors.size() == 1 && graph_[term.factors[0]].op == Op::Sqrt) {
                if (out.root) return {};
                out.by = term.by, out.root = term.factors[0];
                continue;
            }
            NodeId product = graph_.number(term.by);
            for (NodeId factor : term.factors) product = graph_.mul(product, factor);
            out.rest = graph_.add(out.rest, product);
        }
        return out.root ? std::optional(out) : std::nullopt;
    };
    const auto x = split(u), y = split(v);
    if (!x || !y || x->by != y->by || !(x->by > 0)) return false;
    const Interval squares = ranges.of(
                       pruned_.formed(graph_.sub(graph_.arg(x->root, 0), graph_.arg(y->root, 0)))),
                   roots = ranges.of(x->root) + ranges.of(y->root),
                   rest = ranges.of(pruned_.formed(graph_.sub(x->rest, y->rest)));
    const double divisor = squares.lo >= 0 ? roots.hi : roots.lo;
    if (!(divisor > 0) || !std::isfinite(divisor) || !std::isfinite(squares.lo)) return false;
    const Interval apart = Interval(x->by) * (Interval(squares.lo) / Interval(divisor));
    return (rest + apart).lo >= -rounding;
}

bool are_small(const Graph &graph, NodeId a, NodeId b) {
    constexpr std::size_t most_nodes = 300;
    std::vector<NodeId> todo{a, b};
    std::unordered_set<NodeId> seen;
    while (!todo.empty() && seen.size() <= most_nodes) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (seen.insert(id).second)
            todo.insert(todo.end(), graph.args(id).begin(), graph.args(id).end());
    }
    return todo.empty();
}

} // namespace

bool sides_agree(Graph &graph, NodeId a, NodeId b, const Notes &notes, Comparisons &comparisons,
                 Work &work) {
    if (graph[a].type != ir::Type::Float || graph[b].type != ir::Type::Float) return false;
    if (comparisons.in_vain || !are_small(graph, a, b)) return false;
    Work own = comparisons.begin(work);
    const std::size_t before = own.left;
    const bool agree = Agreement(graph, notes, own).hold(a, b, {}, 0);
    comparisons.end(work, before - own.left);
    return agree;
}

} // namespace fathom::proof
