// Pictures by passes: the same as in one draw, in however many views, to the bit; and rays that are
// not decided are counted, told and not sky.
#include "backend-cpu/trace/march.h"
#include "render-gl/render.h"
#include "tests/viewer/drawn.h"

#include <catch2/catch.hpp>

using namespace fathom;
using namespace fathom::viewer_test;

namespace {

// A steep field, a lamp behind it and a ground: rays from the eye and from the light need many
// steps.
const std::string steep = "sphere(1).displace(p => 0.2 * sin(9 * p.x) * sin(9 * p.y) * sin(9 * "
                          "p.z)).paint(orange)\nbox([0.4, 2, 0.4]).translate([1.6, 0, 0])\n"
                          "plane(Y, -1.3)\nsun([2, 3, 1])\nlight([-3, 4, 2], color: #ffddaa)\n"
                          "lighting(soft_shadows: 0.1)\n" +
                          camera;

std::vector<float> picks_of(Drawn &drawn, int width, int height,
                            const std::vector<gl::TileView> &views, int turns, int samples) {
    drawn.canvas.set_turns(turns);
    drawn.draw(width, height, views, samples);
    return drawn.canvas.read_picks();
}

Picture shown(Drawn &drawn) {
    drawn.canvas.finish(settings(gl::Look::Picture, false));
    return drawn.canvas.read_picture();
}

gl::Pixels rendered(const ir::Scene &scene, int turns, int samples) {
    Diagnostics diagnostics;
    const auto built = gl::Program::build(
        glsl::emit(scene, {.target = glsl::Target::Glsl330, .buffers = true, .passes = true},
                   diagnostics),
        scene);
    REQUIRE(std::holds_alternative<gl::Program>(built));
    gl::Request request;
    request.width = 64;
    request.height = 48;
    request.samples = samples;
    request.turns = turns;
    auto pixels = gl::draw(std::get<gl::Program>(built), scene, request, gl::Mode::Linear);
    REQUIRE(pixels);
    return *pixels;
}

} // namespace

TEST_CASE("passes of a picture equal one long draw to the bit") {
    require_context();
    for (const std::string &text :
         {steep, "sphere(1)\nplane(Y, -1)\n" + camera,
          "cylinder(radius: 0.4, height: 3).bend(0.4)\nlighting(skip: true)\n" + camera,
          "(box(2) - box(2).translate(x: 1)).rotate(0.3)\n" + camera}) {
        CAPTURE(text);
        const auto made = driver::compile_text("scene.sdf", text, "", {});
        REQUIRE(made.good());
        for (int samples : {1, 3}) {
            const gl::Pixels whole = rendered(made.scene, 1 << 20, samples);
            for (int turns : {7, 30}) {
                CAPTURE(turns, samples);
                const gl::Pixels passes = rendered(made.scene, turns, samples);
                CHECK(passes.rgba == whole.rgba);
                CHECK(passes.undecided == whole.undecided);
                CHECK(passes.undecided_shadows == whole.undecided_shadows);
                CHECK(passes.passed == whole.passed);
            }
        }
    }
}

TEST_CASE("where a picture is rough its pixels have two, four or eight samples, and no others") {
    require_context();
    const auto made = driver::compile_text("scene.sdf", steep, "", {});
    REQUIRE(made.good());
    const gl::Pixels once = rendered(made.scene, 0, 1), twice = rendered(made.scene, 0, 2),
                     four = rendered(made.scene, 0, 4), eight = rendered(made.scene, 0, 8);
    for (int turns : {0, 7}) {
        CAPTURE(turns);
        const gl::Pixels smooth = rendered(made.scene, turns, 0);
        std::uint64_t samples = 0;
        int others = 0;
        for (std::size_t i = 0; i < smooth.rgba.size(); i += 4) {
            const auto is = [&](const gl::Pixels &of) {
                for (std::size_t c = i; c < i + 3; ++c)
                    if (std::abs(smooth.rgba[c] - of.rgba[c]) > 1e-4f) return false;
                return true;
            };
            samples += is(once) ? 1 : is(twice) ? 2 : is(four) ? 4 : 8;
            others += !is(once) && !is(twice) && !is(four) && !is(eight);
        }
        CHECK(others <= 2); // places are rounded otherwise, and an edge runs there
        const std::size_t pixels = smooth.rgba.size() / 4;
        CHECK(samples > pixels * 11 / 10);
        CHECK(smooth.rays < 2 * pixels);
        CHECK(smooth.rays >= samples); // more than one of a pixel may see the same
    }
}

