#include "cli/exr.h"

#include <openexr.h>

#include <algorithm>
#include <new>
#include <string_view>
#include <vector>

namespace fathom::cli {
namespace {

constexpr int part = 0; // a file of one picture

// A file in memory: what is written at a place.
std::int64_t write_at(exr_const_context_t, void *file, const void *from, std::uint64_t count,
                      std::uint64_t at, exr_stream_error_func_ptr_t) try {
    std::string &bytes = *static_cast<std::string *>(file);
    bytes.resize(std::max<std::uint64_t>(bytes.size(), at + count));
    std::copy_n(static_cast<const char *>(from), count, bytes.data() + at);
    return static_cast<std::int64_t>(count);
} catch (const std::bad_alloc &) {
    return -1;
}

// Scan lines [y, y + lines): `pixels` from their first one, four floats each.
bool write_lines(exr_context_t file, int y, int width, const float *pixels) {
    exr_chunk_info_t chunk;
    if (exr_write_scanline_chunk_info(file, part, y, &chunk) != EXR_ERR_SUCCESS) return false;
    exr_encode_pipeline_t pipeline;
    if (exr_encoding_initialize(file, part, &chunk, &pipeline) != EXR_ERR_SUCCESS) return false;
    for (int i = 0; i < pipeline.channel_count; ++i) {
        exr_coding_channel_info_t &channel = pipeline.channels[i];
        const auto place = std::string_view("RGBA").find(channel.channel_name[0]);
        channel.encode_from_ptr = reinterpret_cast<const std::uint8_t *>(pixels + place);
        channel.user_data_type = EXR_PIXEL_FLOAT;
        channel.user_bytes_per_element = sizeof(float);
        channel.user_pixel_stride = 4 * sizeof(float);
        channel.user_line_stride = width * 4 * static_cast<int>(sizeof(float));
    }
    const bool good =
        exr_encoding_choose_default_routines(file, part, &pipeline) == EXR_ERR_SUCCESS &&
        exr_encoding_run(file, part, &pipeline) == EXR_ERR_SUCCESS;
    exr_encoding_destroy(file, &pipeline);
    return good;
}

bool write_picture(exr_context_t file, int width, int height, const std::vector<float> &pixels) {
    int number = 0;
    bool good = exr_add_part(file, nullptr, EXR_STORAGE_SCANLINE, &number) == EXR_ERR_SUCCESS &&
                exr_initialize_required_attr_simple(file, part, width, height,
                                                    EXR_COMPRESSION_ZIP) == EXR_ERR_SUCCESS;
    for (const char *channel : {"A", "B", "G", "R"})
        good = good && exr_add_channel(file, part, channel, EXR_PIXEL_HALF,
                                       EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1) == EXR_ERR_SUCCESS;
    int lines = 0; // of a chunk
    good = good && exr_write_header(file) == EXR_ERR_SUCCESS &&
           exr_get_scanlines_per_chunk(file, part, &lines) == EXR_ERR_SUCCESS;
    for (int y = 0; good && y < height; y += lines)
        good = write_lines(file, y, width, pixels.data() + std::size_t(y) * 4 * std::size_t(width));
    return good;
}

} // namespace

std::string encode_exr(int width, int height, std::span<const float> rgba) try {
    std::vector<float> pixels(rgba.begin(), rgba.end());
    constexpr float greatest = 65504;                               // of a half
    for (float &x : pixels) x = std::clamp(x, -greatest, greatest); // keeps a NaN
    std::string bytes;
    exr_context_initializer_t ways = EXR_DEFAULT_CONTEXT_INITIALIZER;
    ways.user_data = &bytes;
    ways.write_fn = write_at;
    ways.error_handler_fn = [](exr_const_context_t, exr_result_t, const char *) {};
    exr_context_t file;
    if (exr_start_write(&file, "picture.exr", EXR_WRITE_FILE_DIRECTLY, &ways) != EXR_ERR_SUCCESS)
        return "";
    const bool good = write_picture(file, width, height, pixels);
    // its end writes where the lines lie
    return exr_finish(&file) == EXR_ERR_SUCCESS && good ? bytes : "";
} catch (const std::bad_alloc &) {
    return "";
}

} // namespace fathom::cli
