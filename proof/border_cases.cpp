// Long: one class, whose cases share their state.
// Each `min`, `abs`, `clamp`, `if` that is met decides one way or the other, with an inequality for
// it; lengths become roots, which are |s| where s*s is below them. A case is done where both sides
// are equal, where inequalities say so, or where they contradict each other (cases.h).
#include "proof/border_cases.h"

#include "proof/cases.h"
#include "proof/on_line.h"
#include "proof/tape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>

namespace fathom::proof {
namespace {

using ir::Graph;

constexpr int max_cases = 600, max_forks = 40, max_depth_of_cases = 200, max_squares = 12;

// -- atoms

using Atom = LineAtom;
using AtomKey = std::vector<double>;

// -- one case

// How a choice that is met may go: each way with what has to be at least 0 for it.
struct Fork {
    std::pair<NodeId, int> at; // the node, and its component
    std::vector<std::vector<Sum>> ways;
};

struct Case {
    std::map<std::pair<NodeId, int>, int> way;
    std::vector<std::pair<std::uint32_t, Sum>> solved;
    std::vector<Sum> at_least_0;
    bool border_solved = false;
};

class Cases {
  public:
    Cases(Graph &graph, bool split_sizes, Looked &looked)
        : graph_(graph), split_sizes_(split_sizes), looked_(looked) {}

    bool hold(const Claim &claim) {
        claim_ = claim;
        return hold(Case{}, 0);
    }
    int count() const { return count_; }

  private:
    Graph &graph_;
    const bool split_sizes_; // |x| of an atom by cases, too; else it is an atom
    Looked &looked_;
    Claim claim_;
    Case case_;
    std::optional<Fork> fork_;
    std::optional<int> side_;                    // of the choice, while one is evaluated
    std::optional<bool> turned_;                 // of the comparison
    std::map<std::pair<NodeId, int>, Sum> done_; // values under side_
    std::map<std::pair<NodeId, NodeId>, bool> reads_;
    std::map<AtomKey, std::uint32_t> index_;
    std::vector<Atom> atoms_;
    int count_ = 0, depth_ = 0, squares_ = 0;

    bool hold(const Case &given, int depth) {
        if (++count_ > max_cases || depth > max_forks) return false;
        case_ = given;
        fork_.reset();
        const std::optional<bool> answer = attempt();
        if (answer && !*answer) {
            Case next = case_;
            if (!solve_equality(next)) return false;
            next.way = given.way;
            return hold(next, depth + 1);
        }
        if (answer) return *answer;
        if (!fork_) return false; // too large
        const Fork fork = *fork_;
        const Case base = case_; // the border may have been solved on the way
        for (std::size_t i = 0; i < fork.ways.size(); ++i) {
            Case next = base;
            next.way[fork.at] = int(i);
            bool possible = true;
            for (const Sum &sum : fork.ways[i]) {
                const auto c = as_constant(sum);
                if (c && *c < -1e-9) possible = false;
                if (!c) next.at_least_0.push_back(sum);
            }
            if (!possible || (!fork.ways[i].empty() && impossible(next, {}))) continue;
            if (!hold(next, depth + 1)) return false;
        }
        return true;
    }

    // true, false, or nothing where the case has to be split first (fork_) or is too large.
    std::optional<bool> attempt() {
        side_.reset();
        done_.clear();
        if (!case_.border_solved) {
            const auto u = value(claim_.u), v = u ? value(claim_.v) : std::nullopt;
            if (!v) return {};
            const Sum gap = add(*u, *v, -1);
            if (const auto c = as_constant(gap); c && std::fabs(*c) > 1e-9) return true; // nowhere
            solve(gap);
            case_.border_solved = true;
            done_.clear();
            if (impossible(case_, {})) return true;
        }
        if (claim_.comparison) { // does the condition turn with it?
            std::array<bool, 2> truths{};
            for (const bool turned : {false, true}) {
                turned_ = turned;
                done_.clear();
                const auto t = truth(graph_.arg(claim_.choice, 0));
                turned_.reset();
                if (!t) return {};
                truths[turned] = *t;
            }
            if (truths[0] == truths[1]) return true;
        }
        std::optional<Sum> first;
        const int sides = graph_[claim_.choice].op == Op::Sign ? 3 : 2;
        for (int side = 0; side < sides; ++side) {
            side_ = side;
            done_.clear();
            const int components = ir::components(graph_[claim_.of].type);
            if (components != 1) return vectors_agree(sides);
            const auto x = value(claim_.of);
            if (!x) return {};
            if (!first)
                first = x;
            else if (!are_equal(*first, *x))
                return false;
        }
        return true;
    }
    std::optional<bool> vectors_agree(int sides) {
        for (int i = 0; i < ir::components(graph_[claim_.of].type); ++i) {
            std::optional<Sum> first;
            for (int side = 0; side < sides; ++side) {
                side_ = side;
                done_.clear();
                const auto x = value(claim_.of, i);
                if (!x) return {};
                if (!first)
                    first = x;
                else if (!are_equal(*first, *x))
                    return false;
            }
        }
        return true;
    }

