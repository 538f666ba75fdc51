// The lattice on which surfaces are looked for. Every coordinate of it is a float, exactly, and an
// odd multiple of an odd number times a power of two: so planes at round coordinates, as people
// write them, lie between its planes and not on them, and x = 0 lies in the middle of a cell.
#pragma once

#include "ir/shape.h"

#include <array>
#include <cstdint>
#include <optional>

namespace fathom::mesh {

// A corner of the lattice, counted from the corner of its cube, in cells of the finest level.
using Index = std::array<std::int32_t, 3>;

struct Lattice {
    double unit = 1; // half the side of a cell of the finest level
    Index first{};   // where the cube begins: coordinate unit * (2 first + 1)
    int depth = 0;   // the cube is 2^depth cells of the finest level a side
    int level = 0;   // cells of this level show the surface where nothing smaller is hidden
    double ulp = 0;  // of the largest coordinate: all coordinates are multiples of it

    float at(std::size_t axis, std::int32_t index) const {
        return static_cast<float>(unit * (2.0 * (double(first[axis]) + index) + 1.0));
    }
    std::int32_t cells(int of_level) const { return std::int32_t{1} << (depth - of_level); }
    double side(int of_level) const { return 2 * unit * cells(of_level); } // of a cell
};

// A lattice about a finite box, a cell farther to each side at least, whose cells of `level` are no
// longer than `side`, by at most a 32nd shorter. `extra` levels lie below, and `deeper` more as long
// as cells are shorter by a 128th at most; or as many as floats can tell apart. None: they cannot tell
// cells of that size apart where the box is.
std::optional<Lattice> make_lattice(const ir::Box &box, double side, int extra, int deeper = 0);

inline constexpr int max_level = 13; // 8,192 cells a side

} // namespace fathom::mesh
