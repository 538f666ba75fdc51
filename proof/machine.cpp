// The machine's frame: ranges, norms, loops, what happens to trouble. The rules for the ops:
// machine_ops.cpp and what it names.
#include "proof/instruction_rules.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fathom::proof {

using ir::rounding::infinity;
using ir::rounding::times;
using ir::rounding::up;

namespace {

// Bilinear (trilinear) interpolation is affine along each axis in a cell, so its partial
// derivatives are means of the adjacent differences: |grad| <= sqrt(sum of (largest difference /
// spacing)^2).
Ranges::Sampled sampled_image(const ir::ImageData &image) {
    Ranges::Sampled out{{0, 0}, 0};
    if (image.rgba.empty()) return out;
    auto at = [&](int x, int y, int c) {
        return double(image.rgba[static_cast<std::size_t>(
            ((y % image.height) * image.width + x % image.width) * 4 + c)]);
    };
    out.values = {infinity, -infinity};
    double dx = 0, dy = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (int c = 0; c < 4; ++c) {
                double v = at(x, y, c);
                out.values = hull(out.values, Interval(v));
                dx = std::max(dx, std::fabs(at(x + 1, y, c) - v)); // repeated: the seam counts
                dy = std::max(dy, std::fabs(at(x, y + 1, c) - v));
            }
    out.slope = up(std::hypot(dx * image.width, dy * image.height), 8);
    return out;
}

Ranges::Sampled sampled_grid(const ir::GridData &grid) {
    Ranges::Sampled out{{0, 0}, 0};
    if (grid.values.empty()) return out;
    auto at = [&](int x, int y, int z) {
        return double(
            grid.values[static_cast<std::size_t>((z * grid.size[1] + y) * grid.size[0] + x)]);
    };
    out.values = {infinity, -infinity};
    double d[3] = {0, 0, 0};
    for (int z = 0; z < grid.size[2]; ++z)
        for (int y = 0; y < grid.size[1]; ++y)
            for (int x = 0; x < grid.size[0]; ++x) {
                double v = at(x, y, z);
                out.values = hull(out.values, Interval(v));
                if (x + 1 < grid.size[0]) d[0] = std::max(d[0], std::fabs(at(x + 1, y, z) - v));
                if (y + 1 < grid.size[1]) d[1] = std::max(d[1], std::fabs(at(x, y + 1, z) - v));
                if (z + 1 < grid.size[2]) d[2] = std::max(d[2], std::fabs(at(x, y, z + 1) - v));
            }
    double sum = 0;
    // Samples lie at cell centres or corners: the spacing is at least 1/size.
    for (int i = 0; i < 3; ++i) sum += std::pow(d[i] * grid.size[static_cast<std::size_t>(i)], 2);
    out.slope = up(std::sqrt(sum), 8);
    return out;
}

} // namespace

namespace {
// A known number, and what evaluators in single precision make of it.
Interval single(double x) { return hull(Interval(x), Interval(static_cast<float>(x))); }
} // namespace

Ranges ranges_of(const ir::Scene &scene, Work &work, const std::optional<Interval> &times) {
    Ranges ranges;
    ranges.work = &work;
    for (const ir::ImageData &image : scene.images) work.take(image.rgba.size() / 8);
    for (const ir::GridData &grid : scene.grids) work.take(grid.values.size() / 2);
    ranges.scene = &scene;
    ranges.time =
        times ? hull(single(times->lo), single(times->hi)) : Interval(0, scene.render.time_end);
    for (const ir::Param &param : scene.params) {
        std::array<Interval, 4> &of = ranges.params.emplace_back();
        for (std::size_t i = 0; i < of.size(); ++i)
            of[i] = times             ? single(param.value[i])
                    : param.has_range ? Interval(param.lo[i], param.hi[i])
                    : param.is_color || param.type == ir::Type::Bool ? Interval(0, 1)
                                                                     : Interval::everything();
    }
    for (const ir::ImageData &image : scene.images) ranges.images.push_back(sampled_image(image));
    for (const ir::GridData &grid : scene.grids) ranges.grids.push_back(sampled_grid(grid));
    return ranges;
}

