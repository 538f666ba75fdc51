// How values grow and fall far out. In a cell that is endless along some coordinates, all of them at
// least 1 in size, a value lies between two products c t_1^e_1 t_2^e_2 …, where each t is the greatest
// size of a set of these coordinates (docs/lipschitz.md, 2.34).
#pragma once

#include "ir/interval.h"

#include <array>
#include <cstddef>

namespace fathom::proof {

// Sets of coordinates are bits: 1 to 7.
struct Growth {
    static constexpr int unit = 1024; // of exponents, which are whole numbers of 1/unit
    double by = ir::rounding::infinity;
    std::array<int, 8> power{}; // by set

    bool known() const { return by < ir::rounding::infinity; }
    bool constant() const;
    int degree() const;
};

// `upper`: is the product, power or quotient one that a value is no larger than? Else no smaller.
Growth product(const Growth &a, const Growth &b, bool upper);
Growth to_power(const Growth &a, double exponent, bool upper);
Growth multiple(const Growth &a, double by);
inline Growth over(const Growth &a, const Growth &least) { // upper
    return product(a, to_power(least, -1, true), true);
}

// What is known of a value, or a component of one: |v| <= most, |v| >= least, |grad v| <= slope, and
// |grad v| <= relative |v|.
struct Far {
    Growth most, least{0}, slope, relative;
    int sign = 0; // of v; 0: not known
};

// A cell that is endless.
class FarOut {
  public:
    FarOut() = default;
    explicit FarOut(const std::array<ir::Interval, 3> &cell);
    bool holds() const { return endless_ != 0; }
    bool endless(std::size_t axis) const { return (endless_ >> axis & 1) != 0; }
    static Growth coordinate(std::size_t axis);

    double most(const Growth &a) const;  // infinity where it grows
    double least(const Growth &a) const; // 0 where it falls
    Growth sum(const Growth &a, const Growth &b) const { return together(a, b, true); }
    Growth greater(const Growth &a, const Growth &b) const { return together(a, b, false); }
    // The one of two bounds that tells more: that which falls faster, if it is not far above.
    Growth lesser(const Growth &a, const Growth &b) const;
    // Of two numbers of the same sign, at least: of their sum.
    static Growth least_sum(const Growth &a, const Growth &b);
    // exp(-rate w) of w >= least at most, and exp(rate w) at least.
    Growth exponential(const Growth &least, double rate, bool falls) const;

  private:
    Growth together(const Growth &a, const Growth &b, bool added) const;
    Growth upper_of_both(const Growth &a, const Growth &b) const;
    // |a| over |b|, at most.
    double ratio(const Growth &a, const Growth &b) const;
    static void shorten(std::array<int, 8> &power, int sign);

    unsigned endless_ = 0;
    std::array<ir::Interval, 8> size_{}; // by set
};

} // namespace fathom::proof
