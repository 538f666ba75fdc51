// The scene into the canvas: measured, coarse to fine, in bands of rows, sample by sample; or
// through the noise cache while it is moved.
#include "viewer/app.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace fathom::viewer {
namespace {

constexpr int coarsest = 16;     // pixels a side for one of a coarse picture
constexpr double quick_ms = 150; // a picture that takes longer is drawn coarsely before

// The finest coarseness, up to a limit, at which a picture is quick.
int finest_quick(double frame_ms, int maximum) {
    int coarse = 1;
    while (coarse < maximum && frame_ms / (coarse * coarse) > quick_ms) coarse *= 2;
    return coarse;
}

} // namespace

bool App::pending() const {
    if (!program || controls.cache) return false;
    if (drawn_cached) return true; // the exact picture comes when nothing moves any more
    if (stale || !drawn || drawing || !finished || (resting && coarse > 1)) return true;
    return controls.accumulate && controls.look == gl::Look::Picture && !animated() &&
           !controls.always && !controls.rotate && samples_drawn < samples_at_rest;
}

// What a picture takes is known from one of a few pixels: the second, since drivers put work off to
// the first.
void App::measure(int width, int height) {
    constexpr int apart = 32;
    const int few_wide = std::max(1, width / apart), few_high = std::max(1, height / apart);
    const std::vector<gl::TileView> tiles = tile_views(few_wide, few_high);
    for (int i = 0; i < 2; ++i) {
        const Clock::time_point start = Clock::now();
        if (!canvas.draw(*program, few_wide, few_high, tiles, params, 0)) return;
        status.frame_ms = milliseconds_since(start) * (static_cast<double>(width) / few_wide) *
                          (static_cast<double>(height) / few_high);
    }
    measured = true;
    drawing = false;
    picks.clear();
}

// At rest a slow picture is drawn coarse to fine, but never more coarsely than it is shown already.
int App::first_coarseness(bool same_view) const {
    if (drawn_cached || controls.always || controls.rotate || sequence > 0) return 1;
    int first = finest_quick(status.frame_ms, coarsest);
    while (same_view && first > 1 && 1.0 / first <= drawn_scale) first /= 2;
    return first;
}

// One sample of the picture, or as many of its rows as fit into an iteration of the loop: a slow
// scene does not keep events waiting, and what was shown stays until the new picture is whole. True
// when it is.
bool App::draw_rows(bool whole) {
    constexpr double turn_ms = 30, band_ms = 10;
    const Clock::time_point start = Clock::now();
    const std::vector<gl::TileView> tiles = tile_views(drawn_width, drawn_height);
    const double expected = std::max(status.frame_ms * drawn_scale * drawn_scale, band_ms);
    const int band =
        whole ? drawn_height
              : std::clamp(static_cast<int>(drawn_height * band_ms / expected), 1, drawn_height);
    while (next_row < drawn_height) {
        const bool timed = timer.begin();
        const bool good = canvas.draw(*program, drawn_width, drawn_height, tiles, params,
                                      next_sample, next_row, band);
        timer.end();
        if (!good) {
            drawing = false;
            note("the graphics card has no memory for this size");
            return false;
        }
        next_row += band;
        if (timed) bands_requested.push_back(next_row >= drawn_height);
        while (const auto milliseconds = timer.poll()) {
            gpu_ms += *milliseconds;
            const bool last = bands_requested.front();
            bands_requested.erase(bands_requested.begin());
            if (last) gpu_times.add(std::exchange(gpu_ms, 0));
        }
        if (milliseconds_since(start) > turn_ms) break;
    }
    sample_ms += milliseconds_since(start);
    return next_row >= drawn_height;
}

