// See solid_box.h. A side of the extent is found by branch and bound: what lies beyond a plane is
// divided until all of it is known to be free, one of its points to be solid, or a cell is too small to
// matter.
#include "backend-cpu/prune/solid_box.h"

#include "backend-cpu/prune/shorten.h"
#include "ir/passes/operations.h"
#include "ir/view.h"

#include <algorithm>
#include <cmath>

namespace fathom::cpu {
namespace {

using ir::Box;

constexpr std::size_t cells_a_run = 8; // divided at once: 4 children each, with their middles
constexpr double first_share = 1.0 / 16, last_share = 1.0 / 512, // of the diagonal: how exactly
    reach_share = 1.0 / 128;
constexpr double max_work = 800'000;                    // kernels over a run of boxes
constexpr int min_runs = 32, max_runs = 3200;           // a side of the box
constexpr int min_reach_runs = 12, max_reach_runs = 80; // a direction
constexpr int max_rounds = 24;

double diagonal(const Box &box) {
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) sum += std::pow(box.hi[i] - box.lo[i], 2);
    return std::sqrt(sum);
}
double longest(const Box &box) {
    return std::max({box.hi[0] - box.lo[0], box.hi[1] - box.lo[1], box.hi[2] - box.lo[2]});
}
// How far from its middle all is free. Out where nobody looks unless bounds say so, what floats lose
// matters beside half the diagonal.
double reach(const Box &box) {
    double farthest = 0;
    for (std::size_t i = 0; i < 3; ++i)
        farthest = std::max({farthest, std::fabs(box.lo[i]), std::fabs(box.hi[i])});
    const double half = 0.5 * diagonal(box);
    return farthest <= endless_from ? half : half + 8 * std::ldexp(farthest, -23);
}
std::array<double, 3> middle(const Box &box) {
    std::array<double, 3> m{};
    for (std::size_t i = 0; i < 3; ++i) m[i] = 0.5 * (box.lo[i] + box.hi[i]);
    return m;
}

void cut(std::vector<Box> &boxes, std::size_t from, std::size_t axis, double at) {
    for (std::size_t k = from, end = boxes.size(); k < end; ++k) {
        boxes.push_back(boxes[k]);
        boxes[k].hi[axis] = boxes.back().lo[axis] = at;
    }
}

// Outward; `axis`: the one that it is along, and 3 for one that is along none.
struct Direction {
    std::array<double, 3> way{};
    std::size_t axis = 3;
    bool up = true;
};
Direction along(std::size_t axis, bool up) {
    Direction direction{{}, axis, up};
    direction.way[axis] = up ? 1 : -1;
    return direction;
}

// Cut by the plane that is so far out where that is in it and is along two axes, so that what is flat
// there is decided by slabs at once; else in the middle along its longest side, and along the next
// where that is not much shorter.
void divide(const Box &box, const Direction &direction, double plane, std::vector<Box> &into) {
    const std::size_t first = into.size(), axis = direction.axis;
    into.push_back(box);
    if (axis < 3) {
        const double at = direction.up ? plane : -plane;
        if (box.lo[axis] < at && at < box.hi[axis]) {
            cut(into, first, axis, at);
            return;
        }
    }
    std::array<std::size_t, 3> order{0, 1, 2};
    const auto width = [&](std::size_t i) { return box.hi[i] - box.lo[i]; };
    std::ranges::stable_sort(order, std::ranges::greater{}, width);
    const std::array<double, 3> at = middle(box);
    cut(into, first, order[0], at[order[0]]);
    if (width(order[1]) > 0.6 * width(order[0])) cut(into, first, order[1], at[order[1]]);
}

struct Search {
    const PruneProgram &parts;
    Shortener shortener;
    ShortTape whole;
    Boxes boxes;
    double a_box = 0;  // operations for a box, with loops counted out
    double &work;      // how many are left
    int most_runs = 0; // for a side

    Search(const PruneProgram &p, double operations, double &left)
        : parts(p), shortener(p), whole(whole_tape(p)), a_box(operations), work(left) {
        most_runs = std::clamp(static_cast<int>(max_work / (6 * std::max(whole.cost, 1.0f))),
                               min_runs, max_runs);
    }

    void put(std::size_t at, const std::array<double, 3> &lo, const std::array<double, 3> &hi) {
        for (std::size_t i = 0; i < 3; ++i) {
            boxes.lo[i][at] = static_cast<float>(lo[i]);
            boxes.hi[i][at] = static_cast<float>(hi[i]);
        }
    }

