// From a save file to the language and back: nothing is lost, in the file's order.
#include "save-format/import/importer.h"
#include "tests/unit/save/support.h"

#include <catch2/catch.hpp>

#include <fmt/format.h>
#include <random>

using namespace save_test;

namespace {

// Imports, checks and exports `yaml`, and compares the two files as data.
std::string lost(const std::string &yaml) {
    const Imported imported = import_text(yaml);
    const CheckedText checked = check_text(imported.result.sdf);
    const std::string errors = checked.errors();
    if (!errors.empty()) return errors + imported.result.sdf;
    Diagnostics diagnostics;
    const std::string back = save::export_yaml(checked.checked.scene, diagnostics);
    std::string said;
    for (const Diagnostic &d : diagnostics.items()) // a note says what is labelled
        if (d.severity != Severity::Note) said += d.message + "\n";
    const save::ParsedText before = save::parse_text(yaml), after = save::parse_text(back);
    if (!after.ok) return "the export does not read: " + back;
    const std::string found = difference(before.value, after.value);
    return said + (found.empty() ? "" : found + "\n" + imported.result.sdf + back);
}

const char *everything = R"(---
- 0.3
- {wood: wood.png, unused: other.png}
- - - Name: Standard
      Diffuse: {Red: 0, Green: 178, Blue: 255, Alpha: 255}
      Specular: {Red: 255, Green: 255, Blue: 255, Alpha: 102, Exponent: 128.00}
    - Color Texture: <None>
      Texture Scale: {X: 1.00, Y: 1.00}
      Displacement Map: <None>
      Displacement Amount: 0.10
      Displacement Scale: {X: 1.00, Y: 1.00}
  - - Name: Twin
      Diffuse: {Red: 0, Green: 178, Blue: 255, Alpha: 128}
      Specular: {Red: 255, Green: 255, Blue: 255, Alpha: 102, Exponent: 128.00}
  - - Name: Odd one
      Diffuse: {Red: 300, Green: 12.5, Blue: 1}
      Specular: {Red: 1, Green: 2, Blue: 3, Exponent: 7.25, Future: [1, 2]}
      Sheen: yes
  - - Name: Never used
      Diffuse: {Red: 1, Green: 1, Blue: 1}
      Specular: {Red: 1, Green: 2, Blue: 3, Exponent: 1}
- - Generic
  - My field
  - Children:
      - [Sphere, Sphere 1, {Radius: 0.1, Material: Standard, Offset: {X: 0, Y: 0.5}}]
      - [Sphere, Sphere 2, {Radius: 0.1, Material: Twin}]
      - [Sphere, Sphere 2, {Radius: 0.1, Material: Missing}]
      - [Wobble, w, {Rate: 3, Children: []}]
      - [Wobble, 'with children', {Rate: 3, Children: [[Box, Box 1, {Size: {X: 1, Y: 2, Z: 3}}], [Sphere, x, {}]]}]
      - - Difference
        - Plate
        - Children:
          - [Translation, Translation 1, {Vector: {X: -1, Y: 0.30000000000000004, Z: 0}, Children: [[Box, Body, {Size: {X: 1, Y: 2, Z: 3}, Material: Odd one, Colour Space: sRGB}]]}]
          - [Generic, Holes, {Children: [[Cylinder, Cylinder 1, {Radius: 0.25, Height: 4}], [Cone, Cone 1, {Radius: -1, Height: 4, Foo: [1, {a: "b"}]}], [Unknown, u, {}]]}]
          - [Sphere, deep, {Radius: 3}]
      - [Intersection, Intersection 1, {Children: [[Sphere, a, {}], [Intersection, Intersection 2, {Children: [[Sphere, b, {Radius: 2}], [Torus, c, {Major Radius: 2, Minor Radius: 0.75}]]}], [Union, either, {Children: [[Sphere, d, {}], [Box, e, {}]]}]]}]
      - [Union, Union 7, {Children: [[Union, inner, {Children: [[Sphere, s, {Radius: 5}]]}], [Generic, empty, {Children: []}], [Union, Union 1, {}]]}]
      - [Rotation, Rotation 1, {Angles: {X: 90, Y: 30, Z: -12.5}, Children: [[Menger Sponge, m, {Size: 3, Iterations: 2}]]}]
      - [Scaling, Scaling 1, {Factors: {X: 3, Y: 0.7, Z: -2}, Children: [[Sphere, s, {}], [Sphere, s, {Radius: 4}]]}]
      - [Translation, still, {Vector: {X: 0, Y: 0, Z: 0}, Note: kept, Children: [[Sphere, s, {}], [Sphere, t, {}]]}]
      - [Twist, Twist 1, {Rate: 1.5, Children: [[Box, b, {}]]}]
      - [Turnaround, Turnaround 1, {Children: [[Translation, t, {Vector: {X: -2, Y: 0, Z: 0}, Children: [[Sphere, s, {}]]}]]}]
      - [Repetition, Repetition 1, {Cell: {X: 2, Y: 0, Z: 3}, Children: [[Sphere, s, {Radius: 0.5}]]}]
      - [Hyperize, Hyperize 1, {Exponent: 1.5, Children: [[Box, b, {}]]}]
      - [Offset, Offset 1, {Distance: 0.1, Children: [[Box, b, {}]]}]
      - [Blend, Blend 1, {Factor: 0.3, Children: [[Box, b, {}], [Sphere, s, {}]]}]
      - [Blend, Blend 2, {Center: {X: 1, Y: 0, Z: 0.5}, Children: [[Box, b, {}], [Union, Union 3, {Children: [[Sphere, s, {}], [Box, b, {Size: {X: 2, Y: 2, Z: 2}}]]}]]}]
      - [Generalized Distance Function, g, {Shape: Icosahedron, Radius: 1.5, Exponent: 20}]
      - [Generalized Distance Function, h, {Shape: Cube, Second Shape: Octahedron, Scale: 1.6, Second Scale: -0.8, Radius: 0.6, Exponent: .inf, Second Exponent: 12}]
      - [Blobby Objects, blobs, {Balls: 5, Size: {X: 2, Y: 1, Z: 2}, Radius: 0.1, Seed: 9}]
      - not a node
      - [[no, type], here]
      - [Sphere, extra, {}, more, {of: it}]
- - LightingNode
  - Sunlight
  - Ambient R: 0.1
    Ambient G: 0.2
    Ambient B: 0.25
    Ambient Occlusion: 0.5
    Shadow Darkness: lots
    Soft Shadows: 0.125
    Specular Intensity: 0.4
    Specular Exponent: 17
    Skip Shadows & Shading: True
    Mood: gloomy
    Children:
      - [Generic, Light 1, {Children: []}]
      - [Generic, Lamp, {Position: {X: 1, Y: 2, Z: 3}, Color: {Red: 255, Green: 200, Blue: 10}, Intensity: 2, Flicker: True}]
      - [Generic, Sun, {Direction: {X: 1, Y: 2, Z: 3}}]
- 77
- true
- 0.25
- 0.5
- 0
- 0.5
- 0.5
- [0, 1, 0, 45, -20, 30, 50, false, false, false]
- [0, 0, 0, 0, 0, 30, 50, true, true, false]
- [1, false, false]
- [0, false, true]
- {Future: [1, two, "3"]}
- a word
)";

} // namespace

