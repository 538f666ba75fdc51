// The kernels over ranges, compiled once for every instruction set (CMakeLists.txt, FATHOM_ISA),
// and what compares ranges for many boxes at once.
#include "backend-cpu/kernels/loops.h"
#include "backend-cpu/prune/range_rows.h"

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
#include "backend-cpu/kernels/kernels.def"
#undef FATHOM_KERNEL
    return all;
}
constexpr auto loops = all_range_loops();

// Eight truths, a byte each, to eight bits: the multiplication brings byte i's last bit to 56 + i.
std::uint64_t bits_of_eight(const std::uint8_t *truths) {
    std::uint64_t eight;
    std::memcpy(&eight, truths, 8);
    return eight * 0x0102040810204080u >> 56;
}
std::uint64_t bits_of(const std::uint8_t *truths) {
    std::uint64_t bits = 0;
    for (std::size_t byte = 0; byte < 8; ++byte)
        bits |= bits_of_eight(truths + 8 * byte) << (8 * byte);
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

// Boxes are taken eight at a time; where a ball is out of reach of all eight, k and what is carried
// there apart, by a test that is coarser than ranges and surely wider than rounding, it changes
// nothing.
constexpr std::size_t eight = 8, max_eights = 8;
struct Eights {
    float lo[3][max_eights], hi[3][max_eights], carried[max_eights];
};
std::uint64_t in_reach(const Eights &eights, std::size_t n, const float *row, float k) {
    std::uint8_t truths[max_eights] = {};
    for (std::size_t e = 0; e < n; ++e) {
        float square = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float way = sem::maximum(
                sem::maximum(eights.lo[axis][e] - row[axis], row[axis] - eights.hi[axis][e]), 0.0f);
            square += way * way;
        }
        const float a = eights.carried[e];
        const float reach = sem::maximum(
            a + k + row[3] + 1e-5f * (sem::abs(a) + sem::abs(k) + sem::abs(row[3])), 0.0f);
        truths[e] = !(square >= reach * reach * 1.00001f);
    }
    return bits_of_eight(truths);
}

// Bit j: number j is negative.
std::uint64_t signs_of(const float *numbers) {
    std::uint64_t bits = 0;
    for (std::size_t pair = 0; pair < 4; ++pair) {
        std::uint64_t two;
        std::memcpy(&two, numbers + 2 * pair, sizeof two);
        bits |= (two >> 31 & 1) << (2 * pair) | (two >> 63) << (2 * pair + 1);
    }
    return bits;
}

template <bool is_smooth>
[[gnu::flatten]] void ball_rows(const BallRangeRows &in, const BallRangeFound &found) {
    const std::size_t n = in.boxes, eights_count = n / eight;
    const std::size_t lanes = in.at_once; // eight, but vectorised as a loop, not piece by piece
    float *carried_lo = in.carried_lo, *carried_hi = in.carried_hi;
    const Range k{in.k_lo, in.k_hi};
    Eights eights;
    const auto largest = [](const float *numbers) {
        float result = numbers[0];
        for (std::size_t i = 1; i < eight; ++i) result = sem::maximum(result, numbers[i]);
        return result;
    };
    for (std::size_t e = 0; e < max_eights; ++e) {
        const std::size_t first = (e < eights_count ? e : 0) * eight;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            float lowest = in.lo[axis][first];
            for (std::size_t i = 1; i < eight; ++i)
                lowest = sem::minimum(lowest, in.lo[axis][first + i]);
            eights.lo[axis][e] = lowest;
            eights.hi[axis][e] = largest(in.hi[axis] + first);
        }
        eights.carried[e] = largest(in.carried_hi + first);
    }
    const std::uint64_t all = eights_count == max_eights ? 0xff : (1u << eights_count) - 1;
    for (std::size_t i = 0; i < in.count; ++i) {
        const float *row = in.numbers + 4 * std::size_t{in.rows[i]};
        const Range x{row[0], row[0]}, y{row[1], row[1]}, z{row[2], row[2]}, r{row[3], row[3]};
        std::uint64_t neutral = ~std::uint64_t{0}, renewed = 0;
        for (std::uint64_t left = in_reach(eights, max_eights, row, k.hi) & all; left != 0;
             left &= left - 1) {
            const auto e = static_cast<std::size_t>(std::countr_zero(left));
            const std::size_t first = e * eight;
            float lo[eight], hi[eight], a_lo[eight], a_hi[eight];
            FATHOM_INDEPENDENT
            for (std::size_t j = 0; j < lanes; ++j) {
                const std::size_t box = first + j;
                const Range b = range::BallRow::run({in.lo[0][box], in.hi[0][box]},
                                                    {in.lo[1][box], in.hi[1][box]},
                                                    {in.lo[2][box], in.hi[2][box]}, x, y, z, r);
                lo[j] = b.lo, hi[j] = b.hi;
                a_lo[j] = carried_lo[box], a_hi[j] = carried_hi[box];
            }
            float same[eight], fresh[eight];
            FATHOM_INDEPENDENT
            for (std::size_t j = 0; j < lanes; ++j) {
                same[j] = ((lo[j] - a_hi[j] >= k.hi) & (a_hi[j] < lo[j])) ? -1.0f : 1.0f;
                fresh[j] = ((a_lo[j] - hi[j] >= k.hi) & (hi[j] < a_lo[j])) ? -1.0f : 1.0f;
                const Range a{a_lo[j], a_hi[j]}, b{lo[j], hi[j]};
                const Range joined =
                    is_smooth ? range::BlendSmoothRow::run(a, b, k) : range::MinFRow::run(a, b);
                carried_lo[first + j] = joined.lo, carried_hi[first + j] = joined.hi;
            }
            neutral &= ~((signs_of(same) ^ 0xff) << first);
            renewed |= signs_of(fresh) << first;
            if (found.lows) std::memcpy(found.lows + i * n + first, lo, sizeof lo);
            eights.carried[e] = largest(in.carried_hi + first);
        }
        found.neutral[i * found.stride] = neutral;
        found.renewed[i * found.stride] = renewed;
    }
}
void balls(const BallRangeRows &in, const BallRangeFound &found) {
    in.smooth ? ball_rows<true>(in, found) : ball_rows<false>(in, found);
}

} // namespace

RangeLoops range_loops();
RangeLoops range_loops() { return {loops, below, balls}; }

} // namespace fathom::cpu::FATHOM_ISA