// A = M^T M for the middle matrix M; its largest eigenvalue by the closed form for symmetric 3x3
// matrices, plus the Frobenius norm of the radii. Where an entry is unbounded the answer is
// infinity.
double spectral_norm(const Row *rows, int count) {
    // Often each row has one entry, in a column of its own: then the largest entry is the norm.
    int used[3] = {0, 0, 0};
    double largest_entry = 0;
    bool apart = true;
    for (int i = 0; apart && i < count; ++i) {
        int entries = 0;
        for (std::size_t j = 0; j < 3; ++j) {
            const Interval x = rows[i][j];
            if (x.lo == 0 && x.hi == 0) continue;
            ++entries, ++used[j];
            largest_entry = std::max(largest_entry, x.magnitude());
        }
        apart = entries <= 1;
    }
    if (apart && used[0] <= 1 && used[1] <= 1 && used[2] <= 1) return largest_entry;
    double mid[16][3], radius = 0, frobenius = 0;
    for (int i = 0; i < count; ++i)
        for (int j = 0; j < 3; ++j) {
            Interval x = rows[i][static_cast<std::size_t>(j)];
            if (!x.finite()) return infinity;
            mid[i][j] = x.lo + (x.hi - x.lo) / 2;
            double r = std::max(x.hi - mid[i][j], mid[i][j] - x.lo);
            radius += r * r;
            frobenius += x.magnitude() * x.magnitude();
        }
    if (count == 1) return up(std::sqrt(frobenius), 4);
    double a[3][3] = {};
    for (int i = 0; i < count; ++i)
        for (int j = 0; j < 3; ++j)
            for (int k = j; k < 3; ++k) a[j][k] += mid[i][j] * mid[i][k];
    double off = a[0][1] * a[0][1] + a[0][2] * a[0][2] + a[1][2] * a[1][2];
    double q = (a[0][0] + a[1][1] + a[2][2]) / 3, largest = std::max({a[0][0], a[1][1], a[2][2]});
    if (off > 1e-30 * q * q) {
        double x = a[0][0] - q, y = a[1][1] - q, z = a[2][2] - q;
        double p = std::sqrt((x * x + y * y + z * z + 2 * off) / 6);
        x /= p, y /= p, z /= p;
        double u = a[0][1] / p, v = a[0][2] / p, w = a[1][2] / p;
        double half_det = 0.5 * (x * (y * z - w * w) - u * (u * z - w * v) + v * (u * w - y * v));
        double angle = std::acos(std::clamp(half_det, -1.0, 1.0)) / 3;
        largest = q + 2 * p * std::cos(angle) +
                  1e-8 * p; // the closed form is good to half the digits at double roots
    }
    double norm = std::sqrt(std::max(largest, 0.0)) * (1 + 1e-14) + std::sqrt(radius);
    return up(std::min(norm, std::sqrt(frobenius)), 8);
}

Machine::Machine(const Tape &tape, const Ranges &ranges, bool bends)
    : tape_(tape), ranges_(ranges), value_(tape.components), grad_(tape.components),
      odd_(tape.components), norm_(tape.first.size()), relative_(tape.first.size(), infinity),
      raised_(tape.first.size()), bend_(bends ? tape.first.size() : 0),
      trouble_(tape.first.size(), Trouble::None), cause_(tape.first.size()),
      pole_(tape.first.size()), undefined_(tape.first.size()) {
    in_reach_ = tape.grows;
    made_by_.assign(tape_.first.size(), -1);
    for (std::size_t i = 0; i < tape_.each.size(); ++i)
        if (tape_.each[i].form != Form::Loop) made_by_[tape_.each[i].out] = std::int32_t(i);
    if (tape_.has_majorants)
        for (Slot s = 0; s < tape_.size.size(); ++s) owner_.insert(owner_.end(), tape_.size[s], s);
    run(tape.once);
}

void Machine::reach(const Cell &cell) {
    cell_ = cell;
    near_ =
        std::ranges::all_of(cell.p, [](const Interval &x) { return x.magnitude() <= near_enough; });
    in_reach_ = tape_.grows && std::all_of(cell.p.begin(), cell.p.end(), [](const Interval &x) {
                    return x.magnitude() <= in_reach;
                });
    far_out_ = FarOut(cell.p);
    if (!far_out_.holds()) return;
    far_.resize(tape_.components);
    is_far_.assign(tape_.components, 0);
}

void Machine::run(const Cell &cell) {
    if (ranges_.work->spent()) return know_nothing();
    const std::size_t before = work_;
    decided_ = 0;
    reach(cell);
    run(tape_.each);
    ranges_.work->take(work_ - before);
    conclude();
}

