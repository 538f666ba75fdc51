// The viewer's parts that need no window: cameras, values, literals, editors, edits of the text.
#include "base/encode.h"
#include "driver/edit.h"
#include "save-format/save_format.h"
#include "scratch_folder.h"
#include "viewer/camera.h"
#include "viewer/editor.h"
#include "viewer/frame_times.h"
#include "viewer/params.h"
#include "viewer/slots.h"
#include "viewer/views.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <sstream>
#include <sys/stat.h>
#include <unistd.h>

using namespace fathom;
namespace fs = std::filesystem;

TEST_CASE("a camera is kept by its view and written as a line of the scene") {
    ir::View view = ir::look_at({3, 2, 5}, {0, 1, 0}, std::tan(0.3), false);
    viewer::Camera camera = viewer::camera_of(view);
    ir::View again = viewer::view_of(camera);
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(again.origin[i] == Approx(view.origin[i]).margin(1e-9));
        CHECK(again.forward[i] == Approx(view.forward[i]).margin(1e-9));
        CHECK(again.right[i] == Approx(view.right[i]).margin(1e-9));
    }
    CHECK(again.extent == Approx(view.extent));
    CHECK(viewer::camera_line(camera).starts_with(
        "camera(at: [3, 2, 5], look_at: [0, 1, 0], fov: 34.38deg"));
}

TEST_CASE("turning keeps the distance, panning the direction, framing the whole sphere in sight") {
    viewer::Camera camera =
        viewer::camera_of(ir::look_at({0, 0, 5}, {0, 0, 0}, std::tan(0.4), false));
    viewer::orbit(camera, 0.25, 0.1);
    ir::View turned = viewer::view_of(camera);
    CHECK(std::hypot(turned.origin[0], turned.origin[1], turned.origin[2]) == Approx(5));
    viewer::pan(camera, 0.5, 0);
    for (std::size_t i = 0; i < 3; ++i)
        CHECK(viewer::view_of(camera).forward[i] == Approx(turned.forward[i]).margin(1e-9));
    for (int i = 0; i < 100; ++i) viewer::orbit(camera, 0, 1);
    CHECK(std::isfinite(viewer::view_of(camera).right[0])); // never straight up
    viewer::frame(camera, {1, 2, 3}, 2, 0.5);
    CHECK(2 / camera.distance <= Approx(std::sin(std::atan(camera.slope * 0.5))));
    CHECK(camera.target == glm::dvec3{1, 2, 3});
}

TEST_CASE("a slider's value outlives a reload, unless the text's own value changed") {
    ir::Param param;
    param.name = "radius";
    param.has_range = true;
    param.lo[0] = 0;
    param.hi[0] = 2;
    param.value[0] = param.initial[0] = 1;
    std::vector<ir::Param> before{param}, fresh{param};
    before[0].value[0] = 1.5;
    viewer::carry_over(before, fresh);
    CHECK(fresh[0].value[0] == 1.5);
    fresh = {param};
    fresh[0].value[0] = fresh[0].initial[0] = 0.5; // the text was edited
    viewer::carry_over(before, fresh);
    CHECK(fresh[0].value[0] == 0.5);
    fresh = {param};
    fresh[0].hi[0] = 1.2; // no place for it any more
    viewer::carry_over(before, fresh);
    CHECK(fresh[0].value[0] == 1);
    CHECK(viewer::value_text(before[0]) == "1.5");
    before[0].structural = true;
    REQUIRE(viewer::structural_values(before).size() == 1);
    CHECK(viewer::structural_values(before)[0].text == "1.5");
    std::vector<driver::Override> values = viewer::structural_values(before);
    CHECK_FALSE(viewer::drop_outdated(before, {param}, values));
    param.initial[0] = 0.5;
    CHECK(viewer::drop_outdated(before, {param}, values));
    CHECK(values.empty());
}

