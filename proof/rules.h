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
    Count
};

// factor[r] multiplies what rule r adds to 1 (a factor's excess over 1, or a sum's second term); 1
// is the truth.
struct Rules {
    std::array<double, static_cast<std::size_t>(Rule::Count)> factor;
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
