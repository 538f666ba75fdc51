// See solid_box.h. A side of the box is found by branch and bound: the cell that reaches farthest
// is divided until one of its points is known to be solid, or it is smaller than what matters.
#include "backend-cpu/prune/solid_box.h"

#include "backend-cpu/prune/shorten.h"
#include "ir/passes/operations.h"

#include <algorithm>
#include <cmath>

namespace fathom::cpu {
namespace {

using ir::Box;

constexpr std::size_t cells_a_run = 8; // divided at once: 4 children each, with their middles
constexpr double first_share = 1.0 / 16, last_share = 1.0 / 512; // of the diagonal: how exactly
constexpr double max_work = 100'000;                             // kernels over a run of boxes
constexpr int min_runs = 32, max_runs = 400;                     // a side
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

// The halves of a box, in order to know where the solid ends along an axis: along that one until
// they are thin, for what is flat there is decided by thin slabs at once; else along the others. A
// slab gets narrower as the cube root of how thin it is, both as shares of the domain.
void divide(const Box &box, const Box &domain, std::size_t axis, double fine,
            std::vector<Box> &into) {
    const auto width = [](const Box &of, std::size_t i) { return of.hi[i] - of.lo[i]; };
    const std::size_t b = (axis + 1) % 3, c = (axis + 2) % 3;
    const double across = std::max(width(box, b), width(box, c));
    const double share = across / std::max({width(domain, b), width(domain, c), 1e-300});
    const double thin = width(box, axis);
    const bool along = thin > fine && thin > width(domain, axis) * share * share * share;
    const std::array<double, 3> cut = middle(box);
    const std::size_t first = into.size();
    into.push_back(box);
    for (std::size_t i = 0; i < 3; ++i) {
        if ((i == axis) != along || (!along && width(box, i) < across / 2)) continue;
        for (std::size_t k = first, end = into.size(); k < end; ++k) {
            into.push_back(into[k]);
            into[k].hi[i] = into.back().lo[i] = cut[i];
        }
    }
}

struct Search {
    const PruneProgram &parts;
    Shortener shortener;
    ShortTape whole;
    Boxes boxes;
    double a_box = 0; // operations for a box, with loops counted out
    double &work;     // how many are left
    int runs = 0;     // allowed for a side

    Search(const PruneProgram &p, double operations, double &left)
        : parts(p), shortener(p), whole(whole_tape(p)), a_box(operations), work(left) {
        runs = std::clamp(static_cast<int>(max_work / (6 * std::max(whole.cost, 1.0f))), min_runs,
                          max_runs);
    }

    void put(std::size_t at, const std::array<double, 3> &lo, const std::array<double, 3> &hi) {
        for (std::size_t i = 0; i < 3; ++i) {
            boxes.lo[i][at] = static_cast<float>(lo[i]);
            boxes.hi[i][at] = static_cast<float>(hi[i]);
        }
    }

    // How far along an axis, up or down, the solid in `domain` reaches, no more than `fine` too
    // far; none: there is no solid.
    std::optional<double> side(const Box &domain, std::size_t axis, bool up, double fine) {
        struct Cell {
            Box box;
            double far = 0;
            std::size_t number = 0;
        };
        const auto far_of = [&](const Box &box) { return up ? box.hi[axis] : -box.lo[axis]; };
        // The farthest first; of those the smallest, then the newest.
        const auto later = [](const Cell &a, const Cell &b) {
            if (a.far != b.far) return a.far < b.far;
            const double x = longest(a.box), y = longest(b.box);
            return x != y ? x > y : a.number < b.number;
        };
        std::vector<Cell> heap{{domain, far_of(domain), 0}};
        std::size_t made = 1;
        double known = -std::numeric_limits<double>::infinity(); // a solid point is there
        std::vector<Box> children;
        for (int run = 0; !heap.empty(); ++run) {
            const Cell &top = heap.front();
            if (work < 16 * a_box) work = 0;
            if (run == runs || work <= 0 || top.far <= known + fine || longest(top.box) <= fine)
                return up ? top.far : -top.far;
            children.clear();
            for (std::size_t k = 0; k < cells_a_run && !heap.empty(); ++k) {
                std::pop_heap(heap.begin(), heap.end(), later);
                divide(heap.back().box, domain, axis, fine, children);
                heap.pop_back();
            }
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
                const double far = far_of(children[k]), at = middle(children[k])[axis];
                // Nothing solid by its range, or by the step that is safe from its middle.
                if (shortener.result_lo[k] > 0 ||
                    shortener.result_lo[count + k] > reach(children[k]))
                    continue;
                if (shortener.result_hi[k] <= 0) known = std::max(known, far);
                if (shortener.result_hi[count + k] <= 0) known = std::max(known, up ? at : -at);
                heap.push_back({children[k], far, made++});
                std::push_heap(heap.begin(), heap.end(), later);
            }
        }
        return std::nullopt;
    }
};

} // namespace

ir::Box solid_box(const ir::Scene &scene, ir::FunctionId distance, const ir::Box &domain,
                  double time, double &work) {
    const Program program = compile(scene, distance, Choices::Apart);
    const PruneProgram parts = prune_program_of(program, inputs_of(scene, time));
    Search search(parts, ir::operations(scene.graph, scene.graph.function(distance).result), work);
    Box box = domain;
    // Coarsely until the box stays, then as exactly as is wanted.
    double share = first_share;
    for (int round = 0; round < max_rounds; ++round) {
        const double before = diagonal(box);
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (const bool up : {true, false}) {
                const std::optional<double> found = search.side(box, axis, up, share * before);
                if (!found) return {};
                (up ? box.hi : box.lo)[axis] = *found;
            }
        if (share == last_share) break;
        if (round + 2 >= max_rounds || diagonal(box) > 0.8 * before) share = last_share;
    }
    return box;
}

} // namespace fathom::cpu
