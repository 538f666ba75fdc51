// Where the solid is nearest to a point or to a way (shading.h, NEAREST, FILMS). Names and order follow
// backend-glsl/templates/nearest.glsl.
#include "backend-cpu/trace/rays.h"

#include "ir/shading.h"

#include <algorithm>
#include <cmath>

namespace fathom::cpu {

namespace shading = ir::shading;

namespace {

// A way down the field from p, where its value is g, to where it is below `fine`.
struct Descent {
    std::size_t of; // which place it is for
    Vec p;
    float g, fine;
    float slope = 0;
    Vec v{0};        // the gradient of the last step, which says that the field
    float ahead = 0; // is this at p
    int steps = 0;
    bool waits = false; // for its value: it has just begun anew
    bool landed = false;
    int stalls = 0; // steps in a row that led nowhere below
};

// What is found for a place.
struct Best {
    float off = shading::nowhere;
    Vec at{0}, v{0}, way{0}; // … the gradient, and the way there
    float g = 0;
    Vec edge{0};     // what a circle round it is across
    Vec along{0};    // the way on from there along the surface
    float share = 1; // of that way
    float first = 0; // how far off the field said it was at first
    int slides = 0;
    bool returned = false; // from beyond the light, along the surface
};

Vec perpendicular(Vec v) {
    return std::fabs(v.x) < std::fabs(v.y) ? Vec(0, v.z, -v.y) : Vec(-v.z, 0, v.x);
}

class Searches {
  public:
    Searches(Worker &worker, const std::vector<Near> &places)
        : worker_(worker), places_(places), best_(places.size()) {}

    std::vector<float> run() {
        for (std::size_t i = 0; i < places_.size(); ++i)
            ways_.push_back({i, places_[i].at, places_[i].g, places_[i].fine});
        while (!ways_.empty()) {
            descend();
            std::erase_if(ways_, [&](Descent &way) {
                const bool ended = way.landed || way.steps >= shading::descent_steps;
                way.waits = ended && slides(way);
                return ended && !way.waits;
            });
        }
        if (worker_.stage.frame.films) leave_out_films();
        std::vector<float> found(best_.size());
        for (std::size_t i = 0; i < best_.size(); ++i) found[i] = best_[i].off;
        return found;
    }

  private:
    // Whether there is another way to try from the best place so far.
    bool slides(Descent &way) {
        const Near &place = places_[way.of];
        Best &best = best_[way.of];
        const bool point = !(place.angle > 0);
        const float x = dot(way.p - place.from, place.towards);
        const float size = point ? 1.0f : place.angle * x;
        const Vec off = way.p - place.from - x * place.towards;
        if (way.landed && !point && x > place.last && !best.returned) {
            const Vec n = way.v / std::max(length(way.v), shading::min_slope);
            const Vec back = place.towards - dot(place.towards, n) * n;
            best.returned = true;
            way.p = way.p + (place.last - x) / std::max(dot(back, back), shading::min_slope) * back;
            way.steps = 0;
            way.landed = false;
            return true;
        }
        const bool counts =
            way.landed && (point || (x > place.first && x < place.last + place.fine));
        if (counts && length(off) / size < best.off) {
            const Vec n = way.v / std::max(length(way.v), shading::min_slope);
            const float before = best.off;
            best.off = length(off) / size, best.at = way.p, best.v = way.v, best.g = way.g,
            best.way = off;
            best.along = dot(off, n) * n - off;
            const float gain = (before - best.off) * size;
            if (length(way.v) < shading::steady * way.slope) return false;
            if (!(std::min(gain, length(off) - std::fabs(dot(off, n))) > place.fine)) return false;
            if (point && length(off) < shading::near_enough * best.first) return false;
        } else {
            best.share *= 0.25f;
        }
        if (best.slides == (point ? shading::occlusion_slides : shading::most_slides) ||
            best.share < shading::least_share ||
            !(best.share * length(best.along) > 0.5f * place.fine))
            return false;
        way.p = best.at + best.share * best.along;
        way.steps = 0;
        way.landed = false;
        ++best.slides;
        return true;
    }

    // A step down for each way that does not wait, and the values where they are then.
    void descend() {
        points_.clear(), g_.clear(), arms_.clear(), below_.clear();
        for (std::size_t k = 0; k < ways_.size(); ++k) {
            const Descent &way = ways_[k];
            if (way.waits) continue;
            below_.push_back(k), points_.push_back(way.p), g_.push_back(way.g);
            const float away = std::fabs(way.g) / (way.slope > 0 ? way.slope : 1.0f);
            arms_.push_back(std::max(way.fine, shading::shadow_arm * away));
        }
        const std::size_t n = below_.size();
        gradients_.resize(n), slopes_.resize(n);
        slopes(worker_, points_.data(), g_.data(), arms_.data(), gradients_.data(), slopes_.data(),
               n);
        for (std::size_t k = 0; k < n; ++k)
            step(ways_[below_[k]], arms_[k], gradients_[k], slopes_[k]);
        evaluate();
        if (worker_.stage.frame.unit_slope)
            for (Descent &way : ways_) way.landed = std::fabs(way.g) < way.fine * way.slope;
    }

