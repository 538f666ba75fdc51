// What the measures of the noise cache share: scenes, views, and frames of both kinds alternately.
// Needs a current context of GL 4.2.
#pragma once

#include "bench/measure.h"
#include "render-gl/cache_passes.h"

namespace fathom::bench {

driver::Compilation icosahedron(); // six octaves of fBm
driver::Compilation worley_sums();
driver::Compilation spot_noise();

// The middle of a picture of 800x800 pixels by the scene's own camera, so many times as far away
// from what it looks at.
gl::FrameInputs middle_of(const ir::Scene &scene, double times_as_far);

// Milliseconds, the medians of a few frames, alternately, so that what slows the machine slows
// both.
struct FrameTimes {
    double cached = 0, exact = 0;
};
FrameTimes frame_times(gl::CachedView &view, const ir::Scene &scene, const gl::FrameInputs &inputs);

void measure_cache_views(Table &table);

} // namespace fathom::bench
