// Every kernel over ranges, in every instruction set: the floats that the point kernel computes
// from numbers within the ranges lie within what the range kernel says.
#include "backend-cpu/kernels/kernel_rows.h"
#include "backend-cpu/kernels/kernels.h"

#include <catch2/catch.hpp>

#include <bit>
#include <cmath>
#include <random>
#include <vector>

using namespace fathom::cpu;

namespace {

enum class Number { Float, Int, Bool };
template <class T> constexpr Number number_of() {
    if constexpr (std::is_same_v<T, bool>) return Number::Bool;
    if constexpr (std::is_same_v<T, std::int32_t>) return Number::Int;
    return Number::Float;
}
template <class R, class... P> std::vector<Number> inputs_of(R (*)(P...)) {
    return {number_of<P>()...};
}
std::vector<std::vector<Number>> all_inputs() {
    return {
#define FATHOM_KERNEL(name, parameters, expression, ...) inputs_of(&base::name##Row<float>::run),
#include "backend-cpu/kernels/kernels.def"
#undef FATHOM_KERNEL
    };
}

struct Range {
    float lo, hi;
};

constexpr std::size_t boxes = 64, tries = 40;

struct Dice {
    std::mt19937 random{1};
    float in(float lo, float hi) {
        return lo + (hi - lo) * std::uniform_real_distribution<float>()(random);
    }
    bool chance(float p) { return in(0, 1) < p; }

    Range range(Number number) {
        if (number == Number::Bool) {
            const float lo = chance(0.5f) ? 0.0f : 1.0f;
            return {lo, chance(0.5f) ? 1.0f : lo};
        }
        const float size = chance(0.1f) ? 1e6f : (chance(0.3f) ? 30.0f : 2.0f);
        float middle = in(-size, size),
              half = chance(0.25f) ? 0 : std::exp2(in(-14, 1)) * (chance(0.1f) ? size : 1);
        if (number == Number::Int) middle = std::round(middle), half = std::floor(half * 4);
        if (chance(0.1f)) middle = half; // from 0 on
        return {middle - half, middle + half};
    }
    float number(Number number, Range range) {
        if (chance(0.1f)) return range.lo;
        if (chance(0.1f)) return range.hi;
        const float x = std::clamp(in(range.lo, range.hi), range.lo, range.hi);
        return number == Number::Float ? x : std::clamp(std::round(x), range.lo, range.hi);
    }
};

std::uint32_t word(Number number, float x) {
    if (number == Number::Float) return std::bit_cast<std::uint32_t>(x);
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(x));
}

} // namespace

TEST_CASE("what a kernel computes from numbers in ranges lies in its range") {
    const auto inputs = all_inputs();
    const auto point_sets = point_loop_sets();
    const auto range_sets = range_loop_sets();
    REQUIRE(point_sets.size() == range_sets.size());
    Dice dice;
    for (std::size_t set = 0; set < point_sets.size(); ++set)
        for (std::uint32_t variant = 0; variant < point_sets[set].loops.size(); ++variant) {
            const Kernel kernel = kernel_of_variant(variant);
            const Mask mask = mask_of_variant(variant);
            const std::vector<Number> &in = inputs[static_cast<std::size_t>(kernel)];
            const auto outs = static_cast<std::size_t>(kernel_outputs(kernel));
            INFO(point_sets[set].name << ": " << kernel_name(kernel) << ", mask " << mask);
            // Each operand has 64 cells of its own.
            const std::size_t cells = (outs + in.size()) * boxes;
            std::vector<float> lo(cells), hi(cells);
            std::vector<std::uint32_t> operands, words(cells);
            for (std::size_t o = 0; o < outs + in.size(); ++o)
                operands.push_back(static_cast<std::uint32_t>(o * boxes));
            std::size_t wrong = 0, narrow = 0;
            for (int round = 0; round < 6; ++round) {
                for (std::size_t i = 0; i < in.size(); ++i)
                    for (std::size_t k = 0; k < boxes; ++k) {
                        const Range range = dice.range(in[i]);
                        lo[operands[outs + i] + k] = range.lo;
                        hi[operands[outs + i] + k] = range.hi;
                    }
                range_sets[set].loops[variant](RangeCells{lo.data(), hi.data()}, operands.data(),
                                               boxes);
                for (std::size_t t = 0; t < tries; ++t) {
                    for (std::size_t i = 0; i < in.size(); ++i)
                        for (std::size_t k = 0; k < boxes; ++k) {
                            const std::size_t at = operands[outs + i] + k;
                            words[at] = word(in[i], dice.number(in[i], {lo[at], hi[at]}));
                        }
                    point_sets[set].loops[variant](words.data(), operands.data(), boxes);
                    for (std::size_t o = 0; o < outs; ++o)
                        for (std::size_t k = 0; k < boxes; ++k) {
                            const std::size_t at = operands[o] + k;
                            const float value =
                                kernel_output_type(kernel) == fathom::ir::Type::Float
                                    ? std::bit_cast<float>(words[at])
                                    : static_cast<float>(static_cast<std::int32_t>(words[at]));
                            narrow += hi[at] - lo[at] < 1e30f;
                            if (!(value != value || (lo[at] <= value && value <= hi[at]))) ++wrong;
                        }
                }
            }
            CHECK(wrong == 0);
            CHECK(narrow > 0);
        }
}

TEST_CASE("what is below what, for 64 boxes at once") {
    for (const RangeLoops &set : range_loop_sets()) {
        std::vector<float> a(boxes), b(boxes), by(boxes);
        std::uint64_t expected = 0;
        for (std::size_t k = 0; k < boxes; ++k) {
            a[k] = static_cast<float>(k % 5), b[k] = static_cast<float>(k % 7);
            by[k] = static_cast<float>(k % 3);
            if (b[k] - a[k] >= by[k] && a[k] < b[k]) expected |= std::uint64_t{1} << k;
        }
        CHECK(set.below(a.data(), false, b.data(), false, by.data(), false, boxes) == expected);
        const float two = 2, four = 4, one = 1;
        CHECK(set.below(&two, true, &four, true, &one, true, boxes) == ~std::uint64_t{0});
        CHECK(set.below(&four, true, &two, true, &one, true, boxes) == 0);
    }
}
