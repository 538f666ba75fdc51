// Folding of constants: each op's meaning (ir/semantics.h) applied to numbers. Ints and bools are
// doubles that hold whole numbers.
#include "ir/passes/fold.h"

#include "ir/semantics.h"

#include <cassert>
#include <cmath>
#include <numbers>

namespace fathom::ir {
namespace {

using Args = std::span<const Constant>;

std::size_t size_of(Type type) { return static_cast<std::size_t>(components(type)); }

Constant scalar(Type type, double value) {
    Constant result{type, {}};
    result.value[0] = value;
    return result;
}

template <class T, class F> Constant map1(Type type, const Constant &a, F f) {
    Constant result{type, {}};
    for (std::size_t i = 0; i < size_of(type); ++i) result.value[i] = f(T(a.value[i]));
    return result;
}
template <class T, class F> Constant map2(Type type, const Constant &a, const Constant &b, F f) {
    Constant result{type, {}};
    for (std::size_t i = 0; i < size_of(type); ++i)
        result.value[i] = f(T(a.value[i]), T(b.value[i]));
    return result;
}
template <class T, class F> Constant map3(Type type, Args a, F f) {
    Constant result{type, {}};
    for (std::size_t i = 0; i < size_of(type); ++i)
        result.value[i] = f(T(a[0].value[i]), T(a[1].value[i]), T(a[2].value[i]));
    return result;
}

std::int32_t whole(double x) { return sem::saturate(x); }

// sin(x + quarters * pi/2). A quarter turn, as near as a double comes to one, has the sine that is
// meant: else a rotation by 90deg would carry a cosine of 6e-17.
double sine(double x, int quarters) {
    const double turned = x / (std::numbers::pi / 2), whole = std::round(turned);
    if (std::abs(whole) < 1e6 && std::abs(turned - whole) <= 1e-15 * std::abs(whole)) {
        constexpr double values[] = {0, 1, 0, -1};
        return values[(static_cast<int>(whole) + quarters) & 3];
    }
    return quarters == 0 ? std::sin(x) : std::cos(x);
}

// The functions of the op table on numbers: ir::sem's, but for those that stand here.
namespace of_number {
using namespace sem;
double sin(double x) { return sine(x, 0); }
double cos(double x) { return sine(x, 1); }
} // namespace of_number

// The arithmetic of ints where it differs from that of floats.
template <class T, class I, class F> Constant arithmetic(Type type, Args a, I of_int, F of_float) {
    if (type == Type::Int) return scalar(type, of_int(whole(a[0].value[0]), whole(a[1].value[0])));
    return map2<T>(type, a[0], a[1], of_float);
}

template <class T> T dot(const Constant &a, const Constant &b) {
    T sum = 0;
    for (std::size_t i = 0; i < size_of(a.type); ++i) sum += T(a.value[i]) * T(b.value[i]);
    return sum;
}

template <class T> Constant multiply_matrices(Type type, const Constant &a, const Constant &b) {
    Constant result{type, {}};
    // A vector on the left is a row, on the right a column.
    const std::size_t n = static_cast<std::size_t>(is_matrix(a.type) ? side(a.type) : side(b.type));
    const std::size_t rows = is_matrix(a.type) ? n : 1, columns = is_matrix(b.type) ? n : 1;
    for (std::size_t c = 0; c < columns; ++c)
        for (std::size_t r = 0; r < rows; ++r) {
            T sum = 0;
            for (std::size_t k = 0; k < n; ++k)
                sum += T(a.value[is_matrix(a.type) ? k * n + r : k]) *
                       T(b.value[is_matrix(b.type) ? c * n + k : k]);
            result.value[c * rows + r] = sum;
        }
    return result;
}

double hash(const Constant &a) {
    const std::size_t n = size_of(a.type);
    std::uint32_t h = sem::hash_begin(static_cast<int>(n));
    for (std::size_t i = 0; i < n; ++i)
        h = sem::hash_more(h, a.type == Type::Int ? sem::hash_word(whole(a.value[i]))
                                                  : sem::hash_word(a.value[i]));
    return sem::unit<double>(h);
}

template <class T> T blend(Profile profile, Args a) {
    const T r = T(a[0].value[0]), n = T(a[1].value[0]);
    T result = T(a[2].value[0]);
    for (std::size_t i = 3; i < a.size(); ++i) {
        const T next = T(a[i].value[0]);
        switch (profile) {
        case Profile::Smooth: result = sem::blend_smooth(result, next, r); break;
        case Profile::Round: result = sem::blend_round(result, next, r); break;
        case Profile::Chamfer: result = sem::blend_chamfer(result, next, r); break;
        case Profile::Stairs: result = sem::blend_stairs(result, next, r, n); break;
        case Profile::Columns: result = sem::blend_columns(result, next, r, n); break;
        }
    }
    return result;
}

Constant joined(Type type, Args a) {
    Constant result{type, {}};
    std::size_t at = 0;
    for (const Constant &part : a)
        for (std::size_t i = 0; i < size_of(part.type); ++i) result.value[at++] = part.value[i];
    assert(at == size_of(type));
    return result;
}

Constant swizzled(Type type, const Constant &a, std::uint32_t mask) {
    Constant result{type, {}};
    for (int i = 0; i < swizzle_size(mask); ++i)
        result.value[static_cast<std::size_t>(i)] =
            a.value[static_cast<std::size_t>(swizzle_component(mask, i))];
    return result;
}

Constant transposed(const Constant &a) {
    Constant result{a.type, {}};
    const std::size_t n = static_cast<std::size_t>(side(a.type));
    for (std::size_t c = 0; c < n; ++c)
        for (std::size_t r = 0; r < n; ++r) result.value[c * n + r] = a.value[r * n + c];
    return result;
}

Constant column(Type type, const Constant &a, std::uint32_t index) {
    Constant result{type, {}};
    const std::size_t n = static_cast<std::size_t>(side(a.type));
    for (std::size_t r = 0; r < n; ++r) result.value[r] = a.value[index * n + r];
    return result;
}

template <class T>
std::optional<Constant> evaluate_in(Op op, Type type, Args a, std::uint32_t payload) {
    using D = double; // of what does not round
    const auto x = [&](std::size_t i) { return a[i].value[0]; };
    const auto at = [&](std::size_t i, std::size_t k) { return T(a[i].value[k]); };
    const auto each = [&](auto f) { return map1<T>(type, a[0], f); };
    const auto flag = [](bool value) { return scalar(Type::Bool, value ? 1 : 0); };
    const auto number = [](double value) { return scalar(Type::Float, value); };
    switch (op) {
#define FATHOM_BOUND(name, ...) case Op::name:
#include "ir/ops.def"
        return std::nullopt;

    case Op::Neg:
        if (type == Type::Int) return scalar(type, sem::int_neg(whole(x(0))));
        return each([](T v) { return -v; });
    case Op::Add: return arithmetic<T>(type, a, sem::int_add, [](T u, T v) { return u + v; });
    case Op::Sub: return arithmetic<T>(type, a, sem::int_sub, [](T u, T v) { return u - v; });
    case Op::Mul: return arithmetic<T>(type, a, sem::int_mul, [](T u, T v) { return u * v; });
    case Op::Div: return arithmetic<T>(type, a, sem::int_div, [](T u, T v) { return u / v; });
    case Op::Mod: return arithmetic<T>(type, a, sem::int_mod, sem::mod<T>);
    case Op::Pow: return map2<T>(type, a[0], a[1], sem::pow<T>);
    case Op::Min: return map2<D>(type, a[0], a[1], sem::min<D>);
    case Op::Max: return map2<D>(type, a[0], a[1], sem::max<D>);
    case Op::Step: return map2<D>(type, a[0], a[1], sem::step<D>);
    case Op::Atan2: return map2<T>(type, a[0], a[1], sem::atan2<T>);
    case Op::Abs:
        if (type == Type::Int) return scalar(type, whole(sem::abs(x(0))));
        return map1<D>(type, a[0], sem::abs<D>);
    case Op::Sign: return map1<D>(type, a[0], sem::sign<D>);
    case Op::Floor: return each([](T v) { return std::floor(v); });
    case Op::Ceil: return each([](T v) { return std::ceil(v); });
    case Op::Round: return each(sem::round<T>);
    case Op::Trunc: return each([](T v) { return std::trunc(v); });
    case Op::Fract: return each(sem::fract<T>);
#define FATHOM_FUNCTION(name, function, ...)                                                       \
    case Op::name: {                                                                               \
        return each([](T v) { return T(of_number::function(v)); });                                \
    }
#include "ir/ops.def"
    case Op::Clamp: return map3<D>(type, a, sem::clamp<D>);
    case Op::Mix: return map3<T>(type, a, sem::mix<T>);
    case Op::Smoothstep: return map3<T>(type, a, sem::smoothstep<T>);

    case Op::Dot: return number(dot<T>(a[0], a[1]));
    case Op::Length: return number(std::sqrt(dot<T>(a[0], a[0])));
    case Op::Cross: {
        Constant result{type, {}};
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
            result.value[i] = at(0, j) * at(1, k) - at(0, k) * at(1, j);
        }
        return result;
    }
    case Op::Normalize: {
        const T factor = sem::normalizer(dot<T>(a[0], a[0]));
        return each([factor](T v) { return v * factor; });
    }

    case Op::Less: return flag(x(0) < x(1));
    case Op::LessEqual: return flag(x(0) <= x(1));
    case Op::Equal: return flag(x(0) == x(1));
    case Op::NotEqual: return flag(x(0) != x(1));
    case Op::And: return flag(x(0) != 0 && x(1) != 0);
    case Op::Or: return flag(x(0) != 0 || x(1) != 0);
    case Op::Not: return flag(x(0) == 0);
    case Op::Select: return x(0) != 0 ? a[1] : a[2];

    case Op::ToFloat: return number(T(x(0)));
    case Op::ToInt: return scalar(Type::Int, whole(x(0)));
    case Op::Splat: {
        const double value = x(0);
        return map1<D>(type, a[0], [value](D) { return value; });
    }
    case Op::Make: return joined(type, a);
    case Op::Swizzle: return swizzled(type, a[0], payload);
    case Op::Column: return column(type, a[0], payload);
    case Op::MatMul: return multiply_matrices<T>(type, a[0], a[1]);
    case Op::Transpose: return transposed(a[0]);

    case Op::Hash: return number(hash(a[0]));
    case Op::Perlin: return number(sem::perlin(at(0, 0), at(0, 1), at(0, 2)));
    case Op::Simplex: return number(sem::simplex(at(0, 0), at(0, 1), at(0, 2)));
    case Op::ValueNoise: return number(sem::value_noise(at(0, 0), at(0, 1), at(0, 2)));
    case Op::Worley: return number(sem::worley(at(0, 0), at(0, 1), at(0, 2)));
    case Op::SpotNoise:
        return number(sem::spot_noise(at(0, 0), at(0, 1), at(0, 2), at(1, 0), at(2, 0)));

    case Op::Union:
    case Op::Intersection: {
        double result = x(0);
        for (std::size_t i = 1; i < a.size(); ++i)
            result = op == Op::Union ? sem::min(result, x(i)) : sem::max(result, x(i));
        return number(result);
    }
    case Op::Blend: return number(blend<T>(static_cast<Profile>(payload), a));
    }
    return std::nullopt;
}

} // namespace

std::optional<Constant> evaluate(Op op, Type type, Args a, std::uint32_t payload) {
    return evaluate_in<double>(op, type, a, payload);
}
std::optional<Constant> evaluate_single(Op op, Type type, Args a, std::uint32_t payload) {
    return evaluate_in<float>(op, type, a, payload);
}

} // namespace fathom::ir
