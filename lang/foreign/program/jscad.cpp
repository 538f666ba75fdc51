// The shapes and changes of JSCAD, where up is z, and of scripts that write ours as JavaScript.
#include "lang/foreign/program/program.h"

#include <algorithm>
#include <array>

namespace fathom::lang::program {

namespace {

std::string part_or(Given &g, const std::string &name, const std::string &otherwise) {
    const auto w = taken(g, std::size_t(-1), name);
    return w ? w->text : otherwise;
}

// A colour by its parts from 0 to 1, or by its name.
std::string color_of(const Node &n, const Written &w) {
    if (n.is == Is::Text) return n.text;
    if (n.is == Is::List && n.parts.size() >= 3) {
        std::string inside = w.text.substr(1, w.text.size() - 2);
        if (n.parts.size() == 4) inside = inside.substr(0, inside.rfind(','));
        return "rgb(" + inside + ")";
    }
    throw Unsure{};
}

} // namespace

std::optional<Written> Writer::jscad_solid(const std::string &name, Given &g) {
    const std::string center = part_or(g, "center", "");
    taken(g, std::size_t(-1), "segments");
    const auto placed = [&](std::string text, bool flat = false) {
        if (!center.empty() && center != "[0, 0, 0]" && center != "[0, 0]" && center != "true")
            text += ".translate(" + center + ")";
        return flat ? flat_of(text) : solid_of(text);
    };
    if (name == "cuboid" || name == "cube") return placed("box(" + part_or(g, "size", "2") + ")");
    if (name == "sphere" || name == "geodesicSphere")
        return placed("sphere(" + part_or(g, "radius", "1") + ")");
    if (name == "ellipsoid") return placed("ellipsoid(" + part_or(g, "radius", "1") + ")");
    if (name == "roundedCuboid")
        return placed("rounded_box(" + part_or(g, "size", "2") +
                      ", radius: " + part_or(g, "roundRadius", "0.2") + ")");
    const std::string height = part_or(g, "height", "2");
    if (name == "cylinder")
        return placed("cylinder(" + part_or(g, "radius", "1") + ", " + height + ").orient(Y, Z)");
    if (name == "roundedCylinder")
        return placed("rounded_cylinder(" + part_or(g, "radius", "1") + ", " + height + ", " +
                      part_or(g, "roundRadius", "0.2") + ").orient(Y, Z)");
    if (name == "cylinderElliptic") {
        const auto first = [](const std::string &pair) { // of two that are alike
            const std::size_t comma = pair.find(", ");
            if (!pair.starts_with("[") || comma == std::string::npos ||
                pair.substr(1, comma - 1) != pair.substr(comma + 2, pair.size() - comma - 3))
                throw Unsure{};
            return pair.substr(1, comma - 1);
        };
        return placed("capped_cone(" + first(part_or(g, "startRadius", "[1, 1]")) + ", " +
                      first(part_or(g, "endRadius", "[1, 1]")) + ", " + height + ").orient(Y, Z)");
    }
    if (name == "torus")
        return placed("torus(" + part_or(g, "outerRadius", "4") + ", " +
                      part_or(g, "innerRadius", "1") + ").orient(Y, Z)");
    if (name == "circle") return placed("circle(" + part_or(g, "radius", "1") + ")", true);
    if (name == "ellipse") return placed("ellipse(" + part_or(g, "radius", "1") + ")", true);
    if (name == "rectangle" || name == "square")
        return placed("rectangle(" + part_or(g, "size", "2") + ")", true);
    if (name == "roundedRectangle")
        return placed("rounded_rectangle(" + part_or(g, "size", "2") + ", " +
                          part_or(g, "roundRadius", "0.2") + ")",
                      true);
    if (name == "polygon") return placed("polygon(" + part_or(g, "points", "") + ")", true);
    return std::nullopt;
}

// Functions that take what they are told first and the shapes behind it.
std::optional<Written> Writer::jscad_change(const std::string &name, const Node &n) {
    if (n.parts.size() < 3) return std::nullopt;
    constexpr std::array<std::string_view, 16> all = {
        "translate", "translateX", "translateY", "translateZ", "rotate",        "rotateX",
        "rotateY",   "rotateZ",    "scale",      "colorize",   "extrudeLinear", "extrudeRotate",
        "expand",    "offset",     "mirror",     "color"};
    bool known = false;
    for (const std::string_view one : all) known = known || one == name;
    if (!known) return std::nullopt;
    const Written of = joined("union", n, 2, std::nullopt);
    const std::string head = wrapped(of, as_call) + ".";
    const auto changed = [&](const std::string &text) {
        return Written{head + text, as_call, of.kind};
    };
    const Node &told = n.parts[1];
    if (name == "extrudeLinear" || name == "extrudeRotate" || name == "expand" ||
        name == "offset" || name == "mirror") {
        if (told.is != Is::Record) throw Unsure{};
        Given g;
        for (std::size_t i = 0; i < told.parts.size(); ++i)
            if (told.names[i] != "corners") g.by_name[told.names[i]] = value(told.parts[i]);
        taken(g, 0, "segments");
        std::string out;
        if (name == "extrudeLinear") {
            const std::string height = part_or(g, "height", "1");
            const auto twist = taken(g, 0, "twistAngle");
            taken(g, 0, "twistSteps");
            out = head + "extrude(" + height + (twist ? ", twist: " + twist->text : "") +
                  ").translate(z: " + halved(height) + ")";
        } else if (name == "extrudeRotate") {
            out = head + "revolve().orient(Y, Z)";
        } else if (name == "mirror") {
            const std::string normal = part_or(g, "normal", "[0, 0, 1]");
            out = head + "reflect(" + normal + ")";
        } else {
            out = head + "offset(" + part_or(g, "delta", "1") + ")";
        }
        if (g.asked.size() < g.by_name.size()) throw Unsure{};
        for (const auto &[key, given_value] : g.by_name)
            if (!g.asked.contains(key)) throw Unsure{};
        const bool solid = name.starts_with("extrude") || of.kind != Kind::Flat;
        return Written{out, as_call, solid ? Kind::Solid : Kind::Flat};
    }
    if (name == "colorize" || name == "color") {
        std::string color;
        if (told.is == Is::Call && told.parts.size() == 2 && told.parts[1].is == Is::Text)
            color = told.parts[1].text; // `colorNameToRgb("red")`
        else
            color = color_of(told, told.is == Is::Text ? Written{} : value(told));
        return changed("paint(" + color + ")");
    }
    if (name == "rotate") { // about x, then y, then z
        if (told.is != Is::List || told.parts.size() != 3) {
            if (of.kind == Kind::Flat) return changed("rotate(" + text(told) + ")");
            throw Unsure{};
        }
        std::string out;
        for (std::size_t i = 0; i < 3; ++i) {
            const std::string angle = text(told.parts[i]);
            if (angle == "0") continue;
            out += (out.empty() ? "" : ".") + ("rotate(" + angle + ", axis: ") + "XYZ"[i] + ")";
        }
        return out.empty() ? of : changed(out);
    }
    if (name.starts_with("rotate"))
        return changed("rotate(" + text(told) + ", axis: " + name.back() + ")");
    if (name.starts_with("translate") && name.size() > 9)
        return changed("translate(" + std::string(1, "xyz"[name.back() - 'X']) + ": " + text(told) +
                       ")");
    if (of.kind == Kind::Flat && told.is == Is::List && told.parts.size() == 3)
        return changed(name + "([" + text(told.parts[0]) + ", " + text(told.parts[1]) + "])");
    return changed(name + "(" + text(told) + ")");
}

std::optional<Written> Writer::jscad(const std::string &name, const Node &n) {
    if (name == "union" || name == "subtract" || name == "intersect")
        return joined(name, n, 1, std::nullopt);
    if (auto made = jscad_change(name, n)) return made;
    Given g;
    if (n.parts.size() == 2 && n.parts[1].is == Is::Record)
        for (std::size_t i = 0; i < n.parts[1].parts.size(); ++i)
            g.by_name[n.parts[1].names[i]] = value(n.parts[1].parts[i]);
    else if (n.parts.size() > 1)
        return std::nullopt;
    auto made = jscad_solid(name, g);
    for (const auto &[key, given_value] : g.by_name)
        if (made && !g.asked.contains(key)) throw Unsure{};
    return made;
}

// `getParameterDefinitions = () => [{ name: 'r', type: 'float', initial: 1, min: 0, max: 2 }]`: a
// `param` each.
void Writer::jscad_params(const Statement &s) {
    const Node *list = nullptr;
    const std::vector<Statement> *body = s.name == defines_params ? &s.body : nullptr;
    if (s.does == Does::Set && s.targets.size() == 1 && is_named(s.targets[0], defines_params) &&
        s.value.is == Is::Lambda) {
        body = &s.value.body;
        if (!s.value.parts.empty()) list = &s.value.parts[0];
    }
    if (!body) return;
    if (!list && body->size() == 1 && body->front().does == Does::Return)
        list = &body->front().value;
    if (!list || list->is != Is::List) throw Unsure{};
    for (const Node &one : list->parts) {
        std::map<std::string, const Node *> of;
        for (std::size_t i = 0; one.is == Is::Record && i < one.parts.size(); ++i)
            of[one.names[i]] = &one.parts[i];
        const Node *name = of["name"], *type = of["type"];
        const Node *first = of["initial"] ? of["initial"] : of["default"];
        if (!name || !type) throw Unsure{};
        if (type->text == "group") continue; // a heading
        const auto slider = [&](Kind kind) {
            const std::string ours = fresh(name->text);
            scopes_.back().taken.insert(ours);
            slider_[name->text] = {ours, as_call, kind};
            return ours;
        };
        const bool truth = type->text == "checkbox";
        if (truth) {
            const bool on = of["checked"] && is_named(*of["checked"], "true");
            line("param " + slider(Kind::Unknown) + " = " + (on ? "true" : "false"));
            continue;
        }
        const bool whole = type->text == "int";
        if (!first ||
            (!whole && type->text != "float" && type->text != "number" && type->text != "slider"))
            throw Unsure{};
        std::string value_of = text(*first);
        const bool negative = value_of.starts_with('-');
        const std::string range = of["min"] && of["max"]
                                      ? text(*of["min"], 8) + ".." + text(*of["max"], 8)
                                      : range_around(value_of.substr(negative), negative);
        if (!whole && value_of.find('.') == std::string::npos &&
            std::ranges::count(range, '.') == 2) // between the ends no whole numbers alone
            value_of += ".0";
        line("param " + slider(Kind::Number) + " = " + value_of + " in " + range);
    }
}

// Scripts that write the library's own names.
std::optional<Written> Writer::script_shape(const std::string &name, Given &g) {
    struct Row {
        std::string_view theirs, ours;
        std::size_t least, most;
        bool flat;
    };
    constexpr std::array<Row, 12> rows = {{{"sphere", "sphere", 0, 1, false},
                                           {"box", "box", 1, 1, false},
                                           {"cube", "box", 1, 1, false},
                                           {"torus", "torus", 2, 2, false},
                                           {"cylinder", "cylinder", 2, 2, false},
                                           {"cone", "cone", 2, 2, false},
                                           {"capsule", "capsule", 3, 3, false},
                                           {"roundedBox", "rounded_box", 2, 2, false},
                                           {"ellipsoid", "ellipsoid", 1, 1, false},
                                           {"circle", "circle", 1, 1, true},
                                           {"rectangle", "rectangle", 1, 1, true},
                                           {"smoothUnion", "smooth_union", 3, 9, false}}};
    if ((name == "sdf" || name == "implicit") && g.by_place.size() == 1 &&
        g.by_place[0].kind == Kind::Function)
        return solid_of("implicit(" + taken(g, 0, "")->text + ", within: everywhere)");
    if ((name == "render" || name == "show" || name == "draw") && g.by_place.size() == 1)
        return taken(g, 0, "");
    for (const Row &row : rows) {
        if (row.theirs != name) continue;
        if (g.by_place.size() < row.least || g.by_place.size() > row.most || !g.by_name.empty())
            throw Unsure{};
        std::vector<std::string> arguments;
        for (std::size_t i = 0; i < g.by_place.size(); ++i)
            arguments.push_back(taken(g, i, "")->text);
        const std::string text = call_text(row.ours, arguments);
        return row.flat ? flat_of(text) : solid_of(text);
    }
    return std::nullopt;
}

std::optional<Written> Writer::script_change(const std::string &name, const Written &of, Given &g) {
    const Kind kind = of.kind == Kind::Flat ? Kind::Flat : Kind::Solid;
    if (name == "union" || name == "subtract" || name == "intersect" || name == "difference" ||
        name == "intersection" || name == "add") {
        std::vector<Written> parts{of};
        for (std::size_t i = 0; i < g.by_place.size(); ++i) {
            Written w = *taken(g, i, "");
            if (w.kind == Kind::List) w = {call_text("union", {w.text}), as_call, kind};
            parts.push_back(std::move(w));
        }
        return combined(name == "add" ? "union" : name, parts, "");
    }
    struct Row {
        std::string_view theirs, ours;
    };
    constexpr std::array<Row, 9> rows = {{{"translate", "translate"},
                                          {"move", "translate"},
                                          {"scale", "scale"},
                                          {"shell", "shell"},
                                          {"offset", "offset"},
                                          {"extrude", "extrude"},
                                          {"color", "paint"},
                                          {"paint", "paint"},
                                          {"twist", "twist"}}};
    for (const Row &row : rows) {
        if (row.theirs != name) continue;
        std::vector<std::string> arguments;
        for (std::size_t i = 0; i < g.by_place.size(); ++i) {
            std::string one = taken(g, i, "")->text;
            if (row.ours == "paint" && one.starts_with("\"")) one = one.substr(1, one.size() - 2);
            arguments.push_back(std::move(one));
        }
        const bool vector = arguments.size() == 3 && row.ours == "translate"; // `.move(x, y, z)`
        const std::string all = call_text("", arguments);
        return Written{wrapped(of, as_call) + "." + std::string(row.ours) +
                           (vector ? "([" + all.substr(1, all.size() - 2) + "])" : all),
                       as_call, name == "extrude" ? Kind::Solid : kind};
    }
    return std::nullopt;
}

} // namespace fathom::lang::program
