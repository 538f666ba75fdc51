// What a click finds: whatever is seen has a part with words that its user wrote; and where the
// part is after the text was edited.
#include "scratch_folder.h"
#include "tests/viewer/drawn.h"
#include "viewer/lines.h"

#include <fmt/format.h>
#include <set>

using namespace fathom;
using namespace fathom::viewer_test;

namespace {

const std::string params = "param on = false\nparam r = 1 in 0.5..2\nparam n = 2 in 1..4\n";

// The parts that a picture shows, as "line words"; "nothing" where a pixel of the scene has none.
std::set<std::string> seen(const std::string &text, const char *on) {
    driver::CompileOptions options = Drawn::with_parts();
    options.overrides = {{"on", on}};
    Drawn drawn(driver::compile_text("scene.sdf", text, "", options));
    drawn.draw(60, 60, {drawn.view({0, 0, 60, 60})});
    std::set<std::string> found;
    for (int y = 0; y < 60; ++y)
        for (int x = 0; x < 60; ++x) {
            const gl::Pick pick = drawn.canvas.pick(x, y);
            if (pick.t < 0) continue;
            const viewer::Part part = viewer::part_of(drawn.compilation, pick.part);
            found.insert(part.number ? fmt::format("{} {}", part.line, part.words) : "nothing");
        }
    return found;
}

driver::Compilation compiled(const std::string &text) {
    return driver::compile_text("scene.sdf", text, "", Drawn::with_parts());
}

// The n-th part with these words, from 1.
viewer::Part part_with(const driver::Compilation &compilation, const std::string &words,
                       int n = 1) {
    for (std::size_t i = 1; i <= compilation.parts.shapes.size(); ++i)
        if (viewer::Part part = viewer::part_of(compilation, static_cast<int>(i));
            part.words == words && --n == 0)
            return part;
    FAIL("no part `" << words << "`");
    return {};
}

} // namespace

TEST_CASE("what a param chooses is picked by its own words, whatever the other arm holds") {
    require_context();
    using Seen = std::set<std::string>;
    const auto scene = [](const std::string &shapes) { return params + shapes + "\n" + camera; };
    // The other arm combines the very shape that is shown.
    const std::string same = "(if on { box(r) - sphere(r * 0.6) } else { box(r) }).paint(red)";
    CHECK(seen(scene(same), "false") == Seen{"4 " + same.substr(0, 60) + "..."});
    CHECK(seen(scene(same), "true") == Seen{"4 box(r)", "4 sphere(r * 0.6)"});
    const std::string lines =
        "(if on {\n  box(r) - sphere(r * 0.6)\n} else {\n  box(r) | sphere(r * 0.6)\n}).paint(red)";
    CHECK(seen(scene(lines), "true") == Seen{"5 box(r)", "5 sphere(r * 0.6)"});
    CHECK(seen(scene(lines), "false") == Seen{"7 box(r)", "7 sphere(r * 0.6)"});
    for (const char *form :
         {"(if on { smooth_union(0.1) { box(r); sphere(r) } } else { box(r) }).paint(red)",
          "(if on { union { box(r).paint(blue); sphere(r) } } else { box(r) }).repaint(red)",
          "(if on { box(r) & sphere(r) } else { box(r).rotate(time, axis: Y) }).paint(red)",
          "(if on { box(r) - sphere(r) } else { box(r) }).paint(red).translate(x: 1) | sphere(0.3)",
          "(if on { box(r) | sphere(2) } else { empty }).paint(red)\nbox(r).paint(blue)",
          "for i in 0..n { (if on { box(r) - sphere(1) } else { box(r) }).paint(red) }",
          "(if n > 2 { box(r) - sphere(r) } else if on { sphere(r) } else { box(r) }).paint(red)",
          "fn f(h) { if h { box(r) - sphere(1) } else { box(r) } }\nf(on).paint(red)"})
        for (const char *on : {"true", "false"}) {
            INFO(form << ", on = " << on);
            CHECK(seen(scene(form), on).count("nothing") == 0);
        }
}

TEST_CASE("a shape that is an operand here and painted there is picked in both places") {
    require_context();
    const auto found = seen(params +
                                "let b = box(1)\n(b.paint(red)).translate([-1.5, 0, 0])\n"
                                "(b - sphere(0.6)).translate([1.5, 0, 0])\n" +
                                camera,
                            "false");
    CHECK(found.count("nothing") == 0);
    CHECK(found.size() >= 2);
}

