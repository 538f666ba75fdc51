// Unions of many copies: lattices, rings, and instance_tables whose members differ by a row of
// numbers. (semantics.md, 14; lipschitz.md, 7: the nearest copy and the next on the side of the
// fraction.) The analysis says how many copies to evaluate.
#include "ir/lower/lowering.h"

#include <algorithm>
#include <cassert>

namespace fathom::ir {
namespace {

constexpr double infinite_count =
    1e8; // counts from here on mean "without end" (stdlib's inf arrives as 1e9)

// Copies evaluated along each axis. Without a plan both neighbours are.
std::array<int, 3> neighbors_of(const Scene &scene, ShapeId id) {
    const Shape &shape = scene.shapes[id];
    const Repetition &repetition = scene.shapes.repetitions[shape.payload];
    std::array<int, 3> result{};
    if (id.index >= scene.facts.size()) return result;
    const RepeatPlan &plan = scene.facts[id.index].repeat;
    for (std::size_t i = 0; i < 3; ++i)
        if (repetition.along[i]) {
            result[i] = plan.neighbors[i] > 0 ? plan.neighbors[i] : 3;
            // No more than there are.
            const NodeId count = shape.args[1];
            if (scene.graph.is_constant(count)) {
                const double n = scene.graph.constant_of(count).value[i];
                if (n < infinite_count)
                    result[i] = std::clamp(result[i], 1, std::max(1, static_cast<int>(n)));
            }
        }
    return result;
}

// Of a ring: how many sectors, at most all.
int sectors_of(const Scene &scene, ShapeId id, int count) {
    const RepeatPlan &plan = scene.facts[id.index].repeat;
    const int evaluated = *std::max_element(plan.neighbors.begin(), plan.neighbors.end());
    if (plan.guard)
        return count; // copies that differ: a wedge bounds nothing that a box knows, so all are
                      // evaluated
    return std::min(evaluated > 0 ? evaluated : 3, count);
}

// One axis of a lattice of copies.
struct LatticeAxis {
    NodeId x, cell, shift, base, last; // last: the greatest index, invalid where endless
    int copies = 1;
    bool repeats = false;
    bool fewer = false; // there may be fewer copies than are evaluated
};

// `nearest`, or the distance to the copies that were not evaluated where that is less.
// The copies that were not evaluated lie, along some axis, beyond the first or the last
// evaluated. Each side's are held by a box that is bounded there by the nearest of them, and
// elsewhere by what all copies together extend to. An axis along which one copy is evaluated has
// none: either there is one only, or no other is ever nearer (lipschitz.md, 7), and its slab would
// begin on the wall of the own cell.
NodeId nearest_of_others(Graph &g, const std::array<LatticeAxis, 3> &axes, int dims,
                         const Box &held, NodeId nearest) {
    const auto outside =
        [&](int i) -> NodeId { // how far p is beyond all copies along axis i; invalid: never
        const LatticeAxis &a = axes[static_cast<std::size_t>(i)];
        const double lo = held.lo[static_cast<std::size_t>(i)],
                     hi = held.hi[static_cast<std::size_t>(i)];
        if (!std::isfinite(lo) || !std::isfinite(hi) || (a.repeats && !a.last)) return {};
        const NodeId reach = a.repeats ? g.mul(a.shift, a.cell) : g.number(0);
        return g.make(Op::Max, {g.sub(g.sub(g.number(lo), reach), a.x),
                                g.sub({g.sub(a.x, reach), g.number(hi)})});
    };
    for (int i = 0; i < dims; ++i) {
        const LatticeAxis &a = axes[static_cast<std::size_t>(i)];
        if (!a.repeats || a.copies == 1) continue;
        const double lo = held.lo[static_cast<std::size_t>(i)],
                     hi = held.hi[static_cast<std::size_t>(i)];
        if (!std::isfinite(lo) || !std::isfinite(hi)) continue;
        const NodeId before = g.sub(a.base, g.number(1)), after = g.add(a.base, g.number(a.copies));
        NodeId left = g.sub(a.x, g.add({g.mul(g.sub(before, a.shift), a.cell), g.number(hi)}));
        NodeId right = g.sub(g.add({g.mul(g.sub(after, a.shift), a.cell), g.number(lo)}), a.x);
        const NodeId none = g.number(nowhere);
        if (a.last) {
            left = g.make(Op::Select, {g.make(Op::Less, {before, g.number(0)}), none, left});
            right = g.make(Op::Select, {g.make(Op::Less, {a.last, after}), none, right});
        }
        std::vector<NodeId> distances{g.make(Op::Min, {left, right})};
        for (int j = 0; j < dims; ++j)
            if (j != i)
                if (const NodeId out = outside(j)) distances.push_back(out);
        nearest = g.make(Op::Union, {nearest, joined_distance(g, distances)});
    }
    return nearest;
}

} // namespace

int copies_evaluated(const Scene &scene, ShapeId id) {
    const Shape &shape = scene.shapes[id];
    int copies = 1;
    if (scene.shapes.repetitions[shape.payload].polar)
        copies = sectors_of(
            scene, id,
            std::max(1, static_cast<int>(scene.graph.as_number(shape.args[0]).value_or(1))));
    else
        for (int n : neighbors_of(scene, id)) copies *= std::max(n, 1);
    return copies > max_unrolled ? 1 : copies;
}

template <class F>
NodeId Lowering::minimum_of(Reading reading, NodeId count, int max_count, NodeId index, F each) {
    const NodeId start = far_away(reading, max_count > 0 ? beyond_all : nowhere);
    const NodeId best = graph_.fresh_var(graph_.type(start));
    Loop loop;
    loop.count = count;
    loop.index = index;
    loop.vars = {best};
    loop.next = {each(best)};
    loop.max_count = max_count;
    const LoopId id = graph_.add_loop(std::move(loop));
    return graph_.make(Op::Loop, graph_.type(start), {start}, id.index);
}

NodeId Lowering::repeated(Reading reading, ShapeId id, Where frame) {
    return shapes_.repetitions[shape(id).payload].polar ? polar(reading, id, frame)
                                                        : lattice(reading, id, frame);
}

// Along an axis with cells of width c, u = x/c + h counts cells; h puts cell 0 at the origin, or,
// of a finite number n of them, the middle there: copy i stands at (i - h) c. The first of N copies
// evaluated is floor(u) - N/2 + 1 for even N, the nearest less (N-1)/2 for odd, kept within 0 ..
// n-N.
NodeId Lowering::lattice(Reading reading, ShapeId id, Where frame) {
    Graph &g = graph_;
    const Shape &s = shape(id);
    const Repetition &repetition = shapes_.repetitions[s.payload];
    const ShapeFact &known = fact(id);
    const std::array<int, 3> neighbors = neighbors_of(scene_, id);
    const NodeId cells = read(s.args[0], frame), counts = read(s.args[1], frame);
    const int dims = s.dims;

    std::array<LatticeAxis, 3> axes;
    int total = 1;
    for (int i = 0; i < dims; ++i) {
        LatticeAxis &a = axes[static_cast<std::size_t>(i)];
        a.x = g.component(frame.p, i);
        a.repeats = repetition.along[static_cast<std::size_t>(i)];
        if (!a.repeats) continue;
        a.copies = neighbors[static_cast<std::size_t>(i)];
        total *= a.copies;
        a.cell = g.component(cells, i);
        const NodeId count = g.component(counts, i);
        const bool endless = g.as_number(count).value_or(0) >= infinite_count;
        a.shift = endless ? g.number(0) : g.mul({g.sub(count, g.number(1)), g.number(0.5)});
        const NodeId u = g.add(g.div(a.x, a.cell), a.shift);
        const bool even = a.copies % 2 == 0;
        a.base = g.sub({g.make(even ? Op::Floor : Op::Round, {u}),
                        g.number(even ? a.copies / 2 - 1 : a.copies / 2)});
        if (!endless) {
            a.last = g.sub(count, g.number(1));
            a.fewer = !(g.as_number(count).value_or(0) >= a.copies);
            const NodeId maximum = g.make(Op::Max, {g.sub(count, g.number(a.copies)), g.number(0)});
            a.base = g.make(Op::Clamp, {a.base, g.number(0), maximum});
        }
    }

    // What holds a copy, about the middle of its cell.
    Box held = known.repeat.copy;
    for (std::size_t i = 0; i < 3; ++i)
        if (repetition.mirrored && repetition.along[i]) { // a copy or its reflection
            held.hi[i] = std::max(-held.lo[i], held.hi[i]);
            held.lo[i] = -held.hi[i];
        }

    // The copy whose offset from the first evaluated is k, along each axis.
    const auto copy = [&](const std::array<NodeId, 3> &k) {
        std::vector<NodeId> q;
        std::array<NodeId, 3> cell_id{g.number(0), g.number(0), g.number(0)};
        for (int i = 0; i < dims; ++i) {
            const LatticeAxis &a = axes[static_cast<std::size_t>(i)];
            if (!a.repeats) {
                q.push_back(a.x);
                continue;
            }
            NodeId index = g.add(a.base, k[static_cast<std::size_t>(i)]);
            if (a.fewer) index = g.make(Op::Min, {index, a.last});
            cell_id[static_cast<std::size_t>(i)] = index;
            NodeId local = g.sub(a.x, g.mul(g.sub(index, a.shift), a.cell));
            if (repetition.mirrored)
                local = g.mul(local,
                              g.sub({g.number(1),
                                     g.mul({g.number(2), g.make(Op::Mod, {index, g.number(2)})})}));
            q.push_back(local);
        }
        const NodeId point = g.make(Op::Make, vector_type(dims), q);
        const Where there =
            bind(at(frame, point), repetition.id, g.make(Op::Make, Type::Vec3, cell_id));
        const NodeId value = expression_of(reading, s.children.front(), there);
        if (!known.repeat.hold) return value;
        return at_distance(
            reading, value,
            g.make(Op::Max, {distance_of(reading, value), box_distance(g, held, point)}));
    };

    NodeId result;
    if (total <= max_unrolled) {
        std::vector<NodeId> values;
        for (int t = 0; t < total; ++t) {
            std::array<NodeId, 3> k;
            int rest = t;
            for (std::size_t i = 0; i < 3; ++i) {
                k[i] = g.number(rest % axes[i].copies);
                rest /= axes[i].copies;
            }
            values.push_back(copy(k));
        }
        result = minimum(reading, values);
    } else {
        const NodeId turn = g.fresh_var(Type::Int);
        result = minimum_of(reading, g.integer(total), total, turn, [&](NodeId best) {
            std::array<NodeId, 3> k;
            NodeId rest = turn;
            for (std::size_t i = 0; i < 3; ++i) {
                const NodeId n = g.integer(axes[i].copies);
                k[i] = g.make(Op::ToFloat, Type::Float, {g.make(Op::Mod, {rest, n})});
                rest = g.make(Op::Div, {rest, n});
            }
            return minimum(reading, std::array{best, copy(k)});
        });
    }
    if (!known.repeat.guard) return result;

    const NodeId nearest = nearest_of_others(g, axes, dims, held, distance_of(reading, result));
    return at_distance(reading, result, nearest);
}

// n copies about an axis, the k-th turned by k*2pi/n: the nearest is the one whose sector holds p.
NodeId Lowering::polar(Reading reading, ShapeId id, Where frame) {
    Graph &g = graph_;
    const Shape &s = shape(id);
    const Repetition &repetition = shapes_.repetitions[s.payload];
    const int count = std::max(1, static_cast<int>(g.as_number(s.args[0]).value_or(1)));
    const int sectors = sectors_of(scene_, id, count);
    const int axis = s.dims == 2 ? 2 : repetition.axis;
    // Angles count from where the first copy usually stands: x of the axes y and z, y of x. (x, -z,
    // y) is right-handed.
    const int u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
    const auto turned = [&](NodeId part) { return axis == 1 ? g.neg(part) : part; };
    const NodeId x = g.component(frame.p, u), y = turned(g.component(frame.p, v));
    const double step = 8 * std::atan(1.0) / count;

    const auto copy = [&](NodeId k) { // k: a float, 0 .. n-1
        const NodeId angle = g.mul(k, g.number(step));
        const NodeId c = g.make(Op::Cos, {angle}), sine = g.make(Op::Sin, {angle});
        std::array<NodeId, 3> q;
        if (s.dims == 3) q[static_cast<std::size_t>(axis)] = g.component(frame.p, axis);
        q[static_cast<std::size_t>(u)] = g.add({g.mul(c, x), g.mul(sine, y)});
        q[static_cast<std::size_t>(v)] = turned(g.sub({g.mul(c, y), g.mul(sine, x)}));
        const NodeId point = g.make(Op::Make, vector_type(s.dims),
                                    std::span(q).first(static_cast<std::size_t>(s.dims)));
        const NodeId cell_id = g.make(Op::Make, Type::Vec3, {k, g.number(0), g.number(0)});
        return expression_of(reading, s.children.front(),
                             bind(at(frame, point), repetition.id, cell_id));
    };

    if (sectors >= count) {
        if (count <= max_unrolled) {
            std::vector<NodeId> values;
            for (int k = 0; k < count; ++k) values.push_back(copy(g.number(k)));
            return minimum(reading, values);
        }
        const NodeId turn = g.fresh_var(Type::Int);
        return minimum_of(reading, g.integer(count), count, turn, [&](NodeId best) {
            return minimum(reading,
                           std::array{best, copy(g.make(Op::ToFloat, Type::Float, {turn}))});
        });
    }
    const NodeId t = g.mul({g.make(Op::Atan2, {y, x}), g.number(1 / step)}); // -n/2 .. n/2
    const bool even = sectors % 2 == 0;
    const NodeId base = g.sub({g.make(even ? Op::Floor : Op::Round, {t}),
                               g.number(even ? sectors / 2 - 1 : sectors / 2)});
    const auto sector = [&](NodeId offset) { // into 0 .. n-1; base + offset lies in -n .. 2n
        const NodeId k = g.add(base, offset), n = g.number(count);
        const NodeId low = g.make(Op::Select, {g.make(Op::Less, {k, g.number(0)}), g.add(k, n), k});
        return g.make(Op::Select, {g.make(Op::Less, {low, n}), low, g.sub(low, n)});
    };
    if (sectors <= max_unrolled) {
        std::vector<NodeId> values;
        for (int k = 0; k < sectors; ++k) values.push_back(copy(sector(g.number(k))));
        return minimum(reading, values);
    }
    const NodeId turn = g.fresh_var(Type::Int);
    return minimum_of(reading, g.integer(sectors), sectors, turn, [&](NodeId best) {
        return minimum(reading,
                       std::array{best, copy(sector(g.make(Op::ToFloat, Type::Float, {turn})))});
    });
}

// A loop over the rows, carrying the least so far. A smooth union carries the blend instead: its
// raw field only, and what it begins with is further off than any blend reaches.
NodeId Lowering::many(Reading reading, ShapeId id, Where frame) {
    Graph &g = graph_;
    const Shape &s = shape(id);
    const InstanceTable &instance_table = shapes_.instance_tables[s.payload];
    const NodeId count = g.integer(instance_table.count);
    const bool smooth = instance_table.smooth && reading == Reading::Raw;
    const NodeId k = smooth ? read(s.args[0], frame) : NodeId{};
    const NodeId row = g.fresh_var(Type::Int); // each loop counts for itself
    const Where inside = bind(frame, instance_table.index, row);
    return minimum_of(reading, count, instance_table.count, row, [&](NodeId best) {
        const NodeId value = expression_of(reading, s.children.front(), inside);
        if (!smooth) return minimum(reading, std::array{best, value});
        return g.make(Op::Blend, Type::Float, {k, g.number(1), best, value},
                      static_cast<std::uint32_t>(Profile::Smooth));
    });
}

} // namespace fathom::ir
