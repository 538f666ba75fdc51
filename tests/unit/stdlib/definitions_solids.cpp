// Round and straight solids.
#include "definitions.h"

#include <algorithm>
#include <cmath>

namespace fathom::test {

namespace {

const double golden = (1 + std::sqrt(5.0)) / 2;

double around_y(Point p) { return std::hypot(p[0], p[2]); }
bool within(double x, double lo, double hi) { return lo < x && x < hi; }
// The way from p to a box about the origin, both by their definition: the box's point with the
// nearest coordinates.
double to_box(Point p, double x, double y, double z) {
    Point q{std::clamp(p[0], -x / 2, x / 2), std::clamp(p[1], -y / 2, y / 2),
            std::clamp(p[2], -z / 2, z / 2)};
    return norm(p - q);
}

// Along the screw line, finely; right-handed about y, so that it turns from x towards -z.
bool in_helix(Point p, double radius, double pitch, double turns, double thickness) {
    if (std::abs(around_y(p) - radius) > thickness ||
        std::abs(p[1]) > pitch * turns / 2 + thickness)
        return false;
    const int n = static_cast<int>(turns * 360);
    const auto at = [&](int i) {
        double t = -pi * turns + 2 * pi * turns * i / n;
        return Point{radius * std::cos(t), pitch * t / (2 * pi), -radius * std::sin(t)};
    };
    // pieces that lie higher or lower than half the thickness are too far
    const auto piece = [&](double y) {
        return std::clamp(n * (y / (pitch * turns) + 0.5), 0.0, double(n));
    };
    const int first = static_cast<int>(piece(p[1] - thickness / 2)),
              last = static_cast<int>(std::ceil(piece(p[1] + thickness / 2)));
    for (int i = first; i < std::max(last, first + 1) && i < n; ++i)
        if (to_segment(p, at(i), at(i + 1)) < thickness / 2) return true;
    return to_segment(p, at(first == n ? n - 1 : first), at(first == n ? n : first + 1)) <
           thickness / 2;
}

bool in_round_cone(Point p, double bottom, double top, double height) {
    for (int i = 0; i <= 300; ++i) {
        double t = i / 300.0;
        if (norm(p - Point{0, -height / 2 + t * height, 0}) < bottom + t * (top - bottom))
            return true;
    }
    return false;
}

std::vector<Point> signs(std::vector<Point> of) { // with all signs
    std::vector<Point> all;
    for (const Point &p : of)
        for (int s = 0; s < 8; ++s)
            all.push_back({s & 1 ? -p[0] : p[0], s & 2 ? -p[1] : p[1], s & 4 ? -p[2] : p[2]});
    return all;
}
std::vector<Point> cyclic(Point p) { return {p, {p[1], p[2], p[0]}, {p[2], p[0], p[1]}}; }
std::vector<Point> joined(std::vector<Point> a, const std::vector<Point> &b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}
std::vector<Point> scaled(std::vector<Point> points, double radius) {
    for (Point &p : points) p = radius / norm(p) * p;
    return points;
}

const std::vector<Point> octahedron_corners = signs(cyclic({1, 0, 0}));
const std::vector<Point> cube_corners = signs({{1, 1, 1}});
const std::vector<Point> icosahedron_corners = signs(cyclic({0, 1, golden}));
const std::vector<Point> dodecahedron_corners =
    joined(cube_corners, signs(cyclic({0, golden, 1 / golden})));
const std::vector<Point> tetrahedron_corners{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};

Solid polyhedron(const std::string &text, const std::vector<Point> &corners,
                 const std::vector<Point> &normals, double radius) {
    return {text, [=, c = scaled(corners, radius)](Point p) { return in_convex(p, c, normals); },
            1.5, true};
}

double gdf(Point p, const std::vector<Point> &normals, double exponent) {
    double sum = 0, maximum = 0;
    for (const Point &n : normals) {
        double a = std::abs(dot(p, n)) / norm(n);
        maximum = std::max(maximum, a);
        sum += std::pow(a, exponent);
    }
    return std::isinf(exponent) ? maximum : std::pow(sum, 1 / exponent);
}
// Of directions with all signs, one of each pair.
std::vector<Point> axes(const std::vector<Point> &all) {
    std::vector<Point> half;
    for (const Point &p : all)
        if (std::none_of(half.begin(), half.end(),
                         [&](const Point &q) { return norm(cross(p, q)) < 1e-9; }))
            half.push_back(p);
    return half;
}

double blob_weight(Point p, const std::vector<Point> &centers, double radius) {
    double sum = 0;
    for (const Point &c : centers) {
        double t = norm(p - c) / (2 * radius);
        if (t < 1) sum += (1 - t * t) * (1 - t * t);
    }
    return sum;
}

// By digits: a point is bored away where, on some level, two of its three base-3 digits are 1.
bool in_menger(Point p, double size, int iterations) {
    if (!in_box(p, size, size, size)) return false;
    std::array<double, 3> u{};
    for (std::size_t i = 0; i < 3; ++i) u[i] = p[i] / size + 0.5;
    for (int level = 0; level < iterations; ++level) {
        int ones = 0;
        for (double &x : u) {
            int digit = std::clamp(static_cast<int>(std::floor(3 * x)), 0, 2);
            ones += digit == 1;
            x = 3 * x - digit;
        }
        if (ones >= 2) return false;
    }
    return true;
}

} // namespace

// Long: the table, a row for each shape.
std::vector<Solid> round_solids() {
    const std::vector<Point> path{{-1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 0, 1}};
    const std::vector<Point> blobs{{-0.6, 0, 0}, {0.5, 0.1, 0}, {0, 0.7, 0}};
    return {
        {"sphere(1.2)", [](Point p) { return norm(p) < 1.2; }, 1.5, true},
        {"sphere()", [](Point p) { return norm(p) < 1; }, 1.5, true},
        {"rounded_box([2, 1, 1.2], 0.2)", [](Point p) { return to_box(p, 1.6, 0.6, 0.8) < 0.2; },
         1.2, true},
        {"torus(1, 0.3)", [](Point p) { return std::hypot(around_y(p) - 1, p[1]) < 0.3; }, 1.5,
         true},
        {"torus(0.5, 0.7)", [](Point p) { return std::hypot(around_y(p) - 0.5, p[1]) < 0.7; }, 1.5,
         false},
        {"capped_torus(1, 0.2, 120deg)",
         [](Point p) {
             double a = std::clamp(std::atan2(p[2], p[0]), -pi * 2 / 3, pi * 2 / 3);
             return norm(p - Point{std::cos(a), 0, std::sin(a)}) < 0.2;
         },
         1.4, true},
        {"capped_torus(1, 0.2, 40deg)",
         [](Point p) {
             double a = std::clamp(std::atan2(p[2], p[0]), -pi * 2 / 9, pi * 2 / 9);
             return norm(p - Point{std::cos(a), 0, std::sin(a)}) < 0.2;
         },
         1.4, true},
        {"link(2.4, 0.5, 0.15)",
         [](Point p) {
             double straight = 1.2 - 0.65;
             double minimum = std::min(to_segment(p, {-straight, 0, 0.5}, {straight, 0, 0.5}),
                                       to_segment(p, {-straight, 0, -0.5}, {straight, 0, -0.5}));
             for (double side : {-1.0, 1.0})
                 for (int i = 0; i <= 100; ++i) {
                     double a = -pi / 2 + pi * i / 100;
                     Point q{side * (straight + 0.5 * std::cos(a)), 0, 0.5 * std::sin(a)};
                     minimum = std::min(minimum, norm(p - q));
                 }
             return minimum < 0.15;
         },
         1.4, true},
        {"cylinder(0.5, 2)", [](Point p) { return around_y(p) < 0.5 && std::abs(p[1]) < 1; }, 1.3,
         true},
        {"rounded_cylinder(0.8, 1.5, 0.2)",
         [](Point p) {
             double r = std::max(around_y(p) - 0.6, 0.0), y = std::max(std::abs(p[1]) - 0.55, 0.0);
             return std::hypot(r, y) < 0.2;
         },
         1.2, true},
        {"capsule([-1, 0, 0], [1, 0.5, 0], 0.3)",
         [](Point p) {
             return to_segment(p, {-1, 0, 0}, {1, 0.5, 0}) < 0.3;
         },
         1.5, true},
        {"cone(0.8, 1.6)",
         [](Point p) { return within(p[1], -0.8, 0.8) && around_y(p) < 0.8 * (0.8 - p[1]) / 1.6; },
         1.2, true},
        {"capped_cone(0.8, 0.4, 1.2)",
         [](Point p) { return within(p[1], -0.6, 0.6) && around_y(p) < 0.6 - p[1] / 3; }, 1.2,
         true},
        {"capped_cone(0.2, 1, 0.5)",
         [](Point p) { return within(p[1], -0.25, 0.25) && around_y(p) < 0.6 + 1.6 * p[1]; }, 1.2,
         true},
        {"round_cone(0.6, 0.3, 1.2)", [](Point p) { return in_round_cone(p, 0.6, 0.3, 1.2); }, 1.4,
         true},
        {"round_cone(0.2, 0.7, 0.9)", [](Point p) { return in_round_cone(p, 0.2, 0.7, 0.9); }, 1.4,
         true},
        {"ellipsoid([1.2, 0.6, 0.8])",
         [](Point p) {
             return norm({p[0] / 1.2, p[1] / 0.6, p[2] / 0.8}) < 1;
         },
         1.4, false},
        {"superquadric([1, 0.8, 1.2], 0.3, 1)",
         [](Point p) {
             double across = std::pow(std::abs(p[0]), 2.0) + std::pow(std::abs(p[2] / 1.2), 2.0);
             return std::pow(across, 1 / 0.3) + std::pow(std::abs(p[1] / 0.8), 2 / 0.3) < 1;
         },
         1.4, false},
        {"superquadric([1, 1, 1], 1.6, 2)",
         [](Point p) {
             double across = std::abs(p[0]) + std::abs(p[2]);
             return std::pow(across, 2 / 1.6) + std::pow(std::abs(p[1]), 2 / 1.6) < 1;
         },
         1.2, false},
        {"helix(0.8, 0.5, 3, 0.2)", [](Point p) { return in_helix(p, 0.8, 0.5, 3, 0.2); }, 1.3,
         false},
        {"helix(0.5, 1.5, 1.3, 0.2)", [](Point p) { return in_helix(p, 0.5, 1.5, 1.3, 0.2); }, 1.3,
         false},
        {"tubes([[-1, 0, 0], [0, 1, 0], [1, 0, 0], [1, 0, 1]], 0.15)",
         [=](Point p) {
             for (std::size_t i = 0; i + 1 < path.size(); ++i)
                 if (to_segment(p, path[i], path[i + 1]) < 0.15) return true;
             return false;
         },
         1.4, false},
        {"metaballs([[0.2, 0, 0]], 0.6)",
         [](Point p) {
             return norm(p - Point{0.2, 0, 0}) < 0.6;
         },
         1.2, false},
        {"metaballs([[-0.6, 0, 0], [0.5, 0.1, 0], [0, 0.7, 0]], radius: 0.5)",
         [=](Point p) { return blob_weight(p, blobs, 0.5) > 0.5625; }, 1.6, false},
        {"metaballs_random(1, [0, 0, 0], seed: 4, radius: 0.6)",
         [](Point p) { return norm(p) < 0.6; }, 1.2, false},
        {"menger(2, 2)", [](Point p) { return in_menger(p, 2, 2); }, 1.2, false},
        {"gyroid(1.5, 0.2)",
         [](Point p) {
             double k = 2 * pi / 1.5;
             Point q = k * p;
             double g = std::sin(q[0]) * std::cos(q[2]) + std::sin(q[1]) * std::cos(q[0]) +
                        std::sin(q[2]) * std::cos(q[1]);
             return std::abs(g) / (std::sqrt(3.0) * k) < 0.1;
         },
         1.5, false},
        {"schwarz_p(1.5, 0.2)",
         [](Point p) {
             double k = 2 * pi / 1.5;
             return std::abs(std::cos(k * p[0]) + std::cos(k * p[1]) + std::cos(k * p[2])) /
                        (std::sqrt(3.0) * k) <
                    0.1;
         },
         1.5, false},
        {"heightfield(q => 0.2 * sin(4 * q.x) * cos(4 * q.y), [2, 1.6], depth: 0.5)",
         [](Point p) {
             return std::abs(p[0]) < 1 && std::abs(p[2]) < 0.8 && p[1] > -0.5 &&
                    p[1] < 0.2 * std::sin(4 * p[0]) * std::cos(4 * p[2]);
         },
         1.3, false},
    };
}

std::vector<Solid> straight_solids() {
    const double inf = INFINITY;
    auto gdf_solid = [](const std::string &text, const std::vector<Point> &normals, double radius,
                        double exponent) {
        return Solid{text, [=](Point p) { return gdf(p, normals, exponent) < radius; }, 1.7, false};
    };
    const std::vector<Point> cube = axes(octahedron_corners), octa = axes(cube_corners),
                             dodeca = axes(icosahedron_corners), icosa = axes(dodecahedron_corners);
    std::vector<Point> negative_tetrahedron = tetrahedron_corners;
    for (Point &p : negative_tetrahedron) p = -1.0 * p;
    return {
        {"box([2, 1, 0.5])", [](Point p) { return in_box(p, 2, 1, 0.5); }, 1.2, true},
        {"box()", [](Point p) { return in_box(p, 1, 1, 1); }, 1.2, true},
        {"box_frame([2, 1.5, 1], 0.2)",
         [](Point p) {
             int edges = (std::abs(p[0]) > 0.8) + (std::abs(p[1]) > 0.55) + (std::abs(p[2]) > 0.3);
             return in_box(p, 2, 1.5, 1) && edges >= 2;
         },
         1.2, true},
        {"prism(5, 0.8, 1.5)",
         [](Point p) {
             std::vector<std::array<double, 2>> corners;
             for (int i = 0; i < 5; ++i)
                 corners.push_back(
                     {0.8 * std::cos(2 * pi * i / 5), 0.8 * std::sin(2 * pi * i / 5)});
             return std::abs(p[1]) < 0.75 && in_polygon(p[0], p[2], corners);
         },
         1.2, true},
        {"prism(6, 0.8, 0.6)",
         [](Point p) {
             std::vector<std::array<double, 2>> corners;
             for (int i = 0; i < 6; ++i)
                 corners.push_back(
                     {0.8 * std::cos(2 * pi * i / 6), 0.8 * std::sin(2 * pi * i / 6)});
             return std::abs(p[1]) < 0.3 && in_polygon(p[0], p[2], corners);
         },
         1.2, true},
        {"pyramid([1.6, 1.2, 1])",
         [](Point p) {
             double s = (0.6 - p[1]) / 1.2; // 0 at the tip, 1 at the base
             return within(s, 0, 1) && std::abs(p[0]) < 0.8 * s && std::abs(p[2]) < 0.5 * s;
         },
         1.2, true},
        polyhedron("tetrahedron(1.2)", tetrahedron_corners, negative_tetrahedron, 1.2),
        polyhedron("octahedron(1.2)", octahedron_corners, cube_corners, 1.2),
        polyhedron("dodecahedron(1.2)", dodecahedron_corners, icosahedron_corners, 1.2),
        polyhedron("icosahedron(1.2)", icosahedron_corners, dodecahedron_corners, 1.2),
        {"plane([1, 2, 0], 1)", [](Point p) { return p[0] + 2 * p[1] < 1; }, 1.5, true, true},
        {"slab(0.4, axis: [1, 1, 0])",
         [](Point p) { return std::abs(p[0] + p[1]) / std::sqrt(2.0) < 0.2; }, 1.5, true, true},
        gdf_solid("gdf([[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]], 0.8, 12)",
                  {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}}, 0.8, 12),
        gdf_solid("gdf_cube(0.8, 3)", cube, 0.8, 3),
        gdf_solid("gdf_cube(0.8, 1)", cube, 0.8, 1),
        gdf_solid("gdf_octahedron(0.7, 20)", octa, 0.7, 20),
        gdf_solid("gdf_dodecahedron(0.9)", dodeca, 0.9, inf),
        gdf_solid("gdf_dodecahedron(0.9, 2)", dodeca, 0.9, 2),
        gdf_solid("gdf_icosahedron()", icosa, 1, inf),
        gdf_solid("gdf_icosahedron(1, 4)", icosa, 1, 4),
        gdf_solid("gdf_truncated_octahedron(0.9, 30)", joined(cube, octa), 0.9, 30),
        gdf_solid("gdf_truncated_icosahedron(0.9)", joined(dodeca, icosa), 0.9, inf),
        {"gdf_tetrahedron(0.5)",
         [=](Point p) {
             for (const Point &n : negative_tetrahedron)
                 if (dot(p, n) / norm(n) > 0.5) return false;
             return true;
         },
         1.2, false},
        {"gdf_blend([X, Y, Z], [[1, 1, 1], [-1, 1, 1], [1, -1, 1], [1, 1, -1]], 1.6, -0.8, 0.5)",
         [=](Point p) { return 1.6 * gdf(p, cube, INFINITY) - 0.8 * gdf(p, octa, INFINITY) < 0.5; },
         1.5, false},
    };
}

} // namespace fathom::test
