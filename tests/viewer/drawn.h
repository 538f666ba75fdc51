// A scene drawn on the canvas, without a window, with its parts known.
#pragma once

#include "base/picture.h"
#include "render-gl/canvas.h"
#include "tests/support/gl_context.h"
#include "viewer/pick.h"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

namespace fathom::viewer_test {

struct Drawn {
    driver::Compilation compilation;
    std::optional<gl::Program> picture, probe;
    gl::Canvas canvas;

    explicit Drawn(const std::string &text)
        : Drawn(driver::compile_text("scene.sdf", text, "", with_parts())) {}
    explicit Drawn(driver::Compilation made) : compilation(std::move(made)) { link(); }
    static driver::CompileOptions with_parts() {
        driver::CompileOptions options;
        options.parts = true;
        return options;
    }
    void link() {
        REQUIRE(compilation.good());
        Diagnostics diagnostics;
        for (auto instruments : {glsl::Instruments::Pick, glsl::Instruments::Probe}) {
            glsl::Options target;
            target.target = glsl::Target::Glsl330;
            target.buffers = true;
            target.passes = true;
            target.instruments = instruments;
            target.part_stride = compilation.parts.stride;
            auto built = gl::Program::build(glsl::emit(compilation.scene, target, diagnostics),
                                            compilation.scene);
            REQUIRE(std::holds_alternative<gl::Program>(built));
            (instruments == glsl::Instruments::Pick ? picture : probe) =
                std::move(std::get<gl::Program>(built));
        }
    }
    gl::TileView view(gl::Tile tile, gl::Mode mode = gl::Mode::Slice) const {
        gl::TileView view{tile, {}};
        const ir::Scene &s = compilation.scene;
        view.inputs.view = ir::view_of(s, 0, static_cast<double>(tile.width) / tile.height);
        view.inputs.sun = ir::lights_of(s, 0, view.inputs.view)[0].position;
        view.inputs.mode = mode;
        return view;
    }
    void draw(int width, int height, const std::vector<gl::TileView> &views, int samples = 1) {
        for (int i = 0; i < samples; ++i)
            REQUIRE(canvas.draw(*picture, width, height, views, compilation.scene.params, i));
    }
    std::string words_at(int x, int y) const {
        return viewer::part_of(compilation, canvas.pick(x, y).part).words;
    }
};

inline const std::string camera = "camera(at: [0, 0, 8], look_at: [0, 0, 0])\n";

inline gl::PostSettings settings(gl::Look look, bool fxaa) {
    gl::PostSettings result;
    result.look = look;
    result.fxaa = fxaa;
    return result;
}

} // namespace fathom::viewer_test
