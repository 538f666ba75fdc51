// What is made of shapes: sets and their profiles, blends, transforms, repetitions.
#include "definitions.h"

#include <algorithm>
#include <cmath>

namespace fathom::test {

namespace {

bool in_ball(Point p, Point at, double r) { return norm(p - at) < r; }
double box_field(Point p, double size) { // the distance to a cube
    double out = 0, in = -1e9;
    for (double x : p) {
        double d = std::abs(x) - size / 2;
        out += std::max(d, 0.0) * std::max(d, 0.0);
        in = std::max(in, d);
    }
    return std::sqrt(out) + std::min(in, 0.0);
}
// Turned by `angle`, counter-clockwise seen from the tip of axis 0, 1 or 2.
Point turned(Point p, double angle, int axis) {
    auto j = static_cast<std::size_t>((axis + 1) % 3), k = static_cast<std::size_t>((axis + 2) % 3);
    double c = std::cos(angle), s = std::sin(angle);
    Point q = p;
    q[j] = c * p[j] - s * p[k];
    q[k] = s * p[j] + c * p[k];
    return q;
}
// Two walls that meet at a right angle, x < 0 and y < 0, and what a profile of radius 0.5 adds to
// them.
using Profile = std::function<bool(double, double)>;
Solid corner(const std::string &call, const Profile &added) {
    return {call + "plane(X), plane(Y))",
            [=](Point p) { return p[0] < 0 || p[1] < 0 || added(p[0], p[1]); }, 1, false};
}
// The same for what is left of their intersection, x < 0 and y < 0: a profile takes away what it
// adds, seen from within.
Solid edge(const std::string &call, const Profile &added) {
    return {call + "plane(X), plane(Y))",
            [=](Point p) { return p[0] < 0 && p[1] < 0 && !added(-p[0], -p[1]); }, 1, false};
}

const Point origin{0, 0, 0};

} // namespace

std::vector<Solid> combined_solids() {
    auto fillet = [](double x, double y) {
        return x < 0.5 && y < 0.5 && std::hypot(x - 0.5, y - 0.5) > 0.5;
    };
    auto bevel = [](double x, double y) { return x + y < 0.5; };
    // 2 treads and 3 risers between (0, 0.6) and (0.6, 0)
    auto stairs = [](double x, double y) { return std::floor(x / 0.2) + std::floor(y / 0.2) < 2; };
    // 3 columns side by side on a chamfer; the whole, with the chamfer behind, reaches 0.5 along
    // both walls
    auto columns = [](double x, double y) {
        const double c = 0.5 * std::sqrt(2) / (4 + std::sqrt(2)), middle = (0.5 - 2 * c) / 2;
        if (x + y < 2 * middle) return true;
        for (int i : {-1, 0, 1})
            if (std::hypot(x - middle + i * c * std::sqrt(2), y - middle - i * c * std::sqrt(2)) <
                c)
                return true;
        return false;
    };
    auto smooth = [](double x, double y) {
        double h = std::max(0.5 - std::abs(x - y), 0.0);
        return std::min(x, y) < h * h / 2;
    };
    Point right{0.8, 0, 0};
    auto blob = [=](Point p) {
        double a = norm(p) - 0.7, b = norm(p - right) - 0.5,
               h = std::max(0.4 - std::abs(a - b), 0.0);
        return std::min(a, b) - h * h / 1.6 < 0;
    };
    return {
        {"union { sphere(1); box([3, 0.4, 0.4]) }",
         [](Point p) { return in_ball(p, origin, 1) || in_box(p, 3, 0.4, 0.4); }, 1.7, false},
        {"sphere(1) | box([3, 0.4, 0.4])",
         [](Point p) { return in_ball(p, origin, 1) || in_box(p, 3, 0.4, 0.4); }, 1.7, false},
        {"intersection { sphere(1); box(1.5) }",
         [](Point p) { return in_ball(p, origin, 1) && in_box(p, 1.5, 1.5, 1.5); }, 1.2, false},
        {"difference { box(1.6); sphere(1) }",
         [](Point p) { return in_box(p, 1.6, 1.6, 1.6) && !in_ball(p, origin, 1); }, 1.2, false},
        {"box(1.6) - sphere(1)",
         [](Point p) { return in_box(p, 1.6, 1.6, 1.6) && !in_ball(p, origin, 1); }, 1.2, false},
        {"xor { sphere(0.8); sphere(0.8).translate(x: 0.8) }",
         [=](Point p) { return in_ball(p, origin, 0.8) != in_ball(p, right, 0.8); }, 1.8, false},
        {"complement(sphere(1)) & box(2)",
         [](Point p) { return !in_ball(p, origin, 1) && in_box(p, 2, 2, 2); }, 1.2, false},
        {"empty | sphere(1)", [](Point p) { return in_ball(p, origin, 1); }, 1.2, true},
        {"smooth_union(0.4) { sphere(0.7); sphere(0.5).translate(x: 0.8) }", blob, 1.5, false},
        {"smooth_union(0.4, mix: true) { sphere(0.7); sphere(0.5).translate(x: 0.8) }", blob, 1.5,
         false},
        corner("smooth_union(0.5, ", smooth),
        edge("smooth_intersection(0.5, ", smooth),
        {"smooth_difference(0.5) { plane(X); plane(-Y) }",
         [=](Point p) { return p[0] < 0 && p[1] < 0 && !smooth(-p[0], -p[1]); }, 1, false},
        corner("round_union(0.5, ", fillet),
        edge("round_intersection(0.5, ", fillet),
        {"round_difference(0.5) { plane(X); plane(-Y) }",
         [=](Point p) { return p[0] < 0 && p[1] < 0 && !fillet(-p[0], -p[1]); }, 1, false},
        corner("chamfer_union(0.5, ", bevel),
        edge("chamfer_intersection(0.5, ", bevel),
        {"chamfer_difference(0.5) { plane(X); plane(-Y) }",
         [=](Point p) { return p[0] < 0 && p[1] < 0 && !bevel(-p[0], -p[1]); }, 1, false},
        corner("stairs_union(0.6, 2, ", stairs),
        edge("stairs_intersection(0.6, 2, ", stairs),
        {"stairs_difference(0.6, 2) { plane(X); plane(-Y) }",
         [=](Point p) { return p[0] < 0 && p[1] < 0 && !stairs(-p[0], -p[1]); }, 1, false},
        corner("columns_union(0.5, 3, ", columns),
        edge("columns_intersection(0.5, 3, ", columns),
        {"columns_difference(0.5, 3) { plane(X); plane(-Y) }",
         [=](Point p) { return p[0] < 0 && p[1] < 0 && !columns(-p[0], -p[1]); }, 1, false},
        {"pseudonorm_blend(sphere(0.6).translate(x: -0.5), sphere(0.6).translate(x: 0.5), 4)",
         [](Point p) {
             double a = std::max(1.6 - norm(p - Point{-0.5, 0, 0}), 0.0),
                    b = std::max(1.6 - norm(p - Point{0.5, 0, 0}), 0.0);
             return std::pow(a, 4) + std::pow(b, 4) > 1;
         },
         1.4, false},
        {"pipe(sphere(1), plane(Y, 0.3), 0.1)",
         [](Point p) { return std::hypot(norm(p) - 1, p[1] - 0.3) < 0.1; }, 1.3, false},
        {"engrave(plane(X), plane(Y), 0.3)",
         [](Point p) { return p[0] < 0 && !(-p[0] < 0.3 - std::abs(p[1])); }, 1, false},
        {"groove(plane(X), plane(Y), 0.3, 0.2)",
         [](Point p) { return p[0] < 0 && !(std::abs(p[1]) < 0.15 && p[0] > -0.2); }, 1, false},
        {"tongue(plane(X), plane(Y), 0.3, 0.2)",
         [](Point p) { return p[0] < 0 || (std::abs(p[1]) < 0.15 && p[0] < 0.2); }, 1, false},
        {"blend(box(1.4), sphere(1), 0.4)",
         [](Point p) { return 0.4 * box_field(p, 1.4) + 0.6 * (norm(p) - 1) < 0; }, 1.5, false},
        {"blend(box(1.4), sphere(1), p => clamp(length(p) / 2, 0, 1)) & box(2)",
         [](Point p) {
             double t = std::clamp(norm(p) / 2, 0.0, 1.0);
             return t * box_field(p, 1.4) + (1 - t) * (norm(p) - 1) < 0 && in_box(p, 2, 2, 2);
         },
         1.5, false},
    };
}

// Long: the table, a row for each transform.
std::vector<Solid> transformed_solids() {
    auto stick = [](Point p) { return in_box(p, 2, 0.5, 0.8); };
    Point off{0.5, 0.1, 0.2};
    auto capsule = [](Point p) { return to_segment(p, {0.4, 0, 0}, {1, 0.8, 0}) < 0.2; };
    return {
        {"box([2, 0.5, 0.8]).translate([0.2, 0.1, 0], z: 0.3)",
         [=](Point p) {
             return stick(p - Point{0.2, 0.1, 0.3});
         },
         1.5, false},
        {"box([2, 0.5, 0.8]).rotate(30deg, axis: Z)",
         [=](Point p) { return stick(turned(p, -pi / 6, 2)); }, 1.4, false},
        {"box([2, 0.5, 0.8]).rotate(30deg)", [=](Point p) { return stick(turned(p, -pi / 6, 1)); },
         1.4, false},
        {"box([2, 0.5, 0.8]).rotate_euler([20deg, 30deg, 40deg])",
         [=](Point p) {
             return stick(turned(turned(turned(p, -pi * 2 / 9, 2), -pi / 6, 1), -pi / 9, 0));
         },
         1.4, false},
        {"box([2, 0.5, 0.8]).orient(X, [0, 3, 0])",
         [=](Point p) { return stick(turned(p, -pi / 2, 2)); }, 1.4, false},
        {"sphere(1).scale([1.4, 0.7, -1])",
         [](Point p) {
             return norm({p[0] / 1.4, p[1] / 0.7, p[2]}) < 1;
         },
         1.6, false},
        {"sphere(0.5).scale(2)", [](Point p) { return norm(p) < 1; }, 1.3, false},
        {"capsule([0.4, 0, 0], [1, 0.8, 0], 0.2).reflect([1, 1, 0])",
         [=](Point p) {
             return capsule({-p[1], -p[0], p[2]});
         },
         1.4, false},
        {"capsule([0.4, 0, 0], [1, 0.8, 0], 0.2).mirror(X)",
         [=](Point p) {
             return capsule(p) || capsule({-p[0], p[1], p[2]});
         },
         1.4, false},
        {"sphere(0.7).translate(x: 0.4).turnaround()",
         [](Point p) {
             return in_ball({std::abs(p[0]), p[1], p[2]}, {0.4, 0, 0}, 0.7);
         },
         1.3, false},
        {"box([1, 2, 0.6]).twist(45deg)",
         [](Point p) { return in_box(turned(p, -pi / 4 * p[1], 1), 1, 2, 0.6); }, 1.3, false},
        {"box([2, 1, 0.6]).twist(1, axis: -X)",
         [](Point p) { return in_box(turned(p, -p[0], 0), 2, 1, 0.6); }, 1.3, false},
        {"cylinder(0.8, 2).taper(0.4)",
         [](Point p) {
             return std::abs(p[1]) < 1 && std::hypot(p[0], p[2]) < 0.8 * (1 - 0.6 * (p[1] + 1) / 2);
         },
         1.3, false},
        {"sphere(0.5).elongate([1, 0, 0.4])",
         [](Point p) {
             return norm({std::max(std::abs(p[0]) - 0.5, 0.0), p[1],
                          std::max(std::abs(p[2]) - 0.2, 0.0)}) < 0.5;
         },
         1.2, false},
        {"sphere(1).hyperize(2)",
         [](Point p) {
             return norm({p[0] * p[0], p[1] * p[1], p[2] * p[2]}) < 1;
         },
         1.3, false},
        {"plane(Y).within(ball(1))", [](Point p) { return p[1] < 0 && norm(p) < 1; }, 1.2, false},
        {"box([1.4, 0.8, 0.6]).offset(0.2)",
         [](Point p) {
             Point q{std::clamp(p[0], -0.7, 0.7), std::clamp(p[1], -0.4, 0.4),
                     std::clamp(p[2], -0.3, 0.3)};
             return norm(p - q) < 0.2;
         },
         1.3, false},
        {"sphere(1).shell(0.2)", [](Point p) { return std::abs(norm(p) - 1) < 0.1; }, 1.3, false},
        {"sphere(0.9).displace(p => 0.05 * sin(9 * p.x) * sin(9 * p.y))",
         [](Point p) { return norm(p) - 0.9 < 0.05 * std::sin(9 * p[0]) * std::sin(9 * p[1]); },
         1.2, false},
        {"sphere(0.9).displace(0.1)", [](Point p) { return norm(p) < 1; }, 1.2, false},
        {"box([0.6, 2, 0.6]).distort(p => [p.x + 0.2 * sin(2 * p.y), p.y, p.z])",
         [](Point p) {
             return in_box({p[0] + 0.2 * std::sin(2 * p[1]), p[1], p[2]}, 0.6, 2, 0.6);
         },
         1.3, false},
        {"sphere(0.3).translate([0.1, 0, 0]).repeat([0.8, 0, 1], count: [3, 1, 2])",
         [](Point p) {
             for (double x : {-0.8, 0.0, 0.8})
                 for (double z : {-0.5, 0.5})
                     if (in_ball(p, {x + 0.1, 0, z}, 0.3)) return true;
             return false;
         },
         1.4, false},
        {"sphere(0.3).translate([0.1, 0, 0]).repeat([0.7, 0, 0]) & box(2)",
         [](Point p) {
             for (int i = -4; i <= 4; ++i)
                 if (in_ball(p, {0.7 * i + 0.1, 0, 0}, 0.3)) return in_box(p, 2, 2, 2);
             return false;
         },
         1.2, false},
        {"sphere(0.1).repeat([0.6, 0, 0], count: [3, 1, 1], copies: (s, id) => s.offset(0.08 * "
         "id.x))",
         [](Point p) {
             for (int i = 0; i < 3; ++i)
                 if (in_ball(p, {0.6 * (i - 1), 0, 0}, 0.1 + 0.08 * i)) return true;
             return false;
         },
         1, false},
        {"sphere(0.2).translate(x: 0.8).repeat_polar(7)",
         [](Point p) {
             for (int i = 0; i < 7; ++i)
                 if (in_ball(p, turned({0.8, 0, 0}, 2 * pi * i / 7, 1), 0.2)) return true;
             return false;
         },
         1.2, false},
        {"sphere(0.2).translate(x: 0.8).repeat_polar(4, axis: [0, 1, 1])",
         [](Point p) {
             double h = 0.8 / std::sqrt(2.0);
             for (Point at :
                  {Point{0.8, 0, 0}, Point{-0.8, 0, 0}, Point{0, h, -h}, Point{0, -h, h}})
                 if (in_ball(p, at, 0.2)) return true;
             return false;
         },
         1.2, false},
        {"sphere(0.2).translate(x: 0.25).repeat_mirror([0.8, 0, 0]) & box(2)",
         [](Point p) {
             for (int i = -4; i <= 4; ++i)
                 if (in_ball(p, {0.8 * i + (i % 2 ? -0.25 : 0.25), 0, 0}, 0.2))
                     return in_box(p, 2, 2, 2);
             return false;
         },
         1.2, false},
        {"sphere(0.4).translate([0.5, 0.1, 0.2]).bend(20deg)",
         [=](Point p) {
             double a = pi / 9 * p[1]; // q is p turned by rate*y in the (x, y) plane
             Point q{std::cos(a) * p[0] - std::sin(a) * p[1],
                     std::sin(a) * p[0] + std::cos(a) * p[1], p[2]};
             return in_ball(q, off, 0.4);
         },
         1.4, false},
    };
}

} // namespace fathom::test
