// Kinds of words, and the answers to words of other languages.
#include "lang/lexer.h"

#include "lang/ast.h"
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

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_hex(char c) { return is_digit(c) || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F'); }

unsigned hex_value(char c) {
    return static_cast<unsigned>(is_digit(c) ? c - '0' : (c | 0x20) - 'a' + 10);
}

std::string quoted_code(std::string_view text) { return "`" + std::string(text) + "`"; }

// A word that begins like a number but is none: why, and what was meant where that is plain.
struct BadNumber {
    std::string message, help, replacement;
};

std::size_t number_length(std::string_view word) {
    std::size_t i = 0;
    const auto digits = [&] {
        const std::size_t start = i;
        while (i < word.size() && is_digit(word[i])) ++i;
        return i > start;
    };
    digits();
    if (i + 1 < word.size() && word[i] == '.' && is_digit(word[i + 1])) ++i, digits();
    if (i < word.size() && (word[i] == 'e' || word[i] == 'E')) {
        const std::size_t mantissa = i++;
        if (i < word.size() && (word[i] == '+' || word[i] == '-')) ++i;
        if (!digits()) i = mantissa;
    }
    return i;
}

BadNumber explain_bad_number(std::string_view word) {
    const std::string whole(word);
    if (word[0] == '.')
        return {"a number does not begin with a point", "write the zero before the point",
                "0" + whole};
    const std::size_t length = number_length(word);
    const std::string number(word.substr(0, length));
    const std::string_view rest = word.substr(length);
    if (rest == ".")
        return {"a number does not end with a point",
                "leave the point away, or write a digit after it",
                number.find('.') == std::string::npos ? number + ".0" : number};
    if (rest == "f" || rest == "F" || rest == ".f" || rest == "u" || rest == "U")
        return {"a number has no suffix " + quoted_code(rest), "leave it away", number};
    if ((rest[0] == 'x' || rest[0] == 'X') && number == "0" && rest.size() > 1 &&
        std::all_of(rest.begin() + 1, rest.end(), is_hex) && rest.size() < 9) {
        std::uint64_t value = 0;
        for (const char c : rest.substr(1)) value = value << 4 | hex_value(c);
        return {"numbers are written in decimal", "write the value", fmt::to_string(value)};
    }
    if (rest[0] == '_' &&
        std::all_of(rest.begin(), rest.end(), [](char c) { return is_digit(c) || c == '_'; })) {
        std::string digits = whole;
        std::erase(digits, '_');
        return {"the digits of a number stand together", "leave the underscores away", digits};
    }
    if (rest == "e" || rest == "E") return {"an exponent needs digits after the `e`", "", ""};
    if (rest == "°" || rest == "degrees" || rest == "degree")
        return {"the unit of degrees is `deg`", "write `deg`", number + "deg"};
    return {"a name cannot follow a number directly", "to multiply, write `*`",
            number + " * " + std::string(rest)};
}

} // namespace

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
    if (number.unit == "deg")
        number.value *= std::numbers::pi / 180;
    else if (number.unit == "turn")
        number.value *= 2 * std::numbers::pi;
    else if (number.unit != "rad")
        return std::nullopt;
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

void Lexer::add(Tok kind, std::uint32_t begin, std::uint32_t end) {
    words_.tokens.push_back({kind, fresh_line_, begin, end});
    fresh_line_ = false;
}

Diagnostic &Lexer::foreign(std::uint32_t begin, std::uint32_t end, std::string message,
                           std::string replacement) {
    std::string_view shown = replacement;
    if (shown.ends_with(' ')) shown.remove_suffix(1);
    std::string help = "write " + quoted_code(shown);
    return report(Code::ForeignSyntax, begin, end, std::move(message))
        .help(std::move(help), {{span(begin, end), std::move(replacement)}});
}

void Lexer::line_comment(std::uint32_t begin, std::uint32_t end) {
    if (end > begin && source_.text[end - 1] == '\r') --end;
    words_.comments.push_back({begin, end, true});
    // Python's `a //= 2`: a comment would swallow it in silence.
    const std::string_view text = slice(begin, end);
    const bool after_name = !fresh_line_ && words_.tokens.back().kind == Tok::Name;
    if (after_name && text.starts_with("//= ") && text.size() > 4)
        report(Code::ForeignSyntax, begin, begin + 3, "`//` begins a comment")
            .help("whole division is `a = div(a, b)`");
}

void Lexer::block_comment(std::uint32_t begin, std::uint32_t end) {
    words_.comments.push_back({begin, end, false});
    if (slice(begin, end).find('\n') != std::string_view::npos) fresh_line_ = true;
}

void Lexer::unclosed_comment(std::uint32_t begin, std::uint32_t end) {
    words_.comments.push_back({begin, end, false});
    report(Code::UnclosedBracket, begin, begin + 2, "this comment is never closed")
        .help("close it with `*/`; comments do not nest");
}

