// Each `min`, `abs`, `clamp`, `if` that is met decides one way or the other, with an inequality for
// it; lengths become roots, which are |s| where s*s is below them. A case is done where both sides
// are equal, where inequalities say so, or where they contradict each other (cases.h).
#include "proof/border_cases.h"

#include "proof/case_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <unordered_set>

namespace fathom::proof {
namespace {

constexpr int max_cases = 600, max_forks = 40;
constexpr double rounding_of_squares = 1e-12; // what double precision loses
constexpr double rounding_of_terms = 1e-12;   // what is lost of terms on the way (cases.cpp)

} // namespace

bool Cases::hold(const Claim &claim) {
    claim_ = claim;
    return hold(Case{}, 0);
}

bool Cases::hold_alike(const Claim &claim) {
    alike_ = true;
    return hold(claim);
}

bool Cases::hold(const Case &given, int depth) {
    if (++count_ > max_cases || depth > max_forks || looked_.spent()) return false;
    case_ = given;
    fork_.reset();
    const std::optional<bool> answer = attempt();
    if (answer && !*answer) {
        Case next = case_;
        if (!solve_equality(next)) return false;
        follow_roots(next);
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
        if (!fork.ways[0].empty()) next.first[fork.at] = fork.ways[0][0];
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

std::optional<bool> Cases::attempt() {
    side_.reset();
    roots_ = 0;
    forget();
    if (!case_.border_solved) {
        const auto u = value(claim_.u), v = u ? value(claim_.v) : std::nullopt;
        if (!v) return {};
        const Sum gap = cleared(add(*u, *v, -1));
        if (const auto c = as_constant(gap); c && std::fabs(*c) > 1e-9) {
            double terms = 0; // of which `add` takes a little for nothing, at any coordinate
            for (const Sum *side : {&*u, &*v})
                for (const auto &[m, k] : *side)
                    terms = std::max(terms, m.empty() ? 0 : std::fabs(k));
            if (std::fabs(*c) <= rounding_of_terms * near_enough * terms) return false;
            return true; // nowhere
        }
        if (!solve(gap)) return {};
        follow_roots(case_);
        case_.border_solved = true;
        forget();
        if (impossible(case_, {})) return true;
    }
    if (claim_.comparison) { // does the condition turn with it?
        std::array<bool, 2> truths{};
        for (const bool turned : {false, true}) {
            turned_ = turned;
            forget();
            const auto t = truth(graph_.arg(claim_.choice, 0));
            turned_.reset();
            if (!t) return {};
            truths[turned] = *t;
        }
        if (truths[0] == truths[1]) return true;
    }
    if (alike_) {
        relations_.clear();
        const Relation sides = relation(claim_.of);
        return fork_ ? std::nullopt : std::optional(sides == Relation::Same);
    }
    std::optional<Sum> first;
    const int sides = graph_[claim_.choice].op == Op::Sign ? 3 : 2;
    for (int side = 0; side < sides; ++side) {
        side_ = side;
        forget();
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

std::optional<bool> Cases::vectors_agree(int sides) {
    for (int i = 0; i < ir::components(graph_[claim_.of].type); ++i) {
        std::optional<Sum> first;
        for (int side = 0; side < sides; ++side) {
            side_ = side;
            forget();
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

bool Cases::are_equal_on_line(const Sum &a, const Sum &b) {
    std::vector<Sum> rows;
    for (const Sum &sum : case_.at_least_0) rows.push_back(reduced(sum, case_));
    for (const auto &[atom, sum] : case_.solved)
        if (atoms_[atom].never_negative) rows.push_back(reduced(sum, case_));
    std::vector<Atom> atoms = atoms_;
    Sum one = a, other = b;
    for (Atom &atom : atoms) {
        if (!atom.below) continue;
        atom.below = reduced(*atom.below, case_);
        if (const auto range = range_of(*atom.below, atoms); range && !atom.range)
            atom.range = Interval(0, sqrt(*range).hi);
    }
    bool holds = agree_on_line(rows, one, other, atoms, looked_.on_lines);
    for (std::uint32_t r = 0; !holds && r < atoms.size(); ++r) { // x*x + y*y as r*r
        if (!atoms[r].square || atoms[r].square->size() < 2) continue;
        const Sum square = *atoms[r].square;
        const auto rewrite = [&](Sum &sum) {
            looked_.take(16 * (sum.size() + 1));
            sum = reduced(with_square(sum, r, square), case_);
        };
        if (looked_.spent()) return false;
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

Sum Cases::with_square(const Sum &sum, std::uint32_t r, const Sum &square) {
    const Product &lead = square.begin()->first;
    const double by = square.begin()->second;
    if (lead.size() != 2) return sum;
    Sum out = sum;
    for (int round = 0; round < 40; ++round) {
        const auto it = std::find_if(out.begin(), out.end(), [&](const auto &term) {
            return std::includes(term.first.begin(), term.first.end(), lead.begin(), lead.end());
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

bool Cases::impossible(const Case &c, const Inequality &more) {
    std::vector<Inequality> all;
    for (const Sum &sum : c.at_least_0) {
        Inequality row{reduced(sum, c), false};
        if (std::ranges::none_of(all, [&](const auto &one) { return one.sum == row.sum; }))
            all.push_back(std::move(row));
    }
    if (!more.sum.empty()) all.push_back({reduced(more.sum, c), more.strict, more.slack});
    for (const auto &[a, sum] : c.solved) // an atom that is none any more keeps its sign
        if (atoms_[a].never_negative) all.push_back({reduced(sum, c), false});
    if (by_inverses_)
        for (Inequality &row : all) {
            Sum whole = cleared(row.sum);
            if (row.slack > 0 && whole != row.sum) return false; // of another size
            row.sum = std::move(whole);
        }
    add_sectors(all, c);
    const auto contradicted = [&] {
        std::vector<Product> positive;
        for (const Inequality &row : all)
            for (const auto &[m, k] : row.sum)
                if (!m.empty() && never_negative(m)) positive.push_back(m);
        std::sort(positive.begin(), positive.end());
        positive.erase(std::unique(positive.begin(), positive.end()), positive.end());
        std::size_t steps = 0;
        const bool out = contradict(all, positive, steps);
        looked_.take(steps);
        return out;
    };
    if (contradicted()) return true;
    if (more.slack > 0) return false; // of products of rows the numbers may be large beside it
    const std::size_t known = all.size();
    add_least_roots(all, c);
    if (all.size() > known && contradicted()) return true;
    const std::size_t rows = all.size();
    add_products(all);
    if (all.size() > rows && contradicted()) return true;
    if (!by_inverses_) return false;
    all.resize(rows);
    add_pairs(all);
    return all.size() > rows && contradicted();
}

bool Cases::never_negative(const Product &m) const {
    for (std::size_t i = 0; i < m.size(); ++i) {
        if (atoms_[m[i]].never_negative) continue;
        if (i + 1 >= m.size() || m[i + 1] != m[i]) return false;
        ++i; // a square
    }
    return true;
}

bool Cases::solve_equality(Case &c) {
    std::vector<Inequality> sectors;
    add_sectors(sectors, c);
    std::vector<Sum> rows;
    for (const Inequality &row : sectors) rows.push_back(row.sum);
    for (const Sum &sum : c.at_least_0) rows.push_back(cleared(reduced(sum, c)));
    for (const auto &[a, sum] : c.solved)
        if (atoms_[a].never_negative) rows.push_back(cleared(reduced(sum, c)));
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (rows[i].empty()) continue;
        if (const auto &[m, by] = *rows[i].begin();
            rows[i].size() == 1 && m.size() == 1 && by < 0 && never_negative(m)) {
            c.solved.emplace_back(m[0], Sum{}); // -a >= 0 and a >= 0
            return true;
        }
        for (std::size_t k = 0; k < i; ++k) {
            if (as_constant(rows[i]) || as_constant(rows[k])) continue;
            const auto &[m, by] = *rows[i].begin();
            const auto other = rows[k].find(m);
            if (other == rows[k].end() || other->second * by > 0) continue;
            if (!is_small(add(rows[i], rows[k], -by / other->second), rows[i])) continue;
            if (auto found = solved_for_moving(rows[i])) {
                c.solved.push_back(std::move(*found));
                return true;
            }
        }
    }
    return false;
}

bool Cases::solve(const Sum &gap) {
    if (auto found = solved_for_moving(gap)) {
        case_.solved.push_back(std::move(*found));
        return true;
    }
    if (solve_along_line(gap) || (by_inverses_ && solve_by_inverse(gap))) return true;
    if (const auto square = solved_for_square(gap)) {
        const Sum above = add(atom(square->atom), square->middle, -1);
        const auto w = way(claim_.choice, Squares, {{above}, {add({}, above, -1)}});
        if (!w) return false;
        const auto number = as_constant(square->square);
        const Sum root = number ? constant(std::sqrt(std::max(*number, 0.0)))
                                : atom(root_atom(square->square, true));
        case_.solved.emplace_back(square->atom, add(square->middle, root, *w == 0 ? 1 : -1));
        return true;
    }
    const Sum less = add({}, gap, -1);
    for (const Sum &sum : {gap, less})
        if (const auto roots = squares_in(sum, rounding_of_squares)) { // each is 0
            for (const Sum &root : *roots)
                if (auto found = solved_for_atom(reduced(root, case_)))
                    case_.solved.push_back(std::move(*found));
            return true;
        }
    case_.at_least_0.push_back(gap);
    case_.at_least_0.push_back(less);
    return true;
}

void Cases::follow_roots(Case &c) {
    const auto is_solved = [&](std::uint32_t a) {
        return std::ranges::any_of(c.solved, [&](const auto &one) { return one.first == a; });
    };
    // What was solved by a root is no help to write that root anew.
    const auto holds_roots = [&](const Sum &sum) {
        return std::ranges::any_of(sum, [&](const auto &term) {
            return std::ranges::any_of(term.first,
                                       [&](std::uint32_t a) { return bool(atoms_[a].below); });
        });
    };
    const auto known = std::uint32_t(atoms_.size());
    for (std::uint32_t a = 0; a < known; ++a) {
        if (!atoms_[a].below || is_solved(a)) continue;
        const Sum below = reduced(*atoms_[a].below, c);
        if (below == *atoms_[a].below || holds_roots(below)) continue;
        if (const auto number = as_constant(below))
            c.solved.emplace_back(a, constant(std::sqrt(std::max(*number, 0.0))));
        else if (const std::uint32_t is = root_atom(below, atoms_[a].square.has_value()); is != a)
            c.solved.emplace_back(a, atom(is));
    }
}

Sum Cases::reduced(const Sum &sum, const Case &c) const {
    constexpr std::size_t of_term = 16; // dearer than an operation on intervals
    Sum out = sum;
    for (const auto &[a, is] : c.solved) {
        looked_.take(of_term * (out.size() + 1));
        out = with_atom(out, a, is);
    }
    return out;
}

bool is_count(const Graph &graph, NodeId root) {
    constexpr ir::OpSet turning{Op::Sign, Op::Step},
        made{Op::Less, Op::LessEqual, Op::Add, Op::Sub, Op::Mul, Op::Neg};
    std::vector<NodeId> todo{root};
    std::unordered_set<NodeId> seen;
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        const ir::Node node = graph[id];
        if (graph.is_constant(id) || turning[node.op] || !seen.insert(id).second) continue;
        const auto args = graph.args(id);
        if (node.op == Op::ToFloat) {
            if (graph[args[0]].type != ir::Type::Bool) todo.push_back(args[0]);
        } else if (node.op == Op::Select) {
            todo.insert(todo.end(), args.begin() + 1, args.end());
        } else if (made[node.op]) {
            todo.insert(todo.end(), args.begin(), args.end());
        } else {
            return false;
        }
    }
    return true;
}

bool is_proved_alike(Graph &graph, const Claim &claim, Looked &looked) {
    looked.begin();
    Cases attempt(graph, {}, looked, near_parts(graph, claim));
    const bool holds = attempt.hold_alike(claim);
    looked.cases += attempt.count();
    return holds;
}

namespace {

// From the origin, of what is known by distances that are at most so large in a box about it.
template <class Reach> Apart seen_from(const Apart &apart, const Reach &reach) {
    Apart out{};
    for (int scale = least_scale; scale <= far_scale; ++scale) {
        std::array<Interval, 3> box;
        box.fill(Interval(-distance_at(scale), distance_at(scale)));
        const double distance = reach(box);
        int to = least_scale;
        while (to < far_scale && distance_at(to) < distance) ++to;
        out[std::size_t(scale - least_scale)] = apart[std::size_t(to - least_scale)];
    }
    return out;
}

bool is_proved_as_it_is(Graph &graph, const Claim &claim, Looked &looked, double reach) {
    const bool near = looked.near;
    bool met_product = false;
    const auto along_by = [&](const std::optional<Axes> &axes, bool products) {
        bool met_held = false;
        for (const bool inverses : {false, true})
            for (const bool sizes : {false, true}) {
                if (inverses && !met_held) return false;
                looked.near = near;
                looked.begin();
                Cases attempt(graph, {sizes, inverses, products, reach}, looked, axes);
                const bool holds = attempt.hold(claim);
                looked.cases += attempt.count();
                met_held = met_held || attempt.met_held();
                met_product = met_product || attempt.met_product();
                if (!holds) continue;
                if (axes)
                    looked.apart = seen_from(looked.apart, [&](const auto &box) {
                        double squares = 0;
                        for (std::size_t i = 0; i < 3; ++i)
                            squares += square(box[i] - Interval(axes->origin[i])).hi;
                        return std::sqrt(squares);
                    });
                return true;
            }
        return false;
    };
    const auto along = [&](const std::optional<Axes> &axes) {
        return along_by(axes, false) || (met_product && along_by(axes, true));
    };
    if (along(near_parts(graph, claim))) return true;
    if (const auto axes = axes_of(graph, claim); axes && along(axes)) return true;
    looked.near = near;
    return false;
}

} // namespace

bool is_proved(Graph &graph, const Claim &claim, Looked &looked) {
    for (const Inside &inside : seen_from_inside(graph, claim))
        if (is_proved_as_it_is(graph, inside.claim, looked, inside.reach)) {
            looked.apart = seen_from(looked.apart, [&](const std::array<Interval, 3> &box) {
                Enclosed enclosed(graph, looked.ranges, box);
                double size = 0;
                for (int i = 0; i < ir::components(graph[inside.vector].type); ++i)
                    size = std::max(size, enclosed.of(inside.vector, i).magnitude());
                return size;
            });
            return true;
        }
    return is_proved_as_it_is(graph, claim, looked, near_enough);
}

} // namespace fathom::proof
