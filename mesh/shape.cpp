#include "mesh/shape.h"

#include "mesh/facets.h"
#include "mesh/shape_area.h"

#include <algorithm>
#include <cmath>

namespace fathom::mesh {
namespace {

constexpr int halvings_of_leaf = 3; // of a leaf
constexpr int most_joined = 2;      // levels above the drawing level that are looked at first
constexpr std::size_t tasks_at_once = 8;
constexpr int most_failed = 8;         // boxes above leaves; more of that size are not looked at
constexpr std::size_t hopeless = 16;   // leaves of a task of which no slopes are known, or
constexpr std::size_t too_many = 64;   // … in which it is open: no more looks
constexpr double work_a_leaf = 100;    // kernels, that may be taken in any case
constexpr double least_of_task = 5000; // kernels
constexpr double most_shares = 8;      // of the work by leaves, that a task may take
constexpr double looks_of_gradients = 0.5; // at a box, that gradients at some places count for
constexpr double least_at_edges = 1000;
constexpr double share_at_edges = 2; // of those taken, for the area across edges

// A leaf of the octree.
struct Leaf {
    Block box;
    std::uint8_t signs = 0;               // of its corners
    std::vector<std::uint32_t> touched{}; // the triangles that touch it
};

// One thread's memory.
struct ShapeProver {
    ShapeProver(const Field &field, const Octree &octree, const std::vector<Facet> &of)
        : splitter(field), facets(of), ulp(octree.lattice.ulp) {}
    Splitter splitter;
    const std::vector<Facet> &facets;
    const double ulp;
    double taken = 0, at_edges = 0;    // kernels; for the area of what lies across edges
    double kernels = 0;                // so many may be looked at yet
    std::optional<SteadyBox> steady{}; // of the box that was found to be so last,
    Block steady_in{};                 // … which this is
    std::optional<Unknown> unknown{};  // why the last box was not known
    ShapeSums sums{};                  // of steady boxes of a task
    std::array<int, 32> failed{}; // boxes of a level above leaves, one after the other, of a task

    Block grown(const Block &box) const {
        Block wide = box;
        for (std::size_t i = 0; i < 3; ++i) {
            wide.lo[i] = std::nextafter(static_cast<float>(box.lo[i] - ulp), -INFINITY);
            wide.hi[i] = std::nextafter(static_cast<float>(box.hi[i] + ulp), INFINITY);
        }
        return wide;
    }

    bool overlaps(const Facet &facet, const Block &wide) const {
        for (std::size_t i = 0; i < 3; ++i)
            if (facet.lo[i] > wide.hi[i] || facet.hi[i] < wide.lo[i]) return false;
        return true;
    }

    // Facets whose boxes touch a box: all that touch it, and some more.
    std::vector<std::uint32_t> overlapping(const Block &wide,
                                           const std::vector<std::uint32_t> &among) const {
        std::vector<std::uint32_t> found;
        for (const std::uint32_t t : among)
            if (overlaps(facets[t], wide)) found.push_back(t);
        return found;
    }

    std::vector<std::uint32_t> touching(const Block &wide,
                                        const std::vector<std::uint32_t> &among) const {
        Real3 middle{}, half{};
        for (std::size_t i = 0; i < 3; ++i) {
            middle[i] = 0.5 * (double(wide.lo[i]) + wide.hi[i]);
            half[i] = 0.5 * (double(wide.hi[i]) - wide.lo[i]);
        }
        std::vector<std::uint32_t> found;
        for (const std::uint32_t t : among)
            if (overlaps(facets[t], wide) && may_touch(facets[t].at, middle, half))
                found.push_back(t);
        return found;
    }

    // Steady; not known: then parts of the box are not known either.
    enum class Answer { Yes, No, Unknown };

    // The gradients at some places of a box, each of length 1.
    void see_gradients(const cpu::ShortTape &tape, const Block &wide,
                       std::vector<Real3> &directions) {
        Points places;
        places.add(middle_point(wide.lo, wide.hi));
        for (int c = 0; c < 8; ++c) {
            Point corner = wide.lo;
            for (std::size_t i = 0; i < 3; ++i)
                if (c >> i & 1) corner[i] = wide.hi[i];
            places.add(corner);
        }
        std::array<std::vector<float>, 4> found;
        gradients_at(splitter.evaluator, tape, places, found);
        for (std::size_t k = 0; k < places.size(); ++k)
            if (const auto way = unit_of({found[1][k], found[2][k], found[3][k]}))
                directions.push_back(*way);
        spend(looks_of_gradients * tape.cost);
    }

