// See mesh_advice.h.
#include "api/mesh_advice.h"

#include "mesh/grid.h"
#include "mesh/loose.h"
#include "mesh/pieces.h"
#include "mesh/thin.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <utility>

namespace fathom::v1 {
namespace {

constexpr double showing = 1.5; // cells across what is thin

// What shows a wall or a gap of a thickness: a sentence's end.
std::string shown_by(double thickness, const fathom::mesh::Lattice &lattice, const ir::Box &solid) {
    const double tolerance = thickness / showing;
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

// Of a mesh in several pieces: where the solid is thinner than cells in all of one that lies beside
// another, as along a sharp edge, the two may be one.
std::string advice_on_pieces(const ir::Scene &scene, const fathom::mesh::Settings &settings,
                             const fathom::mesh::Made &made) {
    constexpr std::size_t looked_at = 64, looks = 9; // pieces, and vertices of each
    const std::vector<std::uint32_t> piece = fathom::mesh::pieces_of(made.mesh);
    std::map<std::uint32_t, std::vector<std::uint32_t>> vertices; // by piece
    for (std::uint32_t v = 0; v < piece.size(); ++v) vertices[piece[v]].push_back(v);
    if (vertices.size() < 2) return "";
    std::vector<const std::vector<std::uint32_t> *> order;
    for (const auto &[root, of] : vertices) order.push_back(&of);
    std::ranges::stable_sort(order, {}, [](const auto *of) { return of->size(); });
    order.resize(std::min(order.size() - 1, looked_at)); // all but the greatest
    const fathom::mesh::Field field(scene, settings.time, settings.bounds);
    fathom::mesh::Evaluator evaluator(field);
    const fathom::mesh::Lattice &lattice = made.octree.lattice;
    const double side = lattice.side(lattice.level);
    const double reach = 2 * side; // of what lies beside something
    fathom::mesh::Grid grid(point_of(lattice, {0, 0, 0}), reach);
    for (std::uint32_t v = 0; v < piece.size(); ++v) {
        const fathom::mesh::Real3 at = fathom::mesh::real(made.mesh.vertices[v]);
        grid.add(at, at, v);
    }
    grid.sort();
    std::vector<std::uint32_t> near;
    const auto is_beside_another = [&](std::uint32_t vertex) {
        const fathom::mesh::Real3 at = fathom::mesh::real(made.mesh.vertices[vertex]);
        grid.find(fathom::mesh::along(at, {1, 1, 1}, -reach),
                  fathom::mesh::along(at, {1, 1, 1}, reach), near);
        return std::ranges::any_of(near,
                                   [&](std::uint32_t v) { return piece[v] != piece[vertex]; });
    };
    std::vector<double> thick;
    std::size_t splinters = 0;
    for (const std::vector<std::uint32_t> *of : order) {
        std::vector<double> thin;
        bool beside = false;
        for (std::size_t k = 0; k < looks; ++k) {
            const std::uint32_t v = (*of)[k * of->size() / looks];
            beside = beside || is_beside_another(v);
            const double found = thin_at(evaluator, lattice, side, made.mesh.vertices[v]).thickness;
            if (found > 0 && found < showing * side) thin.push_back(found);
        }
        if (!beside || 3 * thin.size() < 2 * looks) continue;
        ++splinters;
        thick.insert(thick.end(), thin.begin(), thin.end());
    }
    if (splinters == 0) return "";
    std::ranges::sort(thick);
    const double where = thick[3 * thick.size() / 4]; // some way off the edge itself
    return fmt::format("the mesh has {} pieces, of which {}{} may belong to another: a wall or a "
                       "sharp edge there is about {:.2g} thick{}",
                       vertices.size(), vertices.size() > looked_at + 1 ? "at least " : "",
                       splinters, where, shown_by(where, lattice, made.box));
}

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
    if (made.widened > 0)
        return fmt::format(
            "walls thinner than cells are drawn by the solid grown by {0:.2g}, with "
            "its vertices moved to the surface: gaps and holes narrower than {1:.2g} "
            "may be closed",
            made.widened, 2 * made.widened);
    if (made.widened < 0)
        return fmt::format("gaps thinner than cells are drawn by the solid shrunk by {0:.2g}, with "
                           "its vertices moved to the surface: walls thinner than {1:.2g} may have "
                           "holes",
                           -made.widened, -2 * made.widened);
    constexpr std::size_t looks = 1024;
    constexpr std::size_t many = 8; // of these, one is thin: no mere edges and points
    constexpr std::size_t some = 8; // gaps: of one width, more or less, where no groove ends
    const fathom::mesh::Octree &octree = made.octree;
    const std::int32_t side = octree.lattice.cells(octree.lattice.level);
    std::array<std::int32_t, 3> last{-1, -1, -1}; // of a divided drawing cell one part speaks
    std::vector<fathom::mesh::Cell> cells = open_leaves(octree);
    std::erase_if(cells, [&](const fathom::mesh::Cell &cell) {
        if (!octree.nodes[static_cast<std::size_t>(cell.node)].crossed()) return true;
        const std::array<std::int32_t, 3> drawn{cell.at[0] / side, cell.at[1] / side,
                                                cell.at[2] / side};
        return std::exchange(last, drawn) == drawn;
    });
    fathom::mesh::Progress progress;
    const fathom::mesh::Field field(scene, settings.time, settings.bounds);
    const auto found = thin_in(field, octree.lattice, cells, threads_of(settings), progress, looks);
    std::vector<double> thin, gaps;
    for (std::size_t k = 0; k < found.size(); ++k) {
        const fathom::mesh::Cell &cell = cells[k * cells.size() / found.size()];
        const double thickness = found[k].thickness;
        if (!(thickness > 0 && thickness < octree.lattice.side(cell.level))) continue;
        thin.push_back(thickness);
        if (found[k].gap) gaps.push_back(thickness);
    }
    std::ranges::sort(thin);
    std::ranges::sort(gaps);
    if (!thin.empty() && many * thin.size() >= found.size())
        return fmt::format("walls or gaps may have holes: one is about {:.2g} thick{}",
                           lower_quarter(thin),
                           shown_by(lower_quarter(thin), octree.lattice, made.box));
    if (gaps.size() < some || lower_quarter(gaps) < 0.5 * gaps.back())
        return advice_on_pieces(scene, settings, made);
    return fmt::format("parts that are apart may be drawn as one: a gap is about {:.2g} wide{}",
                       lower_quarter(gaps),
                       shown_by(lower_quarter(gaps), octree.lattice, made.box));
}

} // namespace fathom::v1
