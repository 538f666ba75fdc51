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

// What is added to an encoded value of 0..255 at a pixel before it is cut to a byte: 0.02 to 0.98 by
// an ordered pattern of 8x8 pixels (Bayer 1973), so that a slow gradient shows no bands. A value
// within 0.02 of a whole number stays that number everywhere: flat colours stay flat.
float dither(int x, int y);

// Clamped to 0..1, encoded, with `dither` cut to a byte; 0.5 rounds. NaN is 0.
std::uint8_t srgb_byte(float linear, float dither = 0.5f);

// Of linear RGBA, rows from the top; every pixel opaque, dithered.
Picture picture_of_linear(int width, int height, std::span<const float> rgba);

// The pixels that one sample does not do for, by how much they differ from one of the four beside
// them in some channel, encoded 0..1, or in alpha where that counts: 2 above `edge_contrast`, 1 above
// `rough_contrast`, else 0; and 3 where most pixels up to `busy_around` beside are 2, as of a pattern
// that is finer than pixels, where some do not differ by chance. Of linear RGBA.
inline constexpr float rough_contrast = 0.08f, edge_contrast = 0.2f;
inline constexpr int busy_around = 3;
std::vector<std::uint8_t> rough_pixels(int width, int height, std::span<const float> rgba,
                                       bool alpha = false);

// A whole PNG file; empty where the picture has no pixels or is larger than PNG allows. A `note` that
// is not empty is kept in the file as a text of the keyword `fathom`; it is ASCII.
std::string encode_png(int width, int height, std::span<const std::uint8_t> rgba,
                       std::string_view note = {});
inline std::string encode_png(const Picture &picture, std::string_view note = {}) {
    return encode_png(picture.width, picture.height, picture.rgba, note);
}

// The note of a PNG file that is whole: every chunk is there with its checksum, from the signature to
// the end. Nothing where it is not; empty where it has no note.
std::optional<std::string> note_of_png(std::string_view bytes);

// The pixels of a PNG file as encode_png writes them, or nothing.
std::optional<Picture> decode_png(std::string_view bytes);

} // namespace fathom
