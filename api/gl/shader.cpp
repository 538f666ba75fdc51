// A shader in the host's context (fathom/gl.h), of a library that is built with OpenGL.
#include "api/impl.h"
#include "backend-glsl/cache.h"
#include "render-gl/cache_passes.h"
#include "render-gl/context.h"
#include "render-gl/kept_state.h"

#include <fathom/gl.h>

#include <algorithm>
#include <fmt/format.h>
#include <utility>

namespace fathom::v1 {

struct GlShader::Impl {
    std::optional<gl::Program> program; // of a shader without the noise cache
    gl::CachedView cache;               // with it
    gl::FrameInputs frame;
    std::vector<ir::Param> params; // the inputs that are params, by the text's order
    bool drawn = false;
};

namespace {

ir::Type type_of(const std::string &type) {
    if (type == "vec2") return ir::Type::Vec2;
    if (type == "vec3") return ir::Type::Vec3;
    if (type == "vec4") return ir::Type::Vec4;
    return type == "float" ? ir::Type::Float : ir::Type::Int;
}

// What the text wants, as render-gl knows it: of a scene it reads the data and the params alone.
struct Wanted {
    ir::Scene scene;
    glsl::Output output;
};

Wanted wanted_of(const Shader &shader) {
    Wanted wanted;
    auto &[scene, output] = wanted;
    output.text = shader.text;
    output.tables = shader.tables;
    for (const Texture &from : shader.textures) {
        const auto index =
            static_cast<std::uint32_t>(from.grid ? scene.grids.size() : scene.images.size());
        (from.grid ? output.grids : output.images).push_back({from.name, index});
        if (from.grid)
            scene.grids.push_back({from.name, {from.width, from.height, from.depth}, from.values});
        else
            scene.images.push_back({from.name, from.width, from.height, from.values});
    }
    for (const ShaderInput &input : shader.inputs) {
        if (input.param.empty()) continue;
        const auto index = static_cast<std::uint32_t>(scene.params.size());
        output.uniforms.push_back({input.name, type_of(input.type), index});
        ir::Param param;
        param.name = input.name;
        std::ranges::copy_n(input.value.begin(), std::ssize(input.value), param.value.begin());
        scene.params.push_back(std::move(param));
    }
    return wanted;
}

std::vector<glsl::CachedField> fields_of(const Shader &shader) {
    std::vector<glsl::CachedField> fields;
    for (const CachedField &from : shader.cache.fields) {
        glsl::CachedField &to = fields.emplace_back();
        to.wide = from.wide;
        to.meaning = from.meaning;
        std::uint32_t index = 0;
        for (const ShaderInput &input : shader.inputs)
            if (!input.param.empty()) {
                if (std::ranges::find(from.params, input.param) != from.params.end())
                    to.params.push_back(index);
                ++index;
            }
    }
    return fields;
}

std::string words_of(const gl::ProgramError &error) {
    std::string words = "the graphics driver refuses the shader: " + error.message;
    if (error.line > 0)
        words += fmt::format(" (line {} of the shader: {})", error.line, error.source_line);
    return words;
}

// The programs of a text with the noise cache: cached, rest, exact, fill.
std::string load_cached(GlShader::Impl &impl, const Shader &shader, const Wanted &wanted) {
    std::vector<gl::Program> built;
    for (std::string text :
         {glsl::with_cache(shader.text), glsl::with_cache(shader.text, glsl::cache_learns),
          shader.text, shader.cache.fill}) {
        glsl::Output output = wanted.output;
        output.text = std::move(text);
        auto program = gl::Program::build(output, wanted.scene);
        if (const auto *error = std::get_if<gl::ProgramError>(&program)) return words_of(*error);
        built.push_back(std::move(std::get<gl::Program>(program)));
    }
    gl::CachePrices prices{0, shader.cache.scene_cost};
    for (const CachedField &field : shader.cache.fields)
        prices.field = prices.field > 0 ? std::min(prices.field, field.cost) : field.cost;
    return impl.cache.use({std::move(built[0]), std::move(built[1]), std::move(built[2]),
                           std::move(built[3]), fields_of(shader), prices, false},
                          gl::usual_cache_size);
}

std::string loaded(GlShader::Impl &impl, const Shader &shader) {
    const auto is_size = [](const ShaderInput &i) { return i.name == "fathom_resolution"; };
    if (shader.text.empty() || std::ranges::none_of(shader.inputs, is_size))
        return "a text of this target, or of a field alone, draws no picture here";
    Wanted wanted = wanted_of(shader);
    std::optional<gl::Program> program;
    if (shader.cache.fill.empty()) {
        auto built = gl::Program::build(wanted.output, wanted.scene);
        if (const auto *error = std::get_if<gl::ProgramError>(&built)) return words_of(*error);
        program = std::move(std::get<gl::Program>(built));
        impl.cache.drop();
    } else {
        if (std::string why = gl::cache_unavailable(); !why.empty()) return why;
        if (std::string why = load_cached(impl, shader, wanted); !why.empty()) return why;
    }
    impl.program = std::move(program);
    impl.params = std::move(wanted.scene.params);
    impl.frame = {};
    impl.drawn = false;
    return "";
}

void set_one(GlShader::Impl &impl, const ShaderInput &input) {
    gl::FrameInputs &frame = impl.frame;
    const auto put = [&](const char *name, double *values, std::size_t count) {
        if (input.name == name)
            std::copy_n(input.value.begin(), std::min(count, input.value.size()), values);
    };
    double orthographic = frame.view.orthographic ? 1 : 0, mode = static_cast<int>(frame.mode);
    for (const FrameRow &row : rows_of(frame.view, orthographic))
        put(row.name, row.values, row.count);
    put("fathom_sun", &frame.sun[0], 3);
    put("fathom_offset", frame.offset.data(), 2);
    put("fathom_time", &frame.time, 1);
    put("fathom_mode", &mode, 1);
    frame.view.orthographic = orthographic != 0;
    frame.mode = static_cast<gl::Mode>(std::clamp(mode, 0.0, 3.0));
    for (ir::Param &param : impl.params) put(param.name.c_str(), param.value.data(), 4);
}

// What `work` gives in the host's context, whose state is put back; else what `failed` gives.
template <class Work, class Failed> auto in_current(Work work, Failed failed) noexcept {
    return guarded(
        [&]() -> decltype(failed(Diagnostic())) {
            if (!gl::any_is_current())
                return failed(sentence("usage", "no context of OpenGL is current on this thread"));
            const gl::KeptState kept;
            return work(kept);
        },
        failed);
}

bool drawn(GlShader::Impl &impl, int width, int height, const gl::KeptState &kept) {
    impl.drawn = false;
    if (width < 1 || height < 1 || std::max(width, height) > gl::largest_side()) return false;
    impl.frame.width = width;
    impl.frame.height = height;
    if (impl.program) {
        kept.draw_over(width, height);
        impl.program->draw(impl.frame, impl.params);
    } else {
        if (!impl.cache.draw(impl.frame, impl.params, {})) return false;
        kept.copy_over(impl.cache.framebuffer(), width, height);
    }
    return impl.drawn = true;
}

} // namespace

GlShader::GlShader() = default;
GlShader::GlShader(GlShader &&) noexcept = default;

GlShader &GlShader::operator=(GlShader &&other) noexcept {
    GlShader before;
    before.impl_ = std::exchange(impl_, std::move(other.impl_));
    return *this;
}

// Without a context there is none to delete from: what was made went with its own.
GlShader::~GlShader() {
    if (impl_ && !gl::any_is_current()) static_cast<void>(impl_.release());
}

std::string GlShader::load(const Shader &shader) {
    return in_current(
        [&](const gl::KeptState &) {
            std::unique_ptr<Impl> first = impl_ ? nullptr : std::make_unique<Impl>();
            Impl &impl = first ? *first : *impl_;
            std::string why = loaded(impl, shader);
            if (!why.empty()) return why;
            if (first) impl_ = std::move(first);
            set(shader.inputs);
            return why;
        },
        [](const Diagnostic &why) { return why.message; });
}

void GlShader::set(const std::vector<ShaderInput> &inputs) {
    if (impl_)
        for (const ShaderInput &input : inputs) set_one(*impl_, input);
}

bool GlShader::draw(int width, int height) {
    return impl_ &&
           in_current([&](const gl::KeptState &kept) { return drawn(*impl_, width, height, kept); },
                      [](const Diagnostic &) { return false; });
}

double GlShader::cached_share() const {
    if (!impl_ || impl_->program || !impl_->drawn) return 0;
    return in_current(
        [&](const gl::KeptState &) {
            const double all = static_cast<double>(impl_->frame.width) * impl_->frame.height;
            return 1 - static_cast<double>(impl_->cache.read_tally().computed) / all;
        },
        [](const Diagnostic &) { return 0.0; });
}

} // namespace fathom::v1
