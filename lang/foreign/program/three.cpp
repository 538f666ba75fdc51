// Scenes of three.js: what is made by `new`, moved by its parts, and added.
#include "lang/foreign/program/program.h"

#include <array>

namespace fathom::lang::program {

namespace {

std::string color_text(const Node &n) {
    if (n.is == Is::Number && n.text.starts_with("0x") && n.text.size() == 8)
        return "#" + n.text.substr(2);
    if (n.is == Is::Text && !n.text.empty() &&
        n.text.find_first_not_of("abcdefghijklmnopqrstuvwxyz#0123456789ABCDEF") ==
            std::string::npos)
        return n.text;
    throw Unsure{};
}

struct Geometry {
    std::string_view theirs, head;
    std::array<std::string_view, 3> defaults; // of the arguments that are read
    std::size_t read, most;
    std::string_view tail;
};
// `0`, `1` and `2` stand for the arguments.
constexpr std::array<Geometry, 10> geometries = {
    {{"BoxGeometry", "box([0, 1, 2])", {"1", "1", "1"}, 3, 6, ""},
     {"SphereGeometry", "sphere(0)", {"1", "", ""}, 1, 3, ""},
     {"CylinderGeometry", "capped_cone(1, 0, 2)", {"1", "1", "1"}, 3, 5, ""},
     {"ConeGeometry", "cone(0, 1)", {"1", "1", ""}, 2, 4, ""},
     {"TorusGeometry", "torus(0, 1)", {"1", "0.4", ""}, 2, 4, ".orient(Y, Z)"},
     {"IcosahedronGeometry", "icosahedron(0)", {"1", "", ""}, 1, 1, ""},
     {"OctahedronGeometry", "octahedron(0)", {"1", "", ""}, 1, 1, ""},
     {"DodecahedronGeometry", "dodecahedron(0)", {"1", "", ""}, 1, 1, ""},
     {"CapsuleGeometry", "capsule([0, -1, 0], [0, 1, 0], 0)", {"1", "1", ""}, 2, 4, ""},
     {"RoundedBoxGeometry", "", {"", "", ""}, 0, 0, ""}}};

std::string_view last_part(std::string_view dotted) {
    const std::size_t dot = dotted.rfind('.');
    return dot == std::string_view::npos ? dotted : dotted.substr(dot + 1);
}

} // namespace

// What `new THREE.…(…)`, a name or a call of one's own function is; none for all else.
std::optional<Thing> Writer::thing(const Node &n) {
    if (n.is == Is::Name) {
        for (auto scope = scopes_.rbegin(); scope != scopes_.rend(); ++scope)
            if (const auto at = scope->things.find(n.text); at != scope->things.end())
                return at->second;
        return std::nullopt;
    }
    if (n.is != Is::Call) return std::nullopt;
    const std::string from = path(n.parts[0]);
    if (n.parts[0].is == Is::Name && find(n.parts[0].text)) {
        Thing made;
        made.is_mesh = true;
        made.text = text(n, as_call);
        return made;
    }
    if (n.parts[0].is == Is::Member && n.parts[0].text == "clone" && n.parts.size() == 1)
        return thing(n.parts[0].parts[0]);
    return thing_of(std::string(last_part(from)), n);
}

std::optional<Thing> Writer::thing_of(const std::string &name, const Node &n) {
    Thing made;
    if (name == "Group" || name == "Scene" || name == "Object3D") {
        made.is_group = true;
        return made;
    }
    if (name.ends_with("Material")) {
        made.is_material = true;
        if (n.parts.size() > 1 && n.parts[1].is == Is::Record)
            for (std::size_t i = 0; i < n.parts[1].parts.size(); ++i) {
                if (n.parts[1].names[i] == "color")
                    made.paint = color_text(n.parts[1].parts[i]);
                else
                    lost_.insert("what materials have beside their colour");
            }
        return made;
    }
    if (name == "Mesh") {
        if (n.parts.size() < 2) throw Unsure{};
        const std::optional<Thing> geometry = thing(n.parts[1]);
        if (!geometry || geometry->text.empty()) throw Unsure{};
        made.text = geometry->text;
        made.is_mesh = true;
        if (n.parts.size() > 2)
            if (const std::optional<Thing> material = thing(n.parts[2]))
                made.paint = material->paint;
        return made;
    }
    for (const Geometry &g : geometries) {
        if (!name.starts_with(g.theirs) || g.read == 0) continue;
        if (n.parts.size() - 1 > g.most) throw Unsure{};
        std::array<std::string, 3> given_text;
        for (std::size_t i = 0; i < g.read; ++i)
            given_text[i] =
                i + 1 < n.parts.size() ? text(n.parts[i + 1]) : std::string(g.defaults[i]);
        if (name.starts_with("Cylinder") && given_text[0] == given_text[1]) {
            made.text = call_text("cylinder", {given_text[0], given_text[2]});
            return made;
        }
        if (name.starts_with("Capsule")) {
            const std::string half = halved(given_text[1]);
            made.text = call_text("capsule", {"[0, " + negated(half) + ", 0]",
                                              "[0, " + half + ", 0]", given_text[0]});
            return made;
        }
        for (const char c : g.head) {
            if (c >= '0' && c <= '2')
                made.text += given_text[static_cast<std::size_t>(c - '0')];
            else
                made.text += c;
        }
        made.text += g.tail;
        return made;
    }
    return std::nullopt;
}

// A mesh as a value; none for what holds no shape of its own.
std::optional<std::string> Writer::shown(const Thing &t) const {
    if (t.is_group || t.is_material || !t.is_mesh) return std::nullopt;
    std::string out = t.text;
    const auto all = [](const std::map<std::string, std::string> &parts, const char *otherwise) {
        std::string list = "[";
        for (const char *axis : {"x", "y", "z"}) {
            const auto at = parts.find(axis);
            list += (list.size() > 1 ? ", " : "") + (at == parts.end() ? otherwise : at->second);
        }
        return list + "]";
    };
    if (!t.scaled.empty()) out += ".scale(" + all(t.scaled, "1") + ")";
    for (const char *axis : {"z", "y", "x"}) // three.js turns about z first
        if (const auto at = t.turned.find(axis); at != t.turned.end() && at->second != "0")
            out += ".rotate(" + at->second + ", axis: " + static_cast<char>(axis[0] - 32) + ")";
    if (t.moved.size() == 1)
        out += ".translate(" + t.moved.begin()->first + ": " + t.moved.begin()->second + ")";
    else if (!t.moved.empty())
        out += ".translate(" + all(t.moved, "0") + ")";
    if (!t.paint.empty()) out += ".paint(" + t.paint + ")";
    return out;
}

// `const cube = new THREE.Mesh(…)`, `cube.position.x = 1`, `cube.position.set(1, 0, 0)`.
bool Writer::three(const Statement &s) {
    if (of_ != Of::Three) return false;
    const auto own = [&](const std::string &name) -> Thing * {
        auto &things = scopes_.back().things;
        if (const auto at = things.find(name); at != things.end()) return &at->second;
        return nullptr;
    };
    const auto parts_of = [](Thing &t, const std::string &which) {
        return which == "position"   ? &t.moved
               : which == "rotation" ? &t.turned
               : which == "scale"    ? &t.scaled
                                     : nullptr;
    };
    if (s.does == Does::Value) {
        const Node &callee = s.value.parts[0];
        const std::string from = path(callee);
        const std::string root = from.substr(0, from.find('.'));
        const std::optional<Thing> of = root.empty() ? std::nullopt : thing(node(Is::Name, root));
        if (!of || of->is_material) return false;
        const std::string rest = from.size() > root.size() ? from.substr(root.size() + 1) : "";
        if (rest == "add") return false;
        Thing *t = own(root);
        if (rest == "position.set" || rest == "rotation.set" || rest == "scale.set") {
            if (!t || t->is_group || s.value.parts.size() != 4) throw Unsure{};
            auto *parts = parts_of(*t, rest.substr(0, rest.find('.')));
            for (std::size_t i = 0; i < 3; ++i)
                (*parts)[std::string(1, "xyz"[i])] = text(s.value.parts[i + 1]);
            return true;
        }
        throw Unsure{};
    }
    if (s.targets.size() != 1) return false;
    const Node &target = s.targets[0];
    if (target.is == Is::Name && s.sign == "=") {
        const bool made_anew = s.value.is == Is::Call && s.value.parts[0].is == Is::Member &&
                               is_named(s.value.parts[0].parts[0], "THREE");
        if (const std::optional<Thing> t = thing(s.value)) {
            scopes_.back().things[target.text] = *t;
            scopes_.back().names.erase(target.text);
            return true;
        }
        if (made_anew || (s.value.is == Is::Call && s.value.parts[0].is == Is::Name &&
                          s.value.parts[0].text == "OrbitControls")) {
            lost_.insert("lights, cameras and what is drawn on");
            return true;
        }
        return false;
    }
    const std::string from = path(target);
    const std::string root = from.substr(0, from.find('.'));
    if (target.is != Is::Member || root.empty()) return false;
    Thing *t = own(root);
    if (!t || t->is_group || !t->is_mesh) {
        const std::optional<Thing> other = thing(node(Is::Name, root));
        if (find(root) || (other && (from.find(".position") != std::string::npos ||
                                     from.find(".rotation") != std::string::npos ||
                                     from.find(".scale") != std::string::npos)))
            throw Unsure{};
        return true; // of a camera, a light
    }
    const std::string rest = from.substr(root.size() + 1);
    auto *parts = parts_of(*t, rest.substr(0, rest.find('.')));
    if (!parts) return true; // `castShadow`
    const std::string axis = rest.substr(rest.find('.') + 1);
    if (axis.size() != 1) throw Unsure{};
    if (s.sign == "=")
        (*parts)[axis] = text(s.value);
    else if (s.sign == "+=" && parts->contains(axis))
        (*parts)[axis] += " + " + text(s.value, 9);
    else if (s.sign == "+=" && rest[0] != 's')
        (*parts)[axis] = text(s.value);
    else
        throw Unsure{};
    return true;
}

} // namespace fathom::lang::program
