// What of a save file no compiler takes is left out alone: the rest of the scene stays, and all of
// the file comes back.
#include "tests/unit/save/support.h"

#include "backend-cpu/tape.h"
#include "driver/compile.h"

#include <catch2/catch.hpp>

#include <cmath>

using namespace save_test;

namespace {

struct Taken {
    driver::Compilation made;
    Imported imported;
    std::size_t left_out = 0;
};

Taken taken(const std::string &yaml) {
    save::ImportOptions options;
    driver::leave_out_unusable("a.yaml", yaml, FATHOM_SOURCE_DIR "/examples/a.sdf", options);
    Taken result;
    result.left_out = options.unusable.size();
    result.imported = import_text(yaml, options);
    result.made = driver::compile_text("a.sdf", result.imported.result.sdf,
                                       FATHOM_SOURCE_DIR "/examples", {});
    return result;
}

} // namespace

TEST_CASE("what no compiler takes is left out alone", "[save][unusable]") {
    const std::string endless =
        "[Repetition, r, {Cell: {X: 3, Y: 0, Z: 3}, Children: [[Sphere, s, {Radius: 0.5}]]}]";
    const std::pair<const char *, std::string> cases[] = {
        {"a twist of what has no end", "[Twist, bad, {Rate: 1, Children: [" + endless + "]}]"},
        {"a hyperize of what has no end",
         "[Hyperize, bad, {Exponent: 2, Children: [" + endless + "]}]"},
        {"a hyperize below 1",
         "[Hyperize, bad, {Exponent: 0.5, Children: [[Sphere, s, {Radius: 2}]]}]"},
        {"a spatial blend of what has no end",
         "[Blend, bad, {Center: {X: 1, Y: 0, Z: 0}, Children: [" + endless +
             ", [Sphere, s, {}]]}]"},
        {"a grid that is not there", "[Explicit Field, bad, {File: missing.nrrd}]"},
        {"a library's solid with an argument that it has not",
         "[Library Shape, bad, {Function: octahedron, Arguments: {sides: 3}}]"},
        {"a flat shape among solids",
         "[Library Shape, bad, {Function: circle, Arguments: {radius: 1}}]"},
        {"a field of no slope", "[Field, bad, {Field: [[Point], [Swizzle, x, 0], [Sqrt, 1]]}]"},
    };
    for (const auto &[what, node] : cases) {
        INFO(what);
        const std::string yaml = file_of("[Box, good, {Size: {X: 1, Y: 2, Z: 3}}],\n" + node +
                                         ",\n[Sphere, other, {Radius: 0.25}]");
        const Taken result = taken(yaml);
        INFO(result.imported.result.sdf);
        INFO(result.imported.said());
        CHECK(result.left_out == 1);
        CHECK(result.made.good());
        CHECK(result.imported.said().find("cannot be used: ") != std::string::npos);
        CHECK(result.imported.result.sdf.find("box([1, 2, 3])") != std::string::npos);
        CHECK(result.imported.result.sdf.find("sphere(0.25)") != std::string::npos);
        CHECK(difference(save::parse_text(yaml).value,
                         save::parse_text(export_text(result.made.scene)).value) == "");
    }
}

TEST_CASE("an image that is not there leaves the shapes that it lay on", "[save][unusable]") {
    const std::string yaml = "- 0.3\n- {wood: missing.png}\n- - - {Name: Boards, Diffuse: {Red: 1, "
                             "Green: 2, Blue: 3}, Specular: {Red: 255, Green: 255, Blue: 255, "
                             "Exponent: 5}}\n    - {Color Texture: wood}\n"
                             "- [Generic, Distance field, {Children: [[Sphere, s, {Radius: 2, "
                             "Material: Boards}]]}]\n- [LightingNode, Lighting, {}]\n- 100\n";
    const Taken result = taken(yaml);
    INFO(result.imported.said());
    CHECK(result.made.good());
    CHECK(result.imported.result.sdf.find("sphere(2).paint(boards)") != std::string::npos);
    CHECK(difference(save::parse_text(yaml).value,
                     save::parse_text(export_text(result.made.scene)).value) == "");
}

