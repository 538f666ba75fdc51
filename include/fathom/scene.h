/** @file
 *  A compiled scene: from text or a file to parameters, proved facts and, by the other headers, to
 *  distances, shaders and pictures.
 *
 *  @code
 *  #include <fathom/scene.h>
 *  #include <cstdio>
 *
 *  int main() {
 *      auto result = fathom::compile_text("ball.sdf", "param r = 1 in 0.5..2\nsphere(r)\n");
 *      if (!result) return 1;
 *      const fathom::Scene &scene = *result.scene;
 *      for (const fathom::Param &param : scene.params())
 *          std::printf("%s = %g in %g..%g\n", param.name.c_str(), param.value[0], param.lo[0],
 *                      param.hi[0]);
 *      const auto larger = scene.with({{"r", {1.5}}});
 *      if (!larger) return 1;
 *      const fathom::Facts &facts = larger.scene->facts();
 *      std::printf("bound %g, %s\n", *facts.lipschitz, facts.exact ? "exact" : "a lower bound");
 *      return 0;
 *  }
 *  @endcode
 */
#pragma once

#include <fathom/diagnostic.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fathom::FATHOM_V1 {

using Point = std::array<float, 3>;

/** An axis-aligned box. Its ends may be infinite. */
struct Box {
    Point lo{}, hi{};
};

/** A `param` of a scene. Unused components are 0; truths are 0 and 1. */
struct Param {
    enum class Type { Bool, Int, Float, Vec2, Vec3, Vec4 };
    std::string name, label;
    Type type = Type::Float;
    bool color = false;  /**< a Vec3 that is a linear colour */
    bool ranged = false; /**< `lo` and `hi` are given; else they are infinite */
    bool structural =
        false; /**< it decides what shapes there are, or its range is not proved: setting it compiles anew */
    std::array<double, 4> value{}, initial{}, lo{}, hi{};
};

/** How many numbers of `value` a param of a type has: 1 to 4. */
inline int components(Param::Type type) {
    switch (type) {
    case Param::Type::Bool:
    case Param::Type::Int:
    case Param::Type::Float: return 1;
    case Param::Type::Vec2: return 2;
    case Param::Type::Vec3: return 3;
    case Param::Type::Vec4: return 4;
    }
    return 1;
}

/** How sure a bound is: derived by rule, stated by the scene's author (`within:`, `lipschitz:`), or
 *  estimated from samples (`estimate:`). */
enum class Status { Proved, Assumed, Estimated };

/** What is known of one top-level shape. */
struct ShapeFacts {
    Place at;
    double lipschitz = 0; /**< of its field as written, before it is divided by the bound */
    Status status = Status::Proved;
    bool exact = false; /**< |f(p)| is the distance to the surface; else it never exceeds it */
};

/** What is known of a scene, for all values of its params and all times that it covers. */
struct Facts {
    std::optional<double> lipschitz; /**< the largest of the shapes'; none without a shape */
    Status status = Status::Proved;  /**< the least sure of the shapes' */
    bool exact = false;              /**< all shapes are */
    std::optional<Box> bounds;       /**< holds all solids; none where one has no end */
    double time_end = 0;             /**< the facts hold for times in [0, time_end], in seconds */
    std::vector<ShapeFacts> shapes;
    /** What the bound rests on beside the proof: "sphere: exact" (docs/trusted.md). */
    std::vector<std::string> axioms;
    bool reads_time = false; /**< the distance depends on the time */
};

/** Whether facts hold at a time, in seconds: at any where the distance does not depend on it. */
inline bool hold_at(const Facts &facts, double time) {
    return std::isfinite(time) && (!facts.reads_time || (time >= 0 && time <= facts.time_end));
}

/** The bytes of the file that a scene names (by import, image or grid), or nothing. `path` is
 *  relative to the scene's text, with `/`, without `..`. */
using FileProvider = std::function<std::optional<std::string>(const std::string &path)>;

/** What compilations found of fields, for the next ones: who compiles a text again and again, as it
 *  is edited, gives the same one each time, and only what the edit touches is proved anew. A scene
 *  and what is said of it do not depend on it. A handle: copies share what they hold; any number of
 *  threads may use one. Default-made it is none. */
class FATHOM_API ProofCache {
  public:
    ProofCache() = default;
    /** An empty one, of at most so many bytes; what was not wanted for longest goes first. */
    static ProofCache of_bytes(std::size_t most = std::size_t{32} << 20);

    /** How many bounds were not in it when they were wanted, and how many bytes it holds. 0 of none. */
    std::size_t searches() const;
    std::size_t bytes() const;

    struct Impl;
    const std::shared_ptr<Impl> &impl() const { return impl_; } // of the library's own use

  private:
    std::shared_ptr<Impl> impl_;
};

/** What a compilation does at present: reads the text, evaluates it, proves its bounds, makes the
 *  functions that are evaluated. Check and Prove come again where a param's range is refused and its
 *  present value is tried. */
enum class Phase { Read, Check, Prove, Lower, Done };

/** What is kept of a scene that is cut open: what lies between two planes across an axis, each in the
 *  scene's units. An infinite one cuts nothing off. */
struct Section {
    int axis = 2; /**< 0 to 2: x to z */
    double from = -std::numeric_limits<double>::infinity();
    double to = std::numeric_limits<double>::infinity();
};

