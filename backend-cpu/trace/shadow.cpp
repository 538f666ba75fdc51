// How much of a light arrives: ir/shading.h's SHADOW and PENUMBRA over batches of rays. Names and
// order follow backend-glsl/templates/shadow.glsl.
#include "backend-cpu/trace/rays.h"

#include "ir/shading.h"

#include <algorithm>
#include <bit>
#include <numeric>

namespace fathom::cpu {

namespace shading = ir::shading;

namespace {

enum class Phase { Looking, Crossing, Measuring }; // shading.h, SHADOW

struct State {
    Phase phase = Phase::Looking;
    float first = 0;                     // the first mark where something may cover the light
    float s;                             // what is left of the way
    bool mark = true;                    // whether s is one of the marks
    float shadow = shading::closed_from; // the least of `closed` so far
    float quiet = 1e30f;                 // from where on it is looked at again
    int touches = 0;                     // as Walk::touches
    int probes = 0;                      // steps of the touch
};

class Shadows {
  public:
    Shadows(Worker &worker, std::span<const ShadowRay> rays, float angle)
        : worker_(worker), rays_(rays), angle_(angle), lengths_(worker.stage),
          states_(rays.size()) {
        for (std::size_t i = 0; i < rays.size(); ++i) states_[i].s = rays[i].reach;
    }

    void run(std::span<float> lit) {
        std::vector<std::size_t> all(rays_.size());
        std::iota(all.begin(), all.end(), std::size_t{0});
        march(all);
        std::erase_if(all, [&](std::size_t i) {
            return !(states_[i].phase == Phase::Crossing && states_[i].shadow > 0);
        });
        for (std::size_t i : all)
            states_[i] = {.phase = Phase::Measuring, .s = states_[i].first, .mark = true};
        march(all);
        for (std::size_t i = 0; i < rays_.size(); ++i) {
            const float shadow = std::clamp(states_[i].shadow, shading::darkest, 1.0f);
            lit[i] = (shadow * shadow * (3.0f - 2.0f * shadow) - shading::dark_light) /
                     (1.0f - shading::dark_light);
        }
    }

  private:
    Vec place(std::size_t ray, float s) const { return rays_[ray].from + s * rays_[ray].towards; }

    void march(std::vector<std::size_t> active) {
        const int budget = worker_.stage.budget;
        for (int turn = 0;; ++turn) {
            std::erase_if(active, [&](std::size_t i) { return !(states_[i].s > rays_[i].margin); });
            if (active.empty()) return;
            if (turn == budget) break;
            for (std::size_t k = 0; k < active.size(); ++k) {
                const State &state = states_[active[k]];
                worker_.points.set(0, k, place(active[k], state.s));
                worker_.limits[k] =
                    state.phase == Phase::Crossing ? 0 : state.shadow * angle_ * state.s;
            }
            distances(worker_, worker_.points, worker_.values.data(), active.size(),
                      worker_.limits.data());
            worker_.work.shadow_steps += active.size();
            step(active);
        }
        worker_.work.undecided_shadows += active.size();
    }

    void step(const std::vector<std::size_t> &active) {
        close_.clear();
        next_.resize(active.size());
        for (std::size_t k = 0; k < active.size(); ++k) {
            const std::size_t i = active[k];
            State &state = states_[i];
            const float d = worker_.values[k], light = angle_ * state.s;
            next_[k] = passed(state, d);
            if (state.phase != Phase::Crossing && state.touches == 0 && state.shadow > 0 &&
                state.mark && !is_bound(worker_, k) && d < state.shadow * light &&
                state.s <= state.quiet)
                close_.push_back({i, state.s, d});
        }
        look();
        for (std::size_t k = 0; k < active.size(); ++k) {
            State &state = states_[active[k]];
            if (!(state.shadow > 0)) {
                state.s = 0;
                continue;
            }
            if (state.touches > 0 || state.phase == Phase::Crossing) {
                state.s -= next_[k];
                state.mark = false;
                continue;
            }
            const float next = state.s - next_[k], mark = next_mark(state, next_[k]);
            state.mark = mark >= next;
            state.s = std::max(next, mark);
        }
    }

