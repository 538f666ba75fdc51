// What is proved of a mesh: how far it and the surface are apart at most, each from the other, in
// how many pieces it is, and what volume the solid has (docs/meshes.md, 6).
#pragma once

#include "mesh/drawn.h"
#include "mesh/grid.h"
#include "mesh/measure.h"
#include "mesh/slopes.h"

#include <limits>
#include <optional>

namespace fathom::mesh {

// A piece of a triangle without surface found near it: its middle, and that of the triangle.
struct Unproved {
    Point at{};
    Real3 triangle{};
};

// In how many pieces a closed mesh is, and how many handles they have.
struct Form {
    std::size_t components = 0;
    long genus = 0;
    bool operator==(const Form &) const = default;
};
// What was proved of the shape in the leaves of one of an octree's tasks, and measured on the way.
struct ShapeOfTask {
    std::int32_t task = none;
    Enclosure area, volume;
    double whole = 0; // the leaves' own volume
};
// Whether a mesh has the pieces and handles of the solid.
struct ShapeAnswer {
    bool proved = false;
    std::size_t open = 0; // leaves; 0 where it was not looked for
    Real3 place{};        // one of them
    // Of these, those of which no slopes are known, and why that is about the place; …
    std::size_t unknown = 0;
    std::optional<Unknown> why{};
    std::size_t unseen = 0;  // … and those that were not looked at,
    bool dear = false;       // … as too much work
    std::vector<Cell> cells; // of these leaves those that smaller ones may tell of
    std::vector<ShapeOfTask> proved_tasks;
    // Samples see walls, gaps or edges that cells are too large for: it may have others.
    bool doubted = false;
    std::optional<Form> finer;   // … or cells of half the side show others
    std::optional<TooThin> thin; // what they see, where they were asked
    // Where it is proved, what the surface and the solid measure by the same directions.
    Enclosure area, volume;
};
struct Certificate {
    // Every point of the mesh has surface as near as this, and every point of the surface in the
    // cells that are not undecided has mesh as near as that. At most the side of a drawing cell.
    double mesh_to_surface = 0, surface_to_mesh = 0;
    std::vector<Cell> undecided; // leaves that may hold surface farther from the mesh,
    std::vector<Point> doubts;   // … about there
    // Leaves with places where parts of the solid touch, or are no farther apart than this along an
    // axis: what surface there is between them is not drawn.
    std::vector<Cell> seams;
    double seam_width = 0;
    std::vector<std::int32_t> empty; // leaves, by their nodes, in which no surface is
    std::vector<Unproved> unproved;
    std::size_t components = 0;                  // of the mesh
    long genus = 0;                              // of all of them together
    double least_volume = 0, largest_volume = 0; // the solid's lies between them
    // So does the surface's area, by `enclose_measures`; there is no upper end where in so many boxes,
    // one of them about there, it is not known how the surface runs.
    Enclosure area{0, std::numeric_limits<double>::infinity()};
    std::size_t open_places = 0;
    Real3 open_place{};
    bool looked_for_area = true; // for its upper end; else that would take too much
    double mesh_volume = 0, mesh_area = 0;
    ShapeAnswer shape; // by `prove_shape`
    // Whether the proofs used the proved bound, besides intervals.
    bool used_bound = false;
    std::size_t divisions = 0; // of boxes, that this took: counted work
    bool near() const { return undecided.empty() && unproved.empty(); } // both distances hold
    bool certified() const { return near() && !shape.doubted; }
};

// The volume of what is undecided, in cells of the finest level.
std::uint64_t volume_in_doubt(const Certificate &certificate, const Lattice &lattice);

Form form_of(const Mesh &mesh); // closed

// A certificate of the mesh before some of its cells were divided.
struct Earlier {
    const Certificate &certificate;
    const Region &changed; // the cells that were divided since
};

// Of a mesh of that field and those settings; where there is an earlier certificate, only what has
// changed since is proved again.
Certificate certify(const Field &field, const Settings &settings, const Made &made,
                    const Earlier *earlier, Progress &progress);
// The same where all of the mesh is near the surface, and all of that near the mesh; the work ends at
// the first place of which that is not proved.
std::optional<Certificate> certify_if_near(const Field &field, const Settings &settings,
                                           const Made &made, Progress &progress);
// Of a mesh of that scene and those settings.
Certificate certify(const ir::Scene &scene, const Settings &settings, const Made &made,
                    Progress &progress);

// Narrows the volume, and encloses the area, as `measure` does, with a small part of its work.
void enclose_measures(const ir::Scene &scene, const Settings &settings, const Made &made,
                      Progress &progress, Certificate &certificate);

} // namespace fathom::mesh
