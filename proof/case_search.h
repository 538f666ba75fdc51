// The search for a proof of a claim about a border: cases, each with the ways that choices go in it,
// what is solved and what is at least 0 (border_cases.h). A number is a sum of products of atoms.
#pragma once

#include "proof/border_cases.h"
#include "proof/cases.h"
#include "proof/enclosed.h"
#include "proof/on_line.h"
#include "proof/tape.h"

#include <array>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace fathom::proof {

using ir::Graph;
using ir::Interval;
using ir::NodeId;
using ir::Op;

using Atom = LineAtom;
using AtomKey = std::vector<double>;

// How a choice that is met may go: each way with what has to be at least 0 for it.
struct Fork {
    std::pair<NodeId, int> at; // the node, and its component
    std::vector<std::vector<Sum>> ways;
};

struct Case {
    std::map<std::pair<NodeId, int>, int> way;
    std::map<std::pair<NodeId, int>, Sum> first; // what the first way of these says is at least 0
    std::vector<std::pair<std::uint32_t, Sum>> solved;
    std::vector<Sum> at_least_0;
    bool border_solved = false;
};

// What a number of two sides is on one of them to what it is on the other.
enum class Relation : std::uint8_t { Same, Opposite, Unknown };

// Axes at right angles, of length 1, that the point's coordinates are seen along, and their origin.
struct Axes {
    std::array<std::array<double, 3>, 3> along;
    std::array<double, 3> origin;
};
// Along a direction that is no axis, with which the claim's numbers multiply a point (`dot(p - a, d)`).
std::optional<Axes> axes_of(const Graph &graph, const Claim &claim);
// Along the coordinates' own axes, from an origin at the claim's parts; nothing where that is near.
std::optional<Axes> near_parts(const Graph &graph, const Claim &claim);

class Cases {
  public:
    // What a search tries besides: `sizes`, |x| of an atom by cases, which else is an atom; `inverses`,
    // quotients by what is held as products with an inverse.
    struct Tries {
        bool sizes = false, inverses = false;
        bool products = false; // with matrices of numbers, as sums; else their components are atoms
        double reach =
            near_enough; // no coordinate is beyond, of points that a proof has to hold for
    };
    Cases(Graph &graph, Tries tries, Looked &looked, std::optional<Axes> axes = {})
        : graph_(graph), tries_(tries), split_sizes_(tries.sizes), by_inverses_(tries.inverses),
          axes_(axes), looked_(looked) {}

    bool hold(const Claim &claim);
    // By what the sides are to each other alone (relation); no number is compared.
    bool hold_alike(const Claim &claim);
    int count() const { return count_; }
    bool met_held() const { return met_held_; }       // a number that is the same for all points
    bool met_product() const { return met_product_; } // of a vector and a matrix of numbers

  private:
    Graph &graph_;
    const Tries tries_;
    const bool split_sizes_, by_inverses_; // as of Tries
    const std::optional<Axes> axes_;
    Looked &looked_;
    Claim claim_;
    Case case_;
    std::optional<Fork> fork_;
    std::optional<int> side_;                    // of the choice, while one is evaluated
    std::optional<bool> turned_;                 // of the comparison
    std::map<std::pair<NodeId, int>, Sum> done_; // values under side_
    std::map<NodeId, bool> truths_;              // likewise
    std::map<std::pair<NodeId, NodeId>, bool> reads_;
    std::map<AtomKey, std::uint32_t> index_;
    std::vector<Atom> atoms_;
    std::set<std::uint32_t> coordinates_;                   // atoms that are coordinates
    std::map<std::uint32_t, std::pair<NodeId, int>> nodes_; // atoms that are a node's component
    std::map<NodeId, Relation> relations_;
    int count_ = 0, depth_ = 0, squares_ = 0, roots_ = 0, lines_ = 0;
    bool alike_ = false; // as of hold_alike
    bool met_held_ = false, met_product_ = false;
    bool splits_ = true; // else what a case leaves open is asked of its inequalities

