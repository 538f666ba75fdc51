// fathom compile: a scene's shader, for one of the targets, and the data of its buffer. Nothing is
// written unless all went well.
#include "backend-glsl/reflection.h"
#include "base/text.h"
#include "cli/outputs.h"

#include <fmt/format.h>

namespace fathom::cli {
namespace {

// The noise cache's passes, beside the picture's shader: OUT.frag, OUT.reserve.frag, …
Exit write_passes(const std::string &out, const ir::Scene &scene, const glsl::Options &options,
                  Terminal &terminal) {
    Diagnostics diagnostics; // the picture's own text was good, and these are made of its parts
    const glsl::CachePasses passes = glsl::emit_cache_passes(scene, options, diagnostics);
    if (diagnostics.has_errors()) return scene_error;
    if (passes.fill.text.empty()) {
        terminal.say("fathom: no field of this scene is worth keeping; the shader computes all");
        return done;
    }
    const std::pair<const char *, const std::string &> files[] = {{"reserve", passes.reserve},
                                                                  {"fill", passes.fill.text},
                                                                  {"publish", passes.publish},
                                                                  {"sweep", passes.sweep}};
    for (const auto &[pass, text] : files) {
        std::filesystem::path path(out);
        path.replace_filename(
            fmt::format("{}.{}{}", path.stem().string(), pass, path.extension().string()));
        if (const Exit exit = write_result(path.string(), text, terminal); exit != done)
            return exit;
    }
    return done;
}

// The scene with other values of its params; none where it does not compile with them.
std::optional<ir::Scene> rebuilt(const SceneArguments &scene,
                                 const driver::Compilation &compilation,
                                 const std::map<std::string, double> &values) {
    driver::CompileOptions options = compile_options(scene);
    for (const ir::Param &param : compilation.scene.params) {
        const auto value = values.find(param.name);
        if (value == values.end()) continue;
        const bool truth = param.type == ir::Type::Bool;
        std::erase_if(options.overrides,
                      [&](const driver::Override &o) { return o.name == param.name; });
        options.overrides.push_back({param.name, truth ? (value->second != 0 ? "true" : "false")
                                                       : format_shortest(value->second)});
    }
    const auto again = [&] {
        if (scene.file != "-") return driver::compile_file(scene.file, options);
        std::uint32_t at = 0; // standard input was read to its end, so its text is taken from there
        while (compilation.sources[SourceId{at}].name != "<stdin>") ++at;
        return driver::compile_text("<stdin>", compilation.sources[SourceId{at}].text, "", options);
    };
    driver::Compilation other = again();
    if (!other.good()) return std::nullopt;
    return std::move(other.scene);
}

Exit emit(const CompileCommand &command, const driver::Compilation &compilation,
          Terminal &terminal) {
    Exit exit = report(compilation, command.scene, terminal);
    if (exit != done) return exit;
    if (overwrites(compilation, command.out, terminal) ||
        overwrites(compilation, command.reflect, terminal))
        return usage_error;
    glsl::Options options;
    options.target = command.target;
    options.field_only = command.field_only;
    // Only beside a file there is room for the data of a buffer.
    const glsl::TargetTraits &target = glsl::traits_of(command.target);
    options.buffers = target.buffer_file && !command.out.empty() && command.out != "-";
    options.computed = true;
    options.table_text = 256;
    options.title = std::filesystem::path(command.scene.file).stem().string();
    options.place = [&](Span span) {
        if (!span.source) return std::string();
        const Source &source = compilation.sources[span.source];
        return fmt::format("{}:{}", source.name, position(source, span.begin).line);
    };
    options.noise_cache = command.noise_cache;
    options.rebuild = [&](const std::map<std::string, double> &values) {
        return rebuilt(command.scene, compilation, values);
    };
    Diagnostics diagnostics;
    glsl::note_fixed_params(compilation.scene, options, diagnostics);
    glsl::Output output = glsl::emit(compilation.scene, options, diagnostics);
    print_diagnostics(diagnostics, compilation.sources, terminal);
    if (diagnostics.has_errors()) return scene_error;
    if (!command.reflect.empty())
        exit = write_result(command.reflect,
                            glsl::reflection_json(compilation.scene, options, output), terminal);
    if (exit != done) return exit;
    if (target.form == glsl::Form::SpirV) {
        std::string_view bytes(reinterpret_cast<const char *>(output.words.data()),
                               output.words.size() * sizeof(std::uint32_t));
        return write_result(command.out, bytes, terminal);
    }
    if (command.noise_cache) exit = write_passes(command.out, compilation.scene, options, terminal);
    if (exit == done && !output.tables.empty()) {
        std::string_view texels(reinterpret_cast<const char *>(output.tables.data()),
                                output.tables.size() * sizeof(float));
        exit = write_result(command.out + ".tables", texels, terminal);
    }
    return exit == done ? write_result(command.out, output.text, terminal) : exit;
}

} // namespace

Exit run(const CompileCommand &command, Terminal &terminal) {
    if (overwrites(command.scene.file, command.out, terminal) ||
        misnamed(command.out, content_of(command.target), terminal))
        return usage_error;
    auto act = [&](const driver::Compilation &compilation) {
        return emit(command, compilation, terminal);
    };
    driver::CompileOptions options = compile_options(command.scene);
    options.cells = driver::cells_of_text;
    if (command.watch) return watch_scene(command.scene, options, terminal, act);
    return act(driver::compile_file(command.scene.file, options));
}

} // namespace fathom::cli