TEST_CASE("a file with everything comes back whole", "[save]") { CHECK(lost(everything) == ""); }

TEST_CASE("textures and displacement maps come back, on materials and on nodes", "[save]") {
    const char *file = R"(- 0.3
- {wood: wood.png, bumps: maps/bumps.png, unused: other.png}
- - - {Name: Boards, Diffuse: {Red: 1, Green: 2, Blue: 3, Alpha: 9}, Specular: {Red: 255, Green: 255, Blue: 255, Exponent: 5}}
    - {Color Texture: wood, Texture Scale: {X: 0.5, Y: 0.25}, Displacement Map: <None>}
  - - {Name: Rough, Diffuse: {Red: 1, Green: 2, Blue: 3, Alpha: 9}, Specular: {Red: 255, Green: 255, Blue: 255, Exponent: 5}}
    - {Displacement Map: bumps, Displacement Amount: 0.2, Displacement Scale: {X: 2, Y: 3}}
  - - {Name: Both, Diffuse: {Red: 1, Green: 2, Blue: 3, Alpha: 9}, Specular: {Red: 255, Green: 255, Blue: 255, Exponent: 5}}
    - {Color Texture: wood, Displacement Map: bumps, Displacement Amount: -0.2}
- - Generic
  - Distance field
  - Children:
      - [Sphere, Sphere 1, {Radius: 2, Material: Boards}]
      - [Sphere, ball, {Radius: 3, Material: Rough}]
      - [Box, box, {Size: {X: 1, Y: 2, Z: 3}, Material: Both}]
      - [Displacement, bumpy, {Map: bumps, Amount: 0.3, Scale: {X: 2, Y: 2}, Children: [[Translation, t, {Vector: {X: 1, Y: 0, Z: 0}, Children: [[Sphere, s, {Radius: 4, Material: Boards}], [Torus, ring, {}]]}]]}]
      - [Translation, moved, {Vector: {X: 5, Y: 0, Z: 0}, Children: [[Displacement, d, {Map: bumps, Amount: 0.1, Children: [[Sphere, s, {Radius: 5}]]}]]}]
      - [Displacement, no map, {Map: missing, Amount: 0.3, Children: [[Sphere, s, {Radius: 6}]]}]
- [LightingNode, Lighting, {}]
- 100
)";
    CHECK(lost(file) == "");
}

