// Pictures and grids from bytes, with room for any.
#pragma once

#include "driver/image.h"

namespace fathom::test {

template <class Data>
std::optional<Data> taken(std::variant<Data, typecheck::LoadError> answer, std::string &error) {
    if (auto *data = std::get_if<Data>(&answer)) return std::move(*data);
    error = std::get<typecheck::LoadError>(answer).why;
    return std::nullopt;
}

inline std::optional<ir::ImageData> decoded_image(std::string_view bytes, std::string &error) {
    typecheck::Room room;
    return taken(driver::decode_image(bytes, room), error);
}

inline std::optional<ir::GridData> decoded_grid(std::string_view bytes, std::string &error) {
    typecheck::Room room;
    return taken(driver::decode_grid(bytes, room), error);
}

} // namespace fathom::test
