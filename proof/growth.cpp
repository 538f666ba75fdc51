// Products of powers of the sizes t_S of sets S of coordinates. All sizes are at least 1, and t_T <=
// t_S for T in S: so t_T^c t_S^-c <= 1.
#include "proof/growth.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace fathom::proof {

using ir::Interval;
using ir::rounding::down;
using ir::rounding::infinity;
using ir::rounding::up;

namespace {

constexpr int most_power = 1 << 20;     // of exponents, in units
constexpr double fall = 12;             // the power of w as which exp(-w) falls
constexpr double greatest_size = 1e290; // beyond, products might leave double precision

Growth nothing_known(bool upper) { return {upper ? infinity : 0}; }

unsigned positive_sets(const Growth &a) { // all coordinates in them
    unsigned out = 0;
    for (unsigned s = 1; s < 8; ++s)
        if (a.power[s] > 0) out |= s;
    return out;
}
int positive_degree(const Growth &a) {
    int out = 0;
    for (const int e : a.power) out += std::max(e, 0);
    return out;
}
bool reaches(const Growth &a, const Growth &b) { // in each positive exponent
    for (std::size_t s = 1; s < 8; ++s)
        if (std::max(a.power[s], 0) < b.power[s]) return false;
    return true;
}

} // namespace

bool Growth::constant() const {
    return std::ranges::all_of(power, [](int e) { return e == 0; });
}
int Growth::degree() const { return std::accumulate(power.begin(), power.end(), 0); }

Growth product(const Growth &a, const Growth &b, bool upper) {
    if (a.by == 0 || b.by == 0) return {0};
    if (!a.known() || !b.known()) return nothing_known(upper);
    Growth out{upper ? up(a.by * b.by, 2) : down(a.by * b.by, 2)};
    if (out.by > greatest_size) return nothing_known(upper);
    out.by = std::max(out.by, 0.0);
    for (std::size_t s = 1; s < 8; ++s) {
        out.power[s] = a.power[s] + b.power[s];
        if (std::abs(out.power[s]) > most_power) return nothing_known(upper);
    }
    return out;
}

Growth to_power(const Growth &a, double exponent, bool upper) {
    if (exponent == 0) return {1};
    if (a.by == 0 && exponent > 0) return {0};
    if (a.by == 0 || !a.known()) return nothing_known(upper);
    const double by = std::pow(a.by, exponent);
    Growth out{upper ? up(by, 8) : down(by, 8)};
    if (!(out.by < greatest_size)) return nothing_known(upper);
    out.by = std::max(out.by, 0.0);
    for (std::size_t s = 1; s < 8; ++s) {
        const double e = a.power[s] * exponent; // t >= 1: a greater exponent is an upper bound
        if (!(std::fabs(e) < most_power)) return nothing_known(upper);
        // one more, or less, where the product was rounded
        const double whole = upper ? std::ceil(e) : std::floor(e);
        const bool exact = std::fma(double(a.power[s]), exponent, -e) == 0;
        out.power[s] = int(whole) + (exact ? 0 : upper ? 1 : -1);
    }
    return out;
}

Growth multiple(const Growth &a, double by) { return product(a, Growth{by}, true); }

FarOut::FarOut(const std::array<Interval, 3> &cell) {
    unsigned endless = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        if (!cell[i].finite() && cell[i].mignitude() >= 1) endless |= 1u << i;
    }
    for (unsigned set = 1; set < 8; ++set) {
        if ((set & ~endless) != 0) continue;
        Interval size = 1.0;
        for (std::size_t i = 0; i < 3; ++i)
            if ((set >> i & 1) != 0) size = max(size, abs(cell[i]));
        size_[set] = size;
    }
    endless_ = endless;
}

Growth FarOut::coordinate(std::size_t axis) {
    Growth out{1};
    out.power[std::size_t(1) << axis] = Growth::unit;
    return out;
}

// Leaves out t_T^c t_S^-c, at most 1, or for a sign of -1 t_S^c t_T^-c, at least 1.
void FarOut::shorten(std::array<int, 8> &power, int sign) {
    for (unsigned s = 1; s < 8; ++s)
        for (unsigned t = 1; t < 8 && power[s] * sign < 0; ++t) {
            if (t == s || (t & ~s) != 0 || power[t] * sign <= 0) continue;
            const int both = std::min(std::abs(power[s]), std::abs(power[t]));
            power[s] += sign * both, power[t] -= sign * both;
        }
}

double FarOut::most(const Growth &a) const {
    if (a.by == 0 || !a.known()) return a.by;
    std::array<int, 8> power = a.power;
    shorten(power, 1);
    double out = a.by;
    for (std::size_t s = 1; s < 8; ++s) {
        if (power[s] == 0) continue;
        if (power[s] > 0 && size_[s].hi == infinity) return infinity;
        const double at = power[s] > 0 ? size_[s].hi : size_[s].lo;
        out = up(out * up(std::pow(at, double(power[s]) / Growth::unit), 8), 2);
    }
    return out;
}

