// Flat shapes below an extrusion or a revolution, as labelled nodes: the library's own by their
// calls, moved, turned and scaled with `Flat` on the node, combined as solids are.
#include "save-format/export/tree_writer.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fathom::save {

// Whether nodes say all of a flat shape. Where they do not, what is made of it is a function.
bool TreeWriter::flat_words(ShapeId id) {
    id = bare(id);
    const Shape &s = shape(id);
    const auto all = [&](const std::vector<ShapeId> &parts) {
        return std::all_of(parts.begin(), parts.end(),
                           [&](ShapeId part) { return flat_words(part); });
    };
    if (const auto listed = scene_.shapes.listed.find(id); listed != scene_.shapes.listed.end())
        return all(listed->second);
    switch (s.kind) {
    case ShapeKind::Library: {
        const ir::Library &l = scene_.shapes.libraries[s.payload];
        if (l.arguments.empty() && l.lists.empty()) return !l.has_claims && all(s.children);
        return is_library_solid(l.name) &&
               std::all_of(l.arguments.begin(), l.arguments.end(), [&](const auto &argument) {
                   return numbers_.constant(argument.second).has_value();
               });
    }
    case ShapeKind::Map: {
        if (s.map == ir::MapKind::Translate) return numbers_.vector(s.args[2]) && all(s.children);
        const bool fixed = s.map == ir::MapKind::Rotate || s.map == ir::MapKind::Scale;
        const auto numbers = fixed ? numbers_.constant(s.args[2]) : std::nullopt;
        if (!numbers || numbers_.varies(s.args[2])) return false;
        return all(s.children);
    }
    case ShapeKind::Repeat: {
        const ir::Repetition &r = scene_.shapes.repetitions[s.payload];
        return !r.mirrored && !r.id && numbers_.vector(s.args[0]) && all(s.children);
    }
    case ShapeKind::Empty:
    case ShapeKind::Union:
    case ShapeKind::Intersection:
    case ShapeKind::Complement:
    case ShapeKind::Xor:
    case ShapeKind::Paint:
    case ShapeKind::Repaint: return all(s.children);
    case ShapeKind::Blend:
    case ShapeKind::Offset:
    case ShapeKind::Shell:
        return std::all_of(s.args.begin(), s.args.end(),
                           [&](NodeId value) { return numbers_.number(value).has_value(); }) &&
               all(s.children);
    case ShapeKind::Leaf:
    case ShapeKind::Seam:
    case ShapeKind::Lerp:
    case ShapeKind::PseudoNorm:
    case ShapeKind::Displace:
    case ShapeKind::Extrude:
    case ShapeKind::Within:
    case ShapeKind::Mixed:
    case ShapeKind::Instances:
    case ShapeKind::Contract: break;
    }
    return false;
}

// Of flat words alone.
std::optional<TreeNode> TreeWriter::flat_map(ShapeId id, const Paint &paint) {
    const Shape &s = shape(id);
    ir::Graph &graph = numbers_.graph();
    const NodeType type = s.map == ir::MapKind::Translate ? NodeType::Translation
                          : s.map == ir::MapKind::Rotate  ? NodeType::Rotation
                                                          : NodeType::Scaling;
    auto result = one_child(type, s.children[0], paint);
    if (!result) return result;
    if (type == NodeType::Translation) {
        vector(*result, "Vector", graph.make(ir::Op::Neg, {s.args[2]}));
    } else {
        auto m = numbers_.constant(s.args[2])->value;
        const auto scaled = [&](double x, double y) {
            add(*result, "Factors", yaml_xyz(shortest_near(1 / x), shortest_near(1 / y), 1));
        };
        if (type == NodeType::Scaling) {
            scaled(m[0], m[1]);
        } else {
            // a reflection is one in x, then the rotation that is left
            const bool reflects = m[0] * m[3] - m[1] * m[2] < 0;
            if (reflects) m[0] = -m[0], m[1] = -m[1];
            double angle = shortest_near(std::atan2(m[1], m[0]) * 180 / std::numbers::pi);
            if (angle == -180) angle = 180; // of -0 and 0 alike
            if (reflects) {
                result->type = row_of(NodeType::Scaling).name;
                scaled(-1, 1);
            }
            if (reflects && angle != 0) {
                add(*result, "Flat", yaml_switch(true));
                TreeNode turned = made(NodeType::Rotation);
                turned.children.push_back(std::move(*result));
                result = std::move(turned);
            }
            if (!reflects || angle != 0) add(*result, "Angles", yaml_xyz(0, 0, -angle));
        }
    }
    add(*result, "Flat", yaml_switch(true));
    return result;
}

// What is made of a flat shape: extruded along z, or turned about y.
std::optional<TreeNode> TreeWriter::raised(ShapeId id, const char *function, const char *argument,
                                           NodeId value, const Paint &paint) {
    const auto present = numbers_.number(value);
    if (!present || !flat_words(shape(id).children[0])) return otherwise(id, paint, "flat shapes");
    auto result = one_child(NodeType::Deformation, shape(id).children[0], paint);
    if (!result) return result;
    add(*result, "Function", yaml_word(function));
    add(*result, "Arguments", yaml_mapping({{argument, yaml_scalar(*present)}}));
    vary(*result, argument, value);
    return result;
}

} // namespace fathom::save