    // The step after so many steps of a touch.
    static float probe(int probes, float film, float light) {
        const float least = shading::probe * film;
        return std::max(least, std::min(std::ldexp(least, probes), light / 2));
    }
    // The way on from a sample, by TOUCHES. It may be that all is dark.
    float passed(State &state, float d) const {
        const float film = 0.25f * lengths_.slack_at(state.s), light = angle_ * state.s;
        const bool estimated = lengths_.estimate > 0;
        if (estimated && lengths_.estimate * d < shading::dark * light) d = -1;
        if (d < -film || std::isnan(d) || (d <= 0 && state.touches >= shading::deep)) {
            state.shadow = 0;
            return 0;
        }
        if (d < film) {
            if (state.touches == 0) state.probes = 0;
            state.touches = d > 0 ? 1 : std::max(state.touches, 1) + 1;
            return probe(state.probes++, film, light);
        }
        if (state.touches > 0) {
            state.touches = 0;
        }
        return d;
    }

    // How far the marks about s are apart: the greatest power of 2 that is not above a share of the
    // light's size, so that the same places are marked on every way to them.
    float spacing(float s) const {
        return std::bit_cast<float>(std::bit_cast<std::int32_t>(shading::marks * angle_ * s) &
                                    0x7f800000);
    }
    // The first mark before s where what the ball of radius d about s leaves free may be less than
    // the shadow so far, and not before it is quiet no more.
    float next_mark(const State &state, float d) const {
        const float gap = spacing(state.s);
        const float to = std::min(state.s - (d - state.shadow * angle_ * state.s), state.quiet);
        return gap * std::min(std::floor(to / gap), std::ceil(state.s / gap) - 1);
    }

    // Where something may cover the light, what is found there decides.
    void look() {
        if (close_.empty()) return;
        measure();
        places_.clear(), of_.clear();
        for (std::size_t j = 0; j < close_.size(); ++j) {
            const Close &close = close_[j];
            State &state = states_[close.ray];
            const ShadowRay &ray = rays_[close.ray];
            const float light = angle_ * close.s;
            state.quiet =
                close.s - shading::calm * (std::min(near_[j], values_[j]) - state.shadow * light);
            if (!(near_[j] < state.shadow * light)) continue;
            if (state.phase == Phase::Looking) {
                state.phase = Phase::Crossing, state.first = close.s;
                continue;
            }
            of_.push_back(close.ray);
            places_.push_back({points_[j], values_[j], ray.from, ray.towards, ray.margin, ray.reach,
                               angle_, std::max(ray.arm, shading::penumbra_fine * light),
                               0.25f * lengths_.slack_at(close.s), state.shadow});
        }
        const std::vector<float> off = find_nearest(worker_, places_);
        for (std::size_t i = 0; i < of_.size(); ++i) {
            float &shadow = states_[of_[i]].shadow;
            shadow = std::min(shadow, std::max(off[i], shading::darkest));
        }
    }

    // Of what is close: g in values_, the true distance in near_.
    void measure() {
        const std::size_t n = close_.size();
        points_.resize(n), arms_.resize(n), edges_.resize(n), values_.resize(n), near_.resize(n);
        for (std::size_t j = 0; j < n; ++j) {
            points_[j] = place(close_[j].ray, close_[j].s);
            arms_[j] = rays_[close_[j].ray].arm;
            values_[j] = close_[j].d;
            edges_[j] = states_[close_[j].ray].shadow * angle_ * close_[j].s;
        }
        if (worker_.stage.shaded_apart) evaluate_at(points_, values_);
        near(worker_, points_.data(), values_.data(), arms_.data(), edges_.data(), near_.data(), n);
    }
    void evaluate_at(const std::vector<Vec> &points, std::vector<float> &out) {
        out.resize(points.size());
        for (std::size_t j = 0; j < points.size(); ++j) worker_.points.set(0, j, points[j]);
        shaded_values(worker_, worker_.points, out.data(), points.size());
    }

    struct Close {
        std::size_t ray;
        float s, d;
    };

    Worker &worker_;
    std::span<const ShadowRay> rays_;
    const float angle_;
    const Lengths lengths_;
    std::vector<State> states_;
    std::vector<Close> close_;
    std::vector<Vec> points_;
    std::vector<float> next_, arms_, edges_, values_, near_;
    std::vector<Near> places_;
    std::vector<std::size_t> of_; // whose way each is
};

} // namespace

void shadows(Worker &worker, std::span<const ShadowRay> rays, float angle, std::span<float> lit) {
    Shadows(worker, rays, angle).run(lit);
}

} // namespace fathom::cpu
