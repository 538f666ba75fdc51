// A field expression, flattened for repeated interval evaluation: calls entered, loops kept as
// blocks, forms whose smoothness only shows in combination (a square root of squares, a centred
// wave, sin(x)/x) made one instruction. Knows nothing of regions or shapes.
#pragma once

#include "ir/graph.h"
#include "ir/interval.h"
#include "proof/carried.h"
#include "proof/interpolation.h"
#include "proof/pieces.h"
#include "proof/work.h"

#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace fathom::proof {

using ir::Interval;
using ir::NodeId;
using ir::Op;

// What an instruction computes where it is not its op's plain meaning.
enum class Form : std::uint8_t {
    Plain,
    Wave, // x - m*round(x/m): jumps, but only from m/2 to -m/2, which an even function does not see
    Sinc, // sin(x)/x, 1 at 0
    Hyperbolic, // x/tanh(x), 1 at 0
    Norm,       // the length of all arguments' components together
    Corner,     // |max(v, 0)| + min(greatest of v, 0): the distance to a corner, 1-Lipschitz in v
    Square,     // x*x, never negative
    OddPower, // x*|x|^c, c > 0, whose slope (c + 1)*|x|^c is finite at 0 where that of |x|^c is not
    Smooth,   // smooth_extremum: of x, y, k; payload: 1 greater + 2 divides + 4 clipped
    LogSum,   // log(exp(a) + exp(b)); the op says of which base
    PNorm,    // (sum of |x|^n)^(1/n) of all arguments' components but the last, which is n
    HeldWave, // x - m*clamp(round(x/m), lo, hi), lo and hi whole: a Wave where the clamp is not
    Joined,   // a Select whose arms were proved to agree on the border
    Opposite, // a Select whose arms were proved to be each other's negatives there
    Loop,
};

using Slot = std::uint32_t; // a value: components(type) numbers at Tape::first[slot]

// A scalar whose gradient is t by_a grad a + (1 - t) by_b grad b, with t in 0..1 or no further
// beyond (means.h). Id: of a node, or of its slot.
template <class Id> struct MeanOf {
    Id a{}, b{};
    double by_a = 1, by_b = 1, beyond = 0;
    double reach = 0; // the sizes of a and b up to which it is proved
};
using Mean = MeanOf<NodeId>;

struct Instruction {
    Op op = Op::Const;
    Form form = Form::Plain;
    ir::Type type = ir::Type::Float;
    bool varies = false;  // with the point
    bool stepped = false; // an angle that steps alone read (polar.h)
    // Of a Fract or Mod: single precision may have its argument so wrong that it is any (exact.h).
    bool scatters = false;
    bool whole = false; // a Mod of whole numbers by a power of two from 1 on; a Hash of a turn
    bool wavers =
        false; // it reads a number that is not the same one twice for rounding (steadiness.h)
    bool has_majorant = false; // a quotient whose divisor is scaled as it is (majorants.h)
    bool cancels = false;      // a step whose jumps the result does not see (discontinuities.h)
    bool divides = false;      // a Normalize that is v / length(v), which is no number at 0
    Slot out = 0;
    std::vector<Slot> args;
    std::uint32_t payload = 0; // the op's; of a Loop: index into Tape::loops
    std::uint32_t groups = 0;  // of a Make, Norm, Mix or sum: Supports::groups of its arguments
    // Of a vector that is M v + c (linear_maps.h, segments.h): v, then what M and c are made of.
    std::vector<Slot> turned;
    // … and of a matrix product: a bound of the matrix' norm, whatever its numbers are.
    double norm = ir::rounding::infinity;
    // Of a vector M(angle) v + c, where the angle varies (linear_maps.h): bounds of the norms of M and
    // of dM/d angle, and the components of v that the latter takes (`moving`).
    struct Turning {
        enum class Way : std::uint8_t {
            Any,
            Apart, // the angle's gradient is at right angles to those of what M takes of v
            Shear, // … of what moves, v has a multiple of an orthogonal Jacobian, and M is one
        };
        Slot vector = 0, angle = 0;
        double norm = 1, by = 1;
        unsigned moving = 0;
        Way way = Way::Any;
    };
    std::optional<Turning> turning;
    std::optional<MeanOf<Slot>> mean; // of a scalar
    // Of a product that turns about an axis (around.h): it is no steeper than `by` times `vector`,
    // and the size of `vanishing` times `rest_by` times `rest`, where that is not 0.
    struct AroundAxis {
        Slot vector = 0;
        double by = 1;
        Slot vanishing = 0, rest = 0;
        double rest_by = 0;
    };
    std::optional<AroundAxis> around;
    // Of a sum of such a product and what is the same all around the axis (around.h): no steeper than
    // `still` and `radial`, and `across` at right angles to these, and what `rest` adds.
    struct BesideTurn {
        Slot still = 0;
        double radial = 0, across = 0;
        Slot vanishing = 0, rest = 0;
        double rest_by = 0;
    };
    std::optional<BesideTurn> beside_turn;
    // Of a product that is along a vector (radial.h): it is no steeper than the factor's size times
    // the vector, or than the vector by that size.
    struct Along {
        Slot vector = 0, factor = 0;
        bool divides = false;
    };
    std::optional<Along> along;
    // Of an ellipsoid's distance to first order (ellipsoids.h), which is `by` times as large.
    struct EllipsoidOf {
        Slot vector = 0, k0 = 0, k1 = 0;
        std::vector<Slot> inverse;
        double by = 1;
    };
    std::optional<EllipsoidOf> ellipsoid;
    // Of a scalar between values at the corners of a cell (interpolation.h): it is no steeper than
    // `by` times the width of their range times `vector`.
    struct Between {
        Slot vector = 0;
        std::vector<Slot> corners;
        double by = 1;
    };
    std::optional<Between> between;
    // Of a product that is by component a polynomial of one number, the lowest power first.
    struct Univariate {
        Slot of = 0;
        std::vector<double> by;
    };
    std::optional<Univariate> univariate;
    struct FromAxis {
        Slot vector = 0, length = 0;
    };
    std::optional<FromAxis> from_axis; // of the angle between a vector and an axis (polar.h)
    std::optional<double> stands_at;   // its value, whatever the argument's: an angle's (winding.h)
    // Of a power: what its exponent is of a number that is the same for all points, but not known.
    struct Exponent {
        Slot of = 0;
        bool negative = false, inverse = false; // -k, 1/k
    };
    std::optional<Exponent> exponent;
    // Of x y/(x + y), x y z/(x y + y z + z x), …: x, y, …; it is `parallel_by` times the inverse of the
    // sum of their inverses.
    std::vector<Slot> parallel;
    double parallel_by = 1;
    NodeId node;
};