    void spend(double cost) { kernels -= cost, taken += cost; }

    // Whether there is a way along which the field rises all over a box, and all triangles that touch
    // it are passed outward.
    Answer is_steady(const cpu::ShortTape &tape, const Block &wide,
                     const std::vector<std::uint32_t> &touched) {
        Evaluator &evaluator = splitter.evaluator;
        std::vector<Real3> directions; // of the triangles, outward
        for (const std::uint32_t t : touched) directions.push_back(facets[t].normal);
        const auto passes = [&](const Real3 &way) {
            return std::ranges::all_of(
                directions, [&](const Real3 &one) { return inner(one, way) > by_rounding; });
        };
        const std::optional<Real3> across = way_along(directions);
        if (!touched.empty() && !(across && passes(*across))) return Answer::No;
        spend(tape.cost);
        const std::optional<Rising> rising = rising_over(evaluator, tape, splitter.boxes, wide.lo,
                                                         wide.hi, across.value_or(Real3{}));
        if (!rising) {
            unknown = why_unknown(evaluator, tape);
            return Answer::Unknown;
        }
        const Linear &linear = rising->linear;
        const auto is_so = [&](const Real3 &way, double least) {
            steady = steady_box(linear, way, least), steady_in = wide;
            return Answer::Yes;
        };
        if (across && rising->least > by_rounding) return is_so(*across, rising->least);
        const std::optional<Real3> mean =
            unit_of({linear.slope[0], linear.slope[1], linear.slope[2]});
        std::optional<Real3> both;
        if (mean && across) both = unit_of(along(*mean, *across, 1));
        for (const std::optional<Real3> &way : {mean, both}) {
            if (!way || !passes(*way)) continue;
            double rise = 0, size = 0;
            for (std::size_t i = 0; i < 3; ++i) {
                rise += (*way)[i] * linear.slope[i] - std::fabs((*way)[i]) * linear.spread[i];
                size += std::fabs(linear.slope[i]) + linear.spread[i];
            }
            if (rise > by_rounding * size) return is_so(*way, rise);
        }
        // Where gradients that are seen go against each other there is no such way.
        see_gradients(tape, wide, directions);
        const std::optional<Real3> seen = way_along(directions);
        if (!seen || !passes(*seen)) return Answer::No;
        spend(tape.cost);
        const std::optional<double> rise =
            least_slope_along(evaluator, tape, splitter.boxes, wide.lo, wide.hi,
                              {(*seen)[0], (*seen)[1], (*seen)[2]});
        return rise && *rise > by_rounding ? is_so(*seen, *rise) : Answer::No;
    }

    // After a box was found to be steady: takes in what parts of it measure.
    void measure(const cpu::ShortTape &tape, std::span<const Block> parts) {
        constexpr double poor = 4;
        const auto may_look = [&] { return at_edges < share_at_edges * taken + least_at_edges; };
        if (steady->slant.most > poor) {
            const Block wide = steady_in;
            const std::optional<Slant> other = slant_in(splitter.evaluator, tape, splitter.boxes,
                                                        wide.lo, wide.hi, steady->linear);
            if (other && other->most < steady->slant.most) steady->slant = *other;
        }
        const ShapeSums found = sums_in_parts(splitter, tape, *steady, parts, may_look());
        at_edges += found.looks * tape.cost;
        sums.add(found);
    }

    // Whether a point of a leaf that no triangle touches lies inside of the mesh, by the ways to it from
    // the leaf's corners; none where all pass too near to a triangle's side.
    std::optional<bool> is_inside(const Real3 &point, const Leaf &leaf) const {
        for (int c = 0; c < 8; ++c) {
            Real3 from{};
            for (std::size_t i = 0; i < 3; ++i)
                from[i] = (c >> i & 1 ? leaf.box.hi : leaf.box.lo)[i];
            bool inside = leaf.signs >> c & 1, sure = true;
            for (const std::uint32_t t : leaf.touched) {
                const std::optional<bool> crossed = crosses(from, point, facets[t].at);
                sure = sure && crossed;
                inside = inside != crossed.value_or(false);
            }
            if (sure) return inside;
        }
        return std::nullopt;
    }

