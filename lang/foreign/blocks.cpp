// Whole statements of other languages that are told in one report, as OpenSCAD's
// `intersection_for (n = [1 : 6]) { … }`, Curv's `make_shape { … }` and libfive's `(set-bounds! …)`,
// and brackets that are missing behind a first argument. The words are put right before layout.
#include "lang/foreign/word_changes.h"

#include <array>

namespace fathom::lang {

namespace {

constexpr std::size_t longest_head = 200, longest_body = 4000; // words

class Blocks : WordChanges {
  public:
    using WordChanges::WordChanges;

    // Empty where there are none.
    std::vector<Token> run() {
        for (std::size_t i = 0; i < words_.size(); ++i) {
            const std::size_t from = i;
            if (!by_intersection(i) && !by_make_shape(i) && !by_setting(i) && !by_with(i) &&
                !by_array(i) && !by_colon_and_assign(i) && !by_number_and_dot(i) && changed_)
                out_.push_back(words_[i]);
            for (; !ends_.empty() && ends_.back() >= from && ends_.back() <= i; ends_.pop_back())
                put(Tok::BraceClose, words_[i].end, words_[i].end);
        }
        return std::move(out_);
    }

  private:
    Diagnostic &say(Span place, std::string message) {
        return diagnostics_.add(Code::ForeignSyntax, place, std::move(message));
    }

    // The last word of a statement without braces that begins at `i`.
    std::size_t end_of_statement(std::size_t i) const {
        std::size_t last = i;
        for (std::size_t k = i; k < words_.size() && k < i + longest_body; ++k) {
            if (kind(k) == Tok::End || kind(k) == Tok::BraceClose ||
                (k > i && words_[k].first_on_line))
                break;
            const bool opens = is_one_of(kind(k), {Tok::Open, Tok::ListOpen, Tok::Body});
            if (const std::size_t close = opens ? close_of(k, longest_body) : 0; close > k)
                k = close;
            last = k;
        }
        return last;
    }

    // `intersection_for (n = [1 : 6]) …`, read as the loop that it is.
    bool by_intersection(std::size_t i) {
        if (!is(i, "intersection_for") || kind(i + 1) != Tok::Open || may_be_declared(text(i)))
            return false;
        const std::size_t close = close_of(i + 1, longest_head);
        if (close == 0 || close + 1 >= words_.size()) return false;
        begin_change(i);
        const std::uint32_t loop = words_[i].end - 3; // its `for`
        put(Tok::For, loop, words_[i].end, words_[i].first_on_line);
        const std::size_t last = kind(close + 1) == Tok::Body ? close_of(close + 1, longest_body)
                                                              : end_of_statement(close + 1);
        Diagnostic &d = say(words(i, i), "what all turns of a loop have in common is an "
                                         "`intersection` with the loop in its block");
        const bool moved = i > 0 && kind(i - 1) == Tok::Close; // told with what moves it
        if (last == 0 || moved) {
            d.help("write `intersection { for i in 0..n { … } }`");
            return true;
        }
        const std::uint32_t past = words_[last].end;
        d.help("write `intersection { for … { … } }`",
               {{span(words_[i].begin, loop), "intersection { "}, {span(past, past), " }"}});
        return true;
    }

    // Curv's `make_shape { dist … = …; … }`.
    bool by_make_shape(std::size_t &i) {
        if (!is(i, "make_shape") || kind(i + 1) != Tok::Body || may_be_declared(text(i)))
            return false;
        const std::size_t close = close_of(i + 1, longest_body);
        if (close == 0) return false;
        begin_change(i);
        put(Tok::Bad, words_[i].begin, words_[close].end, words_[i].first_on_line);
        say(words(i, i), "a shape is made of a function of the point, and of nothing else")
            .help("write `implicit(p => length(p) - 1)`, with the distance at the point `p`");
        i = close;
        return true;
    }

