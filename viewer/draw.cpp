// Draws what changed and nothing else: samples of the scene, the probe, the panels; and writes
// pictures of the window.
#include "viewer/app.h"

#include "base/picture.h"
#include "driver/files.h"
#include "ir/shading.h"

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

constexpr double turns_a_second = 0.1; // auto-rotate
constexpr double fade_ms = 250;        // from cached values to exact ones, when it comes to rest
constexpr double slow_ms = 300;        // what takes longer is said

std::filesystem::path free_name(const std::filesystem::path &scene, const char *form) {
    for (int i = 1;; ++i) {
        const std::filesystem::path name =
            fmt::format(fmt::runtime(form), scene.stem().string(), i);
        std::error_code error;
        if (!std::filesystem::exists(name, error)) return name;
    }
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
    const double min_apart = 60 / to_window;
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
                    return std::hypot(other.x - label.x, other.y - label.y) < min_apart * to_window;
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
        view.inputs.sun =
            ir::lights_of(s, clock.time, ir::view_of(s, clock.time, shape))[0].position;
        view.inputs.time = clock.time;
        view.inputs.mode = controls.look == gl::Look::Check ? gl::Mode::Check : gl::Mode::Slice;
        view.inputs.plane = {0, 0, 0, controls.slice_offset};
        view.inputs.plane[static_cast<std::size_t>(controls.slice_axis)] = 1;
        if (tiles[i].width > 0 && tiles[i].height > 0) result.push_back(view);
    }
    return result;
}

std::string App::doing() const {
    std::string words;
    const auto say = [&](const std::string &more) { words += (words.empty() ? "" : " | ") + more; };
    if (recording.sequence > 0)
        say(fmt::format("every frame goes to {}; M ends it", recording.folder.string()));
    if (controls.cache && cached.ready()) say(cached.words());
    const Work work = worker->work();
    if (linking)
        say(stage_words(Stage::Linking));
    else if (work.stage != Stage::Rest && (work.seconds * 1000 > slow_ms || !program))
        say(fmt::format("{}, {:.1f} s", stage_words(work.stage), work.seconds));
    if (!progress.drawing || controls.cache || status.frame_ms < slow_ms) return words;
    const int percent = 100 * progress.next_row / std::max(drawn.height, 1);
    if (progress.next_sample > 0)
        say(fmt::format("smoothing, sample {} of {}: {} %", progress.next_sample + 1,
                        Progress::samples_at_rest, percent));
    else if (progress.resting && progress.coarse > 1)
        say(fmt::format("drawing at 1/{}: {} %", progress.coarse, percent));
    else if (progress.resting)
        say(fmt::format("drawing: {} %", percent));
    return words;
}

double App::fading() const {
    if (moving_cached.fade_begin == Clock::time_point{} ||
        moving_cached.fade_begin == Clock::time_point::max())
        return 0;
    return std::max(0.0, 1 - milliseconds_since(moving_cached.fade_begin) / fade_ms);
}

bool App::draw_cached(int width, int height) {
    if (!scene) return false;
    const Shot shot{views, clock.time, width, height};
    if (moving_cached.shot != shot) cached.view_changed();
    moving_cached.shot = shot;
    if (!cached.requested() && !worker->lent())
        cached.build(scene->compilation.scene, scene->compilation.parts.stride);
    if (!cached.requested()) return false; // the worker is at it
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
        if (!cached.draw(inputs, sent, true)) {
            controls.cache = false;
            note("no noise cache: the graphics card has no memory for it");
            return false;
        }
        cached.count();
    }
    gl::show_in_window(cached.framebuffer(), width, height);
    progress.on_screen = true;
    return true;
}

void App::draw_probe() {
    const bool slice = controls.look == gl::Look::Slice, check = controls.look == gl::Look::Check;
    if (progress.probed || !(slice || check)) return;
    labels.clear();
    if (!probe) return worker->want_probe();
    if (!canvas.probe(*probe, tile_views(canvas.width(), canvas.height()), sent)) return;
    progress.probed = true;
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
    if (recording.requested &&
        (animated() || (!moving && !pending() && fading() == 0))) { // the full picture
        recording.requested = false;
        const std::filesystem::path name = free_name(settings.file, "{}-{}.png");
        if (save_window(name, width, height)) note("saved " + name.string());
    }
    if (recording.sequence > 0 && progress.finished && !progress.drawing) {
        const std::string name = fmt::format("{:05}.png", recording.sequence++);
        const std::string error =
            driver::write_file(recording.folder / name, encode_png(canvas.read_picture()));
        if (!error.empty()) {
            recording.sequence = 0;
            note(fmt::format("cannot write {}: {}", (recording.folder / name).string(), error));
        }
    }
    if (fading() > 0) return;
    if (recording.next && clock.frames_due <= 1 && (!moving || animated()) && !pending() &&
        !settings.record.empty()) {
        save_window(settings.record / fmt::format("{:04}.png", ++recording.pictures), width,
                    height);
        recording.next = false;
    }
}

