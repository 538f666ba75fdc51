// What the viewer draws, without a window: samples, tiles, picks, FXAA, the slice and the check of
// steps, read back from the card and held against what they should be.
#include "render-gl/render.h"
#include "render-gl/timer.h"
#include "tests/viewer/drawn.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <epoxy/gl.h>
#include <filesystem>
#include <set>
#include <thread>

using namespace fathom;
using namespace fathom::viewer_test;

TEST_CASE("four samples on the canvas are the picture that render takes with four") {
    require_context();
    Drawn drawn("(sphere(1) | box(1).translate([1, 0.5, 0])).paint(orange)\n" + camera);
    drawn.draw(120, 80, {drawn.view({0, 0, 120, 80})}, 4);
    drawn.canvas.finish(settings(gl::Look::Picture, true));
    const Picture mine = drawn.canvas.read_picture();
    gl::Request request;
    request.width = 120;
    request.height = 80;
    request.samples = 4;
    Diagnostics diagnostics;
    // A scene that was lowered with its parts is for the canvas alone: render takes the plain one.
    const auto plain = driver::compile_text(
        "scene.sdf", "(sphere(1) | box(1).translate([1, 0.5, 0])).paint(orange)\n" + camera, "",
        {});
    const auto wanted = gl::render(plain.scene, request, diagnostics);
    REQUIRE(wanted);
    int differing = 0;
    for (std::size_t i = 0; i < mine.rgba.size(); ++i)
        differing += std::abs(mine.rgba[i] - wanted->rgba[i]) > 1;
    CHECK(differing == 0);
}

TEST_CASE("a tile holds what the whole canvas would at its size") {
    require_context();
    Drawn drawn("sphere(1).paint(orange)\nbox(1).translate([1.5, 0.5, 0])\n" + camera);
    drawn.draw(60, 40, {drawn.view({0, 0, 60, 40})});
    drawn.canvas.finish(settings(gl::Look::Picture, false));
    const Picture alone = drawn.canvas.read_picture();
    const std::vector<gl::TileView> views{drawn.view({0, 0, 60, 40}), drawn.view({62, 42, 60, 40})};
    drawn.draw(122, 82, views);
    drawn.canvas.finish(settings(gl::Look::Picture, false));
    const Picture both = drawn.canvas.read_picture();
    int differing = 0;
    for (std::size_t y = 0; y < 40; ++y)
        for (std::size_t x = 0; x < 60; ++x)
            for (auto [dx, dy] : {std::pair<std::size_t, std::size_t>{0, 0}, {62, 42}})
                for (std::size_t c = 0; c < 3; ++c)
                    // a byte is rounded by its place on the canvas (base/picture.h, `dither`)
                    differing += std::abs(alone.rgba[(y * 60 + x) * 4 + c] -
                                          both.rgba[((y + dy) * 122 + x + dx) * 4 + c]) > 1;
    CHECK(differing == 0);
}

