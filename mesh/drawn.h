// What samples see of a mesh that its cells are too large for, though nothing of it is undecided.
// Nothing is proved by it; it says what is looked at closer, and what is said to users.
#pragma once

#include "mesh/mesh.h"

namespace fathom::mesh {

struct TooThin {
    enum class Sort : std::uint8_t {
        None,
        Holes,  // walls or gaps in many cells are thinner than these: they may have holes
        Gaps,   // parts that are apart may be drawn as one
        Pieces, // one part may be drawn as several pieces
    };
    Sort sort = Sort::None;
    double thickness = 0;      // about
    bool gap = false;          // … of space, in most places
    std::size_t pieces = 0;    // of the mesh; so many may belong to another, or, where not all were
    std::size_t splinters = 0; // looked at, more
    bool more = false;
};
TooThin too_thin_in(const Field &field, const Settings &settings, const Made &made);

// Cells across what is thin that show it for sure.
inline constexpr double cells_across = 1.5;

} // namespace fathom::mesh
