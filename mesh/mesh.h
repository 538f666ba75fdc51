// A scene's surface as a mesh of triangles that is closed, oriented, a 2-manifold, and does not
// cross itself: manifold dual contouring on an octree (Ju, Losasso, Schaefer and Warren 2002;
// Schaefer, Ju and Warren 2007) with the vertices on edges and faces that keep polygons apart (Ju
// and Udeshi 2006). The argument: docs/meshes.md. Opens no file and prints nothing.
#pragma once

#include "mesh/polygons.h"

namespace fathom::mesh {

struct Settings {
    double side = 0;      // of a cell that the surface is drawn by, at most; or
    int resolution = 128; // cells along the longest side of the solid's box, where `side` is 0
    int extra = 3;        // levels below, where something may be hidden between corners
    int deeper = 0;       // levels below these, for mending (mend.h)
    double time = 0;      // seconds
    std::optional<ir::Box> bounds;             // the solid is cut off at it
    unsigned threads = 0;                      // 0: as many as the machine has cores
    std::function<bool(double done)> progress; // as Progress::report
};

unsigned threads_of(const Settings &settings); // at least 1

// Why there is no mesh.
enum class Failure : std::uint8_t {
    None,
    Cancelled,
    Empty,       // no point lies in the solid
    Outside,     // … of those in the bounds
    Unseen,      // something may lie in it, but no corner of the finest cells
    Flat,        // nothing lies in it but sheets without thickness, where its parts only touch
    Endless,     // no box holds the solid
    Unbounded,   // none was found by the work that is spent on it
    TooFine,     // more than 8,192 cells a side, or floats cannot tell such cells apart
    TooMany,     // cells or triangles than can be counted
    Contradicted // signs are not as was proved
};

struct Made {
    Failure failure = Failure::None;
    Point place{}; // of Contradicted: about there
    Mesh mesh;
    double simplified = 0; // the mesh was simplified by this tolerance (simplify.h)
    double widened = 0; // … or is that of the solid grown by this, moved to the surface (widen.h);
                        // negative: shrunk
    Octree octree;      // what the mesh was made of
    Loops loops;
    std::vector<Point> roots;      // by crossing: where the surface crosses the edge,
    std::vector<float> root_slack; // … no farther from there than this
    ir::Box box;                   // that holds the solid
};

// A box that holds the solid as it is cut off, or why there is none.
Failure box_of(const ir::Scene &scene, const Settings &settings, ir::Box &box);

// Where it has walls or gaps thinner than cells it is drawn wider (widen.h), if that is certified.
Made make_mesh(const ir::Scene &scene, const Settings &settings);
// As its cells show it.
Made make_plain_mesh(const ir::Scene &scene, const Settings &settings);
// Of a field whose solid lies in a box, by cells of `settings.side`; nothing is searched for that no
// corner shows.
Made make_mesh_of(const Field &field, const ir::Box &box, const Settings &settings,
                  Progress &progress);

// From an octree to the rest of what is made: divides its tangled cells, which are added to `divided`,
// as long as it has no more nodes than `most`. The phases of the progress are up to where it ends.
Failure finish_mesh(Made &made, const Field &field, const Settings &settings, std::size_t most,
                    std::vector<Cell> &divided, Progress &progress);

} // namespace fathom::mesh
