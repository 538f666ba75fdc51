// Values of programs of other languages, written in ours.
#include "lang/foreign/program/program.h"

#include <algorithm>
#include <array>
#include <charconv>

namespace fathom::lang::program {

namespace {

struct Renamed {
    std::string_view theirs, ours;
};
constexpr std::array<Renamed, 36> functions = {
    {{"sin", "sin"},     {"cos", "cos"},         {"tan", "tan"},         {"asin", "asin"},
     {"acos", "acos"},   {"atan", "atan"},       {"atan2", "atan"},      {"sqrt", "sqrt"},
     {"abs", "abs"},     {"fabs", "abs"},        {"floor", "floor"},     {"ceil", "ceil"},
     {"round", "round"}, {"exp", "exp"},         {"log", "log"},         {"log2", "log2"},
     {"min", "min"},     {"max", "max"},         {"maximum", "max"},     {"minimum", "min"},
     {"sign", "sign"},   {"radians", "radians"}, {"degrees", "degrees"}, {"arcsin", "asin"},
     {"arccos", "acos"}, {"arctan", "atan"},     {"arctan2", "atan"},    {"dot", "dot"},
     {"cross", "cross"}, {"mod", "mod"},         {"clip", "clamp"},      {"len", "len"},
     {"int", "int"},     {"trunc", "trunc"},     {"tanh", "tanh"},       {"norm", "length"}}};
constexpr std::array<Renamed, 12> constants = {{{"X", "X"},
                                                {"Y", "Y"},
                                                {"Z", "Z"},
                                                {"UP", "Z"},
                                                {"ORIGIN", "[0, 0, 0]"},
                                                {"pi", "pi"},
                                                {"PI", "pi"},
                                                {"tau", "tau"},
                                                {"TAU", "tau"},
                                                {"True", "true"},
                                                {"False", "false"},
                                                {"e", "exp(1)"}}};

int binds_of(std::string_view sign) {
    constexpr std::array<std::string_view, 6> compares = {"==", "!=", "<", ">", "<=", ">="};
    if (std::ranges::find(compares, sign) != compares.end()) return 6;
    if (sign == "|") return 1;
    if (sign == "&") return 2;
    if (sign == "or") return 3;
    if (sign == "and") return 4;
    if (sign == "+" || sign == "-") return 8;
    if (sign == "^") return 11;
    return 9;
}

std::string number_text(const std::string &theirs) {
    if (theirs.starts_with("0x")) throw Unsure{};
    if (theirs.starts_with(".")) return "0" + theirs;
    return theirs.ends_with(".") ? theirs + "0" : theirs;
}

} // namespace

std::string Writer::path(const Node &n) const {
    if (n.is == Is::Name) return n.text;
    if (n.is != Is::Member) return {};
    const std::string of = path(n.parts[0]);
    return of.empty() ? of : of + "." + n.text;
}

std::optional<std::string> Writer::constant(const Node &n) const {
    std::string name;
    if (n.is == Is::Name && !find(n.text))
        name = n.text;
    else if (n.is == Is::Member && n.parts[0].is == Is::Name) {
        constexpr std::array<std::string_view, 4> modules = {"math", "np", "numpy", "Math"};
        const bool library = of_ == Of::Sdf && n.parts[0].text == "sdf";
        if (!library && std::ranges::find(modules, n.parts[0].text) == modules.end())
            return std::nullopt;
        name = n.text;
    }
    if (name == "e" && n.is == Is::Name) return std::nullopt;
    if (of_ != Of::Sdf && (name == "UP" || name == "ORIGIN")) return std::nullopt;
    const auto at = std::ranges::find(constants, name, &Renamed::theirs);
    if (at == constants.end()) {
        if (of_ == Of::Sdf || (name != "true" && name != "false")) return std::nullopt;
        return name;
    }
    return std::string(at->ours);
}

std::string Writer::text(const Node &n, int needs) { return wrapped(value(n), needs); }

Written Writer::value(const Node &n) {
    constexpr int most = 20000, deepest = 300;
    struct Level { // how deep the writer is in itself
        explicit Level(int &l) : level(l) { ++level; }
        ~Level() { --level; }
        int &level;
    } const level(level_);
    if (++nodes_ > most || level_ > deepest) throw Unsure{};
    if (const auto ours = constant(n)) {
        const bool axis = *ours == "X" || *ours == "Y" || *ours == "Z" || ours->front() == '[';
        return {*ours, as_call, axis ? Kind::Vector : Kind::Number};
    }
    if (of_ == Of::Curv)
        if (const auto ours = curv_constant(n)) return *ours;
    switch (n.is) {
    case Is::Ours: return {n.text, as_call, Kind::Unknown};
    case Is::Number: return {number_text(n.text), as_call, Kind::Number};
    case Is::Text: return {"\"" + n.text + "\"", as_call, Kind::Unknown};
    case Is::Name: {
        const Written *w = find(n.text);
        if (!w) {
            const std::optional<Thing> t = thing(n);
            const std::optional<std::string> mesh = t ? shown(*t) : std::nullopt;
            if (!mesh) throw Unsure{};
            return {*mesh, as_call, Kind::Solid};
        }
        if (w->text.empty()) { // declared without a value
            if (w->kind == Kind::List) return {"[]", as_call, Kind::List};
            throw Unsure{};
        }
        return *w;
    }
    case Is::List: {
        std::string out = "[";
        Kind kind = n.parts.size() >= 2 && n.parts.size() <= 3 ? Kind::Vector : Kind::List;
        for (std::size_t i = 0; i < n.parts.size(); ++i) {
            const Written w = value(n.parts[i]);
            if (n.parts[i].is == Is::Spread) throw Unsure{};
            if (w.kind != Kind::Number && w.kind != Kind::Unknown) kind = Kind::List;
            out += (i > 0 ? ", " : "") + w.text;
        }
        return {out + "]", as_call, kind};
    }
    case Is::Spread: {
        const Written w = value(n.parts[0]);
        return {call_text("union", {w.text}), as_call, Kind::Solid};
    }
    case Is::Member: {
        if (!sliders_.empty() && is_named(n.parts[0], sliders_)) {
            if (!slider_.contains(n.text)) throw Unsure{};
            return slider_.at(n.text);
        }
        if (n.text.size() == 1 && std::string_view("xyz").find(n.text[0]) < 3)
            return {text(n.parts[0], as_call) + "." + n.text, as_call, Kind::Number};
        if (n.text == "length" && of_ != Of::Sdf)
            return {call_text("len", {text(n.parts[0])}), as_call, Kind::Number};
        throw Unsure{};
    }
    case Is::Index:
        return {text(n.parts[0], as_call) + "[" + text(n.parts[1]) + "]", as_call, Kind::Unknown};
    case Is::Column: {
        const std::string &at = n.parts[1].text;
        if (n.parts[1].is != Is::Number || at.size() != 1 || at[0] > '2') throw Unsure{};
        return {text(n.parts[0], as_call) + "." + "xyz"[at[0] - '0'], as_call, Kind::Number};
    }
    case Is::Unary: {
        const Written w = value(n.parts[0]);
        if (n.text == "not") return {"not " + wrapped(w, 6), 5, Kind::Unknown};
        if (w.kind == Kind::Solid || w.kind == Kind::Flat)
            return {call_text("complement", {w.text}), as_call, w.kind};
        return {"-" + wrapped(w, 11), 10, w.kind};
    }
    case Is::Binary: return binary(n);
    case Is::Choice: {
        const Written yes = value(n.parts[1]);
        return {"if " + text(n.parts[0]) + " { " + yes.text + " } else { " + text(n.parts[2]) +
                    " }",
                0, yes.kind};
    }
    case Is::Lambda: return lambda(n);
    case Is::ForEach: return for_each(n);
    case Is::Call: return of_ == Of::Curv ? curv_call(n) : call(n);
    case Is::Record: throw Unsure{};
    }
    throw Unsure{};
}

Written Writer::binary(const Node &n) {
    if (n.text == ">>") return curv_pipe(n);
    if (n.text == ".." || n.text == "..=")
        return {text(n.parts[0], 8) + n.text + text(n.parts[1], 8), 7, Kind::List};
    const Node &right = n.parts[1];
    const bool shapes = n.text == "|" || n.text == "&" || n.text == "-";
    if (of_ == Of::Sdf && shapes && right.is == Is::Call && right.parts.size() == 2 &&
        right.parts[0].is == Is::Member && right.parts[0].text == "k") {
        const std::string name = n.text == "|"   ? "union"
                                 : n.text == "&" ? "intersection"
                                                 : "difference";
        std::vector<Written> both;
        both.push_back(value(n.parts[0]));
        both.push_back(value(right.parts[0].parts[0]));
        return combined(name, both, text(right.parts[1]));
    }
    const Written a = value(n.parts[0]), b = value(right);
    if (n.text == "div") return {call_text("div", {a.text, b.text}), as_call, Kind::Number};
    if ((n.text == "|" || n.text == "&") && of_ != Of::Sdf) throw Unsure{};
    if (n.text == "+" && (a.kind == Kind::List || b.kind == Kind::List))
        return {call_text("concat", {a.text, b.text}), as_call, Kind::List};
    const int binds = binds_of(n.text);
    const bool chains = binds != 6 && binds != 11;
    Kind kind = a.kind;
    if (kind == Kind::Unknown || b.kind == Kind::Vector) kind = b.kind;
    if (n.text == "|" || n.text == "&") kind = a.kind == Kind::Flat ? Kind::Flat : Kind::Solid;
    return {wrapped(a, chains ? binds : binds + 1) + " " + n.text + " " +
                wrapped(b, binds == 11 ? 10 : binds + 1),
            binds, kind};
}

Written Writer::lambda(const Node &n) {
    scopes_.emplace_back();
    std::string head;
    for (const std::string &name : n.names)
        head += (head.empty() ? "" : ", ") + declare(name, Kind::Unknown);
    if (n.names.size() != 1) head = "(" + head + ")";
    std::string body;
    if (n.parts.empty()) {
        const std::string before = std::move(out_);
        out_.clear();
        inner(n.body, false);
        body = "{\n" + out_ + std::string(static_cast<std::size_t>(depth_) * 2, ' ') + "}";
        out_ = before;
    } else {
        body = text(n.parts[0]);
    }
    scopes_.pop_back();
    return {head + " => " + body, 0, Kind::Function};
}

// What one turn of a loop gives: a value, or the body of a function that gives it.
std::string Writer::turn_of(const Node &f) {
    if (f.is != Is::Lambda) return text(f);
    if (!f.parts.empty()) return text(f.parts[0]);
    const std::string before = std::move(out_);
    out_.clear();
    inner(f.body, false);
    std::string body = "\n" + out_ + std::string(static_cast<std::size_t>(depth_) * 2, ' ');
    out_ = before;
    return body;
}

// `[e for x in l if c]` as `[for x in l { if c { e } }]`.
Written Writer::for_each(const Node &n) {
    const std::string list = range_of(n.parts[1]);
    scopes_.emplace_back();
    const bool counts = n.parts[1].is == Is::Call || n.parts[1].is == Is::Ours;
    const std::string name = declare(n.text, counts ? Kind::Number : Kind::Unknown);
    std::string body = turn_of(n.parts[0]);
    if (n.parts.size() > 2) body = "if " + text(n.parts[2]) + " { " + body + " }";
    scopes_.pop_back();
    if (!body.starts_with('\n')) body = " " + body + " ";
    return {"[for " + name + " in " + list + " {" + body + "}]", as_call, Kind::List};
}

Given Writer::given(const Node &n, std::size_t first) {
    Given g;
    for (std::size_t i = first; i < n.parts.size(); ++i) {
        if (n.names[i - 1].empty())
            g.by_place.push_back(value(n.parts[i]));
        else
            g.by_name[n.names[i - 1]] = value(n.parts[i]);
    }
    return g;
}

// What a call is given, as text.
static std::vector<std::string> texts_of(const Given &g) {
    std::vector<std::string> out;
    for (const Written &w : g.by_place) out.push_back(w.text);
    for (const auto &[name, w] : g.by_name) out.push_back(name + ": " + w.text);
    return out;
}

// `np.linspace(a, b, n)`, with or without its end.
Written Writer::linspace(const Node &n) {
    if (n.parts.size() < 4 || n.parts.size() > 5) throw Unsure{};
    const bool open = n.parts.size() == 5;
    if (open && (n.names[3] != "endpoint" || !is_named(n.parts[4], "False"))) throw Unsure{};
    const std::string count = text(n.parts[3], 9), steps = open ? count : "(" + count + " - 1)",
                      first = text(n.parts[1], 8);
    const std::string span = first == "0"
                                 ? text(n.parts[2], 9)
                                 : "(" + text(n.parts[2], 8) + " - " + text(n.parts[1], 9) + ")";
    return {"[for i in 0.." + count + " { " + (first == "0" ? "" : first + " + ") + span +
                " * i / " + steps + " }]",
            as_call, Kind::List};
}

bool is_mathematical(std::string_view name) {
    constexpr std::array<std::string_view, 8> forms = {"linspace", "pow",     "hypot",    "array",
                                                       "asarray",  "radians", "degToRad", "arange"};
    return std::ranges::find(forms, name) != forms.end() ||
           std::ranges::find(functions, name, &Renamed::theirs) != functions.end();
}

Written Writer::mathematics(const std::string &theirs, const Node &n) {
    if (theirs == "linspace") return linspace(n);
    std::vector<std::string> arguments;
    for (std::size_t i = 1; i < n.parts.size(); ++i) {
        if (n.names[i - 1] == "axis" || n.names[i - 1] == "keepdims") continue;
        if (!n.names[i - 1].empty()) throw Unsure{};
        arguments.push_back(text(n.parts[i]));
    }
    if (theirs == "pow" && arguments.size() == 2)
        return {text(n.parts[1], as_call) + " ^ " + text(n.parts[2], 10), 11, Kind::Number};
    if (theirs == "hypot" && arguments.size() == 2)
        return {"length([" + arguments.at(0) + ", " + arguments.at(1) + "])", as_call,
                Kind::Number};
    if ((theirs == "array" || theirs == "asarray") && arguments.size() == 1)
        return value(n.parts[1]);
    if ((theirs == "radians" || theirs == "degToRad") && arguments.size() == 1 &&
        n.parts[1].is == Is::Number)
        return {arguments[0] + "deg", as_call, Kind::Number};
    if (theirs == "degToRad") return {call_text("radians", arguments), as_call, Kind::Number};
    if (theirs == "arange" && arguments.size() == 1)
        return {"0.." + text(n.parts[1], 8), 7, Kind::List};
    if (theirs == "arange") return {call_text("range", arguments), as_call, Kind::List};
    const auto at = std::ranges::find(functions, theirs, &Renamed::theirs);
    if (at == functions.end()) throw Unsure{};
    return {call_text(at->ours, arguments), as_call,
            at->ours == "cross" ? Kind::Vector : Kind::Number};
}

Written Writer::call_of_ours(const Written &callee, const Node &n) {
    std::vector<std::string> arguments;
    const auto arity = arities_.find(n.parts[0].text);
    const bool script = of_ != Of::Sdf && arity != arities_.end();
    const std::size_t end = script ? std::min(n.parts.size(), arity->second + 1) : n.parts.size();
    for (std::size_t i = 1; i < end; ++i) {
        const std::string &key = n.names[i - 1];
        arguments.push_back((key.empty() ? "" : key + ": ") + text(n.parts[i]));
    }
    return {call_text(callee.text, arguments), as_call, Kind::Unknown};
}

Written Writer::call(const Node &n) {
    const Node &callee = n.parts[0];
    if (callee.is == Is::Name) {
        if (const Written *own = find(callee.text)) return call_of_ours(*own, n);
        const auto imported = imported_.find(callee.text);
        const std::string name = imported == imported_.end() ? callee.text : imported->second;
        if (const auto made = shape(name, n)) return *made;
        constexpr std::array<std::string_view, 7> jscad_only = {
            "hull",    "hullChain", "extrudeHelical", "extrudeRectangular",
            "project", "expand",    "vectorText"};
        const bool jscads =
            of_ == Of::Jscad && std::ranges::find(jscad_only, name) != jscad_only.end();
        if (jscads || (of_ == Of::Sdf && !is_mathematical(name)))
            return unread_call(name, texts_of(given(n, 1)));
        return mathematics(name, n);
    }
    if (callee.is != Is::Member) throw Unsure{};
    const std::string from = path(callee);
    const std::string root = from.substr(0, from.find('.'));
    constexpr std::array<std::string_view, 4> modules = {"math", "np", "numpy", "Math"};
    if (std::ranges::find(modules, root) != modules.end() && !find(root))
        return mathematics(callee.text, n);
    if (from == "Array.from" && n.parts.size() == 3 && n.parts[1].is == Is::Record &&
        n.parts[2].is == Is::Lambda && n.parts[2].names.size() == 2 &&
        n.parts[1].names == std::vector<std::string>{"length"}) {
        Node list = node(Is::Ours, "..",
                         {node(Is::Number, "0"), n.parts[1].parts[0], node(Is::Number, "1")});
        Node each = node(Is::ForEach, n.parts[2].names[1], {n.parts[2], std::move(list)});
        return for_each(each);
    }
    if (!from.empty() && !find(root)) { // `jscad.primitives.cube`, `sdf.sphere`
        const bool known =
            of_ == Of::Jscad || root == "sdf" || root == "CSG" || imported_.contains(root);
        if (known)
            if (const auto made = shape(callee.text, n)) return *made;
        throw Unsure{};
    }
    return method(n);
}

Written Writer::method(const Node &n) {
    const Node &callee = n.parts[0];
    const Written of = value(callee.parts[0]);
    if (callee.text == "map" && n.parts.size() == 2 && n.parts[1].is == Is::Lambda &&
        n.parts[1].names.size() <= 2) {
        const Node &f = n.parts[1];
        if (f.names.size() == 1)
            return for_each(node(Is::ForEach, f.names[0], {f, callee.parts[0]}));
        scopes_.emplace_back();
        const std::string i = declare(f.names[1], Kind::Number),
                          one = declare(f.names[0], Kind::Unknown);
        const std::string body = turn_of(f);
        scopes_.pop_back();
        const bool lines = body.starts_with('\n');
        return {"[for " + i + " in 0..len(" + of.text + ") { let " + one + " = " +
                    wrapped(of, as_call) + "[" + i + "]" + (lines ? body : "; " + body + " ") +
                    "}]",
                as_call, Kind::List};
    }
    Given g = given(n, 1);
    std::optional<Written> made;
    if (of_ == Of::Sdf)
        made = sdf_change(callee.text, of, g);
    else
        made = script_change(callee.text, of, g);
    if (!made && of_ == Of::Sdf && of.kind != Kind::Number && of.kind != Kind::Vector)
        return unread_change(of, callee.text, texts_of(g));
    if (!made) throw Unsure{};
    if (g.asked.size() < g.by_place.size() + g.by_name.size()) throw Unsure{};
    return *made;
}

std::optional<Written> Writer::shape(const std::string &name, const Node &n) {
    if (of_ == Of::Jscad) return jscad(name, n);
    const bool joins = name == "union" || name == "difference" || name == "intersection" ||
                       name == "subtract" || name == "intersect";
    if (joins) return joined(name, n, 1, std::nullopt);
    Given g = given(n, 1);
    std::optional<Written> made;
    if (of_ == Of::Sdf) {
        made = sdf_shape(name, g);
        if (!made) made = sdf_flat(name, g);
    } else if (of_ == Of::Script) {
        made = script_shape(name, g);
    }
    if (made && g.asked.size() < g.by_place.size() + g.by_name.size()) throw Unsure{};
    return made;
}

// Shapes from the call's argument `first` on, by `name`; `before` stands at their head.
Written Writer::joined(const std::string &name, const Node &n, std::size_t first,
                       std::optional<Written> before) {
    std::vector<Written> parts;
    if (before) parts.push_back(std::move(*before));
    std::string k;
    for (std::size_t i = first; i < n.parts.size(); ++i) {
        if (n.names[i - 1] == "k") {
            k = text(n.parts[i]);
            if (k == "None") k.clear();
            continue;
        }
        if (!n.names[i - 1].empty()) throw Unsure{};
        Written w = value(n.parts[i]);
        if (n.parts[i].is == Is::List && w.kind == Kind::List) { // `union([a, b])`
            for (const Node &part : n.parts[i].parts) parts.push_back(value(part));
            continue;
        }
        if (w.kind == Kind::List) w = {call_text("union", {w.text}), as_call, Kind::Solid};
        parts.push_back(std::move(w));
    }
    return combined(name, std::move(parts), k);
}

Written Writer::combined(const std::string &name, std::vector<Written> parts,
                         const std::string &k) {
    const bool cuts = name == "difference" || name == "subtract";
    const bool meets = name == "intersection" || name == "intersect";
    if (parts.empty() || (!cuts && !meets && name != "union")) throw Unsure{};
    const Kind kind = parts[0].kind == Kind::Flat ? Kind::Flat : Kind::Solid;
    if (parts.size() == 1) return parts[0];
    if (!k.empty()) {
        std::vector<std::string> arguments{k};
        for (const Written &w : parts) arguments.push_back(w.text);
        return {call_text(cuts    ? "smooth_difference"
                          : meets ? "smooth_intersection"
                                  : "smooth_union",
                          arguments),
                as_call, kind};
    }
    const int binds = cuts ? 8 : meets ? 2 : 1;
    std::string out;
    for (std::size_t i = 0; i < parts.size(); ++i)
        out += (i == 0  ? ""
                : cuts  ? " - "
                : meets ? " & "
                        : " | ") +
               wrapped(parts[i], i == 0 ? binds : binds + 1);
    return {out, binds, kind};
}

} // namespace fathom::lang::program
