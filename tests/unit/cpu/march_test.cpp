// Pictures of scenes whose look is known by geometry; the march against a brute one; counted work.
#include "scenes.h"

#include "backend-cpu/trace/march.h"

#include <catch2/catch.hpp>

#include <cmath>

using namespace fathom::cpu;
using namespace fathom::cpu::test;

namespace {

// A red unit ball on nothing, lit from the camera's side, with a box about it.
struct OneBall : Fields {
    OneBall() {
        NodeId d = make_distance();
        scene.distance = scene.shaded = function(d);
        NodeId q = g.fresh_var(Type::Vec3);
        NodeId there = g.call(scene.distance, std::span(&q, 1));
        NodeId zero4 = g.make(Op::Splat, Type::Vec4, {g.number(0)});
        scene.hit = function({q}, g.make(Op::MakeHit, Type::Hit, {there, g.integer(-1), q, zero4}));
        Surface s;
        s.point = g.fresh_var(Type::Vec3);
        s.normal = g.fresh_var(Type::Vec3);
        s.extra = g.fresh_var(Type::Vec4);
        s.diffuse = g.vec3(0.8, 0.1, 0.1);
        s.specular = g.vec3(1, 1, 1);
        s.exponent = g.number(20);
        s.emission = g.vec3(0, 0, 0);
        scene.surfaces.push_back(s);
        scene.lighting.ambient = g.vec3(0.1, 0.1, 0.1);
        scene.lighting.ambient_occlusion = g.number(1);
        scene.lighting.shadow_darkness = g.number(1);
        scene.lighting.soft_shadows = g.number(0.02);
        scene.lighting.specular_intensity = g.number(0);
        scene.bounds = scene.extent = {{-1, -1, -1}, {1, 1, 1}};
    }
    NodeId make_distance() { return ball(0, 0, 0, 1); }
    View view() { return look_at({0, 0, 4}, {0, 0, 0}, 0.5, false); }
};

int red(const Picture &picture, int x, int y) {
    return picture.rgba[4 * static_cast<std::size_t>(y * picture.width + x)];
}

} // namespace

TEST_CASE("a ball is seen where it stands, and the background where it does not") {
    OneBall scene;
    Stage stage = prepare(scene.scene, scene.view(), 64, 48, 0);
    Picture picture = render(stage, {});
    REQUIRE(picture.complete);
    CHECK(picture.work.rays == 64 * 48);
    // The ball fills tan(asin(1/4)) / 0.5 of the picture's height.
    double radius = std::tan(std::asin(0.25)) / 0.5 * 24;
    int seen = 0, wrong = 0;
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 64; ++x) {
            double r = std::hypot(x + 0.5 - 32, y + 0.5 - 24);
            bool ball =
                picture.rgba[4 * static_cast<std::size_t>(y * 64 + x) + 2] < 120; // the sky is blue
            seen += ball;
            if (std::abs(r - radius) > 1) wrong += ball != (r < radius);
        }
    CHECK(wrong == 0);
    CHECK(seen == Approx(3.14159 * radius * radius).epsilon(0.05));
    CHECK(picture.work.hits == Approx(seen).epsilon(0.02));
    CHECK(red(picture, 26, 18) > red(picture, 38, 30)); // the default sun stands to the upper left
}

TEST_CASE("rays land on the surface") {
    OneBall scene;
    Stage stage = prepare(scene.scene, scene.view(), 64, 64, 0);
    std::vector<Ray> rays;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
            rays.push_back(eye_ray(stage, float(x) + 0.5f, float(y) + 0.5f));
    for (bool brute : {false, true}) {
        std::vector<Landing> landings = cast(stage, rays, brute);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const auto &[o, d] = rays[i];
            double b = double(o[0]) * d[0] + double(o[1]) * d[1] + double(o[2]) * d[2], c = 16 - 1;
            double root = b * b - c;
            if (std::abs(root) < 1e-2) continue;              // grazing
            double margin = 4e-3 / std::sqrt(std::abs(root)); // a tolerance, seen at a slant
            if (root < 0)
                REQUIRE(landings[i].t < 0);
            else
                REQUIRE(landings[i].t == Approx(-b - std::sqrt(root)).margin(margin));
        }
    }
}

TEST_CASE("the picture does not depend on how many threads draw it, and can be cancelled") {
    OneBall scene;
    Stage stage = prepare(scene.scene, scene.view(), 100, 70, 0);
    PictureOptions one, three;
    one.jobs = 1;
    three.jobs = 3;
    double last = 0;
    int tiles = 0;
    Picture a = render(stage, one, [&](double done, const Tile &, const Picture &) {
        CHECK(done > last);
        last = done;
        ++tiles;
        return true;
    });
    CHECK(tiles == 12);
    CHECK(last == 1);
    Picture b = render(stage, three);
    CHECK(a.rgba == b.rgba);
    CHECK(a.work.evaluations == b.work.evaluations);
    Picture c = render(stage, one, [](double, const Tile &, const Picture &) { return false; });
    CHECK(!c.complete);
    // Tiles of 128 pixels and of 32; all samples, and those of rough pixels alone.
    stage = prepare(scene.scene, scene.view(), 300, 200, 0);
    for (const int samples : {0, 3}) {
        PictureOptions few, many;
        few.samples = many.samples = samples;
        few.jobs = 1;
        many.jobs = 9;
        CHECK(render(stage, few).rgba == render(stage, many).rgba);
    }
}