    // libfive's `(set-bounds! [-1 -1 -1] [1 1 1])`.
    bool by_setting(std::size_t &i) {
        constexpr std::array<std::string_view, 3> settings = {"bounds", "quality", "resolution"};
        if (kind(i) != Tok::Open || !fresh(i) || !is(i + 1, "set") || kind(i + 2) != Tok::Minus ||
            kind(i + 3) != Tok::Name || !is_one_of(text(i + 3), settings))
            return false;
        const std::size_t close = close_of(i, longest_head);
        if (close < i + 4) return false;
        diagnostics_.withdraw(Code::ForeignSyntax, words(i + 4, i + 4)); // of the `!`
        begin_change(i);
        const std::uint32_t begin = words_[i].begin, end = words_[close].end;
        say(words(i, i + 3), "a scene sets no bounds and no resolution: its shapes have them")
            .help("leave it away", {{span(begin, end), ""}});
        i = close;
        return true;
    }

    std::size_t column(std::size_t i) const {
        const std::uint32_t begin = words_[i].begin;
        const std::size_t line =
            begin == 0 ? source_.text.npos : source_.text.rfind('\n', begin - 1);
        return begin - (line == source_.text.npos ? 0 : line + 1);
    }

    // Python's `with union():`, as build123d and its like have it: the block that it is.
    bool by_with(std::size_t &i) {
        if (!is(i, "with") || !fresh(i) || kind(i + 1) != Tok::Name || kind(i + 2) != Tok::Open ||
            is_foreign_transform(text(i + 1)))
            return false;
        const std::size_t close = close_of(i + 2, longest_head);
        std::size_t colon = close + 1;
        if (is(colon, "as") || kind(colon) == Tok::As) colon += 2;
        if (close == 0 || kind(colon) != Tok::Colon) return false;
        std::size_t last = colon;
        while (last + 1 < words_.size() && last <= colon + longest_body &&
               (!words_[last + 1].first_on_line || column(last + 1) > column(i)))
            ++last;
        if (last == colon || last > colon + longest_body) return false;
        const bool empty = close == i + 3;
        const std::uint32_t past = words_[last].end,
                            head = empty ? words_[i + 1].end : words_[close].end;
        const std::string margin(column(i), ' ');
        begin_change(i);
        say(words(i, colon), "a block stands in braces, directly behind the function's name")
            .help("write `" + text(words_[i + 1].begin, head) + " { … }`",
                  {{span(words_[i].begin, words_[i + 1].begin), ""},
                   {span(head, words_[colon].end), " {"},
                   {span(past, past), "\n" + margin + "}"}});
        out_.push_back(words_[i + 1]);
        out_.back().first_on_line = words_[i].first_on_line;
        for (std::size_t k = i + 2; !empty && k <= close; ++k) out_.push_back(words_[k]);
        put(Tok::Body, words_[colon].begin, words_[colon].end);
        ends_.push_back(last);
        i = colon;
        return true;
    }

    // JavaScript's `Array.from({ length: 4 }, (_, i) => box(i))`.
    bool by_array(std::size_t &i) {
        if (!is(i, "Array") || !is(i + 2, "from") || kind(i + 3) != Tok::Open ||
            kind(i + 4) != Tok::Body || !is(i + 5, "length") || kind(i + 6) != Tok::Colon)
            return false;
        const std::size_t close = close_of(i + 3, longest_body),
                          brace = close_of(i + 4, longest_head);
        const std::size_t open = brace + 2; // of the function's parameters
        if (close == 0 || brace < i + 8 || kind(brace + 1) != Tok::Comma) return false;
        Diagnostic &d = say(words(i, i + 2), "a list of so many is made by a loop in brackets");
        const bool plain = kind(open) == Tok::Open && kind(open + 1) == Tok::Name &&
                           kind(open + 2) == Tok::Comma && kind(open + 3) == Tok::Name &&
                           kind(open + 4) == Tok::Close && kind(open + 5) == Tok::FatArrow &&
                           kind(open + 6) != Tok::Body;
        const std::string head = "[for " + (plain ? std::string(text(open + 3)) : "i") + " in 0.." +
                                 text(words_[i + 7].begin, words_[brace - 1].end) + " {";
        std::vector<Edit> edits;
        if (plain)
            edits = {{span(words_[i].begin, words_[open + 5].end), head},
                     {words(close, close), " }]"}};
        d.help("write `" + head + " … }]`", std::move(edits));
        begin_change(i);
        put(Tok::Bad, words_[i].begin, words_[close].end, words_[i].first_on_line);
        i = close;
        return true;
    }

