// Kinds of words, and the answers to words of other languages.
#include "lang/lexer.h"

#include "lang/ast.h"
#include "lang/builder.h"
#include "lang/vocabulary.h"

#include "base/single.h"
#include "base/text.h"
#include "lang/parse.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace fathom::lang {

namespace {

struct Keyword {
    std::string_view text;
    Tok kind;
};

constexpr std::array keyword_table = {
    Keyword{"and", Tok::And},     Keyword{"break", Tok::Break},   Keyword{"else", Tok::Else},
    Keyword{"false", Tok::False}, Keyword{"fn", Tok::Fn},         Keyword{"for", Tok::For},
    Keyword{"if", Tok::If},       Keyword{"import", Tok::Import}, Keyword{"in", Tok::In},
    Keyword{"let", Tok::Let},     Keyword{"not", Tok::Not},       Keyword{"or", Tok::Or},
    Keyword{"param", Tok::Param}, Keyword{"return", Tok::Return}, Keyword{"true", Tok::True},
    Keyword{"var", Tok::Var},     Keyword{"while", Tok::While}};

// Longer ones first, as they are read.
constexpr std::string_view sign_table[] = {"..=", "->", "=>", "..", "==", "!=", "<=", ">=", "+=",
                                           "-=",  "*=", "/=", "(",  ")",  "[",  "]",  "{",  "}",
                                           ",",   ":",  ".",  ";",  "=",  "|",  "&",  "<",  ">",
                                           "+",   "-",  "*",  "/",  "%",  "^"};

std::string quoted_code(std::string_view text) { return "`" + std::string(text) + "`"; }

} // namespace

bool is_keyword_text(std::string_view word) {
    return std::ranges::find(keyword_table, word, &Keyword::text) != keyword_table.end();
}

std::optional<NumberWord> read_number(std::string_view word) {
    const std::size_t length = number_length(word);
    NumberWord number;
    number.digits = word.substr(0, length);
    number.unit = word.substr(length);
    const std::optional<double> value = parse_number(number.digits);
    if (!value || !is_digit(word[0])) return std::nullopt;
    number.value = *value;
    number.is_int = number.digits.find_first_not_of("0123456789") == std::string_view::npos;
    if (number.unit.empty()) return number;
    number.is_int = false;
    constexpr std::pair<std::string_view, double> units[] = {
        {"deg", std::numbers::pi / 180}, {"turn", 2 * std::numbers::pi}, {"rad", 1}};
    const auto *unit =
        std::ranges::find(units, number.unit, &std::pair<std::string_view, double>::first);
    if (unit == std::end(units)) return std::nullopt;
    number.unit = unit->first;
    number.value *= unit->second;
    return number;
}

std::string read_string(std::string_view quoted) {
    std::string out;
    const std::string_view inner = quoted.substr(1, quoted.size() - 2);
    for (std::size_t i = 0; i < inner.size(); ++i) {
        if (inner[i] != '\\' || i + 1 == inner.size()) {
            out.push_back(inner[i]);
            continue;
        }
        switch (inner[++i]) {
        case 'n': out.push_back('\n'); break;
        case 't': out.push_back('\t'); break;
        default: out.push_back(inner[i]);
        }
    }
    return out;
}

void read_color(std::string_view word, double (&rgba)[4]) {
    const std::string_view digits = word.substr(1);
    const std::size_t per_channel = digits.size() == 3 ? 1 : 2;
    for (std::size_t i = 0; i * per_channel < digits.size(); ++i) {
        const unsigned high = hex_value(digits[i * per_channel]);
        const unsigned low = hex_value(digits[i * per_channel + per_channel - 1]);
        rgba[i] = (high * 16 + low) / 255.0;
    }
}

void Lexer::word(std::uint32_t begin, std::uint32_t end) {
    const std::string_view text = slice(begin, end);
    Tok kind = Tok::Name;
    if (text.size() <= 6 && text[0] >= 'a' && text[0] <= 'w')
        for (const Keyword &keyword : keyword_table)
            if (keyword.text == text) kind = keyword.kind;
    add(kind, begin, end);
}

// Whether what stands behind a number's digits is a name that the text has above.
bool Lexer::is_named(std::string_view number) const {
    constexpr std::size_t most_reports = 100; // all words are looked at
    if (diagnostics_.items().size() > most_reports) return true;
    const std::string_view name = number.substr(number_length(number));
    return std::any_of(words_.tokens.begin(), words_.tokens.end(), [&](const Token &t) {
        return t.kind == Tok::Name && text_of(source_, t) == name;
    });
}

