// The scene into the canvas: measured, coarse to fine, in bands of rows, sample by sample; or
// through the noise cache while it is moved.
#include "viewer/app.h"

#include "ir/shading.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace fathom::viewer {
namespace {

constexpr int coarsest = 16;     // pixels a side for one of a coarse picture
constexpr double quick_ms = 150; // a picture that takes longer is drawn coarsely before
constexpr int moved_budget =
    2048; // steps of a ray while it is moved: what needs more comes at rest

void give_budget(std::vector<gl::TileView> &views, int budget) {
    for (gl::TileView &view : views) view.inputs.budget = budget;
}

// The finest coarseness, up to a limit, at which a picture is quick.
int finest_quick(double frame_ms, int maximum) {
    int coarse = 1;
    while (coarse < maximum && frame_ms / (coarse * coarse) > quick_ms) coarse *= 2;
    return coarse;
}

} // namespace

bool App::pending() const {
    if (!program || controls.cache) return false;
    if (drawn.cached) return true; // the exact picture comes when nothing moves any more
    if (progress.stale || !drawn.shot || progress.drawing || !progress.finished ||
        (progress.resting && progress.coarse > 1))
        return true;
    return controls.accumulate && controls.look == gl::Look::Picture && !animated() &&
           !controls.always && !controls.rotate &&
           progress.samples_drawn < Progress::samples_at_rest;
}

// What a picture takes is known from one of a few pixels: the second, since drivers put work off to
// the first.
void App::measure(int width, int height) {
    constexpr int apart = 32;
    const int few_wide = std::max(1, width / apart), few_high = std::max(1, height / apart);
    std::vector<gl::TileView> tiles = tile_views(few_wide, few_high);
    give_budget(tiles, moved_budget);
    canvas.give_up();
    for (int i = 0; i < 2; ++i) {
        const Clock::time_point start = Clock::now();
        if (!canvas.draw(*program, few_wide, few_high, tiles, sent, 0)) return;
        status.frame_ms = milliseconds_since(start) * (static_cast<double>(width) / few_wide) *
                          (static_cast<double>(height) / few_high);
    }
    progress.measured = true;
    progress.drawing = false;
    picks.values.clear();
}

// At rest a slow picture is drawn coarse to fine, but never more coarsely than it is shown already.
int App::first_coarseness(bool same_view) const {
    if (drawn.cached || controls.always || controls.rotate || recording.sequence > 0) return 1;
    int first = finest_quick(status.frame_ms, coarsest);
    while (same_view && first > 1 && 1.0 / first <= drawn.scale) first /= 2;
    return first;
}

// One sample of the picture, or as many of its rows as fit into an iteration of the loop: a slow
// scene does not keep events waiting, and what was shown stays until the new picture is whole. True
// when it is.
bool App::draw_rows(bool whole) {
    constexpr double turn_ms = 30, band_ms = 10;
    const Clock::time_point start = Clock::now();
    std::vector<gl::TileView> tiles = tile_views(drawn.width, drawn.height);
    if (whole) give_budget(tiles, moved_budget);
    const double expected = std::max(status.frame_ms * drawn.scale * drawn.scale, band_ms);
    const int band =
        whole ? drawn.height
              : std::clamp(static_cast<int>(drawn.height * band_ms / expected), 1, drawn.height);
    const auto patient = [&] { return whole || milliseconds_since(start) <= turn_ms; };
    while (progress.next_row < drawn.height) {
        const bool timed = timer.begin();
        const bool good = canvas.draw(*program, drawn.width, drawn.height, tiles, sent,
                                      progress.next_sample, progress.next_row, band, patient);
        timer.end();
        if (!good) {
            progress.drawing = false;
            note("the graphics card has no memory for this size");
            return false;
        }
        if (canvas.decided()) progress.next_row += band; // else the rest of its rays goes on
        if (timed) progress.bands_requested.push_back(progress.next_row >= drawn.height);
        while (const auto milliseconds = timer.poll()) {
            progress.gpu_ms += *milliseconds;
            const bool last = progress.bands_requested.front();
            progress.bands_requested.erase(progress.bands_requested.begin());
            if (last) gpu_times.add(std::exchange(progress.gpu_ms, 0));
        }
        if (milliseconds_since(start) > turn_ms) break;
    }
    progress.sample_ms += milliseconds_since(start);
    return progress.next_row >= drawn.height;
}

