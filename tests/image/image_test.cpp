// Each example's picture by GL and by the CPU, compared. Small, so that a software GL is quick.
//
// Edges apart means: where a pixel of one picture lies beside an edge, float32 may put it on either
// side. So a pixel agrees when each of its channels lies within 2/255 of the range that the other
// picture has in the 3 x 3 pixels around.
#include "backend-cpu/trace/march.h"
#include "backend-glsl/emit.h"
#include "driver/compile.h"
#include "render-gl/context.h"
#include "render-gl/pruning.h"
#include "render-gl/render.h"
#include "render-gl/subroutines.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>

using namespace fathom;
namespace fs = std::filesystem;

namespace {

constexpr int width = 160, height = 120;

int disagreeing(const std::vector<std::uint8_t> &a, const std::vector<std::uint8_t> &b,
                int width = ::width, int height = ::height) {
    int count = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            bool agrees = true;
            for (int c = 0; c < 3; ++c) {
                int lo = 255, hi = 0;
                for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height - 1); ++v)
                    for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width - 1); ++u) {
                        int value = b[static_cast<std::size_t>(4 * (v * width + u) + c)];
                        lo = std::min(lo, value);
                        hi = std::max(hi, value);
                    }
                int value = a[static_cast<std::size_t>(4 * (y * width + x) + c)];
                agrees = agrees && value >= lo - 2 && value <= hi + 2;
            }
            count += !agrees;
        }
    return count;
}

bool all_one_color(const std::vector<std::uint8_t> &rgba) {
    for (std::size_t i = 4; i < rgba.size(); ++i)
        if (rgba[i] != rgba[i % 4]) return false;
    return true;
}

} // namespace

TEST_CASE("GL and the CPU draw the same picture of each example") {
    auto context = gl::Context::make();
    INFO("this test needs EGL and Mesa (./fathom-test installs them)");
    REQUIRE(std::holds_alternative<gl::Context>(context));
    std::vector<fs::path> files;
    for (const fs::directory_entry &entry :
         fs::directory_iterator(fs::path(FATHOM_SOURCE_DIR) / "examples"))
        if (entry.path().extension() == ".sdf") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    CHECK(files.size() >= 10);
    for (const fs::path &file : files) {
        INFO(file.filename().string());
        driver::Compilation compilation = driver::compile_file(file, {});
        if (!compilation.good()) {
            FAIL_CHECK(file.filename().string() << " does not compile");
            continue;
        }
        CHECK(compilation.diagnostics.warnings() == 0);
        gl::Request request;
        request.width = width;
        request.height = height;
        Diagnostics diagnostics;
        std::optional<Picture> by_gl = gl::render(compilation.scene, request, diagnostics);
        CHECK(by_gl);
        if (!by_gl) continue;
        ir::View view = ir::view_of(compilation.scene, 0, static_cast<double>(width) / height);
        cpu::Picture by_cpu =
            cpu::render(cpu::prepare(compilation.scene, view, width, height, 0), {});
        CHECK_FALSE(all_one_color(by_gl->rgba));
        constexpr int allowed = width * height / 1000; // fewer than 0.1 %
        CHECK(disagreeing(by_gl->rgba, by_cpu.rgba) < allowed);
        CHECK(disagreeing(by_cpu.rgba, by_gl->rgba) < allowed);
    }
}

