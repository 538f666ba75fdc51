#include "viewer/worker.h"

#include "base/encode.h"
#include "driver/edit.h"
#include "render-gl/pruning.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace fathom::viewer {
namespace {

void sort_out(const Diagnostics &diagnostics, const Sources &sources, Build &build) {
    for (const Diagnostic &diagnostic : diagnostics.sorted())
        (diagnostic.severity == Severity::Error ? build.errors : build.remarks)
            .push_back(to_text(diagnostic, sources, false));
}

Stage stage_of(driver::Phase phase) {
    switch (phase) {
    case driver::Phase::Read: return Stage::Reading;
    case driver::Phase::Check: return Stage::Checking;
    case driver::Phase::Prove: return Stage::Proving;
    case driver::Phase::Lower: return Stage::Lowering;
    case driver::Phase::Done: return Stage::Emitting;
    }
    return Stage::Emitting;
}

// What the driver has made for a build that nobody took is not lost: the next one may count on it.
void inherit(Link &link, Link &before) {
    if (link.program || !before.program) return;
    link.program = std::move(before.program);
    link.program->set_edited(link.edited);
    link.driver_ms = before.driver_ms;
}

} // namespace

void Linkers::link(Build &build) {
    build.picture_link = picture.link(build.picture, build.compilation.scene);
    if (!build.picture_link.error.empty()) build.errors.push_back(build.picture_link.error);
    if (!build.probe.text.empty())
        build.probe_link = probe.link(build.probe, build.compilation.scene);
    if (!build.probe_link.error.empty()) build.remarks.push_back(build.probe_link.error);
}

Worker::Worker(std::filesystem::path file, driver::CompileOptions options, Hooks hooks)
    : file_(std::move(file)), options_(std::move(options)), hooks_(std::move(hooks)),
      thread_([this] { run(); }) {}

Worker::~Worker() {
    ending_ = true;
    watcher_.wake();
    thread_.join();
}

std::unique_ptr<Build> Worker::take() {
    std::lock_guard lock(mutex_);
    return std::move(finished_);
}

std::optional<Worker::Kept> Worker::take_cached(std::size_t number) {
    std::lock_guard lock(mutex_);
    if (!kept_ || cached_number_ != number) return std::nullopt;
    return std::exchange(kept_, std::nullopt);
}

// The window does not wait for these: until they are there it draws exactly.
void Worker::build_cached(const ir::Scene &scene, int part_stride, std::size_t number) {
    Diagnostics discarded; // the build has told them
    Kept made =
        gl::build_cache_programs(scene, {.part_stride = part_stride, .pick = true}, discarded);
    if (gl::CachePrograms *programs = std::get_if<gl::CachePrograms>(&made))
        for (const gl::Program *program :
             {&programs->cached, &programs->rest, &programs->exact, &programs->fill})
            program->warm_up(scene.params);
    {
        std::lock_guard lock(mutex_);
        kept_ = std::move(made);
        cached_number_ = number;
    }
    hooks_.ready();
}

const char *stage_words(Stage stage) {
    switch (stage) {
    case Stage::Rest: return "";
    case Stage::Reading: return "reading the scene";
    case Stage::Checking: return "checking the scene";
    case Stage::Proving: return "proving how far a ray may step";
    case Stage::Lowering: return "lowering shapes to functions";
    case Stage::Emitting: return "writing the shader";
    case Stage::Linking: return "the graphics driver compiles the shader";
    }
    return "";
}

Work Worker::work() const {
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begun_.load();
    return {stage_, passed.count()};
}

void Worker::enter(Stage stage) {
    if (stage_ == Stage::Rest) begun_ = std::chrono::steady_clock::now();
    stage_ = stage;
    hooks_.ready();
}

std::string Worker::complaint() {
    std::lock_guard lock(mutex_);
    return complaint_;
}

void Worker::again() {
    asked_ = true;
    watcher_.wake();
}

void Worker::rebuild(std::vector<driver::Override> overrides) {
    {
        std::lock_guard lock(mutex_);
        overrides_ = std::move(overrides);
    }
    again();
}

void Worker::show(std::string text) {
    {
        std::lock_guard lock(mutex_);
        unsaved_ = std::move(text);
    }
    again();
}

void Worker::prove_at(std::size_t number, std::vector<ir::Param> params) {
    {
        std::lock_guard lock(mutex_);
        wanted_bounds_ = PresentBounds{number, std::move(params), {}};
    }
    moved_ = true;
    watcher_.wake();
}

std::optional<Worker::PresentBounds> Worker::take_bounds() {
    std::lock_guard lock(mutex_);
    return std::exchange(present_bounds_, std::nullopt);
}

// `scene`: of the newest build.
void Worker::prove_present(const ir::Scene &scene) {
    std::optional<PresentBounds> wanted;
    {
        std::lock_guard lock(mutex_);
        moved_ = false;
        wanted = std::exchange(wanted_bounds_, std::nullopt);
    }
    if (!wanted || wanted->number != number_) return;
    const auto start = std::chrono::steady_clock::now();
    ir::Scene present = scene;
    std::ranges::copy(wanted->params, present.params.begin());
    const auto stop = [this] {
        saved_ = saved_ || watcher_.wait(std::chrono::milliseconds(0));
        return ending_ || asked_ || moved_ || saved_;
    };
    auto bounds = driver::prove_present_bounds(present, bounds_, stop);
    if (!bounds) return;
    wanted->bounds = std::move(*bounds);
    wanted->milliseconds =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    {
        std::lock_guard lock(mutex_);
        present_bounds_ = std::move(wanted);
    }
    hooks_.ready();
}

