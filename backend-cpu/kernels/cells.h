// What a tape's memory is made of: words for points, four of them for a number with its gradient.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace fathom::cpu {

using Word = std::uint32_t;

// Four words of memory: a number and its gradient by x, y and z.
struct alignas(16) DualCell {
    std::array<Word, 4> words;
};

// Points that a kernel works on at once. A register of this many words is 1 KB: some forty fit the
// first-level cache, and the cost of starting a kernel is spread over sixteen vectors of AVX-512.
inline constexpr std::size_t batch_size = 256;

} // namespace fathom::cpu