TEST_CASE("a part of an imported save file has that file to open, and no line in it") {
    const ScratchFolder folder;
    const std::filesystem::path file =
        folder.write("x.yaml", "---\n- 0.3\n- {}\n- []\n- - Generic\n  - Distance field\n"
                               "  - Children:\n      - - Sphere\n        - Sphere 1\n"
                               "        - Radius: 0.8\n");
    const driver::Compilation made = driver::compile_file(file, Drawn::with_parts());
    REQUIRE(made.good());
    const viewer::Part part = viewer::part_of(made, 1);
    CHECK(part.words == "sphere(0.8)");
    CHECK(part.file == file.string());
    CHECK(part.line == 0);
    CHECK(viewer::place_of(part) == file.string());
    CHECK(viewer::part_line(part).ends_with("x.yaml"));
    CHECK(viewer::found_again(made, part, made).number == part.number);
}

TEST_CASE("lines are followed through edits") {
    using Lines = std::vector<std::uint32_t>;
    CHECK(viewer::lines_after("a\nb\nc\n", "a\nb\nc\n") == Lines{0, 1, 2, 3});
    CHECK(viewer::lines_after("a\nb\nc\n", "b\nc\n") == Lines{0, 0, 1, 2});
    CHECK(viewer::lines_after("a\nb\nc\n", "x\ny\na\nb\nz\nc") == Lines{0, 3, 4, 6});
    CHECK(viewer::lines_after("a\nb\nc\n", "  a\r\n\tb\r\nc") == Lines{0, 1, 2, 3}); // indented
    CHECK(viewer::lines_after("a\nb\nc\n", "a\nB\nc\n") == Lines{0, 1, 2, 3});       // edited
    CHECK(viewer::lines_after("a\nb\nc\n", "a\nx\ny\nc\n") == Lines{0, 1, 0, 4});
    CHECK(viewer::lines_after("a\nb\nc\nd\n", "b\na\nd\n") == Lines{0, 0, 1, 2, 3});
    CHECK(viewer::lines_after("", "a\n") == Lines{0});
    CHECK(viewer::lines_after("a\n", "") == Lines{0, 0});
    CHECK(viewer::lines_after("a\na\na\n", "a\na\n") == Lines{0, 1, 2, 0});
}

TEST_CASE("a selection stays on its shape when lines come and go, and goes with its own") {
    const std::string at = "sphere(0.3).translate([", end = ", 0, 0])\n";
    const auto row = [&](int x) { return fmt::format("{}{}{}", at, x, end); };
    const auto found = [](const driver::Compilation &before, const viewer::Part &part,
                          const std::string &text) {
        const driver::Compilation now = compiled(text);
        REQUIRE(now.good());
        return viewer::found_again(before, part, now);
    };
    const driver::Compilation rows = compiled("box(1)\n" + row(1) + row(2) + row(3) + camera);
    const viewer::Part second = part_with(rows, "sphere(0.3).translate([2, 0, 0])");
    CHECK(second.line == 3);
    CHECK(found(rows, second, row(1) + row(2) + row(3) + camera).words == second.words);
    CHECK(found(rows, second, row(1) + row(2) + row(3) + camera).line == 2);
    CHECK(found(rows, second, "\n\nbox(1)\n" + row(1) + row(2) + row(3) + camera).line == 5);
    CHECK(found(rows, second, "box(1)\n" + row(1) + row(3) + camera).number == 0);
    CHECK(found(rows, second, "box(1)\n" + row(1) + row(7) + row(3) + camera).line == 3); // edited
    CHECK(found(rows, second, row(2) + "box(1)\n" + row(1) + row(3) + camera).line == 1); // moved
    CHECK(found(rows, second, row(3) + camera).number == 0);
    // The line above goes, and what comes up to its place has the same words.
    const auto same = [&](const char *lift) {
        return std::string("smooth_union(0.1) { box(1); sphere(") + lift + ") }\n";
    };
    const driver::Compilation twins =
        compiled("sphere(9)\n" + same("0.5") + "union {\n  box(1)\n  sphere(0.7)\n}\n" + camera);
    const viewer::Part last = part_with(twins, "sphere(0.7)");
    CHECK(
        found(twins, last, same("0.5") + "union {\n  box(1)\n  sphere(0.7)\n}\n" + camera).words ==
        "sphere(0.7)");
    // Copies keep their turn.
    const driver::Compilation copies =
        compiled("for i in 0..3 {\n  sphere(0.3 + 0.1 * i) | box(0.2)\n}\n" + camera);
    int number = 0;
    for (std::size_t i = 1; i <= copies.parts.shapes.size(); ++i)
        if (viewer::part_of(copies, static_cast<int>(i)).words == "sphere(0.3 + 0.1 * i)") ++number;
    for (int n = 1; n <= number; ++n) {
        const viewer::Part copy = part_with(copies, "sphere(0.3 + 0.1 * i)", n);
        CHECK(viewer::found_again(copies, copy, copies).number == copy.number);
    }
}
