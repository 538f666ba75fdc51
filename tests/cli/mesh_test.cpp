// `fathom mesh` as scripts see it: files by suffix, exit statuses, and what is left behind.
#include "shell.h"

#include <catch2/catch.hpp>

#include <cstring>

// Specks that are smaller than any cell, in no wall.
static const char *const dust = "sphere(0.0001).repeat([0.05, 0.05, 0.05]).within(ball(1))\n";

TEST_CASE("a mesh is written in the format of its suffix") {
    ScratchFolder folder;
    folder.write("ring.sdf", "param r = 1 in 0.5..2\ntorus(r, 0.3)\n");
    for (const char *name : {"a.stl", "a.obj", "a.ply", "a.glb", "a.3mf", "a.STL"}) {
        INFO(name);
        const Result made =
            shell(folder, std::string("fathom mesh ring.sdf --resolution 12 -o ") + name);
        CHECK(made.exit == 0);
        CHECK(made.err.empty());
        CHECK(made.out.empty());
    }
    CHECK(folder.read("a.obj").starts_with("# by Fathom\nmtllib a.mtl\no ring\nv "));
    CHECK(contains(folder.read("a.mtl"), "newmtl unpainted\n"));
    CHECK(folder.read("a.ply").starts_with("ply\n"));
    CHECK(folder.read("a.glb").starts_with("glTF"));
    CHECK(folder.read("a.3mf").starts_with("PK"));
    const std::string stl = folder.read("a.stl");
    CHECK(stl == folder.read("a.STL"));
    std::uint32_t triangles = 0;
    REQUIRE(stl.size() > 84);
    std::memcpy(&triangles, stl.data() + 80, 4);
    CHECK(stl.size() == 84 + 50 * std::size_t{triangles});
    CHECK(shell(folder, "fathom mesh ring.sdf --resolution 12 -o -").out == stl);
    CHECK(shell(folder, "cat ring.sdf | fathom mesh - --resolution 12 -o -").out == stl);
    CHECK(shell(folder, "fathom mesh ring.sdf -D r=2 --resolution 12 -o -").out != stl);
    const Result finer = shell(folder, "fathom mesh ring.sdf --tolerance 0.1 -o -");
    CHECK((finer.exit == 0 && finer.out.size() > stl.size()));
}

TEST_CASE(
    "lengths may have a unit: what --units says a length of 1 is, mm unless said, m of a .glb") {
    ScratchFolder folder;
    folder.write("ring.sdf", "torus(1, 0.3)\n");
    const auto stl = [&](const std::string &options) {
        const Result made = shell(folder, "fathom mesh ring.sdf -o a.stl " + options);
        CHECK((made.exit == 0 && made.err.empty()));
        return folder.read("a.stl");
    };
    const std::string scene_s = stl("--tolerance 0.125");
    CHECK(stl("--tolerance 0.125mm") == scene_s);
    CHECK(stl("--tolerance 0.0125cm --units mm") == scene_s);
    CHECK(stl("--tolerance 3.175mm --units in") == scene_s);
    CHECK(stl("--tolerance 0.125in --units in --simplify 0.5in") ==
          stl("--tolerance 0.125 --simplify 0.5"));
    CHECK(stl("--tolerance 0.25mm") != scene_s);
    CHECK(shell(folder, "fathom mesh ring.sdf -o a.glb --tolerance 125mm").exit == 0);
    CHECK(shell(folder, "fathom mesh ring.sdf -o b.glb --tolerance 0.125").exit == 0);
    CHECK(folder.read("a.glb") == folder.read("b.glb"));
    CHECK(shell(folder, "fathom volume ring.sdf -o a.npy --voxel 0.2mm").exit == 0);
    CHECK(shell(folder, "fathom volume ring.sdf -o b.npy --voxel 0.2").exit == 0);
    CHECK(folder.read("a.npy") == folder.read("b.npy"));
    CHECK(shell(folder, "fathom slice ring.sdf --y 0 -o a.svg --tolerance 2cm --units m").exit ==
          0);
    CHECK(shell(folder, "fathom slice ring.sdf --y 0 -o b.svg --tolerance 0.02 --units m").exit ==
          0);
    CHECK(folder.read("a.svg") == folder.read("b.svg"));
    CHECK(shell(folder, "fathom measure ring.sdf --units in --tolerance 2.54mm").out ==
          shell(folder, "fathom measure ring.sdf --units in --tolerance 0.1").out);
}

