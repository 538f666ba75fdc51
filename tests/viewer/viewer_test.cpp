// The viewer for real: saves, keys and clicks, and pictures of the window compared.
// Long: one window, and what a user does to it.
#include "driver/compile.h"
#include "save-format/save_format.h"
#include "tests/viewer/window.h"

#include <algorithm>
#include <fmt/ranges.h>
#include <limits>
#include <sys/stat.h>

using namespace fathom;
using namespace fathom::viewer_test;

namespace {

const std::string camera = "camera(at: [0, 0, 6], look_at: [0, 0, 0])\n";

bool red(const std::array<float, 3> &p) { return p[0] > 2 * p[1]; }
bool blue(const std::array<float, 3> &p) { return p[2] > 2 * p[0]; }

// Milliseconds from the save of that file, by a line of --times.
double since_save(const std::string &line, const std::string &file) {
    INFO(line);
    REQUIRE(line.ends_with(" ms after the save of " + file));
    return std::stod(line.substr(line.find("on the screen ") + 14));
}

bool touched_driver(const std::string &line) { return line.find("driver untouched") == line.npos; }

} // namespace

TEST_CASE(
    "save and see; an error keeps the picture under its message; the next good save clears it") {
    Window window("import \"parts/a.sdf\"\nball()\n" + camera, {}, [](const ScratchFolder &f) {
        f.write("parts/a.sdf", "fn ball() -> shape = sphere(1).paint(red)\n");
    });
    const Picture first = window.picture();
    CHECK(first.width == 480);
    CHECK(red(pixel(first, 240, 160)));
    // Nothing was saved yet.
    CHECK(window.lines().back().ends_with("on the screen"));

    // An import that is saved is a save.
    window.folder.write("parts/a.sdf", "fn ball() -> shape = box(2).paint(blue)\n");
    REQUIRE(window.reloads(2));
    const Picture second = window.picture();
    CHECK(since_save(window.lines().back(), "a.sdf") < 30e3);
    CHECK(blue(pixel(second, 240, 160)));

    // An error: the picture stays, the message lies over its upper left.
    CHECK(window.reload("import \"parts/a.sdf\"\nbll()\n" + camera).find("error") !=
          std::string::npos);
    const Picture third = window.picture();
    CHECK(difference(second, third) > 0.01);
    CHECK(difference(second, third, 0.6) == 0);
    CHECK(blue(pixel(third, 240, 220)));

    // The fixed file, by an editor's atomic rename: the very picture of before.
    // What is moved into place may have been written long ago.
    const fs::path moved =
        window.folder.write("scene.tmp", "import \"parts/a.sdf\"\nball()\n" + camera);
    fs::last_write_time(moved, fs::file_time_type::clock::now() - std::chrono::hours(24 * 365));
    fs::rename(moved, window.folder / "scene.sdf");
    REQUIRE(window.reloads(4));
    CHECK(since_save(window.lines().back(), "scene.sdf") < 30e3);
    CHECK(difference(second, window.picture()) == 0);

    // The file goes, and comes back.
    fs::remove(window.folder / "scene.sdf");
    REQUIRE(window.reloads(5));
    CHECK(window.lines().back().find("error") != std::string::npos);
    CHECK(blue(pixel(window.picture(), 240, 220)));
    window.reload("import \"parts/a.sdf\"\nball()\n" + camera);
    CHECK(difference(second, window.picture()) == 0);
}

TEST_CASE("a number that was edited before, and a param, leave the driver alone; the picture is a "
          "cold start's") {
    const auto scene = [](const std::string &r, const std::string &p) {
        return "param lift = " + p + " in -1..1\n(sphere(" + r +
               ") | box(0.8).translate([0.9, lift, 0])).paint(orange)\n" + "camera(at: [" + r +
               ", 1, 6], look_at: [0, 0, 0])\n";
    };
    const Picture cold = cold_picture(scene("0.9", "-0.5"));
    Window window(scene("1", "0.25"));
    CHECK(touched_driver(window.lines().back()));
    CHECK(touched_driver(window.reload(scene("1.1", "0.25")))); // from here on it is data
    for (const char *r : {"1.2", "1.25", "0.9"})
        CHECK_FALSE(touched_driver(window.reload(scene(r, "0.25"))));
    CHECK_FALSE(touched_driver(window.reload(scene("0.9", "-0.5"))));
    CHECK(difference(window.picture(), cold, 0, 2.0f / 255) == 0); // the driver folds constants
}

