// What an export says is the scene's field: exported and imported again, the raw field is the same
// at 10^4 points of generated scenes (every example: examples_test.cpp). Raw, since the bounds that
// divide it may differ: of what is written as a function, more may be known.
#include "tests/support/effort.h"
#include "tests/unit/save/support.h"

#include "backend-cpu/tape.h"
#include "driver/compile.h"
#include "ir/lower/lower.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <fmt/format.h>
#include <random>

using namespace save_test;

namespace {

constexpr std::size_t points = 10000;

struct Points {
    std::vector<float> x, y, z;
};

// In the scene's box and some way round it, at most 8 from the origin.
Points points_about(const ir::Scene &scene, unsigned seed) {
    std::mt19937 random(seed);
    Points made;
    for (std::size_t i = 0; i < points; ++i) {
        std::array<float, 3> p{};
        for (std::size_t k = 0; k < 3; ++k) {
            const double lo = std::max(scene.bounds.empty() ? -2 : scene.bounds.lo[k] - 0.5, -8.0),
                         hi = std::min(scene.bounds.empty() ? 2 : scene.bounds.hi[k] + 0.5, 8.0);
            p[k] = static_cast<float>(lo + (hi - lo) * (random() / 4294967296.0));
        }
        made.x.push_back(p[0]), made.y.push_back(p[1]), made.z.push_back(p[2]);
    }
    return made;
}

// The root's raw field: what an offset by nothing, every bound being 1, is asked for.
std::vector<float> raw_field(ir::Scene scene, const Points &at) {
    for (ir::ShapeFact &fact : scene.facts) {
        fact.lipschitz = scene.graph.number(1);
        fact.guard = false;
    }
    ir::Shape whole;
    whole.kind = ir::ShapeKind::Offset;
    whole.children = {scene.root};
    whole.args = {scene.graph.number(0)};
    ir::ShapeFact fact;
    fact.lipschitz = scene.graph.number(1);
    scene.root = scene.shapes.add(std::move(whole));
    scene.facts.resize(scene.shapes.size(), fact);
    ir::lower(scene);
    const cpu::Program program = cpu::compile(scene, scene.distance);
    cpu::Scratch scratch = cpu::make_scratch(program, cpu::inputs_of(scene, 0));
    std::vector<float> result(at.x.size());
    const float *in[] = {at.x.data(), at.y.data(), at.z.data()};
    float *out[] = {result.data()};
    cpu::evaluate(program, scratch, in, out, result.size());
    return result;
}

struct Comparison {
    std::string exported, imported, errors; // what was said
    double worst = 0;                       // the largest difference
    bool signs = true;
    std::string sdf;
};

Comparison compared(const driver::Compilation &first, unsigned seed) {
    Comparison result;
    Diagnostics diagnostics;
    const std::string yaml = save::export_yaml(first.scene, diagnostics);
    for (const Diagnostic &d : diagnostics.items()) // a note says what is labelled
        if (d.severity != Severity::Note) result.exported += d.message + "\n";
    const Imported imported = import_text(yaml);
    result.imported = imported.said();
    result.sdf = imported.result.sdf;
    const driver::Compilation second =
        driver::compile_text("b.sdf", result.sdf, FATHOM_SOURCE_DIR "/examples", {});
    for (const Diagnostic &d : second.diagnostics.items())
        if (d.severity == Severity::Error)
            result.errors += to_text(d, second.sources, false).substr(0, 400) + "\n";
    if (!second.good()) return result;
    const Points at = points_about(first.scene, seed);
    const std::vector<float> a = raw_field(first.scene, at), b = raw_field(second.scene, at);
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double off = std::abs(double(a[i]) - double(b[i]));
        if (!(off <= result.worst)) result.worst = off;
        result.signs = result.signs && ((a[i] < 0) == (b[i] < 0) || off <= 1e-5);
    }
    return result;
}

