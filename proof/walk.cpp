// The walk: places from the root down (places.cpp), facts from the leaves up, and what every fact
// is told at its end. The rules themselves stand by group beside it.
#include "proof/prover.h"

#include "base/single.h"
#include "ir/maps.h"
#include "ir/view.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace fathom::proof {

using ir::FieldKind;
using ir::MapKind;
using ir::NodeId;
using ir::Op;
using ir::Shape;
using ir::ShapeId;
using ir::ShapeKind;
using ir::rounding::infinity;
using ir::rounding::up;

std::size_t prove(ir::Scene &scene, Diagnostics &diagnostics, const Options &options) {
    Prover prover(scene, diagnostics, options);
    prover.run();
    return options.work - prover.work.left;
}

void Prover::run() {
    std::size_t count = scene.shapes.size();
    work.take(count / 4);
    known.assign(count, 0);
    set_lipschitz(derived.emplace_back(), 1);
    places.assign(count, {});
    scene.facts.assign(count, {});
    scene.cells.clear();
    for (std::size_t i = 0; i < count; ++i) { // variables that shapes bind
        const Shape &shape = scene.shapes[ShapeId{i}];
        if (shape.kind == ShapeKind::Instances) {
            const ir::InstanceTable &instance_table = scene.shapes.instance_tables[shape.payload];
            ranges.vars[graph[instance_table.index].payload] = {
                Interval(0, std::max(instance_table.count - 1, 0))};
        }
        if (shape.kind == ShapeKind::Repeat) {
            const ir::Repetition &repetition = scene.shapes.repetitions[shape.payload];
            if (!repetition.id) continue;
            std::array<Interval, 4> id{};
            if (repetition.polar) {
                id[0] = Interval(0, std::max(number(shape.args[0]).hi - 1, 0.0));
            } else {
                const Vec cells = vector(shape.args[0]), counts = vector(shape.args[1]);
                for (std::size_t a = 0; a < 3; ++a) {
                    if (!repetition.along[a]) continue;
                    // Without an end, as far as lengths go: of larger ids the square is no number.
                    const double last = up(longest / std::max(cells[a].lo, shortest));
                    id[a] = counts[a].hi >= 1e8 ? Interval(-last, last)
                                                : Interval(0, std::max(counts[a].hi - 1, 0.0));
                }
            }
            ranges.vars[graph[repetition.id].payload] = id;
        }
    }
    test_conditions();
    find_places();
    know_caches(); // before the shapes that read them
    std::size_t leaves = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const Shape &shape = scene.shapes[ShapeId{i}];
        leaves += shape.kind == ShapeKind::Leaf;
        deformed += shape.kind == ShapeKind::Map &&
                    (shape.map == MapKind::Twist || shape.map == MapKind::Bend ||
                     shape.map == MapKind::Taper || shape.map == MapKind::Distort);
    }
    // Together they take an eighth of what the proof may.
    const std::size_t each = options.work / 8 / std::max<std::size_t>(leaves, 1);
    leaf_work = std::max(each, 2 * options.field_instructions);
    spare_work = options.work / 4;
    leaf_instructions =
        options.field_instructions *
        std::min<std::size_t>(std::bit_floor(each / options.field_instructions), 16);
    for (std::size_t i = 0; i < count; ++i) {
        constexpr std::size_t steps_of_a_shape = 50; // in time
        work.pass(steps_of_a_shape);
        left_before = work.left;
        Derived k = derived.front();
        if (places[i].reached) { // what is never evaluated keeps facts that say nothing
            k = know(ShapeId{i});
            if (!is_field(ShapeId{i})) k.leaf = {};
            find_extent(ShapeId{i}, k);
            k.fact.surface_slope = surface_slope(ShapeId{i}, k);
            keep_in_ball(ShapeId{i}, k);
            k.fact.curvature = curvature_of(ShapeId{i}, k);
            finish(ShapeId{i}, k);
            if (scene.shapes[ShapeId{i}].kind == ShapeKind::Within && !k.failed)
                tell_cut_away(ShapeId{i});
            if (k.fact.bounds.finite()) k.fact.bounded = k.fact.bounds;
        }
        if (places[i].reached) {
            known[i] = static_cast<std::uint32_t>(derived.size());
            derived.push_back(k);
        }
        spent.push_back(left_before - work.left);
        scene.facts[i] = k.fact; // padded there alone, so that the slack does not add up
        scene.facts[i].bounds = padded(k.fact.bounds);
        scene.facts[i].repeat.copy = padded(k.fact.repeat.copy);
    }
    name_axioms();
    ir::find_extent(scene);
    know_cells();
}