    // Whether each part of a box is steady, but for those that neither surface nor mesh is in, and that
    // lie on the same side of both.
    Answer prove(const cpu::ShortTape &tape, const Block &box, const Leaf &leaf,
                 const std::vector<std::uint32_t> &among, int halvings) {
        const Block wide = grown(box);
        const std::vector<std::uint32_t> touched = touching(wide, among);
        const Answer answer = is_steady(tape, wide, touched);
        if (answer == Answer::Yes) measure(tape, {&box, 1});
        if (answer != Answer::No || halvings == 0 || kernels < 0) return answer;
        std::array<Block, 8> parts;
        cpu::Boxes &boxes = splitter.boxes;
        boxes.count = 16;
        double squares = 0;
        for (std::size_t k = 0; k < 8; ++k) {
            parts[k] = box;
            squares = 0;
            for (std::size_t i = 0; i < 3; ++i) {
                const float cut = 0.5f * (box.lo[i] + box.hi[i]);
                (k >> i & 1 ? parts[k].lo : parts[k].hi)[i] = cut;
                const float lo = parts[k].lo[i], hi = parts[k].hi[i];
                boxes.lo[i][k] = lo, boxes.hi[i][k] = hi;
                boxes.lo[i][8 + k] = boxes.hi[i][8 + k] = 0.5f * (lo + hi);
                squares += std::pow(double(hi) - lo, 2);
            }
        }
        ranges_over(splitter.evaluator, tape, boxes);
        std::array<Space, 8> space{};
        for (std::size_t k = 0; k < 8; ++k)
            space[k] = space_of(splitter.evaluator, k, 0.5 * std::sqrt(squares), ulp, true);
        for (std::size_t k = 0; k < 8; ++k) {
            if (space[k] != Space::Open && touching(grown(parts[k]), touched).empty()) {
                const std::optional<bool> inside = is_inside(real(parts[k].lo), leaf);
                if (inside != (space[k] == Space::Inside)) return Answer::No;
                const double volume = whole_of(parts[k]), solid = *inside ? volume : 0;
                sums.add({{}, {solid, solid}, volume, 0});
                continue;
            }
            const Answer part = prove(tape, parts[k], leaf, touched, halvings - 1);
            if (part != Answer::Yes) return part;
        }
        return Answer::Yes;
    }
};

// What is known of the leaves of a task.
struct ShapeFound {
    bool looked = false;
    std::size_t open = 0;         // leaves in which it is not known
    Real3 place{};                // one of them
    std::size_t unknown = 0;      // of these, those of which no slopes are known,
    std::optional<Unknown> why{}; // … of the one about the place
    std::size_t unseen = 0;       // those that were not looked at,
    bool dear = false;            // … since that takes too much
    std::vector<Cell> cells;      // those that smaller ones may tell of
    ShapeSums sums;
};

// The leaves of a task.
struct ShapeTask {
    const Octree &octree;
    const Lattice &lattice;
    const Grid &grid;
    const std::vector<Cell> &leaves;
    TapePtr tape{}; // that holds about all of them

    Block box_of(const Cell &leaf, int level) const {
        const std::int32_t side = lattice.cells(level);
        Index at = leaf.at;
        for (std::int32_t &x : at) x -= x % side;
        return {point_of(lattice, at), point_of(lattice, corner(at, side, 7))};
    }

    // Leaves from `first` to before `last`, all in one cell of the level.
    void prove(ShapeProver &prover, std::size_t first, std::size_t last, int level,
               ShapeFound &found) const {
        const Block box = box_of(leaves[first], level), wide = prover.grown(box);
        const auto leave_open = [&](std::size_t count) {
            for (std::size_t i = 0; found.open == 0 && i < 3; ++i)
                found.place[i] = 0.5 * (double(box.lo[i]) + box.hi[i]);
            found.open += count;
        };
        if (found.unknown >= hopeless || found.open >= too_many || prover.kernels < 0) {
            found.unseen += last - first;
            found.dear = found.dear || prover.kernels < 0;
            return leave_open(last - first);
        }
        std::vector<std::uint32_t> near;
        grid.find(real(wide.lo), real(wide.hi), near);
        const TapePtr shorter = tape_in(prover.splitter, tape, wide);
        if (level == leaves[first].level) {
            const Leaf leaf{box, octree.nodes[static_cast<std::size_t>(leaves[first].node)].signs,
                            prover.touching(wide, near)};
            const auto answer = prover.prove(*shorter, box, leaf, leaf.touched, halvings_of_leaf);
            if (answer == ShapeProver::Answer::Yes) return;
            if (answer == ShapeProver::Answer::No) found.cells.push_back(leaves[first]);
            leave_open(1);
            if (answer != ShapeProver::Answer::Unknown) return;
            if (found.unknown++ > 0) return;
            for (std::size_t i = 0; i < 3; ++i)
                found.place[i] = 0.5 * (double(box.lo[i]) + box.hi[i]);
            found.why = prover.unknown;
            return;
        }
        int &failed = prover.failed[static_cast<std::size_t>(level)];
        if (last - first > 1 && failed < most_failed) {
            if (prover.is_steady(*shorter, wide, prover.overlapping(wide, near)) ==
                ShapeProver::Answer::Yes) {
                failed = 0;
                std::vector<Block> parts;
                for (std::size_t k = first; k < last; ++k)
                    parts.push_back(box_of(leaves[k], leaves[k].level));
                prover.measure(*shorter, parts);
                return;
            }
            ++failed;
        }
        for (std::size_t k = first, next; k < last; k = next) {
            const Point at = box_of(leaves[k], level + 1).lo;
            for (next = k + 1; next < last && box_of(leaves[next], level + 1).lo == at;) ++next;
            prove(prover, k, next, level + 1, found);
        }
    }

