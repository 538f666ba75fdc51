#include "mesh/mesh.h"

#include "backend-cpu/prune/solid_box.h"
#include "mesh/crumbs.h"
#include "mesh/drawn.h"
#include "mesh/thin.h"
#include "mesh/widen.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace fathom::mesh {
namespace {

constexpr double box_work = 200e6; // operations on boxes, to find the solid's

constexpr std::size_t nodes_untangled = 250'000; // that may come of it, or
constexpr std::size_t times_untangled = 4;       // so many times what there was
constexpr std::size_t few_tangled = 64;          // cells that are divided unasked
// Cells: a wall that lies at an angle to them is seen whole from their diagonal on.
constexpr double shows_whole = 1.75;

OctreeSettings octree_settings(const Settings &settings) {
    OctreeSettings octree;
    octree.threads = threads_of(settings);
    octree.extra = settings.extra;
    return octree;
}

// `changed`: only what is tangled about these cells.
Failure look_for_loops(Made &made, const Region *changed, unsigned threads, Progress &progress) {
    made.loops = changed ? find_tangled(made.octree, *changed, threads, progress)
                         : find_loops(made.octree, threads, progress);
    if (progress.cancelled) return Failure::Cancelled;
    if (made.loops.torn == 0) return Failure::None;
    made.place = point_of(made.octree.lattice, made.loops.torn_at);
    return Failure::Contradicted;
}

void list_tangled(Made &made) {
    made.octree.undecided.insert(made.octree.undecided.end(), made.loops.tangled.begin(),
                                 made.loops.tangled.end());
    made.octree.settled = made.octree.lattice.level;
}

// The mesh of cells of one size. What they do not show is listed: where walls are thinner than the
// finest cells each divided cell tangles those about it, and all together would draw crumbs.
Failure draw_evenly(Made &made, const Field &field, const Settings &settings,
                    std::vector<Cell> &divided, Progress &progress) {
    OctreeSettings octree = octree_settings(settings);
    octree.searches = false;
    Progress quiet; // it was here before
    quiet.report = progress.report;
    quiet.from = quiet.to = progress.from;
    made.octree = make_octree(field, made.octree.lattice, octree, quiet);
    divided.clear();
    if (quiet.cancelled) return Failure::Cancelled;
    const Failure failure = look_for_loops(made, nullptr, octree.threads, progress);
    if (failure != Failure::None) return failure;
    list_tangled(made);
    made.loops.tangled.clear(); // cells of one size need not be divided
    return Failure::None;
}

// Cells that are tangled are divided until none is, or their parts are the finest. `again`: where that
// is in vain the mesh may be begun again.
Failure untangle(Made &made, const Field &field, const Settings &settings, bool again,
                 std::size_t most, std::vector<Cell> &divided, Progress &progress) {
    constexpr int most_rounds = 1024; // a thin edge may tangle one cell after the other
    const OctreeSettings octree = octree_settings(settings);
    const std::size_t before = made.octree.nodes.size();
    const std::size_t bound = before + std::max(times_untangled * before, nodes_untangled);
    std::optional<Region> changed; // where cells were divided; no others can have become tangled
    const auto note = [&](const std::vector<Cell> &cells) {
        constexpr double few = 1; // it may tangle those that it touches
        changed.emplace(made.octree.lattice, few);
        for (const Cell &cell : cells) changed->add(cell);
    };
    if (!divided.empty()) note(divided);
    for (int round = 0; round < most_rounds; ++round) {
        if (made.octree.nodes.size() > most) return Failure::TooMany;
        const Failure failure =
            look_for_loops(made, changed ? &*changed : nullptr, octree.threads, progress);
        if (failure != Failure::None) return failure;
        const std::vector<Cell> &tangled = made.loops.tangled;
        if (tangled.empty()) {
            if (!changed) return Failure::None;
            changed.reset(); // now all loops
            continue;
        }
        if (again && (made.octree.nodes.size() > bound ||
                      thinner_in(field, made.octree, tangled, few_tangled, shows_whole,
                                 octree.threads, progress)))
            return draw_evenly(made, field, settings, divided, progress);
        if (round == 0 && thinner_in(field, made.octree, tangled, few_tangled, shows_whole,
                                     octree.threads, progress)) {
            // Their parts would be as tangled. Those alone are divided that have to be.
            list_tangled(made);
            changed.reset();
            continue;
        }
        divided.insert(divided.end(), tangled.begin(), tangled.end());
        divide(made.octree, field, tangled, octree, progress);
        note(tangled);
    }
    return again ? draw_evenly(made, field, settings, divided, progress) : Failure::TooMany;
}

// Divides the larger cells that crumbs end in, until there are none. Where that leaves as many all is
// as before: about an edge that is sharp enough each level has crumbs of its own.
Failure join_crumbs(Made &made, const Field &field, const Settings &settings, std::size_t most,
                    std::vector<Cell> &divided, Progress &progress) {
    constexpr int most_rounds = 2;
    constexpr std::size_t few = 16; // where there are more, walls are thin or edges sharp all over
    Crumbs crumbs = find_crumbs(made.octree, made.loops);
    if (crumbs.count > few) return Failure::None;
    struct Kept {
        std::size_t count = 0;
        Octree octree;
        Loops loops;
    };
    std::optional<Kept> kept; // the last that had fewer than those before
    std::vector<Cell> since;  // divided since then
    for (int round = 0; round < most_rounds && !crumbs.larger.empty(); ++round) {
        if (!kept || crumbs.count < kept->count) {
            kept = Kept{crumbs.count, made.octree, made.loops};
            divided.insert(divided.end(), since.begin(), since.end());
            since.clear();
        }
        std::vector<Cell> changed = crumbs.larger;
        refine(made.octree, field, changed, octree_settings(settings), progress);
        const Failure failure = untangle(made, field, settings, false, most, changed, progress);
        if (progress.cancelled) return Failure::Cancelled;
        since.insert(since.end(), changed.begin(), changed.end());
        if (failure != Failure::None) break;
        crumbs = find_crumbs(made.octree, made.loops);
        if (crumbs.count > kept->count) break;
    }
    if (kept && crumbs.count >= kept->count) {
        made.octree = std::move(kept->octree);
        made.loops = std::move(kept->loops);
    } else {
        divided.insert(divided.end(), since.begin(), since.end());
    }
    return Failure::None;
}

// From an octree without tangled cells to the mesh.
Failure draw(Made &made, const Field &field, unsigned threads, Progress &progress) {
    Vertices vertices = place_vertices(made.octree, field, made.loops, threads, progress);
    if (progress.cancelled) return Failure::Cancelled;
    made.mesh = make_polygons(made.octree.lattice, made.loops, vertices);
    made.roots = std::move(vertices.roots);
    made.root_slack = std::move(vertices.root_slack);
    if (!made.mesh.triangles.empty()) return Failure::None;
    if (!made.octree.undecided.empty()) return Failure::Unseen;
    return made.octree.seams.empty() ? Failure::Empty : Failure::Flat;
}

Failure finish(Made &made, const Field &field, const Settings &settings, bool again,
               std::size_t most, std::vector<Cell> &divided, Progress &progress) {
    const double from = progress.from, to = progress.to;
    progress.to = from + 0.2 * (to - from);
    Failure failure = untangle(made, field, settings, again, most, divided, progress);
    if (failure == Failure::None)
        failure = join_crumbs(made, field, settings, most, divided, progress);
    if (failure != Failure::None) return failure;
    progress.phase(from + 0.8 * (to - from));
    failure = draw(made, field, threads_of(settings), progress);
    progress.phase(to);
    return failure;
}

// Whether some of the solid is seen at the end of what is searched for its box.
bool is_seen_at(double far, const ir::Scene &scene, const Settings &settings) {
    constexpr int looks = 33; // a side
    const Field field(scene, settings.time, {});
    Evaluator evaluator(field);
    Points points;
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const double end : {-far, far})
            for (int n = 0; n < looks * looks; ++n) {
                const auto at = [&](int k) {
                    return static_cast<float>(far * (2.0 * k / (looks - 1) - 1));
                };
                Point p{};
                p[axis] = static_cast<float>(end);
                p[(axis + 1) % 3] = at(n / looks), p[(axis + 2) % 3] = at(n % looks);
                points.add(p);
            }
    std::vector<float> values;
    values_at(evaluator, *field.whole, points, values);
    return std::ranges::any_of(values, [](float value) { return value <= 0; });
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
        if (!known && !(box.lo[i] > -far / 2 && box.hi[i] < far / 2))
            return is_seen_at(far, scene, settings) ? Failure::Endless : Failure::Unbounded;
    return Failure::None;
}

