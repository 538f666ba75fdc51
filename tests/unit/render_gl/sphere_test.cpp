// Pictures of scenes whose look is known by calculation.
#include "tests/support/gl_context.h"
#include "tests/unit/glsl/scenes.h"

#include "render-gl/render.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

using namespace fathom;
using namespace fathom::scenes;

namespace {

constexpr int width = 160, height = 120;

gl::Program built(const Scene &scene, bool buffers = true) {
    Diagnostics diagnostics;
    const glsl::Output output =
        glsl::emit(scene, {.target = glsl::Target::Glsl330, .buffers = buffers}, diagnostics);
    REQUIRE_FALSE(diagnostics.has_errors());
    auto result = gl::Program::build(output, scene);
    if (const auto *error = std::get_if<gl::ProgramError>(&result)) FAIL(error->message);
    return std::get<gl::Program>(std::move(result));
}

std::vector<float> drawn(const Scene &scene, gl::Mode mode, gl::Request request = {}) {
    request.width = width;
    request.height = height;
    const auto pixels = gl::draw(built(scene), scene, request, mode);
    REQUIRE(pixels);
    return pixels->rgba;
}

float at(const std::vector<float> &rgba, int x, int y, int component) {
    return rgba[static_cast<std::size_t>((y * width + x) * 4 + component)];
}

struct PixelRay {
    glm::dvec3 origin, direction;
};
PixelRay ray(const View &view, double x, double y) {
    const double u = (2 * x / width - 1) * width / height, v = 1 - 2 * y / height;
    PixelRay r{view.origin, view.forward};
    (view.orthographic ? r.origin : r.direction) += view.extent * (u * view.right + v * view.up);
    r.direction = glm::normalize(r.direction);
    return r;
}

// Where a ray first meets the unit sphere; negative where it does not.
double meets(const PixelRay &r, double radius = 1) {
    const double b = glm::dot(r.origin, r.direction),
                 c = glm::dot(r.origin, r.origin) - radius * radius;
    return b * b < c ? -1 : -b - std::sqrt(b * b - c);
}

double aspect() { return static_cast<double>(width) / height; }

} // namespace

TEST_CASE("a sphere's silhouette and depth stand where geometry puts them") {
    require_context();
    for (bool orthographic : {false, true}) {
        Scene scene = sphere();
        scene.camera.given = true;
        scene.camera.at = scene.graph.vec3(2.4, 1.6, 4);
        scene.camera.look_at = scene.graph.vec3(0, 0, 0);
        scene.camera.orthographic = orthographic;
        const std::vector<float> numbers = drawn(scene, gl::Mode::Numbers);
        const View view = view_of(scene, 0, aspect());
        int wrong = 0, inside = 0;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const PixelRay r = ray(view, x + 0.5, y + 0.5);
                const double t = meets(r);
                const bool edge = (meets(r, 1.01) < 0) != (meets(r, 0.99) < 0);
                const bool hit = at(numbers, x, y, 3) > 0.5f;
                inside += hit;
                if (!edge && hit != (t >= 0)) ++wrong;
                double away = 0; // of the point that was hit from the middle
                for (std::size_t i = 0; i < 3; ++i)
                    away += std::pow(r.origin[i] + at(numbers, x, y, 1) * r.direction[i], 2);
                if (hit && std::abs(std::sqrt(away) - 1) > 3e-3)
                    ++wrong; // render.epsilon at that distance, and a little
            }
        CHECK(wrong == 0);
        CHECK(inside > 1000);
    }
}

// How far a colour that tells the normal is from what the unit sphere's would be, at most.
double worst_normal(Scene scene, double within) {
    Graph &g = scene.graph;
    Surface &s = scene.surfaces.back();
    s.diffuse = g.add(g.mul(s.normal, g.number(0.5)), g.vec3(0.5, 0.5, 0.5));
    scene.lighting.skip = true;
    const std::vector<float> colors = drawn(scene, gl::Mode::Linear);
    const View view = view_of(scene, 0, aspect());
    double worst = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const PixelRay r = ray(view, x + 0.5, y + 0.5);
            const double t = meets(r);
            if (meets(r, within) < 0)
                continue; // nearer to the edge a hit's tolerance is long along the ray
            for (std::size_t i = 0; i < 3; ++i) {
                const double normal = r.origin[i] + t * r.direction[i];
                worst = std::max(
                    worst, std::abs(at(colors, x, y, static_cast<int>(i)) - (0.5 + 0.5 * normal)));
            }
        }
    return worst;
}

TEST_CASE("a sphere's normals point away from its middle") {
    require_context();
    CHECK(worst_normal(sphere(), 0.9) < 3e-3);
}

TEST_CASE("a field without a gradient on its surface has the surface's normals") {
    require_context();
    Scene cubed = of_field(
        [&](Graph &g, NodeId p) {
            const NodeId ball = sphere_distance(g, p, g.vec3(0, 0, 0), g.number(1));
            return g.mul(g.mul(ball, ball), g.mul(ball, g.number(0.2)));
        },
        cube(1.5));
    cubed.facts[cubed.root.index].lipschitz_sup = 2; // taken from what is no distance
    cubed.camera.given = true;
    cubed.camera.at = cubed.graph.vec3(3.304, 2.203, 5.507);
    cubed.camera.look_at = cubed.graph.vec3(0, 0, 0);
    CHECK(worst_normal(std::move(cubed), 0.8) < 1e-2);
}

