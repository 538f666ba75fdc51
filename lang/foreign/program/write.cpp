// Statements of programs of other languages, written in ours: names that change get new names, and
// loops that add to a name become blocks of what they add.
#include "lang/foreign/program/program.h"
#include "lang/vocabulary.h"

#include <algorithm>
#include <array>

namespace fathom::lang::program {

namespace {

constexpr std::array<std::string_view, 66> kept_names = {"let",
                                                         "var",
                                                         "fn",
                                                         "param",
                                                         "import",
                                                         "as",
                                                         "for",
                                                         "in",
                                                         "if",
                                                         "else",
                                                         "while",
                                                         "limit",
                                                         "break",
                                                         "return",
                                                         "and",
                                                         "or",
                                                         "not",
                                                         "true",
                                                         "false",
                                                         "sphere",
                                                         "box",
                                                         "torus",
                                                         "cylinder",
                                                         "capsule",
                                                         "cone",
                                                         "capped_cone",
                                                         "plane",
                                                         "rounded_box",
                                                         "ellipsoid",
                                                         "pyramid",
                                                         "circle",
                                                         "rectangle",
                                                         "polygon",
                                                         "star",
                                                         "union",
                                                         "difference",
                                                         "intersection",
                                                         "smooth_union",
                                                         "smooth_difference",
                                                         "smooth_intersection",
                                                         "blend",
                                                         "X",
                                                         "Y",
                                                         "Z",
                                                         "pi",
                                                         "tau",
                                                         "turn",
                                                         "sin",
                                                         "cos",
                                                         "sqrt",
                                                         "abs",
                                                         "min",
                                                         "max",
                                                         "length",
                                                         "dot",
                                                         "box_frame",
                                                         "regular_polygon",
                                                         "implicit",
                                                         "empty",
                                                         "time",
                                                         "color",
                                                         "map",
                                                         "range",
                                                         "len",
                                                         "concat",
                                                         "rotate"};

} // namespace

void Writer::line(const std::string &text) {
    constexpr std::size_t most = 60000;
    out_.append(static_cast<std::size_t>(depth_) * 2, ' ');
    out_ += text;
    out_ += '\n';
    if (out_.size() > most) throw Unsure{};
}

const Written *Writer::find(const std::string &name) const {
    for (auto scope = scopes_.rbegin(); scope != scopes_.rend(); ++scope)
        if (const auto at = scope->names.find(name); at != scope->names.end()) return &at->second;
    return nullptr;
}

// A name of ours for one of theirs: itself, or with a number where that is taken.
std::string Writer::fresh(const std::string &name) const {
    const auto taken = [&](const std::string &one) {
        return std::ranges::find(kept_names, one) != kept_names.end() ||
               std::ranges::any_of(scopes_, [&](const Scope &s) { return s.taken.contains(one); });
    };
    if (name.find('$') != std::string::npos) throw Unsure{};
    if (!taken(name)) return name;
    for (int i = 2;; ++i)
        if (const std::string one = name + std::to_string(i); !taken(one)) return one;
}

std::string Writer::declare(const std::string &name, Kind kind) {
    const std::string ours = fresh(name);
    scopes_.back().names[name] = {ours, as_call, kind};
    scopes_.back().taken.insert(ours);
    scopes_.back().things.erase(name);
    if (scopes_.size() == 1 && (kind == Kind::Solid || kind == Kind::List)) last_ = name;
    return ours;
}

void Writer::inner(const std::vector<Statement> &body, bool top) {
    ++depth_;
    block(body, top);
    --depth_;
}

void Writer::block(const std::vector<Statement> &body, bool top) {
    for (std::size_t i = 0; i < body.size(); ++i) statement(body[i], top, i + 1 == body.size());
    for (const Node &n : scopes_.back().added) {
        const std::optional<Thing> t = thing(n);
        if (!t) throw Unsure{};
        const std::optional<std::string> shape_of = shown(*t);
        if (!shape_of) continue;
        shown_ = true;
        line(*shape_of);
    }
    scopes_.back().added.clear();
}

// -- statements ----------------------------------------------------------------------------------

void Writer::comment(const std::string &lines) {
    for (std::size_t at = 0; at < lines.size();) {
        const std::size_t end = std::min(lines.find('\n', at), lines.size());
        line(lines.substr(at, end - at));
        at = end + 1;
    }
}

void Writer::statement(const Statement &s, bool top, bool last) {
    comment(s.comment);
    if (!gathered_.empty()) {
        if (const Gathering g = gathering(s); g.into == gathered_) return line(text(*g.added));
    }
    switch (s.does) {
    case Does::Nothing: return;
    case Does::Set: return set(s);
    case Does::Function: return function(s);
    case Does::For: return loop(s, top);
    case Does::If: return choice(s, top);
    case Does::Value: return show(s.value, top, last);
    case Does::Return: {
        if (scopes_.size() == 1) shown_ = true;
        const Written w = value(s.value);
        const bool list = top && w.kind == Kind::List;
        return line((last ? "" : "return ") + (list ? call_text("union", {w.text}) : w.text));
    }
    }
}

void Writer::choice(const Statement &s, bool top) {
    const std::string path_of_test =
        s.value.is == Is::Binary && s.value.parts[0].is == Is::Name ? s.value.parts[0].text : "";
    if (path_of_test == "__name__") return block(s.body, top);
    const auto only_set = [](const std::vector<Statement> &body) {
        return body.size() == 1 && body[0].does == Does::Set && body[0].targets.size() == 1 &&
               body[0].targets[0].is == Is::Name;
    };
    if (gathered_.empty() && only_set(s.body) &&
        (s.otherwise.empty() || only_set(s.otherwise))) { // a name that may change
        const std::string &name = s.body[0].targets[0].text;
        const auto of = [&](const Statement &one) {
            if (one.targets[0].text != name) throw Unsure{};
            if (one.sign == "=") return value(one.value);
            return value(node(Is::Binary, one.sign.substr(0, 1), {one.targets[0], one.value}));
        };
        const Written *was = find(name);
        if (s.otherwise.empty() && (!was || was->text.empty())) throw Unsure{};
        const Written yes = of(s.body[0]), no = s.otherwise.empty() ? *was : of(s.otherwise[0]);
        const std::string test = text(s.value);
        return line("let " + declare(name, yes.kind) + " = if " + test + " { " + yes.text +
                    " } else { " + no.text + " }");
    }
    line("if " + text(s.value) + " {");
    scopes_.emplace_back();
    inner(s.body, top);
    scopes_.pop_back();
    if (!s.otherwise.empty()) {
        line("} else {");
        scopes_.emplace_back();
        inner(s.otherwise, top);
        scopes_.pop_back();
    }
    line("}");
}

void Writer::set(const Statement &s) {
    if (s.sign == "param") return curv_param(s);
    if (three(s)) return;
    if (s.targets.size() > 1 || s.targets[0].is == Is::List) return set_parts(s);
    const Node &target = s.targets[0];
    if (target.is == Is::Record) return imports(s);
    if (target.is != Is::Name) throw Unsure{};
    if (s.sign == "=" && s.value.is == Is::Call && is_named(s.value.parts[0], "require"))
        return imports(s);
    if (s.sign == "=" && s.value.is == Is::Lambda) {
        Statement fn;
        fn.name = target.text;
        fn.names = s.value.names;
        fn.defaults.resize(fn.names.size());
        fn.body = s.value.body;
        if (!s.value.parts.empty()) {
            Statement result;
            result.does = Does::Return;
            result.value = s.value.parts[0];
            fn.body.push_back(std::move(result));
        }
        return function(fn);
    }
    if (s.sign != "=")
        return set_name(target.text, node(Is::Binary, s.sign.substr(0, 1), {target, s.value}));
    set_name(target.text, s.value);
}

void Writer::set_name(const std::string &name, const Node &n) {
    const bool none = is_named(n, "None") || is_named(n, "null");
    if (none || (n.is == Is::List && n.parts.empty())) { // what a loop adds to
        scopes_.back().names[name] = {"", as_call, none ? Kind::Solid : Kind::List};
        return;
    }
    if (const std::string from = path(n); !from.empty() && !find(from) && !constant(n)) {
        if (of_ != Of::Jscad || n.is == Is::Name) throw Unsure{};
        imported_[name] = n.text; // `const cube = jscad.primitives.cube`
        return;
    }
    const Written w = value(n);
    line("let " + declare(name, w.kind) + " = " + w.text);
}

// `x, y = 1, 2`, `x, y, z = p.T`.
void Writer::set_parts(const Statement &s) {
    std::vector<Node> targets = s.targets;
    if (targets.size() == 1) targets = targets[0].parts;
    if (s.sign != "=") throw Unsure{};
    const bool each = s.value.is == Is::List && s.value.parts.size() == targets.size();
    std::string of;
    if (!each) {
        const Node &v = s.value;
        if (v.is == Is::Member && v.text == "T")
            of = text(v.parts[0], as_call);
        else if (v.is == Is::ForEach && v.parts[0].is == Is::Column && targets.size() <= 4)
            of = text(v.parts[0].parts[0], as_call);
        else if (v.is == Is::Name)
            of = text(v);
        else
            throw Unsure{};
    }
    std::vector<Written> values;
    for (std::size_t i = 0; i < targets.size(); ++i) {
        if (targets[i].is != Is::Name) throw Unsure{};
        if (each)
            values.push_back(value(s.value.parts[i]));
        else
            values.push_back({of + "[" + std::to_string(i) + "]", as_call, Kind::Unknown});
    }
    for (std::size_t i = 0; i < targets.size(); ++i)
        line("let " + declare(targets[i].text, values[i].kind) + " = " + values[i].text);
}

// `const { cube, sphere } = require("@jscad/modeling").primitives`: nothing is wanted here.
void Writer::imports(const Statement &s) {
    if (s.targets[0].is == Is::Name) return;
    for (std::size_t i = 0; i < s.targets[0].names.size(); ++i) {
        const Node &to = s.targets[0].parts[i];
        if (to.is != Is::Name) throw Unsure{};
        if (to.text != s.targets[0].names[i]) imported_[to.text] = s.targets[0].names[i];
    }
    if (!sliders_.empty() && is_named(s.value, sliders_)) { // `const { radius } = params`
        for (std::size_t i = 0; i < s.targets[0].names.size(); ++i) {
            const auto of = slider_.find(s.targets[0].names[i]);
            if (of == slider_.end()) throw Unsure{};
            scopes_.back().names[s.targets[0].parts[i].text] = of->second;
        }
        return;
    }
    const Node *from = &s.value;
    while (from->is == Is::Member) from = &from->parts[0];
    const bool library = is_named(*from, "jscad") || is_named(*from, "THREE") ||
                         (from->is == Is::Call && is_named(from->parts[0], "require")) ||
                         (from->is == Is::Name && !find(from->text));
    if (!library) throw Unsure{};
}

std::string Writer::parameters(const Statement &s) {
    std::string list;
    for (std::size_t i = 0; i < s.names.size(); ++i) {
        const Node &otherwise = s.defaults[i];
        const bool has = otherwise.is != Is::Ours || !otherwise.text.empty();
        const Written w = has ? value(otherwise) : Written{};
        // A parameter may be named in calls: it keeps its name, but for words of ours.
        const std::string ours = std::ranges::find(kept_names, s.names[i]) != kept_names.end()
                                     ? s.names[i] + "_"
                                     : s.names[i];
        scopes_.back().names[s.names[i]] = {ours, as_call, w.kind};
        scopes_.back().taken.insert(ours);
        list += (i > 0 ? ", " : "") + ours + (has ? " = " + w.text : "");
    }
    return list;
}

// `def f(): def g(p): …; return g` below a decorator: a shape of a field.
bool Writer::function_of_points(const Statement &s) {
    if (s.decorated == 0) return false;
    if (s.body.size() != 2 || s.body[0].does != Does::Function || s.body[1].does != Does::Return ||
        !is_named(s.body[1].value, s.body[0].name) || s.body[0].names.size() != 1)
        throw Unsure{};
    const std::string ours = declare(s.name, Kind::Function);
    scopes_.emplace_back();
    const std::string makes =
        s.decorated == 2 ? ") -> shape2 = implicit2(" : ") -> shape = implicit(";
    const std::string head = "fn " + ours + "(" + parameters(s) + makes;
    scopes_.emplace_back();
    line(head + parameters(s.body[0]) + " => {");
    const bool was = shown_;
    inner(s.body[0].body, false);
    shown_ = was;
    line("}, within: everywhere)");
    scopes_.pop_back();
    scopes_.pop_back();
    return true;
}

void Writer::function(const Statement &s) {
    if (of_ == Of::Jscad && s.name == "main") { // the scene
        if (s.names.size() > 1 || scopes_.size() != 1) throw Unsure{};
        if (!s.names.empty()) sliders_ = s.names[0];
        return block(s.body, true);
    }
    if (of_ == Of::Jscad && s.name == defines_params) return; // written first
    if (!gathered_.empty()) throw Unsure{};
    const bool returns =
        std::ranges::any_of(s.body, [](const Statement &one) { return one.does == Does::Return; });
    if (of_ == Of::Three && !returns) { // `animate`
        lost_.insert("what moves from frame to frame");
        return;
    }
    if (function_of_points(s)) return;
    arities_[s.name] = s.names.size();
    const std::string ours = declare(s.name, Kind::Function);
    scopes_.emplace_back();
    const std::string given_names = parameters(s);
    const bool was = shown_;
    std::string body = std::move(out_);
    out_.clear();
    const bool short_one = s.body.size() == 1 && s.body[0].does == Does::Return;
    if (short_one) {
        out_ = text(s.body[0].value);
    } else {
        if (s.body.empty()) throw Unsure{};
        inner(s.body, false);
    }
    std::swap(body, out_);
    // Scripts may leave away what the body does not read.
    const bool read = of_ == Of::Sdf || of_ == Of::Curv || s.names.size() != 1 ||
                      body.find(given_names) != std::string::npos;
    if (!read) arities_[s.name] = 0;
    const std::string head = "fn " + ours + "(" + (read ? given_names : "") + ")";
    if (short_one) {
        line(head + " = " + body);
    } else {
        line(head + " {");
        out_ += body;
        line("}");
    }
    shown_ = was;
    scopes_.pop_back();
}

// What stands alone: a shape that is saved, drawn or returned; else it says nothing here.
void Writer::show(const Node &n, bool top, bool last) {
    if (n.is == Is::Call && n.parts[0].is == Is::Member && of_ == Of::Sdf) {
        const Node &callee = n.parts[0];
        if (callee.text == "save" || callee.text == "show_slice") {
            if (callee.text == "show_slice") return;
            shown_ = true;
            return line(text(callee.parts[0]));
        }
    }
    const std::string named = n.is == Is::Call ? path(n.parts[0]) : "";
    if (n.is == Is::Call && n.parts.size() == 2 && n.parts[0].is == Is::Member &&
        n.parts[0].text == "forEach" && n.parts[1].is == Is::Lambda &&
        n.parts[1].names.size() == 1 && !n.parts[1].body.empty()) {
        Statement s;
        s.name = n.parts[1].names[0];
        s.value = n.parts[0].parts[0];
        s.body = n.parts[1].body;
        return loop(s, top);
    }
    if (named == "print" || named == "console.log") return;
    if (of_ == Of::Three) {
        Statement s;
        s.does = Does::Value;
        s.value = n;
        if (n.is == Is::Call && three(s)) return;
        const bool adds =
            n.is == Is::Call && n.parts[0].is == Is::Member && n.parts[0].text == "add";
        if (!adds) return; // cameras, controls, renderers
        const std::optional<Thing> to = thing(n.parts[0].parts[0]);
        const bool scene = !to && path(n.parts[0].parts[0]) == "scene" && !find("scene");
        if (!scene && (!to || !to->is_group)) throw Unsure{};
        for (std::size_t i = 1; i < n.parts.size(); ++i)
            if (thing(n.parts[i]))
                scopes_.back().added.push_back(n.parts[i]);
            else if (find(path(n.parts[i])))
                throw Unsure{};
        return;
    }
    const Written w = value(n);
    if (w.kind == Kind::Number && top) return;
    if (of_ == Of::Sdf && top && scopes_.size() == 1 && n.is != Is::Call) return;
    if (!top && !last) throw Unsure{};
    if (w.kind == Kind::List && top)
        line(call_text("union", {w.text}));
    else
        line(w.text);
    shown_ = true;
}

std::string Writer::program(const std::vector<Statement> &statements) {
    for (const Statement &s : statements)
        if (of_ == Of::Jscad) jscad_params(s);
    block(statements, true);
    if (!shown_) {
        const Written *w = last_.empty() ? nullptr : find(last_);
        if (!w || w->text.empty()) throw Unsure{};
        line(w->kind == Kind::List ? call_text("union", {w->text}) : w->text);
    }
    std::string helpers;
    for (const std::string &one : helpers_) helpers += one;
    return helpers + out_;
}

} // namespace fathom::lang::program