unsigned threads_of(const Settings &settings) {
    return settings.threads > 0 ? settings.threads
                                : std::max(std::thread::hardware_concurrency(), 1u);
}

Made make_plain_mesh(const ir::Scene &scene, const Settings &settings) {
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
        make_lattice(made.box, side, settings.extra, settings.deeper);
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
    Failure failure = finish(made, field, settings, true, 2 * most_nodes, divided, progress);
    if (failure == Failure::Empty && settings.bounds) failure = Failure::Outside;
    if (failure != Failure::None) return fail(failure);
    return made;
}

Made make_mesh(const ir::Scene &scene, const Settings &settings) {
    Made made = make_plain_mesh(scene, settings);
    if (made.failure != Failure::None && made.failure != Failure::Unseen) return made;
    const Field field(scene, settings.time, settings.bounds);
    Progress progress;
    progress.report = settings.progress;
    progress.from = progress.to; // it was at its end
    std::optional<Wider> wider;
    if (!made.octree.undecided.empty()) {
        wider = draw_wider(scene, field, settings, made, made.octree.undecided, Proof::Distances,
                           progress);
    } else if (const TooThin thin = too_thin_in(field, settings, made);
               thin.sort == TooThin::Sort::Holes || thin.sort == TooThin::Sort::Pieces) {
        wider = draw_wider(scene, field, settings, made, ThinWalls{thin.thickness, thin.gap},
                           Proof::Distances, progress);
    }
    if (progress.cancelled) made.failure = Failure::Cancelled;
    if (!progress.cancelled && wider && wider->certificate.near()) {
        made = std::move(wider->made);
        made.octree.undecided.clear();
    }
    return made;
}

Made make_mesh_of(const Field &field, const ir::Box &box, const Settings &settings,
                  Progress &progress) {
    Made made;
    made.box = box;
    const auto fail = [&](Failure failure) {
        made.failure = failure;
        return std::move(made);
    };
    const std::optional<Lattice> lattice = make_lattice(box, settings.side, settings.extra, 0);
    if (!lattice) return fail(Failure::TooFine);
    OctreeSettings octree = octree_settings(settings);
    octree.searches = false;
    const double from = progress.from, to = progress.to;
    progress.to = 0.5 * (from + to);
    made.octree = make_octree(field, *lattice, octree, progress);
    if (progress.cancelled) return fail(Failure::Cancelled);
    if (made.octree.full) return fail(Failure::TooMany);
    progress.phase(to);
    std::vector<Cell> divided;
    made.failure = finish(made, field, settings, true, most_nodes, divided, progress);
    return made;
}

Failure finish_mesh(Made &made, const Field &field, const Settings &settings, std::size_t most,
                    std::vector<Cell> &divided, Progress &progress) {
    return finish(made, field, settings, false, most, divided, progress);
}

} // namespace fathom::mesh
