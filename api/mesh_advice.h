// What is said beside a mesh: of walls, gaps and edges that its cells are too large for.
#pragma once

#include "mesh/certify.h"

#include <string>
#include <vector>

namespace fathom::v1 {

// What would show what lies in some cells, by samples of it: a sentence's end.
std::string advice_of(const ir::Scene &scene, const fathom::mesh::Settings &settings,
                      const fathom::mesh::Made &made, const std::vector<fathom::mesh::Cell> &cells);

// The same of cells that are drawn: where walls or gaps in many of them are thinner than they are,
// where parts that are apart may be drawn as one, and where one part may be drawn as several pieces.
// Empty: of nothing.
std::string advice_on_drawn(const ir::Scene &scene, const fathom::mesh::Settings &settings,
                            const fathom::mesh::Made &made);

// Where cells of half the side show another shape.
std::string advice_on_shape(const fathom::mesh::Made &made, const fathom::mesh::Form &finer);

} // namespace fathom::v1