TEST_CASE(
    "a pixel knows the part it shows: of unions, of what cuts, of blends, under paint, in loops") {
    require_context();
    Drawn drawn(
        "let two = sphere(0.6).translate([-2.5, 0, 0]) | box(1).paint(red).translate([-1, 0, 0])\n"
        "two.paint(blue)\n"
        "box(1.2).translate([1, 0, 0]) - cylinder(radius: 0.3, height: 4).rotate(90deg, axis: "
        "X).translate([1, 0, 0])\n"
        "smooth_union(0.2) { sphere(0.4).translate([2.4, 0, 0]); sphere(0.41).translate([3.1, 0, "
        "0]) }\n" +
        camera);
    drawn.draw(240, 120, {drawn.view({0, 0, 240, 120})});
    const auto x_of = [](double x) {
        return static_cast<int>(120 + x / (8 * std::tan(0.392699)) * 60);
    };
    CHECK(drawn.words_at(x_of(-2.5), 60) == "sphere(0.6).translate([-2.5, 0, 0])");
    CHECK(drawn.words_at(x_of(-1), 60) == "box(1).paint(red).translate([-1, 0, 0])");
    CHECK(drawn.words_at(x_of(0.6), 60) == "box(1.2).translate([1, 0, 0])");
    CHECK(drawn.words_at(x_of(2.3), 60) == "sphere(0.4).translate([2.4, 0, 0])");
    CHECK(drawn.words_at(x_of(3.2), 60) == "sphere(0.41).translate([3.1, 0, 0])");
    CHECK(drawn.words_at(3, 3).empty());
    const gl::Pick middle = drawn.canvas.pick(x_of(-2.5), 60);
    CHECK(middle.t == Approx(std::hypot(8, 2.5) - 0.6).margin(0.05));
    CHECK(middle.slope == Approx(1).margin(0.01));
    CHECK(middle.steps >= 1);
    // The wall of the hole is the cylinder's: seen from the side, through it.
    Drawn hole("box(1.2) - cylinder(radius: 0.3, height: 4)\ncamera(at: [0, 5, 0.6], look_at: [0, "
               "0, 0])\n");
    hole.draw(100, 100, {hole.view({0, 0, 100, 100})});
    std::set<std::string> seen;
    for (int y = 0; y < 100; ++y) seen.insert(hole.words_at(50, y));
    CHECK(seen == std::set<std::string>{"", "box(1.2)", "cylinder(radius: 0.3, height: 4)"});
}

TEST_CASE("a part's box lies where the part stands in the world") {
    driver::CompileOptions options;
    options.parts = true;
    const auto c = driver::compile_text(
        "scene.sdf",
        "(box(2).translate([3, 0, 0]) | sphere(1)).scale(2).rotate(90deg, axis: Z)\n" + camera, "",
        options);
    REQUIRE(c.good());
    int found = 0;
    for (std::size_t i = 0; i < c.parts.shapes.size(); ++i)
        if (viewer::part_of(c, static_cast<int>(i) + 1).words == "box(2).translate([3, 0, 0])") {
            const ir::Box box = viewer::world_box(c.scene, c.parts.shapes[i], 0);
            const std::array<double, 3> lo{-2, 4, -2}, hi{2, 8, 2};
            for (std::size_t k = 0; k < 3; ++k) {
                CHECK(box.lo[k] == Approx(lo[k]).margin(1e-6));
                CHECK(box.hi[k] == Approx(hi[k]).margin(1e-6));
            }
            ++found;
        }
    CHECK(found == 1);
}

TEST_CASE("FXAA brings edges nearer to the picture of many samples, and leaves flat parts alone") {
    require_context();
    Drawn drawn("box(1.6).rotate(8deg, axis: Z).paint(black)\nrender(epsilon: 1e-4)\n" + camera);
    const std::vector<gl::TileView> view{drawn.view({0, 0, 120, 120})};
    drawn.draw(120, 120, view, 16);
    drawn.canvas.finish(settings(gl::Look::Picture, false));
    const Picture truth = drawn.canvas.read_picture();
    drawn.draw(120, 120, view);
    drawn.canvas.finish(settings(gl::Look::Picture, false));
    const Picture rough = drawn.canvas.read_picture();
    drawn.canvas.finish(settings(gl::Look::Picture, true));
    const Picture smooth = drawn.canvas.read_picture();
    double rough_error = 0, smooth_error = 0;
    int touched = 0;
    for (std::size_t i = 0; i < truth.rgba.size(); ++i) {
        rough_error += std::pow(rough.rgba[i] - truth.rgba[i], 2);
        smooth_error += std::pow(smooth.rgba[i] - truth.rgba[i], 2);
        touched += rough.rgba[i] != smooth.rgba[i];
    }
    INFO("squared error without " << rough_error << ", with " << smooth_error);
    CHECK(smooth_error < 0.6 * rough_error);
    CHECK(touched > 100);
    CHECK(touched < static_cast<int>(rough.rgba.size()) / 10);
}

