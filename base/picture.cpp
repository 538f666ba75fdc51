#include "base/picture.h"
#include "base/srgb.h"

#include <png.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>

namespace fathom {

float dither(int x, int y) {
    int place = 0; // the bits of x^y and y in turn, the lowest first
    for (int bit = 0; bit < 3; ++bit)
        place = place * 4 + ((((x ^ y) >> bit) & 1) * 2 + ((y >> bit) & 1));
    return 0.02f + 0.96f / 63 * static_cast<float>(place);
}

std::uint8_t srgb_byte(float linear, float dither) {
    if (!(linear > 0)) return 0;
    if (linear >= 1) return 255;
    return static_cast<std::uint8_t>(srgb_of_linear(linear) * 255 + dither);
}

Picture picture_of_linear(int width, int height, std::span<const float> rgba) {
    Picture picture{width, height, {}};
    picture.rgba.resize(rgba.size());
    std::size_t i = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x, i += 4) {
            const float add = dither(x, y);
            for (std::size_t c = 0; c < 3; ++c) picture.rgba[i + c] = srgb_byte(rgba[i + c], add);
            picture.rgba[i + 3] = 255;
        }
    return picture;
}

std::vector<std::uint8_t> rough_pixels(int width, int height, std::span<const float> rgba,
                                       bool alpha) {
    const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
    std::vector<float> encoded(3 * w * h);
    for (std::size_t i = 0; i < w * h; ++i)
        for (std::size_t c = 0; c < 3; ++c)
            encoded[3 * i + c] = srgb_of_linear(std::fmin(std::fmax(rgba[4 * i + c], 0.0f), 1.0f));
    std::vector<std::uint8_t> rough(w * h);
    const auto compare = [&](std::size_t a, std::size_t b) {
        float most = alpha ? std::fabs(rgba[4 * a + 3] - rgba[4 * b + 3]) : 0;
        for (std::size_t c = 0; c < 3; ++c)
            most = std::fmax(most, std::fabs(encoded[3 * a + c] - encoded[3 * b + c]));
        const std::uint8_t found = most > edge_contrast ? 2 : most > rough_contrast ? 1 : 0;
        rough[a] = std::max(rough[a], found), rough[b] = std::max(rough[b], found);
    };
    for (std::size_t y = 0; y < h; ++y)
        for (std::size_t x = 0; x < w; ++x) {
            if (x + 1 < w) compare(y * w + x, y * w + x + 1);
            if (y + 1 < h) compare(y * w + x, y * w + x + w);
        }
    // How many of the pixels above and to the left of a corner of pixels differ sharply.
    std::vector<std::uint32_t> sharp((w + 1) * (h + 1));
    for (std::size_t y = 0; y < h; ++y)
        for (std::size_t x = 0, row = 0; x < w; ++x) {
            row += rough[y * w + x] == 2;
            sharp[(y + 1) * (w + 1) + x + 1] =
                sharp[y * (w + 1) + x + 1] + static_cast<std::uint32_t>(row);
        }
    const std::size_t around = busy_around;
    for (std::size_t y = 0; y < h; ++y)
        for (std::size_t x = 0; x < w; ++x) {
            const std::size_t left = x - std::min(x, around), top = y - std::min(y, around),
                              right = std::min(x + around + 1, w),
                              bottom = std::min(y + around + 1, h);
            const std::uint32_t found =
                sharp[bottom * (w + 1) + right] - sharp[top * (w + 1) + right] -
                sharp[bottom * (w + 1) + left] + sharp[top * (w + 1) + left];
            if (2 * found > (right - left) * (bottom - top)) rough[y * w + x] = 3;
        }
    return rough;
}

namespace {

// A PNG is a signature of 8 bytes, then chunks: the length of its data, its type, the data and a
// checksum of type and data, each number of 4 bytes, the highest first. PNG 1.2, 3.2.
constexpr std::string_view signature = "\x89PNG\r\n\x1a\n";
constexpr std::size_t header_end = 8 + 4 + 4 + 13 + 4; // of IHDR, which comes first
constexpr std::string_view note_keyword("fathom\0", 7);

std::string four_bytes(std::uint32_t number) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8)
        bytes += static_cast<char>(static_cast<unsigned char>(number >> shift));
    return bytes;
}

std::uint32_t number_at(std::string_view bytes, std::size_t at) {
    std::uint32_t number = 0;
    for (std::size_t i = 0; i < 4; ++i)
        number = number << 8 | static_cast<unsigned char>(bytes[at + i]);
    return number;
}

std::uint32_t checksum(std::string_view bytes) {
    return static_cast<std::uint32_t>(
        ::crc32_z(0, reinterpret_cast<const unsigned char *>(bytes.data()), bytes.size()));
}

std::string text_chunk(std::string_view note) {
    const std::string body = "tEXt" + std::string(note_keyword) + std::string(note);
    return four_bytes(static_cast<std::uint32_t>(body.size() - 4)) + body +
           four_bytes(checksum(body));
}

} // namespace

std::optional<std::string> note_of_png(std::string_view bytes) {
    if (!bytes.starts_with(signature)) return std::nullopt;
    std::string note;
    for (std::size_t at = signature.size(); bytes.size() - at >= 12;) {
        const std::uint32_t length = number_at(bytes, at);
        if (length > bytes.size() - at - 12) return std::nullopt;
        const std::string_view body = bytes.substr(at + 4, 4 + std::size_t{length});
        if (number_at(bytes, at + 8 + length) != checksum(body)) return std::nullopt;
        const std::string_view type = body.substr(0, 4), data = body.substr(4);
        if (type == "tEXt" && data.starts_with(note_keyword))
            note = data.substr(note_keyword.size());
        at += 12 + std::size_t{length};
        if (type == "IEND") return at == bytes.size() ? std::optional(note) : std::nullopt;
    }
    return std::nullopt;
}

std::optional<Picture> decode_png(std::string_view bytes) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    if (!png_image_begin_read_from_memory(&image, bytes.data(), bytes.size())) return std::nullopt;
    image.format = PNG_FORMAT_RGBA;
    Picture picture{static_cast<int>(image.width), static_cast<int>(image.height), {}};
    picture.rgba.resize(4 * static_cast<std::size_t>(image.width) * image.height);
    if (!png_image_finish_read(&image, nullptr, picture.rgba.data(), 0, nullptr))
        return std::nullopt;
    return picture;
}

std::string encode_png(int width, int height, std::span<const std::uint8_t> rgba,
                       std::string_view note) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = static_cast<png_uint_32>(width);
    image.height = static_cast<png_uint_32>(height);
    image.format = PNG_FORMAT_RGBA;
    png_alloc_size_t size = 0;
    if (width <= 0 || height <= 0 ||
        !png_image_write_to_memory(&image, nullptr, &size, 0, rgba.data(), 0, nullptr))
        return {};
    std::string bytes(size, '\0');
    if (!png_image_write_to_memory(&image, bytes.data(), &size, 0, rgba.data(), 0, nullptr))
        return {};
    bytes.resize(size);
    if (!note.empty()) bytes.insert(header_end, text_chunk(note));
    return bytes;
}

} // namespace fathom
