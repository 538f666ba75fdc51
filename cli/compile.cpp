// fathom compile: a scene's shader, for one of the targets. Nothing is written unless all went well.
#include "backend-glsl/emit.h"
#include "cli/terminal.h"

#include <fmt/format.h>

namespace fathom::cli {
namespace {

Exit emit(const CompileCommand &command, const driver::Compilation &compilation, Terminal &terminal) {
    Exit exit = report(compilation, command.scene, terminal);
    if (exit != done) return exit;
    glsl::Options options;
    options.target = *glsl::target_by_name(command.target);
    options.field_only = command.field_only;
    options.title = std::filesystem::path(command.scene.file).stem().string();
    options.place = [&](Span span) {
        if (!span.source) return std::string();
        const Source &source = compilation.sources[span.source];
        return fmt::format("{}:{}", source.name, position(source, span.begin).line);
    };
    Diagnostics diagnostics;
    glsl::Output output = glsl::emit(compilation.scene, options, diagnostics);
    print_diagnostics(diagnostics, compilation.sources, terminal);
    if (diagnostics.has_errors()) return scene_error;
    if (options.target == glsl::Target::Spirv) {
        std::string_view bytes(reinterpret_cast<const char *>(output.words.data()),
                               output.words.size() * sizeof(std::uint32_t));
        return write_result(command.out, bytes, terminal);
    }
    return write_result(command.out, output.text, terminal);
}

} // namespace

Exit run(const CompileCommand &command, Terminal &terminal) {
    auto act = [&](const driver::Compilation &compilation) { return emit(command, compilation, terminal); };
    if (command.watch) return watch_scene(command.scene, terminal, act);
    return act(driver::compile_file(command.scene.file, compile_options(command.scene)));
}

} // namespace fathom::cli