    // To where the gradient v says that the field is 0; unless it is there, or the arm was longer than
    // that is far. Where that is above 0 by the gradient of the step before, the field is the greater
    // of two, and 0 where both are.
    void step(Descent &way, float arm, Vec v, float slope) {
        const Vec u = way.v;
        const bool first = way.steps++ == 0;
        const float away = std::fabs(way.g) / slope;
        way.landed =
            searches_ && !worker_.stage.frame.unit_slope && way.slope > 0 && away < way.fine;
        if (way.landed) return;
        way.slope = slope;
        if (arm > std::max(way.fine, away)) return;
        if (best_[way.of].first == 0) best_[way.of].first = away;
        way.v = v;
        Vec by = -way.g / (slope * std::max(length(v), shading::min_slope)) * v;
        const float vv = dot(v, v), uu = dot(u, u), uv = dot(u, v), det = vv * uu - uv * uv;
        if (!first && way.ahead + dot(u, by) > 0 && det > shading::descent_apart * vv * uu)
            by = ((way.ahead * uv - way.g * uu) * v + (way.g * uv - way.ahead * vv) * u) / det;
        way.ahead = way.g + dot(v, by);
        way.p = way.p + by;
    }

    void leave_out_films() {
        searches_ = false;
        for (std::size_t i = 0; i < places_.size(); ++i) {
            const Best &best = best_[i];
            if (best.off < places_[i].limit)
                ways_.push_back({i, best.at, best.g, shading::film_near * places_[i].thick});
        }
        std::vector<Descent> there;
        const auto is_done = [&](const Descent &way) {
            if (std::fabs(way.g) < way.fine) there.push_back(way);
            return !(way.g >= way.fine) || way.steps == shading::film_steps;
        };
        std::erase_if(ways_, is_done);
        while (!ways_.empty()) {
            before_.clear();
            for (const Descent &way : ways_) before_.push_back(way.g);
            descend();
            std::size_t k = 0;
            std::erase_if(ways_, [&](Descent &way) {
                const bool lower = way.g < shading::film_lower * before_[k++];
                way.stalls = lower ? 0 : way.stalls + 1;
                if (way.stalls == shading::film_stalls) {
                    best_[way.of].off = shading::nowhere; // a least value above 0
                    return true;
                }
                return is_done(way);
            });
        }
        ways_ = std::move(there);
        look_round();
    }

    // On a circle round a place where the field is 0 some place is in the solid, if there is one. It
    // lies across the edge, which both the way down and the way there are across.
    void look_round() {
        for (const Descent &way : ways_) {
            Best &best = best_[way.of];
            best.at = way.p;
            best.edge = glm::cross(best.v, best.way);
            const float least = dot(best.v, best.v) * dot(best.way, best.way);
            if (!(dot(best.edge, best.edge) > shading::film_flat * least))
                best.edge = perpendicular(best.v);
            best.edge = glm::normalize(best.edge);
        }
        for (int turn = 0; turn < shading::film_looks && !ways_.empty(); ++turn) {
            const float angle = shading::film_turn * static_cast<float>(turn);
            for (Descent &way : ways_) {
                const Best &best = best_[way.of];
                const Vec side = glm::normalize(perpendicular(best.edge));
                way.p = best.at + shading::film_look * places_[way.of].thick *
                                      (std::cos(angle) * side +
                                       std::sin(angle) * glm::cross(best.edge, side));
            }
            evaluate();
            std::erase_if(ways_,
                          [&](const Descent &way) { return !(way.g >= -places_[way.of].thick); });
        }
        for (const Descent &way : ways_) best_[way.of].off = shading::nowhere;
    }

    // The values where the ways are.
    void evaluate() {
        for (std::size_t k = 0; k < ways_.size(); ++k) worker_.points.set(0, k, ways_[k].p);
        shaded_values(worker_, worker_.points, worker_.values.data(), ways_.size());
        for (std::size_t k = 0; k < ways_.size(); ++k) ways_[k].g = worker_.values[k];
    }

    Worker &worker_;
    const std::vector<Near> &places_;
    std::vector<Best> best_; // of each place
    std::vector<Descent> ways_;
    bool searches_ = true;           // for the surface, and not beyond what is found
    std::vector<std::size_t> below_; // those that step down
    std::vector<Vec> points_, gradients_;
    std::vector<float> g_, arms_, slopes_, before_;
};

} // namespace

std::vector<float> find_nearest(Worker &worker, const std::vector<Near> &places) {
    return Searches(worker, places).run();
}

} // namespace fathom::cpu
