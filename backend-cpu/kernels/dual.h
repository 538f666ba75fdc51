// A number with its gradient by the three coordinates of a point: forward-mode differentiation of
// whatever template is given it. At a kink the derivative is that of one side: of what decides a
// little further along a fixed direction v. So where numbers are equal, choices compare how fast
// they grow along v, grad . v. All choices of a point agree on that side, so that a field which is
// smooth although its text is not (numbers sorted by min and max, say) has its true gradient there;
// chosen one by one, they would mix sides. Derivatives that do not exist (sqrt at 0, say) are 0, so
// that gradients are always finite there.
#pragma once

#include "backend-cpu/kernels/kernels.h"
#include "ir/semantics.h"

#include <bit>
#include <cmath>
#include <initializer_list>
#include <type_traits>

namespace fathom::cpu {

// A number and its derivatives by x, y and z.
struct Dual {
    float value = 0, dx = 0, dy = 0, dz = 0;

    constexpr Dual() = default;
    constexpr explicit Dual(float v) : value(v) {}
    constexpr explicit Dual(double v) : value(static_cast<float>(v)) {}
    constexpr explicit Dual(int v) : value(static_cast<float>(v)) {}
    constexpr Dual(float v, float x, float y, float z) : value(v), dx(x), dy(y), dz(z) {}

    // Along v, whose components have no simple ratio: planes of ties hold it by chance alone.
    constexpr float growth() const { return 0.7548777f * dx + 0.5698403f * dy + 0.324718f * dz; }