    bool hold(const Case &given, int depth);
    void forget() { done_.clear(), truths_.clear(); }

    // true, false, or nothing where the case has to be split first (fork_) or is too large.
    std::optional<bool> attempt();
    std::optional<bool> vectors_agree(int sides);

    Relation relation(NodeId id);
    Relation relation_of(NodeId id);
    // Is a number 0 in this case, as far as is seen without splitting it?
    bool vanishes(NodeId id);
    bool is_0(NodeId id);
    bool is_at_least_0(NodeId id) const;
    std::vector<NodeId> parts_of_min(NodeId id) const;
    bool is_of_border(NodeId id); // reads a number, no coordinate, that u or v reads

    bool are_equal(const Sum &a, const Sum &b);
    // gap = a - b, at most `granted` of both
    bool is_rounding(const Sum &gap, const Sum &a, const Sum &b, double granted);
    // The same by the case's inequalities.
    bool is_at_most(const Sum &gap, const Sum &a, const Sum &b);
    bool differs_by_at_most(const Case &c, const Sum &gap, double slack);
    void grant(const Sum &gap);
    double granted_near(const Sum &a, const Sum &b, double distance);
    // Of an atom that is no further from the axes' origin than this; `box` has the points there.
    std::optional<Interval> range_near(std::uint32_t a, Enclosed &box, double distance) const;
    std::optional<Interval> range_near(const Sum &sum, Enclosed &box, double distance) const;
    Enclosed enclosed_near(double distance) const;
    Case with_ranges(const Case &c, double distance);

    // Where all that is left hangs on one number.
    bool are_equal_on_line(const Sum &a, const Sum &b);
    // With r*r for the leading term of what r is the root of, less the other terms.
    static Sum with_square(const Sum &sum, std::uint32_t r, const Sum &square);
    // Of a sum of products of what has a range.
    static std::optional<Interval> range_of(const Sum &sum, const std::vector<Atom> &atoms);

    bool impossible(const Case &c, const Inequality &more);
    // The ranges of what is held and stands in products; what it is of.
    std::vector<std::uint32_t> add_ranges(std::vector<Inequality> &rows) const;
    // These, and what follows of rows of degree 1, `t >= 0`: (a - lo) t >= 0.
    void add_products(std::vector<Inequality> &rows) const;
    // The products of two rows of degree 1; of a root that is at least b >= 0, the squares.
    void add_pairs(std::vector<Inequality> &rows);
    // Roots are at least as large as the number that their squares are a sum of squares beside.
    void add_least_roots(std::vector<Inequality> &rows, const Case &c);
    bool never_negative(const Product &m) const;

    // The angles at which a fold keeps a product of a turn and a point; its borders as rows.
    std::optional<Interval> sector_of(NodeId product);
    void add_sectors(std::vector<Inequality> &rows, const Case &c) const;

    // Of s >= 0 and -s >= 0: s = 0, if that can be solved.
    bool solve_equality(Case &c);

    // gap = 0: for an atom that stands in one term alone, or in a square, by either of its roots; else
    // as two inequalities. False where the case has to be split first.
    bool solve(const Sum &gap);
    // For an atom that is not held, where there is one.
    std::optional<std::pair<std::uint32_t, Sum>> solved_for_moving(const Sum &sum) const;
    // A u + B v + C = 0 with A, B, C of what is held: u = u0 - B t and v = v0 + A t.
    bool solve_along_line(const Sum &gap);
    bool is_held(const Sum &sum) const; // of what is held alone
    // a / b, both held, b a number times an atom that is never 0.
    std::optional<Sum> quotient(const Sum &a, const Sum &b);

