// What the parts of the importer share while one file is read: the reader, the text written so far,
// the names given, and the items to keep. Private to save-format.
#pragma once

#include "save-format/node_types.h"
#include "save-format/program.h"
#include "save-format/save_format.h"
#include "save-format/sdf_text.h"
#include "save-format/yaml_reader.h"

#include <array>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace fathom::save {

// One `dfmodel.keep("label path: value")`. Records of the tree stand in the order of the tree,
// parents first, and their paths ("0/2": the third child of the root's first) are those of the
// file: applied in that order to what an export makes of the scene, they give the file's tree again
// (kept_items.h).
struct KeptRecord {
    std::string label;
    std::string path;
    std::string flow;
    Span verbatim;       // instead of `flow`: a node as it stands in the file
    bool filled = false; // a place that was held for a record which was not needed
};

// One property as it was read.
struct Property {
    bool given = false; // and legal
    double number[3] = {};
    std::string word;
    Value tree;
};

// The properties of one node, with what was unknown.
struct Properties {
    std::vector<Property> values; // as in the node type's row
    Value varying;                // programs by property: what numbers follow
    std::string unknown;          // flow entries that go on unread: "Foo: 1, Bar: [2]"
    void keep(std::string_view key, std::string_view flow);
};

// A material of the file and its name in the text.
struct MaterialInfo {
    std::string identifier;
    bool twin =
        false; // another one before it looks the same, and the scene does not tell them apart
    std::string displacement; // a call `displace_map(…)`, empty for none
};

// The state of one import.
struct Importer {
    Importer(const Sources &sources, SourceId source, Diagnostics &diagnostics,
             const ImportOptions &options);

    const Source &source;
    SourceId source_id;
    const ImportOptions &options;
    Report report;
    YamlReader reader;
    Names names;
    std::string out; // complete statements
    std::vector<KeptRecord> kept;
    std::unordered_map<std::string, std::string> textures; // name -> identifier
    std::unordered_map<std::string, MaterialInfo> materials;
    std::unordered_map<std::string, std::string>
        looks;                         // a material as it is written -> the first of that look
    std::vector<std::string> scene;    // what the root's children are called, or say
    std::vector<std::string> settings; // camera, lights, lighting, render
    bool lighting_seen = false;
    std::size_t nodes = 0;
    std::array<int, 64>
        ordinals{};     // base nodes by type so far, for the names that an export would give
    Words words;        // parameters and cached fields, by their names in programs
    std::string limits; // of the march, as further arguments of `render(…)`
    std::string camera; // one that moves, in place of the first view's

    // Leave the reader after the item that `first` begins.
    void read_textures(const Event &first);
    void read_materials(const Event &first);
    void read_tree(const Event &first);
    void read_lighting(bool in_tree); // after the type
    void keep(std::string label, std::string path, std::string flow);

    // The rest of a list of which something was read already; `flow` ends up with its closing
    // bracket.
    void rest_of_sequence(std::string &flow);
    // One property of the row, or an unknown one.
    void read_property(const NodeTypeRow &row, const Event &key, Properties &properties,
                       std::string_view of);
    std::string text_of_asset(const std::string &file) const;
    // The root's labelled lists, and what the lighting says beside the light.
    void read_parameters(const Value &list);
    void read_caches(const Value &list);
    void read_surroundings(const Properties &properties, Span at);
    // The expression that a number follows, by its name in `Varying`; empty for none.
    std::string formula(const Value &varying, std::string_view name, Span at);
};

} // namespace fathom::save
