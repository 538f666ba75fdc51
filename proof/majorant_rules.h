// The bound of one quotient in one cell, as it is being found: a vector that is folded and inverted
// over and over, over the scale that is carried along. Its Jacobian is as large as the scale, and
// hangs on it as the scale hangs on itself. For majorant_*.cpp and machine_majorants.cpp alone.
// Proofs: docs/lipschitz.md, 2.45.
#pragma once

#include "proof/instruction_rules.h"

#include <map>
#include <tuple>

namespace fathom::proof {

inline double plus(double a, double b) { return ir::rounding::up(a + b); }
inline double ratio_of(double a, double b) {
    return a == 0 ? 0 : b > 0 ? ir::rounding::up(a / b) : ir::rounding::infinity;
}
inline bool have_one_sign(const Interval &a, const Interval &b) {
    return (a.lo >= 0 && b.lo >= 0) || (a.hi <= 0 && b.hi <= 0);
}

// What is asked of one quotient in one cell.
struct Majorants {
    // A component of the tape; its slot is Machine::owner_.
    using Part = std::uint32_t;
    static constexpr Part one = ~Part(0); // the number 1, as a divisor
    struct Vector {
        std::array<Part, 4> at{};
        std::uint32_t size = 0;
        bool operator==(const Vector &) const = default;
        bool operator<(const Vector &other) const {
            return std::tie(size, at) < std::tie(other.size, other.at);
        }
        bool holds(const Vector &other) const {
            return std::includes(at.begin(), at.begin() + size, other.at.begin(),
                                 other.at.begin() + other.size);
        }
    };
    // Of a scalar k that hangs on the size r of one vector: r k'(r)/k, wherever k has a slope.
    struct Radial {
        Vector of; // of no size: k has no slope
        Interval exponent = 0.0;
        // k = by r^power wherever it has a slope, if `power` is not 0
        double power = 0;
        Interval by = 1.0;
    };
    struct Factor {
        Part part = 0;
        bool divides = false;
        bool operator==(const Factor &) const = default;
    };
    struct Factors {
        Interval by = 1.0; // all that stand still
        std::vector<Factor> parts;
    };
    // How a product of radial factors turns: the gradient of it is at most `log_slope` times it times
    // the Jacobian of `of`, and at most `exponent` over the size of `of`.
    struct Turns {
        Vector of;
        Interval exponent = 0.0;
        double log_slope = 0;
        double by_itself = 0; // log_slope over the size of the product, where both are of one point
        double farthest =
            ir::rounding::infinity; // the size of `of`, wherever the product has a slope
    };
    // By component a function g of another vector's: an interval of its slopes, and its values at 0.
    // |g(t) - g(0)| is at most the greatest slope times |t| where `bounded`.
    struct Fold {
        Vector of;
        Interval slope = 1.0, at_0 = 0.0;
        bool bounded = true;
    };
    // What bounds are asked for: over |d|, of the size of a vector and of its Jacobian; over d^2, of
    // its size and `more` times the gradient of d; and of the Jacobian of the quotient, as one.
    enum class Wanted { Size, Slope, Turning, Whole };

    Machine &machine;
    const Tape &tape;
    int steps = 0;
    std::map<std::tuple<Wanted, Vector, Part, double>, double> known{};
    // Of values in the arm that is being looked at, beside what the cell says.
    std::vector<std::pair<Part, Interval>> narrowed{};

    // -- of parts and vectors
    Slot slot(Part p) const { return machine.owner_[p]; }
    std::uint32_t component(Part p) const { return p - tape.first[slot(p)]; }
    const Interval &value(Part p) const { return machine.value_[p]; }
    Interval in_arm(Part p, int depth = 0) const; // where `narrowed` holds
    bool is_still(Part p) const { return machine.norm_[slot(p)] == 0 || zero(machine.grad_[p]); }
    bool is_still(const Vector &v) const {
        return std::all_of(v.at.begin(), v.at.begin() + v.size,
                           [&](Part p) { return is_still(p); });
    }
    Interval value(const Vector &v) const; // of any component
    double size(const Vector &v) const;    // at most
    double norm(const Vector &v) const;
    Vector all_of(Slot s) const;
    // The instruction that makes a part component by component, or chooses it.
    const Instruction *plain(Part p) const;
    Part argument(const Instruction &made, std::size_t i, Part p) const;
    int taken(const Instruction &choice) const; // the arm that all points take, or 0
    Part source(Part p) const;                  // where its number is taken from
    Vector sources(const Vector &v) const;      // in order, where no two are the same
    // The instruction that all parts of a vector are made as; and its arguments, part by part.
    const Instruction *made_alike(const Vector &v) const;
    Vector arguments(const Vector &v, std::size_t i) const;
    static bool are_one(const Vector &v);
    static bool is_in_order(const Vector &v); // no two of its parts are the same
    Part divisor(Part d) const;               // without what leaves its size

