// Fields that are steep in places: their bounds cell by cell of a region (semantics.md, 13), as a
// table with a row a corner. A mean of a cell's corners is no less than the cell's own bound, and
// it is continuous; it holds in the cell grown by its margin.
#include "ir/lower/lowering.h"

#include <algorithm>
#include <cmath>

namespace fathom::ir {

// Slope and, where it is known, bend.
static Table corner_table(const CellBounds &cells) {
    constexpr double maximum = 1e30; // of a float, squared in no shader
    const auto above = [&](double x) {
        return std::nextafter(static_cast<float>(std::min(x, maximum)), INFINITY);
    };
    Table table;
    table.rows = static_cast<int>(cells.lipschitz.size());
    table.stride = cells.bend.empty() ? 1 : 2;
    for (std::size_t i = 0; i < cells.lipschitz.size(); ++i) {
        table.data.push_back(above(cells.lipschitz[i]));
        if (!cells.bend.empty()) table.data.push_back(above(cells.bend[i]));
    }
    return table;
}

Lowering::InCell Lowering::in_cell(ShapeId id, NodeId q) {
    Graph &g = graph_;
    const CellBounds &cells = fact(id).cells;
    std::array<double, 3> size{}, lo = cells.box.lo, last{};
    for (std::size_t i = 0; i < 3; ++i) {
        size[i] = (cells.box.hi[i] - lo[i]) / cells.count[i];
        last[i] = cells.count[i] - 1;
    }
    const NodeId u = g.div(g.sub(q, g.vec(lo)), g.vec(size)); // in cells
    const NodeId cell =
        g.make(Op::Clamp, {g.make(Op::Floor, {u}), g.vec(std::array<double, 3>{}), g.vec(last)});
    const std::array<double, 3> strides{1, cells.count[0] + 1.0,
                                        (cells.count[0] + 1.0) * (cells.count[1] + 1.0)};
    const NodeId first = g.make(Op::ToInt, Type::Int,
                                {g.add(g.make(Op::Dot, {cell, g.vec(strides)}), g.number(0.5))});
    const auto found = cell_tables_.try_emplace(id);
    if (found.second) found.first->second = g.add_table(corner_table(cells));
    const NodeId part = g.make(Op::Clamp, {g.sub(u, cell), g.vec(std::array<double, 3>{}),
                                           g.vec(std::array{1.0, 1.0, 1.0})});
    const Type type = cells.bend.empty() ? Type::Float : Type::Vec2;
    std::vector<NodeId> bounds;
    for (int corner = 0; corner < 8; ++corner) {
        const double row = corner % 2 + corner / 2 % 2 * strides[1] + corner / 4 * strides[2];
        bounds.push_back(
            g.make(Op::TableRead, type,
                   {g.make(Op::Add, Type::Int, {first, g.integer(static_cast<int>(row))})},
                   table_slot(found.first->second, 0)));
    }
    for (int axis = 0; axis < 3; ++axis) {
        NodeId by = g.component(part, axis);
        if (type == Type::Vec2) by = g.make(Op::Splat, type, {by});
        std::vector<NodeId> mixed;
        for (std::size_t i = 0; i < bounds.size(); i += 2)
            mixed.push_back(g.make(Op::Mix, {bounds[i], bounds[i + 1], by}));
        bounds = std::move(mixed);
    }
    // |u - middle| cells from the middle; the walls are half a cell from there.
    const NodeId from_middle =
        g.make(Op::Abs, {g.sub(u, g.add(cell, g.vec(std::array{0.5, 0.5, 0.5})))});
    const NodeId left = g.mul(g.sub(g.vec(std::array{0.5, 0.5, 0.5}), from_middle), g.vec(size));
    const NodeId wall =
        g.make(Op::Min, {g.component(left, 0),
                         g.make(Op::Min, {g.component(left, 1), g.component(left, 2)})});
    const bool both = type == Type::Vec2;
    return {both ? g.component(bounds.front(), 0) : bounds.front(),
            both ? g.component(bounds.front(), 1) : NodeId{}, g.add(wall, g.number(cells.margin))};
}

// The step ends with the cell, if it is longer than what the bound for all of the region gives.
NodeId Lowering::divided_by_cells(ShapeId id, NodeId field, NodeId q) {
    Graph &g = graph_;
    const InCell here = in_cell(id, q);
    const NodeId whole = divided(shape(id).children.front(), field);
    const NodeId reach = g.make(Op::Max, {here.wall, g.make(Op::Abs, {whole})});
    return g.make(Op::Clamp, {g.div(field, here.slope), g.neg(reach), reach});
}

// Its safe radius by curvature: sqrt(2 f/M), as far as the cell's M holds and the field is the
// region's. Where the least of the field on a way lies nearer than that, it lies within both, and
// the slope along the way is 0 there (lipschitz.md, 4).
NodeId Lowering::bent_by_cells(ShapeId id, Where frame) {
    Graph &g = graph_;
    const NodeId p = frame.p;
    const Region region = region_of(id, frame);
    const InCell here = in_cell(id, region_nearest(g, region, p));
    const NodeId field = expression_of(Reading::Raw, shape(id).children.front(), inside(id, frame));
    const NodeId bent = g.make(
        Op::Sqrt, {g.make(Op::Max, {g.mul(field, g.div(g.number(2), here.bend)), g.number(0)})});
    const NodeId held = g.make(Op::Min, {here.wall, g.neg(region_distance(g, region, p))});
    return g.make(Op::Min, {bent, held});
}

} // namespace fathom::ir
