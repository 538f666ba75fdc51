#include "driver/compile.h"

#include "driver/edit.h"
#include "driver/framing.h"
#include "driver/scene_files.h"
#include "driver/text_fixes.h"
#include "driver/unproved_ranges.h"
#include "ir/lower/lower.h"
#include "ir/passes/early_exit.h"
#include "ir/passes/operations.h"
#include "ir/passes/verify.h"
#include "proof/prove.h"
#include "proof/rounding.h"
#include "save-format/save_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <new>
#include <utility>

namespace fathom::driver {

// Made at build time from stdlib/*.sdf (cmake/embed.cmake).
const std::vector<std::pair<std::string_view, std::string_view>> &embedded_library();

const std::vector<typecheck::LibraryFile> &standard_library() {
    static const std::vector<typecheck::LibraryFile> library = [] {
        std::vector<typecheck::LibraryFile> files;
        for (auto [name, text] : embedded_library()) {
            // `dfmodel` is imported by name; all others are there from the start.
            bool module = name == "dfmodel.sdf";
            files.push_back({module ? name.substr(0, name.size() - 4) : name, text, !module});
        }
        return files;
    }();
    return library;
}

namespace {

void enter(const CompileOptions &options, Phase phase) {
    if (options.entered) options.entered(phase);
}

// What the attempts at one compilation and their proofs share: what is left of the limits.
struct Effort {
    std::size_t work, evaluations;
    proof::BoundCache &bounds;
    Stop stop;
    std::vector<ir::ShapeId> asked{}; // what prove_one was asked of
};

// What the proof says of one shape while the scene is still being built (`lipschitz(s)`, `taper`).
// Its diagnostics are dropped: the whole scene is proved afterwards, and reports each of them once.
// Takes its steps off the effort's.
std::optional<ir::ShapeFact> prove_one(ir::Scene &scene, ir::ShapeId shape, Effort &effort) {
    Diagnostics discarded;
    proof::Options options;
    options.test_assumptions = false;
    options.work = effort.work;
    options.cache = &effort.bounds;
    options.stop = &effort.stop;
    ir::ShapeId root = std::exchange(scene.root, shape);
    std::vector<ir::TopLevel> top_level = std::exchange(scene.top_level, {{shape, {}}});
    effort.work -= proof::prove(scene, discarded, options);
    effort.asked.push_back(shape);
    scene.root = root;
    scene.top_level = std::move(top_level);
    if (discarded.has_errors()) return std::nullopt;
    return scene.facts[shape.index];
}

typecheck::Options check_options(const CompileOptions &options, Effort &effort) {
    typecheck::Options result;
    result.overrides = options.overrides;
    result.limits = options.limits;
    result.limits.work = effort.evaluations;
    result.flat_thickness = options.flat_thickness;
    result.fields = options.fields;
    result.stop = &effort.stop;
    result.lipschitz = [&effort](ir::Scene &scene, ir::ShapeId shape) -> std::optional<double> {
        std::optional<ir::ShapeFact> fact = prove_one(scene, shape, effort);
        if (!fact || !std::isfinite(fact->lipschitz_sup)) return std::nullopt;
        return fact->lipschitz_sup;
    };
    result.extent = [&effort](ir::Scene &scene, ir::ShapeId shape,
                              int axis) -> std::optional<std::pair<double, double>> {
        std::optional<ir::ShapeFact> fact = prove_one(scene, shape, effort);
        std::size_t i = static_cast<std::size_t>(axis);
        if (!fact || !std::isfinite(fact->bounds.lo[i]) || !std::isfinite(fact->bounds.hi[i]))
            return std::nullopt;
        return std::pair(fact->bounds.lo[i], fact->bounds.hi[i]);
    };
    return result;
}

// `--strict-proof`: what is assumed, estimated or not bounded is an error.
void refuse_unproved(Compilation &out) {
    for (const ir::Axiom &axiom : out.scene.axioms) {
        std::string help;
        switch (axiom.kind) {
        case ir::Axiom::Kind::Library: continue;
        case ir::Axiom::Kind::Assumed: help = "leave `lipschitz:` out, to have it proved"; break;
        case ir::Axiom::Kind::Estimated:
            help = "leave `estimate:` out, or use another shape";
            break;
        case ir::Axiom::Kind::Rounding:
            help = "use smaller numbers and regions, or leave `--strict-proof` out";
            break;
        }
        out.diagnostics
            .add(Code::Unproved, axiom.at,
                 "this is not proved, under `--strict-proof`: " + axiom.says)
            .help(help);
    }
}

// What a picture evaluates.
std::vector<ir::NodeId> roots_of(const ir::Scene &scene) {
    std::vector<ir::NodeId> roots{scene.graph.function(scene.distance).result,
                                  scene.graph.function(scene.hit).result};
    for (const ir::Surface &s : scene.surfaces)
        roots.insert(roots.end(), {s.diffuse, s.specular, s.exponent, s.emission});
    return roots;
}

void cancel(Compilation &out) {
    out.scene = {};
    out.diagnostics = {};
    out.cancelled = true;
}

// What a scene is compiled from, beside the options.
struct Text {
    const typecheck::Loader &loader;
    const std::string &identity;
    SourceId root;
};

// `at_values`: as typecheck::Options has it.
void run_phases(Compilation &out, const Text &text, const CompileOptions &options, Effort &effort,
                const std::vector<Span> &at_values) {
    enter(options, Phase::Check);
    typecheck::Options checks = check_options(options, effort);
    checks.at_values = at_values;
    typecheck::Checked checked =
        typecheck::check(out.sources, text.root, text.identity, standard_library(), text.loader,
                         checks, out.diagnostics);
    if (checked.no_memory) throw std::bad_alloc();
    out.scene = std::move(checked.scene);
    out.usage_errors = std::move(checked.usage_errors);
    out.names = std::move(checked.names);
    effort.evaluations -= std::min(effort.evaluations, checked.evaluations);
    out.evaluations += checked.evaluations;
    if (effort.stop.now()) return cancel(out);
    if (checked.over_limit || options.types_alone) return;
    if (options.section) ir::cut_open(out.scene, *options.section);
    // What checked is proved also where other statements did not: all errors in one run.
    enter(options, Phase::Prove);
    proof::Options proof_options;
    proof_options.work = effort.work;
    proof_options.cache = &effort.bounds;
    proof_options.stop = &effort.stop;
    proof_options.limit_note = limit_note(options.limits, &Limits::proof);
    proof_options.limit_help = limit_help(options.limits, &Limits::proof);
    proof_options.cells = options.cells;
    if (options.times)
        proof_options.times = ir::Interval(
            options.times->first, std::isinf(options.times->second)
                                      ? std::max(options.times->first, out.scene.render.time_end)
                                      : options.times->second);
    effort.work -= proof::prove(out.scene, out.diagnostics, proof_options);
    if (!out.good()) add_text_fixes(out.sources, out.diagnostics);
    out.proof_steps = options.limits.proof - effort.work;
    if (effort.stop.now()) return cancel(out);
    if (out.good()) {
        enter(options, Phase::Lower);
        if (options.present_bounds) proof::add_present_bounds(out.scene);
        if (options.parts)
            out.parts = ir::lower_with_parts(out.scene);
        else
            ir::lower(out.scene);
        if (effort.stop.now()) return cancel(out);
        const ir::Graph &graph = out.scene.graph;
        const Span whole =
            out.scene.top_level.empty() ? Span{text.root, 0, 0} : out.scene.top_level[0].span;
        const std::size_t functions = ir::functions_called(graph, roots_of(out.scene));
        if (functions > options.limits.functions)
            out.diagnostics
                .add(Code::LoopLimit, whole,
                     fmt::format("a shader of this scene would have {} functions", functions))
                .note(limit_note(options.limits, &Limits::functions))
                .note("write those that are alike as one function with an argument")
                .help(limit_help(options.limits, &Limits::functions));
        const double cost = ir::operations(graph, graph.function(out.scene.distance).result);
        if (cost > double(options.limits.point)) {
            out.diagnostics
                .add(Code::LoopLimit, whole,
                     fmt::format("a point of this scene would take {:.0e} operations", cost))
                .note(limit_note(options.limits, &Limits::point))
                .note("look for copies of copies, or loops in loops")
                .help(limit_help(options.limits, &Limits::point));
        } else {
            const ir::Interval times =
                proof_options.times.value_or(ir::Interval(0, out.scene.render.time_end));
            // Which says what a pixel shows.
            find_framing(out.scene, times, options.section, out.diagnostics);
            tell_of_view_inside(out.scene, times.lo, out.diagnostics);
            proof::bound_rounding(out.scene, out.diagnostics, proof_options.times);
        }
        if (options.strict_proof) refuse_unproved(out);
        ir::end_loops_early(out.scene.graph);
        assert(ir::verify(out.scene).empty());
    }
}

// The phases; and again, where the proof refuses the ranges of params, with these at their present
// values, as far as the limits are not spent. What is drawn once is proved for these alone, and
// nothing is said.
void run_phases(Compilation &out, const Text &text, const CompileOptions &options) {
    proof::BoundCache own;
    Effort effort{options.limits.proof, options.limits.work, options.bounds ? *options.bounds : own,
                  Stop(options.cancelled)};
    Compilation again;
    again.sources = out.sources, again.diagnostics = out.diagnostics;
    run_phases(out, text, options, effort, {});
    if (out.cancelled || options.types_alone || !out.diagnostics.has_errors() ||
        (options.strict_proof && !options.times))
        return;
    const std::vector<Span> params = unproved_ranges(out.scene, out.diagnostics, effort.asked);
    if (params.empty()) return;
    again.evaluations = out.evaluations;
    run_phases(again, text, options, effort, params);
    if (again.cancelled) return cancel(out);
    if (!again.good()) return;
    if (!options.times) warn_of_ranges(out.scene, out.diagnostics, params, again.diagnostics);
    out = std::move(again);
}

// The phases, or an error where the system gives no memory for them.
void compile_phases(Compilation &out, const Text &text, const CompileOptions &options) {
    try {
        run_phases(out, text, options);
        if (!out.cancelled) enter(options, Phase::Done);
    } catch (const std::bad_alloc &) {
        out.scene = {};
        out.diagnostics
            .add(Code::MemoryLimit, {text.root, 0, 0},
                 "the system has no memory left for this scene")
            .help(fmt::format("`--limit memory={}` refuses it sooner, with the place",
                              std::max<std::size_t>(1, options.limits.memory / 2)));
    }
}

// Notes the parts of the save file that errors of its text belong to; false where none is new.
bool note_unusable(const Compilation &out, SourceId text, const save::ImportResult &result,
                   std::map<std::uint32_t, std::string> &unusable) {
    bool more = false;
    for (const Diagnostic &d : out.diagnostics.items()) {
        const Span at = d.primary.span;
        if (d.severity != Severity::Error || at.source != text || at.end == 0) continue;
        // the last part that begins before the error's end: that of a chain's last call
        const auto behind = std::upper_bound(
            result.parts.begin(), result.parts.end(), at.end - 1,
            [](std::uint32_t offset, const auto &part) { return offset < part.first; });
        if (behind == result.parts.begin() || !std::prev(behind)->second.source) continue;
        more = unusable.emplace(std::prev(behind)->second.begin, d.message).second || more;
    }
    return more;
}

constexpr std::size_t max_compiled_bytes = std::size_t{4}
                                           << 20; // bytes of a save file that is compiled
constexpr int max_attempts = 32; // at a save file, each without the parts refused before

// A save file stands for the text that an import makes of it; what is to be said of the file itself
// joins the diagnostics. Those parts are left out that no compiler takes, so that the others are not
// lost with them.
Compilation compile_imported(const std::string &name, const std::string &text,
                             const typecheck::Loader &loader, const std::string &identity,
                             save::ImportOptions &import, const CompileOptions &options) {
    for (int attempt = 1;; ++attempt) {
        Compilation out;
        const SourceId save_file = out.sources.add(name, text);
        save::ImportResult result =
            save::import_yaml(out.sources, save_file, out.diagnostics, import);
        const SourceId root =
            out.sources.add(name + " (imported)", std::move(result.sdf), save_file);
        compile_phases(out, {loader, identity, root}, options);
        if (result.structural_error || attempt == max_attempts ||
            !note_unusable(out, root, result, import.unusable))
            return out;
    }
}

// A text whose name is a save file's is imported first.
Compilation compile_source(const std::string &name, std::string text,
                           const typecheck::Loader &loader, const std::string &identity,
                           const CompileOptions &options) {
    if (is_save_file(name)) {
        save::ImportOptions import;
        return compile_imported(name, text, loader, identity, import, options);
    }
    Compilation out;
    const SourceId root = out.sources.add(name, std::move(text));
    compile_phases(out, {loader, identity, root}, options);
    return out;
}

} // namespace

void leave_out_unusable(const std::string &name, const std::string &text,
                        const std::filesystem::path &scene, save::ImportOptions &import) {
    if (text.size() > max_compiled_bytes) return;
    SceneFiles files(scene.parent_path(), {}, {});
    const std::string identity = files.add_root(scene);
    compile_imported(name, text, files.loader(), identity, import, {});
}

Compilation compile_loaded(std::string name, std::string text, const typecheck::Loader &loader,
                           const CompileOptions &options) {
    return compile_source(name, std::move(text), loader, "", options);
}

Compilation compile_text(std::string name, std::string text, const std::filesystem::path &folder,
                         const CompileOptions &options) {
    SceneFiles files(folder, options.include_folders, options.limits);
    const std::string identity = files.add_root(folder / "-");
    Compilation out = compile_source(name, std::move(text), files.loader(), identity, options);
    out.files = files.touched();
    return out;
}

Compilation compile_file(const std::filesystem::path &file, const CompileOptions &options) {
    enter(options, Phase::Read);
    bool standard_input = file == "-";
    Compilation out;
    std::string error;
    SceneFiles files(file.parent_path(), options.include_folders, options.limits);
    if (!standard_input) files.touch(file);
    const std::size_t most = options.limits.source * mebibyte;
    std::optional<std::string> text = options.unsaved  ? options.unsaved
                                      : standard_input ? read_standard_input(most, error)
                                                       : read_file(file, most, error);
    if (!text) {
        out.unreadable = error;
    } else if (standard_input) {
        return compile_text("<stdin>", std::move(*text), "", options);
    } else {
        std::string identity = files.add_root(file);
        out = compile_source(file.string(), std::move(*text), files.loader(), identity, options);
    }
    out.files = files.touched();
    return out;
}

std::optional<proof::PresentBounds> prove_present_bounds(const ir::Scene &scene,
                                                         proof::BoundCache &bounds,
                                                         const std::function<bool()> &stop) {
    Stop asked(stop);
    return proof::prove_present_bounds(scene, &bounds, &asked);
}

bool is_steep(const ir::Scene &scene) {
    return std::ranges::any_of(scene.facts, [](const ir::ShapeFact &fact) {
        return fact.status == ir::ProofStatus::Proved && fact.lipschitz_sup > proof::steep &&
               std::isfinite(fact.lipschitz_sup);
    });
}

} // namespace fathom::driver