void Machine::conclude() {
    Slot s = tape_.result;
    result_norm_ = norm_[s];
    if (undefined_[s] && result_norm_ < infinity) { // a rule that bounds its slope sees no 0/0
        result_norm_ = infinity;
        trouble_[s] = Trouble::Singular;
    }
    for (std::uint32_t i = 0; i < tape_.size[s]; ++i)
        if (in_reach_ && result_norm_ > 0 && value_[tape_.first[s] + i].magnitude() > max_single) {
            result_norm_ = infinity;
            trouble_[s] = Trouble::Overflow;
        }
    for (std::uint32_t i = 0; i < tape_.size[s]; ++i)
        if (odd_[tape_.first[s] + i]) { // a wave that nothing made even
            result_norm_ = infinity;
            trouble_[s] = Trouble::Jump;
        }
}

bool Machine::leaves_single(bool by_infinity) const {
    const auto is_above = [&](double most) {
        return [most, by_infinity](const Interval &v) {
            return v.magnitude() > most && (by_infinity || v.finite());
        };
    };
    return std::ranges::any_of(value_, is_above(ir::rounding::max_single)) ||
           std::ranges::any_of(tape_.each, [&](const Instruction &in) {
               return squares_arguments(in) && std::ranges::any_of(in.args, [&](Slot s) {
                          const auto from = value_.begin() + std::ptrdiff_t(tape_.first[s]);
                          return std::any_of(from, from + tape_.size[s],
                                             is_above(ir::rounding::max_squared));
                      });
           });
}

void Machine::know_nothing() {
    std::ranges::fill(value_, Interval::everything());
    std::ranges::fill(grad_,
                      Row{Interval::everything(), Interval::everything(), Interval::everything()});
    std::ranges::fill(norm_, infinity);
    std::ranges::fill(relative_, infinity);
    std::ranges::fill(raised_, Raised());
    std::ranges::fill(bend_, infinity);
    result_norm_ = infinity;
    work_ += tape_.length() + 1;
}

void Machine::run(const std::vector<Instruction> &block) {
    for (const Instruction &instruction : block) {
        ++work_;
        if (instruction.form == Form::Loop)
            run_loop(instruction);
        else
            step(instruction);
    }
}

void Machine::copy(Slot from, Slot to) {
    std::uint32_t a = tape_.first[from], b = tape_.first[to];
    for (std::uint32_t i = 0; i < tape_.size[to]; ++i) {
        value_[b + i] = value_[a + i];
        grad_[b + i] = grad_[a + i];
        odd_[b + i] = odd_[a + i];
        if (far_out_.holds()) far_[b + i] = far_[a + i], is_far_[b + i] = is_far_[a + i];
    }
    norm_[to] = norm_[from];
    relative_[to] = relative_[from];
    raised_[to] = raised_[from];
    if (!bend_.empty()) bend_[to] = bend_[from];
    trouble_[to] = trouble_[from];
    cause_[to] = cause_[from];
    pole_[to] = pole_[from];
    undefined_[to] = undefined_[from];
}

// `into` becomes what holds both; a jump from one to the other may lie in the cell.
void Machine::join(Slot into, Slot other, bool jump, NodeId cause) {
    std::uint32_t a = tape_.first[into], b = tape_.first[other];
    for (std::uint32_t i = 0; i < tape_.size[into]; ++i) {
        value_[a + i] = hull(value_[a + i], value_[b + i]);
        odd_[a + i] = odd_[a + i] | odd_[b + i];
        if (far_out_.holds()) is_far_[a + i] = 0;
        for (std::size_t j = 0; j < 3; ++j)
            grad_[a + i][j] = hull(grad_[a + i][j], grad_[b + i][j]);
    }
    undefined_[into] = undefined_[into] | undefined_[other];
    if (norm_[other] > norm_[into]) {
        norm_[into] = norm_[other];
        trouble_[into] = trouble_[other];
        cause_[into] = cause_[other];
        pole_[into] = pole_[other];
    }
    relative_[into] = jump ? infinity : std::max(relative_[into], relative_[other]);
    raised_[into] = jump ? Raised() : either(raised_[into], raised_[other]);
    if (!bend_.empty()) bend_[into] = jump ? infinity : std::max(bend_[into], bend_[other]);
    if (jump && norm_[into] != infinity) {
        for (std::uint32_t i = 0; i < tape_.size[into]; ++i)
            grad_[a + i] = {Interval::everything(), Interval::everything(), Interval::everything()};
        norm_[into] = infinity;
        trouble_[into] = Trouble::Jump;
        cause_[into] = cause;
    }
}