TEST_CASE("--json prints the certificate, and says partial where something is undecided") {
    ScratchFolder folder;
    folder.write("ball.sdf", "sphere(1)\n");
    const Result made = shell(folder, "fathom mesh ball.sdf --resolution 20 --json -o a.stl");
    CHECK(made.exit == 0);
    CHECK(made.err.empty());
    for (const char *part : {"{\"status\":\"certified\",", "\"watertight\":true",
                             "\"mesh_genus\":0", "\"mesh_components\":1", "\"undecided_cells\":0",
                             "\"rests_on\":[\"intervals\",\"single-precision\",\"bound\"]"})
        CHECK(contains(made.out, part));
    CHECK(fs::exists(folder / "a.stl"));
    folder.write("dust.sdf", dust);
    const Result specks = shell(folder, "fathom mesh dust.sdf --resolution 24 --json -o a.stl");
    CHECK(specks.exit == 0);
    CHECK(contains(specks.out, "{\"status\":\"partial\","));
    CHECK(contains(specks.out, "\"mesh_to_surface\":null"));
    CHECK(contains(specks.err, "cells may hold surface"));
    // thinner than any cell, over a large area: drawn as if it were wider
    folder.write("slit.sdf", "box(1) - box([2, 0.00001, 2])\n");
    const Result slit = shell(folder, "fathom mesh slit.sdf --resolution 24 --json -o a.stl");
    CHECK(contains(slit.out, "{\"status\":\"certified\","));
    CHECK(contains(slit.out, "\"mesh_components\":2"));
    CHECK(contains(slit.err, "gaps thinner than cells are drawn by the solid shrunk by 0.0"));
    CHECK(shell(folder, "fathom mesh ball.sdf --json -o -").exit == 2);
}

TEST_CASE("what is too fine or too coarse says what would do, and soon") {
    ScratchFolder folder;
    folder.write("ball.sdf", "sphere(1)\n");
    const Result fine = shell(folder, "fathom mesh ball.sdf --resolution 8000 -o a.stl");
    CHECK(fine.exit == 2);
    CHECK(contains(fine.err, "that is too fine, and takes too many cells: a tolerance of 0.0"));
    CHECK(contains(fine.err, "may do, or a resolution of "));
    for (const char *command : {"mesh ball.sdf -o a.stl", "measure ball.sdf"})
        for (const char *tolerance : {"1e3", "1e6", "1e20"}) {
            const Result coarse =
                shell(folder, std::string("fathom ") + command + " --tolerance " + tolerance);
            INFO(command << " " << tolerance);
            CHECK(coarse.exit == 2);
            CHECK(contains(coarse.err, "are larger than the solid, which is 2 long: take a "
                                       "tolerance of 0.02, for instance"));
        }
}

TEST_CASE("a mesh whose end is not found by the work that is spent says so, and what to write") {
    ScratchFolder folder;
    folder.write(
        "copies.sdf",
        "stairs_intersection(0.236, 4) {\n"
        "  tubes([[-0.442, -0.489, -0.806], [0.205, 0.167, 0.301], [-0.626, 0.22, -0.666]], "
        "0.111)\n  octahedron(0.516).translate([-0.0482, 0.32, 0.0235])\n"
        "}.repeat_mirror([0, 2.89, 0])\n");
    const Result made = shell(folder, "fathom mesh copies.sdf --resolution 15 -o a.stl");
    CHECK(made.exit != 0);
    CHECK(contains(made.err,
                   "no mesh: where the solid ends was not found by the work that is spent "
                   "on it: say it by bounds, or in the scene, as with `& box(10)`; here "
                   "`--bounds X,Y,Z,X,Y,Z` does it"));
    const Result cut =
        shell(folder, "fathom mesh copies.sdf --resolution 15 --bounds=-1,-1,-1,1,1,1 -o a.stl");
    CHECK(cut.exit == 0);
}

