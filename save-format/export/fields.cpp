// Functions of the point, as nodes: a user-defined field, with its region and what is assumed of
// it; and any shape that nodes have no words for, as the raw field that it is.
#include "ir/lower/lower.h"
#include "ir/passes/walk.h"
#include "save-format/export/tree_writer.h"

#include <algorithm>

namespace fathom::save {

// The corners of a box as the text has them, where they follow params or time: as the library makes
// the box of both, or by its centre and size.
std::array<NodeId, 2> TreeWriter::corners(const ir::Region &box) {
    ir::Graph &graph = numbers_.graph();
    const NodeId half = graph.number(0.5);
    if (graph[box.size].op == ir::Op::Sub) {
        const NodeId high = graph.arg(box.size, 0), low = graph.arg(box.size, 1);
        const std::array<NodeId, 2> halves{graph.mul(low, half), graph.mul(high, half)};
        if (graph.add({halves[0], halves[1]}) == box.center) return {low, high};
    }
    const NodeId reach = graph.mul(box.size, half);
    const NodeId low = graph.sub(box.center, reach);
    return {low, graph.add(box.center, reach)};
}

std::optional<Value> TreeWriter::region(const ir::Region &region) {
    Value value, varying;
    value.kind = varying.kind = Value::Kind::Mapping;
    bool whole = true; // there are words for all that varies
    static constexpr const char *axes[] = {"X", "Y", "Z"};
    const auto put = [&](const char *key, Value present, NodeId follows) {
        value.entries.emplace_back(key, std::move(present));
        if (!follows || !numbers_.varies(follows)) return;
        auto program = steps(follows);
        whole = whole && program;
        if (program) varying.entries.emplace_back(key, std::move(*program));
    };
    const auto center = region.center ? numbers_.vector(region.center) : std::array<double, 3>{};
    switch (region.kind) {
    case ir::RegionKind::Everywhere: put("Everywhere", yaml_switch(true), {}); break;
    case ir::RegionKind::Ball: {
        const auto radius = numbers_.number(region.size);
        if (!radius || !center) return std::nullopt;
        put("Ball", yaml_scalar(*radius), region.size);
        put("Center", yaml_xyz((*center)[0], (*center)[1], (*center)[2]), region.center);
        break;
    }
    case ir::RegionKind::Box: {
        const auto size = numbers_.vector(region.size);
        if (!size || !center) return std::nullopt;
        std::array<double, 3> low{}, high{};
        for (std::size_t i = 0; i < 3; ++i)
            low[i] = (*center)[i] - (*size)[i] / 2, high[i] = (*center)[i] + (*size)[i] / 2;
        const auto ends = corners(region);
        put("Low", yaml_xyz(low[0], low[1], low[2]), ends[0]);
        put("High", yaml_xyz(high[0], high[1], high[2]), ends[1]);
        break;
    }
    case ir::RegionKind::Tube: {
        const auto radius = numbers_.number(region.size);
        if (!radius) return std::nullopt;
        put("Tube", yaml_scalar(*radius), region.size);
        put("Axis", yaml_word(axes[region.axis]), {});
        break;
    }
    }
    if (!whole) return std::nullopt;
    if (!varying.entries.empty()) value.entries.emplace_back("Varying", std::move(varying));
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
    auto field_steps = steps(s.args[0]);
    if (!field_steps) return no_field(id, "this function of the point: " + no_words);
    TreeNode result = made(NodeType::Field);
    add(result, "Field", std::move(*field_steps));
    if (within) {
        auto limits = region(*within);
        if (!limits) return no_field(id, "this region");
        add(result, "Within", std::move(*limits));
    }
    if (s.assumed > 0) add(result, "Assumed", yaml_scalar(s.assumed));
    if (s.estimate > 0) add(result, "Estimate", yaml_scalar(s.estimate));
    if (!paint.fill.empty()) add(result, "Material", yaml_word(paint.fill));
    return result;
}

// The shape's raw field as an expression in Point. The lowering knows what each kind computes: it
// gets one more shape, which consumes the raw field and changes nothing (an offset by 0),
// with every bound set to 1, so that nothing is divided. Made once for each shape.
NodeId TreeWriter::raw_field(ShapeId id) {
    if (const auto found = raw_.find(id); found != raw_.end()) return found->second;
    if (scene_.facts.size() != scene_.shapes.size())
        return {}; // not proved: no bound to write either
    ir::Graph &graph = numbers_.graph();
    if (!lowered_) {
        lowered_ = scene_;
        for (ir::ShapeFact &fact : lowered_->facts) {
            fact.lipschitz = graph.number(1);
            fact.guard = false;
        }
    }
    Shape whole;
    whole.kind = ShapeKind::Offset;
    whole.children = {id};
    whole.args = {graph.number(0)};
    // The lowering goes over all that there is.
    if (!numbers_.budget().take(scene_.shapes.size() + graph.size() / 8, 0)) return {};
    ir::ShapeFact fact;
    fact.lipschitz = graph.number(1);
    const ShapeId root = lowered_->shapes.add(std::move(whole));
    lowered_->facts.resize(lowered_->shapes.size(), fact);
    lowered_->root = root;
    lowered_->top_level = {{root, {}}};
    std::swap(lowered_->graph, graph);
    ir::lower(*lowered_);
    std::swap(lowered_->graph, graph);
    const ir::Function function = graph.function(lowered_->distance);
    const NodeId field =
        ir::substitute(graph, function.result, {{function.params[0], graph.point()}});
    raw_.emplace(id, field);
    return field;
}

bool TreeWriter::painted_within(ShapeId id) {
    if (const auto known = painted_within_.find(id); known != painted_within_.end())
        return known->second;
    const Shape &s = shape(id);
    const bool painted =
        s.kind == ShapeKind::Paint || s.kind == ShapeKind::Repaint ||
        std::ranges::any_of(s.children, [&](ShapeId child) { return painted_within(child); });
    painted_within_.emplace(id, painted);
    return painted;
}

std::optional<TreeNode> TreeWriter::otherwise(ShapeId id, const Paint &paint,
                                              const std::string &what) {
    const NodeId raw = raw_field(id);
    auto field_steps = raw ? steps(raw) : std::nullopt;
    if (!field_steps) return no_field(id, what);
    ++functions_;
    TreeNode result = made(NodeType::Field);
    add(result, "Field", std::move(*field_steps));
    const ir::ShapeFact &fact = scene_.facts[id.index];
    if (boxed_ && fact.bounds.finite() && !fact.bounds.empty()) {
        const auto &lo = fact.bounds.lo, &hi = fact.bounds.hi;
        add(result, "Within",
            yaml_mapping(
                {{"Low", yaml_xyz(lo[0], lo[1], lo[2])}, {"High", yaml_xyz(hi[0], hi[1], hi[2])}}));
        unsaved(diagnostics_, shape(id).origin,
                "the save format has no words for " + what +
                    ": it is written as a function of the "
                    "point within its box")
            .note("its surface is the same; away from it, the file has the distance to the box");
    } else if (fact.status == ir::ProofStatus::Proved && said_.insert(shape(id).origin).second) {
        Remark(diagnostics_, Diagnostic{Code::Unsupported,
                                        Severity::Note,
                                        "the save format has no words for " + what +
                                            ": it is written as a function of the point",
                                        {shape(id).origin, {}},
                                        {},
                                        {},
                                        {}})
            .note("its bound, proved here, stands beside it: where an import does not prove it "
                  "again, it is assumed");
    }
    add(result, "Assumed", yaml_scalar(fact.lipschitz_sup));
    if (!paint.fill.empty()) add(result, "Material", yaml_word(paint.fill));
    if (!paint.forced && painted_within(id))
        unsaved(
            diagnostics_, shape(id).origin,
            "the save format writes this as one function of the point, without the paints in it");
    return result;
}

std::optional<TreeNode> TreeWriter::no_field(ShapeId id, const std::string &what) {
    unsaved(diagnostics_, shape(id).origin, "the save format has no words for " + what)
        .note("it is left out of the file");
    return std::nullopt;
}

} // namespace fathom::save
