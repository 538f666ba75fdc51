// Intersections, differences and blends of shapes, as nodes: a part that is complemented is what a
// difference takes away.
#include "save-format/export/tree_writer.h"

#include <algorithm>

namespace fathom::save {

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
    if (s.kind == ShapeKind::Instances) {
        profile = 0;
        const auto listed = scene_.shapes.listed.find(id);
        if (listed == scene_.shapes.listed.end())
            return otherwise(id, paint, "a smooth union of instances");
        children = listed->second;
    }
    const auto radius = numbers_.number(s.args[0]);
    const auto count = s.args.size() > 1 ? numbers_.number(s.args[1]) : std::optional(0.0);
    if (!radius || !count) return otherwise(id, paint, "a blend whose size is no number");
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
    number(result, "Radius", s.args[0]);
    if (profile >= 3) number(result, "Count", s.args[1]);
    for (const ShapeId child : children) {
        if (auto operand = single(child, paint)) result.children.push_back(std::move(*operand));
    }
    return result;
}

std::optional<TreeNode> TreeWriter::seam(ShapeId id, const Paint &paint) {
    const Shape &s = shape(id);
    static constexpr const char *names[] = {"Pipe", "Engrave", "Groove", "Tongue"};
    const auto radius = numbers_.number(s.args[0]);
    const auto depth = s.args.size() > 1 ? numbers_.number(s.args[1]) : std::optional(0.0);
    auto first = single(s.children[0], paint);
    std::vector<TreeNode> rest;
    united(s.children[1], paint, rest);
    if (!radius || !depth || !first || rest.empty()) return otherwise(id, paint, "this seam");
    TreeNode result = made(NodeType::Seam);
    add(result, "Profile", yaml_word(names[s.payload]));
    number(result, "Radius", s.args[0]);
    if (s.payload >= 2) number(result, "Depth", s.args[1]);
    result.children.push_back(std::move(*first));
    for (TreeNode &other : rest) result.children.push_back(std::move(other));
    return result;
}

std::optional<TreeNode> TreeWriter::lerp(ShapeId id, const Paint &paint) {
    const Shape &s = shape(id);
    ir::Graph &graph = numbers_.graph();
    const int functions = functions_;
    TreeNode result = made(NodeType::Blend);
    const NodeId t = numbers_.reduced(s.args[0]);
    if (!number(result, "Factor", t)) {
        // 2.14: clamp(length(p - center), 0, 1)
        NodeId center;
        if (graph[t].op == ir::Op::Clamp && graph[graph.arg(t, 0)].op == ir::Op::Length &&
            graph.as_number(graph.arg(t, 1)) == 0.0 && graph.as_number(graph.arg(t, 2)) == 1.0) {
            const NodeId from = graph.arg(graph.arg(t, 0), 0);
            if (from == graph.point()) center = graph.vec3(0, 0, 0);
            if (graph[from].op == ir::Op::Sub && graph.arg(from, 0) == graph.point())
                center = graph.arg(from, 1);
            if (graph[from].op == ir::Op::Add) {
                for (int i = 0; i < 2; ++i)
                    if (graph.arg(from, i) == graph.point())
                        center = graph.make(ir::Op::Neg, {graph.arg(from, 1 - i)});
            }
        }
        if (!center || !vector(result, "Center", center)) {
            auto field_steps = steps(t);
            if (!field_steps) return otherwise(id, paint, "a blend by this function");
            add(result, "Factor Field", std::move(*field_steps));
        }
    }
    auto first = single(s.children[0], paint);
    std::vector<TreeNode> rest;
    united(s.children[1], paint, rest);
    if (!first || rest.empty())
        return otherwise(id, paint, "a blend with something that is left out");
    // Where the factor varies, both have to end somewhere.
    if (functions_ != functions && !numbers_.number(t))
        return otherwise(id, paint, "this blend by a function");
    result.children.push_back(std::move(*first));
    for (TreeNode &other : rest) result.children.push_back(std::move(other));
    return result;
}

} // namespace fathom::save
