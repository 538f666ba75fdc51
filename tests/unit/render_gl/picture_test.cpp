// Pictures as bytes.
#include "base/picture.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

using namespace fathom;

TEST_CASE("sRGB bytes are monotone, clamped, and those of the standard") {
    CHECK(srgb_byte(-1) == 0);
    CHECK(srgb_byte(0) == 0);
    CHECK(srgb_byte(1) == 255);
    CHECK(srgb_byte(50) == 255);
    CHECK(srgb_byte(std::numeric_limits<float>::quiet_NaN()) == 0);
    CHECK(srgb_byte(0.21586f) == 128); // 128/255 encoded
    CHECK(srgb_byte(0.002f) == 7);     // on the straight part: 12.92 * 0.002 * 255 = 6.6
    int last = 0;
    for (int i = 0; i <= 10000; ++i) {
        const int byte = srgb_byte(static_cast<float>(i) / 10000);
        CHECK(byte >= last);
        last = byte;
    }
}

TEST_CASE("a PNG says its size, and what cannot be one is empty") {
    const Picture picture{3, 2, std::vector<std::uint8_t>(24, 200)};
    const std::string bytes = encode_png(picture);
    REQUIRE(bytes.size() > 24);
    CHECK(bytes.substr(1, 3) == "PNG");
    CHECK(bytes[19] == 3); // IHDR: width, height, big-endian
    CHECK(bytes[23] == 2);
    CHECK(encode_png({0, 5, {}}).empty());
}
