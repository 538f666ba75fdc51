// What is known of a shape while the proof runs: its fact, and what only the rules for its parents
// need. And the arithmetic of boxes. Every statement is for all params and times.
#pragma once

#include "ir/scene.h"
#include "proof/field.h"

namespace fathom::proof {

using ir::Box;
using Vec = std::array<Interval, 3>;

// Beside the box: a turn inflates a box and leaves a ball as it is.
struct Ball {
    std::array<double, 3> centre{};
    double radius = ir::rounding::infinity;
    double growth_rate = 0; // {f < t} lies in it grown by growth_rate*t, t >= 0
};

struct Derived {
    ir::ShapeFact fact;
    // A tree of min and max over exact fields, rigidly moved: its value is a part's true distance.
    bool parts_exact = false;
    // The field's gradient is everywhere a convex mean of vectors L*n, n the unit gradient of an
    // exact part whose nearest surface point lies in this box (lipschitz.md, 5.1).
    // Everything: unknown.
    Box parts = Box::everything();
    // {f < t} lies in fact.bounds grown by growth_rate*t, t >= 0; {f > -t} in outer grown by outer_growth_rate*t.
    double growth_rate = 0, outer_growth_rate = 0;
    Box outer = Box::everything();
    Ball ball; // set anew after every rule (balls.cpp)
    // By how much the field may differ from that of a part that makes its gradient: an offset by r
    // moves surfaces, and not what gradients point away from.
    double offset_slack = 0;
    // By how much it may differ from the mean of its parts' values, L times, with the weights that its
    // gradient has: at most offset_slack, and 0 of a mean by a constant.
    double mean_slack = 0;
    double lowered = 0; // outside, an exact field and at most this much (offsets by less than 0)
    // Outside, the field at p is at least f(s) + |p - s| less this much, for a point s of the box:
    // what is drawn apart is flat between its halves, as far as they are apart.
    double short_by = 0;
    NodeId leaf;         // of a field of one's own, that field
    bool failed = false; // reported, here or below
};

void forget_moment_arms(Derived &k); // gradients no longer point from parts in a known box

// The field moves away from its parts' by at most `by`.
void differ_by(Derived &k, double by);

// Of a min of fields: {min < t} is in the hull of the children's; {min > -t} in the meet of theirs.
void unite(Derived &k, const Derived &c);
// Of a mean of fields, as of Lerp: it is below t, or above -t, only where one of them is. So both of
// its boxes are hulls.
void weigh(Derived &k, const Derived &c);
// What every combination of two inherits: the attributes of the gradients.
void inherit(Derived &k, const Derived &c);

inline Box empty_box() { return {}; }
Box from_cell(const Cell &cell, int dims);
Cell to_cell(const Box &box);
Box grow(const Box &box, double by); // outward on all sides; an empty box stays empty
Box grow(const Box &box, const std::array<double, 3> &by);
// What holds {f < t}, t >= 0, of a field whose solid lies in `box` and that swells so.
Box reached(const Box &box, double growth_rate, double t);
// What holds {max(f, g) < t} for all t >= 0, as the boxes grow: their meet, and in axes where they
// are apart the middle between them. Nowhere empty, unless one of them is.
Box meeting(const Box &a, const Box &b);
Box moved(const Box &box, const Vec &by);
Box times(const Box &box, const Vec &by);
Box turned(const Box &box, const std::array<Interval, 16> &matrix, int side); // column-major
bool disjoint(const Box &a, const Box &b);
bool holds(const Box &outer, const Box &inner);
bool everywhere(const Box &box);
double radius_about(const Box &box, int axis); // the largest distance of its points from the axis
double norm_of(const Box &box);                // the largest distance of its points from the origin
Box padded(const Box &box);                    // by the float32 slack

constexpr double slack =
    1e-6; // relative: what float32 evaluation of a proved bound may lose (docs/lipschitz.md, 2)

} // namespace fathom::proof
