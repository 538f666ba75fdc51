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

// The library has the dodecahedron's, the icosahedron's and both sets with y and z the other way
// round: they go out turned about x, but where images lie on shapes, which would turn as well.
std::optional<TreeNode> TreeWriter::generalised(ShapeId id, const ir::Library &l,
                                                const std::string &name, const Paint &paint) {
    const auto sets = vector_sets();
    TreeNode result = made(NodeType::GeneralizedDistanceFunction);
    bool whole = true, turned = false, straight = false;
    const auto set_number = [&](const char *property, std::string_view key) {
        const NodeId *value = argument(l, key);
        whole = whole && value && number(result, property, *value);
    };
    const auto set_of = [&](int wanted) -> const VectorSet * {
        const bool old = wanted == 3 || wanted == 4 || wanted == 6;
        const int now = wanted == 6 ? 9 : old ? wanted + 4 : wanted;
        for (const VectorSet &set : sets) {
            if (set.number != now) continue;
            turned = turned || old;
            straight = straight || (!old && set.turned());
            return &set;
        }
        return nullptr;
    };
    if (name == "gdf_pair") {
        const auto add_set = [&](const char *property, std::string_view key) {
            const NodeId *node = argument(l, key);
            const auto value = node ? numbers_.number(*node) : std::nullopt;
            const VectorSet *set = value ? set_of(static_cast<int>(*value)) : nullptr;
            whole = whole && set;
            if (set) add(result, property, yaml_word(set->name));
        };
        add_set("Shape", "a");
        set_number("Radius", "radius");
        set_number("Exponent", "a_exponent");
        add_set("Second Shape", "b");
        set_number("Scale", "a_scale");
        set_number("Second Scale", "b_scale");
        set_number("Second Exponent", "b_exponent");
        if (!whole) return otherwise(id, paint, "`" + name + "` with these arguments");
        if (turned && (straight || !scene_.images.empty()))
            return std::nullopt; // a call, with its numbers
    } else {
        const VectorSet *set = nullptr;
        for (const VectorSet &other : sets) {
            std::string function = other.function;
            if (name == function) set = &other;
            if (other.turned() && name == function.erase(4, 3)) set = &other, turned = true;
        }
        if (!set || (turned && !scene_.images.empty())) return std::nullopt;
        add(result, "Shape", yaml_word(set->name));
        set_number("Radius", "radius");
        set_number("Exponent", "exponent");
        if (!whole) return otherwise(id, paint, "`" + name + "` with these arguments");
    }
    if (!paint.fill.empty()) add(result, "Material", yaml_word(paint.fill));
    add(result, "Offset", yaml_mapping({{"X", yaml_scalar(0)}, {"Y", yaml_scalar(0)}}));
    if (!turned) return result;
    TreeNode turn = made(NodeType::Rotation);
    add(turn, "Angles", yaml_xyz(90, 0, 0));
    turn.children.push_back(std::move(result));
    return turn;
}

const char *TreeWriter::add_arguments(TreeNode &result, const ir::Library &l,
                                      std::vector<Entry> words) {
    Value arguments;
    arguments.kind = Value::Kind::Mapping;
    arguments.entries = std::move(words);
    const auto written = [](const ir::Constant &value) {
        if (value.type == ir::Type::Bool) return yaml_switch(value.value[0] != 0);
        std::vector<Value> parts;
        for (int i = 0; i < ir::components(value.type); ++i)
            parts.push_back(yaml_scalar(value.value[static_cast<std::size_t>(i)]));
        return parts.size() == 1 ? parts[0] : yaml_list(std::move(parts));
    };
    for (const auto &[key, node] : l.arguments) {
        const auto value = numbers_.constant(node);
        auto program = value ? std::nullopt : steps(node);
        if (program) { // of the point
            arguments.entries.emplace_back(key, yaml_mapping({{"Program", *program}}));
            continue;
        }
        if (!value) return "these arguments";
        arguments.entries.emplace_back(key, written(*value));
        vary(result, key, node);
    }
    for (const auto &[key, nodes] : l.lists) {
        std::vector<Value> items;
        if (!numbers_.budget().take(nodes.size(), 4 * sizeof(Value) * nodes.size())) return "";
        for (const NodeId node : nodes) {
            const auto value = numbers_.constant(node);
            if (!value || numbers_.varies(node)) return "this list";
            items.push_back(written(*value));
        }
        arguments.entries.emplace_back(key, yaml_list(std::move(items)));
    }
    add(result, "Arguments", std::move(arguments));
    return nullptr;
}

