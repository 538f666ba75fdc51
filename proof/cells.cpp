// Bounds of a field that is steep in places, cell by cell (semantics.md, 13): a slope of 1,000 in a
// corner of its box does not slow the surface down. A box of cells is halved down to single cells;
// on the way, what is far from the surface is left as it is, and parts of the tape that a half does
// not need are not run in it (machine.h, needed). Proof: docs/lipschitz.md, 6.
#include "proof/cells.h"

#include "ir/lower/lower.h"
#include "ir/passes/inline.h"
#include "proof/prover.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fathom::proof {

using ir::NodeId;
using ir::Shape;
using ir::rounding::infinity;

namespace {

constexpr int fewest = 4;               // cells along the longest side
constexpr double lead = 0.25;           // the margin, in the smallest side of a cell
constexpr double flattest = 1e-6;       // of the bound for all of the region
constexpr double float_slack = 1e-3;    // of a margin: what float32 makes of a point's cell
constexpr double look_up_cost = 30;     // operations that a look-up takes
constexpr double least_gain = 1.2;      // beside what a look-up costs
constexpr double good = 1.4;            // a bound over a slope seen, from which on it is kept
constexpr double good_anyway = 0.75;    // … over the largest slope seen in all cells
constexpr int deepest = 6, shallow = 3; // halvings of a cell, with surface and without
constexpr double shortest_way = 0.02;   // of a cell's side: what is less is none

// Cells from `lo` to before `hi`.
struct Block {
    std::array<int, 3> lo{}, hi{};
    bool single() const { return hi[0] - lo[0] + hi[1] - lo[1] + hi[2] - lo[2] == 3; }
};

enum class Holds : std::uint8_t { Nothing, Surface, Solid };

class Search {
  public:
    Search(Machine &machine, const Domain &domain, double whole, double seen, const CellAim &aim,
           ir::CellBounds &out)
        : machine_(machine), domain_(domain), whole_(whole), seen_in_all_(seen), aim_(aim),
          out_(out), all_(machine.all_steps()) {}

    // False: the table would be dropped, and is not made. `most`: of the mean bound beside the
    // surface.
    bool run(double most) {
        lay_out();
        if (!promises(most)) return false;
        const Block whole{{0, 0, 0}, out_.count};
        look(whole, all_);
        find_near();
        begun_ = machine_.work();
        refine(whole, all_);
        find_ways();
        finish();
        return true;
    }
    // Of the cells beside the surface, what a step is divided by.
    double mean_near() const {
        double sum = 0;
        for (std::size_t i = 0; i < near_.size(); ++i)
            if (near_[i]) sum += out_.lipschitz[i];
        return near_count_ > 0 ? sum / double(near_count_) : whole_;
    }

  private:
    std::size_t index(int x, int y, int z) const {
        return std::size_t((z * out_.count[1] + y) * out_.count[0] + x);
    }
    template <class F> void each(const Block &block, F act) {
        for (int z = block.lo[2]; z < block.hi[2]; ++z)
            for (int y = block.lo[1]; y < block.hi[1]; ++y)
                for (int x = block.lo[0]; x < block.hi[0]; ++x) act(index(x, y, z));
    }

    // As many cells as the aim has evaluations for, as nearly cubes as may be.
    void lay_out() {
        const Cell &box = domain_.box;
        double longest = 0;
        for (const Interval &side : box.p) longest = std::max(longest, side.width());
        const double most =
            double(aim_.instructions) / double(std::max<std::size_t>(all_.size(), 1));
        const double along =
            std::clamp(std::floor(std::cbrt(most)), double(fewest), double(aim_.along));
        shortest_ = infinity;
        for (std::size_t i = 0; i < 3; ++i) {
            const double width = box.p[i].width();
            out_.box.lo[i] = box.p[i].lo, out_.box.hi[i] = box.p[i].hi;
            out_.count[i] = std::max(int(std::lround(along * width / longest)), 1);
            size_[i] = width / out_.count[i];
            shortest_ = std::min(shortest_, size_[i]);
        }
        out_.margin = lead * shortest_;
        const std::size_t cells =
            std::size_t(out_.count[0]) * std::size_t(out_.count[1]) * std::size_t(out_.count[2]);
        out_.lipschitz.assign(cells, 0);
        out_.bend.assign(cells, 0);
        holds_.assign(cells, Holds::Nothing);
    }

