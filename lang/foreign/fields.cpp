// What the names of other languages say: a distance of a shader, which makes a shape here, names with
// hyphens, and what is set from outside.
#include "lang/foreign/foreign.h"
#include "lang/vocabulary.h"

#include <array>

namespace fathom::lang {

bool names_a_scene(std::string_view name) {
    constexpr std::array<std::string_view, 15> names = {
        "map",  "scene",    "sdf",      "sdscene",   "de",      "getdist",     "mapscene", "world",
        "dist", "scenesdf", "sdfscene", "scenedist", "sdworld", "getdistance", "mapworld"};
    std::string plain; // in small letters, without `_`
    for (const char c : name)
        if (c != '_') plain += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return is_one_of(std::string_view(plain), names);
}

// The shape of a function that gives a scene's distance, as shaders name it; else empty.
std::string ForeignSyntax::shape_of_field(Index name) const {
    const Index open = name + 1, close = match(open);
    Index type = open + 1;
    if (kind(type) == Tok::In || text(type) == "in" || text(type) == "const") ++type;
    if (!names_a_scene(text(name)) || text(type) != "vec3" || type + 2 != close || !may_look_far())
        return {};
    for (Index i = 0; i < tokens_.tokens.size(); ++i)
        if (text(i) == "implicit") return {};
    const std::string called(text(name));
    if (text(name - 1) == "float") return "implicit(" + called + ", within: everywhere)";
    if (text(name - 1) != "vec2") return {};
    return "implicit(p => " + called + "(p).x, within: everywhere)";
}

// Godot's `uniform float r : hint_range(0.0, 2.0) = 1.0;`, of a number.
bool ForeignSyntax::hinted_param(Index first, Index name) {
    const Index open = name + 3, close = match(open);
    if (kind(name + 1) != Tok::Colon || text(name + 2) != "hint_range" || close <= open)
        return false;
    Index comma = open + 1;
    while (comma < close && kind(comma) != Tok::Comma) ++comma;
    Index last = comma + 1; // a third number is the slider's step
    while (last < close && kind(last) != Tok::Comma) ++last;
    if (comma >= close || kind(close + 1) != Tok::Assign || !ends_statement(close + 3))
        return false;
    lost_.push_back(name);
    const std::string head = "param " + std::string(text(name));
    const std::string range = std::string(text(token(open).end, token(comma).begin)) + ".." +
                              std::string(text(token(comma + 1).begin, token(last - 1).end));
    foreign(span(first, close), "what is set from outside is declared with `param`")
        .help(to_write(head + " = " + std::string(text(close + 2)) + " in " + range),
              {{span(first, close), head},
               {{id_, token(close + 2).end, token(close + 2).end}, " in " + range}});
    return true;
}

// `my-name`: a difference here, in all of the file.
void ForeignSyntax::foreign_name_parts(Index left, Index right) {
    const std::string name = std::string(text(left)) + "_" + std::string(text(right));
    constexpr std::size_t most_edits = 20;
    std::vector<Edit> edits;
    for (Index i = left; i + 2 < tokens_.tokens.size() && edits.size() < most_edits; ++i)
        if (kind(i) == Tok::Name && kind(i + 1) == Tok::Minus && text(i) == text(left) &&
            text(i + 2) == text(right))
            edits.push_back({span(i, i + 2), name});
    lost_.push_back(left), lost_.push_back(right);
    foreign(span(left, right), "a name has no `-`").help(to_write(name), std::move(edits));
}

// Whether the statement's value, behind the name, uses it.
bool ForeignSyntax::is_used_after(Index name) const {
    for (Index i = name + 1; !ends_statement(i); ++i)
        if (kind(i) == Tok::Name && text(i) == text(name)) return true;
    return false;
}

} // namespace fathom::lang
