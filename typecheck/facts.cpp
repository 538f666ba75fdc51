// What was found out about the names of a scene: their types, and when each is known. For goldens,
// editors and people who look inside.
#include "typecheck/interpreter.h"

#include <fmt/format.h>

#include <algorithm>

namespace fathom::typecheck {

namespace {

std::string without_article(std::string text) {
    for (std::string_view article : {"a ", "an "})
        if (text.starts_with(article)) return text.substr(article.size());
    return text;
}

std::string signature(const lang::Function &f) {
    std::string text = "(";
    for (std::size_t i = 0; i < f.parameters.size(); ++i)
        text += (i ? ", " : "") + std::string(f.parameters[i].name.text) +
                (f.parameters[i].type ? ": " + type_text(*f.parameters[i].type) : "");
    return text + ")" + (f.result ? " -> " + type_text(*f.result) : "");
}

Stage later(Stage a, Stage b) { return std::max(a, b); }

Stage stage_of_node(const ir::Scene &scene, ir::NodeId id) {
    const ir::Graph::Reads r = scene.graph.reads(id);
    if (r.point || r.normal || r.direction || r.time || r.free_vars) return Stage::Field;
    return r.params ? Stage::Parameter : Stage::Scene;
}

using ShapeStages = std::unordered_map<std::uint32_t, Stage>; // what was found so far
struct Known {
    ShapeStages shapes;
    std::unordered_map<std::uint32_t, Stage> lists; // lists share their parts
};

// Of a shape's numbers, the point apart: every field depends on it.
Stage stage_of_shape(const ir::Scene &scene, ir::ShapeId root, ShapeStages &known) {
    // children are older than what they are parts of, so a list of the ones below, sorted, will do
    std::vector<ir::ShapeId> below, todo{root};
    while (!todo.empty()) {
        ir::ShapeId id = todo.back();
        todo.pop_back();
        if (!known.try_emplace(id.index, Stage::Scene).second) continue;
        below.push_back(id);
        for (ir::ShapeId child : scene.shapes[id].children) todo.push_back(child);
    }
    std::sort(below.begin(), below.end(),
              [](ir::ShapeId a, ir::ShapeId b) { return a.index < b.index; });
    for (ir::ShapeId id : below) {
        Stage stage = Stage::Scene;
        for (ir::NodeId arg : scene.shapes[id].args) {
            const ir::Graph::Reads r = scene.graph.reads(arg);
            stage = later(stage, r.time     ? Stage::Field
                                 : r.params ? Stage::Parameter
                                            : Stage::Scene);
        }
        for (ir::ShapeId child : scene.shapes[id].children)
            stage = later(stage, known[child.index]);
        known[id.index] = stage;
    }
    return known[root.index];
}

Stage stage_of(const Interpreter &ev, const Value &v, Known &known) {
    if (v.kind == ValueKind::Field) return stage_of_node(ev.scene, node_of(v));
    if (v.kind == ValueKind::Shape) return stage_of_shape(ev.scene, shape_of(v), known.shapes);
    if (v.kind != ValueKind::List) return Stage::Scene;
    if (const auto it = known.lists.find(v.id); it != known.lists.end()) return it->second;
    Stage stage = Stage::Scene;
    for (const Value &item : ev.lists[v.id]) stage = later(stage, stage_of(ev, item, known));
    return known.lists[v.id] = stage;
}

} // namespace

std::string type_of(const Interpreter &ev, const Value &v) {
    if (v.kind == ValueKind::Closure) {
        const Closure &c = ev.closures[v.id];
        return signature(c.ast->functions[c.function]);
    }
    return without_article(describe(ev, v));
}

const char *stage_name(Stage stage) {
    switch (stage) {
    case Stage::Scene: return "scene";
    case Stage::Parameter: return "parameter";
    case Stage::Field: return "field";
    }
    return "";
}

std::vector<NameFact> name_facts(const Interpreter &ev, std::uint32_t frame, SourceId source) {
    std::vector<NameFact> facts;
    Known known;
    for (const Binding &b : ev.frames[frame].bindings)
        if (b.declared.source == source)
            facts.push_back({ev.symbol_names[b.name], type_of(ev, b.value),
                             stage_of(ev, b.value, known), b.declared});
    return facts;
}

} // namespace fathom::typecheck