    bool are_equal(const Sum &a, const Sum &b) {
        const Sum gap = add(a, b, -1);
        if (is_small(gap, a) || is_small(gap, b)) return true;
        if (impossible(case_, {gap, true}) && impossible(case_, {add({}, gap, -1), true}))
            return true;
        return split_sizes_ && are_equal_on_line(a, b);
    }

    // Where all that is left hangs on one number.
    bool are_equal_on_line(const Sum &a, const Sum &b) {
        std::vector<Sum> rows;
        for (const Sum &sum : case_.at_least_0) rows.push_back(reduced(sum, case_));
        for (const auto &[atom, sum] : case_.solved)
            if (atoms_[atom].never_negative) rows.push_back(reduced(sum, case_));
        std::vector<Atom> atoms = atoms_;
        Sum one = a, other = b;
        for (Atom &atom : atoms) {
            if (!atom.below) continue;
            atom.below = reduced(*atom.below, case_);
            if (!atom.range) atom.range = range_of_root(*atom.below, atoms);
        }
        bool holds = agree_on_line(rows, one, other, atoms, looked_.on_lines);
        for (std::uint32_t r = 0; !holds && r < atoms.size(); ++r) { // x*x + y*y as r*r
            if (!atoms[r].square || atoms[r].square->size() < 2) continue;
            const Sum square = *atoms[r].square;
            const auto rewrite = [&](Sum &sum) {
                sum = reduced(with_square(sum, r, square), case_);
            };
            std::ranges::for_each(rows, rewrite);
            rewrite(one), rewrite(other);
            for (std::uint32_t k = 0; k < atoms.size(); ++k)
                if (k != r && atoms[k].below) rewrite(*atoms[k].below);
            holds = agree_on_line(rows, one, other, atoms, looked_.on_lines);
        }
        if (!holds) return false;
        looked_.near = true;
        return true;
    }
    // With r*r for the leading term of what r is the root of, less the other terms.
    static Sum with_square(const Sum &sum, std::uint32_t r, const Sum &square) {
        const Product &lead = square.begin()->first;
        const double by = square.begin()->second;
        if (lead.size() != 2) return sum;
        Sum out = sum;
        for (int round = 0; round < 40; ++round) {
            const auto it = std::find_if(out.begin(), out.end(), [&](const auto &term) {
                return std::includes(term.first.begin(), term.first.end(), lead.begin(),
                                     lead.end());
            });
            if (it == out.end()) return out;
            Product rest;
            std::set_difference(it->first.begin(), it->first.end(), lead.begin(), lead.end(),
                                std::back_inserter(rest));
            Sum is{{{r, r}, 1 / by}};
            for (const auto &[m, c] : square)
                if (m != lead) is = add(is, Sum{{m, c}}, -1 / by);
            const auto whole = multiply(Sum{{rest, it->second}}, is);
            if (!whole) return sum;
            out.erase(it);
            out = add(out, *whole);
        }
        return sum;
    }
    // Of the root of a sum of products of what has a range.
    static std::optional<Interval> range_of_root(const Sum &below, const std::vector<Atom> &atoms) {
        Interval sum;
        for (const auto &[m, c] : below) {
            Interval term = c;
            for (std::uint32_t a : m) {
                if (!atoms[a].range) return {};
                term = term * *atoms[a].range;
            }
            sum += term;
        }
        return Interval(0, sqrt(sum).hi);
    }

    bool impossible(const Case &c, const Inequality &more) {
        std::vector<Inequality> all;
        std::vector<Product> positive;
        for (const Sum &sum : c.at_least_0) all.push_back({reduced(sum, c), false});
        if (!more.sum.empty()) all.push_back({reduced(more.sum, c), more.strict});
        for (const Inequality &row : all)
            for (const auto &[m, k] : row.sum)
                if (!m.empty() && never_negative(m)) positive.push_back(m);
        for (const auto &[a, sum] : c.solved) // an atom that is none any more keeps its sign
            if (atoms_[a].never_negative) {
                all.push_back({reduced(sum, c), false});
                for (const auto &[m, k] : all.back().sum)
                    if (!m.empty() && never_negative(m)) positive.push_back(m);
            }
        std::sort(positive.begin(), positive.end());
        positive.erase(std::unique(positive.begin(), positive.end()), positive.end());
        return contradict(std::move(all), positive);
    }
    bool never_negative(const Product &m) const {
        for (std::size_t i = 0; i < m.size(); ++i) {
            if (atoms_[m[i]].never_negative) continue;
            if (i + 1 >= m.size() || m[i + 1] != m[i]) return false;
            ++i; // a square
        }
        return true;
    }

