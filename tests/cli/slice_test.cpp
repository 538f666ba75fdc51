// `fathom slice` as scripts see it.
#include "shell.h"

#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>

using Json = nlohmann::json;

TEST_CASE("slices are files of one frame, by number and suffix") {
    ScratchFolder folder;
    folder.write("ring.sdf", "param r = 1 in 0.5..2\ntorus(r, 0.3).rotate(90deg, axis: X)\n");
    const Result made = shell(folder, "fathom slice ring.sdf --z 0..0.3:0.1 -o layer_%04d.svg "
                                      "--resolution 64 --units mm --json");
    CHECK(made.exit == 0);
    CHECK(made.err.empty());
    const Json json = Json::parse(made.out);
    REQUIRE(json["slices"].size() == 3);
    std::string frame;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::string name = "layer_000" + std::to_string(k) + ".svg",
                          svg = folder.read(name.c_str());
        CHECK(json["slices"][k]["file"] == name);
        CHECK(json["slices"][k]["status"] == "certified");
        CHECK(json["slices"][k]["contours"] == 2);
        CHECK(contains(svg, "fill-rule=\"evenodd\""));
        const std::string head = svg.substr(0, svg.find("<title>"));
        if (k > 0) CHECK(head == frame);
        frame = head;
    }
    CHECK(contains(frame, "mm\""));
    CHECK(shell(folder, "fathom slice ring.sdf --z 0 -o a.dxf --resolution 32").exit == 0);
    CHECK(folder.read("a.dxf").starts_with("0\nSECTION\n"));
    CHECK(shell(folder, "fathom slice ring.sdf --y 0,0.2 -o b.png --resolution 32 --size 64x48")
              .exit == 0);
    CHECK((fs::exists(folder / "b_0000.png") && fs::exists(folder / "b_0001.png")));
    const Result one = shell(folder, "cat ring.sdf | fathom slice - --z 0.1 -o - --resolution 64");
    CHECK((one.exit == 0 && one.out.starts_with("<svg ")));
    // What the ends of a range are.
    const Json closed = Json::parse(
        shell(folder, "fathom slice ring.sdf --z 0..=0.3:0.1 -o l_##.svg --resolution 16 --json")
            .out);
    CHECK(closed["slices"].size() == 4);
}

TEST_CASE("a plane that misses the solid gives a file without contours, and says where it lies") {
    ScratchFolder folder;
    folder.write("ball.sdf", "sphere(1)\n");
    const Result made = shell(folder, "fathom slice ball.sdf --z 7 -o a.svg");
    CHECK(made.exit == 0);
    CHECK(contains(made.err, "no plane meets the solid, which lies from z = "));
    CHECK(contains(folder.read("a.svg"), "d=\"\""));
}

TEST_CASE("what cannot be sliced says why, and writes nothing") {
    ScratchFolder folder;
    folder.write("ground.sdf", "plane(Y, 0)\n");
    folder.write("nothing.sdf", "sphere(1) & sphere(1).translate(x: 5)\n");
    folder.write("ball.sdf", "sphere(1)\n");
    folder.write("wrong.sdf", "shpere(1)\n");
    fs::create_directory(folder / "d.svg");
    const auto fails = [&](const std::string &arguments, int exit, const std::string &words) {
        INFO(arguments);
        const Result made = shell(folder, "fathom slice " + arguments);
        CHECK(made.exit == exit);
        INFO(made.err);
        CHECK(contains(made.err, words));
        CHECK_FALSE(fs::exists(folder / "a.svg"));
    };
    fails("ground.sdf --y 0.5 -o a.svg", 1, "`--bounds X,Y,Z,X,Y,Z`");
    fails("nothing.sdf --z 0 -o a.svg", 1, "empty");
    fails("wrong.sdf --z 0 -o a.svg", 1, "unknown-name");
    fails("none.sdf --z 0 -o a.svg", 3, "none.sdf");
    fails("ball.sdf -o a.svg", 1, "`fathom slice --z 0` cuts solids");
    fails("- -o a.svg", 2, "read twice");
    fails("ball.sdf --x 0 --z 0 -o a.svg", 2, "one of --x, --y and --z");
    fails("ball.sdf --z 0..1 -o a.svg", 2, "wants a step");
    fails("ball.sdf --z 0..1:0 -o a.svg", 2, "wants heights");
    fails("ball.sdf --z nan -o a.svg", 2, "wants heights");
    fails("ball.sdf --z 0..1e9:1e-9 -o a.svg", 2, "100000");
    fails("ball.sdf --z 0, -o a.svg", 2, "wants heights");
    fails("ball.sdf --z 0 -o a.stl", 2, "`fathom mesh`");
    fails("ball.sdf --z 0 -o a.txt", 2, ".svg, .dxf or .png");
    fails("ball.sdf --z 0 -o none/a.svg", 3, "none");
    fails("ball.sdf --z 0 -o d.svg", 3, "is a directory");
    fails("ball.sdf --z 0 -o a.svg --size 8x8", 2, "of a PNG");
    fails("ball.sdf --z 0,1 -o -", 2, "takes one slice");
    CHECK(shell(folder, "fathom slice ground.sdf --y=-0.5 --bounds=-1,-1,-1,1,1,1 -o a.svg").exit ==
          0);
    CHECK(shell(folder, "fathom mesh ball.sdf -o b.svg").exit == 2);
}

