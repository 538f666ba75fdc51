// The bound of a field over a region: branch and bound on the machine's norms, best first, by a
// counted budget. Knows nothing of shapes.
#pragma once

#include "proof/machine.h"

#include <optional>

namespace fathom::proof {

// A region with its numbers as intervals over all params and times.
struct Zone {
    ir::RegionKind kind = ir::RegionKind::Everywhere;
    std::array<Interval, 3> center{};
    std::array<Interval, 3> half{}; // Box: half its size; Ball, Tube: half[0] is the radius
    int axis = 1;
    std::vector<Zone> less;
};
Cell outer_box(const Zone &zone);
bool misses(const Zone &zone, const Cell &cell); // certainly no common point

struct Domain {
    Cell box;
    const Zone *zone = nullptr; // narrower than the box
};

struct Budget {
    std::size_t instructions = 250'000;
    double tolerance = 1.05; // the bound over the largest slope seen, at which to stop
    double enough = 0;       // a bound than which none need be less
    double hopeless = ir::rounding::infinity; // a slope seen from which on the bound is of no use
    std::size_t most = 0; // instructions where the bound is far above what is seen; 0: no more
    int levels = 4;       // of vectors in vectors that a field is looked at through (composed.h)
};

struct FieldBound {
    double lipschitz = 0; // >= the true constant; infinity where none was proved
    double sampled = 0;   // <= the true constant: the largest slope seen
    Interval value;       // holds every value
    Trouble trouble = Trouble::None;
    bool at_infinity = false; // the slope grows without bound on an unbounded region
    bool too_large = false;   // the field was cut off while flattening
    std::optional<Op> cause;  // the first operation in trouble
    std::array<double, 3> where{};
    bool came_near = false; // no cell about `where` that can be told from it has a bound
    bool each_side = false; // … but each way of the choices in it has one, by itself
    std::array<double, 3> side_a{}, side_b{}; // of a jump: two near points and the values there
    double value_a = 0, value_b = 0;
    bool known_sides = false; // there are such points
    bool seen_jump = false;   // they differ as much however near they are taken
    bool held_params = false; // they were tried with params in the middle of their ranges
    bool held_time = false;   // … with the time at its begin
    std::size_t evaluations = 0;
};

FieldBound bound_field(Flattening &context, const Ranges &ranges, NodeId field,
                       const Domain &domain, const Budget &budget);

// An upper bound of |value| over the domain.
double bound_magnitude(Flattening &context, const Ranges &ranges, NodeId scalar,
                       const Domain &domain, const Budget &budget);

// All components of an expression that reads no point (or reads it over `cell`).
std::array<Interval, 16> range_of(Flattening &context, const Ranges &ranges, NodeId expression,
                                  const Cell &cell = {});

// The axis' smallest known period of a field, 0 where it is not known to have one; `reads` is false
// where the field does not depend on that coordinate at all, and `linear` where it is a multiple of it
// besides what does not, and so as steep wherever that coordinate is.
struct Periods {
    std::array<double, 3> period{};
    std::array<bool, 3> reads{true, true, true}, linear{};
};
Periods periods_of(const Tape &tape, const ir::Graph &graph);

// Where p -> p with these coordinates' signs changed, each component of the field keeps its value
// or changes its sign (then its Jacobian has the same norm there): which, of the first one.
enum class Reflected { Unknown, Same, Negated };
Reflected reflected(const Tape &tape, const std::array<bool, 3> &axes);

// Deterministic points: the same everywhere.
struct Dice {
    std::uint64_t state;
    double next(); // 0 <= x < 1
};

} // namespace fathom::proof
