// Every entry that makes a solid against its independent definition: the sign everywhere, the
// distance where it claims to be exact, the bound between pairs of points, and the claims of box,
// mirror planes and moment arm.
#include "definitions.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace fathom;
using namespace fathom::test;

namespace {

std::vector<Solid> all_solids() {
    std::vector<Solid> all;
    for (auto part : {round_solids(), straight_solids(), flat_solids(), combined_solids(),
                      transformed_solids()})
        all.insert(all.end(), part.begin(), part.end());
    return all;
}

std::vector<Point> places(std::size_t count, double reach, std::uint64_t seed) {
    Numbers numbers(seed);
    std::vector<Point> points;
    for (std::size_t i = 0; i < count; ++i) points.push_back(numbers.in(-reach, reach));
    return points;
}

// Float32 near the surface, and definitions by samples: within this of it the sign says nothing.
constexpr double band = 2e-4;

void check_sign(const Solid &solid, const Field &field) {
    std::vector<Point> points = places(20000, solid.reach, 1);
    std::vector<double> d = field.at(points);
    int wrong = 0, in = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        bool inside = solid.inside(points[i]);
        in += inside;
        if (std::abs(d[i]) > band && (d[i] < 0) != inside && wrong++ == 0)
            UNSCOPED_INFO("at " << points[i][0] << ", " << points[i][1] << ", " << points[i][2]
                                << ": " << d[i] << (inside ? ", inside" : ", outside"));
    }
    CHECK(wrong == 0);
    CHECK(in > 0); // else the definition tests nothing
}

// No step passes the surface; where the field claims to be exact, it is as long as can be.
void check_distance(const Solid &solid, const Field &field) {
    const int n = 56;
    std::vector<Point> surface = border(solid.inside, solid.reach, n);
    REQUIRE(!surface.empty());
    std::vector<Point> points = places(250, 1.3 * solid.reach, 2);
    std::vector<double> d = field.at(points);
    Numbers numbers(5);
    double over = 0, under = 0;
    std::size_t worst = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        double truth = way_to_border(solid.inside, surface, points[i], numbers);
        over = std::max(over, std::abs(d[i]) - truth);
        if (truth - std::abs(d[i]) > under) under = truth - std::abs(d[i]), worst = i;
    }
    CHECK(over < 1e-3);
    if (solid.exact && !solid.endless) {
        INFO("at " << points[worst][0] << ", " << points[worst][1] << ", " << points[worst][2]
                   << ": " << d[worst]);
        CHECK(under < 0.025); // what trying leaves of sharp tips
    }
}

// The marched field changes by no more than the way between two points, near ones and far ones.
void check_slope(const Solid &solid, const Field &field) {
    Numbers numbers(3);
    std::vector<Point> a, b;
    for (int i = 0; i < 20000; ++i) {
        a.push_back(numbers.in(-2 * solid.reach, 2 * solid.reach));
        double step = solid.reach * std::pow(10, -3 * numbers.next());
        b.push_back(a.back() + step * numbers.in(-1, 1));
    }
    std::vector<double> fa = field.at(a), fb = field.at(b);
    double steepest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        double way = norm(a[i] - b[i]), slack = 4e-6 * (1 + std::abs(fa[i]));
        if (way > 1e-4) steepest = std::max(steepest, (std::abs(fa[i] - fb[i]) - slack) / way);
    }
    CHECK(steepest < 1.0001);
}

const ir::Library *claims_of(const ir::Scene &scene) {
    if (!scene.root) return nullptr;
    const ir::Shape &root = scene.shapes[scene.root];
    if (root.kind != ir::ShapeKind::Library) return nullptr;
    const ir::Library &library = scene.shapes.libraries[root.payload];
    return library.has_claims ? &library : nullptr;
}

double component(const ir::Scene &scene, ir::NodeId id, int i) {
    return scene.graph.constant_of(id).value[static_cast<std::size_t>(i)];
}

