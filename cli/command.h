// What the command line says, as values: one struct a command. Reading the line (arguments.cpp)
// knows nothing of what the commands do, the commands nothing of how the line is written.
#pragma once

#include "base/limits.h"

#include <fathom/scene.h>

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
    scene_error = 1,  // the scene (or the save file) has an error; diagnostics are printed
    usage_error = 2,  // the command line is wrong
    device_error = 3, // a file named on it, or the device, cannot be used
    ended = 4         // ended by SIGTERM; what was finished before is kept
};

// Whether diagnostics are coloured: where a terminal is, always, or never.
enum class ColorChoice { Auto, Always, Never };

// A param that `-D name=text` sets; the text is an expression of the language.
struct Definition {
    std::string name, text;
};

// What every command that reads a scene takes.
struct SceneArguments {
    std::string file;                                   // `-` is standard input
    std::vector<Definition> overrides;                  // -D
    std::vector<std::filesystem::path> include_folders; // -I
    Limits limits;                                      // --limit
    std::vector<std::string> limit_words;               // --limit, as written
    bool strict_proof = false;                          // of check, compile and render
};

// `fathom check`.
struct CheckCommand {
    SceneArguments scene; // its file is each of these in turn
    std::vector<std::string> files;
    bool json = false, explain = false, watch = false;
    std::optional<double> time; // the moment that is proved alone, with the params' present values
};
// `fathom compile`.
struct CompileCommand {
    SceneArguments scene;
    std::string out;     // empty: standard output
    std::string reflect; // where what a host has to bind is written; empty: nowhere
    std::string target;  // by name; empty: the table's first
    bool field_only = false, watch = false;
    bool noise_cache = false; // with the cache's hooks, and its passes beside `out`
};
// What draws a picture: GL where it works, GL, or the CPU.
enum class Backend { Auto, Gl, Cpu };
// A param that moves over the frames of a film: `from` at the first, `to` at the last or, without
// `to_last`, where one frame more would be.
struct Sweep {
    std::string name;
    double from = 0, to = 0;
    bool to_last = false;
};
// Frames' numbers, ascending, each once; and the word that said them.
struct FrameList {
    std::string word;
    std::vector<int> numbers;
};
// How pictures go to standard output.
enum class StreamFormat { Png, Pam, Raw };
// How the progress is told on standard error.
enum class ProgressFormat { Bar, Json };
// `fathom render`.
struct RenderCommand {
    SceneArguments scene;
    std::string out;
    int width = 1280, height = 720;
    Backend backend = Backend::Auto;
    double time = 0;
    FrameList frames; // of the film; empty: one picture
    FrameList only;   // those of them that are made; empty: all
    double frame_rate = 30;
    std::vector<Sweep> sweeps;
    int turntable = 0;                        // frames of one turn of the camera; 0: it stays
    std::pair<int, int> sheet;                // columns and rows of a contact sheet; 0: none
    std::optional<v1::Section> section;       // the picture's scene is cut open
    double shutter = 0;                       // how much of a frame's length it is open, 0 to 1
    int first_sample = 0, samples = 0;        // 0 samples: one, and more where a pixel is rough
    bool part_of_samples = false;             // they were given as a range
    std::optional<std::array<int, 4>> region; // x, y, width, height
    std::optional<std::pair<int, int>> tile;  // which of how many bands of rows
    int jobs = 0;                             // threads of the CPU; 0: as many as it has cores
    int max_steps = 0;                        // evaluations of a ray; 0: what the scene says
    bool strict = false;                      // a ray left undecided is an error
    int quality = 90;                         // of a JPEG
    bool alpha = false;                       // no background, but transparent pixels
    bool cache = false;                       // through the noise cache
    bool skip_existing = false;               // files that are whole and the same are kept
    StreamFormat stream = StreamFormat::Png;  // of `-o -`
    ProgressFormat progress = ProgressFormat::Bar;
};
// `fathom merge`.
struct MergeCommand {
    std::vector<std::string> parts; // files; with `frames`, one name with `#`s
    std::string out;
    FrameList frames; // of a film; empty: the parts are of one picture
    double frame_rate = 30;
    int samples = 0; // of the whole picture; 0: up to the last that a part has
    int quality = 90;
};
// `fathom farm`.
enum class Engine { Slurm, Parallel };
struct FarmCommand {
    std::string action;   // slurm, parallel, status or collect
    RenderCommand render; // scene.file: the scene; of status and collect, the job folder
    std::string folder;   // the job folder
    std::string film;     // a film's name in it; empty: frames alone
    int tiles = 1;        // units of one frame
    int chunk = 0;        // frames of a unit; 0: as many as take a minute
    bool dry_run = false; // prints what would be done
    std::vector<std::string> options; // of the engine
};
// A length as it was said: 0.01 of the scene's units, or 0.01mm.
struct Length {
    double number = 0; // 0: none
    std::string unit;  // a word of unit_names(); empty: the scene's
};
// The solid that `mesh`, `measure`, `slice` and `volume` look at, and how finely.
struct SolidArguments {
    SceneArguments scene;
    bool several = false; // it is one of several scenes: documents name it
    bool json = false;    // a document on standard output, also where there is none to make
    bool flat = false;    // its flat shapes, as solids about z = 0
    bool maybe = false;   // `flat` where it has nothing else
    std::string part;     // of the scene, alone; empty: all of it
    Length tolerance;     // the side of the cells; none: by resolution
    int resolution = 128; // cells along the longest side of the solid's box
    std::optional<std::array<std::array<double, 3>, 2>> bounds;
    double time = 0;             // with frames, when frame 0 is
    std::optional<double> until; // the last moment that is looked at; unset: `time`
    FrameList frames;            // a file for each; empty: one
    double frame_rate = 30;
    std::vector<Sweep> sweeps;
    std::string units;               // what a length of 1 is, a word of unit_names(); empty: unsaid
    std::string unsaid = "mm";       // … then: where other lengths have a unit
    std::vector<std::string> fields; // functions of the point that a volume holds; none: distances
};
// `fathom mesh`.
struct MeshCommand {
    SolidArguments solid; // its scene's file is each of these in turn
    std::vector<std::string> files;
    std::string out;             // `{}` stands for the scene's name
    Length simplify;             // a distance; none: no triangles are left out
    bool parts = false;          // each an object of its own
    std::optional<bool> certify; // unset: where a document is wanted
};
// `fathom measure`.
struct MeasureCommand {
    SolidArguments solid;
    std::optional<double> density;
    bool parts = false;                                       // each part, too
    std::vector<std::pair<std::string, std::string>> between; // parts, whose clearance is wanted
};
// `fathom slice`.
struct SliceCommand {
    SolidArguments solid;
    std::string out;                 // `#`s, or %04d, stand for the slice's number
    char axis = 0;                   // x, y or z; 0: none was said
    std::vector<double> heights;     // along it
    int width = 1024, height = 1024; // of a PNG
};
// `fathom volume`.
struct VolumeCommand {
    SolidArguments solid;
    std::string out;
    Length voxel;    // its side; none: by resolution
    double band = 3; // voxels to each side of the surface, of a .vdb
    bool certify = true;
};
// `fathom eval`.
struct EvalCommand {
    SceneArguments scene;
    std::vector<std::array<double, 3>> at;
    std::vector<double> coordinates; // more, three each
    bool points = false;             // more on standard input
    double time = 0;
};
// `fathom view`.
struct ViewCommand {
    SceneArguments scene;
    int width = 1280, height = 800;
    std::string record; // a folder for a picture after every reload
    std::string editor; // a socket
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
    bool check = false, diff = false;
};
// `fathom doc`.
struct DocCommand {
    std::string name;                // empty: the list of all
    std::vector<std::string> search; // the list of the entries that hold these words
    bool json = false;               // all that the language and its library name, for editors
};
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
    bool json = false;
    bool one_bound = false; // without bounds by cells, to compare
    std::string compare;    // a file that --json wrote; empty: none
};

using Command = std::variant<CheckCommand, CompileCommand, RenderCommand, MergeCommand, FarmCommand,
                             MeshCommand, MeasureCommand, SliceCommand, VolumeCommand, EvalCommand,
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
Exit run(const MergeCommand &, Terminal &);
Exit run(const FarmCommand &, Terminal &);
Exit run(const MeshCommand &, Terminal &);
Exit run(const MeasureCommand &, Terminal &);
Exit run(const SliceCommand &, Terminal &);
Exit run(const VolumeCommand &, Terminal &);
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
