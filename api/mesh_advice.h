// What is said beside a mesh: of walls, gaps and edges that its cells are too large for.
#pragma once

#include "mesh/certify.h"

#include <string>
#include <vector>

namespace fathom::v1 {

// What would show what lies in some cells, by samples of it: a sentence's end.
std::string advice_of(const ir::Scene &scene, const fathom::mesh::Settings &settings,
                      const fathom::mesh::Made &made, const std::vector<fathom::mesh::Cell> &cells);

// Why it is not proved that the solid has the mesh's pieces and handles, or of its area that there is
// an upper end, and what to write. Empty: it is.
std::string why_shape_is_open(const fathom::mesh::Made &made,
                              const fathom::mesh::Certificate &certificate);
std::string why_area_is_open(const fathom::mesh::Certificate &certificate);

// The same of cells that are drawn: where walls or gaps in many of them are thinner than they are,
// where parts that are apart may be drawn as one, and where one part may be drawn as several pieces.
// Empty: of nothing. `seen`: what samples saw of them, where they were asked before.
std::string advice_on_drawn(const ir::Scene &scene, const fathom::mesh::Settings &settings,
                            const fathom::mesh::Made &made,
                            const std::optional<fathom::mesh::TooThin> &seen);

// Where cells of half the side show another shape.
std::string advice_on_shape(const fathom::mesh::Made &made, const fathom::mesh::Form &finer);

} // namespace fathom::v1