    // Of s >= 0 and -s >= 0: s = 0, if that can be solved.
    bool solve_equality(Case &c) {
        std::vector<Sum> rows;
        for (const Sum &sum : c.at_least_0) rows.push_back(reduced(sum, c));
        for (std::size_t i = 0; i < rows.size(); ++i)
            for (std::size_t k = 0; k < i; ++k) {
                if (as_constant(rows[i]) || as_constant(rows[k])) continue;
                const auto &[m, by] = *rows[i].begin();
                const auto other = rows[k].find(m);
                if (other == rows[k].end() || other->second * by > 0) continue;
                if (!is_small(add(rows[i], rows[k], -by / other->second), rows[i])) continue;
                if (auto found = solved_for_atom(rows[i])) {
                    c.solved.push_back(std::move(*found));
                    return true;
                }
            }
        return false;
    }

    // gap = 0: for an atom that stands in one term alone; else as two inequalities.
    void solve(const Sum &gap) {
        if (auto found = solved_for_atom(gap)) {
            case_.solved.push_back(std::move(*found));
            return;
        }
        case_.at_least_0.push_back(gap);
        case_.at_least_0.push_back(add({}, gap, -1));
    }
    Sum reduced(const Sum &sum, const Case &c) const {
        Sum out = sum;
        for (const auto &[a, is] : c.solved) out = with_atom(out, a, is);
        return out;
    }

    // -- values

    std::uint32_t atom_of(AtomKey key, Atom about) {
        const auto [it, fresh] = index_.try_emplace(std::move(key), std::uint32_t(atoms_.size()));
        if (fresh) atoms_.push_back(std::move(about));
        return it->second;
    }
    Sum leaf(NodeId id, int i) {
        Atom about;
        if (graph_[id].op == Op::Point) about.range = Interval(-near_enough, near_enough);
        return reduced(atom(atom_of({-1.0, double(id.index), double(i)}, about)), case_);
    }
    // A function of which nothing is known but its arguments.
    std::optional<Sum> unknown(NodeId id, int i) {
        const ir::Node node = graph_[id];
        if (node.count == 0) return leaf(id, i);
        AtomKey key{double(node.op), double(node.payload), double(node.type), double(i)};
        for (int k = 0; k < int(node.count); ++k) {
            const NodeId a = graph_.arg(id, k);
            for (int c = 0; c < ir::components(graph_[a].type); ++c) {
                const auto x = value(a, c);
                if (!x) return {};
                add_to_key(key, *x);
            }
        }
        Atom about;
        about.never_negative = node.op == Op::Exp || node.op == Op::Exp2 || node.op == Op::Hash;
        return atom(atom_of(std::move(key), about));
    }

    bool reads(NodeId id, NodeId what) {
        if (id == what) return true;
        const auto it = reads_.find({id, what});
        if (it != reads_.end()) return it->second;
        bool out = false;
        for (NodeId a : graph_.args(id)) out = out || reads(a, what);
        return reads_[{id, what}] = out;
    }

    // The way that this case has gone at a node, or a fork. What depends on the choice, or on the
    // truth of its comparison, goes its own way on each side. `use`: which of a node's questions.
    enum Use { Own = 0, Sizes = 100, Roots = 200, Upper = 300, Lengths = 400, PerSide = 1000 };
    std::optional<int> way(NodeId id, int i, std::vector<std::vector<Sum>> ways) {
        if (side_ && reads(id, claim_.choice)) i += PerSide * (1 + *side_);
        if (turned_ && reads(id, claim_.comparison)) i += 10 * PerSide * (1 + *turned_);
        if (const auto it = case_.way.find({id, i}); it != case_.way.end()) return it->second;
        if (!fork_) fork_ = Fork{{id, i}, std::move(ways)};
        return {};
    }

    std::optional<Sum> value(NodeId id, int i = 0) {
        if (const auto it = done_.find({id, i}); it != done_.end()) return it->second;
        if (fork_ || depth_ > max_depth_of_cases) return {};
        ++depth_;
        std::optional<Sum> out = value_of(id, i);
        --depth_;
        if (out) done_[{id, i}] = *out;
        return out;
    }

