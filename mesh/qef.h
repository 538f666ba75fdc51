// The point that planes meet in, as far as they say: the least sum of squared distances from them
// (Garland and Heckbert 1997; Ju, Losasso, Schaefer and Warren 2002), in a box.
#pragma once

#include <array>
#include <span>

namespace fathom::mesh {

using Vector = std::array<double, 3>;

struct Plane {
    Vector point, normal; // normal: of length 1
};

// The point in the box. Along directions in which the planes say little (normals that turn by less
// than some 6 degrees) it stays at the mean of their points.
Vector meeting_point(std::span<const Plane> planes, const Vector &lo, const Vector &hi);

// On a rectangle: where the third coordinate, `axis`, is what `at` has.
Vector meeting_point_on(std::span<const Plane> planes, std::size_t axis, double at,
                        const Vector &lo, const Vector &hi);

} // namespace fathom::mesh
