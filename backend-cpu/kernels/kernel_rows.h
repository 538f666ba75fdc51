// The kernels of kernels.def as functions of one point, over any number type. Instantiated by
// several files for different processors; FATHOM_ISA names the file's own namespace, so that no
// linker can merge their instantiations (CMakeLists.txt renames ir::sem alike).
#pragma once

#include "backend-cpu/kernels/elementary.h"
#include "backend-cpu/kernels/kernels.h"
#include "backend-cpu/kernels/trigonometry.h"
#include "ir/semantics.h"

#include <array>
#include <type_traits>

#ifndef FATHOM_ISA
#define FATHOM_ISA base
#endif

namespace fathom::cpu::FATHOM_ISA {

namespace sem = ir::sem;
using I = std::int32_t;

template <class F> F dot(F ax, F ay, F bx, F by) { return ax * bx + ay * by; }
template <class F> F dot(F ax, F ay, F az, F bx, F by, F bz) { return ax * bx + ay * by + az * bz; }
template <class F> F dot(F ax, F ay, F az, F aw, F bx, F by, F bz, F bw) {
    return ax * bx + ay * by + az * bz + aw * bw;
}
template <class F> F length(F x, F y) { return sem::sqrt(dot(x, y, x, y)); }
template <class F> F length(F x, F y, F z) { return sem::sqrt(dot(x, y, z, x, y, z)); }
template <class F> F length(F x, F y, F z, F w) { return sem::sqrt(dot(x, y, z, w, x, y, z, w)); }

template <class F> std::array<F, 3> cross(F ax, F ay, F az, F bx, F by, F bz) {
    return {ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx};
}
template <class F> F normalize(F x) { return x * sem::normalizer(x * x); }
template <class F> std::array<F, 2> normalize(F x, F y) {
    F k = sem::normalizer(dot(x, y, x, y));
    return {x * k, y * k};
}
template <class F> std::array<F, 3> normalize(F x, F y, F z) {
    F k = sem::normalizer(dot(x, y, z, x, y, z));
    return {x * k, y * k, z * k};
}
template <class F> std::array<F, 4> normalize(F x, F y, F z, F w) {
    F k = sem::normalizer(dot(x, y, z, w, x, y, z, w));
    return {x * k, y * k, z * k, w * k};
}
template <class F, class... X> F hash(X... components) {
    std::uint32_t h = sem::hash_begin(sizeof...(X));
    ((h = sem::hash_more(h, sem::hash_word(components))), ...);
    return sem::unit<F>(h);
}

// x^n, n > 0; each product rounds once.
template <int n, class F> F power(F x) {
    if constexpr (n == 1) {
        return x;
    } else if constexpr (n % 2 == 0) {
        const F root = power<n / 2>(x);
        return root * root;
    } else {
        return power<n - 1>(x) * x;
    }
}

// The functions of the op table: ir::sem's, but for those that elementary.h and trigonometry.h
// compute.
namespace functions {
using namespace sem;
template <class F> F sin(F x) { return sine(x); }
template <class F> F cos(F x) { return cosine(x); }
template <class F> F tan(F x) { return tangent(x); }
template <class F> F asin(F x) { return arcsine(sem::clamp(x, F(-1), F(1))); }
template <class F> F acos(F x) { return arccosine(sem::clamp(x, F(-1), F(1))); }
template <class F> F atan(F x) { return arctangent(x); }
template <class F> F exp(F x) { return exponential(x); }
template <class F> F exp2(F x) { return exponential2(x); }
template <class F> F log(F x) { return logarithm_e(sem::max(x, F(0))); }
template <class F> F log2(F x) { return logarithm_2(sem::max(x, F(0))); }
template <class F> F sinh(F x) { return sine_hyperbolic(x); }
template <class F> F cosh(F x) { return cosine_hyperbolic(x); }
template <class F> F tanh(F x) { return tangent_hyperbolic(x); }
template <class F> F pow(F x, F y) { return sem::power_of(x, y, power_of_size(sem::abs(x), y)); }
} // namespace functions

#define FATHOM_KERNEL(name, parameters, expression, ...)                                           \
    template <class F> struct name##Row {                                                          \
        static auto run parameters {                                                               \
            using std::floor, std::ceil, std::trunc;                                               \
            using sem::plain;                                                                      \
            return expression;                                                                     \
        }                                                                                          \
        static constexpr auto more_masks = std::to_array<Mask>({0 __VA_OPT__(, ) __VA_ARGS__});    \
    };
#include "backend-cpu/kernels/kernels.def"
#undef FATHOM_KERNEL

template <class T> inline constexpr std::size_t outputs_of = 1;
template <class T, std::size_t n> inline constexpr std::size_t outputs_of<std::array<T, n>> = n;

template <class R, class... P> constexpr std::size_t inputs_of_run(R (*)(P...)) {
    return sizeof...(P);
}
template <class Row> inline constexpr std::size_t inputs_of_row = inputs_of_run(&Row::run);

// The masks of a row's variants, the one of registers first.
template <class Row> constexpr auto masks_of() {
    constexpr std::size_t inputs = inputs_of_row<Row>;
    constexpr std::size_t own = inputs <= 3 ? (std::size_t{1} << inputs) - 1 : 1;
    std::array<Mask, own + Row::more_masks.size() - 1> masks{};
    for (std::size_t i = 0; i < own; ++i) masks[i] = static_cast<Mask>(i);
    for (std::size_t i = 1; i < Row::more_masks.size(); ++i)
        masks[own + i - 1] = Row::more_masks[i];
    return masks;
}

} // namespace fathom::cpu::FATHOM_ISA
