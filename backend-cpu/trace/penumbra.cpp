// What is beside the ways to the lights, and how far off (shading.h, PENUMBRA). Names and order follow
// fathom_beside of backend-glsl/templates/shadow.glsl.
#include "backend-cpu/trace/rays.h"

#include "ir/shading.h"

#include <algorithm>
#include <cmath>

namespace fathom::cpu {

namespace shading = ir::shading;

namespace {

struct Search {
    std::size_t of; // which sight
    Vec p;          // on the way down to the surface
    float g = 0, slope = 0;
    Vec v{0}; // the gradient of the last step
    int steps = 0, slides = 0;
    Vec along{0};    // the way on from the place of the surface that is least off
    float share = 1; // of that way
};

class Searches {
  public:
    Searches(Worker &worker, const std::vector<Sight> &sights) : worker_(worker), sights_(sights) {
        for (std::size_t i = 0; i < sights.size(); ++i) {
            found_.push_back({shading::nowhere, sights[i].at, 0});
            searches_.push_back({i, sights[i].at});
        }
    }

    std::vector<Beside> run() {
        while (!searches_.empty()) {
            for (std::size_t k = 0; k < searches_.size(); ++k)
                worker_.points.set(0, k, searches_[k].p);
            shaded_values(worker_, worker_.points, worker_.values.data(), searches_.size());
            for (std::size_t k = 0; k < searches_.size(); ++k) searches_[k].g = worker_.values[k];
            below_.clear();
            std::size_t kept = 0;
            for (Search search : searches_) {
                const bool landed = std::fabs(search.g) < sights_[search.of].fine * search.slope;
                if (landed || search.steps == shading::descent_steps) {
                    if (!slides(search, landed)) continue;
                } else {
                    below_.push_back(kept);
                }
                searches_[kept++] = search;
            }
            searches_.resize(kept);
            descend();
        }
        return std::move(found_);
    }

  private:
    // Whether there is another way to try from the best place so far.
    bool slides(Search &search, bool landed) {
        const Sight &sight = sights_[search.of];
        const float x = dot(search.p - sight.from, sight.towards);
        const Vec off = search.p - sight.from - x * sight.towards;
        const float offset = landed && x > sight.margin && x < sight.reach
                                 ? length(off) / (sight.angle * x)
                                 : shading::nowhere;
        Beside &found = found_[search.of];
        if (offset < found.off) {
            const float before = found.off;
            found = {offset, search.p, search.g};
            const Vec n = search.v / std::max(length(search.v), shading::min_slope);
            search.along = dot(off, n) * n - off;
            const float gain = (before - offset) * sight.angle * x;
            if (length(search.v) < shading::steady * search.slope) return false;
            if (!(std::min(gain, length(off) - std::fabs(dot(off, n))) > 0.25f * sight.fine))
                return false;
        } else {
            search.share *= 0.25f;
        }
        if (search.slides == shading::most_slides ||
            !(search.share * length(search.along) > 0.5f * sight.fine) ||
            search.share < shading::least_share)
            return false;
        search.p = found.at + search.share * search.along;
        search.steps = 0;
        ++search.slides;
        return true;
    }

    void descend() {
        const std::size_t n = below_.size();
        points_.clear(), arms_.clear(), gradients_.resize(n);
        for (std::size_t k : below_) {
            const Search &search = searches_[k];
            points_.push_back(search.p);
            arms_.push_back(
                std::max(sights_[search.of].fine, shading::shadow_arm * std::fabs(search.g)));
        }
        gradients(worker_, points_.data(), arms_.data(), gradients_.data(), n);
        for (std::size_t k = 0; k < n; ++k) {
            Search &search = searches_[below_[k]];
            search.v = gradients_[k];
            float bent = -4 * search.g;
            for (std::size_t i = 0; i < 4; ++i) bent += worker_.tap_values[i * n + k];
            bent *= 0.25f / arms_[k];
            search.slope =
                std::max(std::sqrt(dot(search.v, search.v) + shading::crease * bent * bent),
                         shading::min_slope);
            const float size = std::max(length(search.v), shading::min_slope);
            search.p = search.p - search.g / (search.slope * size) * search.v;
            ++search.steps;
        }
    }

    Worker &worker_;
    const std::vector<Sight> &sights_;
    std::vector<Beside> found_;
    std::vector<Search> searches_;
    std::vector<std::size_t> below_; // those on the way down
    std::vector<Vec> points_, gradients_;
    std::vector<float> arms_;
};

} // namespace

std::vector<Beside> find_beside(Worker &worker, const std::vector<Sight> &sights) {
    return Searches(worker, sights).run();
}

} // namespace fathom::cpu
