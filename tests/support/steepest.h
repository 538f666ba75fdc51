// The steepest slope of a field, found by trying pairs of points: no gradient is asked for, so that
// kinks and what evaluators round count as they are.
#pragma once

#include "tests/support/slopes.h"

#include <functional>

namespace fathom::test {

// Two points and the slope between them.
struct Pair {
    Point3 p, q;
    double slope = 0;
};
inline void measure_pairs(Sampler &sampler, std::vector<Pair> &pairs) {
    std::vector<Point3> p, q;
    for (const Pair &pair : pairs) p.push_back(pair.p), q.push_back(pair.q);
    const std::vector<float> a = sampler.values(p), b = sampler.values(q);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        double run = 0;
        for (std::size_t k = 0; k < 3; ++k) run += (p[i][k] - q[i][k]) * (p[i][k] - q[i][k]);
        // float32 loses some units in the last place of what it adds
        pairs[i].slope = (std::fabs(double(a[i]) - b[i]) - 2e-6) / std::sqrt(run);
    }
}

// The steepest slope found between points of a ball about the origin that are up to `apart` from each
// other: `tries` pairs, every fourth from the plane z = 0, and from the steepest of them others
// beside, ever nearer, as long as they are steeper. The second point may lie up to 5 % outside.
inline double steepest_slope(Sampler &sampler, double radius, double apart, int tries) {
    const double reach_out = 1.05 * radius;
    const auto outside = [](const Point3 &p, double r) { return std::hypot(p[0], p[1], p[2]) > r; };
    const auto beside = [&](const Point3 &p) {
        Point3 q = p;
        while (outside(q, reach_out) ||
               !outside({q[0] - p[0], q[1] - p[1], q[2] - p[2]}, 0.2 * apart))
            q = sampler.in_ball(p, apart);
        return q;
    };
    std::vector<Pair> pairs;
    for (int i = 0; i < tries; ++i) {
        Point3 p = sampler.in_ball({0, 0, 0}, radius);
        if (i % 4 == 0) p[2] = 0;
        pairs.push_back({p, beside(p)});
    }
    measure_pairs(sampler, pairs);
    const std::size_t kept = 16, children = 12;
    std::ranges::partial_sort(pairs, pairs.begin() + kept, std::greater{}, &Pair::slope);
    pairs.resize(kept);
    double reach = 0.2;
    for (int round = 0; round < 30; ++round, reach *= 0.75) {
        std::vector<Pair> next;
        for (const Pair &from : pairs)
            for (std::size_t i = 0; i < children; ++i) {
                Pair moved{sampler.in_ball(from.p, reach), from.q};
                if (outside(moved.p, radius)) moved.p = from.p;
                for (std::size_t k = 0; k < 3; ++k)
                    moved.q[k] = float(moved.p[k] + from.q[k] - from.p[k]);
                if (i % 2 == 0 || outside(moved.q, reach_out)) moved.q = beside(moved.p);
                next.push_back(moved);
            }
        measure_pairs(sampler, next);
        for (std::size_t i = 0; i < next.size(); ++i)
            if (Pair &from = pairs[i / children]; next[i].slope > from.slope) from = next[i];
    }
    return std::ranges::max(pairs, {}, &Pair::slope).slope;
}

} // namespace fathom::test
