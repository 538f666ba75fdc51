// Movements, deformations and repetitions of shapes, as nodes: known by the maps of space that the
// library makes of them; any other map is written as its steps.
#include "ir/maps.h"
#include "save-format/export/tree_writer.h"
#include "save-format/program.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <unordered_set>
#include <utility>

namespace fathom::save {
namespace {

constexpr double degree = std::numbers::pi / 180;

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

// 1 / x; of a scale that was read from factors, these.
NodeId reciprocal(ir::Graph &graph, NodeId one, NodeId x) {
    if (graph[x].op == ir::Op::Div && graph.arg(x, 0) == one) return graph.arg(x, 1);
    return graph.make(ir::Op::Div, {one, x});
}

} // namespace

// 30, where the arithmetic left 29.999999999999996.
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

// A turn by an angle that follows params or time about an axis that does not: the object's own, as
// the library makes it of both.
bool TreeWriter::varying_turn(TreeNode &node, NodeId matrix) {
    ir::Graph &graph = numbers_.graph();
    matrix = numbers_.reduced(matrix);
    std::vector<NodeId> open{matrix}, angles;
    std::unordered_set<NodeId> seen;
    while (!open.empty()) {
        const NodeId at = open.back();
        open.pop_back();
        if (!seen.insert(at).second) continue;
        if (graph[at].op == ir::Op::Sin) angles.push_back(graph.arg(at, 0));
        open.insert(open.end(), graph.args(at).begin(), graph.args(at).end());
    }
    for (const NodeId angle : angles) {
        if (graph.is_constant(angle)) continue;
        // the axis is what a turn by 1 leaves of R - R'
        const NodeId turned = ir::substitute(graph, matrix, {{angle, graph.number(1)}});
        if (!graph.is_constant(turned)) continue;
        const auto m = graph.constant_of(turned).value;
        std::array<double, 3> axis{m[5] - m[7], m[6] - m[2], m[1] - m[3]};
        for (double &part : axis) part = std::abs(part) < 1e-12 ? 0 : part / (2 * std::sin(1.0));
        for (double &part : axis) part = shortest_near(part);
        const double length = std::hypot(axis[0], axis[1], axis[2]);
        if (std::abs(length - 1) > 1e-9) continue;
        const NodeId same = ir::rotation(graph, graph.vec3(axis[0], axis[1], axis[2]), angle);
        bool equal = true; // at some angles, up to rounding
        for (const double test : {0.3, 2.1, -1.2}) {
            const NodeId a = ir::substitute(graph, matrix, {{angle, graph.number(test)}}),
                         b = ir::substitute(graph, same, {{angle, graph.number(test)}});
            equal = equal && graph.is_constant(a) && graph.is_constant(b);
            for (std::size_t i = 0; equal && i < 9; ++i)
                equal =
                    std::abs(graph.constant_of(a).value[i] - graph.constant_of(b).value[i]) < 1e-9;
        }
        if (!equal) continue;
        add(node, "Axis", yaml_xyz(axis[0], axis[1], axis[2]));
        return number(node, "Angle", angle);
    }
    return false;
}

// Long: a case for each kind of map.
void TreeWriter::map(ShapeId id, const Paint &paint, std::vector<TreeNode> &out) {
    const Shape &s = shape(id);
    ir::Graph &graph = numbers_.graph();
    const auto push = [&](std::optional<TreeNode> result) {
        if (result) out.push_back(std::move(*result));
    };
    if (s.dims == 2) return push(flat_map(id, paint));
    static constexpr const char *axes[] = {"X", "Y", "Z"};
    switch (s.map) {
    case ir::MapKind::Translate: {
        const auto by = numbers_.vector(s.args[2]);
        if (!by) return push(otherwise(id, paint, "a movement that is no number"));
        if (*by == std::array<double, 3>{} && !numbers_.varies(s.args[2]))
            return united(s.children[0], paint, out);
        auto result = one_child(NodeType::Translation, s.children[0], paint);
        if (result) vector(*result, "Vector", graph.make(ir::Op::Neg, {s.args[2]}));
        return push(std::move(result));
    }
    case ir::MapKind::Rotate: {
        const auto matrix = numbers_.constant(s.args[2]);
        if (!matrix) return push(otherwise(id, paint, "a rotation that is no number"));
        const auto &m = matrix->value;
        const double det = m[0] * (m[4] * m[8] - m[5] * m[7]) - m[3] * (m[1] * m[8] - m[2] * m[7]) +
                           m[6] * (m[1] * m[5] - m[2] * m[4]);
        ir::Constant turn = *matrix;
        bool identity = true;
        for (std::size_t i = 0; i < 9; ++i)
            identity = identity && std::abs(m[i] - (i % 4 == 0 ? 1 : 0)) < 1e-15;
        const bool varies = numbers_.varies(s.args[2]);
        if (varies && det < 0) return push(otherwise(id, paint, "a reflection that varies"));
        if (identity && !varies) return united(s.children[0], paint, out);
        // A reflection in planes of the axes is a scaling; any other is one in x, then the rotation
        // that is left.
        bool diagonal = det < 0;
        for (std::size_t i = 0; i < 9; ++i)
            diagonal = diagonal && (i % 4 == 0 ? std::abs(m[i]) == 1 : m[i] == 0);
        if (diagonal) {
            auto result = one_child(NodeType::Scaling, s.children[0], paint);
            if (result) add(*result, "Factors", yaml_xyz(m[0], m[4], m[8]));
            return push(std::move(result));
        }
        TreeNode inner = made(NodeType::Rotation);
        united(s.children[0], paint, inner.children);
        if (inner.children.empty()) return;
        if (det < 0) {
            TreeNode mirror = made(NodeType::Scaling);
            add(mirror, "Factors", yaml_xyz(-1, 1, 1));
            mirror.children = std::move(inner.children);
            for (std::size_t i = 0; i < 3; ++i) turn.value[i] = -turn.value[i];
            return rotation(turn, std::move(mirror), out);
        }
        std::vector<TreeNode> children = std::move(inner.children);
        TreeNode held;
        rotation(turn, std::move(held), out);
        if (varies && !varying_turn(out.back(), s.args[2])) {
            out.pop_back();
            return push(otherwise(id, paint, "a rotation about an axis that varies"));
        }
        out.back().children = std::move(children);
        return;
    }
    case ir::MapKind::Scale: {
        const auto by = numbers_.vector(s.args[2]);
        if (!by) return push(otherwise(id, paint, "a scale that is no number"));
        const bool varies = numbers_.varies(s.args[2]);
        if (*by == std::array<double, 3>{1, 1, 1} && !varies)
            return united(s.children[0], paint, out);
        auto result = one_child(NodeType::Scaling, s.children[0], paint);
        // the shortest number whose reciprocal the scale is
        const auto factor = [](double scale) {
            const double exact = 1 / scale, near = shortest_near(exact);
            return 1 / near == scale || 1 / exact != scale ? near : exact;
        };
        if (!result) return push(std::move(result));
        if (!varies) {
            add(*result, "Factors", yaml_xyz(factor((*by)[0]), factor((*by)[1]), factor((*by)[2])));
            return push(std::move(result));
        }
        NodeId scale = numbers_.reduced(s.args[2]); // one number where all three are the same
        const NodeId x = graph.component(scale, 0);
        if (x == graph.component(scale, 1) && x == graph.component(scale, 2)) scale = x;
        const NodeId one = scale == x ? graph.number(1) : graph.vec3(1, 1, 1);
        const NodeId factors = reciprocal(graph, one, scale);
        std::array<double, 3> now{};
        for (int i = 0; i < 3; ++i)
            now[static_cast<std::size_t>(i)] =
                numbers_.number(scale == x ? factors : graph.component(factors, i)).value_or(1);
        add(*result, "Factors", yaml_xyz(now[0], now[1], now[2]));
        vary(*result, "Factors", factors);
        return push(std::move(result));
    }
    case ir::MapKind::Twist: {
        const auto rate = numbers_.number(s.args[2]);
        if (!rate) return push(otherwise(id, paint, "a twist that is no number"));
        if (*rate == 0 && !numbers_.varies(s.args[2])) return united(s.children[0], paint, out);
        auto result = deformed(id, NodeType::Twist, paint);
        if (result && result->type == made(NodeType::Field).type) return push(std::move(result));
        if (result) {
            number(*result, "Rate", graph.make(ir::Op::Neg, {s.args[2]}));
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
        if (!first || !from || !to)
            return push(otherwise(id, paint, "a deformation that is no number"));
        auto result = deformed(id, NodeType::Deformation, paint);
        if (!result || result->type == made(NodeType::Field).type) return push(std::move(result));
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
        vary(*result, bend ? "rate" : "ratio", s.args[2]);
        if (!bend) vary(*result, "from", s.args[3]), vary(*result, "to", s.args[4]);
        return push(std::move(result));
    }
    case ir::MapKind::MirrorFold: {
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
        auto map_steps = steps(q);
        if (!map_steps) return push(otherwise(id, paint, "this map of space"));
        auto result = one_child(NodeType::Distortion, s.children[0], paint);
        if (result) add(*result, "Map", std::move(*map_steps));
        return push(std::move(result));
    }
    case ir::MapKind::Revolve: return push(raised(id, "revolve", "offset", s.args[2], paint));
    }
}

// A deformation wants to know where its shape ends, which a function does not say. So where there
// is one below it, it becomes a function itself; or, so that the paints below are kept, each
// function goes out with its box.
std::optional<TreeNode> TreeWriter::deformed(ShapeId id, NodeType type, const Paint &paint) {
    const int functions = functions_;
    const bool boxed = std::exchange(boxed_, boxed_ || painted_within(id));
    auto result = one_child(type, shape(id).children[0], paint);
    const bool whole = functions_ != functions && !boxed_;
    boxed_ = boxed;
    return whole ? otherwise(id, paint, "this deformation") : std::move(result);
}

// The copies of what is written as a function have no ends that an import could know: then the
// whole repetition is one.
void TreeWriter::repeat(ShapeId id, const Paint &paint, std::vector<TreeNode> &out) {
    const int functions = functions_;
    const std::size_t before = out.size();
    copies(id, paint, out);
    if (functions_ == functions || scene_.shapes.repetitions[shape(id).payload].id) return;
    out.resize(before);
    if (auto whole = otherwise(id, paint, "this repetition")) out.push_back(std::move(*whole));
}

void TreeWriter::copies(ShapeId id, const Paint &paint, std::vector<TreeNode> &out) {
    const Shape &s = shape(id);
    const ir::Repetition &r = scene_.shapes.repetitions[s.payload];
    static constexpr const char *axes[] = {"X", "Y", "Z"};
    const auto refuse = [&](const char *what) {
        if (auto result = otherwise(id, paint, what)) out.push_back(std::move(*result));
    };
    if (r.polar) {
        const auto count = numbers_.number(s.args[0]);
        if (!count) return refuse("a repetition that is no number");
        auto result = copied(NodeType::Deformation, id, paint);
        if (!result) return;
        add(*result, "Function", yaml_word("repeat_polar"));
        Value arguments = yaml_mapping({{"n", yaml_scalar(*count)}});
        if (s.dims == 3) arguments.entries.emplace_back("axis", yaml_word(axes[r.axis]));
        add(*result, "Arguments", std::move(arguments));
        out.push_back(std::move(*result));
        return;
    }
    const auto cell = numbers_.vector(s.args[0]);
    const auto count = s.args.size() > 1 && s.args[1]
                           ? numbers_.vector(s.args[1])
                           : std::optional(std::array<double, 3>{1e9, 1e9, 1e9});
    if (!cell || !count) return refuse("a repetition that is no number");
    std::array<double, 3> size{}, copies{};
    for (std::size_t i = 0; i < 3; ++i) {
        size[i] = r.along[i] ? (*cell)[i] : 0;
        copies[i] = !r.along[i]          ? 1
                    : (*count)[i] >= 1e8 ? std::numeric_limits<double>::infinity()
                                         : (*count)[i];
    }
    auto result = copied(r.mirrored ? NodeType::Deformation : NodeType::Repetition, id, paint);
    if (!result) return;
    if (r.mirrored) {
        add(*result, "Function", yaml_word("repeat_mirror"));
        add(*result, "Arguments", yaml_mapping({{"cell", yaml_xyz(size[0], size[1], size[2])}}));
        vary(*result, "cell", s.args[0]);
    } else {
        add(*result, "Cell", yaml_xyz(size[0], size[1], size[2]));
        vary(*result, "Cell", s.args[0]);
        bool counted = false;
        for (std::size_t i = 0; i < 3; ++i)
            counted = counted || (r.along[i] && std::isfinite(copies[i]));
        for (std::size_t i = 0; i < 3; ++i)
            copies[i] = r.along[i] ? copies[i] : std::numeric_limits<double>::infinity();
        if (counted) add(*result, "Count", yaml_xyz(copies[0], copies[1], copies[2]));
        if (s.dims == 2) add(*result, "Flat", yaml_switch(true));
    }
    out.push_back(std::move(*result));
}

// The child of a repetition. Where copies differ it is what copy 0 is, and numbers say how they
// follow the copy.
std::optional<TreeNode> TreeWriter::copied(NodeType type, ShapeId id, const Paint &paint) {
    const ir::Repetition &r = scene_.shapes.repetitions[shape(id).payload];
    if (!r.id) return one_child(type, shape(id).children[0], paint);
    numbers_.open_copies(r.id);
    const bool boxed = std::exchange(boxed_, true); // functions of a copy end where it does
    auto result = one_child(type, shape(id).children[0], paint);
    boxed_ = boxed;
    numbers_.close_copies();
    if (result) add(*result, "Differ", yaml_switch(true));
    return result;
}

} // namespace fathom::save
