// How much light arrives is a matter of the solid alone: what the shadows and the occlusion of pictures
// have to be, whatever text the solid has.
#include "tests/property/stills.h"

#include <utility>

using namespace fathom;
using namespace fathom::stills;

TEST_CASE("two texts of one solid give one picture") {
    const std::string scene = camera + "lighting(ambient_occlusion: 1, soft_shadows: 0.1)\n"
                                       "sun(direction: [0.6, 0.8, 0.3])\nplane(Y, -1)\n";
    // What a field of its own finds at edges differs a little.
    struct Pair {
        const char *one, *other;
        int differ = few;
    };
    const Pair pairs[] = {
        {"box(2)",
         "plane(X, 1) & plane(-X, 1) & plane(Y, 1) & plane(-Y, 1) & plane(Z, 1) & plane(-Z, 1)",
         few},
        {"sphere(1)", "implicit(p => length(p) - 1, within: ball(1.05))"},
        {"ellipsoid([1.2, 0.6, 0.5])",
         "implicit(p => 0.2 * (dot(p / [1.2, 0.6, 0.5], p / [1.2, 0.6, 0.5]) - 1), "
         "within: aabb([-1.2, -0.6, -0.5], [1.2, 0.6, 0.5]))"},
        {"box([0.6, 0.3, 0.6]).rotate(40deg)",
         "box([0.6, 1, 0.6]).scale([1, 0.3, 1]).rotate(40deg)"},
        {"cylinder(0.6, 0.18).rotate(30deg, axis: Z)",
         "cylinder(0.6, 0.6).scale([1, 0.3, 1]).rotate(30deg, axis: Z)"},
        {"box(1.2)",
         "implicit(p => max(abs(p.x), max(abs(p.y), abs(p.z))) - 0.6, within: everywhere)"},
        {"sphere(1)", "implicit(p => length(p) - 1, within: ball(3))"},
        {"sphere(1)", "implicit(p => 7 * (length(p) - 1), within: ball(2))"},
        {"sphere(1)", "implicit(p => 1000 * (length(p) - 1), within: ball(2))"},
        {"box([1, 0.5, 0.7]).rotate(20deg)", "box([1, 0.5, 35]).scale([1, 1, 0.02]).rotate(20deg)"},
        {"sphere(1)", "implicit(p => dot(p, p) - 1, within: ball(2))", 2 * few},
        // Steep at the surface and flat far off; and flat at the surface.
        {"sphere(1)", "implicit(p => atan(50 * (length(p) - 1)), within: ball(1.3))"},
        {"sphere(1)", "implicit(p => exp(-8.0) - exp(-8 * dot(p, p)), within: ball(3))", 3 * few},
        {"sphere(1)",
         "implicit(p => { let d = length(p) - 1; d * d * d + 0.003 * d }, within: ball(1.3))",
         2 * few},
        {"sphere(1)", "sphere(0.5).scale(2)"},
        {"torus(1, 0.3)", "implicit(p => length([length(p.xz) - 1, p.y]) - 0.3, within: ball(3))"},
        {"box(1.5) | sphere(1)", "sphere(1) | (box(1.5) & box(9))"},
        {"box(2) - sphere(1.2)", "box(2) & implicit(p => 1.2 - length(p), within: everywhere)"},
        {"cylinder(1, 1.5)", "circle(1).extrude(1.5).rotate(90deg, axis: X)"},
    };
    for (const auto &[one, other, differ] : pairs) {
        INFO(one << " and " << other);
        CHECK(different(drawn(scene + one + "\n"), drawn(scene + other + "\n")) <= differ);
    }
}

TEST_CASE("a field with a kink on its surface is lit as that lies") {
    const std::string scene = camera + "lighting(ambient_occlusion: 0)\nlight([3, 5, 3])\n";
    const cpu::Picture exact = drawn(scene + "torus(1, 0.4)\n");
    for (const char *kinked : {"if d < 0 { 8 * d } else { d }", "if d < 0 { 0.1 * d } else { d }",
                               "max(d, 3 * d)", "d + 0.6 * abs(d)"}) {
        INFO(kinked);
        CHECK(different(exact,
                        drawn(scene + "implicit(p => { let d = length([length(p.xz) - 1, p.y]) - " +
                              "0.4; " + kinked + " }, within: ball(3))\n")) <= few);
    }
}

