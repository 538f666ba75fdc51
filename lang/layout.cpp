// From words to the tokens of the grammar: which line ends end a statement, which bracket closes
// which, and what each `(` and `{` is for. After this, line ends, comments and unbalanced brackets
// are no concern of the grammar's. Knows nothing of expressions.
#include "lang/foreign/foreign.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

namespace fathom::lang {

namespace {

// What still waits for its `{` at one level of brackets.
enum class Header { None, If, Else, For, While, Fn };

struct Level {
    Tok bracket = Tok::Body; // Open, ListOpen, Body; of the file, Body
    std::uint32_t index = 0; // of the opening token
    Header waits = Header::None;
    bool never_closed = false;
};

// A statement goes on behind these at a line's end.
bool continues_after(Tok kind) {
    return is_one_of(kind, {Tok::Comma,       Tok::Colon,      Tok::Dot,          Tok::Assign,
                            Tok::Bar,         Tok::Amp,        Tok::Less,         Tok::Greater,
                            Tok::Plus,        Tok::Minus,      Tok::Star,         Tok::Slash,
                            Tok::Percent,     Tok::Caret,      Tok::Question,     Tok::Arrow,
                            Tok::FatArrow,    Tok::DotDot,     Tok::DotDotEqual,  Tok::EqualEqual,
                            Tok::NotEqual,    Tok::LessEqual,  Tok::GreaterEqual, Tok::PlusAssign,
                            Tok::MinusAssign, Tok::StarAssign, Tok::SlashAssign,  Tok::OtherAssign,
                            Tok::And,         Tok::Or,         Tok::Not,          Tok::In,
                            Tok::Else});
}

// These end an operand, so that a `{` behind them belongs to it.
bool takes_block(Tok kind) { return kind == Tok::Name || kind == Tok::Close; }

// Operators that cannot begin a statement, nor continue one from the next line.
bool belongs_to_line_above(Tok kind) {
    return continues_after(kind) && kind != Tok::Minus && kind != Tok::Not && kind != Tok::Comma &&
           kind != Tok::Colon && kind != Tok::In && kind != Tok::Question;
}

bool begins_declaration(Tok kind) {
    return is_one_of(kind, {Tok::Let, Tok::Var, Tok::Fn, Tok::Param, Tok::Import, Tok::While,
                            Tok::Return, Tok::Break});
}

Tok closer_of(Tok bracket) {
    return bracket == Tok::Open       ? Tok::Close
           : bracket == Tok::ListOpen ? Tok::ListClose
                                      : Tok::BraceClose;
}

// A line that begins with one of these begins something new, were it not inside brackets.
bool begins_anew(Tok kind) {
    return is_one_of(kind, {Tok::Name, Tok::For, Tok::If, Tok::Number}) || begins_declaration(kind);
}

// Which opening brackets no closing one belongs to, by the same rules as Layout::close.
std::vector<bool> never_closed(const std::vector<Token> &words) {
    std::vector<bool> unclosed(words.size(), false);
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const Tok kind = words[i].kind;
        if (kind == Tok::Open || kind == Tok::ListOpen || kind == Tok::Body) open.push_back(i);
        if (kind != Tok::Close && kind != Tok::ListClose && kind != Tok::BraceClose) continue;
        const auto found = std::find_if(open.rbegin(), open.rend(), [&](std::size_t o) {
            return closer_of(words[o].kind) == kind;
        });
        if (found == open.rend()) continue;
        for (auto o = open.rbegin(); o != found; ++o) unclosed[*o] = true;
        open.erase(found.base() - 1, open.end());
    }
    for (const std::size_t o : open) unclosed[o] = true;
    return unclosed;
}

class Layout {
  public:
    Layout(const Source &source, SourceId id, const Words &words, Diagnostics &diagnostics)
        : source_(source), id_(id), words_(words.tokens), diagnostics_(diagnostics) {
        out_.tokens.reserve(words_.size() + words_.size() / 4);
        out_.match.reserve(words_.size() + words_.size() / 4);
        levels_.push_back({});
        never_closed_ = never_closed(words_);
    }

    Tokens run() {
        for (std::size_t i = 0; i < words_.size(); ++i) place(i);
        if (levels_.size() > 1) {
            const Level &level = suspect_ ? *suspect_ : levels_.back();
            report_unclosed(level, suspect_ ? nullptr : left_of(level));
            while (levels_.size() > 1) close_missing();
        }
        out_.kinds.reserve(out_.tokens.size());
        for (const Token &t : out_.tokens) out_.kinds.push_back(static_cast<char>(t.kind));
        return std::move(out_);
    }

