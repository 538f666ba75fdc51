// The one facade over the compiler: a file in, a scene and all that is to be said about it out.
// Prints nothing and measures nothing; who wants times listens to the phases.
#pragma once

#include "driver/files.h"
#include "ir/lower/lower.h"
#include "ir/section.h"
#include "proof/bound_cache.h"
#include "proof/present_bounds.h"
#include "save-format/save_format.h"
#include "typecheck/check.h"

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace fathom::driver {

using typecheck::Override;

// The phases of a compilation, in their order; from Check on again where the ranges of params are
// refused and their present values are tried (semantics.md, 25).
enum class Phase { Read, Check, Prove, Lower, Done };

// Cells along a side for what is drawn often (CompileOptions::cells): pictures of files; what is
// seen at once after each change; text of shaders, which holds them as constants.
constexpr int cells_of_pictures = 16, cells_of_views = 12, cells_of_text = 8;

// What a compilation is told besides the text.
struct CompileOptions {
    std::vector<std::filesystem::path> include_folders; // -I
    std::vector<Override> overrides;                    // -D
    Limits limits;                                      // --limit
    std::function<void(Phase)> entered;                 // may be empty
    bool strict_proof = false; // an error at all that is not proved but by the library's claims
    // Proved for the params' present values and from the first to the last of these times alone, in
    // seconds: for what is drawn once; an infinite last one is the end of the scene's. None: for all
    // that the scene allows.
    std::optional<std::pair<double, double>> times;
    // Bounds by cells of what is marched and steep, so many along a side at most (proof/prove.h):
    // for what is drawn. 0: none but those of fields in a region.
    int cells = 0;
    bool present_bounds = false;          // for a host that proves bounds anew while params move
                                          // (proof/present_bounds.h)
    std::optional<ir::Section> section{}; // cut open there, before it is proved
    double flat_thickness = 0;            // as typecheck::Options has it
    std::vector<std::string> fields{};    // too
    // The scene's own text where it is being typed and not saved yet; compile_file reads it in place
    // of the file's.
    std::optional<std::string> unsaved{};
    bool parts =
        false; // lower so that hits tell their parts (ir::lower_with_parts): for the viewer alone
    // Ends behind the check, for who wants the names and their types at once: nothing is proved, and
    // there is no scene.
    bool types_alone = false;
    // What earlier compilations found of fields, for who compiles after each edit; it outlives them.
    // It changes how long a compilation takes and nothing else. None: one for each compilation.
    proof::BoundCache *bounds = nullptr;
    // Asked now and then; where it says yes the compilation ends soon, as `cancelled`. May be empty.
    std::function<bool()> cancelled{};
};

// All that came of a compilation; `scene` is whole only where there are no errors.
struct Compilation {
    Sources sources;
    Diagnostics diagnostics;
    ir::Scene scene;                       // proved and lowered where `good()`, else poisoned
    ir::Parts parts;                       // where they were wanted
    std::vector<std::string> usage_errors; // of the overrides: the command line is wrong
    std::string unreadable;                // why the scene's own file cannot be used, or empty
    std::map<std::filesystem::path, FileStamp>
        files;                                    // all that was read or looked for: what to watch
    std::vector<typecheck::NameFact> names;       // of the scene's own file: types and stages
    std::size_t evaluations = 0, proof_steps = 0; // counted work
    bool cancelled = false; // nobody wanted it any more: no scene, and nothing is said of the text

    bool good() const {
        return !cancelled && unreadable.empty() && usage_errors.empty() &&
               !diagnostics.has_errors();
    }
};

// `file` as the user wrote it; `-` is standard input, whose imports are those of the current
// folder. A save file
// (`.yaml`, `.yml`) is imported first.
Compilation compile_file(const std::filesystem::path &file, const CompileOptions &options);

// Text that is no file (yet): printed as `name`, importing as if it lay in `folder`. Where `name`
// is that of a save file the text is imported first.
Compilation compile_text(std::string name, std::string text, const std::filesystem::path &folder,
                         const CompileOptions &options);

// Text whose imports, images and grids come from `loader`, which gets an empty `from` where the
// text itself names.
Compilation compile_loaded(std::string name, std::string text, const typecheck::Loader &loader,
                           const CompileOptions &options);

// Adds to `import.unusable` what of a save file no compiler takes (a twist of what has no end, a
// grid that is not there), so that an import leaves out that alone. `scene` is where the text will
// stand. Files above 4 MiB are not compiled.
void leave_out_unusable(const std::string &name, const std::string &text,
                        const std::filesystem::path &scene, save::ImportOptions &import);

// What is proved of a scene that was compiled with `present_bounds`, for the values that its params
// have. The cache as in CompileOptions; asked now and then, `stop` ends it with nothing.
std::optional<proof::PresentBounds> prove_present_bounds(const ir::Scene &scene,
                                                         proof::BoundCache &bounds,
                                                         const std::function<bool()> &stop);

// Is some shape so steep that it may be marched by bounds by cells (CompileOptions::cells)?
bool is_steep(const ir::Scene &scene);

// The embedded standard library.
const std::vector<typecheck::LibraryFile> &standard_library();

} // namespace fathom::driver
