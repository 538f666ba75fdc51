// Bounds of a field cell by cell of a box, and how far each cell is from its surface at least. By
// counted work. Knows nothing of shapes. Proof: docs/lipschitz.md, 6.
#pragma once

#include "proof/field.h"

namespace fathom::proof {

struct CellAim {
    std::size_t instructions = 250'000; // for all cells
    std::size_t refining = 0;           // for parts of those near the surface
    // Cells pay where `whole` is so many times the slopes seen, and more by what a look-up takes, in
    // operations, beside those of the field.
    double gain = 3, look_up = 0;
    bool bends = true; // second derivatives, too
    int along = 16;    // cells along the longest side at most, at least 4
};

// None where the field is mostly not far less steep than `whole`, its bound over all of the domain,
// whose box has to be bounded.
std::optional<ir::CellBounds> bound_cells(Flattening &context, const Ranges &ranges, NodeId field,
                                          const Domain &domain, double whole, const CellAim &aim);

} // namespace fathom::proof
