// Every variant of every kernel as a loop over a batch, and the table of them. The loops are plain,
// so that the compiler vectorises them for whatever processor the including file is compiled for.
#pragma once

#include "backend-cpu/kernels/kernel_rows.h"

#include <bit>
#include <tuple>
#include <utility>

#if defined(__clang__)
#define FATHOM_INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")
#else
#define FATHOM_INDEPENDENT _Pragma("GCC ivdep")
#endif

namespace fathom::cpu::FATHOM_ISA {

// How a cell holds numbers: `load<float>(cell)`, for each number type beside its definition.
template <class T> inline T load(const std::uint32_t &cell) {
    if constexpr (std::is_same_v<T, bool>)
        return cell != 0;
    else
        return std::bit_cast<T>(cell);
}
inline void store(std::uint32_t &cell, float x) { cell = std::bit_cast<std::uint32_t>(x); }
inline void store(std::uint32_t &cell, I x) { cell = static_cast<std::uint32_t>(x); }
inline void store(std::uint32_t &cell, bool x) { cell = x ? 1u : 0u; }

template <class Cell, class T, bool shared> struct Operand {
    const Cell *cells;
    explicit Operand(const Cell *at) : cells(at) {}
    T operator[](std::size_t k) const { return load<T>(cells[k]); }
};
template <class Cell, class T> struct Operand<Cell, T, true> {
    T value;
    explicit Operand(const Cell *at) : value(load<T>(*at)) {}
    T operator[](std::size_t) const { return value; }
};

// An output may stand in the register of an input that ends here, number by number: no iteration
// depends on another.
template <class Row, class Cell, Mask mask, class R, class... P, std::size_t... i>
void loop_of(R (*)(P...), std::index_sequence<i...>, Cell *cells, const std::uint32_t *operands,
             std::size_t n) {
    constexpr std::size_t outs = outputs_of<R>;
    const std::tuple<Operand<Cell, P, (mask >> i & 1) != 0>...> in(cells + operands[outs + i]...);
    if constexpr (std::is_same_v<R, float> || std::is_same_v<R, I> || std::is_same_v<R, bool> ||
                  outs == 1) {
        Cell *out = cells + operands[0];
        FATHOM_INDEPENDENT
        for (std::size_t k = 0; k < n; ++k) store(out[k], Row::run(std::get<i>(in)[k]...));
    } else {
        std::array<Cell *, outs> out;
        for (std::size_t o = 0; o < outs; ++o) out[o] = cells + operands[o];
        FATHOM_INDEPENDENT
        for (std::size_t k = 0; k < n; ++k) {
            const R result = Row::run(std::get<i>(in)[k]...);
            for (std::size_t o = 0; o < outs; ++o) store(out[o][k], result[o]);
        }
    }
}

// Flat: a call inside would keep the loop from being vectorised.
template <class Row, class Cell, Mask mask>
[[gnu::flatten]] void loop(Cell *cells, const std::uint32_t *operands, std::size_t n) {
    loop_of<Row, Cell, mask>(&Row::run, std::make_index_sequence<inputs_of_row<Row>>{}, cells,
                             operands, n);
}

template <class Cell> using LoopPointer = void (*)(Cell *, const std::uint32_t *, std::size_t);

template <class Row, class Cell, std::size_t... m>
constexpr auto loops_of_row(std::index_sequence<m...>) {
    constexpr auto masks = masks_of<Row>();
    return std::array<LoopPointer<Cell>, sizeof...(m)>{&loop<Row, Cell, masks[m]>...};
}

template <class F> inline constexpr std::size_t variant_count = 0
#define FATHOM_KERNEL(name, parameters, expression, ...) +masks_of<name##Row<F>>().size()
#include "backend-cpu/kernels/kernels.def"
#undef FATHOM_KERNEL
    ;

template <class F, class Cell> constexpr auto all_loops() {
    std::array<LoopPointer<Cell>, variant_count<F>> all{};
    std::size_t at = 0;
#define FATHOM_KERNEL(name, parameters, expression, ...)                                           \
    for (auto *pointer : loops_of_row<name##Row<F>, Cell>(                                         \
             std::make_index_sequence<masks_of<name##Row<F>>().size()>{}))                         \
        all[at++] = pointer;
#include "backend-cpu/kernels/kernels.def"
#undef FATHOM_KERNEL
    return all;
}

} // namespace fathom::cpu::FATHOM_ISA
