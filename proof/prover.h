// The working state of one proof, and the rules by group (walk.cpp calls those in
// shapes.cpp, maps.cpp, repeat.cpp, fields.cpp).
#pragma once

#include "proof/bound_cache.h"
#include "proof/cells.h"
#include "proof/prove.h"
#include "proof/shape_facts.h"

#include <deque>
#include <map>
#include <optional>
#include <tuple>
#include <unordered_set>

namespace fathom::proof {

// Where a shape is evaluated at all, in its own space.
struct Place {
    bool reached = false,
         reported = false; // reported: not only inside a body whose claims are taken
    Box box;               // the hull over all uses
    const Zone *zone =
        nullptr; // the region, where there is one use and it is the shape's own space
    bool shared = false;
};

// What helps where a bound of a field of one's own is not proved.
inline constexpr const char *state_a_bound =
    "state a bound with `lipschitz:`, which is tested, or with `estimate:`, which is not";

struct Prover {
    ir::Scene &scene;
    Diagnostics &diagnostics;
    const Options &options;
    ir::Graph &graph;
    Work work;
    BoundCache of_this_proof; // where the caller has none
    Flattening flattening;
    Ranges ranges;
    std::deque<Derived> derived;      // the first is that of shapes that no one asks
    std::vector<std::uint32_t> known; // by shape: its place in `derived`
    std::vector<Place> places;
    std::deque<Zone> zones;            // stable addresses
    std::size_t leaf_instructions = 0; // of a field of one's own whose bound is loose, at most
    std::size_t leaf_work = 0;         // for trying to prove a bound that is stated, at most
    std::size_t spare_work = 0;        // for all of these, beside `work`
    std::size_t deformed = 0;          // how many shapes are twisted, bent, tapered or distorted
    bool told_of_work = false;
    std::vector<std::size_t> spent; // steps of `work`, by shape, of those that are known
    std::size_t left_before = 0;    // of `work`, when the one after these was begun

    Prover(ir::Scene &s, Diagnostics &d, const Options &o)
        : scene(s), diagnostics(d), options(o),
          graph(s.graph), work{o.work, o.stop}, flattening{s.graph, work},
          ranges(ranges_of(s, work, o.times)) {
        ranges.rules = o.rules;
        flattening.ranges = &ranges;
        flattening.cache = o.cache ? o.cache : &of_this_proof;
    }

    void run();

    // -- numbers
    Interval number(ir::NodeId id); // of a closed scalar
    Vec vector(ir::NodeId id);      // of a closed vector (a flat one's z is 0)
    std::array<Interval, 16> numbers(ir::NodeId id);
    bool reads_point(ir::NodeId id) const { return graph.reads(id).point; }
    const Derived &of(ir::ShapeId id) const { return derived[known[id.index]]; }
    const Derived &child(const ir::Shape &shape, std::size_t i = 0) const {
        return of(shape.children[i]);
    }
    const Place &place(ir::ShapeId id) const { return places[id.index]; }
    Zone zone_of(const ir::Region &region);
    bool is_field(ir::ShapeId id) const;

    void test_conditions(); // conditions.cpp
    void know_caches();     // caches.cpp
    void name_axioms();     // axioms.cpp: fills Scene::axioms
    void report_not_cached(ir::CacheId id);

    // -- places, from the root down
    void find_places();
    void visit(ir::ShapeId child, const Box &box, const Zone *zone, bool reported);

