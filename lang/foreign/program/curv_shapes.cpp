// The shapes of Curv: up is z, round sizes are diameters, and an argument is one value.
#include "lang/foreign/program/program.h"

#include <algorithm>
#include <array>

namespace fathom::lang::program {

namespace {

const Node *part_of(const Node &record, std::string_view name) {
    if (record.is != Is::Record) return nullptr;
    for (std::size_t i = 0; i < record.parts.size(); ++i)
        if (record.names[i] == name) return &record.parts[i];
    return nullptr;
}

std::optional<std::string> axis_of(const std::string &name) {
    if (name == "X_axis" || name == "Y_axis" || name == "Z_axis") return name.substr(0, 1);
    return std::nullopt;
}

constexpr std::array<std::string_view, 29> changes = {
    "move",       "translate", "rotate",          "scale",           "stretch",        "reflect",
    "reflect_x",  "reflect_y", "reflect_z",       "colour",          "color",          "offset",
    "shell",      "extrude",   "revolve",         "twist",           "repeat_x",       "repeat_xy",
    "repeat_xyz", "repeat_y",  "repeat_z",        "repeat_radial",   "lipschitz",      "complement",
    "set_bbox",   "align",     "repeat_mirror_x", "repeat_mirror_y", "repeat_mirror_z"};

} // namespace

static bool is_curv_change(std::string_view name) {
    return std::ranges::find(changes, name) != changes.end();
}

// Parts of a union and the like: shapes, and loops that give them.
Written Writer::curv_joined(const std::string &name, const Node &list, const std::string &k) {
    const auto loops =
        std::ranges::any_of(list.parts, [](const Node &n) { return n.is == Is::ForEach; });
    if (list.is != Is::List) {
        const Written w = value(list);
        if (name != "union" || !k.empty()) throw Unsure{};
        return solid_of(call_text("union", {w.text}));
    }
    if (!loops) {
        std::vector<Written> parts;
        for (const Node &n : list.parts) parts.push_back(value(n));
        return combined(name, std::move(parts), k);
    }
    std::string out = k.empty() ? name + " {\n" : "smooth_" + name + "(" + k + ") {\n";
    const auto indent = [&](int n) { return std::string(static_cast<std::size_t>(n) * 2, ' '); };
    ++depth_;
    for (const Node &n : list.parts) {
        const Node *body = &n;
        std::string head, tail;
        std::size_t opened = 0;
        for (; body->is == Is::ForEach; body = &body->parts[0], ++opened) {
            const std::string range = range_of(body->parts[1]);
            scopes_.emplace_back();
            head += "for " + declare(body->text, Kind::Number) + " in " + range + " { ";
            tail += " }";
        }
        const Written w = value(*body);
        for (; opened > 0; --opened) scopes_.pop_back();
        out += indent(depth_) + head + w.text + tail + "\n";
    }
    --depth_;
    return {out + indent(depth_) + "}", as_call, Kind::Solid};
}

std::optional<Written> Writer::curv_shape(const std::string &name, const Node &a) {
    const auto part = [&](std::string_view key) {
        const Node *n = part_of(a, key);
        if (!n) throw Unsure{};
        return value(*n);
    };
    const auto half = [](const Written &w) { return halved(w.text); };
    if (name == "sphere") return solid_of("sphere(" + half(value(a)) + ")");
    if (name == "cube") return solid_of("box(" + text(a) + ")");
    if (name == "box") return solid_of("box(" + text(a) + ")");
    if (name == "ellipsoid") return solid_of("ellipsoid(" + half(value(a)) + ")");
    if (name == "cylinder")
        return solid_of("cylinder(" + half(part("d")) + ", " + part("h").text + ").orient(Y, Z)");
    if (name == "cone")
        return solid_of("cone(" + half(part("d")) + ", " + part("h").text + ").orient(Y, Z)");
    if (name == "torus")
        return solid_of("torus(" + half(part("major")) + ", " + half(part("minor")) +
                        ").orient(Y, Z)");
    if (name == "half_space")
        return solid_of("plane(" + part("normal").text + ", " +
                        (part_of(a, "d") ? part("d").text : "0") + ")");
    if (name == "circle") return flat_of("circle(" + half(value(a)) + ")");
    if (name == "rect" || name == "square") return flat_of("rectangle(" + text(a) + ")");
    if (name == "ellipse") return flat_of("ellipse(" + half(value(a)) + ")");
    if (name == "polygon") return flat_of("polygon(" + text(a) + ")");
    if (name == "regular_polygon") { // by the circle within, one side at the foot
        const std::string n = text(a, 10);
        return flat_of("regular_polygon(" + n + ", 1 / cos(pi / " + n + ")).rotate(180deg / " + n +
                       " - 90deg)");
    }
    if (name == "union" || name == "intersection" || name == "difference")
        return curv_joined(name, a, "");
    if (name == "make_shape") return curv_field(a);
    return std::nullopt;
}

// `make_shape {dist [x, y, z, t] = e; bbox = [[…], […]]}`.
Written Writer::curv_field(const Node &record) {
    const Node *dist = part_of(record, "dist"), *box = part_of(record, "bbox");
    if (!dist || dist->is != Is::Lambda || dist->names.empty()) throw Unsure{};
    const auto says = [&](std::string_view key) {
        const Node *said = part_of(record, key);
        return said && !is_named(*said, "false");
    };
    const bool flat = says("is_2d") && !says("is_3d");
    for (const std::string &key : record.names)
        if (key != "dist" && key != "bbox" && key != "is_3d" && key != "is_2d" && key != "colour")
            throw Unsure{};
    const auto name_point = [&](const std::vector<std::string> &names) {
        if (names.size() == 1) {
            if (flat) throw Unsure{}; // its point has a height, too
            scopes_.back().names[names[0]] = {"p", as_call, Kind::Vector};
            return;
        }
        const std::array<const char *, 4> parts = {"p.x", "p.y", flat ? "0" : "p.z", "time"};
        if (names.size() != 4) throw Unsure{};
        for (std::size_t i = 0; i < 4; ++i)
            scopes_.back().names[names[i]] = {parts[i], as_call, Kind::Number};
    };
    scopes_.emplace_back();
    name_point(dist->names);
    const std::string field = text(dist->parts[0]);
    scopes_.pop_back();
    std::string paint;
    if (const Node *color = part_of(record, "colour")) {
        std::optional<std::string> painted;
        if (color->is == Is::Lambda) {
            scopes_.emplace_back();
            name_point(color->names);
            if (!flat) painted = curv_color(color->parts[0]);
            scopes_.pop_back();
        }
        if (painted)
            paint = ".paint(p => " + *painted + ")";
        else
            lost_.insert("a colour");
    }
    std::string within = "everywhere";
    if (box) {
        if (box->is != Is::List || box->parts.size() != 2) throw Unsure{};
        const auto corner = [&](Node at) {
            if (flat && (at.is != Is::List || at.parts.size() != 3)) throw Unsure{};
            if (flat) at.parts.pop_back();
            return text(at);
        };
        within = call_text("aabb", {corner(box->parts[0]), corner(box->parts[1])});
    }
    if (flat) return flat_of("implicit2(p => " + field + ", within: " + within + ")");
    return solid_of("implicit(p => " + field + ", within: " + within + ")" + paint);
}

// `s >> f x`: what `f` with the argument, or without one, does to the shape.
Written Writer::curv_changed(const Written &of, const std::string &name, const Node *a) {
    const std::string head = wrapped(of, as_call) + ".";
    const auto changed = [&](const std::string &all) {
        return Written{head + all, as_call, of.kind};
    };
    if (name == "revolve") return solid_of(head + "revolve().orient(Y, Z)");
    if (name == "complement") return {call_text(name, {of.text}), as_call, of.kind};
    if (name.starts_with("repeat_mirror_") && name.size() == 15)
        return changed("mirror(" + std::string(1, static_cast<char>(name.back() - 32)) + ")");
    if (name.starts_with("reflect_") && name.size() == 9)
        return changed("reflect(" + std::string(1, static_cast<char>(name.back() - 32)) + ")");
    if (!a) throw Unsure{};
    if (name == "lipschitz") {
        lost_.insert("`lipschitz`, as bounds are derived here");
        return of;
    }
    if (name == "set_bbox") {
        lost_.insert("`set_bbox`, as boxes are found here");
        return of;
    }
    if (name == "align") {
        const Node *from = part_of(*a, "from"), *to = part_of(*a, "to");
        if (!from || !to) throw Unsure{};
        return changed(call_text("orient", {text(*from), text(*to)}));
    }
    if (name == "move" || name == "translate") return changed("translate(" + text(*a) + ")");
    if (name == "scale" || name == "stretch") return changed("scale(" + text(*a) + ")");
    if (name == "reflect") return changed("reflect(" + text(*a) + ")");
    if (name == "offset" || name == "shell") return changed(name + "(" + text(*a) + ")");
    if (name == "extrude") return solid_of(head + "extrude(" + text(*a) + ")");
    if (name == "twist") return changed("twist(" + text(*a) + ", axis: Z)");
    if (name == "rotate") {
        const Node *angle = part_of(*a, "angle"), *axis = part_of(*a, "axis");
        if (a->is == Is::Record && !angle) throw Unsure{};
        const std::string turn = text(angle ? *angle : *a);
        if (of.kind == Kind::Flat) return changed("rotate(" + turn + ")");
        return changed("rotate(" + turn + ", axis: " + (axis ? text(*axis) : "Z") + ")");
    }
    if (name == "repeat_radial")
        return changed("repeat_polar(" + text(*a) + (of.kind == Kind::Flat ? ")" : ", axis: Z)"));
    if (name == "repeat_x" || name == "repeat_y" || name == "repeat_z") {
        std::string cell = "[0, 0, 0]";
        const std::size_t at = 1 + 3 * static_cast<std::size_t>(name.back() - 'x');
        return changed("repeat(" + cell.replace(at, 1, text(*a)) + ")");
    }
    if (name == "repeat_xyz") return changed("repeat(" + text(*a) + ")");
    if (name == "repeat_xy") {
        if (a->is != Is::List || a->parts.size() != 2) throw Unsure{};
        return changed("repeat([" + text(a->parts[0]) + ", " + text(a->parts[1]) + ", 0])");
    }
    if (name != "colour" && name != "color") throw Unsure{};
    if (const auto color = curv_color(*a)) return changed("paint(" + *color + ")");
    lost_.insert("a colour");
    return of;
}

// `red`, `sRGB[r, g, b]`, `sRGB.HSV[h, s, v]`, `hue h`, `grey v`; nothing where it is another one.
std::optional<std::string> Writer::curv_color(const Node &n) {
    if (n.is == Is::Name) return find(n.text) ? text(n) : n.text;
    if (n.is != Is::Call) return std::nullopt;
    const Node &of = n.parts[0], &given = n.parts[1];
    const bool of_space = of.is == Is::Member && is_named(of.parts[0], "sRGB");
    const std::string &name = of.text;
    if (of.is != Is::Name && !of_space) return std::nullopt;
    if (name == "hue") return "hsv(" + text(given) + ", 1, 1)";
    if (name == "grey" || name == "gray") return "vec3(" + text(given) + ")";
    const bool hsv = of_space && name == "HSV";
    if ((!hsv && name != "sRGB" && name != "rgb") || given.is != Is::List ||
        given.parts.size() != 3)
        return std::nullopt;
    const std::string all = text(given);
    return (hsv ? "hsv(" : "rgb(") + all.substr(1, all.size() - 2) + ")";
}

Written Writer::curv_pipe(const Node &n) {
    const Written of = value(n.parts[0]);
    const Node &f = n.parts[1];
    const Node &named = f.is == Is::Call ? f.parts[0] : f;
    if (named.is == Is::Name && is_curv_change(named.text) && !find(named.text))
        return curv_changed(of, named.text, f.is == Is::Call ? &f.parts[1] : nullptr);
    if (f.is == Is::Name)
        if (const Written *own = find(f.text); own && own->kind == Kind::Function)
            return {call_text(own->text, {of.text}), as_call, Kind::Unknown};
    if (named.is == Is::Name && !find(named.text))
        return unread_change(of, named.text,
                             f.is == Is::Call ? std::vector{text(f.parts[1])}
                                              : std::vector<std::string>{});
    throw Unsure{};
}

Written Writer::curv_call(const Node &n) {
    const Node &callee = n.parts[0], &a = n.parts[1];
    if (callee.is == Is::Call && callee.parts[0].is == Is::Name) { // `move v s`, `morph k [a, b]`
        const std::string &name = callee.parts[0].text;
        if (name == "morph" && a.is == Is::List && a.parts.size() == 2)
            return solid_of(
                call_text("blend", {text(a.parts[1]), text(a.parts[0]), text(callee.parts[1])}));
        if (is_curv_change(name)) return curv_changed(value(a), name, &callee.parts[1]);
        if (find(name) || is_mathematical(name)) throw Unsure{};
        return unread_call(name, {text(callee.parts[1]), text(a)});
    }
    if (callee.is == Is::Member) {
        const Node &of = callee.parts[0];
        if (callee.text == "exact" || callee.text == "mitred") {
            if (of.is == Is::Name && !find(of.text))
                if (const auto made = curv_shape(of.text, a)) return *made;
            throw Unsure{};
        }
        if (of.is == Is::Call && is_named(of.parts[0], "smooth"))
            return curv_joined(callee.text, a, text(of.parts[1]));
        throw Unsure{};
    }
    if (callee.is != Is::Name) throw Unsure{};
    if (const Written *own = find(callee.text)) {
        const Node *at = a.is == Is::List && a.parts.size() == 1 ? &a.parts[0] : nullptr;
        constexpr std::string_view axes = "XYZ";
        const bool axis = at && at->is == Is::Name && at->text.size() == 1 &&
                          axes.find(at->text[0]) != std::string_view::npos; // `p[X]`
        if (own->kind == Kind::List || own->kind == Kind::Vector ||
            (own->kind == Kind::Unknown && at && (axis || at->is == Is::Number))) {
            if (!at) throw Unsure{};
            const std::string place = axis ? std::to_string(axes.find(at->text[0])) : text(*at);
            return {own->text + "[" + place + "]", as_call, Kind::Unknown};
        }
        if (own->kind != Kind::Function) throw Unsure{};
        std::vector<std::string> arguments;
        const auto arity = arities_.find(callee.text);
        if (a.is == Is::Record) {
            for (std::size_t i = 0; i < a.parts.size(); ++i)
                arguments.push_back(a.names[i] + ": " + text(a.parts[i]));
        } else if (arity != arities_.end() && arity->second > 1) {
            if (a.is != Is::List || a.parts.size() != arity->second) throw Unsure{};
            for (const Node &part : a.parts) arguments.push_back(text(part));
        } else {
            arguments.push_back(text(a));
        }
        return {call_text(own->text, arguments), as_call, Kind::Unknown};
    }
    if (is_curv_change(callee.text)) { // without more: `complement s`, `revolve s`
        if (callee.text == "complement" || callee.text == "revolve" ||
            callee.text.starts_with("repeat_mirror_"))
            return curv_changed(value(a), callee.text, nullptr);
        throw Unsure{};
    }
    if (const auto made = curv_shape(callee.text, a)) return *made;
    Node plain = node(Is::Call, "", {node(Is::Name, callee.text == "mag" ? "norm" : callee.text)});
    const bool spread = callee.text == "max" || callee.text == "min" || callee.text == "dot" ||
                        callee.text == "cross" || callee.text == "pow";
    if (!is_mathematical(plain.parts[0].text)) return unread_call(callee.text, {text(a)});
    if (spread && a.is == Is::List)
        plain.parts.insert(plain.parts.end(), a.parts.begin(), a.parts.end());
    else
        plain.parts.push_back(a);
    plain.names.resize(plain.parts.size() - 1);
    return mathematics(plain.parts[0].text, plain);
}

// `Z_axis`, `nothing`, `45*deg`.
std::optional<Written> Writer::curv_constant(const Node &n) {
    if (n.is == Is::Binary && n.text == "*" && is_named(n.parts[1], "deg")) {
        const Node &turn = n.parts[0];
        if (turn.is == Is::Number) return Written{turn.text + "deg", as_call, Kind::Number};
        if (turn.is == Is::Unary && turn.text == "-" && turn.parts[0].is == Is::Number)
            return Written{"-" + turn.parts[0].text + "deg", 10, Kind::Number};
    }
    if (n.is != Is::Name || find(n.text)) return std::nullopt;
    if (const auto axis = axis_of(n.text)) return Written{*axis, as_call, Kind::Vector};
    if (n.text == "nothing") return solid_of("empty");
    if (n.text == "deg") return Written{"1deg", as_call, Kind::Number};
    if (n.text == "time") return Written{"time", as_call, Kind::Number};
    return std::nullopt;
}

// `param r = 1 in 0.5..2`.
void Writer::curv_param(const Statement &s) {
    if (s.name == "colour_picker") {
        if (s.value.is != Is::Name) throw Unsure{};
        return line("param " + declare(s.targets[0].text, Kind::Unknown) + " = " + s.value.text);
    }
    if (s.name == "checkbox") {
        const std::string &on = s.value.text; // `#true`
        return line("param " + declare(s.targets[0].text, Kind::Unknown) + " = " +
                    (on.ends_with("true") ? "true" : "false"));
    }
    const Node &ends = s.targets[1];
    if (ends.is != Is::List || ends.parts.size() != 2) throw Unsure{};
    const std::string low = text(ends.parts[0], 8), high = text(ends.parts[1], 8),
                      first = text(s.value);
    const bool whole =
        s.name != "int_slider" && (low + high + first).find('.') == std::string::npos;
    line("param " + declare(s.targets[0].text, Kind::Number) + " = " + first + (whole ? ".0" : "") +
         " in " + low + ".." + high);
}

} // namespace fathom::lang::program