void Machine::run_loop(const Instruction &instruction) {
    const Loop &loop = tape_.loops[instruction.payload];
    Interval count = value_[tape_.first[loop.count]];
    double most = std::clamp(count.hi, 0.0, double(loop.most));
    bool count_varies = norm_[loop.count] > 0;
    for (std::size_t k = 0; k < loop.vars.size(); ++k) copy(loop.start[k], loop.vars[k]);
    bool ended = false;
    auto may_end = [&](bool jump) {
        for (std::size_t k = 0; k < loop.vars.size(); ++k)
            if (ended)
                join(loop.ends[k], loop.vars[k], jump, instruction.node);
            else
                copy(loop.vars[k], loop.ends[k]);
        ended = true;
    };
    bool split = false; // some point of the cell may have left earlier
    for (int turn = 0;; ++turn) {
        if (turn >= count.lo || turn >= most) {
            may_end(split || count_varies);
            if (turn >= most) break;
        }
        value_[tape_.first[loop.index]] = double(turn);
        run(loop.body);
        if (loop.has_condition) {
            Interval go = value_[tape_.first[loop.condition]];
            if (go.hi < 0.5) {
                may_end(split);
                break;
            }
            if (go.lo < 0.5) {
                may_end(split);
                split = split || loop.condition_varies;
            }
        }
        for (std::size_t k = 0; k < loop.vars.size(); ++k) copy(loop.next[k], loop.scratch[k]);
        for (std::size_t k = 0; k < loop.vars.size(); ++k) copy(loop.scratch[k], loop.vars[k]);
    }
}

// A quotient whose sides may both be 0.
bool Machine::is_0_by_0(const Instruction &instruction) const {
    if (instruction.op != Op::Div) return false;
    const Slot above = instruction.args[0], below = instruction.args[1];
    for (std::uint32_t i = 0; i < tape_.size[above]; ++i)
        if (value_[tape_.first[above] + i].contains(0) &&
            value_[tape_.first[below] + i].mignitude() < min_single)
            return true;
    return false;
}

// What is infinite, as 1/0, and read by anything else than what keeps it: infinity less infinity, or
// times 0, and a sine of it are no numbers.
bool Machine::is_none_of_infinite(const Instruction &in) const {
    using enum Op;
    constexpr ir::OpSet keep{Neg,    Abs,  Min,   Max,       Union,  Intersection, Clamp,
                             Exp,    Exp2, Log,   Log2,      Sqrt,   InverseSqrt,  Atan,
                             Sinh,   Cosh, Tanh,  Floor,     Ceil,   Round,        Trunc,
                             Sign,   Step, Less,  LessEqual, Equal,  NotEqual,     Select,
                             Length, Make, Splat, Swizzle,   Column, Transpose};
    const auto may_be = [&](Slot s, double end) {
        for (std::uint32_t i = 0; i < tape_.size[s]; ++i)
            if (const Interval &v = value_[tape_.first[s] + i]; v.lo == end || v.hi == end)
                return true;
        return false;
    };
    const auto infinite = [&](Slot s) {
        return pole_[s] && (may_be(s, infinity) || may_be(s, -infinity));
    };
    if (keep[in.op] || std::ranges::none_of(in.args, infinite)) return false;
    if (in.op == Smoothstep) return infinite(in.args[0]) || infinite(in.args[1]); // its edges
    if (in.op != Add && in.op != Sub && in.op != Mul && in.op != Div) return true;
    const Slot a = in.args[0], b = in.args[1];
    if (in.op == Mul) return a != b; // the square of what is infinite is so, too
    if (!infinite(a) || !infinite(b)) return false;
    const double other = in.op == Add ? -infinity : infinity;
    return in.op == Div || (may_be(a, infinity) && may_be(b, other)) ||
           (may_be(a, -infinity) && may_be(b, -other));
}

void Machine::fail(const Instruction &instruction, Trouble why) {
    Slot s = instruction.out;
    for (std::uint32_t i = 0; i < tape_.size[s]; ++i) {
        grad_[tape_.first[s] + i] = {Interval::everything(), Interval::everything(),
                                     Interval::everything()};
        odd_[tape_.first[s] + i] = 0;
    }
    norm_[s] = infinity;
    relative_[s] = infinity;
    trouble_[s] = why;
    cause_[s] = instruction.node;
    pole_[s] = why == Trouble::Singular && poles[instruction.op];
    undefined_[s] = (pole_[s] && is_0_by_0(instruction)) || is_none_of_infinite(instruction);
    for (Slot a : instruction.args) {
        undefined_[s] = undefined_[s] | undefined_[a];
        pole_[s] = pole_[s] | pole_[a];
    }
    for (Slot a : instruction.args) // what fed it was in trouble before
        if (trouble_[a] != Trouble::None) {
            trouble_[s] = trouble_[a];
            cause_[s] = cause_[a];
            return;
        }
    if (why == Trouble::Jump)
        for (Slot a : instruction.args) // a wave that jumps
            if (cause_[a]) cause_[s] = cause_[a];
}

