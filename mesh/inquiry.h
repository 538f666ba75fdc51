// What the two halves of a certificate share: a mesh, its surface, and what is looked up by its place.
#pragma once

#include "mesh/certify.h"
#include "mesh/grid.h"
#include "mesh/nearest.h"

#include <atomic>
#include <optional>

namespace fathom::mesh {

inline constexpr double outward = 1 + 1e-9; // what rounding in double precision may take

// All that the pieces of work share.
struct Inquiry {
    const Made &made;
    const Field &field;
    bool trusts;
    double allowed;         // the side of a drawing cell, and what the mesh was simplified by
    bool own;               // the mesh is as its loops made it
    const Earlier *earlier; // or null
    bool all_or_nothing;    // what is found after the first doubt does not matter
    std::vector<Triangle3> triangles{};
    std::optional<TriangleTree> tree{};
    Grid by_root;
    // The triangles at vertex v: at_vertex[first_at[v]] and on, below first_at[v + 1].
    std::vector<std::uint32_t> first_at{}, at_vertex{};
    std::vector<std::pair<std::int32_t, std::uint32_t>> patches{}; // by node, sorted

    mutable std::atomic<bool> doubted{false};

    bool in_vain() const { return all_or_nothing && doubted; }
    bool proved_before(const Real3 &at) const { return earlier && !earlier->changed.beside(at); }
};

// What may be near: first what belongs to the leaf or triangle itself, then, only where that does not
// do, all that is about.
struct Candidates {
    std::vector<std::uint32_t> own, near;
    std::vector<std::uint32_t> vertices; // of the leaf's own patches
    bool found_near = false;
};

// How far surface is from the mesh, into the certificate; and how far the mesh is from the surface.
void certify_surface(const Inquiry &inquiry, unsigned threads, Progress &progress,
                     Certificate &certificate);
void certify_mesh(const Inquiry &inquiry, unsigned threads, Progress &progress,
                  Certificate &certificate);

} // namespace fathom::mesh
