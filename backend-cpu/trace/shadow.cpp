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

struct State {
    float s;                             // what is left of the way
    bool mark = false;                   // whether s is one of the marks
    float shadow = shading::closed_from; // the least of `closed` at them so far, and
    float at = 0, slope = 1;             // where, and the gradient's length there
    float quiet = 1e30f;                 // from where on it is looked at again
    int touches = 0;                     // as Walk::touches
    int probes = 0;                      // steps of the touch
    bool careful = false;                // a film is on the way: each mark is tried for one
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
        find_penumbrae(all);
        if (worker_.stage.frame.films) {
            begin_anew(all);
            march(all);
            find_penumbrae(all);
        }
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
                worker_.limits[k] = state.shadow * angle_ * state.s;
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
            if (state.touches == 0 && state.shadow > 0 && state.mark && !is_bound(worker_, k) &&
                d < state.shadow * light && state.s <= state.quiet)
                close_.push_back({i, state.s, d});
        }
        look();
        for (std::size_t k = 0; k < active.size(); ++k) {
            State &state = states_[active[k]];
            if (!(state.shadow > 0)) {
                state.s = 0;
                continue;
            }
            if (state.touches > 0) {
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

    // Keeps those that a film may have shaded, as they were at first, but for being careful.
    void begin_anew(std::vector<std::size_t> &rays) {
        std::erase_if(rays, [&](std::size_t i) {
            return !(states_[i].shadow > 0 && states_[i].shadow < shading::closed_from);
        });
        close_.clear();
        for (std::size_t i : rays) close_.push_back({i, states_[i].at, 0});
        std::vector<Vec> points(rays.size());
        for (std::size_t j = 0; j < rays.size(); ++j) points[j] = place(rays[j], close_[j].s);
        std::vector<float> values;
        evaluate_at(points, values);
        for (std::size_t j = 0; j < rays.size(); ++j) close_[j].d = values[j];
        measure();
        find_films([](std::size_t) { return true; });
        for (std::size_t j = 0; j < close_.size(); ++j)
            if (on_film_[j])
                states_[close_[j].ray] = {.s = rays_[close_[j].ray].reach, .careful = true};
        std::erase_if(rays, [&](std::size_t i) { return !states_[i].careful; });
    }

    // Where something may cover the light, the true distance decides.
    void look() {
        if (close_.empty()) return;
        measure();
        const auto closed_at = [&](std::size_t j) { return near_[j] / (angle_ * close_[j].s); };
        find_films([&](std::size_t j) {
            const State &state = states_[close_[j].ray];
            return state.careful && closed_at(j) < state.shadow;
        });
        for (std::size_t j = 0; j < close_.size(); ++j) {
            const Close &close = close_[j];
            State &state = states_[close.ray];
            const float closed = closed_at(j);
            state.quiet = close.s - shading::calm * (std::min(near_[j], values_[j]) -
                                                     state.shadow * angle_ * close.s);
            if (closed < state.shadow && !on_film_[j]) {
                state.shadow = std::max(closed, shading::darkest);
                state.at = close.s;
                state.slope = values_[j] > 0 ? values_[j] / near_[j] : 1.0f;
            }
        }
    }

    // Of what is close: g in values_, the true distance in near_.
    void measure() {
        const std::size_t n = close_.size();
        points_.resize(n), arms_.resize(n), values_.resize(n), near_.resize(n);
        for (std::size_t j = 0; j < n; ++j) {
            points_[j] = place(close_[j].ray, close_[j].s);
            arms_[j] = rays_[close_[j].ray].arm;
            values_[j] = close_[j].d;
        }
        if (worker_.stage.shaded_apart) evaluate_at(points_, values_);
        for (std::size_t j = 0; j < n; ++j)
            arms_[j] = std::max(arms_[j], shading::shadow_arm * values_[j]);
        near(worker_, points_.data(), values_.data(), arms_.data(), near_.data(), n);
    }
    // Of these of what is close: whether it is a film (shading.h, FILMS).
    template <class Which> void find_films(Which which) {
        on_film_.assign(close_.size(), 0);
        std::vector<std::size_t> tried;
        std::vector<Approach> ways;
        for (std::size_t j = 0; j < close_.size(); ++j) {
            if (!which(j)) continue;
            tried.push_back(j);
            ways.push_back({points_[j], values_[j], 0.25f * lengths_.slack_at(close_[j].s),
                            rays_[close_[j].ray].towards});
        }
        const std::vector<char> found = cpu::find_films(worker_, ways);
        for (std::size_t i = 0; i < tried.size(); ++i) on_film_[tried[i]] = found[i];
    }

    void evaluate_at(const std::vector<Vec> &points, std::vector<float> &out) {
        out.resize(points.size());
        for (std::size_t j = 0; j < points.size(); ++j) worker_.points.set(0, j, points[j]);
        shaded_values(worker_, worker_.points, out.data(), points.size());
    }

    void find_penumbrae(const std::vector<std::size_t> &rays) {
        constexpr float golden = 0.618033989f;
        struct Search {
            std::size_t ray;
            float lo, hi, a, b, at_a, at_b; // a < b, in between
        };
        std::vector<Search> searches;
        for (std::size_t i : rays) {
            const State &state = states_[i];
            if (!(state.shadow > shading::darkest && state.shadow < shading::closed_from)) continue;
            const float gap = spacing(state.at);
            const float lo = std::max(state.at - gap, rays_[i].margin),
                        hi = std::min(state.at + gap, rays_[i].reach);
            const float part = golden * (hi - lo);
            searches.push_back({i, lo, hi, hi - part, lo + part, 0, 0});
        }
        if (searches.empty()) return;
        std::vector<Vec> points(searches.size());
        std::vector<float> values;
        const auto closed = [&](auto where, auto result) {
            for (std::size_t j = 0; j < searches.size(); ++j)
                points[j] = place(searches[j].ray, where(searches[j]));
            evaluate_at(points, values);
            for (std::size_t j = 0; j < searches.size(); ++j) {
                Search &search = searches[j];
                result(search, values[j] / (states_[search.ray].slope * angle_ * where(search)));
            }
        };
        closed([](const Search &x) { return x.a; }, [](Search &x, float c) { x.at_a = c; });
        closed([](const Search &x) { return x.b; }, [](Search &x, float c) { x.at_b = c; });
        for (int turn = 0; turn < shading::penumbra_turns; ++turn) {
            std::vector<char> left(searches.size());
            for (std::size_t j = 0; j < searches.size(); ++j) {
                Search &x = searches[j];
                left[j] = x.at_a < x.at_b;
                if (left[j]) {
                    x.hi = x.b, x.b = x.a, x.at_b = x.at_a;
                    x.a = x.hi - golden * (x.hi - x.lo);
                } else {
                    x.lo = x.a, x.a = x.b, x.at_a = x.at_b;
                    x.b = x.lo + golden * (x.hi - x.lo);
                }
            }
            const auto made = [&](const Search &x) {
                return left[static_cast<std::size_t>(&x - searches.data())] ? x.a : x.b;
            };
            closed(made, [&](Search &x, float c) {
                (left[static_cast<std::size_t>(&x - searches.data())] ? x.at_a : x.at_b) = c;
            });
        }
        close_.clear();
        for (const Search &x : searches) close_.push_back({x.ray, x.at_a < x.at_b ? x.a : x.b, 0});
        for (std::size_t j = 0; j < close_.size(); ++j)
            points[j] = place(close_[j].ray, close_[j].s);
        evaluate_at(points, values);
        for (std::size_t j = 0; j < close_.size(); ++j) close_[j].d = values[j];
        look();
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
    std::vector<float> next_, arms_, values_, near_;
    std::vector<char> on_film_; // as close_
};

} // namespace

void shadows(Worker &worker, std::span<const ShadowRay> rays, float angle, std::span<float> lit) {
    Shadows(worker, rays, angle).run(lit);
}

} // namespace fathom::cpu
