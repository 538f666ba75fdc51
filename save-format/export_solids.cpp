// Fields and the library's solids, as nodes: a solid under its own name where the save format has
// one, else as a call of numbers; a field of one's own as its steps and where it holds.
#include "save-format/program.h"
#include "save-format/tree_writer.h"

namespace fathom::save {
namespace {

const NodeId *argument(const ir::Library &library, std::string_view name) {
    for (const auto &[key, value] : library.arguments) {
        if (key == name) return &value;
    }
    return nullptr;
}

} // namespace

std::optional<Value> TreeWriter::region(const ir::Region &region) {
    Value value;
    value.kind = Value::Kind::Mapping;
    static constexpr const char *axes[] = {"X", "Y", "Z"};
    const auto center = region.center ? numbers_.vector(region.center) : std::array<double, 3>{};
    switch (region.kind) {
    case ir::RegionKind::Everywhere:
        value.entries.emplace_back("Everywhere", yaml_switch(true));
        break;
    case ir::RegionKind::Ball: {
        const auto radius = numbers_.number(region.size);
        if (!radius || !center) return std::nullopt;
        value.entries.emplace_back("Ball", yaml_scalar(*radius));
        value.entries.emplace_back("Center", yaml_xyz((*center)[0], (*center)[1], (*center)[2]));
        break;
    }
    case ir::RegionKind::Box: {
        const auto size = numbers_.vector(region.size);
        if (!size || !center) return std::nullopt;
        std::array<double, 3> low{}, high{};
        for (std::size_t i = 0; i < 3; ++i)
            low[i] = (*center)[i] - (*size)[i] / 2, high[i] = (*center)[i] + (*size)[i] / 2;
        value.entries.emplace_back("Low", yaml_xyz(low[0], low[1], low[2]));
        value.entries.emplace_back("High", yaml_xyz(high[0], high[1], high[2]));
        break;
    }
    case ir::RegionKind::Tube: {
        const auto radius = numbers_.number(region.size);
        if (!radius) return std::nullopt;
        value.entries.emplace_back("Tube", yaml_scalar(*radius));
        value.entries.emplace_back("Axis", yaml_word(axes[region.axis]));
        break;
    }
    }
    if (!region.less.empty()) {
        std::vector<Value> less;
        for (const ir::Region &other : region.less) {
            auto part = this->region(other);
            if (!part) return std::nullopt;
            less.push_back(std::move(*part));
        }
        value.entries.emplace_back("Less", yaml_list(std::move(less)));
    }
    return value;
}

std::optional<TreeNode> TreeWriter::field(ShapeId id, const ir::Region *within,
                                          const Paint &paint) {
    const Shape &s = shape(id);
    auto field_steps = steps(s.args[0], id, "a function of the point");
    if (!field_steps) return std::nullopt;
    TreeNode result = made(NodeType::Field);
    add(result, "Field", std::move(*field_steps));
    if (within) {
        auto limits = region(*within);
        if (!limits) return left_out(id, "a region that is no number");
        add(result, "Within", std::move(*limits));
    }
    if (s.assumed > 0) add(result, "Assumed", yaml_scalar(s.assumed));
    if (s.estimate > 0) add(result, "Estimate", yaml_scalar(s.estimate));
    if (!paint.fill.empty()) add(result, "Material", yaml_word(paint.fill));
    return result;
}

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
        if (!whole) return left_out(id, "`" + name + "` with these arguments");
        if (!paint.fill.empty()) add(result, "Material", yaml_word(paint.fill));
        if (result.type != row_of(NodeType::LibraryShape).name)
            add(result, "Offset", yaml_mapping({{"X", yaml_scalar(0)}, {"Y", yaml_scalar(0)}}));
        return result;
    };
    if (s.dims == 2) return left_out(id, "flat shapes");
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
    // What the body reads decides for explicit fields: the file is no number, so the call does not
    // carry it.
    if (name == "distance_grid") {
        for (std::size_t i = 0; i < scene_.graph.size(); ++i) {
            const ir::Node &n = scene_.graph[NodeId{i}];
            if (n.op != ir::Op::Grid || n.payload >= scene_.grids.size()) continue;
            TreeNode result = made(NodeType::ExplicitField);
            add(result, "File", yaml_word(scene_.grids[n.payload].name));
            return finish(std::move(result));
        }
        return left_out(id, "a distance grid");
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
            if (!value) return left_out(id, "`" + name + "` with these arguments");
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
    return single(s.children[0], paint); // a combination or transform under its library's name
}

} // namespace fathom::save
