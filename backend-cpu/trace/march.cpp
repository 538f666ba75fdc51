// Rays through the field, in batches from which those that are done drop out. Names and order
// follow ir/shading.h and backend-glsl/marcher.cpp.
#include "backend-cpu/trace/cell_march.h"

#include <algorithm>
#include <numeric>

namespace fathom::cpu {

namespace shading = ir::shading;

Lengths::Lengths(const Stage &stage)
    : slack(static_cast<float>(stage.frame.slack)),
      coarse(slack + shading::float_slack * static_cast<float>(stage.frame.radius)),
      pixel(static_cast<float>(stage.frame.pixel)), far(static_cast<float>(stage.frame.far)),
      base(static_cast<float>(stage.frame.tolerance_base)),
      slope(static_cast<float>(stage.frame.tolerance_slope)), fades(!stage.frame.boxed),
      orthographic(stage.view.orthographic), estimate(static_cast<float>(stage.frame.estimate)) {}

float Lengths::arm(float t) const {
    return shading::arm * tolerance(t) +
           std::min(shading::normal_slack * coarse, shading::widest * width(t));
}

Inside box(const ir::Frame &frame, Vec origin, Vec direction) {
    auto safe = [](float d) { return std::fabs(d) < 1e-20f ? 1e-20f : d; };
    Vec by{safe(direction.x), safe(direction.y), safe(direction.z)};
    Vec a = vec(frame.lo) - origin, b = vec(frame.hi) - origin;
    float ax = a.x / by.x, ay = a.y / by.y, az = a.z / by.z;
    float bx = b.x / by.x, by_ = b.y / by.y, bz = b.z / by.z;
    return {std::max(std::min(ax, bx), std::max(std::min(ay, by_), std::min(az, bz))),
            std::min(std::max(ax, bx), std::min(std::max(ay, by_), std::max(az, bz)))};
}

RayState clipped(const Stage &stage, Vec origin, Vec direction) {
    RayState ray{origin, direction, 0, static_cast<float>(stage.frame.far)};
    if (stage.frame.boxed) {
        Inside inside = box(stage.frame, origin, direction);
        ray.begin = std::max(ray.begin, inside.first);
        ray.end = std::min(ray.end, inside.last);
    }
    return ray;
}

void distances(Worker &worker, const Columns &points, float *out, std::size_t n,
               const float *limits) {
    worker.work.evaluations += n;
    if (worker.evaluator)
        evaluate(*worker.stage.pruning, *worker.evaluator, points.pointers(), &out, n, limits);
    else
        evaluate(worker.stage.distance, worker.distance, points.pointers(), &out, n);
}
void safe_radii(Worker &worker, const Columns &points, float *out, float *spans, std::size_t n) {
    worker.work.evaluations += n;
    float *const both[] = {out, spans};
    evaluate(worker.stage.safe_radius, worker.safe_radius, points.pointers(), both, n);
}
bool is_bound(const Worker &worker, std::size_t k) {
    return worker.evaluator && worker.evaluator->bounded[k] != 0;
}
void hits(Worker &worker, std::size_t n) {
    if (worker.hit_evaluator)
        evaluate(*worker.stage.hit_pruning, *worker.hit_evaluator, worker.points.pointers(),
                 worker.hits.pointers(), n);
    else
        evaluate(worker.stage.hit, worker.hit, worker.points.pointers(), worker.hits.pointers(), n);
}

void shaded_values(Worker &worker, const Columns &points, float *out, std::size_t n) {
    if (!worker.stage.shaded_apart) return distances(worker, points, out, n);
    worker.work.evaluations += n;
    if (worker.shaded_evaluator)
        evaluate(*worker.stage.shaded_pruning, *worker.shaded_evaluator, points.pointers(), &out,
                 n);
    else
        evaluate(worker.stage.shaded, worker.shaded, points.pointers(), &out, n);
}

Vec corner(std::size_t i) {
    const auto sign = [](std::size_t bit) { return 2.0f * static_cast<float>(bit & 1) - 1.0f; };
    return 0.577350269f * Vec{sign((i + 3) >> 1), sign(i >> 1), sign(i)};
}

void gradients(Worker &worker, const Vec *points, const float *h, Vec *out, std::size_t n) {
    std::array<Vec, 4> corners;
    for (std::size_t i = 0; i < 4; ++i) {
        corners[i] = corner(i);
        for (std::size_t k = 0; k < n; ++k)
            worker.taps.set(0, i * n + k, points[k] + h[k] * corners[i]);
    }
    shaded_values(worker, worker.taps, worker.tap_values.data(), 4 * n);
    std::fill(out, out + n, Vec{});
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t k = 0; k < n; ++k)
            out[k] = out[k] + worker.tap_values[i * n + k] * corners[i];
    for (std::size_t k = 0; k < n; ++k) out[k] = (0.75f / h[k]) * out[k];
}