TEST_CASE("a literal that is edited becomes data, once") {
    const std::string a =
        "#version 330 core\n// 1.5\nconst vec4 t[1] = vec4[](\n    vec4(1.0, 2.0, 3.0, 4.0));\n"
        "float f1(vec3 p2) { return length(p2) - 1.5 * 1e-3; }\n";
    auto with = [&](const std::string &from, const std::string &to) {
        std::string b = a;
        b.replace(b.find(from), from.size(), to);
        return b;
    };
    viewer::Slots slots{a, {}};
    CHECK(viewer::text_with_slots(slots) == a);
    REQUIRE(viewer::values_in(slots, a));
    CHECK(viewer::values_in(slots, a)->empty());
    const std::string b = with("- 1.5", "- 1.75");
    CHECK_FALSE(viewer::values_in(slots, b)); // not edited before
    auto wider = viewer::widened(slots, b);
    REQUIRE(wider);
    REQUIRE(wider->edited.size() == 1);
    CHECK(viewer::text_with_slots(*wider).find("length(p2) - fathom_edited[0] * 1e-3") !=
          std::string::npos);
    CHECK(viewer::text_with_slots(*wider).find("uniform float fathom_edited[1];") !=
          std::string::npos);
    CHECK(viewer::values_in(*wider, with("- 1.5", "- 2.5")) == std::vector<float>{2.5f});
    CHECK(viewer::values_in(*wider, a) == std::vector<float>{1.5f});
    CHECK_FALSE(viewer::values_in(*wider, with("3.0", "3.5")));
    CHECK_FALSE(viewer::values_in(*wider, with("t[1]", "t[2]"))); // a whole number is structure
    CHECK_FALSE(viewer::widened(*wider, with("length", "dot")));
    // A second literal joins the first; the table that holds it is constant no more.
    auto both = viewer::widened(*wider, with("3.0", "3.5"));
    REQUIRE(both);
    CHECK(both->edited.size() == 2);
    CHECK(viewer::text_with_slots(*both).find("const") == std::string::npos);
    CHECK(viewer::values_in(*both, with("3.0", "3.5")) == std::vector<float>{3.5f, 1.5f});
}

TEST_CASE("editors are told the line in their own way") {
    using Words = std::vector<std::string>;
    CHECK(viewer::editor_command("gedit", "/s/a b.sdf", 7, 3) ==
          Words{"gedit", "+7", "/s/a b.sdf"});
    CHECK(viewer::editor_command("code --wait", "/s/a.sdf", 7, 3) ==
          Words{"code", "--wait", "-g", "/s/a.sdf:7:3"});
    CHECK(viewer::editor_command("/usr/bin/subl", "/s/a.sdf", 7, 3) ==
          Words{"/usr/bin/subl", "/s/a.sdf:7:3"});
    CHECK(viewer::editor_command("kate", "/s/a.sdf", 7, 3) ==
          Words{"kate", "--line", "7", "--column", "3", "/s/a.sdf"});
    CHECK(viewer::needs_terminal("vim"));
    CHECK(viewer::needs_terminal("/usr/bin/emacsclient -t"));
    CHECK_FALSE(viewer::needs_terminal("emacsclient -n"));
    CHECK(viewer::open_in_editor("no-such-editor-here", "a.sdf", 7, 3) ==
          "cannot start `no-such-editor-here`; it is at a.sdf:7");
    CHECK(viewer::in_terminal("xterm -fs 12", {"vim", "+7", "/s/a.sdf"}) ==
          Words{"xterm", "-fs", "12", "-e", "vim", "+7", "/s/a.sdf"});
    CHECK(viewer::in_terminal("terminator", {"vim", "/s/a b.sdf"}) ==
          Words{"terminator", "-x", "vim", "/s/a b.sdf"});
}

