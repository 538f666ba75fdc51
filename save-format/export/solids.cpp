// The library's solids, as nodes: under their own names where the save format has them, else as
// calls with numbers.
#include "save-format/export/tree_writer.h"

#include <unordered_set>

namespace fathom::save {
namespace {

const NodeId *argument(const ir::Library &library, std::string_view name) {
    for (const auto &[key, value] : library.arguments) {
        if (key == name) return &value;
    }
    return nullptr;
}

// The first grid that these expressions read.
std::optional<std::uint32_t> grid_below(const ir::Graph &graph, std::vector<NodeId> open) {
    std::unordered_set<NodeId> seen;
    while (!open.empty()) {
        const NodeId id = open.back();
        open.pop_back();
        if (!seen.insert(id).second) continue;
        if (graph[id].op == ir::Op::Grid) return graph[id].payload;
        open.insert(open.end(), graph.args(id).begin(), graph.args(id).end());
    }
    return std::nullopt;
}

} // namespace

std::optional<TreeNode> TreeWriter::library(ShapeId id, const Paint &paint) {
    const Shape &s = shape(id);
    const ir::Library &l = scene_.shapes.libraries[s.payload];
    const bool exact = l.claims.kind == ir::FieldKind::Exact;
    std::string name = l.name.substr(l.name.rfind('.') + 1);
    bool whole = true;
    const auto number = [&](std::string_view key) {
        const NodeId *node = argument(l, key);
        const auto value = node ? numbers_.number(*node) : std::nullopt;
        whole = whole && value;
        return yaml_scalar(value.value_or(0));
    };
    const auto vector = [&](std::string_view key) {
        const NodeId *node = argument(l, key);
        const auto value = node ? numbers_.vector(*node) : std::nullopt;
        whole = whole && value;
        const auto v = value.value_or(std::array<double, 3>{});
        return yaml_xyz(v[0], v[1], v[2]);
    };
    const auto finish = [&](TreeNode result) -> std::optional<TreeNode> {
        if (!whole) return otherwise(id, paint, "`" + name + "` with these arguments");
        if (!paint.fill.empty()) add(result, "Material", yaml_word(paint.fill));
        if (result.type != row_of(NodeType::LibraryShape).name)
            add(result, "Offset", yaml_mapping({{"X", yaml_scalar(0)}, {"Y", yaml_scalar(0)}}));
        return result;
    };
    if (name == "sphere" && exact) {
        TreeNode result = made(NodeType::Sphere);
        add(result, "Radius", number("radius"));
        return finish(std::move(result));
    }
    if (name == "torus" && exact) {
        TreeNode result = made(NodeType::Torus);
        add(result, "Major Radius", number("major"));
        add(result, "Minor Radius", number("minor"));
        return finish(std::move(result));
    }
    if (name == "box") {
        TreeNode result = made(NodeType::Box);
        add(result, "Size", vector("size"));
        if (exact) add(result, "Exact", yaml_switch(true));
        return finish(std::move(result));
    }
    if (name == "cylinder" || (name == "cone" && !exact)) {
        TreeNode result = made(name == "cone" ? NodeType::Cone : NodeType::Cylinder);
        add(result, "Radius", number("radius"));
        add(result, "Height", number("height"));
        if (exact) add(result, "Exact", yaml_switch(true));
        return finish(std::move(result));
    }
    if (name == "menger_sponge") {
        TreeNode result = made(NodeType::MengerSponge);
        add(result, "Size", number("size"));
        add(result, "Iterations", number("iterations"));
        return finish(std::move(result));
    }
    if (name == "blobby") {
        TreeNode result = made(NodeType::BlobbyObjects);
        add(result, "Balls", number("balls"));
        add(result, "Size", vector("size"));
        add(result, "Radius", number("radius"));
        add(result, "Seed", number("seed"));
        return finish(std::move(result));
    }
    const auto sets = vector_sets();
    for (const VectorSet &set : sets) {
        if (name != set.function) continue;
        TreeNode result = made(NodeType::GeneralizedDistanceFunction);
        add(result, "Shape", yaml_word(set.name));
        add(result, "Radius", number("radius"));
        add(result, "Exponent", number("exponent"));
        return finish(std::move(result));
    }
    if (name == "gdf_pair") {
        const auto set = [&](std::string_view key) {
            const NodeId *node = argument(l, key);
            const auto value = node ? numbers_.number(*node) : std::nullopt;
            whole = whole && value && *value >= 0 && *value < static_cast<double>(sets.size());
            return yaml_word(whole ? sets[static_cast<std::size_t>(*value)].name : "");
        };
        TreeNode result = made(NodeType::GeneralizedDistanceFunction);
        add(result, "Shape", set("a"));
        add(result, "Radius", number("radius"));
        add(result, "Exponent", number("a_exponent"));
        add(result, "Second Shape", set("b"));
        add(result, "Scale", number("a_scale"));
        add(result, "Second Scale", number("b_scale"));
        add(result, "Second Exponent", number("b_exponent"));
        return finish(std::move(result));
    }
    if (name == "distance_grid") { // the file is no number: the body tells which it reads
        const auto grid = grid_below(scene_.graph, shape(bare(s.children[0])).args);
        if (!grid) return otherwise(id, paint, "this grid");
        TreeNode result = made(NodeType::ExplicitField);
        add(result, "File", yaml_word(scene_.grids[*grid].name));
        return finish(std::move(result));
    }
    const bool of_numbers = name != "gdf" && name != "gdf_blend" && name != "metaballs" &&
                            name != "tubes" && is_library_solid(name);
    if (of_numbers) {
        TreeNode result = made(NodeType::LibraryShape);
        add(result, "Function", yaml_word(name));
        Value arguments;
        arguments.kind = Value::Kind::Mapping;
        for (const auto &[key, node] : l.arguments) {
            const auto value = numbers_.constant(node);
            if (!value) return otherwise(id, paint, "`" + name + "` with these arguments");
            std::vector<Value> parts;
            for (int i = 0; i < ir::components(value->type); ++i)
                parts.push_back(yaml_scalar(value->value[static_cast<std::size_t>(i)]));
            if (value->type == ir::Type::Bool) parts[0] = yaml_switch(value->value[0] != 0);
            arguments.entries.emplace_back(key, parts.size() == 1 ? parts[0]
                                                                  : yaml_list(std::move(parts)));
        }
        add(result, "Arguments", std::move(arguments));
        return finish(std::move(result));
    }
    if (l.has_claims) return otherwise(id, paint, "`" + name + "`");
    return single(s.children[0], paint); // a combination or transform under its library's name
}

} // namespace fathom::save