void Lexer::number(std::uint32_t begin, std::uint32_t end) {
    const std::string_view word = slice(begin, end);
    const std::optional<NumberWord> number = read_number(word);
    const bool held =
        number && fits_single(number->value) && (number->value == 0 || flushed(number->value) != 0);
    if (held) return add(Tok::Number, begin, end);
    if (word[0] == '.' && !words_.tokens.empty() && words_.tokens.back().end == begin &&
        slice(words_.tokens.back().begin, begin).find('_') != std::string_view::npos &&
        is_digit(source_.text[words_.tokens.back().begin])) { // `1_000.5`: told at the digits
        words_.tokens.back().end = end;
        return;
    }
    add(Tok::Bad, begin, end);
    if (is_digit(word[0]) && number_length(word) == word.size()) {
        report(Code::BadNumber, begin, end,
               "this number is too large or too small for single precision")
            .help("write 0, a number from 1.2e-38 to 3.4e38, or `inf` where there is no limit");
        return;
    }
    const Tok before =
        words_.tokens.size() > 1 ? words_.tokens[words_.tokens.size() - 2].kind : Tok::End;
    if (const auto told = told_names_.find(word); told != told_names_.end()) { // `2nd`, once more
        Diagnostic *first = diagnostics_.find(Code::BadNumber, told->second.first);
        constexpr std::size_t most_edits = 40;
        if (first && first->fix && ++told->second.uses < most_edits)
            first->fix->edits.push_back({span(begin, end), first->fix->edits[0].replacement});
        return;
    }
    if (is_one_of(before, {Tok::Let, Tok::Var, Tok::Fn, Tok::Param})) {
        told_names_.try_emplace(word, ToldName{span(begin, end)});
        const std::size_t digits = number_length(word);
        const std::string name =
            std::string(word.substr(digits)) + std::string(word.substr(0, digits));
        report(Code::BadNumber, begin, end, "a name begins with a letter")
            .help("write " + quoted_code(name), {{span(begin, end), name}});
        return;
    }
    const char left = begin > 0 ? source_.text[begin - 1] : ' ';
    const bool component =
        word[0] == '.' && (is_digit(left) || std::isalpha(static_cast<unsigned char>(left)) ||
                           left == '_' || left == ')' || left == ']');
    BadNumber bad = component ? BadNumber{"a component is a name or an index", "write an index",
                                          "[" + std::string(word.substr(1)) + "]"}
                              : explain_bad_number(word, is_named(word));
    Diagnostic &d = report(Code::BadNumber, begin, end, std::move(bad.message));
    if (!bad.help.empty())
        d.help(std::move(bad.help), {{span(begin, end), std::move(bad.replacement)}});
}

void Lexer::string(std::uint32_t begin, std::uint32_t end) {
    add(Tok::String, begin, end);
    const std::string_view text = slice(begin, end);
    for (std::uint32_t i = 0; i < text.size();) {
        const CodePoint c = decode_utf8(text, i);
        if (!c.valid)
            report(Code::BadCharacter, begin + i, begin + i + 1, "this byte is not UTF-8");
        if (c.value == '\\' &&
            std::string_view("nt\\\"").find(text[i + 1]) == std::string_view::npos)
            report(Code::SyntaxError, begin + i, begin + i + 1 + decode_utf8(text, i + 1).length,
                   "a string has no such escape")
                .help("the escapes are `\\n`, `\\t`, `\\\\` and `\\\"`");
        i += c.length + (c.value == '\\' ? 1 : 0);
    }
}

// What no rule of the words reads: a `#`, a string between typographic quotes. Its end, or 0.
std::uint32_t Lexer::by_hand(std::uint32_t begin) {
    const char first = source_.text[begin];
    if (const std::uint32_t end = name_with_letters(begin); end > 0) return end;
    if (first == '\xE2') return smart_string(begin);
    if (first != '#') return 0;
    std::size_t end = begin + 1;
    while (end < source_.text.size() && is_word_char(source_.text[end])) ++end;
    return hash(begin, static_cast<std::uint32_t>(end));
}