  private:
    Level &level() { return levels_.back(); }
    bool lines_count() { return level().bracket == Tok::Body; }
    Tok previous() const { return out_.tokens.empty() ? Tok::End : out_.tokens.back().kind; }
    std::uint32_t previous_end() const { return out_.tokens.empty() ? 0 : out_.tokens.back().end; }
    Span span(const Token &t) const { return {id_, t.begin, t.end}; }
    Span after_previous() const { return {id_, previous_end(), previous_end()}; }

    void put(Token token, Tok kind) {
        token.kind = kind;
        out_.match.push_back(static_cast<std::uint32_t>(out_.tokens.size()));
        out_.tokens.push_back(token);
    }
    void put_virtual(Tok kind) { put({kind, false, previous_end(), previous_end()}, kind); }
    void end_statement() {
        put_virtual(Tok::End);
        level().waits = Header::None;
    }

    void place(std::size_t i);
    void line_begins(const Token &t);
    void open(const Token &t, std::size_t i);
    void close(const Token &t, std::size_t i);
    void close_missing();
    void report_unclosed(const Level &open, const Token *instead);
    Edit closing_edit(const Level &open, const Token *instead) const;
    bool else_if_of_other_languages(const Token &t);
    bool ends_with_callee() const;
    bool transform_waits(const Token &t);
    bool has_function(std::string_view name);
    Tok brace_kind();

    std::uint32_t indent_of(const Token &t) const {
        const auto line = position(source_, t.begin).line;
        const std::string_view text = line_text(source_, line);
        return static_cast<std::uint32_t>(std::min(text.find_first_not_of(" \t"), text.size()));
    }

    // The first line behind an opening bracket that stands no further in than its own, after some
    // that do: where its writer thought that it had ended.
    const Token *left_of(const Level &open) const {
        const std::uint32_t margin = indent_of(out_.tokens[open.index]);
        bool inside = false;
        for (std::size_t i = open.index + 1; i < out_.tokens.size(); ++i) {
            const Token &t = out_.tokens[i];
            if (!t.first_on_line || t.begin == t.end) continue;
            const bool deeper = indent_of(t) > margin;
            if (!deeper) return inside ? &t : nullptr;
            inside = true;
        }
        return nullptr;
    }

