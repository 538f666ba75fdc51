#include "api/impl.h"

#include "backend-glsl/reflection.h"
#include "ir/passes/cost.h"
#include "ir/view.h"

#include <algorithm>
#include <fmt/format.h>
#include <glm/gtc/type_ptr.hpp>

namespace fathom::v1 {
namespace {

const glsl::Target *target_by_name(std::string_view name) {
    for (const glsl::Target &target : glsl::all_targets())
        if (name == glsl::traits_of(target).name) return &target;
    return nullptr;
}

Texture texture_of(const ir::ImageData &image, std::string name) {
    return {std::move(name), false, image.width, image.height, 1, image.rgba};
}

Texture texture_of(const ir::GridData &grid, std::string name) {
    return {std::move(name), true, grid.size[0], grid.size[1], grid.size[2], grid.values};
}

CachePasses cache_of(const ir::Scene &scene, glsl::CachePasses passes,
                     const std::vector<glsl::CachedField> &fields) {
    const ir::Graph &graph = scene.graph;
    const auto cost = [&](ir::FunctionId f) {
        return f ? ir::cost_of(graph, graph.function(f).result) : 0;
    };
    CachePasses cache{std::move(passes.reserve),
                      std::move(passes.fill.text),
                      std::move(passes.publish),
                      std::move(passes.sweep),
                      {},
                      cost(scene.distance)};
    for (const glsl::CachedField &field : fields) {
        CachedField to{
            field.wide, {}, cost(graph.cache(ir::CacheId{field.cache}).field), field.meaning};
        for (const std::uint32_t param : field.params)
            to.params.push_back(scene.params[param].name);
        cache.fields.push_back(std::move(to));
    }
    return cache;
}

std::optional<Shader> shader_of(const Scene &scene, const ShaderOptions &options,
                                std::vector<Diagnostic> &said) {
    const glsl::Target *target = target_by_name(options.target);
    if (!target) {
        said.push_back(sentence("usage", fmt::format("there is no target `{}`", options.target)));
        return std::nullopt;
    }
    if (options.noise_cache && (!glsl::traits_of(*target).noise_cache || options.field_only)) {
        said.push_back(
            sentence("usage", fmt::format("the noise cache is for whole pictures, and not "
                                          "for the target `{}`",
                                          options.target)));
        return std::nullopt;
    }
    const ir::Scene &ir_scene = ir_of(scene);
    const Sources &sources = scene.impl().compilation->sources;
    glsl::Options to;
    to.target = *target;
    to.field_only = options.field_only;
    to.buffers = options.buffers;
    to.noise_cache = options.noise_cache;
    to.computed = true;
    to.table_text = 256;
    to.time = options.time;
    to.title = options.title;
    to.place = [&](Span span) {
        if (!span.source) return std::string();
        const Source &source = sources[span.source];
        return fmt::format("{}:{}", source.name, position(source, span.begin).line);
    };
    to.rebuild = [&](const std::map<std::string, double> &values) -> std::optional<ir::Scene> {
        std::map<std::string, std::vector<double>> lists;
        for (const auto &[name, value] : values) lists[name] = {value};
        const CompileResult other = scene.with(lists);
        return other.scene ? std::optional(ir_of(*other.scene)) : std::nullopt;
    };
    Diagnostics diagnostics;
    glsl::note_fixed_params(ir_scene, to, diagnostics);
    glsl::Output output = glsl::emit(ir_scene, to, diagnostics);
    for (Diagnostic &diagnostic : translated(diagnostics, sources))
        said.push_back(std::move(diagnostic));
    if (diagnostics.has_errors()) return std::nullopt;
    Shader shader;
    if (options.noise_cache) {
        glsl::CachePasses passes = glsl::emit_cache_passes(ir_scene, to, diagnostics);
        if (diagnostics.has_errors()) {
            said = translated(diagnostics, sources);
            return std::nullopt;
        }
        if (!passes.fill.text.empty())
            shader.cache = cache_of(ir_scene, std::move(passes), output.cached);
    }
    shader.reflection = glsl::reflection_json(ir_scene, to, output);
    shader.text = std::move(output.text);
    shader.words = std::move(output.words);
    shader.tables = std::move(output.tables);
    shader.reads_time = output.reads_time;
    for (const glsl::Uniform &uniform : output.uniforms) {
        const Param &param = scene.params()[uniform.param];
        shader.uniforms.push_back({uniform.name, param.name, param.type, uniform.location});
    }
    for (glsl::Input &input : output.inputs) {
        ShaderInput to{std::move(input.type),
                       std::move(input.name),
                       std::move(input.value),
                       std::move(input.meaning),
                       "",
                       input.place};
        for (const Uniform &uniform : shader.uniforms)
            if (uniform.name == to.name) to.param = uniform.param;
        shader.inputs.push_back(std::move(to));
    }
    for (const glsl::Sampler &sampler : output.images)
        shader.textures.push_back(texture_of(ir_scene.images[sampler.index], sampler.name));
    for (const glsl::Sampler &sampler : output.grids)
        shader.textures.push_back(texture_of(ir_scene.grids[sampler.index], sampler.name));
    return shader;
}

} // namespace

std::vector<std::string> shader_targets() {
    std::vector<std::string> names;
    for (const glsl::Target &target : glsl::all_targets())
        names.emplace_back(glsl::traits_of(target).name);
    return names;
}

std::vector<ShaderTarget> shader_target_table() {
    std::vector<ShaderTarget> all;
    for (const glsl::Target &target : glsl::all_targets()) {
        const glsl::TargetTraits &row = glsl::traits_of(target);
        all.push_back({row.name, row.suffix, row.field_by, row.buffer_file, row.noise_cache});
    }
    return all;
}

std::optional<Shader> make_shader(const Scene &scene, const ShaderOptions &options,
                                  std::vector<Diagnostic> *diagnostics) {
    std::vector<Diagnostic> said;
    std::optional<Shader> shader = guarded([&] { return shader_of(scene, options, said); },
                                           [&](Diagnostic why) {
                                               said.push_back(std::move(why));
                                               return std::optional<Shader>();
                                           });
    if (diagnostics) *diagnostics = std::move(said);
    return shader;
}

std::array<FrameRow, 7> rows_of(ir::View &view, double &orthographic) {
    return {{{"fathom_origin", glm::value_ptr(view.origin), 3},
             {"fathom_right", glm::value_ptr(view.right), 3},
             {"fathom_up", glm::value_ptr(view.up), 3},
             {"fathom_forward", glm::value_ptr(view.forward), 3},
             {"fathom_extent", &view.extent, 1},
             {"fathom_focus", &view.focus, 1},
             {"fathom_orthographic", &orthographic, 1}}};
}

std::vector<ShaderInput> turned_camera(const Shader &shader, double around, double above,
                                       double distance) {
    ir::View view;
    double orthographic = 0;
    std::vector<ShaderInput> camera;
    std::vector<FrameRow> rows_of_it;
    for (const ShaderInput &input : shader.inputs)
        for (const FrameRow &row : rows_of(view, orthographic))
            if (input.name == row.name && input.value.size() == row.count) {
                std::ranges::copy(input.value, row.values);
                camera.push_back(input);
                rows_of_it.push_back(row);
            }
    view.orthographic = orthographic != 0;
    view = ir::turned(view, around, above, distance);
    for (std::size_t i = 0; i < camera.size(); ++i)
        camera[i].value.assign(rows_of_it[i].values, rows_of_it[i].values + rows_of_it[i].count);
    return camera;
}

} // namespace fathom::v1