    // -- rules, from the leaves up; each returns all that it found
    Derived of_child(const ir::Shape &shape) const; // what a rule about the first child begins with
    Derived know(ir::ShapeId id);
    Derived know_leaf(ir::ShapeId id);
    Derived know_set(ir::ShapeId id); // union, intersection, xor, blend, seam, pseudo-norm
    struct Steepness {
        ir::NodeId formula;
        double sup;
    };
    Derived join_operand(const ir::Shape &shape, Derived k, const Derived &first,
                         const Derived &next);
    Steepness join_bounds(const ir::Shape &shape, Steepness so_far, const Derived &next);
    Derived know_lerp(ir::ShapeId id);
    Box varying_box(ir::NodeId weight, const Box &within); // lerp.cpp
    double gap_of(ir::ShapeId id, double enough);
    Derived know_displaced(ir::ShapeId id); // displace, offset, shell
    Derived know_extrude(ir::ShapeId id);
    Derived know_map(ir::ShapeId id);
    Derived know_translate(ir::ShapeId id, Derived k); // k: of the child; so all below
    Derived know_rotate(ir::ShapeId id, Derived k);
    Derived know_scale(ir::ShapeId id, Derived k);
    Derived know_fold(ir::ShapeId id, Derived k);
    Derived know_revolve(ir::ShapeId id, Derived k);
    Derived know_deformed(ir::ShapeId id);
    Derived know_twist(ir::ShapeId id, Derived k);
    Derived know_bend(ir::ShapeId id, Derived k);
    Derived know_taper(ir::ShapeId id, Derived k);
    Derived know_distort(ir::ShapeId id, Derived k);
    void needs_region(ir::ShapeId id, Derived &k, const std::string &what);
    struct Copies; // repeat.cpp
    Copies ring_copies(const ir::Shape &shape, const ir::Repetition &repetition,
                       const Derived &motif, Derived &k);
    Copies lattice_copies(const ir::Shape &shape, const ir::Repetition &repetition,
                          const Derived &motif, Derived &k);
    Derived know_repeat(ir::ShapeId id);
    Derived know_within(ir::ShapeId id);
    void know_cells(); // after all facts: cells.cpp
    void find_cells(ir::ShapeId id, ir::NodeId field, const Domain &domain, double whole,
                    const CellAim &aim); // sets Scene::cells where they pay
    Derived know_instances(ir::ShapeId id);
    Derived know_library(ir::ShapeId id);
    void hold_claim(ir::ShapeId id, Derived &k);
    Derived know_contract(ir::ShapeId id);

    Ball ball_of(ir::ShapeId id,
                 const Derived &k); // from the children's balls, where that says more
    void keep_in_ball(ir::ShapeId id, Derived &k); // sets the ball, and cuts the box to it

    double bend(ir::NodeId field, const Box &box); // curvature.cpp
    double core_of_leaf(ir::NodeId field);
    // c, where f'' <= 1/(f + c) along lines wherever f > -c; -infinity: unknown. Wanted for what is
    // displaced alone.
    double core_of(ir::ShapeId id, int depth = 0);
    double core_made(ir::ShapeId id, int depth);
    std::map<ir::ShapeId, double> cores;
    double curvature_of(ir::ShapeId id, const Derived &k); // ShapeFact::curvature

    std::vector<ir::PartialSum> partial_sums(ir::ShapeId displaced, double slope); // octaves.cpp
    void tighten(ir::ShapeId id, Derived &k); // a deformed shape's bound, by its own expression
    double region_radius(ir::ShapeId id, int axis) const;

    // -- folds: q is p by component, |p_i|, or p less something limited
    Box fold_preimage(ir::NodeId q, const Box &box);
    // Where the box lies on the near side of every mirror: how far a fold draws apart what it keeps.
    std::optional<double> fold_is_clean(ir::NodeId q, const Box &box);
    std::array<bool, 3> fold_symmetry(ir::NodeId q, std::array<bool, 3> child);
    std::optional<ir::NodeId> shift_of(ir::NodeId q, int i);
    std::optional<Vec> whole_shift(ir::NodeId q); // the interval of p - q, where limited
    Interval number_anywhere(ir::NodeId id);

    std::shared_ptr<const Tape> tape_of(ir::NodeId field); // flattened once, while there is room
    std::map<ir::NodeId, std::shared_ptr<const Tape>> tapes;
    std::size_t tapes_length = 0; // of all, in instructions

    // What values the raw field may have in a box of its own space; and how far from 0 they are.
    Interval values(ir::ShapeId id, const Cell &cell, int depth = 0);
    Interval own_values(ir::ShapeId id, const Cell &cell, int depth); // as if proved everywhere
    double magnitude(ir::ShapeId id, const Box &box);
    Box extent(ir::ShapeId id); // holds the solid, wherever its field's values say so
    // Of a part that has a region (cut_away.cpp).
    bool leaves_nothing(ir::ShapeId id, const Zone &zone, int dims);
    void tell_cut_away(ir::ShapeId id);
    void find_extent(ir::ShapeId id, Derived &k);           // sets the box of what has none
    double surface_slope(ir::ShapeId id, const Derived &k); // see ir::ShapeFact