    // -- what hangs on a vector's size
    std::optional<Radial> radial(Part p, int depth = 0) const;
    std::optional<Radial> radial_product(const Instruction &made, int depth) const;
    std::optional<Radial> length_of(const Instruction &made, double power) const;
    std::optional<Radial> joined(const Radial &a, const Radial &b) const;
    std::optional<Turns> turns(const std::vector<Factor> &factors) const;
    void gather(Part p, bool divides, Factors &out, int depth = 0) const;
    double least(const std::vector<Factor> &factors) const;
    double most(const std::vector<Factor> &factors) const;
    // A divisor as a part times what hangs on vectors' sizes.
    struct Scaled {
        Part rest = one;
        std::vector<Factor> scales;
        double by = 1, least = 1; // of what else it is multiplied by, and of all that; at least
    };
    std::optional<Scaled> scaled(Part d) const;
    // A divisor without factors that stand still, or that `is_scale` says are taken off.
    static void take(Factors &out, const Factors &more) {
        out.by = out.by * more.by;
        out.parts.insert(out.parts.end(), more.parts.begin(), more.parts.end());
    }
    template <class F> Factors peel(Part &d, F is_scale) const {
        Factors out;
        while (d != one) {
            const Instruction *made = plain(d);
            if (!made || made->form != Form::Plain || (made->op != Op::Mul && made->op != Op::Div))
                return out;
            const bool divides = made->op == Op::Div;
            const Part a = divisor(argument(*made, 0, d)), b = divisor(argument(*made, 1, d));
            if (is_still(b))
                out.by = divides ? out.by / value(b) : out.by * value(b), d = a;
            else if (!divides && is_still(a))
                out.by = out.by * value(a), d = b;
            else if (Factors of_b; gather(b, divides, of_b), is_scale(of_b, a))
                take(out, of_b), d = a;
            else if (Factors of_a; !divides && (gather(a, false, of_a), is_scale(of_a, b)))
                take(out, of_a), d = b;
            else
                return out;
        }
        return out;
    }
    double slope_over(const Scaled &d);

    // -- folds
    std::optional<Fold> fold(const Vector &v) const;
    std::vector<Vector> chain(Vector v, bool meets) const;
    std::optional<Fold> fold_to(const Vector &v, const Vector &y, int depth = 0) const;

    // -- quotients as one
    double whole(const Vector &raw, Part d);
    double whole_in_parts(const Vector &v, Part d);
    double whole_of_fold(const Vector &v, const Vector &y, Part d);
    double whole_of_product(const Vector &v, const Instruction &made, Part d);
    double whole_of_sum(const Vector &v, Part d);
    Interval slopes_here(Part p, Part of, int depth = 0) const;

    // -- bounds
    double bound(Wanted wanted, const Vector &raw, Part d, double more = 0);
    double at_once(Wanted wanted, const Vector &v, Part d, double more);
    double by_rows(const Vector &raw, Part d);
    double by_number(Wanted wanted, const Vector &v, Part d, double more);
    double by_choice(Wanted wanted, const Vector &v, const Instruction &choice, Part d,
                     double more);
    double by_arm(Wanted wanted, const Vector &v, Part d, double more);
    double by_fold(Wanted wanted, const Fold &fold, std::uint32_t size, Part d, double more);
    double by_sum(Wanted wanted, const Vector &v, Part d, double more);
    double by_product(Wanted wanted, const Vector &v, const Instruction &made, Part d, double more);
    std::optional<std::pair<Vector, Interval>> without_number(const Vector &v) const;
    double by_factors(Wanted wanted, const Vector &u, const Factors &f, Part d, double more);
    double turning_by_factors(const Vector &u, const Factors &f, const std::vector<Factor> &above,
                              const std::vector<Factor> &common, Part left, double least_by,
                              double more);
    double by_divisor(Wanted wanted, const Vector &v, Part d, double more);
    double growth(Part d);
    double growth_in_arm(Part d);
    // Looks at each arm of a choice, with what its comparison says of values there.
    template <class F> double greatest_of_arms(const Instruction &choice, F bound_of_arm) {
        const Instruction *order = machine.maker(choice.args[0]);
        const bool compares = order && order->form == Form::Plain &&
                              tape.size[order->args[0]] == 1 &&
                              (order->op == Op::Less || order->op == Op::LessEqual);
        const auto before = narrowed;
        double most = 0;
        for (const std::size_t arm : {1, 2}) {
            narrowed = before;
            if (compares) {
                const Part a = source(tape.first[order->args[0]]),
                           b = source(tape.first[order->args[1]]);
                const Part least = arm == 1 ? a : b, greatest = arm == 1 ? b : a;
                narrowed.emplace_back(least, Interval(-ir::rounding::infinity, value(greatest).hi));
                narrowed.emplace_back(greatest, Interval(value(least).lo, ir::rounding::infinity));
            }
            most = std::max(most, bound_of_arm(arm));
        }
        narrowed = before;
        return most;
    }
    std::optional<std::pair<Part, Part>> sum_of(Part d) const;
    double share_of(Part part, Part rest) const;
};

// No arm of a choice is looked at.
struct OutsideArms {
    Majorants &majorants;
    std::vector<std::pair<Majorants::Part, Interval>> narrowed;
    explicit OutsideArms(Majorants &of) : majorants(of), narrowed(std::move(of.narrowed)) {
        of.narrowed.clear();
    }
    ~OutsideArms() { majorants.narrowed = std::move(narrowed); }
    OutsideArms(const OutsideArms &) = delete;
    OutsideArms &operator=(const OutsideArms &) = delete;
};

} // namespace fathom::proof