    // How far along a direction the solid in `domain` reaches, no more than about `fine` too far unless
    // `most` runs do not tell; none: there is no solid. Halves what may be, for it takes the less to see that a part is free
    // the farther that is from the solid.
    std::optional<double> side(const Box &domain, const Direction &direction, double fine,
                               int most) {
        struct Cell {
            Box box;
            double value = 0; // at its middle
            std::size_t number = 0;
        };
        const auto far_of = [&](const Box &box) { return ir::reach_of(box, direction.way); };
        // The nearest to a solid first, then the newest.
        const auto later = [](const Cell &a, const Cell &b) {
            return a.value != b.value ? a.value > b.value : a.number < b.number;
        };
        constexpr double nowhere = -std::numeric_limits<double>::infinity();
        std::vector<Cell> cells{{domain, 0, 0}}, aside; // a heap; and those that end before `plane`
        std::size_t made = 1;
        double known = nowhere, far = far_of(domain);
        std::vector<Box> children;
        int runs = 0;
        while (far > known + fine) {
            const double plane =
                known == nowhere ? nowhere : std::max(0.5 * (known + far), known + 0.5 * fine);
            const auto ends_before = [&](const Cell &cell) { return far_of(cell.box) <= plane; };
            const auto again = std::stable_partition(aside.begin(), aside.end(), ends_before);
            for (auto cell = again; cell != aside.end(); ++cell) {
                cells.push_back(*cell);
                std::push_heap(cells.begin(), cells.end(), later);
            }
            aside.erase(again, aside.end());
            const double before = known;
            while (!cells.empty() && known == before) {
                children.clear();
                for (std::size_t k = 0; k < cells_a_run && !cells.empty();) {
                    std::pop_heap(cells.begin(), cells.end(), later);
                    if (ends_before(cells.back()))
                        aside.push_back(cells.back());
                    else
                        divide(cells.back().box, direction, plane, children), ++k;
                    cells.pop_back();
                }
                if (children.empty()) break;
                if (work < 16 * a_box) work = 0;
                if (runs++ == most || work <= 0) return far;
                const std::size_t count = children.size(), padded = (2 * count + 15) / 16 * 16;
                for (std::size_t k = 0; k < padded; ++k) {
                    const Box &child = children[std::min(k % count, count - 1)];
                    if (k < count)
                        put(k, child.lo, child.hi);
                    else
                        put(k, middle(child), middle(child));
                }
                boxes.count = padded;
                work -= a_box * static_cast<double>(padded);
                run_values(parts, shortener, whole.selection(parts), boxes);
                for (std::size_t k = 0; k < count; ++k) {
                    const std::array<double, 3> at = middle(children[k]);
                    const double end = far_of(children[k]);
                    // Nothing solid by its range, or by the step that is safe from its middle.
                    const double value = shortener.result_lo[count + k];
                    if (shortener.result_lo[k] > 0 || value > reach(children[k])) continue;
                    // All of it is, or it is too small to matter.
                    if (shortener.result_hi[k] <= 0 || longest(children[k]) <= 0.5 * fine)
                        known = std::max(known, end);
                    else if (shortener.result_hi[count + k] <= 0)
                        known = std::max(known, far_of({at, at}));
                    cells.push_back({children[k], value, made++});
                    std::push_heap(cells.begin(), cells.end(), later);
                }
            }
            if (known != before) continue;
            if (known == nowhere) return std::nullopt;
            far = plane;
        }
        return far;
    }
};

} // namespace

Extent hull(Extent a, const Extent &b) {
    a.box = ir::hull(a.box, b.box);
    a.reach.resize(b.reach.size(), -std::numeric_limits<double>::infinity());
    for (std::size_t k = 0; k < b.reach.size(); ++k) a.reach[k] = std::max(a.reach[k], b.reach[k]);
    return a;
}

Extent solid_extent(const ir::Scene &scene, ir::FunctionId distance, const ir::Box &domain,
                    std::span<const std::array<double, 3>> directions, double time, double &work) {
    const Program program = compile(scene, distance, Choices::Apart);
    const PruneProgram parts = prune_program_of(program, inputs_of(scene, time));
    Search search(parts, ir::operations(scene.graph, scene.graph.function(distance).result), work);
    Extent extent{domain, {}};
    extent.reach.assign(directions.size(), -std::numeric_limits<double>::infinity());
    Box &box = extent.box;
    // Coarsely until the box stays, then as exactly as is wanted.
    double share = first_share;
    for (int round = 0; round < max_rounds; ++round) {
        const double before = diagonal(box);
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (const bool up : {true, false}) {
                const std::optional<double> found =
                    search.side(box, along(axis, up), share * before, search.most_runs);
                if (!found) {
                    box = {};
                    return extent;
                }
                (up ? box.hi : box.lo)[axis] = up ? *found : -*found;
            }
        const bool stays = diagonal(box) > 0.8 * before;
        if (share == last_share && stays) break;
        if (stays) share = last_share;
    }
    const int reach_runs = std::clamp(search.most_runs / 32, min_reach_runs, max_reach_runs);
    for (std::size_t k = 0; k < directions.size(); ++k)
        extent.reach[k] = search.side(box, {directions[k]}, reach_share * diagonal(box), reach_runs)
                              .value_or(ir::reach_of(box, directions[k]));
    return extent;
}

ir::Box solid_box(const ir::Scene &scene, ir::FunctionId distance, const ir::Box &domain,
                  double time, double &work) {
    return solid_extent(scene, distance, domain, {}, time, work).box;
}

} // namespace fathom::cpu
