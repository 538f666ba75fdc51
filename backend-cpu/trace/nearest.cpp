// Where the solid is nearest to a point or to a way (shading.h, NEAREST, FILMS). Names and order follow
// backend-glsl/templates/nearest.glsl.
#include "backend-cpu/trace/rays.h"

#include "ir/shading.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace fathom::cpu {

namespace shading = ir::shading;

namespace {

// A way down the field from p, where its value is g, to where it is below `fine`.
struct Descent {
    std::size_t of; // which place it is for
    Vec p;
    float g, fine;
    float slope = 0;
    Vec v{0};         // the gradient of the last step, which says that the field
    float ahead = 0;  // is this at p
    float stride = 0; // the last step's length,
    Vec last{0};      // where it began,
    float before = 0; // and the field there
    float was = 0;    // and its slope
    Vec other{0};     // the last place where the field had the other sign,
    float beyond = 0; // and its value there; 0: none
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
    bool none = false;     // no solid is at `at`, where the field has this
    float slope = 1;
};

// Circles beside a place without a solid (shading.h, BESIDE), and what is found on them.
struct Circles {
    std::size_t of;
    Vec middle, side, up;       // the last two of length 1
    Vec behind;                 // how far before or behind the plane they lie
    float reach;                // the greatest one's radius, across the way
    bool found = false;         // a place in the solid, on
    float angle = 0, share = 0; // this circle; on those of
    float free = 0;             // this share and less there is none
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
        if (worker_.stage.frame.films) {
            leave_out_films();
            look_beside();
        }
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
            best.way = off, best.slope = std::max(way.slope, shading::min_slope);
            best.along = dot(off, n) * n - off;
            const float gain = (before - best.off) * size;
            if (length(way.v) < shading::steady * way.slope) return false;
            if (!(std::min(gain, length(off) - std::fabs(dot(off, n))) > place.fine)) return false;
            if (point && length(off) < shading::near_enough * best.first) return false;
        } else {
            if (!way.landed && best.off == shading::nowhere) rule_out(way);
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
        if (!worker_.stage.frame.unit_slope) by = kept_near(way, by, first);
        way.ahead = way.g + dot(v, by);
        way.p = way.p + by;
    }

