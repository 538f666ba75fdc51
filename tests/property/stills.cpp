// Pictures that were wrong, each by the smallest scene that showed it: what a ray, a shadow or a
// pixel of such a scene has to be, whatever the bound and the example.
#include "tests/property/stills.h"

#include <array>
#include <cmath>
#include <fmt/format.h>
#include <numeric>
#include <utility>

using namespace fathom;
using namespace fathom::stills;

TEST_CASE("a slider at 0 whose range makes a shape steep draws the shape without it") {
    const std::string from = "camera(at: [0, 4, 26], look_at: [0, 0, 0], fov: 40deg)\n";
    const cpu::Picture steep =
        drawn(from + "param a = 0 in 0..20\nsphere(6).displace(p => a * sin(p.x))\n");
    CHECK(different(steep, drawn(from + "sphere(6)\n")) <= few);
}

TEST_CASE("a taper that is steep at its end keeps its neck") {
    const cpu::Picture picture = drawn(camera + "cylinder(1, 4).taper(0.002)\nbackground(white)\n");
    // the solid is a cone of 2 units to each side of the middle: a column of it without a gap
    int first = height, last = 0, inside = 0;
    for (int y = 0; y < height; ++y)
        if (byte(picture, width / 2, y, 2) < 250) {
            first = std::min(first, y), last = std::max(last, y);
            ++inside;
        }
    CHECK(inside == last - first + 1);
    CHECK(inside > height / 3);
}

TEST_CASE("a hundred blobs are drawn whole by one bound") {
    const std::string scene = "import \"dfmodel\" as dfmodel\n"
                              "dfmodel.blobby(100, size: [4, 2, 4], radius: 0.1, seed: 3)\n"
                              "background(black)\n";
    const cpu::Picture picture = drawn(scene);
    int shown = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) shown += byte(picture, x, y, 0) > 16;
    CHECK(shown > width * height / 8);
}

TEST_CASE("no sky shows through a city without an end") {
    const driver::Compilation city =
        compiled("box(1).repeat([1.5, 0, 1.5], (s, id) => s.scale([0.6, 0.8 + 2 * hash(id), 0.6])"
                 ".rotate(0.5 * hash(id + 3), axis: Y))\nplane(Y, 0)\n"
                 "camera(at: [6, 5, 8], look_at: [0, 2.5, 0], fov: 40deg)\n");
    const cpu::Stage stage = stage_of(city.scene);
    std::vector<cpu::Ray> rays;
    for (int y = 0; y < height; y += 2)
        for (int x = 0; x < width; x += 2) {
            const cpu::Ray ray = cpu::eye_ray(stage, float(x) + 0.5f, float(y) + 0.5f);
            if (ray.direction[1] < -0.02f)
                rays.push_back(ray); // it meets the ground, if nothing else
        }
    REQUIRE(rays.size() > 1000);
    const std::vector<cpu::Landing> landings = cpu::cast(stage, rays);
    CHECK(std::ranges::all_of(landings,
                              [](const cpu::Landing &l) { return l.end == cpu::RayEnd::Hit; }));
}

TEST_CASE("a param's range in place of a constant changes no shadow") {
    const std::string scene = "box([1, 2, 1]).twist(rate).translate(y: 1)\nplane(Y)\n"
                              "sun(direction: [0.6, 0.8, 0.2])\nlighting(soft_shadows: 0.1)\n";
    CHECK(different(drawn(camera + "let rate = 0.4\n" + scene),
                    drawn(camera + "param rate = 0.4 in 0..1.5\n" + scene)) <= few);
}

TEST_CASE("a region of another size paints no ghosts") {
    const auto scene = [](const char *within) {
        return camera + "implicit(p => 0.4 * (length(p) - 1), within: " + within +
               ").translate(y: 1)\nplane(Y)\nsun(direction: [0.6, 0.5, 0.2])\n";
    };
    CHECK(different(drawn(scene("ball(1.1)")), drawn(scene("ball(2.5)"))) <= few);
}