TEST_CASE("rays that go through what has no inside are counted, and grazes are not") {
    require_context();
    for (const auto &[text, sheet] :
         {std::pair("box(2) - box(2).translate(x: 1)\n" + camera, true),
          std::pair("implicit(p => abs(length(p) - 1))\n" + camera, true),
          std::pair("box(2) | sphere(1.3) | torus(2, 0.2)\n" + camera, false)}) {
        CAPTURE(text);
        const auto made = driver::compile_text("scene.sdf", text, "", {});
        REQUIRE(made.good());
        const ir::View view = ir::view_of(made.scene, 0, 64.0 / 48);
        const auto by_cpu = cpu::render(cpu::prepare(made.scene, view, 64, 48, 0), {});
        const gl::Pixels by_gl = rendered(made.scene, 0, 1);
        CHECK((by_cpu.work.passed > 20) == sheet);
        CHECK((sheet || by_cpu.work.passed <= 3));
        CHECK(std::abs(static_cast<double>(by_gl.passed) -
                       static_cast<double>(by_cpu.work.passed)) <= 3);
    }
}

TEST_CASE("four views by passes are what they are in one draw, and end") {
    require_context();
    Drawn drawn(steep);
    std::vector<gl::TileView> views;
    for (int i = 0; i < 4; ++i) {
        views.push_back(drawn.view({32 * (i % 2), 24 * (i / 2), 30, 22}));
        views.back().inputs.view.origin.x += 0.3 * i; // each has rays of its own to take up
    }
    const std::vector<float> whole = picks_of(drawn, 62, 46, views, 1 << 20, 2);
    const Picture picture = shown(drawn);
    CHECK(picks_of(drawn, 62, 46, views, 9, 2) == whole);
    CHECK(shown(drawn).rgba == picture.rgba);
}

TEST_CASE("a picture whose passes are interrupted goes on where it was") {
    require_context();
    Drawn drawn(steep);
    const std::vector<gl::TileView> views{drawn.view({0, 0, 40, 30})};
    const std::vector<float> whole = picks_of(drawn, 40, 30, views, 1 << 20, 1);
    drawn.canvas.set_turns(9);
    int calls = 0;
    for (int row = 0; row < 30; row += 15) do {
            REQUIRE(drawn.canvas.draw(*drawn.picture, 40, 30, views, drawn.compilation.scene.params,
                                      0, row, 15, [] { return false; }));
            REQUIRE(++calls < 1000);
        } while (!drawn.canvas.decided());
    CHECK(calls > 4);
    CHECK(drawn.canvas.read_picks() == whole);
}

TEST_CASE("an undecided ray is counted, told, and shows what it is nearest to") {
    require_context();
    const std::string text =
        "sphere(1).displace(p => 0.3 * sin(9 * p.x) * sin(9 * p.y) * sin(9 * p.z)).paint(red)\n"
        "background([0, 0, 1])\nlighting(skip: true)\nrender(max_steps: 12)\n" +
        camera;
    Drawn drawn(text);
    const std::vector<gl::TileView> views{drawn.view({0, 0, 60, 60})};
    const std::vector<float> picks = picks_of(drawn, 60, 60, views, 5, 1);
    const Picture picture = shown(drawn);
    std::uint64_t undecided = 0, sky = 0;
    for (std::size_t i = 0; i < picks.size(); i += 4) {
        if (!(picks[i + 3] < 0)) continue;
        ++undecided;
        sky += picture.rgba[i + 2] > picture.rgba[i];
        CHECK(picks[i + 1] >= 0);
        CHECK(picks[i + 2] == 12);
    }
    CHECK(undecided > 100);
    CHECK(sky == 0);
    CHECK(drawn.canvas.undecided().rays == undecided);

    const auto plain = driver::compile_text("scene.sdf", text, "", {});
    const ir::View view = ir::view_of(plain.scene, 0, 64.0 / 48);
    const auto by_cpu = cpu::render(cpu::prepare(plain.scene, view, 64, 48, 0), {});
    const gl::Pixels by_gl = rendered(plain.scene, 0, 1);
    CHECK(std::abs(static_cast<double>(by_gl.undecided) -
                   static_cast<double>(by_cpu.work.undecided)) <
          0.02 * static_cast<double>(by_cpu.work.undecided) + 3);

    drawn.canvas.finish(settings(gl::Look::Heat, false)); // and magenta where steps are looked at
    const Picture heat = drawn.canvas.read_picture();
    std::uint64_t magenta = 0;
    for (std::size_t i = 0; i < heat.rgba.size(); i += 4)
        magenta += heat.rgba[i] == 255 && heat.rgba[i + 1] == 0 && heat.rgba[i + 2] == 255;
    CHECK(magenta == undecided);
}
