// Images and grids of any bytes: each is decoded within its room, or refused with a word. Sanitizers
// watch our readers and what they call.
#include "driver/image.h"

#include <cstdlib>

using namespace fathom;

template <class Data> static void check(const std::variant<Data, typecheck::LoadError> &answer) {
    if (const auto *error = std::get_if<typecheck::LoadError>(&answer))
        if (error->why.empty()) std::abort();
}

extern "C" int LLVMFuzzerTestOneInput(const unsigned char *data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char *>(data), size);
    constexpr typecheck::Room most{std::size_t{1} << 22, 1 << 18, 1 << 16};
    typecheck::Room room = most;
    const auto image = driver::decode_image(bytes, room);
    check(image);
    if (const auto *made = std::get_if<ir::ImageData>(&image)) {
        const std::size_t pixels =
            static_cast<std::size_t>(made->width) * static_cast<std::size_t>(made->height);
        if (made->rgba.size() != 4 * pixels || pixels > most.pixels) std::abort();
        if (room.bytes + 16 * pixels > most.bytes || room.steps > most.steps) std::abort();
    }
    room = most;
    const auto grid = driver::decode_grid(bytes, room);
    check(grid);
    if (const auto *made = std::get_if<ir::GridData>(&grid)) {
        std::size_t values = 1;
        for (int side : made->size) values *= static_cast<std::size_t>(side);
        if (made->values.size() != values || room.bytes + 4 * values > most.bytes) std::abort();
    }
    return 0;
}