    // Of what is held: its range, which is halved until a sign is seen; 1, -1, or 0 where none is.
    std::optional<Interval> halved_range_of(const Sum &sum) const;
    int held_sign(const Sum &sum) const;
    // 1 / b where b is held and never 0, as a product of inverses.
    std::optional<Sum> inverse(const Sum &b);
    // A sum with the sign of this one, 0 where it is: without inverses, without factors above 0.
    Sum cleared(const Sum &sum);
    // Without a factor that all of it has, held and never 0.
    Sum without_held_factor(const Sum &sum) const;
    // The root of a square, also where it is one with r*r for x*x + y*y.
    std::optional<Sum> root_by_roots(const Sum &square) const;
    bool is_square(const Sum &sum); // times a number above 0, which is held
    // gap = 0 for an atom u that is multiplied by what is held and never 0.
    bool solve_by_inverse(const Sum &gap);
    // A number of which the square is `below`, a sum of products with one inverse.
    std::optional<Sum> root_over_inverses(const Sum &below);
    std::optional<std::pair<Product, Sum>> in_place_of_pair(const Product &m) const;
    // Roots of what has been solved since, as roots of what it is now.
    void follow_roots(Case &c);
    Sum reduced(const Sum &sum, const Case &c) const;

    std::uint32_t atom_of(AtomKey key, Atom about);
    Sum leaf(NodeId id, int i);
    // A function of which nothing is known but its arguments.
    std::optional<Sum> unknown(NodeId id, int i);

    bool reads(NodeId id, NodeId what); // or what is true where that is not
    bool turns(NodeId id);              // reads the choice, or the comparison that turns it
    // `a <= b` beside `b < a`, and the other way round: one is true where the other is not.
    bool are_opposite(NodeId a, NodeId b) const;

    // The way that this case has gone at a node, or a fork. What depends on the choice, or on the
    // truth of its comparison, goes its own way on each side. `use`: which of a node's questions.
    enum Use {
        Own = 0,
        Sizes = 100,
        Roots = 200,
        Upper = 300,
        Lengths = 400,
        Squares = 500,
        PerSide = 1000
    };
    std::optional<int> way(NodeId id, int i, std::vector<std::vector<Sum>> ways);
    std::pair<NodeId, int> place_of_way(NodeId id, int i); // on this side
    // A root of a square is either of two numbers: the one of which the way that was gone speaks,
    // though the square has been written otherwise since; nothing where that is not seen.
    std::optional<Sum> root_as_met(NodeId at, int i, const Sum &root);

    std::optional<Sum> value(NodeId id, int i = 0);

    std::optional<Sum> size_of(NodeId id, int i, const Sum &x); // |x|

    // The square root of a node's value; 0 below 0.
    std::optional<Sum> root(NodeId at, NodeId below, int i);
    std::optional<Sum> root_of(NodeId at, const Sum &x, int i, bool of_squares);
    std::uint32_t root_atom(const Sum &below, bool of_squares);
    bool is_square_sum(NodeId id) const;
    std::optional<bool> truth_of(NodeId id);
    // x*x + y*y as r*r where r is a root of it that stands in the sum: so that r*r - 2r + 1 is seen.
    Sum squares_known(const Sum &x) const;

    std::optional<Sum> lesser(NodeId id, int i, const Sum &a, const Sum &b, bool least);

    std::optional<Sum> times(const Sum &a, const Sum &b);
    std::optional<Sum> dot(NodeId a, NodeId b);

    std::optional<Sum> value_of(NodeId id, int i);
    static constexpr ir::OpSet by_component_{Op::Neg, Op::Add, Op::Sub,  Op::Mul,       Op::Div,
                                             Op::Min, Op::Max, Op::Abs,  Op::Clamp,     Op::Sign,
                                             Op::Mix, Op::Pow, Op::Step, Op::Smoothstep};

    std::optional<Sum> component(NodeId id, int i, Op op, const Sum &a, const Sum &b, const Sum &c);

    std::optional<Sum> cross(NodeId id, int i);
    std::optional<Sum> turned(NodeId id, int i);

    std::optional<bool> truth(NodeId id);
};

} // namespace fathom::proof