void Worker::want_probe() {
    if (!probe_.exchange(true)) again();
}

// `cells`: bounds by cells, so many along a side; 0: none but those of fields in a region.
std::unique_ptr<Build> Worker::build(int cells) {
    auto start = std::chrono::steady_clock::now();
    auto result = std::make_unique<Build>();
    driver::CompileOptions options = options_;
    options.parts = true;
    options.present_bounds = true;
    options.cells = cells;
    options.bounds = &bounds_;
    options.entered = [this](driver::Phase phase) { enter(stage_of(phase)); };
    {
        std::lock_guard lock(mutex_);
        options.unsaved = unsaved_;
        for (const driver::Override &value : overrides_) {
            std::erase_if(options.overrides,
                          [&](const auto &given) { return given.name == value.name; });
            options.overrides.push_back(value);
        }
    }
    result->compilation = driver::compile_file(file_, options);
    const driver::Compilation &compilation = result->compilation;
    sort_out(compilation.diagnostics, compilation.sources, *result);
    if (!compilation.unreadable.empty())
        result->errors.push_back(
            driver::stamp_of(file_).exists
                ? "cannot read `" + for_terminal(file_.string()) + "`: " + compilation.unreadable
                : "there is no `" + for_terminal(file_.string()) + "`; this window waits for it");
    for (const std::string &error : compilation.usage_errors)
        result->errors.push_back(for_terminal(error));
    if (result->good()) {
        glsl::Options target;
        target.target = glsl::Target::Glsl330;
        target.buffers =
            true; // no places in the text: a moved line changes nothing for the graphics driver
        target.part_stride = compilation.parts.stride;
        target.pruning = pruning_;
        target.passes = true;
        target.instruments = glsl::Instruments::Pick;
        Diagnostics emission;
        result->picture = glsl::emit(compilation.scene, target, emission);
        target.instruments = glsl::Instruments::Probe;
        if (probe_) result->probe = glsl::emit(compilation.scene, target, emission);
        sort_out(emission, compilation.sources, *result);
        if (compilation.sources.size() > 0)
            result->views = driver::views_in(compilation.sources[SourceId{0}].text);
    }
    result->front_end_ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    return result;
}

// The build's scene, where it has fields that may be cached, or bounds for the present values.
static std::optional<ir::Scene> worked_on(const Build &build) {
    const ir::Scene &scene = build.compilation.scene;
    if (!build.good() || (scene.graph.cache_count() == 0 && scene.present_bounds.empty()))
        return std::nullopt;
    return scene;
}

void Worker::hand_over(std::unique_ptr<Build> made, Linkers &linkers) {
    if (lent_ && made->good()) {
        enter(Stage::Linking);
        linkers.link(*made);
        made->linked = true;
    }
    made->number = ++number_;
    std::lock_guard lock(mutex_);
    if (finished_ && made->good()) {
        inherit(made->picture_link, finished_->picture_link);
        inherit(made->probe_link, finished_->probe_link);
    } else if (finished_ && finished_->picture_link.program) {
        linkers = {}; // its program ends with it, so the next is made anew
    }
    finished_ = std::move(made);
    complaint_ = watcher_.polls_because();
}

void Worker::run() {
    const bool lent = hooks_.take_context && hooks_.take_context();
    lent_ = lent;
    // On the processor making the lists would hold up every edit.
    pruning_ = lent && gl::can_prune() && !gl::is_software();
    {
        Linkers linkers;
        while (!ending_) {
            asked_ = false;
            std::unique_ptr<Build> made = build(0);
            watcher_.watch(made->compilation.files);
            const bool steep = made->good() && driver::is_steep(made->compilation.scene);
            const std::size_t regions = made->compilation.scene.cells.size();
            const int part_stride = made->compilation.parts.stride;
            std::optional<ir::Scene> scene = worked_on(*made); // the build goes to the window
            hand_over(std::move(made), linkers);
            // Bounds by cells take longer to find than all else: the first picture is without them.
            if (steep && !ending_ && !asked_) {
                std::unique_ptr<Build> by_cells = build(driver::cells_of_views);
                if (!ending_ && !asked_ && by_cells->compilation.scene.cells.size() > regions) {
                    scene = worked_on(*by_cells);
                    hand_over(std::move(by_cells), linkers);
                }
            }
            enter(Stage::Rest);
            if (lent && scene && scene->graph.cache_count() > 0 && !ending_ && !asked_)
                build_cached(*scene, part_stride, number_);
            saved_ = false;
            while (!ending_ && !asked_ && !saved_)
                if (scene && moved_)
                    prove_present(*scene);
                else
                    saved_ = watcher_.wait(std::chrono::hours(1));
        }
    }
    if (lent) hooks_.leave_context();
}

} // namespace fathom::viewer
