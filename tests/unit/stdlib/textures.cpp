// Images on shapes: where a map lies, how far it moves a surface, and that no seam or pole of a
// parametrisation makes the field steeper than its bound. And grids of distances.
#include "base/picture.h"
#include "field.h"
#include "tests/unit/driver/scratch_folder.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <fmt/format.h>

using namespace fathom;
using namespace fathom::test;

namespace {

template <class Gray> std::string png(int width, int height, Gray gray) {
    Picture picture{width, height, {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const auto g = static_cast<std::uint8_t>(gray(x, y));
            picture.rgba.insert(picture.rgba.end(), {g, g, g, 255});
        }
    return encode_png(picture);
}

void write_images(const ScratchFolder &folder) {
    folder.write("white.png", png(2, 2, [](int, int) { return 255; }));
    folder.write("right.png", png(8, 8, [](int x, int) { return x < 4 ? 0 : 255; }));
    folder.write("top.png", png(8, 8, [](int, int y) { return y < 4 ? 255 : 0; }));
    Numbers numbers(11);
    folder.write("rough.png", png(16, 12, [&](int, int) { return 255 * numbers.next(); }));
}

double at(const Field &field, Point p) { return field.at({p})[0]; }

// Where the field changes its sign along the ray from the point out of the origin.
double surface_along(const Field &field, Point way, double from, double to) {
    for (int i = 0; i < 40; ++i) {
        const double middle = (from + to) / 2;
        (at(field, middle * way) < 0 ? from : to) = middle;
    }
    return from;
}

} // namespace

TEST_CASE("a displacement map moves the surface by its brightness", "[textures]") {
    const ScratchFolder folder;
    write_images(folder);
    const auto radius = [&](const std::string &text, Point way) {
        Field field(text, folder.path().string());
        INFO(text << "\n" << field.said());
        REQUIRE(field.good());
        return surface_along(field, way, 0.2, 5);
    };
    const std::string white = "displace_map(image(\"white.png\"), 0.1)";
    CHECK(radius("sphere(1)." + white, {0.6, 0.64, 0.48}) == Approx(1.1).margin(1e-4));
    CHECK(radius("sphere(1).displace_map(image(\"white.png\"), -0.1)", {0.6, 0.64, 0.48}) ==
          Approx(0.9).margin(1e-4));
    CHECK(radius("box(2)." + white, {1, 0, 0}) == Approx(1.1).margin(1e-4));
    // The amount is a length where the call stands, also above a scale; what is cut away is cut
    // less.
    CHECK(radius("sphere(1).scale(2)." + white, {0, 1, 0}) == Approx(2.1).margin(1e-4));
    Field hollow("(sphere(3) - sphere(1))." + white, folder.path().string());
    CHECK(at(hollow, {0, 0.95, 0}) < 0); // the hollow's wall came inward, to 0.9
    CHECK(at(hollow, {0, 0.85, 0}) > 0);
}

TEST_CASE("a map lies upright, and to the right as seen from outside", "[textures]") {
    const ScratchFolder folder;
    write_images(folder);
    struct Case {
        std::string shape;
        Point left, right, low, high; // on the surface, looked at from the front or the side
    };
    const std::vector<Case> cases{
        {"sphere(1)", {-1, 0, 0}, {1, 0, 0}, {0, -0.6, 0.8}, {0, 0.6, 0.8}},
        {"box(2)", {-0.5, 0, 1}, {0.5, 0, 1}, {0, -0.5, 1}, {0, 0.5, 1}},
        {"box(2)", {1, 0, 0.5}, {1, 0, -0.5}, {1, -0.5, 0}, {1, 0.5, 0}}, // its right side
        {"box(2)", {0.5, 0, -1}, {-0.5, 0, -1}, {-1, -0.5, 0}, {-1, 0.5, 0}},
        {"box(2)",
         {-0.5, 1, 0},
         {0.5, 1, 0},
         {0, 1, 0.5},
         {0, 1, -0.5}}, // its top, front edge below
        {"cylinder(1, 2)", {-1, 0, 0}, {1, 0, 0}, {0, -0.7, 1}, {0, 0.7, 1}},
        {"cylinder(1, 2)",
         {-1, 0, 0},
         {1, 0, 0},
         {0.5, -1, 0},
         {0.5, 1, 0}}, // its bottom and its top
        {"torus(1, 0.3)", {-1.3, 0, 0}, {1.3, 0, 0}, {0, -0.3, 1}, {0, 0.3, 1}},
        {"ellipsoid([1, 2, 1])", {-1, 0, 0}, {1, 0, 0}, {0, -1.2, 0.8}, {0, 1.2, 0.8}},
        {"rectangle([2, 2]).extrude(2)",
         {0.3, 0.1, 1},
         {0.7, 0.1, 1},
         {0.1, 0.3, 1},
         {0.1, 0.7, 1}},
    };
    for (const Case &c : cases) {
        INFO(c.shape);
        Field right(c.shape + ".displace_map(image(\"right.png\"), 0.1)", folder.path().string());
        Field top(c.shape + ".displace_map(image(\"top.png\"), 0.1)", folder.path().string());
        REQUIRE(right.good());
        REQUIRE(top.good());
        // a little outside of the undisplaced surface: solid only where the map is white
        const auto out = [](Point p) { return 1.04 * p; };
        CHECK(at(right, out(c.left)) > 0);
        CHECK(at(right, out(c.right)) < 0);
        CHECK(at(top, out(c.low)) > 0);
        CHECK(at(top, out(c.high)) < 0);
    }
    // On a plane an image is a unit of length: 0.2 lies in its left or lower half, 0.7 in the
    // other.
    Field right("plane(Z).displace_map(image(\"right.png\"), 0.1)", folder.path().string());
    Field top("plane(Z).displace_map(image(\"top.png\"), 0.1)", folder.path().string());
    CHECK(at(right, {0.2, 0, 0.05}) > 0);
    CHECK(at(right, {0.7, 0, 0.05}) < 0);
    CHECK(at(top, {0, 0.2, 0.05}) > 0);
    CHECK(at(top, {0, 0.7, 0.05}) < 0);
}

TEST_CASE("a displaced field is no steeper than proved, at seams and poles too", "[textures]") {
    const ScratchFolder folder;
    write_images(folder);
    const std::string map = ".displace_map(image(\"rough.png\"), 0.05";
    for (const char *shape :
         {"sphere(1)", "box([1, 1.6, 2])", "rounded_box([1.5, 1, 1], 0.2)", "cylinder(0.6, 1.8)",
          "cylinder(1, 0.5)", "torus(0.8, 0.3)", "cone(0.7, 1.5)", "icosahedron(1)",
          "ellipsoid([1, 0.6, 0.8])", "plane([1, 2, 3], 0.2)", "star(5, 1, 0.5).extrude(0.6)",
          "circle(0.4).revolve(0.7)", "box(1.4) - sphere(0.9)",
          "sphere(0.6).translate(x: 0.4).scale([1, 2, 1])",
          "union { for i in 0..9 { sphere(0.2 + 0.02 * i).translate(x: 0.3 * i - 1.2) } }"}) {
        for (const char *rest : {")", ", scale: 0.4)"}) {
            const std::string text = "(" + std::string(shape) + ")" + map + rest;
            INFO(text);
            Field field(text, folder.path().string());
            INFO(field.said());
            REQUIRE(field.good());
            Numbers numbers(3);
            std::vector<Point> a, b;
            for (int i = 0; i < 30000; ++i) {
                a.push_back(numbers.in(-1.5, 1.5));
                if (i % 3 == 0)
                    a.back()[0] = 1e-3 * numbers.next(),
                    a.back()[2] = 1e-3 * numbers.next(); // about the axis
                b.push_back(a.back() + std::pow(10, -3 * numbers.next()) * numbers.in(-1, 1));
            }
            const std::vector<double> fa = field.at(a), fb = field.at(b);
            double steepest = 0;
            for (std::size_t i = 0; i < a.size(); ++i) {
                const double way = norm(a[i] - b[i]);
                if (way > 1e-4)
                    steepest = std::max(steepest, (std::abs(fa[i] - fb[i]) - 8e-6) / way);
            }
            CHECK(steepest < 1.0001);
            CHECK(steepest > 0.02); // else the bound says nothing
        }
    }
}

TEST_CASE("wrong images are errors where they are named", "[textures]") {
    const ScratchFolder folder;
    write_images(folder);
    folder.write("broken.png", png(8, 8, [](int, int) { return 9; }).substr(0, 60));
    folder.write("text.png", "this is no image");
    struct Case {
        std::string text, error;
    };
    for (const Case &c : std::vector<Case>{
             {"sphere(1).paint(material(texture: image(\"missing.png\")))", "no such file"},
             {"sphere(1).paint(material(texture: image(\"broken.png\")))", "a broken PNG"},
             {"sphere(1).paint(material(texture: image(\"text.png\")))",
              "neither a PNG nor a JPEG"},
             {"sphere(1).paint(material(texture: image(\"../x.png\")))", "leads out of"},
             {"sphere(1).paint(material(texture: \"white.png\"))", "wants an image"},
             {"sphere(1).paint(material(texture: image(\"white.png\"), texture_scale: 0))",
              "cannot be 0"},
             {"sphere(1).paint(material(texture_scale: 2))", "without a `texture`"},
             {"sphere(1).displace_map(image(\"white.png\"), 0.1, scale: 0)", "cannot be 0"},
             {"sphere(1).displace_map(red, 0.1)", "wants an image"},
             {"gyroid(1, 0.1).displace_map(image(\"white.png\"), 0.1)", "`gyroid` has none"},
             {"implicit(p => length(p) - 1).paint(material(texture: image(\"white.png\")))",
              "has none"},
             {"distance_grid(\"missing.nrrd\")", "no such file"},
             {"distance_grid(\"white.png\")", "neither an NRRD nor an OpenVDB grid"}}) {
        INFO(c.text);
        const driver::Compilation made =
            driver::compile_text("test.sdf", c.text, folder.path(), {});
        INFO(said(made));
        REQUIRE(made.diagnostics.errors() == 1);
        const Diagnostic d = made.diagnostics.sorted()[0];
        CHECK(d.message.find(c.error) != std::string::npos);
        CHECK(d.primary.span.source == SourceId{std::size_t{0}});
    }
}

TEST_CASE("a grid of distances is a solid of its own size, place and slope", "[textures]") {
    ScratchFolder folder;
    // the distance to a ball of radius 0.5 about (0.25, 0, 0), sampled from (-0.5, -0.75, -1) on
    const int n[] = {17, 16, 21};
    const double step = 0.1, lo[] = {-0.55, -0.75, -1};
    std::string text = "NRRD0004\ntype: float\ndimension: 3\nsizes: 17 16 21\nspace directions: "
                       "(0.1,0,0) (0,0.1,0) (0,0,0.1)\n"
                       "space origin: (-0.55,-0.75,-1)\nencoding: ascii\n\n";
    for (int z = 0; z < n[2]; ++z)
        for (int y = 0; y < n[1]; ++y)
            for (int x = 0; x < n[0]; ++x)
                text += fmt::format(
                    "{}\n",
                    norm(Point{lo[0] + step * x - 0.25, lo[1] + step * y, lo[2] + step * z}) - 0.5);
    folder.write("ball.nrrd", text);
    Field field("distance_grid(\"ball.nrrd\")", folder.path().string());
    INFO(field.said());
    REQUIRE(field.good());
    Numbers numbers(9);
    double over = 0, wrong = 0, under = 0;
    for (int i = 0; i < 4000; ++i) {
        const Point p = numbers.in(-2, 2);
        const double d = at(field, p), truth = norm(p - Point{0.25, 0, 0}) - 0.5;
        over = std::max(over, std::abs(d) - std::abs(truth));
        if (std::abs(truth) > 0.02 && (d < 0) != (truth < 0)) ++wrong;
        under = std::max(under, truth - d);
    }
    CHECK(wrong == 0);
    CHECK(over < 0.02); // of the sampling
    CHECK(under < 1.2); // far away it is still a long step
    CHECK(at(field, {2, 0, 0}) > 0.8);
}

TEST_CASE("an isovalue makes a solid of any values, with bound 1, and the solid is framed",
          "[textures]") {
    const ScratchFolder folder;
    // a scan: 3,000 in the middle of a ball and 400 less for each unit, on voxels of 0.5 x 0.5 x 1
    std::string text =
        "NRRD0004\ntype: uint16\ndimension: 3\nsizes: 40 40 24\nencoding: ascii\nspace "
        "directions: (0.5,0,0) (0,0.5,0) (0,0,1)\nspace origin: (100,-10,-12)\n\n";
    const Point middle{108, 0, 0};
    for (int z = 0; z < 24; ++z)
        for (int y = 0; y < 40; ++y)
            for (int x = 0; x < 40; ++x)
                text += fmt::format(
                    "{}\n",
                    std::max(0.0, std::round(3000 - 400 * norm(Point{100 + 0.5 * x, -10 + 0.5 * y,
                                                                     -12.0 + z} -
                                                               middle))));
    folder.write("ct.nrrd", text);
    const std::string call = "distance_grid(\"ct.nrrd\", isovalue: 1800, above: true)";
    for (const std::string &scene :
         {call, std::string("param level = 1800 in 1000..2000\n"
                            "distance_grid(\"ct.nrrd\", isovalue: level, above: true)")}) {
        INFO(scene);
        Field field(scene, folder.path().string());
        INFO(field.said());
        REQUIRE(field.good()); // a ball of radius 3
        CHECK(at(field, middle) < -1.5);
        CHECK(surface_along(field, {1, 0, 0}, 108, 120) == Approx(111).margin(0.1));
        Numbers numbers(7);
        double over = 0, steepest = 0, wrong = 0;
        for (int i = 0; i < 6000; ++i) {
            const Point p = middle + numbers.in(-14, 14), q = p + 0.3 * numbers.in(-1, 1);
            const double d = at(field, p), truth = norm(p - middle) - 3;
            over = std::max(over, std::abs(d) - std::abs(truth));
            steepest = std::max(steepest, (std::abs(d - at(field, q)) - 8e-6) / norm(p - q));
            if (std::abs(truth) > 0.2 && (d < 0) != (truth < 0)) ++wrong;
        }
        CHECK(wrong == 0);
        CHECK(over < 0.1); // of the sampling
        CHECK(steepest <= 1.00001);
        CHECK(steepest > 0.5); // else the bound says nothing
    }
    // the other side: the box without the ball
    Field outside("distance_grid(\"ct.nrrd\", isovalue: 1800)", folder.path().string());
    INFO(outside.said());
    REQUIRE(outside.good());
    CHECK(at(outside, middle) > 1.5);
    CHECK(at(outside, {101, 8, 10}) < 0);

    const driver::Compilation made = driver::compile_text("test.sdf", call, folder.path(), {});
    REQUIRE(made.good());
    for (std::size_t i = 0; i < 3; ++i) { // the ball, with no more than two voxels about it
        CHECK(made.scene.framed.lo[i] <= middle[i] - 3 + 0.1);
        CHECK(made.scene.framed.lo[i] >= middle[i] - 5.1);
        CHECK(made.scene.framed.hi[i] >= middle[i] + 3 - 0.1);
        CHECK(made.scene.framed.hi[i] <= middle[i] + 5.1);
    }

    for (const auto &[wrong, words] : std::vector<std::pair<std::string, std::string>>{
             {"distance_grid(\"ct.nrrd\")", "none of them is below 0"},
             {"distance_grid(\"ct.nrrd\", isovalue: 4000, above: true)",
              "none of them is above 4000"},
             {"distance_grid(\"ct.nrrd\", above: true)", "say both"}}) {
        INFO(wrong);
        const driver::Compilation bad = driver::compile_text("test.sdf", wrong, folder.path(), {});
        REQUIRE(bad.diagnostics.errors() == 1);
        CHECK(bad.diagnostics.sorted()[0].message.find(words) != std::string::npos);
    }
}