TEST_CASE("long lists of like shapes keep their order, doubles and digits", "[save]") {
    std::string nodes =
        "[Difference, Difference 1, {Children: [[Box, Box 1, {Size: {X: 9, Y: 9, Z: 9}}]";
    for (int i = 0; i < 20; ++i) {
        const std::string x = fmt::format("0.{}", 123456789012345 + i % 7);
        nodes += i % 3 == 0 ? ", [Sphere, s, {Radius: " + x + "}]"
                            : ", [Translation, t, {Vector: {X: " + x +
                                  ", Y: 0, Z: 1}, Children: [[Sphere, s, {Radius: 0.25}]]}]";
    }
    CHECK(lost(file_of(nodes + "]}]")) == "");
}

TEST_CASE("powers of space come back as powers, to the last digit", "[save]") {
    std::string nodes;
    for (const char *exponent :
         {"0.1", "0.5", "1.3", "2", "2.3", "2.3000000000000003", "3", "4", "5", "17.25"})
        nodes += std::string(nodes.empty() ? "" : ", ") + "[Hyperize, h, {Exponent: " + exponent +
                 ", Children: [[Box, b, {}]]}]";
    CHECK(lost(file_of(nodes)) == "");
}

TEST_CASE("the version and a lighting node among the shapes come back", "[save]") {
    CHECK(lost("- 0.9\n- {}\n- []\n- [Generic, Distance field, {Children: [[Sphere, Sphere 1, "
               "{Radius: 1}], "
               "[LightingNode, Lighting, {Ambient R: 0.5, Children: []}]]}]\n- 100\n") == "");
}