    // The block's box, grown by `by` as far as the domain goes.
    Cell box_of(const Block &block, const std::array<double, 3> &by) const {
        Cell box;
        for (std::size_t i = 0; i < 3; ++i) {
            const double lo = out_.box.lo[i];
            box.p[i] = {std::max(lo + block.lo[i] * size_[i] - by[i], lo),
                        std::min(lo + block.hi[i] * size_[i] + by[i], out_.box.hi[i])};
        }
        return box;
    }
    Cell grown(const Block &block) const {
        const double by = out_.margin * (1 + float_slack);
        return box_of(block, {by, by, by});
    }
    bool misses_zone(const Cell &cell) const { return domain_.zone && misses(*domain_.zone, cell); }

    // What float32 may take for another sign counts as surface, too.
    Holds held(const Interval &value, double bound) const {
        const double doubt = 1e-6 * std::min(bound, whole_) * shortest_;
        return value.lo > doubt    ? Holds::Nothing
               : value.hi < -doubt ? Holds::Solid
                                   : Holds::Surface;
    }
    double bound_here() const { return std::min(machine_.norm(), whole_); }

    // The bounds of whole cells, and which may hold surface.
    void look(const Block &block, const Machine::Steps &steps) {
        const Cell box = block.single() ? grown(block) : box_of(block, size_);
        if (misses_zone(box)) return;
        machine_.run(box, steps);
        const double bound = bound_here(), bend = aim_.bends ? machine_.bend() : infinity;
        Holds holds = held(machine_.value(0), bound);
        if (block.single() && holds == Holds::Surface) holds = by_middle(box, bound, steps);
        if (block.single() || holds != Holds::Surface)
            return each(block, [&](std::size_t i) {
                out_.lipschitz[i] = bound, out_.bend[i] = bend, holds_[i] = holds;
                bends_known_ = bends_known_ || std::isfinite(bend);
            });
        halves(block, machine_.needed(steps),
               [&](const Block &half, const Machine::Steps &fewer) { look(half, fewer); });
    }
    // The mean value theorem from the middle.
    Holds by_middle(const Cell &box, double bound, const Machine::Steps &steps) {
        Cell middle;
        double squares = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            middle.p[i] = box.p[i].middle();
            squares += box.p[i].width() * box.p[i].width() / 4;
        }
        if (misses_zone(middle)) return Holds::Surface;
        machine_.run(middle, steps);
        const double reach = bound * std::sqrt(squares) * (1 + 1e-12);
        return held(machine_.value(0) + Interval(-reach, reach), bound);
    }
    template <class F> void halves(const Block &block, const Machine::Steps &steps, F act) {
        std::size_t axis = 0;
        double widest = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const double width = size_[i] * (block.hi[i] - block.lo[i]);
            if (block.hi[i] - block.lo[i] > 1 && width > widest) axis = i, widest = width;
        }
        Block left = block, right = block;
        left.hi[axis] = right.lo[axis] = (block.lo[axis] + block.hi[axis]) / 2;
        act(left, steps);
        act(right, steps);
    }

    // With surface, or next to a cell that has some.
    void find_near() {
        near_.assign(holds_.size(), false);
        const auto [nx, ny, nz] = out_.count;
        for (int z = 0; z < nz; ++z)
            for (int y = 0; y < ny; ++y)
                for (int x = 0; x < nx; ++x) {
                    if (holds_[index(x, y, z)] != Holds::Surface) continue;
                    const Block around{
                        {std::max(x - 1, 0), std::max(y - 1, 0), std::max(z - 1, 0)},
                        {std::min(x + 2, nx), std::min(y + 2, ny), std::min(z + 2, nz)}};
                    each(around, [&](std::size_t i) { near_[i] = true; });
                }
        near_count_ = std::size_t(std::count(near_.begin(), near_.end(), true));
    }

    // Of cells near the surface the greatest bound of their parts. (Not so of second derivatives: a
    // crease may lie between two parts.)
    void refine(const Block &block, const Machine::Steps &steps) {
        bool some = false;
        each(block, [&](std::size_t i) { some = some || near_[i]; });
        if (!some || machine_.work() - begun_ >= aim_.refining) return;
        const Cell box = block.single() ? grown(block) : box_of(block, size_);
        if (misses_zone(box)) return;
        if (block.single()) return refine_cell(block, box, steps);
        machine_.run(box, steps);
        halves(block, machine_.needed(steps),
               [&](const Block &half, const Machine::Steps &fewer) { refine(half, fewer); });
    }
    // Whether the mean bound beside the surface can come below `most`: tried on some of the cells
    // there, each with the work that it would have. So what gains nothing takes little.
    bool promises(double most) {
        constexpr std::size_t looked_at = 128, tried = 32, too_few = 12;
        constexpr double doubt = 1.1; // of a mean over so many cells
        constexpr std::size_t stride = 7919;
        const std::size_t cells = holds_.size();
        if (aim_.bends || cells < 4 * looked_at) return true; // by curvature they pay all the same
        std::vector<Block> beside;
        std::size_t looked = 0;
        for (; looked < looked_at && beside.size() < tried; ++looked) {
            const std::size_t i = looked * stride % cells;
            const auto nx = std::size_t(out_.count[0]), ny = std::size_t(out_.count[1]);
            const int x = int(i % nx), y = int(i / nx % ny), z = int(i / nx / ny);
            const Block block{{x, y, z}, {x + 1, y + 1, z + 1}};
            if (misses_zone(grown(block))) continue;
            machine_.run(grown(block), all_);
            const double bound = bound_here();
            const Interval value = machine_.value(0);
            const double reach = bound * *std::ranges::max_element(size_);
            if (value.lo > reach || value.hi < -reach) continue;
            out_.lipschitz[i] = bound, holds_[i] = held(value, bound);
            beside.push_back(block);
        }
        if (beside.size() < too_few) return true;
        near_count_ = cells * beside.size() / looked;
        begun_ = machine_.work();
        double sum = 0;
        for (const Block &block : beside) {
            refine_cell(block, grown(block), all_);
            sum += out_.lipschitz[index(block.lo[0], block.lo[1], block.lo[2])];
        }
        near_count_ = done_ = 0;
        std::ranges::fill(out_.lipschitz, 0);
        std::ranges::fill(holds_, Holds::Nothing);
        return sum <= most * doubt * double(beside.size());
    }
    void refine_cell(const Block &block, const Cell &box, const Machine::Steps &steps) {
        const std::size_t at = index(block.lo[0], block.lo[1], block.lo[2]);
        const std::size_t used = machine_.work() - begun_, left = near_count_ - done_++;
        const std::size_t spare = aim_.refining > used ? aim_.refining - used : 0;
        limit_ = machine_.work() + spare / std::max<std::size_t>(left, 1) * 3;
        seen_ = 0;
        Dice dice{0xce11};
        for (int k = 0; k < 2; ++k) {
            Cell point;
            for (std::size_t i = 0; i < 3; ++i)
                point.p[i] = box.p[i].lo + box.p[i].width() * (0.2 + 0.6 * dice.next());
            if (misses_zone(point)) continue;
            machine_.run(point, steps);
            if (machine_.norm() != infinity) seen_ = std::max(seen_, machine_.norm());
        }
        // Each time eight times as many parts, until the bound is good or the work is spent.
        const int most = holds_[at] == Holds::Surface ? deepest : shallow;
        for (int depth = 0; depth <= most; depth += 3) {
            Part part;
            if (!add_part(box, steps, depth, part)) return;
            out_.lipschitz[at] = std::min(out_.lipschitz[at], part.bound);
            if (!part.surface && holds_[at] == Holds::Surface) holds_[at] = part.sign;
            if (is_good(part.bound)) return;
        }
    }
    bool is_good(double bound) const {
        return bound <= std::max({good * seen_, good_anyway * seen_in_all_, 1e-5 * whole_});
    }
    struct Part { // of the parts looked at so far
        double bound = 0;
        bool surface = false;
        Holds sign = Holds::Nothing;
    };
    // False where the work is spent before all is looked at.
    bool add_part(const Cell &box, const Machine::Steps &steps, int depth, Part &all) {
        if (misses_zone(box)) return true;
        if (machine_.work() > limit_) return false;
        machine_.run(box, steps);
        const double bound = bound_here();
        const Holds holds = held(machine_.value(0), bound);
        if (depth > 0 && (holds == Holds::Surface || !is_good(bound))) {
            const Machine::Steps fewer = machine_.needed(steps);
            std::size_t axis = 0;
            for (std::size_t i = 1; i < 3; ++i)
                if (box.p[i].width() > box.p[axis].width()) axis = i;
            Cell left = box, right = box;
            left.p[axis].hi = right.p[axis].lo = box.p[axis].middle();
            return add_part(left, fewer, depth - 1, all) && add_part(right, fewer, depth - 1, all);
        }
        all.bound = std::max(all.bound, bound);
        all.surface = all.surface || holds == Holds::Surface;
        all.sign = holds;
        return true;
    }

    // From each cell outside the solid to the nearest cell with surface: squares of ways, axis by
    // axis.
    void find_ways() {
        std::vector<double> squares(holds_.size());
        for (std::size_t i = 0; i < squares.size(); ++i)
            squares[i] = holds_[i] == Holds::Surface ? 0 : infinity;
        const std::array<std::size_t, 3> stride{
            1, std::size_t(out_.count[0]), std::size_t(out_.count[0]) * std::size_t(out_.count[1])};
        std::vector<double> line;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto n = std::size_t(out_.count[axis]);
            line.resize(n);
            for (std::size_t first = 0; first < squares.size(); ++first) {
                if (first / stride[axis] % n != 0) continue;
                for (std::size_t i = 0; i < n; ++i) {
                    line[i] = infinity;
                    for (std::size_t j = 0; j < n; ++j) {
                        const auto apart = double(i > j ? i - j : j - i);
                        const double gap = std::max(apart - 1, 0.0) * size_[axis];
                        line[i] = std::min(line[i], squares[first + j * stride[axis]] + gap * gap);
                    }
                }
                for (std::size_t i = 0; i < n; ++i) squares[first + i * stride[axis]] = line[i];
            }
        }
        double diagonal = 0;
        for (std::size_t i = 0; i < 3; ++i)
            diagonal += std::pow(out_.box.hi[i] - out_.box.lo[i], 2);
        out_.way.assign(squares.size(), 0);
        for (std::size_t i = 0; i < squares.size(); ++i) {
            if (holds_[i] != Holds::Nothing) continue;
            const double way = std::sqrt(std::min(squares[i], diagonal)) * (1 - 1e-6) -
                               2 * float_slack * shortest_;
            if (way > shortest_way * shortest_) out_.way[i] = way;
        }
    }

    void finish() {
        // Not near 0: where a field is flat, steps end with the cell.
        for (double &bound : out_.lipschitz)
            bound = std::max(bound * (1 + 1e-6), flattest * whole_);
        for (double &bend : out_.bend)
            bend = std::max(bend * (1 + 1e-4), flattest * whole_ / shortest_); // float32's root
        if (!bends_known_) out_.bend.clear();
    }

    Machine &machine_;
    const Domain &domain_;
    const double whole_, seen_in_all_; // the bound for all cells, and the largest slope seen
    const CellAim &aim_;
    ir::CellBounds &out_;
    const Machine::Steps all_;
    std::array<double, 3> size_{}; // of a cell
    double shortest_ = 0;
    std::vector<Holds> holds_;
    std::vector<bool> near_;
    bool bends_known_ = false;
    std::size_t near_count_ = 0, done_ = 0, begun_ = 0, limit_ = 0;
    double seen_ = 0; // the largest slope at points of the cell that is refined
};

} // namespace