TEST_CASE("--certify says whether anything is proved, with a document and without one") {
    ScratchFolder folder;
    folder.write("ball.sdf", "sphere(1)\n");
    const std::string make = "fathom mesh ball.sdf --resolution 20 -o a.stl ";
    CHECK(shell(folder, make).err.empty());
    const Result on = shell(folder, make + "--certify on");
    CHECK((on.exit == 0 && on.out.empty()));
    for (const char *part : {"a.stl: certified: all of the mesh lies within 0.",
                             "; the solid's surface is in one piece and 0 handles; the solid's "
                             "volume lies between "})
        CHECK(contains(on.err, part));
    // Where pieces and handles are not proved it is said why, and what of it is proved.
    folder.write("cone.sdf", "cone(0.6, 1)\n");
    const std::string cone = "fathom mesh cone.sdf --resolution 48 -o a.stl ";
    const Result line = shell(folder, cone + "--certify on");
    for (const char *part :
         {"a.stl: certified, but for pieces and handles: all of the mesh lies within 0.",
          "; whether pieces nearer than that are apart, and narrower holes open, "
          "is not proved: how fast the field changes near [",
          "] is not known, by a root of what may be 0 (`sqrt`; cones, frames and "
          "polygons take one): what is made without that is proved alone"})
        CHECK(contains(line.err, part));
    const Result document = shell(folder, cone + "--json");
    for (const char *part :
         {"{\"status\":\"certified\",\"proved\":[\"distances\"", "\"components\":null",
          "\"doubted\":false,\"why\":\"how fast the field changes near ["})
        CHECK(contains(document.out, part));
    const Result off = shell(folder, make + "--json --certify off");
    CHECK((off.exit == 0 && off.err.empty()));
    for (const char *part : {"{\"status\":\"unproved\",", "\"mesh_components\":1",
                             "\"mesh_genus\":0", "\"mesh_area\":12.", "\"undecided_cells\":0"})
        CHECK(contains(off.out, part));
    for (const char *part : {"mesh_to_surface", "\"volume\"", "rests_on", "unproved_places"})
        CHECK_FALSE(contains(off.out, part));
    CHECK(shell(folder, make + "--json --certify on").out == shell(folder, make + "--json").out);
    CHECK(contains(shell(folder, make + "--certify perhaps").err, "wants on or off"));
    folder.write("dust.sdf", dust);
    const Result specks =
        shell(folder, "fathom mesh dust.sdf --resolution 24 --certify on -o a.stl");
    CHECK(contains(specks.err, "a.stl: partial: of "));
}

