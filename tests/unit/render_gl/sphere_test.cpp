// Pictures of scenes whose look is known by calculation.
#include "tests/unit/glsl/scenes.h"

#include "tests/unit/render_gl/context.h"
#include "render-gl/render.h"

#include <catch2/catch.hpp>



using namespace fathom;

namespace {

gl::Program built(const ir::Scene &scene, bool buffers = true) {
    Diagnostics diagnostics;
    const glsl::Output output = glsl::emit(scene, {.target = glsl::Target::Glsl330, .buffers = buffers}, diagnostics);
    REQUIRE_FALSE(diagnostics.has_errors());
    auto result = gl::Program::build(output, scene);
    if (const auto *error = std::get_if<gl::ProgramError>(&result)) FAIL(error->message);
    return std::get<gl::Program>(std::move(result));
}

} // namespace

TEST_CASE("a sphere's silhouette stands where geometry puts it") {
    if (!has_context()) return;
    const ir::Scene scene = scenes::sphere();
    const gl::Request request{.width = 160, .height = 120};
    const auto pixels = gl::draw(built(scene), scene, request, gl::Mode::Numbers);
    REQUIRE(pixels);
    const ir::View view = ir::view_of(scene, 0, 160.0 / 120);
    const double distance = std::hypot(view.origin[0], view.origin[1], view.origin[2]);
    const double edge = 1 / std::sqrt(distance * distance - 1) / view.extent; // in half heights
    int wrong = 0;
    for (int y = 0; y < 120; ++y)
        for (int x = 0; x < 160; ++x) {
            const double u = (2 * (x + 0.5) / 160 - 1) * 160 / 120, v = 1 - 2 * (y + 0.5) / 120;
            const double r = std::hypot(u, v);
            const bool hit = pixels->rgba[static_cast<std::size_t>((y * 160 + x) * 4 + 3)] > 0.5f;
            if (std::abs(r - edge) > 0.002 && hit != (r < edge)) ++wrong;
        }
    CHECK(wrong == 0);
}