// A string between typographic quotes on its line: its end, or 0.
std::uint32_t Lexer::smart_string(std::uint32_t begin) {
    constexpr std::string_view opening[] = {"\xE2\x80\x9C", "\xE2\x80\x9E", "\xE2\x80\x98",
                                            "\xE2\x80\x9D"};
    constexpr std::string_view closing[] = {"\xE2\x80\x9D", "\xE2\x80\x9C", "\xE2\x80\x99"};
    const std::string_view all = source_.text;
    const auto begins = [&](std::string_view sign) { return all.substr(begin).starts_with(sign); };
    if (std::ranges::none_of(opening, begins)) return 0;
    const std::size_t inside = begin + opening[0].size(), line = all.find('\n', begin);
    std::size_t end = all.npos;
    for (const std::string_view sign : closing) end = std::min(end, all.find(sign, inside));
    end = std::min(end, all.find('"', inside));
    if (end == all.npos || end > line) return 0;
    const auto past = static_cast<std::uint32_t>(end + (all[end] == '"' ? 1 : 3));
    const std::string text(all.substr(inside, end - inside));
    add(Tok::Bad, begin, past);
    foreign(begin, past, "a string stands in straight double quotes", "\"" + text + "\"");
    return past;
}

void Lexer::unclosed_string(std::uint32_t begin, std::uint32_t end) {
    add(Tok::Bad, begin, end);
    if (begin > 0 && is_digit(source_.text[begin - 1])) { // inches
        report(Code::BadNumber, begin, begin + 1,
               "a length has no unit: all of a scene are in the same")
            .help("leave the `\"` away", {{span(begin, begin + 1), ""}});
        return;
    }
    const std::string_view rest = slice(begin + 1, end);
    const std::size_t last = rest.find_last_not_of(")];,{ \t\r");
    Diagnostic &d =
        report(Code::UnclosedBracket, begin, begin + 1, "this string is not closed on its line");
    if (last == rest.npos || rest.find_first_of("()") <= last) {
        d.help("close it with `\"`");
        return;
    }
    const auto at = static_cast<std::uint32_t>(begin + 2 + last);
    d.help("close it with `\"`", {{span(at, at), "\""}});
}

void Lexer::quoted(std::uint32_t begin, std::uint32_t end) {
    add(Tok::String, begin, end);
    const std::string joined =
        source_.text[begin] == '`' ? joined_string(slice(begin, end), "${") : std::string();
    if (!joined.empty()) {
        foreign(begin, end, "a string holds no values", joined);
        return;
    }
    if (source_.text[begin] == '`' && slice(begin, end).find("${") != std::string_view::npos) {
        report(Code::ForeignSyntax, begin, end, "a string holds no values")
            .help("join it to them: `\"r = \" + r`");
        return;
    }
    foreign(begin, end, "a string stands in double quotes",
            "\"" + std::string(slice(begin + 1, end - 1)) + "\"");
}

namespace {

struct Sign {
    std::string_view text;
    Tok kind;
    std::string_view message, replacement; // of a sign that another language has
};

constexpr Sign long_signs[] = {
    {"..=", Tok::DotDotEqual, "", ""},
    {"===", Tok::EqualEqual, "equality is one pair of signs", "=="},
    {"!==", Tok::NotEqual, "inequality is one pair of signs", "!="},
    {"..<", Tok::DotDot, "a range `a..b` already leaves out its end", ".."},
    {"->", Tok::Arrow, "", ""},
    {"=>", Tok::FatArrow, "", ""},
    {"..", Tok::DotDot, "", ""},
    {"==", Tok::EqualEqual, "", ""},
    {"!=", Tok::NotEqual, "", ""},
    {"<=", Tok::LessEqual, "", ""},
    {">=", Tok::GreaterEqual, "", ""},
    {"<>", Tok::NotEqual, "inequality is written `!=`", "!="},
    {"~=", Tok::NotEqual, "inequality is written `!=`", "!="},
    {"?.", Tok::Dot, "there is no `?.`: every name has a value", "."},
    {"&&", Tok::And, "the logical and is a word", "and"},
    {"||", Tok::Or, "the logical or is a word", "or"},
    {"**", Tok::Caret, "a power is written `^`", "^"},
    {"+=", Tok::PlusAssign, "", ""},
    {"-=", Tok::MinusAssign, "", ""},
    {"*=", Tok::StarAssign, "", ""},
    {"/=", Tok::SlashAssign, "", ""},
    {"%=", Tok::OtherAssign, "", ""},
    {"^=", Tok::OtherAssign, "", ""},
    {"|=", Tok::OtherAssign, "", ""},
    {"&=", Tok::OtherAssign, "", ""},
    {"++", Tok::PlusPlus, "", ""},
    {"--", Tok::MinusMinus, "", ""}};

} // namespace

