// What nodes are in a case: sums of products, by component. A choice has gone one way, or splits it.
#include "ir/semantics.h"
#include "proof/case_search.h"
#include "proof/continuity.h"
#include "proof/exact.h"
#include "proof/machine.h"
#include "proof/tape.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

namespace fathom::proof {
namespace {

constexpr int max_depth_of_cases = 200, max_squares = 12;

// How often one sum is the other, above 0; else 0. Of what is below a root: nearly is not enough.
double multiple_of(const Sum &a, const Sum &b) {
    if (a.size() != b.size() || a.empty()) return 0;
    const double times = a.begin()->second / b.begin()->second;
    for (auto x = a.begin(), y = b.begin(); x != a.end(); ++x, ++y)
        if (x->first != y->first || !(std::fabs(x->second / (times * y->second) - 1) < 1e-10))
            return 0;
    return times;
}

} // namespace

std::uint32_t Cases::atom_of(AtomKey key, Atom about) {
    const auto [it, fresh] = index_.try_emplace(std::move(key), std::uint32_t(atoms_.size()));
    if (fresh) atoms_.push_back(std::move(about));
    return it->second;
}

Sum Cases::leaf(NodeId id, int i) {
    Atom about;
    if (axes_ && graph_[id].op == Op::Point && graph_[id].type == ir::Type::Vec3) {
        const double reach = tries_.reach;
        const bool near =
            std::ranges::all_of(axes_->origin, [&](double x) { return std::fabs(x) <= reach / 4; });
        if (near) about.range = Interval(-2.5 * reach, 2.5 * reach); // sqrt(3) times it, the origin
        const auto k = static_cast<std::size_t>(i);
        Sum out = constant(axes_->origin[k]);
        for (std::size_t j = 0; j < 3; ++j) {
            const std::uint32_t a = atom_of({-4.0, double(j)}, about);
            coordinates_.insert(a);
            out = add(out, atom(a), axes_->along[j][k]);
        }
        return reduced(out, case_);
    }
    const ir::Node node = graph_[id];
    const auto k = static_cast<std::size_t>(i);
    const ir::Graph::Reads read = graph_.reads(id);
    about.held = !read.point && !read.free_vars;
    met_held_ = met_held_ || about.held;
    if (node.op == Op::Point) about.range = Interval(-tries_.reach, tries_.reach);
    if (node.op == Op::Param && looked_.ranges)
        about.range = looked_.ranges->params[node.payload][k];
    if (node.op == Op::Time && looked_.ranges) about.range = looked_.ranges->time;
    if (about.range && !about.range->finite()) about.range.reset();
    if (about.held && about.range) about.never_negative = about.range->lo >= 0;
    const std::uint32_t a = atom_of({-1.0, double(id.index), double(i)}, about);
    if (node.op == Op::Point) coordinates_.insert(a);
    return reduced(atom(a), case_);
}

std::optional<Sum> Cases::unknown(NodeId id, int i) {
    const ir::Node node = graph_[id];
    if (node.count == 0) return leaf(id, i);
    AtomKey key{double(node.op), double(node.payload), double(node.type), double(i)};
    if (tells_apart[node.op]) { // one number while nothing below it turns, whatever is near
        if (side_ && reads(id, claim_.choice)) key.push_back(*side_);
        if (turned_ && reads(id, claim_.comparison)) key.push_back(*turned_ ? 3 : 2);
        key.push_back(double(id.index));
    }
    for (int k = 0; k < int(node.count) && !tells_apart[node.op]; ++k) {
        const NodeId a = graph_.arg(id, k);
        for (int c = 0; c < ir::components(graph_[a].type); ++c) {
            const auto x = value(a, c);
            if (!x) return {};
            add_to_key(key, *x);
        }
    }
    Atom about;
    about.never_negative = node.op == Op::Exp || node.op == Op::Exp2 || node.op == Op::Hash;
    if (const auto angle = node.op == Op::MatMul ? sector_of(id) : std::nullopt) {
        AtomKey point = key;
        point.front() = -7.0, point[3] = 0;
        about.sector =
            Sector{i == 0 ? Sector::X : Sector::Y, atom_of(std::move(point), Atom{}), *angle};
    }
    const ir::Graph::Reads read = graph_.reads(id);
    about.held = !read.point && !read.free_vars;
    const std::uint32_t a = atom_of(std::move(key), about);
    nodes_.try_emplace(a, id, i);
    return reduced(atom(a), case_);
}

bool Cases::are_opposite(NodeId a, NodeId b) const {
    const Op x = graph_[a].op, y = graph_[b].op;
    return ((x == Op::Less && y == Op::LessEqual) || (x == Op::LessEqual && y == Op::Less)) &&
           graph_.arg(a, 0) == graph_.arg(b, 1) && graph_.arg(a, 1) == graph_.arg(b, 0);
}

bool Cases::reads(NodeId id, NodeId what) {
    if (id == what || are_opposite(id, what)) return true;
    const auto it = reads_.find({id, what});
    if (it != reads_.end()) return it->second;
    bool out = false;
    for (NodeId a : graph_.args(id)) out = out || reads(a, what);
    return reads_[{id, what}] = out;
}

std::pair<NodeId, int> Cases::place_of_way(NodeId id, int i) {
    if (side_ && reads(id, claim_.choice)) i += PerSide * (1 + *side_);
    if (turned_ && reads(id, claim_.comparison)) i += 10 * PerSide * (1 + *turned_);
    return {id, i};
}

std::optional<int> Cases::way(NodeId id, int i, std::vector<std::vector<Sum>> ways) {
    const auto place = place_of_way(id, i);
    if (const auto it = case_.way.find(place); it != case_.way.end()) return it->second;
    if (!fork_ && splits_) fork_ = Fork{place, std::move(ways)};
    return {};
}

std::optional<Sum> Cases::root_as_met(NodeId at, int i, const Sum &root) {
    const auto it = case_.first.find(place_of_way(at, i));
    if (it == case_.first.end() || root.empty()) return root;
    const Sum met = reduced(it->second, case_);
    if (met.empty()) return met;
    const auto like = [](const Sum &x, const Sum &y, double sign) { // two roots are far apart
        double most = 0, apart = 0;
        for (const auto &[m, c] : x) most = std::max(most, std::fabs(c));
        for (const auto &[m, c] : add(x, y, -sign)) apart = std::max(apart, std::fabs(c));
        return apart <= 0.01 * most;
    };
    for (const double sign : {1.0, -1.0})
        if (like(root, met, sign)) return add({}, root, sign);
    if (root.size() != 1 || met.size() != 1) return {};
    Product more; // factors above 0 that the other has not
    std::ranges::set_symmetric_difference(root.begin()->first, met.begin()->first,
                                          std::back_inserter(more));
    if (!std::ranges::all_of(more, [&](std::uint32_t a) { return atoms_[a].never_negative; }))
        return {};
    return add({}, root, root.begin()->second * met.begin()->second > 0 ? 1 : -1);
}

std::optional<Sum> Cases::value(NodeId id, int i) {
    if (const auto it = done_.find({id, i}); it != done_.end()) return it->second;
    if (fork_ || depth_ > max_depth_of_cases || looked_.spent()) return {};
    looked_.take(1);
    ++depth_;
    std::optional<Sum> out = value_of(id, i);
    --depth_;
    if (out) done_[{id, i}] = *out;
    return out;
}

std::optional<Sum> Cases::size_of(NodeId id, int i, const Sum &x) {
    if (const auto c = as_constant(x)) return constant(std::fabs(*c));
    const Product &lead = x.begin()->first;
    if (x.size() == 1 && lead.size() == 1) {
        const double c = x.begin()->second;
        if (atoms_[lead[0]].never_negative) return c > 0 ? x : add({}, x, -1);
        if (!split_sizes_) {
            Atom about;
            about.never_negative = true;
            about.square = multiply(atom(lead[0]), atom(lead[0]));
            if (const auto &of = atoms_[lead[0]].sector; of && of->part == Sector::Y) {
                about.sector = of;
                about.sector->part = Sector::SizeOfY;
            }
            const std::uint32_t a = atom_of({-2.0, double(lead[0])}, about);
            return add({}, reduced(atom(a), case_), std::fabs(c));
        }
    }
    if (x.size() == 1) { // |a t| = a |t| for a >= 0
        Product kept, rest;
        for (std::uint32_t a : lead) (atoms_[a].never_negative ? kept : rest).push_back(a);
        if (!kept.empty()) {
            const double c = x.begin()->second; // the rest goes the way that x goes
            const auto size = rest.empty() ? std::optional(constant(std::fabs(c)))
                                           : size_of(id, i, Sum{{rest, c}});
            return size ? times(*size, Sum{{kept, 1.0}}) : std::nullopt;
        }
    }
    if (const int sign = by_inverses_ ? held_sign(x) : 0; sign != 0)
        return sign > 0 ? x : add({}, x, -1);
    const auto w = way(id, i, {{x}, {add({}, x, -1)}});
    if (!w) return {};
    return *w == 0 ? x : add({}, x, -1);
}

std::optional<Sum> Cases::root(NodeId at, NodeId below, int i) {
    constexpr int most_roots = 10'000; // of a case: an extreme may stand in both arms of another
    if (++roots_ > most_roots) return {};
    const ir::Node node = graph_[below];
    if (below == claim_.choice && side_ && node.op == Op::Select)
        return root(at, graph_.arg(below, 1 + *side_), i);
    if (node.op == Op::Min || node.op == Op::Max) {
        const auto a = root(graph_.arg(below, 0), graph_.arg(below, 0), i),
                   b = a ? root(graph_.arg(below, 1), graph_.arg(below, 1), i) : std::nullopt;
        if (!b) return {};
        const auto x = times(*a, *a), y = x ? times(*b, *b) : std::nullopt;
        const Sum gap = y ? add(*y, *x, -1) : Sum{}, less = add({}, gap, -1);
        if (y && (is_sum_of_squares(gap) || is_square(gap))) return node.op == Op::Min ? a : b;
        if (y && (is_sum_of_squares(less) || is_square(less))) return node.op == Op::Min ? b : a;
        return lesser(below, Roots + i, *a, *b, node.op == Op::Min);
    }
    if (node.op == Op::Swizzle)
        return root(at, graph_.arg(below, 0), ir::swizzle_component(node.payload, i));
    if (node.op == Op::Select) {
        const auto t = truth(graph_.arg(below, 0));
        if (!t) return {};
        return root(at, graph_.arg(below, *t ? 1 : 2), i);
    }
    const auto x = node.op == Op::Make ? value(graph_.arg(below, i)) : value(below, i);
    return x ? root_of(at, *x, i, is_square_sum(below)) : std::nullopt;
}

std::optional<Sum> Cases::root_of(NodeId at, const Sum &x, int i, bool of_squares) {
    if (const auto c = as_constant(x)) return constant(*c > 0 ? std::sqrt(*c) : 0);
    const Sum sum = squares_known(x);
    auto s = root_of_square(sum);
    if (!s && by_inverses_) s = root_over_inverses(sum);
    if (s) s = root_as_met(at, Lengths + i, *s);
    if (s) return size_of(at, Lengths + i, *s);
    for (std::uint32_t a = 0; a < atoms_.size(); ++a)
        if (atoms_[a].square)
            if (const double times = multiple_of(sum, *atoms_[a].square); times > 0)
                return add({}, reduced(atom(a), case_), std::sqrt(times));
    return reduced(atom(root_atom(sum, of_squares)), case_);
}

std::uint32_t Cases::root_atom(const Sum &below, bool of_squares) {
    Atom about;
    about.never_negative = true;
    about.below = below;
    about.held = is_held(below);
    const auto range = about.held ? range_of(below, atoms_) : std::nullopt;
    if (range) about.range = sqrt(*range);
    if (of_squares || (range && range->lo >= 0))
        about.square = below; // of less than 0 the root is 0
    AtomKey key{-3.0, double(of_squares)};
    add_to_key(key, below);
    return atom_of(std::move(key), about);
}

bool Cases::is_square_sum(NodeId id) const {
    std::vector<NodeId> todo{id};
    std::set<NodeId> seen;
    while (!todo.empty()) {
        const NodeId part = todo.back();
        todo.pop_back();
        if (!seen.insert(part).second) continue;
        const Op op = graph_[part].op;
        const NodeId a =
            op == Op::Add || op == Op::Mul || op == Op::Dot ? graph_.arg(part, 0) : NodeId{};
        if (!a || (op != Op::Add && a != graph_.arg(part, 1))) return false;
        if (op == Op::Add) todo.insert(todo.end(), {a, graph_.arg(part, 1)});
    }
    return true;
}

Sum Cases::squares_known(const Sum &x) const {
    Sum out = x;
    for (std::uint32_t a = 0; a < atoms_.size(); ++a) {
        if (!atoms_[a].square || !out.contains({a}) || atoms_[a].square->empty()) continue;
        const auto &[lead, c] = *atoms_[a].square->begin();
        const auto it = out.find(lead);
        if (it == out.end()) continue;
        const double times = it->second / c;
        Sum next = add(out, *atoms_[a].square, -times);
        next = add(next, Sum{{{a, a}, times}});
        if (next.size() <= out.size()) out = next;
    }
    return out;
}

std::optional<Sum> Cases::lesser(NodeId id, int i, const Sum &a, const Sum &b, bool least) {
    const Sum gap = cleared(add(b, a, -1)); // b - a
    if (const auto c = as_constant(gap)) return (*c >= 0) == least ? a : b;
    if (const int sign = by_inverses_ ? held_sign(gap) : 0; sign != 0)
        return (sign > 0) == least ? a : b;
    const Sum less = add({}, gap, -1);
    if (is_sum_of_squares(gap)) return least ? a : b;
    if (is_sum_of_squares(less)) return least ? b : a;
    if (!splits_) {
        if (impossible(case_, {less, true})) return least ? a : b;
        if (impossible(case_, {gap, true})) return least ? b : a;
    }
    const auto w = way(id, i, {{gap}, {less}});
    if (!w) return {};
    return (*w == 0) == least ? a : b;
}

std::optional<Sum> Cases::times(const Sum &a, const Sum &b) {
    constexpr std::size_t of_term = 4;
    looked_.take(of_term * a.size() * b.size());
    const auto out = multiply(a, b);
    if (!out) return {};
    Sum sum;
    for (const auto &[m, c] : *out) {
        const auto known = in_place_of_pair(m);
        if (!known) {
            sum = add(sum, Sum{{m, c}});
            continue;
        }
        // What a root's square is made of may have been solved by that root.
        if (squares_ >= max_squares) return {};
        ++squares_;
        const auto whole = times(Sum{{known->first, c}}, reduced(known->second, case_));
        --squares_;
        if (!whole) return {};
        sum = add(sum, *whole);
    }
    return sum;
}

// r*r is what is below the root r, and q*d is a where q = a/d: the other factors, and that.
std::optional<std::pair<Product, Sum>> Cases::in_place_of_pair(const Product &m) const {
    const auto without = [&](std::size_t i, std::size_t k) {
        Product rest;
        for (std::size_t n = 0; n < m.size(); ++n)
            if (n != i && n != k) rest.push_back(m[n]);
        return rest;
    };
    for (std::size_t i = 0; i < m.size(); ++i) {
        if (i + 1 < m.size() && m[i] == m[i + 1] && atoms_[m[i]].square)
            return std::pair(without(i, i + 1), *atoms_[m[i]].square);
        if (const auto &b = atoms_[m[i]].inverse_of) { // 1 = lead / b + the rest of b / b
            const Product &lead = b->begin()->first;
            const Product others = without(i, i);
            if (!std::ranges::includes(others, lead)) continue;
            Product rest;
            std::ranges::set_difference(others, lead, std::back_inserter(rest));
            Sum is = constant(1);
            for (const auto &[k, c] : *b) {
                if (k == lead) continue;
                Product product = k;
                product.insert(std::ranges::upper_bound(product, m[i]), m[i]);
                is = add(is, Sum{{product, -c}});
            }
            return std::pair(rest, is);
        }
        if (!atoms_[m[i]].quotient) continue;
        const auto &[d, of] = *atoms_[m[i]].quotient;
        if (const auto at = std::ranges::find(m, d); at != m.end())
            return std::pair(without(i, std::size_t(at - m.begin())), of);
    }
    return {};
}

std::optional<Sum> Cases::dot(NodeId a, NodeId b) {
    Sum sum;
    for (int k = 0; k < ir::components(graph_[a].type); ++k) {
        const auto x = value(a, k), y = x ? value(b, k) : std::nullopt;
        const auto product = y ? times(*x, *y) : std::nullopt;
        if (!product) return {};
        sum = add(sum, *product);
    }
    return sum;
}

std::optional<Sum> Cases::value_of(NodeId id, int i) {
    const ir::Node node = graph_[id];
    const auto arg = [&](int k) { return value(graph_.arg(id, k), i); };
    if (id == claim_.choice && side_) {
        if (node.op == Op::Select) return value(graph_.arg(id, 1 + *side_), i);
        return constant(node.op == Op::Step ? *side_ : *side_ - 1);
    }
    if (graph_.is_constant(id)) {
        const double c = graph_.constant_of(id).value[static_cast<std::size_t>(i)];
        return std::isfinite(c) ? std::optional(constant(c)) : std::nullopt;
    }
    if (node.type == ir::Type::Bool || ir::is_matrix(node.type)) return unknown(id, i);
    if (node.op == Op::ToFloat && graph_[graph_.arg(id, 0)].type == ir::Type::Int)
        return value(graph_.arg(id, 0));
    if (node.op == Op::ToFloat) {
        const auto t = truth(graph_.arg(id, 0));
        return t ? std::optional(constant(*t)) : std::nullopt;
    }
    if (by_component_[node.op] && !(node.type == ir::Type::Int && node.op == Op::Div)) {
        const auto a = arg(0), b = node.count > 1 && a ? arg(1) : std::nullopt,
                   c = node.count > 2 && b ? arg(2) : std::nullopt;
        if (!a || (node.count > 1 && !b) || (node.count > 2 && !c)) return {};
        return component(id, i, node.op, *a, b.value_or(Sum{}), c.value_or(Sum{}));
    }
    if (node.op == Op::Make) return value(graph_.arg(id, i));
    if (node.op == Op::Splat) return value(graph_.arg(id, 0));
    if (node.op == Op::Swizzle)
        return value(graph_.arg(id, 0), ir::swizzle_component(node.payload, i));
    if (node.op == Op::Dot) return dot(graph_.arg(id, 0), graph_.arg(id, 1));
    if (node.op == Op::Length) {
        const auto sum = dot(graph_.arg(id, 0), graph_.arg(id, 0));
        return sum ? root_of(id, *sum, 0, true) : std::nullopt;
    }
    if (node.op == Op::Sqrt) return root(id, graph_.arg(id, 0), i);
    if (node.op == Op::Cross) return cross(id, i);
    if (node.op == Op::MatMul && ir::is_vector(node.type)) return turned(id, i);
    if (node.op == Op::Select) {
        const auto t = truth(graph_.arg(id, 0));
        if (!t) return {};
        return value(graph_.arg(id, *t ? 1 : 2), i);
    }
    return unknown(id, i);
}

std::optional<Sum> Cases::component(NodeId id, int i, Op op, const Sum &a, const Sum &b,
                                    const Sum &c) {
    if (op == Op::Neg) return add({}, a, -1);
    if (op == Op::Add || op == Op::Sub) return add(a, b, op == Op::Add ? 1 : -1);
    if (op == Op::Mul) return times(a, b);
    if (op == Op::Min || op == Op::Max) return lesser(id, i, a, b, op == Op::Min);
    if (op == Op::Abs) return size_of(id, Sizes + i, a);
    if (op == Op::Div) {
        if (const auto d = as_constant(b); d && *d != 0) return add({}, a, 1 / *d);
        if (const auto q = by_inverses_ ? std::nullopt : quotient(a, b)) return q;
        if (const auto over = by_inverses_ ? inverse(b) : std::nullopt) return times(a, *over);
        return unknown(id, i);
    }
    if (op == Op::Clamp) { // min(max(x, lo), hi)
        const auto low = lesser(id, i, a, b, false);
        return low ? lesser(id, Upper + i, *low, c, true) : std::nullopt;
    }
    if (op == Op::Mix) {
        if (const auto t = as_constant(c); t && (*t == 0 || *t == 1)) return *t == 0 ? a : b;
        const auto by = times(c, add(b, a, -1));
        return by ? std::optional(add(a, *by)) : std::nullopt;
    }
    if (op == Op::Pow) {
        const auto n = as_constant(b);
        if (!n || *n != std::floor(*n) || *n < 1 || *n > 4) return unknown(id, i);
        std::optional<Sum> out = a;
        for (int k = 1; out && k < int(*n); ++k) out = times(*out, a);
        return out;
    }
    if (op == Op::Smoothstep) { // a number on the border, as at one of its ends
        const auto from = as_constant(a), to = as_constant(b), x = as_constant(c);
        return from && to && x && *from < *to ? constant(ir::sem::smoothstep(*from, *to, *x))
                                              : unknown(id, i);
    }
    if (op == Op::Step) { // step(edge, x)
        const Sum gap = add(b, a, -1);
        if (const auto d = as_constant(gap); d && *d != 0) return constant(*d > 0);
        const auto w = way(id, i, {{gap}, {add({}, gap, -1)}});
        return w ? std::optional(constant(*w == 0)) : std::nullopt;
    }
    // A sign of what is 0 on all of the border may turn with it, so either side is looked at.
    if (const auto d = as_constant(a); d && *d != 0) return constant(*d > 0 ? 1 : -1);
    if (const int sign = by_inverses_ ? held_sign(a) : 0; sign != 0) return constant(sign);
    const Sum less = add({}, a, -1);
    const auto w = way(id, i, {{a}, {less}, {a, less}});
    return w ? std::optional(constant(*w == 0 ? 1 : *w == 1 ? -1 : 0)) : std::nullopt;
}

std::optional<bool> Cases::truth(NodeId id) {
    if (const auto it = truths_.find(id); it != truths_.end()) return it->second;
    const auto out = truth_of(id);
    if (out) truths_.emplace(id, *out);
    return out;
}

std::optional<bool> Cases::truth_of(NodeId id) {
    const ir::Node node = graph_[id];
    if (turned_ && id == claim_.comparison) return *turned_;
    if (side_ && id == claim_.choice) return *side_ == 1;
    if (turned_ && are_opposite(id, claim_.comparison)) return !*turned_;
    if (side_ && are_opposite(id, claim_.choice)) return *side_ == 0;
    if (graph_.is_constant(id)) return graph_.constant_of(id).value[0] != 0;
    if (node.op == Op::Not) {
        const auto t = truth(graph_.arg(id, 0));
        return t ? std::optional(!*t) : std::nullopt;
    }
    if (node.op == Op::And || node.op == Op::Or) {
        const auto a = truth(graph_.arg(id, 0));
        if (!a || *a == (node.op == Op::Or)) return a;
        return truth(graph_.arg(id, 1));
    }
    if (node.op == Op::Select) {
        const auto t = truth(graph_.arg(id, 0));
        return t ? truth(graph_.arg(id, *t ? 1 : 2)) : std::nullopt;
    }
    std::vector<Sum> when_true, when_false;
    if ((node.op == Op::Less || node.op == Op::LessEqual) &&
        graph_[graph_.arg(id, 0)].type == ir::Type::Float) {
        const auto u = value(graph_.arg(id, 0)), v = u ? value(graph_.arg(id, 1)) : std::nullopt;
        if (!v) return {};
        when_true = {add(*v, *u, -1)}, when_false = {add(*u, *v, -1)};
        if (const auto c = as_constant(when_true[0]); c && is_count(graph_, id))
            return node.op == Op::Less ? *c > 0 : *c >= 0;
    }
    const auto w = way(id, 0, {when_false, when_true});
    return w ? std::optional(*w == 1) : std::nullopt;
}

} // namespace fathom::proof