std::optional<ir::CellBounds> bound_cells(Flattening &context, const Ranges &ranges, NodeId field,
                                          const Domain &domain, double whole, const CellAim &aim) {
    const Cell &box = domain.box;
    for (const Interval &side : box.p)
        if (!side.finite() || !(side.width() > 0)) return std::nullopt;
    const Tape tape = flatten(context, field);
    if (tape.too_large || tape.length() * 64 > aim.instructions) return std::nullopt;
    Machine machine(tape, ranges, aim.bends);
    machine.narrow_still();
    // Where it is everywhere about as steep, one bound says as much.
    std::vector<double> slopes;
    Dice dice{0xce11};
    for (int i = 0; i < 64; ++i) {
        Cell point;
        for (std::size_t a = 0; a < 3; ++a)
            point.p[a] = box.p[a].lo + box.p[a].width() * dice.next();
        if (domain.zone && misses(*domain.zone, point)) continue;
        machine.run(point);
        slopes.push_back(machine.norm());
    }
    if (slopes.empty()) return std::nullopt;
    std::nth_element(slopes.begin(), slopes.begin() + std::ptrdiff_t(slopes.size() / 2),
                     slopes.end());
    const double enough =
        aim.gain * (1 + aim.look_up / double(std::max<std::size_t>(tape.length(), 1)));
    if (slopes[slopes.size() / 2] * enough > whole) return std::nullopt;
    const double seen =
        *std::ranges::max_element(slopes, {}, [](double x) { return std::isfinite(x) ? x : 0; });
    ir::CellBounds out;
    Search search(machine, domain, whole, std::isfinite(seen) ? seen : 0, aim, out);
    // By curvature they pay all the same.
    if (!search.run(whole / enough)) return std::nullopt;
    if (out.bend.empty() && search.mean_near() * enough > whole) return std::nullopt;
    return out;
}

