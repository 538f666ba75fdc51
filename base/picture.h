// Pictures as bytes: sRGB encoding and PNG. Opens no file; knows nothing of how a picture came to
// be.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace fathom {

// Rows from the top, RGBA, sRGB-encoded, 4*width*height bytes.
struct Picture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba;
};

std::uint8_t srgb_byte(float linear); // clamped to 0..1, rounded; NaN is 0

// Of linear RGBA, rows from the top; every pixel opaque.
Picture picture_of_linear(int width, int height, std::span<const float> rgba);

// A whole PNG file; empty where the picture has no pixels or is larger than PNG allows.
std::string encode_png(const Picture &picture);

} // namespace fathom