// While it is moved by hand, the picture is drawn as coarsely as it takes to keep up; at rest
// coarse to fine, then smoothed by more samples.
void App::draw_scene(int width, int height, bool moving, bool drew_before) {
    constexpr double wanted_ms = 30, min_scale = 1.0 / 32;
    if (!progress.measured) measure(width, height);
    if (moving && controls.use_cache && !cached.requested() && !worker->lent() &&
        scene->compilation.scene.graph.cache_count() > 0)
        cached.build(scene->compilation.scene, scene->compilation.parts.stride);
    const double expected_ms = drawn.cached && cached.choice.state == gl::CacheChoice::State::Cached
                                   ? cached.choice.cached_ms
                                   : status.frame_ms;
    const Shot shot{views, clock.time, width, height};
    const bool same_view = !progress.stale && drawn.shot == shot;
    double scale = 1;
    if (moving && expected_ms > wanted_ms)
        scale = std::clamp(std::sqrt(wanted_ms / expected_ms), min_scale, 1.0);
    if (!moving) {
        if (!same_view || !progress.resting) progress.coarse = first_coarseness(same_view);
        scale = 1.0 / progress.coarse;
    }
    progress.resting = !moving;
    const bool through_cache = uses_cache(moving);
    const bool anew = !same_view || drawn.scale != scale ||
                      (controls.always && !progress.drawing) || (drawn.cached && !through_cache);
    if (anew) {
        // Until the next picture is whole, what is under the mouse is told by the one that is
        // shown.
        if (same_view && !moving && !progress.drawing && picks.values.empty() &&
            canvas.samples() > 0)
            keep_picks();
        if (moving) picks.values.clear();
        drawn.shot = shot;
        drawn.scale = scale;
        drawn.width = std::max(1, static_cast<int>(width * scale));
        drawn.height = std::max(1, static_cast<int>(height * scale));
        progress.stale = progress.probed = false;
        const bool before = std::exchange(drawn.cached, false);
        if (through_cache && gl::uses_cache_next(cached.choice) && draw_cached_frame(scale)) {
            drawn.cached = true;
            ++moving_cached.frames;
            progress.drawing = false;
            moving_cached.fade_begin = {};
            if (drew_before) frame_times.add(milliseconds_since(clock.last_draw));
            clock.last_draw = Clock::now();
            progress.drew_now = true;
            return;
        }
        if (moving_cached.frames > 0 && !through_cache && settings.tell)
            settings.tell(
                fmt::format("moved: {} frames through the noise cache, the last {:.1f} ms, "
                            "exact {:.1f} ms",
                            moving_cached.frames, cached.choice.cached_ms, cached.choice.exact_ms));
        if (!through_cache) moving_cached.frames = 0;
        if (before && !through_cache) {
            canvas.keep_before();
            moving_cached.fade_begin =
                Clock::time_point::max(); // begins when the exact picture is there
        }
    }
    const bool more = !anew && !progress.drawing && progress.finished && pending() && !moving;
    if (anew || more) {
        progress.drawing = true;
        progress.next_sample = anew ? 0 : progress.samples_drawn;
        progress.next_row = 0;
        progress.sample_ms = 0;
        canvas.give_up();
    }
    if (!progress.drawing && progress.finished) return;
    const bool drew = progress.drawing;
    if (progress.drawing) {
        progress.drew_now = true;
        if (!draw_rows(moving)) return;
    }
    if (drew) picture_is_whole(scale, moving, drew_before);
    draw_probe();
    finish_picture(scale);
    if (moving_cached.fade_begin == Clock::time_point::max())
        moving_cached.fade_begin = Clock::now();
    if (drew && !moving && progress.coarse > 1)
        progress.coarse = finest_quick(status.frame_ms, progress.coarse / 2);
}

// A sample of it is: what it took decides how coarse the next one may be.
void App::picture_is_whole(double scale, bool moving, bool drew_before) {
    const bool first = progress.next_sample == 0;
    progress.drawing = false;
    progress.samples_drawn = progress.next_sample + 1;
    status.frame_ms = progress.sample_ms / (scale * scale); // in full
    if (moving || progress.coarse == 1) {
        if (first) gl::took(cached.choice, false, status.frame_ms);
        // Frames that follow one another; what came after a rest says nothing of speed.
        if (drew_before) frame_times.add(milliseconds_since(clock.last_draw));
    }
    clock.last_draw = Clock::now();
    if (!first || (moving && progress.frames_drawn++ % 32 != 0)) return;
    keep_picks();
    double sum = 0;
    for (std::size_t i = 2; i < picks.values.size(); i += 4) sum += picks.values[i];
    status.mean_steps =
        picks.values.empty() ? 0 : sum / (static_cast<double>(picks.values.size()) / 4);
    if (moving) picks.values.clear();
}

void App::keep_picks() {
    picks.values = canvas.read_picks();
    picks.width = canvas.width();
    picks.height = canvas.height();
}

void App::finish_picture(double scale) {
    gl::PostSettings post;
    post.look = controls.look;
    post.fxaa = controls.fxaa;
    post.max_steps = ir::shading::many_steps;
    post.outlined = selected.number;
    post.hovered = hovered.number;
    post.thickness = std::max(1, static_cast<int>(std::lround(2 * font_scale * scale)));
    post.isolines = isoline_step(views.cameras[0]);
    canvas.finish(post);
    progress.finished = progress.on_screen = true;
}

// A picture that is recorded, looked at in other colours or drawn for its time is exact; so are
// several views.
bool App::uses_cache(bool moving) const {
    return (moving || controls.rotate) && controls.use_cache && cached.ready() &&
           views.count == 1 && controls.look == gl::Look::Picture && !controls.always &&
           recording.sequence == 0;
}

bool App::draw_cached_frame(double scale) {
    gl::FrameInputs inputs = tile_views(drawn.width, drawn.height)[0].inputs;
    inputs.width = drawn.width;
    inputs.height = drawn.height;
    inputs.mode = gl::Mode::Linear;
    gl::finish();
    const Clock::time_point start = Clock::now();
    if (!cached.draw(inputs, sent, false)) return false;
    gl::finish();
    gl::took(cached.choice, cached.looked_up(), milliseconds_since(start) / (scale * scale));
    if (controls.analysis) cached.count();
    if (!canvas.take(cached.framebuffer(), drawn.width, drawn.height)) return false;
    progress.samples_drawn = 1;
    finish_picture(scale);
    return true;
}

} // namespace fathom::viewer
