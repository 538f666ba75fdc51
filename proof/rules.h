// The constants of lipschitz.md as functions of plain numbers, each rounded up; and the table by
// which tests weaken a rule to see that it is needed.
#pragma once

#include <array>
#include <cstddef>

namespace fathom::proof {

enum class Rule : std::size_t {
    Twist,
    Bend,
    Taper,
    Distort,
    Displace,
    LerpVarying,
    LerpWeights,
    BlendRadius,
    Columns,
    Pipe,
    PseudoNorm,
    Field,
    Holes,
    RepeatNeighbors,
    Sectors,
    Tightened,
    Octaves,
    Shell,
    Round,
    Detour,
    Curvature,
    FarProduct, // of endless cells (lipschitz.md, 2.34): what the second factor's slope adds
    FarQuotient,
    FarPower,
    FarSum,
    FarDifference,
    FarExponential,
    FarLogarithm,
    FarFunction,
    FarMean,
    FarLength,
    FarChoice,
    Linear,       // of expressions: a vector that is M v + c (2, 2.7, 2.13, 2.47)
    Raised,       // powers of what is Lipschitz, and a number (2.31, 2.40)
    Relative,     // what grows as itself (2.16)
    Turning,      // vectors that turn as they move (2.21)
    Mean,         // what moves along with two numbers (2.18)
    AroundAxis,   // what vanishes on an axis about which it turns (2.19)
    BesideTurn,   // … beside what is the same all around
    Between,      // numbers interpolated on a lattice (2.20)
    Along,        // vectors along themselves (2.25)
    Univariate,   // polynomials of one number (2.27)
    AxisAngle,    // angles to an axis (2.35)
    Triangle,     // triangle waves (2)
    Majorant,     // what is divided by a scale that is carried along (2.45)
    Ellipsoid,    // ellipsoids to first order (2.46)
    Ways,         // bounds by ways (2.6)
    Composed,     // fields of what is moved, turned or folded (2.28)
    Rays,         // fields that grow along each ray alike (2.48)
    TwoGradients, // of a sum or a product, by the angle between them (2.49)
    Count
};

// factor[r] multiplies what rule r adds to 1 (a factor's excess over 1, or a sum's second term), or
// of a rule of expressions the norm that it finds; 1 is the truth. Likewise the norms of one op, or
// of one form (tape.h), where they are not negative.
struct Rules {
    std::array<double, static_cast<std::size_t>(Rule::Count)> factor;
    struct OfOp {
        int op = -1, form = -1;
        double factor = 1;
    } of_op;
    Rules() { factor.fill(1); }
    double operator[](Rule rule) const { return factor[static_cast<std::size_t>(rule)]; }
};

// The spectral norm of a shear by s: (s + sqrt(s^2 + 4))/2. A twist by rate k of parts with moment_arm
// arm M: sigma(k M).
double sigma(double s);

// The spectral norm of [[1, 0], [b, a]]: what a taper does to a gradient's parts across and along
// the axis.
double lower_triangle_norm(double a, double b);

} // namespace fathom::proof