TEST_CASE("what is thin and flat far off has a soft shadow without cracks") {
    // An open bowl in a room. Its field is a distance near it, and flat where its shadows end.
    const std::string scene = "camera(at: [2.6, 1.6, 2.9], look_at: [0, -0.1, 0], fov: 60deg)\n"
                              "lighting(soft_shadows: 0.1)\nlight([2, 3, 1])\n"
                              "box(8).shell(0.1)\n"
                              "fn bowl(p) = max(abs(length(p) - 1) - 0.05, p.y - 0.4)\n";
    const auto with = [&](const std::string &far_off) {
        return drawn(scene + "implicit(p => { let d = bowl(p); " + far_off +
                     " }, within: ball(4))\n");
    };
    const cpu::Picture even = with("d");
    for (const char *flat : {"d / sqrt(1 + 9 * d * d)", "1 - exp(-2 * d)", "atan(3 * d)"}) {
        INFO(flat);
        CHECK(different(even, with(flat)) <= 3 * few);
    }
}

TEST_CASE("what closes a place is as near as the solid is, not as a field says") {
    const std::string scene =
        camera + "lighting(occlusion_reach: 0.4, soft_shadows: 0)\nplane(Y, -0.7)\n";
    const std::pair<const char *, const char *> pairs[] = {
        {"box([2, 1.4, 1.4]) - box([2, 1.4, 1.6]).translate([0.3, 0.3, 0])",
         "box([0.3, 1.4, 1.4]).translate(x: -0.85) | box([2, 0.3, 1.4]).translate(y: -0.55)"},
        {"box(1.4) - union { for a in [X, Y, Z] { cylinder(0.4, 1.42).orient(Y, a) } }",
         "box(1.4) - union { for a in [X, Y, Z] { cylinder(0.4, 3).orient(Y, a) } }"},
        {"box([1.8, 1.2, 1.4]) - box([0.2, 2, 2]).repeat([0.4, 0, 0], count: [4, 1, 1])",
         "for i in -2..=2 { box([0.2, 1.2, 1.4]).translate(x: 0.4 * i) }"},
        {"box([2, 1, 0.4]).scale([0.5, 1, 3])", "box([1, 1, 1.2])"},
        {"sphere(0.7)\nbox([0.2, 20, 3]).scale([1, 0.1, 1]).translate(x: -0.85)",
         "sphere(0.7)\nbox([0.2, 2, 3]).translate(x: -0.85)"},
    };
    for (const auto &[cut, whole] : pairs) {
        INFO(cut);
        CHECK(different(drawn(scene + cut + "\n"), drawn(scene + whole + "\n")) <= few);
    }
}

TEST_CASE("wide occlusion has no contour lines where a field is no distance") {
    const std::string look =
        "camera(at: [1.2, -0.5, 1.4], look_at: [0, -0.8, 0], fov: 55deg)\n"
        "sun(direction: [-0.4, 1.0, -0.7])\nlighting(ambient_occlusion: 1, occlusion_reach: 0.5)\n"
        "sphere(0.5).translate([0, -0.45, 0])\n";
    const std::string parts = "cylinder(0.15, 1).translate([-0.7, -0.5, 0.4])\n",
                      walls = "box([4, 0.1, 4]).translate(y: -0.95)\n"
                              "box([0.1, 2, 4]).translate([-1.5, 0, 0])\n"
                              "box([4, 2, 0.1]).translate([0, 0, -1.5])";
    const std::pair<std::string, std::string> pairs[] = {
        {parts + "implicit(p => 0.7 * (p.y + 1))\n", parts + "plane(Y, -1)\n"},
        {"smooth_union(0.0001) {\n" + walls + "\n}\n", walls + "\n"},
    };
    for (const auto &[field, exact] : pairs) {
        INFO(field);
        CHECK(different(drawn(look + field), drawn(look + exact)) <= 5 * few);
    }
}

TEST_CASE("what stands on a ground has no dots along its foot") {
    const std::string scene = "plane(Y, -0.5).paint(#c8c0b0)\n"
                              "camera(at: [1.5, 0.3, 4], look_at: [0.5, -0.2, 0], fov: 35deg)\n";
    const cpu::Picture stands = drawn(scene + "box(1).rotate(25deg)\n"
                                              "cylinder(0.4, 1).translate([1.2, 0, 0])\n"),
                       sunk = drawn(scene + "box([1, 1.2, 1]).rotate(25deg).translate(y: -0.1)\n"
                                            "cylinder(0.4, 1.2).translate([1.2, -0.1, 0])\n");
    CHECK(different(stands, sunk) <= 2);
}

