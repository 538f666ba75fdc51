// A picture as an OpenEXR file: what compositing programs read. Opens no file.
#pragma once

#include <span>
#include <string>

namespace fathom::cli {

// The bytes of an EXR file (scan lines, ZIP) of linear colours, four floats a pixel, from the top left;
// alpha, 0 to 1, is multiplied into the colours. Its numbers are halves: what is beyond 65504 is cut to
// that. Empty where there is no memory for it, or the picture is larger than the format allows.
std::string encode_exr(int width, int height, std::span<const float> rgba);

} // namespace fathom::cli
