// Fields that are steep in places: what is known of them cell by cell of a region or of the box of a
// guard (semantics.md, 13), as a table with a row a cell. It holds in the cell grown by its margin.
// So a step's length may jump from cell to cell; no sign does.
#include "ir/lower/lowering.h"

#include <algorithm>
#include <cmath>

namespace fathom::ir {

// Of each cell its slope, the way to the surface (far below 0 where none is known) and, where it is
// known, the bend.
static Table cell_table(const CellBounds &cells) {
    constexpr double maximum = 1e30; // of a float, squared in no shader
    const auto above = [&](double x) {
        return std::nextafter(static_cast<float>(std::min(x, maximum)), INFINITY);
    };
    Table table;
    table.rows = static_cast<int>(cells.lipschitz.size());
    table.stride = cells.bend.empty() ? 2 : 3;
    for (std::size_t i = 0; i < cells.lipschitz.size(); ++i) {
        const double way = cells.way[i];
        table.data.push_back(above(cells.lipschitz[i]));
        table.data.push_back(way > 0 ? std::nextafter(static_cast<float>(way), 0.0f)
                                     : -static_cast<float>(nowhere));
        if (!cells.bend.empty()) table.data.push_back(above(cells.bend[i]));
    }
    return table;
}

Lowering::InCell Lowering::in_cell(ShapeId id, NodeId q) {
    Graph &g = graph_;
    const CellBounds &cells = scene_.cells.at(id);
    std::array<double, 3> size{}, often{}, lo = cells.box.lo, last{};
    for (std::size_t i = 0; i < 3; ++i) {
        size[i] = (cells.box.hi[i] - lo[i]) / cells.count[i];
        often[i] = 1 / size[i];
        last[i] = cells.count[i] - 1;
    }
    const NodeId u = g.mul(g.sub(q, g.vec(lo)), g.vec(often)); // in cells
    const NodeId cell =
        g.make(Op::Clamp, {g.make(Op::Floor, {u}), g.vec(std::array<double, 3>{}), g.vec(last)});
    const std::array<double, 3> strides{1, static_cast<double>(cells.count[0]),
                                        static_cast<double>(cells.count[0]) * cells.count[1]};
    const NodeId row = g.make(Op::ToInt, Type::Int,
                              {g.add({g.make(Op::Dot, {cell, g.vec(strides)}), g.number(0.5)})});
    const auto found = cell_tables_.try_emplace(id);
    if (found.second) found.first->second = g.add_table(cell_table(cells));
    const bool bends = !cells.bend.empty();
    const NodeId known = g.make(Op::TableRead, bends ? Type::Vec3 : Type::Vec2, {row},
                                table_slot(found.first->second, 0));
    // |u - middle| cells from the middle; the walls are half a cell from there.
    const std::array halves{0.5, 0.5, 0.5};
    const NodeId from_middle = g.make(Op::Abs, {g.sub(u, g.add(cell, g.vec(halves)))});
    const NodeId left = g.mul({g.sub(g.vec(halves), from_middle), g.vec(size)});
    const NodeId wall =
        g.make(Op::Min, {g.component(left, 0),
                         g.make(Op::Min, {g.component(left, 1), g.component(left, 2)})});
    return {g.component(known, 0), g.component(known, 1), bends ? g.component(known, 2) : NodeId{},
            g.add(wall, g.number(cells.margin))};
}

// The raw field of `of` at q, divided. The step ends with the cell, if it is longer than what the
// bound for all of the region gives. Outside, it goes as far at least as no cell has surface.
NodeId Lowering::divided_by_cells(ShapeId id, ShapeId of, NodeId field, NodeId q) {
    Graph &g = graph_;
    const InCell here = in_cell(id, q);
    NodeId slope = here.slope;
    if (const NodeId formula = fact(of).lipschitz; formula && !g.is_constant(formula))
        slope = g.make(Op::Min, {slope, g.make(Op::Max, {formula, g.number(1e-6)})});
    const NodeId whole = divided(of, field);
    const NodeId reach = g.make(Op::Max, {here.wall, g.make(Op::Abs, {whole})});
    return g.make(Op::Max,
                  {g.make(Op::Clamp, {g.div(field, slope), g.neg(reach), reach}), here.way});
}

// What has a guard, by cells of the guard's box: as what is confined to that region (shapes.cpp,
// within).
NodeId Lowering::marched_in_box(ShapeId id, Where frame) {
    const Box &box = scene_.cells.at(id).box;
    const NodeId q = graph_.make(Op::Clamp, {frame.p, graph_.vec(box.lo), graph_.vec(box.hi)});
    const Where inside = at(frame, q);
    const NodeId here = shape(id).kind == ShapeKind::Displace
                            ? displaced(Reading::Marched, id, inside)
                            : divided_by_cells(id, id, expression_of(Reading::Raw, id, inside), q);
    return joined_distance(graph_, std::array{box_distance(graph_, box, frame.p), here});
}

bool Lowering::may_have_cells(ShapeId id, double steeper_than) const {
    const Shape &s = shape(id);
    const bool region = s.kind == ShapeKind::Within;
    if (s.dims != 3 || !free_vars_[id.index].empty()) return false;
    if (region) {
        const Region &where = shapes_.regions[s.payload];
        if (where.kind == RegionKind::Everywhere || !where.less.empty()) return false;
        if (where.kind == RegionKind::Tube) return false; // without an end
    } else {
        // Rays go by the safe radius where it is known, which knows no cells.
        const bool bent = s.kind == ShapeKind::Displace && curved_[id.index];
        if (!fact(id).guard || bent) return false;
    }
    const ShapeFact &divided = fact(region ? s.children.front() : id);
    return divided.status == ProofStatus::Proved && std::isfinite(divided.lipschitz_sup) &&
           divided.lipschitz_sup > steeper_than;
}

std::vector<DividedField> Lowering::divided_fields(double steeper_than) {
    look_over();
    std::vector<DividedField> out;
    std::vector<char> marched(shapes_.size(), 0);
    marched[scene_.root.index] = 1;
    for (std::size_t i = scene_.root.index + 1; i-- > 0;) {
        const ShapeId id{i};
        if (!marched[i]) continue;
        if (passes_through(id)) {
            for (const ShapeId child : shape(id).children) marched[child.index] = 1;
        } else if (may_have_cells(id, steeper_than)) {
            const ShapeId of =
                shape(id).kind == ShapeKind::Within ? shape(id).children.front() : id;
            const NodeId p = graph_.point();
            out.push_back({id, expression_of(Reading::Raw, of, {p, 0})});
        }
    }
    return out;
}

std::vector<DividedField> divided_fields(Scene &scene, double steeper_than) {
    if (!scene.root) return {};
    return Lowering(scene).divided_fields(steeper_than);
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
