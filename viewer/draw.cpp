// Draws what changed and nothing else: samples of the scene, the probe, the panels; and writes
// pictures of the window.
#include "viewer/app.h"

#include "base/picture.h"
#include "driver/files.h"

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace fathom::viewer {
namespace {

constexpr int samples_at_rest = 4;
constexpr double turns_a_second = 0.1; // auto-rotate
constexpr double fade_ms = 250;        // from kept values to exact ones, when it comes to rest

std::filesystem::path free_name(const std::filesystem::path &scene, const char *form) {
    for (int i = 1;; ++i) {
        const std::filesystem::path name =
            fmt::format(fmt::runtime(form), scene.stem().string(), i);
        std::error_code error;
        if (!std::filesystem::exists(name, error)) return name;
    }
}

// Isolines 1, 2 or 5 times a power of ten apart, about twelve from the middle of the window to its
// edge.
double isoline_step(const Camera &camera) {
    const double wanted = camera.slope * camera.distance / 12;
    const double power = std::pow(10, std::floor(std::log10(wanted)));
    for (double step : {2.0, 5.0})
        if (wanted <= step * power) return step * power;
    return 10 * power;
}

// Along a few rows and columns of the probe, where the distance passes a multiple of the step: not
// more labels than are well read.
std::vector<IsolineLabel> isoline_labels(const std::vector<float> &probe,
                                         const std::vector<float> &picks, int width, int height,
                                         double step, double to_window) {
    std::vector<IsolineLabel> labels;
    const auto seen = [&](int x, int y) {
        const std::size_t at = 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                    static_cast<std::size_t>(x));
        return probe[at + 3] > 0 && (picks[at + 1] < 0 || probe[at + 1] <= picks[at + 1]);
    };
    const auto distance = [&](int x, int y) {
        return static_cast<double>(
            probe[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                       static_cast<std::size_t>(x))]);
    };
    const double least_apart = 60 / to_window;
    const auto along = [&](int x, int y, int dx, int dy) {
        for (; x + dx < width && y + dy < height; x += dx, y += dy) {
            if (!seen(x, y) || !seen(x + dx, y + dy)) continue;
            const double a = std::floor(distance(x, y) / step),
                         b = std::floor(distance(x + dx, y + dy) / step);
            if (std::abs(a - b) != 1) continue;
            const IsolineLabel label{static_cast<float>(x * to_window),
                                     static_cast<float>(y * to_window), std::max(a, b) * step};
            const bool crowded =
                std::any_of(labels.begin(), labels.end(), [&](const IsolineLabel &other) {
                    return std::hypot(other.x - label.x, other.y - label.y) <
                           least_apart * to_window;
                });
            if (!crowded) labels.push_back(label);
        }
    };
    for (int y : {height / 2, height / 4, 3 * height / 4}) along(0, y, 1, 0);
    for (int x : {width / 2, width / 5, 4 * width / 5}) along(x, 0, 0, 1);
    return labels;
}

} // namespace

double App::aspect() const {
    int width = 0, height = 0;
    glfwGetFramebufferSize(window, &width, &height);
    const gl::Tile first = tiles_of(views, width, height)[0];
    return first.height > 0 ? static_cast<double>(first.width) / first.height : 1;
}

std::vector<gl::TileView> App::tile_views(int width, int height) const {
    const ir::Scene &s = scene->compilation.scene;
    const std::vector<gl::Tile> tiles = tiles_of(views, width, height);
    std::vector<gl::TileView> result;
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        gl::TileView view{tiles[i], {}};
        const double shape = static_cast<double>(tiles[0].width) / std::max(tiles[0].height, 1);
        view.inputs.view = view_of(views.cameras[i]);
        view.inputs.sun = ir::lights_of(s, time, ir::view_of(s, time, shape))[0].position;
        view.inputs.time = time;
        view.inputs.mode = controls.look == gl::Look::Check ? gl::Mode::Check : gl::Mode::Slice;
        view.inputs.plane = {0, 0, 0, controls.slice_offset};
        view.inputs.plane[static_cast<std::size_t>(controls.slice_axis)] = 1;
        if (tiles[i].width > 0 && tiles[i].height > 0) result.push_back(view);
    }
    return result;
}

