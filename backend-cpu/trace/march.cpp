// Rays through the field, in batches from which those that are done drop out. Names and order
// follow ir/shading.h and backend-glsl/marcher.cpp.
#include "backend-cpu/trace/cell_march.h"

#include <algorithm>
#include <numeric>

namespace fathom::cpu {

namespace shading = ir::shading;

Lengths::Lengths(const Stage &stage)
    : slack(static_cast<float>(stage.frame.slack)), pixel(static_cast<float>(stage.frame.pixel)),
      far(static_cast<float>(stage.frame.far)),
      base(static_cast<float>(stage.frame.tolerance_base)),
      slope(static_cast<float>(stage.frame.tolerance_slope)),
      orthographic(stage.view.orthographic) {}

float Lengths::arm(float t) const { return tolerance(t) + shading::normal_slack * slack; }

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

void gradients(Worker &worker, const Vec *points, const float *h, Vec *out, std::size_t n) {
    std::fill(out, out + n, Vec{});
    for (int i = 0; i < 4; ++i) {
        auto sign = [](int bit) { return 2.0f * static_cast<float>(bit & 1) - 1.0f; };
        const Vec e = 0.577350269f * Vec{sign((i + 3) >> 1), sign(i >> 1), sign(i)};
        for (std::size_t k = 0; k < n; ++k) worker.taps.set(0, k, points[k] + h[k] * e);
        distances(worker, worker.taps, worker.tap_values.data(), n);
        for (std::size_t k = 0; k < n; ++k) out[k] = out[k] + worker.tap_values[k] * e;
    }
    for (std::size_t k = 0; k < n; ++k) out[k] = (0.75f / h[k]) * out[k];
}

void near(Worker &worker, const Vec *points, const float *d, const float *h, float *out,
          std::size_t n) {
    if (!worker.stage.frame.steep) {
        std::copy(d, d + n, out);
        return;
    }
    std::vector<Vec> slopes(n);
    gradients(worker, points, h, slopes.data(), n);
    for (std::size_t k = 0; k < n; ++k)
        out[k] = d[k] / clamp(length(slopes[k]), shading::min_slope, 1.0f);
}

namespace {

// Which of the rays that found d small enough are at the surface.
class Arrivals {
  public:
    void clear() { rays_.clear(), points_.clear(), d_.clear(), h_.clear(); }
    void add(std::size_t ray, Vec point, float d, float h) {
        rays_.push_back(ray), points_.push_back(point), d_.push_back(d), h_.push_back(h);
    }
    template <class F> void each(Worker &worker, F &&f) {
        true_.resize(rays_.size());
        near(worker, points_.data(), d_.data(), h_.data(), true_.data(), rays_.size());
        for (std::size_t i = 0; i < rays_.size(); ++i) f(rays_[i], true_[i]);
    }

  private:
    std::vector<std::size_t> rays_;
    std::vector<Vec> points_;
    std::vector<float> d_, h_, true_;
};

} // namespace

namespace {

void march_together(Worker &worker, std::span<const RayState> rays, std::span<Landing> landings,
                    bool brute) {
    const Lengths lengths(worker.stage);
    const bool by_curvature = worker.stage.has_safe_radius && !brute;
    const int max_steps = worker.stage.scene->render.max_steps * (brute ? 100 : 1);
    std::vector<Walk> walks(rays.size());
    std::vector<std::size_t> active;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        walks[i].t = rays[i].begin;
        landings[i] = {};
        if (rays[i].end >= rays[i].begin) active.push_back(i);
    }
    const auto reach = [&](const Walk &walk) { return tolerance_at(walk, lengths, max_steps); };
    Arrivals arrivals;
    while (!active.empty()) {
        // Who has run out of steps or of way is done.
        std::erase_if(active, [&](std::size_t i) {
            const Walk &walk = walks[i];
            if (walk.steps < max_steps && walk.t <= rays[i].end + lengths.slack) return false;
            landings[i] = {-1.0f, walk.steps};
            return true;
        });
        for (std::size_t k = 0; k < active.size(); ++k) {
            const RayState &ray = rays[active[k]];
            const float t = walks[active[k]].t;
            worker.points.set(0, k, ray.origin + t * ray.direction);
        }
        if (by_curvature)
            safe_radii(worker, worker.points, worker.values.data(), worker.spans.data(),
                       active.size());
        else
            distances(worker, worker.points, worker.values.data(), active.size());
        arrivals.clear();
        for (std::size_t k = 0; k < active.size(); ++k) {
            Walk &walk = walks[active[k]];
            const RayState &ray = rays[active[k]];
            walk.d = worker.values[k];
            if (by_curvature) walk.span = worker.spans[k];
            ++walk.steps;
            if (!brute && walk.steps < max_steps && apart(walk)) {
                go_back(walk, lengths, by_curvature);
            } else if (walk.d <= reach(walk)) {
                arrivals.add(active[k], ray.origin + walk.t * ray.direction, walk.d,
                             lengths.arm(walk.t));
            } else {
                advance(walk, ray.end, lengths, brute);
            }
        }
        arrivals.each(worker, [&](std::size_t i, float distance) {
            Walk &walk = walks[i];
            if (distance <= reach(walk))
                landings[i] = {walk.t + walk.d, walk.steps};
            else
                advance(walk, rays[i].end, lengths, brute);
        });
        // A landing has at least one step; who was set down has nothing more to do.
        std::erase_if(active, [&](std::size_t i) { return landings[i].steps > 0; });
    }
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
        worker.work.hits += landing.t >= 0;
    }
}

