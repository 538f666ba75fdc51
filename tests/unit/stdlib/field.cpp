#include "field.h"

#include <cmath>
#include <limits>

namespace fathom::test {

double dot(Point a, Point b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double norm(Point p) { return std::sqrt(dot(p, p)); }
Point operator+(Point a, Point b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Point operator-(Point a, Point b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Point operator*(double s, Point a) { return {s * a[0], s * a[1], s * a[2]}; }
Point cross(Point a, Point b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// Knuth's linear congruences; the upper bits are good enough for places.
double Numbers::next() {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(state_ >> 11) / 9007199254740992.0;
}

std::string said(const driver::Compilation &compilation) {
    std::string out = compilation.unreadable;
    for (const Diagnostic &d : compilation.diagnostics.sorted())
        out += std::string(code_name(d.code)) + ": " + d.message + "\n";
    return out;
}

Field::Field(const std::string &text, const std::string &folder)
    : compilation_(driver::compile_text("test.sdf", text, folder, {})) {
    if (good()) program_ = cpu::compile(compilation_.scene, compilation_.scene.distance);
}

std::vector<double> Field::at(const std::vector<Point> &points) const {
    cpu::Scratch scratch = cpu::make_scratch(program_, cpu::inputs_of(compilation_.scene, 0));
    std::vector<float> x, y, z, d(points.size());
    for (const Point &p : points) {
        x.push_back(static_cast<float>(p[0]));
        y.push_back(static_cast<float>(p[1]));
        z.push_back(static_cast<float>(p[2]));
    }
    const float *in[] = {x.data(), y.data(), z.data()};
    float *out[] = {d.data()};
    cpu::evaluate(program_, scratch, in, out, points.size());
    return {d.begin(), d.end()};
}

std::vector<Point> border(const Inside &inside, double reach, int n) {
    const double step = 2 * reach / n;
    const auto side = static_cast<std::size_t>(n + 1);
    auto place = [&](std::size_t i) { return -reach + step * static_cast<double>(i); };
    std::vector<bool> solid(side * side * side);
    auto at = [&](std::size_t i, std::size_t j, std::size_t k) {
        return (i * side + j) * side + k;
    };
    for (std::size_t i = 0; i < side; ++i)
        for (std::size_t j = 0; j < side; ++j)
            for (std::size_t k = 0; k < side; ++k)
                solid[at(i, j, k)] = inside({place(i), place(j), place(k)});
    std::vector<Point> found;
    auto bisect = [&](Point in, Point out) {
        for (int turn = 0; turn < 30; ++turn) {
            Point middle = 0.5 * (in + out);
            (inside(middle) ? in : out) = middle;
        }
        found.push_back(0.5 * (in + out));
    };
    for (std::size_t i = 0; i < side; ++i)
        for (std::size_t j = 0; j < side; ++j)
            for (std::size_t k = 0; k < side; ++k)
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    std::array<std::size_t, 3> next{i, j, k};
                    if (++next[axis] == side) continue;
                    bool here = solid[at(i, j, k)], there = solid[at(next[0], next[1], next[2])];
                    if (here == there) continue;
                    Point a{place(i), place(j), place(k)},
                        b{place(next[0]), place(next[1]), place(next[2])};
                    here ? bisect(a, b) : bisect(b, a);
                }
    return found;
}

double way_to_border(const Inside &inside, const std::vector<Point> &border, Point p,
                     Numbers &numbers) {
    double best = std::numeric_limits<double>::infinity();
    Point towards{};
    for (const Point &q : border) {
        Point d = q - p;
        if (double square = dot(d, d); square < best) best = square, towards = d;
    }
    best = std::sqrt(best);
    const bool here = inside(p);
    double spread = 0.1 / (best + 0.05);
    for (int turn = 0; turn < 300; ++turn, spread *= 0.975) {
        Point way = towards + spread * norm(towards) * numbers.in(-1, 1);
        way = 1 / norm(way) * way;
        if (inside(p + best * (1 - 1e-5) * way) == here) continue;
        double same = 0, other = best;
        for (int i = 0; i < 30; ++i) {
            double middle = (same + other) / 2;
            (inside(p + middle * way) == here ? same : other) = middle;
        }
        best = other;
        towards = best * way;
    }
    return best;
}

} // namespace fathom::test
