// Rust's `match x { 0 => a, 1 | 2 => b, _ => c }`, read as the `if`s that say the same. The words are
// put right before layout, as in forms.cpp.
#include "lang/foreign/word_changes.h"

#include <algorithm>

namespace fathom::lang {

namespace {

constexpr std::size_t longest_subject = 4, longest_match = 2000; // words

// `pattern => body`, of words.
struct Arm {
    std::size_t first = 0, arrow = 0, body = 0, past = 0; // past: behind the body
    bool braces = false, comma = false;
};

class Matches : WordChanges {
  public:
    using WordChanges::WordChanges;

    // Empty where there are none.
    std::vector<Token> run() {
        for (std::size_t i = 0; i < words_.size(); ++i) {
            const bool found = is(i, "match") && read(i);
            if (!found && changed_) out_.push_back(words_[i]);
        }
        return std::move(out_);
    }

  private:
    std::size_t next(std::size_t k) const { // behind what begins there, a bracket with its inside
        if (!is_one_of(kind(k), {Tok::Open, Tok::ListOpen, Tok::Body})) return k + 1;
        const std::size_t close = close_of(k, longest_match);
        return close > 0 ? close + 1 : k + 1;
    }

    // Of the arms of a `match` whose braces these are; empty where they are none.
    std::vector<Arm> arms(std::size_t open, std::size_t close) const {
        std::vector<Arm> found;
        for (std::size_t k = open + 1; k < close;) {
            Arm arm{k, k};
            while (is_one_of(kind(arm.arrow),
                             {Tok::Number, Tok::String, Tok::Name, Tok::True, Tok::False,
                              Tok::Minus, Tok::Bar, Tok::DotDot, Tok::DotDotEqual}))
                ++arm.arrow;
            arm.body = arm.past = arm.arrow + 1;
            if (arm.arrow == k || kind(arm.arrow) != Tok::FatArrow || arm.body >= close) return {};
            arm.braces = kind(arm.body) == Tok::Body;
            if (arm.braces)
                arm.past = next(arm.body);
            else
                while (arm.past < close && kind(arm.past) != Tok::Comma) arm.past = next(arm.past);
            if (arm.past > close || arm.past == arm.body) return {};
            arm.comma = kind(arm.past) == Tok::Comma;
            k = arm.past + (arm.comma ? 1 : 0);
            found.push_back(arm);
        }
        return found;
    }

    bool read(std::size_t &i) {
        std::size_t open = i + 1;
        while (open <= i + longest_subject && !is_one_of(kind(open), {Tok::Body, Tok::End}) &&
               (open == i + 1 || !words_[std::min(open, words_.size() - 1)].first_on_line))
            open = next(open);
        const bool subject = is_one_of(kind(i + 1), {Tok::Name, Tok::Open}) && open > i + 1;
        if (!subject || kind(open) != Tok::Body) return false;
        const std::size_t close = close_of(open, longest_match);
        if (close == 0) return false;
        const std::vector<Arm> all = arms(open, close);
        // `match(x) { y => … }` may be a call of ours with a lambda behind it
        if (all.empty() || (kind(i + 1) == Tok::Open && kind(all[0].first) == Tok::Name) ||
            text(all[0].first) == "_")
            return false;
        begin_change(i);
        subject_first_ = i + 1;
        subject_past_ = open;
        const std::string value = text(words_[i + 1].begin, words_[open - 1].end);
        std::vector<Edit> edits{{words(i, open), ""}, {words(close, close), ""}};
        std::string told;
        for (const Arm &arm : all) {
            const bool otherwise = arm.arrow == arm.first + 1 && text(arm.first) == "_";
            const std::uint32_t at = words_[arm.first].begin;
            std::string head = &arm == all.data() ? "" : "else ";
            if (!head.empty()) put(Tok::Else, at, at);
            if (!otherwise) {
                put(Tok::If, at, at, &arm == all.data() && words_[i].first_on_line);
                head += "if " + condition(arm, value) + " ";
            }
            if (told.empty()) told = head + "{ … } else { … }";
            edits.push_back({words(arm.first, arm.arrow), head + (arm.braces ? "" : "{")});
            const std::uint32_t end = words_[arm.past - 1].end;
            if (!arm.braces) put(Tok::Body, at, at);
            for (std::size_t k = arm.body; k < arm.past; ++k) out_.push_back(words_[k]);
            if (!arm.braces) put(Tok::BraceClose, end, end);
            if (arm.comma)
                edits.push_back({words(arm.past, arm.past), arm.braces ? "" : " }"});
            else if (!arm.braces)
                edits.push_back({span(end, end), " }"});
        }
        diagnostics_.add(Code::ForeignSyntax, words(i, i), "a choice is written with `if`")
            .help(to_write(told), std::move(edits));
        i = close;
        return true;
    }

    void put_word(std::size_t k) {
        out_.push_back(words_[k]);
        out_.back().first_on_line = false;
    }
    void put_subject() {
        for (std::size_t k = subject_first_; k < subject_past_; ++k) put_word(k);
    }

    // `x == 1 or x == 2`, `x >= 0 and x <= 3`, as text and as words.
    std::string condition(const Arm &arm, const std::string &value) {
        std::string out;
        for (std::size_t k = arm.first; k < arm.arrow;) {
            std::size_t past = k;
            while (past < arm.arrow && kind(past) != Tok::Bar) ++past;
            const std::uint32_t at = words_[k].begin;
            if (!out.empty()) {
                put(Tok::Or, at, at);
                out += " or ";
            }
            std::size_t range = k;
            while (range < past && !is_one_of(kind(range), {Tok::DotDot, Tok::DotDotEqual}))
                ++range;
            const auto compare = [&](Tok sign, std::string_view ours, std::size_t from,
                                     std::size_t to) {
                put_subject();
                put(sign, at, at);
                for (std::size_t w = from; w < to; ++w) put_word(w);
                out += value + " " + std::string(ours) + " " +
                       (from < to ? text(words_[from].begin, words_[to - 1].end) : "");
            };
            if (range > k && range + 1 < past) {
                const bool whole = kind(range) == Tok::DotDotEqual;
                compare(Tok::GreaterEqual, ">=", k, range);
                put(Tok::And, at, at);
                out += " and ";
                compare(whole ? Tok::LessEqual : Tok::Less, whole ? "<=" : "<", range + 1, past);
            } else
                compare(Tok::EqualEqual, "==", k, past);
            k = past + 1;
        }
        return out;
    }

    std::size_t subject_first_ = 0, subject_past_ = 0; // what is compared with the patterns
};

} // namespace

std::vector<Token> read_foreign_matches(const Source &source, SourceId id,
                                        const std::vector<Token> &words, Diagnostics &diagnostics) {
    return Matches(source, id, words, diagnostics).run();
}

} // namespace fathom::lang
