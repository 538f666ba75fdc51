// One node a shape. Unions dissolve among siblings that are united anyway, and what changes nothing
// is left out: so the importer can foretell the nodes that its own text will give
// (import/tree.cpp), and record the rest.
#include "save-format/export/tree.h"

#include "ir/passes/inline.h"
#include "ir/passes/walk.h"
#include "save-format/export/appearance.h"
#include "save-format/export/tree_writer.h"
#include "save-format/program.h"

#include <algorithm>
#include <fmt/format.h>

namespace fathom::save {

Budget::Budget(const Limits &limits, Diagnostics &diagnostics)
    : limits_(limits), diagnostics_(diagnostics) {}

bool Budget::take(std::size_t steps, std::size_t bytes) {
    steps_ += steps;
    bytes_ += bytes;
    if (spent_) return false;
    const auto refuse = [&](Code code, const char *what, std::size_t Limits::*limit) {
        spent_ = true;
        diagnostics_.add(code, place, what)
            .note(limit_note(limits_, limit))
            .note("a save file has a node for each place where a shape is, also of one that the "
                  "scene names once and uses often")
            .help(limit_help(limits_, limit));
    };
    if (steps_ > limits_.work)
        refuse(Code::LoopLimit, "this export takes more work than is allowed", &Limits::work);
    else if (bytes_ > limits_.memory * mebibyte)
        refuse(Code::MemoryLimit, "this export takes more memory than is allowed", &Limits::memory);
    return !spent_;
}

// What a shape takes with its numbers, as a node, as values and as text: measured (2,300 bytes a node,
// and two nodes for three shapes on the way).
constexpr std::size_t node_bytes = 1600;

Remark unsaved(Diagnostics &diagnostics, Span place, std::string message) {
    return {diagnostics,
            Diagnostic{
                Code::Unsupported, Severity::Warning, std::move(message), {place, {}}, {}, {}, {}}};
}

TreeNode made(NodeType type) {
    TreeNode node;
    node.type = row_of(type).name;
    return node;
}

void add(TreeNode &node, const char *name, Value value) {
    node.properties.emplace_back(name, std::move(value));
}

ShapeId TreeWriter::bare(ShapeId id) const {
    while (shape(id).kind == ShapeKind::Contract) id = shape(id).children[0];
    return id;
}

void TreeWriter::vary(TreeNode &node, std::string_view name, NodeId value) {
    if (!value || !numbers_.varies(value)) return;
    if (auto program = steps(value)) {
        node.varying.emplace_back(std::string(name), std::move(*program));
        return;
    }
    unsaved(diagnostics_, {},
            "the save format has no words for what `" + std::string(name) + "` of a `" + node.type +
                "` follows: " + no_words)
        .note("its present value is written");
}

bool TreeWriter::number(TreeNode &node, const char *name, NodeId value) {
    const auto present = numbers_.number(value);
    if (!present) return false;
    add(node, name, yaml_scalar(*present));
    vary(node, name, value);
    return true;
}

bool TreeWriter::vector(TreeNode &node, const char *name, NodeId value) {
    const auto present = numbers_.vector(value);
    if (!present) return false;
    add(node, name, yaml_xyz((*present)[0], (*present)[1], (*present)[2]));
    vary(node, name, value);
    return true;
}

void TreeWriter::united(ShapeId id, const Paint &paint, std::vector<TreeNode> &out) {
    if (!numbers_.budget().take(1, node_bytes)) return;
    id = bare(id);
    if (displaced(id, paint, out)) return;
    const Shape &s = shape(id);
    if (const auto listed = scene_.shapes.listed.find(id);
        listed != scene_.shapes.listed.end() && (s.args.empty() || s.kind == ShapeKind::Map)) {
        const std::vector<ShapeId> parts = listed->second;
        for (const ShapeId part : parts) united(part, paint, out);
        return;
    }
    switch (s.kind) {
    case ShapeKind::Empty: return;
    case ShapeKind::Union:
        for (const ShapeId child : s.children) united(child, paint, out);
        return;
    case ShapeKind::Instances: {
        const ir::InstanceTable &instance_table = scene_.shapes.instance_tables[s.payload];
        if (instance_table.smooth) break;
        for (int i = 0; i < instance_table.count; ++i) {
            numbers_.set(instance_table.index, {ir::Type::Int, {double(i)}});
            united(s.children[0], paint, out);
        }
        return;
    }
    case ShapeKind::Map: return map(id, paint, out);
    case ShapeKind::Repeat: return repeat(id, paint, out);
    case ShapeKind::Paint:
    case ShapeKind::Repaint: return painted(id, paint, out);
    case ShapeKind::Offset:
        if (numbers_.number(s.args[0]) == 0.0 && !numbers_.varies(s.args[0]))
            return united(s.children[0], paint, out);
        break;
    case ShapeKind::Leaf:
    case ShapeKind::Intersection:
    case ShapeKind::Complement:
    case ShapeKind::Xor:
    case ShapeKind::Blend:
    case ShapeKind::Seam:
    case ShapeKind::Lerp:
    case ShapeKind::PseudoNorm:
    case ShapeKind::Shell:
    case ShapeKind::Displace:
    case ShapeKind::Extrude:
    case ShapeKind::Within:
    case ShapeKind::Mixed:
    case ShapeKind::Library:
    case ShapeKind::Contract: break;
    }
    if (auto made_node = node(id, paint)) out.push_back(std::move(*made_node));
}

std::optional<TreeNode> TreeWriter::single(ShapeId id, const Paint &paint) {
    std::vector<TreeNode> nodes;
    united(id, paint, nodes);
    if (nodes.empty()) return std::nullopt;
    if (nodes.size() == 1) return std::move(nodes[0]);
    TreeNode group = made(NodeType::Union);
    group.children = std::move(nodes);
    return group;
}

std::optional<TreeNode> TreeWriter::one_child(NodeType type, ShapeId child, const Paint &paint) {
    TreeNode result = made(type);
    united(child, paint, result.children);
    if (result.children.empty()) return std::nullopt;
    return result;
}

// A displacement map lies on the base shapes, but is said where it was given: at the whole that
// they are of, or by the material that has it.
bool TreeWriter::displaced(ShapeId id, const Paint &paint, std::vector<TreeNode> &out) {
    const auto found = maps_.find(id);
    if (found == maps_.end() || open_maps_.contains(found->second)) return false;
    const ir::DisplacementMap &map = scene_.shapes.displacement_maps[found->second];
    const auto amount = numbers_.number(map.amount);
    const std::string texture = looks_.texture(map.map.image);
    if (!amount || texture.empty()) return false;
    open_maps_.insert(found->second);
    if (looks_.displaces(paint.fill, map, *amount) && !numbers_.varies(map.amount))
        united(id, paint, out);
    else if (auto result = map_node(map, *amount, id, paint)) {
        vary(*result, "Amount", map.amount);
        out.push_back(std::move(*result));
    }
    open_maps_.erase(found->second);
    return true;
}

std::optional<TreeNode> TreeWriter::map_node(const ir::DisplacementMap &map, double amount,
                                             ShapeId child, const Paint &paint) {
    auto result = one_child(NodeType::Displacement, child, paint);
    if (!result) return result;
    add(*result, "Map", yaml_word(looks_.texture(map.map.image)));
    add(*result, "Amount", yaml_scalar(amount));
    add(*result, "Scale",
        yaml_mapping({{"X", yaml_scalar(map.map.scale[0])}, {"Y", yaml_scalar(map.map.scale[1])}}));
    return result;
}

// A base shape's own part of a map whose whole was taken apart since, by a texture that lies below:
// the amount is here what the transforms between have made of it.
std::optional<TreeNode> TreeWriter::displaced_base(ShapeId id, const Paint &paint) {
    const Shape &s = shape(id);
    const ir::DisplacementMap &map = scene_.shapes.displacement_maps[s.payload - 1];
    const NodeId moved = numbers_.present(s.args[0]);
    const ir::Graph &graph = numbers_.graph();
    double amount = graph[moved].op == ir::Op::Neg ? -1 : 1;
    if (graph[moved].op == ir::Op::Mul) {
        for (int i = 0; i < 2; ++i) amount = graph.as_number(graph.arg(moved, i)).value_or(amount);
    }
    const ShapeId child = s.children[0];
    std::string name = paint.fill;
    if (shape(child).kind == ShapeKind::Paint) name = looks_.material(shape(child).payload);
    if (looks_.displaces(name, map, amount)) return single(child, paint);
    return map_node(map, amount, child, paint);
}

void TreeWriter::painted(ShapeId id, Paint paint, std::vector<TreeNode> &out) {
    const Shape &s = shape(id);
    if (paint.forced) return united(s.children[0], paint, out);
    const std::string name = looks_.material(s.payload);
    if (!name.empty()) {
        paint.fill = name;
        paint.forced = s.kind == ShapeKind::Repaint;
        return united(s.children[0], paint, out);
    }
    // Appearances that depend on the point: a group that says so, whose shapes a 0.3 reader shows
    // plainly.
    const ir::Material &m = scene_.shapes.materials[s.payload];
    TreeNode group = made(NodeType::Generic);
    Value appearances;
    appearances.kind = Value::Kind::Mapping;
    const auto part = [&](const char *key, NodeId expression) {
        auto program = steps(expression);
        if (program) appearances.entries.emplace_back(key, std::move(*program));
        return program.has_value();
    };
    bool whole = part("Diffuse", m.diffuse);
    whole = part("Specular", m.specular) && whole;
    whole = part("Exponent", m.exponent) && whole;
    whole = part("Emission", m.emission) && whole;
    if (!whole)
        unsaved(diagnostics_, s.origin,
                "the save format has no words for a part of this material: " + no_words)
            .note("it is left out of the file");
    appearances.entries.emplace_back("Repaint", yaml_switch(s.kind == ShapeKind::Repaint));
    add(group, "Paint", std::move(appearances));
    paint.fill.clear();
    united(s.children[0], paint, group.children);
    if (!group.children.empty()) out.push_back(std::move(group));
}

std::optional<TreeNode> TreeWriter::node(ShapeId id, const Paint &paint) {
    const Shape &s = shape(id);
    switch (s.kind) {
    case ShapeKind::Leaf: return field(id, nullptr, paint);
    case ShapeKind::Within: {
        const ShapeId child = bare(s.children[0]);
        const ir::Region &limits = scene_.shapes.regions[s.payload];
        if (shape(child).kind == ShapeKind::Leaf) return field(child, &limits, paint);
        auto value = region(limits);
        if (!value) return otherwise(id, paint, "this region");
        auto result = one_child(NodeType::Region, child, paint);
        if (!result) return result;
        // a map of space takes it itself
        const bool map = shape(child).kind == ShapeKind::Map && result->children.size() == 1 &&
                         (result->children[0].type == row_of(NodeType::Distortion).name ||
                          result->children[0].type == row_of(NodeType::Hyperize).name);
        if (map) result = TreeNode(std::move(result->children[0]));
        add(*result, "Within", std::move(*value));
        return result;
    }
    case ShapeKind::Intersection: return intersection(id, paint);
    case ShapeKind::Complement: {
        const ShapeId child = bare(s.children[0]);
        if (shape(child).kind == ShapeKind::Blend || shape(child).kind == ShapeKind::Instances) {
            if (shape(child).args.size() > 0)
                if (auto blend = profile_blend(child, true, paint)) return blend;
        }
        return one_child(NodeType::Complement, s.children[0], paint);
    }
    case ShapeKind::Blend:
    case ShapeKind::Instances: return profile_blend(id, false, paint);
    case ShapeKind::Xor: {
        TreeNode result = made(NodeType::ProfileBlend);
        add(result, "Operation", yaml_word("Xor"));
        for (const ShapeId child : s.children) {
            if (auto operand = single(child, paint)) result.children.push_back(std::move(*operand));
        }
        return result;
    }
    case ShapeKind::Mixed: {
        auto result = single(s.children[0], paint);
        if (result && result->type == row_of(NodeType::ProfileBlend).name)
            add(*result, "Mix", yaml_switch(true));
        return result;
    }
    case ShapeKind::Lerp: return lerp(id, paint);
    case ShapeKind::PseudoNorm: {
        auto first = single(s.children[0], paint);
        std::vector<TreeNode> rest;
        united(s.children[1], paint, rest);
        TreeNode result = made(NodeType::PseudoNormBlend);
        if (!number(result, "Exponent", s.args[0]) || !first || rest.empty())
            return otherwise(id, paint, "this pseudo-norm blend");
        result.children.push_back(std::move(*first));
        for (TreeNode &other : rest) result.children.push_back(std::move(other));
        return result;
    }
    case ShapeKind::Offset: {
        if (!numbers_.number(s.args[0])) return otherwise(id, paint, "an offset that is no number");
        auto result = one_child(NodeType::Offset, s.children[0], paint);
        if (result) number(*result, "Distance", s.args[0]);
        return result;
    }
    case ShapeKind::Shell: {
        const auto thickness = numbers_.number(s.args[0]);
        if (!thickness) return otherwise(id, paint, "a shell that is no number");
        auto result = one_child(NodeType::Deformation, s.children[0], paint);
        if (!result) return result;
        add(*result, "Function", yaml_word("shell"));
        add(*result, "Arguments", yaml_mapping({{"thickness", yaml_scalar(*thickness)}}));
        vary(*result, "thickness", s.args[0]);
        return result;
    }
    case ShapeKind::Displace: {
        if (s.payload > 0 && open_maps_.contains(s.payload - 1))
            return single(s.children[0], paint); // said by `displaced`
        if (s.payload > 0 &&
            !looks_.texture(scene_.shapes.displacement_maps[s.payload - 1].map.image).empty())
            return displaced_base(id, paint);
        auto field_steps = steps(s.args[0]);
        if (!field_steps) { // the shape itself stays
            unsaved(diagnostics_, s.origin,
                    "the save format has no words for this displacement: " + no_words)
                .note("the shape is written without it");
            return single(s.children[0], paint);
        }
        auto result = one_child(NodeType::Displacement, s.children[0], paint);
        if (result) add(*result, "Field", std::move(*field_steps));
        return result;
    }
    case ShapeKind::Library: return library(id, paint);
    case ShapeKind::Seam: return seam(id, paint);
    case ShapeKind::Extrude: return raised(id, "extrude", "height", s.args[0], paint);
    case ShapeKind::Empty:
    case ShapeKind::Union:
    case ShapeKind::Map:
    case ShapeKind::Repeat:
    case ShapeKind::Paint:
    case ShapeKind::Repaint:
    case ShapeKind::Contract: return single(id, paint);
    }
    return std::nullopt;
}

std::string FileNames::written(const std::string &name, const std::string &file) const {
    if (!options_.path_of || file.empty()) return name;
    std::string path = options_.path_of(file);
    if (path.empty()) path = name;
    if (path.starts_with("../"))
        unsaved(diagnostics_, {}, "`" + path + "` does not lie in the save file's folder")
            .note("a scene reads its own folder and those of `-I` alone")
            .help("copy the file there, or write the save file to a folder that holds both");
    return path;
}

Numbers::Numbers(const ir::Scene &scene, Budget &budget) : budget_(budget), graph_(scene.graph) {
    for (std::size_t i = 0; i < scene.graph.size(); ++i) {
        const ir::Node &node = scene.graph[NodeId{i}];
        if (node.op == ir::Op::Param && node.payload < scene.params.size()) {
            ir::Constant value{node.type, {}};
            const auto &present = scene.params[node.payload].value;
            std::copy(present.begin(), present.end(), value.value.begin());
            values_[NodeId{i}] = graph_.constant(value);
        } else if (node.op == ir::Op::Time) {
            values_[NodeId{i}] = graph_.number(0);
        }
    }
    for (const ir::Param &param : scene.params) words_.params.push_back(param.name);
}

NodeId Numbers::reduced(NodeId id) {
    return variables_.empty() ? id : ir::substitute(graph_, id, variables_);
}

NodeId Numbers::present(NodeId id) {
    constexpr std::size_t max_nodes = 20000; // of what calls and loops become
    if (!values_.empty()) id = ir::substitute(graph_, id, values_);
    return graph_.is_constant(id) ? id : ir::without_loops(graph_, id, max_nodes).root;
}

bool Numbers::varies(NodeId id) {
    return !graph_.is_constant(id) && !graph_.is_constant(reduced(id)) &&
           graph_.is_constant(present(id));
}

std::string Numbers::program(NodeId id) {
    std::string flow = program_flow(graph_, id, variables_, words_);
    moves_ = moves_ || flow.find("[Time]") != std::string::npos;
    return flow;
}

std::optional<Value> Numbers::steps(NodeId id) {
    const std::string flow = program(id);
    constexpr std::size_t step_bytes = 16; // of text, and of a value for each byte of it
    if (flow.empty() || !budget_.take(flow.size() / step_bytes, flow.size() * 2 * step_bytes))
        return std::nullopt;
    return parse_text(flow).value;
}

std::optional<ir::Constant> Numbers::constant(NodeId id) {
    if (!id) return std::nullopt;
    const NodeId node = graph_.is_constant(id) ? id : present(id);
    if (!graph_.is_constant(node)) return std::nullopt;
    return graph_.constant_of(node);
}

std::optional<double> Numbers::number(NodeId id) {
    const auto value = constant(id);
    return value && ir::components(value->type) == 1 ? std::optional(value->value[0])
                                                     : std::nullopt;
}

std::optional<std::array<double, 3>> Numbers::vector(NodeId id) {
    const auto value = constant(id);
    if (!value) return std::nullopt;
    const int size = ir::components(value->type);
    if (size == 1) return std::array<double, 3>{value->value[0], value->value[0], value->value[0]};
    if (size > 3) return std::nullopt;
    return std::array<double, 3>{value->value[0], value->value[1], size == 3 ? value->value[2] : 0};
}

void Numbers::set(NodeId variable, const ir::Constant &value) {
    values_[variable] = variables_[variable] = graph_.constant(value);
}

void Numbers::open_copies(NodeId id) {
    values_[id] = graph_.vec3(0, 0, 0);
    words_.ids.push_back(id);
}

std::vector<TreeNode> export_tree(const ir::Scene &scene, Numbers &numbers,
                                  Appearances &appearances, Diagnostics &diagnostics) {
    TreeWriter writer(scene, numbers, appearances, diagnostics);
    std::vector<TreeNode> nodes;
    for (const ir::TopLevel &top : scene.top_level) {
        numbers.budget().place = top.span;
        writer.united(top.shape, {}, nodes);
    }
    return nodes;
}

static Value mapping_of(std::vector<Entry> entries) {
    Value value;
    value.kind = Value::Kind::Mapping;
    value.entries = std::move(entries);
    return value;
}

Value node_value(TreeNode node, std::map<std::string, int> &ordinals) {
    if (node.verbatim) return std::move(*node.verbatim);
    Value properties = mapping_of(std::move(node.properties));
    const NodeTypeRow *row = find_node_type(node.type);
    if (!node.varying.empty())
        properties.entries.emplace_back("Varying", mapping_of(std::move(node.varying)));
    std::vector<Value> children;
    children.reserve(node.children.size());
    for (TreeNode &child : node.children)
        children.push_back(node_value(std::move(child), ordinals));
    if (!children.empty() || !row || row->children != Arity::Leaf) {
        // beside them a kept one that was no list would be read as the children next time
        std::erase_if(properties.entries, [](const Entry &e) { return e.first == "Children"; });
        properties.entries.emplace_back("Children", yaml_list(std::move(children)));
    }
    std::string name = node.name;
    if (!node.head) { // as import/tree.cpp counts
        const int ordinal = ++ordinals[node.type];
        if (!node.named) name = fmt::format("{} {}", node.type, ordinal);
    }
    Value type;
    type.text = node.type;
    type.plain = true;
    Value named = yaml_word(name);
    named.plain = named.plain || node.plain;
    std::vector<Value> items{std::move(type), std::move(named), std::move(properties)};
    items.insert(items.end(), node.extra.begin(), node.extra.end());
    return yaml_list(std::move(items));
}

} // namespace fathom::save
