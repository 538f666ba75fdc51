#include "driver/image.h"
#include "base/srgb.h"

#include <array>
#include <cmath>
#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <jpeglib.h>
#include <png.h>

namespace fathom::driver {
namespace {

constexpr std::size_t pixels_a_step = 16; // of one scan
constexpr std::size_t kept_a_pixel = 4 * sizeof(float);
constexpr std::size_t needed_a_pixel = kept_a_pixel + 16; // while it is decoded
constexpr std::size_t scan_itself = 4096;                 // pixels that an empty scan is as dear as

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

using Reason = LoadError::Reason;

// Why there is no room for a picture of this size; else takes it.
std::optional<LoadError> take_room(std::size_t width, std::size_t height, Room &room) {
    if (width == 0 || height == 0) return LoadError{Reason::Unreadable, "has no pixels"};
    if (width > room.pixels || height > room.pixels / width)
        return LoadError{Reason::TooManyPixels,
                         fmt::format("{} x {} pixels are too many", width, height)};
    const std::size_t pixels = width * height;
    if (pixels > room.bytes / needed_a_pixel)
        return LoadError{Reason::TooLarge, "takes more memory than is left"};
    if (pixels / pixels_a_step > room.steps)
        return LoadError{Reason::TooMuchWork, "takes more work than is left"};
    room.bytes -= pixels * kept_a_pixel;
    room.steps -= pixels / pixels_a_step;
    return std::nullopt;
}

std::variant<ir::ImageData, LoadError> decode_png(std::string_view bytes, Room &room) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    const auto broken = [&] {
        return LoadError{Reason::Unreadable, std::string("a broken PNG: ") + image.message};
    };
    if (!png_image_begin_read_from_memory(&image, bytes.data(), bytes.size())) return broken();
    if (auto error = take_room(image.width, image.height, room)) {
        png_image_free(&image);
        return *error;
    }
    image.format = PNG_FORMAT_RGBA;
    std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(image));
    if (!png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr)) return broken();
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
    Room *room = nullptr;
    int scans = 1;        // that room was taken for
    bool has_room = true; // else the picture was left for this
    LoadError why;
};

// A progressive picture may have any number of scans, each of which goes over all pixels.
void count_scans(j_common_ptr info) {
    auto *pixels = static_cast<JpegPixels *>(info->client_data);
    const int scan = reinterpret_cast<j_decompress_ptr>(info)->input_scan_number;
    const std::size_t cost = (pixels->width * pixels->height + scan_itself) / pixels_a_step;
    for (; pixels->scans < scan; ++pixels->scans) {
        pixels->has_room = cost <= pixels->room->steps;
        if (!pixels->has_room) leave_jpeg(info);
        pixels->room->steps -= cost;
    }
}

// A call of its own, so that nothing with a destructor is on the way that libjpeg leaves by.
bool jpeg_has_room(JpegPixels *pixels) {
    if (auto error = take_room(pixels->width, pixels->height, *pixels->room)) {
        pixels->has_room = false;
        pixels->why = *error;
    }
    return pixels->has_room;
}

bool read_jpeg(std::string_view bytes, JpegPixels *pixels, JpegErrors *errors) {
    jpeg_decompress_struct info;
    jpeg_progress_mgr progress{};
    progress.progress_monitor = count_scans;
    info.err = jpeg_std_error(&errors->base);
    errors->base.error_exit = leave_jpeg;
    errors->base.emit_message = no_message;
    errors->message[0] = 0;
    if (setjmp(errors->leave)) {
        jpeg_destroy_decompress(&info);
        return false;
    }
    jpeg_create_decompress(&info);
    info.client_data = pixels;
    info.progress = &progress;
    jpeg_mem_src(&info, reinterpret_cast<const unsigned char *>(bytes.data()), bytes.size());
    jpeg_read_header(&info, TRUE);
    pixels->width = info.image_width;
    pixels->height = info.image_height;
    if (!jpeg_has_room(pixels)) {
        jpeg_destroy_decompress(&info);
        return false;
    }
    info.out_color_space = JCS_RGB;
    jpeg_start_decompress(&info);
    pixels->rgb = static_cast<std::uint8_t *>(std::malloc(pixels->width * pixels->height * 3));
    while (pixels->rgb && info.output_scanline < info.output_height) {
        JSAMPROW row = pixels->rgb + std::size_t{info.output_scanline} * pixels->width * 3;
        jpeg_read_scanlines(&info, &row, 1);
    }
    jpeg_finish_decompress(&info);
    jpeg_destroy_decompress(&info);
    return pixels->rgb != nullptr;
}

std::variant<ir::ImageData, LoadError> decode_jpeg(std::string_view bytes, Room &room) {
    JpegPixels pixels;
    pixels.room = &room;
    JpegErrors errors;
    std::variant<ir::ImageData, LoadError> image;
    if (read_jpeg(bytes, &pixels, &errors)) {
        std::vector<std::uint8_t> rgb(pixels.rgb, pixels.rgb + pixels.width * pixels.height * 3);
        image = to_linear(pixels.width, pixels.height, rgb, 3);
    } else if (!pixels.has_room) {
        image = pixels.why.why.empty()
                    ? LoadError{Reason::TooMuchWork, fmt::format("its {} scans and more take more "
                                                                 "work than is left",
                                                                 pixels.scans)}
                    : pixels.why;
    } else {
        image = LoadError{Reason::Unreadable, std::string("a broken JPEG: ") + errors.message};
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

std::variant<ir::ImageData, LoadError> decode_image(std::string_view bytes, Room &room) {
    if (bytes.starts_with("\x89PNG")) return decode_png(bytes, room);
    if (bytes.starts_with("\xff\xd8")) return decode_jpeg(bytes, room);
    return LoadError{Reason::Unreadable, "neither a PNG nor a JPEG picture"};
}

} // namespace fathom::driver
