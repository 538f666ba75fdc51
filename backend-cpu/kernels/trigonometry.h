// sin, cos, tan and their inverses of floats as straight arithmetic, so that loops over them
// vectorise: the C library's are calls, which take most of the time of scenes with rotations by
// angle or polar repetition. Each is right to about 1e-7 (the polynomials are minimax fits of ours, their errors
// given), and the same in every instruction set, since nothing here may be contracted or reordered.
// Other number types go to the functions of <cmath> or to those found by ADL.
#pragma once

#include <array>
#include <cmath>
#include <type_traits>

#ifndef FATHOM_ISA
#define FATHOM_ISA base
#endif

namespace fathom::cpu::FATHOM_ISA {

// x = turns * pi/2 + rest, |rest| <= pi/4; `quarter` is turns modulo 4, in -2..2.
struct Quadrant {
    float rest, quarter;
};

inline Quadrant quadrant(float x) {
    // adding and taking away 1.5 * 2^52 rounds a double to a whole number (any |number| below 2^51)
    constexpr double rounder = 6755399441055744.0;
    constexpr double half_pi = 1.57079632679489661923, half_pi_rest = 6.12323399573676603587e-17;
    constexpr double maximum = 0.78539816339744830962;
    const double wide = x;
    const double turns = (wide * (1 / half_pi) + rounder) - rounder;
    const double fours = (turns * 0.25 + rounder) - rounder;
    double rest = (wide - turns * half_pi) - turns * half_pi_rest;
    // where floats are farther apart than a turn: some angle still, so that sin and cos stay within
    // -1..1
    rest = rest > maximum ? maximum : rest;
    rest = rest < -maximum ? -maximum : rest;
    return {static_cast<float>(rest), static_cast<float>(turns - 4 * fours)};
}

// On |r| <= pi/4: sin r = r + r^3 S(r^2), error 4e-9 r; cos r = 1 - r^2/2 + r^4 C(r^2), error
// 1e-10.
inline float sine_part(float r) {
    const float u = r * r;
    return r + r * u * (-1.666665494e-01f + u * (8.332177916e-03f + u * -1.951726684e-04f));
}
inline float cosine_part(float r) {
    const float u = r * r;
    return (1 - 0.5f * u) +
           u * u * (4.166664686e-02f + u * (-1.388736721e-03f + u * 2.443841555e-05f));
}

template <class F> F sine(F x) {
    if constexpr (std::is_same_v<F, float>) {
        const Quadrant q = quadrant(x);
        const bool odd = q.quarter * q.quarter == 1;
        const float size = odd ? cosine_part(q.rest) : sine_part(q.rest);
        return (odd ? q.quarter < 0 : q.quarter != 0) ? -size : size;
    } else {
        using std::sin;
        return sin(x);
    }
}

template <class F> F cosine(F x) {
    if constexpr (std::is_same_v<F, float>) {
        const Quadrant q = quadrant(x);
        const bool odd = q.quarter * q.quarter == 1;
        const float size = odd ? sine_part(q.rest) : cosine_part(q.rest);
        return (odd ? q.quarter > 0 : q.quarter != 0) ? -size : size;
    } else {
        using std::cos;
        return cos(x);
    }
}

// Both, which rotations want: as long as one of them takes. Signs by one condition each, so that
// loops over it vectorise.
template <class F> std::array<F, 2> sine_cosine(F x) {
    if constexpr (std::is_same_v<F, float>) {
        const Quadrant q = quadrant(x);
        const float square = q.quarter * q.quarter;
        const float s = sine_part(q.rest), c = cosine_part(q.rest);
        const float high = square == 1 ? c : s, wide = square == 1 ? s : c;
        const bool below = (q.quarter < 0) | (square == 4), left = (q.quarter > 0) | (square == 4);
        return {below ? -high : high, left ? -wide : wide};
    } else {
        return {sine(x), cosine(x)};
    }
}

template <class F> F tangent(F x) {
    if constexpr (std::is_same_v<F, float>) {
        const Quadrant q = quadrant(x);
        const bool odd = q.quarter * q.quarter == 1;
        const float s = sine_part(q.rest), c = cosine_part(q.rest);
        return (odd ? -c : s) / (odd ? s : c);
    } else {
        using std::tan;
        return tan(x);
    }
}

// atan of a fraction in 0..1. Above tan(pi/8) it is pi/4 + atan((y - 1) / (y + 1)); for |y| <=
// tan(pi/8), atan y = y + y^3 A(y^2), error 2e-8 y.
inline float angle_of_fraction(float fraction) {
    constexpr float eighth = 0.41421356237f, quarter_pi = 0.78539816340f;
    const bool steep = fraction > eighth;
    const float y = steep ? (fraction - 1) / (fraction + 1) : fraction;
    const float u = y * y;
    const float angle =
        y + y * u *
                (-3.333295512e-01f +
                 u * (1.997792017e-01f + u * (-1.387978016e-01f + u * 8.060065663e-02f)));
    return steep ? quarter_pi + angle : angle;
}

template <class F> F arctangent(F x) {
    if constexpr (std::is_same_v<F, float>) {
        constexpr float half_pi = 1.57079632679f;
        const float size = x < 0 ? -x : x;
        const bool steep = size > 1;
        const float angle = angle_of_fraction(steep ? 1 / size : size);
        const float positive = steep ? half_pi - angle : angle;
        return x < 0 ? -positive : positive;
    } else {
        using std::atan;
        return atan(x);
    }
}

// The angle of (x, y) in (-pi, pi], 0 at the origin (ir/semantics.h).
template <class F> F arctangent(F y, F x) {
    if constexpr (std::is_same_v<F, float>) {
        constexpr float pi = 3.14159265359f, half_pi = 1.57079632679f;
        const float width = x < 0 ? -x : x, height = y < 0 ? -y : y;
        const bool steep = height > width;
        const float less = steep ? width : height, more = steep ? height : width;
        const float fraction = less == more ? (more == 0 ? 0.0f : 1.0f) : less / more;
        const float slope = angle_of_fraction(fraction);
        const float right = steep ? half_pi - slope : slope; // of (|x|, |y|)
        const float upper = x < 0 ? pi - right : right;
        return y < 0 ? -upper : upper;
    } else {
        using std::atan2;
        return atan2(y + F(0), x + F(0));
    }
}

// Of x in -1..1, by the other side of the triangle.
template <class F> F arcsine(F x) {
    if constexpr (std::is_same_v<F, float>) {
        return arctangent(x, std::sqrt((1 - x) * (1 + x)));
    } else {
        using std::asin;
        return asin(x);
    }
}
template <class F> F arccosine(F x) {
    if constexpr (std::is_same_v<F, float>) {
        return arctangent(std::sqrt((1 - x) * (1 + x)), x);
    } else {
        using std::acos;
        return acos(x);
    }
}

} // namespace fathom::cpu::FATHOM_ISA