void slopes(Worker &worker, const Vec *points, const float *g, const float *h, Vec *gradient,
            float *out, std::size_t n) {
    gradients(worker, points, h, gradient, n);
    const std::vector<float> &tap = worker.tap_values;
    for (std::size_t k = 0; k < n; ++k) {
        const float mean = 0.25f * (tap[k] + tap[n + k] + tap[2 * n + k] + tap[3 * n + k]);
        const float bent = (mean - g[k]) / h[k];
        out[k] = std::max(std::sqrt(dot(gradient[k], gradient[k]) + shading::crease * bent * bent),
                          shading::min_slope);
    }
}

void near(Worker &worker, const Vec *points, const float *g, const float *least_arm,
          const float *edge, float *out, std::size_t n) {
    if (worker.stage.frame.unit_slope) {
        std::copy(g, g + n, out);
        return;
    }
    std::vector<Vec> at(points, points + n), gradient(n);
    std::vector<float> value(g, g + n), arm(n), slope(n);
    for (std::size_t k = 0; k < n; ++k) arm[k] = std::max(least_arm[k], shading::shadow_arm * g[k]);
    slopes(worker, at.data(), value.data(), arm.data(), gradient.data(), slope.data(), n);
    std::vector<std::size_t> again;
    std::vector<Vec> down = gradient;
    for (std::size_t k = 0; k < n; ++k) {
        out[k] = g[k] / slope[k];
        if (!(arm[k] > std::max(least_arm[k], out[k]))) continue;
        const std::size_t j = again.size();
        at[j] = points[k], value[j] = g[k];
        arm[j] = std::max(least_arm[k], shading::shadow_arm * out[k]);
        again.push_back(k);
    }
    slopes(worker, at.data(), value.data(), arm.data(), gradient.data(), slope.data(),
           again.size());
    for (std::size_t j = 0; j < again.size(); ++j) {
        out[again[j]] = value[j] / slope[j];
        down[again[j]] = gradient[j];
    }
    again.clear();
    for (std::size_t k = 0; k < n; ++k)
        if (out[k] >= edge[k] && edge[k] > least_arm[k]) again.push_back(k);
    for (std::size_t j = 0; j < again.size(); ++j) {
        const std::size_t k = again[j];
        worker.points.set(0, j, points[k] - edge[k] / std::max(length(down[k]), 1e-30f) * down[k]);
    }
    value.resize(again.size());
    shaded_values(worker, worker.points, value.data(), again.size());
    for (std::size_t j = 0; j < again.size(); ++j) {
        const std::size_t k = again[j];
        if (value[j] < 0) out[k] = edge[k] * g[k] / (g[k] - value[j]);
    }
}

void refine(Worker &worker, std::span<const RayState> rays, std::span<Crossing> crossings,
            std::span<Landing> landings) {
    const Lengths lengths(worker.stage);
    const auto chord = [](const Crossing &c) {
        if (!(c.at_a > c.at_b)) return c.a;
        return c.b > c.a ? c.a + (c.b - c.a) * (c.at_a / (c.at_a - c.at_b)) : c.b;
    };
    std::vector<std::size_t> active(crossings.size());
    std::iota(active.begin(), active.end(), std::size_t{0});
    std::vector<float> at(crossings.size());
    std::vector<char> kept(crossings.size()); // the end that stayed last: 0 none, 1 a, 2 b
    for (std::size_t i = 0; i < crossings.size(); ++i) at[i] = chord(crossings[i]);
    std::vector<float> aimed(crossings.size(),
                             -1); // where it lands if what is before it is outside
    std::erase_if(active, [&](std::size_t i) {
        const float tolerance = lengths.tolerance(at[i]), quarter = 0.25f * tolerance;
        if (!crossings[i].aimed ||
            std::fabs(at[i] - (crossings[i].b - quarter)) > shading::refined * tolerance)
            return false;
        if (!(at[i] - quarter > crossings[i].a)) return true;
        aimed[i] = at[i];
        at[i] -= quarter;
        return false;
    });
    for (int turn = 0; turn < shading::refinements; ++turn) {
        std::erase_if(active, [&](std::size_t i) {
            return !(crossings[i].b - crossings[i].a > shading::refined * lengths.tolerance(at[i]));
        });
        if (active.empty()) break;
        for (std::size_t k = 0; k < active.size(); ++k) {
            const RayState &ray = rays[crossings[active[k]].ray];
            worker.points.set(0, k, ray.origin + at[active[k]] * ray.direction);
        }
        distances(worker, worker.points, worker.values.data(), active.size());
        for (std::size_t k = 0; k < active.size(); ++k) {
            const std::size_t i = active[k];
            Crossing &c = crossings[i];
            ++landings[c.ray].steps;
            const bool inside = !(worker.values[k] > 0);
            (inside ? c.b : c.a) = at[i];
            (inside ? c.at_b : c.at_a) = worker.values[k];
            const char stays = inside ? 1 : 2;
            if (kept[i] == stays) (inside ? c.at_a : c.at_b) *= 0.5f;
            kept[i] = stays;
        }
        std::erase_if(active, [&](std::size_t i) {
            const float last = at[i];
            at[i] = chord(crossings[i]);
            if (aimed[i] >= 0 && kept[i] == 2) {
                at[i] = aimed[i];
                return true;
            }
            aimed[i] = -1;
            return std::fabs(at[i] - last) <= shading::refined * lengths.tolerance(last);
        });
    }
    for (std::size_t i = 0; i < crossings.size(); ++i) {
        landings[crossings[i].ray].t = at[i];
        landings[crossings[i].ray].end = RayEnd::Hit;
    }
}

