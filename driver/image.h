// What scenes read besides text: pictures (PNG, JPEG) as linear colours, grids of distances; and
// pictures as JPEG files. Knows nothing of paths.
#pragma once

#include "ir/scene.h"
#include "typecheck/check.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>

namespace fathom::driver {

using typecheck::LoadError;
using typecheck::Room;

// Or why the bytes are no picture, or one for which there is no room. What it takes is taken off
// `room`: 16 bytes a pixel, a step for 16 pixels of each scan.
std::variant<ir::ImageData, LoadError> decode_image(std::string_view bytes, Room &room);

// A whole JPEG file of rows from the top, RGBA, sRGB-encoded; of a quality from 1 to 100 in
// libjpeg's scale, with colours as fine as lightness. Empty where there are no pixels, or more of
// them than JPEG allows.
std::string encode_jpeg(int width, int height, std::span<const std::uint8_t> rgba, int quality);

// A grid of values: NRRD of three dimensions, x the fastest, of floats, doubles or integers (which
// become the nearest floats), raw, gzip or ascii; or OpenVDB (driver/vdb/vdb.h), which may have
// several, of which `name` says one. Takes 4 bytes a value, and a step for 16 of them.
std::variant<ir::GridData, LoadError> decode_grid(std::string_view bytes, Room &room,
                                                  const std::string &name = {});

} // namespace fathom::driver
