// The noise cache against exact frames from three distances: near, as the scene's own camera has
// it, and so far away that cells are about as wide as pixels. However little look-ups gain, a warm
// view must not be slower than 0.95 of the exact one. Both kinds of frames alternately in one run;
// where the CPU draws, its own time counts.
#include "bench/measure.h"

#include "bench/noise_cache.h"
#include "render-gl/cache_passes.h"
#include "render-gl/context.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fathom::bench {
namespace {

struct Distance {
    const char *name;
    double times;
};
constexpr std::array<Distance, 3> distances{{{"near", 0.55}, {"whole", 1}, {"far", 3}}};

// A view is warm when it misses next to nothing, or is drawn exactly, or has had its chance.
constexpr int warm_frames = 24;
void warm(gl::CachedView &view, const ir::Scene &scene, const gl::FrameInputs &inputs) {
    const auto pixels =
        static_cast<std::uint64_t>(inputs.width) * static_cast<std::uint64_t>(inputs.height);
    for (int frame = 0; frame < warm_frames; ++frame) {
        view.draw(inputs, scene.params, {});
        if (!view.looked_up()) return;
        if (frame > 3 && 200 * view.read_tally().misses <= pixels) return;
    }
}

void measure_views(Table &table, double &worst, const std::string &what,
                   const driver::Compilation &c) {
    if (!c.good()) return table.push_back({.what = what, .missing = complaint(c)});
    gl::CachedView view;
    Diagnostics diagnostics;
    if (const std::string why = view.use(c.scene, gl::usual_cache_size, diagnostics); !why.empty())
        return table.push_back({.what = what, .missing = why});
    for (const Distance &distance : distances) {
        view.weigh_anew();
        const gl::FrameInputs inputs = middle_of(c.scene, distance.times);
        warm(view, c.scene, inputs);
        const FrameTimes times = frame_times(view, c.scene, inputs);
        worst = std::min(worst, times.exact / times.cached);
        table.push_back(
            {.what = what + ", " + distance.name + (view.looked_up() ? "" : " (drawn exactly)"),
             .value = 1e3 / times.cached,
             .unit = "frames/s",
             .baseline = "exact",
             .baseline_value = 1e3 / times.exact,
             .minimum = 0.95});
    }
}

} // namespace

void measure_cache_views(Table &table) {
    double worst = 1e30;
    measure_views(table, worst, "noise cache, warm: icosahedron", icosahedron());
    measure_views(table, worst, "  Worley sums", worley_sums());
    measure_views(table, worst, "  spot noise", spot_noise());
    for (const char *name : {"08_rocky_icosahedron", "11_well", "rough_icosahedron", "well"})
        measure_views(
            table, worst, std::string("  ") + name,
            driver::compile_file(std::string(FATHOM_SOURCE_DIR "/examples/") + name + ".sdf", {}));
    table.push_back(
        {.what = "  the worst of these", .value = worst, .unit = "of exact", .minimum = 0.95});
}

} // namespace fathom::bench