void check_fields(const Comparison &result) {
    CHECK(result.worst <= 1e-5);
    CHECK(result.signs);
}

} // namespace

TEST_CASE("images, grids and maps go out by their names, and come back the same", "[save][field]") {
    const std::string text = R"(let tiles = image("parts/tiles.png")
let bumps = image("parts/pebbles.png")
sphere(1).displace_map(bumps, 0.1, scale: [0.5, 0.25]).paint(material(texture: tiles, texture_scale: 0.5))
union { box(1).translate(y: 2)
  torus(1, 0.3).scale(0.5) }.displace_map(bumps, 0.05).translate(x: 3)
distance_grid("parts/rock.nrrd").translate(x: -3)
param level = 0.02 in -0.05..0.05
distance_grid("parts/rock.nrrd", isovalue: level).translate(z: -3)
distance_grid("parts/rock.nrrd", isovalue: -0.02, above: true).translate(z: 3)
)";
    const driver::Compilation first =
        driver::compile_text("a.sdf", text, FATHOM_SOURCE_DIR "/examples", {});
    REQUIRE(first.good());
    const Comparison result = compared(first, 3);
    INFO(result.sdf);
    CHECK(result.exported == "");
    CHECK(result.imported == "");
    CHECK(result.errors == "");
    check_fields(result);
    CHECK(result.sdf.find("texture: tiles, texture_scale: 0.5") != std::string::npos);
    CHECK(result.sdf.find("distance_grid(file: \"parts/rock.nrrd\", isovalue: level") !=
          std::string::npos);
    CHECK(result.sdf.find(".displace_map(pebbles, 0.05, scale: 1)") != std::string::npos);
}

namespace {

// Scenes as people write them, of all that the library has by numbers.
class Generator {
  public:
    explicit Generator(unsigned seed) : random_(seed) {}

    std::string scene() {
        std::string text = "param size = 0.7 in 0.5..1.2\n"
                           "let stone = material(diffuse: p => mix(#884422, #ccaa88, noise(3 * "
                           "p)), exponent: 9)\n";
        const int count = 1 + pick(3);
        for (int i = 0; i < count; ++i) text += shape(3) + paint() + "\n";
        return text + "camera(at: [3, 2, 5], look_at: [0, 0.5, 0])\n";
    }

  private:
    int pick(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }
    std::string number(double lo, double hi) {
        return fmt::to_string(std::round(100 * (lo + (hi - lo) * (random_() / 4294967296.0))) /
                              100);
    }
    std::string size() { return number(0.3, 1.2); }
    std::string xyz(double lo, double hi) {
        return "[" + number(lo, hi) + ", " + number(lo, hi) + ", " + number(lo, hi) + "]";
    }
    std::string axis() { return std::string(1, "XYZ"[pick(3)]); }
    std::string paint() {
        switch (pick(5)) {
        case 0: return ".paint(#c08040)";
        case 1: return ".paint(stone)";
        case 2: return ".paint(material(diffuse: (p, n) => mix(red, blue, 0.5 + 0.5 * n.y)))";
        default: return "";
        }
    }

