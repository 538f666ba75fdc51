// Meshes of walls and gaps thinner than cells: no corner of a cell lies in such a wall, but the solid
// grown by most of a cell shows it whole, and the vertices of that one's mesh are moved to the surface
// (docs/meshes.md, 12).
#pragma once

#include "mesh/certify.h"

#include <span>

namespace fathom::mesh {

// How much of a mesh is in doubt.
struct Doubt {
    std::uint64_t volume = 0; // of cells, in those of the finest level
    std::size_t places = 0;   // of the mesh
    friend auto operator<=>(const Doubt &, const Doubt &) = default;
};
Doubt doubt_of(const Made &made, const Certificate &certificate);

struct Wider {
    Made
        made; // the same octree, with another mesh: no vertex of it belongs to a cell by its number
    Certificate certificate; // of it
};

// What is thin, by samples.
struct ThinWalls {
    double thickness = 0; // about; 0: nothing
    bool gaps = false;    // it is gaps
};

// What is proved of such a mesh.
enum class Proof {
    Distances,   // that both are small enough, and nothing else; it is left out where they are not
    Certificate, // all, where they are; else it is left out
    AllOfBest,   // all of each mesh, also of those of which some is in doubt
};

// Where many cells are undecided, and most of what is in them are walls, or gaps, by samples: the mesh
// that is drawn so, by cells that are up to four times smaller if need be, by `Distances` at most two;
// the first that is certified, else the one with least in doubt. None: there are no such walls, or no
// such mesh was made.
// Its shape is doubted where cells of half the side, or of twice the side, show other pieces and handles.
std::optional<Wider> draw_wider(const ir::Scene &scene, const Field &field,
                                const Settings &settings, const Made &made,
                                std::span<const Cell> cells, Proof proof, Progress &progress);
// The same where it is known what is thin.
std::optional<Wider> draw_wider(const ir::Scene &scene, const Field &field,
                                const Settings &settings, const Made &made, const ThinWalls &walls,
                                Proof proof, Progress &progress);

} // namespace fathom::mesh