TEST_CASE("edges show the faces beside them, and nothing else") {
    const std::string light = "sun(direction: [0.4, 0.8, 0.6])\nbackground(black)\n"
                              "lighting(ambient: 0.3, ambient_occlusion: 0, shadow_darkness: 0, "
                              "specular_intensity: 0, classic: true)\n";
    const std::string scenes[] = {
        "box([1, 0.2, 1]).translate(y: 0.1)\n"
        "camera(at: [1.2, 2.0, 3.2], look_at: [0, 0, 0], fov: 24deg)\n",
        "box(1).scale([2, 0.4, 1.2]).rotate(-20deg).translate([8, 0, 0])\n"
        "camera(at: [9.2, 4.0, 7.2], look_at: [8, 0, 0], fov: 24deg)\n"};
    for (const std::string &scene : scenes) {
        INFO(scene);
        const driver::Compilation compilation = compiled(scene + light);
        const cpu::Picture picture =
            cpu::render(cpu::prepare(compilation.scene, ir::view_of(compilation.scene, 0, 4.0 / 3),
                                     480, 360, 0),
                        {});
        // Of a body in parallel light only three faces show, each of one colour; a byte more or
        // less by the dither.
        std::array<int, 257> count{};
        for (std::size_t at = 1; at < picture.rgba.size(); at += 4) ++count[picture.rgba[at]];
        count[0] = 0; // the background
        int faces = 0;
        for (int face = 0; face < 3; ++face) {
            const auto most = std::ranges::max_element(count) - count.begin();
            for (auto c = std::max<std::ptrdiff_t>(most - 1, 0); c <= most + 1; ++c)
                faces += std::exchange(count[static_cast<std::size_t>(c)], 0);
        }
        const int others = std::accumulate(count.begin(), count.end(), 0);
        CHECK(faces > picture.width * picture.height / 10);
        CHECK(others <= faces / 500);
    }
}

TEST_CASE("an edge has no highlight that neither of its faces has") {
    // brighter by 25 than all eight pixels round it, in each channel
    int dots = 0;
    for (int i = 0; i < 12; ++i) {
        const cpu::Picture picture =
            drawn("gdf_truncated_octahedron(0.75).rotate_euler([10deg, 25deg, 0]).paint(#2d6a4f)"
                  ".translate([1, 1.9, 0])\nlight(at: [5, 6, 9], color: #fff2e0)\n"
                  "camera(at: [0.8, 0.5, 11.6], look_at: [1.12, 2.17, 0], fov: " +
                  std::to_string(1.5 + 0.1 * i) + "deg)\n");
        for (int y = 1; y + 1 < height; ++y)
            for (int x = 1; x + 1 < width; ++x) {
                int least = 255;
                for (int k = 0; k < 9; ++k)
                    for (int c = 0; k != 4 && c < 3; ++c)
                        least = std::min(least, byte(picture, x, y, c) -
                                                    byte(picture, x + k % 3 - 1, y + k / 3 - 1, c));
                dots += least > 25;
            }
    }
    CHECK(dots <= 1);
}

TEST_CASE("a ground without an end fades into the background, without a step") {
    const cpu::Picture picture = drawn("box(1)\nplane(Y, -0.5).paint(#6f7a63)\nbackground(white)\n"
                                       "camera(at: [2, 1, 6], look_at: [0, 0.98, 0], fov: 1deg)\n");
    const int x = width / 8;
    int brightest = 0;
    for (int y = 0; y + 1 < height; ++y)
        brightest =
            std::max(brightest, std::abs(byte(picture, x, y + 1, 1) - byte(picture, x, y, 1)));
    CHECK(byte(picture, x, height - 1, 1) < 200);
    CHECK(byte(picture, x, 0, 1) == 255);
    CHECK(brightest < 60);
}

TEST_CASE("a lawn round a solid changes no groove of it") {
    const std::string solid = "box([2, 1, 2]) - box([0.12, 1, 3]).translate(y: 0.3)\n";
    const std::string light = "camera(at: [0.9, 5, 1.2], look_at: [0, 0.5, 0], fov: 22deg)\n"
                              "lighting(ambient_occlusion: 1, shadow_darkness: 0)\n";
    const cpu::Picture alone = drawn(light + solid),
                       lawn = drawn(light + solid + "box([40, 0.1, 40]).translate(y: -0.55)\n");
    int darker = 0;
    for (int y = height / 3; y < 2 * height / 3; ++y) // the solid's top, far from the lawn
        for (int x = width / 3; x < 2 * width / 3; ++x)
            darker += std::abs(byte(alone, x, y, 1) - byte(lawn, x, y, 1)) > 2;
    CHECK(darker <= few);
}