    // What DOWN makes of a step: not too far, half the step before where that led past something,
    // faster where steps hardly shorten, and between two places of which one is in the solid.
    Vec kept_near(Descent &way, Vec by, bool first) const {
        const Near &place = places_[way.of];
        const bool point = !(place.angle > 0);
        const float light = point ? 1.0f : place.angle * dot(way.p - place.from, place.towards);
        const float most = shading::descent_reach * place.limit * light, size = length(by);
        if (first) way.stride = way.before = way.beyond = 0;
        if (way.before * way.g < 0) way.other = way.last, way.beyond = way.before;
        const float ratio = way.before * way.g > 0 ? size / way.stride : 0;
        const Vec came = way.p - way.last;
        const bool past =
            !first && way.g > 0 && way.before > 0 && way.slope > way.was && dot(way.v, came) > 0;
        const bool far = most > 0 && size > most;
        if (far) by *= most / size;
        if (past) by = -0.5f * came;
        way.stride = past ? 0.5f * length(came) : size;
        if (!past) way.last = way.p, way.before = way.g, way.was = way.slope;
        if (!far && !past && way.steps > shading::descent_plain && ratio > shading::descent_slow &&
            ratio < 1)
            by /= std::max(1 - ratio, shading::descent_fastest);
        const Vec across = way.other - way.p;
        if (way.beyond * way.g < 0 && length(by) > shading::descent_across * length(across))
            by = std::clamp(way.g / (way.g - way.beyond), shading::descent_least,
                            1 - shading::descent_least) *
                 across;
        return by;
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
                    rule_out(way); // a least value above 0
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
                way.p =
                    best.at +
                    shading::film_look * places_[way.of].thick / std::min(best.slope, 1.0f) *
                        (std::cos(angle) * side + std::sin(angle) * glm::cross(best.edge, side));
            }
            evaluate();
            std::erase_if(ways_,
                          [&](const Descent &way) { return !(way.g >= -places_[way.of].thick); });
        }
        for (const Descent &way : ways_) {
            best_[way.of].off = shading::nowhere;
            best_[way.of].none = true, best_[way.of].g = 0;
        }
        ways_.clear();
    }

    // No solid is where the way has ended.
    void rule_out(const Descent &way) {
        Best &best = best_[way.of];
        best.off = shading::nowhere;
        best.none = true, best.at = way.p, best.v = way.v, best.g = way.g;
        best.slope = std::max(way.slope, shading::min_slope);
    }

    // shading.h, BESIDE.
    void look_beside() {
        circles_.clear();
        for (std::size_t i = 0; i < places_.size(); ++i)
            if (best_[i].none) begin_circles(i);
        for (int look = 0; look < shading::circles * 2 * shading::circle_looks && !circles_.empty();
             ++look)
            look_on_circle(look);
        std::erase_if(circles_, [](const Circles &circles) { return !circles.found; });
        float turn = 0.5f * shading::circle_turn;
        for (int i = 0; i < shading::circle_halvings && !circles_.empty(); ++i) {
            halve(turn);
            turn *= shading::circle_narrower;
        }
        for (const Circles &circles : circles_) {
            const Near &place = places_[circles.of];
            const Vec from = on_circle(circles, circles.angle, circles.share) - place.from;
            const float x = dot(from, place.towards);
            const bool point = !(place.angle > 0);
            if (point || (x > place.first && x < place.last + place.fine))
                best_[circles.of].off =
                    length(from - x * place.towards) / (point ? 1.0f : place.angle * x);
        }
    }

    void begin_circles(std::size_t i) {
        const Best &best = best_[i];
        const Near &place = places_[i];
        const bool point = !(place.angle > 0);
        const float x = dot(best.at - place.from, place.towards);
        const float reach = place.limit * (point ? 1.0f : place.angle * x);
        const float away = std::fabs(best.g) / best.slope;
        if (!(away < reach && (point || (x > place.first && x < place.last)))) return;
        if (!(dot(best.v, best.v) > 0)) return;
        const Vec n = glm::normalize(best.v), beside = place.from + x * place.towards;
        const float across = dot(place.towards, n), off = dot(best.at - beside, n);
        const Vec to = std::fabs(across) > shading::circle_across ? place.towards / across : n;
        const Vec side = glm::normalize(perpendicular(n));
        circles_.push_back({i, beside + off * to, side, glm::cross(n, side),
                            (away + shading::film_look * place.thick) * n, reach});
    }

    Vec on_circle(const Circles &circles, float angle, float share) const {
        const Vec out = std::cos(angle) * circles.side + std::sin(angle) * circles.up;
        const Vec l = places_[circles.of].towards;
        const float across = std::max(length(out - dot(out, l) * l), shading::circle_across);
        return circles.middle + circles.behind + share * circles.reach / across * out;
    }

    // From the least circle on; at each angle before and behind.
    void look_on_circle(int look) {
        const float share = static_cast<float>(1 + look / (2 * shading::circle_looks)) /
                            static_cast<float>(shading::circles);
        const float angle =
            shading::circle_turn * static_cast<float>(look % (2 * shading::circle_looks) / 2);
        evaluate(circles_.size(), [&](std::size_t k) {
            if (!circles_[k].found) circles_[k].behind = -circles_[k].behind;
            return on_circle(circles_[k], angle, share);
        });
        for (std::size_t k = 0; k < circles_.size(); ++k) {
            Circles &circles = circles_[k];
            if (circles.found || !(worker_.values[k] < -places_[circles.of].thick)) continue;
            circles.found = true, circles.angle = angle;
            circles.share = share, circles.free = share - 1.0f / shading::circles;
        }
    }

    // The circle between the one with a place in the solid and the next, at the place and beside it.
    void halve(float turn) {
        turned_.assign(circles_.size(), {});
        for (const float by : {0.0f, turn, -turn}) {
            evaluate(circles_.size(), [&](std::size_t k) {
                const Circles &circles = circles_[k];
                return on_circle(circles, circles.angle + by,
                                 0.5f * (circles.free + circles.share));
            });
            for (std::size_t k = 0; k < circles_.size(); ++k)
                if (!turned_[k] && worker_.values[k] < -places_[circles_[k].of].thick)
                    turned_[k] = by;
        }
        for (std::size_t k = 0; k < circles_.size(); ++k) {
            Circles &circles = circles_[k];
            (turned_[k] ? circles.share : circles.free) = 0.5f * (circles.free + circles.share);
            circles.angle += turned_[k].value_or(0);
        }
    }

    // The field at at(k) for each k below n, into worker_.values.
    template <class At> void evaluate(std::size_t n, At at) {
        for (std::size_t k = 0; k < n; ++k) worker_.points.set(0, k, at(k));
        shaded_values(worker_, worker_.points, worker_.values.data(), n);
    }
    // The values where the ways are.
    void evaluate() {
        evaluate(ways_.size(), [&](std::size_t k) { return ways_[k].p; });
        for (std::size_t k = 0; k < ways_.size(); ++k) ways_[k].g = worker_.values[k];
    }

    Worker &worker_;
    const std::vector<Near> &places_;
    std::vector<Best> best_; // of each place
    std::vector<Descent> ways_;
    std::vector<Circles> circles_;
    std::vector<std::optional<float>> turned_; // by what angle the solid is nearer
    bool searches_ = true;                     // for the surface, and not beyond what is found
    std::vector<std::size_t> below_;           // those that step down
    std::vector<Vec> points_, gradients_;
    std::vector<float> g_, arms_, slopes_, before_;
};

} // namespace

std::vector<float> find_nearest(Worker &worker, const std::vector<Near> &places) {
    return Searches(worker, places).run();
}

} // namespace fathom::cpu