TEST_CASE("what is said of planes without a contour is true, and areas lie in what is proved") {
    ScratchFolder folder;
    folder.write("ball.sdf", "sphere(1)\n");
    folder.write("seam.sdf", "box(1) | box(1).translate(x: 1)\n");
    const auto cut = [&](const std::string &arguments) {
        return shell(folder, "fathom slice " + arguments + " -o a.svg --json --resolution 32");
    };
    CHECK(contains(cut("ball.sdf --z 5").err, "no plane meets the solid, which lies from z = -1"));
    const std::string touched = cut("ball.sdf --z 1").err;
    CHECK(contains(touched, "no plane meets the solid, which lies from z = -1"));
    CHECK(contains(touched, "in an area that squares of a side of 0.0"));
    const Result seam = cut("seam.sdf --x 0.5");
    CHECK(seam.err.empty());
    CHECK(Json::parse(seam.out)["slices"][0]["status"] == "certified");
    // Corners of contours that a coarse lattice rounds off.
    folder.write("star.sdf", "for i in 0..5 { cone(0.3, 1).rotate(i * 72deg, axis: Z) }\n");
    for (const char *side : {"0.5", "0.3", "0.2"}) {
        const Result made = shell(folder, std::string("fathom slice star.sdf --z 0.01 -o a.svg "
                                                      "--json --tolerance ") +
                                              side);
        REQUIRE(made.exit == 0);
        const Json area = Json::parse(made.out)["slices"][0]["area"];
        INFO(area.dump());
        CHECK(area["least"] <= area["value"]);
        CHECK(area["value"] <= area["most"]);
    }
}

TEST_CASE("contours that may be pieces of one thin wall are told, and what shows it whole") {
    ScratchFolder folder;
    folder.write("ring.sdf", "ring(20, 19.9)\n");
    folder.write("slot.sdf", "(box([40, 20, 4]) - box([0.05, 30, 9]).rotate(30deg, axis: Z))\n");
    folder.write("dots.sdf", "for i in 0..9 { sphere(1).translate(x: 3 * i) }\n");
    const Result ring = shell(folder, "fathom slice ring.sdf -o ring.svg --json");
    CHECK(Json::parse(ring.out)["slices"][0]["contours"] > 50);
    CHECK(contains(ring.err, "contours are about as narrow as the squares"));
    CHECK(contains(ring.err, "a tolerance of 0.039 may show it whole"));
    const Result whole =
        shell(folder, "fathom slice ring.sdf -o ring.svg --json --tolerance 0.039");
    CHECK(Json::parse(whole.out)["slices"][0]["contours"] == 2);
    CHECK(whole.err.empty());
    const Result slot = shell(folder, "fathom slice slot.sdf --z 0,1 -o slot.svg");
    CHECK(contains(slot.err, "contours at 0 are about as narrow"));
    CHECK(shell(folder, "fathom slice dots.sdf --z 0 -o dots.svg --resolution 64").err.empty());
}

TEST_CASE("a scene of flat shapes is drawn without a height, as exactly as a slice") {
    ScratchFolder folder;
    folder.write("plate.sdf", "param r = 4 in 1..5\n"
                              "rectangle([40, 20]) - circle(r).translate(x: 10)\n"
                              "circle(3).translate(x: 40)\n");
    const Result made =
        shell(folder, "fathom slice plate.sdf -o plate.svg --units mm --json --tolerance 0.05");
    CHECK(made.err.empty());
    CHECK(made.exit == 0);
    CHECK(contains(made.out, "\"status\":\"certified\",\"contours\":3,"));
    // 800 - 16 pi + 9 pi
    const std::size_t at = made.out.find("\"value\":") + 8;
    CHECK(std::stod(made.out.substr(at)) == Approx(778.01).margin(0.1));
    CHECK(contains(folder.read("plate.svg"), "width=\"63."));
    CHECK(shell(folder, "fathom slice plate.sdf -D r=5 -o plate.dxf").exit == 0);
    CHECK(contains(folder.read("plate.dxf"), "POLYLINE"));
    CHECK(shell(folder, "fathom slice plate.sdf --part circle -o c.png --size 64x64").exit == 0);
    // A drawing has no height to be told of.
    folder.write("foil.sdf", "rectangle([10, 1e-4]).rotate(0.3)\ncircle(1)\n");
    const Result foil = shell(folder, "fathom slice foil.sdf -o foil.svg --resolution 16");
    CHECK(contains(foil.err, "may hold border"));
    CHECK_FALSE(contains(foil.err, "height"));
    // With a height, or to other commands, flat shapes are what they were.
    CHECK(contains(shell(folder, "fathom slice plate.sdf --z 0 -o a.svg").err, "flat-shape"));
    CHECK(contains(shell(folder, "fathom mesh plate.sdf -o a.stl").err, "flat-shape"));
    CHECK_FALSE((fs::exists(folder / "a.svg") || fs::exists(folder / "a.stl")));
    // The size of a drawing says nothing of how well it is drawn.
    folder.write("tiny.sdf", "rectangle([0.004, 0.002])\n");
    folder.write("large.sdf", "rectangle([4000, 2000])\n");
    for (const char *name : {"tiny", "large"}) {
        const Result drawn =
            shell(folder, std::string("fathom slice ") + name + ".sdf -o " + name + ".svg --json");
        INFO(drawn.out << drawn.err);
        CHECK(contains(drawn.out, "\"status\":\"certified\",\"contours\":1,"));
    }
}
