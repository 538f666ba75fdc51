// Lists of Bauble (Janet) and libfive (Scheme), and what joins the shapes of one:
// `(apply union (map f (range 5)))`, `(union ;(seq [i :in (range 5)] (sphere i)))`.
#include "lang/foreign/program/program.h"

#include <algorithm>

namespace fathom::lang::program {

// A name of theirs, which may hold hyphens, as one of ours.
std::string Writer::lisp_declare(const Node &theirs, Kind kind) {
    if (theirs.is != Is::Name) throw Unsure{};
    std::string name = theirs.text == "$" ? "each" : theirs.text; // of `|(f $)`
    std::ranges::replace(name, '-', '_');
    const std::string ours = declare(name, kind);
    scopes_.back().names[theirs.text] = scopes_.back().names[name];
    return ours;
}

// `(range 5)`, `(range 1 5)`, `(range 0 1 0.1)`, Scheme's `(iota 5)`; empty where it is none.
std::string Writer::lisp_range(const Node &n) {
    const std::string head = lisp_head(n);
    const std::size_t count = n.parts.size();
    if (head != "range" && head != "iota") return {};
    if (count == 2) return "0.." + lisp_text(n.parts[1], 8);
    if (head == "iota" || count < 3 || count > 4) throw Unsure{};
    if (count == 3) return lisp_text(n.parts[1], 8) + ".." + lisp_text(n.parts[2], 8);
    return call_text("range",
                     {lisp_text(n.parts[1]), lisp_text(n.parts[2]), lisp_text(n.parts[3])});
}

// `[for name in list { body }]`, where the name is called as `body` is written.
Written Writer::lisp_for(const Node &name, const Node &list, const Node &body) {
    const std::string range = lisp_range(list);
    const std::string over = range.empty() ? lisp_list(list).text : range;
    scopes_.emplace_back();
    const std::string ours = lisp_declare(name, range.empty() ? Kind::Unknown : Kind::Number);
    const Written each = lisp(body);
    scopes_.pop_back();
    const bool loop = lisp_head(body) == "seq"; // one in the other
    const std::string inside = loop ? each.text.substr(1, each.text.size() - 2) : each.text;
    return {"[for " + ours + " in " + over + " { " + inside + " }]", as_call, Kind::List};
}

// What is a list there.
Written Writer::lisp_list(const Node &n) {
    const std::string head = lisp_head(n);
    if (const std::string range = lisp_range(n); !range.empty())
        return {"[for i in " + range + " { i }]", as_call, Kind::List};
    if ((head == "map" || head == "seq") && n.parts.size() != 3) throw Unsure{};
    if (head == "map") {
        const Node &f = n.parts[1];
        if (f.is == Is::Name) { // by a function's name
            if (f.text == "i") throw Unsure{};
            const Node each = node(Is::Name, "i");
            return lisp_for(each, n.parts[2], node(Is::List, "(", {f, each}));
        }
        const std::string made = lisp_head(f);
        if ((made != "fn" && made != "lambda") || f.parts.size() != 3 ||
            f.parts[1].parts.size() != 1)
            throw Unsure{};
        return lisp_for(f.parts[1].parts[0], n.parts[2], f.parts[2]);
    }
    if (head == "seq") { // `[i :in list]`, `[i :range [0 5]]`
        const Node &by = n.parts[1];
        if (by.is != Is::List || by.parts.size() < 3 || by.parts.size() % 3 != 0 ||
            by.parts[1].is != Is::Name)
            throw Unsure{};
        Node over = by.parts[2], body = n.parts[2];
        if (by.parts[1].text == ":range" && over.is == Is::List && over.text == "[") {
            over.text = "(";
            over.parts.insert(over.parts.begin(), node(Is::Name, "range"));
        } else if (by.parts[1].text != ":in")
            throw Unsure{};
        if (by.parts.size() > 3) { // `[x :in a, y :in b]`
            const Node rest = node(Is::List, "[", {by.parts.begin() + 3, by.parts.end()});
            body = node(Is::List, "(", {n.parts[0], rest, body});
        }
        return lisp_for(by.parts[0], over, body);
    }
    Written w = lisp(n);
    if (w.kind != Kind::List && w.kind != Kind::Vector && w.kind != Kind::Unknown) throw Unsure{};
    w.kind = Kind::List;
    return w;
}

// `(apply union (map f list))` as `(union ;(map f list))`.
Written Writer::lisp_apply(const Node &n) {
    if (n.parts.size() < 3 || n.parts[1].is != Is::Name) throw Unsure{};
    Node call = node(Is::List, "(", {n.parts.begin() + 1, n.parts.end() - 1});
    call.parts.push_back(node(Is::Spread, "", {n.parts.back()}));
    if (auto made = lisp_joined(call.parts[0].text, call)) return *made;
    throw Unsure{};
}

// What `;list` adds to a call's parts.
void Writer::lisp_spread(const Node &list, std::vector<Written> &into) {
    if (list.is == Is::List && list.text == "[")
        for (const Node &part : list.parts) into.push_back(lisp(part));
    else
        into.push_back(lisp_list(list));
}

// Makes a shape of each list among the parts; all of it, where one list alone flows together by `k`.
std::optional<Written> Writer::lisp_of_lists(const std::string &op, std::vector<Written> &parts,
                                             const std::string &k) {
    if (std::ranges::none_of(parts, [](const Written &w) { return w.kind == Kind::List; }))
        return std::nullopt;
    const bool meets = op == "intersect" || op == "intersection";
    if ((op != "union" && !meets && parts[0].kind == Kind::List) || op == "blend") throw Unsure{};
    if (!k.empty()) {
        if (parts.size() > 1) throw Unsure{};
        return Written{
            call_text(meets ? "smooth_intersection" : "smooth_union", {k, parts[0].text}), as_call,
            Kind::Solid};
    }
    for (Written &w : parts)
        if (w.kind == Kind::List)
            w = solid_of(call_text(meets ? "intersection" : "union", {w.text}));
    return std::nullopt;
}

} // namespace fathom::lang::program
