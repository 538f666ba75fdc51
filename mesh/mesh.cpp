#include "mesh/mesh.h"

#include "backend-cpu/prune/solid_box.h"
#include "mesh/thin.h"

#include <cmath>

namespace fathom::mesh {
namespace {

constexpr double box_work = 200e6; // operations on boxes, to find the solid's

// Cells that are tangled are divided until none is, or their parts are the finest.
Failure untangle(Made &made, const Field &field, const OctreeSettings &settings, std::size_t most,
                 std::vector<Cell> &divided, Progress &progress) {
    constexpr int most_rounds = 64;
    for (int round = 0; round < most_rounds; ++round) {
        if (made.octree.nodes.size() > most) return Failure::TooMany;
        made.loops = find_loops(made.octree, settings.threads, progress);
        if (progress.cancelled) return Failure::Cancelled;
        if (made.loops.torn > 0) {
            made.place = point_of(made.octree.lattice, made.loops.torn_at);
            return Failure::Contradicted;
        }
        if (made.loops.tangled.empty()) return Failure::None;
        if (round == 0 &&
            thinner_in(field, made.octree, made.loops.tangled, settings.threads, progress)) {
            // Their parts would be as tangled. They are listed, and those alone divided that have to be.
            made.octree.undecided.insert(made.octree.undecided.end(), made.loops.tangled.begin(),
                                         made.loops.tangled.end());
            made.octree.settled = made.octree.lattice.level;
            continue;
        }
        divided.insert(divided.end(), made.loops.tangled.begin(), made.loops.tangled.end());
        divide(made.octree, field, made.loops.tangled, settings, progress);
    }
    return Failure::None;
}

OctreeSettings octree_settings(const Settings &settings) {
    OctreeSettings octree;
    octree.threads = threads_of(settings);
    octree.extra = settings.extra;
    return octree;
}

} // namespace

Failure box_of(const ir::Scene &scene, const Settings &settings, ir::Box &box) {
    constexpr double far = cpu::endless_from;
    ir::Box space{{-far, -far, -far}, {far, far, far}};
    const bool known = settings.bounds || (!scene.endless && scene.bounds.finite());
    if (known) space = settings.bounds ? *settings.bounds : scene.bounds;
    if (settings.bounds && !scene.endless && scene.bounds.finite())
        for (std::size_t i = 0; i < 3; ++i) { // it need not be looked for in all of wide bounds
            space.lo[i] = std::max(space.lo[i], scene.bounds.lo[i]);
            space.hi[i] = std::min(space.hi[i], scene.bounds.hi[i]);
            if (!(space.lo[i] < space.hi[i])) return Failure::Outside;
        }
    double work = box_work;
    box = cpu::solid_box(scene, scene.distance, space, settings.time, work);
    if (box.empty()) return settings.bounds ? Failure::Outside : Failure::Empty;
    for (std::size_t i = 0; i < 3; ++i)
        if (!known && !(box.lo[i] > -far / 2 && box.hi[i] < far / 2)) return Failure::Endless;
    return Failure::None;
}

unsigned threads_of(const Settings &settings) {
    return settings.threads > 0 ? settings.threads
                                : std::max(std::thread::hardware_concurrency(), 1u);
}

Made make_mesh(const ir::Scene &scene, const Settings &settings) {
    Made made;
    const auto fail = [&](Failure failure) {
        made.failure = failure;
        return std::move(made);
    };
    if (const Failure failure = box_of(scene, settings, made.box); failure != Failure::None)
        return fail(failure);
    double longest = 0;
    for (std::size_t i = 0; i < 3; ++i)
        longest = std::max(longest, made.box.hi[i] - made.box.lo[i]);
    const double side =
        settings.side > 0 ? settings.side : longest / std::max(settings.resolution, 1);
    const std::optional<Lattice> lattice =
        make_lattice(made.box, side, settings.extra + settings.deeper);
    if (!lattice) return fail(Failure::TooFine);

    const Field field(scene, settings.time, settings.bounds);
    Progress progress;
    progress.report = settings.progress;
    progress.to = 0.5;
    made.octree = make_octree(field, *lattice, octree_settings(settings), progress);
    if (progress.cancelled) return fail(Failure::Cancelled);
    if (made.octree.full) return fail(Failure::TooMany);
    progress.phase(1);
    std::vector<Cell> divided;
    Failure failure = finish_mesh(made, field, settings, 2 * most_nodes, divided, progress);
    if (failure == Failure::Empty && settings.bounds) failure = Failure::Outside;
    if (failure != Failure::None) return fail(failure);
    return made;
}

Failure finish_mesh(Made &made, const Field &field, const Settings &settings, std::size_t most,
                    std::vector<Cell> &divided, Progress &progress) {
    const double from = progress.from, to = progress.to;
    progress.to = from + 0.2 * (to - from);
    const OctreeSettings octree = octree_settings(settings);
    const Failure failure = untangle(made, field, octree, most, divided, progress);
    if (failure != Failure::None) return failure;
    progress.phase(from + 0.8 * (to - from));
    Vertices vertices = place_vertices(made.octree, field, made.loops, octree.threads, progress);
    if (progress.cancelled) return Failure::Cancelled;
    made.mesh = make_polygons(made.octree.lattice, made.loops, vertices);
    made.roots = std::move(vertices.roots);
    made.root_slack = std::move(vertices.root_slack);
    progress.phase(to);
    if (!made.mesh.triangles.empty()) return Failure::None;
    if (!made.octree.undecided.empty()) return Failure::Unseen;
    return made.octree.seams.empty() ? Failure::Empty : Failure::Flat;
}

} // namespace fathom::mesh
