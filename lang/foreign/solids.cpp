// OpenSCAD's solids and flat shapes, which are placed and turned otherwise than ours: each as it is
// written here, for the same solid.
#include "base/text.h"
#include "lang/foreign/foreign.h"

#include <algorithm>
#include <array>
#include <map>

namespace fathom::lang {

namespace {

// What each takes by place, and what also by its name.
struct Taken {
    std::string_view shape, places, names;
};
constexpr Taken taken[] = {{"cube", "size center", " size center "},
                           {"square", "size center", " size center "},
                           {"cylinder", "h r1 r2 center", " h r r1 r2 d d1 d2 center "},
                           {"sphere", "r", " r d "},
                           {"circle", "r", " r d "}};
constexpr std::array<std::string_view, 5> flat_shapes = {"square", "circle", "polygon", "text",
                                                         "projection"};
constexpr int most_faces = 8; // that are meant as such; more of them stand for a round side

// The word of a row at a place; empty: it has fewer.
std::string_view word_at(std::string_view row, std::size_t place) {
    for (; place > 0 && !row.empty(); --place) {
        const std::size_t space = row.find(' ');
        row.remove_prefix(space == row.npos ? row.size() : space + 1);
    }
    return row.substr(0, row.find(' '));
}

} // namespace

bool is_flat_shape(std::string_view name) { return is_one_of(name, flat_shapes); }

std::string half_of(std::string_view value) {
    const std::string_view unit = value.ends_with("deg") ? "deg" : "";
    if (const auto number = parse_number(value.substr(0, value.size() - unit.size())))
        return format_shortest(*number / 2) + std::string(unit);
    if (value.starts_with('[') && value.find_first_not_of("[]0123456789., ") == value.npos) {
        std::string halves = "[";
        for (std::size_t at = 1; at < value.size();) { // of each number
            const std::size_t from = value.find_first_not_of(' ', at),
                              end = std::min(value.find_first_of(",]", at), value.size() - 1);
            const auto number = parse_number(value.substr(from, end - from));
            if (!number) return std::string(value) + " / 2";
            halves += (halves.size() > 1 ? ", " : "") + format_shortest(*number / 2);
            at = end + 1;
        }
        return halves + "]";
    }
    const bool list = value.starts_with('[') && value.find(']') == value.size() - 1;
    const bool plain = value.find_first_of(" +-*/%?<>=&|") == std::string_view::npos;
    return list || plain ? std::string(value) + " / 2" : "(" + std::string(value) + ") / 2";
}

// The number of a `$fn` from `from` on, in the arguments of a call or in a statement of its own;
// 0: none.
static int faces_of(std::string_view number) {
    const auto value = parse_number(number);
    const bool few = value && *value >= 3 && *value <= most_faces;
    return few ? static_cast<int>(*value) : 0;
}

// The number that the file's last statement `$fn = …` gives all of its solids; 0: none.
int ForeignSyntax::faces_of_file() const {
    if (faces_of_file_) return *faces_of_file_;
    faces_of_file_ = 0;
    for (Index i = 0; i + 2 < tokens_.tokens.size(); ++i)
        if (kind(i) == Tok::Bad && text(i) == "$fn" && kind(i + 1) == Tok::Assign &&
            enclosing(i) == 0)
            faces_of_file_ = faces_of(text(i + 2));
    return *faces_of_file_;
}

// What stands for one of OpenSCAD's shapes; an empty text: nothing, or nothing certain. `certain`
// where only OpenSCAD writes what stands around it.
ForeignSyntax::Solid ForeignSyntax::solid_of(Index name, bool certain) const {
    const std::string_view theirs = text(name);
    const auto *row = std::ranges::find(taken, theirs, &Taken::shape);
    const Index open = name + 1, close = match(open);
    if (kind(open) != Tok::Open || close <= open) return {};
    Solid solid;
    if (theirs == "children") {
        solid.told = "the shapes that a function is given are a parameter: `fn f(parts: [shape])`";
        solid.text =
            close == open + 1 ? "union(parts)" : "parts[" + value_text(open + 1, close) + "]";
        return solid;
    }
    if (row == std::end(taken)) return {};
    std::map<std::string_view, std::string> given;
    int faces = 0, special = 0, named = 0;
    std::size_t place = 0;
    for (Index from = open + 1, to = from; from < close; from = to + 1) {
        for (to = from; to < close && kind(to) != Tok::Comma;)
            to = match(to) > to ? match(to) + 1 : to + 1;
        if (to == from) continue;
        const bool has_name = kind(from + 1) == Tok::Assign && from + 2 < to;
        if (kind(from) == Tok::Bad) { // `$fn = 64`
            if (!has_name) return {};
            special += 1;
            if (text(from) == "$fn") faces = faces_of(text(from + 2));
            continue;
        }
        named += has_name ? 1 : 0;
        const std::string_view argument = has_name ? text(from) : word_at(row->places, place++);
        const bool known = !argument.empty() &&
                           row->names.find(" " + std::string(argument) + " ") != std::string::npos;
        if (!known || (has_name && kind(from) != Tok::Name)) return {};
        for (Index i = from + 2 * Index{has_name}; i < to; ++i)
            if (is_one_of(kind(i), {Tok::Bad, Tok::Trailing, Tok::Body})) return {};
        given[argument] = value_text(has_name ? from + 2 : from, to);
    }
    if (special == 0) faces = faces_of_file();
    const auto value = [&](std::string_view argument) -> std::string {
        const auto it = given.find(argument);
        return it == given.end() ? std::string() : it->second;
    };
    const std::string center = value("center");
    const bool by_place = !given.empty() && named == 0;
    const bool box = theirs == "cube" || theirs == "square";
    if (!certain && by_place && box && place == 2 && center != "true" && center != "false")
        return {};
    if (!certain && special == 0 && theirs != "cube" && theirs != "square" && place < 3 &&
        (named == 0 || theirs != "cylinder"))
        return {};
    // `1` and `r2`, or half of `d2`
    const auto radius = [&](std::string_view end, const std::string &otherwise) {
        const std::string r = value("r" + std::string(end)), d = value("d" + std::string(end));
        return !r.empty() ? r : !d.empty() ? half_of(d) : otherwise;
    };
    solid.is_centered = center == "true";
    const auto moved = [&](const std::string &half, const std::string &nothing) {
        if (center == "true") return std::string();
        if (center.empty() || center == "false") return half;
        return "if " + center + " { " + nothing + " } else { " + half + " }";
    };
    const std::string round = radius("", "1");
    if (box) {
        const std::string size = value("size").empty() ? "1" : value("size");
        const bool flat = theirs == "square";
        std::string half = half_of(size);
        const bool number = parse_number(size).has_value();
        if (number)
            half = flat ? "[" + half + ", " + half + "]"
                        : "[" + half + ", " + half + ", " + half + "]";
        solid.text = (flat ? "rectangle(" : "box(") + size + ")";
        if (const auto by = moved(half, flat ? "[0, 0]" : "[0, 0, 0]"); !by.empty())
            solid.text += ".translate(" + by + ")";
        solid.told =
            flat ? "OpenSCAD's `square` has a corner at the origin, a `rectangle` its middle"
                 : "OpenSCAD's `cube` has a corner at the origin, a `box` its middle";
        if (solid.is_centered)
            solid.told =
                flat ? "OpenSCAD's `square` is a `rectangle`" : "OpenSCAD's `cube` is a `box`";
    } else if (theirs == "sphere") {
        solid.text = "sphere(" + round + ")";
        solid.told = "OpenSCAD's `sphere` has facets, ours is round";
    } else if (theirs == "circle") {
        solid.text = faces > 0 ? "regular_polygon(" + std::to_string(faces) + ", " + round + ")"
                               : "circle(" + round + ")";
        solid.told = faces > 0 ? "a `circle` is round: one of few sides is a `regular_polygon`"
                               : "OpenSCAD's `circle` has corners, ours is round";
    } else {
        const std::string height = value("h").empty() ? "1" : value("h");
        const std::string bottom = radius("1", round), top = radius("2", round);
        const bool cone = bottom != top;
        solid.text = !cone && faces > 0
                         ? "prism(" + std::to_string(faces) + ", " + bottom + ", " + height + ")"
                     : !cone      ? "cylinder(" + bottom + ", " + height + ")"
                     : top == "0" ? "cone(" + bottom + ", " + height + ")"
                                  : "capped_cone(" + bottom + ", " + top + ", " + height + ")";
        solid.text += ".orient(Y, Z)";
        if (const auto by = moved(half_of(height), "0"); !by.empty())
            solid.text += ".translate(z: " + by + ")";
        solid.told = solid.is_centered
                         ? "OpenSCAD's `cylinder` lies along z, ours along y"
                         : "OpenSCAD's `cylinder` stands on the xy plane, ours lies along y with "
                           "its middle at the origin";
        if (cone && faces > 0) solid.lost = "the few sides of `$fn` are lost: a cone is round";
        if (!cone && faces > 0) solid.lost = "of few sides it is a `prism`";
    }
    return solid;
}

// Whether the file has what OpenSCAD alone writes.
bool ForeignSyntax::is_openscad() const {
    constexpr Index farthest = 5000; // words
    for (Index i = 0; i + 2 < tokens_.tokens.size() && i < farthest; ++i) {
        if (kind(i) == Tok::Bad && text(i).starts_with("$f")) return true;
        if (kind(i) != Tok::Name) continue;
        if (text(i) == "module" && kind(i + 1) == Tok::Name && kind(i + 2) == Tok::Open)
            return true;
        const bool moves = kind(i + 1) == Tok::Open && is_foreign_transform(text(i));
        if (moves && kind(match(i + 1) + 1) == Tok::Name && !token(match(i + 1) + 1).first_on_line)
            return true;
        if (text(i) == "center" && kind(i + 1) == Tok::Assign &&
            is_one_of(kind(i + 2), {Tok::True, Tok::False}))
            return true;
    }
    return false;
}

// `cube([10, 20, 30]);`, a statement of its own.
bool ForeignSyntax::foreign_solid(Index first) {
    if (kind(first) != Tok::Name || kind(first + 1) != Tok::Open) return false;
    const std::string_view theirs = text(first);
    const Index close = match(first + 1);
    if (close <= first || !ends_statement(close + 1) || may_be_declared(theirs)) return false;
    const bool ends = (kind(close + 1) == Tok::End && text(close + 1) == ";") ||
                      kind(close + 1) == Tok::BraceClose || theirs == "children";
    const bool told = ends && theirs == "cylinder" && is_openscad();
    const Solid solid = solid_of(first, told);
    if (solid.text.empty()) return false;
    bool assigns = false; // or has a `true` behind its size
    for (Index i = first; i < close; ++i)
        assigns = assigns || is_one_of(kind(i), {Tok::Assign, Tok::True, Tok::False});
    if (!ends && !assigns) return false;
    forget_arguments(first + 1);
    failed_ = close;
    Diagnostic &d = foreign(span(first), std::string(solid.told));
    if (!solid.lost.empty()) d.note(std::string(solid.lost));
    d.help(to_write(solid.text), {{span(first, close), solid.text}});
    return true;
}

// Where an OpenSCAD module's body begins at a `{`: whether it takes shapes, and whether it has more
// than one, which a function gives as a `union`.
ForeignSyntax::ModuleBody ForeignSyntax::module_body(Index open) const {
    ModuleBody body;
    int shapes = 0;
    bool starts = true;
    for (Index i = open + 1; i < match(open); ++i) {
        body.takes_shapes = body.takes_shapes || text(i) == "children" || text(i) == "$children";
        const Index level = enclosing(i);
        const bool opens = match(i) > i && level == open;
        if (level != open && !opens) continue;
        if (starts && kind(i) == Tok::For) shapes += 2;
        const bool value = (kind(i) == Tok::Name && kind(i + 1) == Tok::Assign) ||
                           is_one_of(text(i), std::array<std::string_view, 4>{"module", "function",
                                                                              "echo", "assert"});
        if (starts && !value && kind(i) != Tok::End) ++shapes;
        starts = kind(i) == Tok::End || (kind(i) == Tok::BraceClose && kind(i + 1) != Tok::Else);
        if (opens && match(i) < match(open)) {
            const Index close = match(i);
            for (Index k = i + 1; k < close; ++k)
                body.takes_shapes =
                    body.takes_shapes || text(k) == "children" || text(k) == "$children";
            i = close;
            starts = kind(close) == Tok::BraceClose && kind(close + 1) != Tok::Else;
        }
    }
    body.has_many = shapes > 1;
    return body;
}

// For `module ring(n) {`, whose body begins at `after`: what the head of a function needs besides.
void ForeignSyntax::module_head(Index first, Index after, std::string &head) const {
    const Index body = kind(after) == Tok::End ? after + 1 : after;
    if (text(first) != "module" || match(body) <= body) return;
    const ModuleBody found = module_body(body);
    if (found.takes_shapes)
        head.insert(head.size() - 1, head.ends_with("()") ? "parts: [shape]" : ", parts: [shape]");
    if (found.has_many) head += " = union";
}

// Of a ball or a post by its first argument, `r` or `d`; empty where it says none.
std::string ForeignSyntax::radius_of(Index shape) const {
    std::string radius;
    for (Index i = shape + 2, end = i; i < match(shape + 1); i = end + 1) {
        for (end = i; end < match(shape + 1) && kind(end) != Tok::Comma;)
            end = match(end) > end ? match(end) + 1 : end + 1;
        const bool has_name = kind(i + 1) == Tok::Assign;
        if (kind(i) == Tok::Bad || (has_name && text(i) != "r" && text(i) != "d")) continue;
        if (has_name || i == shape + 2) radius = value_text(has_name ? i + 2 : i, end);
        if (has_name && text(i) == "d") radius = half_of(radius);
    }
    return radius;
}

// `minkowski() { cube(10); sphere(2); }`.
bool ForeignSyntax::foreign_minkowski(Index first) {
    const Index open = match(first + 1) + 1, close = match(open);
    if (text(first) != "minkowski" || kind(first + 1) != Tok::Open || close <= open ||
        may_be_declared(text(first)))
        return false;
    Index last = close; // the statement of the last shape
    for (Index i = open + 1; i + 1 < close; i = match(i) > i ? match(i) + 1 : i + 1)
        if (kind(i) == Tok::End || i == open + 1) last = kind(i) == Tok::End ? i + 1 : i;
    if (last <= open + 1 || kind(last) != Tok::Name || kind(last + 1) != Tok::Open) return false;
    const std::string_view shape = text(last);
    const bool ball = shape == "sphere" || shape == "circle", post = shape == "cylinder";
    if (!ball && !post) return false;
    const std::string radius = radius_of(last);
    if (radius.empty()) return false;
    failed_ = close;
    Diagnostic &d = foreign(span(first), "there is no Minkowski sum");
    if (post) {
        d.help("edges along z are rounded in the flat shape: "
               "`rectangle([10, 20]).offset(2).extrude(5)`");
        return true;
    }
    forget_arguments(last + 1);
    d.help("with a ball it is an offset: write " + in_code("union { … }.offset(" + radius + ")"),
           {{{id_, token(first).begin, token(open).begin}, "union "},
            {{id_, token(last - 1).end, token(close - 1).end}, ""},
            {{id_, token(close).end, token(close).end}, ".offset(" + radius + ")"}});
    return true;
}

// `*cube(1);` and `%cube(1);`, which OpenSCAD leaves out of the model; `!cube(1);`, which it draws
// alone.
bool ForeignSyntax::foreign_modifier(Index at) {
    if (!is_one_of(kind(at), {Tok::Star, Tok::Percent}) || kind(at + 1) != Tok::Name) return false;
    Index end = at + 1;
    while (!ends_statement(end)) end = match(end) > end ? match(end) + 1 : end + 1;
    const std::uint32_t past = kind(end) == Tok::End ? token(end).end : token(end - 1).end;
    const std::string_view whole = text(token(at).begin, token(end - 1).end);
    failed_ = end - 1;
    Diagnostic &d = foreign(span(at), "there are no modifiers of shapes");
    const std::string_view all = source_.text;
    const std::size_t line = std::min(all.find('\n', past), all.size());
    const bool alone = all.substr(past, line - past).find_first_not_of(" \t\r") == all.npos;
    if (whole.find('\n') == whole.npos && alone)
        d.help("what is not drawn stands behind `//`",
               {{{id_, token(at).begin, token(at).begin}, "// "}});
    else
        d.help("what is not drawn is left away", {{{id_, token(at).begin, past}, ""}});
    return true;
}

// What was said of the `=` and `$fn` in a call that an edit replaces.
void ForeignSyntax::forget_arguments(Index open) const {
    for (Index i = open; i < match(open); ++i) {
        if (kind(i) == Tok::Assign) diagnostics_.withdraw(Code::ForeignSyntax, span(i));
        if (kind(i) == Tok::Bad) diagnostics_.withdraw(Code::BadCharacter, span(i));
    }
}

} // namespace fathom::lang
