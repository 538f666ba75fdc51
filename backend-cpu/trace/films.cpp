// Whether what a value tells of is a solid (shading.h, FILMS). Names and order follow fathom_film of
// backend-glsl/templates/shadow.glsl.
#include "backend-cpu/trace/rays.h"

#include "ir/shading.h"

#include <algorithm>
#include <cmath>

namespace fathom::cpu {

namespace shading = ir::shading;

namespace {

// A way down the field, to where it is 0.
struct Descent {
    std::size_t of; // which approach
    Vec at;
    float g;
};

class Films {
  public:
    Films(Worker &worker, const std::vector<Approach> &ways)
        : worker_(worker), ways_(ways), found_(ways.size(), 0) {}

    std::vector<char> run() {
        for (std::size_t i = 0; i < ways_.size(); ++i)
            descents_.push_back({i, ways_[i].at, ways_[i].g});
        for (int step = 0;; ++step) {
            std::erase_if(descents_, [&](const Descent &way) {
                const float near = shading::film_near * ways_[way.of].thick;
                if (std::fabs(way.g) < near) there_.push_back(way);
                return !(way.g >= near);
            });
            if (step == shading::film_steps || descents_.empty()) break;
            descend();
        }
        look_round();
        return std::move(found_);
    }

  private:
    void descend() {
        const std::size_t n = descents_.size();
        at_.clear(), arms_.clear(), slopes_.resize(n), low_.assign(n, 0), low_at_.resize(n);
        for (const Descent &way : descents_) {
            at_.push_back(way.at);
            arms_.push_back(shading::shadow_arm * way.g);
        }
        gradients(worker_, at_.data(), arms_.data(), slopes_.data(), n);
        for (std::size_t k = 0; k < n; ++k) {
            const float g = descents_[k].g;
            float bent = -4 * g;
            for (std::size_t i = 0; i < 4; ++i) {
                const float tap = worker_.tap_values[i * n + k];
                bent += tap;
                if (i > 0 && !(tap < low_[k])) continue;
                low_[k] = tap, low_at_[k] = at_[k] + arms_[k] * corner(i);
            }
            bent *= 0.25f / arms_[k];
            const float slope =
                std::max(std::sqrt(dot(slopes_[k], slopes_[k]) + shading::crease * bent * bent),
                         shading::min_slope);
            const float size = std::max(length(slopes_[k]), shading::min_slope);
            at_[k] = at_[k] - g / (slope * size) * slopes_[k];
        }
        evaluate();
        for (std::size_t k = 0; k < n; ++k) {
            Descent &way = descents_[k];
            if (!(values_[k] < shading::film_halved * way.g) && low_[k] < values_[k])
                at_[k] = low_at_[k], values_[k] = low_[k];
            if (values_[k] < shading::film_lower * way.g) {
                way.at = at_[k], way.g = values_[k];
                continue;
            }
            found_[way.of] = 1; // a least value above 0
        }
        std::erase_if(descents_, [&](const Descent &way) { return found_[way.of] != 0; });
    }

    // On a circle round a place where the field is 0 some place is in the solid, if there is one.
    void look_round() {
        for (int turn = 0; turn < shading::film_looks && !there_.empty(); ++turn) {
            const float angle = shading::film_turn * static_cast<float>(turn);
            at_.clear();
            for (const Descent &way : there_) {
                const auto &[at, g, thick, l] = ways_[way.of];
                const Vec side =
                    glm::normalize(std::fabs(l.x) < 0.6f ? Vec(0, l.z, -l.y) : Vec(-l.z, 0, l.x));
                at_.push_back(way.at +
                              shading::film_look * thick *
                                  (std::cos(angle) * side + std::sin(angle) * glm::cross(l, side)));
            }
            evaluate();
            for (std::size_t k = 0; k < there_.size(); ++k) there_[k].g = values_[k];
            std::erase_if(there_,
                          [&](const Descent &way) { return !(way.g >= -ways_[way.of].thick); });
        }
        for (const Descent &way : there_) found_[way.of] = 1;
    }

    void evaluate() {
        values_.resize(at_.size());
        for (std::size_t j = 0; j < at_.size(); ++j) worker_.points.set(0, j, at_[j]);
        shaded_values(worker_, worker_.points, values_.data(), at_.size());
    }

    Worker &worker_;
    const std::vector<Approach> &ways_;
    std::vector<char> found_;
    std::vector<Descent> descents_, there_;
    std::vector<Vec> at_, slopes_, low_at_;
    std::vector<float> arms_, values_, low_;
};

} // namespace

std::vector<char> find_films(Worker &worker, const std::vector<Approach> &ways) {
    return Films(worker, ways).run();
}

} // namespace fathom::cpu
