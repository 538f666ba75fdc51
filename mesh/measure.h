// What can be enclosed of a solid by cells of space that are in it, out of it, or open: its volume,
// its centre, its box; and of its surface, its area (docs/measure.md, 1 and 2).
#pragma once

#include "mesh/area.h"
#include "mesh/mesh.h"

namespace fathom::mesh {

struct Measures {
    Enclosure volume;
    Enclosure area;              // without an upper end where there are
    std::size_t open_places = 0; // … boxes of which none is known,
    Real3 open_place{};          // the middle of one of them
    bool looked = true;          // for an upper end of the area; else it would take too much
    std::array<Enclosure, 3> center;
    std::array<Enclosure, 3> least, greatest; // the ends of the solid's box
    bool used_bound = false;                  // the proved bound, besides intervals
};

// What measuring may take.
struct MeasureEffort {
    double work = 0.3e9;                           // kernels over boxes: a second or two
    int least_halvings = 2;                        // of each open cell, whatever that takes
    std::size_t spare = 400'000, least_spare = 32; // boxes divided more often: of all, of a cell
    double looks = 1e12; // kernels of all open cells: where they have more no slopes are looked at,
    double in_loops = 6e6; // … or not in the loops of each, by its share of this
};
// Beside a certificate: each open cell as it is, and those at edges as far as few boxes go.
inline constexpr MeasureEffort beside_certificate{0, 0, 4'000, 0, 0.3e6, 0.1e6};

// By the cells of a mesh of that scene and those settings, which are divided further as far as the
// work goes.
Measures measure(const ir::Scene &scene, const Settings &settings, const Made &made,
                 Progress &progress, const MeasureEffort &effort = {});

// The volume and the area of a closed mesh, and the centre of what it bounds.
struct MeshSums {
    double volume = 0, area = 0;
    std::array<double, 3> center{};
};
MeshSums sums_of(const Mesh &mesh);

} // namespace fathom::mesh
