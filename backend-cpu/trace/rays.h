// What marching and shading share: points in structure-of-arrays form, and one thread's memory for
// evaluating them.
#pragma once

#include "backend-cpu/prune/pruning.h"
#include "backend-cpu/trace/march.h"
#include "ir/shading.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <optional>

namespace fathom::cpu {

using Vec = glm::vec3;
using glm::dot, glm::length;
inline Vec vec(const glm::dvec3 &a) { return Vec(a); }
inline Vec vec(const std::array<float, 3> &a) { return {a[0], a[1], a[2]}; }
inline float clamp(float x, float lo, float hi) { return std::fmin(std::fmax(x, lo), hi); }

// Rows of numbers, one column a point: what a Program takes and gives.
class Columns {
  public:
    Columns(std::size_t rows, std::size_t most) : most_(most), numbers_(rows * most) {
        for (std::size_t r = 0; r < rows; ++r) pointers_.push_back(numbers_.data() + r * most);
    }
    Columns(const Columns &) = delete;
    Columns &operator=(const Columns &) = delete;
    float *operator[](std::size_t row) { return pointers_[row]; }
    float *const *pointers() const { return pointers_.data(); }
    void set(std::size_t row, std::size_t i, Vec v) {
        pointers_[row][i] = v.x;
        pointers_[row + 1][i] = v.y;
        pointers_[row + 2][i] = v.z;
    }
    Vec vec(std::size_t row, std::size_t i) const {
        return {pointers_[row][i], pointers_[row + 1][i], pointers_[row + 2][i]};
    }
    std::size_t most() const { return most_; }

  private:
    std::size_t most_;
    std::vector<float> numbers_;
    std::vector<float *> pointers_;
};

// A picture's tiles are as large as its threads allow: rays that take long are few in each, and the
// last ones of a tile leave the vectors empty.
inline constexpr int max_tile_side = 128, min_tile_side = 32, tiles_a_thread = 6;
inline constexpr std::size_t max_rays = max_tile_side * max_tile_side;

struct CellMarch;

// One thread's.
struct Worker {
    explicit Worker(const Stage &stage);
    const Stage &stage;
    Scratch distance, safe_radius, hit, background, shaded;
    std::optional<CellEvaluator> evaluator, hit_evaluator, shaded_evaluator;
    std::vector<float> limits = std::vector<float>(max_rays);
    std::vector<Scratch> surfaces;
    Columns points{3, max_rays};
    std::vector<float> values = std::vector<float>(max_rays);
    std::vector<float> spans = std::vector<float>(max_rays);
    Columns taps{3, 4 * max_rays};
    std::vector<float> tap_values = std::vector<float>(4 * max_rays);
    Columns hits{9, max_rays};
    std::shared_ptr<CellMarch> cell_march; // made when first needed
    Work work;
};

// Numbers of the frame in float32.
struct Lengths {
    float slack, coarse, pixel, far, base, slope;
    bool fades; // what lies far off, as rays have no box
    bool orthographic;
    float estimate; // Frame::estimate
    explicit Lengths(const Stage &stage);
    float tolerance(float t) const { return base + slope * t; }
    float arm(float t) const;
    float slack_at(float t) const { return slack + ir::shading::float_slack * t; }
    float width(float t) const { return orthographic ? pixel : pixel * t; } // of a pixel
};

struct RayState {
    Vec origin, direction;
    float begin = 0, end = 0;
};
struct Inside {
    float first, last;
};
Inside box(const ir::Frame &frame, Vec origin, Vec direction);
RayState clipped(const Stage &stage, Vec origin,
                 Vec direction); // between the eye and the end of everything

// limits: from what value on a lower bound of the distance will do, by point; without them all are
// exact.
void distances(Worker &worker, const Columns &points, float *out, std::size_t n,
               const float *limits = nullptr);
// The distances, and how far they reach (Scene::safe_radius).
void safe_radii(Worker &worker, const Columns &points, float *out, float *spans, std::size_t n);
bool is_bound(const Worker &worker, std::size_t k); // of the last distances'
void hits(Worker &worker, std::size_t n);           // at worker.points, into worker.hits
// Scene::shaded at the first n points.
void shaded_values(Worker &worker, const Columns &points, float *out, std::size_t n);
// Its gradients at n points, with arms h.
Vec corner(std::size_t i);
void gradients(Worker &worker, const Vec *points, const float *h, Vec *out, std::size_t n);
// And the slopes there (shading.h, TRUE DISTANCE), where it says g.
void slopes(Worker &worker, const Vec *points, const float *g, const float *h, Vec *gradient,
            float *out, std::size_t n);
// The true distances near n points where it says g (shading.h, TRUE DISTANCE), by gradients of these
// arms at least.
void near(Worker &worker, const Vec *points, const float *g, const float *least_arm,
          const float *edge, float *out, std::size_t n);

// A point, or a way to a light, that the solid may be near to (shading.h, NEAREST).
struct Near {
    Vec at;            // where the search begins,
    float g;           // and Scene::shaded there
    Vec from;          // what it is near to: this point,
    Vec towards;       // or the way from there along this, of length 1
    float first, last; // of the way
    float angle;       // half the light's angular size; 0 for a point
    float fine;        // as near to the surface as it has to be
    float thick;       // what is touched is below it
    float limit;       // what is farther off does not count
};
// How far off the solid is that is found: from a point; from a way in lights' sizes; or nowhere.
std::vector<float> find_nearest(Worker &worker, const std::vector<Near> &places);

// A hit's place: between the last two samples of its walk (shading.h, REFINED).
struct Crossing {
    std::size_t ray;
    float a, b, at_a, at_b; // along the ray, and the field there: above 0, at most 0
    bool aimed;             // at a quarter of a tolerance before b
};
void refine(Worker &worker, std::span<const RayState> rays, std::span<Crossing> crossings,
            std::span<Landing> landings);
void march(Worker &worker, std::span<const RayState> rays, std::span<Landing> landings, bool brute);
// Linear colours of the rays; those with t < 0 see the background. With `cover` they see none: it is
// how much of a ray's colour is the surface's, 0 to 1, and the colours are multiplied by it.
void shade(Worker &worker, std::span<const RayState> rays, std::span<const Landing> landings,
           std::span<Vec> colors, std::span<float> cover = {});

struct ShadowRay {
    Vec from, towards;
    float reach, margin, arm;
};
void shadows(Worker &worker, std::span<const ShadowRay> rays, float angle, std::span<float> lit);

} // namespace fathom::cpu