// llvmpipe ends a shader after 65,536 iterations of all its loops: with a loop for each spot, and
// with one whose count nothing divides, the march came to more, and the solid was full of holes.
// Steps run out in places of the spots, by either.
TEST_CASE("long loops leave no holes by GL") {
    auto context = gl::Context::make();
    REQUIRE(std::holds_alternative<gl::Context>(context));
    constexpr int width = 80, height = 60;
    const std::pair<const char *, int> scenes[] = {
        {"sphere(1).displace(p => 0.1 * spot_noise(p, 0.3, 20))\ncamera(at: [0, 0, 4])\n",
         width * height / 50},
        {"implicit(p => {\n"
         "  var d = 9.0\n"
         "  for i in 0..997 {\n"
         "    let y = 1 - (2 * i + 1) / 997\n"
         "    let r = sqrt(1 - y * y)\n"
         "    d = min(d, length(p - [r * cos(2.4 * i), y, r * sin(2.4 * i)]) - 0.07)\n"
         "  }\n"
         "  d + 0.001 * sin(20 * p.x)\n"
         "}, within: ball(1.2))\ncamera(at: [0, 0, 4])\n",
         width * height / 200}};
    for (const auto &[text, allowed] : scenes) {
        CAPTURE(text);
        const driver::Compilation made = driver::compile_text("long.sdf", text, "", {});
        REQUIRE(made.good());
        gl::Request request;
        request.width = width;
        request.height = height;
        Diagnostics diagnostics;
        const std::optional<Picture> by_gl = gl::render(made.scene, request, diagnostics);
        REQUIRE(by_gl);
        const ir::View view = ir::view_of(made.scene, 0, static_cast<double>(width) / height);
        const cpu::Picture by_cpu =
            cpu::render(cpu::prepare(made.scene, view, width, height, 0), {});
        CHECK(disagreeing(by_gl->rgba, by_cpu.rgba, width, height) < allowed);
    }
}

// Rows of a loop over a ground without end: by GL only the ground is asked beyond the rows' cells,
// and what is not asked casts no shadow.
TEST_CASE("rows stand on an endless ground and shade it by GL as by the CPU") {
    auto context = gl::Context::make();
    REQUIRE(std::holds_alternative<gl::Context>(context));
    for (const char *ground :
         {"plane(Y, -1.3)", "plane(Y, -1.3).displace(p => 0.06 * sin(15 * p.x) * sin(15 * p.z))",
          "plane(Y, -1.3).displace_map(image(\"pebbles.png\"), 0.06, scale: 1.4)"}) {
        CAPTURE(ground);
        const driver::Compilation made = driver::compile_text(
            "rows.sdf",
            ground + std::string("\nfor i in 0..300 {\n"
                                 "  let y = 1 - (2 * i + 1) / 300\n"
                                 "  let r = sqrt(1 - y * y)\n"
                                 "  sphere(0.08).translate([r * cos(2.4 * i), y, r * sin(2.4 * "
                                 "i)])\n}\ncamera(at: [2, 1.6, 3], fov: 45deg)\n"),
            FATHOM_SOURCE_DIR "/examples/parts", {});
        REQUIRE(made.good());
        gl::Request request;
        request.width = width;
        request.height = height;
        Diagnostics diagnostics;
        const std::optional<Picture> by_gl = gl::render(made.scene, request, diagnostics);
        REQUIRE(by_gl);
        const ir::View view = ir::view_of(made.scene, 0, static_cast<double>(width) / height);
        const cpu::Picture by_cpu =
            cpu::render(cpu::prepare(made.scene, view, width, height, 0), {});
        CHECK(disagreeing(by_gl->rgba, by_cpu.rgba) < width * height / 400);
    }
}

// As estimates of fractals do. By a bound that is assumed each ray would stay undecided.
TEST_CASE("an estimate that never changes its sign is hit, and looks as the solid does") {
    auto context = gl::Context::make();
    REQUIRE(std::holds_alternative<gl::Context>(context));
    gl::Request request;
    request.width = width;
    request.height = height;
    const auto drawn = [&](const std::string &solid) {
        CAPTURE(solid);
        const driver::Compilation made =
            driver::compile_text("estimate.sdf",
                                 solid + "\nbox(0.5).translate([1.2, 0, 0.6])\nplane(Y, -1)\n"
                                         "camera(at: [2, 1, 4], fov: 40deg)\n",
                                 "", {});
        REQUIRE(made.good());
        Diagnostics diagnostics;
        const std::optional<Picture> by_gl = gl::render(made.scene, request, diagnostics);
        REQUIRE(by_gl);
        CHECK(diagnostics.warnings() == 0); // of undecided rays
        const ir::View view = ir::view_of(made.scene, 0, static_cast<double>(width) / height);
        const cpu::Picture by_cpu =
            cpu::render(cpu::prepare(made.scene, view, width, height, 0), {});
        CHECK(by_cpu.work.undecided == 0);
        CHECK(by_cpu.work.undecided_shadows == 0);
        CHECK(disagreeing(by_gl->rgba, by_cpu.rgba) < width * height / 1000);
        return by_cpu.rgba;
    };
    const auto ball = drawn("sphere(0.8)");
    for (const char *estimate : {"1", "4"}) {
        const auto estimated = drawn("implicit(p => max(length(p) - 0.8, 1e-7), within: ball(0.8), "
                                     "estimate: " +
                                     std::string(estimate) + ")");
        CHECK(disagreeing(estimated, ball) < width * height / 200);
    }
}