void Lexer::word(std::uint32_t begin, std::uint32_t end) {
    const std::string_view text = slice(begin, end);
    Tok kind = Tok::Name;
    if (text.size() <= 6 && text[0] >= 'a' && text[0] <= 'w')
        for (const Keyword &keyword : keyword_table)
            if (keyword.text == text) kind = keyword.kind;
    add(kind, begin, end);
}

void Lexer::number(std::uint32_t begin, std::uint32_t end) {
    const std::string_view word = slice(begin, end);
    const std::optional<NumberWord> number = read_number(word);
    const bool held =
        number && fits_single(number->value) && (number->value == 0 || flushed(number->value) != 0);
    if (held) return add(Tok::Number, begin, end);
    add(Tok::Bad, begin, end);
    if (is_digit(word[0]) && number_length(word) == word.size()) {
        report(Code::BadNumber, begin, end,
               "this number is too large or too small for single precision")
            .help("write 0, a number from 1.2e-38 to 3.4e38, or `inf` where there is no limit");
        return;
    }
    const char left = begin > 0 ? source_.text[begin - 1] : ' ';
    const bool component =
        word[0] == '.' && (is_digit(left) || std::isalpha(static_cast<unsigned char>(left)) ||
                           left == '_' || left == ')' || left == ']');
    BadNumber bad = component ? BadNumber{"a component is a name or an index", "write an index",
                                          "[" + std::string(word.substr(1)) + "]"}
                              : explain_bad_number(word);
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

void Lexer::unclosed_string(std::uint32_t begin, std::uint32_t end) {
    add(Tok::Bad, begin, end);
    report(Code::UnclosedBracket, begin, begin + 1, "this string is not closed on its line")
        .help("close it with `\"`");
}

void Lexer::quoted(std::uint32_t begin, std::uint32_t end) {
    add(Tok::String, begin, end);
    foreign(begin, end, "a string stands in double quotes",
            "\"" + std::string(slice(begin + 1, end - 1)) + "\"");
}

// The end of the name behind `#define`, where a value follows on its line; else 0.
std::uint32_t Lexer::defined_name(std::uint32_t from) const {
    const std::string_view all = source_.text;
    const auto is_word = [](char c) {
        return c == '_' || std::isalnum(static_cast<unsigned char>(c));
    };
    const std::size_t begin = std::min(all.find_first_not_of(" \t", from), all.size());
    std::size_t end = begin;
    while (end < all.size() && is_word(all[end])) ++end;
    const std::size_t value = std::min(all.find_first_not_of(" \t", end), all.size());
    const bool good = end > begin && !is_digit(all[begin]) && value > end && value < all.size() &&
                      all[value] != '\n' && all[value] != '\r' && all[value] != '/';
    return good ? static_cast<std::uint32_t>(end) : 0;
}

// `#define N 3` is read as `let N = 3`.
std::uint32_t Lexer::define(std::uint32_t begin, std::uint32_t end, std::uint32_t name_end) {
    const auto name = static_cast<std::uint32_t>(source_.text.find_first_not_of(" \t", end));
    report(Code::ForeignSyntax, begin, end, "there is no preprocessor; a name is bound with `let`")
        .help("write `let " + std::string(slice(name, name_end)) + " = …`",
              {{span(begin, end), "let"}, {span(name_end, name_end), " ="}});
    add(Tok::Let, begin, end);
    add(Tok::Name, name, name_end);
    add(Tok::Assign, name_end, name_end);
    return name_end;
}

std::uint32_t Lexer::hash(std::uint32_t begin, std::uint32_t end) {
    const std::string_view digits = slice(begin + 1, end);
    const bool all_hex = std::all_of(digits.begin(), digits.end(), is_hex);
    if (all_hex && (digits.size() == 3 || digits.size() == 6 || digits.size() == 8)) {
        add(Tok::Color, begin, end);
        return end;
    }
    // `# remark` of Python, and `#version`, `#include`: the rest of the line is theirs.
    if (digits.empty() || (fresh_line_ && !all_hex)) {
        const std::size_t line_end = std::min(source_.text.find('\n', begin), source_.text.size());
        if (end < source_.text.size() && source_.text[end] == '(') { // OpenSCAD's modifier
            report(Code::ForeignSyntax, begin, begin + 1, "there are no modifiers of shapes")
                .help("leave it away", {{span(begin, begin + 1), ""}});
            return begin + 1;
        }
        if (const auto name_end = defined_name(end); digits == "define" && name_end > 0)
            return define(begin, end, name_end);
        Diagnostic &d =
            report(Code::ForeignSyntax, begin, digits.empty() ? begin + 1 : end,
                   digits.empty() ? "a comment begins with `//`" : "there is no preprocessor");
        if (digits.empty())
            d.help("write `//`", {{span(begin, begin + 1), "//"}});
        else if (digits == "define")
            d.help("a value is bound by `let name = …`, a function by `fn name(x) = …`");
        else
            d.help(
                "other files are brought in by `import \"file.sdf\"`; a comment begins with `//`");
        return static_cast<std::uint32_t>(line_end);
    }
    add(Tok::Bad, begin, end);
    Diagnostic &d =
        report(Code::BadColor, begin, end, "a colour takes 3, 6 or 8 hex digits after the `#`");
    if (all_hex)
        d.note(fmt::format("here are {}", digits.size()));
    else
        d.note("hex digits are 0 to 9 and a to f");
    return end;
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
        add(Tok::Not, begin, end);
        foreign(begin, end, "the logical not is a word", "not ");
        return;
    }
    if (text.size() == 1) return add(static_cast<Tok>(text[0]), begin, end);
    for (const Sign &sign : long_signs) {
        if (sign.text != text) continue;
        add(sign.kind, begin, end);
        if (!sign.message.empty())
            foreign(begin, end, std::string(sign.message), std::string(sign.replacement));
        return;
    }
}

