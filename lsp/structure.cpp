// What a text looks like: tokens with their meaning, what folds, what selections grow to, colours.
#include "lsp/requests.h"

#include "lang/lexer.h"

#include <algorithm>
#include <fmt/format.h>

namespace fathom::lsp {
namespace {

using lang::Tok;

// The order is that of the legend.
enum class Meaning : std::uint8_t {
    Comment,
    Keyword,
    String,
    Number,
    Operator,
    Function,
    Method,
    Variable,
    Parameter,
    Property,
    Type,
    Namespace
};
constexpr const char *meanings[] = {"comment",   "keyword",  "string", "number",
                                    "operator",  "function", "method", "variable",
                                    "parameter", "property", "type",   "namespace"};
constexpr int declaration_bit = 1, readonly_bit = 2, library_bit = 4;

struct Colored {
    std::uint32_t begin, end;
    Meaning meaning;
    int modifiers = 0;
};

int modifiers_of(const Declaration &declaration) {
    switch (declaration.by) {
    case DeclaredBy::Var: return 0;
    case DeclaredBy::Let:
    case DeclaredBy::Function:
    case DeclaredBy::Param:
    case DeclaredBy::Parameter:
    case DeclaredBy::Loop:
    case DeclaredBy::Import: return readonly_bit;
    }
    return 0;
}

Meaning meaning_of(const Declaration &declaration) {
    if (declaration.function) return Meaning::Function;
    switch (declaration.by) {
    case DeclaredBy::Function: return Meaning::Function;
    case DeclaredBy::Parameter: return Meaning::Parameter;
    case DeclaredBy::Import: return Meaning::Namespace;
    case DeclaredBy::Let:
    case DeclaredBy::Var:
    case DeclaredBy::Param:
    case DeclaredBy::Loop: return Meaning::Variable;
    }
    return Meaning::Variable;
}

Colored colored(const Workspace &workspace, const Names &names, const Use &use) {
    Colored out{use.at.begin, use.at.end, Meaning::Variable, 0};
    if (use.as == UsedAs::Argument) {
        out.meaning = Meaning::Property;
        return out;
    }
    const bool called =
        use.as == UsedAs::Callee || use.as == UsedAs::Method || use.as == UsedAs::Member;
    if (use.declaration) {
        const Declaration &declared = names.declarations[*use.declaration];
        out.meaning = meaning_of(declared);
        out.modifiers = modifiers_of(declared);
    } else if (!use.module && (!library_forms(workspace, use.name).empty() ||
                               constant_named(workspace, use.name))) {
        out.meaning = constant_named(workspace, use.name) ? Meaning::Variable : Meaning::Function;
        out.modifiers = library_bit | readonly_bit;
    } else if (called)
        out.meaning = Meaning::Function;
    if (use.as == UsedAs::Method && out.meaning == Meaning::Function) out.meaning = Meaning::Method;
    return out;
}

// Of a word that is no name.
std::optional<Meaning> meaning_of(Tok kind) {
    if (kind == Tok::Number || kind == Tok::Color) return Meaning::Number;
    if (kind == Tok::String) return Meaning::String;
    if (lang::is_one_of(kind,
                        {Tok::Let, Tok::Var, Tok::Fn, Tok::Param, Tok::Import, Tok::For, Tok::In,
                         Tok::If, Tok::Else, Tok::While, Tok::Limit, Tok::Break, Tok::Return,
                         Tok::And, Tok::Or, Tok::Not, Tok::True, Tok::False, Tok::As}))
        return Meaning::Keyword;
    if (lang::is_one_of(kind,
                        {Tok::Assign,      Tok::Bar,        Tok::Amp,          Tok::Less,
                         Tok::Greater,     Tok::Plus,       Tok::Minus,        Tok::Star,
                         Tok::Slash,       Tok::Percent,    Tok::Caret,        Tok::Arrow,
                         Tok::FatArrow,    Tok::DotDot,     Tok::DotDotEqual,  Tok::EqualEqual,
                         Tok::NotEqual,    Tok::LessEqual,  Tok::GreaterEqual, Tok::PlusAssign,
                         Tok::MinusAssign, Tok::StarAssign, Tok::SlashAssign}))
        return Meaning::Operator;
    return std::nullopt;
}

// All words and comments that have a meaning, by place.
std::vector<Colored> colored_words(const Workspace &workspace, const Reading &read) {
    std::map<std::uint32_t, Colored> at;
    for (const lang::Comment &comment : read.syntax.words.comments)
        at[comment.begin] = {comment.begin, comment.end, Meaning::Comment, 0};
    std::vector<std::pair<std::uint32_t, std::uint32_t>> plain; // names without a meaning so far
    for (const lang::Token &token : read.syntax.words.tokens) {
        if (auto meaning = meaning_of(token.kind))
            at[token.begin] = {token.begin, token.end, *meaning, 0};
        else if (token.kind == Tok::Name) {
            const std::string_view text =
                read.syntax.text().substr(token.begin, token.end - token.begin);
            if (text == "as" || text == "limit") // a keyword where no name of the text stands
                at[token.begin] = {token.begin, token.end, Meaning::Keyword, 0};
        }
    }
    for (Span component : read.names.components)
        at[component.begin] = {component.begin, component.end, Meaning::Property, 0};
    for (Span type : read.names.types) at[type.begin] = {type.begin, type.end, Meaning::Type, 0};
    for (const Declaration &declared : read.names.declarations)
        if (!declared.name.empty())
            at[declared.at.begin] = {declared.at.begin, declared.at.end, meaning_of(declared),
                                     declaration_bit | modifiers_of(declared)};
    for (const Use &use : read.names.uses) at[use.at.begin] = colored(workspace, read.names, use);
    std::vector<Colored> all;
    for (const auto &[begin, word] : at) all.push_back(word);
    return all;
}

// `range`: null for the whole text.
Json tokens_within(Workspace &workspace, const Json &params, const Json &range) {
    const Reading &read = reading(document_of(workspace, params));
    const std::string_view text = read.syntax.text();
    const bool limited = !range.is_null();
    const std::size_t from = limited ? offset_at(text, position_of(range.at("start"))) : 0,
                      to = limited ? offset_at(text, position_of(range.at("end"))) : text.size();
    Json data = Json::array();
    Position last;
    const auto put = [&](std::size_t begin, std::size_t end, const Colored &word) {
        const auto [start, stop] = range_of(read.lines, begin, end);
        const int length = stop.character - start.character;
        if (length == 0) return;
        data.insert(data.end(),
                    {start.line - last.line,
                     start.line == last.line ? start.character - last.character : start.character,
                     length, static_cast<int>(word.meaning), word.modifiers});
        last = start;
    };
    for (const Colored &word : colored_words(workspace, read)) {
        if (word.end <= from || word.begin >= to) continue;
        for (std::size_t begin = word.begin; begin < word.end;) { // a comment may have lines
            const std::size_t end = std::min<std::size_t>(text.find('\n', begin), word.end);
            put(begin, end, word);
            begin = end + 1;
        }
    }
    return {{"data", std::move(data)}};
}

} // namespace

Json semantic_legend() {
    return {{"tokenTypes", meanings},
            {"tokenModifiers", {"declaration", "readonly", "defaultLibrary"}}};
}

Json semantic_tokens(Workspace &workspace, const Json &params) {
    return tokens_within(workspace, params, nullptr);
}

Json semantic_tokens_of_range(Workspace &workspace, const Json &params) {
    return tokens_within(workspace, params, params.at("range"));
}

Json folding_ranges(Workspace &workspace, const Json &params) {
    const Reading &read = reading(document_of(workspace, params));
    const std::string_view text = read.syntax.text();
    Json all = Json::array();
    const auto fold = [&](int first, int last, const char *kind) {
        if (first >= last) return;
        Json range{{"startLine", first}, {"endLine", last}};
        if (*kind) range["kind"] = kind;
        all.push_back(std::move(range));
    };
    std::vector<std::pair<char, int>> open;
    int imports = -1, last_import = -1;
    for (const lang::Token &token : read.syntax.words.tokens) {
        const int line = position_at(read.lines, token.begin).line;
        const char sign = text[token.begin];
        if (token.kind == Tok::Import) {
            if (imports < 0) imports = line;
            last_import = line;
        }
        if (token.end - token.begin != 1) continue;
        if (sign == '(' || sign == '[' || sign == '{') open.emplace_back(sign, line);
        if (sign != ')' && sign != ']' && sign != '}') continue;
        if (open.empty()) continue;
        fold(open.back().second, line - 1, ""); // the closing line stays seen
        open.pop_back();
    }
    fold(imports, last_import, "imports");
    const std::vector<lang::Comment> &comments = read.syntax.words.comments;
    for (std::size_t i = 0; i < comments.size();) {
        std::size_t last = i;
        int end = position_at(read.lines, comments[i].end).line;
        while (last + 1 < comments.size() && comments[last + 1].is_line && comments[i].is_line &&
               position_at(read.lines, comments[last + 1].begin).line == end + 1)
            end = position_at(read.lines, comments[++last].end).line;
        fold(position_at(read.lines, comments[i].begin).line, end, "comment");
        i = last + 1;
    }
    return all;
}

Json selection_ranges(Workspace &workspace, const Json &params) {
    const Reading &read = reading(document_of(workspace, params));
    const std::string_view text = read.syntax.text();
    Json all = Json::array();
    for (const Json &position : params.at("positions")) {
        const std::size_t offset = offset_at(text, position_of(position));
        std::vector<Span> spans{{{}, 0, static_cast<std::uint32_t>(text.size())}};
        const auto at = static_cast<std::uint32_t>(offset);
        for (const Step &step : path_to(read.syntax.ast, at, at)) {
            // a method's call goes on to its arguments; the object before it is a step of its own
            const Span span = step.span(read.syntax.ast);
            if (span.begin != spans.back().begin || span.end != spans.back().end)
                spans.push_back(span);
        }
        const Word word = word_at(text, offset);
        if (word.begin < word.end &&
            (word.begin > spans.back().begin || word.end < spans.back().end) &&
            word.begin >= spans.back().begin && word.end <= spans.back().end)
            spans.push_back(
                {{}, static_cast<std::uint32_t>(word.begin), static_cast<std::uint32_t>(word.end)});
        Json chain;
        for (Span span : spans) {
            Json step{{"range", range_json(read.lines, span)}};
            if (!chain.is_null()) step["parent"] = std::move(chain);
            chain = std::move(step);
        }
        all.push_back(std::move(chain));
    }
    return all;
}

namespace {

Json color_json(double r, double g, double b, double a) {
    return {{"red", r}, {"green", g}, {"blue", b}, {"alpha", a}};
}

} // namespace

Json document_colors(Workspace &workspace, const Json &params) {
    const Reading &read = reading(document_of(workspace, params));
    const std::string_view text = read.syntax.text();
    Json all = Json::array();
    for (const lang::Token &token : read.syntax.words.tokens) {
        if (token.kind != Tok::Color) continue;
        double rgba[4] = {0, 0, 0, 1};
        lang::read_color(text.substr(token.begin, token.end - token.begin), rgba);
        all.push_back({{"range", range_json(read.lines, {{}, token.begin, token.end})},
                       {"color", color_json(rgba[0], rgba[1], rgba[2], rgba[3])}});
    }
    for (const Use &use : read.names.uses) {
        if (use.declaration || use.module || use.as != UsedAs::Value) continue;
        const Constant *constant = constant_named(workspace, use.name);
        if (!constant || !constant->rgb) continue;
        const auto part = [&](int shift) { return double(*constant->rgb >> shift & 255) / 255; };
        all.push_back({{"range", range_json(read.lines, use.at)},
                       {"color", color_json(part(16), part(8), part(0), 1)}});
    }
    return all;
}

// `#rrggbb`, with the alpha behind it where that is not 1; and the name of the colour, if it has one.
Json color_presentations(Workspace &workspace, const Json &params) {
    const Json &color = params.at("color");
    const auto byte = [&color](const char *name) {
        return static_cast<std::uint32_t>(std::clamp(color.at(name).get<double>(), 0.0, 1.0) * 255 +
                                          0.5);
    };
    const std::uint32_t rgb = byte("red") << 16 | byte("green") << 8 | byte("blue"),
                        alpha = byte("alpha");
    Json all = Json::array();
    const auto offer = [&](const std::string &label) {
        all.push_back(
            {{"label", label}, {"textEdit", {{"range", params.at("range")}, {"newText", label}}}});
    };
    offer(alpha == 255 ? fmt::format("#{:06x}", rgb) : fmt::format("#{:06x}{:02x}", rgb, alpha));
    if (alpha == 255)
        for (const Constant &constant : workspace.constants)
            if (constant.rgb == rgb) offer(constant.name);
    return all;
}

} // namespace fathom::lsp