// As NVIDIA's compiler gets them. By one field, by two, with safe radii, and beyond cells of rows.
TEST_CASE("fields that are subroutines draw the same picture to the bit") {
    auto context = gl::Context::make();
    REQUIRE(std::holds_alternative<gl::Context>(context));
    const fs::path examples = fs::path(FATHOM_SOURCE_DIR) / "examples";
    const std::pair<const char *, int> scenes[] = {
        {"01_sphere.sdf", 1}, {"well.sdf", 3}, {"11_well.sdf", 2}, {"old_tree.sdf", 2}};
    for (const auto &[name, fields] : scenes) {
        CAPTURE(name);
        driver::CompileOptions with_cells;
        with_cells.cells = driver::cells_of_pictures;
        const driver::Compilation made = driver::compile_file(examples / name, with_cells);
        REQUIRE(made.good());
        Diagnostics diagnostics;
        glsl::Output output = glsl::emit(made.scene,
                                         {.target = glsl::Target::Glsl330,
                                          .buffers = true,
                                          .pruning = gl::can_prune(),
                                          .passes = true},
                                         diagnostics);
        const auto plain = gl::Program::build(output, made.scene);
        output.text = gl::with_subroutines(output.text);
        const auto called = gl::Program::build(output, made.scene);
        REQUIRE(std::holds_alternative<gl::Program>(plain));
        REQUIRE(std::holds_alternative<gl::Program>(called));
        CHECK(gl::subroutines_of(std::get<gl::Program>(plain).name()).empty() ==
              !gl::wants_subroutines());
        CHECK(gl::subroutines_of(std::get<gl::Program>(called).name()).size() ==
              static_cast<std::size_t>(fields));
        gl::Request request;
        request.width = width;
        request.height = height;
        for (const gl::Mode mode : {gl::Mode::Numbers, gl::Mode::Linear}) {
            const auto a = gl::draw(std::get<gl::Program>(plain), made.scene, request, mode),
                       b = gl::draw(std::get<gl::Program>(called), made.scene, request, mode);
            REQUIRE(a);
            REQUIRE(b);
            CHECK(a->rgba == b->rgba);
        }
    }
}

// What is closed in sees less of the sky; a lamp that shines on it shines undimmed, so that
// contacts are not black.
TEST_CASE("occlusion dims the ambient light alone") {
    const auto picture = [](const std::string &lighting) {
        const std::string text =
            "sphere(1).translate(y: 1)\nplane(Y)\nsun([1, 3, 1])\ncamera([0, 2, 6])\nlighting(" +
            lighting + ", shadow_darkness: 0.5, fill: 0)";
        const driver::Compilation made = driver::compile_text("contact.sdf", text, "", {});
        REQUIRE(made.good());
        const ir::View view = ir::view_of(made.scene, 0, static_cast<double>(width) / height);
        return cpu::render(cpu::prepare(made.scene, view, width, height, 0), {}).rgba;
    };
    CHECK(picture("ambient: 0, ambient_occlusion: 1") ==
          picture("ambient: 0, ambient_occlusion: 0"));
    CHECK(picture("ambient: 0.3, ambient_occlusion: 1") !=
          picture("ambient: 0.3, ambient_occlusion: 0"));
}