TEST_CASE(
    "walls thinner than cells are said, with what shows them, with a certificate and without") {
    ScratchFolder folder;
    folder.write("shell.sdf", "(box(2) - box(1.98)).rotate(0.3, axis: [1, 2, 3])\n");
    const Result shown = shell(folder, "fathom mesh shell.sdf --resolution 24 -o a.stl");
    CHECK(shown.exit == 0);
    CHECK(contains(shown.err, "walls thinner than cells are drawn by the solid grown by 0.04"));
    CHECK(contains(shown.err, "which a tolerance of 0.05"));
    folder.write("round.sdf", "sphere(2) - sphere(1.98)\n"); // is drawn whole
    const Result whole = shell(folder, "fathom mesh round.sdf --resolution 24 --json -o a.stl");
    CHECK(contains(whole.out, "{\"status\":\"certified\","));
    CHECK(contains(whole.out, "\"mesh_components\":2"));
    CHECK(contains(whole.err, "walls thinner than cells are drawn by the solid grown by 0.1"));
    CHECK(contains(whole.err, "gaps and holes narrower than 0.2"));
    folder.write("thick.sdf", "sphere(2) - sphere(1)\n");
    CHECK(shell(folder, "fathom mesh thick.sdf --resolution 24 -o a.stl").err.empty());
    CHECK(shell(folder, "fathom mesh thick.sdf --resolution 24 --json -o a.stl").err.empty());
    // some corners of cells lie in its wall, and it is drawn whole all the same
    folder.write("vase.sdf", "polygon([[0, -1], [0.5, -1], [0.8, -0.2], [0.4, 0.6], [0.6, 1], "
                             "[0.57, 1], [0.37, 0.6], [0.77, -0.2], [0.48, -0.95], [0, -0.95]])"
                             ".revolve()\n");
    const Result vase = shell(folder, "fathom mesh vase.sdf --resolution 64 --json -o a.stl");
    CHECK(contains(vase.out, "{\"status\":\"certified\","));
    CHECK(contains(vase.out, "\"mesh_genus\":0"));
    CHECK(contains(vase.err, "walls thinner than cells are drawn by the solid grown by 0.01"));
    CHECK(shell(folder, "fathom mesh vase.sdf --resolution 128 --json -o a.stl").err.empty());
    // few cells see the gap about a pin, and it is closed in them
    folder.write("pin.sdf", "box([6, 4, 4]) - cylinder(0.5, 1.52) | cylinder(0.46, 1.4)\n");
    for (const char *more : {"", " --json"})
        CHECK(contains(
            shell(folder, std::string("fathom mesh pin.sdf --resolution 40 -o a.stl") + more).err,
            "parts that are apart may be drawn as one: a gap is about 0.04 wide, and cells have "
            "sides of "));
    CHECK(shell(folder, "fathom mesh pin.sdf --resolution 300 -o a.stl").err.empty());
    // a splinter before a sharp edge is certified, as a piece of its own; small solids are no splinters
    folder.write("wedge.sdf", "polygon([[0, 0], [4, 0], [4, 0.7]]).extrude(1)\n");
    CHECK(
        contains(shell(folder, "fathom mesh wedge.sdf -o a.stl").err, " cells may hold surface "));
    CHECK(contains(shell(folder, "fathom mesh wedge.sdf --json -o a.stl").err,
                   "the mesh has 2 pieces, of which 1 may belong to another: "));
    folder.write("balls.sdf", "sphere(0.02).repeat([0.3, 0.3, 0.3], count: [3, 3, 3])\n");
    CHECK(shell(folder, "fathom mesh balls.sdf -o a.stl").err.empty());
}

TEST_CASE("--simplify writes fewer triangles, and the certificate is of these") {
    ScratchFolder folder;
    folder.write("part.sdf", "box(1) - sphere(0.62)\n");
    CHECK(shell(folder, "fathom mesh part.sdf --resolution 24 -o fine.stl").exit == 0);
    const Result made =
        shell(folder, "fathom mesh part.sdf --resolution 24 --simplify 0.01 --json -o coarse.stl");
    CHECK(made.exit == 0);
    CHECK(contains(made.out, "{\"status\":\"certified\","));
    CHECK(contains(made.out, "\"simplified\":{\"triangles_before\":"));
    CHECK(folder.read("coarse.stl").size() < folder.read("fine.stl").size() / 2);
    for (const char *wrong : {"-1", "0", "nan"}) {
        const Result made =
            shell(folder, std::string("fathom mesh part.sdf -o a.stl --simplify ") + wrong);
        CHECK(made.exit == 2);
        CHECK(contains(made.err, "wants a length above 0"));
    }
    // A tolerance of many cells takes no longer to certify than one of few.
    folder.write("ball.sdf", "sphere(1)\n");
    const Result all =
        shell(folder, "fathom mesh ball.sdf --resolution 32 --simplify 10 --json -o ball.stl");
    CHECK(all.exit == 0);
    CHECK(contains(all.out, "certified"));
}