void Prover::find_cells(ir::ShapeId id, NodeId field, const Domain &domain, double whole,
                        const CellAim &aim) {
    std::optional<ir::CellBounds> cells =
        bound_cells(flattening, ranges, field, domain, whole, aim);
    if (!cells) return;
    for (double &bound : cells->lipschitz) bound *= options.rules[Rule::Field];
    for (double &bend : cells->bend) bend *= options.rules[Rule::Curvature];
    scene.cells[id] = std::move(*cells);
}

void Prover::know_cells() {
    if (options.cells == 0) return;
    constexpr std::size_t max_nodes = 4'000;
    const std::vector<ir::DividedField> fields = ir::divided_fields(scene, steep);
    for (const auto &[id, field] : fields) {
        const ir::ShapeFact &fact = scene.facts[id.index];
        const Shape &shape = scene.shapes[id];
        const bool region = shape.kind == ir::ShapeKind::Within;
        const ir::ShapeFact &divided = region ? scene.facts[shape.children.front().index] : fact;
        CellAim aim;
        aim.instructions = aim.refining = options.cell_instructions / fields.size();
        aim.gain = least_gain, aim.look_up = look_up_cost;
        aim.along = options.cells;
        aim.bends = region;
        const ir::WithoutCalls written = ir::without_loops(graph, field, max_nodes);
        work.take(max_nodes);
        const NodeId text = written.all ? ir::balanced(graph, written.root) : field;
        if (region) {
            const Zone zone = zone_of(scene.shapes.regions[shape.payload]);
            find_cells(id, text, {outer_box(zone), &zone}, divided.lipschitz_sup, aim);
        } else {
            find_cells(id, text, {to_cell(fact.bounds), nullptr}, divided.lipschitz_sup, aim);
        }
    }
}

} // namespace fathom::proof
