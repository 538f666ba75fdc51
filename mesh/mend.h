// A mesh that is made again, finer, where its certificate leaves something undecided.
#pragma once

#include "mesh/certify.h"

namespace fathom::mesh {

struct Mended {
    Made made;
    Certificate certificate; // of it
    int rounds = 0;          // so often it was made again
};

// Divides cells that the certificate leaves undecided, and those with places that it leaves unproved,
// and makes the mesh and its certificate again, until all is decided, cells are 1,024 times smaller than
// those that the surface is drawn by, or to divide them so far would make the octree grow by more
// than half a million nodes, and more than it was large; or until a round changes nothing, or little
// where some doubt is out of reach (docs/meshes.md, 6). What is undecided then is listed.
// Walls and gaps thinner than cells are drawn wider first (widen.h). `settings.deeper` is set here.
Mended make_certified_mesh(const ir::Scene &scene, Settings settings);

} // namespace fathom::mesh
