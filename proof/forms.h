// Expressions whose smoothness only shows in combination: a centred wave, a square root of squares,
// the distance to a corner. Each function says whether a node is one, and of what. Knows nothing of
// tapes.
#pragma once

#include "ir/graph.h"

#include <optional>
#include <vector>

namespace fathom::proof {

using ir::NodeId;
using ir::Op;

// The number that all components of a constant are.
std::optional<double> number(ir::Graph &graph, NodeId id);

// x and m where the node is x % m - m/2, fract(x) - 1/2, or x - m*round(x/m).
struct WaveParts {
    NodeId x, m;
};
std::optional<WaveParts> wave(ir::Graph &graph, NodeId id);

// x, m, lo and hi of x - m*clamp(round(x/m), lo, hi), lo and hi whole numbers.
struct HeldWaveParts {
    NodeId x, m, lo, hi;
};
std::optional<HeldWaveParts> held_wave(ir::Graph &graph, NodeId id);

// k*fract(x) - k/2 as k*(fract(x) - 1/2).
std::optional<NodeId> scaled_wave(ir::Graph &graph, NodeId id);

// The parts of (x^n + y^n + …)^(1/n), n >= 1: n is even, or each part a size |x|. n may be a param,
// of which only its range says whether it is at least 1.
struct PNormParts {
    std::vector<NodeId> parts;
    NodeId power;
};
std::optional<PNormParts> p_norm(ir::Graph &graph, NodeId id);

// v of |max(v, 0)| + min(max of all components of v, 0), as everyone writes a box.
std::optional<NodeId> corner(ir::Graph &graph, NodeId id);

// |max(v, 0)| + min(greatest of v + c, c) as corner(v) + c, and max(c, least of c - v) -
// |max(v, 0)| as c - corner(v): round edges of intersections and unions.
std::optional<NodeId> round_edge(ir::Graph &graph, NodeId id);

// u*u*(3 - 2*u) as smoothstep(0, 1, u), of a u that is in 0..1 by its making.
std::optional<NodeId> hermite(ir::Graph &graph, NodeId id);

// x and c of x*|x|^c, c > 0, whose slope (c + 1)*|x|^c is finite at 0 where that of |x|^c is not.
struct OddPowerParts {
    NodeId x, exponent;
};
std::optional<OddPowerParts> odd_power(ir::Graph &graph, NodeId id);

} // namespace fathom::proof