void Lexer::sign(std::uint32_t begin, std::uint32_t end) {
    const std::string_view text = slice(begin, end);
    if (text == "!") {
        const bool behind_operand = !words_.tokens.empty() && words_.tokens.back().end == begin &&
                                    words_.tokens.back().kind == Tok::Name;
        if (behind_operand) {
            add(Tok::Bad, begin, end);
            report(Code::ForeignSyntax, begin, end, "the language does not use `!`");
            return;
        }
        const Tok last = words_.tokens.empty() ? Tok::End : words_.tokens.back().kind;
        const bool fresh = words_.tokens.empty() || fresh_line_ ||
                           is_one_of(last, {Tok::End, Tok::Body, Tok::BraceClose});
        const bool begins = is_one_of(
            last, {Tok::End, Tok::Body, Tok::BraceClose, Tok::Name, Tok::Number, Tok::ListClose});
        const char next = end < source_.text.size() ? source_.text[end] : ' ';
        if (((fresh && begins) || last == Tok::Close) && is_word_char(next))
            return shown_alone(begin, end); // OpenSCAD's `!cube(1)`
        add(Tok::Not, begin, end);
        foreign(begin, end, "the logical not is a word", "not ");
        return;
    }
    if (text == "...") {
        const Tok before = words_.tokens.empty() ? Tok::End : words_.tokens.back().kind;
        add(Tok::DotDot, begin, end);
        if (is_one_of(before, {Tok::Name, Tok::Number, Tok::Close, Tok::ListClose}))
            report(Code::ForeignSyntax, begin, end, "a range is written with two points")
                .help("write `..` for a range without its end, `..=` for one with it");
        return;
    }
    if (text.size() == 1) return add(static_cast<Tok>(text[0]), begin, end);
    for (const Sign &sign : long_signs) {
        if (sign.text != text) continue;
        add(sign.kind, begin, end);
        if (sign.message.empty()) return;
        report(Code::ForeignSyntax, begin, end, std::string(sign.message))
            .help("write " + quoted_code(sign.replacement),
                  {{span(begin, end), set_apart(begin, end, sign.replacement)}});
        return;
    }
}

// What OpenSCAD keeps in names of its own.
static bool is_special(std::string_view name) {
    constexpr std::array<std::string_view, 9> special = {"fn",  "fa",  "fs",  "t",      "vpr",
                                                         "vpt", "vpd", "vpf", "preview"};
    return std::find(special.begin(), special.end(), name) != special.end() || name == "children";
}