TEST_CASE("the slice is the marched field on its plane") {
    require_context();
    Drawn drawn("sphere(1)\n" + camera);
    drawn.draw(80, 80, {drawn.view({0, 0, 80, 80})});
    REQUIRE(drawn.canvas.probe(*drawn.probe,
                               std::vector{drawn.view({0, 0, 80, 80}, gl::Mode::Slice)}, {}));
    const std::vector<float> values = drawn.canvas.read_probe();
    double worst = 0;
    for (int y = 0; y < 80; ++y)
        for (int x = 0; x < 80; ++x) {
            const float *v = &values[4 * static_cast<std::size_t>(y * 80 + x)];
            const double scale = 8 * std::tan(0.39269908), u = (2 * (x + 0.5) / 80 - 1) * scale,
                         w = (1 - 2 * (y + 0.5) / 80) * scale;
            CHECK(v[3] == 1);
            worst = std::max(worst, std::abs(v[0] - (std::hypot(u, w) - 1)));
        }
    CHECK(worst < 1e-4);
}

TEST_CASE("the check of steps marks nothing where the bound is proved, and what a false promise "
          "makes it miss") {
    require_context();
    const auto verdicts = [](const std::string &text) {
        Drawn drawn(text);
        const gl::Tile all{0, 0, 160, 120};
        drawn.draw(160, 120, {drawn.view(all)});
        REQUIRE(drawn.canvas.probe(*drawn.probe, std::vector{drawn.view(all, gl::Mode::Check)},
                                   drawn.compilation.scene.params));
        std::array<int, 4> counts{};
        const std::vector<float> values = drawn.canvas.read_probe();
        for (std::size_t i = 0; i < values.size(); i += 4)
            ++counts[static_cast<std::size_t>(values[i])];
        return counts;
    };
    const auto honest =
        verdicts("box([1, 3, 1]).twist(90deg, axis: Y) | torus(major: 1.6, minor: 0.2)\n" + camera);
    CHECK(honest[1] == 0);
    CHECK(honest[0] > 160 * 120 * 9 / 10);
    // Its slope is over 9, and it says 1.
    const auto lying = verdicts(
        "implicit(p => 3 * (length(p) - 1) + 0.4 * sin(16 * p.x), estimate: 1)\n" + camera);
    CHECK(lying[1] > 100);
}

