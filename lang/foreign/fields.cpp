// What the names of other languages say: a distance of a shader, which makes a shape here, and names
// with hyphens.
#include "lang/foreign/foreign.h"

#include <array>

namespace fathom::lang {

// The shape of a function that gives a scene's distance, as shaders name it; else empty.
std::string ForeignSyntax::shape_of_field(Index name) const {
    constexpr std::array<std::string_view, 13> names = {
        "map",     "scene",   "sdf",      "SDF",   "sdScene",  "de",  "DE",
        "GetDist", "getDist", "mapScene", "world", "sceneSDF", "dist"};
    const Index open = name + 1, close = match(open);
    Index type = open + 1;
    if (kind(type) == Tok::In || text(type) == "in" || text(type) == "const") ++type;
    if (!is_one_of(text(name), names) || text(type) != "vec3" || type + 2 != close ||
        !may_look_far())
        return {};
    for (Index i = 0; i < tokens_.tokens.size(); ++i)
        if (text(i) == "implicit") return {};
    const std::string called(text(name));
    if (text(name - 1) == "float") return "implicit(" + called + ", within: everywhere)";
    if (text(name - 1) != "vec2") return {};
    return "implicit(p => " + called + "(p).x, within: everywhere)";
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
