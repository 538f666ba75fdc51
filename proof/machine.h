// Runs a tape over a box of points: for every value an interval for each component, one for each
// partial derivative, and beside them a bound on the Jacobian's spectral norm (the hull of two unit
// gradients has norm sqrt 3; max and min of two fields of norm 1 have norm 1). Derivatives are
// Clarke's: at a kink the hull of both sides', which bounds the slope of everything continuous.
// What may jump or be infinitely steep in the box has norm infinity and says why.
#pragma once

#include "base/ids.h"
#include "ir/scene.h"
#include "proof/growth.h"
#include "proof/rules.h"
#include "proof/tape.h"
#include "proof/ways.h"

#include <array>
#include <optional>

namespace fathom::proof {

// What the numbers that are not the point may be.
struct Ranges {
    const ir::Scene *scene = nullptr;
    Interval time;
    std::vector<std::array<Interval, 4>> params; // by param: each component; everything where none
                                                 // is known
    std::unordered_map<std::uint32_t, std::array<Interval, 4>>
        vars; // by Var payload: ids of cells, rows of instance_tables
    // By image and grid: least and greatest value, and a bound on the slope in the unit square or
    // cube.
    struct Sampled {
        Interval values;
        double slope = 0;
    };
    std::vector<Sampled> images, grids;
    // By cached field, where its values may be cached: what holds of the cached ones, too (caches.cpp).
    // Else nothing, and its own text is looked at.
    struct Cached {
        bool cached = false;
        std::array<Interval, 4> values{};
        double slope = 0; // of all components together
    };
    std::vector<Cached> caches;
    Work *work = nullptr; // of all machines together
    Rules rules;          // tests weaken one (rules.h)
};
// Of params and time all that the scene allows, or the present values at these times (prove.h).
// Reads the images and grids, which takes steps off `work`.
Ranges ranges_of(const ir::Scene &scene, Work &work, const std::optional<Interval> &times = {});

// How far rays go: further off whatever grows has left single precision.
constexpr double in_reach = 1e6;

enum class Trouble : std::uint8_t { None, Jump, Singular, Overflow };

struct Cell {
    std::array<Interval, 3> p{Interval::everything(), Interval::everything(),
                              Interval::everything()};
};

// How far the points of a region are from each coordinate axis, and from the origin.
struct Distances {
    std::array<Interval, 3> from_axis{everywhere, everywhere, everywhere};
    Interval from_origin = everywhere;
    static constexpr Interval everywhere{0, ir::rounding::infinity};
};

using Row = std::array<Interval, 3>;

// A scalar base + w, or base - w where `negative`: base is the same at all points, w >= 0, and the
// power-th root of w is no steeper than `slope`; the power is below 0, or 1 or more; of a power of
// infinity |grad w| <= slope w (machine_raised.cpp). A slope of infinity: not known.
// Where the power is a param's, it is known by its slot, and `power` has its sign and is as near to 0
// as it may be.
struct Raised {
    double slope = ir::rounding::infinity, power = 2;
    Interval base = 0.0;
    bool negative = false;
    Slot param = 0; // 1 + the slot; 0: the power is a number
    bool same_power(const Raised &other) const {
        return power == other.power && param == other.param;
    }
};
Raised either(const Raised &a, const Raised &b); // what holds of both

// A bound on the spectral norm of every matrix whose rows lie in `rows`.
double spectral_norm(const Row *rows, int count);

// A row of a matrix, its length at most, and the sign of its weight; 0: not known.
struct Weighed {
    const Row *grad = nullptr;
    double norm = 0;
    int sign = 0;
};
// How long a sum of the rows is at most, whose weights together have a length of 1; at most `known`.
double norm_of_weighed(const Weighed *rows, int count, double known);

class Machine {
  public:
    // bends: bounds second derivatives too (machine_bend.cpp).
    Machine(const Tape &tape, const Ranges &ranges, bool bends = false);
    void run(const Cell &cell); // without work left: nothing is known of any value

    // A run of some of Tape::each, by their places. Values that are not computed anew stay what they
    // were, so they have to be those of a cell that holds this one: then they hold here, too.
    using Steps = std::vector<std::uint32_t>;
    Steps all_steps() const;
    void run(const Cell &cell, const Steps &steps);
    // Of the steps just run, those that a part of the cell may need anew. What is the same at all of
    // its points and what no choice takes stays as it is (machine_needed.cpp).
    Steps needed(const Steps &steps) const;

