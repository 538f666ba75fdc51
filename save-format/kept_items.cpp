// Kept items, read and applied; see kept_items.h and importer.h, where they are written.
#include "save-format/kept_items.h"

#include "base/text.h"
#include "save-format/importer.h"
#include "save-format/node_types.h"

#include <algorithm>

namespace fathom::save {
namespace {

std::optional<std::vector<std::size_t>> path_of(std::string_view text) {
    std::vector<std::size_t> path;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('/'), text.size());
        const auto number = parse_number(text.substr(0, end));
        if (!number || *number < 0 || *number > 1e9) return std::nullopt;
        path.push_back(static_cast<std::size_t>(*number));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return path;
}

TreeNode *node_at(TreeNode &root, const std::vector<std::size_t> &path, std::size_t length) {
    TreeNode *node = &root;
    for (std::size_t i = 0; i < length; ++i) {
        if (path[i] >= node->children.size() || node->children[path[i]].verbatim) return nullptr;
        node = &node->children[path[i]];
    }
    return node;
}

void set_properties(TreeNode &node, const Value &properties) {
    const NodeTypeRow *row = find_node_type(node.type);
    for (const auto &[key, value] : properties.entries) {
        const std::string wanted = spelling_key(key);
        const auto present =
            std::find_if(node.properties.begin(), node.properties.end(),
                         [&](const auto &entry) { return spelling_key(entry.first) == wanted; });
        if (present == node.properties.end()) {
            node.properties.emplace_back(key, value);
            continue;
        }
        // A value that made no sense in the file goes back only where the scene still has the
        // default that stood in.
        const PropertyType *type = row ? find_property(*row, key) : nullptr;
        if (!type) continue;
        const auto number = number_of(present->second);
        bool untouched =
            type->kind == PropertyKind::Carried || (number && *number == type->fallback);
        if (type->kind == PropertyKind::Vector) {
            untouched = std::all_of(
                present->second.entries.begin(), present->second.entries.end(),
                [&](const auto &part) { return number_of(part.second) == type->fallback; });
        }
        if (type->kind == PropertyKind::Word) untouched = present->second.text == type->word;
        if (type->kind == PropertyKind::Material)
            untouched = true; // another name of an equal material, or one that is missing
        if (untouched) present->second = value;
    }
}

bool apply(const TreeRecord &record, TreeNode &root) {
    const Value &value = record.value;
    if (record.label == "node" || record.label == "group") {
        if (record.path.empty()) return false;
        TreeNode *parent = node_at(root, record.path, record.path.size() - 1);
        const std::size_t index = record.path.back();
        if (!parent || index > parent->children.size()) return false;
        const auto at = parent->children.begin() + static_cast<std::ptrdiff_t>(index);
        TreeNode made;
        if (record.label == "node") {
            made.verbatim = value;
            parent->children.insert(at, std::move(made));
            return true;
        }
        if (value.items.size() != 4) return false;
        const auto count = number_of(value.items[0]);
        if (!count || *count < 1 ||
            index + static_cast<std::size_t>(*count) > parent->children.size())
            return false;
        const auto end = at + static_cast<std::ptrdiff_t>(*count);
        made.type = value.items[1].text;
        made.name = value.items[2].text;
        made.named = made.head = true;
        made.properties = value.items[3].entries;
        made.children.assign(std::make_move_iterator(at), std::make_move_iterator(end));
        *at = std::move(made);
        parent->children.erase(at + 1, end);
        return true;
    }
    TreeNode *node = node_at(root, record.path, record.path.size());
    if (!node) return false;
    if (record.label == "name") {
        node->name = value.text;
        node->named = true;
    } else if (record.label == "type") {
        node->type = value.text;
    } else if (record.label == "properties") {
        set_properties(*node, value);
    } else {
        node->extra = value.items;
    }
    return true;
}

} // namespace

KeptItems read_kept(const std::vector<std::string> &statements) {
    KeptItems kept;
    for (const std::string &statement : statements) {
        const std::size_t colon = statement.find(": ");
        const std::string head = statement.substr(0, colon);
        const std::size_t space = head.find(' ');
        const std::string label = head.substr(0, space);
        const auto path =
            path_of(space == std::string::npos ? std::string_view()
                                               : std::string_view(head).substr(space + 1));
        ParsedText parsed = colon == std::string::npos
                                ? ParsedText{}
                                : parse_text(std::string_view(statement).substr(colon + 2));
        if (!parsed.ok || !path) {
            kept.unread.push_back(statement);
            continue;
        }
        Value &value = parsed.value;
        if (label == "version") {
            kept.version = std::move(value);
        } else if (label == "texture") {
            kept.textures.push_back(std::move(value));
        } else if (label == "material") {
            kept.materials.push_back(std::move(value));
        } else if (label == "light") {
            kept.lights.push_back(std::move(value));
        } else if (label == "lighting") {
            kept.lighting = std::move(value);
        } else if (label == "steps" || label == "camera" || label == "view" || label == "setting") {
            kept.items.push_back({label, std::move(value)});
        } else if (label == "name" || label == "type" || label == "properties" ||
                   label == "group" || label == "node" || label == "extra") {
            kept.tree.push_back({label, *path, std::move(value)});
        } else {
            kept.unread.push_back(statement);
        }
    }
    return kept;
}

std::vector<const TreeRecord *> apply_records(const std::vector<TreeRecord> &records,
                                              TreeNode &root) {
    std::vector<const TreeRecord *> homeless;
    for (const TreeRecord &record : records) {
        if (!apply(record, root)) homeless.push_back(&record);
    }
    return homeless;
}

} // namespace fathom::save
