// A number with its gradient by the three coordinates of a point: forward-mode differentiation of
// whatever template is given it. At a kink the derivative is that of one side: of what decides a
// little further along a fixed direction v. So where numbers are equal, choices compare how fast
// they grow along v, grad . v. All choices of a point agree on that side, so that a field which is
// smooth although its text is not (numbers sorted by min and max, say) has its true gradient there;
// chosen one by one, they would mix sides. Derivatives that do not exist (sqrt at 0, say) are 0, so
// that gradients are always finite there.
#pragma once

#include "backend-cpu/kernels/elementary.h"
#include "backend-cpu/kernels/kernels.h"
#include "backend-cpu/kernels/trigonometry.h"
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
// The functions by the names that kernel_rows.h looks up: values are those of the point kernels.
inline Dual exponential(Dual a) {
    const float e = base::exponential(a.value);
    return chain(e, a, e);
}
inline Dual exponential2(Dual a) {
    const float e = base::exponential2(a.value);
    return chain(e, a, e * 0.69314718056f);
}
inline Dual logarithm_e(Dual a) { return chain(base::logarithm_e(a.value), a, 1 / a.value); }
inline Dual logarithm_2(Dual a) {
    return chain(base::logarithm_2(a.value), a, 1.44269504089f / a.value);
}
inline Dual sin(Dual a) { return chain(base::sine(a.value), a, base::cosine(a.value)); }
inline Dual cos(Dual a) { return chain(base::cosine(a.value), a, -base::sine(a.value)); }
inline Dual tan(Dual a) {
    const float t = base::tangent(a.value);
    return chain(t, a, 1 + t * t);
}
inline float other_side(float x) { return std::sqrt((1 - x) * (1 + x)); } // of a right triangle
inline Dual asin(Dual a) { return chain(base::arcsine(a.value), a, 1 / other_side(a.value)); }
inline Dual acos(Dual a) { return chain(base::arccosine(a.value), a, -1 / other_side(a.value)); }
inline Dual atan(Dual a) {
    return chain(base::arctangent(a.value), a, 1 / (1 + a.value * a.value));
}
inline Dual sine_hyperbolic(Dual a) {
    return chain(base::sine_hyperbolic(a.value), a, base::cosine_hyperbolic(a.value));
}
inline Dual cosine_hyperbolic(Dual a) {
    return chain(base::cosine_hyperbolic(a.value), a, base::sine_hyperbolic(a.value));
}
inline Dual tangent_hyperbolic(Dual a) {
    const float t = base::tangent_hyperbolic(a.value);
    return chain(t, a, 1 - t * t);
}
inline Dual atan2(Dual y, Dual x) {
    const float square = x.value * x.value + y.value * y.value;
    return chain(base::arctangent(y.value, x.value), y, x.value / square, x, -y.value / square);
}
inline Dual power_of_size(Dual a, Dual b) {
    const float power = base::power_of_size(a.value, b.value);
    const float by_a = b.value == 0 ? 0.0f : b.value * base::power_of_size(a.value, b.value - 1);
    const float by_b = a.value > 0 ? power * base::logarithm_e(a.value) : 0.0f;
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