void Lexer::strange(std::uint32_t begin, std::uint32_t end) {
    if (begin == 0 && slice(begin, end) == "\xEF\xBB\xBF") return; // a byte order mark
    CodePoint first = decode_utf8(source_.text, begin);
    while (first.valid && first.value >= 0x80 && begin + first.length < end && // `⌈⌊`, one by one
           (strange_sign(begin, begin + first.length, first.value) ||
            sign_of_mathematics(begin, begin + first.length))) {
        begin += first.length;
        first = decode_utf8(source_.text, begin);
    }
    if (first.valid && begin + first.length == end && strange_sign(begin, end, first.value)) return;
    const std::string_view text = slice(begin, end);
    if (first.valid && invisible_sign(begin, end, first.value)) return;
    if (text == "\xCF\x80") { // π
        add(Tok::Bad, begin, end);
        report(Code::BadCharacter, begin, end, "names use the letters a to z")
            .help("write `pi`", {{span(begin, end), "pi"}});
        return;
    }
    if (sign_of_mathematics(begin, end)) return;
    if (text == "\xC2\xA0") { // a no-break space
        report(Code::BadCharacter, begin, end, "this is a no-break space")
            .help("write an ordinary space", {{span(begin, end), " "}});
        return;
    }
    if (text == "@" && !fresh_line_ && !words_.tokens.empty() &&
        is_one_of(words_.tokens.back().kind, {Tok::Name, Tok::Close, Tok::ListClose})) {
        add(Tok::Star, begin, end);
        foreign(begin, end, "a product of matrices and vectors is written `*`", "*");
        return;
    }
    if (text == "$t") { // OpenSCAD's
        add(Tok::Bad, begin, end);
        foreign(begin, end, "the seconds are `time`", "time");
        return;
    }
    if (text[0] == '$' && text.size() > 1 && !is_special(text.substr(1))) {
        add(Tok::Name, begin + 1, end);
        foreign(begin, end, "a name has no `$` before it", std::string(text.substr(1)));
        return;
    }
    const std::string_view rest = std::string_view(source_.text).substr(end);
    if (text == "\\" && without_end(rest.substr(0, rest.find('\n'))).empty()) {
        report(Code::BadCharacter, begin, end, "a line that ends in an operator goes on by itself")
            .help("leave the `\\` away", {{span(begin, end), ""}});
        return;
    }
    if (text == "$preview") { // which has one way to be drawn here
        add(Tok::False, begin, end);
        foreign(begin, end, "a scene is the same where it is looked at and where it is drawn",
                "false");
        return;
    }
    if (text == "$children") {
        add(Tok::Bad, begin, end);
        report(Code::BadCharacter, begin, end, "the language does not use `$`")
            .help("the shapes that a function is given are a parameter, `parts: [shape]`: their "
                  "number is `len(parts)`",
                  {{span(begin, end), "len(parts)"}});
        return;
    }
    add(Tok::Bad, begin, end);
    if (!first.valid) {
        report(Code::BadCharacter, begin, end, "this is not UTF-8 text");
    } else if (first.value == 0x201C || first.value == 0x201D || first.value == 0x2018 ||
               first.value == 0x2019) {
        report(Code::BadCharacter, begin, end, "a string stands in straight double quotes")
            .help("write `\"`");
    } else if (first.value >= 0x80) {
        report(Code::BadCharacter, begin, end,
               "names use the letters a to z, A to Z, digits and `_`")
            .note("comments and strings may hold any letters");
    } else if (text[0] == '\\') {
        report(Code::BadCharacter, begin, end, "the language does not use `\\`")
            .help("a function without a name is written `p => …`");
    } else if (text[0] == '$') {
        const std::optional<Span> all = assignment_from(begin, end);
        const Faces faces = all ? faces_of(*all) : Faces::None;
        Diagnostic &d = report(Code::BadCharacter, begin, end, "the language does not use `$`");
        if (faces == Faces::HandedOn)
            d.note("all is round here: what few sides make of a cylinder or a circle is lost")
                .help("leave it away; where sides are meant, write `prism(6, radius, height)` or "
                      "`regular_polygon(6, radius)` in its place",
                      {{*all, ""}});
        else
            d.note("names are plain words; smoothness needs no `$fn`, a distance field has no "
                   "facets");
        if (all && faces == Faces::None) d.help("leave it away", {{*all, ""}});
    } else if (text[0] == '\'') {
        report(Code::BadCharacter, begin, end, "the language does not use `'`")
            .help("a string stands in double quotes, a comment begins with `//`");
    } else if (text[0] == '@' && mark_of_wgsl(begin, end)) {
    } else if (text[0] == '@') {
        report(Code::BadCharacter, begin, end, "the language does not use " + quoted_code(text))
            .help(text == "@param"
                      ? "a parameter is declared by `param r = 1 in 0..2`"
                      : "leave it away: what stands here is neither marked nor decorated");
    } else if (text[0] == '~') {
        Diagnostic &d = report(Code::BadCharacter, begin, end, "the language does not use `~`")
                            .note("there are no operators on bits; the logical not is `not`");
        const std::size_t count = words_.tokens.size();             // the sign itself is the last
        if (count > 1 && words_.tokens[count - 2].kind == Tok::Amp) // `a & ~b`
            d.help("what is in `a` and not in the shape `b` is `a - b`",
                   {{span(words_.tokens[count - 2].begin, begin + 1), "- "}});
    } else {
        report(Code::BadCharacter, begin, end,
               first.value < 0x20 ? "a control character stands here"
                                  : "the language does not use " + quoted_code(text));
    }
}

Vocabulary vocabulary() {
    Vocabulary all{{}, {"as", "limit"}, {}, {"deg", "rad", "turn"}, {}};
    for (const Keyword &keyword : keyword_table) all.keywords.push_back(keyword.text);
    for (std::string_view name : type_names())
        if (name[0] != '_') all.types.push_back(name);
    all.signs.assign(std::begin(sign_table), std::end(sign_table));
    return all;
}

} // namespace fathom::lang
