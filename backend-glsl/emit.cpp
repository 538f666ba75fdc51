// The runs that an output takes: the scene's loops rerolled, its cells' kernels, its text, the check.
#include "backend-glsl/emit.h"

#include "backend-glsl/check.h"
#include "backend-glsl/html.h"
#include "backend-glsl/inputs.h"
#include "backend-glsl/picture.h"
#include "backend-glsl/prune.h"
#include "backend-glsl/reroll.h"
#include "backend-glsl/turns.h"
#include "ir/view.h"

#include <algorithm>
#include <cmath>

namespace fathom::glsl {

namespace {

// The first shape that reads an image or a grid, as its user wrote it; no source where none does.
Span reads_sampler(const ir::Scene &scene) {
    const ir::Graph &graph = scene.graph;
    std::vector<bool> reads(graph.size()); // arguments, and what a call calls, stand before it
    for (std::size_t i = 0; i < graph.size(); ++i) {
        const ir::Node &node = graph[ir::NodeId{i}];
        const auto of = [&](ir::NodeId id) { return id && id.index < i && reads[id.index]; };
        reads[i] =
            node.op == ir::Op::Image || node.op == ir::Op::Grid ||
            std::ranges::any_of(graph.args(ir::NodeId{i}), of) ||
            (node.op == ir::Op::Call && of(graph.function(ir::FunctionId{node.payload}).result));
    }
    const auto read = [&](ir::NodeId id) { return id && reads[id.index]; };
    for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
        const ir::Shape &s = scene.shapes[ir::ShapeId{i}];
        const bool paints = s.kind == ir::ShapeKind::Paint || s.kind == ir::ShapeKind::Repaint;
        const ir::Material *m = paints ? &scene.shapes.materials[s.payload] : nullptr;
        if (s.origin.source &&
            (std::ranges::any_of(s.args, read) || (m && (read(m->diffuse) || read(m->specular) ||
                                                         read(m->exponent) || read(m->emission)))))
            return s.origin;
    }
    return {};
}

class Emitter {
  public:
    Emitter(const ir::Scene &scene, const std::optional<Rerolled> &loops, const Options &options,
            Diagnostics &diagnostics)
        : scene_(loops ? loops->scene : scene), options_(options),
          diagnostics_(diagnostics), module_{scene_, options} {
        if (loops) module_.results = loops->results;
    }

    Emitter(const ir::Scene &scene, const std::map<std::uint32_t, ir::NodeId> &results,
            const Options &options, Diagnostics &diagnostics)
        : Emitter(scene, std::nullopt, options, diagnostics) {
        module_.results = results;
    }

    void use(const PrunePlan &plan) { module_.pruned = plan.loops; }
    void use_far_cells() { module_.far_cells = true; }
    void split_endless_parts() { module_.around = static_cast<bool>(scene_.endless); }

    // What lists the rows of one grid's cells.
    PruneKernel run_kernel(const PrunedLoop &loop) {
        const std::vector<ir::FunctionId> wanted{loop.value, loop.start, loop.joined, loop.radius};
        const SceneText scene = assemble_functions(module_, wanted);
        const auto name = [&](ir::FunctionId id) { return module_.functions.at(id.index); };
        Output output = gathered();
        PruneKernel kernel{"", output.tables, output.uniforms, loop.rows, output.reads_time};
        const std::string text = "#version 430 core\n" + written_by(options_) + "\n" +
                                 Inputs(module_).of_field() + scene.tables + scene.functions +
                                 prune_kernel(loop, {name(loop.value), name(loop.start),
                                                     name(loop.joined), name(loop.radius)});
        if (check(text, output, Stage::Compute)) kernel.text = text;
        return kernel;
    }

    // What makes the far cells of a scene that reads nothing but tables, params and the time.
    PruneKernel run_far() {
        const SceneText scene = assemble_functions(module_, {&scene_.distance, 1});
        Output output = gathered();
        if (!output.images.empty() || !output.grids.empty()) return {};
        PruneKernel kernel{"", output.tables, output.uniforms, 0, output.reads_time};
        const std::string text = "#version 430 core\n" + written_by(options_) + "\n" +
                                 Inputs(module_).of_field() + prune_look_up(scene_.bounds) +
                                 scene.tables + scene.functions +
                                 far_kernel(module_.functions.at(scene_.distance.index));
        if (check(text, output, Stage::Compute)) kernel.text = text;
        return kernel;
    }

