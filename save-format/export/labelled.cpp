// What stands under labelled keys, so that only this project reads it: said once, as a note.
#include "save-format/export/tree.h"
#include "save-format/node_types.h"

#include <algorithm>
#include <fmt/format.h>

namespace fathom::save {
namespace {

struct Labelled {
    std::map<std::string, int> types;      // labelled nodes
    std::map<std::string, int> properties; // of other nodes
    bool varying = false;
};

// What says no more than the node itself does: the same solid by its true distance, a flat shape
// below a labelled node, the turn whose angles stand beside it.
bool says_more(std::string_view property, const NodeTypeRow &row) {
    return property != "Exact" && property != "Flat" && row.type != NodeType::Rotation;
}

void count(const TreeNode &node, Labelled &found) {
    const NodeTypeRow *row = find_node_type(node.type);
    const bool labelled = row && row->type >= first_labelled && row->type != NodeType::Lighting;
    if (labelled) ++found.types[row->name];
    for (const auto &[key, value] : node.properties) {
        const PropertyType *type = row && !labelled ? find_property(*row, key) : nullptr;
        if (type && type->labelled && says_more(type->name, *row))
            ++found.properties[fmt::format("`{}` of {{}} `{}` node", type->name, row->name)];
    }
    found.varying = found.varying || !node.varying.empty();
    for (const TreeNode &child : node.children) count(child, found);
}

} // namespace

void report_labelled(const ir::Scene &scene, Numbers &numbers, const TreeNode &root,
                     const Value &lighting, Diagnostics &diagnostics) {
    std::string what;
    const auto say = [&](const std::string &text) { what += (what.empty() ? "" : ", ") + text; };
    const auto counted = [](std::size_t n, const std::string &one) {
        return fmt::format("{} {}{}", n, one, (n == 1 ? "" : "s"));
    };
    const ir::RenderSettings usual;
    Labelled found;
    count(root, found);
    if (lighting.items.size() > 2 && lighting.items[2].find("Background")) say("the background");
    if (scene.render.epsilon != usual.epsilon || scene.render.far != usual.far ||
        scene.render.time_end != usual.time_end)
        say("limits of the march");
    if (!scene.lights.empty()) say(counted(scene.lights.size(), "light"));
    if (!scene.params.empty()) say(counted(scene.params.size(), "parameter"));
    if (numbers.moves()) say("motion");
    if (!numbers.words().caches.empty())
        say(counted(numbers.words().caches.size(), "cached field"));
    for (const auto &[type, n] : found.types)
        say(counted(static_cast<std::size_t>(n), "`" + type + "` node"));
    for (const auto &[property, n] : found.properties)
        say(fmt::format(fmt::runtime(property + (n == 1 ? "" : "s")), n));
    if (!what.empty()) {
        Remark(diagnostics,
               Diagnostic{Code::Unsupported,
                          Severity::Note,
                          "under labelled keys, which version 0.3 does not have: " + what,
                          {},
                          {},
                          {},
                          {}})
            .note("`fathom import` reads them back; another reader leaves them out, and has "
                  "parameters and motion at their present values");
    }
    for (const ir::Param &param : scene.params)
        if (param.structural)
            unsaved(diagnostics, param.origin,
                    "`" + param.name +
                        "` decides what shapes there are: the file has those of "
                        "its present value")
                .note("the parameter itself is kept, and moves what follows it otherwise");
}

} // namespace fathom::save
