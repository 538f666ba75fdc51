// How hashes of nodes and shapes take in a word.
#pragma once

#include <cstdint>

namespace fathom::ir {

inline std::uint64_t stir(std::uint64_t h, std::uint64_t word) {
    h = (h ^ word) * 0x9e3779b97f4a7c15ull;
    return h ^ (h >> 29);
}

} // namespace fathom::ir
