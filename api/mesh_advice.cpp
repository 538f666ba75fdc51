// See mesh_advice.h.
#include "api/mesh_advice.h"

#include "mesh/drawn.h"
#include "mesh/loose.h"
#include "mesh/thin.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace fathom::v1 {
namespace {

// What shows a wall or a gap of a thickness: a sentence's end.
std::string shown_by(double thickness, const fathom::mesh::Lattice &lattice, const ir::Box &solid) {
    const double tolerance = thickness / fathom::mesh::cells_across;
    if (!fathom::mesh::make_lattice(solid, tolerance, 0))
        return ", thinner than the finest cells of any mesh: make it thicker, or leave it out";
    double longest = 0;
    for (std::size_t i = 0; i < 3; ++i) longest = std::max(longest, solid.hi[i] - solid.lo[i]);
    const double now = lattice.side(lattice.level);
    return fmt::format(", and cells have sides of {:.2g}: a tolerance of {:.2g} shows it, or a "
                       "resolution of {:.0f}",
                       now, tolerance, std::ceil(longest / tolerance));
}

// Of how thick something is at some places, from the least: a sharp edge is as thin as one likes
// somewhere; of a wall all places tell its thickness.
double lower_quarter(const std::vector<double> &thick) { return thick[thick.size() / 4]; }

// What decides such cells: a sentence.
std::string advice_on_loose(const fathom::mesh::Field &field, const fathom::mesh::Made &made,
                            const std::vector<fathom::mesh::Cell> &cells) {
    const fathom::mesh::Lattice &lattice = made.octree.lattice;
    const double times = shrunk_to_decide(field, lattice, cells);
    const double side = lattice.side(lattice.level);
    if (times > 1 && fathom::mesh::make_lattice(made.box, side / times, 0))
        return fmt::format(
            "what is proved of the field there decides it in cells {:.0f} times smaller: with a "
            "tolerance of {:.2g}, or a bound nearer to the field's true slope",
            times, side / times);
    return "what is proved of the field there decides it in no cells of a mesh: a bound nearer to "
           "its true slope does, as of shapes in place of a formula, or a part of it by itself";
}

} // namespace

std::string advice_of(const ir::Scene &scene, const fathom::mesh::Settings &settings,
                      const fathom::mesh::Made &made,
                      const std::vector<fathom::mesh::Cell> &cells) {
    fathom::mesh::Progress progress;
    const fathom::mesh::Lattice &lattice = made.octree.lattice;
    std::vector<double> thick;
    std::size_t touch = 0;
    const fathom::mesh::Field field(scene, settings.time, settings.bounds);
    const auto found = thin_in(field, lattice, cells, threads_of(settings), progress);
    for (const fathom::mesh::Thin &thin : found) {
        if (thin.thickness > 0) thick.push_back(thin.thickness);
        touch += thin.touches;
    }
    if (touch > thick.size())
        return "parts of the solid touch there, and rounding leaves open where each ends, which no "
               "finer mesh tells: let them overlap a little, or move them by the same transforms";
    if (thick.empty()) return advice_on_loose(field, made, cells);
    std::ranges::sort(thick);
    return fmt::format("a wall, a gap or a sharp edge there is about {:.2g} thick{}",
                       lower_quarter(thick), shown_by(lower_quarter(thick), lattice, made.box));
}

std::string advice_on_drawn(const ir::Scene &scene, const fathom::mesh::Settings &settings,
                            const fathom::mesh::Made &made) {
    const double side = made.octree.lattice.side(made.octree.lattice.level);
    if (made.widened > 0)
        return fmt::format(
            "walls thinner than cells are drawn by the solid grown by {0:.2g}, with its vertices "
            "moved to the surface: gaps and holes narrower than {1:.2g} may be closed, which a "
            "tolerance of {2:.2g} shows",
            made.widened, 2 * made.widened, 0.5 * side);
    if (made.widened < 0)
        return fmt::format("gaps thinner than cells are drawn by the solid shrunk by {0:.2g}, with "
                           "its vertices moved to the surface: walls thinner than {1:.2g} may have "
                           "holes, which a tolerance of {2:.2g} shows",
                           -made.widened, -2 * made.widened, 0.5 * side);
    const fathom::mesh::Field field(scene, settings.time, settings.bounds);
    const fathom::mesh::TooThin thin = too_thin_in(field, settings, made);
    const std::string shown = shown_by(thin.thickness, made.octree.lattice, made.box);
    switch (thin.sort) {
    case fathom::mesh::TooThin::Sort::None: break;
    case fathom::mesh::TooThin::Sort::Holes:
        return fmt::format("walls or gaps may have holes: one is about {:.2g} thick{}",
                           thin.thickness, shown);
    case fathom::mesh::TooThin::Sort::Gaps:
        return fmt::format("parts that are apart may be drawn as one: a gap is about {:.2g} wide{}",
                           thin.thickness, shown);
    case fathom::mesh::TooThin::Sort::Pieces:
        return fmt::format("the mesh has {} pieces, of which {}{} may belong to another: a wall or "
                           "a sharp edge there is about {:.2g} thick{}",
                           thin.pieces, thin.more ? "at least " : "", thin.splinters,
                           thin.thickness, shown);
    }
    return "";
}

std::string advice_on_shape(const fathom::mesh::Made &made, const fathom::mesh::Form &finer) {
    const fathom::mesh::Lattice &lattice = made.octree.lattice;
    return fmt::format("smaller cells show another shape, {} piece{} and {} handle{}, with a "
                       "tolerance of {:.2g}",
                       finer.components, finer.components == 1 ? "" : "s", finer.genus,
                       finer.genus == 1 ? "" : "s", 0.5 * lattice.side(lattice.level));
}

} // namespace fathom::v1
