// OpenSCAD's `sin(30)`: its functions take and give degrees, which no line tells that is read alone.
#include "lang/foreign/program/program.h"

#include <algorithm>
#include <array>

namespace fathom::lang::program {

namespace {

constexpr std::array<std::string_view, 3> taking = {"sin", "cos", "tan"};
constexpr std::array<std::string_view, 4> giving = {"asin", "acos", "atan", "atan2"};
constexpr std::array<std::string_view, 9> of_radians = {"deg", "rad", "turn", "pi", "PI",
                                                        "tau", "TAU", "time", "p"};
constexpr std::array<std::string_view, 8> transforms = {
    "translate", "rotate", "scale", "color", "mirror", "resize", "multmatrix", "offset"};

// The places of a text's words that are asked for.
struct PlacedWords {
    const std::vector<Piece> &pieces;

    std::string_view text(std::size_t i) const {
        return i < pieces.size() ? std::string_view(pieces[i].text) : std::string_view();
    }
    bool is_name(std::size_t i) const { return i < pieces.size() && pieces[i].kind == Word::Name; }
    bool is_number(std::size_t i) const {
        return i < pieces.size() && pieces[i].kind == Word::Number;
    }
    std::uint32_t end(std::size_t i) const {
        return pieces[i].begin + static_cast<std::uint32_t>(pieces[i].text.size());
    }
    // The bracket that closes the one at `i`; 0 where there is none.
    std::size_t close_of(std::size_t i) const {
        int depth = 0;
        for (; i < pieces.size(); ++i) {
            if (text(i) == "(" || text(i) == "[") ++depth;
            if ((text(i) == ")" || text(i) == "]") && --depth == 0) return i;
        }
        return 0;
    }
};

// What OpenSCAD alone has, and nothing that is ours.
bool is_openscad(const PlacedWords &words) {
    constexpr std::array<std::string_view, 9> others = {
        "fn", "let", "var", "param", "implicit", "camera", "const", "def", "=>"};
    bool found = false;
    for (std::size_t i = 0; i < words.pieces.size(); ++i) {
        const std::string_view word = words.text(i), next = words.text(i + 1);
        const bool lets = word == "let" && next == "(";
        if (!lets && std::ranges::find(others, word) != others.end()) return false;
        const bool prefixed = std::ranges::find(transforms, word) != transforms.end() &&
                              next == "(" && words.text(i - (i > 0)) != ".";
        const std::size_t close = prefixed ? words.close_of(i + 1) : 0;
        found = found || word == "$fn" || word == "$fa" || word == "$fs" ||
                (word == "module" && words.is_name(i + 1)) ||
                ((word == "linear_extrude" || word == "rotate_extrude") && next == "(") ||
                (word == "for" && next == "(" && words.is_name(i + 2) && words.text(i + 3) == "=" &&
                 words.text(i + 4) == "[") ||
                (close > 0 && words.is_name(close + 1));
    }
    return found;
}

// The edits that make `sin(a)` one of degrees; none where its angle has a unit, or is of radians.
void take_degrees(const PlacedWords &words, std::size_t open, SourceId id,
                  std::vector<Edit> &edits) {
    const std::size_t close = words.close_of(open), first = open + 1;
    if (close <= first) return;
    const std::uint32_t end = words.end(close - 1);
    bool products = true;
    int depth = 0;
    for (std::size_t i = first; i < close; ++i) {
        const std::string_view word = words.text(i);
        if (std::ranges::find(of_radians, word) != of_radians.end()) return;
        depth += word == "(" || word == "[" ? 1 : word == ")" || word == "]" ? -1 : 0;
        const bool binds = words.is_name(i) || words.is_number(i) || word == "*" || word == "/" ||
                           word == ")" || word == "]" || (word == "-" && i == first);
        products = products && (depth > 0 || binds);
    }
    if (close == first + 1 && words.is_number(first)) {
        edits.push_back({{id, end, end}, "deg"});
        return;
    }
    const std::uint32_t begin = words.pieces[first].begin;
    if (!products) edits.push_back({{id, begin, begin}, "("});
    edits.push_back({{id, end, end}, products ? " * 1deg" : ") * 1deg"});
}

// The edits that make `atan(x)` give degrees, unless it does.
void give_degrees(const PlacedWords &words, std::size_t name, SourceId id,
                  std::vector<Edit> &edits) {
    const std::size_t close = words.close_of(name + 1);
    if (close == 0 || (words.text(close + 1) == "/" && words.text(close + 3) == "deg")) return;
    const std::uint32_t begin = words.pieces[name].begin, end = words.end(close);
    edits.push_back({{id, begin, begin}, "("});
    edits.push_back({{id, end, end}, " / 1deg)"});
}

} // namespace

bool answer_degrees(const Source &source, SourceId id, Diagnostics &diagnostics) {
    constexpr std::size_t longest = 50000;
    if (source.text.size() > longest) return false;
    std::vector<Piece> pieces;
    try {
        pieces = read_pieces(source.text, false);
    } catch (const Unsure &) {
        return false;
    }
    const PlacedWords words{pieces};
    if (!is_openscad(words)) return false;
    std::vector<Edit> edits;
    std::optional<Span> at;
    for (std::size_t i = 0; i + 2 < pieces.size(); ++i) {
        if (!words.is_name(i) || words.text(i + 1) != "(") continue;
        const std::size_t before = edits.size();
        const bool takes = std::ranges::find(taking, words.text(i)) != taking.end();
        const bool gives = std::ranges::find(giving, words.text(i)) != giving.end();
        if ((takes || gives) && i > 0 && words.text(i - 1) == "function") return false; // its own
        if (takes) take_degrees(words, i + 1, id, edits);
        if (gives) give_degrees(words, i, id, edits);
        if (edits.size() > before && !at) at = Span{id, pieces[i].begin, words.end(i)};
    }
    if (!at) return false;
    diagnostics
        .add(Code::ForeignSyntax, *at,
             "OpenSCAD's angles are in degrees, and here they are in radians without a unit")
        .note("the rest of the program is read when that is settled")
        .help("write `sin(30deg)`, `sin(a * 1deg)` and `atan(y, x) / 1deg`", std::move(edits));
    return true;
}

} // namespace fathom::lang::program