// Evaluators add up the squares of its arguments.
inline bool squares_arguments(const Instruction &in) {
    return in.form == Form::Norm || in.form == Form::Corner || in.op == Op::Length ||
           in.op == Op::Normalize;
}

struct Loop {
    std::vector<Instruction> body;
    std::vector<Slot> vars, start, next, scratch, ends; // `ends`: the values that the loop hands on
    Slot index = 0, count = 0, condition = 0;
    bool has_condition = false, condition_varies = false;
    int most = 0; // turns
};

struct Tape {
    std::vector<Instruction> once; // does not vary with the point
    std::vector<Instruction> each;
    std::vector<Loop> loops;
    std::vector<std::uint32_t> first; // by slot: its first component
    std::vector<std::uint8_t> size;   // by slot: how many
    std::uint32_t components = 0;
    Slot result = 0;
    bool grows = false; // some values may leave single precision
    bool near = false;  // what cancels does so where no coordinate is above `near_enough` alone
    bool has_majorants = false; // some instruction has one
    bool too_large = false;     // the field was cut off while flattening; nothing may be concluded
    std::optional<int> winds_about; // an axis: seen from coordinates that turn about it (winding.h)
    std::size_t length() const;
};

constexpr double near_enough = 1000; // coordinates up to which some proofs hold (on_line.h)

// Choices whose turning a field is proved not to see (borders.h).
struct Meeting {
    std::unordered_set<NodeId> choices;
    bool near = false; // where no coordinate is above `near_enough` alone (on_line.h)
    Apart moved{};     // what the field jumps by at most all the same, up to each distance
};

class BoundCache;
struct Ranges;

// Border questions: is this Select continuous (continuity.h)? Answered once a Select that varies.
struct Flattening {
    ir::Graph &graph;
    Work &work;
    std::unordered_map<NodeId, bool> joined{}; // by Select, remembered over fields
    bool borders =
        true; // is each choice tested for whether the field changes there? Slopes depend on it
    // By field: the choices at which it does not change (borders.h), found once a field.
    std::unordered_map<NodeId, Meeting> meeting{};
    std::unordered_map<NodeId, std::optional<Pieces>> pieces{}; // by node, remembered over fields
    // By field: the same with its loops written out, where borders in their bodies have to be seen.
    std::unordered_map<NodeId, NodeId> written{};
    std::vector<bool> cached{}; // by cached field: known by its bounds alone (Ranges::caches)
    std::unordered_map<NodeId, std::optional<Mean>> means{}; // by node, remembered over fields
    SteepnessOfWeights weights{};                            // of what is interpolated
    const Ranges *ranges = nullptr; // of all that the fields read, or none: then no mean is found
    BoundCache *cache = nullptr;    // of answers to whole questions (question.h), or none
};

struct Cell;
// For the points of `region`, if one is given: then fewer jumps are seen by the field.
Tape flatten(Flattening &context, NodeId root, const Cell *region = nullptr);
// … as seen from coordinates that turn about an axis, where it can be (Tape::winds_about).
Tape flatten_unwound(Flattening &context, NodeId root);

} // namespace fathom::proof
