// The YAML save format of DFModel, version 0.3 (docs/save-format.md), both ways: text in, text out.
// Opens no file and knows neither the language's grammar nor its checker: what it imports is
// written as text of the language, what it exports is read from the scene's tree of shapes. libyaml
// is seen in this folder alone.
#pragma once

#include "base/diagnostic.h"
#include "base/limits.h"
#include "ir/scene.h"

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace fathom::save {

// How an import is done.
struct ImportOptions {
    bool strict = false;         // what is wrong in the content is an error, not a warning
    std::size_t max_depth = 256; // of nodes within nodes; deeper is a structural error
    // Parts that cannot be used, by where they begin in the file, and why: what a compiler said of
    // the text that came of them. A solid is left out, a transform or combination unites its
    // children; all are kept for an export.
    std::map<std::uint32_t, std::string> unusable;
    std::string asset_prefix; // put before the relative paths of textures and grids: the way from
                              // the .sdf's folder to the save file's ("../saves/"), empty where
                              // both lie in one folder
};

// The text of the language that a save file became.
struct ImportResult {
    std::string
        sdf; // complete text, also where it holds only what could be read until the structure broke
    bool structural_error =
        false; // broken YAML or a wrong main list: `sdf` is partial, write it only when asked
    std::size_t nodes = 0; // nodes of the scene tree that were read
    // Which part of the file the text stands for from an offset on, in order.
    std::vector<std::pair<std::uint32_t, Span>> parts;
};

// Never fails: what is wrong in the content is reported (`yaml-value`, `yaml-version`: warnings
// unless strict), falls back to its default, and travels on in `dfmodel.keep(…)` statements. A
// broken structure is reported (`yaml-structure`, an error) and ends the reading. One pass; time
// and memory are linear in the text.
ImportResult import_yaml(const Sources &sources, SourceId source, Diagnostics &diagnostics,
                         const ImportOptions &options = {});

// How an export is done.
struct ExportOptions {
    Limits limits;
    // Of a file as the scene found it: its path as seen from the save file's folder, or "" where
    // nobody knows. None: images and grids keep the names that the scene has for them.
    std::function<std::string(const std::string &file)> path_of{};
};

// The scene at the present values of its params and at time 0. What 0.3 cannot say goes out under
// labelled keys and nodes that `import_yaml` reads back; what not even those can say is reported
// (`unsupported`, as a warning, at its place in the scene's text) and left out. Shapes that are
// shared become nodes each time: where that takes more than the limits `work` and `memory` there is
// an error, and no text.
std::string export_yaml(const ir::Scene &scene, Diagnostics &diagnostics,
                        const ExportOptions &options = {});

} // namespace fathom::save
