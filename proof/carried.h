// How far a field is moved by what a proof at a border grants: that a value's two sides count as equal
// though they differ a little, as constants that people write with 7 digits make them (docs/lipschitz.md,
// 2.42). Values are enclosed in boxes about the origin; what decides by a moved number may move by all.
#pragma once

#include "ir/graph.h"
#include "proof/enclosed.h"

#include <array>

namespace fathom::proof {

struct Ranges;
struct Work;

// Of the lesser of both sides, as in all that single precision evaluates: constants are floats.
constexpr double granted_to_sides = 5e-7;
// What rounding of double precision alone makes, which is not counted.
constexpr double granted_to_doubles = 1e-12;
// Of a number of more digits than single precision keeps exactly, as people write those with 6 digits.
constexpr double written_of_numbers = 1e-6;
// What that may make of a value up to there.
inline double most_written_at(double distance) { return 3.2e-5 * std::max(1.0, distance); }

// What sides that count as equal differ by at most, up to each distance (distance_at).
using Apart = std::array<double, far_scale - least_scale + 1>;
// Is that a tenth of what a ray ends at, or less, in a picture of all of the region (docs/trusted.md, 2)?
// Where it has no end, in pictures of all that is so far.
bool is_unseen(const Apart &apart, const std::array<Interval, 3> *region);
// What a border's proof has granted: the sides of `at` differ by `apart` at most, or, if `beside`, by
// `granted_to_sides` of the value.
struct Granted {
    ir::NodeId at;
    bool beside = true;
    Apart apart{};
};

// What a value is off at most in a box where its numbers are, by as much as people leave off when they
// write them (`written_of_numbers`), while no choice and no step turns.
double written_off(const ir::Graph &graph, ir::NodeId value, Enclosed values, Work &work);

enum class Carried { Nowhere, Near, Everywhere };
// Up to which distance is the field moved by no more than what would be granted to itself? `moved`: by
// how much is it moved by what is known to differ by so much, at least what it is already.
Carried is_carried(const ir::Graph &graph, ir::NodeId field, const Granted &granted,
                   const Ranges *ranges, Work &work, Apart &moved);

} // namespace fathom::proof
