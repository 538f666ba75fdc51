// What the command line says, as values: one struct a command. Reading the line (arguments.cpp)
// knows nothing of what the commands do, the commands nothing of how the line is written.
#pragma once

#include "backend-glsl/targets.h"
#include "typecheck/check.h"

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace fathom::cli {

// The exit statuses of every command.
enum Exit {
    done = 0,
    scene_error = 1, // the scene (or the save file) has an error; diagnostics are printed
    usage_error = 2, // the command line is wrong
    device_error = 3 // a file named on it, or the device, cannot be used
};

// Whether diagnostics are coloured: where a terminal is, always, or never.
enum class ColorChoice { Auto, Always, Never };

// What every command that reads a scene takes.
struct SceneArguments {
    std::string file;                                   // `-` is standard input
    std::vector<typecheck::Override> overrides;         // -D
    std::vector<std::filesystem::path> include_folders; // -I
    Limits limits;                                      // --limit
    bool strict_proof = false;                          // of check, compile and render
};

// `fathom check`.
struct CheckCommand {
    SceneArguments scene;
    bool json = false, explain = false, watch = false;
};
// `fathom compile`.
struct CompileCommand {
    SceneArguments scene;
    std::string out;       // empty: standard output
    glsl::Target target{}; // the table's first
    bool field_only = false, watch = false;
    bool noise_cache = false; // with the cache's hooks, and its passes beside `out`
};
// What draws a picture: GL where it works, GL, or the CPU.
enum class Backend { Auto, Gl, Cpu };
// `fathom render`.
struct RenderCommand {
    SceneArguments scene;
    std::string out;
    int width = 1280, height = 720;
    Backend backend = Backend::Auto;
    double time = 0;
    std::optional<std::pair<int, int>> frames; // first, one past the last
    double frame_rate = 30;
    int samples = 0;     // a pixel; 0: one, and more where it is rough
    int max_steps = 0;   // evaluations of a ray; 0: what the scene says
    bool strict = false; // a ray left undecided is an error
    int quality = 90;    // of a JPEG
    bool cache = false;  // through the noise cache
};
// `fathom mesh`.
struct MeshCommand {
    SceneArguments scene;
    std::string out;
    double tolerance = 0; // 0: by resolution
    int resolution = 128;
    std::optional<std::array<std::array<double, 3>, 2>> bounds;
    double time = 0;
    bool json = false; // the certificate
};
// `fathom eval`.
struct EvalCommand {
    SceneArguments scene;
    std::vector<std::array<double, 3>> at;
    bool points = false; // more on standard input
    double time = 0;
};
// `fathom view`.
struct ViewCommand {
    SceneArguments scene;
    int width = 1280, height = 800;
    std::string record; // a folder for a picture after every reload
    bool save_view = false, times = false, still = false, one_context = false;
};
// `fathom import`.
struct ImportCommand {
    std::string file, out;
    bool strict = false, partial = false;
};
// `fathom export`.
struct ExportCommand {
    SceneArguments scene;
    std::string out;
};
// `fathom fmt`.
struct FmtCommand {
    std::vector<std::string> files;
    bool check = false;
};
// `fathom doc`.
struct DocCommand {
    std::string name;
}; // empty: the list of all
// `fathom explain`.
struct ExplainCommand {
    std::string code;
}; // empty: the list of all
// `fathom lsp`.
struct LspCommand {};
// `fathom bench`.
struct BenchCommand {
    SceneArguments scene;
    int width = 400, height = 400;
};

using Command = std::variant<CheckCommand, CompileCommand, RenderCommand, MeshCommand, EvalCommand,
                             ViewCommand, ImportCommand, ExportCommand, FmtCommand, DocCommand,
                             ExplainCommand, LspCommand, BenchCommand>;

// A command with the options that all commands share.
struct Invocation {
    ColorChoice color = ColorChoice::Auto;
    Command command;
};

// A line that is answered at once: help, the version, or what is wrong with it.
struct Answer {
    Exit exit = done;
    std::string results, words; // to standard output, to standard error; encoded for a terminal
};

// Reads the command line. An Answer is what to print instead (help, version or a usage error).
std::variant<Invocation, Answer> read_arguments(int count, const char *const *arguments);

class Terminal;
// Each runs one command and returns the exit status of the program.
Exit run(const CheckCommand &, Terminal &);
Exit run(const CompileCommand &, Terminal &);
Exit run(const RenderCommand &, Terminal &);
Exit run(const MeshCommand &, Terminal &);
Exit run(const EvalCommand &, Terminal &);
Exit run(const ViewCommand &, Terminal &);
Exit run(const ImportCommand &, Terminal &);
Exit run(const ExportCommand &, Terminal &);
Exit run(const FmtCommand &, Terminal &);
Exit run(const DocCommand &, Terminal &);
Exit run(const LspCommand &, Terminal &);
Exit run(const ExplainCommand &, Terminal &);
Exit run(const BenchCommand &, Terminal &);

} // namespace fathom::cli
