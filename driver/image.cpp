#include "driver/image.h"
#include "base/srgb.h"

#include <array>
#include <cmath>
#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <jpeglib.h>
#include <png.h>

namespace fathom::driver {
namespace {

constexpr std::size_t max_pixels = std::size_t{1} << 24;

// The linear value of each byte of sRGB.
const std::array<float, 256> &linear_table() {
    static const std::array<float, 256> table = [] {
        std::array<float, 256> values{};
        for (std::size_t i = 0; i < values.size(); ++i) {
            values[i] = static_cast<float>(linear_of_srgb(static_cast<double>(i) / 255));
        }
        return values;
    }();
    return table;
}

ir::ImageData to_linear(std::size_t width, std::size_t height,
                        const std::vector<std::uint8_t> &bytes, std::size_t channels) {
    ir::ImageData image;
    image.width = static_cast<int>(width);
    image.height = static_cast<int>(height);
    image.rgba.resize(width * height * 4);
    const std::array<float, 256> &table = linear_table();
    for (std::size_t i = 0; i < width * height; ++i) {
        for (std::size_t c = 0; c < 3; ++c) image.rgba[4 * i + c] = table[bytes[channels * i + c]];
        image.rgba[4 * i + 3] =
            channels == 4 ? static_cast<float>(bytes[channels * i + 3]) / 255.0f : 1.0f;
    }
    return image;
}

bool too_large(std::size_t width, std::size_t height) {
    return width == 0 || height == 0 || width > max_pixels || height > max_pixels / width;
}

std::optional<ir::ImageData> decode_png(std::string_view bytes, std::string &error) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    if (!png_image_begin_read_from_memory(&image, bytes.data(), bytes.size())) {
        error = std::string("a broken PNG: ") + image.message;
        return std::nullopt;
    }
    if (too_large(image.width, image.height)) {
        error = "more than 16 million pixels";
        png_image_free(&image);
        return std::nullopt;
    }
    image.format = PNG_FORMAT_RGBA;
    std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(image));
    if (!png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr)) {
        error = std::string("a broken PNG: ") + image.message;
        return std::nullopt;
    }
    return to_linear(image.width, image.height, pixels, 4);
}

// libjpeg ends an error by leaving the call that it was made in; no object with a destructor may be
// on that way.
struct JpegErrors {
    jpeg_error_mgr base;
    std::jmp_buf leave;
    char message[JMSG_LENGTH_MAX];
};

void leave_jpeg(j_common_ptr info) {
    auto *errors = reinterpret_cast<JpegErrors *>(info->err);
    errors->base.format_message(info, errors->message);
    std::longjmp(errors->leave, 1);
}

void no_message(j_common_ptr, int) {}

struct JpegPixels {
    std::size_t width = 0, height = 0;
    std::uint8_t *rgb = nullptr; // malloc
};

bool read_jpeg(std::string_view bytes, JpegPixels *pixels, JpegErrors *errors) {
    jpeg_decompress_struct info;
    info.err = jpeg_std_error(&errors->base);
    errors->base.error_exit = leave_jpeg;
    errors->base.emit_message = no_message;
    errors->message[0] = 0;
    if (setjmp(errors->leave)) {
        jpeg_destroy_decompress(&info);
        return false;
    }
    jpeg_create_decompress(&info);
    jpeg_mem_src(&info, reinterpret_cast<const unsigned char *>(bytes.data()), bytes.size());
    jpeg_read_header(&info, TRUE);
    if (too_large(info.image_width, info.image_height)) {
        std::strcpy(errors->message, "more than 16 million pixels");
        jpeg_destroy_decompress(&info);
        return false;
    }
    info.out_color_space = JCS_RGB;
    jpeg_start_decompress(&info);
    pixels->width = info.output_width;
    pixels->height = info.output_height;
    pixels->rgb = static_cast<std::uint8_t *>(std::malloc(pixels->width * pixels->height * 3));
    while (pixels->rgb && info.output_scanline < info.output_height) {
        JSAMPROW row = pixels->rgb + std::size_t{info.output_scanline} * pixels->width * 3;
        jpeg_read_scanlines(&info, &row, 1);
    }
    jpeg_finish_decompress(&info);
    jpeg_destroy_decompress(&info);
    return pixels->rgb != nullptr;
}

std::optional<ir::ImageData> decode_jpeg(std::string_view bytes, std::string &error) {
    JpegPixels pixels;
    JpegErrors errors;
    bool good = read_jpeg(bytes, &pixels, &errors);
    std::optional<ir::ImageData> image;
    if (good) {
        std::vector<std::uint8_t> rgb(pixels.rgb, pixels.rgb + pixels.width * pixels.height * 3);
        image = to_linear(pixels.width, pixels.height, rgb, 3);
    } else {
        error = std::string("a broken JPEG: ") + errors.message;
    }
    std::free(pixels.rgb);
    return image;
}

struct JpegBytes {
    unsigned char *bytes = nullptr; // malloc
    unsigned long size = 0;
};

// `rgb` has three bytes a pixel.
bool write_jpeg(int width, int height, const std::uint8_t *rgb, int quality, JpegBytes *out,
                JpegErrors *errors) {
    jpeg_compress_struct info;
    info.err = jpeg_std_error(&errors->base);
    errors->base.error_exit = leave_jpeg;
    errors->base.emit_message = no_message;
    errors->message[0] = 0;
    if (setjmp(errors->leave)) {
        jpeg_destroy_compress(&info);
        return false;
    }
    jpeg_create_compress(&info);
    jpeg_mem_dest(&info, &out->bytes, &out->size);
    info.image_width = static_cast<JDIMENSION>(width);
    info.image_height = static_cast<JDIMENSION>(height);
    info.input_components = 3;
    info.in_color_space = JCS_RGB;
    jpeg_set_defaults(&info);
    jpeg_set_quality(&info, quality, TRUE);
    info.comp_info[0].h_samp_factor = info.comp_info[0].v_samp_factor = 1;
    jpeg_start_compress(&info, TRUE);
    while (info.next_scanline < info.image_height) {
        JSAMPROW row = const_cast<JSAMPROW>(rgb + std::size_t{info.next_scanline} * 3 *
                                                      static_cast<std::size_t>(width));
        jpeg_write_scanlines(&info, &row, 1);
    }
    jpeg_finish_compress(&info);
    jpeg_destroy_compress(&info);
    return true;
}

} // namespace

std::string encode_jpeg(int width, int height, std::span<const std::uint8_t> rgba, int quality) {
    std::vector<std::uint8_t> rgb;
    rgb.reserve(rgba.size() / 4 * 3);
    for (std::size_t i = 0; i < rgba.size(); ++i)
        if (i % 4 != 3) rgb.push_back(rgba[i]);
    JpegBytes out;
    JpegErrors errors;
    std::string bytes;
    if (write_jpeg(width, height, rgb.data(), quality, &out, &errors))
        bytes.assign(reinterpret_cast<const char *>(out.bytes), out.size);
    std::free(out.bytes);
    return bytes;
}

std::optional<ir::ImageData> decode_image(std::string_view bytes, std::string &error) {
    if (bytes.starts_with("\x89PNG")) return decode_png(bytes, error);
    if (bytes.starts_with("\xff\xd8")) return decode_jpeg(bytes, error);
    error = "neither a PNG nor a JPEG picture";
    return std::nullopt;
}

} // namespace fathom::driver
