// A mesh's triangles as the proof of its shape asks of them (docs/meshes.md, 13).
#pragma once

#include "mesh/certify.h"
#include "mesh/nearest.h"

#include <optional>
#include <span>

namespace fathom::mesh {

inline constexpr double by_rounding = 1e-9; // of a length

struct Facet {
    Triangle3 at{};
    Real3 normal{};   // of length 1
    Real3 lo{}, hi{}; // of the box about it
};
Facet facet_of(const Mesh &mesh, const std::array<std::uint32_t, 3> &triangle);

// Whether a triangle and a box may have a point in common: no axis across which both lie apart.
bool may_touch(const Triangle3 &t, const Real3 &middle, const Real3 &half);
std::optional<Real3> unit_of(const Real3 &way);
// A way that goes along as many directions of length 1 as can be, by turns towards the one that it goes
// along worst.
std::optional<Real3> way_along(std::span<const Real3> directions);
// Whether a way from one point to another crosses a triangle; none where it comes near to its sides.
std::optional<bool> crosses(const Real3 &from, const Real3 &to, const Triangle3 &t);

} // namespace fathom::mesh
