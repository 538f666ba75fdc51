// What a `#` begins: a colour of ours, a comment of Python's, a line of C's preprocessor.
#include "lang/lexer.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace fathom::lang {

namespace {

constexpr std::array<std::string_view, 6> needless = {"version", "extension", "pragma",
                                                      "line",    "undef",     "precision"};

bool is_word(std::string_view text) {
    return !text.empty() && std::ranges::all_of(text, is_word_char) && !is_digit(text[0]);
}

// Whether a line of the text defines the name, also by our `let`.
bool defines(std::string_view text, const std::string &name) {
    for (const std::string &line : {"#define " + name, "let " + name})
        for (std::size_t at = text.find(line); at != text.npos; at = text.find(line, at + 1)) {
            const std::size_t past = at + line.size();
            if (past == text.size() || !is_word_char(text[past])) return true;
        }
    return false;
}

} // namespace

// `#define N 3` is read as `let N = 3`, `#define F(x) …` as `fn F(x) = …`: the end of what stands
// before the value, or 0 where the line is no such thing.
std::uint32_t ForeignWords::define(std::uint32_t begin, std::uint32_t end) {
    const std::string_view all = source_.text;
    const std::size_t size = all.size();
    const auto skip = [&](std::size_t i) {
        return std::min(all.find_first_not_of(" \t", i), size);
    };
    const auto word_end = [&](std::size_t i) {
        while (i < size && is_word_char(all[i])) ++i;
        return i;
    };
    const std::size_t name = skip(end), name_end = word_end(name);
    if (name_end == name || is_digit(all[name])) return 0;
    std::vector<Span> parameters;
    std::size_t head_end = name_end;
    const bool function = name_end < size && all[name_end] == '(';
    if (function) {
        for (std::size_t i = name_end + 1;;) {
            i = skip(i);
            const std::size_t past = word_end(i);
            if (past == i || is_digit(all[i])) return 0;
            parameters.push_back(span(std::uint32_t(i), std::uint32_t(past)));
            i = skip(past);
            if (i == size || (all[i] != ',' && all[i] != ')')) return 0;
            head_end = i + 1;
            if (all[i++] == ')') break;
        }
    }
    const std::size_t value = skip(head_end), line_end = std::min(all.find('\n', begin), size);
    if (value >= line_end || all[value] == '\r' || all[value] == '/' || all[line_end - 1] == '\\')
        return 0;
    const auto at = [](std::size_t i) { return static_cast<std::uint32_t>(i); };
    const std::string head(all.substr(name, head_end - name)), word = function ? "fn" : "let";
    report(Code::ForeignSyntax, begin, end,
           function ? "there is no preprocessor; a function is declared with `fn`"
                    : "there is no preprocessor; a name is bound with `let`")
        .help("write `" + word + " " + head + " = …`",
              {{span(begin, end), word}, {span(at(head_end), at(head_end)), " ="}});
    add(function ? Tok::Fn : Tok::Let, begin, end);
    add(Tok::Name, at(name), at(name_end));
    if (function) {
        add(Tok::Open, at(name_end), at(name_end + 1));
        for (const Span &p : parameters) {
            if (p.begin != parameters[0].begin) add(Tok::Comma, p.begin, p.begin);
            add(Tok::Name, p.begin, p.end);
        }
        add(Tok::Close, at(head_end - 1), at(head_end));
    }
    add(Tok::Assign, at(head_end), at(head_end));
    return at(head_end);
}

