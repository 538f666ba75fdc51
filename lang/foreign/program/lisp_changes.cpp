// What Bauble and libfive do to shapes: where they stand, how they are coloured, what is made of flat
// ones.
#include "lang/foreign/program/program.h"

#include <algorithm>
#include <array>

namespace fathom::lang::program {

// Whether it is of the point `p`, and not of a `p` of the program's own.
bool Writer::is_by_point(const Node &n) const {
    const bool names = n.is == Is::Name && (n.text == "p" || n.text.starts_with("p."));
    return (names && !find("p")) ||
           std::ranges::any_of(n.parts, [&](const Node &part) { return is_by_point(part); });
}

std::string Writer::lisp_of_point(const Node &n) {
    scopes_.emplace_back();
    if (!find("p")) scopes_.back().names["p"] = {"p", as_call, Kind::Vector};
    std::string text = lisp_text(n);
    scopes_.pop_back();
    return text;
}

// A colour as it is written here; empty where there is none of that kind.
std::string Writer::lisp_color(const Node &n) {
    if (n.is == Is::Name) {
        if (n.text == "normal") return "(p, n) => n";
        if (n.text == "normal+") return "(p, n) => 0.5 + 0.5 * n";
        if (const Written *own = find(n.text)) return own->kind == Kind::Function ? "" : own->text;
        return n.text.find_first_not_of("abcdefghijklmnopqrstuvwxyz") == n.text.npos ? n.text : "";
    }
    const bool hsv = lisp_head(n) == "hsv" && n.parts.size() == 4;
    if (!hsv && (n.is != Is::List || n.text != "[" || n.parts.size() != 3)) return {};
    std::vector<std::string> parts;
    const std::size_t scopes = scopes_.size();
    try {
        for (std::size_t i = hsv ? 1 : 0; i < n.parts.size(); ++i)
            parts.push_back(lisp_of_point(n.parts[i]));
    } catch (const Unsure &) { // of what a shape has not: of light, say
        scopes_.resize(scopes);
        return {};
    }
    return (is_by_point(n) ? "p => " : "") + call_text(hsv ? "hsv" : "rgb", parts);
}

// `(color s [1 0 0])`, `(shade s red)`, `(blinn-phong s (vec3 1 0 0) 10)`.
Written Writer::lisp_painted(const Node &n) {
    const std::string &name = n.parts[0].text;
    if (n.parts.size() < 3 || (name == "color" && n.parts.size() > 3)) throw Unsure{};
    const Written of = lisp(n.parts[1]);
    const std::string color = lisp_color(n.parts[2]);
    if (color.empty()) {
        lost_.insert("a `" + name + "` that is not of the point alone");
        return of;
    }
    return {wrapped(of, as_call) + ".paint(" + color + ")", as_call, of.kind};
}

// `(set background-color (vec3 0.2 0.3 0.4))`.
void Writer::lisp_setting(const Node &form) {
    if (form.parts.size() != 3 || form.parts[1].is != Is::Name) throw Unsure{};
    const std::string &name = form.parts[1].text;
    const std::string color = name == "background-color" ? lisp_color(form.parts[2]) : "";
    if (color.empty() || color.find("=>") != color.npos)
        lost_.insert("`set " + name + "`");
    else
        line("background(" + color + ")");
}

// `(extrude z 20 s)`, in either order, `(extrude-z s 0 1)`, `(revolve y s)`, `(revolve-y s)`.
std::optional<Written> Writer::lisp_profile(const std::string &name, const Form &f) {
    const auto of = [&](const Node &flat) {
        Written w = lisp_head(flat) == "lambda-shape" ? lisp_field(flat, true) : lisp(flat);
        if (w.kind != Kind::Flat && w.kind != Kind::Unknown) throw Unsure{};
        return wrapped(w, as_call) + ".";
    };
    const std::size_t count = f.rest.size();
    const std::string axis = f.axes.size() == 1 ? f.axes[0].first : "";
    if (!f.named.empty()) return std::nullopt;
    if (name == "extrude" && axis.size() == 1 && count == 2) {
        const bool half_first = lisp(*f.rest[0]).kind == Kind::Number;
        // The flat shape's x and y are x and z there along y, and y and z along x.
        const std::string turned = axis == "X"   ? ".rotate(120deg, axis: [1, 1, 1])"
                                   : axis == "Y" ? ".rotate(90deg, axis: X)"
                                                 : "";
        return solid_of(of(*f.rest[half_first ? 1 : 0]) + "extrude(" +
                        doubled(*f.rest[half_first ? 0 : 1]) + ")" + turned);
    }
    if (name == "extrude-z" && axis.empty() && count == 3)
        return solid_of(of(*f.rest[0]) + "extrude(" + lisp_text(*f.rest[2]) + " - " +
                        lisp_text(*f.rest[1], 9) + ").translate(z: (" + lisp_text(*f.rest[1]) +
                        " + " + lisp_text(*f.rest[2]) + ") / 2)");
    if (count == 1 && ((name == "revolve" && axis == "Y") || (name == "revolve-y" && axis.empty())))
        return solid_of(of(*f.rest[0]) + "revolve()");
    return std::nullopt;
}

// `(rotate s y 0.5)`, `(move s x 10 y 5)`, `(move-x s 10)`.
std::optional<Written> Writer::lisp_change(const std::string &name, const Node &n,
                                           const Form &given) {
    Form f = given;
    if (f.rest.empty()) return std::nullopt;
    if (name == "morph" && f.rest.size() == 3) {
        std::vector<Written> shapes;
        std::string by;
        for (const Node *part : f.rest) {
            Written w = lisp(*part);
            if (w.kind == Kind::Number && by.empty())
                by = w.text;
            else
                shapes.push_back(std::move(w));
        }
        if (shapes.size() != 2) throw Unsure{};
        return Written{call_text("blend", {shapes[1].text, shapes[0].text, by}), as_call,
                       Kind::Solid};
    }
    if (name == "color" || name == "shade" || name == "blinn-phong") return lisp_painted(n);
    Written of = lisp(*f.rest[0]);
    Node turned; // `(move x 10 s)` as `(move s x 10)`
    if (of.kind == Kind::Number && f.rest.back() == &n.parts.back())
        if (Written last = lisp(n.parts.back()); last.kind != Kind::Number) {
            of = std::move(last);
            turned = n;
            std::rotate(turned.parts.begin() + 1, turned.parts.end() - 1, turned.parts.end());
            f = form_of(turned);
        }
    const std::string head = wrapped(of, as_call) + ".";
    const auto changed = [&](const std::string &text) {
        return Written{head + text, as_call, of.kind};
    };
    const auto limit = f.named.find("limit");
    for (const auto &[key, given_value] : f.named)
        if (key != "limit" || name != "tile") return std::nullopt;
    const std::size_t count = f.rest.size();
    const auto at = [&](std::size_t i) {
        if (i >= f.rest.size()) throw Unsure{};
        return lisp_text(*f.rest[i]);
    };
    const bool by_axis = name.size() > 2 && name[name.size() - 2] == '-';
    if (by_axis && f.axes.empty() && count == 2) { // libfive's `rotate-x`
        Node same = n;
        same.parts[0].text = name.substr(0, name.size() - 2);
        same.parts.insert(same.parts.end() - 1, node(Is::Name, name.substr(name.size() - 1)));
        return lisp_change(same.parts[0].text, same, form_of(same));
    }
    if (by_axis && count == 1) {
        const std::string axis(1, static_cast<char>(name.back() - 32));
        const std::string base = name.substr(0, name.size() - 2);
        if (base == "symmetric" || base == "mirror") return changed("mirror(" + axis + ")");
        if (base == "reflect") return changed("reflect(" + axis + ")");
        return std::nullopt;
    }
    if (name == "move" || name == "rotate" || name == "scale") {
        if (f.axes.empty()) {
            if (count != 2 || (name == "rotate" && of.kind != Kind::Flat)) return std::nullopt;
            return changed((name == "move" ? "translate" : name) + "(" + at(1) + ")");
        }
        if (count != f.axes.size() + 1) return std::nullopt;
        std::string all;
        std::array<std::string, 3> sizes{"1", "1", "1"};
        for (std::size_t i = 0; i < f.axes.size(); ++i) {
            if (f.axes[i].second != i + 1 || f.axes[i].first.size() != 1) return std::nullopt;
            const char axis = f.axes[i].first[0];
            if (name == "move")
                all += (all.empty() ? "translate(" : ", ") +
                       std::string(1, static_cast<char>(axis + 32)) + ": " + at(i + 1);
            else if (name == "rotate")
                all += (all.empty() ? "rotate(" : ".rotate(") + at(i + 1) + ", axis: " + axis + ")";
            else
                sizes[static_cast<std::size_t>(axis - 'X')] = at(i + 1);
        }
        if (name == "scale")
            return changed("scale([" + sizes[0] + ", " + sizes[1] + ", " + sizes[2] + "])");
        return changed(all + (name == "move" ? ")" : ""));
    }
    if (name == "mirror" && !f.axes.empty() && count == 1) {
        std::string all;
        for (const auto &[axis, before] : f.axes)
            all += (all.empty() ? "mirror(" : ".mirror(") + axis + ")";
        return changed(all);
    }
    if ((name == "offset" || name == "expand") && count == 2) {
        const Node &by = *f.rest[1];
        return changed((is_by_point(by) ? "displace(p => " : "offset(") + lisp_of_point(by) + ")");
    }
    if (name == "shell" && count == 2) return changed("shell(" + at(1) + ")");
    if (name == "elongate" && count == 2) return changed("elongate(" + doubled(*f.rest[1]) + ")");
    if (name == "twist" && count == 2 && f.axes.size() == 1)
        return changed("twist(" + at(1) + ", axis: " + f.axes[0].first + ")");
    if (name == "radial" && count == 2 && f.axes.size() == 1)
        return changed("repeat_polar(" + at(1) + ", axis: " + f.axes[0].first + ")");
    if (name == "tile" && count == 2)
        return changed("repeat(" + at(1) +
                       (limit == f.named.end() ? "" : ", count: " + lisp_text(*limit->second)) +
                       ")");
    if (name == "slow" && count == 2) {
        lost_.insert("`slow`, as bounds are derived here");
        return of;
    }
    if (name == "with-lights" || name == "bound") {
        lost_.insert("`" + name + "`" + (name == "bound" ? ", as bounds are derived here" : ""));
        return of;
    }
    return std::nullopt;
}

} // namespace fathom::lang::program
