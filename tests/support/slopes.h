// The property that everything rests on, measured: a marched distance never exceeds the way to the
// surface (the safe ball), and is nowhere steeper than 1. Random balls, pairs of points at all
// distances, and ascent on the gradient's length; the same points every time. Evaluates with the
// CPU back end, in float32.
#pragma once

#include "backend-cpu/tape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace fathom::test {

using Point3 = std::array<double, 3>;

struct Slopes {
    double steepest = 0; // of the gradient's length and of pairs' slopes
    Point3 where{};
    int balls = 0, unsafe = 0; // balls, and those in which the field changes its sign
    Point3 unsafe_center{}, unsafe_point{};
    double unsafe_by = 0; // distance asked for over the way actually there, at most
};

class Sampler {
  public:
    Sampler(const ir::Scene &scene, double time = 0)
        : program_(cpu::compile(scene, scene.distance)), inputs_(cpu::inputs_of(scene, time)),
          scratch_(cpu::make_scratch(program_, inputs_)),
          gradients_(cpu::make_gradient_scratch(program_, inputs_)) {}

    std::vector<float> values(const std::vector<Point3> &points) {
        auto [x, y, z] = split(points);
        std::vector<float> out(points.size());
        const float *in[3] = {x.data(), y.data(), z.data()};
        float *to[1] = {out.data()};
        cpu::evaluate(program_, scratch_, in, to, points.size());
        return out;
    }
    // Lengths of the gradients.
    std::vector<float> steepness(const std::vector<Point3> &points) {
        auto [x, y, z] = split(points);
        std::vector<float> v(points.size()), dx(v), dy(v), dz(v);
        const float *in[3] = {x.data(), y.data(), z.data()};
        float *to[4] = {v.data(), dx.data(), dy.data(), dz.data()};
        cpu::evaluate_gradient(program_, gradients_, in, to, points.size());
        for (std::size_t i = 0; i < v.size(); ++i)
            v[i] = std::sqrt(dx[i] * dx[i] + dy[i] * dy[i] + dz[i] * dz[i]);
        return v;
    }

    double random() { // splitmix64
        std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return double((z ^ (z >> 31)) >> 11) * 0x1p-53;
    }
    Point3 in_box(const Point3 &lo, const Point3 &hi) {
        Point3 p;
        for (std::size_t i = 0; i < 3; ++i) p[i] = float(lo[i] + (hi[i] - lo[i]) * random());
        return p;
    }
    Point3 in_ball(const Point3 &c, double r) {
        for (;;) {
            Point3 u{2 * random() - 1, 2 * random() - 1, 2 * random() - 1};
            if (u[0] * u[0] + u[1] * u[1] + u[2] * u[2] > 1) continue;
            return {float(c[0] + r * u[0]), float(c[1] + r * u[1]), float(c[2] + r * u[2])};
        }
    }

  private:
    static std::array<std::vector<float>, 3> split(const std::vector<Point3> &points) {
        std::array<std::vector<float>, 3> out;
        for (std::size_t i = 0; i < 3; ++i)
            for (const Point3 &p : points) out[i].push_back(float(p[i]));
        return out;
    }
    cpu::Program program_;
    cpu::Inputs inputs_;
    cpu::Scratch scratch_;
    cpu::GradientScratch gradients_;
    std::uint64_t state_ = 7;
};

// `count` balls, of whose centres the first `sloped` are asked for their gradients too. float32
// loses some units in the last place of the coordinates and of the field; `rounding` is that,
// absolutely.
inline Slopes measure(const ir::Scene &scene, Point3 lo, Point3 hi, int count,
                      int sloped = std::numeric_limits<int>::max(), double time = 0) {
    Sampler sampler(scene, time);
    Slopes out;
    double size = 0;
    for (std::size_t i = 0; i < 3; ++i)
        size = std::max({size, std::fabs(lo[i]), std::fabs(hi[i]), hi[i] - lo[i]});
    const double rounding = 2e-5 * std::max(1.0, size);
    const int batch = 1024;
    std::vector<std::pair<float, Point3>> best;
    for (int done = 0; done < count; done += batch) {
        std::vector<Point3> p, q;
        for (int i = 0; i < batch; ++i) p.push_back(sampler.in_box(lo, hi));
        std::vector<float> d = sampler.values(p);
        for (std::size_t i = 0; i < p.size(); ++i)
            q.push_back(sampler.in_ball(p[i], std::min<double>(std::fabs(d[i]), 4 * size)));
        if (done < sloped) {
            const std::vector<float> g = sampler.steepness(p);
            for (std::size_t i = 0; i < p.size(); ++i) best.emplace_back(g[i], p[i]);
            std::partial_sort(
                best.begin(), best.begin() + std::min<std::ptrdiff_t>(32, std::ssize(best)),
                best.end(), [](const auto &a, const auto &b) { return a.first > b.first; });
            best.resize(std::min<std::size_t>(best.size(), 32));
        }
        std::vector<float> e = sampler.values(q);
        for (std::size_t i = 0; i < p.size(); ++i) {
            double run = 0;
            for (std::size_t k = 0; k < 3; ++k) run += (p[i][k] - q[i][k]) * (p[i][k] - q[i][k]);
            run = std::sqrt(run);
            ++out.balls;
            if ((d[i] < 0) != (e[i] < 0) && std::fabs(e[i]) > rounding &&
                std::fabs(d[i]) > rounding) {
                // the way to the sign change is at most `run`
                if (out.unsafe == 0 || std::fabs(d[i]) / run > out.unsafe_by) {
                    out.unsafe_by = std::fabs(d[i]) / run;
                    out.unsafe_center = p[i], out.unsafe_point = q[i];
                }
                ++out.unsafe;
            }
            // Pairs: the ball's two points, at all distances as the balls are of all sizes.
            if (run > 1e-2 * size || run > 200 * rounding) {
                double slope = (std::fabs(double(d[i]) - e[i]) - rounding) / run;
                if (slope > out.steepest) out.steepest = slope, out.where = p[i];
            }
        }
    }
    // Ascent from the steepest places.
    double reach = 0.1 * size;
    for (int round = 0; round < 40; ++round, reach *= 0.8) {
        std::vector<Point3> p;
        for (const auto &[g, c] : best)
            for (int i = 0; i < 16; ++i) {
                Point3 q = sampler.in_ball(c, reach);
                // Back in at a random depth: two coordinates that are clamped alike are a kink's.
                for (std::size_t k = 0; k < 3; ++k)
                    if (q[k] < lo[k] || q[k] > hi[k])
                        q[k] = float(std::clamp(q[k], lo[k], hi[k]) +
                                     0.01 * sampler.random() * (q[k] < lo[k] ? 1 : -1));
                p.push_back(q);
            }
        std::vector<float> g = sampler.steepness(p);
        for (std::size_t i = 0; i < p.size(); ++i)
            if (auto &from = best[i / 16]; g[i] > from.first) from = {g[i], p[i]};
    }
    // Exactly on a kink a chain of choices may pick a gradient that no side has; right beside it
    // none.
    for (const auto &[g, p] : best) {
        std::vector<Point3> beside;
        for (int i = 0; i < 8; ++i) beside.push_back(sampler.in_ball(p, 1e-5 * size));
        const std::vector<float> there = sampler.steepness(beside);
        const double seen = std::min(g, *std::max_element(there.begin(), there.end()));
        if (seen > out.steepest) out.steepest = seen, out.where = p;
    }
    return out;
}

} // namespace fathom::test