    // From here on what stands still has ranges that tell more of numbers it reads more than once
    // (machine_still.cpp).
    void narrow_still();

    // From here on runs tell of those points of a cell alone that are so far away.
    void keep_to(const Distances &distances);

    // From here on hashes and noise have the values at the middle of what they are of, not their
    // ranges: for what is told of single points, and for no bound.
    void read_values() { reads_values_ = true; }
    // … and what all steps decided in the last run, as one number (crossings.cpp).
    std::uint64_t decided() const { return decided_; }

    int size() const { return tape_.size[tape_.result]; }
    Interval value(int i) const {
        return value_[tape_.first[tape_.result] + static_cast<std::uint32_t>(i)];
    }
    const Row &row(int i) const {
        return grad_[tape_.first[tape_.result] + static_cast<std::uint32_t>(i)];
    }
    double norm() const {
        return result_norm_;
    } // infinity where the field may jump or be infinitely steep here
    // Of second derivatives along straight lines, all components together; infinity where the slope
    // may jump, or nothing is known.
    double bend() const { return result_norm_ == infinity_ ? infinity_ : bend_[tape_.result]; }
    // … and of any value on the way, with what else is known of it.
    double bend(Slot s) const { return bend_[s]; }
    double norm(Slot s) const { return norm_[s]; }
    Interval value(Slot s, int i) const {
        return value_[tape_.first[s] + static_cast<std::uint32_t>(i)];
    }
    const Row &row(Slot s, int i) const {
        return grad_[tape_.first[s] + static_cast<std::uint32_t>(i)];
    }
    // Is a value of the last run beyond what single precision holds?
    bool leaves_single(bool by_infinity) const;
    Trouble trouble() const { return trouble_[tape_.result]; }
    NodeId cause() const { return cause_[tape_.result]; } // the first node that is in trouble
    std::size_t work() const { return work_; }            // instructions run so far

    // The greatest norm over all ways in which the tape's choices may go within the cell, each way
    // with its own gradients: no hull of two sides (ways.h; docs/lipschitz.md, 2.6). For cells in
    // which `run` found a finite norm. Stops where that is at least `enough`; infinity where there
    // are too many ways.
    double norm_by_ways(const Cell &cell, double enough);