void check_claims(const Solid &solid, const Field &field) {
    const ir::Library *library = claims_of(field.scene());
    if (!library) return;
    const ir::Claims &claims = library->claims;
    CHECK((claims.kind == ir::FieldKind::Exact) == solid.exact);

    std::vector<Point> points = places(4000, solid.reach, 4);
    if (claims.lo && claims.hi) {
        for (int axis = 0; axis < 3; ++axis) {
            double lo = component(field.scene(), claims.lo, axis),
                   hi = component(field.scene(), claims.hi, axis);
            for (const Point &p : points) {
                double x = p[static_cast<std::size_t>(axis)];
                if (solid.inside(p) && (x < lo - 1e-6 || x > hi + 1e-6)) {
                    FAIL_CHECK("inside, but outside of the box: " << p[0] << ", " << p[1] << ", "
                                                                  << p[2]);
                    return;
                }
            }
        }
    }
    std::vector<double> d = field.at(points);
    if (claims.growth_rate && claims.lo && claims.hi) {
        const double growth_rate = component(field.scene(), claims.growth_rate, 0);
        // the field at hand is the marched one, divided by its bound
        const double slope = claims.lipschitz ? component(field.scene(), claims.lipschitz, 0) : 1;
        for (std::size_t i = 0; i < points.size(); ++i)
            for (int axis = 0; axis < 3; ++axis) {
                const double x = points[i][static_cast<std::size_t>(axis)],
                             by = growth_rate * slope * std::max(d[i], 0.0) + 1e-5;
                if (x < component(field.scene(), claims.lo, axis) - by ||
                    x > component(field.scene(), claims.hi, axis) + by) {
                    FAIL_CHECK("the field is " << d[i] << " outside of the box grown by " << by);
                    return;
                }
            }
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!claims.symmetric[axis]) continue;
        std::vector<Point> mirrored = points;
        for (Point &p : mirrored) p[axis] = -p[axis];
        std::vector<double> m = field.at(mirrored);
        double maximum = 0;
        for (std::size_t i = 0; i < d.size(); ++i)
            maximum = std::max(maximum, std::abs(d[i] - m[i]));
        INFO("mirrored across axis " << axis);
        CHECK(maximum < 1e-5);
    }
    const double h = 1e-2;
    for (int axis = 0; axis < 3; ++axis) {
        ir::NodeId moment_arm = claims.moment_arm[static_cast<std::size_t>(axis)];
        if (!moment_arm) continue;
        double bound = component(field.scene(), moment_arm, 0), maximum = 0;
        // turned a little about the axis, the field changes by at most the moment arm times the
        // angle
        std::vector<Point> turned = points;
        auto j = static_cast<std::size_t>((axis + 1) % 3),
             k = static_cast<std::size_t>((axis + 2) % 3);
        for (Point &p : turned) {
            double x = p[j], y = p[k];
            p[j] = std::cos(h) * x - std::sin(h) * y;
            p[k] = std::sin(h) * x + std::cos(h) * y;
        }
        std::vector<double> t = field.at(turned);
        for (std::size_t i = 0; i < d.size(); ++i)
            maximum = std::max(maximum, std::abs(d[i] - t[i]) / h);
        INFO("turned about axis " << axis);
        CHECK(maximum <= bound + 1e-3);
    }
}

} // namespace

TEST_CASE("each solid is the one that its definition says", "[stdlib]") {
    for (const Solid &solid : all_solids()) {
        DYNAMIC_SECTION(solid.text) {
            Field field(solid.text);
            INFO(field.said());
            REQUIRE(field.good());
            check_sign(solid, field);
            check_distance(solid, field);
            check_slope(solid, field);
            check_claims(solid, field);
        }
    }
}

// A profile's edge on the axis is inside of the solid; were it a surface, what is cut out with it
// would keep a needle there, and rays past it would crawl.
TEST_CASE("nothing is left along the axis of what is turned", "[stdlib]") {
    Field cut("box(4) - rectangle([0.8, 1]).translate(x: 0.4).revolve()");
    REQUIRE(cut.good());
    for (double y = -0.4; y < 0.45; y += 0.1)
        CHECK(cut.at({{1e-9, y, 0}})[0] == Approx(0.5 - std::abs(y)).margin(1e-6));
}

// By the orbits of z^8 + p, z as (radius, latitude, longitude): what never leaves is solid, what
// leaves at once is not.
TEST_CASE("the mandelbulb holds what stays bounded", "[stdlib]") {
    Field field("mandelbulb(8, 8)");
    REQUIRE(field.good());
    const std::vector<Point> points = places(20000, 1.3, 6);
    const std::vector<double> d = field.at(points);
    int bounded = 0, wrong = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        Point z = points[i];
        int iterations = 0;
        while (iterations < 60 && norm(z) < 2) {
            const double r = norm(z), latitude = 8 * std::asin(z[1] / std::max(r, 1e-12)),
                         longitude = 8 * std::atan2(z[2], z[0]);
            z = points[i] + std::pow(r, 8) * Point{std::cos(latitude) * std::cos(longitude),
                                                   std::sin(latitude),
                                                   std::cos(latitude) * std::sin(longitude)};
            ++iterations;
        }
        bounded += iterations == 60;
        wrong += (iterations == 60 && d[i] > 1e-3) || (iterations < 5 && d[i] < 0);
    }
    CHECK(bounded > 1000);
    CHECK(wrong == 0);
}

// A solid, operation or transform that nobody has defined anew here would be believed as it is.
TEST_CASE("every entry that makes or changes a solid has a definition of its own", "[stdlib]") {
    std::string all = " mandelbulb( "; // above; images and grids have their own tests
    for (const Solid &solid : all_solids()) all += " " + solid.text;
    for (const typecheck::LibraryEntry &entry :
         typecheck::library_entries(driver::standard_library())) {
        if (entry.file == "built in" || entry.file == "dfmodel" || entry.file == "fields.sdf" ||
            entry.file == "looks.sdf" || entry.file == "motion.sdf" ||
            entry.name == "displace_map" || entry.name == "distance_grid")
            continue;
        INFO(entry.file << ": " << entry.signature);
        bool defined = false;
        for (std::size_t at = all.find(entry.name); at != all.npos;
             at = all.find(entry.name, at + 1)) {
            const char after =
                at + entry.name.size() < all.size() ? all[at + entry.name.size()] : ' ';
            const char before = all[at - 1];
            defined = defined || ((after == '(' || after == ' ') &&
                                  (before == ' ' || before == '.' || before == '('));
        }
        CHECK(defined);
    }
}