void shadows(Worker &worker, std::span<const ShadowRay> rays, float angle, std::span<float> lit) {
    const Lengths lengths(worker.stage);
    struct State {
        float s, before = 0, shadow = 1;
    };
    std::vector<State> states(rays.size());
    std::vector<std::size_t> active(rays.size()), close;
    std::iota(active.begin(), active.end(), std::size_t{0});
    std::vector<Vec> points;
    std::vector<float> d, arms, truth;
    std::vector<char> bounds;
    for (std::size_t i = 0; i < rays.size(); ++i) states[i].s = rays[i].reach;
    for (int turn = 0; turn < shading::shadow_steps && !active.empty(); ++turn) {
        std::erase_if(active, [&](std::size_t i) { return !(states[i].s > rays[i].margin); });
        for (std::size_t k = 0; k < active.size(); ++k) {
            const ShadowRay &ray = rays[active[k]];
            const State &state = states[active[k]];
            worker.points.set(0, k, ray.from + state.s * ray.towards);
            worker.limits[k] = state.shadow * angle * state.s;
        }
        distances(worker, worker.points, worker.values.data(), active.size(), worker.limits.data());
        bounds.clear();
        for (std::size_t k = 0; k < active.size(); ++k) bounds.push_back(is_bound(worker, k));
        worker.work.shadow_steps += active.size();

        // Where an edge of the shadow may be, the true distance decides.
        close.clear(), points.clear(), d.clear(), arms.clear();
        for (std::size_t k = 0; k < active.size(); ++k) {
            const State &state = states[active[k]];
            if (worker.values[k] < state.shadow * angle * state.s) {
                close.push_back(k), points.push_back(worker.points.vec(0, k)),
                    d.push_back(worker.values[k]);
                arms.push_back(rays[active[k]].arm);
            }
        }
        truth.resize(close.size());
        near(worker, points.data(), d.data(), arms.data(), truth.data(), close.size());
        std::size_t next_close = 0;
        for (std::size_t k = 0; k < active.size(); ++k) {
            State &state = states[active[k]];
            const float d = worker.values[k];
            if (bounds[k]) { // it shades nothing, and its ball touches nothing
                state.before = 0;
                state.s -= d;
                continue;
            }
            const bool is_close = next_close < close.size() && close[next_close] == k;
            const float near = is_close ? truth[next_close++] : d;
            const float y = state.before > 0 ? 0.5f * near * d / state.before : 0.0f;
            const float c = std::sqrt(std::max(near * near - y * y, 0.0f));
            state.shadow = std::min(state.shadow, c / (angle * (state.s + y)));
            if (near <= 0 || state.shadow < 0.00390625f) {
                state.shadow = 0;
                state.s = 0; // done
                continue;
            }
            state.before = d;
            state.s -= std::max(d, 0.25f * lengths.slack);
        }
    }
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const float shadow = states[i].shadow;
        lit[i] = shadow * shadow * (3.0f - 2.0f * shadow);
    }
}

} // namespace fathom::cpu
