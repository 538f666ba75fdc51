// Where a plane cuts a solid: closed contours that do not cross, on a lattice of squares in the plane
// (docs/slices.md). Opens no file and prints nothing.
#pragma once

#include "mesh/measure.h"

namespace fathom::mesh {

using Flat = std::array<float, 2>; // a point of the plane

// Closed lines, without their first point again. The solid is on the left: outlines go
// counterclockwise, holes clockwise.
using Contours = std::vector<std::vector<Flat>>;

struct Rectangle {
    Flat lo{}, hi{};
};

// The plane is seen from where the coordinate is greater. Of axis 2 (z) its points are (x, y), of
// axis 1 (x, -z), of axis 0 (-z, y).
struct Section {
    Failure failure = Failure::None;
    Point place{}; // of Contradicted
    Contours contours;
    // Every point of the contours has the section's border as near as this; every point of that in
    // the squares that are not undecided has a contour as near as that. At most a square's side.
    double to_section = 0, to_contour = 0;
    double side = 0;                  // of the squares
    std::vector<Rectangle> undecided; // squares that may hold a border farther from the contours
    Enclosure area;                   // of the section
    bool used_bound = false;
};

// A solid that is cut many times.
struct Cut {
    Cut(const ir::Scene &scene, const Settings &settings, const ir::Box &solid_box);
    const Field field;
    ir::Box box;      // of the solid
    double side = 0;  // of the squares, at most
    int halvings = 3; // of the side, where squares stay undecided
};

Section section(const Cut &cut, std::size_t axis, float at);

// A box's outline in a plane.
Rectangle outline_of(const ir::Box &box, std::size_t axis);

} // namespace fathom::mesh
