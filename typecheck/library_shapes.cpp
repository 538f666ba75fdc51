// What a scene keeps once however often it is named: calls of library shapes with their claims
// (semantics.md, 12), regions, materials.
#include "typecheck/interpreter.h"

#include <fmt/format.h>

namespace fathom::typecheck {

static std::string number_key(std::uint32_t i) { return fmt::format("{},", i); }

Value library_shape(Interpreter &ev, ir::Library library, const Value &body, Span origin) {
    ir::ShapeId child = shape_of(body);
    // a body that only makes claims is this very call: keep its claims under the call's numbers
    const ir::Shape &inner = ev.scene.shapes[child];
    if (inner.kind == ir::ShapeKind::Library &&
        ev.scene.shapes.libraries[inner.payload].arguments.empty() &&
        ev.scene.shapes.libraries[inner.payload].name == library.name) {
        const ir::Library &claimed = ev.scene.shapes.libraries[inner.payload];
        library.has_claims = claimed.has_claims;
        library.claims = claimed.claims;
        child = inner.children[0];
    }
    std::string key = "library:" + library.name + ":";
    for (const auto &[name, node] : library.arguments) key += name + "=" + number_key(node.index);
    for (const auto &[name, nodes] : library.lists) {
        key += name + "=[";
        for (const ir::NodeId node : nodes) key += number_key(node.index);
        key += "]";
    }
    if (library.has_claims) {
        const ir::Claims &c = library.claims;
        key += number_key(static_cast<std::uint32_t>(c.kind)) + number_key(c.lipschitz.index) +
               number_key(c.lo.index) + number_key(c.hi.index) + number_key(c.growth_rate.index);
        for (bool b : c.symmetric) key += b ? "y" : "n";
        for (ir::NodeId n : c.moment_arm) key += number_key(n.index);
    }
    auto [it, added] = ev.interned_records.try_emplace(
        key, static_cast<std::uint32_t>(ev.scene.shapes.libraries.size()));
    if (added) ev.scene.shapes.libraries.push_back(std::move(library));
    ir::Shape s;
    s.kind = ir::ShapeKind::Library;
    s.dims = body.size;
    s.payload = it->second;
    s.children = {child};
    s.origin = origin;
    return shape_value(ev.scene.shapes.add(std::move(s)), body.size);
}

static std::string region_key(const ir::Region &r) {
    std::string key = number_key(static_cast<std::uint32_t>(r.kind)) + number_key(r.center.index) +
                      number_key(r.size.index) + number_key(static_cast<std::uint32_t>(r.axis)) +
                      "(";
    for (const ir::Region &l : r.less) key += region_key(l);
    return key + ")";
}

std::uint32_t intern_region(Interpreter &ev, const ir::Region &region) {
    auto [it, added] = ev.interned_records.try_emplace(
        "region:" + region_key(region), static_cast<std::uint32_t>(ev.scene.shapes.regions.size()));
    if (added) ev.scene.shapes.regions.push_back(region);
    return it->second;
}

std::uint32_t intern_material(Interpreter &ev, const ir::Material &m) {
    std::string key = "material:" + number_key(m.diffuse.index) + number_key(m.specular.index) +
                      number_key(m.exponent.index) + number_key(m.emission.index) +
                      number_key(static_cast<std::uint32_t>(m.texture.image));
    auto [it, added] = ev.interned_records.try_emplace(
        key, static_cast<std::uint32_t>(ev.scene.shapes.materials.size()));
    if (added) ev.scene.shapes.materials.push_back(m);
    return it->second;
}

} // namespace fathom::typecheck