TEST_CASE("where a field's region ends under water nothing is seen") {
    const auto lake = [](const char *size) {
        return std::string("heightfield(q => 0.9 * exp(-1.5 * dot(q, q)) - 0.35, size: ") + size +
               ", depth: 0.6)\nplane(Y).paint(#2f8fa3)\n"
               "camera(at: [3, 2.4, 4], look_at: [0, 0.2, 0], fov: 40deg)\n"
               "lighting(ambient: 0.3, ambient_occlusion: 1, shadow_darkness: 0)\n";
    };
    CHECK(different(drawn(lake("[4, 4]")), drawn(lake("[9, 9]"))) <= few);
}

TEST_CASE("a folded fractal's region casts no band on the ground") {
    const auto folded = [](const char *radius) {
        return std::string("fn over(p: vec2) -> vec2 = [max(p.x, -p.y), max(p.y, -p.x)]\n"
                           "fn fold(p: vec3) -> float {\n  var q = p\n  var scale = 1.0\n"
                           "  for i in 0..4 {\n    q.xy = over(q.xy)\n    q.xz = over(q.xz)\n"
                           "    q.yz = over(q.yz)\n    q = 2 * q - 1\n    scale = 2 * scale\n  }\n"
                           "  (length(q) - 1.6) / scale\n}\n"
                           "implicit(p => fold(p), within: ball(") +
               radius +
               ")).orient([1, 1, 1], Y)\nplane(Y, -0.7)\n"
               "camera(at: [3, 3, 5], look_at: [0, -0.5, 0.8], fov: 30deg)\n"
               "lighting(ambient: 0.3, ambient_occlusion: 1, shadow_darkness: 0)\n";
    };
    CHECK(different(drawn(folded("1.95")), drawn(folded("2.6"))) <= few);
}

TEST_CASE("a flat face of a gem has one colour, in soft shadows too") {
    const std::string scene = "gdf_truncated_octahedron(1).rotate_euler([10deg, 25deg, 0])\n"
                              "camera(at: [0.8, 0.5, 6], look_at: [0, 0, 0], fov: 26deg)\n"
                              "sun(direction: [0.4, 0.7, 0.6])\nbackground(black)\n"
                              "lighting(ambient: 0.3, ambient_occlusion: 1, soft_shadows: 0.06, "
                              "specular_intensity: 0, classic: true)\n";
    const cpu::Picture picture = drawn(scene);
    // A pixel whose four neighbours are alike is like them: no slit, no dot.
    int inside = 0, apart = 0;
    for (int y = 1; y + 1 < height; ++y)
        for (int x = 1; x + 1 < width; ++x) {
            const std::array<int, 4> around{byte(picture, x - 1, y, 1), byte(picture, x + 1, y, 1),
                                            byte(picture, x, y - 1, 1), byte(picture, x, y + 1, 1)};
            const auto [least, most] = std::ranges::minmax(around);
            if (most - least > 2 || least < 16) continue;
            ++inside;
            const int own = byte(picture, x, y, 1);
            apart += own < least - 2 || own > most + 2;
        }
    CHECK(inside > width * height / 5);
    CHECK(apart == 0);
}

TEST_CASE("the soft shadow on a soft star has no grain") {
    const std::string scene =
        "gdf_blend([X, Y, Z], [[1, 1, 1], [-1, 1, 1], [1, -1, 1], [1, 1, -1]], 1.8, -0.9, "
        "radius: 0.22).rotate_euler([10deg, 25deg, 0])\n"
        "camera(at: [0.8, 0.5, 6], look_at: [0, 0, 0], fov: 22deg)\n"
        "light(at: [5, 6, 9], color: #fff2e0)\nbackground(black)\n"
        "lighting(ambient: 0.2, ambient_occlusion: 0, shadow_darkness: 0.6, soft_shadows: 0.06, "
        "specular_intensity: 0)\n";
    const cpu::Picture picture = drawn(scene);
    // Along a row it gets lighter and darker a few times, by the star's arms, and not at each pixel.
    int turns = 0, rows = 0;
    for (int y = 0; y < height; ++y) {
        int way = 0, from = byte(picture, 0, y, 1), inside = 0;
        for (int x = 1; x < width; ++x) {
            const int to = byte(picture, x, y, 1);
            inside += to > 16;
            if (std::abs(to - from) <= 5) continue;
            const int now = to > from ? 1 : -1;
            turns += now == -way;
            way = now, from = to;
        }
        rows += inside > 8;
    }
    INFO(turns << " turns in " << rows << " rows");
    CHECK(rows > height / 4);
    CHECK(turns < 8 * rows);
}

