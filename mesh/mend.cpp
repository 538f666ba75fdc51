#include "mesh/mend.h"

#include "mesh/drawn.h"
#include "mesh/shape.h"
#include "mesh/thin.h"
#include "mesh/widen.h"

#include <algorithm>
#include <cmath>

namespace fathom::mesh {
namespace {

constexpr int deeper = 7; // than what is searched without a certificate, at most
constexpr std::size_t least_growth = 500'000; // of the octree, in nodes
constexpr double nodes_a_cell = 16; // that dividing one once may take, with its neighbours
constexpr std::size_t few_beside =
    64;                          // cells in doubt that are small enough: what lies beside is not
constexpr int deepest_blind = 4; // levels that are tried where nothing shows,
constexpr std::size_t few_blind = 32; // … or all, in so many drawing cells at most
constexpr int sampled_levels = 6;     // that samples at even steps tell
constexpr int most_rounds = 12;
// A round that divides all that is in doubt halves it or more: surface goes through half of a cell's
// parts. Where some of it is out of reach the rounds go on while they take a quarter.
constexpr std::uint64_t worth = 4;
constexpr int boxes_shrink_from = 2; // levels: certificates look no closer into what is larger

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

// How far below a drawing cell something shows. `wall`: that was measured, of a wall or a gap that may
// go through all of it; else it is likely to be a tip or an edge, or is not known.
struct Depth {
    int levels = 0;
    bool wall = false;
};

// A place whose doubt may be mended: a cell that is to be divided, and by how many levels, as far as
// the field tells.
struct Patient {
    Cell cell;
    Depth depth;
};

// The larger leaves about cells in doubt: the mesh ends in one of them, before a tip that no corner of
// it shows.
void add_larger_beside(const Octree &octree, const std::vector<const Cell *> &cells,
                       std::vector<Patient> &patients) {
    std::vector<Cell> about;
    for (const Cell *cell : cells) {
        const std::size_t first = about.size();
        add_leaves_about(octree, *cell, about);
        about.erase(std::remove_if(about.begin() + static_cast<std::ptrdiff_t>(first), about.end(),
                                   [&](const Cell &near) { return near.level >= cell->level; }),
                    about.end());
    }
    for (const Cell &cell : about) patients.push_back({cell, {1, true}});
    const auto number = [](const Patient &patient) { return patient.cell.node; };
    std::ranges::stable_sort(patients, {}, number);
    const auto same = [](const Patient &x, const Patient &y) { return x.cell.node == y.cell.node; };
    patients.erase(std::unique(patients.begin(), patients.end(), same), patients.end());
}

std::array<std::int64_t, 3> block_of(const Lattice &lattice, const Cell &cell) {
    const std::int64_t side = lattice.cells(lattice.level);
    return {cell.at[0] / side, cell.at[1] / side, cell.at[2] / side};
}

// How far below a drawing cell signs at corners show what lies about a point: so many levels that
// cells are no thicker than the piece of solid or of space next to it. None: nothing shows.
std::optional<Depth> depth_that_shows(const Lattice &lattice, Evaluator &evaluator,
                                      const Point &at) {
    constexpr int steps = 128; // a finest cell each, one drawing cell to both sides
    Points points;
    points.add(at);
    std::array<std::vector<float>, 4> slope;
    gradients_at(evaluator, *evaluator.field.whole, points, slope);
    Real3 way{slope[1][0], slope[2][0], slope[3][0]};
    const double length = std::sqrt(inner(way, way));
    if (!(length > 0 && std::isfinite(length))) return std::nullopt;
    const double side = lattice.side(lattice.level), step = side / 64 / length;
    points.clear();
    for (int k = -steps / 2; k <= steps / 2; ++k) {
        const Real3 p = along(real(at), way, k * step);
        points.add({static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
    }
    std::vector<float> values;
    values_at(evaluator, *evaluator.field.whole, points, values);
    int thinnest = steps, from = -1; // between two changes of sign; the ends may be anything
    for (int k = 1; k <= steps; ++k) {
        const auto j = static_cast<std::size_t>(k);
        if ((values[j] <= 0) == (values[j - 1] <= 0)) continue;
        if (from >= 0) thinnest = std::min(thinnest, k - from);
        from = k;
    }
    int levels = 1;
    while (from >= 0 && levels < sampled_levels && (64 >> levels) > thinnest) ++levels;
    if (from >= 0 && levels < sampled_levels) return Depth{levels, true};
    const Thin thin = thin_at(evaluator, lattice, side, at); // looks closer
    if (!(thin.thickness > 0)) return from >= 0 ? std::optional(Depth{levels}) : std::nullopt;
    while (levels < lattice.depth - lattice.level && std::ldexp(side, -levels) > thin.thickness)
        ++levels;
    return Depth{levels};
}

// What dividing a cell so deep takes, in nodes, if surface goes through all its parts.
double nodes_for(const Patient &patient) {
    const auto [levels, wall] = patient.depth;
    return nodes_a_cell *
           std::ldexp(1.0, 2 * ((wall ? levels : std::min(levels, deepest_blind)) - 1));
}

// How deep drawing cells are to be divided for their doubts, by their key: found out when they are first
// in doubt.
using Depths = std::unordered_map<std::uint64_t, Depth>;

// All cells that might be divided for a certificate's doubts, each once, and how deep.
struct Patients {
    std::vector<Patient> all;
    std::unordered_set<std::uint64_t> blocks; // all drawing cells with a doubt, by their key
};
Patients patients(const Made &made, const Certificate &certificate, const Field &field,
                  unsigned threads, Progress &progress, Depths &depths) {
    const Octree &octree = made.octree;
    const Lattice &lattice = octree.lattice;
    struct Doubt {
        Cell cell;
        Point at{};
        std::uint64_t block = 0;
    };
    std::vector<Doubt> doubts;
    std::vector<Cell> about;
    for (std::size_t k = 0; k < certificate.undecided.size(); ++k) {
        const Cell &cell = certificate.undecided[k];
        doubts.push_back({cell, certificate.doubts[k]});
        if (cell.level < lattice.depth) continue;
        about.clear();
        add_leaves_about(octree, cell, about);
        for (const Cell &near : about) doubts.push_back({near, certificate.doubts[k]});
    }
    for (const Unproved &place : certificate.unproved) {
        Index at{};
        for (std::size_t i = 0; i < 3; ++i)
            at[i] = static_cast<std::int32_t>(
                std::floor((place.at[i] - double(lattice.at(i, 0))) / (2 * lattice.unit)));
        const Cell leaf = leaf_at(octree, at);
        if (leaf.node != none &&
            octree.nodes[static_cast<std::size_t>(leaf.node)].space == Space::Open)
            doubts.push_back({leaf, place.at});
    }
    Patients result;
    for (const Doubt &doubt : doubts) result.blocks.insert(key_of(block_of(lattice, doubt.cell)));
    std::erase_if(doubts, [&](const Doubt &doubt) { return doubt.cell.level >= lattice.depth; });
    std::ranges::stable_sort(doubts, {}, [](const Doubt &doubt) { return doubt.cell.node; });
    const auto same = [](const Doubt &x, const Doubt &y) { return x.cell.node == y.cell.node; };
    doubts.erase(std::unique(doubts.begin(), doubts.end(), same), doubts.end());
    std::vector<const Doubt *> first; // of their drawing cells
    for (Doubt &doubt : doubts) {
        doubt.block = key_of(block_of(lattice, doubt.cell));
        if (depths.emplace(doubt.block, Depth{}).second) first.push_back(&doubt);
    }
    // A place where a gap closes shows nothing; a few of them are divided as far as can be.
    const int all = lattice.depth - lattice.level;
    const int blind = first.size() <= few_blind ? all : std::min(deepest_blind, all);
    std::vector<Depth> found(first.size());
    in_parallel(
        first.size(), threads, progress, [&] { return Evaluator(field); },
        [&](Evaluator &evaluator, std::size_t k) {
            found[k] = depth_that_shows(lattice, evaluator, first[k]->at).value_or(Depth{blind});
        });
    for (std::size_t k = 0; k < first.size(); ++k) depths[first[k]->block] = found[k];
    std::vector<const Cell *> small;
    for (const Doubt &doubt : doubts) { // cells may be one level smaller than is likely to do
        const auto [levels, wall] = depths[doubt.block];
        const int left = lattice.level + levels - doubt.cell.level;
        // What may be too deep to afford is divided as deep as samples at even steps tell.
        const int first_left = std::min(left, lattice.level + sampled_levels - doubt.cell.level);
        if (left >= 0)
            result.all.push_back(
                {doubt.cell, {std::max(first_left > 0 ? first_left : left, 1), wall}});
        else
            small.push_back(&doubt.cell);
    }
    if (small.size() <= few_beside) add_larger_beside(octree, small, result.all);
    return result;
}

// What a round divides, and whether some doubt is out of reach of this round and of all that follow.
struct Choice {
    std::vector<Cell> cells;
    bool hopeless = false;
};

// Whole clusters of neighbouring drawing cells, those that take least first, as long as all of them
// together take no more than so many nodes.
Choice affordable(const Patients &patients, const Lattice &lattice, double nodes) {
    const std::vector<Patient> &all = patients.all;
    std::unordered_set<std::uint64_t> in_reach; // drawing cells that are divided, or lie beside one
    std::unordered_map<std::uint64_t, std::vector<std::size_t>> by_block;
    for (std::size_t k = 0; k < all.size(); ++k)
        by_block[key_of(block_of(lattice, all[k].cell))].push_back(k);
    struct Cluster {
        std::vector<std::size_t> members;
        double nodes = 0;
    };
    std::vector<Cluster> clusters;
    for (const Patient &patient : all) {
        std::vector<std::array<std::int64_t, 3>> stack{block_of(lattice, patient.cell)};
        Cluster cluster;
        while (!stack.empty()) {
            const auto at = stack.back();
            stack.pop_back();
            const auto block = by_block.find(key_of(at));
            if (block == by_block.end()) continue;
            for (const std::size_t k : block->second) {
                cluster.members.push_back(k);
                cluster.nodes += nodes_for(all[k]);
            }
            by_block.erase(block);
            for (std::int64_t k = 0; k < 27; ++k) {
                stack.push_back({at[0] + k % 3 - 1, at[1] + k / 3 % 3 - 1, at[2] + k / 9 - 1});
                in_reach.insert(key_of(stack.back()));
            }
        }
        if (!cluster.members.empty()) clusters.push_back(std::move(cluster));
    }
    std::ranges::stable_sort(clusters, {}, &Cluster::nodes);
    Choice choice;
    choice.hopeless =
        (!clusters.empty() && clusters.back().nodes > nodes) ||
        std::ranges::any_of(patients.blocks, [&](auto block) { return !in_reach.contains(block); });
    std::vector<std::size_t> taken;
    for (const Cluster &cluster : clusters) {
        nodes -= cluster.nodes;
        if (nodes < 0) break;
        taken.insert(taken.end(), cluster.members.begin(), cluster.members.end());
    }
    std::ranges::sort(taken);
    for (const std::size_t k : taken) choice.cells.push_back(all[k].cell);
    return choice;
}

// Whether a round did so much that another is worth its time: it left less in doubt. Where all is in
// reach anything else will do: about what touches, doubt may grow before it ends.
bool gains(const Certificate &before, const Certificate &after, const Lattice &lattice,
           bool hopeless) {
    const auto worth_it = [&](std::uint64_t was, std::uint64_t is) {
        return hopeless ? is < was && was - is >= was / worth : is != was;
    };
    return worth_it(volume_in_doubt(before, lattice), volume_in_doubt(after, lattice)) ||
           worth_it(before.unproved.size(), after.unproved.size());
}

// Whether a round that gains nothing says nothing of the next one: a certificate looks as closely into
// some cells in doubt as it will into their parts.
bool gain_may_be_late(const Certificate &certificate, const std::vector<Cell> &divided,
                      const Lattice &lattice) {
    const auto large = [&](const Cell &cell) {
        return cell.level < lattice.level + boxes_shrink_from;
    };
    return std::ranges::any_of(certificate.undecided, large) ||
           (!certificate.unproved.empty() && std::ranges::any_of(divided, large));
}

// Divides cells, and makes the mesh and its certificate again, with its shape where that is wanted and
// the distances hold. Whether that was done.
bool divide_again(const Field &field, const Settings &settings, std::vector<Cell> divided,
                  std::size_t most, bool with_shape, Mended &mended, Progress &progress) {
    OctreeSettings octree;
    octree.threads = threads_of(settings);
    Made next; // what there is stays, should this one come to nothing
    next.box = mended.made.box;
    next.octree = mended.made.octree;
    refine(next.octree, field, divided, octree, progress);
    const double here = progress.to;
    progress.phase(here + 0.25 * (1 - here));
    if (progress.cancelled ||
        finish_mesh(next, field, settings, most, divided, progress) != Failure::None)
        return false;
    Region changed(next.octree.lattice);
    for (const Cell &cell : divided) changed.add(cell);
    const Earlier earlier{mended.certificate, changed};
    progress.phase(here + 0.5 * (1 - here));
    Certificate certificate = certify(field, settings, next, &earlier, progress);
    if (with_shape && certificate.near())
        prove_shape(field, settings, next, progress, certificate, &earlier);
    mended.certificate = std::move(certificate);
    mended.made = std::move(next);
    ++mended.rounds;
    return true;
}

// Divides the cells that leave the mesh's shape open, where they are few.
void divide_for_shape(const Field &field, const Settings &settings, std::size_t most,
                      Mended &mended, Progress &progress) {
    constexpr int most_rounds = 10;
    for (int round = 0; round < most_rounds && !progress.cancelled; ++round) {
        const Lattice &lattice = mended.made.octree.lattice;
        std::vector<Cell> cells = mended.certificate.shape.cells;
        std::erase_if(cells, [&](const Cell &cell) { return cell.level >= lattice.depth; });
        if (cells.empty() || mended.certificate.shape.open > few_open_leaves) return;
        Mended next = mended;
        if (!divide_again(field, settings, std::move(cells), most, true, next, progress) ||
            !next.certificate.near())
            return;
        mended = std::move(next);
    }
}

// Whether cells of another size show the same pieces and handles: of twice the side or, where these do
// not, of half of it, if they may be tried. Else what those show.
std::optional<Form> finer_form(const ir::Scene &scene, const Settings &settings, const Made &made,
                               const Form &form, bool &same) {
    constexpr double most_nodes_of_finer = 0.6e6;
    Settings other = settings;
    other.deeper = 0;
    other.progress = {};
    const double side = made.octree.lattice.side(made.octree.lattice.level);
    other.side = 2 * side;
    const Made coarser = make_plain_mesh(scene, other);
    same = coarser.failure == Failure::None && form_of(coarser.mesh) == form;
    if (same) return std::nullopt;
    same = 4 * double(made.octree.nodes.size()) >
           most_nodes_of_finer; // larger cells alone are no sign
    if (same) return std::nullopt;
    other.side = 0.5 * side;
    const Made finer = make_plain_mesh(scene, other);
    if (finer.failure != Failure::None) return std::nullopt;
    const Form shown = form_of(finer.mesh);
    same = shown == form;
    return shown;
}

// Says whether the mesh has the shape of the solid. Where a few cells leave that open they are divided;
// where samples see what cells are too large for, it is drawn wider, or doubted.
void settle_shape(const ir::Scene &scene, const Field &field, const Settings &settings,
                  bool was_wider, std::size_t most, Mended &mended, Progress &progress) {
    if (!mended.certificate.near() || mended.made.widened != 0) return;
    Certificate &certificate = mended.certificate;
    prove_shape(field, settings, mended.made, progress, certificate);
    divide_for_shape(field, settings, most, mended, progress);
    if (certificate.shape.proved || progress.cancelled) return;
    const TooThin thin = too_thin_in(field, settings, mended.made);
    certificate.shape.thin = thin;
    if (thin.sort == TooThin::Sort::None) {
        bool same = true;
        const Form form{certificate.components, certificate.genus};
        const std::optional<Form> finer = finer_form(scene, settings, mended.made, form, same);
        certificate.shape.doubted = !same;
        if (!same) certificate.shape.finer = finer;
        return;
    }
    certificate.shape.doubted = true;
    // What is shrunk to show gaps may come apart, and no sample would see that.
    constexpr std::size_t large = 300'000; // nodes: several meshes more would take too long
    // Where pieces are far thinner than cells they are sharp edges rather than walls.
    const double side = mended.made.octree.lattice.side(mended.made.octree.lattice.level);
    const bool sharp = thin.sort == TooThin::Sort::Pieces && thin.thickness < side / 8;
    if (was_wider || sharp || thin.sort == TooThin::Sort::Gaps ||
        mended.made.octree.nodes.size() > large)
        return;
    std::optional<Wider> wide =
        draw_wider(scene, field, settings, mended.made, ThinWalls{thin.thickness, thin.gap},
                   Proof::Certificate, progress);
    if (!wide) return;
    mended.made = std::move(wide->made), certificate = std::move(wide->certificate);
}

} // namespace

Mended make_certified_mesh(const ir::Scene &scene, Settings settings) {
    constexpr double mesh_share = 0.4, first_share = 0.6; // of the time
    const std::function<bool(double)> report = settings.progress;
    settings.deeper = deeper;
    if (report) settings.progress = [&](double done) { return report(mesh_share * done); };
    Mended mended;
    mended.made = make_plain_mesh(scene, settings);
    const bool unseen = mended.made.failure == Failure::Unseen;
    if (mended.made.failure != Failure::None && !unseen) return mended;
    Progress progress;
    progress.report = report;
    progress.from = mesh_share;
    progress.to = first_share;
    const Field field(scene, settings.time, settings.bounds);
    std::optional<Wider> wide =
        draw_wider(scene, field, settings, mended.made, mended.made.octree.undecided,
                   Proof::AllOfBest, progress);
    const auto take_wide = [&] {
        mended.made = std::move(wide->made), mended.certificate = std::move(wide->certificate);
        wide.reset(); // it is taken once
    };
    if (progress.cancelled) mended.made.failure = Failure::Cancelled;
    if (progress.cancelled || (unseen && !wide)) return mended;
    if (unseen || (wide && wide->certificate.certified())) {
        take_wide();
        return mended;
    }
    mended.certificate = certify(field, settings, mended.made, nullptr, progress);
    if (!wide && !progress.cancelled) { // what corners show may be crumbs
        wide = draw_wider(scene, field, settings, mended.made, mended.certificate.undecided,
                          Proof::AllOfBest, progress);
        if (wide && wide->certificate.certified()) {
            take_wide();
            return mended;
        }
    }
    OctreeSettings octree;
    octree.threads = threads_of(settings);
    const std::size_t before = mended.made.octree.nodes.size();
    const std::size_t most = before + std::max(before, least_growth);
    Depths depths;
    while (!progress.cancelled && mended.rounds < most_rounds) {
        const double left = double(most) - double(mended.made.octree.nodes.size());
        Choice choice = affordable(
            patients(mended.made, mended.certificate, field, octree.threads, progress, depths),
            mended.made.octree.lattice, left);
        std::vector<Cell> &divided = choice.cells;
        if (divided.empty() || progress.cancelled) break;
        const bool may_wait = !choice.hopeless && gain_may_be_late(mended.certificate, divided,
                                                                   mended.made.octree.lattice);
        const Certificate last = mended.certificate;
        if (!divide_again(field, settings, divided, most, false, mended, progress)) break;
        const bool gained =
            gains(last, mended.certificate, mended.made.octree.lattice, choice.hopeless);
        if (!gained && !may_wait) break;
    }
    const bool was_wider = wide.has_value();
    if (wide && !mended.certificate.near() &&
        doubt_of(wide->made, wide->certificate) < doubt_of(mended.made, mended.certificate))
        take_wide();
    if (!progress.cancelled)
        settle_shape(scene, field, settings, was_wider, most, mended, progress);
    if (mended.certificate.shape.doubted && wide && wide->certificate.near()) take_wide();
    if (progress.cancelled) mended.made.failure = Failure::Cancelled;
    return mended;
}

} // namespace fathom::mesh