    const Source &source_;
    SourceId id_;
    const std::vector<Token> &words_;
    Diagnostics &diagnostics_;
    Tokens out_;
    std::vector<Level> levels_;
    std::vector<bool> never_closed_;                           // of the words
    std::unordered_map<std::string_view, bool> own_functions_; // of the names that were asked for
    std::optional<Level> suspect_; // the first `{` whose `}` stands further left than its line
};

// Whether the line above is `name` or `name(…)`, perhaps behind a `=`: what a block may belong to.
bool Layout::ends_with_callee() const {
    std::size_t callee = out_.tokens.size() - 1;
    if (out_.tokens[callee].kind == Tok::Close && out_.match[callee] > 0)
        callee = out_.match[callee] - 1;
    if (out_.tokens[callee].kind != Tok::Name) return false;
    const Tok before = callee == 0 ? Tok::End : out_.tokens[callee - 1].kind;
    return before == Tok::End || before == Tok::Assign || before == Tok::Body ||
           before == Tok::Trailing;
}

void Layout::report_unclosed(const Level &open, const Token *instead) {
    const Token &token = out_.tokens[open.index];
    for (std::size_t i = open.index + 1; i < out_.tokens.size(); ++i) {
        const Token &inside = out_.tokens[i];
        if (inside.first_on_line) break;
        // a string that is not closed on the line, which was told, holds what would have closed it
        if (inside.kind == Tok::Bad && text_of(source_, inside)[0] == '"') return;
    }
    const std::string sign(text_of(source_, token));
    Diagnostic &d =
        diagnostics_.add(Code::UnclosedBracket, span(token), "this `" + sign + "` is never closed");
    const std::string closer(1, static_cast<char>(closer_of(open.bracket)));
    if (instead) d.label(span(*instead), "`" + closer + "` is wanted before this");
    if (open.bracket != Tok::Body || !suspect_)
        d.help("write `" + closer + "`", {closing_edit(open, instead)});
    const std::string_view rest = std::string_view(source_.text).substr(token.end);
    const std::string_view line = rest.substr(0, rest.find('\n'));
    if (const std::size_t comment = line.find("//");
        comment != std::string_view::npos && line.find(closer, comment) != std::string_view::npos)
        d.note("`//` begins a comment; a division without its rest is `div(a, b)`");
}

// What closes a bracket before `instead`, or at the text's end; with all around it there.
Edit Layout::closing_edit(const Level &open, const Token *instead) const {
    const auto margin = [&](const Level &l) {
        const Token &t = out_.tokens[l.index];
        const std::string_view line = line_text(source_, position(source_, t.begin).line);
        return std::string(line.substr(0, indent_of(t)));
    };
    const auto edit = [&](std::uint32_t at, std::string closers) {
        return Edit{{id_, at, at}, std::move(closers)};
    };
    const auto closer = [](const Level &l) { return std::string(1, char(closer_of(l.bracket))); };
    const Token *const first = out_.tokens.data();
    const bool placed = instead && instead > first && instead < first + out_.tokens.size();
    const std::uint32_t end = placed ? (instead - 1)->end : previous_end();
    if (open.bracket != Tok::Body) return edit(end, closer(open));
    if (instead && !placed) return edit(end, " }");
    if (instead) return edit(end, "\n" + margin(open) + "}");
    std::size_t below = open.index + 1; // the first line behind it
    while (below < out_.tokens.size() && !out_.tokens[below].first_on_line) ++below;
    const bool on_line = below > open.index + 1;
    if (on_line && below < out_.tokens.size() &&
        indent_of(out_.tokens[below]) <= indent_of(out_.tokens[open.index]))
        return edit(out_.tokens[below - 1].end, " }");
    std::string closers;
    for (std::size_t l = levels_.size(); l-- > 1;)
        closers += levels_[l].bracket != Tok::Body          ? closer(levels_[l])
                   : on_line && below >= out_.tokens.size() ? " }"
                                                            : "\n" + margin(levels_[l]) + "}";
    return edit(end, closers);
}

void Layout::close_missing() {
    const Level open = level();
    levels_.pop_back();
    put_virtual(closer_of(open.bracket));
    out_.match.back() = open.index;
    out_.match[open.index] = static_cast<std::uint32_t>(out_.tokens.size() - 1);
}

void Layout::line_begins(const Token &t) {
    // A declaration cannot stand inside parentheses: one of them was forgotten.
    if (!lines_count() && begins_declaration(t.kind)) {
        report_unclosed(level(), &t);
        while (!lines_count()) close_missing();
    }
    // Inside a bracket that is never closed, the line end behind a whole operand is where it should
    // have been.
    while (!lines_count() && level().never_closed && begins_anew(t.kind) &&
           !continues_after(previous()) && out_.tokens.size() - 1 > level().index) {
        report_unclosed(level(), &t);
        close_missing();
    }
    if (!lines_count() || out_.tokens.empty() || out_.tokens.back().kind == Tok::End) return;
    if (begins_declaration(t.kind)) return end_statement(); // it is no operand
    const Tok last = previous();
    const std::size_t before = out_.tokens.size();
    if (last == Tok::Star && before > 1 && out_.tokens[before - 2].kind == Tok::Import)
        return end_statement(); // Python's `from … import *`
    if (last == Tok::Body || last == Tok::Trailing || last == Tok::StrayBrace ||
        continues_after(last))
        return;
    const std::string_view sign = text_of(source_, t);
    if (t.kind == Tok::Else || sign[0] == '.' || sign[0] == '|' || sign[0] == '&') {
        const bool range = t.kind == Tok::DotDot || t.kind == Tok::DotDotEqual;
        if (!range && t.kind != Tok::Number && t.kind != Tok::OtherAssign) return;
    }
    if (t.kind == Tok::Body) {
        if (level().waits == Header::None && !ends_with_callee()) return end_statement();
        const std::uint32_t end = previous_end();
        diagnostics_
            .add(Code::ForeignSyntax, span(t), "the `{` stands on the line of what it belongs to")
            .help("move it to the end of the line above", {{{id_, end, t.end}, " {"}});
        return;
    }
    if (sign == "%" && t.end < source_.text.size() && source_.text[t.end] >= 'a' &&
        source_.text[t.end] <= 'z') // OpenSCAD's `%sphere(2)`: told by the grammar
        return end_statement();
    if (belongs_to_line_above(t.kind)) {
        const std::string op(sign);
        std::uint32_t rest = t.end;
        while (rest < source_.text.size() &&
               (source_.text[rest] == ' ' || source_.text[rest] == '\t'))
            ++rest;
        diagnostics_.add(Code::LineContinues, span(t), "a line cannot begin with `" + op + "`")
            .help("move the `" + op + "` to the end of the line above",
                  {{after_previous(), " " + op}, {{id_, t.begin, rest}, ""}});
        return;
    }
    if (transform_waits(t)) return; // OpenSCAD's: told by the grammar
    end_statement();
}

// Whether the line above is a transform of OpenSCAD without its shape, as `translate([0, 0, 1])`,
// and this line stands further in, or is a call.
bool Layout::transform_waits(const Token &t) {
    const std::size_t close = out_.tokens.size() - 1;
    if (t.kind != Tok::Name || out_.tokens[close].kind != Tok::Close) return false;
    const std::size_t open = out_.match[close];
    if (open == 0) return false;
    const Token &name = out_.tokens[open - 1];
    const std::string_view named = text_of(source_, name);
    const bool only_theirs = named == "rotate_extrude" || named == "linear_extrude";
    if (open + 1 >= close && !only_theirs) return false; // `revolve()`
    const Tok first = out_.tokens[open + 1].kind;
    const bool method = open > 1 && out_.tokens[open - 2].kind == Tok::Dot; // ours
    const bool theirs = is_one_of(first, {Tok::ListOpen, Tok::Number, Tok::String, Tok::Minus}) ||
                        (first == Tok::Name && out_.tokens[open + 2].kind == Tok::Assign);
    if (name.kind != Tok::Name || !(theirs || only_theirs) || method ||
        !is_foreign_transform(named))
        return false;
    if (indent_of(t) != indent_of(name)) return indent_of(t) > indent_of(name);
    // on a line of its own above a call: nothing of the library has no shape
    return name.first_on_line && source_.text[t.end] == '(' &&
           !has_function(text_of(source_, name));
}

// Whether the text has a function of its own with that name.
bool Layout::has_function(std::string_view name) {
    const auto [it, fresh] = own_functions_.try_emplace(name, false);
    for (std::size_t i = 0; fresh && i + 1 < words_.size(); ++i)
        it->second = it->second || (is_one_of(words_[i].kind, {Tok::Fn, Tok::Let}) &&
                                    text_of(source_, words_[i + 1]) == name);
    return it->second;
}

Tok Layout::brace_kind() {
    if (previous() == Tok::FatArrow) return Tok::Body;
    if (level().waits != Header::None) {
        level().waits = Header::None;
        return Tok::Body;
    }
    return takes_block(previous()) ? Tok::Trailing : Tok::StrayBrace;
}

void Layout::open(const Token &t, std::size_t i) {
    Tok kind = t.kind;
    Tok bracket = t.kind;
    if (kind == Tok::Body)
        kind = brace_kind();
    else if (t.first_on_line)
        kind = kind == Tok::Open ? Tok::FreshOpen : Tok::FreshListOpen;
    put(t, kind);
    levels_.push_back({bracket, static_cast<std::uint32_t>(out_.tokens.size() - 1), Header::None,
                       never_closed_[i]});
}

void Layout::close(const Token &t, std::size_t i) {
    const auto matches = [&](const Level &l) { return closer_of(l.bracket) == t.kind; };
    const auto found = std::find_if(levels_.rbegin(), levels_.rend() - 1, matches);
    if (found == levels_.rend() - 1) {
        const std::string sign(text_of(source_, t));
        diagnostics_.add(Code::SyntaxError, span(t), "this `" + sign + "` closes nothing")
            .help("remove it", {{span(t), ""}});
        if (continues_after(previous())) put(t, Tok::Bad);
        return;
    }
    if (found != levels_.rbegin()) {
        report_unclosed(level(), &t);
        while (!matches(level())) close_missing();
    }
    const std::uint32_t opener = level().index;
    if (t.kind == Tok::BraceClose && t.first_on_line && !suspect_ &&
        indent_of(t) < indent_of(out_.tokens[opener]))
        suspect_ = level();
    levels_.pop_back();
    put(t, t.kind);
    out_.match.back() = opener;
    out_.match[opener] = static_cast<std::uint32_t>(out_.tokens.size() - 1);

    // `( … ) =>` is a lambda's head, unless it stands behind a callee.
    if (t.kind != Tok::Close || i + 1 >= words_.size() || words_[i + 1].kind != Tok::FatArrow)
        return;
    const Tok before = opener ? out_.tokens[opener - 1].kind : Tok::End;
    const bool callee = before == Tok::Name || before == Tok::Close || before == Tok::ListClose;
    if (!callee || out_.tokens[opener].first_on_line) out_.tokens[opener].kind = Tok::LambdaOpen;
}

bool Layout::else_if_of_other_languages(const Token &t) {
    const std::string_view text = text_of(source_, t);
    if (previous() != Tok::BraceClose || (text != "elif" && text != "elseif" && text != "elsif"))
        return false;
    diagnostics_.add(Code::ForeignSyntax, span(t), "this is written in two words")
        .help("write `else if`", {{span(t), "else if"}});
    put(t, Tok::Else);
    put(t, Tok::If);
    level().waits = Header::If;
    return true;
}

void Layout::place(std::size_t i) {
    const Token &t = words_[i];
    if (t.kind == Tok::Name && else_if_of_other_languages(t)) return;
    if (t.first_on_line) line_begins(t);
    if (is_one_of(t.kind, {Tok::Open, Tok::ListOpen, Tok::Body})) return open(t, i);
    if (is_one_of(t.kind, {Tok::Close, Tok::ListClose, Tok::BraceClose})) return close(t, i);
    if (t.kind == Tok::If) level().waits = Header::If;
    if (t.kind == Tok::Else) level().waits = Header::Else;
    if (t.kind == Tok::For) level().waits = Header::For;
    if (t.kind == Tok::While) level().waits = Header::While;
    if (t.kind == Tok::Fn) level().waits = Header::Fn;
    if (t.kind == Tok::End) level().waits = Header::None;
    if (t.kind == Tok::Assign && level().waits == Header::Fn) level().waits = Header::None;
    const std::size_t n = out_.tokens.size();
    // `s: shape<1>= a`: comparisons do not chain, so that this is a type's end and a `=`.
    if (t.kind == Tok::GreaterEqual && n >= 3 && previous() == Tok::Number &&
        out_.tokens[n - 2].kind == Tok::Less && out_.tokens[n - 3].kind == Tok::Name) {
        put({Tok::Greater, false, t.begin, t.begin + 1}, Tok::Greater);
        return put({Tok::Assign, false, t.begin + 1, t.end}, Tok::Assign);
    }
    if (t.kind == Tok::Name) {
        const bool lambda = i + 1 < words_.size() && words_[i + 1].kind == Tok::FatArrow;
        const bool condition = level().waits == Header::If || level().waits == Header::While;
        if (lambda && !condition) return put(t, Tok::LambdaName);
        const std::string_view text = text_of(source_, t);
        const Tok last = previous();
        const bool after_operand = !continues_after(last) && last != Tok::While && last != Tok::End;
        if (level().waits == Header::While && after_operand && text == "limit")
            return put(t, Tok::Limit);
        if (text == "as" && n >= 2 && out_.tokens[n - 2].kind == Tok::Import)
            return put(t, Tok::As);
    }
    // `if n => 3 {`: a condition is no function
    if (t.kind == Tok::FatArrow && previous() == Tok::Name &&
        (level().waits == Header::If || level().waits == Header::While)) {
        diagnostics_.add(Code::ForeignSyntax, span(t), "this comparison is written `>=`")
            .help("write `>=`", {{span(t), ">="}});
        return put(t, Tok::GreaterEqual);
    }
    put(t, t.kind);
}

} // namespace

Tokens lay_out(const Source &source, SourceId id, const Words &words, Diagnostics &diagnostics) {
    Words ours;
    const auto latest = [&]() -> const std::vector<Token> & {
        return ours.tokens.empty() ? words.tokens : ours.tokens;
    };
    for (const auto pass : {read_foreign_blocks, read_foreign_casts, read_foreign_forms,
                            read_foreign_matches, read_foreign_lambdas})
        if (std::vector<Token> changed = pass(source, id, latest(), diagnostics); !changed.empty())
            ours.tokens = std::move(changed);
    return Layout(source, id, ours.tokens.empty() ? words : ours, diagnostics).run();
}

} // namespace fathom::lang
