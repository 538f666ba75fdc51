#include "base/picture.h"
#include "base/srgb.h"

#include <png.h>

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

std::vector<std::uint8_t> rough_pixels(int width, int height, std::span<const float> rgba) {
    const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
    std::vector<float> encoded(3 * w * h);
    for (std::size_t i = 0; i < w * h; ++i)
        for (std::size_t c = 0; c < 3; ++c)
            encoded[3 * i + c] = srgb_of_linear(std::fmin(std::fmax(rgba[4 * i + c], 0.0f), 1.0f));
    std::vector<std::uint8_t> rough(w * h);
    const auto compare = [&](std::size_t a, std::size_t b) {
        for (std::size_t c = 0; c < 3; ++c)
            if (std::fabs(encoded[3 * a + c] - encoded[3 * b + c]) > rough_contrast)
                rough[a] = rough[b] = 1;
    };
    for (std::size_t y = 0; y < h; ++y)
        for (std::size_t x = 0; x < w; ++x) {
            if (x + 1 < w) compare(y * w + x, y * w + x + 1);
            if (y + 1 < h) compare(y * w + x, y * w + x + w);
        }
    return rough;
}

std::string encode_png(const Picture &picture) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = static_cast<png_uint_32>(picture.width);
    image.height = static_cast<png_uint_32>(picture.height);
    image.format = PNG_FORMAT_RGBA;
    png_alloc_size_t size = 0;
    if (picture.width <= 0 || picture.height <= 0 ||
        !png_image_write_to_memory(&image, nullptr, &size, 0, picture.rgba.data(), 0, nullptr))
        return {};
    std::string bytes(size, '\0');
    if (!png_image_write_to_memory(&image, bytes.data(), &size, 0, picture.rgba.data(), 0, nullptr))
        return {};
    bytes.resize(size);
    return bytes;
}

} // namespace fathom
