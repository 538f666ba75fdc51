// Pictures by OpenGL (fathom/gl.h), of a library that is built with it.
#include "api/picture.h"
#include "backend-glsl/emit.h"
#include "base/picture.h"
#include "render-gl/cache_passes.h"
#include "render-gl/context.h"
#include "render-gl/pruning.h"
#include "render-gl/render.h"

#include <fathom/gl.h>

#include <algorithm>
#include <chrono>
#include <fmt/format.h>

namespace fathom::v1 {

struct GlPainter::Impl {
    gl::Context context;
    std::optional<Scene> scene;
    std::optional<gl::Program> program;
    std::unique_ptr<gl::CachedView> cache;
    std::string exact_because;
    GlOptions options;
    double driver_seconds = 0;

    ~Impl() { // programs are deleted while their context is current
        const gl::KeptCurrent kept;
        context.make_current();
        cache.reset();
        program.reset();
    }
};

namespace {

// What `work` gives with the painter's context current, else what stands for it: where it is not open,
// where it is current on another thread, or for lack of memory.
template <class Work, class Failed>
auto inside(GlPainter::Impl *impl, Work work, Failed failed) noexcept {
    return guarded(
        [&]() -> decltype(work(*impl)) {
            if (!impl) return failed(sentence("usage", "OpenGL is not open"));
            const gl::KeptCurrent kept;
            if (!impl->context.make_current())
                return failed(sentence("usage", "the painter draws on another thread"));
            return work(*impl);
        },
        failed);
}

// A still picture is drawn through the cache until less than a twentieth of it misses, or a frame
// learnt less than a quarter of what was missing, or look-ups do not pay; what the last frame
// misses is computed. Where the first one, which computes all, wishes for more cells than pixels
// miss, few of them share any: learning them takes longer than computing this picture, so that was
// it.
constexpr int max_learning_frames = 6;

bool draw_still(gl::CachedView &view, const ir::Scene &scene, const gl::FrameInputs &inputs,
                const std::function<bool(double)> &progress) {
    const auto pixels =
        static_cast<std::uint64_t>(inputs.width) * static_cast<std::uint64_t>(inputs.height);
    std::uint64_t before = 0;
    for (int frame = 0; frame < max_learning_frames; ++frame) {
        if (!view.draw(inputs, scene.params, {})) return false;
        const std::uint64_t misses = view.read_tally().misses;
        if (progress && !progress((frame + 1.0) / max_learning_frames)) return false;
        if (!view.looked_up() || 20 * misses <= pixels) break;
        const gl::CacheCounts counts = view.store().read_counts();
        const std::uint64_t cells =
            std::uint64_t{counts.inserted} + counts.crowded + std::uint64_t{counts.full};
        if (frame == 0 ? cells > misses : 4 * misses > 3 * before) break;
        before = misses;
    }
    return true;
}

std::string cached_share(const gl::CachedView &view) {
    const double all = static_cast<double>(view.width()) * view.height();
    const gl::CacheTally tally = view.read_tally();
    const double computed = static_cast<double>(tally.computed);
    if (!view.looked_up()) return "drawn exactly: cached values do not pay in this view";
    if (computed < all && tally.hits > 0)
        return fmt::format("{:.1f} % by cached values", 100 - 100 * computed / all);
    return tally.misses > 0 ? "drawn exactly: its pixels share too few cached values to learn them"
                            : "drawn exactly: cells are narrower than pixels";
}

std::optional<gl::Pixels> draw_cached(GlPainter::Impl &impl, const ir::Scene &scene,
                                      const PictureOptions &options, std::string &remark) {
    gl::CachedView &view = *impl.cache;
    gl::FrameInputs inputs;
    inputs.view = view_of(scene, options, options.time);
    inputs.sun =
        ir::lights_of(scene, options.time, ir::view_of(scene, options.time, aspect_of(options)))[0]
            .position;
    inputs.width = options.width;
    inputs.height = options.height;
    inputs.time = options.time;
    inputs.mode = gl::Mode::Linear;
    std::optional<gl::Pixels> sum;
    const int samples = std::max(options.samples, 1);
    for (int k = 0; k < samples; ++k) {
        inputs.offset = ir::sample_offset(k);
        const bool drawn = k == 0 && impl.options.still
                               ? draw_still(view, scene, inputs, options.progress)
                               : view.draw(inputs, scene.params, {});
        if (!drawn) return std::nullopt;
        gl::Pixels pixels = view.read_pixels();
        if (sum) {
            for (std::size_t i = 0; i < sum->rgba.size(); ++i) sum->rgba[i] += pixels.rgba[i];
            sum->undecided += pixels.undecided;
            sum->passed += pixels.passed;
        } else {
            sum = std::move(pixels);
        }
    }
    for (float &value : sum->rgba) value /= static_cast<float>(samples);
    sum->rays = static_cast<std::uint64_t>(samples) * sum->rgba.size() / 4;
    remark = cached_share(view);
    return sum;
}

std::optional<gl::Pixels> draw_exactly(GlPainter::Impl &impl, const ir::Scene &scene,
                                       const PictureOptions &options) {
    gl::Request request;
    request.width = options.width;
    request.height = options.height;
    request.samples = options.samples;
    request.time = options.time;
    request.view = view_of(scene, options, options.time);
    request.progress = options.progress;
    return gl::draw(*impl.program, scene, request, gl::Mode::Linear);
}

std::string beyond(const GlPainter::Impl &impl, const PictureOptions &options) {
    if (!impl.program) return "no scene is in use";
    if (std::string why = refused(impl.scene->facts(), options); !why.empty()) return why;
    if (std::max(options.width, options.height) > gl::largest_side())
        return fmt::format("this GL draws at most {0}x{0} pixels", gl::largest_side());
    if (options.region || options.first_sample > 0 || options.alpha || options.sums ||
        options.shutter > 0)
        return "parts of a picture, alpha and an open shutter are drawn by the CPU alone";
    return "";
}

glsl::Options text_options() {
    glsl::Options options;
    options.target = glsl::Target::Glsl330;
    options.passes = true;
    options.buffers = true;
    return options;
}

ir::Scene limited(const Scene &scene, int max_steps) {
    ir::Scene limited = ir_of(scene);
    if (max_steps > 0) limited.render.max_steps = max_steps;
    return limited;
}

Diagnostic refused_by_driver(const gl::ProgramError &error) {
    Diagnostic diagnostic = sentence(std::string(code_name(Code::ShaderInvalid)),
                                     "the graphics driver refuses the shader: " + error.message);
    if (error.line > 0)
        diagnostic.notes.push_back(
            fmt::format("line {} of the shader: {}", error.line, error.source_line));
    return diagnostic;
}

std::vector<Diagnostic> used(GlPainter::Impl &impl, const Scene &scene, const GlOptions &wanted) {
    const Sources &sources = scene.impl().compilation->sources;
    impl.program.reset();
    impl.cache.reset();
    impl.exact_because.clear();
    impl.options = wanted;
    impl.scene = scene;
    const ir::Scene drawn = limited(scene, wanted.max_steps);
    Diagnostics diagnostics;
    glsl::Options options = text_options();
    options.pruning = gl::can_prune();
    const glsl::Output output = glsl::emit(drawn, options, diagnostics);
    std::vector<Diagnostic> said = translated(diagnostics, sources);
    if (diagnostics.has_errors()) return said;
    const auto start = std::chrono::steady_clock::now();
    auto program = gl::Program::build(output, drawn);
    impl.driver_seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (const auto *error = std::get_if<gl::ProgramError>(&program)) {
        said.push_back(refused_by_driver(*error));
        return said;
    }
    impl.program = std::move(std::get<gl::Program>(program));
    if (wanted.noise_cache) {
        auto view = std::make_unique<gl::CachedView>();
        Diagnostics unused; // of its own programs, which draw the same scene
        impl.exact_because = view->use(drawn, gl::usual_cache_size, unused);
        if (impl.exact_because.empty()) impl.cache = std::move(view);
    }
    return said;
}

Picture drawn(GlPainter::Impl &impl, const PictureOptions &options) {
    Picture picture;
    const ir::Scene scene = limited(*impl.scene, impl.options.max_steps);
    PictureOptions watched = options;
    bool cancelled = false;
    if (options.progress)
        watched.progress = [&](double done) { return !(cancelled = !options.progress(done)); };
    std::optional<gl::Pixels> pixels = impl.cache
                                           ? draw_cached(impl, scene, watched, picture.remark)
                                           : draw_exactly(impl, scene, watched);
    if (!pixels) return without_picture(cancelled ? "cancelled" : "OpenGL has no memory for it");
    picture.width = pixels->width;
    picture.height = pixels->height;
    picture.rgba = picture_of_linear(pixels->width, pixels->height, pixels->rgba).rgba;
    picture.complete = true;
    picture.rays = pixels->rays;
    picture.undecided = pixels->undecided;
    picture.undecided_shadows = pixels->undecided_shadows;
    picture.passed = pixels->passed;
    if (options.linear) {
        picture.linear = std::move(pixels->rgba);
        for (std::size_t i = 3; i < picture.linear.size(); i += 4) picture.linear[i] = 1; // opaque
    }
    return picture;
}

} // namespace

GlPainter::GlPainter() = default;
GlPainter::GlPainter(GlPainter &&) noexcept = default;
GlPainter &GlPainter::operator=(GlPainter &&) noexcept = default;
GlPainter::~GlPainter() = default;

std::string GlPainter::open() {
    return guarded(
        [&]() -> std::string {
            if (impl_) return "";
            const gl::KeptCurrent kept;
            auto context = gl::Context::make();
            if (const std::string *why = std::get_if<std::string>(&context)) return *why;
            impl_.reset(new Impl{std::move(std::get<gl::Context>(context)), {}, {}, {}, {}, {}, 0});
            return "";
        },
        [](const Diagnostic &why) { return why.message; });
}

bool GlPainter::is_open() const { return impl_ != nullptr; }
bool GlPainter::is_cached() const { return impl_ && impl_->cache; }
double GlPainter::driver_seconds() const { return impl_ ? impl_->driver_seconds : 0; }

bool GlPainter::is_software() const {
    return inside(
        impl_.get(), [](Impl &) { return gl::is_software(); },
        [](const Diagnostic &) { return false; });
}

int GlPainter::largest_side() const {
    return inside(
        impl_.get(), [](Impl &) { return gl::largest_side(); },
        [](const Diagnostic &) { return 0; });
}

std::string GlPainter::describe() const {
    return inside(
        impl_.get(), [](Impl &impl) { return impl.context.describe(); },
        [](const Diagnostic &) { return std::string(); });
}

std::string GlPainter::exact_because() const {
    return guarded([&] { return impl_ ? impl_->exact_because : std::string(); },
                   [](const Diagnostic &) { return std::string(); });
}

std::string GlPainter::text(const Scene &scene) const {
    return inside(
        impl_.get(),
        [&](Impl &) {
            glsl::Options options = text_options();
            options.pruning = gl::can_prune();
            Diagnostics diagnostics;
            glsl::Output output = glsl::emit(ir_of(scene), options, diagnostics);
            return diagnostics.has_errors() ? std::string() : std::move(output.text);
        },
        [](const Diagnostic &) { return std::string(); });
}

std::vector<Diagnostic> GlPainter::use(const Scene &scene, const GlOptions &options) {
    return inside(
        impl_.get(), [&](Impl &impl) { return used(impl, scene, options); },
        [](Diagnostic why) { return std::vector{std::move(why)}; });
}

Picture GlPainter::draw(const PictureOptions &options) {
    return inside(
        impl_.get(),
        [&](Impl &impl) {
            std::string why = beyond(impl, options);
            return why.empty() ? drawn(impl, options) : without_picture(std::move(why));
        },
        [](Diagnostic why) { return without_picture(std::move(why.message)); });
}

bool GlPainter::draw_for_nothing(const PictureOptions &options) {
    return inside(
        impl_.get(),
        [&](Impl &impl) {
            if (!beyond(impl, options).empty()) return false;
            const ir::Scene scene = limited(*impl.scene, impl.options.max_steps);
            return draw_exactly(impl, scene, options).has_value();
        },
        [](const Diagnostic &) { return false; });
}

GlLists GlPainter::lists() const {
    return inside(
        impl_.get(),
        [](Impl &impl) {
            const gl::Pruning *pruning = impl.program ? impl.program->pruning() : nullptr;
            if (!pruning) return GlLists();
            const gl::Pruning::Tally tally = pruning->tally();
            return GlLists{tally.rows, tally.all, tally.side};
        },
        [](const Diagnostic &) { return GlLists(); });
}

void GlPainter::remake_lists() {
    inside(
        impl_.get(),
        [](Impl &impl) {
            gl::Pruning *pruning = impl.program ? impl.program->pruning() : nullptr;
            if (!pruning) return;
            pruning->remake(ir_of(*impl.scene).params, 0);
            gl::finish();
        },
        [](const Diagnostic &) {});
}

} // namespace fathom::v1