    std::optional<Sum> size_of(NodeId id, int i, const Sum &x) { // |x|
        if (const auto c = as_constant(x)) return constant(std::fabs(*c));
        const Product &lead = x.begin()->first;
        if (x.size() == 1 && lead.size() == 1) {
            const double c = x.begin()->second;
            if (atoms_[lead[0]].never_negative) return c > 0 ? x : add({}, x, -1);
            if (!split_sizes_) {
                Atom about;
                about.never_negative = true;
                about.square = multiply(atom(lead[0]), atom(lead[0]));
                const std::uint32_t a = atom_of({-2.0, double(lead[0])}, about);
                return add({}, reduced(atom(a), case_), std::fabs(c));
            }
        }
        const auto w = way(id, i, {{x}, {add({}, x, -1)}});
        if (!w) return {};
        return *w == 0 ? x : add({}, x, -1);
    }

    // The square root of a node's value; 0 below 0.
    std::optional<Sum> root(NodeId at, NodeId below, int i) {
        const ir::Node node = graph_[below];
        if (below == claim_.choice && side_ && node.op == Op::Select)
            return root(at, graph_.arg(below, 1 + *side_), i);
        if (node.op == Op::Min || node.op == Op::Max) {
            const auto a = root(graph_.arg(below, 0), graph_.arg(below, 0), i),
                       b = a ? root(graph_.arg(below, 1), graph_.arg(below, 1), i) : std::nullopt;
            return b ? lesser(below, Roots + i, *a, *b, node.op == Op::Min) : std::nullopt;
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
    std::optional<Sum> root_of(NodeId at, const Sum &x, int i, bool of_squares) {
        if (const auto c = as_constant(x)) return constant(*c > 0 ? std::sqrt(*c) : 0);
        const Sum sum = squares_known(x);
        if (const auto s = root_of_square(sum)) return size_of(at, Lengths + i, *s);
        Atom about;
        about.never_negative = true;
        about.below = sum;
        if (of_squares) about.square = sum; // of less than 0 the root is 0
        AtomKey key{-3.0, double(of_squares)};
        add_to_key(key, sum);
        return reduced(atom(atom_of(std::move(key), about)), case_);
    }
    bool is_square_sum(NodeId id) const {
        const ir::Node node = graph_[id];
        if (node.op == Op::Mul || node.op == Op::Dot) return graph_.arg(id, 0) == graph_.arg(id, 1);
        if (node.op == Op::Add)
            return is_square_sum(graph_.arg(id, 0)) && is_square_sum(graph_.arg(id, 1));
        return false;
    }
    // x*x + y*y as r*r where r is a root of it that stands in the sum: so that r*r - 2r + 1 is seen.
    Sum squares_known(const Sum &x) const {
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

    std::optional<Sum> lesser(NodeId id, int i, const Sum &a, const Sum &b, bool least) {
        const Sum gap = add(b, a, -1); // b - a
        if (const auto c = as_constant(gap)) return (*c >= 0) == least ? a : b;
        const auto w = way(id, i, {{gap}, {add({}, gap, -1)}});
        if (!w) return {};
        return (*w == 0) == least ? a : b;
    }

    std::optional<Sum> times(const Sum &a, const Sum &b) {
        const auto out = multiply(a, b);
        if (!out) return {};
        Sum sum; // r*r is what is below the root r
        for (const auto &[m, c] : *out) {
            const auto twice = std::adjacent_find(
                m.begin(), m.end(), [&](auto x, auto y) { return x == y && atoms_[x].square; });
            if (twice == m.end()) {
                sum = add(sum, Sum{{m, c}});
                continue;
            }
            Product rest = m;
            rest.erase(rest.begin() + (twice - m.begin()), rest.begin() + (twice - m.begin()) + 2);
            // What a root's square is made of may have been solved by that root.
            if (squares_ >= max_squares) return {};
            ++squares_;
            const auto whole = times(Sum{{rest, c}}, reduced(*atoms_[*twice].square, case_));
            --squares_;
            if (!whole) return {};
            sum = add(sum, *whole);
        }
        return sum;
    }
    std::optional<Sum> dot(NodeId a, NodeId b) {
        Sum sum;
        for (int k = 0; k < ir::components(graph_[a].type); ++k) {
            const auto x = value(a, k), y = x ? value(b, k) : std::nullopt;
            const auto product = y ? times(*x, *y) : std::nullopt;
            if (!product) return {};
            sum = add(sum, *product);
        }
        return sum;
    }

    std::optional<Sum> value_of(NodeId id, int i) {
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
        if (node.op == Op::Select) {
            const auto t = truth(graph_.arg(id, 0));
            if (!t) return {};
            return value(graph_.arg(id, *t ? 1 : 2), i);
        }
        return unknown(id, i);
    }
    static constexpr ir::OpSet by_component_{Op::Neg, Op::Add, Op::Sub, Op::Mul,   Op::Div,
                                             Op::Min, Op::Max, Op::Abs, Op::Clamp, Op::Sign,
                                             Op::Mix, Op::Pow, Op::Step};

    std::optional<Sum> component(NodeId id, int i, Op op, const Sum &a, const Sum &b,
                                 const Sum &c) {
        if (op == Op::Neg) return add({}, a, -1);
        if (op == Op::Add || op == Op::Sub) return add(a, b, op == Op::Add ? 1 : -1);
        if (op == Op::Mul) return times(a, b);
        if (op == Op::Min || op == Op::Max) return lesser(id, i, a, b, op == Op::Min);
        if (op == Op::Abs) return size_of(id, Sizes + i, a);
        if (op == Op::Div) {
            if (const auto d = as_constant(b); d && *d != 0) return add({}, a, 1 / *d);
            return unknown(id, i);
        }
        if (op == Op::Clamp) { // min(max(x, lo), hi)
            const auto low = lesser(id, i, a, b, false);
            return low ? lesser(id, Upper + i, *low, c, true) : std::nullopt;
        }
        if (op == Op::Mix) {
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
        if (op == Op::Step) { // step(edge, x)
            const Sum gap = add(b, a, -1);
            if (const auto d = as_constant(gap)) return constant(*d >= 0);
            const auto w = way(id, i, {{gap}, {add({}, gap, -1)}});
            return w ? std::optional(constant(*w == 0)) : std::nullopt;
        }
        if (const auto d = as_constant(a)) return constant(*d > 0 ? 1 : *d < 0 ? -1 : 0); // Sign
        const Sum less = add({}, a, -1);
        const auto w = way(id, i, {{a}, {less}, {a, less}});
        return w ? std::optional(constant(*w == 0 ? 1 : *w == 1 ? -1 : 0)) : std::nullopt;
    }

    std::optional<Sum> cross(NodeId id, int i) {
        const NodeId a = graph_.arg(id, 0), b = graph_.arg(id, 1);
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const auto aj = value(a, j), ak = value(a, k), bj = value(b, j), bk = value(b, k);
        if (!aj || !ak || !bj || !bk) return {};
        const auto x = times(*aj, *bk), y = times(*ak, *bj);
        if (!x || !y) return {};
        return add(*x, *y, -1);
    }

    std::optional<bool> truth(NodeId id) {
        const ir::Node node = graph_[id];
        if (turned_ && id == claim_.comparison) return *turned_;
        if (side_ && id == claim_.choice) return *side_ == 1;
        if (graph_.is_constant(id)) return graph_.constant_of(id).value[0] != 0;
        if (node.op == Op::Not) {
            const auto t = truth(graph_.arg(id, 0));
            return t ? std::optional(!*t) : std::nullopt;
        }
        if (node.op == Op::And || node.op == Op::Or) {
            const auto a = truth(graph_.arg(id, 0)),
                       b = a ? truth(graph_.arg(id, 1)) : std::nullopt;
            if (!b) return {};
            return node.op == Op::And ? *a && *b : *a || *b;
        }
        if (node.op == Op::Select) {
            const auto t = truth(graph_.arg(id, 0));
            return t ? truth(graph_.arg(id, *t ? 1 : 2)) : std::nullopt;
        }
        std::vector<Sum> when_true, when_false;
        if ((node.op == Op::Less || node.op == Op::LessEqual) &&
            graph_[graph_.arg(id, 0)].type == ir::Type::Float) {
            const auto u = value(graph_.arg(id, 0)),
                       v = u ? value(graph_.arg(id, 1)) : std::nullopt;
            if (!v) return {};
            when_true = {add(*v, *u, -1)}, when_false = {add(*u, *v, -1)};
        }
        const auto w = way(id, 0, {when_false, when_true});
        return w ? std::optional(*w == 1) : std::nullopt;
    }
};

} // namespace

bool is_proved(Graph &graph, const Claim &claim, Looked &looked) {
    const bool near = looked.near;
    for (const bool split_sizes : {false, true}) {
        looked.near = near;
        Cases attempt(graph, split_sizes, looked);
        const bool holds = attempt.hold(claim);
        looked.cases += attempt.count();
        if (holds) return true;
    }
    looked.near = near;
    return false;
}

} // namespace fathom::proof
