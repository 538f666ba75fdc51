#include "base/picture.h"
#include "base/srgb.h"

#include <png.h>

#include <cmath>

namespace fathom {

std::uint8_t srgb_byte(float linear) {
    if (!(linear > 0)) return 0;
    if (linear >= 1) return 255;
    return static_cast<std::uint8_t>(srgb_of_linear(linear) * 255 + 0.5f);
}

Picture picture_of_linear(int width, int height, std::span<const float> rgba) {
    Picture picture{width, height, {}};
    picture.rgba.resize(rgba.size());
    for (std::size_t i = 0; i < rgba.size(); ++i)
        picture.rgba[i] = i % 4 == 3 ? 255 : srgb_byte(rgba[i]);
    return picture;
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
