// Flat shapes, seen through `extrude` and `revolve`.
#include "definitions.h"

#include <algorithm>
#include <cmath>

namespace fathom::test {

namespace {

using Flat = std::function<bool(double, double)>;
using Corners = std::vector<std::array<double, 2>>;

Solid extruded(const std::string &text, const Flat &inside, bool exact, double reach = 1.3) {
    return {text + ".extrude(0.6)",
            [=](Point p) { return std::abs(p[2]) < 0.3 && inside(p[0], p[1]); }, reach, exact};
}

Corners star_corners(int tips, double outer, double inner) {
    Corners corners;
    for (int i = 0; i < 2 * tips; ++i) {
        double a = pi * i / tips, r = i % 2 ? inner : outer;
        corners.push_back({r * std::cos(a), r * std::sin(a)});
    }
    return corners;
}

bool near_bezier(double x, double y, const Corners &c, double r) {
    double minimum = 1e9;
    Point before{};
    for (int i = 0; i <= 400; ++i) {
        double t = i / 400.0, a = (1 - t) * (1 - t), b = 2 * t * (1 - t), d = t * t;
        Point at{a * c[0][0] + b * c[1][0] + d * c[2][0], a * c[0][1] + b * c[1][1] + d * c[2][1],
                 0};
        if (i > 0) minimum = std::min(minimum, to_segment({x, y, 0}, before, at));
        before = at;
    }
    return minimum < r;
}

} // namespace

// Long: the table, a row for each shape.
std::vector<Solid> flat_solids() {
    const Inside can = [](Point p) { return std::hypot(p[0], p[2]) < 0.8 && std::abs(p[1]) < 0.5; };
    const Corners arrow{{-1, -0.6}, {1, -0.6}, {0.3, 0}, {0, 0.9}};
    const Corners pentagon{star_corners(5, 0.8, 0.8 * std::cos(pi / 5))};
    return {
        extruded(
            "circle(0.8)", [](double x, double y) { return std::hypot(x, y) < 0.8; }, true),
        extruded(
            "ellipse([1, 0.5])", [](double x, double y) { return std::hypot(x, 2 * y) < 1; },
            false),
        extruded(
            "rectangle([1.5, 0.8])",
            [](double x, double y) { return std::abs(x) < 0.75 && std::abs(y) < 0.4; }, true),
        extruded(
            "rounded_rectangle([1.5, 0.8], 0.2)",
            [](double x, double y) {
                return std::hypot(std::max(std::abs(x) - 0.55, 0.0),
                                  std::max(std::abs(y) - 0.2, 0.0)) < 0.2;
            },
            true),
        extruded(
            "polygon([[-1, -0.6], [1, -0.6], [0.3, 0], [0, 0.9]])",
            [=](double x, double y) { return in_polygon(x, y, arrow); }, true),
        extruded(
            "polygon([[0, 0.9], [0.3, 0], [1, -0.6], [-1, -0.6]])",
            [=](double x, double y) { return in_polygon(x, y, arrow); }, true),
        extruded(
            "regular_polygon(5, 0.8)",
            [=](double x, double y) { return in_polygon(x, y, pentagon); }, true),
        extruded(
            "star(5, 1, 0.4)",
            [=](double x, double y) { return in_polygon(x, y, star_corners(5, 1, 0.4)); }, true),
        extruded(
            "star(4, 1, 0.9)",
            [=](double x, double y) { return in_polygon(x, y, star_corners(4, 1, 0.9)); }, true),
        extruded(
            "segment([-1, 0], [0.8, 0.5], 0.3)",
            [](double x, double y) {
                return to_segment({x, y, 0}, {-1, 0, 0}, {0.8, 0.5, 0}) < 0.15;
            },
            true),
        extruded(
            "arc(0.8, 120deg, 0.2)",
            [](double x, double y) {
                double a = std::clamp(std::atan2(y, x), -pi * 2 / 3, pi * 2 / 3);
                return std::hypot(x - 0.8 * std::cos(a), y - 0.8 * std::sin(a)) < 0.1;
            },
            true),
        extruded(
            "ring(1, 0.6)",
            [](double x, double y) { return std::hypot(x, y) < 1 && std::hypot(x, y) > 0.6; },
            true),
        extruded(
            "bezier([-1, -0.4], [0, 1.4], [1, -0.4], 0.2)",
            [](double x, double y) {
                return near_bezier(x, y, {{-1, -0.4}, {0, 1.4}, {1, -0.4}}, 0.1);
            },
            false),
        extruded(
            "bezier([-1, -0.4], [0.9, -0.8], [-0.6, 0.9], 0.15)",
            [](double x, double y) {
                return near_bezier(x, y, {{-1, -0.4}, {0.9, -0.8}, {-0.6, 0.9}}, 0.075);
            },
            false),
        extruded(
            "bezier([-1, -0.5], [0, 0], [1, 0.5], 0.2)",
            [](double x, double y) {
                return to_segment({x, y, 0}, {-1, -0.5, 0}, {1, 0.5, 0}) < 0.1;
            },
            false),
        {"rectangle([0.4, 0.8]).revolve(0.7)",
         [](Point p) {
             return std::abs(std::hypot(p[0], p[2]) - 0.7) < 0.2 && std::abs(p[1]) < 0.4;
         },
         1.2, true},
        {"polygon([[0, -0.6], [0.8, -0.6], [0, 0.9]]).revolve()",
         [](Point p) { return p[1] > -0.6 && std::hypot(p[0], p[2]) < 0.8 * (0.9 - p[1]) / 1.5; },
         1.2, true},
        // edges on the axis are no surface, wherever the profile was made
        {"rectangle([0.8, 1]).translate(x: 0.4).revolve()", can, 1.2, true},
        {"rectangle([0.5, 0.4]).scale(-2).rotate(-90deg).reflect([1, 0]).translate(x: "
         "0.4).revolve()",
         can, 1.2, true},
        {"regular_polygon(4, sqrt(0.5)).rotate(45deg).scale([0.8, 1]).translate(x: "
         "0.2).revolve(0.2)",
         can, 1.2, false},
        {"sphere(1.1) - (rectangle([0.8, 1]).translate(x: 0.4) & circle(0.7)).paint(red).revolve()",
         [=](Point p) { return norm(p) < 1.1 && !(can(p) && norm(p) < 0.7); }, 1.2, false},
        {"rectangle([1, 1]).extrude(1.6, taper: 0.5)",
         [](Point p) {
             double half = 0.5 * (1 - 0.5 * (p[2] + 0.8) / 1.6);
             return std::abs(p[2]) < 0.8 && std::abs(p[0]) < half && std::abs(p[1]) < half;
         },
         1.2, false},
        {"rectangle([1, 0.5]).extrude(1.6, twist: 90deg)",
         [](Point p) {
             double a = -pi / 2 * p[2] / 1.6;
             double x = std::cos(a) * p[0] - std::sin(a) * p[1],
                    y = std::sin(a) * p[0] + std::cos(a) * p[1];
             return std::abs(p[2]) < 0.8 && std::abs(x) < 0.5 && std::abs(y) < 0.25;
         },
         1.2, false},
        {"rectangle([1, 0.5]).rotate(30deg).translate([0.2, 0.1]).mirror(X).extrude(0.5)",
         [](Point p) {
             if (std::abs(p[2]) > 0.25) return false;
             for (double side : {-1.0, 1.0}) {
                 double x = side * p[0] - 0.2, y = p[1] - 0.1, c = std::cos(pi / 6),
                        s = std::sin(pi / 6);
                 if (std::abs(c * x + s * y) < 0.5 && std::abs(c * y - s * x) < 0.25) return true;
             }
             return false;
         },
         1.2, false},
        {"circle(0.3).repeat([0.7, 0.8], count: [3, 2]).extrude(0.4)",
         [](Point p) {
             if (std::abs(p[2]) > 0.2) return false;
             for (double x : {-0.7, 0.0, 0.7})
                 for (double y : {-0.4, 0.4})
                     if (std::hypot(p[0] - x, p[1] - y) < 0.3) return true;
             return false;
         },
         1.3, false},
        {"(circle(0.8) - rectangle([0.6, 0.6])).scale([1, 0.5]).extrude(0.4)",
         [](Point p) {
             return std::abs(p[2]) < 0.2 && std::hypot(p[0], 2 * p[1]) < 0.8 &&
                    !(std::abs(p[0]) < 0.3 && std::abs(2 * p[1]) < 0.3);
         },
         1.2, false},
    };
}

} // namespace fathom::test
