// Distances to the points of a lattice, written with `floor`, `ceil`, `round`, `fract` or `%` and
// numbers: x - m*(floor((x + c)/m) + d), by component. Found on the nodes as written.
#pragma once

#include "ir/graph.h"

#include <array>
#include <optional>
#include <utility>
#include <vector>

namespace fathom::proof {

using Numbers = std::array<double, 4>;

// A sum's terms but for its numbers, with their signs, in order.
using SignedTerms = std::vector<std::pair<ir::NodeId, double>>;

// By component: w(base + at) + beyond, with w(x) = x - m*round(x/m), or m/2 for -m/2 and the other
// way round. `beyond` is 0 where the borders are midway between the lattice's points.
struct Lattice {
    ir::NodeId node;
    std::array<SignedTerms, 4> base;
    Numbers period{}, at{}, beyond{};
};
std::optional<Lattice> lattice(ir::Graph &graph, ir::NodeId id);

// base + at, and the period, as nodes.
ir::NodeId place_of(ir::Graph &graph, const Lattice &lattice);
ir::NodeId period_of(ir::Graph &graph, const Lattice &lattice);

// Is the one half a period, and whole ones, beside the other, the borders of both midway?
bool is_half_beside(const Lattice &a, const Lattice &b, int components);

// Of a choice by which of two vectors is the shorter, one of them a lattice's distance with borders
// that are not midway: the same choice with borders midway, where it does not see the difference
// (docs/lipschitz.md, 2.38); else nothing.
std::optional<ir::NodeId> with_borders_midway(ir::Graph &graph, ir::NodeId choice);

} // namespace fathom::proof
