// The shapes of Bauble, whose boxes and heights are halves and whose up is y, and of libfive, whose
// boxes have two corners and whose up is z.
#include "base/text.h"
#include "lang/foreign/program/program.h"

#include <algorithm>
#include <array>

namespace fathom::lang::program {

namespace {

bool is_vector(const Node &n) { return n.is == Is::List && n.text == "["; }

// `x`, `-y`; empty where it is no axis.
std::string axis_text(const Node &n) {
    if (n.is != Is::Name) return {};
    const std::string_view name = n.text;
    const bool down = name.starts_with("-");
    const std::string_view axis = name.substr(down ? 1 : 0);
    if (axis != "x" && axis != "y" && axis != "z") return {};
    return std::string(down ? "-" : "") + static_cast<char>(axis[0] - 32);
}

std::string along(std::string shape, const std::string &axis) {
    return axis.empty() || axis == "Y" ? shape : shape + ".orient(Y, " + axis + ")";
}

} // namespace

// What a form calls; empty where it is a value or a vector.
std::string lisp_head(const Node &form) {
    if (form.is != Is::List || form.text != "(" || form.parts.empty() ||
        form.parts[0].is != Is::Name)
        return {};
    std::string head = form.parts[0].text; // Bauble has `tile:` and `tile*`
    if (head.size() > 1 && (head.back() == ':' || head.back() == '*')) head.pop_back();
    return head;
}

// A form's parts behind its head: axes, words with `:`, and the rest, in their order.
Writer::Form Writer::form_of(const Node &n) const {
    Form f;
    bool was_value = false; // an axis behind a value is no name of the program's own
    for (std::size_t i = 1; i < n.parts.size(); ++i) {
        const Node &part = n.parts[i];
        if (part.is == Is::Name && part.text.starts_with(":")) {
            if (i + 1 == n.parts.size()) throw Unsure{};
            if (const std::string axis = axis_text(node(Is::Name, part.text.substr(1)));
                !axis.empty()) { // `:y 0.5`
                f.axes.push_back({axis, f.rest.size()});
                continue;
            }
            f.named[part.text.substr(1)] = &n.parts[++i];
        } else if (const std::string axis = axis_text(part);
                   !axis.empty() && (!find(part.text) || (was_value && i + 1 < n.parts.size()))) {
            was_value = false;
            f.axes.push_back({axis, f.rest.size()});
        } else {
            f.rest.push_back(&part);
            was_value = true;
        }
    }
    return f;
}

std::string Writer::doubled(const Node &n) {
    if (is_vector(n)) {
        std::string out = "[";
        for (const Node &part : n.parts) out += (out.size() > 1 ? ", " : "") + doubled(part);
        return out + "]";
    }
    const std::string of = lisp_text(n, 10);
    const auto number = parse_number(of);
    return number ? format_shortest(*number * 2) : "2 * " + of;
}

std::string Writer::lisp_text(const Node &n, int needs) { return wrapped(lisp(n), needs); }

Written Writer::lisp(const Node &n) {
    constexpr int most = 20000;
    if (++nodes_ > most) throw Unsure{};
    if (n.is == Is::Name) {
        if (const Written *w = find(n.text)) return *w;
        if (n.text == "t") return {"time", as_call, Kind::Number};
        if (n.text == "true" || n.text == "false") return {n.text, as_call, Kind::Number};
        if (n.text == "tau" || n.text == "pi") return {n.text, as_call, Kind::Number};
        if (n.text == "ground") return solid_of("plane(Y)");
        const std::size_t dot = n.text.find('.'); // `p.x`
        const Written *of = dot == std::string::npos ? nullptr : find(n.text.substr(0, dot));
        if (of && of->kind == Kind::Vector && dot + 2 == n.text.size() &&
            std::string_view("xyz").find(n.text.back()) < 3)
            return {of->text + n.text.substr(dot), as_call, Kind::Number};
        throw Unsure{};
    }
    if (n.is == Is::Unary || n.is == Is::Number) return value(n);
    if (n.is == Is::Binary) {
        return {lisp_text(n.parts[0], 9) + " " + n.text + " " + lisp_text(n.parts[1], 10), 9,
                Kind::Number};
    }
    if (is_vector(n)) {
        std::string out = "[";
        for (const Node &part : n.parts) out += (out.size() > 1 ? ", " : "") + lisp_text(part);
        return {out + "]", as_call, Kind::Vector};
    }
    const std::string head = lisp_head(n);
    if (head.empty() || n.parts.size() < 2) {
        if (n.parts.size() == 3 && n.parts[1].is == Is::Name &&
            std::string_view("/*+-").find(n.parts[1].text) < 4) // `(tau / 4)`
            return lisp(node(Is::List, "(", {n.parts[1], n.parts[0], n.parts[2]}));
        if (const Written *own = head.empty() ? nullptr : find(head); own && n.parts.size() == 1)
            return {call_text(own->text, {}), as_call, Kind::Unknown};
        throw Unsure{};
    }
    if (find(head)) return lisp_own(n);
    if (n.parts.size() == 3 && n.parts[1].is == Is::Name && n.parts[1].text.size() == 1 &&
        std::string_view("/*+").find(n.parts[1].text) < 3)
        return lisp(node(Is::List, "(", {n.parts[1], n.parts[0], n.parts[2]}));
    if (head == "view" && n.parts.size() == 2) return lisp(n.parts[1]);
    if (head == "if" && n.parts.size() == 4) {
        const std::string given = lisp_text(n.parts[1]), then = lisp_text(n.parts[2]);
        const Written otherwise = lisp(n.parts[3]);
        return {"if " + given + " { " + then + " } else { " + otherwise.text + " }", 0,
                otherwise.kind};
    }
    if (const auto made = lisp_number(head, n)) return *made;
    const Form f = form_of(n);
    if (const auto made = lisp_joined(head, n)) return *made;
    if (const auto made = lisp_solid(head, f)) return *made;
    if (const auto made = lisp_profile(head, f)) return *made;
    if (const auto made = lisp_change(head, n, f)) return *made;
    throw Unsure{};
}

Written Writer::lisp_own(const Node &n) {
    const Written own = *find(n.parts[0].text);
    if (own.kind != Kind::Function) throw Unsure{};
    std::vector<std::string> arguments;
    for (std::size_t i = 1; i < n.parts.size(); ++i) arguments.push_back(lisp_text(n.parts[i]));
    return {call_text(own.text, arguments), as_call, Kind::Unknown};
}

std::optional<Written> Writer::lisp_number(const std::string &head, const Node &n) {
    if (head.size() == 1 && std::string_view("+-*/").find(head[0]) < 4) {
        const int binds = head == "+" || head == "-" ? 8 : 9;
        if (n.parts.size() == 2 && head == "-")
            return Written{"-" + lisp_text(n.parts[1], 11), 10, Kind::Number};
        std::string out;
        for (std::size_t i = 1; i < n.parts.size(); ++i)
            out +=
                (i > 1 ? " " + head + " " : "") + lisp_text(n.parts[i], i > 1 ? binds + 1 : binds);
        return Written{out, binds, Kind::Number};
    }
    constexpr std::array<std::string_view, 23> same = {
        "sin",   "cos",  "tan",   "abs",    "sqrt", "min",   "max",       "mod",
        "exp",   "log",  "pow",   "atan",   "asin", "acos",  "floor",     "ceil",
        "round", "sign", "fract", "length", "mix",  "clamp", "smoothstep"};
    const bool compares = head == "<" || head == ">" || head == "<=" || head == ">=";
    if (compares && n.parts.size() == 3)
        return Written{lisp_text(n.parts[1], 7) + " " + head + " " + lisp_text(n.parts[2], 7), 6,
                       Kind::Number};
    if (head == "sin+" || head == "cos+") // Bauble's, from 0 to 1
        return Written{"0.5 + 0.5 * " + call_text(head.substr(0, 3), {lisp_text(n.parts[1])}), 8,
                       Kind::Number};
    if (head == "square") {
        const Written w = lisp(n.parts[1]);
        return Written{wrapped(w, as_call) + " ^ 2", 11, Kind::Number};
    }
    if (head == "expt" && n.parts.size() == 3)
        return Written{lisp_text(n.parts[1], as_call) + " ^ " + lisp_text(n.parts[2], as_call), 11,
                       Kind::Number};
    if (head == "perlin" && n.parts.size() == 2)
        return Written{call_text("noise", {lisp_text(n.parts[1])}), as_call, Kind::Number};
    if (std::ranges::find(same, head) == same.end()) return std::nullopt;
    std::vector<std::string> arguments;
    for (std::size_t i = 1; i < n.parts.size(); ++i) arguments.push_back(lisp_text(n.parts[i]));
    return Written{call_text(head, arguments), as_call, Kind::Number};
}

// `(lambda-shape (x y z) e)`, `(shape/3d e)` of the point `p`: a field of one's own.
Written Writer::lisp_field(const Node &n, bool flat) {
    const bool by_point = n.parts[0].text != "lambda-shape";
    if (n.parts.size() != (by_point ? 2u : 3u)) throw Unsure{};
    scopes_.emplace_back();
    if (by_point) scopes_.back().names["p"] = {"p", as_call, Kind::Vector};
    for (const Node &axis : by_point ? std::vector<Node>() : n.parts[1].parts) {
        if (axis.text != "x" && axis.text != "y" && axis.text != "z") throw Unsure{};
        if (!flat || axis.text != "z")
            scopes_.back().names[axis.text] = {"p." + axis.text, as_call, Kind::Number};
    }
    const std::string arguments = "(p => " + lisp_text(n.parts.back()) + ", within: everywhere)";
    scopes_.pop_back();
    if (flat) return flat_of("implicit2" + arguments);
    return solid_of("implicit" + arguments);
}

std::optional<Written> Writer::lisp_joined(const std::string &head, const Node &n) {
    if (head == "apply") return lisp_apply(n);
    if (head == "map" || head == "seq") return lisp_list(n);
    if ((head == "lambda-shape" && n.parts.size() == 3) || head == "shape/3d")
        return lisp_field(n, false);
    if (head == "shape/2d") return lisp_field(n, true);
    if (head != "union" && head != "intersect" && head != "intersection" && head != "subtract" &&
        head != "difference" && head != "blend")
        return std::nullopt;
    std::vector<Written> parts;
    std::string k;
    for (std::size_t i = 1; i < n.parts.size(); ++i) {
        const Node &part = n.parts[i];
        if (part.is == Is::Name && part.text == ":r" && i + 1 < n.parts.size())
            k = lisp_text(n.parts[++i]);
        else if (part.is == Is::Name && part.text.starts_with(":"))
            throw Unsure{};
        else if (part.is == Is::Spread)
            lisp_spread(part.parts[0], parts);
        else
            parts.push_back(lisp(part));
    }
    if (const auto made = lisp_of_lists(head, parts, k)) return made;
    if (head == "blend") { // libfive: the last is how far
        if (parts.size() != 3 || parts[2].kind != Kind::Number) throw Unsure{};
        k = parts[2].text;
        parts.pop_back();
    }
    return combined(head == "blend" ? "union" : head, std::move(parts), k);
}

std::optional<Written> Writer::lisp_solid(const std::string &name, const Form &f) {
    const auto round = f.named.find("r");
    const std::string axis = f.axes.empty() ? "" : f.axes[0].first;
    const auto at = [&](std::size_t i) {
        if (i >= f.rest.size()) throw Unsure{};
        return lisp_text(*f.rest[i]);
    };
    const auto put = [&](std::string shape, std::size_t i) { // libfive's place
        return f.rest.size() > i ? shape + ".translate(" + at(i) + ")" : shape;
    };
    for (const auto &[key, given_value] : f.named)
        if (key != "r") return std::nullopt;
    const std::size_t count = f.rest.size();
    if (count == 0 && name != "half-space") return std::nullopt;
    if ((name == "sphere" || name == "ball") && count <= 2)
        return solid_of(put("sphere(" + at(0) + ")", 1));
    if ((name == "box" || name == "box-exact" || name == "box-mitered") && count == 2 &&
        is_vector(*f.rest[0]) && is_vector(*f.rest[1]))
        return solid_of(between_corners("box", lisp(*f.rest[0]), lisp(*f.rest[1])));
    if ((name == "box" || name == "rounded-box") && count == 1) {
        const std::string size = doubled(*f.rest[0]);
        if (round != f.named.end())
            return solid_of("rounded_box(" + size + ", radius: " + lisp_text(*round->second) + ")");
        return solid_of("box(" + size + ")");
    }
    if (name == "cylinder" && count == 2 && !axis.empty()) {
        const std::string r = at(0), h = doubled(*f.rest[1]);
        if (round != f.named.end())
            return solid_of(along("rounded_cylinder(" + r + ", " + h +
                                      ", rounding: " + lisp_text(*round->second) + ")",
                                  axis));
        return solid_of(along("cylinder(" + r + ", " + h + ")", axis));
    }
    if (name == "cone" && count == 2 && axis.size() == 1) // Bauble: up from its foot
        return solid_of("cone(" + at(0) + ", " + at(1) + ").translate(y: " + halved(at(1)) + ")" +
                        (axis == "Y" ? "" : ".orient(Y, " + axis + ")"));
    if ((name == "cylinder" || name == "cylinder-z" || name == "cone-z") && axis.empty() &&
        count >= 2 && count <= 3) { // libfive: from its foot up z
        const std::string h = at(1);
        return solid_of(put(std::string(name == "cone-z" ? "cone(" : "cylinder(") + at(0) + ", " +
                                h + ").orient(Y, Z).translate(z: " + halved(h) + ")",
                            2));
    }
    if (name == "torus" && count == 2 && !axis.empty())
        return solid_of(along("torus(" + at(0) + ", " + at(1) + ")", axis));
    if (name == "torus-z" && count >= 2)
        return solid_of(put("torus(" + at(0) + ", " + at(1) + ").orient(Y, Z)", 2));
    if (name == "half-space" && !axis.empty() && count <= 1) // what lies on the axis' side
        return solid_of("plane(" + negated(axis) +
                        (count == 1 ? ", " + negated(at(0)) : std::string()) + ")");
    if (name == "ellipsoid" && count == 1) return solid_of("ellipsoid(" + at(0) + ")");
    if (name == "octahedron" && count == 1) return solid_of("octahedron(" + at(0) + ")");
    if (name == "line" && count == 3 && is_vector(*f.rest[0]) && is_vector(*f.rest[1])) {
        const std::size_t parts = f.rest[0]->parts.size();
        if (parts != f.rest[1]->parts.size()) throw Unsure{};
        if (parts == 3) return solid_of("capsule(" + at(0) + ", " + at(1) + ", " + at(2) + ")");
        return flat_of("segment(" + at(0) + ", " + at(1) + ", " + doubled(*f.rest[2]) + ")");
    }
    if (name == "rect" && count == 1) {
        const std::string size = doubled(*f.rest[0]);
        return flat_of(round == f.named.end()
                           ? "rectangle(" + size + ")"
                           : "rounded_rectangle(" + size + ", " + lisp_text(*round->second) + ")");
    }
    if (name == "polygon" && count == 1)
        return flat_of(call_text("polygon", {lisp_list(*f.rest[0]).text}));
    if (name == "circle" && count <= 2) return flat_of(put("circle(" + at(0) + ")", 1));
    if (name == "rectangle" && count == 2)
        return Written{between_corners(name, lisp(*f.rest[0]), lisp(*f.rest[1])), as_call,
                       Kind::Flat};
    return std::nullopt;
}

std::string Writer::program(const std::vector<TopForm> &forms) {
    for (const auto &[form, above] : forms) {
        comment(above);
        if (!form.parts.empty()) lisp_statement(form);
    }
    if (!shown_) throw Unsure{};
    return out_;
}

// `(def r 20)`, `(define (f x) …)`, `(let [r 2] …)`, or a shape.
void Writer::lisp_statement(const Node &form) {
    std::string head = lisp_head(form);
    if (head.starts_with("gl/")) head = head.substr(3); // `(gl/def r 20)`
    const std::size_t count = form.parts.size();
    if (head == "set") return lisp_setting(form);
    if (head.starts_with("set-") || head == "use" || head == "use-modules") return;
    if ((head == "def" || head == "define" || head == "defn") && count >= 3) {
        const bool scheme = form.parts[1].is == Is::List;
        if (scheme && form.parts[1].parts.empty()) throw Unsure{}; // `(define () …)`
        const Node *named = scheme ? &form.parts[1].parts[0] : &form.parts[1];
        if (named->is != Is::Name || count != (head == "defn" ? 4u : 3u)) throw Unsure{};
        const bool function = scheme || head == "defn";
        if (!function) {
            const Written w = lisp(form.parts[2]);
            const std::string ours = lisp_declare(*named, w.kind);
            return line("let " + ours + " = " + w.text);
        }
        const std::string ours = lisp_declare(*named, Kind::Function);
        const std::vector<Node> &list = form.parts[scheme ? 1 : 2].parts;
        scopes_.emplace_back();
        std::string parameters_of;
        for (std::size_t i = scheme ? 1 : 0; i < list.size(); ++i)
            parameters_of +=
                (parameters_of.empty() ? "" : ", ") + lisp_declare(list[i], Kind::Unknown);
        const std::string body = lisp_text(form.parts.back());
        scopes_.pop_back();
        return line("fn " + ours + "(" + parameters_of + ") = " + body);
    }
    if (head == "let" && count == 3 && form.parts[1].is == Is::List) {
        const std::vector<Node> &list = form.parts[1].parts;
        const bool pairs = form.parts[1].text == "(";
        for (std::size_t i = 0; i < list.size(); i += pairs ? 1 : 2) {
            if (pairs && list[i].parts.size() != 2) throw Unsure{};
            if (!pairs && i + 1 == list.size()) throw Unsure{};
            lisp_statement(node(Is::List, "(",
                                {node(Is::Name, "def"), pairs ? list[i].parts[0] : list[i],
                                 pairs ? list[i].parts[1] : list[i + 1]}));
        }
        return lisp_statement(form.parts[2]);
    }
    const Written w = lisp(form);
    if (w.kind == Kind::Number || w.kind == Kind::Vector || w.kind == Kind::List) throw Unsure{};
    shown_ = true;
    line(w.text);
}

} // namespace fathom::lang::program