TEST_CASE("a sky without bands: bytes of a gradient average to its values") {
    const cpu::Picture picture = drawn("sphere(0.01)\nbackground(d => vec3(0.3 + 0.02 * d.x))\n"
                                       "camera(at: [0.03, 0.02, 0.05], look_at: [0, 0, 0])\n");
    // Over a block of the pattern the mean of the bytes moves by less than a level from the next one.
    double before = 0;
    int same = 0;
    for (int block = 0; block < width / 8; ++block) {
        double sum = 0;
        for (int y = 0; y < 8; ++y)
            for (int x = 0; x < 8; ++x) sum += byte(picture, 8 * block + x, y, 1);
        if (block > 0) {
            CHECK(std::abs(sum / 64 - before) < 1);
            same += sum / 64 == before;
        }
        before = sum / 64;
    }
    CHECK(same < 3);
}

TEST_CASE("a flat colour stays flat") {
    const cpu::Picture picture = drawn("sphere(0.01)\nbackground(#6f7a63)\n");
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) {
            CHECK(byte(picture, x, y, 0) == 0x6f);
            CHECK(byte(picture, x, y, 1) == 0x7a);
        }
}

TEST_CASE("where one sample does not do there are more, and nowhere else") {
    const std::string scene = camera + "box(2)\nbackground(white)\n";
    const cpu::Picture one = drawn(scene), smooth = drawn(scene, 0), all = drawn(scene, 4);
    CHECK(smooth.work.rays < one.work.rays * 2);
    CHECK(smooth.work.rays > one.work.rays);
    CHECK(different(one, all) > 3 * different(smooth, all));
}

TEST_CASE("stripes that are finer than pixels are grey towards the horizon") {
    const std::string text =
        "plane(Y).paint(p => if fract(p.x) < 0.5 { white } else { black })\n"
        "camera(at: [0.3, 0.35, 6], look_at: [0, 0.35, 0])\nlighting(classic: true)\n";
    const cpu::Picture one = drawn(text), smooth = drawn(text, 0);
    const auto spread = [&](const cpu::Picture &picture) {
        double sum = 0, squares = 0;
        int count = 0;
        for (int y = height / 2 + 1; y < height / 2 + 4; ++y)
            for (int x = 0; x < width; ++x, ++count) {
                const double value = byte(picture, x, y, 1);
                sum += value, squares += value * value;
            }
        return std::sqrt(squares / count - sum * sum / (double(count) * count));
    };
    CHECK(spread(one) > 60);
    CHECK(spread(smooth) < 0.5 * spread(one));
}

TEST_CASE("where parts meet in one plane their seam is not seen") {
    const std::string light = "camera(at: [3, 4, 5], look_at: [0, 0.3, 0], fov: 25deg)\n"
                              "plane(Y, -0.5)\nsun(direction: [0.5, 0.8, 0.3])\n";
    // parts that abut, and the same solid in one
    const std::pair<const char *, const char *> pairs[] = {
        {"for i in 0..4 { for j in 0..4 { box(0.5).translate([0.5*i - 0.75, 0.5*j - 0.25, 0]) } }",
         "box([2, 2, 0.5]).translate(y: 0.5)"},
        {"for i in 0..5 { cylinder(0.7, 0.3).translate(y: 0.3*i - 0.35) }",
         "cylinder(0.7, 1.5).translate(y: 0.25)"},
        {"for i in 0..3 { box([1, 0.4, 1]).translate(y: 0.4*i - 0.3).rotate(0.3) }",
         "box([1, 1.2, 1]).translate(y: 0.1).rotate(0.3)"},
    };
    for (const auto &[parts, whole] : pairs) {
        INFO(parts);
        CHECK(different(drawn(light + parts + "\n"), drawn(light + whole + "\n")) <= few);
    }
}

