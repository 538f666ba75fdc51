// Every example, as it is marched: the safe ball (the field keeps its sign within |d(p)| of p) on
// many random balls, on the CPU and in the shader, and no holes: rays marched by proved steps land
// where a plain march at a tenth of the step lands.
#include "backend-cpu/trace/march.h"
#include "driver/compile.h"
#include "tests/support/effort.h"
#include "tests/support/shader_balls.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdio>
#include <filesystem>

using namespace fathom;
namespace fs = std::filesystem;

namespace {

std::vector<fs::path> examples() {
    std::vector<fs::path> files;
    for (const fs::directory_entry &entry :
         fs::directory_iterator(fs::path(FATHOM_SOURCE_DIR) / "examples"))
        if (entry.path().extension() == ".sdf") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

// Half as much again as the finite parts' box on every side, where rays come and go.
void around(const ir::Scene &scene, test::Point3 &lo, test::Point3 &hi) {
    for (std::size_t i = 0; i < 3; ++i) {
        double a = scene.bounds.empty() ? -4 : scene.bounds.lo[i];
        double b = scene.bounds.empty() ? 4 : scene.bounds.hi[i];
        lo[i] = a - 0.5 * (b - a), hi[i] = b + 0.5 * (b - a);
    }
}

} // namespace

TEST_CASE("the field keeps its sign within the distance it gives") {
    const int balls = test::effort(150'000);
    for (const fs::path &file : examples()) {
        driver::Compilation c = driver::compile_file(file, {});
        INFO(file.filename().string());
        REQUIRE(c.good());
        test::Point3 lo, hi;
        around(c.scene, lo, hi);
        test::Slopes s = test::measure(c.scene, lo, hi, balls, balls / 10);
        std::printf("%-24s %d balls, steepest marched slope %.3f\n",
                    file.filename().string().c_str(), s.balls, s.steepest);
        INFO("at [" << s.unsafe_center[0] << ", " << s.unsafe_center[1] << ", "
                    << s.unsafe_center[2] << "] the step is " << s.unsafe_by
                    << " times the way to [" << s.unsafe_point[0] << ", " << s.unsafe_point[1]
                    << ", " << s.unsafe_point[2] << "]");
        CHECK(s.balls >= balls);
        CHECK(s.unsafe == 0);
    }
}

TEST_CASE("so it does in the shader") {
    require_context();
    for (const fs::path &file : examples()) {
        driver::Compilation c = driver::compile_file(file, {});
        INFO(file.filename().string());
        REQUIRE(c.good());
        test::Point3 lo, hi;
        around(c.scene, lo, hi);
        const test::ShaderBalls s = test::shader_balls(c.scene, lo, hi, test::effort(1 << 18));
        INFO(s.worst);
        CHECK(s.unsafe == 0);
    }
}

// Grazing: where the plain march misses, or hits, by less than a pixel's width, either answer is
// right; such a ray has a neighbour, half a pixel away, on which both agree with the other answer.
// So a hole is a pixel for which none of the rays around it lands as the proved march says.
TEST_CASE("no ray passes a surface") {
    constexpr int width = 48, height = 36;
    for (const fs::path &file : examples()) {
        driver::Compilation c = driver::compile_file(file, {});
        INFO(file.filename().string());
        REQUIRE(c.good());
        ir::View view = ir::view_of(c.scene, 0, double(width) / height);
        cpu::Stage stage = cpu::prepare(c.scene, view, width, height, 0);
        std::vector<cpu::Ray> rays;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                rays.push_back(cpu::eye_ray(stage, float(x) + 0.5f, float(y) + 0.5f));
        std::vector<cpu::Landing> fast = cpu::cast(stage, rays),
                                  slow = cpu::cast(stage, rays, true);
        int holes = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            if ((fast[i].t >= 0) == (slow[i].t >= 0)) continue;
            int x = int(i) % width, y = int(i) / width;
            std::vector<cpu::Ray> near;
            for (int k = 0; k < 16; ++k) {
                float a = float(k) * 0.3927f;
                near.push_back(cpu::eye_ray(stage, float(x) + 0.5f + 0.5f * std::cos(a),
                                            float(y) + 0.5f + 0.5f * std::sin(a)));
            }
            bool grazing = false;
            for (const cpu::Landing &l : cpu::cast(stage, near, true))
                grazing = grazing || (l.t >= 0) == (fast[i].t >= 0);
            holes += !grazing;
        }
        CHECK(holes == 0);
    }
}
