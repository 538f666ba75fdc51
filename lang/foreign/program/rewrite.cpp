// Which language a program is of, and the answer that rewrites all of it.
#include "lang/foreign/program/program.h"

#include <algorithm>
#include <array>

namespace fathom::lang::program {

namespace {

struct Sign {
    std::string_view word;
    Of of;
};
// What only programs of that language hold; the first that is found decides.
constexpr std::array<Sign, 9> telling = {{{"from sdf import", Of::Sdf},
                                          {"import sdf", Of::Sdf},
                                          {"@jscad/modeling", Of::Jscad},
                                          {"jscad.", Of::Jscad},
                                          {"THREE.", Of::Three},
                                          {"make_shape {", Of::Curv},
                                          {"make_shape{", Of::Curv},
                                          {"parametric\n", Of::Curv},
                                          {"parametric ", Of::Curv}}};

std::string_view words_of(Of of) {
    switch (of) {
    case Of::Sdf: return "`sdf`, a library of Python";
    case Of::Jscad: return "JSCAD";
    case Of::Three: return "three.js";
    case Of::Script: return "JavaScript";
    case Of::Curv: return "Curv";
    case Of::Lisp: return "Bauble or libfive";
    }
    return {};
}

// How it measures otherwise than here: the edit keeps where everything is.
std::string_view difference_of(Of of) {
    switch (of) {
    case Of::Sdf:
    case Of::Jscad: return "up is z there and y here; all stays where it is in x, y and z";
    case Of::Curv:
        return "up is z there and y here, and round sizes are diameters there and radii here; all "
               "stays where it is in x, y and z";
    case Of::Lisp: return "boxes are given there by half their size, or by two corners";
    case Of::Three:
    case Of::Script: return {};
    }
    return {};
}

struct Told {
    Of of;
    std::uint32_t begin, end;
};

bool is_word_at(const std::vector<Piece> &pieces, std::size_t i, std::string_view text) {
    return i < pieces.size() && pieces[i].kind != Word::Text && pieces[i].text == text;
}

// Scripts have several words that are none of ours; Curv has calls by a space.
std::optional<Told> told_by_words(const std::vector<Piece> &pieces) {
    constexpr std::array<std::string_view, 17> curv_shapes = {
        "cube",       "sphere",  "box",          "cylinder",
        "torus",      "cone",    "union",        "circle",
        "difference", "rect",    "square",       "ellipsoid",
        "half_space", "ellipse", "intersection", "regular_polygon",
        "polygon"};
    constexpr std::array<std::string_view, 8> jscad_shapes = {
        "cuboid",        "roundedCuboid",    "roundedCylinder", "geodesicSphere",
        "extrudeLinear", "cylinderElliptic", "extrudeRotate",   "ellipsoid"};
    int script = 0, ours = 0;
    bool strong = false, let = false, jscad = false;
    std::optional<Told> curv;
    std::size_t first = pieces.size();
    for (std::size_t i = 0; i + 1 < pieces.size(); ++i) {
        const Piece &p = pieces[i], &next = pieces[i + 1];
        if (p.kind == Word::Text) {
            if (p.text[0] == '\'') ++script;
            continue;
        }
        const bool declares =
            p.text == "const" ||
            (p.text == "for" && next.text == "(" && is_word_at(pieces, i + 2, "let")) ||
            (p.text == "export" && next.text == "default") ||
            (p.text == "function" && next.text != "(");
        const bool script_word = declares || p.text == "..." || p.text == "===" ||
                                 (p.text == "Math" && next.text == ".") ||
                                 (p.text == "push" && next.text == "(") ||
                                 (p.text == "." && next.text == "subtract") ||
                                 ((p.text == "for" || p.text == "if") && next.text == "(");
        if (script_word) {
            script += declares ? 2 : 1;
            first = std::min(first, i);
        }
        jscad = jscad || (next.text == "(" && is_word_at(pieces, i + 2, "{") &&
                          std::ranges::find(jscad_shapes, p.text) != jscad_shapes.end());
        if (p.text == "fn" || p.text == "param") ++ours;
        const bool starts = i == 0 || p.first || is_word_at(pieces, i - 1, "[") ||
                            is_word_at(pieces, i - 1, "=") || is_word_at(pieces, i - 1, ",") ||
                            is_word_at(pieces, i - 1, "in") || is_word_at(pieces, i - 1, "else") ||
                            is_word_at(pieces, i - 1, ")");
        const bool spaced = starts && !next.first && (next.spaced || next.text == "{") &&
                            std::ranges::find(curv_shapes, p.text) != curv_shapes.end() &&
                            (next.kind == Word::Number || next.text == "[" || next.text == "{" ||
                             next.kind == Word::Name);
        const bool exact = next.text == "." && (is_word_at(pieces, i + 2, "exact") ||
                                                is_word_at(pieces, i + 2, "mitred"));
        if (starts && exact && !curv) { // `cube.exact 2`
            curv = Told{Of::Curv, p.begin, p.begin + static_cast<std::uint32_t>(p.text.size())};
            strong = true;
        }
        let = let || p.text == "let";
        const bool several = p.text == "union" || p.text == "difference" || p.text == "smooth";
        strong = strong || p.text == ">>" || (let && p.text == "in") || p.text == "`" ||
                 (spaced && (next.text == "{" || (several && next.text == "[")));
        if ((spaced || (several && next.kind == Word::Number)) && !curv)
            curv = Told{Of::Curv, p.begin, p.begin + static_cast<std::uint32_t>(p.text.size())};
        strong = strong || (curv && p.text == "smooth");
    }
    if (!strong) curv.reset();
    if (ours > 0) return std::nullopt;
    if (script >= 3 && first < pieces.size()) // texts alone tell nothing
        return Told{jscad ? Of::Jscad : Of::Script, pieces[first].begin,
                    pieces[first].begin + static_cast<std::uint32_t>(pieces[first].text.size())};
    return curv;
}

struct Rewritten {
    std::string text, lost, unread; // what is lost and not read, as words
    Of of;
    Span at; // what tells it
};

std::optional<Rewritten> rewrite_of(const Told &told, std::string_view text, SourceId id) {
    const bool python = told.of == Of::Sdf;
    Writer writer(told.of);
    Rewritten out{{}, {}, {}, told.of, {id, told.begin, told.end}};
    if (told.of == Of::Lisp) {
        out.text = writer.program(read_lisp(text));
    } else {
        const std::vector<Piece> pieces = read_pieces(text, python);
        out.text =
            writer.program(told.of == Of::Curv ? read_curv(pieces) : read_script(pieces, python));
    }
    for (const std::string &one : writer.lost()) out.lost += (out.lost.empty() ? "" : "; ") + one;
    for (const std::string &one : writer.unread())
        out.unread += (out.unread.empty() ? "`" : ", `") + one + "`";
    return out;
}

std::optional<Rewritten> rewrite(std::string_view text, SourceId id) {
    constexpr std::size_t longest = 50000;
    if (text.size() > longest) return std::nullopt;
    std::optional<Told> told;
    for (const Sign &sign : telling) {
        const std::size_t at = text.find(sign.word);
        if (at == std::string_view::npos) continue;
        const auto begin = static_cast<std::uint32_t>(at);
        std::string_view word = sign.word;
        while (word.back() == ' ' || word.back() == '\n' || word.back() == '{')
            word.remove_suffix(1);
        told = Told{sign.of, begin, begin + static_cast<std::uint32_t>(word.size())};
        break;
    }
    std::size_t first = text.find_first_not_of(" \n\r\t");
    while (first != std::string_view::npos && (text[first] == ';' || text[first] == '#'))
        first = text.find_first_not_of(" \n\r\t", std::min(text.find('\n', first), text.size()));
    if (!told && first != std::string_view::npos && text[first] == '(') {
        const std::size_t end = text.find_first_of(" \n)", first);
        const auto begin = static_cast<std::uint32_t>(first);
        told = Told{Of::Lisp, begin, static_cast<std::uint32_t>(std::min(end, text.size()))};
    }
    try {
        if (!told) told = told_by_words(read_pieces(text, false));
        if (told) return rewrite_of(*told, text, id);
    } catch (const Unsure &) { // answered line by line
    }
    return std::nullopt;
}

} // namespace

bool answer(const Source &source, SourceId id, Diagnostics &diagnostics) {
    if (answer_hosted(source, id, diagnostics)) return true;
    auto rewritten = rewrite(source.text, id);
    if (!rewritten) return answer_degrees(source, id, diagnostics);
    if (!source.text.ends_with('\n')) rewritten->text.pop_back();
    Diagnostic &d = diagnostics.add(Code::ForeignSyntax, rewritten->at,
                                    "this is a program of " + std::string(words_of(rewritten->of)));
    if (const std::string_view differs = difference_of(rewritten->of); !differs.empty())
        d.note(std::string(differs));
    if (!rewritten->lost.empty()) d.note("left away: " + rewritten->lost);
    if (!rewritten->unread.empty())
        d.note("not known here: " + rewritten->unread +
               ", to be written otherwise where it stands");
    d.help("write all of it so:",
           {{{id, 0, static_cast<std::uint32_t>(source.text.size())}, rewritten->text}});
    return true;
}

} // namespace fathom::lang::program