std::optional<TreeNode> TreeWriter::library(ShapeId id, const Paint &paint) {
    const Shape &s = shape(id);
    const ir::Library &l = scene_.shapes.libraries[s.payload];
    const bool exact = l.claims.kind == ir::FieldKind::Exact;
    std::string name = l.name.substr(l.name.rfind('.') + 1);
    bool whole = true;
    const auto set_number = [&](TreeNode &node, const char *property, std::string_view key) {
        const NodeId *value = argument(l, key);
        whole = whole && value && number(node, property, *value);
    };
    const auto set_vector = [&](TreeNode &node, const char *property, std::string_view key) {
        const NodeId *value = argument(l, key);
        whole = whole && value && vector(node, property, *value);
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
        set_number(result, "Radius", "radius");
        return finish(std::move(result));
    }
    if (name == "torus" && exact) {
        TreeNode result = made(NodeType::Torus);
        set_number(result, "Major Radius", "major");
        set_number(result, "Minor Radius", "minor");
        return finish(std::move(result));
    }
    if (name == "box") {
        TreeNode result = made(NodeType::Box);
        set_vector(result, "Size", "size");
        if (exact) add(result, "Exact", yaml_switch(true));
        return finish(std::move(result));
    }
    if (name == "cylinder" || (name == "cone" && !exact)) {
        TreeNode result = made(name == "cone" ? NodeType::Cone : NodeType::Cylinder);
        set_number(result, "Radius", "radius");
        set_number(result, "Height", "height");
        if (exact) add(result, "Exact", yaml_switch(true));
        return finish(std::move(result));
    }
    if (name == "menger_sponge") {
        TreeNode result = made(NodeType::MengerSponge);
        set_number(result, "Size", "size");
        set_number(result, "Iterations", "iterations");
        return finish(std::move(result));
    }
    if (name == "blobby") {
        TreeNode result = made(NodeType::BlobbyObjects);
        set_number(result, "Balls", "balls");
        set_vector(result, "Size", "size");
        set_number(result, "Radius", "radius");
        set_number(result, "Seed", "seed");
        return finish(std::move(result));
    }
    if (auto gdf = generalised(id, l, name, paint)) return gdf;
    std::vector<Entry> words;      // arguments that are no numbers
    if (name == "distance_grid") { // the body tells which file it reads
        const auto grid = grid_below(scene_.graph, shape(bare(s.children[0])).args);
        if (!grid) return otherwise(id, paint, "this grid");
        const ir::GridData &data = scene_.grids[*grid];
        const Value file = yaml_word(looks_.files().written(data.name, data.file));
        const bool distances =
            std::none_of(l.arguments.begin(), l.arguments.end(),
                         [](const auto &each) { return each.first == "isovalue"; });
        if (distances && data.part.empty()) {
            TreeNode result = made(NodeType::ExplicitField);
            add(result, "File", file);
            return finish(std::move(result));
        }
        words.emplace_back("file", yaml_mapping({{"File", file}}));
        if (!data.part.empty())
            words.emplace_back("grid", yaml_mapping({{"Text", yaml_word(data.part)}}));
    }
    // Not the claims of a body alone.
    const bool called = !words.empty() || !l.arguments.empty() || !l.lists.empty();
    if (called && is_library_solid(name)) {
        TreeNode result = made(NodeType::LibraryShape);
        add(result, "Function", yaml_word(name));
        const char *unknown = add_arguments(result, l, std::move(words));
        if (unknown) return otherwise(id, paint, "`" + name + "` with " + unknown);
        return finish(std::move(result));
    }
    const ShapeId body = bare(s.children[0]);
    if (l.has_claims && !l.claims.lipschitz && shape(body).kind == ShapeKind::Leaf)
        return field(body, nullptr, paint); // its bound was proved, and will be again
    if (l.has_claims) return otherwise(id, paint, "`" + name + "`");
    return single(s.children[0], paint); // a combination or transform under its library's name
}

} // namespace fathom::save
