// Slopes of what jumps or bends: whole parts, rests, angles and powers lie on the planes that are said.
#include "driver/compile.h"
#include "mesh/mend.h"
#include "mesh/slopes.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <random>
#include <string>

using namespace fathom;

namespace {

ir::Scene stepped_scene(const std::string &text) {
    driver::Compilation c = driver::compile_text("mesh.sdf", text, "", {});
    REQUIRE(c.good());
    return std::move(c.scene);
}

std::string implicit_field(const std::string &formula) {
    return "implicit(p => " + formula + ", within: aabb([-2, -2, -2], [2, 2, 2]))";
}

} // namespace

TEST_CASE("fields made of what jumps have the slopes that are said of them, wherever that is") {
    constexpr int boxes_of_each = 400, points_of_each = 16;
    std::mt19937 dice(11);
    const auto random = [&](double lo, double hi) {
        return std::uniform_real_distribution<double>(lo, hi)(dice);
    };
    for (const char *formula :
         {"abs(p.x % 0.5 - 0.25) - 0.1",
          "max(abs((p.x * 3) % 2 - 1), abs((p.y * 3) % 2 - 1)) / 3 - 0.2",
          "abs((p.x + 0.3 * p.y) % 0.7 - 0.35) - 0.1", "abs(fract(p.z) - 0.5) - 0.2",
          "abs(p.x - round(p.x)) - 0.2", "abs(p.y - 0.4 * round(p.y / 0.4)) - 0.1",
          "0.25 * abs(p.x) * sign(p.x) * sign(p.x) - 0.2",
          "0.2 * cos(3 * atan(p.y, p.x)) * min(1, length(p.xy)) - 0.05",
          "0.1 * abs(atan(p.z, p.x)) * min(1, length(p.xz)) - 0.1",
          "0.1 * atan(p.z, 2.5 + p.x) - 0.1", "0.1 * atan(p.x, p.z + 3) - 0.1",
          "0.05 * (p.x ^ 2 + p.y ^ 3 + p.z ^ 4) - 0.1",
          "0.3 * mix(p.x, p.y, clamp(p.z, 0, 1)) - 0.1", "0.3 * smoothstep(-0.5, 1, p.x) - 0.1",
          "p.x - (if p.y % 1 < 0.5 { 0.1 } else { 0.1 })",
          "0.4 * abs(p.x - floor(p.x) - 0.5) + 0.4 * abs(ceil(p.y) - p.y - 0.5) - 0.3"}) {
        INFO(formula);
        const ir::Scene scene = stepped_scene(implicit_field(formula));
        const mesh::Field field(scene, 0, {});
        mesh::Evaluator evaluator(field);
        cpu::Boxes boxes;
        std::size_t known = 0;
        for (int n = 0; n < boxes_of_each; ++n) {
            mesh::Point lo{}, hi{};
            const double size = std::pow(10.0, random(-4, -0.3));
            for (std::size_t i = 0; i < 3; ++i) {
                // One in two about a place where something may jump.
                const double at = n % 2 ? random(-1.8, 1.8) : 0.25 * std::round(random(-6, 6));
                lo[i] = static_cast<float>(at - size * random(0, 1));
                hi[i] = static_cast<float>(lo[i] + size);
            }
            const std::array<double, 3> along{0.6, 0, 0.8};
            const auto rising = mesh::rising_over(evaluator, *field.whole, boxes, lo, hi, along);
            if (!rising) continue;
            ++known;
            const mesh::Linear &linear = rising->linear;
            mesh::Points points;
            for (int k = 0; k < points_of_each; ++k) {
                mesh::Point p{};
                for (std::size_t i = 0; i < 3; ++i)
                    p[i] = static_cast<float>(lo[i] + random(0, 1) * (double(hi[i]) - lo[i]));
                points.add(p);
            }
            std::vector<float> values;
            mesh::values_at(evaluator, *field.whole, points, values);
            const mesh::Point middle = mesh::middle_point(lo, hi);
            for (std::size_t k = 0; k < points.size(); ++k) {
                double plane = linear.value;
                for (std::size_t i = 0; i < 3; ++i)
                    plane += linear.slope[i] * (double(points[k][i]) - middle[i]);
                CHECK(std::fabs(plane - values[k]) <= linear.off);
                // Of two points, the field changes by the slopes.
                double least = 0, most = 0;
                for (std::size_t i = 0; i < 3; ++i) {
                    const double way = double(points[k][i]) - points[0][i];
                    least += linear.slope[i] * way - linear.spread[i] * std::fabs(way);
                    most += linear.slope[i] * way + linear.spread[i] * std::fabs(way);
                }
                const double slack = 2 * linear.rounding + 1e-6;
                CHECK(values[k] - values[0] >= least - slack);
                CHECK(values[k] - values[0] <= most + slack);
            }
        }
        CHECK(known > boxes_of_each / 4);
    }
}

TEST_CASE("pieces and handles of what is repeated are proved, as floors and angles have slopes") {
    struct Repeated {
        const char *text;
        std::size_t pieces;
        long genus;
    };
    for (const auto &[text, pieces, genus] :
         {Repeated{"box(0.3).translate(x: 1).repeat_polar(7)", 7, 0},
          Repeated{"sphere(0.3).repeat(1, count: 3)", 27, 0},
          Repeated{"torus(0.3, 0.1).repeat(1, count: 2)", 8, 8}}) {
        INFO(text);
        mesh::Settings settings;
        settings.resolution = 50;
        const mesh::Mended mended = make_certified_mesh(stepped_scene(text), settings);
        CHECK(mended.certificate.certified());
        CHECK(mended.certificate.shape.proved);
        CHECK(mended.certificate.components == pieces);
        CHECK(mended.certificate.genus == genus);
    }
}

TEST_CASE("copies that all but touch are never proved to be in the wrong number of pieces") {
    std::size_t proved = 0;
    for (const double gap : {-0.04, -0.02, -0.003, 0.003, 0.02, 0.04})
        for (const int resolution : {12, 17, 24}) {
            const bool turned = resolution == 17;
            const std::string text =
                turned ? "sphere(" + std::to_string(0.5 - gap / 2) +
                             ").translate(x: 0.5 / sin(turn / 10)).repeat_polar(5)"
                       : "sphere(" + std::to_string(0.5 - gap / 2) +
                             ").repeat([1, 1, 0], count: [2, 2, 1])";
            INFO(text);
            mesh::Settings settings;
            settings.resolution = resolution;
            const mesh::Mended mended = make_certified_mesh(stepped_scene(text), settings);
            const std::size_t copies = turned ? 5 : 4;
            if (!mended.certificate.shape.proved) continue;
            ++proved;
            CHECK(mended.certificate.components == (gap > 0 ? copies : 1));
            CHECK(mended.certificate.genus == (gap > 0 ? 0 : 1));
        }
    CHECK(proved >= 8);
}
