// fathom compile: a scene's shader, for one of the targets, and the data of its buffer. Nothing is
// written unless all went well.
#include "cli/outputs.h"

#include <fmt/format.h>

namespace fathom::cli {
namespace {

// The noise cache's passes, beside the picture's shader: OUT.frag, OUT.reserve.frag, …
Exit write_passes(const std::string &out, const v1::CachePasses &passes, Terminal &terminal) {
    if (passes.fill.empty()) {
        terminal.say("fathom: no field of this scene is worth keeping; the shader computes all");
        return done;
    }
    const std::pair<const char *, const std::string &> files[] = {{"reserve", passes.reserve},
                                                                  {"fill", passes.fill},
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

template <class T> std::string_view bytes_of(const std::vector<T> &values) {
    return {reinterpret_cast<const char *>(values.data()), values.size() * sizeof(T)};
}

Exit emit(const CompileCommand &command, const v1::CompileResult &result, Terminal &terminal) {
    Exit exit = report(result, terminal);
    if (exit != done) return exit;
    if (overwrites(result.files, command.out, terminal) ||
        overwrites(result.files, command.reflect, terminal, "--reflect"))
        return usage_error;
    const v1::ShaderTarget target = target_named(command.target);
    v1::ShaderOptions options;
    options.target = target.name;
    options.field_only = command.field_only;
    // Only beside a file there is room for the data of a buffer.
    options.buffers = target.buffers && !command.out.empty() && command.out != "-";
    options.title = std::filesystem::path(command.scene.file).stem().string();
    options.noise_cache = command.noise_cache;
    std::vector<v1::Diagnostic> diagnostics;
    const std::optional<v1::Shader> shader = v1::make_shader(*result.scene, options, &diagnostics);
    print_diagnostics(diagnostics, 0, result.texts, terminal);
    if (!shader) return scene_error;
    if (!command.reflect.empty())
        exit = write_result(command.reflect, shader->reflection, terminal);
    if (exit != done) return exit;
    if (!shader->words.empty()) // SPIR-V
        return write_result(command.out, bytes_of(shader->words), terminal);
    if (command.noise_cache) exit = write_passes(command.out, shader->cache, terminal);
    if (exit == done && !shader->tables.empty())
        exit = write_result(command.out + ".tables", bytes_of(shader->tables), terminal);
    return exit == done ? write_result(command.out, shader->text, terminal) : exit;
}

} // namespace

Exit run(const CompileCommand &command, Terminal &terminal) {
    if (overwrites(command.scene.file, command.out, terminal) ||
        overwrites(command.scene.file, command.reflect, terminal, "--reflect") ||
        misnamed(command.out, content_of(target_named(command.target)), terminal))
        return usage_error;
    const auto act = [&](const v1::CompileResult &result) {
        return emit(command, result, terminal);
    };
    v1::CompileOptions options = library_options(command.scene);
    options.cells = cells_of_text;
    if (command.watch) return watch_scene(command.scene, options, terminal, act);
    return act(v1::compile_file(command.scene.file, options));
}

} // namespace fathom::cli
