// Pictures as bytes: sRGB encoding and PNG. Opens no file; knows nothing of how a picture came to
// be.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
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

// A whole PNG file; empty where the picture has no pixels or is larger than PNG allows. A `note` that
// is not empty is kept in the file as a text of the keyword `fathom`; it is ASCII.
std::string encode_png(const Picture &picture, std::string_view note = {});

// The note of a PNG file that is whole: every chunk is there with its checksum, from the signature to
// the end. Nothing where it is not; empty where it has no note.
std::optional<std::string> note_of_png(std::string_view bytes);

// The pixels of a PNG file as encode_png writes them, or nothing.
std::optional<Picture> decode_png(std::string_view bytes);

} // namespace fathom
