// Kept items, read and applied; see kept_items.h and importer.h, where they are written.
#include "save-format/kept_items.h"

#include "base/text.h"
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

// Records come in the order of the tree, so that the children before a record's place are settled:
// they stand in `children`, the others wait in `rest`, and each is moved once. Thereby the whole is
// linear, where inserting into a long list of children would not be.
void open(TreeNode &node) {
    node.rest.assign(std::make_move_iterator(node.children.rbegin()),
                     std::make_move_iterator(node.children.rend()));
    node.children.clear();
}
void close(TreeNode &node) {
    node.children.insert(node.children.end(), std::make_move_iterator(node.rest.rbegin()),
                         std::make_move_iterator(node.rest.rend()));
    node.rest.clear();
}
void close_all(TreeNode &node) {
    close(node);
    for (TreeNode &child : node.children) close_all(child);
}

// Settles the first `count` children; false where there are not as many.
bool settle(TreeNode &node, std::size_t count) {
    while (node.children.size() < count && !node.rest.empty()) {
        node.children.push_back(std::move(node.rest.back()));
        node.rest.pop_back();
    }
    return node.children.size() >= count;
}

TreeNode *node_at(TreeNode &root, const std::vector<std::size_t> &path, std::size_t length) {
    TreeNode *node = &root;
    for (std::size_t i = 0; i < length; ++i) {
        if (!settle(*node, path[i] + 1) || node->children[path[i]].verbatim) return nullptr;
        node = &node->children[path[i]];
    }
    return node;
}

// A place among the children, everything before it settled and everything behind it waiting.
bool stand_at(TreeNode &node, std::size_t index) {
    if (node.children.size() > index) { // the first record here, or one out of order
        close(node);
        open(node);
    }
    return settle(node, index);
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
        const auto kept = number_of(value);
        bool untouched = type->kind == PropertyKind::Carried ||
                         (number && *number == type->fallback) ||
                         (type->kind == PropertyKind::Whole && number && kept &&
                          *number == std::clamp(*kept, type->minimum, type->maximum));
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
        if (!parent || !stand_at(*parent, index)) return false;
        TreeNode made;
        if (record.label == "node") {
            made.verbatim = value;
        } else {
            const auto count = value.items.size() == 4 ? number_of(value.items[0]) : std::nullopt;
            if (!count || *count < 1 || *count > static_cast<double>(parent->rest.size()))
                return false;
            made.type = value.items[1].text;
            made.name = value.items[2].text;
            made.plain = value.items[2].plain;
            made.named = made.head = true;
            made.properties = value.items[3].entries;
            const auto from = parent->rest.rbegin(),
                       to = from + static_cast<std::ptrdiff_t>(*count);
            made.children.assign(std::make_move_iterator(from), std::make_move_iterator(to));
            parent->rest.resize(parent->rest.size() - static_cast<std::size_t>(*count));
        }
        parent->children.push_back(std::move(made));
        return true;
    }
    TreeNode *node = node_at(root, record.path, record.path.size());
    if (!node) return false;
    if (record.label == "name") {
        node->name = value.text;
        node->named = true;
        node->plain = value.plain;
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
    close_all(root);
    return homeless;
}

} // namespace fathom::save
