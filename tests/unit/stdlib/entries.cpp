// What every entry of the library owes its reader: a doc comment with an example that runs, and an
// error of its own where an argument makes no shape.
#include "field.h"

#include <catch2/catch.hpp>

#include <fstream>
#include <set>
#include <sstream>

using namespace fathom;

namespace {

struct Example {
    std::string name, text;
};

// The prelude's own, without what is built into the checker. Module dfmodel is tested with the save
// format.
std::vector<typecheck::LibraryEntry> entries() {
    std::vector<typecheck::LibraryEntry> own;
    for (typecheck::LibraryEntry &entry : typecheck::library_entries(driver::standard_library()))
        if (entry.file != "built in" && entry.file != "dfmodel") own.push_back(std::move(entry));
    return own;
}

std::vector<Example> examples() {
    std::vector<Example> found;
    for (const typecheck::LibraryEntry &entry : entries()) {
        std::size_t at = entry.doc.find("Example: `");
        if (at == std::string::npos) continue;
        at += std::string("Example: `").size();
        found.push_back({entry.name, entry.doc.substr(at, entry.doc.find('`', at) - at)});
    }
    return found;
}

// Examples with images find them among those of the gallery.
driver::Compilation compiled(const std::string &text) {
    return driver::compile_text("test.sdf", text, FATHOM_SOURCE_DIR "/examples/parts", {});
}

// Calls that make no shape; of each entry that can be called wrongly at least one.
// Long: the table, a row for each condition.
std::vector<std::string> wrong_calls() {
    std::vector<std::string> calls{
        "sphere(0)",
        "sphere(-1)",
        "box(0)",
        "box([1, -1, 1])",
        "rounded_box([1, 1, 1], 0.6)",
        "rounded_box([1, 1, 1], -0.1)",
        "box_frame([1, 1, 1], 0)",
        "box_frame([1, 1, 1], 0.5)",
        "torus(0, 0.2)",
        "torus(1, 0)",
        "capped_torus(1, 0.2, 0)",
        "capped_torus(1, 0.2, 4)",
        "link(0.5, 0.5, 0.1)",
        "cylinder(0, 1)",
        "cylinder(1, 0)",
        "rounded_cylinder(0.5, 1, 0.6)",
        "capsule([0, 0, 0], [1, 0, 0], 0)",
        "cone(0, 1)",
        "cone(1, -1)",
        "capped_cone(0, 0, 1)",
        "capped_cone(-1, 1, 1)",
        "round_cone(1, 0.2, 0.5)",
        "prism(2, 1, 1)",
        "prism(5, 0, 1)",
        "pyramid([1, 0, 1])",
        "tetrahedron(0)",
        "octahedron(-1)",
        "dodecahedron(0)",
        "icosahedron(0)",
        "plane([0, 0, 0])",
        "slab(0)",
        "slab(1, [0, 0, 0])",
        "ellipsoid([1, 0, 1])",
        "superquadric([1, 1, 1], 0, 1)",
        "superquadric([1, 1, 1], 1, 3)",
        "gdf([])",
        "sphere(inverse(mat2(1, 2, 2, 4))[0][0])",
        "gdf([[0, 0, 0]])",
        "gdf_cube(1, 0.5)",
        "gdf_icosahedron(0)",
        "gdf_blend([X], [Y], 0, 0, 1)",
        "metaballs([], 1)",
        "metaballs([[0, 0, 0]], 0)",
        "metaballs_random(0, [1, 1, 1], 1)",
        "menger(0)",
        "menger(1, 99)",
        "gyroid(0, 0.1)",
        "schwarz_p(1, 0)",
        "mandelbulb(1)",
        "helix(1, 0, 1, 0.1)",
        "helix(1, 1, 0, 0.1)",
        "heightfield(q => 0, [0, 1])",
        "tubes([[0, 0, 0]], 0.1)",
        "circle(0).extrude(1)",
        "ellipse([0, 1]).extrude(1)",
        "rectangle([1, 0]).extrude(1)",
        "polygon([[0, 0], [1, 0]]).extrude(1)",
        "regular_polygon(2, 1).extrude(1)",
        "star(5, 0.4, 1).extrude(1)",
        "segment([0, 0], [1, 0], 0).extrude(1)",
        "arc(1, 0, 0.1).extrude(1)",
        "ring(1, 2).extrude(1)",
        "bezier([0, 0], [1, 1], [2, 0], 0).extrude(1)",
        "circle(1).extrude(0)",
        "circle(1).revolve(-1)",
        "intersection([])",
        "difference([])",
        "smooth_union(-1, sphere(1), box(1))",
        "stairs_union(1, 0, sphere(1), box(1))",
        "pipe(sphere(1), box(1), 0)",
        "groove(sphere(1), box(1), 0, 1)",
        "pseudonorm_blend(sphere(1), box(1), 0.5)",
        "sphere(1).rotate(1, [0, 0, 0])",
        "sphere(1).orient([0, 0, 0], X)",
        "sphere(1).scale(0)",
        "sphere(1).scale([1, 0, 1])",
        "sphere(1).mirror([0, 0, 0])",
        "sphere(1).twist(1, [0, 0, 0])",
        "sphere(1).bend(1, X, X)",
        "sphere(1).taper(-1)",
        "sphere(1).elongate([-1, 0, 0])",
        "sphere(1).hyperize(0)",
        "sphere(1).shell(0)",
        "sphere(1).repeat([0, 0, 0])",
        "sphere(1).repeat([-1, 0, 0])",
        "sphere(1).repeat([1, 0, 0], [0, 1, 1])",
        "sphere(1).repeat_polar(0)",
        "sphere(1).repeat_mirror([0, 0, 0])",
        "sphere(1).displace(p => fbm(p, octaves: 0))",
        "sphere(1).paint(palette(0.5, []))",
        "sphere(1).translate(y: ease_in(time, 0.5))",
        "sphere(1).translate(y: ease_out(time, 0.5))",
        "sphere(1).translate(y: ease_back(time, -1))",
        "sphere(1).translate(y: ease_bounce(time, 0))",
        "sphere(1).translate(y: keyframes([[1, 0], [1, 2]], time))",
        "sphere(1).translate(keyframes([[1, 0, 0, 0], [0.5, 1, 1, 1]], time))",
        "rounded_rectangle([1, 1], 0.6).extrude(1)",
        "engrave(sphere(1), box(1), 0)",
        "tongue(sphere(1), box(1), 0, 1)",
        "sphere(1).reflect([0, 0, 0])",
        "sphere(1).turnaround([0, 0, 0])",
        "sphere(1).displace(p => ridged(p, octaves: 0))",
        "sphere(1).displace(p => turbulence(p, octaves: 0))",
        "sphere(1).displace(p => spot_noise(p, 0, 1))",
        "sphere(1).displace(p => spot_noise(p, 1, 0))",
        "sphere(1).displace_map(image(\"tiles.png\"), 0.1, scale: 0)",
        "sphere(1).paint(triplanar(image(\"tiles.png\"), 0))",
        "sphere(map_range(1, 2, 2, 0, 1))",
        "box(1).repeat([1, 0, 0], [-1, 1, 1])",
    };
    for (const char *solid : {"tetrahedron", "cube", "octahedron", "dodecahedron",
                              "truncated_octahedron", "truncated_icosahedron"})
        calls.push_back(std::string("gdf_") + solid + "(-1)");
    for (const char *operation : {"union", "intersection", "difference"}) {
        for (const char *profile : {"smooth", "round", "chamfer"})
            calls.push_back(std::string(profile) + "_" + operation + "(-0.1, sphere(1), box(1))");
        for (const char *profile : {"stairs", "columns"}) {
            calls.push_back(std::string(profile) + "_" + operation +
                            "(-0.1, 2, sphere(1), box(1))");
            calls.push_back(std::string(profile) + "_" + operation + "(0.1, 0, sphere(1), box(1))");
        }
    }
    for (const char *profile : {"smooth", "round", "chamfer"})
        for (const char *operation : {"intersection", "difference"})
            calls.push_back(std::string(profile) + "_" + operation + "(0.1, [])");
    return calls;
}

// Entries whose every argument of the right type makes something: no list is too short, no number
// degenerate. Those whose errors are of files are tested with the images.
const std::set<std::string> always_right{
    "empty",        "union",        "xor",           "complement", "blend",       "translate",
    "rotate_euler", "offset",       "displace",      "distort",    "within",      "paint",
    "repaint",      "hsv",          "noise",         "simplex",    "value_noise", "worley",
    "saturate",     "smin",         "smax",          "rotate2",    "distance",    "radians",
    "degrees",      "faceforward",  "refract",       "asinh",      "acosh",       "atanh",
    "determinant",  "outerProduct", "distance_grid", "ease_in_out"};

} // namespace