struct CompileOptions {
    /** Folders where imports are looked for, after the scene's own. */
    std::vector<std::filesystem::path> include_folders;
    /** Params set by expressions of the language, as `-D name=text` does. */
    std::map<std::string, std::string> definitions;
    /** What a scene may cost, as `--limit NAME=VALUE` says it (docs/limits.md): by name, in units of
     *  the limit. A name that there is not is an error, with the code `usage`. */
    std::map<std::string, std::string> limits;
    /** Where named files come from. None: the file system. With one, no file is opened. */
    FileProvider files;
    /** What earlier compilations found. */
    ProofCache cache;
    /** Asked about once a millisecond, by the thread that compiles; where it says yes the compilation
     *  ends within some milliseconds, with the one error `cancelled`. Forgotten once it has ended. */
    std::function<bool()> cancelled;
    /** Told as each phase begins, by that thread. Forgotten, too. */
    std::function<void(Phase)> entered;
    /** A bound that is not proved, but assumed or estimated, is an error. What the library states of
     *  its own shapes is no such bound. */
    bool strict_proof = false;
    /** None: the facts hold for all values that the params' ranges and the scene's times allow. Else
     *  for the params' present values and from the first to the second of these times alone, in
     *  seconds: for what is drawn once. An infinite second one is the end of the scene's times. */
    std::optional<std::array<double, 2>> times;
    /** For what is drawn: bounds by cells of what is steep, at most so many cells along a side, 4 or
     *  more. A field then takes longer steps, and a compilation longer. The program takes 16 for
     *  pictures and 8 for texts of shaders, which hold the cells. 0: none. */
    int cells = 0;
    /** Cut open, for pictures of what is inside: the solid is the part that is kept, and the faces of
     *  the cut are orange. Facts are those of that part. */
    std::optional<Section> section;
    /** Above 0: the scene is a drawing. Its flat shapes (`shape2`), which else are an error, are what
     *  there is, as solids that thick about z = 0: `slice` at z = 0 gives their outlines. Solids are
     *  an error then. */
    double flat_thickness = 0;
    /** Functions of the point that volumes hold (`VolumeOptions::field`), each an expression in the
     *  names of the scene's file: `density`, or `p => noise(4 * p)`. They give a float or a vec3; what
     *  they give is no part of the solid, and nothing is proved of it. */
    std::vector<std::string> fields;
};

struct CompileResult;

/** A scene that compiled. A value: copies share what never changes; any number of threads may use
 *  one. It takes as much memory as its expressions, images and grids. */
class FATHOM_API Scene {
  public:
    const std::vector<Param> &params() const;
    const Facts &facts() const;

    /** The same scene with other values: by name, as many components as the param has. A name that
     *  there is not, a value out of its range or no number is an error, with the code `usage`.
     *  Structural params compile the text again, and may fail as a compilation does. */
    CompileResult with(const std::map<std::string, std::vector<double>> &values) const;

    struct Impl;
    explicit Scene(std::shared_ptr<const Impl> impl);
    const Impl &impl() const { return *impl_; } // of the library's own use

  private:
    std::shared_ptr<const Impl> impl_;
};

/** A name that the scene's own text declares, and what it stands for: "float", "shape", "function". */
struct Name {
    std::string name, type;
    Place at;
};

/** `scene` is there if and only if no diagnostic is an error. `names` are there in both cases. */
struct CompileResult {
    std::optional<Scene> scene;
    std::vector<Name> names;                  /**< as declared */
    std::vector<Diagnostic> diagnostics;      /**< by place */
    std::vector<std::filesystem::path> files; /**< read or looked for (fathom/watch.h) */
    std::size_t dropped = 0;                  /**< diagnostics beyond the most that are kept */
    Texts texts{};                            /**< that the places lie in */
    explicit operator bool() const { return scene.has_value(); }
};

/** Compiles a `.sdf` file or a save file (`.yaml`, `.yml`); `-` is standard input. Never throws: a
 *  file that cannot be read is a diagnostic (`unreadable`), and so is a lack of memory (`memory`). */
FATHOM_API CompileResult compile_file(const std::filesystem::path &file,
                                      const CompileOptions &options = {});

/** Compiles text. `name` is what diagnostics call it; where it ends in `.yaml` or `.yml` the text
 *  is a save file. Imports are relative to the current folder unless `options.files` is given. */
FATHOM_API CompileResult compile_text(std::string_view name, std::string_view text,
                                      const CompileOptions &options = {});

/** The verdict on a scene as the JSON document that `fathom check --json` prints (docs/cli.md), with
 *  a line end. Empty of a result that no compilation of a text gave, and without memory for it. */
FATHOM_API std::string verdict_json(const CompileResult &result);

/** The text in the one form that `fathom fmt` gives it, or nothing where it cannot be parsed. */
FATHOM_API std::optional<std::string> format_text(std::string_view text);

/** The same, with what is to be said of a text that cannot be parsed. */
struct Formatted {
    std::optional<std::string> text;
    std::vector<Diagnostic> diagnostics;
    std::size_t dropped = 0; /**< diagnostics beyond the most that are kept */
    Texts texts{};
};
FATHOM_API Formatted format_text(std::string_view name, std::string_view text);

/** A function of the standard library. A name may have several entries. */
struct LibraryEntry {
    std::string name, signature, doc;
    std::string module; /**< to be imported; empty for what is visible everywhere */
    std::string file;   /**< of the library that defines it; empty of what is built in */
};
FATHOM_API std::vector<LibraryEntry> library_entries();

/** "0.1.0" */
FATHOM_API std::string_view version();

} // namespace fathom::FATHOM_V1
