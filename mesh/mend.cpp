#include "mesh/mend.h"

#include <algorithm>
#include <cmath>

namespace fathom::mesh {
namespace {

constexpr int deeper = 3;                       // than what is searched without a certificate
constexpr std::size_t least_growth = 2'000'000; // of the octree, in nodes
constexpr double nodes_a_cell = 16; // that dividing one once may take, with its neighbours
constexpr int most_rounds = 12;

// The open leaves about one, a drawing cell away at most: where nothing of a gap or a wall is seen, more
// of it is seen beside there.
void add_leaves_about(const Octree &octree, const Cell &cell, std::vector<Cell> &cells) {
    for (int level = octree.lattice.level; level <= cell.level; ++level) {
        const std::int32_t side = octree.lattice.cells(level);
        for (int k = 0; k < 27; ++k) {
            const Cell near = leaf_at(octree, {cell.at[0] + (k % 3 - 1) * side,
                                               cell.at[1] + (k / 3 % 3 - 1) * side,
                                               cell.at[2] + (k / 9 - 1) * side});
            if (near.node != none &&
                octree.nodes[static_cast<std::size_t>(near.node)].space == Space::Open)
                cells.push_back(near);
        }
    }
}

// The leaves that are to be divided for a certificate's doubts, each once.
std::vector<Cell> doubtful(const Made &made, const Certificate &certificate) {
    const Lattice &lattice = made.octree.lattice;
    std::vector<Cell> cells;
    for (const Cell &cell : certificate.undecided) {
        cells.push_back(cell);
        if (cell.level == lattice.depth) add_leaves_about(made.octree, cell, cells);
    }
    for (const Unproved &place : certificate.unproved) {
        Index at{};
        for (std::size_t i = 0; i < 3; ++i)
            at[i] = static_cast<std::int32_t>(
                std::floor((place.at[i] - double(lattice.at(i, 0))) / (2 * lattice.unit)));
        const Cell leaf = leaf_at(made.octree, at);
        if (leaf.node != none &&
            made.octree.nodes[static_cast<std::size_t>(leaf.node)].space == Space::Open)
            cells.push_back(leaf);
    }
    std::erase_if(cells, [&](const Cell &cell) { return cell.level >= lattice.depth; });
    std::ranges::sort(cells, {}, &Cell::node);
    const auto same = [](const Cell &x, const Cell &y) { return x.node == y.node; };
    cells.erase(std::unique(cells.begin(), cells.end(), same), cells.end());
    return cells;
}

// How many nodes dividing them to the finest level takes, if surface goes through all of them: four
// parts of each.
double nodes_for(const std::vector<Cell> &cells, const Lattice &lattice) {
    double nodes = 0;
    for (const Cell &cell : cells)
        nodes += nodes_a_cell * std::ldexp(1.0, 2 * (lattice.depth - cell.level - 1));
    return nodes;
}

} // namespace

Mended make_certified_mesh(const ir::Scene &scene, Settings settings) {
    constexpr double mesh_share = 0.4, first_share = 0.6; // of the time
    const std::function<bool(double)> report = settings.progress;
    settings.deeper = deeper;
    if (report) settings.progress = [&](double done) { return report(mesh_share * done); };
    Mended mended;
    mended.made = make_mesh(scene, settings);
    if (mended.made.failure != Failure::None) return mended;
    Progress progress;
    progress.report = report;
    progress.from = mesh_share;
    progress.to = first_share;
    const Field field(scene, settings.time, settings.bounds);
    mended.certificate = certify(field, settings, mended.made, nullptr, progress);
    OctreeSettings octree;
    octree.threads = threads_of(settings);
    const std::size_t before = mended.made.octree.nodes.size();
    const std::size_t most = before + std::max(before, least_growth);
    while (!progress.cancelled && mended.rounds < most_rounds) {
        std::vector<Cell> divided = doubtful(mended.made, mended.certificate);
        if (divided.empty() || double(mended.made.octree.nodes.size()) +
                                       nodes_for(divided, mended.made.octree.lattice) >
                                   double(most))
            break;
        Made next; // what there is stays, should this one come to nothing
        next.box = mended.made.box;
        next.octree = mended.made.octree;
        refine(next.octree, field, divided, octree, progress);
        const double here = progress.to;
        progress.phase(here + 0.25 * (1 - here));
        if (progress.cancelled ||
            finish_mesh(next, field, settings, most, divided, progress) != Failure::None)
            break;
        Region changed(next.octree.lattice);
        for (const Cell &cell : divided) changed.add(cell);
        const Earlier earlier{mended.certificate, changed};
        progress.phase(here + 0.5 * (1 - here));
        mended.certificate = certify(field, settings, next, &earlier, progress);
        mended.made = std::move(next);
        ++mended.rounds;
    }
    if (progress.cancelled) mended.made.failure = Failure::Cancelled;
    return mended;
}

} // namespace fathom::mesh