TEST_CASE("the card's own clock answers in order") {
    require_context();
    Drawn drawn("sphere(1)\n" + camera);
    gl::Timer timer;
    for (int i = 0; i < 3; ++i) {
        timer.begin();
        drawn.draw(40, 40, {drawn.view({0, 0, 40, 40})});
        timer.end();
    }
    int answers = 0;
    for (int tries = 0; tries < 10'000 && answers < 3; ++tries) {
        while (const auto milliseconds = timer.poll()) {
            ++answers;
            CHECK(*milliseconds >= 0);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    CHECK(answers == 3);
    CHECK_FALSE(timer.poll());
}

TEST_CASE("every example has a shader with parts, and every part a place in a file") {
    int scenes = 0;
    for (const auto &entry : std::filesystem::directory_iterator(FATHOM_SOURCE_DIR "/examples")) {
        if (entry.path().extension() != ".sdf") continue;
        INFO(entry.path().filename().string());
        driver::CompileOptions options;
        options.parts = true;
        const auto compilation = driver::compile_file(entry.path(), options);
        REQUIRE(compilation.good());
        ++scenes;
        Diagnostics diagnostics;
        for (auto instruments : {glsl::Instruments::Pick, glsl::Instruments::Probe}) {
            glsl::Options target;
            target.target = glsl::Target::Glsl330;
            target.buffers = true;
            target.instruments = instruments;
            target.part_stride = compilation.parts.stride;
            CHECK_FALSE(glsl::emit(compilation.scene, target, diagnostics).text.empty());
        }
        CHECK_FALSE(diagnostics.has_errors());
        int nameless = 0;
        for (std::size_t i = 1; i <= compilation.parts.shapes.size(); ++i) {
            const viewer::Part part = viewer::part_of(compilation, static_cast<int>(i));
            nameless += part.words.empty() || part.line == 0;
            CHECK(part.file.ends_with(".sdf"));
            CHECK(std::filesystem::exists(part.file));
        }
        CHECK(nameless == 0);
    }
    CHECK(scenes > 30);
}

TEST_CASE("to know its parts changes no pixel of a scene") {
    require_context();
    for (const char *name : {"still_life", "02_csg", "repetition", "bolts"}) {
        INFO(name);
        const std::filesystem::path file =
            std::string(FATHOM_SOURCE_DIR "/examples/") + name + ".sdf";
        const auto plain = driver::compile_file(file, {});
        REQUIRE(plain.good());
        gl::Request request;
        request.width = 80;
        request.height = 60;
        Diagnostics diagnostics;
        const auto wanted = gl::render(plain.scene, request, diagnostics);
        REQUIRE(wanted);
        Drawn drawn(driver::compile_file(file, Drawn::with_parts()));
        drawn.draw(80, 60, {drawn.view({0, 0, 80, 60})});
        drawn.canvas.finish(settings(gl::Look::Picture, false));
        const Picture mine = drawn.canvas.read_picture();
        int differing = 0;
        for (std::size_t i = 0; i < mine.rgba.size(); ++i)
            differing += std::abs(mine.rgba[i] - wanted->rgba[i]) > 2;
        CHECK(differing <= 80 * 60 * 4 / 500); // rounding at edges
    }
}

// From cached values to exact ones no pixel jumps: each frame of a fade lies between both pictures by
// its share, so two that follow one another differ by that share of their difference.
TEST_CASE("a picture fades into the next by shares") {
    require_context();
    constexpr int side = 48;
    Drawn kept(camera + "sphere(1.6).paint(#ff8040)\n"),
        exact(camera + "sphere(1.7).paint(#4080ff)\n");
    gl::Canvas &canvas = kept.canvas;
    const auto draw = [&](const Drawn &of) {
        REQUIRE(canvas.draw(*of.picture, side, side,
                            {{of.view({0, 0, side, side}, gl::Mode::Linear)}},
                            of.compilation.scene.params, 0));
        canvas.finish(settings(gl::Look::Picture, false));
    };
    unsigned framebuffer = 0, texture = 0;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, side, side);
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    const auto shown = [&](double share) {
        canvas.show(side, side, share, framebuffer);
        std::vector<std::uint8_t> pixels(4 * side * side);
        glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
        glReadPixels(0, 0, side, side, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
        return pixels;
    };
    draw(kept);
    const auto first = shown(0);
    canvas.keep_before();
    draw(exact);
    const auto last = shown(0);
    REQUIRE(first != last);
    constexpr int frames = 15; // of a sixtieth of a second, in a quarter of one
    auto previous = first;
    for (int frame = 0; frame <= frames; ++frame) {
        const double share = 1 - double(frame) / frames;
        const auto now = shown(share);
        int jumps = 0, outside = 0;
        for (std::size_t i = 0; i < now.size(); ++i) {
            if (i % 4 == 3) continue;
            const double wide = std::abs(int(first[i]) - int(last[i]));
            jumps += std::abs(int(now[i]) - int(previous[i])) > wide / frames + 2;
            outside += std::fabs(now[i] - (share * first[i] + (1 - share) * last[i])) > 1.01;
        }
        INFO("share " << share);
        CHECK(jumps == 0);
        CHECK(outside == 0);
        previous = now;
    }
    CHECK(previous == last);
    glDeleteFramebuffers(1, &framebuffer);
    glDeleteTextures(1, &texture);
}
