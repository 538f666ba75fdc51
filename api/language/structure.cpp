// What a text looks like: tokens with their meaning, what folds, what selections grow to, colours.
#include "api/language/features.h"

#include "lang/lexer.h"

#include <algorithm>
#include <fmt/format.h>

namespace fathom::language {
namespace {

using lang::Tok;

using Meaning = v1::SemanticToken::Meaning;
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
    case DeclaredBy::Import: return Meaning::Module;
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

} // namespace

std::vector<v1::SemanticToken> tokens(Workspace &workspace, Document &document,
                                      v1::Stretch within) {
    std::vector<v1::SemanticToken> all;
    for (const Colored &word : colored_words(workspace, reading(document)))
        if (word.end > within.begin && word.begin < within.end)
            all.push_back({{word.begin, word.end},
                           word.meaning,
                           (word.modifiers & declaration_bit) != 0,
                           (word.modifiers & readonly_bit) != 0,
                           (word.modifiers & library_bit) != 0});
    return all;
}

std::vector<v1::FoldingRange> folding(Document &document) {
    using Kind = v1::FoldingRange::Kind;
    const Syntax &syntax = reading(document).syntax;
    const std::string_view text = syntax.text();
    std::vector<v1::FoldingRange> all;
    const auto fold = [&](int first, int last, Kind kind) {
        if (first < last) all.push_back({first, last, kind});
    };
    std::vector<std::pair<char, int>> open;
    int imports = 0, last_import = 0;
    for (const lang::Token &token : syntax.words.tokens) {
        const char sign = text[token.begin];
        const bool bracket = token.end - token.begin == 1 &&
                             std::string_view("()[]{}").find(sign) != std::string_view::npos;
        if (!bracket && token.kind != Tok::Import) continue;
        const int line = line_of(syntax, token.begin);
        if (token.kind == Tok::Import) {
            if (imports == 0) imports = line;
            last_import = line;
        } else if (sign == '(' || sign == '[' || sign == '{') {
            open.emplace_back(sign, line);
        } else if (!open.empty()) {
            fold(open.back().second, line - 1, Kind::Brackets); // the closing line stays seen
            open.pop_back();
        }
    }
    fold(imports, last_import, Kind::Imports);
    const std::vector<lang::Comment> &comments = syntax.words.comments;
    for (std::size_t i = 0; i < comments.size();) {
        std::size_t last = i;
        int end = line_of(syntax, comments[i].end);
        while (last + 1 < comments.size() && comments[last + 1].is_line && comments[i].is_line &&
               line_of(syntax, comments[last + 1].begin) == end + 1)
            end = line_of(syntax, comments[++last].end);
        fold(line_of(syntax, comments[i].begin), end, Kind::Comment);
        i = last + 1;
    }
    return all;
}

std::vector<v1::Stretch> selections(Document &document, std::size_t at) {
    const Syntax &syntax = reading(document).syntax;
    std::vector<v1::Stretch> all{{0, syntax.text().size()}};
    const auto byte = static_cast<std::uint32_t>(at);
    for (const Step &step : path_to(syntax.ast, byte, byte)) {
        // a method's call goes on to its arguments; the object before it is a step of its own
        const Span span = step.span(syntax.ast);
        if (span.begin != all.back().begin || span.end != all.back().end)
            all.push_back(stretch_of(span));
    }
    const Word word = word_at(syntax.text(), at);
    if (word.begin < word.end && (word.begin > all.back().begin || word.end < all.back().end) &&
        word.begin >= all.back().begin && word.end <= all.back().end)
        all.push_back({word.begin, word.end});
    return all;
}

std::vector<v1::ColorAt> colors(Workspace &workspace, Document &document) {
    const Reading &read = reading(document);
    const std::string_view text = read.syntax.text();
    std::vector<v1::ColorAt> all;
    for (const lang::Token &token : read.syntax.words.tokens) {
        if (token.kind != Tok::Color) continue;
        double rgba[4] = {0, 0, 0, 1};
        lang::read_color(text.substr(token.begin, token.end - token.begin), rgba);
        all.push_back({{token.begin, token.end}, {rgba[0], rgba[1], rgba[2], rgba[3]}});
    }
    for (const Use &use : read.names.uses) {
        if (use.declaration || use.module || use.as != UsedAs::Value) continue;
        const Constant *constant = constant_named(workspace, use.name);
        if (!constant || !constant->rgb) continue;
        const auto part = [&](int shift) { return double(*constant->rgb >> shift & 255) / 255; };
        all.push_back({stretch_of(use.at), {part(16), part(8), part(0), 1}});
    }
    return all;
}

// `#rrggbb`, with the alpha behind it where that is not 1; and the name of the colour, if it has one.
std::vector<std::string> color_texts(const Workspace &workspace,
                                     const std::array<double, 4> &rgba) {
    const auto byte = [&rgba](std::size_t i) {
        return static_cast<std::uint32_t>(std::clamp(rgba[i], 0.0, 1.0) * 255 + 0.5);
    };
    const std::uint32_t rgb = byte(0) << 16 | byte(1) << 8 | byte(2), alpha = byte(3);
    if (alpha != 255) return {fmt::format("#{:06x}{:02x}", rgb, alpha)};
    std::vector<std::string> all{fmt::format("#{:06x}", rgb)};
    for (const Constant &constant : workspace.constants)
        if (constant.rgb == rgb) all.push_back(constant.name);
    return all;
}

} // namespace fathom::language