TEST_CASE("what has no mesh says why, and writes nothing") {
    ScratchFolder folder;
    folder.write("ground.sdf", "plane(Y, 0)\n");
    folder.write("nothing.sdf", "sphere(1) & sphere(1).translate(x: 5)\n");
    folder.write("moves.sdf", "sphere(1 + time / 3600)\n");
    folder.write("ball.sdf", "sphere(1)\n");
    folder.write("wrong.sdf", "shpere(1)\n");
    const auto fails = [&](const std::string &arguments, int exit, const std::string &words) {
        INFO(arguments);
        const Result made = shell(folder, "fathom mesh " + arguments);
        CHECK(made.exit == exit);
        INFO(made.err);
        CHECK(contains(made.err, words));
        CHECK_FALSE(fs::exists(folder / "a.stl"));
    };
    fails("ground.sdf -o a.stl", 1, "`--bounds X,Y,Z,X,Y,Z`");
    fails("nothing.sdf -o a.stl", 1, "empty");
    fails("wrong.sdf -o a.stl", 1, "wrong.sdf:1:1: error[unknown-name]");
    fails("none.sdf -o a.stl", 3, "none.sdf");
    fails("ball.sdf -o a.stl -D r=1", 2, "r");
    fails("ball.sdf -o a.stl --tolerance 1e-9", 2, "too fine");
    fails("ball.sdf -o a.stl --units mm", 2, "says nothing of units");
    fails("ball.sdf -o a.3mf --units furlong", 2, "--units");
    fails("ball.sdf -o a.stl --tolerance -1", 2, "above 0");
    fails("ball.sdf -o a.stl --tolerance 1furlong", 2, "as 0.01 or 0.01mm");
    fails("ball.sdf -o a.stl --tolerance mm", 2, "as 0.01 or 0.01mm");
    fails("ball.sdf -o a.stl --tolerance 1 --resolution 5", 2, "one of them");
    fails("ball.sdf -o a.stl --resolution 0", 2, "--resolution");
    fails("ball.sdf -o a.stl --bounds 1,1,1,0,0,0", 2, "least corner");
    fails("ball.sdf -o a.stl --bounds 1,1", 2, "X,Y,Z,X,Y,Z");
    fails("moves.sdf -o a.stl --time -1", 2, "--time");
    fails("ball.sdf", 2, "-o");
    fails("ball.sdf -o a.png", 2, "`fathom render`");
    fails("ball.sdf -o a.txt", 2, ".glb or .3mf");
    fails("ball.sdf -o none/a.stl", 3, "none");
    CHECK(shell(folder, "fathom mesh ground.sdf --bounds=-1,-1,-1,1,1,1 -o a.stl").exit == 0);
    CHECK(fs::exists(folder / "a.stl"));
}

TEST_CASE("--parts writes each part as a whole object of its own, and says where two overlap") {
    ScratchFolder folder;
    folder.write("two.sdf", "let base = box([2, 1, 2]).paint(#8a8)\n"
                            "base\n"
                            "cylinder(0.3, 2).paint(red)\n"
                            "cylinder(0.1, 1).translate(x: 3).paint(red)\n"
                            "box(1) & box(1).translate(x: 3)\n");
    const Result glb = shell(folder, "fathom mesh two.sdf --parts --resolution 30 -o 'a b.glb'");
    CHECK(glb.exit == 0);
    CHECK(contains(glb.err, "part `box` (line 5) holds no point, and is left out"));
    CHECK(contains(glb.err, "two parts overlap: `base` and `cylinder` at ["));
    for (const char *name : {"\"name\":\"base\"", "\"name\":\"cylinder\"",
                             "\"name\":\"cylinder#2\"", "\"children\":[1,2,3]"})
        CHECK(contains(folder.read("a b.glb"), name));
    const Result obj = shell(folder, "fathom mesh two.sdf --parts --resolution 30 -o 'a b.obj'");
    CHECK(obj.exit == 0);
    CHECK(contains(folder.read("a b.obj"), "mtllib a b.mtl\n"));
    CHECK(contains(folder.read("a b.obj"), "\no cylinder.2\n"));
    CHECK(contains(folder.read("a b.mtl"), "\nnewmtl ff0000\n"));
    const Result json =
        shell(folder, "fathom mesh two.sdf --parts --resolution 30 --json -o a.3mf 2>no");
    CHECK(json.exit == 0);
    CHECK(json.out.starts_with(
        "{\"parts\":[{\"name\":\"base\",\"line\":2,\"status\":\"certified\","));
    CHECK(contains(json.out,
                   "\"empty\":[\"box\"],\"overlaps\":[{\"between\":[\"base\",\"cylinder\"]"));
    CHECK(contains(json.out, "\"all_overlaps_looked_for\":true"));
    // Parts that only touch do not overlap.
    folder.write("touch.sdf", "box(1)\nbox(1).translate(y: 1)\n");
    CHECK(shell(folder, "fathom mesh touch.sdf --parts --resolution 20 -o t.glb").err.empty());
    const auto fails = [&](const std::string &arguments, int exit, const std::string &words) {
        const Result made = shell(folder, "fathom mesh " + arguments);
        INFO(arguments << '\n' << made.err);
        CHECK(made.exit == exit);
        CHECK(contains(made.err, words));
    };
    fails("two.sdf --parts -o n.stl", 2, "holds one object");
    fails("two.sdf --parts --part base -o n.glb", 2, "give one of them");
    folder.write("ground.sdf", "sphere(1)\nplane(Y, -1)\n");
    fails("ground.sdf --parts -o n.glb", 1, "--bounds X,Y,Z,X,Y,Z");
    folder.write("none.sdf", "box(1) & box(1).translate(x: 3)\n");
    fails("none.sdf --parts -o n.glb", 1, "empty");
    CHECK_FALSE((fs::exists(folder / "n.stl") || fs::exists(folder / "n.glb")));
}