    // The fields that a text with the noise cache keeps, as a text of their own that ends in
    // `tail`.
    Output run_fields(const std::vector<std::uint32_t> &caches) {
        std::vector<ir::FunctionId> fields;
        for (std::uint32_t id : caches) fields.push_back(scene_.graph.cache(ir::CacheId{id}).field);
        const SceneText scene = assemble_functions(module_, fields);
        std::vector<CachedText> cached;
        for (std::size_t i = 0; i < caches.size(); ++i)
            cached.push_back({module_.functions.at(fields[i].index),
                              scene_.graph[scene_.graph.function(fields[i]).result].type,
                              scene_.graph.cache(ir::CacheId{caches[i]}).cell,
                              scene_.caches[caches[i]].slope});
        Output output = gathered();
        output.text = "#version 420 core\n" + written_by(options_) + "\n" +
                      Inputs(module_).of_field() + scene.tables + scene.functions +
                      cache_fill(cached);
        if (!check(output.text, output)) return {};
        return output;
    }

    Output run() {
        const SceneText scene =
            assemble(module_, !options_.field_only && options_.instruments != Instruments::Probe);
        Output output = gathered();
        for (const auto &[id, field] : module_.cached) output.cached.push_back(cached_field(id));
        const TargetTraits &target = traits_of(options_.target);
        if ((!module_.images.empty() || !module_.grids.empty()) && !target.samplers) {
            std::string others;
            for (const Target other : all_targets())
                if (traits_of(other).samplers)
                    others +=
                        std::string(others.empty() ? "`" : ", `") + traits_of(other).name + "`";
            diagnostics_
                .add(Code::Unsupported, reads_sampler(scene_),
                     std::string("images and grids cannot be put into a text for `") + target.name +
                         "`")
                .help("write the text for a target whose host binds them: " + others +
                      "; or paint and shape by a function of the point");
            return {};
        }

        std::string text = options_.field_only ? field_text(module_, scene, output.inputs)
                                               : picture_text(module_, scene, output.inputs);
        for (Uniform &uniform : output.uniforms)
            for (const Input &input : output.inputs)
                if (input.name == uniform.name) uniform.location = input.place;
        if (!check(text, output)) return {};
        if (!module_.cached.empty() &&
            (!check(with_cache(text), output) || !check(with_cache(text, cache_learns), output)))
            return {};
        if (target.form != Form::SpirV) output.text = std::move(text);
        return output;
    }

  private:
    Output gathered() const {
        Output output;
        output.tables = module_.texels;
        output.reads_time = module_.reads_time;
        output.budget = ir::budget_of(scene_);
        output.turns = turns_of(module_);
        for (const auto &[index, name] : module_.params)
            if (!is_fixed(scene_.params[index], options_))
                output.uniforms.push_back({name, scene_.params[index].type, index, -1});
        for (const auto &[index, name] : module_.images) output.images.push_back({name, index});
        for (const auto &[index, name] : module_.grids) output.grids.push_back({name, index});
        return output;
    }

    // A field's meaning is all that its own text says, and the data that the text only names.
    CachedField cached_field(std::uint32_t id) const {
        Options plain;
        Module alone{scene_, plain};
        alone.results = module_.results;
        const ir::FunctionId field = scene_.graph.cache(ir::CacheId{id}).field;
        const SceneText text = assemble_functions(alone, {&field, 1});
        CachedField cached;
        cached.cache = id;
        cached.wide = module_.cached.at(id).type != ir::Type::Float;
        cached.meaning = 14695981039346656037u; // FNV-1a, 64 bits
        const auto mix = [&](const void *data, std::size_t size) {
            for (std::size_t i = 0; i < size; ++i)
                cached.meaning =
                    (cached.meaning ^ static_cast<const unsigned char *>(data)[i]) * 1099511628211u;
        };
        mix(text.tables.data(), text.tables.size());
        mix(text.functions.data(), text.functions.size());
        mix(&module_.cached.at(id).cell, sizeof(double));
        for (const auto &[index, name] : alone.images) {
            const ir::ImageData &image = scene_.images[index];
            mix(&image.width, sizeof image.width);
            mix(image.rgba.data(), image.rgba.size() * sizeof(float));
        }
        for (const auto &[index, name] : alone.grids) {
            const ir::GridData &grid = scene_.grids[index];
            mix(grid.size.data(), sizeof grid.size);
            mix(grid.values.data(), grid.values.size() * sizeof(float));
        }
        for (const auto &[index, name] : alone.params) cached.params.push_back(index);
        return cached;
    }

    bool check(const std::string &text, Output &output, Stage stage = Stage::Fragment) {
        return good_text(text, stage, options_, output.words, diagnostics_);
    }