bool App::pending() const {
    if (!program || controls.cache) return false;
    if (drawn_kept) return true; // the exact picture comes when nothing moves any more
    if (stale || !drawn || drawing || !finished) return true;
    return controls.accumulate && controls.look == gl::Look::Picture && !animated() &&
           !controls.always && !controls.rotate && samples_drawn < samples_at_rest;
}

// One sample of the picture, or as many of its rows as fit into a turn of the loop: a slow scene
// does not keep events waiting, and what was shown stays until the new picture is whole. True when
// it is.
bool App::draw_rows(bool whole) {
    constexpr double turn_ms = 30, band_ms = 10;
    const Clock::time_point start = Clock::now();
    const std::vector<gl::TileView> tiles = tile_views(drawn->width, drawn->height);
    const double expected = status.frame_ms > 0 ? status.frame_ms : 16 * band_ms;
    const int band =
        whole ? drawn->height
              : std::clamp(static_cast<int>(drawn->height * band_ms / expected), 8, drawn->height);
    while (next_row < drawn->height) {
        const bool measured = timer.begin();
        const bool good = canvas.draw(*program, drawn->width, drawn->height, tiles, params,
                                      next_sample, next_row, band);
        timer.end();
        if (!good) {
            drawing = false;
            note("the graphics card has no memory for this size");
            return false;
        }
        next_row += band;
        if (measured) bands_asked.push_back(next_row >= drawn->height);
        while (const auto milliseconds = timer.poll()) {
            gpu_ms += *milliseconds;
            const bool last = bands_asked.front();
            bands_asked.erase(bands_asked.begin());
            if (last) gpu_times.add(std::exchange(gpu_ms, 0));
        }
        if (milliseconds_since(start) > turn_ms) break;
    }
    sample_ms += milliseconds_since(start);
    return next_row >= drawn->height;
}