TEST_CASE("an OBJ and its materials are both written, or neither") {
    ScratchFolder folder;
    folder.write("ball.sdf", "sphere(1)\n");
    fs::create_directory(folder / "a.mtl");
    const Result blocked = shell(folder, "fathom mesh ball.sdf --resolution 8 -o a.obj");
    CHECK(blocked.exit == 3);
    CHECK(contains(blocked.err, "a.mtl"));
    CHECK_FALSE(fs::exists(folder / "a.obj"));
    // A file that may grow to 4 KiB: the OBJ is larger, its materials are not.
    const Result full =
        shell(folder, "(ulimit -f 4; trap '' XFSZ; fathom mesh ball.sdf --resolution 8 -o b.obj)");
    CHECK(full.exit == 3);
    CHECK(contains(full.err, "b.obj"));
    for (const auto &entry : fs::directory_iterator(folder.path()))
        CHECK((entry.path().filename() == "ball.sdf" || entry.path().filename() == "a.mtl"));
    // What begins a comment in an OBJ is in no name of its materials.
    CHECK(shell(folder, "fathom mesh ball.sdf --resolution 8 -o 'c#1.obj'").exit == 0);
    CHECK(contains(folder.read("c#1.obj"), "mtllib c.1.mtl\n"));
    CHECK(fs::exists(folder / "c.1.mtl"));
    // A name that an OBJ of the scene's own materials would overwrite.
    CHECK(shell(folder, "fathom mesh ball.sdf --resolution 8 -o ball.obj").exit == 0);
    CHECK(fs::exists(folder / "ball.mtl"));
}