TEST_CASE("no name of a file is an option or a command to an editor, and no shell sees it") {
    const ScratchFolder folder;
    const std::string touch = "touch " + (folder / "pwned").string();
    const std::vector<std::string> names{
        "+call system('" + touch + "')|q.sdf",
        "+!" + touch,
        "-c" + touch,
        "--cmd=" + touch,
        "-",
        "scp://host/a.sdf",
        "$(" + touch + ")",
        "`" + touch + "`",
        "; " + touch + " #",
        "a\n" + touch + "\n",
        "'; " + touch + "; '",
        "{line}{column}{file}{}",
        "%s",
    };
    const std::string here = fs::current_path().string() + "/";
    for (const char *editor : {"vim", "gedit", "code", "subl", "hx", "kate", "emacs -nw", "nano"})
        for (const std::string &name : names) {
            const std::vector<std::string> words = viewer::editor_command(editor, name, 7, 3);
            INFO(editor << " " << name);
            // One word holds the name, and begins with the way from the root.
            CHECK(std::ranges::count_if(words, [&](const std::string &word) {
                      return word.starts_with(here + name);
                  }) == 1);
            CHECK(words ==
                  viewer::editor_command(editor, here + name, 7, 3)); // which is told as it is
        }
    // Run: an editor that writes down its words, by itself and in a terminal that starts it.
    const std::string log = (folder / "log").string();
    const fs::path program = folder.write(
        "editor", "#!/bin/sh\nfor word; do printf '%s\\0' \"$word\" >> '" + log + "'; done\n");
    ::chmod(program.c_str(), 0755);
    for (const std::string &name : names) {
        fs::remove(log);
        CHECK(viewer::open_in_editor(program.string(), name, 7, 3) ==
              "opened " + for_terminal(name) + ":7");
        const std::string wanted = std::string("+7") + '\0' + here + name + '\0';
        for (int i = 0; i < 500 && folder.read("log") != wanted; ++i) ::usleep(10000);
        CHECK(folder.read("log") == wanted);
    }
    CHECK_FALSE(fs::exists(folder / "pwned"));
}

TEST_CASE("a param's value and a camera are written where they stand, and nowhere else") {
    const std::string text = "// a comment\nparam r = (1) in 0..2 // radius\r\nsphere(r)";
    CHECK(driver::with_param(text, "r", "1.5") ==
          "// a comment\nparam r = (1.5) in 0..2 // radius\r\nsphere(r)");
    CHECK_FALSE(driver::with_param(text, "s", "1"));
    CHECK(driver::with_camera(text, "camera(at: [1, 2, 3])") == text + "\ncamera(at: [1, 2, 3])\n");
    CHECK(driver::with_camera("camera(at: [0, 0, 9]) // mine\nbox(1)\n", "camera(at: [1, 2, 3])") ==
          "camera(at: [1, 2, 3]) // mine\nbox(1)\n");
    const std::vector<std::string> two{"camera(at: [0, 9, 0])", "camera(at: [9, 0, 0])"};
    const std::string with = driver::with_views("box(1)", two);
    CHECK(with == "box(1)\n// view 2: camera(at: [0, 9, 0])\n// view 3: camera(at: [9, 0, 0])\n");
    CHECK(driver::views_in(with) == two);
    CHECK(driver::with_views(with, {}) == "box(1)\n");
}

TEST_CASE("a value is written as the text writes it: hex stays hex, degrees degrees") {
    const auto written = [](const std::string &value, auto change) {
        const std::string text = "param p = " + value + "\nsphere(1)\n";
        driver::Compilation made = driver::compile_text("scene.sdf", text, "", {});
        INFO(value);
        REQUIRE(made.scene.params.size() == 1);
        ir::Param param = made.scene.params[0];
        change(param);
        return viewer::value_text(param, driver::notation_of_param(text, "p"));
    };
    const auto same = [](ir::Param &) {};
    for (const char *value :
         {"#d08030", "#000000", "#ffffff", "rgb(0.5, 0.25, 1)", "30deg", "-45deg", "0.25turn",
          "1.5", "[1, 2, 3]", "[30deg, 45deg, 90deg]", "true"})
        CHECK(written(value, same) == value);
    CHECK(written("#fff", same) == "#ffffff");
    CHECK(written("#d0803080", same) == "#d08030");
    CHECK(written("tomato", same).starts_with("rgb("));
    CHECK(written("1.5rad", same) == "1.5");
    const auto to = [](double x) { return [x](ir::Param &param) { param.value[0] = x; }; };
    CHECK(written("#d08030", to(1)) == "#ff8030");
    CHECK(written("#d08030", to(1.5)).starts_with("rgb(")); // brighter than hex can say
    CHECK(written("30deg", to(0.5235988f)) == "30deg");
    CHECK(written("30deg", to(1)) == "57.29578deg");
    CHECK(written("30deg", to(0)) == "0");
    // All values that eight bits a channel hold come back as they were.
    for (int channel = 0; channel < 256; ++channel) {
        const std::string value = fmt::format("#{0:02x}{0:02x}{0:02x}", channel);
        CHECK(written(value, same) == value);
    }
}