    std::string solid() {
        switch (pick(26)) {
        case 0: return "sphere(" + size() + ")";
        case 1: return "box(" + xyz(0.4, 1.5) + ")";
        case 2: return "rounded_box(" + xyz(0.6, 1.5) + ", radius: 0.1)";
        case 3: return "torus(" + number(0.6, 1.2) + ", " + number(0.1, 0.4) + ")";
        case 4: return "cylinder(" + size() + ", " + size() + ")";
        case 5: return "cone(" + size() + ", " + size() + ")";
        case 6: return "capsule(" + xyz(-1, 0) + ", " + xyz(0.1, 1) + ", 0.2)";
        case 7: return "gdf_icosahedron(" + size() + ", exponent: " + number(4, 30) + ")";
        case 8: return "gdf_truncated_octahedron(" + size() + ")";
        case 9: return "octahedron(" + size() + ")";
        case 10: return "dfmodel.box(" + xyz(0.4, 1.5) + ")";
        case 11: return "dfmodel.cone(" + size() + ", " + size() + ")";
        case 12: return "dfmodel.cylinder(" + size() + ", " + size() + ")";
        case 13: return "dfmodel.menger_sponge(" + number(1, 2) + ", 2)";
        case 14: return fmt::format("dfmodel.blobby(5, size: 1, radius: 0.1, seed: {})", pick(9));
        case 15:
            return "dfmodel.gdf_pair(dfmodel.cube, dfmodel.octahedron, a_scale: 1.6, b_scale: "
                   "-0.8, radius: 0.6)";
        case 16: return "menger(1.5, 2)";
        case 17: return "helix(0.6, 0.5, turns: 2, thickness: 0.2)";
        case 18:
            return "tubes([" + xyz(-1, 1) + ", " + xyz(-1, 1) + ", " + xyz(-1, 1) +
                   "], radius: 0.15)";
        case 19: return "metaballs([" + xyz(-0.5, 0.5) + ", " + xyz(-0.5, 0.5) + "], radius: 0.6)";
        case 20: return "gdf([" + xyz(0.2, 1) + ", " + xyz(-1, -0.1) + ", X], radius: 0.7)";
        case 21: return "star(5, outer: 0.9, inner: 0.4).extrude(" + size() + ")";
        case 22: return "(circle(0.4) - rectangle([0.3, 0.3])).translate([0.7, 0]).revolve()";
        case 23: return "heightfield(q => 0.1 * sin(4 * q.x), size: [2, 2], depth: 0.4)";
        case 24: return "implicit(p => length(p) - size + 0.1 * noise(3 * p))";
        default: return "sphere(size)";
        }
    }

    std::string transform() {
        switch (pick(19)) {
        case 0: return ".translate(" + xyz(-1, 1) + ")";
        case 1: return ".rotate(" + number(-170, 170) + "deg, axis: " + xyz(-1, 1) + ")";
        case 2:
            return ".rotate_euler([" + number(-90, 90) + "deg, " + number(-90, 90) + "deg, 20deg])";
        case 3: return ".scale(" + number(0.5, 1.5) + ")";
        case 4: return ".scale(" + xyz(0.5, 1.5) + ")";
        case 5: return ".mirror(" + axis() + ")";
        case 6: return ".turnaround(" + axis() + ")";
        case 7: return ".reflect(" + xyz(0.1, 1) + ")";
        case 8: return ".offset(" + number(0.02, 0.1) + ")";
        case 9: return ".shell(0.05)";
        case 10: return ".displace(p => 0.05 * fbm(3 * p, octaves: 3))";
        case 11: return ".elongate([0.3, 0, 0.2])";
        case 12: return ".repeat_polar(5, axis: " + axis() + ")";
        case 13: return ".repeat([3, 0, 3], count: [2, 1, 3])";
        case 14:
            return ".repeat([4, 0, 4], count: [2, 1, 2], copies: (s, id) => s.scale(0.7 + 0.1 * "
                   "id.x))";
        case 15: return ".repeat_polar(4, copies: (s, id) => s.translate(y: 0.1 * id.x))";
        case 16: return ".distort(p => [p.x + 0.1 * sin(2 * p.y), p.y, p.z])";
        case 17: return ".rotate(0.3 * time + 0.2)";
        default: return ".repeat_mirror([3, 0, 3])";
        }
    }

