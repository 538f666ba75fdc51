// The CPU's pictures: ir/shading.h over batches of rays, in float32 and in the order of
// backend-glsl/marcher.cpp, on all cores. Opens and prints nothing.
#pragma once

#include "backend-cpu/tape.h"
#include "ir/view.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>

namespace fathom::cpu {

// Work that was done, in numbers that do not depend on the machine.
struct Work {
    std::uint64_t rays = 0; // from the eye
    std::uint64_t hits = 0;
    std::uint64_t steps = 0; // of rays from the eye: evaluations on their way, shading.h's `steps`
    std::uint64_t shadow_steps = 0;
    std::uint64_t evaluations = 0; // of the distance, for whatever purpose
    std::uint64_t undecided = 0;   // rays from the eye that ended neither in a hit nor in a miss
    std::uint64_t undecided_shadows = 0; // rays from lights that ran out of evaluations
    std::uint64_t passed = 0; // rays from the eye that passed a surface without an inside
    // With pruning: of those, how many a far cell answered; what cells near the surface keep of the
    // shapes, all told; and how many evaluations that were.
    std::uint64_t far = 0, near = 0;
    double near_shapes = 0;
    Work &operator+=(const Work &other);
};

struct Pruning;
// Whether the shapes that cannot matter are left out, cell by cell (pruning.h). By itself from so
// many shapes on.
enum class Prune : std::uint8_t { Auto, Never, Always };
inline constexpr float prune_from = 256;

// A scene made ready to be looked at from one place. Constant while any number of threads use it.
struct Stage {
    const ir::Scene *scene = nullptr;
    int width = 0, height = 0;
    ir::View view;
    ir::Frame frame;
    Inputs inputs;
    Program distance, hit, background;
    Program shaded; // Scene::shaded, where that is not the distance
    bool shaded_apart = false;
    Program safe_radius; // Scene::safe_radius, where `reaches`: not with pruning
    std::shared_ptr<const Pruning> pruning, hit_pruning, shaded_pruning; // none: not worth it
    std::vector<Program> surfaces;
    std::vector<ir::LightValue> lights;
    bool has_background = false, has_safe_radius = false;
    bool local_normals = false; // some surface reads its normal
    int budget = 0;             // evaluations that a ray may take
    struct Shading {
        float ambient[3] = {};
        float ambient_occlusion = 0, shadow_darkness = 0, soft_shadows = 0, specular_intensity = 0;
        float fill = 0, occlusion_reach = 0;
    } shading;
};
Stage prepare(const ir::Scene &scene, const ir::View &view, int width, int height, double time,
              Prune prune = Prune::Auto);
// How many operands of unions, blends and other choices, and rows of tables, the whole tape has.
float shapes_of(const ir::Scene &scene);

enum class PictureMode : std::uint8_t { Color, Steps };

// A rectangle of pixels; x and y of its upper left one, from the top left.
struct Tile {
    int x = 0, y = 0, width = 0, height = 0;
    friend bool operator==(const Tile &, const Tile &) = default;
};

// The most samples of a pixel whose sum is exact (summand).
inline constexpr int max_samples = 256;

struct PictureOptions {
    int samples = 1;            // of each pixel: 1 to max_samples; 0: one, and
                                // rough_samples where it is rough (base/picture.h)
    int first_sample = 0;       // of a pixel's sequence of them (ir::sample_offset)
    std::optional<Tile> region; // what is drawn of the picture; none: all of it
    bool sums = false;          // also Picture::sums; not with 0 samples
    bool linear = false;        // also Picture::linear
    bool alpha = false;         // no background: alpha is how much of a pixel something covers
    unsigned jobs = 0;          // threads; 0: as many as the machine has cores
    PictureMode mode = PictureMode::Color;
};

// Of the region, which has its size.
struct Picture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba; // sRGB, from the top left; alpha is not multiplied into it
    std::vector<float> linear; // four a pixel, where they are wanted; alpha is multiplied into it
    std::vector<double> sums;  // three a pixel, where they are wanted (summand); as `linear`
    Work work;
    bool complete = false; // false: cancelled
};

// Called by one thread at a time, with the part that is done, 0 to 1, and the tile just finished, a
// part of `so_far` whose pixels are now drawn; false cancels.
using Progress = std::function<bool(double done, const Tile &tile, const Picture &so_far)>;

Picture render(const Stage &stage, const PictureOptions &options, const Progress &progress = {});

// What a sample of a linear colour adds to its pixel's sum: the colour, rounded to a multiple of
// 2^-32 and limited to 2^12 either way, which no picture shows. So max_samples of them are added
// without rounding, in any order and in any groups: pictures can be divided by their samples.
double summand(float linear);
// Pixels of a row, RGBA, of linear ones as Picture::linear. x and y: the place of the first one in the
// whole picture.
void encode_linear(std::span<const float> linear, int x, int y, std::span<std::uint8_t> rgba);
// The same of sums of so many samples: three numbers a pixel.
void encode_sums(std::span<const double> sums, int samples, int x, int y,
                 std::span<std::uint8_t> rgba);

// How the scene's surface looks at points on it or near it; `normals` of length 1 there. `arm` is a
// length that is small for the surface: where paint reads the normal, it is turned into the paint's
// space by a point that far from the surface. Colours are linear.
struct Look {
    std::int32_t surface = 0; // index into Scene::surfaces
    std::array<float, 3> diffuse{}, specular{}, emission{};
    float exponent = 0;
};
std::vector<Look> looks_at(const Stage &stage, std::span<const std::array<float, 3>> points,
                           std::span<const std::array<float, 3>> normals, float arm);

// How a ray ends (shading.h, MARCH).
enum class RayEnd : std::uint8_t { Miss, Hit, Undecided };

// Rays alone, for tests: where each ends and after how many steps. `brute` marches plainly, at a
// tenth of the proved step, or an eighth of the tolerance where that is more, and a hundred times as
// often, as a check on what the stepping may have jumped over.
struct Ray {
    std::array<float, 3> origin, direction;
};
struct Landing {
    float t = -1; // negative: a miss
    int steps = 0;
    RayEnd end = RayEnd::Miss;
    bool close = false; // shading.h, CLOSE
};
std::vector<Landing> cast(const Stage &stage, std::span<const Ray> rays, bool brute = false);
Ray eye_ray(const Stage &stage, float x,
            float y); // through a place of the picture, in pixels from its top left

} // namespace fathom::cpu