// While it is moved by hand, the picture is drawn as coarsely as it takes to keep up; at rest
// coarse to fine, then smoothed by more samples.
void App::draw_scene(int width, int height, bool moving, bool drew_before) {
    constexpr double wanted_ms = 30, min_scale = 1.0 / 32;
    if (!measured) measure(width, height);
    if (moving && controls.use_cache && !cached.requested() && !worker->lent() &&
        scene->compilation.scene.graph.cache_count() > 0)
        cached.build(scene->compilation.scene, scene->compilation.parts.stride);
    const double expected_ms = drawn_cached && cached.choice.state == gl::CacheChoice::State::Cached
                                   ? cached.choice.cached_ms
                                   : status.frame_ms;
    const Shot shot{views, time, width, height};
    const bool same_view = !stale && drawn == shot;
    double scale = 1;
    if (moving && expected_ms > wanted_ms)
        scale = std::clamp(std::sqrt(wanted_ms / expected_ms), min_scale, 1.0);
    if (!moving) {
        if (!same_view || !resting) coarse = first_coarseness(same_view);
        scale = 1.0 / coarse;
    }
    resting = !moving;
    const bool through_cache = uses_cache(moving);
    const bool anew = !same_view || drawn_scale != scale || (controls.always && !drawing) ||
                      (drawn_cached && !through_cache);
    if (anew) {
        // Until the next picture is whole, what is under the mouse is told by the one that is
        // shown.
        if (same_view && !moving && !drawing && picks.empty() && canvas.samples() > 0) keep_picks();
        if (moving) picks.clear();
        drawn = shot;
        drawn_scale = scale;
        drawn_width = std::max(1, static_cast<int>(width * scale));
        drawn_height = std::max(1, static_cast<int>(height * scale));
        stale = probed = false;
        const bool before = std::exchange(drawn_cached, false);
        if (through_cache && gl::uses_cache_next(cached.choice) && draw_cached_frame(scale)) {
            drawn_cached = true;
            ++cached_frames;
            drawing = false;
            fade_begin = {};
            if (drew_before) frame_times.add(milliseconds_since(last_draw));
            last_draw = Clock::now();
            drew_now = true;
            return;
        }
        if (cached_frames > 0 && !through_cache && settings.tell)
            settings.tell(
                fmt::format("moved: {} frames through the noise cache, the last {:.1f} ms, "
                            "exact {:.1f} ms",
                            cached_frames, cached.choice.cached_ms, cached.choice.exact_ms));
        if (!through_cache) cached_frames = 0;
        if (before && !through_cache) {
            canvas.keep_before();
            fade_begin = Clock::time_point::max(); // begins when the exact picture is there
        }
    }
    const bool more = !anew && !drawing && finished && pending() && !moving;
    if (anew || more) {
        drawing = true;
        next_sample = anew ? 0 : samples_drawn;
        next_row = 0;
        sample_ms = 0;
    }
    if (!drawing && finished) return;
    const bool drew = drawing;
    if (drawing) {
        drew_now = true;
        if (!draw_rows(moving)) return;
    }
    if (drew) picture_is_whole(scale, moving, drew_before);
    draw_probe();
    finish_picture(scale);
    if (fade_begin == Clock::time_point::max()) fade_begin = Clock::now();
    if (drew && !moving && coarse > 1) coarse = finest_quick(status.frame_ms, coarse / 2);
}

// A sample of it is: what it took decides how coarse the next one may be.
void App::picture_is_whole(double scale, bool moving, bool drew_before) {
    const bool first = next_sample == 0;
    drawing = false;
    samples_drawn = next_sample + 1;
    status.frame_ms = sample_ms / (scale * scale); // in full
    if (moving || coarse == 1) {
        if (first) gl::took(cached.choice, false, status.frame_ms);
        // Frames that follow one another; what came after a rest says nothing of speed.
        if (drew_before) frame_times.add(milliseconds_since(last_draw));
    }
    last_draw = Clock::now();
    if (!first || (moving && frames_drawn++ % 32 != 0)) return;
    keep_picks();
    double sum = 0;
    for (std::size_t i = 2; i < picks.size(); i += 4) sum += picks[i];
    status.mean_steps = picks.empty() ? 0 : sum / (static_cast<double>(picks.size()) / 4);
    if (moving) picks.clear();
}

void App::keep_picks() {
    picks = canvas.read_picks();
    picks_width = canvas.width();
    picks_height = canvas.height();
}

void App::finish_picture(double scale) {
    gl::PostSettings post;
    post.look = controls.look;
    post.fxaa = controls.fxaa;
    post.max_steps = scene->compilation.scene.render.max_steps;
    post.outlined = selected.number;
    post.hovered = hovered.number;
    post.thickness = std::max(1, static_cast<int>(std::lround(2 * font_scale * scale)));
    post.isolines = isoline_step(views.cameras[0]);
    canvas.finish(post);
    finished = on_screen = true;
}

// A picture that is recorded, looked at in other colours or drawn for its time is exact; so are
// several views.
bool App::uses_cache(bool moving) const {
    return (moving || controls.rotate) && controls.use_cache && cached.ready() &&
           views.count == 1 && controls.look == gl::Look::Picture && !controls.always &&
           sequence == 0;
}

bool App::draw_cached_frame(double scale) {
    gl::FrameInputs inputs = tile_views(drawn_width, drawn_height)[0].inputs;
    inputs.width = drawn_width;
    inputs.height = drawn_height;
    inputs.mode = gl::Mode::Linear;
    gl::finish();
    const Clock::time_point start = Clock::now();
    if (!cached.draw(inputs, params, false)) return false;
    gl::finish();
    gl::took(cached.choice, cached.looked_up(), milliseconds_since(start) / (scale * scale));
    if (controls.analysis) cached.count();
    if (!canvas.take(cached.framebuffer(), drawn_width, drawn_height)) return false;
    samples_drawn = 1;
    finish_picture(scale);
    return true;
}

} // namespace fathom::viewer
