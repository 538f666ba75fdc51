// Each solid of the library once more, as a question: is this point inside? Written from what docs
// say the solid is, in double, with no distance functions where another way is at hand. Knows
// nothing of the library's text.
#pragma once

#include "field.h"

namespace fathom::test {

struct Solid {
    std::string text; // a scene of one library call
    Inside inside;
    double reach = 1.5;   // all of the solid lies within this cube's half side, with room
    bool exact = false;   // the field claims to be the distance
    bool endless = false; // the surface goes on beyond `reach`
};

std::vector<Solid> round_solids();
std::vector<Solid> straight_solids();
std::vector<Solid> flat_solids();
std::vector<Solid> combined_solids();
std::vector<Solid> transformed_solids();

// -- parts of definitions
constexpr double pi = 3.14159265358979323846;
bool in_box(Point p, double x, double y, double z); // of these sides, about the origin
double to_segment(Point p, Point a, Point b);
bool in_convex(Point p, const std::vector<Point> &corners,
               const std::vector<Point> &normals); // below each normal's farthest corner
bool in_polygon(double x, double y,
                const std::vector<std::array<double, 2>> &corners); // by the winding of angles

} // namespace fathom::test