    const ir::Scene &scene_;
    const Options &options_;
    Diagnostics &diagnostics_;
    Module module_;
};

// The box of a scene's cells: larger than its bounds by what shading samples around.
Pruning grid_of(const ir::Scene &scene) {
    Pruning grid;
    double diagonal = 0;
    for (std::size_t i = 0; i < 3; ++i)
        diagonal +=
            (scene.bounds.hi[i] - scene.bounds.lo[i]) * (scene.bounds.hi[i] - scene.bounds.lo[i]);
    const double by = 0.05 * std::sqrt(diagonal); // occlusion: 0.08 of half the diagonal
    for (std::size_t i = 0; i < 3; ++i) {
        grid.lo[i] = scene.bounds.lo[i] - by;
        grid.hi[i] = scene.bounds.hi[i] + by;
    }
    return grid;
}

} // namespace

CachePasses emit_cache_passes(const ir::Scene &scene, const Options &options,
                              Diagnostics &diagnostics) {
    std::vector<std::uint32_t> caches;
    for (const CachedField &field : emit(scene, options, diagnostics).cached)
        caches.push_back(field.cache);
    if (caches.empty()) return {};
    Options direct = options;
    direct.noise_cache = false;
    const std::optional<Rerolled> loops = rerolled(scene);
    return {cache_reserve(), cache_publish(), cache_sweep(), cache_tint(),
            Emitter(scene, loops, direct, diagnostics).run_fields(caches)};
}

std::vector<int> prunable_rows(const ir::Scene &scene) {
    const std::optional<Rerolled> loops = rerolled(scene);
    const auto plan = loops ? plan_pruning(loops->scene, loops->results) : plan_pruning(scene, {});
    std::vector<int> rows;
    if (plan)
        for (const PrunedLoop &loop : plan->grids) rows.push_back(loop.rows);
    return rows;
}

// A page around the text of the scene, and the texts for other values of its structural params.
static Output emit_page(const ir::Scene &scene, const Options &options, Diagnostics &diagnostics) {
    Options by_passes = options; // the page is a host of ours
    by_passes.passes = true;
    std::vector<PageVariant> variants;
    const std::vector<std::map<std::string, double>> all =
        options.rebuild ? page_values(scene) : std::vector<std::map<std::string, double>>(1);
    Output own;
    for (const std::map<std::string, double> &values : all) {
        const bool first = variants.empty();
        std::optional<ir::Scene> other = first ? std::nullopt : options.rebuild(values);
        Diagnostics said;
        Output output;
        if (first || other)
            output = emit(first ? scene : *other, by_passes, first ? diagnostics : said);
        if (output.text.empty() && first) return output;
        if (first) own = output;
        if (output.text.empty())
            diagnostics.add(Code::FixedParam, scene.params.front().origin,
                            "the page has no picture for " + words_of(scene, values) +
                                ": the scene does not compile for that");
        else
            variants.push_back(page_variant(other ? *other : scene, by_passes, output, values));
    }
    own.text = html_page(options, variants);
    return own;
}

Output emit(const ir::Scene &scene, const Options &options, Diagnostics &diagnostics) {
    if (traits_of(options.target).form == Form::Page && !options.passes && !options.field_only)
        return emit_page(scene, options, diagnostics);
    std::optional<Rerolled> loops = rerolled(scene);
    if (loops) loops->scene.safe_radius = {}; // it would have the lists in full
    const std::map<std::uint32_t, ir::NodeId> results =
        loops ? loops->results : std::map<std::uint32_t, ir::NodeId>{};
    std::optional<PrunePlan> plan =
        options.pruning ? plan_pruning(loops ? loops->scene : scene, results) : std::nullopt;
    if (plan) plan->scene.safe_radius = {};
    if (!plan) return Emitter(scene, loops, options, diagnostics).run();
    Pruning pruning = grid_of(scene);
    Options direct = options;
    direct.noise_cache = false;
    for (const PrunedLoop &loop : plan->grids) {
        pruning.kernels.push_back(
            Emitter(plan->scene, results, direct, diagnostics).run_kernel(loop));
        if (pruning.kernels.back().text.empty()) return {};
    }
    if (options.far_cells) {
        Emitter cells(plan->scene, results, direct, diagnostics);
        cells.use(*plan);
        pruning.far = cells.run_far();
    }
    if (diagnostics.has_errors()) return {};
    Emitter picture(plan->scene, results, options, diagnostics);
    picture.use(*plan);
    if (options.far_cells) picture.split_endless_parts();
    if (!pruning.far.text.empty()) picture.use_far_cells();
    Output output = picture.run();
    if (!output.text.empty()) output.pruning = std::move(pruning);
    return output;
}

} // namespace fathom::glsl