TEST_CASE("generated trees come back whole", "[save]") {
    std::mt19937 random(1);
    const auto pick = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
    const auto number = [&] { return fmt::format("{}.{}", 1 + pick(9), pick(1000)); };
    const auto xyz = [&] {
        return "{X: " + number() + ", Y: " + number() + ", Z: -" + number() + "}";
    };
    int names = 0;
    const std::function<std::string(int)> node = [&](int depth) -> std::string {
        const std::string name =
            pick(2) == 0 ? fmt::format("node {}", ++names) : fmt::format("Sphere {}", 1 + pick(4));
        std::string children;
        const auto kids = [&](int minimum, int maximum) {
            const int count = minimum + pick(maximum - minimum + 1);
            for (int i = 0; i < count; ++i) children += (i ? ", " : "") + node(depth - 1);
            return "Children: [" + children + "]}]";
        };
        switch (depth <= 0 ? pick(9) : pick(28)) {
        case 0: return "[Sphere, " + name + ", {Radius: " + number() + "}]";
        case 1: return "[Box, " + name + ", {Size: {X: 1, Y: " + number() + ", Z: 2}}]";
        case 2: return "[Torus, " + name + ", {Major Radius: 12, Minor Radius: " + number() + "}]";
        case 3:
            return "[Cylinder, " + name + ", {Radius: 1, Height: " + number() + ", Exact: True}]";
        case 4: return "[Mystery, " + name + ", {Value: " + number() + "}]";
        case 14:
            return "[Generalized Distance Function, " + name +
                   ", {Shape: Dodecahedron, Radius: " + number() + ", Exponent: 9}]";
        case 15:
            return fmt::format("[Blobby Objects, {}, {{Balls: 3, Size: {{X: 1, Y: {}, Z: 1}}, "
                               "Radius: 0.1, Seed: {}}}]",
                               name, number(), pick(9));
        case 16:
            return fmt::format("[Menger Sponge, {}, {{Size: {}, Iterations: {}}}]", name, number(),
                               pick(4));
        case 17:
            return "[Twist, " + name + ", {Rate: " + number() + ", Tightness: {X: [1, 2]}, " +
                   kids(1, 2);
        case 18: return "[Turnaround, " + name + ", {" + kids(1, 2);
        case 19:
            return "[Repetition, " + name + ", {Cell: {X: " + number() + ", Y: 0, Z: " + number() +
                   "}, " + kids(1, 2);
        case 20: return "[Hyperize, " + name + ", {Exponent: " + number() + ", " + kids(1, 2);
        case 21: return "[Offset, " + name + ", {Distance: " + number() + ", " + kids(1, 3);
        case 22:
            return "[Pseudo-norm Blend, " + name + ", {Exponent: " + number() + ", " + kids(2, 3);
        case 23:
            return "[Seam, " + name + ", {Profile: Groove, Radius: 0.1, Depth: " + number() + ", " +
                   kids(2, 3);
        case 8:
            return "[Cone, " + name + ", {Radius: " + number() + ", Height: 2, Steepness: high}]";
        case 7:
            return "[Library Shape, " + name +
                   ", {Function: octahedron, Arguments: {radius: " + number() + "}}]";
        case 6:
            return "[Sphere, " + name +
                   ", {Radius: -1, Colour: [red, {a: \"b\"}]}, behind, {it: all}]";
        case 5: return "just a word";
        case 9: return "[Union, " + name + ", {" + kids(0, 4);
        case 10: return "[Generic, " + name + ", {" + kids(0, 4);
        case 11: return "[Intersection, " + name + ", {" + kids(0, 3);
        case 12: return "[Difference, " + name + ", {" + kids(0, 3);
        case 13: return "[Translation, " + name + ", {Vector: " + xyz() + ", " + kids(0, 3);
        case 24:
            return "[Rotation, " + name + ", {Angles: {X: " + number() + ", Y: 0, Z: " + number() +
                   "}, " + kids(1, 2);
        case 25:
            return "[Scaling, " + name + ", {Factors: {X: 2, Y: " + number() + ", Z: 3}, " +
                   kids(1, 2);
        case 26: return "[Blend, " + name + ", {Factor: 0.25, " + kids(0, 3);
        default: return "[Mystery, " + name + ", {Rate: 1, " + kids(0, 3);
        }
    };
    for (int i = 0; i < 200; ++i) {
        std::string nodes;
        const int count = 1 + pick(4);
        for (int k = 0; k < count; ++k) nodes += node(3) + ",\n";
        INFO(nodes);
        REQUIRE(lost(file_of(nodes)) == "");
    }
}

TEST_CASE("what a scene exports, it exports again to the same bytes", "[save]") {
    // sizes that differ from copy to copy, by one number and by three
    for (const char *text :
         {"sphere(1).repeat([2, 0, 2], copies: (_, id) => box(1).scale(0.5 + 0.4 * hash(id)))\n",
          "sphere(1).repeat([2, 0, 2], copies: (_, id) => box(1).scale([0.5, 0.5 + 0.4 * hash(id), "
          "1]))\n"}) {
        INFO(text);
        const CheckedText first = check_text(text);
        REQUIRE(first.errors() == "");
        const std::string yaml = export_text(first.checked.scene);
        CHECK(yaml.find("Varying") != std::string::npos);
        const CheckedText second = check_text(import_text(yaml).result.sdf);
        REQUIRE(second.errors() == "");
        CHECK(export_text(second.checked.scene) == yaml);
    }
}