double FarOut::least(const Growth &a) const {
    if (a.by == 0 || !a.known()) return 0;
    std::array<int, 8> power = a.power;
    shorten(power, -1);
    double out = a.by;
    for (std::size_t s = 1; s < 8; ++s) {
        if (power[s] == 0) continue;
        if (power[s] < 0 && size_[s].hi == infinity) return 0;
        const double at = power[s] < 0 ? size_[s].hi : size_[s].lo;
        out = down(out * down(std::pow(at, double(power[s]) / Growth::unit), 8), 2);
    }
    return std::isfinite(out) ? std::max(out, 0.0) : std::numeric_limits<double>::max();
}

double FarOut::ratio(const Growth &a, const Growth &b) const {
    Growth out{1};
    for (std::size_t s = 1; s < 8; ++s) out.power[s] = a.power[s] - b.power[s];
    return most(out);
}

// A product of powers that is no less than either, but for a number.
Growth FarOut::upper_of_both(const Growth &a, const Growth &b) const {
    Growth out{1};
    if (reaches(a, b) || reaches(b, a)) {
        const Growth &more = reaches(a, b) ? a : b;
        for (std::size_t s = 1; s < 8; ++s) out.power[s] = std::max(more.power[s], 0);
    } else {
        const unsigned all = positive_sets(a) | positive_sets(b);
        out.power[all] = std::max(positive_degree(a), positive_degree(b));
    }
    // what both fall as: as t_S or, as t_S^-c <= t_T^-c, as the size of a part
    std::array<int, 8> left_a{}, left_b{};
    for (std::size_t s = 1; s < 8; ++s)
        left_a[s] = std::max(-a.power[s], 0), left_b[s] = std::max(-b.power[s], 0);
    for (unsigned s = 1; s < 8; ++s)
        for (unsigned t = 1; t < 8; ++t) {
            if ((t & ~s) != 0 && (s & ~t) != 0) continue;
            const int both = std::min(left_a[s], left_b[t]);
            left_a[s] -= both, left_b[t] -= both;
            out.power[s & t] -= both;
        }
    return out;
}

Growth FarOut::together(const Growth &a, const Growth &b, bool added) const {
    if (a.by == 0) return b;
    if (b.by == 0) return a;
    if (!a.known() || !b.known()) return {};
    Growth x = a, y = b;
    shorten(x.power, 1), shorten(y.power, 1);
    Growth out = upper_of_both(x, y);
    const double of_x = up(x.by * ratio(x, out), 2), of_y = up(y.by * ratio(y, out), 2);
    out.by = added ? up(of_x + of_y) : std::max(of_x, of_y);
    return std::isfinite(out.by) ? out : Growth{};
}

Growth FarOut::lesser(const Growth &a, const Growth &b) const {
    constexpr double far_above = 1e4;
    if (!a.known() || !b.known()) return a.known() ? a : b;
    const double x = most(a), y = most(b);
    if (a.degree() < b.degree()) return x <= far_above * y ? a : b;
    if (b.degree() < a.degree()) return y <= far_above * x ? b : a;
    return x <= y ? a : b;
}

// Of A t_S^p + B t_T^q, the lesser of A and B times t_(S and T)^min(p, q), as the greatest of both
// sizes is one of them; else the one that grows more.
Growth FarOut::least_sum(const Growth &a, const Growth &b) {
    if (a.by == 0) return b;
    if (b.by == 0) return a;
    const auto only = [](const Growth &x) -> unsigned {
        unsigned set = 0;
        for (unsigned s = 1; s < 8; ++s)
            if (x.power[s] != 0) {
                if (set != 0 || x.power[s] < 0) return 0;
                set = s;
            }
        return set;
    };
    const unsigned s = only(a), t = only(b);
    const bool as_one = s != 0 && t != 0 && s != t;
    const Growth &more = a.degree() >= b.degree() ? a : b;
    if (!as_one) {
        Growth out = more;
        if (a.power == b.power) out.by = down(a.by + b.by);
        return out;
    }
    if ((s & ~t) == 0 && b.power[t] >= a.power[s]) return b;
    if ((t & ~s) == 0 && a.power[s] >= b.power[t]) return a;
    Growth out{std::min(a.by, b.by)};
    out.power[s | t] = std::min(a.power[s], b.power[t]);
    return out;
}

// With w = by m, m >= M: exp(-k m) m^n is greatest at m = n/k, or at M where that is beyond.
Growth FarOut::exponential(const Growth &of, double rate, bool falls) const {
    Growth m = of;
    m.by = 1;
    const double k = down(of.by * rate, 2), from = least(m);
    if (!(k > 0) || of.constant() || !(from >= 1)) return nothing_known(falls);
    const double at = std::max(from, fall / k);
    const double exponent = fall * std::log(at) - k * at;
    const double error = 1e-14 * (fall * std::fabs(std::log(at)) + k * at + 1);
    const double most = up(std::exp(exponent + error), 8);
    if (!(most < greatest_size)) return nothing_known(falls);
    const Growth power = to_power(m, falls ? -fall : fall, falls);
    if (!power.known()) return nothing_known(falls);
    if (falls) return multiple(power, most);
    return most > 0 && std::isfinite(1 / most) ? product(power, {down(1 / most, 2)}, false)
                                               : Growth{0};
}

} // namespace fathom::proof
