#include "mesh/crumbs.h"

#include <algorithm>
#include <numeric>

namespace fathom::mesh {
namespace {

// Numbers that are joined in sets: each set is known by one of its members.
struct Sets {
    std::vector<std::size_t> parent;
    explicit Sets(std::size_t count) : parent(count) {
        std::iota(parent.begin(), parent.end(), std::size_t{0});
    }
    std::size_t of(std::size_t k) {
        while (parent[k] != k) k = parent[k] = parent[parent[k]];
        return k;
    }
    void join(std::size_t a, std::size_t b) { parent[of(a)] = of(b); }
};

} // namespace

Crumbs find_crumbs(const Octree &octree, const Loops &loops) {
    Sets pieces(loops.patches.size());
    for (const Crossing &crossing : loops.crossings) {
        std::int32_t first = none;
        for (const std::int32_t patch : crossing.patches) {
            if (patch == none) continue;
            if (first == none) first = patch;
            pieces.join(static_cast<std::size_t>(first), static_cast<std::size_t>(patch));
        }
    }
    struct Piece {
        bool crumb = true; // no cell of the drawing level shows it by its own corners
        int finest = 0;    // the level of its smallest cells
    };
    std::vector<Piece> found(loops.patches.size()); // by set
    for (std::size_t k = 0; k < loops.patches.size(); ++k) {
        const Cell &cell = loops.patches[k].cell;
        Piece &piece = found[pieces.of(k)];
        piece.finest = std::max(piece.finest, cell.level);
        if (cell.level <= octree.lattice.level &&
            octree.nodes[static_cast<std::size_t>(cell.node)].crossed())
            piece.crumb = false;
    }
    Crumbs crumbs;
    for (std::size_t k = 0; k < loops.patches.size(); ++k) {
        const Cell &cell = loops.patches[k].cell;
        const Piece &piece = found[pieces.of(k)];
        if (!piece.crumb) continue;
        crumbs.count += pieces.of(k) == k;
        if (cell.level < piece.finest) crumbs.larger.push_back(cell);
    }
    std::ranges::sort(crumbs.larger, {}, &Cell::node);
    const auto same = [](const Cell &a, const Cell &b) { return a.node == b.node; };
    crumbs.larger.erase(std::unique(crumbs.larger.begin(), crumbs.larger.end(), same),
                        crumbs.larger.end());
    return crumbs;
}

} // namespace fathom::mesh
