// Loops of programs of other languages: those that add to a name become blocks of what they add.
#include "lang/foreign/program/program.h"

namespace fathom::lang::program {

static bool is_name_of(const Node &n, const std::string &name) {
    return n.is == Is::Name && n.text == name;
}

// `f |= e`, `f = f | e`, `f = e if f is None else f | e`, `l.append(e)`: what is added to what.
Writer::Gathering Writer::gathering(const Statement &s) const {
    if (s.does == Does::Value && s.value.is == Is::Call && s.value.parts.size() == 2) {
        const Node &callee = s.value.parts[0];
        if (callee.is == Is::Member && callee.parts[0].is == Is::Name &&
            (callee.text == "push" || callee.text == "append"))
            return {callee.parts[0].text, &s.value.parts[1], false};
        return {};
    }
    if (s.does != Does::Set || s.targets.size() != 1 || s.targets[0].is != Is::Name) return {};
    const std::string &name = s.targets[0].text;
    if (s.sign == "|=" || s.sign == "-=") {
        const Written *was = find(name);
        if (s.sign == "-=" && (!was || was->kind == Kind::Number)) return {};
        return {name, &s.value, s.sign == "-="};
    }
    if (s.sign == "+=" && s.value.is == Is::List && s.value.parts.size() == 1)
        return {name, &s.value.parts[0], false};
    if (s.sign != "=") return {};
    const Node *value = &s.value;
    if (value->is == Is::Choice) { // of the first turn, and of the others
        const Node &test = value->parts[0];
        if (test.is == Is::Binary && is_name_of(test.parts[0], name))
            value = &value->parts[test.text == "!=" ? 1 : 2];
        else if (is_name_of(test, name))
            value = &value->parts[1];
        else
            return {};
    }
    if (value->is == Is::Binary && (value->text == "|" || value->text == "-") &&
        is_name_of(value->parts[0], name)) {
        const Written *was = find(name);
        if (value->text == "-" && (!was || was->kind == Kind::Number)) return {};
        return {name, &value->parts[1], value->text == "-"};
    }
    if (value->is != Is::Call) return {};
    const Node &callee = value->parts[0];
    if (callee.is == Is::Member && is_name_of(callee.parts[0], name) && value->parts.size() == 2 &&
        value->names[0].empty()) {
        const bool cut = callee.text == "subtract" || callee.text == "difference";
        if (cut || callee.text == "union") return {name, &value->parts[1], cut};
    }
    const bool cut = is_named(callee, "subtract") || is_named(callee, "difference");
    if ((is_named(callee, "union") || cut) && value->parts.size() == 3 &&
        is_name_of(value->parts[1], name) && value->names[1].empty())
        return {name, &value->parts[2], cut};
    return {};
}

// The one thing that the turns of a loop add to, which is no name of the loop's own.
Writer::Gathering Writer::gathering_in(const std::vector<Statement> &body) const {
    Gathering found;
    for (const Statement &s : body) {
        const std::vector<Statement> none;
        for (const auto *inside : {&s.body, &s.otherwise}) {
            if (s.does != Does::For && s.does != Does::If) continue;
            const Gathering one = gathering_in(*inside);
            if (one.into.empty()) continue;
            if (!found.into.empty() && (found.into != one.into || found.cut != one.cut))
                throw Unsure{};
            found = one;
        }
        const Gathering one = gathering(s);
        if (one.into.empty() || !find(one.into)) continue;
        if (!found.into.empty() && (found.into != one.into || found.cut != one.cut)) throw Unsure{};
        found = one;
    }
    return found;
}

void Writer::gather(const Statement &loop_of, const std::string &into, bool cut) {
    const Written before = *find(into);
    const bool list = before.kind == Kind::List;
    if (list && (!before.text.empty() || cut)) throw Unsure{};
    const std::string ours = fresh(into);
    gathered_ = into;
    if (list) {
        const std::size_t begin = out_.size();
        loop(loop_of, false);
        const std::size_t indent = static_cast<std::size_t>(depth_) * 2;
        out_.insert(begin + indent, "let " + ours + " = [");
        out_.insert(out_.size() - 1, "]");
    } else {
        if (cut && before.text.empty()) throw Unsure{};
        line("let " + ours + " = " + (cut ? before.text + " - union {" : "union {"));
        ++depth_;
        if (!cut && !before.text.empty()) line(before.text);
        loop(loop_of, false);
        --depth_;
        line("}");
    }
    gathered_.clear();
    declare(into, list ? Kind::List : Kind::Solid);
}

std::string Writer::range_of(const Node &list) {
    if (list.is == Is::Ours && (list.text == ".." || list.text == "..=")) {
        if (!is_named(list.parts[2], "1") && list.parts[2].text != "1") {
            if (list.text == "..=") throw Unsure{};
            return call_text("range",
                             {text(list.parts[0]), text(list.parts[1]), text(list.parts[2])});
        }
        return text(list.parts[0], 8) + list.text + text(list.parts[1], 8);
    }
    if (list.is == Is::Call && is_named(list.parts[0], "range") && of_ == Of::Sdf) {
        const std::size_t n = list.parts.size() - 1;
        if (n == 1) return "0.." + text(list.parts[1], 8);
        if (n == 2) return text(list.parts[1], 8) + ".." + text(list.parts[2], 8);
        if (n != 3) throw Unsure{};
        return call_text("range", {text(list.parts[1]), text(list.parts[2]), text(list.parts[3])});
    }
    return text(list);
}

void Writer::loop(const Statement &s, bool top) {
    if (gathered_.empty()) {
        const Gathering g = gathering_in(s.body);
        if (!g.into.empty()) return gather(s, g.into, g.cut);
    }
    const std::string list = range_of(s.value);
    scopes_.emplace_back();
    const bool counts = s.value.is == Is::Ours || s.value.is == Is::Call;
    const std::string name = declare(s.name, counts ? Kind::Number : Kind::Unknown);
    line("for " + name + " in " + list + " {");
    inner(s.body, top);
    line("}");
    scopes_.pop_back();
}

} // namespace fathom::lang::program
