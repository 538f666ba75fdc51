// The rule of curvature, measured: between two samples outside, no farther apart than their safe
// radii together, nothing of the solid lies (shading.h, MARCH). Random segments that the balls of
// their ends do not cover, and points all along them; the same every time. On the processor, in
// float32.
#pragma once

#include "tests/support/slopes.h"

namespace fathom::test {

struct Spans {
    int tried = 0; // segments that are free by safe radii, and not by distances
    int cut = 0;   // … and in which the field is below 0
    int shorter =
        0; // samples whose safe radius is less than their distance, or whose distance differs
};

inline Spans measure_spans(const ir::Scene &scene, Point3 lo, Point3 hi, int count) {
    const cpu::Program reach = cpu::compile(scene, scene.safe_radius);
    cpu::Scratch scratch = cpu::make_scratch(reach, cpu::inputs_of(scene, 0));
    Sampler sampler(scene);
    using Values = std::array<std::vector<float>, 2>; // the distance, and the safe radius
    const auto ask = [&](const std::vector<Point3> &points) {
        std::array<std::vector<float>, 3> in;
        for (const Point3 &p : points)
            for (std::size_t i = 0; i < 3; ++i) in[i].push_back(float(p[i]));
        Values out{std::vector<float>(points.size()), std::vector<float>(points.size())};
        const float *from[] = {in[0].data(), in[1].data(), in[2].data()};
        float *to[] = {out[0].data(), out[1].data()};
        cpu::evaluate(reach, scratch, from, to, points.size());
        return out;
    };
    const auto on = [](const Point3 &p, const Point3 &to, double h) {
        return Point3{float(p[0] + h * to[0]), float(p[1] + h * to[1]), float(p[2] + h * to[2])};
    };
    constexpr int between = 24;
    const double wide = 2 * std::hypot(hi[0] - lo[0], hi[1] - lo[1], hi[2] - lo[2]);
    constexpr double rounding = 1e-5;
    Spans out;
    for (int done = 0; done < count; done += 1024) {
        std::vector<Point3> p, q, to;
        std::vector<double> way;
        for (int i = 0; i < 1024; ++i) p.push_back(sampler.in_box(lo, hi));
        const Values a = ask(p);
        const std::vector<float> known = sampler.values(p);
        for (std::size_t i = 0; i < p.size(); ++i) {
            Point3 u = sampler.in_ball({0, 0, 0}, 1);
            const double size = std::sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]) + 1e-9;
            for (double &x : u) x /= size;
            to.push_back(u);
            way.push_back(std::min(double(a[1][i]), wide) * (0.5 + 1.7 * sampler.random()));
            q.push_back(on(p[i], u, std::max(way.back(), 0.0)));
            out.shorter += !(a[1][i] >= a[0][i] - 1e-6f) ||
                           std::fabs(known[i] - a[0][i]) > 1e-5f * (1 + std::fabs(known[i]));
        }
        const Values b = ask(q);
        std::vector<Point3> inner;
        for (std::size_t i = 0; i < p.size(); ++i) {
            if (!(a[0][i] > 0 && b[0][i] > 0 && way[i] > double(a[0][i]) + b[0][i] &&
                  way[i] <= double(a[1][i]) + b[1][i]))
                continue;
            ++out.tried;
            for (int k = 1; k < between; ++k)
                inner.push_back(on(p[i], to[i], way[i] * k / between));
        }
        const std::vector<float> d = sampler.values(inner);
        for (std::size_t i = 0; i < d.size(); i += between - 1)
            out.cut += *std::min_element(d.begin() + std::ptrdiff_t(i),
                                         d.begin() + std::ptrdiff_t(i + between - 1)) < -rounding;
    }
    return out;
}

} // namespace fathom::test
