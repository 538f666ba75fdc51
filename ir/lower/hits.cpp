// Which surface decides, and how it looks: paints, the numbers that travel with a hit, and mixed
// materials.
#include "ir/lower/lowering.h"
#include "ir/passes/walk.h"

#include <algorithm>
#include <cassert>

namespace fathom::ir {

NodeId Lowering::point3(NodeId p) {
    if (graph_.type(p) == Type::Vec3) return p;
    return graph_.make(Op::Make, Type::Vec3,
                       {graph_.component(p, 0), graph_.component(p, 1), graph_.number(0)});
}

// The surface that shows on a shape whose distance is not a mere min or max of its children's.
NodeId Lowering::colored(ShapeId id, Where frame) {
    const Shape &s = shape(id);
    const auto child = [&](std::size_t i) {
        return expression_of(Reading::Hit, s.children[i], frame);
    };
    if (s.kind == ShapeKind::Map)
        return expression_of(Reading::Hit, s.children.front(), at(frame, read(s.args[0], frame)));
    if (s.kind == ShapeKind::Within)
        return expression_of(Reading::Hit, s.children.front(), inside(id, frame));
    if (s.kind == ShapeKind::Instances) return many(Reading::Hit, id, frame);
    if (s.kind == ShapeKind::Lerp) { // the operand with the greater weight: t against 1 - t
        const NodeId t = read(s.args[0], frame), half = graph_.number(0.5);
        return minimum(Reading::Hit,
                       std::array{at_distance(Reading::Hit, child(0), graph_.sub(half, t)),
                                  at_distance(Reading::Hit, child(1), graph_.sub(t, half))});
    }
    const bool of_first =
        s.kind == ShapeKind::Seam && static_cast<SeamKind>(s.payload) != SeamKind::Pipe;
    const std::size_t count = of_first ? 1 : s.children.size();
    std::vector<NodeId> hits;
    for (std::size_t i = 0; i < count; ++i) hits.push_back(child(i));
    return hits.empty() ? far_away(Reading::Hit) : minimum(Reading::Hit, hits);
}

NodeId Lowering::painted(ShapeId id, Where frame) {
    const Shape &s = shape(id);
    const Material &m = shapes_.materials[s.payload];
    std::vector<NodeId> vars;
    for (NodeId part : {m.diffuse, m.specular, m.exponent, m.emission})
        if (graph_.reads(part).free_vars)
            for (NodeId var : graph_.free_vars(part)) vars.push_back(var);
    const NodeId paint = graph_.integer(surface_of(s.payload, s.dims == 2));
    const NodeId point = point3(frame.p), extra = pack(packing_of(std::move(vars)), frame);
    const ShapeId child = s.children.front();
    if (part_[child.index] || parts_below_[child.index])
        return painted_part(expression_of(Reading::Hit, child, frame),
                            s.kind == ShapeKind::Repaint || !colored_[child.index], paint, point,
                            extra);
    if (s.kind == ShapeKind::Repaint || !paint_[child.index])
        return graph_.make(Op::MakeHit,
                           {expression_of(Reading::Marched, child, frame), paint, point, extra});
    return graph_.make(Op::FillPaint,
                       {expression_of(Reading::Hit, child, frame), paint, point, extra});
}

// -- the four floats that travel with a hit
// -------------------------------------------------------------------------- Variables that shapes
// bind (ids of repetition, rows of instance_tables) are whole numbers. Up to four travel as they
// are; of more, k share a float, each with 24/k bits: two keep -2048..2047, three -128..127.
// Beyond, ids wrap and colours repeat.

namespace {

constexpr int extra_floats = 4;

int numbers_a_float(const Packing &packing) {
    return std::max(1, (packing.numbers + extra_floats - 1) / extra_floats);
}
double radix_of(const Packing &packing) {
    return std::exp2(std::max(1, 24 / numbers_a_float(packing)));
}

} // namespace

Packing Lowering::packing_of(std::vector<NodeId> vars) const {
    std::sort(vars.begin(), vars.end());
    vars.erase(std::unique(vars.begin(), vars.end()), vars.end());
    Packing packing{std::move(vars), 0};
    for (NodeId var : packing.vars) packing.numbers += components(graph_.type(var));
    return packing;
}

NodeId Lowering::pack(const Packing &packing, Where frame) {
    Graph &g = graph_;
    std::array<NodeId, extra_floats> floats;
    floats.fill(g.number(0));
    const int shared = numbers_a_float(packing);
    const double radix = radix_of(packing);
    int next = 0;
    for (NodeId var : packing.vars) {
        const NodeId value = value_of(var, frame);
        for (int i = 0; i < components(g.type(var)); ++i, ++next) {
            if (next >= extra_floats * 24) break;
            NodeId part = is_vector(g.type(value)) ? g.component(value, i) : value;
            if (g.type(part) != Type::Float) part = g.make(Op::ToFloat, Type::Float, {part});
            NodeId &slot = floats[static_cast<std::size_t>(next / shared)];
            if (shared > 1) {
                const NodeId wrapped =
                    g.make(Op::Mod, {g.add(part, g.number(radix / 2)), g.number(radix)});
                part = g.mul(wrapped, g.number(std::pow(radix, next % shared)));
            }
            slot = g.add(slot, part);
        }
    }
    return g.make(Op::Make, Type::Vec4, floats);
}

NodeId Lowering::unpack(const Packing &packing, std::size_t which, NodeId extra) {
    Graph &g = graph_;
    const int shared = numbers_a_float(packing);
    const double radix = radix_of(packing);
    int next = 0;
    for (std::size_t i = 0; i < which; ++i) next += components(g.type(packing.vars[i]));
    const Type type = g.type(packing.vars[which]);
    std::vector<NodeId> parts;
    for (int i = 0; i < components(type); ++i, ++next) {
        NodeId part = g.component(extra, std::min(next / shared, extra_floats - 1));
        if (shared > 1) {
            const NodeId shifted =
                g.make(Op::Floor, {g.div(part, g.number(std::pow(radix, next % shared)))});
            part = g.sub({g.make(Op::Mod, {shifted, g.number(radix)}), g.number(radix / 2)});
        }
        parts.push_back(part);
    }
    if (type == Type::Int)
        return g.make(Op::ToInt, Type::Int, {g.make(Op::Round, {parts.front()})});
    return parts.size() == 1 ? parts.front() : g.make(Op::Make, type, parts);
}

// -- surfaces

Surface Lowering::blank_surface() {
    Surface surface;
    surface.point = graph_.fresh_var(Type::Vec3);
    surface.normal = graph_.fresh_var(Type::Vec3);
    surface.extra = graph_.fresh_var(Type::Vec4);
    return surface;
}

std::int32_t Lowering::surface_of(std::uint32_t material, bool flat) {
    const auto [it, added] = surfaces_.try_emplace({material, flat}, 0);
    if (!added) return it->second;
    const Material &m = shapes_.materials[material];
    Surface surface = blank_surface();
    std::vector<NodeId> vars;
    for (NodeId part : {m.diffuse, m.specular, m.exponent, m.emission})
        if (graph_.reads(part).free_vars)
            for (NodeId var : graph_.free_vars(part)) vars.push_back(var);
    const Packing packing = packing_of(std::move(vars));
    const NodeId normal = graph_.make(Op::Normal, Type::Vec3, std::span<const NodeId>{});
    Substitution map{{graph_.point(), surface.point}, {normal, surface.normal}};
    if (flat) map[graph_.point(Type::Vec2)] = graph_.swizzle(surface.point, std::array{0, 1});
    for (std::size_t i = 0; i < packing.vars.size(); ++i)
        map[packing.vars[i]] = unpack(packing, i, surface.extra);
    surface.diffuse = substitute(graph_, m.diffuse, map);
    surface.specular = substitute(graph_, m.specular, map);
    surface.exponent = substitute(graph_, m.exponent, map);
    surface.emission = substitute(graph_, m.emission, map);
    for (NodeId part : {m.diffuse, m.specular, m.exponent, m.emission})
        surface.reads_normal |= graph_.reads(part).normal;
    it->second = static_cast<std::int32_t>(scene_.surfaces.size());
    scene_.surfaces.push_back(surface);
    return it->second;
}

// -- mixed materials

std::vector<std::string> Lowering::surface_names() const {
    std::vector<std::string> names(scene_.surfaces.size());
    for (const auto &[material, surface] : surfaces_)
        names[static_cast<std::size_t>(surface)] = shapes_.materials[material.first].name;
    return names;
}

std::vector<std::string> surface_names(const Scene &scene) {
    Scene again = scene; // the same one, so that its surfaces have the same places
    Lowering lowering(again);
    lowering.run();
    return lowering.surface_names();
}

// The materials of a blend's operands, each as it is at the point, by the blend's weights: of two
// whose distances differ by d < r, the lesser weighs 1 - (r - d)/2r and the greater the rest (the
// slope of the quadratic profile); folded in order.
NodeId Lowering::mixed(ShapeId id, Where frame) {
    const NodeId paint = graph_.integer(mixed_surface(id));
    const NodeId extra = pack(packing_of(free_vars_[id.index]), frame);
    const NodeId distance = expression_of(Reading::Marched, shape(id).children.front(), frame);
    return graph_.make(Op::MakeHit, {distance, paint, point3(frame.p), extra});
}

std::int32_t Lowering::mixed_surface(ShapeId id) {
    if (const auto it = mixed_surfaces_.find(id); it != mixed_surfaces_.end()) return it->second;
    Graph &g = graph_;
    Surface surface = blank_surface();
    Where frame{shape(id).dims == 2 ? g.swizzle(surface.point, std::array{0, 1}) : surface.point,
                0};
    const Packing packing = packing_of(free_vars_[id.index]);
    for (std::size_t i = 0; i < packing.vars.size(); ++i)
        frame = bind(frame, packing.vars[i], unpack(packing, i, surface.extra));

    // The blend, below what does not move the point: an intersection or difference is -blend(-f,
    // -g).
    ShapeId core = shape(id).children.front();
    const auto goes_on = [&](const Shape &s) {
        return s.kind == ShapeKind::Complement || s.kind == ShapeKind::Contract ||
               (s.kind == ShapeKind::Library && !shapes_.libraries[s.payload].has_claims);
    };
    while (goes_on(shape(core))) core = shape(core).children.front();
    const bool blends = shape(core).kind == ShapeKind::Blend;
    const std::vector<ShapeId> operands = blends ? shape(core).children : std::vector{core};

    // What the paints found below look like; those of the operands are made first, so all of them
    // are known here.
    using Appearance = std::array<NodeId, 4>; // diffuse, specular, exponent, emission
    const auto appearance_of = [&](NodeId hit) {
        Appearance appearance{g.vec3(0.448, 0.448, 0.448), g.vec3(1, 1, 1), g.number(32),
                              g.vec3(0, 0, 0)};
        const NodeId paint = code_of(g.make(Op::HitPaint, {hit})),
                     point = g.make(Op::HitPoint, {hit}), extra = g.make(Op::HitExtra, {hit});
        for (std::size_t i = 0; i < scene_.surfaces.size(); ++i) {
            const Surface &one = scene_.surfaces[i];
            const NodeId is = g.make(Op::Equal, {paint, g.integer(static_cast<int>(i))});
            if (g.as_number(is) == 0.0) continue;
            const Substitution map{
                {one.point, point}, {one.extra, extra}, {one.normal, surface.normal}};
            const std::array parts{one.diffuse, one.specular, one.exponent, one.emission};
            for (std::size_t k = 0; k < parts.size(); ++k)
                appearance[k] =
                    g.make(Op::Select, {is, substitute(g, parts[k], map), appearance[k]});
            surface.reads_normal |= one.reads_normal;
        }
        return appearance;
    };
    std::vector<NodeId> hits, fields;
    for (ShapeId operand : operands) {
        hits.push_back(expression_of(Reading::Hit, operand, frame));
        fields.push_back(expression_of(Reading::Raw, operand, frame));
    }
    const NodeId r = blends ? read(shape(core).args[0], frame) : g.number(0);
    const NodeId width = g.make(Op::Max, {r, g.number(1e-9)});
    Appearance appearance = appearance_of(hits.front());
    NodeId field = fields.front();
    for (std::size_t i = 1; i < hits.size(); ++i) {
        const NodeId d = g.sub(fields[i], field);
        // 0 where the next is greater by r or more, 1 where it is less by r or more.
        const NodeId t =
            g.make(Op::Clamp, {g.mul({g.sub({g.number(1), g.div(d, width)}), g.number(0.5)}),
                               g.number(0), g.number(1)});
        const Appearance next = appearance_of(hits[i]);
        for (std::size_t k = 0; k < appearance.size(); ++k)
            appearance[k] =
                g.make(Op::Mix, {appearance[k], next[k], g.splat(t, g.type(appearance[k]))});
        field = g.make(Op::Union, {field, fields[i]});
    }
    surface.diffuse = appearance[0];
    surface.specular = appearance[1];
    surface.exponent = appearance[2];
    surface.emission = appearance[3];
    const std::int32_t index = static_cast<std::int32_t>(scene_.surfaces.size());
    mixed_surfaces_.emplace(id, index);
    scene_.surfaces.push_back(surface);
    return index;
}

} // namespace fathom::ir
