// The shapes and changes of `sdf`, a library of Python: up is z, and flat shapes lie in x and y.
#include "lang/foreign/program/program.h"

namespace fathom::lang::program {

std::optional<Written> taken(Given &g, std::size_t place, const std::string &name) {
    if (place < g.by_place.size()) {
        g.asked.insert("#" + std::to_string(place));
        return g.by_place[place];
    }
    const auto at = g.by_name.find(name);
    if (at == g.by_name.end()) return std::nullopt;
    g.asked.insert(name);
    return at->second;
}

namespace {

std::string need(Given &g, std::size_t place, const std::string &name) {
    if (const auto w = taken(g, place, name)) return w->text;
    throw Unsure{};
}
std::string or_else(Given &g, std::size_t place, const std::string &name, const char *otherwise) {
    const auto w = taken(g, place, name);
    return w ? w->text : otherwise;
}

std::string moved(std::string shape, Given &g, std::size_t place) {
    const auto center = taken(g, place, "center");
    if (!center || center->text == "[0, 0, 0]") return shape;
    return shape + ".translate(" + center->text + ")";
}

// A shape along y, of that height, put between two points that lie opposite; else empty.
std::string between(const std::string &a, const std::string &b, const std::string &head,
                    const std::string &tail) {
    if (a == negated(b) || b == negated(a)) {
        const bool up = b == "X" || b == "Y" || b == "Z";
        if (up) return head + "2" + tail + (b == "Y" ? "" : ".orient(Y, " + b + ")");
        return head + "2 * length(" + b + ")" + tail + ".orient(Y, " + b + ")";
    }
    return {};
}

std::optional<Written> slab_of(Given &g) {
    std::string out;
    constexpr std::string_view axes = "XYZ";
    for (std::size_t i = 0; i < 6; ++i) {
        const std::string name{"xyz"[i / 2], i % 2 == 0 ? '0' : '1'};
        const auto end = taken(g, i, name);
        if (!end || end->text == "None") continue;
        const std::string axis{axes[i / 2]};
        const std::string at = i % 2 == 0 ? negated(end->text) : end->text;
        out +=
            (out.empty() ? "" : " & ") + call_text("plane", {(i % 2 == 0 ? "-" : "") + axis, at});
    }
    if (out.empty()) return std::nullopt;
    return Written{out, 2, Kind::Solid};
}

} // namespace

std::optional<Written> Writer::sdf_shape(const std::string &name, Given &g) {
    if (name == "sphere")
        return solid_of(moved(call_text(name, {or_else(g, 0, "radius", "1")}), g, 1));
    if (name == "box") {
        const auto a = taken(g, 2, "a"), b = taken(g, 3, "b");
        if (a && b) return solid_of(between_corners(name, *a, *b));
        return solid_of(moved(call_text(name, {or_else(g, 0, "size", "1")}), g, 1));
    }
    if (name == "rounded_box")
        return solid_of(call_text(name, {need(g, 0, "size"), "radius: " + need(g, 1, "radius")}));
    if (name == "wireframe_box") {
        const auto size = taken(g, 0, "size"), bar = taken(g, 1, "thickness");
        if (!size || !bar) return std::nullopt;
        return solid_of("box_frame(" + wrapped(*size, 8) + " + " + wrapped(*bar, 9) +
                        ", thickness: " + bar->text + ")");
    }
    if (name == "torus")
        return solid_of(call_text(name, {need(g, 0, "r1"), need(g, 1, "r2")}) + ".orient(Y, Z)");
    if (name == "capsule")
        return solid_of(call_text(name, {need(g, 0, "a"), need(g, 1, "b"), need(g, 2, "radius")}));
    if (name == "cylinder") {
        const auto r = taken(g, 0, "radius");
        if (!r) return std::nullopt;
        return solid_of("implicit(p => length(p.xy) - " + wrapped(*r, 9) + ", within: everywhere)");
    }
    if (name == "capped_cylinder" || name == "capped_cone") {
        const std::string a = need(g, 0, "a"), b = need(g, 1, "b");
        const bool cone = name == "capped_cone";
        const std::string radii =
            need(g, 2, cone ? "ra" : "radius") + (cone ? ", " + need(g, 3, "rb") : std::string());
        const std::string plain =
            between(a, b, (cone ? "capped_cone(" : "cylinder(") + radii + ", ", ")");
        if (!plain.empty()) return solid_of(plain);
        helpers_.insert(cone ? "fn cone_between(a: vec3, b: vec3, ra, rb) =\n"
                               "  capped_cone(ra, rb, length(b - a)).orient(Y, b - a)"
                               ".translate((a + b) / 2)\n"
                             : "fn cylinder_between(a: vec3, b: vec3, radius) =\n"
                               "  cylinder(radius, length(b - a)).orient(Y, b - a)"
                               ".translate((a + b) / 2)\n");
        return solid_of(call_text(cone ? "cone_between" : "cylinder_between", {a, b, radii}));
    }
    if (name == "rounded_cylinder")
        return solid_of(call_text(name, {need(g, 0, "ra"), need(g, 2, "h"), need(g, 1, "rb")}) +
                        ".orient(Y, Z)");
    if (name == "rounded_cone") {
        const std::string h = need(g, 2, "h");
        return solid_of(call_text("round_cone", {need(g, 0, "r1"), need(g, 1, "r2"), h}) +
                        ".orient(Y, Z).translate(z: " + halved(h) + ")");
    }
    if (name == "ellipsoid") return solid_of(call_text(name, {need(g, 0, "size")}));
    if (name == "octahedron") return solid_of(call_text(name, {need(g, 0, "r")}));
    if (name == "pyramid") {
        const std::string h = need(g, 0, "h");
        return solid_of("pyramid([1, " + h + ", 1]).orient(Y, Z).translate(z: " + halved(h) + ")");
    }
    if (name == "plane") { // what lies on the normal's side is solid
        const std::string n = or_else(g, 0, "normal", "Z");
        const auto at = taken(g, 1, "point");
        const bool moves = at && at->text != "[0, 0, 0]";
        return solid_of(call_text("plane", {negated(n)}) +
                        (moves ? ".translate(" + at->text + ")" : ""));
    }
    if (name == "slab") return slab_of(g);
    return std::nullopt;
}

std::optional<Written> Writer::sdf_flat(const std::string &name, Given &g) {
    if (name == "circle")
        return flat_of(moved(call_text(name, {or_else(g, 0, "radius", "1")}), g, 1));
    if (name == "rectangle")
        return flat_of(moved(call_text(name, {or_else(g, 0, "size", "1")}), g, 1));
    if (name == "rounded_rectangle")
        return flat_of(call_text(name, {need(g, 0, "size"), need(g, 1, "radius")}));
    if (name == "hexagon") return flat_of(call_text("regular_polygon", {"6", need(g, 0, "r")}));
    if (name == "polygon") return flat_of(call_text(name, {need(g, 0, "points")}));
    return std::nullopt;
}

std::optional<Written> Writer::sdf_change(const std::string &name, const Written &of, Given &g) {
    const std::string head = wrapped(of, as_call) + ".";
    const Kind kind = of.kind == Kind::Flat ? Kind::Flat : Kind::Solid;
    const auto changed = [&](const std::string &text) {
        return Written{head + text, as_call, kind};
    };
    if (name == "union" || name == "difference" || name == "intersection") {
        std::vector<Written> parts{of};
        for (std::size_t i = 0; i < g.by_place.size(); ++i) parts.push_back(*taken(g, i, ""));
        const auto k = taken(g, g.by_place.size(), "k");
        return combined(name, parts, k && k->text != "None" ? k->text : "");
    }
    if (name == "translate" || name == "scale" || name == "repeat") {
        const auto by = taken(g, 0,
                              name == "translate" ? "offset"
                              : name == "scale"   ? "factor"
                                                  : "spacing");
        if (!by) return std::nullopt;
        if (name != "repeat") return changed(call_text(name, {by->text}));
        taken(g, 2, "padding");
        const auto count = taken(g, 1, "count"); // to each side
        if (!count || count->text == "None") return changed(call_text(name, {by->text}));
        return changed(call_text(name, {by->text, "count: 2 * " + wrapped(*count, 10) + " + 1"}));
    }
    if (name == "rotate") {
        const std::string angle = need(g, 0, "angle");
        if (kind == Kind::Flat) return changed(call_text(name, {angle}));
        return changed(call_text(name, {angle, "axis: " + or_else(g, 1, "vector", "Z")}));
    }
    if (name == "rotate_to")
        return changed(call_text("orient", {need(g, 0, "a"), need(g, 1, "b")}));
    if (name == "orient") {
        const std::string to = need(g, 0, "axis");
        return to == "Z" ? of : changed(call_text(name, {"Z", to}));
    }
    if (name == "circular_array") {
        const std::string count = need(g, 0, "count"), far = or_else(g, 1, "offset", "0");
        return changed((far == "0" ? "" : "translate(x: " + far + ").") + "repeat_polar(" + count +
                       (kind == Kind::Flat ? ")" : ", axis: Z)"));
    }
    if (name == "dilate") return changed(call_text("offset", {need(g, 0, "r")}));
    if (name == "erode") return changed(call_text("offset", {negated(need(g, 0, "r"))}));
    if (name == "shell") return changed(call_text(name, {need(g, 0, "thickness")}));
    if (name == "elongate") {
        const auto by = taken(g, 0, "size");
        return by ? std::optional(changed("elongate(2 * " + wrapped(*by, 10) + ")")) : std::nullopt;
    }
    if (name == "twist") return changed(call_text(name, {negated(need(g, 0, "k")), "axis: Z"}));
    if (name == "bend")
        return changed(call_text(name, {need(g, 0, "k"), "axis: X", "towards: -Y"}));
    if (name == "blend") {
        const std::string other = need(g, 0, "other"), k = or_else(g, 1, "k", "0.5");
        return Written{call_text(name, {other, of.text, k}), as_call, kind};
    }
    if (name == "k") { // of what is joined to another one; what others are joined to ignores it
        taken(g, 0, name);
        return of;
    }
    if (name == "negate") return Written{call_text("complement", {of.text}), as_call, kind};
    if (name == "extrude")
        return Written{head + call_text(name, {need(g, 0, "h")}), as_call, Kind::Solid};
    if (name == "revolve") {
        const std::string far = or_else(g, 0, "offset", "0");
        return Written{head + (far == "0" ? "revolve()" : "revolve(" + far + ")") + ".orient(Y, Z)",
                       as_call, Kind::Solid};
    }
    return std::nullopt;
}

} // namespace fathom::lang::program
