// What several definitions need.
#include "definitions.h"

#include <algorithm>
#include <cmath>

namespace fathom::test {

bool in_box(Point p, double x, double y, double z) {
    return std::abs(p[0]) < x / 2 && std::abs(p[1]) < y / 2 && std::abs(p[2]) < z / 2;
}

double to_segment(Point p, Point a, Point b) {
    Point d = b - a;
    double length2 = dot(d, d);
    double t = length2 > 0 ? std::clamp(dot(p - a, d) / length2, 0.0, 1.0) : 0.0;
    return norm(p - a - t * d);
}

bool in_convex(Point p, const std::vector<Point> &corners, const std::vector<Point> &normals) {
    return std::all_of(normals.begin(), normals.end(), [&](const Point &n) {
        double maximum = -1e300;
        for (const Point &c : corners) maximum = std::max(maximum, dot(c, n));
        return dot(p, n) < maximum;
    });
}

bool in_polygon(double x, double y, const std::vector<std::array<double, 2>> &corners) {
    double turned = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const auto &a = corners[i], &b = corners[(i + 1) % corners.size()];
        double ax = a[0] - x, ay = a[1] - y, bx = b[0] - x, by = b[1] - y;
        turned += std::atan2(ax * by - ay * bx, ax * bx + ay * by);
    }
    return std::abs(turned) > 3;
}

} // namespace fathom::test