    void prove_all(ShapeProver &prover, ShapeFound &found) {
        constexpr float far = std::numeric_limits<float>::infinity();
        Block all{{far, far, far}, {-far, -far, -far}};
        const int level = std::max(lattice.level - most_joined, 0);
        for (const Cell &leaf : leaves) {
            const Block box = box_of(leaf, std::min(level, leaf.level));
            for (std::size_t i = 0; i < 3; ++i) {
                all.lo[i] = std::min(all.lo[i], box.lo[i]);
                all.hi[i] = std::max(all.hi[i], box.hi[i]);
            }
        }
        tape = tape_in(prover.splitter, prover.splitter.evaluator.field.whole, prover.grown(all));
        prover.failed = {};
        prover.sums = {};
        prover.taken = prover.at_edges = 0;
        found.looked = true;
        for (std::size_t k = 0, next; k < leaves.size(); k = next) {
            const int of = std::min(level, leaves[k].level);
            const Point at = box_of(leaves[k], of).lo;
            for (next = k + 1; next < leaves.size() && box_of(leaves[next], of).lo == at;) ++next;
            prove(prover, k, next, of, found);
        }
        found.sums = prover.sums;
    }
};

std::int32_t task_of(const Octree &octree, const std::vector<Cell> &leaves) {
    return octree.nodes[static_cast<std::size_t>(leaves[0].node)].task;
}

// Takes what was proved of a task before, if no triangle has changed near to it: boxes of its leaves are
// four cells long, and what is not around a divided cell is eight from there.
bool take_from(const Earlier *earlier, const ShapeTask &task, ShapeFound &found) {
    if (!earlier) return false;
    const auto &proved = earlier->certificate.shape.proved_tasks;
    const auto before =
        std::ranges::find(proved, task_of(task.octree, task.leaves), &ShapeOfTask::task);
    if (before == proved.end()) return false;
    for (const Cell &leaf : task.leaves)
        if (earlier->changed.around(real(point_of(task.lattice, leaf.at)))) return false;
    found.looked = true;
    found.sums = {before->area, before->volume, before->whole, 0};
    return true;
}

// The leaves that surface or mesh may go through, as a certificate knows, by their task.
std::vector<std::vector<Cell>> leaves_by_task(const Made &made, const Certificate &certificate) {
    std::vector<std::int32_t> drawn, free;
    for (const Patch &patch : made.loops.patches) drawn.push_back(patch.cell.node);
    std::ranges::sort(drawn);
    free = certificate.empty;
    std::ranges::sort(free);
    std::vector<std::vector<Cell>> tasks(made.octree.tapes.size());
    for (const Cell &leaf : open_leaves(made.octree)) {
        if (std::ranges::binary_search(free, leaf.node) &&
            !std::ranges::binary_search(drawn, leaf.node))
            continue;
        const Node &node = made.octree.nodes[static_cast<std::size_t>(leaf.node)];
        tasks[static_cast<std::size_t>(node.task)].push_back(leaf);
    }
    std::erase_if(tasks, [](const std::vector<Cell> &task) { return task.empty(); });
    return tasks;
}

} // namespace

void prove_shape(const Field &field, const Settings &settings, const Made &made, Progress &progress,
                 Certificate &certificate, const Earlier *earlier, double work) {
    certificate.shape = ShapeAnswer{};
    if (made.simplified > 0 || made.widened != 0) return;
    const Lattice &lattice = made.octree.lattice;
    const std::vector<std::vector<Cell>> tasks = leaves_by_task(made, certificate);
    std::vector<Facet> facets;
    Grid grid(point_of(lattice, {0, 0, 0}), lattice.side(lattice.level));
    for (const auto &t : made.mesh.triangles) {
        const Facet &facet = facets.emplace_back(facet_of(made.mesh, t));
        grid.add(facet.lo, facet.hi, static_cast<std::uint32_t>(facets.size() - 1));
    }
    grid.sort();
    std::vector<ShapeFound> found(tasks.size());
    std::vector<std::size_t> asked; // tasks of which nothing is known from before
    std::size_t leaves = 0;
    for (std::size_t k = 0; k < tasks.size(); ++k) {
        if (take_from(earlier, {made.octree, lattice, grid, tasks[k]}, found[k])) continue;
        asked.push_back(k);
        leaves += tasks[k].size();
    }
    work = std::max(work, work_a_leaf * static_cast<double>(leaves));
    // Some tasks from everywhere at once: where they leave too much open the others say nothing more.
    const std::size_t rounds = (asked.size() + tasks_at_once - 1) / tasks_at_once;
    const double from = progress.from, to = progress.to;
    std::size_t open = 0;
    double left = work; // what tasks leave over others may take
    double looked = 0;  // leaves
    bool vain = false;
    std::vector<double> taken(tasks.size());
    for (std::size_t round = 0; round < rounds; ++round) {
        const auto count = (asked.size() - round + rounds - 1) / rounds;
        const auto number_of = [&](std::size_t k) { return asked[round + k * rounds]; };
        // What the rest would take, as far as those that were looked at tell.
        const double rest = looked > 0 ? (work - left) * (double(leaves) / looked - 1) : 0;
        vain = vain || (rest > left && left < work);
        if (open > few_open_leaves || vain) {
            for (std::size_t k = 0; k < count; ++k) {
                const std::vector<Cell> &unseen = tasks[number_of(k)];
                found[number_of(k)].open = found[number_of(k)].unseen = unseen.size();
                found[number_of(k)].dear = open <= few_open_leaves;
                found[number_of(k)].place = real(point_of(lattice, unseen[0].at));
            }
            continue;
        }
        progress.from = from + (to - from) * double(round) / double(rounds);
        progress.to = from + (to - from) * double(round + 1) / double(rounds);
        in_parallel(
            count, threads_of(settings), progress,
            [&] { return ShapeProver(field, made.octree, facets); },
            [&](ShapeProver &prover, std::size_t k) {
                ShapeTask task{made.octree, lattice, grid, tasks[number_of(k)]};
                const double share =
                    work * static_cast<double>(task.leaves.size()) / static_cast<double>(leaves);
                prover.kernels = std::max(least_of_task, most_shares * share);
                task.prove_all(prover, found[number_of(k)]);
                taken[number_of(k)] = prover.taken;
            });
        for (std::size_t k = 0; k < count; ++k) {
            open += found[number_of(k)].open;
            left -= taken[number_of(k)];
            looked += static_cast<double>(tasks[number_of(k)].size());
        }
    }
    progress.from = from, progress.to = to;
    ShapeAnswer &shape = certificate.shape;
    ShapeSums sums;
    int told = 0; // how much the place that is named tells: of one that was looked at, and of why
    for (std::size_t k = 0; k < found.size(); ++k) {
        const ShapeFound &of = found[k];
        sums.add(of.sums);
        if (of.looked && of.open == 0)
            shape.proved_tasks.push_back(
                {task_of(made.octree, tasks[k]), of.sums.area, of.sums.volume, of.sums.whole});
        shape.open += of.open, shape.unknown += of.unknown, shape.unseen += of.unseen;
        shape.dear = shape.dear || of.dear;
        shape.cells.insert(shape.cells.end(), of.cells.begin(), of.cells.end());
        const int tells = of.open == 0 ? 0 : of.why ? 3 : of.looked ? 2 : 1;
        if (tells <= told) continue;
        told = tells, shape.place = of.place, shape.why = of.why;
    }
    shape.proved = shape.open == 0 && !progress.cancelled;
    shape.area = {sums.area.lo * (1 - rounding_share), sums.area.hi * (1 + rounding_share)};
    // Of what is neither left out as inside or outside nor here, nothing is said.
    const double sizes = rounding_share * certificate.largest_volume;
    shape.volume = {certificate.least_volume + sums.volume.lo - sizes,
                    certificate.largest_volume - (sums.whole - sums.volume.hi) + sizes};
}

} // namespace fathom::mesh
