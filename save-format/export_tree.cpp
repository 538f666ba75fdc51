// One node a shape. Unions dissolve among siblings that are united anyway, and what changes nothing
// is left out: so the importer can foretell the nodes that its own text will give
// (import_tree.cpp), and record the rest.
#include "save-format/export_tree.h"

#include "ir/maps.h"
#include "save-format/node_types.h"
#include "save-format/program.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fathom::save {
namespace {

using ir::NodeId;
using ir::Shape;
using ir::ShapeId;
using ir::ShapeKind;

constexpr int most_copies = 4096; // of a repetition whose copies differ
constexpr double degree = std::numbers::pi / 180;

// The shortest decimal within a few units in the last place: 30, where the arithmetic
// left 29.999999999999996.
double shortest_near(double value) {
    if (value == 0 || !std::isfinite(value)) return value;
    double best = value;
    std::string text = yaml_number(value);
    for (int digits = 1; digits <= 15; ++digits) {
        const double unit = std::pow(10, std::floor(std::log10(std::abs(value))) + 1 - digits);
        const double rounded =
            std::abs(unit) >= 1 ? std::round(value / unit) * unit
                                : std::round(value * std::round(1 / unit)) / std::round(1 / unit);
        if (std::abs(rounded - value) <= 4e-15 * std::abs(value)) return rounded;
    }
    return best;
}

struct Paint {
    std::string fill;    // of what is unpainted
    bool forced = false; // by a repaint: inner paints do not count
};

class TreeWriter {
  public:
    TreeWriter(const ir::Scene &scene, Numbers &numbers, const MaterialName &name,
               Diagnostics &diagnostics)
        : scene_(scene), numbers_(numbers), material_name_(name), diagnostics_(diagnostics) {}

    // Appends the nodes whose union the shape is.
    void united(ShapeId id, const Paint &paint, std::vector<TreeNode> &out);

  private:
    // One node, or none where nothing is there.
    std::optional<TreeNode> single(ShapeId id, const Paint &paint);
    std::optional<TreeNode> node(ShapeId id, const Paint &paint);

    void map(ShapeId id, const Paint &paint, std::vector<TreeNode> &out);
    void rotation(const ir::Constant &matrix, TreeNode made, std::vector<TreeNode> &out);
    void repeat(ShapeId id, const Paint &paint, std::vector<TreeNode> &out);
    void painted(ShapeId id, Paint paint, std::vector<TreeNode> &out);
    std::optional<TreeNode> intersection(ShapeId id, const Paint &paint);
    std::optional<TreeNode> profile_blend(ShapeId id, bool complemented, const Paint &paint);
    std::optional<TreeNode> lerp(ShapeId id, const Paint &paint);
    std::optional<TreeNode> library(ShapeId id, const Paint &paint);
    std::optional<TreeNode> field(ShapeId id, const ir::Region *region, const Paint &paint);
    std::optional<TreeNode> one_child(NodeType type, ShapeId child, const Paint &paint);
    std::optional<TreeNode> left_out(ShapeId id, std::string what);
    std::optional<Value> steps(NodeId expression, ShapeId at, const char *what);
    std::optional<Value> region(const ir::Region &region);

    const Shape &shape(ShapeId id) const { return scene_.shapes[id]; }
    // Contracts, library wrappers of combinations and such say nothing here.
    ShapeId bare(ShapeId id) const;