// Signs that typography, other keyboards and mathematics put in the place of ours.
bool Lexer::strange_sign(std::uint32_t begin, std::uint32_t end, std::uint32_t c) {
    struct Twin {
        std::uint32_t code_point;
        Tok kind;
        std::string_view ours;
    };
    static constexpr Twin twins[] = {
        {0x2212, Tok::Minus, "-"},         {0x2013, Tok::Minus, "-"},
        {0x2014, Tok::Minus, "-"},         {0x00D7, Tok::Star, "*"},
        {0x22C5, Tok::Star, "*"},          {0x00B7, Tok::Star, "*"},
        {0x00F7, Tok::Slash, "/"},         {0x2264, Tok::LessEqual, "<="},
        {0x2265, Tok::GreaterEqual, ">="}, {0x2260, Tok::NotEqual, "!="},
        {0x2192, Tok::Arrow, "->"},        {0x21D2, Tok::FatArrow, "=>"},
        {0x222A, Tok::Bar, "|"},           {0x2229, Tok::Amp, "&"},
        {0xFF08, Tok::Open, "("},          {0xFF09, Tok::Close, ")"},
        {0xFF0C, Tok::Comma, ","},         {0x2026, Tok::DotDot, ".."}};
    for (const Twin &twin : twins) {
        if (twin.code_point != c) continue;
        add(twin.kind, begin, end);
        report(Code::BadCharacter, begin, end, "this sign is not one of the language's")
            .help("write " + quoted_code(twin.ours), {{span(begin, end), std::string(twin.ours)}});
        return true;
    }
    return false;
}

// `$fn = 64;`, and `, $fn = 64` among arguments: all of it. Nothing where no `=` follows.
std::optional<Span> Lexer::assignment_from(std::uint32_t begin, std::uint32_t end) const {
    const std::string_view all = source_.text;
    const std::size_t sign = std::min(all.find_first_not_of(' ', end), all.size());
    if (sign == all.size() || all[sign] != '=') return std::nullopt;
    std::size_t last = std::min(all.find_first_of(";\n,)", sign), all.size()), first = begin;
    const char behind = last < all.size() ? all[last] : '\n';
    const std::size_t before = begin > 0 ? all.find_last_not_of(' ', begin - 1) : all.npos;
    const bool after_comma = before != all.npos && all[before] == ',';
    if ((behind == ',' || behind == ')') && after_comma)
        first = before;
    else if (behind == ';' || behind == ',')
        last = std::min(all.find_first_not_of(' ', last + 1), all.size());
    return span(static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last));
}

void Lexer::strange(std::uint32_t begin, std::uint32_t end) {
    if (begin == 0 && slice(begin, end) == "\xEF\xBB\xBF") return; // a byte order mark
    const CodePoint first = decode_utf8(source_.text, begin);
    if (first.valid && begin + first.length == end && strange_sign(begin, end, first.value)) return;
    const std::string_view text = slice(begin, end);
    if (text == "\xCF\x80") { // π
        add(Tok::Bad, begin, end);
        report(Code::BadCharacter, begin, end, "names use the letters a to z")
            .help("write `pi`", {{span(begin, end), "pi"}});
        return;
    }
    if (text == "\xC2\xA0") { // a no-break space
        report(Code::BadCharacter, begin, end, "this is a no-break space")
            .help("write an ordinary space", {{span(begin, end), " "}});
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
        report(Code::BadCharacter, begin, end, "names use the letters a to z, digits and `_`")
            .note("comments and strings may hold any letters");
    } else if (text[0] == '\\') {
        report(Code::BadCharacter, begin, end, "the language does not use `\\`")
            .help("a function without a name is written `p => …`");
    } else if (text[0] == '$') {
        Diagnostic &d =
            report(Code::BadCharacter, begin, end, "the language does not use `$`")
                .note("names are plain words; smoothness needs no `$fn`, a distance field has no "
                      "facets");
        if (const std::optional<Span> all = assignment_from(begin, end))
            d.help("leave it away", {{*all, ""}});
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
