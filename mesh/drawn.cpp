#include "mesh/drawn.h"

#include "mesh/grid.h"
#include "mesh/pieces.h"
#include "mesh/thin.h"

#include <algorithm>
#include <map>
#include <utility>

namespace fathom::mesh {
namespace {

// Where the solid is thinner than cells in all of a piece that lies beside another, as along a sharp
// edge, the two may be one.
TooThin splinters_in(const Field &field, const Made &made) {
    constexpr std::size_t looked_at = 64, looks = 9; // pieces, and vertices of each
    const std::vector<std::uint32_t> piece = pieces_of(made.mesh);
    std::map<std::uint32_t, std::vector<std::uint32_t>> vertices; // by piece
    for (std::uint32_t v = 0; v < piece.size(); ++v) vertices[piece[v]].push_back(v);
    if (vertices.size() < 2) return {};
    std::vector<const std::vector<std::uint32_t> *> order;
    for (const auto &[root, of] : vertices) order.push_back(&of);
    std::ranges::stable_sort(order, {}, [](const auto *of) { return of->size(); });
    order.resize(std::min(order.size() - 1, looked_at)); // all but the greatest
    Evaluator evaluator(field);
    const Lattice &lattice = made.octree.lattice;
    const double side = lattice.side(lattice.level);
    const double reach = 2 * side; // of what lies beside something
    Grid grid(point_of(lattice, {0, 0, 0}), reach);
    for (std::uint32_t v = 0; v < piece.size(); ++v) {
        const Real3 at = real(made.mesh.vertices[v]);
        grid.add(at, at, v);
    }
    grid.sort();
    std::vector<std::uint32_t> near;
    const auto is_beside_another = [&](std::uint32_t vertex) {
        const Real3 at = real(made.mesh.vertices[vertex]);
        grid.find(along(at, {1, 1, 1}, -reach), along(at, {1, 1, 1}, reach), near);
        return std::ranges::any_of(near,
                                   [&](std::uint32_t v) { return piece[v] != piece[vertex]; });
    };
    std::vector<double> thick;
    TooThin found;
    for (const std::vector<std::uint32_t> *of : order) {
        std::vector<double> thin;
        bool beside = false;
        for (std::size_t k = 0; k < looks; ++k) {
            const std::uint32_t v = (*of)[k * of->size() / looks];
            beside = beside || is_beside_another(v);
            const double there = thin_at(evaluator, lattice, side, made.mesh.vertices[v]).thickness;
            if (there > 0 && there < cells_across * side) thin.push_back(there);
        }
        if (!beside || 3 * thin.size() < 2 * looks) continue;
        ++found.splinters;
        thick.insert(thick.end(), thin.begin(), thin.end());
    }
    if (found.splinters == 0) return {};
    std::ranges::sort(thick);
    found.sort = TooThin::Sort::Pieces;
    found.thickness = thick[3 * thick.size() / 4]; // some way off the edge itself
    found.pieces = vertices.size();
    found.more = vertices.size() > looked_at + 1;
    return found;
}

// Of how thick something is at some places, from the least: a sharp edge is as thin as one likes
// somewhere; of a wall all places tell its thickness.
double lower_quarter(const std::vector<double> &thick) { return thick[thick.size() / 4]; }

} // namespace

TooThin too_thin_in(const Field &field, const Settings &settings, const Made &made) {
    constexpr std::size_t looks = 1024;
    constexpr std::size_t many = 8; // of these, one is thin: no mere edges and points
    constexpr std::size_t some = 8; // gaps: of one width, more or less, where no groove ends
    const Octree &octree = made.octree;
    const std::int32_t side = octree.lattice.cells(octree.lattice.level);
    Index last{-1, -1, -1}; // of a divided drawing cell one part speaks
    std::vector<Cell> cells = open_leaves(octree);
    std::erase_if(cells, [&](const Cell &cell) {
        if (!octree.nodes[static_cast<std::size_t>(cell.node)].crossed()) return true;
        const Index drawn{cell.at[0] / side, cell.at[1] / side, cell.at[2] / side};
        return std::exchange(last, drawn) == drawn;
    });
    Progress progress;
    const auto found = thin_in(field, octree.lattice, cells, threads_of(settings), progress, looks);
    std::vector<double> thin, gaps;
    for (std::size_t k = 0; k < found.size(); ++k) {
        const Cell &cell = cells[k * cells.size() / found.size()];
        const double thickness = found[k].thickness;
        if (!(thickness > 0 && thickness < octree.lattice.side(cell.level))) continue;
        thin.push_back(thickness);
        if (found[k].gap) gaps.push_back(thickness);
    }
    std::ranges::sort(thin);
    std::ranges::sort(gaps);
    if (!thin.empty() && many * thin.size() >= found.size())
        return {TooThin::Sort::Holes, lower_quarter(thin), 2 * gaps.size() > thin.size()};
    if (gaps.size() >= some && lower_quarter(gaps) >= 0.5 * gaps.back())
        return {TooThin::Sort::Gaps, lower_quarter(gaps), true};
    return splinters_in(field, made);
}

} // namespace fathom::mesh