// The rule's norm or the box's, whichever is less.
void Machine::finish(const Instruction &instruction, double rule, bool odd_used) {
    Slot s = instruction.out;
    std::uint32_t at = tape_.first[s];
    if (odd_used) {
        fail(instruction, Trouble::Jump);
        return;
    }
    int n = tape_.size[s];
    if (!instruction.turned.empty() && rule < infinity) { // M v + c: |M| |J_v|, M and c being still
        bool still = true;
        for (std::size_t i = 1; i < instruction.turned.size(); ++i)
            still = still && norm_[instruction.turned[i]] == 0;
        if (still)
            rule = std::min(rule, up(times(instruction.norm, norm_[instruction.turned[0]]), 4) *
                                      ranges_.rules[Rule::Linear]);
    }
    const bool is_log = instruction.op == Op::Log || instruction.op == Op::Log2;
    if (is_log && n == 1 && instruction.form == Form::Plain &&
        (rule < infinity || value(instruction.args[0], 0).lo >= min_single))
        rule = std::min(rule, up(times(instruction.op == Op::Log ? 1 : std::numbers::log2e,
                                       relative_[instruction.args[0]]),
                                 4) *
                                  ranges_.rules[Rule::Relative]);
    if (std::isnan(rule)) rule = infinity;
    double box = 0;
    if (rule > 0) box = spectral_norm(&grad_[at], n);
    norm_[s] = std::min(rule, box);
    relative_[s] = relative_norm(instruction);
    if (n == 1 && relative_[s] < infinity)
        hold_norm(s, up(times(relative_[s], value_[at].hi), 4) * ranges_.rules[Rule::Relative]);
    hold_norm(s, norm_by_raised(instruction) * ranges_.rules[Rule::Raised]);
    trouble_[s] = Trouble::None;
    cause_[s] = NodeId();
    pole_[s] = 0;
    undefined_[s] = is_none_of_infinite(instruction);
    for (Slot a : instruction.args) undefined_[s] = undefined_[s] | undefined_[a];
    const double relative = relative_[s]; // may be known though the slope has no bound
    if (norm_[s] == infinity) fail(instruction, Trouble::Singular), relative_[s] = relative;
}

Interval Machine::box_length(Slot s) const {
    Interval sum;
    for (std::uint32_t i = 0; i < tape_.size[s]; ++i) sum += square(value_[tape_.first[s] + i]);
    return length_of(coordinates(s), sqrt(sum));
}

void Machine::keep_to(const Distances &distances) {
    distances_ = distances;
    const auto point = std::ranges::find(tape_.each, Op::Point, &Instruction::op);
    coordinate_.assign(tape_.components, 0);
    if (point == tape_.each.end()) return;
    const std::uint32_t at = tape_.first[point->out];
    for (Slot s = 0; s < tape_.first.size(); ++s)
        for (int c = 0; c < int(tape_.size[s]); ++c)
            if (const std::uint32_t from = origin(s, c); from >= at && from < at + 3)
                coordinate_[tape_.first[s] + std::uint32_t(c)] = std::uint8_t(from - at + 1);
}

// The point's coordinates, a bit each, that a value is made of, each once; else 0.
unsigned Machine::coordinates(Slot s) const {
    if (!distances_) return 0;
    unsigned out = 0;
    for (std::uint32_t i = tape_.first[s]; i < tape_.first[s] + tape_.size[s]; ++i) {
        const unsigned one = coordinate_[i] == 0 ? 0 : 1u << (coordinate_[i] - 1);
        if (one == 0 || (out & one) != 0) return 0;
        out |= one;
    }
    return out;
}

// The length of a vector of these coordinates, at the points that `keep_to` keeps to.
Interval Machine::length_of(unsigned coordinates, Interval found) const {
    if (!distances_ || coordinates == 0) return found;
    Interval known = coordinates == 7 ? distances_->from_origin : Distances::everywhere;
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (coordinates == 7)
            known.lo = std::max(known.lo, distances_->from_axis[axis].lo);
        else if (coordinates == (7u & ~(1u << axis)))
            known = distances_->from_axis[axis];
    const Interval both{std::max(found.lo, known.lo), std::min(found.hi, known.hi)};
    return both.lo <= both.hi ? both : found; // no point of the cell is kept
}

} // namespace fathom::proof