// A leaf, and what is only written round it.
bool Prover::is_field(ShapeId id) const {
    const Shape &shape = scene.shapes[id];
    switch (shape.kind) {
    case ShapeKind::Leaf:
    case ShapeKind::Paint:
    case ShapeKind::Repaint:
    case ShapeKind::Contract: return true;
    case ShapeKind::Library: return !scene.shapes.libraries[shape.payload].has_claims;
    case ShapeKind::Empty:
    case ShapeKind::Union:
    case ShapeKind::Intersection:
    case ShapeKind::Complement:
    case ShapeKind::Xor:
    case ShapeKind::Blend:
    case ShapeKind::Seam:
    case ShapeKind::Lerp:
    case ShapeKind::PseudoNorm:
    case ShapeKind::Map:
    case ShapeKind::Offset:
    case ShapeKind::Shell:
    case ShapeKind::Displace:
    case ShapeKind::Extrude:
    case ShapeKind::Repeat:
    case ShapeKind::Within:
    case ShapeKind::Mixed:
    case ShapeKind::Instances: return false;
    }
    return false;
}

// -- numbers

std::array<Interval, 16> Prover::numbers(NodeId id) {
    std::array<Interval, 16> out{};
    if (!id) return out;
    if (graph.is_constant(id)) {
        const ir::Constant &c = graph.constant_of(id);
        for (std::size_t i = 0; i < 16; ++i) out[i] = c.value[i];
        return out;
    }
    return range_of(flattening, ranges, id);
}
Interval Prover::number(NodeId id) { return numbers(id)[0]; }
Vec Prover::vector(NodeId id) {
    auto all = numbers(id);
    if (id && graph[id].type == ir::Type::Float) all[1] = all[2] = all[0];
    return {all[0], all[1], all[2]};
}

void Prover::set_lipschitz(Derived &k, double value) {
    // Rounding outward leaves 1 + a few units in the last place where the truth is 1; the float32
    // slack covers them.
    if (value > 1 && value <= 1 + slack) value = 1;
    if (value > 0) value = std::max(value, shortest); // by which a field can be divided
    k.fact.lipschitz_sup = value;
    k.fact.lipschitz = graph.number(value);
}
void Prover::set_lipschitz(Derived &k, NodeId formula, double sup) {
    ir::Graph::Reads reads = graph.reads(formula);
    bool in_params = (reads.params || reads.time) && !reads.point && !reads.free_vars;
    set_lipschitz(k, sup);
    if (in_params && std::isfinite(sup)) k.fact.lipschitz = formula;
}
// Within the box the field; outside sqrt(|p-q|^2 + max(f(q), 0)^2), whose two gradients are
// perpendicular: max(L, 1).
void Prover::keep_local(Derived &k, double sup, NodeId formula) {
    k.fact.local = true;
    k.growth_rate = 1;
    k.fact.moment_arm = {infinity, infinity, infinity};
    for (std::size_t a = 0; a < 3; ++a)
        k.fact.symmetric[a] = k.fact.symmetric[a] && k.fact.bounds.lo[a] == -k.fact.bounds.hi[a];
    set_lipschitz(k, graph.make(Op::Max, {formula, graph.number(1)}), std::max(sup, 1.0));
}
void Prover::fail(Derived &k) {
    k.failed = true;
    k.fact.lipschitz_sup = infinity;
    k.fact.lipschitz = graph.number(1);
}

// -- facts

// All but what a shape has of its own.
Derived Prover::of_child(const Shape &shape) const {
    Derived k = child(shape);
    k.fact.repeat = {};
    k.fact.guard = k.fact.local = false;
    k.fact.outward = k.fact.inward = k.fact.round = infinity;
    k.fact.partial.clear();
    return k;
}

Derived Prover::know(ShapeId id) {
    const Shape shape = scene.shapes[id];
    switch (shape.kind) {
    case ShapeKind::Empty: {
        Derived k;
        k.fact.kind = FieldKind::Exact;
        k.fact.bounds = k.parts = empty_box();
        k.fact.symmetric = {true, true, true};
        k.fact.exact_outside = k.parts_exact = true;
        set_lipschitz(k, 1);
        return k;
    }
    case ShapeKind::Leaf: return know_leaf(id);
    case ShapeKind::Union:
    case ShapeKind::Intersection:
    case ShapeKind::Xor:
    case ShapeKind::Blend:
    case ShapeKind::Seam:
    case ShapeKind::PseudoNorm: return know_set(id);
    case ShapeKind::Complement: {
        Derived k = of_child(shape);
        std::swap(k.fact.bounds, k.outer);
        std::swap(k.growth_rate, k.outer_growth_rate);
        k.fact.exact_outside = k.fact.kind == FieldKind::Exact;
        return k;
    }
    case ShapeKind::Lerp: return know_lerp(id);
    case ShapeKind::Map: return know_map(id);
    case ShapeKind::Offset:
    case ShapeKind::Shell:
    case ShapeKind::Displace: return know_displaced(id);
    case ShapeKind::Extrude: return know_extrude(id);
    case ShapeKind::Repeat: return know_repeat(id);
    case ShapeKind::Within: return know_within(id);
    case ShapeKind::Paint:
    case ShapeKind::Repaint:
    case ShapeKind::Mixed: {
        Derived k = of_child(shape);
        return k;
    }
    case ShapeKind::Instances: return know_instances(id);
    case ShapeKind::Library: return know_library(id);
    case ShapeKind::Contract: return know_contract(id);
    }
    return {};
}