TEST_CASE("a text that is half written takes no camera") {
    CHECK(driver::can_be_read("box(1)\ncamera(at: [1, 2, 3])\n"));
    CHECK(driver::can_be_read("bxo(1)\n")); // a wrong name is in nobody's way
    CHECK_FALSE(driver::can_be_read("for i in 0..3 {\n  box(1)\n"));
    CHECK_FALSE(driver::can_be_read("sphere(1).translate([1,\n"));
    CHECK_FALSE(driver::can_be_read("/* box(1)\n"));
}

TEST_CASE("a save file is seen from a camera, and is a save file still") {
    const driver::Compilation scene = driver::compile_text(
        "scene.sdf",
        "smooth_union(0.2) { sphere(0.8).paint(#d08030); box(1).translate([1.2, 0, 0]) }\n"
        "camera(at: [0, 0, 6], look_at: [0, 0, 0])\n",
        "", {});
    REQUIRE(scene.good());
    Diagnostics diagnostics;
    const std::string yaml = save::export_yaml(scene.scene, diagnostics);
    const auto lines_that_differ = [&](const std::string &camera) {
        const auto made = driver::save_file_with_camera(yaml, camera, "", {});
        REQUIRE(std::holds_alternative<std::string>(made));
        std::istringstream a(yaml), b(std::get<std::string>(made));
        CHECK(std::count(yaml.begin(), yaml.end(), '\n') ==
              std::ranges::count(std::get<std::string>(made), '\n'));
        int differing = 0;
        for (std::string x, y; std::getline(a, x) && std::getline(b, y);) differing += x != y;
        return differing;
    };
    CHECK(lines_that_differ("camera(at: [0, 0, 6], look_at: [0, 0, 0], fov: 45deg)") == 0);
    CHECK(lines_that_differ("camera(at: [6, 0, 0], look_at: [0, 0, 0], fov: 45deg)") == 1);
    const auto broken = driver::save_file_with_camera("--- {", "camera(at: [6, 0, 0])", "", {});
    CHECK(std::holds_alternative<driver::EditError>(broken));
}

TEST_CASE("views share the window and each has its place") {
    viewer::Views views;
    viewer::show_views(views, 4);
    const auto tiles = viewer::tiles_of(views, 101, 80);
    REQUIRE(tiles.size() == 4);
    for (int y = 0; y < 80; ++y)
        for (int x = 0; x < 101; ++x) {
            int holders = 0;
            for (const gl::Tile &t : tiles)
                holders += x >= t.x && y >= t.y && x < t.x + t.width && y < t.y + t.height;
            const int at = viewer::tile_at(tiles, x, y);
            CHECK(holders == (at >= 0 ? 1 : 0));
        }
    CHECK(viewer::view_name(views.cameras[1]) == "top");
    CHECK(viewer::view_name(views.cameras[2]) == "front");
    CHECK(viewer::view_name(views.cameras[3]) == "right");
    viewer::orbit(views.cameras[3], 0.1, 0);
    CHECK(viewer::view_name(views.cameras[3]).empty());
}

TEST_CASE("frame times: the median, and what all but one in a hundred stay below") {
    viewer::FrameTimes times;
    CHECK(times.at_share(0.5) == 0);
    for (int i = 1; i <= 200; ++i) times.add(i);
    CHECK(times.at_share(0.5) == 100);
    CHECK(times.at_share(0.99) == 198);
    for (int i = 0; i < 500; ++i) times.add(7);
    CHECK(times.milliseconds.size() == viewer::FrameTimes::maximum);
    CHECK(times.at_share(0.99) == 7);
}