    // The raw field as one expression in Point, where the shape is made of leaves, maps, min and
    // max; else nothing.
    std::optional<ir::NodeId> expression(ir::ShapeId id, int depth = 0);

    FieldBound bound_once(ir::NodeId field, const Place &here, bool own);
    FieldBound bound_written(ir::NodeId field, const Domain &domain, const Budget &budget);
    std::optional<FieldBound> bound_by_scale(ir::NodeId field, const Domain &domain,
                                             const Budget &budget);
    FieldBound bound_by_values(ir::NodeId field, const Domain &domain, const Budget &budget);
    // The bound that was found as a number, or, where that is worth it, as a formula of params.
    Steepness by_params(ir::ShapeId id, ir::NodeId field, double whole);
    std::map<std::tuple<ir::NodeId, std::array<double, 3>, std::array<double, 3>>, FieldBound>
        bounds; // by field and box

    // The bound of an expression of the point over where the shape is evaluated. Reports failures.
    FieldBound bound(ir::ShapeId id, ir::NodeId field, const std::string &what, bool report = true);

    void keep_local(Derived &k, double sup,
                    ir::NodeId formula); // the bound of a field that is joined with its box
    void set_lipschitz(Derived &k, double value); // a constant
    void set_lipschitz(Derived &k, ir::NodeId formula,
                       double sup); // an expression in params; constant where it reads none
    void fail(Derived &k);          // no proof: infinity, facts usable
    void check_size(ir::ShapeId id, Derived &k); // too large or too small for single precision
    void finish(ir::ShapeId id, Derived &k);     // guards, notes

    // -- reports; silent where the shape is not reported
    static std::string cheaper(const ir::Shape &shape);
    Diagnostic *report(ir::ShapeId id, Code code, std::string message);
    void report_limit(ir::ShapeId id); // dearest.cpp: names what took most of the work
    // What of the shape's field is to blame for what was found of it, and where it is written, where
    // either is seen: places.cpp.
    struct Blamed {
        ir::NodeId node;
        std::optional<Span> at;
    };
    Blamed blame(ir::ShapeId id, const FieldBound &bound);
    Diagnostic *report_at(ir::ShapeId id, const Blamed &blamed, Code code, std::string message);
    std::optional<std::string> divides_by_0(ir::ShapeId id);
    bool report_ellipsoid(ir::ShapeId id, const FieldBound &bound, const Blamed &blamed,
                          const std::string &what);
    bool report_division(ir::ShapeId id, const FieldBound &bound, const Blamed &blamed,
                         const std::string &what); // false: not said here
    void report_unplaced(ir::ShapeId id, const FieldBound &bound, const Blamed &blamed,
                         const std::string &what, const std::string &cause);
    void report_field(ir::ShapeId id, const FieldBound &bound, const std::string &what);
    void test_estimate(ir::ShapeId id, ir::NodeId field, double estimate); // assumed.cpp
    // What is proved of a field whose bound the user states, where that is no more. Else the bound
    // is tested, and refused where a pair of points is steeper.
    std::optional<FieldBound> holds_stated(ir::ShapeId id, ir::NodeId field, double stated);
    FieldBound bound_apart(ir::NodeId field, const Place &here, double stated, bool own);
    void test_stated(ir::ShapeId id, ir::NodeId field, double stated, const FieldBound &found);
    std::unordered_set<ir::ShapeId> held; // of those that state a bound: for which it is proved,
                                          // and of the library's
    std::vector<std::string>
    chain(ir::ShapeId id); // the operations that make a bound, steepest child first
};

std::string number_text(double x); // three significant digits: "2.37", "1.2e+03"
std::string point_text(const std::array<double, 3> &p, int dims = 3);
// Two with as many digits as it takes to tell them apart.
std::pair<std::string, std::string> two_numbers(double a, double b);
std::pair<std::string, std::string> two_points(const std::array<double, 3> &a,
                                               const std::array<double, 3> &b, int dims);
std::string operation_name(const ir::Scene &scene, ir::ShapeId id); // "twist", "sphere", …

} // namespace fathom::proof
