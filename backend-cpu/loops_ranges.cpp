// The kernels over ranges, compiled once for every instruction set (CMakeLists.txt, FATHOM_ISA),
// and what compares ranges for many boxes at once.
#include "backend-cpu/loops.h"
#include "backend-cpu/range_rows.h"

#include <cstring>

namespace fathom::cpu::FATHOM_ISA {

namespace {

struct RangeOperand {
    const float *lo, *hi;
    RangeOperand(const RangeCells &cells, std::uint32_t at)
        : lo(cells.lo + at), hi(cells.hi + at) {}
};
template <bool shared> Range at(const RangeOperand &in, std::size_t k) {
    return {in.lo[shared ? 0 : k], in.hi[shared ? 0 : k]};
}

template <class Row, Mask mask, class R, class... P, std::size_t... i>
void range_loop_of(R (*)(P...), std::index_sequence<i...>, const RangeCells &cells,
                   const std::uint32_t *operands, std::size_t n) {
    constexpr std::size_t outs = outputs_of<R>;
    const std::array<RangeOperand, sizeof...(i)> in{RangeOperand(cells, operands[outs + i])...};
    if constexpr (outs == 1) {
        float *lo = cells.lo + operands[0], *hi = cells.hi + operands[0];
        FATHOM_INDEPENDENT
        for (std::size_t k = 0; k < n; ++k) {
            const R result = Row::run(at<(mask >> i & 1) != 0>(in[i], k)...);
            lo[k] = result.lo, hi[k] = result.hi;
        }
    } else {
        for (std::size_t k = 0; k < n; ++k) {
            const R result = Row::run(at<(mask >> i & 1) != 0>(in[i], k)...);
            for (std::size_t o = 0; o < outs; ++o) {
                cells.lo[operands[o] + k] = result[o].lo;
                cells.hi[operands[o] + k] = result[o].hi;
            }
        }
    }
}

template <class Row, Mask mask> [[gnu::flatten]] void
range_loop(const RangeCells &cells, const std::uint32_t *operands, std::size_t n) {
    range_loop_of<Row, mask>(&Row::run, std::make_index_sequence<inputs_of_row<Row>>{}, cells,
                             operands, n);
}

template <class Points, class Row, std::size_t... m>
constexpr auto range_loops_of_row(std::index_sequence<m...>) {
    static_assert(inputs_of_row<Row> == inputs_of_row<Points>);
    constexpr auto masks = masks_of<Points>();
    return std::array<RangeLoop, sizeof...(m)>{&range_loop<Row, masks[m]>...};
}

constexpr auto all_range_loops() {
    std::array<RangeLoop, variant_count<float>> all{};
    std::size_t next = 0;
#define FATHOM_KERNEL(name, parameters, expression, ...)                                           \
    for (RangeLoop pointer : range_loops_of_row<name##Row<float>, range::name##Row>(               \
             std::make_index_sequence<masks_of<name##Row<float>>().size()>{}))                     \
        all[next++] = pointer;
#include "backend-cpu/kernels.def"
#undef FATHOM_KERNEL
    return all;
}
constexpr auto loops = all_range_loops();

// Eight truths, a byte each, to eight bits: the multiplication brings byte i's last bit to 56 + i.
std::uint64_t bits_of(const std::uint8_t *truths) {
    std::uint64_t bits = 0;
    for (std::size_t byte = 0; byte < 8; ++byte) {
        std::uint64_t eight;
        std::memcpy(&eight, truths + 8 * byte, 8);
        bits |= (eight * 0x0102040810204080u >> 56) << (8 * byte);
    }
    return bits;
}

template <class F> std::uint64_t mask_of(std::size_t n, F holds) {
    std::uint8_t truths[64] = {};
    for (std::size_t k = 0; k < n; ++k) truths[k] = holds(k) ? 1 : 0;
    return bits_of(truths);
}

// Bit k: a + margin <= b, and a < b, all over box k.
std::uint64_t below(const float *a_hi, bool a_shared, const float *b_lo, bool b_shared,
                    const float *margin_hi, bool margin_shared, std::size_t n) {
    if (a_shared && b_shared && margin_shared)
        return *b_lo - *a_hi >= *margin_hi && *a_hi < *b_lo ? ~std::uint64_t{0} : 0;
    if (!a_shared && !b_shared && margin_shared)
        return mask_of(n, [&, margin = *margin_hi](std::size_t k) {
            return (b_lo[k] - a_hi[k] >= margin) & (a_hi[k] < b_lo[k]);
        });
    return mask_of(n, [&](std::size_t k) {
        const float a = a_hi[a_shared ? 0 : k], b = b_lo[b_shared ? 0 : k];
        return (b - a >= margin_hi[margin_shared ? 0 : k]) & (a < b);
    });
}

} // namespace

RangeLoops range_loops();
RangeLoops range_loops() { return {loops, below}; }

} // namespace fathom::cpu::FATHOM_ISA
