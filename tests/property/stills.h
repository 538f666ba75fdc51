// Small pictures by the CPU, for tests that compare them.
#pragma once

#include "backend-cpu/trace/march.h"
#include "base/picture.h"
#include "driver/compile.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

namespace fathom::stills {

inline constexpr int width = 96, height = 72;

inline driver::Compilation compiled(const std::string &text) {
    driver::Compilation compilation = driver::compile_text("still.sdf", text, {}, {});
    REQUIRE(compilation.good());
    return compilation;
}

inline cpu::Stage stage_of(const ir::Scene &scene) {
    return cpu::prepare(scene, ir::view_of(scene, 0, static_cast<double>(width) / height), width,
                        height, 0);
}

inline cpu::Picture drawn(const std::string &text, int samples = 1) {
    const driver::Compilation compilation = compiled(text);
    const cpu::Stage stage = stage_of(compilation.scene);
    cpu::PictureOptions options;
    options.samples = samples;
    cpu::Picture picture = cpu::render(stage, options);
    CHECK(picture.work.undecided == 0);
    return picture;
}

inline int byte(const cpu::Picture &picture, int x, int y, int channel) {
    return picture.rgba[static_cast<std::size_t>(4 * (y * picture.width + x) + channel)];
}

// Pixels that differ by more than 2 of 255 in some channel.
inline int different(const cpu::Picture &a, const cpu::Picture &b) {
    int count = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            int most = 0;
            for (int c = 0; c < 3; ++c)
                most = std::max(most, std::abs(byte(a, x, y, c) - byte(b, x, y, c)));
            count += most > 2;
        }
    return count;
}

inline constexpr int few = width * height / 1000; // a thousandth

inline const std::string camera = "camera(at: [3, 4, 9], look_at: [0, 0.3, 0], fov: 40deg)\n";

} // namespace fathom::stills
