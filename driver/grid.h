// What all grids that are read have in common, whatever their format.
#pragma once

#include "driver/image.h"

#include <array>
#include <cstdint>
#include <optional>

namespace fathom::driver {

// Sets the grid's size, where there is room for so many values beside `extra` bytes that reading
// them takes; otherwise why not. Reserves nothing.
std::optional<LoadError> make_place(const std::array<std::uint64_t, 3> &size, std::size_t extra,
                                    const Room &room, ir::GridData &grid);

// Takes a whole grid off the room: 4 bytes a value, and a step for 16 of them. Or why it is none: a
// value that is not finite.
std::optional<LoadError> take_grid(const ir::GridData &grid, Room &room);

} // namespace fathom::driver