TEST_CASE("--frames makes a file for each frame, as render numbers them, at its time and params") {
    ScratchFolder folder;
    folder.write("m.sdf", "param r = 0.5 in 0.2..1\nsphere(r).translate(x: time)\n");
    const std::string few = "--resolution 8 ";
    CHECK(shell(folder, "fathom mesh m.sdf --frames 0..=20:10 --fps 10 -o a.stl " + few).exit == 0);
    for (const char *name : {"a_0000.stl", "a_0010.stl", "a_0020.stl"}) {
        INFO(name);
        CHECK(fs::exists(folder / name));
    }
    CHECK_FALSE(fs::exists(folder / "a.stl"));
    // Each as if it were made alone.
    CHECK(shell(folder, "fathom mesh m.sdf --time 1 -o - " + few).out == folder.read("a_0010.stl"));
    const Result swept = shell(
        folder, "fathom mesh m.sdf --frames 0..=2 --sweep r=0.2..=1 --json -o 'b_##.obj' " + few);
    CHECK(swept.exit == 0);
    CHECK(swept.out.starts_with("{\"frame\":0,\"file\":\"b_00.obj\",\"status\":"));
    CHECK(contains(swept.out, "\n{\"frame\":2,\"file\":\"b_02.obj\","));
    CHECK(
        (fs::exists(folder / "b_01.mtl") && contains(folder.read("b_01.obj"), "mtllib b_01.mtl")));
    CHECK(
        shell(folder, "fathom mesh m.sdf -D r=1 --time 0.066666666666666666 --json -o c.obj " + few)
            .exit == 0);
    const std::string alone = folder.read("c.obj"), frame = folder.read("b_02.obj");
    CHECK(alone.substr(alone.find("\nv ")) == frame.substr(frame.find("\nv ")));
    CHECK(shell(folder, "fathom mesh m.sdf --frames 0..2 -o c_%03d.stl " + few).exit == 0);
    CHECK(!folder.read("c_000.stl").empty());
    CHECK(!folder.read("c_001.stl").empty());
    CHECK(shell(folder, "fathom slice m.sdf --z 0 --frames 0..2 -o s.svg " + few).exit == 0);
    CHECK(shell(folder, "fathom volume m.sdf --frames 0..2 -o v.nrrd " + few).exit == 0);
    CHECK((fs::exists(folder / "s_0001.svg") && fs::exists(folder / "v_0001.nrrd")));
    const auto fails = [&](const std::string &arguments, int exit, const std::string &words) {
        const Result made = shell(folder, "fathom " + arguments);
        INFO(arguments << '\n' << made.err);
        CHECK(made.exit == exit);
        CHECK(contains(made.err, words));
    };
    fails("mesh m.sdf --frames 0..3 -o -", 2, "--frames makes files");
    fails("mesh m.sdf --fps 3 -o n.stl", 2, "--fps is for --frames");
    fails("mesh m.sdf --sweep r=0..1 -o n.stl", 2, "--sweep is for --frames");
    fails("volume m.sdf --sweep r=0..1 -o n.vdb", 2, "--sweep is for --frames");
    fails("slice m.sdf --z 0,1 --frames 0..3 -o n.svg", 2, "one height");
    fails("mesh m.sdf --frames 0..2 --sweep q=0..1 -o n.stl", 2, "q");
    fails("mesh m.sdf --frames 0..2 -o none/n.stl", 3, "none");
    fails("mesh m.sdf --frames 200000 -o n.stl", 2, "--time");
    // The third frame has no mesh; the first two stay.
    folder.write("ends.sdf", "sphere(1).translate(x: 40 * time) & box(3)\n");
    fails("mesh ends.sdf --frames 0..4 -o e.stl " + few, 1, "e_0002.stl");
    CHECK((fs::exists(folder / "e_0001.stl") && !fs::exists(folder / "e_0002.stl")));
}

TEST_CASE("several scenes are each a file by their name") {
    ScratchFolder folder;
    fs::create_directory(folder / "sub");
    folder.write("ball.sdf", "sphere(1)\n");
    folder.write("sub/cube {}.sdf", "box(1)\n");
    folder.write("wrong.sdf", "shpere(1)\n");
    const Result made =
        shell(folder, "fathom mesh wrong.sdf ball.sdf 'sub/cube {}.sdf' -o 'out {}.obj' "
                      "--resolution 8 --json");
    CHECK(made.exit == 1);
    CHECK(contains(made.err, "unknown-name"));
    CHECK(made.out.starts_with("{\"ok\":false")); // a document for each
    CHECK(contains(made.out, "\n{\"scene\":\"ball.sdf\",\"file\":\"out ball.obj\",\"status\":"));
    CHECK(contains(folder.read("out ball.obj"), "\no ball\n"));
    CHECK((fs::exists(folder / "out cube {}.obj") && fs::exists(folder / "out cube {}.mtl")));
    CHECK_FALSE(fs::exists(folder / "out wrong.obj"));
    const auto fails = [&](const std::string &arguments, const std::string &words) {
        const Result refused = shell(folder, "fathom mesh " + arguments);
        INFO(arguments << '\n' << refused.err);
        CHECK(refused.exit == 2);
        CHECK(contains(refused.err, words));
    };
    fails("ball.sdf wrong.sdf -o a.stl", "would both be `a.stl`");
    fails("ball.sdf sub/../ball.sdf -o '{}.stl'", "would both be `ball.stl`");
    fails("ball.sdf wrong.sdf -o -", "standard output takes one mesh");
    fails("- - -o '{}.stl'", "read once");
    CHECK_FALSE((fs::exists(folder / "a.stl") || fs::exists(folder / "ball.stl")));
}
