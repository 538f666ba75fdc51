// Functions without a name as other languages write them, read as ours: `function(p) { … }`,
// `lambda x, y: …`, `fun x -> …`, `\x -> …`, `|x| …`, `[](float x) { … }`. The words are put right
// before layout, so that all behind them is read and only the one mistake is told.
#include "lang/foreign/word_changes.h"

#include <array>

namespace fathom::lang {

namespace {

constexpr std::array<std::string_view, 3> lambda_words = {"function", "func", "fun"};

bool is_operand_place(Tok before) {
    return is_one_of(before, {Tok::Assign, Tok::Open, Tok::ListOpen, Tok::Comma, Tok::Return,
                              Tok::FatArrow, Tok::Colon});
}

bool begins_body(Tok kind) {
    return is_one_of(kind, {Tok::Name, Tok::Number, Tok::String, Tok::Color, Tok::True, Tok::False,
                            Tok::If, Tok::Not});
}

class Lambdas : WordChanges {
  public:
    using WordChanges::WordChanges;

    // Empty where there are none.
    std::vector<Token> run() {
        for (std::size_t i = 0; i < words_.size(); ++i) {
            const bool found = by_word(i) || by_backslash(i) || by_bars(i) || by_arrow(i) ||
                               by_list_and_arrow(i) || by_captures(i);
            if (!found && changed_) out_.push_back(words_[i]);
        }
        return std::move(out_);
    }

  private:
    // The bracket that closes the one at `i`, of those of its kind; 0 where there is none.
    std::size_t head_close(std::size_t i) const {
        const Tok open = kind(i), close = open == Tok::Open ? Tok::Close : Tok::ListClose;
        int depth = 0;
        constexpr std::size_t longest_head = 400; // words
        for (std::size_t k = i; k < words_.size() && k < i + longest_head; ++k) {
            if (kind(k) == open) ++depth;
            if (kind(k) == close && --depth == 0) return k;
            if (is_one_of(kind(k), {Tok::Body, Tok::BraceClose, Tok::End})) return 0;
        }
        return 0;
    }

    // `head` is what is written here for [begin, end); the words of `parameters` stay as they are.
    void say(std::uint32_t begin, std::uint32_t end, const std::string &head, Span at) {
        diagnostics_.add(Code::ForeignSyntax, at, "a function without a name is written `p => …`")
            .help("write `" + head + " …`", {{span(begin, end), head}});
    }

    // Parameters in parentheses, which stay: what stands before them goes, `=>` comes behind.
    // `past` is the word at which the body begins.
    void in_parentheses(std::size_t first, std::size_t open, std::size_t close, std::size_t past,
                        std::size_t &i) {
        begin_change(first);
        const std::uint32_t end = words_[close].end;
        const std::string head = text(words_[open].begin, end) + " =>";
        const bool arrow = past > close + 1; // one of theirs is replaced
        const std::uint32_t until = arrow ? words_[past - 1].end : end;
        diagnostics_
            .add(Code::ForeignSyntax, span(words_[first].begin, words_[open - 1].end),
                 "a function without a name is written `p => …`")
            .help("write `" + head + " …`",
                  {{span(words_[first].begin, words_[open].begin), ""}, {span(end, until), " =>"}});
        for (std::size_t k = open; k <= close; ++k) out_.push_back(words_[k]);
        out_[out_.size() - (close - open + 1)].first_on_line = words_[first].first_on_line;
        put(Tok::FatArrow, until, until);
        i = past - 1;
    }

    // Names in a row, from `first` to before `past`: `x`, or `(x, y)`.
    void in_a_row(std::size_t head, std::size_t first, std::size_t past, Span sign, std::size_t &i,
                  std::size_t next) {
        begin_change(head);
        std::vector<std::size_t> names;
        for (std::size_t k = first; k < past; ++k)
            if (kind(k) == Tok::Name) names.push_back(k);
        const bool fresh = words_[head].first_on_line;
        const std::uint32_t begin = words_[head].begin;
        std::string written;
        if (names.size() == 1) {
            written = text(names[0]);
            put(Tok::Name, words_[names[0]].begin, words_[names[0]].end, fresh);
        } else {
            put(Tok::Open, begin, begin, fresh);
            for (const std::size_t k : names) {
                if (k != names[0]) put(Tok::Comma, words_[k].begin, words_[k].begin);
                put(Tok::Name, words_[k].begin, words_[k].end);
                written += (k == names[0] ? "(" : ", ") + std::string(text(k));
            }
            written += ")";
            const std::uint32_t end = words_[past - 1].end;
            put(Tok::Close, end, end);
        }
        const std::uint32_t end = words_[next - 1].end;
        put(Tok::FatArrow, end, end);
        say(begin, end, written + " =>", sign);
        i = next - 1;
    }

