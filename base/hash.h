// How hashes of several words are made, for tables in memory. Not kept in files: may change.
#pragma once

#include <cstdint>

namespace fathom {

inline std::uint64_t hash_combine(std::uint64_t hash, std::uint64_t word) {
    hash = (hash ^ word) * 0x9e3779b97f4a7c15ull;
    return hash ^ (hash >> 29);
}

} // namespace fathom