void App::draw_panels(int width, int height) {
    int window_width = 0, window_height = 0;
    glfwGetWindowSize(window, &window_width, &window_height);
    const float to_window =
        width > 0 ? static_cast<float>(window_width) / static_cast<float>(width) : 1;
    status.width = width;
    status.height = height;
    Shown shown{.status = status,
                .file = settings.file.string(),
                .errors = newest.errors,
                .remarks = newest.remarks,
                .doing = doing(),
                .picture = !canvas.empty() || controls.cache,
                .selected = {},
                .hovered = {},
                .view_names = {},
                .labels = labels,
                .frame_times = frame_times,
                .gpu_times = gpu_times,
                .verdicts = verdicts,
                .cache = cached.ready() ? &cached.figures() : nullptr};
    if (selected.number) shown.selected = part_line(selected);
    if (hovered.number) {
        const gl::Pick pick = pick_at_cursor();
        shown.hovered =
            part_line(hovered) +
            (pick.undecided()
                 ? fmt::format("\n{:.0f} steps, and it is undecided what is here", pick.steps)
                 : fmt::format("\n{:.0f} steps, field rises by {:.3g} a unit here", pick.steps,
                               pick.slope));
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
        shown.max_steps = ir::shading::many_steps;
        shown.undecided = canvas.undecided().rays;
        shown.reach =
            ir::frame_of(scene->compilation.scene, view_of(views.cameras[0]), 100).radius * 1.5;
    }
    const Asked asked = show_panels(controls, shown, params);
    for (std::size_t i : asked.changed) param_changed(params[i]);
    for (std::size_t i : asked.write) write_param(params[i]);
    for (std::size_t i : asked.copy) {
        glfwSetClipboardString(window, text_of(params[i]).c_str());
        note("copied " + text_of(params[i]));
    }
    if (asked.look) {
        progress.finished = progress.probed = false;
        clock.frames_due = 3;
        glfwSwapInterval(controls.always ? 0 : 1);
    }
    if (asked.size[0] > 0) glfwSetWindowSize(window, asked.size[0], asked.size[1]);
}

void App::draw(double seconds) {
    int width = 0, height = 0;
    glfwGetFramebufferSize(window, &width, &height);
    if (width == 0 || height == 0) return; // minimised
    // What is drawn in full is not moved on before it is whole.
    const bool in_full = controls.always || controls.rotate || recording.sequence > 0;
    clock.held_back += seconds;
    if (!in_full || !progress.drawing) {
        const double passed =
            recording.sequence > 0 ? 1.0 / 30 : clock.held_back; // its frames are that far apart
        clock.held_back = 0;
        if (animated()) { // beyond the span of the proof the time begins anew
            const double end = scene->compilation.scene.render.time_end;
            clock.time = std::fmod(clock.time + passed, end);
        }
        if (controls.rotate) orbit(views.camera(), -2 * turns_a_second * passed, 0);
    }
    fly_by_keys(seconds);
    const bool by_hand = milliseconds_since(clock.touched) < 150;
    const bool moving =
        (animated() || by_hand) && !controls.always && !controls.rotate && recording.sequence == 0;
    const bool drew_before = std::exchange(progress.drew_now, false);
    follow_params();
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
    if (std::exchange(pointer.clicked, false) && !ImGui::GetIO().WantCaptureMouse) select(true);
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
    if (progress.drawing && !picks.values.empty()) {
        const int x = static_cast<int>(pointer.x * picks.width / width),
                  y = static_cast<int>(pointer.y * picks.height / height);
        if (x < 0 || y < 0 || x >= picks.width || y >= picks.height) return {};
        const float *at = &picks.values[4 * static_cast<std::size_t>(y * picks.width + x)];
        return {static_cast<int>(at[0]), at[1], at[2], at[3]};
    }
    return canvas.pick(static_cast<int>(pointer.x * canvas.width() / width),
                       static_cast<int>(pointer.y * canvas.height() / height));
}

} // namespace fathom::viewer