// Its upper half is what is compared: what the window is at is told in one more line of the panel.
static Picture upper_half(Picture picture) {
    picture.height = picture.height / 2 + status_height;
    return picture;
}

TEST_CASE("what is steep is shown by one bound, and then by cells without another save") {
    const std::string steep =
        "import \"dfmodel\" as dfmodel\n"
        "dfmodel.blobby(10, size: [2, 2, 2], radius: 0.15, seed: 1).paint(red)\n";
    bool shows_both = false; // not where cells are found before the first frame of a busy machine
    for (int start = 0; start < 3 && !shows_both; ++start) {
        Window window(steep + camera);
        const Picture first = upper_half(window.picture());
        CHECK(pixel(first, 229, 150)[0] > 2 * pixel(first, 229, 150)[2]);
        shows_both = window.reloads(2);
        CHECK(window.lines().back().find("good") != std::string::npos);
        CHECK(difference(first, upper_half(window.picture()), 0, 0.02f) <
              0.01); // hits land a little elsewhere
    }
    CHECK(shows_both);
}

TEST_CASE("fifty saves in a burst: the newest wins, by two reloads at most after the last, as from "
          "a cold start") {
    const auto text = [&](int i) {
        return fmt::format("sphere({}){}{}", 1 + i * 0.01,
                           (i % 2 ? ".paint(blue)\n" : ".paint(red)\n"), camera);
    };
    const Picture wanted = cold_picture(text(49));
    Window window("sphere(1)\n" + camera);
    for (int i = 0; i < 50; ++i) {
        window.save(text(i));
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    const std::size_t before = window.lines().size();
    std::size_t after = 0;
    CHECK(waited([&] { // numbers are uniforms in one and constants in the other: up to rounding
        after = window.lines().size();
        return difference(window.picture(), wanted, 0, 0.01f) == 0;
    }));
    CHECK(after <= before + 2);
}

TEST_CASE("no save of a hundred is missed, and memory stays flat") {
    Window window("sphere(1)\n" + camera);
    const auto resident = [&] {
        std::ifstream in(fmt::format("/proc/{}/status", window.process().id()));
        for (std::string line; std::getline(in, line);)
            if (line.starts_with("VmRSS:")) return std::stol(line.substr(6));
        return 0L;
    };
    int saves = 0, missed = 0;
    const auto reloaded = [&](int times) { // the least resident memory while they go on
        long least = std::numeric_limits<long>::max();
        for (int i = 0; i < times; ++i) {
            // Every tenth save is another shader, so programs come and go.
            ++saves;
            const std::string shape = saves % 10   ? "sphere("
                                      : saves % 20 ? "box("
                                                   : "torus(major: 1, minor: ";
            const std::size_t before = window.lines().size();
            window.save(fmt::format("{}{}).paint(orange)\n{}", shape, 0.5 + saves * 0.001, camera));
            missed += !window.reloads(before + 1);
            least = std::min(least, resident());
        }
        return least;
    };
    // What allocator and driver keep comes and goes in steps of 10 to 40 MB. A leak grows for ever:
    // so one stretch of sixty saves that adds little shows that there is none.
    std::vector<long> memory{reloaded(40)};
    bool flat = false;
    while (!flat && memory.size() < 5) {
        reloaded(40);
        memory.push_back(reloaded(20));
        flat = memory.back() - memory[memory.size() - 2] < 16 * 1024;
    }
    CHECK(saves >= 100);
    CHECK(missed == 0);
    INFO("resident after 40 saves, and after 60 more each, in KB: "
         << fmt::format("{}", fmt::join(memory, ", ")));
    CHECK(flat);
}

TEST_CASE(
    "what three sliders make steep is marched by the bound of the values that they stand on") {
    const auto text = [](const std::string &a) {
        return "param a = " + a +
               " in 0..20\nparam b = 1 in 0..20\nparam c = 0.3 in 0..1\n"
               "sphere(2).displace(p => a * c * sin(b * p.x) * cos(b * p.y)).paint(red)\n" +
               camera;
    };
    const Picture cold = cold_picture(text("2.2"));
    Window window(text("0.2"));
    const auto bounds = [&] { // that were proved so far
        std::istringstream in(window.folder.read("errors.txt"));
        std::vector<double> result;
        for (std::string line; std::getline(in, line);)
            if (line.starts_with("bound: ")) result.push_back(std::stod(line.substr(7)));
        return result;
    };
    REQUIRE(waited([&] { return bounds().size() == 1; }));
    CHECK(bounds().back() < 1.2);
    window.key("shift+period"); // a tenth of the range
    REQUIRE(waited([&] { return bounds().size() == 2; }));
    CHECK(bounds().back() > 1.6);
    CHECK(bounds().back() < 2.4);
    CHECK(window.lines().size() == 1);                                  // nothing was compiled
    CHECK(difference(window.picture(), cold, 0.4, 2.0f / 255) < 0.001); // below the sliders
    window.reload(text("0"));
    REQUIRE(waited([&] { return bounds().size() >= 3; }));
    CHECK(bounds().back() == 1);
}

TEST_CASE("sliders: by keys and by the mouse; the value goes into the text, and back") {
    const std::string text =
        "param size = 1 in 0.5..2\nparam round = false\nsphere(size).paint(red)\n" + camera;
    const std::string written =
        "param size = 1.15 in 0.5..2\nparam round = false\nsphere(size).paint(red)\n" + camera;
    const Picture cold = cold_picture(written);
    Window window(text);
    const Picture first = window.picture();
    window.key("shift+period"); // a tenth of the range
    const Picture larger = window.picture();
    CHECK(difference(first, larger, 0, 0.02f) > 0.01);
    CHECK(window.lines().size() == 1); // nothing was compiled
    window.key("i");
    REQUIRE(window.reloads(2));
    CHECK(window.folder.read("scene.sdf") == written);
    CHECK_FALSE(touched_driver(window.lines().back()));
    window.key("Escape"); // the note of the writing
    CHECK(difference(window.picture(), cold) == 0);

    // The slider of the first param, dragged to its right end: 2.
    const Picture before = window.picture();
    window.hands("mousemove 210 44 mousedown 1");
    window.hands("mousemove 479 44");
    window.hands("mouseup 1");
    CHECK(difference(before, window.picture(), 0, 0.02f) > 0.02);
    window.key("BackSpace");
    CHECK(difference(before, window.picture(), 0.35) == 0);
}

TEST_CASE("a slider stays under the mouse when its value begins to differ from the text's") {
    Window window("param size = 1 in 0.5..2\nsphere(size).paint(red)\n" + camera);
    const auto panel_begins = [&] { // its title is black, far darker than the sky
        const Picture picture = window.picture();
        int x = 0;
        while (x < picture.width && pixel(picture, x, 20)[2] > 0.1f) ++x;
        return x;
    };
    const int begin = panel_begins();
    CHECK(begin > 50);
    CHECK(begin < 300);
    window.key("period");
    CHECK(panel_begins() == begin);
    window.key("BackSpace");
    window.hands("mousemove 300 44 mousedown 1"); // its value differs from here on
    for (int x : {301, 302, 301, 300}) window.hands(fmt::format("mousemove {} 44", x));
    window.hands("mouseup 1");
    window.key("i"); // what it holds goes into the text
    REQUIRE(window.reloads(2));
    const std::string text = window.folder.read("scene.sdf");
    const double size = std::stod(text.substr(text.find("= ") + 2));
    INFO(text);
    CHECK(size > 0.5);
    CHECK(size < 1.95); // not run away to either end
    // Pressed again in the same place, it holds the same: that is where its handle stands.
    const Picture before = window.picture();
    window.hands("mousemove 300 44 mousedown 1");
    window.hands("mouseup 1");
    CHECK(difference(window.picture(), before, 0.35, 0.02f) == 0);
}

TEST_CASE("Escape closes what lies on top, and only then selects nothing") {
    Window window("param tint = #d08030\nsphere(1).paint(tint)\n" + camera);
    window.hands("mousemove 100 200"); // beside the shape: nothing is named there
    const Picture bare = window.picture();
    window.hands("mousemove 240 220 click 1");
    const Picture selected = window.picture();
    CHECK(outlined(selected, 0, 480) > 100);
    window.hands("mousemove 230 44 click 3"); // the menu of the param
    const Picture menu = window.picture();
    CHECK(difference(menu, selected) > 0.05);
    window.key("Escape");
    CHECK(difference(window.picture(), selected) < 0.04); // its words move with the note below
    window.key("question");
    CHECK(difference(window.picture(), selected) > 0.1);
    window.key("Escape");
    CHECK(outlined(window.picture(), 0, 480) > 100);
    window.key("Escape");
    CHECK(outlined(window.picture(), 0, 480) == 0);
    CHECK(difference(window.picture(), bare, 0.3) == 0);
}

TEST_CASE("what was done is told for some seconds, then no more") {
    Window window("param size = 1 in 0.5..2\nsphere(size)\n" + camera);
    const auto status_rows = [](const Picture &picture) { // it darkens what it lies on
        const int x = picture.width - 2;
        const float sky = pixel(picture, x, picture.height / 2)[2];
        int rows = 0;
        while (pixel(picture, x, picture.height - 4 - rows)[2] < sky / 2) ++rows;
        return rows;
    };
    const Picture bare = window.picture();
    std::this_thread::sleep_for(std::chrono::seconds(8)); // so "saved …" has gone
    window.key("y");
    const Picture told = window.picture(); // "copied 1"
    CHECK(status_rows(told) > status_rows(bare));
    std::this_thread::sleep_for(std::chrono::seconds(8));
    CHECK(status_rows(window.picture()) == status_rows(bare));
}

TEST_CASE("the view of a save file is written as YAML, and the file stays one") {
    const driver::Compilation scene = driver::compile_text(
        "scene.sdf",
        "sun(direction: [1, 2, 3])\nsphere(1).paint(red) | box(1).translate([1, 0, 0])\n" + camera,
        "", {});
    Diagnostics diagnostics;
    const std::string yaml = save::export_yaml(scene.scene, diagnostics);
    Window window(yaml, {}, {}, "scene.yaml");
    window.key("3"); // from the right
    const Picture right = window.picture();
    window.key("ctrl+s");
    REQUIRE(window.reloads(2));
    CHECK(window.lines().back().find("good") != std::string::npos);
    const std::string saved = window.folder.read("scene.yaml");
    CHECK(saved != yaml);
    CHECK(saved.find("camera(") == std::string::npos);
    CHECK(saved.find("- [0, 0, 0, 90, 0, 6,") != std::string::npos);
    window.key("r"); // the file's own camera now
    CHECK(difference(window.picture(), right, 0, 0.02f) < 0.002);
}

TEST_CASE("a picture that takes its time is on the screen coarsely at once, and events are heard") {
    // Instances seconds of a software driver.
    const std::string heavy =
        "let bumps = p => 0.1 * fbm(3 * p, octaves: 6)\n"
        "for i in 0..4 { sphere(1).displace(bumps).translate([1.5 * i - 2, 0, 0]).paint(orange) }\n"
        "box([40, 0.1, 40]).translate([0, -1.5, 0])\n" +
        camera;
    Window window(heavy, {"--size", "1000x700"}); // its reload was told
    CHECK(Display::need().colors(400, 500) > 30); // and something is seen of it
    // Its keys work while it is drawn: it closes at once.
    window.key("ctrl+q");
    CHECK(window.process().exit_status() == 0);
}

TEST_CASE("a click names the shape, outlines it and opens its line") {
    Window *opened = nullptr;
    Display::need();
    ScratchFolder tools;
    const fs::path editor =
        tools.write("editor", "#!/bin/sh\necho \"$@\" >> " + (tools / "log").string() + "\n");
    ::chmod(editor.c_str(), 0755);
    ::setenv("EDITOR", editor.c_str(), 1);
    Window window(
        "let a = sphere(1)\na.translate([-1.5, 0, 0])\nbox(1.5)\n  .translate([1.5, 0, 0])\n" +
        camera);
    ::unsetenv("EDITOR");
    opened = &window;
    CHECK(outlined(opened->picture(), 0, 480) == 0);
    const std::string scene = (window.folder / "scene.sdf").string();
    const Picture bare = window.picture();
    window.hands("mousemove 340 160");
    const Picture hovering =
        window.picture(false); // named beside the mouse, with a pale line round it
    CHECK(difference(bare, hovering) > 0.02);
    CHECK(outlined(hovering, 0, 480) == 0);
    window.hands("click 1");
    const Picture right = window.picture();
    CHECK(outlined(right, 0, 240) == 0);
    CHECK(outlined(right, 240, 480) > 100);
    REQUIRE(waited([&] { return fs::exists(tools / "log"); }));
    CHECK(waited([&] { return tools.read("log") == "+3 " + scene + "\n"; }));
    window.hands("mousemove 150 160");
    window.hands("click 1");
    const Picture left = window.picture();
    CHECK(outlined(left, 0, 240) > 100);
    CHECK(outlined(left, 240, 480) == 0);
    CHECK(waited([&] { return tools.read("log") == "+3 " + scene + "\n+2 " + scene + "\n"; }));
    // The selection survives a reload that moves its line.
    window.reload(
        "\nlet a = sphere(1)\na.translate([-1.5, 0, 0])\nbox(1.5)\n  .translate([1.5, 0, 0])\n" +
        camera);
    const Picture again = window.picture();
    CHECK(outlined(again, 0, 240) > 100);
    CHECK(outlined(again, 240, 480) == 0);
    window.key("z"); // framed, it fills the window
    const Picture framed = window.picture();
    CHECK(outlined(framed, 120, 360) > 100);
    window.key("Escape");
    CHECK(outlined(window.picture(), 0, 480) == 0);
}

TEST_CASE("views: from the front as a camera there, four at once, and written into the scene") {
    const std::string parts = "sun(direction: [1, 2, 3])\n(sphere(1) | box(0.6).translate([1.2, "
                              "0.4, 0.8])).paint(orange)\n";
    const Picture cold =
        cold_picture(parts + "camera(at: [0, 0, 7.0710678], look_at: [0, 0, 0], fov: 40deg)\n");
    std::string text;
    Picture four;
    {
        Window window(parts + "camera(at: [3, 4, 5], look_at: [0, 0, 0], fov: 40deg)\n");
        const Picture scene_view = window.picture();
        window.key("1");
        const Picture front = window.picture();
        CHECK(difference(front, cold, 0, 0.02f) < 0.002);
        window.key("r");
        CHECK(difference(window.picture(), scene_view, 0, 0.004f) == 0);
        for (const char *there_and_back :
             {"5 5", "equal minus", "r r"}) { // orthographic, nearer, the scene's own
            const std::string keys = there_and_back;
            window.key(keys.substr(0, keys.find(' ')));
            const Picture there = window.picture();
            CHECK((difference(there, scene_view, 0, 0.02f) > 0.005) == (keys != "r r"));
            window.key(keys.substr(keys.find(' ') + 1));
            CHECK(difference(window.picture(), scene_view, 0, 0.02f) < 0.002);
        }
        window.hands("keydown w");
        window.hands("keyup w"); // it flew
        CHECK(difference(window.picture(), scene_view, 0, 0.02f) > 0.002);
        window.key("r");
        window.key("v");
        window.key("v");
        four = window.picture();
        CHECK(difference(four, scene_view) > 0.1);
        const auto background = pixel(four, 5, 60);
        for (auto [x, y] : {std::pair{119, 79}, {360, 79}, {119, 238}, {360, 238}})
            CHECK(std::abs(pixel(four, x, y)[2] - background[2]) >
                  0.1); // something stands in each tile
        window.key("ctrl+s");
        REQUIRE(window.reloads(2));
        text = window.folder.read("scene.sdf");
        CHECK(
            text.find(
                "camera(at: [3, 4, 5], look_at: [0, 0, 0], fov: 40deg)\n// view 2: camera(at: [") !=
            text.npos);
        CHECK(text.find("orthographic: true)\n// view 4:") != text.npos);
    }
    CHECK(difference(cold_picture(text), four, 0, 0.02f) < 0.002);
}

TEST_CASE("the window's size, and how it is coloured, change nothing that stays") {
    const std::string text =
        "(sphere(1) | box(0.8).translate([1.2, 0, 0])).paint(orange)\n" + camera;
    const Picture cold = cold_picture(text, {"--size", "640x400"});
    Window window(text);
    const Picture first = window.picture();
    window.hands("search --name scene.sdf windowsize 640 400");
    CHECK(waited([&] { return window.picture().width == 640; }));
    CHECK(difference(window.picture(), cold) == 0);
    window.hands("search --name scene.sdf windowsize 480 320");
    CHECK(waited([&] { return window.picture().width == 480; }));
    CHECK(difference(window.picture(), first) == 0);
    for (const char *key : {"h", "b", "l", "k", "question", "g"}) {
        INFO(key);
        window.key(key);
        const Picture other = window.picture();
        CHECK(difference(other, first) > 0.02);
        window.key(key);
        CHECK(difference(window.picture(), first) == 0);
    }
}

TEST_CASE("without a context to share the driver works on the window's thread, and the pictures "
          "are the same") {
    const auto scene = [](const char *r) {
        return "sphere(" + std::string(r) + ").paint(orange)\n" + camera;
    };
    const Picture cold = cold_picture(scene("1.3"));
    Window window(scene("1"), {"--one-context"});
    CHECK(touched_driver(window.reload(scene("1.1"))));
    CHECK_FALSE(touched_driver(window.reload(scene("1.3"))));
    CHECK(difference(window.picture(), cold) == 0);
    CHECK(touched_driver(window.reload("box(1)\n" + camera)));
    CHECK(difference(window.picture(), cold) > 0.01);
}

TEST_CASE(
    "with --save-view the camera is in the file when the window closes; frames are numbered") {
    Window window("sphere(1)\nbox(1).translate([time, 0, 0])\n" + camera, {"--save-view"});
    window.key("3");
    window.key("m");
    window.key("space"); // time passes
    CHECK(waited([&] { return fs::exists(window.folder / "scene-frames/00004.png"); }));
    window.key("m");
    window.key("ctrl+q");
    CHECK(window.process().exit_status() == 0);
    CHECK(window.folder.read("scene.sdf") ==
          "sphere(1)\nbox(1).translate([time, 0, 0])\ncamera(at: [6, 0, 0], look_at: [0, 0, 0], "
          "fov: 45deg)\n");
}

TEST_CASE("no frame is blank while the driver works on the next shader") {
    Window window("sphere(1).rotate(time, axis: Y).paint(red)\n" + camera);
    window.key("m"); // every frame is kept
    window.key("space");
    for (int i = 0; i < 8; ++i) {
        const std::string shape = i % 2 ? "box(" : "torus(major: 0.2, minor: ";
        window.reload(fmt::format("{}{}).rotate(time, axis: Y).paint(red)\n{}", shape,
                                  1.5 + 0.01 * i, camera));
    }
    window.key("m");
    int frames = 0, blank = 0;
    for (const fs::directory_entry &entry :
         fs::directory_iterator(window.folder / "scene-frames")) {
        if (entry.path().extension() != ".png") continue; // one that is being written
        std::string error;
        const auto frame = fathom::test::decoded_image(
            window.folder.read("scene-frames/" + entry.path().filename().string()), error);
        REQUIRE(frame);
        ++frames;
        blank += !red(pixel(*frame, frame->width / 2, frame->height / 2));
    }
    CHECK(frames > 8);
    CHECK(blank == 0);
}

TEST_CASE("the noise cache's view learns until nothing is red, and the panel tells of it") {
    Window window("let bumps = cached(p => 0.1 * fbm(3 * p, octaves: 6), cell: 0.05)\n"
                  "sphere(1).displace(bumps).paint(white)\n" +
                      camera,
                  {"--size", "160x160"});
    const Picture exact = window.picture();
    const auto reds = [](const Picture &picture) {
        int count = 0;
        for (int y = 0; y < picture.height / 2; ++y)
            for (int x = 0; x < picture.width; ++x) count += red(pixel(picture, x, y));
        return count;
    };
    CHECK(reds(exact) == 0);
    window.key("2");
    CHECK(waited([&] { return reds(window.picture()) == 0; })); // which ones: test_cache
    window.key("g");
    const Picture with_panel = window.picture();
    window.key("2");
    window.key("Escape");
    CHECK(reds(window.picture()) == 0);
    CHECK(difference(with_panel, exact) > 0.1);
}

TEST_CASE("moved through the noise cache, it comes to rest exactly") {
    // Cells so coarse that cached values show.
    const std::string text =
        "let bumps = cached(p => 0.15 * fbm(2.5 * p, octaves: 6), cell: 0.25)\n"
        "sphere(1).displace(bumps).paint(white)\n" +
        camera;
    const Picture cold = cold_picture(text);
    Window window(text);
    CHECK(difference(window.picture(), cold) == 0);
    window.key("2"); // once the cache is there, and has learnt
    CHECK(waited([&] { return difference(window.picture(), cold, 0, 0.02f) > 0.02; }));
    window.key("2");
    window.key("Escape");
    CHECK(difference(window.picture(), cold) == 0); // as if there were none
    // Moved there and back, while the cache is in use: the exact picture again.
    const auto moved = [&] {
        return window.folder.read("errors.txt").find("frames through the noise cache") !=
               std::string::npos;
    };
    CHECK_FALSE(moved());
    CHECK(waited([&] {
        window.hands("mousemove 240 60 mousedown 1 mousemove 270 60 mousemove 250 60 mouseup 1");
        std::this_thread::sleep_for(std::chrono::milliseconds(900)); // at rest it is told
        return moved();
    }));
    window.key("r");
    window.key("Escape");
    CHECK(difference(window.picture(), cold, 0, 0.004f) == 0);
}

TEST_CASE("a driver without images draws exactly, and says so") {
    ::setenv("MESA_GL_VERSION_OVERRIDE", "4.1FC", 1);
    ::setenv("MESA_EXTENSION_OVERRIDE", "-GL_ARB_shader_image_load_store", 1);
    const std::string text = "let bumps = cached(p => 0.1 * fbm(3 * p, octaves: 6), cell: 0.05)\n"
                             "sphere(1).displace(bumps).paint(white)\n" +
                             camera;
    {
        Window window(text);
        const Picture exact = window.picture();
        window.key("2"); // its word stands in the status line
        const Picture told = window.picture();
        CHECK(difference(exact, told, 0, 0.02f) == 0);
        bool words = false;
        for (int y = told.height - status_height; y < told.height; ++y)
            for (int x = 0; x < told.width; ++x) words |= pixel(exact, x, y) != pixel(told, x, y);
        CHECK(words);
        window.hands("mousemove 240 160 mousedown 1 mousemove 270 160 mousemove 240 160 mouseup 1");
        CHECK(window.process().runs());
    }
    ::unsetenv("MESA_GL_VERSION_OVERRIDE");
    ::unsetenv("MESA_EXTENSION_OVERRIDE");
}

TEST_CASE("a still scene costs less than a hundredth of a core") {
    Window window("sphere(1).paint(orange)\n" + camera);
    window.picture();
    const auto ticks = [&] { // processor time, in hundredths of a second
        std::ifstream in(fmt::format("/proc/{}/stat", window.process().id()));
        std::string word;
        long used = 0;
        for (int i = 1; i <= 15 && in >> word; ++i)
            if (i >= 14) used += std::stol(word);
        return used;
    };
    std::this_thread::sleep_for(std::chrono::milliseconds(500)); // it comes to rest
    const long before = ticks();
    std::this_thread::sleep_for(std::chrono::seconds(4));
    CHECK(ticks() - before <= 4);
}

TEST_CASE("a file that does not exist yet is waited for") {
    Display::need();
    ScratchFolder folder;
    Process process({FATHOM_PROGRAM, "view", "new.sdf", "--times", "--still", "--size", "320x240"},
                    {-1, folder / "errors.txt", folder.path()});
    const auto told = [&](const std::string &words) {
        return waited([&] {
                   return folder.read("errors.txt").find(words) != std::string::npos ||
                          !process.runs();
               }) &&
               process.runs();
    };
    REQUIRE(told("there is no `new.sdf` yet; the window waits for it"));
    REQUIRE(told("reload: error"));
    folder.write("new.sdf", "sphere(1)\n");
    REQUIRE(told("reload: good"));
    CHECK(told("after the save of new.sdf"));
}

TEST_CASE("what stands in the way is said in a sentence") {
    Display::need();
    ScratchFolder folder;
    folder.write("scene.sdf", "sphere(1)\n");
    const auto said = [&](std::vector<std::string> options, const char *display) {
        const std::string kept = std::getenv("DISPLAY");
        if (*display)
            ::setenv("DISPLAY", display, 1);
        else
            ::unsetenv("DISPLAY");
        std::vector<std::string> words{FATHOM_PROGRAM, "view", "scene.sdf"};
        words.insert(words.end(), options.begin(), options.end());
        fs::remove(folder / "errors.txt");
        Process process(words, {-1, folder / "errors.txt", folder.path()});
        ::setenv("DISPLAY", kept.c_str(), 1);
        CHECK(process.exit_status() == 3);
        return folder.read("errors.txt");
    };
    CHECK(said({}, "").find("there is no display to open a window on") != std::string::npos);
    CHECK(said({}, ":987").find("no window can be opened") != std::string::npos);
    CHECK(said({"--record", "/proc/pictures"}, std::getenv("DISPLAY"))
              .find("cannot make the folder /proc/pictures") != std::string::npos);
}