// At `#if`: the edits that leave its lines away, and what they leave out, where that is known by a
// number or by whether the text defines a name.
std::vector<Edit> ForeignWords::chosen_lines(std::uint32_t begin) const {
    if (!may_look_far()) return {};
    const std::string_view all = source_.text;
    const auto line_end = [&](std::size_t at) { return std::min(all.find('\n', at), all.size()); };
    const auto word_at = [&](std::size_t at) { // `# if`, too
        std::size_t from = all.find_first_not_of(" \t", at + 1), past = from;
        while (past < all.size() && is_word_char(all[past])) ++past;
        return all.substr(std::min(from, all.size()), past - from);
    };
    const auto argument = [&](std::size_t at) {
        const std::string_view line = all.substr(at, line_end(at) - at);
        const std::size_t from = line.find(word_at(at)) + word_at(at).size();
        const std::size_t first = line.find_first_not_of(" \t", from);
        return first == std::string_view::npos
                   ? std::string_view()
                   : line.substr(first, line.find_first_of(" \t\r/", first) - first);
    };
    const std::string name(argument(begin));
    const std::string_view word = word_at(begin);
    bool holds = false;
    if (word == "if" && (name == "0" || name == "1"))
        holds = name == "1";
    else if ((word == "ifdef" || word == "ifndef") && !name.empty())
        holds = defines(all.substr(0, begin), name) == (word == "ifdef");
    else
        return {};
    std::size_t other = 0;
    int depth = 1;
    for (std::size_t at = line_end(begin); at < all.size(); at = line_end(at + 1)) {
        const std::size_t first = all.find_first_not_of(" \t", at + 1);
        if (first == std::string_view::npos || all[first] != '#') continue;
        const std::string_view what = word_at(first);
        if (what == "if" || what == "ifdef" || what == "ifndef") ++depth;
        if (what == "elif" && depth == 1) return {};
        if (what == "else" && depth == 1) other = first;
        if (what != "endif" || --depth > 0) continue;
        const auto cut = [&](std::size_t from, std::size_t to) {
            return Edit{span(static_cast<std::uint32_t>(from), static_cast<std::uint32_t>(to)), ""};
        };
        const std::size_t past = line_end(first);
        if (holds) return {cut(begin, line_end(begin)), cut(other > 0 ? other : first, past)};
        if (other == 0) return {cut(begin, past)};
        return {cut(begin, line_end(other)), cut(first, past)};
    }
    return {};
}

// `#version`, `#include`, `#ifdef`: the line is theirs.
void ForeignWords::directive(std::uint32_t begin, std::uint32_t end, std::uint32_t line_end) {
    const std::string_view word = slice(begin + 1, end);
    const bool begins = word == "if" || word == "ifdef" || word == "ifndef";
    const bool goes_on = word == "else" || word == "elif" || word == "endif";
    if (goes_on && open_choices_ > 0) { // told where it begins
        if (word == "endif") --open_choices_;
        return;
    }
    Diagnostic &d = report(Code::ForeignSyntax, begin, end, "there is no preprocessor");
    std::string_view rest = slice(end, line_end);
    rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
    const std::size_t quote = rest.size() > 1 ? rest.find('"', 1) : rest.npos;
    if (begins) {
        ++open_choices_;
        d.help("what is left away and what is not, is chosen by `if`: "
               "`let fancy = true`, and then `if fancy { … } else { … }`",
               chosen_lines(begin));
    } else if (word == "include" && rest.starts_with('"') && quote != rest.npos) {
        const std::string import = "import " + std::string(rest.substr(0, quote + 1));
        d.help("write `" + import + "`", {{span(begin, line_end), import}});
    } else if (word == "include" && rest.starts_with('<')) {
        d.help("the library needs no import: leave the line away", {{span(begin, line_end), ""}});
    } else if (word == "include" || word == "import") {
        d.help("another file is brought in by `import \"file.sdf\"`");
    } else if (word == "define" && is_word(rest)) {
        d.help("write `let " + std::string(rest) + " = true`",
               {{span(begin, line_end), "let " + std::string(rest) + " = true"}});
    } else if (word == "define") {
        d.help("a value is bound by `let name = …`, a function by `fn name(x) = …`");
    } else if (std::find(needless.begin(), needless.end(), word) != needless.end()) {
        d.help("leave the line away", {{span(begin, line_end), ""}});
    } else {
        d.help("a comment begins with `//`", {{span(begin, begin + 1), "// "}});
    }
}

// Whether `[0 0 1]` stands there, which libfive has a `#` before: numbers or names without commas.
bool ForeignWords::lisp_vector(std::uint32_t begin) const {
    const std::string_view rest = std::string_view(source_.text).substr(begin);
    const std::size_t close = std::min(rest.find(']'), rest.size());
    if (!rest.starts_with('[') || close == rest.size()) return false;
    const std::string_view inside = rest.substr(1, close - 1);
    return inside.find(' ') != inside.npos && std::all_of(inside.begin(), inside.end(), [](char c) {
               return is_word_char(c) ||
                      std::string_view(" .+-*/()").find(c) != std::string_view::npos;
           });
}

} // namespace fathom::lang