  private:
    static constexpr double infinity_ = ir::rounding::infinity;
    friend struct Step;      // the rules of one instruction (instruction_rules.h)
    friend struct FarStep;   // … and in endless cells (machine_far.cpp)
    friend struct Majorants; // … of a quotient by what scales it (machine_majorants.cpp)
    void run(const std::vector<Instruction> &block);
    void conclude();
    bool is_one_value(Slot s) const;
    void need_args(const Instruction &instruction, std::vector<bool> &wanted) const;
    void know_nothing();
    void run_loop(const Instruction &instruction);
    void step(const Instruction &instruction);
    void decide(const Instruction &instruction);
    void read_step(const Instruction &instruction);
    void finish(const Instruction &instruction, double norm, bool odd_used);
    void weaken(Slot s, double factor);
    void hold(const Instruction &instruction, Rule rule,
              void (Machine::*apply)(const Instruction &));
    void hold_mean(const Instruction &instruction);
    void hold_norm(Slot s, double most);
    void hold_turning(const Instruction &instruction);
    void hold_around(const Instruction &instruction);
    void hold_beside_turn(const Instruction &instruction);
    void hold_between(const Instruction &instruction);
    void hold_along(const Instruction &instruction);
    void hold_ellipsoid(const Instruction &instruction);
    void hold_univariate(const Instruction &instruction);
    void hold_angle(const Instruction &instruction);
    void hold_triangle(const Instruction &instruction);
    void hold_majorant(const Instruction &instruction);
    void fail(const Instruction &instruction, Trouble why);
    bool is_0_by_0(const Instruction &instruction) const;
    bool is_none_of_infinite(const Instruction &instruction) const;
    void copy(Slot from, Slot to);
    void join(Slot into, Slot other, bool jump, NodeId cause);
    Interval box_length(Slot s) const;
    unsigned coordinates(Slot s) const;
    Interval length_of(unsigned coordinates, Interval found) const;
    void reach(const Cell &cell);
    void run_way();
    void look_back();
    void narrow(Slot s, int component, Interval to);
    void settle(Slot s);
    // Which of two values is known to be the lesser in a run by ways: 0, 1, or -1 for neither; and
    // of a difference its sign, 0 for at most 0.
    int order(Slot a, int ac, Slot b, int bc) const;
    void keep_order(Slot lesser, int lc, Slot greater, int gc);
    int sign_of(Slot s, int c) const;
    void keep_sign(Slot s, int c, bool negative);
    std::uint32_t origin(Slot s, int component) const;
    double component_norm(Slot s, int component) const;
    double relative_norm(const Instruction &instruction) const;
    unsigned axes(Slot s) const;
    bool at_right_angles(const Instruction &in, int a, int b) const;
    struct Monomial { // by of^degree
        Interval by;
        Slot of;
        int degree;
    };
    Monomial monomial(Slot s, int depth = 0) const;
    Raised raised(Slot s) const;
    Raised grows_as_itself(Slot s) const;
    Raised raised_to(Slot u, double power) const;
    Raised raised_by_exponent(const Instruction &instruction) const;
    Raised raised_by_param(const Instruction &instruction) const;
    Raised raised_wave(Slot s, bool from_below) const;
    Raised raised_times(Slot w, Slot b) const;
    Raised raised_in_parallel(const Instruction &instruction) const;
    Raised raised(const Instruction &instruction) const;
    const Instruction *maker(Slot s) const;
    struct Product {
        Interval by = 1.0;
        std::vector<Slot> factors;
    };
    bool gather(Slot s, Product &out, int depth = 0) const;
    Interval above_base(Slot s, const Raised &x) const;
    double norm_of_power(Slot s, double e) const;
    double norm_of_product(Slot s, double e) const;
    double norm_by_raised(const Instruction &instruction) const;
    void hold_waves_of_one(const Instruction &instruction);
    void hold_raised(const Instruction &instruction);
    Far far(Slot s, int component) const;
    void keep_far(Slot s, int component, Far found);
    bool is_regular(const Instruction &instruction) const;
    void hold_far(const Instruction &instruction);
    std::optional<std::pair<std::uint32_t, std::uint32_t>> difference(Slot s, int c) const;

    const Tape &tape_;
    const Ranges &ranges_;
    Cell cell_;
    bool near_ = false; // no coordinate of the cell is above `near_enough`
    bool reads_values_ = false;
    std::uint64_t decided_ = 0;
    std::optional<Distances> distances_;
    std::vector<std::uint8_t> coordinate_; // by component: 1 + that of the point that it is, or 0
    bool in_reach_ = false; // the cell is where rays go, and values may leave single precision
    std::vector<Interval> value_;
    std::vector<Row> grad_;
    std::vector<std::uint8_t> odd_; // by component: may jump, but only from x to -x
    std::vector<double> norm_;      // by slot
    std::vector<double> relative_;  // by slot: of a scalar v >= 0, what |grad v| is at most, of v
    std::vector<Raised> raised_;    // by slot
    FarOut far_out_;                // of an endless cell
    std::vector<Far> far_;          // by component, where `is_far_`
    std::vector<std::uint8_t> is_far_;
    std::vector<double> bend_; // by slot, or none
    std::vector<Trouble> trouble_;
    std::vector<NodeId> cause_;
    std::vector<std::uint8_t> pole_;      // by slot: singular as it may be no number at all
    std::vector<std::uint8_t> undefined_; // by slot: it may be no number, whatever its slope is
    double result_norm_ = 0;
    std::size_t work_ = 0;
    Ways *ways_ = nullptr;              // in a run by ways
    std::vector<std::int32_t> made_by_; // by slot: the instruction of Tape::each, or -1
    std::vector<Slot> owner_;           // by component, where the tape has majorants
    struct {
        double most = 0; // that they said of a cell
        int left = 0;    // cells of less before they are asked again
    } majorants_;
    std::vector<bool> still_; // by slot: not computed anew by each run; none before runs by ways
};

} // namespace fathom::proof