TEST_CASE("what is thinner than a pixel is not lost between the samples") {
    const std::string bare =
        "camera(at: [0, 0, 14], look_at: [0, 0, 0], fov: 20deg)\n"
        "sphere(0.1).translate([-2, 0, -1])\nsphere(0.1).translate([2, 0, 1])\n"
        "background([0, 0, 0])\n";
    const std::string wire = bare + "box([0.02, 4, 0.02]).rotate(7deg, axis: Z).paint(white)\n";
    const cpu::Picture without = drawn(bare, 0), with = drawn(wire, 0), once = drawn(wire, 1);
    const auto rows = [&](const cpu::Picture &picture) {
        int seen = 0;
        for (int y = 0; y < height; ++y) {
            bool here = false;
            for (int x = 0; x < width; ++x)
                here = here || byte(picture, x, y, 1) > byte(without, x, y, 1) + 8;
            seen += here;
        }
        return seen;
    };
    const int high = 58; // rows that the wire crosses
    CHECK(rows(once) < high / 2);
    CHECK(rows(with) > high * 9 / 10);
}

TEST_CASE("a needle that is alone is not lost between the samples") {
    // its box is thinner than a pixel, too: hardly a ray meets that
    const cpu::Picture picture = drawn("background(white)\ncylinder(0.02, 20).paint(black)\n", 0);
    int rows = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            if (byte(picture, x, y, 0) < 255) {
                ++rows;
                break;
            }
    CHECK(rows > height * 3 / 4);
}

TEST_CASE("where a cut ends in the face of what it cuts, or a little beyond, nothing is drawn or "
          "shades") {
    const std::string light = camera + "plane(Y, -1.3)\nsun(direction: [0.5, 0.8, 0.3])\n";
    // what is cut so, and the same solid by a longer tool or by itself
    struct Pair {
        const char *flush, *plain;
        int least = 400; // at most one pixel of so many differs, without occlusion
    };
    const Pair pairs[] = {
        {"cylinder(1, 2) - cylinder(0.8, 2)", "cylinder(1, 2) - cylinder(0.8, 2.5)"},
        {"box(2) - box([1, 1, 1]).translate(y: 0.5)",
         "box(2) - box([1, 1.5, 1]).translate(y: 0.75)"},
        {"box(2) - box(2).translate(x: 1)", "box([1, 2, 2]).translate(x: -0.5)"},
        {"box(2) & box(2).translate(x: 2)", "empty"},
        {"cylinder(1, 0.4) - cylinder(0.7, 0.42)", "cylinder(1, 0.4) - cylinder(0.7, 4)", 200},
        {"sphere(0.7) - sphere(0.72)", "empty"},
        {"box([2, 2, 0.2]) - box([1.4, 1.2, 0.24])", "box([2, 2, 0.2]) - box([1.4, 1.2, 3])"},
        {"sphere(1) | (box(4) - box(4))", "sphere(1)"},
        {"box(1) | (sphere(1) - sphere(1)).translate([1.2, 0.8, 0.4])", "box(1)"},
        {"box([3, 0.2, 3]).rotate(20deg, axis: X) -"
         " cylinder(0.7, 0.2).translate(x: 0.5).rotate(20deg, axis: X)",
         "box([3, 0.2, 3]).rotate(20deg, axis: X) -"
         " cylinder(0.7, 0.4).translate(x: 0.5).rotate(20deg, axis: X)"},
        {"smooth_union(0.2) { box([3, 0.2, 3]) - cylinder(0.7, 0.2); sphere(0.3) }",
         "smooth_union(0.2) { box([3, 0.2, 3]) - cylinder(0.7, 0.4); sphere(0.3) }", 120},
    };
    for (const auto &[flush, plain, least] : pairs) {
        INFO(flush);
        for (const char *soft : {"0.002", "0.15"}) {
            INFO("soft_shadows: " << soft);
            // Dots are left where a film meets the ground or a wall; and a blend makes a film thick.
            const auto differ = [&](const std::string &occlusion) {
                const std::string lit =
                    light + "lighting(" + occlusion + ", soft_shadows: " + soft + ")\n";
                return different(drawn(lit + flush + "\n"), drawn(lit + plain + "\n"));
            };
            CHECK(differ("ambient_occlusion: 0") <= width * height / least);
            // With occlusion a few more do.
            CHECK(differ("occlusion_reach: 0.47") <= width * height / std::min(least - 10, 200));
        }
    }
}