TEST_CASE("every public name of the library has a doc comment with an example", "[stdlib]") {
    std::set<std::string> shown;
    for (const Example &e : examples()) shown.insert(e.name);
    CHECK(shown.size() > 100);
    for (const typecheck::LibraryEntry &entry : entries()) {
        INFO(entry.file << ": " << entry.signature);
        CHECK(shown.count(entry.name) == 1); // of overloads the first has it
    }
}

TEST_CASE("every example of the library compiles without a warning", "[stdlib]") {
    for (const Example &e : examples()) {
        DYNAMIC_SECTION(e.name) {
            driver::Compilation made = compiled(e.text);
            INFO(e.text << "\n" << test::said(made));
            CHECK(made.good());
            // the Mandelbulb alone has no proof, and says so
            CHECK(made.diagnostics.warnings() == (e.name == "mandelbulb" ? 1 : 0));
        }
    }
}

TEST_CASE("every entry that can be called wrongly is, below", "[stdlib]") {
    std::string all;
    for (const std::string &call : wrong_calls()) all += " " + call;
    for (const typecheck::LibraryEntry &entry : entries()) {
        INFO(entry.file << ": " << entry.signature);
        bool called = false;
        for (std::size_t at = all.find(entry.name + "("); at != all.npos;
             at = all.find(entry.name + "(", at + 1))
            called = called || all[at - 1] == ' ' || all[at - 1] == '.' || all[at - 1] == '(';
        CHECK((called || always_right.count(entry.name) == 1));
    }
}

TEST_CASE("an argument that makes no shape is an error at the call", "[stdlib]") {
    for (const std::string &call : wrong_calls()) {
        DYNAMIC_SECTION(call) {
            driver::Compilation made = compiled(call);
            INFO(test::said(made));
            REQUIRE(made.diagnostics.errors() == 1);
            const Diagnostic d = made.diagnostics.sorted()[0];
            CHECK(d.code == Code::BadArgument);
            CHECK(d.primary.span.source ==
                  SourceId{std::size_t{0}}); // in the user's text, not in the library's
        }
    }
}

TEST_CASE("the page of the library shows every entry", "[stdlib]") {
    std::ifstream file(FATHOM_SOURCE_DIR "/docs/stdlib.md");
    std::stringstream page;
    page << file.rdbuf();
    for (const typecheck::LibraryEntry &entry : entries()) {
        INFO(entry.file << ": " << entry.name);
        CHECK(page.str().find("### `" + entry.name + "`") != std::string::npos);
        CHECK(page.str().find("\n" + entry.signature + "\n") != std::string::npos);
    }
}
