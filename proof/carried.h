// How far a field is moved by what a proof at a border grants: that a value's two sides count as equal
// though they differ a little, as constants that people write with 7 digits make them (docs/lipschitz.md,
// 2.42). Values are enclosed in boxes about the origin; what decides by a moved number may move by all.
#pragma once

#include "ir/graph.h"

namespace fathom::proof {

struct Ranges;
struct Work;

// What a border's proof has granted: the sides of `at` differ by `apart` at most, or, where that is
// 0, by `granted_to_sides` of the value.
struct Granted {
    ir::NodeId at;
    double apart = 0;
};

// Of the lesser of both sides, as in all that single precision evaluates: constants are floats.
constexpr double granted_to_sides = 5e-7;
// What rounding of double precision alone makes, which is not counted.
constexpr double granted_to_doubles = 1e-12;

enum class Carried { Nowhere, Near, Everywhere };
// Up to which distance is the field moved by no more than what would be granted to itself?
Carried is_carried(const ir::Graph &graph, ir::NodeId field, const Granted &granted,
                   const Ranges *ranges, Work &work);

} // namespace fathom::proof
