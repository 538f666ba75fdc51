// What a ray meets, judged by no march: the field is evaluated all along each ray of random scenes,
// closely, and more closely where it is least; where it changes its sign there is a surface. A ray
// has to end in a hit at the first such place, and in a miss where there is none.
#include "backend-cpu/trace/march.h"
#include "driver/compile.h"
#include "random_scenes.h"
#include "tests/support/effort.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <numeric>

using namespace fathom;

namespace {

const int scenes = test::effort(40);
constexpr int width = 16, height = 12;
constexpr std::size_t samples = 1000, closer = 1000, least = 4; // along a ray; between two; places

struct Field {
    cpu::Program program;
    cpu::Scratch scratch;
    explicit Field(const ir::Scene &scene)
        : program(cpu::compile(scene, scene.distance)),
          scratch(cpu::make_scratch(program, cpu::inputs_of(scene, 0))) {}
    // At n places between a and b along the ray, both included.
    std::vector<float> along(const cpu::Ray &ray, float a, float b, std::size_t n) {
        std::array<std::vector<float>, 3> points;
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t c = 0; c < 3; ++c)
                points[c].push_back(ray.origin[c] +
                                    (a + (b - a) * float(i) / float(n - 1)) * ray.direction[c]);
        std::vector<float> values(n);
        const float *in[] = {points[0].data(), points[1].data(), points[2].data()};
        float *out[] = {values.data()};
        cpu::evaluate(program, scratch, in, out, n);
        return values;
    }
};

// Where along the ray the field is first below -slack(t), as far as can be seen; negative: nowhere.
template <class Slack>
float first_inside(Field &field, const cpu::Ray &ray, float end, Slack slack) {
    const std::vector<float> f = field.along(ray, 0, end, samples);
    const float spacing = end / float(samples - 1);
    std::vector<std::size_t> places(samples - 1);
    std::iota(places.begin(), places.end(), 0);
    std::size_t inside = samples;
    for (std::size_t i = 0; i < samples && inside == samples; ++i)
        if (f[i] < -slack(float(i) * spacing)) inside = i;
    // Between samples before that: where the field comes nearest to 0.
    std::erase_if(places, [&](std::size_t i) { return i >= inside; });
    std::ranges::sort(places, {}, [&](std::size_t i) { return std::min(f[i], f[i + 1]); });
    places.resize(std::min(places.size(), least));
    std::ranges::sort(places);
    for (std::size_t i : places) {
        const float a = float(i) * spacing;
        const std::vector<float> close = field.along(ray, a, a + spacing, closer);
        for (std::size_t k = 0; k < closer; ++k)
            if (const float t = a + spacing * float(k) / float(closer - 1); close[k] < -slack(t))
                return t;
    }
    return inside < samples ? float(inside) * spacing : -1;
}

struct Verdict {
    int rays = 0, holes = 0, shallow = 0, phantoms = 0, undecided = 0;
};

Verdict judge(const ir::Scene &scene) {
    Verdict verdict;
    const ir::View view = ir::view_of(scene, 0, double(width) / height);
    const cpu::Stage stage = cpu::prepare(scene, view, width, height, 0);
    Field field(scene);
    const auto slack = float(stage.frame.slack);
    const float far = stage.frame.boxed
                          ? float(glm::length(view.origin - stage.frame.center) +
                                  glm::length(stage.frame.hi - stage.frame.lo))
                          : std::min(float(stage.frame.far), 10 * float(stage.frame.radius));
    std::vector<cpu::Ray> rays;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            rays.push_back(cpu::eye_ray(stage, float(x) + 0.5f, float(y) + 0.5f));
    const std::vector<cpu::Landing> landings = cpu::cast(stage, rays);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const cpu::Landing &landing = landings[i];
        ++verdict.rays;
        if (landing.end == cpu::RayEnd::Undecided) {
            ++verdict.undecided;
            continue;
        }
        const auto tolerance_at = [&](float t) {
            return float(stage.frame.tolerance_base + stage.frame.tolerance_slope * t);
        };
        const float tolerance = tolerance_at(std::max(landing.t, 0.f));
        const float until = landing.end == cpu::RayEnd::Hit ? landing.t - 2 * tolerance : far;
        // What a ray may graze is half a pixel high (shading.h, MARCH): those are counted apart.
        const auto passes = [&](auto depth) {
            const float inside = first_inside(field, rays[i], far, depth);
            return inside >= 0 && inside < until;
        };
        verdict.shallow += passes([&](float) { return 4 * slack; });
        verdict.holes += passes(tolerance_at);
        if (landing.end != cpu::RayEnd::Hit || landing.t > far) continue;
        // Near the hit the field is not above 0 somewhere (shading.h, REFINED), rounding apart.
        const std::vector<float> near = field.along(rays[i], std::max(landing.t - tolerance, 0.f),
                                                    landing.t + tolerance, closer);
        verdict.phantoms += std::ranges::min(near) > slack;
    }
    return verdict;
}

} // namespace

TEST_CASE("rays through random scenes end where the field changes its sign") {
    Verdict all;
    int judged = 0;
    for (std::uint64_t seed = 1; judged < scenes; ++seed) {
        test::RandomScene random(seed);
        const test::TermPtr solid = random.solid(3);
        std::string text;
        for (const std::string &param : random.params()) text += param;
        text += text_of(*solid) + "\n";
        driver::CompileOptions options;
        options.cells = seed % 2 == 0 ? 8 : 0; // as pictures are made, and as all else
        const driver::Compilation c = driver::compile_text("scene.sdf", text, {}, options);
        if (!c.good()) continue;
        ++judged;
        const Verdict verdict = judge(c.scene);
        INFO(seed << "\n" << text);
        CHECK(verdict.holes == 0);
        CHECK(verdict.phantoms == 0);
        all.rays += verdict.rays;
        all.undecided += verdict.undecided;
        all.shallow += verdict.shallow;
    }
    INFO(all.rays << " rays, " << all.undecided << " undecided");
    CHECK(all.undecided <= all.rays / 1000);
    CHECK(all.shallow <= all.rays / 1000);
}
