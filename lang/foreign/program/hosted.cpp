// A shader that stands in a text of another program, as three.js has it between backticks, Python
// between three quotes, C++ as R"(…)" and a page in a `script`.
#include "lang/foreign/program/program.h"

#include <algorithm>
#include <array>

namespace fathom::lang::program {

namespace {

struct Quotes {
    std::string_view open, close;
};
constexpr std::array<Quotes, 5> quotes = {
    {{"`", "`"}, {"\"\"\"", "\"\"\""}, {"'''", "'''"}, {"R\"(", ")\""}, {"\">", "</script>"}}};

// Whether a distance of a point is declared in it, as `float map(vec3 p)` or `fn map(p: vec3f)`.
bool has_distance(std::string_view text) {
    constexpr std::array<std::string_view, 6> points = {"(vec3 ",  "(in vec3 ", "(const in vec3 ",
                                                        ": vec3<", ": vec3f",   "(float3 "};
    const bool gives = text.find("float ") != std::string_view::npos ||
                       text.find("-> f32") != std::string_view::npos;
    for (const std::string_view point : points)
        if (gives && text.find(point) != std::string_view::npos) return true;
    return false;
}

// The longest text between quotes that declares a distance, without its empty first line.
std::string_view hosted_shader(std::string_view text) {
    std::string_view out;
    for (const Quotes &q : quotes)
        for (std::size_t at = text.find(q.open); at != std::string_view::npos;
             at = text.find(q.open, at)) {
            at += q.open.size();
            const std::size_t end = text.find(q.close, at);
            if (end == std::string_view::npos) break;
            const std::string_view inner = text.substr(at, end - at);
            if (inner.size() > out.size() && has_distance(inner)) out = inner;
            at = end + q.close.size();
        }
    if (const std::size_t line = out.find('\n');
        line != std::string_view::npos && out.find_first_not_of(" \r\n") > line)
        out.remove_prefix(line + 1);
    return out;
}

// The lines without the blanks that all of them begin with.
std::string without_indent(std::string_view text) {
    std::string out;
    std::size_t indent = std::string_view::npos;
    for (int turn = 0; turn < 2; ++turn)
        for (std::size_t begin = 0; begin < text.size();) {
            const std::size_t end = std::min(text.find('\n', begin), text.size());
            const std::string_view line = text.substr(begin, end - begin);
            const std::size_t blanks = line.find_first_not_of(" \t\r");
            begin = end + 1;
            if (turn == 0 && blanks != std::string_view::npos)
                indent = std::min(indent, blanks);
            else if (turn == 1)
                out += std::string(
                           line.substr(blanks == std::string_view::npos ? line.size() : indent)) +
                       "\n";
        }
    return out;
}

} // namespace

bool answer_hosted(const Source &source, SourceId id, Diagnostics &diagnostics) {
    const std::string_view text = source.text, shader = hosted_shader(text);
    if (shader.empty()) return false;
    const auto begin = static_cast<std::uint32_t>(shader.data() - text.data());
    if (text.find("\nfn ") < begin) return false; // a text of ours, which has a string
    const auto size = static_cast<std::uint32_t>(text.size());
    const std::size_t line = std::min(shader.find('\n'), shader.size());
    diagnostics
        .add(Code::ForeignSyntax, {id, begin, begin + static_cast<std::uint32_t>(line)},
             "this is a shader in the text of another program")
        .note("the rest of the program, which shows it, is not wanted")
        .help("keep the shader alone:", {{{id, 0, size}, without_indent(shader)}});
    return true;
}

} // namespace fathom::lang::program
