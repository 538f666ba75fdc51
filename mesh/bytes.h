// Numbers as bytes of binary files, little-endian.
#pragma once

#include "mesh/polygons.h"

#include <bit>
#include <cstring>
#include <string>

namespace fathom::mesh {

template <class Number> void put(std::string &bytes, Number number) {
    static_assert(std::endian::native == std::endian::little);
    std::array<char, sizeof(Number)> raw;
    std::memcpy(raw.data(), &number, sizeof(Number));
    bytes.append(raw.data(), raw.size());
}
inline void put(std::string &bytes, const Point &p) {
    for (const float x : p) put(bytes, x);
}

} // namespace fathom::mesh
