// Ast to ir::Scene: names, types, stages, and the evaluation of everything that is scene time. The
// proof is a step of its own (proof). Opens no file: what a scene imports comes through
// the `Loader` that the driver gives.
#pragma once

#include "base/diagnostic.h"
#include "base/limits.h"
#include "base/stop.h"
#include "ir/scene.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace fathom::typecheck {

// An imported text and its identity.
struct LoadedText {
    std::string identity; // equal for the same file however it was named; handed back as `from`
    std::string name;     // as printed in diagnostics
    std::string text;
};
// Why a text cannot be imported, as a sentence.
struct LoadError {
    enum class Reason { NotFound, Outside, Unreadable, TooLarge, TooMuchWork, TooManyPixels };
    Reason reason = Reason::NotFound;
    std::string why; // for people: "no such file", "is not a PNG or JPEG image", …
};

// What an image or a grid may still take, in bytes and steps of scene time; what it took is taken
// off.
struct Room {
    std::size_t bytes = std::size_t(-1), steps = std::size_t(-1), pixels = std::size_t(-1);
};

// Of a name that no system would open; a path is not even made of it.
constexpr std::size_t longest_file_name = 4096; // bytes
std::optional<LoadError> too_long(std::string_view path);

// What a scene may read of the world; paths are as the user wrote them, `from` the identity of the
// file that reads.
struct Loader {
    // Of a file, however it was named; the same of every spelling.
    std::function<std::variant<std::string, LoadError>(const std::string &path,
                                                       const std::string &from)>
        identity;
    std::function<std::variant<LoadedText, LoadError>(const std::string &path,
                                                      const std::string &from)>
        text;
    std::function<std::variant<ir::ImageData, LoadError>(const std::string &path,
                                                         const std::string &from, Room &room)>
        image;
    // `name` of one grid of the file; empty: the only one.
    std::function<std::variant<ir::GridData, LoadError>(
        const std::string &path, const std::string &from, Room &room, const std::string &name)>
        grid;
};

// One embedded file of the standard library. Prelude files are visible everywhere, others by
// `import "name"`.
struct LibraryFile {
    std::string_view name; // "solids.sdf"; of a module "dfmodel"
    std::string_view text;
    bool prelude = true;
};

// `-D name=text`, or a slider's value as text: an expression of scene time.
struct Override {
    std::string name, text;
};

// For `fathom doc` and editors: a public name of the embedded library.
struct LibraryEntry {
    std::string name, signature, doc, file;
    std::string module; // "dfmodel"; empty for what is visible everywhere
};

// The checker calls the analysis for two things while it evaluates: `lipschitz(s)`, and the exact
// extent of a shape along an axis (`taper` without `from:` and `to:`). The driver wires them to the
// proof.
struct Options {
    std::vector<Override> overrides;
    std::function<std::optional<double>(ir::Scene &, ir::ShapeId)> lipschitz;
    std::function<std::optional<std::pair<double, double>>(ir::Scene &, ir::ShapeId, int axis)>
        extent;
    // Above 0: the scene is flat. Its shape2 are what there is, each the middle of a solid as thick
    // as this about z = 0, and solids are refused. 0: it is of solids.
    double flat_thickness = 0;
    // Where params are declared that stand at their present values, as scene time sees them, and not
    // for all of their ranges: they become structural.
    std::vector<Span> at_values{};
    // Functions of the point that are wanted beside the solid, each an expression in the names of
    // the scene's file: Scene::fields.
    std::vector<std::string> fields{};
    Limits limits;        // what the scene may cost before it is refused
    Stop *stop = nullptr; // where it stops, evaluation ends as at a limit, and nothing is reported
};

// When a value is known: while the scene is read, once its parameters are set, or where a point or
// the time is wanted. Of a shape: its latest number but the point.
enum class Stage { Scene, Parameter, Field };
const char *stage_name(Stage stage);
struct NameFact {
    std::string name, type;
    Stage stage = Stage::Scene;
    Span declared;
};

// What checking gives: the scene, and what is known of its names.
struct Checked {
    ir::Scene scene; // without what diagnostics refused; the rest can still be proved
    std::vector<std::string>
        usage_errors;            // overrides that name no param or are out of range: exit 2
    std::vector<NameFact> names; // of the scene's own file, as declared
    std::size_t evaluations = 0; // counted work of scene time
    bool no_memory = false;      // the system gave no more: all else is empty
    bool over_limit = false; // evaluation ended at a limit, which is reported: not worth a proof
};

// `root` is already in `sources`; imported files are added to it. Reports every independent error.
Checked check(Sources &sources, SourceId root, const std::string &root_identity,
              const std::vector<LibraryFile> &library, const Loader &loader, const Options &options,
              Diagnostics &diagnostics);

// The public names of the library with their documentation.
std::vector<LibraryEntry> library_entries(const std::vector<LibraryFile> &library);

// A value that every text sees without an import: `pi`, `X`, `tomato`.
struct LibraryConstant {
    std::string name, type;           // "float", "vec3", "color", …
    std::optional<std::uint32_t> rgb; // of a named colour: 0xrrggbb, sRGB
};
std::vector<LibraryConstant> library_constants(); // sorted by name

} // namespace fathom::typecheck