// While it is moved by hand, the picture is drawn as coarsely as it takes to keep up; at rest in
// full, then smoothed by more samples.
void App::draw_scene(int width, int height, bool moving, bool drew_before) {
    constexpr double wanted_ms = 30;
    double scale = 1;
    if (moving && controls.keep && !cached.asked() && !worker->lent() &&
        scene->compilation.scene.graph.cache_count() > 0)
        cached.build(scene->compilation.scene, scene->compilation.parts.stride);
    const double expected_ms = drawn_kept && cached.choice.state == gl::CacheChoice::State::Kept
                                   ? cached.choice.kept_ms
                                   : status.frame_ms;
    if (moving && expected_ms > wanted_ms)
        scale = std::clamp(std::sqrt(wanted_ms / expected_ms), 0.125, 1.0);
    const Shot shot{views, time, std::max(1, static_cast<int>(width * scale)),
                    std::max(1, static_cast<int>(height * scale))};
    const bool kept = keeps(moving);
    const bool anew =
        stale || drawn != shot || (controls.always && !drawing) || (drawn_kept && !kept);
    if (anew) {
        drawn = shot;
        stale = probed = false;
        const bool before = std::exchange(drawn_kept, false);
        if (kept && gl::keeps_next(cached.choice) && draw_kept(shot, scale)) {
            drawn_kept = true;
            ++kept_frames;
            drawing = false;
            fade_begin = {};
            if (drew_before) frame_times.add(milliseconds_since(last_draw));
            last_draw = Clock::now();
            drew_now = true;
            return;
        }
        if (kept_frames > 0 && !kept && settings.tell)
            settings.tell(
                fmt::format("moved: {} frames through the noise cache, the last {:.1f} ms, "
                            "exact {:.1f} ms",
                            kept_frames, cached.choice.kept_ms, cached.choice.exact_ms));
        if (!kept) kept_frames = 0;
        if (before && !kept) {
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
    const bool first = drawing && next_sample == 0;
    if (drawing) {
        drew_now = true;
        if (!draw_rows(moving || controls.always || controls.rotate || sequence > 0)) return;
        drawing = false;
        samples_drawn = next_sample + 1;
        // What a full frame would take: the measure that decides how coarse the next may be.
        status.frame_ms = sample_ms / (scale * scale);
        if (first) gl::took(cached.choice, false, status.frame_ms);
        // Frames that follow one another; what came after a rest says nothing of speed.
        if (drew_before) frame_times.add(milliseconds_since(last_draw));
        last_draw = Clock::now();
    }
    draw_probe();
    finish_picture(scale);
    if (fade_begin == Clock::time_point::max()) fade_begin = Clock::now();
    if (first && (!moving || frames_drawn++ % 32 == 0)) {
        double sum = 0;
        const std::vector<float> picks = canvas.read_picks();
        for (std::size_t i = 2; i < picks.size(); i += 4) sum += picks[i];
        status.mean_steps = picks.empty() ? 0 : sum / (static_cast<double>(picks.size()) / 4);
    }
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
    finished = true;
}

// A picture that is recorded, looked at in other colours or drawn for its time is exact; so are
// several views.
bool App::keeps(bool moving) const {
    return (moving || controls.rotate) && controls.keep && cached.ready() && views.count == 1 &&
           controls.look == gl::Look::Picture && !controls.always && sequence == 0;
}

bool App::draw_kept(const Shot &shot, double scale) {
    gl::FrameInputs inputs = tile_views(shot.width, shot.height)[0].inputs;
    inputs.width = shot.width;
    inputs.height = shot.height;
    inputs.mode = gl::Mode::Linear;
    gl::finish();
    const Clock::time_point start = Clock::now();
    if (!cached.draw(inputs, params, false)) return false;
    gl::finish();
    gl::took(cached.choice, cached.looked_up(), milliseconds_since(start) / (scale * scale));
    if (controls.analysis) cached.count();
    if (!canvas.take(cached.framebuffer(), shot.width, shot.height)) return false;
    samples_drawn = 1;
    finish_picture(scale);
    return true;
}

double App::fading() const {
    if (fade_begin == Clock::time_point{} || fade_begin == Clock::time_point::max()) return 0;
    return std::max(0.0, 1 - milliseconds_since(fade_begin) / fade_ms);
}

bool App::draw_cached(int width, int height) {
    if (!scene) return false;
    const Shot shot{views, time, width, height};
    if (cached_shot != shot) cached.view_changed();
    cached_shot = shot;
    if (!cached.asked() && !worker->lent())
        cached.build(scene->compilation.scene, scene->compilation.parts.stride);
    if (!cached.asked()) return false; // the worker is at it
    if (!cached.ready()) {
        controls.cache = false;
        note("no noise cache: " + cached.why_not());
        return false;
    }
    if (!cached.settled()) {
        gl::FrameInputs inputs = tile_views(width, height)[0].inputs;
        inputs.width = width;
        inputs.height = height;
        inputs.mode = gl::Mode::Picture;
        if (!cached.draw(inputs, params, true)) {
            controls.cache = false;
            note("no noise cache: the graphics card has no memory for it");
            return false;
        }
        cached.count();
        note(cached.words());
    }
    gl::show_in_window(cached.framebuffer(), width, height);
    return true;
}

void App::draw_probe() {
    const bool slice = controls.look == gl::Look::Slice, check = controls.look == gl::Look::Check;
    if (probed || !(slice || check)) return;
    labels.clear();
    if (!probe) return worker->want_probe();
    if (!canvas.probe(*probe, tile_views(canvas.width(), canvas.height()), params)) return;
    probed = true;
    const std::vector<float> values = canvas.read_probe();
    if (check) {
        verdicts = {};
        for (std::size_t i = 0; i < values.size(); i += 4)
            ++verdicts[static_cast<std::size_t>(std::clamp(values[i], 0.0f, 3.0f))];
        return;
    }
    int width = 0, height = 0;
    glfwGetWindowSize(window, &width, &height);
    labels =
        isoline_labels(values, canvas.read_picks(), canvas.width(), canvas.height(),
                       isoline_step(views.cameras[0]), static_cast<double>(width) / canvas.width());
}

bool App::save_window(const std::filesystem::path &file, int width, int height) {
    const std::string error = driver::write_file(file, encode_png(gl::read_window(width, height)));
    if (!error.empty()) note(fmt::format("cannot write {}: {}", file.string(), error));
    return error.empty();
}

// The panels have settled and the picture is the full one: that is what a record shows.
void App::save_pictures(int width, int height, bool moving) {
    if (picture_asked &&
        (animated() || (!moving && !pending() && fading() == 0))) { // the full picture
        picture_asked = false;
        const std::filesystem::path name = free_name(settings.file, "{}-{}.png");
        if (save_window(name, width, height)) note("saved " + name.string());
    }
    if (sequence > 0 && finished) {
        const std::string name = fmt::format("{:05}.png", sequence++);
        const std::string error =
            driver::write_file(sequence_folder / name, encode_png(canvas.read_picture()));
        if (!error.empty()) {
            sequence = 0;
            note(fmt::format("cannot write {}: {}", (sequence_folder / name).string(), error));
        }
    }
    if (fading() > 0) return;
    if (record_next && frames_due <= 1 && (!moving || animated()) && !pending() &&
        !settings.record.empty()) {
        save_window(settings.record / fmt::format("{:04}.png", ++recorded), width, height);
        record_next = false;
    }
}

void App::draw_panels(int width, int height) {
    int window_width = 0, window_height = 0;
    glfwGetWindowSize(window, &window_width, &window_height);
    const float to_window =
        width > 0 ? static_cast<float>(window_width) / static_cast<float>(width) : 1;
    status.width = width;
    status.height = height;
    Shown shown{status,      settings.file.string(),
                errors,      remarks,
                {},          {},
                {},          labels,
                frame_times, gpu_times,
                verdicts,    cached.ready() ? &cached.figures() : nullptr,
                256,         1};
    if (selected.number) shown.selected = part_line(selected);
    if (hovered.number) {
        const gl::Pick pick = pick_at_cursor();
        shown.hovered = fmt::format("{}\n{:.0f} steps, field rises by {:.3g} a unit here",
                                    part_line(hovered), pick.steps, pick.slope);
    }
    if (views.count > 1)
        for (const gl::Tile &tile : tiles_of(views, width, height)) {
            const std::size_t i = shown.view_names.size();
            const Camera &camera = views.cameras[i];
            std::string name = view_name(camera);
            name += std::string(name.empty() ? "" : ", ") +
                    (camera.orthographic ? "orthographic" : "perspective");
            if (static_cast<int>(i) == views.active) name += " *";
            shown.view_names.push_back(
                {name,
                 {static_cast<float>(tile.x) * to_window, static_cast<float>(tile.y) * to_window}});
        }
    if (scene) {
        shown.max_steps = scene->compilation.scene.render.max_steps;
        shown.reach =
            ir::frame_of(scene->compilation.scene, view_of(views.cameras[0]), 100).radius * 1.5;
    }
    const Asked asked = show_panels(controls, shown, params);
    for (std::size_t i : asked.changed) param_changed(params[i]);
    for (std::size_t i : asked.write) write_param(params[i]);
    if (!asked.copy.empty()) {
        glfwSetClipboardString(window, asked.copy.c_str());
        note("copied " + asked.copy);
    }
    if (asked.look) {
        finished = probed = false;
        frames_due = 3;
        glfwSwapInterval(controls.always ? 0 : 1);
    }
    if (asked.size[0] > 0) glfwSetWindowSize(window, asked.size[0], asked.size[1]);
}

void App::draw(double seconds) {
    int width = 0, height = 0;
    glfwGetFramebufferSize(window, &width, &height);
    if (width == 0 || height == 0) return; // minimised
    const double passed =
        sequence > 0 ? 1.0 / 30 : seconds; // a sequence's frames are a thirtieth of a second apart
    if (animated()) {                      // beyond the span of the proof the time begins anew
        const double end = scene->compilation.scene.render.time_end;
        time = std::fmod(time + passed, end);
    }
    if (controls.rotate) orbit(views.camera(), -2 * turns_a_second * passed, 0);
    fly_by_keys(seconds);
    const bool by_hand = milliseconds_since(touched) < 150;
    const bool moving =
        (animated() || by_hand) && !controls.always && !controls.rotate && sequence == 0;
    const bool drew_before = std::exchange(drew_now, false);
    if (program && !controls.cache) draw_scene(width, height, moving, drew_before);
    if (controls.cache && draw_cached(width, height)) {
        // in place of the picture
    } else if (canvas.empty())
        gl::clear_window(width, height, 0.12f);
    else
        canvas.show(width, height, fading());

    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    if (std::exchange(click_asked, false) && !ImGui::GetIO().WantCaptureMouse) select(true);
    draw_panels(width, height);
    ImGui::Render();
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    save_pictures(width, height, moving);
    glfwSwapBuffers(window);
}

gl::Pick App::pick_at_cursor() const {
    int width = 0, height = 0;
    glfwGetWindowSize(window, &width, &height);
    if (width <= 0 || height <= 0 || canvas.empty()) return {};
    return canvas.pick(static_cast<int>(cursor_x * canvas.width() / width),
                       static_cast<int>(cursor_y * canvas.height() / height));
}

} // namespace fathom::viewer