TEST_CASE("a good file loses nothing to the question", "[save][unusable]") {
    CHECK(taken(file_of("[Box, good, {Size: {X: 1, Y: 2, Z: 3}}]")).left_out == 0);
    // what is wrong with the scene and not with a part of it is told, not left out
    CHECK(taken("- 0.3\n- {}\n- []\n- [Generic, Distance field, {}]\n- [LightingNode, L, {}]\n"
                "- 100\n")
              .left_out == 0);
}

TEST_CASE("a count beyond its limit is the limit, and comes back as it was", "[save]") {
    const std::string yaml =
        file_of("[Blobby Objects, b, {Balls: 5000, Size: {X: 200, Y: 200, Z: 200}}],"
                "\n[Menger Sponge, m, {Size: 1, Iterations: 40}]");
    const Imported imported = import_text(yaml);
    CHECK(imported.result.sdf.find("blobby(1000,") != std::string::npos);
    CHECK(imported.result.sdf.find("menger_sponge(1, 12)") != std::string::npos);
    const CheckedText checked = check_text(imported.result.sdf);
    CHECK(checked.errors() == "");
    CHECK(difference(save::parse_text(yaml).value,
                     save::parse_text(export_text(checked.checked.scene)).value) == "");
}

// Twice, since the first export's own form must be read again as it was meant.
TEST_CASE("keys that are no text and names without quotes survive trips", "[save]") {
    std::string yaml = file_of("[Sphere, ~, {Radius: 2, ? [a, b]: {c: 1}, ? {d: 2}: [e]}],\n"
                               "[Box, 12, {? [x, [y, z]]: ~}],\n[Torus, true, {}],\n"
                               "[Mystery, ~, {? [k]: v}],\n[Sphere, 'null', {}]");
    const save::Value first = save::parse_text(yaml).value;
    for (int trip = 0; trip < 3; ++trip) {
        const CheckedText checked = check_text(import_text(yaml).result.sdf);
        REQUIRE(checked.errors() == "");
        yaml = export_text(checked.checked.scene);
        INFO(yaml);
        CHECK(difference(first, save::parse_text(yaml).value) == "");
        CHECK(yaml.find("? [a, b]\n") != std::string::npos);
        CHECK(yaml.find("'[a, b]'") == std::string::npos);
        CHECK(yaml.find("'~'") == std::string::npos);
        CHECK(yaml.find("'12'") == std::string::npos);
        CHECK(yaml.find("'null'") != std::string::npos);
    }
}

TEST_CASE("the sets of the dodecahedron and icosahedron are those of [AC99]", "[save]") {
    const double g = (1 + std::sqrt(5.0)) / 2;
    const std::pair<const char *, std::array<double, 3>> faces[] = {{"Dodecahedron", {0, g, 1}},
                                                                    {"Icosahedron", {0, 1 / g, g}}};
    for (const auto &[name, normal] : faces) {
        const driver::Compilation made = driver::compile_text(
            "a.sdf",
            import_text(file_of(std::string("[Generalized Distance Function, g, {Shape: ") + name +
                                ", Radius: 1}]"))
                .result.sdf,
            "", {});
        REQUIRE(made.good());
        const double length = std::hypot(normal[0], normal[1], normal[2]);
        const cpu::Program program = cpu::compile(made.scene, made.scene.distance);
        cpu::Scratch scratch = cpu::make_scratch(program, cpu::inputs_of(made.scene, 0));
        const float x = float(normal[0] / length), y = float(normal[1] / length),
                    z = float(normal[2] / length);
        float distance = 1;
        const float *in[] = {&x, &y, &z};
        float *out[] = {&distance};
        cpu::evaluate(program, scratch, in, out, 1);
        CHECK(std::abs(distance) < 1e-6); // the middle of a face lies at the radius
    }
}