void look_back(Worker &worker, std::span<const Walk> walks, std::span<Landing> landings) {
    const Lengths lengths(worker.stage);
    for (std::size_t i = 0; i < landings.size(); ++i) {
        worker.work.passed += walks[i].passed;
        landings[i].close =
            was_close(walks[i], landings[i].end != RayEnd::Miss, landings[i].t, lengths);
    }
}

namespace {

void march_together(Worker &worker, std::span<const RayState> rays, std::span<Landing> landings,
                    bool brute) {
    const Lengths lengths(worker.stage);
    const bool by_curvature = worker.stage.has_safe_radius && !brute;
    const int budget = worker.stage.budget * (brute ? 100 : 1);
    std::vector<Walk> walks(rays.size());
    std::vector<std::size_t> active;
    std::vector<Crossing> crossings;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        walks[i].t = rays[i].begin;
        landings[i] = {};
        if (rays[i].end >= rays[i].begin) active.push_back(i);
    }
    // Whether the ray is done.
    const auto judged = [&](std::size_t i) {
        Walk &walk = walks[i];
        Verdict verdict = judge(walk, lengths);
        if (brute && !std::isnan(walk.d) && verdict != Verdict::Crossed &&
            verdict != Verdict::Touches)
            verdict = walk.d <= 0 ? Verdict::Crossed : Verdict::GoOn;
        switch (verdict) {
        case Verdict::GoOn: advance(walk, rays[i].end, lengths, brute); return false;
        case Verdict::GoBack: go_back(walk, lengths, by_curvature); return false;
        case Verdict::Crossed:
            landings[i].steps = walk.steps;
            crossings.push_back(crossing(walk, i));
            return true;
        case Verdict::Touches: pass(walk, rays[i].end, lengths); return false;
        case Verdict::Near: landings[i] = beside(walk, lengths); return true;
        case Verdict::Undecided: break;
        }
        landings[i] = {walk.t, walk.steps, RayEnd::Undecided};
        return true;
    };
    while (!active.empty()) {
        std::erase_if(active, [&](std::size_t i) {
            const Walk &walk = walks[i];
            const bool free = !(walk.t <= rays[i].end + lengths.slack);
            if (!free && walk.steps < budget) return false;
            landings[i] = {free ? -1.0f : walk.t, walk.steps,
                           free ? RayEnd::Miss : RayEnd::Undecided};
            return true;
        });
        for (std::size_t k = 0; k < active.size(); ++k) {
            const RayState &ray = rays[active[k]];
            worker.points.set(0, k, ray.origin + walks[active[k]].t * ray.direction);
        }
        if (by_curvature)
            safe_radii(worker, worker.points, worker.values.data(), worker.spans.data(),
                       active.size());
        else
            distances(worker, worker.points, worker.values.data(), active.size());
        for (std::size_t k = 0; k < active.size(); ++k) {
            Walk &walk = walks[active[k]];
            walk.d = worker.values[k];
            if (by_curvature) walk.span = worker.spans[k];
            ++walk.steps;
        }
        std::erase_if(active, judged);
    }
    refine(worker, rays, crossings, landings);
    look_back(worker, walks, landings);
}

} // namespace

void march(Worker &worker, std::span<const RayState> rays, std::span<Landing> landings,
           bool brute) {
    if (worker.evaluator && !brute)
        march_by_cells(worker, rays, landings);
    else
        march_together(worker, rays, landings, brute);
    worker.work.rays += rays.size();
    for (const Landing &landing : landings) {
        worker.work.steps += static_cast<std::uint64_t>(landing.steps);
        worker.work.hits += landing.end == RayEnd::Hit;
        worker.work.undecided += landing.end == RayEnd::Undecided;
    }
}

} // namespace fathom::cpu