// -- guards

void Prover::finish(ShapeId id, Derived &k) {
    const Shape &shape = scene.shapes[id];
    // Each rule says for itself why it has no bound. Whatever comes to no number without saying so
    // is not marched either: nothing may be proved by a bound that is none.
    if (!k.failed && !std::isfinite(k.fact.lipschitz_sup)) {
        if (Diagnostic *d =
                report(id, Code::LipschitzUnbounded,
                       "no bound was found for the slope of " + operation_name(scene, id)))
            d->help("write `.within(…)` after it, with a region that holds what you want to see, "
                    "as in `.within(ball(3))`, or smaller numbers");
        fail(k);
    }
    check_size(id, k);
    bool everywhere_valid = everywhere(place(id).box);
    bool deformed = shape.kind == ShapeKind::Displace || shape.kind == ShapeKind::Instances ||
                    (shape.kind == ShapeKind::Map &&
                     (shape.map == MapKind::Twist || shape.map == MapKind::Bend ||
                      shape.map == MapKind::Taper || shape.map == MapKind::Distort));
    k.fact.guard = !k.failed && everywhere_valid && k.fact.bounds.finite() &&
                   !k.fact.bounds.empty() && shape.dims == 3 &&
                   (k.fact.lipschitz_sup > 1.3 || deformed) && shape.kind != ShapeKind::Within;
    if (k.fact.guard && std::isfinite(k.fact.round)) { // where the box says more, it is the guard
        const auto a = static_cast<std::size_t>(ir::turning_axis(shape));
        double section = 1;
        for (std::size_t i = 0; i < 3; ++i)
            if (i != a) section *= k.fact.bounds.hi[i] - k.fact.bounds.lo[i];
        if (std::numbers::pi * k.fact.round * k.fact.round >= section) k.fact.round = infinity;
    }
    if (k.failed) return;
    if (!std::isfinite(k.fact.lipschitz_sup)) { // no rule gave a bound, and none said so
        if (Diagnostic *d = report(id, Code::NeedsRegion,
                                   operation_name(scene, id) + " here has no bound on its slope"))
            d->help("write `.within(…)` after it, with a region that holds what you want to see, "
                    "as in `.within(ball(3))`");
        return fail(k);
    }
    double below = 1;
    for (ShapeId c : shape.children) below = std::max(below, of(c).fact.lipschitz_sup);
    if (!shape.children.empty() && std::isfinite(below) && k.fact.lipschitz_sup > 4 * below &&
        shape.kind != ShapeKind::Library)
        if (Diagnostic *d =
                report(id, Code::Costly,
                       operation_name(scene, id) + " makes this shape cost up to " +
                           number_text(k.fact.lipschitz_sup / below) + " times the steps"))
            d->note("its field is at most " + number_text(k.fact.lipschitz_sup) +
                    " times as steep as a distance, and every step is divided by that")
                .help(cheaper(shape));
}

// What would make an operation's bound less.
std::string Prover::cheaper(const Shape &shape) {
    switch (shape.kind) {
    case ShapeKind::Leaf:
        return "keep the region where the field is steep out with a smaller `within:`, or cut the "
               "field off where it is large, as in `min(…, 0.5)`";
    case ShapeKind::Displace: return "displace by less, or by a field that changes more slowly";
    case ShapeKind::Lerp:
        return "let the weight change more slowly, or blend shapes that differ by less";
    case ShapeKind::Within: return "keep holes of a region out of where an offset or a blend is";
    case ShapeKind::Blend: return "let the radius change more slowly";
    case ShapeKind::Map:
        switch (shape.map) {
        case MapKind::Twist: return "twist by a lower rate, or a shape that is nearer to the axis";
        case MapKind::Bend: return "bend by a lower rate, or a shape that is nearer to the origin";
        case MapKind::Taper:
            return "taper by less, or over a longer stretch with `from:` and `to:`";
        case MapKind::Distort: return "prove the map over less, with a smaller `within:`";
        case MapKind::Translate:
        case MapKind::Rotate:
        case MapKind::Scale:
        case MapKind::MirrorFold:
        case MapKind::Revolve: break;
        }
        break;
    case ShapeKind::Empty:
    case ShapeKind::Union:
    case ShapeKind::Intersection:
    case ShapeKind::Complement:
    case ShapeKind::Xor:
    case ShapeKind::Seam:
    case ShapeKind::PseudoNorm:
    case ShapeKind::Offset:
    case ShapeKind::Shell:
    case ShapeKind::Extrude:
    case ShapeKind::Repeat:
    case ShapeKind::Paint:
    case ShapeKind::Repaint:
    case ShapeKind::Mixed:
    case ShapeKind::Instances:
    case ShapeKind::Library:
    case ShapeKind::Contract: break;
    }
    return "use shapes with a lower bound";
}

} // namespace fathom::proof