    friend bool operator<(Dual a, Dual b) {
        return a.value < b.value || (a.value == b.value && a.growth() < b.growth());
    }
    friend bool operator>(Dual a, Dual b) { return b < a; }
    friend bool operator<=(Dual a, Dual b) {
        return a.value < b.value || (a.value == b.value && a.growth() <= b.growth());
    }
    friend bool operator>=(Dual a, Dual b) { return b <= a; }
    friend bool operator==(Dual a, Dual b) { return a.value == b.value; }
    friend bool operator!=(Dual a, Dual b) { return a.value != b.value; }
};

inline float plain(Dual a) { return a.value; }

// value = v, gradient = slope * a's; a slope that is no number counts as 0.
inline Dual chain(float v, Dual a, float slope) {
    float s = std::isfinite(slope) ? slope : 0.0f;
    return {v, s * a.dx, s * a.dy, s * a.dz};
}
inline Dual chain(float v, Dual a, float by_a, Dual b, float by_b) {
    Dual p = chain(v, a, by_a), q = chain(v, b, by_b);
    return {v, p.dx + q.dx, p.dy + q.dy, p.dz + q.dz};
}

inline Dual operator-(Dual a) { return {-a.value, -a.dx, -a.dy, -a.dz}; }
inline Dual operator+(Dual a, Dual b) {
    return {a.value + b.value, a.dx + b.dx, a.dy + b.dy, a.dz + b.dz};
}
inline Dual operator-(Dual a, Dual b) {
    return {a.value - b.value, a.dx - b.dx, a.dy - b.dy, a.dz - b.dz};
}
inline Dual operator*(Dual a, Dual b) { return chain(a.value * b.value, a, b.value, b, a.value); }
inline Dual operator/(Dual a, Dual b) {
    return chain(a.value / b.value, a, 1 / b.value, b, -a.value / (b.value * b.value));
}

inline Dual floor(Dual a) { return Dual(std::floor(a.value)); }
inline Dual ceil(Dual a) { return Dual(std::ceil(a.value)); }
inline Dual trunc(Dual a) { return Dual(std::trunc(a.value)); }
inline Dual sqrt(Dual a) {
    float root = std::sqrt(a.value);
    return chain(root, a, 0.5f / root);
}
// The length of a vector is |x| along a line on which but one component x changes, also at 0.
inline Dual length_at_zero(Dual all, std::initializer_list<Dual> components) {
    if (all.value != 0) return all;
    const Dual *only = nullptr;
    for (const Dual &one : components)
        if (one.growth() != 0) {
            if (only) return all;
            only = &one;
        }
    if (!only) return all;
    return only->growth() < 0 ? -*only : *only;
}
inline Dual length(Dual x, Dual y) { return length_at_zero(sqrt(x * x + y * y), {x, y}); }
inline Dual length(Dual x, Dual y, Dual z) {
    return length_at_zero(sqrt(x * x + y * y + z * z), {x, y, z});
}
inline Dual length(Dual x, Dual y, Dual z, Dual w) {
    return length_at_zero(sqrt(x * x + y * y + z * z + w * w), {x, y, z, w});
}
inline Dual exp(Dual a) {
    float e = std::exp(a.value);
    return chain(e, a, e);
}
inline Dual exp2(Dual a) {
    float e = std::exp2(a.value);
    return chain(e, a, e * 0.69314718056f);
}
inline Dual log(Dual a) { return chain(std::log(a.value), a, 1 / a.value); }
inline Dual log2(Dual a) { return chain(std::log2(a.value), a, 1.44269504089f / a.value); }
inline Dual sin(Dual a) { return chain(std::sin(a.value), a, std::cos(a.value)); }
inline Dual cos(Dual a) { return chain(std::cos(a.value), a, -std::sin(a.value)); }
inline Dual tan(Dual a) {
    float t = std::tan(a.value);
    return chain(t, a, 1 + t * t);
}
inline Dual asin(Dual a) {
    return chain(std::asin(a.value), a, 1 / std::sqrt(1 - a.value * a.value));
}
inline Dual acos(Dual a) {
    return chain(std::acos(a.value), a, -1 / std::sqrt(1 - a.value * a.value));
}
inline Dual atan(Dual a) { return chain(std::atan(a.value), a, 1 / (1 + a.value * a.value)); }
inline Dual sinh(Dual a) { return chain(std::sinh(a.value), a, std::cosh(a.value)); }
inline Dual cosh(Dual a) { return chain(std::cosh(a.value), a, std::sinh(a.value)); }
inline Dual tanh(Dual a) {
    float t = std::tanh(a.value);
    return chain(t, a, 1 - t * t);
}
inline Dual atan2(Dual y, Dual x) {
    float square = x.value * x.value + y.value * y.value;
    return chain(std::atan2(y.value, x.value), y, x.value / square, x, -y.value / square);
}
// For bases of 0 and above (ir/semantics.h takes the rest to these).
inline Dual pow(Dual a, Dual b) {
    float power = std::pow(a.value, b.value);
    float by_a = b.value == 0 ? 0.0f : b.value * std::pow(a.value, b.value - 1);
    float by_b = a.value > 0 ? power * std::log(a.value) : 0.0f;
    return chain(power, a, by_a, b, by_b);
}

} // namespace fathom::cpu

namespace fathom::ir::sem {
// At a discontinuity they have the value that floats have, whatever the number grows to.
template <> inline cpu::Dual sign(cpu::Dual x) { return cpu::Dual(sign(x.value)); }
template <> inline cpu::Dual step(cpu::Dual edge, cpu::Dual x) {
    return cpu::Dual(step(edge.value, x.value));
}
} // namespace fathom::ir::sem

namespace fathom::cpu {

// How a cell holds it: ints and truths in the first word. Beside the type, where look-up by
// argument finds them.
template <class T> T load(const DualCell &cell) {
    if constexpr (std::is_same_v<T, Dual>)
        return std::bit_cast<Dual>(cell);
    else if constexpr (std::is_same_v<T, bool>)
        return cell.words[0] != 0;
    else
        return std::bit_cast<T>(cell.words[0]);
}
inline void store(DualCell &cell, Dual x) { cell = std::bit_cast<DualCell>(x); }
inline void store(DualCell &cell, std::int32_t x) { cell.words[0] = static_cast<std::uint32_t>(x); }
inline void store(DualCell &cell, bool x) { cell.words[0] = x ? 1u : 0u; }

} // namespace fathom::cpu
