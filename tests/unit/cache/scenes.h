// Scenes from text, drawn through the noise cache and exactly, for the tests of the cache.
#pragma once

#include "driver/compile.h"
#include "render-gl/cache_passes.h"
#include "tests/support/gl_context.h"

#include <catch2/catch.hpp>
#define GLM_ENABLE_EXPERIMENTAL
#include <glm/gtx/rotate_vector.hpp>

#include <cmath>
#include <string>

namespace fathom {

inline driver::Compilation compiled(const std::string &text) {
    driver::Compilation compilation = driver::compile_text("test.sdf", text, "", {});
    if (!compilation.good()) FAIL(compilation.diagnostics.items().front().message);
    return compilation;
}

// A rocky ball: most of its noise is of wavelengths above a cell.
inline const std::string rock = R"(
let bumps = cached(p => 0.1 * fbm(2 * p, octaves: 5), cell: 0.05)
sphere(1).displace(bumps)
camera(at: [0, 0, 4], look_at: [0, 0, 0])
)";

inline gl::FrameInputs frame_of(const ir::Scene &scene, int side, double turn = 0,
                                gl::Mode mode = gl::Mode::Linear) {
    gl::FrameInputs inputs;
    inputs.view = ir::view_of(scene, 0, 1);
    inputs.sun = ir::lights_of(scene, 0, inputs.view)[0].position;
    for (glm::dvec3 *v :
         {&inputs.view.origin, &inputs.view.right, &inputs.view.up, &inputs.view.forward})
        *v = glm::rotateY(*v, turn);
    inputs.width = inputs.height = side;
    inputs.mode = mode;
    return inputs;
}

// In pictures of a few pixels each is wider than a cell.
constexpr gl::CacheSettings all_cells{.min_pixels = 0, .weigh = false};

inline void use(gl::CachedView &view, const ir::Scene &scene, const gl::CacheSize &size = {}) {
    Diagnostics diagnostics;
    const std::string why = view.use(scene, size, diagnostics);
    if (!why.empty()) FAIL(why);
}

// Frames of the same view until nothing is missed, at most so many. How many it took.
inline int warm(gl::CachedView &view, const gl::FrameInputs &inputs, const ir::Scene &scene,
                int maximum = 60, const gl::CacheSettings &settings = all_cells) {
    for (int frame = 0; frame < maximum; ++frame) {
        if (!view.draw(inputs, scene.params, settings)) FAIL("no memory");
        if (view.read_tally().misses == 0) return frame;
    }
    return maximum;
}

inline gl::Pixels exact(const ir::Scene &scene, int side, gl::Mode mode) {
    Diagnostics diagnostics;
    const glsl::Output output =
        glsl::emit(scene, {.target = glsl::Target::Glsl330, .buffers = true}, diagnostics);
    auto program = gl::Program::build(output, scene);
    if (!std::holds_alternative<gl::Program>(program)) FAIL("no program");
    gl::Request request;
    request.width = request.height = side;
    return *gl::draw(std::get<gl::Program>(program), scene, request, mode);
}

} // namespace fathom
