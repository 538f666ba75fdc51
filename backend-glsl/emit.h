// From a lowered scene to shader text, for each target (docs/shaders.md). What is given out has
// been checked by glslang. Sees expressions, functions, folds and tables only; knows no language,
// opens no file, calls no GL.
#pragma once

#include "backend-glsl/targets.h"
#include "base/diagnostic.h"
#include "ir/scene.h"

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace fathom::glsl {

// What a shader tells its host beside the picture. Texts with instruments are for a host of ours
// that sets every uniform: they carry no defaults, so that a number that changed in the scene's
// camera or params changes no text.
enum class Instruments {
    None,
    Pick, // a second output, fathom_pick: (part, t, steps, slope of Scene::shaded at the hit);
          // (0, -1, steps, 0) where the ray hits nothing; the slope is -1 where it is undecided
    Probe // no picture: fathom_pick is, by fathom_mode, what marcher.h says
};

struct Options {
    Instruments instruments = Instruments::None;
    int part_stride = 0;     // ir::Parts::stride, where the scene was lowered with its parts
    Target target{};         // the table's first
    bool field_only = false; // just `float sdf(vec3 p)`, the material function and the bound
    bool buffers = false; // the host binds large tables as the texture buffer `fathom_tables`; else
                          // a formula stands for a table that has one, unless that is short and
                          // the formula dear, and all other data is text
    bool computed = false; // formulas first, also where there is a buffer
    int table_text = 16;   // rows up to which data is text all the same
    bool noise_cache =
        false; // GL 4.2: cached fields worth it are read through the noise cache (cache.h)
    bool pruning =
        false;           // GL 4.3: long loops run over the rows that can matter in a cell (prune.h)
    bool passes = false; // a host of ours draws it by passes (marcher.h), so that a ray may take
                         // as many steps as it needs; not with the noise cache
    bool far_cells = true; // … and rays evaluate no rows where those are known to be far
    double time = 0; // where a target has no host that sets a camera: the moment whose camera is
                     // the first view
    std::string title = "scene"; // html: the page's title
    // html: the scene for other values of its structural params, by name; none where it does not
    // compile. Empty: the page has the scene for its own values alone.
    std::function<std::optional<ir::Scene>(const std::map<std::string, double> &)> rebuild{};
    std::function<std::string(Span)> place{}; // "arch.sdf:12", or an empty text
};

// What a host has to set. Inputs of the frame (camera, time, size) have fixed names, see marcher.h.
struct Uniform {
    std::string name;
    ir::Type type = ir::Type::Float;
    std::uint32_t param = 0; // index into Scene::params
    int location = -1;       // -1 where the text gives none
};

// A uniform as the text declares it: an input of the frame, a param or a sampler.
struct Input {
    std::string type, name;
    std::vector<double> value; // for the scene's first view; of a sampler none
    std::string meaning;       // of an input of the frame: what it is, with its unit
    int place = -1;            // its location, a sampler's binding; -1 where the text gives none
};

struct Sampler {
    std::string name;
    std::uint32_t index = 0; // into Scene::images or Scene::grids
};

// A field that a text with `noise_cache` reads through the cache. The host sets
// fathom_cache_fields[i], i its place in Output::cached, to a number of its own choice below
// max_cache_fields.
struct CachedField {
    std::uint32_t cache = 0;   // index into Graph::caches
    bool wide = false;         // vectors: its values lie in fathom_cache_wide
    std::uint64_t meaning = 0; // equal for fields that compute the same from the same params
    std::vector<std::uint32_t> params; // that it reads
};

// A compute shader that makes the lists of one grid, or the far cells, and its own data.
struct PruneKernel {
    std::string text;
    std::vector<float> tables;
    std::vector<Uniform> uniforms;
    int rows = 0;
    bool reads_time = false;
};

// What a text with `pruning` runs by: cells that fill this box, as many grids of them as kernels.
struct Pruning {
    std::array<double, 3> lo{}, hi{};
    std::vector<PruneKernel> kernels;
    PruneKernel far; // no text where rays are not to look for far cells
};

// How many turns of loops one evaluation of a field takes (turns.h).
struct Turns {
    double all = 0;
    double written_out = 0; // where the driver writes short loops out
};

struct Output {
    std::string text;                 // empty where an error was reported
    std::vector<std::uint32_t> words; // spirv
    std::vector<Uniform> uniforms;    // the params that the text reads
    std::vector<Input> inputs;        // all uniforms, in the text's order
    std::vector<float>
        tables; // RGBA32F texels of `fathom_tables`; empty where the text holds the data
    std::vector<Sampler> images, grids;
    std::vector<CachedField> cached;
    Pruning pruning;
    bool reads_time = false;
    int budget = 0; // steps that a ray may take in all passes (ir::budget_of)
    Turns turns;    // of loops
};

Output emit(const ir::Scene &scene, const Options &options, Diagnostics &diagnostics);

// Notes each param that decides what there is. A text can hold it only as a constant: it has no
// uniform, no slider, no line to edit that would rebuild the scene. Of a page whose scene can be
// rebuilt, not those that it has all values of (page_values).
void note_fixed_params(const ir::Scene &scene, const Options &options, Diagnostics &diagnostics);

// By loop that `pruning` would make lists for: its rows.
std::vector<int> prunable_rows(const ir::Scene &scene);

// The passes that follow a picture drawn by a text with `noise_cache`. Empty where no field is
// cached.
struct CachePasses {
    std::string reserve, publish, sweep, tint; // the same for every scene
    Output fill;
};
CachePasses emit_cache_passes(const ir::Scene &scene, const Options &options,
                              Diagnostics &diagnostics);

} // namespace fathom::glsl