TEST_CASE("what two parts leave of each other has a soft shadow without stripes") {
    const auto sliver = [](const std::string &thin, const std::string &thick) {
        return "camera(at: [3, 2.6, 5], look_at: [0, 0, 0], fov: 40deg)\n"
               "lighting(soft_shadows: 0.15)\nsun(direction: [0.6, 0.8, 0.3])\nplane(Y, -1.2)\n" +
               thick + ".translate([-0.553, 0.278, 0.157]) & " + thin +
               ".rotate(1.557, axis: [0.714, -0.813, 1]).translate([0.238, 0.008, 0.435])\n";
    };
    const auto ring = [](const char *radius, const char *tube) {
        return std::string("implicit(p => length([length(p.xz) - ") + radius + ", p.y]) - " + tube +
               ")";
    };
    CHECK(different(drawn(sliver("torus(0.903, 0.147)", "torus(0.568, 0.299)")),
                    drawn(sliver(ring("0.903", "0.147"), ring("0.568", "0.299")))) <= 11 * few);
}

TEST_CASE("the soft shadow of a sharp edge is as that of a blunt one") {
    const std::string scene = "camera(at: [2, 4.5, 4], look_at: [0.5, -0.8, -0.3], fov: 42deg)\n"
                              "sun(direction: [-1, 1.2, 0.5])\nplane(Y, -1.1)\n"
                              "lighting(soft_shadows: 0.1)\n";
    const cpu::Picture lens =
        drawn(scene + "sphere(2).translate(y: 1.8734) & sphere(2).translate(y: -1.8734)\n");
    const cpu::Picture blunt =
        drawn(scene + "(sphere(2).translate(y: 1.8734) & sphere(2).translate(y: -1.8734)) |"
                      " torus(0.6995, 0.004)\n");
    CHECK(different(lens, blunt) <= 5 * few);
}

TEST_CASE("the light in a hole does not depend on how far the tool reaches beyond it") {
    const std::string scene = "camera(at: [2.2, 2.2, 2.6], look_at: [0, -0.7, 0], fov: 50deg)\n"
                              "sun(direction: [-0.3, 1, 0.3])\nplane(Y, -1)\n"
                              "lighting(soft_shadows: 0.1)\n";
    struct Cut {
        std::string one, other; // all of it, but for how far it reaches
        std::string through;    // well beyond
    };
    const Cut cuts[] = {
        {"box([1.6, 0.1, 1.6]) - cylinder(0.4, ", ")", "3"},
        {"cylinder(0.4, 0.8) - cylinder(0.33, ", ")", "3"},
        {"box([1.6, 0.1, 1.6]) - box([0.8, 0.3, ", "]).rotate(90deg, axis: X)", "3"},
    };
    for (const Cut &cut : cuts) {
        const bool tube = cut.one[0] == 'c';
        const cpu::Picture whole = drawn(scene + cut.one + cut.through + cut.other + "\n");
        for (const char *reach : {"0", "0.0002", "0.002", "0.02", "0.04", "0.1"}) {
            const std::string length = (tube ? "(0.8 + " : "(0.1 + ") + std::string(reach) + ")";
            INFO(cut.one << length << cut.other);
            CHECK(different(whole, drawn(scene + cut.one + length + cut.other + "\n")) <= few);
        }
    }
}

TEST_CASE("an orthographic camera may stand as far back as one likes") {
    const auto from = [](const char *at, const char *fov) {
        return drawn(
            "sphere(0.5)\nplane(Y, -1)\nsun(direction: [-0.3, 1, 0.3])\n"
            "lighting(soft_shadows: 0.1)\ncamera(look_at: [0, -0.5, 0], orthographic: true, at: " +
            std::string(at) + ", fov: " + fov + ")\n");
    };
    // tan(fov / 2) times the distance is the same
    CHECK(different(from("[3, 1.7, 4]", "2 * atan(0.36)"),
                    from("[30, 21.5, 40]", "2 * atan(0.036)")) <= few);
}

// But for the edge of the floor, each byte is near the mean of those above and below it.
TEST_CASE("a lamp beside a wall lights the floor without rings") {
    const cpu::Picture lit = drawn("box([6.2, 4.2, 6.2]) - box([6, 4, 6])\n"
                                   "camera(at: [0, 0.5, 2.9], look_at: [0, -1.6, 0], fov: 30deg)\n"
                                   "light(at: [0, 1.97, 0], intensity: 0.9)\n");
    int bent = 0;
    for (int x = 0; x < width; ++x)
        for (int y = 1; y < height - 1; ++y)
            bent += std::abs(2 * byte(lit, x, y, 0) - byte(lit, x, y - 1, 0) -
                             byte(lit, x, y + 1, 0)) > 4;
    CHECK(bent <= 2 * width);
}