    const ir::Scene &scene_;
    Numbers &numbers_;
    const MaterialName &material_name_;
    Diagnostics &diagnostics_;
};

TreeNode made(NodeType type) {
    TreeNode node;
    node.type = row_of(type).name;
    return node;
}

void add(TreeNode &node, const char *name, Value value) {
    node.properties.emplace_back(name, std::move(value));
}

const NodeId *argument(const ir::Library &library, std::string_view name) {
    for (const auto &[key, value] : library.arguments) {
        if (key == name) return &value;
    }
    return nullptr;
}

ShapeId TreeWriter::bare(ShapeId id) const {
    while (shape(id).kind == ShapeKind::Contract) id = shape(id).children[0];
    return id;
}

std::optional<TreeNode> TreeWriter::left_out(ShapeId id, std::string what) {
    diagnostics_
        .add(Code::Unsupported, shape(id).origin, "the save format has no words for " + what)
        .note("it is left out of the file")
        .severity = Severity::Warning;
    return std::nullopt;
}

std::optional<Value> TreeWriter::steps(NodeId expression, ShapeId at, const char *what) {
    const std::string flow = program_flow(numbers_.graph(), numbers_.reduced(expression));
    if (flow.empty()) {
        left_out(at, std::string(what) + " with loops, tables or images");
        return std::nullopt;
    }
    return parse_text(flow).value;
}

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

void TreeWriter::united(ShapeId id, const Paint &paint, std::vector<TreeNode> &out) {
    id = bare(id);
    const Shape &s = shape(id);
    if (const auto listed = scene_.shapes.listed.find(id);
        listed != scene_.shapes.listed.end() && s.args.empty()) {
        const std::vector<ShapeId> parts = listed->second;
        for (const ShapeId part : parts) united(part, paint, out);
        return;
    }
    switch (s.kind) {
    case ShapeKind::Empty: return;
    case ShapeKind::Union:
        for (const ShapeId child : s.children) united(child, paint, out);
        return;
    case ShapeKind::Many: {
        const ir::Family &family = scene_.shapes.families[s.payload];
        if (family.smooth) break;
        for (int i = 0; i < family.count; ++i) {
            numbers_.set(family.index, {ir::Type::Int, {double(i)}});
            united(s.children[0], paint, out);
        }
        return;
    }
    case ShapeKind::Map: return map(id, paint, out);
    case ShapeKind::Repeat: return repeat(id, paint, out);
    case ShapeKind::Paint:
    case ShapeKind::Repaint: return painted(id, paint, out);
    case ShapeKind::Offset:
        if (numbers_.number(s.args[0]) == 0.0) return united(s.children[0], paint, out);
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

void TreeWriter::painted(ShapeId id, Paint paint, std::vector<TreeNode> &out) {
    const Shape &s = shape(id);
    if (paint.forced) return united(s.children[0], paint, out);
    const std::string name = material_name_(s.payload);
    if (!name.empty()) {
        paint.fill = name;
        paint.forced = s.kind == ShapeKind::Repaint;
        return united(s.children[0], paint, out);
    }
    // Looks that depend on the point: a group that says so, whose shapes a 0.3 reader shows
    // plainly.
    const ir::Material &m = scene_.shapes.materials[s.payload];
    TreeNode group = made(NodeType::Generic);
    Value looks;
    looks.kind = Value::Kind::Mapping;
    const auto part = [&](const char *key, NodeId expression) {
        const std::string flow = expression
                                     ? program_flow(numbers_.graph(), numbers_.reduced(expression))
                                     : std::string();
        if (!flow.empty()) looks.entries.emplace_back(key, parse_text(flow).value);
        return !flow.empty();
    };
    bool whole = part("Diffuse", m.diffuse);
    whole = part("Specular", m.specular) && whole;
    whole = part("Exponent", m.exponent) && whole;
    whole = part("Emission", m.emission) && whole;
    if (!whole) left_out(id, "a part of this material: a function with loops, tables or images");
    looks.entries.emplace_back("Repaint", yaml_switch(s.kind == ShapeKind::Repaint));
    add(group, "Paint", std::move(looks));
    paint.fill.clear();
    united(s.children[0], paint, group.children);
    if (!group.children.empty()) out.push_back(std::move(group));
}

// A rotation's angles, as 2.5 has them: the point is turned by R = Rx Ry Rz, the object by its
// transpose.
void TreeWriter::rotation(const ir::Constant &matrix, TreeNode child, std::vector<TreeNode> &out) {
    // columns of the object's matrix M = Rz(-z) Ry(-y) Rx(-x); at(row, column)
    const auto at = [&](int row, int column) {
        return matrix.value[static_cast<std::size_t>(3 * column + row)];
    };
    const double sine = std::clamp(-at(2, 0), -1.0, 1.0); // sin of the turn about y
    double x = 0, y = std::asin(sine), z = 0;
    if (std::abs(sine) < 1 - 1e-12) {
        x = std::atan2(at(2, 1), at(2, 2));
        z = std::atan2(at(1, 0), at(0, 0));
    } else {
        x = std::atan2(-at(1, 2),
                       at(1, 1)); // only x and z together are known: all of it is given to x
    }
    const auto degrees = [](double angle) {
        const double value = shortest_near(-angle / degree);
        return std::abs(value) < 1e-12 ? 0.0 : value;
    };
    TreeNode result = made(NodeType::Rotation);
    add(result, "Angles", yaml_xyz(degrees(x), degrees(y), degrees(z)));
    result.children.push_back(std::move(child));
    out.push_back(std::move(result));
}

// The v with which the library raises space to a power (thesis 6.3), where q is such a map. It
// writes x |x|^(v - 1), whose power the graph multiplies out where it is small and whole.
std::optional<double> hyperized_by(ir::Graph &graph, NodeId q, NodeId p) {
    if (graph[q].op != ir::Op::Mul) return std::nullopt;
    std::vector<double> exponents = {2, 3, 4};
    for (const NodeId part : graph.args(q)) {
        if (graph[part].op != ir::Op::Pow || !graph.is_constant(graph.arg(part, 1))) continue;
        const double power = graph.constant_of(graph.arg(part, 1)).value[0];
        exponents = {shortest_near(power + 1), power + 1};
    }
    for (const double v : exponents)
        if (ir::hyperize_point(graph, p, graph.number(v)) == q) return v;
    return std::nullopt;
}

void TreeWriter::map(ShapeId id, const Paint &paint, std::vector<TreeNode> &out) {
    const Shape &s = shape(id);
    ir::Graph &graph = numbers_.graph();
    const auto push = [&](std::optional<TreeNode> result) {
        if (result) out.push_back(std::move(*result));
    };
    if (s.dims == 2) return push(left_out(id, "flat shapes"));
    static constexpr const char *axes[] = {"X", "Y", "Z"};
    switch (s.map) {
    case ir::MapKind::Translate: {
        const auto by = numbers_.vector(s.args[2]);
        if (!by) return push(left_out(id, "a movement that is no number"));
        if (*by == std::array<double, 3>{}) return united(s.children[0], paint, out);
        auto result = one_child(NodeType::Translation, s.children[0], paint);
        if (result) add(*result, "Vector", yaml_xyz(-(*by)[0], -(*by)[1], -(*by)[2]));
        return push(std::move(result));
    }
    case ir::MapKind::Rotate: {
        const auto matrix = numbers_.constant(s.args[2]);
        if (!matrix) return push(left_out(id, "a rotation that is no number"));
        const auto &m = matrix->value;
        const double det = m[0] * (m[4] * m[8] - m[5] * m[7]) - m[3] * (m[1] * m[8] - m[2] * m[7]) +
                           m[6] * (m[1] * m[5] - m[2] * m[4]);
        ir::Constant turn = *matrix;
        bool identity = true;
        for (std::size_t i = 0; i < 9; ++i)
            identity = identity && std::abs(m[i] - (i % 4 == 0 ? 1 : 0)) < 1e-15;
        if (identity) return united(s.children[0], paint, out);
        // A reflection is the reflection in x, then the rotation that is left.
        TreeNode inner = made(NodeType::Rotation);
        united(s.children[0], paint, inner.children);
        if (inner.children.empty()) return;
        if (det < 0) {
            TreeNode mirror = made(NodeType::Scaling);
            add(mirror, "Factors", yaml_xyz(-1, 1, 1));
            mirror.children = std::move(inner.children);
            for (std::size_t i = 0; i < 3; ++i) turn.value[i] = -turn.value[i];
            bool plain = true;
            for (std::size_t i = 0; i < 9; ++i)
                plain = plain && std::abs(turn.value[i] - (i % 4 == 0 ? 1 : 0)) < 1e-15;
            if (plain) {
                out.push_back(std::move(mirror));
                return;
            }
            return rotation(turn, std::move(mirror), out);
        }
        std::vector<TreeNode> children = std::move(inner.children);
        TreeNode held;
        rotation(turn, std::move(held), out);
        out.back().children = std::move(children);
        return;
    }
    case ir::MapKind::Scale: {
        const auto by = numbers_.vector(s.args[2]);
        if (!by) return push(left_out(id, "a scale that is no number"));
        if (*by == std::array<double, 3>{1, 1, 1}) return united(s.children[0], paint, out);
        auto result = one_child(NodeType::Scaling, s.children[0], paint);
        // the shortest number whose reciprocal the scale is
        const auto factor = [](double scale) {
            const double exact = 1 / scale, near = shortest_near(exact);
            return 1 / near == scale || 1 / exact != scale ? near : exact;
        };
        if (result)
            add(*result, "Factors", yaml_xyz(factor((*by)[0]), factor((*by)[1]), factor((*by)[2])));
        return push(std::move(result));
    }
    case ir::MapKind::Twist: {
        const auto rate = numbers_.number(s.args[2]);
        if (!rate) return push(left_out(id, "a twist that is no number"));
        if (*rate == 0) return united(s.children[0], paint, out);
        auto result = one_child(NodeType::Twist, s.children[0], paint);
        if (result) {
            add(*result, "Rate", yaml_scalar(-*rate));
            if (s.axis != 2) add(*result, "Axis", yaml_word(axes[s.axis]));
        }
        return push(std::move(result));
    }
    case ir::MapKind::Bend:
    case ir::MapKind::Taper: {
        const bool bend = s.map == ir::MapKind::Bend;
        const auto first = numbers_.number(s.args[2]);
        const auto from = bend ? std::optional(0.0) : numbers_.number(s.args[3]),
                   to = bend ? std::optional(0.0) : numbers_.number(s.args[4]);
        if (!first || !from || !to) return push(left_out(id, "a deformation that is no number"));
        auto result = one_child(NodeType::Deformation, s.children[0], paint);
        if (!result) return;
        add(*result, "Function", yaml_word(bend ? "bend" : "taper"));
        Value arguments = yaml_mapping(
            {{bend ? "rate" : "ratio", yaml_scalar(*first)}, {"axis", yaml_word(axes[s.axis])}});
        if (bend) {
            arguments.entries.emplace_back("towards", yaml_word(axes[s.towards]));
        } else {
            arguments.entries.emplace_back("from", yaml_scalar(*from));
            arguments.entries.emplace_back("to", yaml_scalar(*to));
        }
        add(*result, "Arguments", std::move(arguments));
        return push(std::move(result));
    }
    case ir::MapKind::Fold: {
        const NodeId q = numbers_.reduced(s.args[0]), p = graph.point();
        for (int axis = 0; axis < 3; ++axis) {
            // as the library writes it, p + (|dot(p, n)| - dot(p, n)) n, or by component
            double unit[3] = {0, 0, 0};
            unit[axis] = 1;
            const NodeId n = graph.vec3(unit[0], unit[1], unit[2]);
            const NodeId along = graph.make(ir::Op::Dot, {p, n});
            const NodeId written =
                graph.add(p, graph.mul(graph.sub(graph.make(ir::Op::Abs, {along}), along), n));
            if (q != written && q != ir::mirror_point(graph, p, axis)) continue;
            auto result = one_child(NodeType::Turnaround, s.children[0], paint);
            if (result && axis != 0) add(*result, "Axis", yaml_word(axes[axis]));
            return push(std::move(result));
        }
        [[fallthrough]];
    }
    case ir::MapKind::Distort: {
        const NodeId q = numbers_.reduced(s.args[0]), p = graph.point();
        if (s.map == ir::MapKind::Distort) {
            if (const auto exponent = hyperized_by(graph, q, p)) {
                auto result = one_child(NodeType::Hyperize, s.children[0], paint);
                if (result) add(*result, "Exponent", yaml_scalar(*exponent));
                return push(std::move(result));
            }
        }
        auto map_steps = steps(q, id, "a map of space");
        if (!map_steps) return;
        auto result = one_child(NodeType::Distortion, s.children[0], paint);
        if (result) add(*result, "Map", std::move(*map_steps));
        return push(std::move(result));
    }
    case ir::MapKind::Revolve: return push(left_out(id, "flat shapes"));
    }
}

void TreeWriter::repeat(ShapeId id, const Paint &paint, std::vector<TreeNode> &out) {
    const Shape &s = shape(id);
    const ir::Repetition &r = scene_.shapes.repetitions[s.payload];
    static constexpr const char *axes[] = {"X", "Y", "Z"};
    const auto refuse = [&](const char *what) { left_out(id, what); };
    if (s.dims == 2) return refuse("flat shapes");
    if (r.polar) {
        const auto count = numbers_.number(s.args[0]);
        if (!count) return refuse("a repetition that is no number");
        if (!r.id) {
            auto result = one_child(NodeType::Deformation, s.children[0], paint);
            if (!result) return;
            add(*result, "Function", yaml_word("repeat_polar"));
            add(*result, "Arguments",
                yaml_mapping({{"n", yaml_scalar(*count)}, {"axis", yaml_word(axes[r.axis])}}));
            out.push_back(std::move(*result));
            return;
        }
        if (*count > most_copies) return refuse("so many copies that differ");
        for (int i = 0; i < static_cast<int>(*count); ++i) {
            numbers_.set(r.id, {ir::Type::Vec3, {double(i), 0, 0}});
            TreeNode held;
            united(s.children[0], paint, held.children);
            if (held.children.empty()) continue;
            if (i == 0) {
                for (TreeNode &child : held.children) out.push_back(std::move(child));
                continue;
            }
            double angles[3] = {0, 0, 0};
            angles[r.axis] = shortest_near(-360.0 * i / *count);
            TreeNode turned = made(NodeType::Rotation);
            add(turned, "Angles", yaml_xyz(angles[0], angles[1], angles[2]));
            turned.children = std::move(held.children);
            out.push_back(std::move(turned));
        }
        return;
    }
    const auto cell = numbers_.vector(s.args[0]);
    const auto count = s.args.size() > 1 && s.args[1]
                           ? numbers_.vector(s.args[1])
                           : std::optional(std::array<double, 3>{1e9, 1e9, 1e9});
    if (!cell || !count) return refuse("a repetition that is no number");
    std::array<double, 3> size{}, copies{};
    bool finite = true;
    for (std::size_t i = 0; i < 3; ++i) {
        size[i] = r.along[i] ? (*cell)[i] : 0;
        copies[i] = !r.along[i]          ? 1
                    : (*count)[i] >= 1e8 ? std::numeric_limits<double>::infinity()
                                         : (*count)[i];
        finite = finite && std::isfinite(copies[i]);
    }
    if (!r.id) {
        auto result = one_child(r.mirrored ? NodeType::Deformation : NodeType::Repetition,
                                s.children[0], paint);
        if (!result) return;
        if (r.mirrored) {
            add(*result, "Function", yaml_word("repeat_mirror"));
            add(*result, "Arguments",
                yaml_mapping({{"cell", yaml_xyz(size[0], size[1], size[2])}}));
        } else {
            add(*result, "Cell", yaml_xyz(size[0], size[1], size[2]));
            bool counted = false;
            for (std::size_t i = 0; i < 3; ++i)
                counted = counted || (r.along[i] && std::isfinite(copies[i]));
            for (std::size_t i = 0; i < 3; ++i)
                copies[i] = r.along[i] ? copies[i] : std::numeric_limits<double>::infinity();
            if (counted) add(*result, "Count", yaml_xyz(copies[0], copies[1], copies[2]));
        }
        out.push_back(std::move(*result));
        return;
    }
    if (!finite) return refuse("a repetition without end whose copies differ");
    if (copies[0] * copies[1] * copies[2] > most_copies)
        return refuse("so many copies that differ");
    for (int x = 0; x < static_cast<int>(copies[0]); ++x) {
        for (int y = 0; y < static_cast<int>(copies[1]); ++y) {
            for (int z = 0; z < static_cast<int>(copies[2]); ++z) {
                numbers_.set(r.id, {ir::Type::Vec3, {double(x), double(y), double(z)}});
                const double index[3] = {double(x), double(y), double(z)};
                double moved[3];
                for (std::size_t i = 0; i < 3; ++i)
                    moved[i] = -(index[i] - (copies[i] - 1) / 2) * size[i];
                TreeNode copy = made(NodeType::Translation);
                add(copy, "Vector", yaml_xyz(moved[0], moved[1], moved[2]));
                united(s.children[0], paint, copy.children);
                if (!copy.children.empty()) out.push_back(std::move(copy));
            }
        }
    }
}

std::optional<TreeNode> TreeWriter::intersection(ShapeId id, const Paint &paint) {
    std::vector<TreeNode> kept, taken;
    bool nothing = false, cut = false;
    const auto collect = [&](auto &self, ShapeId at) -> void {
        for (ShapeId child : shape(at).children) {
            child = bare(child);
            if (shape(child).kind == ShapeKind::Complement) {
                cut = true;
                united(shape(child).children[0], paint, taken);
                continue;
            }
            const auto &inner = shape(child).children;
            const bool plain = shape(child).kind == ShapeKind::Intersection &&
                               std::none_of(inner.begin(), inner.end(), [&](ShapeId part) {
                                   return shape(bare(part)).kind == ShapeKind::Complement;
                               });
            if (plain && at == id) {
                self(self, child);
            } else if (auto operand = single(child, paint)) {
                kept.push_back(std::move(*operand));
            } else {
                nothing = true;
            }
        }
    };
    collect(collect, id);
    if (nothing) return std::nullopt;
    if (kept.empty()) { // only complements: not (a or b)
        TreeNode result = made(NodeType::Complement);
        result.children = std::move(taken);
        return result;
    }
    TreeNode result = made(NodeType::Intersection);
    if ((taken.empty() && !cut) || kept.size() > 1) {
        result.children = std::move(kept);
        if (taken.empty() && !cut)
            return result.children.size() == 1 ? std::move(result.children[0]) : std::move(result);
        kept.clear();
        kept.push_back(std::move(result));
    }
    TreeNode difference = made(NodeType::Difference);
    difference.children = std::move(kept);
    for (TreeNode &other : taken) difference.children.push_back(std::move(other));
    return difference;
}

std::optional<TreeNode> TreeWriter::profile_blend(ShapeId id, bool complemented,
                                                  const Paint &paint) {
    const Shape &s = shape(id);
    static constexpr const char *profiles[] = {"Smooth", "Round", "Chamfer", "Stairs", "Columns"};
    std::vector<ShapeId> children = s.children;
    std::size_t profile = s.payload;
    if (s.kind == ShapeKind::Many) {
        profile = 0;
        const auto listed = scene_.shapes.listed.find(id);
        if (listed == scene_.shapes.listed.end()) return left_out(id, "a smooth union of a family");
        children = listed->second;
    }
    const auto radius = numbers_.number(s.args[0]);
    const auto count = s.args.size() > 1 ? numbers_.number(s.args[1]) : std::optional(0.0);
    if (!radius || !count) return left_out(id, "a blend whose size is no number");
    std::vector<bool> negative;
    for (ShapeId &child : children) {
        child = bare(child);
        negative.push_back(shape(child).kind == ShapeKind::Complement);
        if (complemented && negative.back()) child = shape(child).children[0];
    }
    const bool all = std::all_of(negative.begin(), negative.end(), [](bool b) { return b; });
    const bool first =
        negative[0] && std::none_of(negative.begin() + 1, negative.end(), [](bool b) { return b; });
    if (complemented && !all && !first) return std::nullopt;
    TreeNode result = made(NodeType::ProfileBlend);
    add(result, "Operation",
        yaml_word(!complemented ? "Union"
                  : all         ? "Intersection"
                                : "Difference"));
    add(result, "Profile", yaml_word(profiles[std::min<std::size_t>(profile, 4)]));
    add(result, "Radius", yaml_scalar(*radius));
    if (profile >= 3) add(result, "Count", yaml_scalar(*count));
    for (const ShapeId child : children) {
        if (auto operand = single(child, paint)) result.children.push_back(std::move(*operand));
    }
    return result;
}

std::optional<TreeNode> TreeWriter::lerp(ShapeId id, const Paint &paint) {
    const Shape &s = shape(id);
    ir::Graph &graph = numbers_.graph();
    TreeNode result = made(NodeType::Blend);
    const NodeId t = numbers_.reduced(s.args[0]);
    if (const auto factor = graph.as_number(t)) {
        add(result, "Factor", yaml_scalar(*factor));
    } else {
        // 2.14: clamp(length(p - center), 0, 1)
        std::optional<std::array<double, 3>> center;
        if (graph[t].op == ir::Op::Clamp && graph[graph.arg(t, 0)].op == ir::Op::Length &&
            graph.as_number(graph.arg(t, 1)) == 0.0 && graph.as_number(graph.arg(t, 2)) == 1.0) {
            const NodeId from = graph.arg(graph.arg(t, 0), 0);
            if (from == graph.point()) center = std::array<double, 3>{};
            if (graph[from].op == ir::Op::Sub && graph.arg(from, 0) == graph.point())
                center = numbers_.vector(graph.arg(from, 1));
            if (graph[from].op == ir::Op::Add) {
                for (int i = 0; i < 2; ++i) {
                    if (graph.arg(from, i) != graph.point()) continue;
                    center = numbers_.vector(graph.arg(from, 1 - i));
                    if (center)
                        for (double &part : *center) part = -part;
                }
            }
        }
        if (center) {
            add(result, "Center", yaml_xyz((*center)[0], (*center)[1], (*center)[2]));
        } else {
            auto field_steps = steps(t, id, "a blend by a function");
            if (!field_steps) return std::nullopt;
            add(result, "Factor Field", std::move(*field_steps));
        }
    }
    auto first = single(s.children[0], paint);
    std::vector<TreeNode> rest;
    united(s.children[1], paint, rest);
    if (!first || rest.empty()) return left_out(id, "a blend with something that is left out");
    result.children.push_back(std::move(*first));
    for (TreeNode &other : rest) result.children.push_back(std::move(other));
    return result;
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

std::optional<TreeNode> TreeWriter::node(ShapeId id, const Paint &paint) {
    const Shape &s = shape(id);
    if (s.dims == 2) return left_out(id, "flat shapes");
    switch (s.kind) {
    case ShapeKind::Leaf: return field(id, nullptr, paint);
    case ShapeKind::Within: {
        const ShapeId child = bare(s.children[0]);
        const ir::Region &limits = scene_.shapes.regions[s.payload];
        if (shape(child).kind == ShapeKind::Leaf) return field(child, &limits, paint);
        if (shape(child).kind == ShapeKind::Map) {
            auto result = single(child, paint);
            auto value = region(limits);
            const bool takes_region =
                result && (result->type == "Distortion" || result->type == "Hyperize");
            if (takes_region && value) {
                add(*result, "Within", std::move(*value));
                return result;
            }
        }
        return left_out(id, "this use of `within:`");
    }
    case ShapeKind::Intersection: return intersection(id, paint);
    case ShapeKind::Complement: {
        const ShapeId child = bare(s.children[0]);
        if (shape(child).kind == ShapeKind::Blend || shape(child).kind == ShapeKind::Many) {
            if (shape(child).args.size() > 0)
                if (auto blend = profile_blend(child, true, paint)) return blend;
        }
        return one_child(NodeType::Complement, s.children[0], paint);
    }
    case ShapeKind::Blend:
    case ShapeKind::Many: return profile_blend(id, false, paint);
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
        const auto exponent = numbers_.number(s.args[0]);
        auto first = single(s.children[0], paint);
        std::vector<TreeNode> rest;
        united(s.children[1], paint, rest);
        if (!exponent || !first || rest.empty()) return left_out(id, "this pseudo-norm blend");
        TreeNode result = made(NodeType::PseudoNormBlend);
        add(result, "Exponent", yaml_scalar(*exponent));
        result.children.push_back(std::move(*first));
        for (TreeNode &other : rest) result.children.push_back(std::move(other));
        return result;
    }
    case ShapeKind::Offset: {
        const auto distance = numbers_.number(s.args[0]);
        if (!distance) return left_out(id, "an offset that is no number");
        auto result = one_child(NodeType::Offset, s.children[0], paint);
        if (result) add(*result, "Distance", yaml_scalar(*distance));
        return result;
    }
    case ShapeKind::Shell: {
        const auto thickness = numbers_.number(s.args[0]);
        if (!thickness) return left_out(id, "a shell that is no number");
        auto result = one_child(NodeType::Deformation, s.children[0], paint);
        if (!result) return result;
        add(*result, "Function", yaml_word("shell"));
        add(*result, "Arguments", yaml_mapping({{"thickness", yaml_scalar(*thickness)}}));
        return result;
    }
    case ShapeKind::Displace: {
        auto field_steps = steps(s.args[0], id, "a displacement");
        if (!field_steps) return single(s.children[0], paint); // reported; the shape itself stays
        auto result = one_child(NodeType::Displacement, s.children[0], paint);
        if (result) add(*result, "Field", std::move(*field_steps));
        return result;
    }
    case ShapeKind::Library: return library(id, paint);
    case ShapeKind::Seam: return left_out(id, "a seam's profile");
    case ShapeKind::Extrude: return left_out(id, "flat shapes");
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

} // namespace

Numbers::Numbers(const ir::Scene &scene) : graph_(scene.graph) {
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
}

NodeId Numbers::reduced(NodeId id) {
    return values_.empty() ? id : ir::substitute(graph_, id, values_);
}

std::optional<ir::Constant> Numbers::constant(NodeId id) {
    if (!id) return std::nullopt;
    const NodeId node = graph_.is_constant(id) ? id : reduced(id);
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
    values_[variable] = graph_.constant(value);
}

std::vector<TreeNode> export_tree(const ir::Scene &scene, Numbers &numbers,
                                  const MaterialName &material_name, Diagnostics &diagnostics) {
    TreeWriter writer(scene, numbers, material_name, diagnostics);
    std::vector<TreeNode> nodes;
    for (const ir::TopLevel &top : scene.top_level) writer.united(top.shape, {}, nodes);
    return nodes;
}

} // namespace fathom::save