TEST_CASE("a bound that was divided out does not change the look") {
    require_context();
    const auto scaled = [](double by) {
        Scene scene = of_field(
            [&](Graph &g, NodeId p) {
                const NodeId ball = sphere_distance(g, p, g.vec3(0, 0, 0), g.number(1));
                const NodeId small = sphere_distance(g, p, g.vec3(1, 0.6, 0.6), g.number(0.4));
                return g.mul(g.make(Op::Union, Type::Float, {ball, small}), g.number(1 / by));
            },
            cube(1.5));
        scene.facts[scene.root.index].lipschitz_sup = by;
        return scene;
    };
    const std::vector<float> plain = drawn(scaled(1), gl::Mode::Linear),
                             divided = drawn(scaled(8), gl::Mode::Linear);
    int different = 0;
    for (std::size_t i = 0; i < plain.size(); ++i)
        different += std::abs(plain[i] - divided[i]) > 0.02f;
    CHECK(different < 40); // silhouettes, by less than a pixel
}

TEST_CASE("a point in a shadow is darker, by as much as is asked") {
    require_context();
    const auto ground = [](double darkness) {
        Scene scene = of_field(
            [](Graph &g, NodeId p) {
                const NodeId ball = sphere_distance(g, p, g.vec3(0, 1.5, 0), g.number(0.5));
                return g.make(Op::Union, Type::Float, {ball, g.component(p, 1)});
            },
            cube(2));
        Graph &g = scene.graph;
        scene.facts[scene.root.index].bounds = Box::everything();
        scene.lights.push_back({true, g.vec3(0, 1, 0), g.vec3(1, 1, 1)});
        scene.lighting.shadow_darkness = g.number(darkness);
        scene.lighting.ambient_occlusion = g.number(0);
        scene.lighting.ambient = g.vec3(0, 0, 0);
        scene.lighting.specular_intensity = g.number(0);
        scene.camera.given = true;
        scene.camera.at = g.vec3(0, 1, 4);
        scene.camera.look_at = g.vec3(0, 0, 0);
        scene.camera.fov = g.number(0.4);
        return scene;
    };
    const std::vector<float> lit = drawn(ground(0), gl::Mode::Linear),
                             half = drawn(ground(0.5), gl::Mode::Linear);
    CHECK(at(lit, width / 2, height / 2, 0) == Approx(0.8).epsilon(1e-3));
    CHECK(at(half, width / 2, height / 2, 0) == Approx(0.4).epsilon(1e-3));
    CHECK(at(half, 2, height / 2, 0) ==
          Approx(at(lit, 2, height / 2, 0)).epsilon(1e-3)); // beside the shadow
}

TEST_CASE("samples are averaged, strips join, and a picture can be stopped") {
    require_context();
    const Scene scene = table_of_spheres(30);
    const gl::Program program = built(scene);
    double last = 0;
    bool forward = true;
    gl::Request request{.width = 97, .height = 61, .samples = 16};
    request.progress = [&](double done) {
        forward &= done >= last;
        last = done;
        return true;
    };
    const auto smooth = gl::draw(program, scene, request, gl::Mode::Linear);
    REQUIRE(smooth);
    CHECK(forward);
    CHECK(last == 1);
    request.progress = {};
    const auto again = gl::draw(program, scene, request, gl::Mode::Linear);
    request.samples = 1;
    const auto rough = gl::draw(program, scene, request, gl::Mode::Linear);
    REQUIRE(again);
    REQUIRE(rough);
    CHECK(again->rgba == smooth->rgba);
    double rough_sum = 0, smooth_sum = 0;
    int between = 0; // values that no single sample has
    for (std::size_t i = 0; i < rough->rgba.size(); ++i) {
        rough_sum += rough->rgba[i];
        smooth_sum += smooth->rgba[i];
        between += std::abs(rough->rgba[i] - smooth->rgba[i]) > 0.05f;
    }
    CHECK(smooth_sum == Approx(rough_sum).epsilon(0.01));
    CHECK(between > 100);
    request.progress = [](double done) { return done < 0.5; };
    CHECK_FALSE(gl::draw(program, scene, request, gl::Mode::Linear));
    CHECK_FALSE(
        gl::draw(program, scene, {.width = gl::largest_side() + 1, .height = 1}, gl::Mode::Linear));
}

TEST_CASE("params move the picture without a new program") {
    require_context();
    Scene scene = of_field(
        [](Graph &g, NodeId p) { return g.sub(g.make(Op::Length, {p}), g.param(0, Type::Float)); });
    Param radius;
    radius.name = "radius";
    radius.value[0] = 1;
    scene.params.push_back(radius);
    const gl::Program program = built(scene);
    const auto covered = [&] {
        const auto numbers =
            gl::draw(program, scene, {.width = width, .height = height}, gl::Mode::Numbers);
        int hits = 0;
        for (std::size_t i = 3; i < numbers->rgba.size(); i += 4) hits += numbers->rgba[i] > 0.5f;
        return hits;
    };
    const int large = covered();
    scene.params[0].value[0] = 0.5;
    const int small = covered();
    CHECK(small > large / 5);
    CHECK(small < large / 3);
}

TEST_CASE("what a driver says is brought back to our line") {
    require_context();
    const Scene scene = sphere();
    Diagnostics diagnostics;
    glsl::Output output = glsl::emit(scene, {.target = glsl::Target::Glsl330}, diagnostics);
    const std::size_t body = output.text.find("return length(p) - 1.0;");
    REQUIRE(body != std::string::npos);
    output.text.replace(body, 6, "retrun");
    const auto result = gl::Program::build(output, scene);
    const auto *error = std::get_if<gl::ProgramError>(&result);
    REQUIRE(error);
    CHECK(error->source_line == "    retrun length(p) - 1.0;");
    CHECK(error->message.find("syntax error") != std::string::npos);
}