    std::string shape(int depth) {
        if (depth == 0) return solid();
        const auto operands = [&] {
            return "{ " + shape(depth - 1) + paint() + "\n" + shape(depth - 1) + " }";
        };
        const auto two = [&] { return shape(depth - 1) + ", " + shape(depth - 1); };
        switch (pick(17)) {
        case 0: return "union " + operands();
        case 1: return "intersection " + operands();
        case 2: return "difference " + operands();
        case 3: return "xor " + operands();
        case 4: return "smooth_union(0.2) " + operands();
        case 5: return "chamfer_difference(0.15) " + operands();
        case 6: return "round_intersection(0.2) " + operands();
        case 7: return "columns_union(0.3, 3) " + operands();
        case 8: return "stairs_difference(0.3, 3) " + operands();
        case 9: return "smooth_union(0.3, mix: true) " + operands();
        case 10: return "blend(" + two() + ", " + number(0.2, 0.8) + ")";
        case 11:
            return "blend(" + two() + ", p => clamp(length(p - " + xyz(-1, 1) +
                   "), 0, 1)).within(ball(4))";
        case 12: return "pseudonorm_blend(" + two() + ", 3)";
        case 13: return "groove(" + two() + ", width: 0.1, depth: 0.05)";
        case 14: return "union { for i in 0..3 { " + shape(depth - 1) + ".translate(x: 2 * i) } }";
        default: return shape(depth - 1) + transform();
        }
    }

    std::mt19937 random_;
};

} // namespace

TEST_CASE("generated scenes are the same after an export and an import", "[save][field]") {
    const auto scenes = static_cast<unsigned>(fathom::test::effort(50));
    unsigned proved = 0;
    for (unsigned seed = 1; seed <= scenes; ++seed) {
        const std::string text = "import \"dfmodel\" as dfmodel\n" + Generator(seed).scene();
        const driver::Compilation first = driver::compile_text("a.sdf", text, "", {});
        for (const Diagnostic &d : first.diagnostics.items()) {
            // a bound that cannot be proved is possible by chance; anything else is the generator's
            // mistake
            INFO(text);
            INFO(d.message);
            CHECK((d.severity != Severity::Error || code_name(d.code).starts_with("lipschitz") ||
                   code_name(d.code) == "needs-region"));
        }
        if (!first.good()) continue;
        ++proved;
        const Comparison result = compared(first, seed);
        INFO(text);
        INFO(result.exported);
        CHECK((result.exported.empty() ||
               result.exported.find("without the paints in it") != std::string::npos));
        CHECK(result.imported == "");
        CHECK(result.errors == "");
        check_fields(result);
    }
    CHECK(proved > scenes * 3 / 5);
}

TEST_CASE("the edges of what arguments may be come back, and deformed functions", "[save][field]") {
    for (const char *text :
         {"star(6, 1, 0.7).extrude(2, 60deg, 0.4)", "rectangle([1, 1]).extrude(2, twist: 1)",
          "rectangle([1, 1]).extrude(2, taper: 0)", "ring(1, 0.6).extrude(1).bend(0.4)",
          "smooth_union(0, sphere(0.7), box(1))", "columns_union(0, 2, sphere(0.7), box(1))",
          "pseudonorm_blend(sphere(0.6).translate(x: -0.5), sphere(0.6), inf)",
          "pseudonorm_blend(sphere(0.6).translate(x: -0.5), sphere(0.6), 1)"}) {
        INFO(text);
        const driver::Compilation first = driver::compile_text("a.sdf", text, "", {});
        REQUIRE(first.good());
        const Comparison result = compared(first, 3);
        CHECK(result.exported == "");
        CHECK(result.imported == "");
        CHECK(result.errors == "");
        check_fields(result);
    }
    // Paints below a deformation are kept; the functions there have their boxes, for its proof.
    const driver::Compilation painted = driver::compile_text(
        "a.sdf", "(star(6, 1, 0.7).extrude(2).paint(red) | sphere(0.9)).twist(0.5)", "", {});
    REQUIRE(painted.good());
    const Comparison result = compared(painted, 3);
    CHECK(result.exported == "");
    CHECK(result.errors == "");
    CHECK(result.signs);
    CHECK(result.sdf.find("paint(") != std::string::npos);
}
