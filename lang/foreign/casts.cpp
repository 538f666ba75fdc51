// Calls that name a type, as C++, Java and Rust have them, and casts: `static_cast<int>(x)`,
// `std::make_shared<Sphere>(1)`, `parse::<f32>()`, `(int)x`, and vectors of a type. The words are put
// right before layout, so that all behind them is read and only the one mistake is told. No text of
// ours has such a form.
#include "lang/foreign/word_changes.h"

#include <array>

namespace fathom::lang {

namespace {

constexpr std::size_t longest_type_argument = 20, longest_operand = 200; // words
constexpr std::array<std::string_view, 11> cast_types = {
    "float", "int", "double", "bool", "f32", "f64", "i32", "u32", "uint", "long", "short"};
constexpr std::array<std::string_view, 4> whole_types = {"int", "i32", "u32", "uint"};
constexpr std::array<std::string_view, 3> made_of_type = {"make_shared", "make_unique", "make"};

class Casts : WordChanges {
  public:
    using WordChanges::WordChanges;

    // Empty where there are none.
    std::vector<Token> run() {
        for (std::size_t i = 0; i < words_.size(); ++i)
            if (!vector_of_type(i) && !by_type_argument(i) && !by_type_in_parentheses(i) &&
                changed_)
                out_.push_back(words_[i]);
        return std::move(out_);
    }

  private:
    // The `>` of `<T>`, `<std::vector<T>>`; 0 where what stands there is no type.
    std::size_t type_end(std::size_t less) const {
        int depth = 0;
        for (std::size_t k = less; k < less + longest_type_argument; ++k) {
            depth += kind(k) == Tok::Less ? 1 : kind(k) == Tok::Greater ? -1 : 0;
            if (depth == 0) return kind(k) == Tok::Greater && k > less + 1 ? k : 0;
            if (!is_one_of(kind(k), {Tok::Less, Tok::Greater, Tok::Name, Tok::Colon, Tok::Comma,
                                     Tok::Star, Tok::Amp, Tok::Number}))
                return 0;
        }
        return 0;
    }

    // WGSL's `vec3<f32>`, as a type or called.
    bool vector_of_type(std::size_t &i) {
        constexpr std::array<std::string_view, 3> vectors = {"vec2", "vec3", "vec4"};
        if (kind(i) != Tok::Name || !is_one_of(text(i), vectors) || kind(i + 1) != Tok::Less ||
            kind(i + 2) != Tok::Name || !is_one_of(text(i + 2), cast_types) ||
            kind(i + 3) != Tok::Greater)
            return false;
        diagnostics_
            .add(Code::ForeignSyntax, words(i, i + 3),
                 "a vector has no type beside its length: its numbers are floats")
            .help("write `" + std::string(text(i)) + "`", {{words(i + 1, i + 3), ""}});
        begin_change(i);
        out_.push_back(words_[i]);
        i += 3;
        return true;
    }

    // `f<T>(…)`, `std::f<T>(…)`, `f::<T>(…)`.
    bool by_type_argument(std::size_t &i) {
        const bool standard =
            is(i, "std") && kind(i + 1) == Tok::Colon && kind(i + 2) == Tok::Colon;
        const std::size_t name = standard ? i + 3 : i;
        if (kind(name) != Tok::Name) return false;
        const bool turbofish = kind(name + 1) == Tok::Colon && kind(name + 2) == Tok::Colon;
        const std::size_t less = turbofish ? name + 3 : name + 1;
        if (kind(less) != Tok::Less || !touch(less - 1, less) || !touch(less, less + 1))
            return false;
        const std::size_t end = type_end(less);
        if (end == 0 || kind(end + 1) != Tok::Open || !touch(end, end + 1)) return false;
        const std::string_view word = text(name);
        const std::size_t type = less + 1; // its first word
        const bool cast = word.ends_with("_cast");
        const bool made = is_one_of(word, made_of_type);
        const bool plain = end == less + 2;
        std::string ours = cast   ? (is_one_of(text(type), whole_types) ? "int" : "float")
                           : made ? small(text(type))
                                  : std::string(word);
        const Span head = words(i, end);
        diagnostics_
            .add(Code::ForeignSyntax, head,
                 cast   ? "a number is converted by a call"
                 : made ? "a value is made by a call of what it is"
                        : "a call names no types")
            .help("write `" + ours + "(…)`", {{head, ours}});
        begin_change(i);
        const bool first = words_[i].first_on_line;
        if (!cast && !made)
            put(Tok::Name, words_[name].begin, words_[name].end, first);
        else if (cast && plain && text(type) == ours)
            put(Tok::Name, words_[type].begin, words_[type].end, first);
        else // what it is called here, nothing is known of: the call's value may be anything
            put(Tok::Bad, head.begin, head.end, first);
        i = end;
        return true;
    }
    static std::string small(std::string_view type) {
        std::string out(type);
        if (!out.empty() && out[0] >= 'A' && out[0] <= 'Z') out[0] += 'a' - 'A';
        return out;
    }

    // The last word of the operand that begins at `i`: `x`, `f(x).y`, `(a + b)`.
    std::size_t operand_end(std::size_t i) const {
        std::size_t end = kind(i) == Tok::Open ? close_of(i, longest_operand) : i;
        if (end == 0) return 0;
        while (end < i + longest_operand) {
            if (kind(end + 1) == Tok::Dot && kind(end + 2) == Tok::Name)
                end += 2;
            else if (is_one_of(kind(end + 1), {Tok::Open, Tok::ListOpen}) && touch(end, end + 1)) {
                const std::size_t close = close_of(end + 1, longest_operand);
                if (close == 0) return 0;
                end = close;
            } else
                break;
        }
        return end;
    }

    // `(int)x`, `(float) (a + b)`.
    bool by_type_in_parentheses(std::size_t &i) {
        if (kind(i) != Tok::Open || kind(i + 1) != Tok::Name || kind(i + 2) != Tok::Close ||
            !is_one_of(text(i + 1), cast_types) ||
            !is_one_of(kind(i + 3), {Tok::Name, Tok::Number, Tok::Open}) ||
            words_[i + 3].first_on_line ||
            is_one_of(before(i), {Tok::Name, Tok::Close, Tok::ListClose}))
            return false;
        const std::size_t end = operand_end(i + 3);
        if (end == 0) return false;
        const Span cast = words(i, i + 2);
        const std::uint32_t begin = words_[i + 3].begin;
        const bool whole = is_one_of(text(i + 1), whole_types), grouped = kind(i + 3) == Tok::Open;
        if (whole) {
            std::vector<Edit> edits{{span(cast.begin, begin), grouped ? "int" : "int("}};
            if (!grouped) edits.push_back({span(words_[end].end, words_[end].end), ")"});
            diagnostics_.add(Code::ForeignSyntax, cast, "a number is converted by a call")
                .help("write `int(…)`", std::move(edits));
        } else
            diagnostics_.add(Code::ForeignSyntax, cast, "a whole number is converted by itself")
                .help("leave `" + text(cast.begin, cast.end) + "` away",
                      {{span(cast.begin, begin), ""}});
        begin_change(i);
        const bool first = words_[i].first_on_line;
        i += 3;
        out_.push_back(words_[i]);
        out_.back().first_on_line = first;
        return true;
    }
};

} // namespace

std::vector<Token> read_foreign_casts(const Source &source, SourceId id,
                                      const std::vector<Token> &words, Diagnostics &diagnostics) {
    return Casts(source, id, words, diagnostics).run();
}

} // namespace fathom::lang