    // `f(x, y) := x^2 + y`.
    bool by_colon_and_assign(std::size_t &i) {
        if (kind(i) != Tok::Colon || kind(i + 1) != Tok::Assign || !touch(i, i + 1) ||
            before(i) != Tok::Close)
            return false;
        std::size_t open = i - 1;
        for (int depth = 0; open > 0; --open) {
            if (kind(open) == Tok::Close) ++depth;
            if (kind(open) == Tok::Open && --depth == 0) break;
        }
        if (open == 0 || kind(open - 1) != Tok::Name ||
            (!fresh(open - 1) && (open < 2 || kind(open - 2) != Tok::Fn)))
            return false;
        begin_change(i);
        const std::uint32_t begin = words_[i].begin, end = words_[i + 1].end;
        put(Tok::Assign, begin, end);
        say(span(begin, end), "a name is bound with `=`")
            .help("write `=`", {{span(begin, end), "="}});
        ++i;
        return true;
    }

    // `sphere(1.translate(x: 2)` with nothing that closes it: a number has no such method.
    bool by_number_and_dot(std::size_t i) {
        if (kind(i) != Tok::Number || !is_one_of(before(i), {Tok::Open, Tok::Comma, Tok::Colon}) ||
            kind(i + 1) != Tok::Dot || !touch(i, i + 1) || kind(i + 3) != Tok::Open ||
            !(is_foreign_transform(text(i + 2)) || is(i + 2, "paint") || is(i + 2, "shell")))
            return false;
        std::size_t open = i;
        for (int depth = 1; open > 0 && open + longest_head > i;) {
            --open;
            if (kind(open) == Tok::Close) ++depth;
            if (kind(open) == Tok::Open && --depth == 0) break;
        }
        if (kind(open) != Tok::Open || open == 0 || kind(open - 1) != Tok::Name) return false;
        std::size_t last = close_of(i + 3, longest_head);
        while (last > 0 && kind(last + 1) == Tok::Dot && kind(last + 2) == Tok::Name &&
               kind(last + 3) == Tok::Open)
            last = close_of(last + 3, longest_head);
        if (last == 0) return false;
        const bool ends =
            last + 1 >= words_.size() || is_one_of(kind(last + 1), {Tok::End, Tok::BraceClose}) ||
            (words_[last + 1].first_on_line &&
             is_one_of(kind(last + 1),
                       {Tok::Name, Tok::Let, Tok::Var, Tok::Fn, Tok::Param, Tok::For, Tok::If}));
        if (!ends) return false;
        begin_change(i);
        out_.push_back(words_[i]);
        const std::uint32_t end = words_[i].end;
        put(Tok::Close, end, end);
        diagnostics_.add(Code::UnclosedBracket, words(open, open), "this `(` is never closed")
            .help("write `)`", {{span(end, end), ")"}});
        return true;
    }

    std::vector<std::size_t>
        ends_; // the last words of blocks whose braces are added, outermost first
};

} // namespace

std::vector<Token> read_foreign_blocks(const Source &source, SourceId id,
                                       const std::vector<Token> &words, Diagnostics &diagnostics) {
    return Blocks(source, id, words, diagnostics).run();
}

} // namespace fathom::lang