TEST_CASE("a sheet as thin as a thousandth is seen whole") {
    const auto hits = [](const char *at, const char *thick) {
        const driver::Compilation sheets =
            compiled(std::string("camera(at: ") + at + ", look_at: [0, 0, 0], fov: 40deg)\n" +
                     "box([1.5, " + thick + ", 1.5]).rotate(0.3, axis: X)\n" +
                     "sphere(0.5).shell(" + thick + ").translate(x: 1.4)\n");
        const cpu::Stage stage = stage_of(sheets.scene);
        std::vector<cpu::Ray> rays;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                rays.push_back(cpu::eye_ray(stage, float(x) + 0.5f, float(y) + 0.5f));
        return std::ranges::count_if(cpu::cast(stage, rays), [](const cpu::Landing &landing) {
            return landing.end == cpu::RayEnd::Hit;
        });
    };
    for (const char *at : {"[0, 6, 0.01]", "[3, 4, 9]", "[0, 0.4, 7]"}) {
        INFO(at);
        CHECK(std::abs(hits(at, "0.001") - hits(at, "0.004")) <= few);
    }
}

TEST_CASE("a thin sheet is seen whole from afar") {
    for (const double away : {100, 200, 300, 400})
        for (const double turned : {0.0, 0.2, 0.5, 0.8}) {
            const auto sheet = [&](const char *thick) {
                return drawn(fmt::format(
                    "camera(at: [{}, 0, {}], fov: {}deg)\nlighting(soft_shadows: 0)\n"
                    "box([2, 2, {}]).paint(tomato)\n",
                    away * turned, away * std::sqrt(1 - turned * turned), 160 / away, thick));
            };
            INFO(away << " away, turned " << turned);
            CHECK(different(sheet("0.001"), sheet("0.003")) <= height); // a column, its side
        }
}

TEST_CASE("what is far away, or a ground's size, changes nothing near") {
    const std::string solid = "camera(at: [3, 4, 5], look_at: [0, 0, 0], fov: 30deg)\n"
                              "box(1)\nsphere(0.6).translate(y: 0.8)\n"
                              "lighting(ambient_occlusion: 1, occlusion_reach: 0.3)\n";
    const auto ground = [&](const char *size, const char *hidden = "") {
        return drawn(solid + "box([" + size + ", 1, " + size + "]).translate(y: -1)\n" + hidden);
    };
    const cpu::Picture plain = ground("100");
    // Normals are taken as far apart as half a pixel: a few at edges differ.
    CHECK(different(plain, ground("2000")) <= width * height / 80);
    CHECK(different(plain, ground("100", "sphere(1).translate(y: -3000)\n")) <=
          width * height / 80);
}

TEST_CASE("a ball as large as a world has no grain") {
    const cpu::Picture picture =
        drawn(camera + "sphere(1000).translate(y: -1000)\nsun(direction: [0.5, 0.8, 0.3])\n");
    int rough = 0;
    for (int y = height / 2; y < height; ++y)
        for (int x = 1; x < width; ++x)
            rough += std::abs(byte(picture, x, y, 1) - byte(picture, x - 1, y, 1)) > 3;
    CHECK(rough <= few);
}

TEST_CASE("where a field has no gradient on its surface, that is shaded as it lies") {
    const std::string before = "camera(at: [1, 1.6, 4], look_at: [0, 0, 0], fov: 40deg)\n"
                               "lighting(shadow_darkness: 0, ambient_occlusion: 0)\n"
                               "implicit(p => ",
                      after = ", within: ball(1.6))\n";
    const std::array<std::pair<const char *, const char *>, 4> fields{{
        {"(length(p) - 1) ^ 3", "length(p) - 1"},
        {"(length(p) - 1) ^ 3 - (0.3 * p.y) ^ 3", "length(p) - 1 - 0.3 * p.y"},
        {"(length(p) - 1) * abs(length(p) - 1)", "length(p) - 1"},
        {"(0.9 * p.x + 0.3 * p.y) ^ 5 - (0.4 * p.z) ^ 5", "0.9 * p.x + 0.3 * p.y - 0.4 * p.z"},
    }};
    for (const auto &[cubed, plain] : fields) {
        INFO(cubed);
        CHECK(different(drawn(before + cubed + after), drawn(before + plain + after)) <= 12 * few);
    }
}
