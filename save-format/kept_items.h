// What `dfmodel.keep(…)` statements brought through the scene, read back for an export. Private to
// save-format.
#pragma once

#include "save-format/yaml_reader.h"

#include <optional>
#include <string>
#include <vector>

namespace fathom::save {

// An item that belongs to a node of the tree.
struct TreeRecord {
    std::string label;             // name, type, properties, group, node, extra
    std::vector<std::size_t> path; // from the root
    Value value;
};

// An item of the main list.
struct MainItem {
    std::string label; // steps, camera, view, setting
    Value value;
};

// All items of an imported file that the language has no words for.
struct KeptItems {
    std::optional<Value> version;
    std::vector<Value> textures, materials, lights;
    std::vector<TreeRecord> tree;
    std::optional<Value> lighting;   // [in the tree, name, {properties}]
    std::vector<MainItem> items;     // behind the tree, in order
    std::vector<std::string> unread; // statements that are none of these
};

// Parses the texts of `keep` statements.
KeptItems read_kept(const std::vector<std::string> &statements);

// A node of the file to be. `given` names and types were in a file; others follow from the scene.
struct TreeNode {
    std::string type, name;
    bool named = false;
    bool plain = false; // the name stood without quotes, so that `~` and `12` are no text
    bool head = false;  // of a group that a record brought back: it counts in no ordinal
    std::vector<Entry> properties;
    std::vector<Entry> varying; // programs by property: what numbers follow
    std::vector<TreeNode> children;
    std::optional<Value> verbatim; // instead of all that
    std::vector<Value> extra;
    std::vector<TreeNode> rest; // while records are applied: the children behind those, last first
};

// Brings groups, names, properties and unknown nodes back, in the order of the records. What no
// longer has a place is returned.
std::vector<const TreeRecord *> apply_records(const std::vector<TreeRecord> &records,
                                              TreeNode &root);

} // namespace fathom::save