    // Rust's `f: fn(float) -> float`: the word goes, and what is behind it is a type of ours.
    bool type_of_function(std::size_t i) {
        if (kind(i) != Tok::Fn || !is_one_of(before(i), {Tok::Colon, Tok::Arrow}) ||
            kind(i + 1) != Tok::Open)
            return false;
        const std::size_t close = head_close(i + 1);
        if (close == 0 || kind(close + 1) != Tok::Arrow) return false;
        for (std::size_t k = i + 2; k < close; ++k)
            if (kind(k) == Tok::Name && !is_type_word(text(k))) return false;
        begin_change(i);
        const Span at = span(words_[i].begin, words_[i].end);
        diagnostics_.add(Code::ForeignSyntax, at, "a function's type is written `(float) -> float`")
            .help("leave `fn` away", {{at, ""}});
        return true;
    }

    // `function(p) { … }`, `function(x) x * x`, `fn(p) => …`; `lambda x, y: …`; `fun x y -> …`.
    bool by_word(std::size_t &i) {
        const bool ours = kind(i) == Tok::Fn;
        if (!ours && kind(i) != Tok::Name) return false;
        const std::string_view word = text(i);
        const Span at = span(words_[i].begin, words_[i].end);
        if (type_of_function(i)) return true;
        if (!is_operand_place(before(i))) return false;
        if (word == "lambda" && kind(i + 1) == Tok::Colon && before(i) == Tok::Assign) {
            begin_change(i);
            const std::uint32_t end = words_[i + 1].end;
            put(Tok::Open, at.begin, at.begin, words_[i].first_on_line);
            put(Tok::Close, at.begin, at.begin);
            put(Tok::FatArrow, end, end);
            say(at.begin, end, "() =>", at);
            ++i;
            return true;
        }
        if (word == "lambda" && kind(i + 1) == Tok::Name) {
            std::size_t k = i + 2;
            while (kind(k) == Tok::Comma && kind(k + 1) == Tok::Name) k += 2;
            if (kind(k) != Tok::Colon) return false;
            in_a_row(i, i + 1, k, at, i, k + 1);
            return true;
        }
        if (!ours &&
            std::find(lambda_words.begin(), lambda_words.end(), word) == lambda_words.end())
            return false;
        if (kind(i + 1) == Tok::Name) {
            std::size_t k = i + 2;
            while (kind(k) == Tok::Name) ++k;
            if (kind(k) != Tok::Arrow && kind(k) != Tok::FatArrow) return false;
            in_a_row(i, i + 1, k, at, i, k + 1);
            return true;
        }
        if (kind(i + 1) != Tok::Open) return false;
        const std::size_t close = head_close(i + 1);
        if (close == 0) return false;
        const Tok body = kind(close + 1);
        const bool sign =
            body == Tok::FatArrow || body == Tok::Arrow || (ours && body == Tok::Assign);
        if (!sign && body != Tok::Body && !begins_body(body)) return false;
        if (!ours && may_be_declared(word)) return false;
        in_parentheses(i, i + 1, close, close + (sign ? 2 : 1), i);
        return true;
    }

    // `\x -> …`, `\x y -> …`: the lexer has reported the sign.
    bool by_backslash(std::size_t &i) {
        if (kind(i) != Tok::Bad || text(i)[0] != '\\') return false;
        std::size_t k = i + 1;
        while (kind(k) == Tok::Name) ++k;
        if (kind(k) != Tok::Arrow && kind(k) != Tok::FatArrow) return false;
        const std::uint32_t begin = words_[i].begin, name_end = words_[i].end;
        if (name_end == begin + 1 && k == i + 1) return false;
        diagnostics_.withdraw(Code::BadCharacter, span(begin, name_end));
        begin_change(i);
        std::vector<Span> names;
        if (name_end > begin + 1) names.push_back(span(begin + 1, name_end));
        for (std::size_t n = i + 1; n < k; ++n)
            names.push_back(span(words_[n].begin, words_[n].end));
        const bool row = names.size() > 1;
        std::string written = row ? "(" : "";
        if (row) put(Tok::Open, begin, begin, words_[i].first_on_line);
        for (const Span &name : names) {
            if (written.size() > 1) {
                put(Tok::Comma, name.begin, name.begin);
                written += ", ";
            }
            put(Tok::Name, name.begin, name.end, !row && words_[i].first_on_line);
            written += text(name.begin, name.end);
        }
        const std::uint32_t past = names.back().end, end = words_[k].end;
        if (row) put(Tok::Close, past, past), written += ")";
        put(Tok::FatArrow, end, end);
        say(begin, end, written + " =>", span(begin, name_end));
        i = k;
        return true;
    }

