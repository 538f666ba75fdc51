// What a save does to the window: a new build is taken, camera, time, values and selection survive.
#include "viewer/app.h"

#include "driver/edit.h"
#include "driver/verdict.h"
#include "render-gl/pruning.h"
#include "viewer/params.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <span>
#include <utility>

namespace fathom::viewer {
namespace {

// The camera of a `camera(…)` line alone.
std::optional<Camera> camera_of_line(const std::string &line) {
    const driver::Compilation alone = driver::compile_text("view", line + "\n", "", {});
    if (!alone.good() || !alone.scene.camera.given) return std::nullopt;
    return camera_of(ir::view_of(alone.scene, 0, 1));
}

} // namespace

driver::CompileOptions compile_options(const Settings &settings) {
    driver::CompileOptions options;
    options.include_folders = settings.include_folders;
    for (const auto &[name, text] : settings.values) options.overrides.push_back({name, text});
    options.limits = settings.limits;
    options.strict_proof = settings.strict_proof;
    return options;
}

double milliseconds_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

void App::note(std::string words) {
    status.note = std::move(words);
    clock.noted = Clock::now();
    clock.frames_due = std::max(clock.frames_due, 2);
}

// What was done is news for some seconds, and then it is not.
double App::note_seconds_left() const {
    constexpr double news_ms = 6000;
    return std::max(news_ms - milliseconds_since(clock.noted), 1.0) / 1000;
}

void App::drop_old_note() {
    if (!status.note.empty() && note_seconds_left() <= 0.001) note("");
}

std::string App::text_of(const ir::Param &param) const {
    driver::Notation notation;
    if (scene && param.origin.source)
        notation = driver::notation_of_param(scene->compilation.sources[param.origin.source].text,
                                             param.name);
    return value_text(param, notation);
}

// True where the build's picture can be drawn. The same text keeps the same program: only numbers
// go to the card.
bool App::adopt(Build &build) {
    if (!build.linked) linkers.link(build);
    if (!build.good()) return false;
    const auto use = [](std::optional<gl::Program> &mine, Link &link, const glsl::Output &output) {
        if (link.program) mine = std::move(link.program);
        link.program.reset();
        if (!mine) return;
        mine->adopt(output);
        mine->set_edited(link.edited);
    };
    status.linked_anew = build.picture_link.program.has_value();
    if (status.linked_anew) progress.measured = false;
    if (status.linked_anew) status.driver_ms = build.picture_link.driver_ms;
    use(program, build.picture_link, build.picture);
    status.lists.clear();
    if (const gl::Pruning *pruning = program ? program->pruning() : nullptr)
        status.lists = fmt::format("{:.0f} of {:.0f} rows a cell", pruning->tally().rows,
                                   pruning->tally().all);
    if (build.probe.text.empty())
        probe.reset();
    else
        use(probe, build.probe_link, build.probe);
    return program.has_value();
}

void App::rebuild(std::vector<driver::Override> values) {
    newest.structural = values;
    worker->rebuild(std::move(values));
}

void App::take(std::unique_ptr<Build> build) {
    clock.frames_due = 3;
    // A slider's value that the changed text has no place for any more: the text's own counts.
    if (!build->compilation.usage_errors.empty() && !newest.structural.empty()) return rebuild({});
    recording.next = true;
    newest.told = false;
    newest.saved = driver::last_saved(newest.files, build->compilation.files);
    newest.files = build->compilation.files;
    const bool good = build->good() && adopt(*build);
    newest.errors = build->errors;
    newest.remarks = build->remarks;
    status.front_end_ms = build->front_end_ms;
    status.trouble = worker->complaint();
    if (!good) return; // the last good picture stays
    progress.on_screen = false;
    picks.values.clear(); // by the numbers of the scene before
    // What was said a while ago is of the text before; just now, of this one: "wrote it".
    if (milliseconds_since(clock.noted) > 3000) note("");

    std::vector<ir::Param> before = std::move(params);
    params = build->compilation.scene.params;
    std::erase_if(params, [](const ir::Param &param) { return param.is_bound; });
    carry_over(before, params);
    if (drop_outdated(before, params, newest.structural)) rebuild(newest.structural);
    const std::vector<std::string> old_views = scene ? scene->views : std::vector<std::string>{};
    if (scene) selected = found_again(scene->compilation, selected, build->compilation);
    scene = std::move(build);
    outline_cursor();
    cached.scene_changed();
    progress.stale = true;
    const ir::Scene &s = scene->compilation.scene;
    status.shader_bytes = scene->picture.text.size();

    // The camera is the user's, until the text's own changes.
    const Camera fresh = camera_of(ir::view_of(s, 0, aspect()));
    if (!std::exchange(has_camera, true) || (s.camera.given && fresh != scene_camera))
        views.cameras[0] = fresh;
    scene_camera = fresh;
    if (scene->views != old_views) {
        const std::size_t shown = scene->views.size() >= 3 ? 4 : scene->views.empty() ? 1 : 2;
        show_views(views, static_cast<int>(shown));
        for (std::size_t i = 0; i + 1 < shown; ++i)
            if (const auto camera = camera_of_line(scene->views[i])) views.cameras[i + 1] = *camera;
    }

    hovered = {};
    controls.chosen = params.empty() ? 0 : std::min(controls.chosen, params.size() - 1);
    const driver::Verdict verdict = driver::judge(s);
    status.bound = verdict.lipschitz ? fmt::format("L {:.4g} {}", *verdict.lipschitz,
                                                   driver::status_name(verdict.status))
                                     : "no bound";
}

// A present bound holds at the values that it was proved for alone: until that of others is there,
// rays go by what holds for the whole ranges.
void App::follow_params() {
    if (!scene) return;
    const std::vector<ir::PresentBound> &bounds = scene->compilation.scene.present_bounds;
    const auto present = [&](const std::vector<ir::Param> &others) {
        return std::ranges::equal(params, std::span(others).first(params.size()), {},
                                  &ir::Param::value, &ir::Param::value);
    };
    if (std::exchange(sent_number, scene->number) != scene->number || !present(sent)) {
        sent = scene->compilation.scene.params; // whose present bounds are unknown
        std::ranges::copy(params, sent.begin());
        status.bound_now.clear();
        if (!bounds.empty()) worker->prove_at(scene->number, params);
    }
    const std::optional<Worker::PresentBounds> proved = worker->take_bounds();
    if (!proved || proved->number != scene->number || !present(proved->params)) return;
    for (std::size_t i = 0; i < bounds.size(); ++i)
        sent[bounds[i].param].value[0] = proved->bounds.values[i];
    if (controls.look != gl::Look::Picture) progress.stale = true; // it shows steps
    clock.frames_due = std::max(clock.frames_due, 1);
    status.bound_now = fmt::format("{:.4g} as the params stand", proved->bounds.whole);
    if (settings.tell)
        settings.tell(
            fmt::format("bound: {}, proved in {:.2f} ms", status.bound_now, proved->milliseconds));
}

void App::param_changed(const ir::Param &param) {
    progress.stale = true;
    note("");              // it may have told the value before
    cached.view_changed(); // fields that read it are given up by the cache itself
    clock.touched = Clock::now();
    clock.frames_due = 3;
    if (param.structural) rebuild(structural_values(params));
}

// -- an editor

// True where all values can be set without another compilation: then they are.
static bool slid(App &app, const std::vector<std::pair<std::string, double>> &values) {
    std::vector<std::pair<ir::Param *, double>> moved;
    for (const auto &[name, value] : values) {
        const auto param = std::ranges::find(app.params, name, &ir::Param::name);
        if (param == app.params.end() || param->structural || ir::components(param->type) != 1 ||
            (param->has_range && (value < param->lo[0] || value > param->hi[0])))
            return false;
        moved.emplace_back(&*param, value);
    }
    for (const auto &[param, value] : moved) {
        param->value[0] = param->initial[0] = value; // the text says so
        app.param_changed(*param);
    }
    return !moved.empty() && app.newest.errors.empty();
}

void App::hear_editor() {
    if (!editor) return;
    Typed typed = editor->take();
    if (typed.cursor) cursor = typed.cursor;
    if (typed.text && !slid(*this, typed.params)) worker->show(std::move(*typed.text));
    if (typed.cursor) outline_cursor();
    if (!editor->open()) {
        editor.reset();
        note("the editor has gone; the window follows the file from now on");
    }
}

void App::outline_cursor() {
    if (!scene || !cursor) return;
    Part part = part_at(scene->compilation, settings.file.string(), *cursor);
    if (part.number == selected.number) return;
    selected = std::move(part);
    progress.finished = false;
    clock.frames_due = 3;
}

// -- back into the text

namespace {

using Edited = std::variant<std::string, driver::EditError>;

// Reads, edits and writes a file; empty, or the sentence that says why not.
template <class Edit> std::string edit_file(const std::filesystem::path &file, Edit edit) {
    std::string error;
    const std::optional<std::string> text =
        driver::read_file(file, driver::max_source_bytes, error);
    if (!text) return fmt::format("cannot read {}: {}", file.string(), error);
    const Edited edited = edit(*text);
    if (const auto *why_not = std::get_if<driver::EditError>(&edited))
        return fmt::format("cannot write into {}: {}", file.string(), why_not->sentence);
    error = driver::write_file(file, std::get<std::string>(edited));
    return error.empty() ? "" : fmt::format("cannot write {}: {}", file.string(), error);
}

} // namespace

void App::write_param(const ir::Param &param) {
    const Span origin = param.origin;
    std::filesystem::path file = settings.file;
    if (scene && origin.source && origin.source.index < scene->compilation.sources.size())
        file = scene->compilation.sources[origin.source].name;
    std::string value;
    const std::string error = edit_file(file, [&](const std::string &text) -> Edited {
        value = value_text(param, driver::notation_of_param(text, param.name));
        if (auto with = driver::with_param(text, param.name, value)) return std::move(*with);
        return driver::EditError{fmt::format("it declares no param `{}` any more", param.name)};
    });
    note(error.empty() ? fmt::format("wrote {} = {} into {}", param.name, value, file.string())
                       : error);
}

bool App::write_view() {
    const std::string camera = camera_line(views.cameras[0]);
    const std::filesystem::path &file = settings.file;
    const bool save_file = driver::is_save_file(file);
    const std::string error = edit_file(file, [&](const std::string &text) -> Edited {
        if (save_file)
            return driver::save_file_with_camera(text, camera, file.parent_path(),
                                                 compile_options(settings));
        if (!driver::can_be_read(text))
            return driver::EditError{"fix its errors first, so that a place for it is found"};
        std::vector<std::string> others;
        for (int i = 1; i < views.count; ++i)
            others.push_back(camera_line(views.cameras[static_cast<std::size_t>(i)]));
        return driver::with_views(driver::with_camera(text, camera), others);
    });
    const char *what = !save_file         ? "the view"
                       : views.count == 1 ? "the camera"
                                          : "the camera, and no other view: save files hold one,";
    note(error.empty() ? fmt::format("wrote {} into {}", what, file.string()) : error);
    return error.empty();
}

} // namespace fathom::viewer