TEST_CASE("a material's displacement with a value that cannot be is not added at each trip",
          "[save]") {
    const std::string look = "- 0.3\n- {bumps: bumps.png}\n- - - {Name: Rough, Diffuse: {Red: 1, "
                             "Green: 2, Blue: 3}, Specular: {Red: 4, Green: 5, Blue: 6}}\n"
                             "    - {Displacement Map: bumps, ";
    for (const std::string wrong :
         {"Displacement Scale: {X: 0.Y, Y: 0.5}", "Displacement Scale: {X: 2, Y: -1}",
          "Displacement Scale: 2", "Displacement Amount: 1e7"}) {
        std::string yaml = look + wrong +
                           "}\n- [Generic, Field, {Children: [[Sphere, a, {Material: "
                           "Rough}]]}]\n";
        for (int trip = 0; trip < 2; ++trip) {
            const CheckedText checked = check_text(import_text(yaml).result.sdf);
            REQUIRE(checked.errors() == "");
            yaml = export_text(checked.checked.scene);
            INFO(yaml);
            CHECK(yaml.find("- Displacement\n") == std::string::npos);
        }
    }
}

TEST_CASE("children that are given twice, once as none, are not lost on the way", "[save]") {
    std::string exported =
        "---\n- 0.3\n- {}\n- []\n"
        "- [Generic, Field, {Children: [[Sphere, Ball, {Radius: 2}]], Children: ~}]\n";
    for (int trip = 0; trip < 3; ++trip) {
        const CheckedText checked = check_text(import_text(exported).result.sdf);
        REQUIRE(checked.errors() == "");
        exported = export_text(checked.checked.scene);
        INFO(exported);
        CHECK(exported.find("Ball") != std::string::npos);
    }
}

TEST_CASE("an export of shared shapes counts against the limits", "[save]") {
    const CheckedText checked = check_text(
        "fn d(s, n) = if n == 0 { s } else { d(s | s.translate(x: 1), n - 1) }\nd(sphere(1), 12)");
    REQUIRE(checked.errors().empty());
    const auto answer = [&](std::size_t work, std::size_t memory) {
        save::ExportOptions options;
        options.limits.work = work, options.limits.memory = memory;
        Diagnostics diagnostics;
        const std::string text = save::export_yaml(checked.checked.scene, diagnostics, options);
        CHECK(text.empty() == diagnostics.has_errors());
        CHECK(diagnostics.errors() <= 1);
        for (const Diagnostic &d : diagnostics.items())
            if (d.severity == Severity::Error) {
                CHECK(d.primary.span.source);
                return std::string(code_name(d.code));
            }
        return std::string();
    };
    const Limits usual;
    CHECK(answer(usual.work, usual.memory) == "");
    CHECK(answer(20'000, 100) == "");
    CHECK(answer(2'000, usual.memory) == "loop-limit");
    CHECK(answer(usual.work, 10) == "memory-limit");
}

TEST_CASE("paths go out as the save file sees them", "[save]") {
    CheckedText checked = check_text("sphere(1).paint(material(texture: image(\"a.png\")))\n"
                                     "distance_grid(\"g.nrrd\", isovalue: 2).translate(x: 3)");
    INFO(checked.errors());
    REQUIRE(checked.errors().empty());
    for (ir::ImageData &image : checked.checked.scene.images) image.file = "scenes/a.png";
    for (ir::GridData &grid : checked.checked.scene.grids) grid.file = "scenes/g.nrrd";
    const auto written = [&](const char *way, std::string &said) {
        save::ExportOptions options;
        options.path_of = [&](const std::string &file) { return way + file; };
        Diagnostics diagnostics;
        const std::string text = save::export_yaml(checked.checked.scene, diagnostics, options);
        for (const Diagnostic &d : diagnostics.items())
            if (d.severity == Severity::Warning) said += d.message + "\n";
        return text;
    };
    std::string said;
    const std::string below = written("deep/", said);
    CHECK(below.find("deep/scenes/a.png") != below.npos);
    CHECK(below.find("deep/scenes/g.nrrd") != below.npos);
    CHECK(said.empty());
    const std::string beside = written("../", said);
    CHECK(beside.find("../scenes/a.png") != beside.npos);
    CHECK(said.find("`../scenes/a.png` does not lie in the save file's folder\n") != said.npos);
    CHECK(said.find("`../scenes/g.nrrd` does not lie in the save file's folder\n") != said.npos);
    const std::string as_it_is = export_text(checked.checked.scene);
    CHECK(as_it_is.find("scenes/") == as_it_is.npos);
}