    // Whether behind this bar an expression goes on or ends, as in `|p| - 1`: an amount. A sign that
    // touches only what is behind it begins a body: `|x| -x`, `|x| *x`.
    bool no_body_follows(std::size_t bar) const {
        const std::size_t next = bar + 1;
        const bool prefix = is_one_of(kind(next), {Tok::Minus, Tok::Star}) &&
                            touch(next, next + 1) && !touch(bar, next);
        return !prefix &&
               is_one_of(kind(next), {Tok::Minus, Tok::Plus, Tok::Star, Tok::Slash, Tok::Caret,
                                      Tok::Less, Tok::Greater, Tok::Close, Tok::Comma, Tok::End});
    }

    // `|x, y| …`, where no operator can stand.
    bool by_bars(std::size_t &i) {
        if (kind(i) != Tok::Bar || !is_operand_place(before(i)) || words_[i].first_on_line)
            return false;
        std::size_t k = i + 1;
        while (kind(k) == Tok::Name) {
            ++k;
            if (kind(k) == Tok::Colon && kind(k + 1) == Tok::Name) k += 2;
            if (kind(k) != Tok::Comma) break;
            ++k;
        }
        if (kind(k) != Tok::Bar || k == i + 1 || no_body_follows(k)) return false;
        begin_change(i);
        const std::uint32_t begin = words_[i].begin, end = words_[k].end;
        const std::string inside = text(words_[i].end, words_[k].begin);
        const bool one = k == i + 2;
        put(Tok::Open, begin, begin);
        for (std::size_t n = i + 1; n < k; ++n) out_.push_back(words_[n]);
        put(Tok::Close, end, end);
        put(Tok::FatArrow, end, end);
        say(begin, end, (one ? inside : "(" + inside + ")") + " =>", span(begin, end));
        i = k;
        return true;
    }

    // Java's `(x, y) -> …`, where no type can stand.
    bool by_list_and_arrow(std::size_t &i) {
        if (kind(i) != Tok::Open || !is_one_of(before(i), {Tok::Assign, Tok::Return})) return false;
        const std::size_t close = head_close(i);
        if (close == 0 || kind(close + 1) != Tok::Arrow) return false;
        begin_change(i);
        for (std::size_t k = i; k <= close; ++k) out_.push_back(words_[k]);
        const Token &arrow = words_[close + 1];
        put(Tok::FatArrow, arrow.end, arrow.end);
        diagnostics_
            .add(Code::ForeignSyntax, span(arrow.begin, arrow.end),
                 "a function without a name is written with `=>`")
            .help("write `=>`", {{span(arrow.begin, arrow.end), "=>"}});
        i = close + 1;
        return true;
    }

    // `x -> …`. Where nothing parts the three, it may be a part of `x`.
    bool by_arrow(std::size_t &i) {
        if (kind(i) != Tok::Name || kind(i + 1) != Tok::Arrow || before(i) == Tok::Colon ||
            !is_operand_place(before(i)) || words_[i].end == words_[i + 1].begin)
            return false;
        begin_change(i);
        const Token &arrow = words_[i + 1];
        out_.push_back(words_[i]);
        put(Tok::FatArrow, arrow.end, arrow.end);
        diagnostics_
            .add(Code::ForeignSyntax, span(arrow.begin, arrow.end),
                 "a function without a name is written with `=>`")
            .help("write `=>`", {{span(arrow.begin, arrow.end), "=>"}});
        ++i;
        return true;
    }

    // C++'s `[](float x) { … }`, `[&](…) -> float { … }`.
    bool by_captures(std::size_t &i) {
        if (kind(i) != Tok::ListOpen || !is_operand_place(before(i))) return false;
        const bool sign = kind(i + 1) == Tok::Amp || kind(i + 1) == Tok::Assign;
        const std::size_t open = i + (sign ? 3 : 2);
        if (kind(open - 1) != Tok::ListClose || kind(open) != Tok::Open) return false;
        const std::size_t close = head_close(open);
        if (close == 0) return false;
        std::size_t past = close + 1;
        if (kind(past) == Tok::Arrow && kind(past + 1) == Tok::Name) past += 2;
        bool typed = false; // `float x`: no call of ours
        for (std::size_t k = open + 1; k + 1 < close; ++k)
            typed = typed || (kind(k) == Tok::Name && kind(k + 1) == Tok::Name);
        if (kind(past) != Tok::Body || !typed) return false;
        in_parentheses(i, open, close, past, i);
        return true;
    }
};

} // namespace

std::vector<Token> read_foreign_lambdas(const Source &source, SourceId id,
                                        const std::vector<Token> &words, Diagnostics &diagnostics) {
    return Lambdas(source, id, words, diagnostics).run();
}

} // namespace fathom::lang
