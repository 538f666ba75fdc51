// Types, casts, macros, paths and declarations as Rust, C++, Java and TypeScript write them, read as
// ours: `Vec<f32>`, `&T`, `x as f32`, `vec![1, 2]`, `Vec3::new(…)`, `const R: f32 = 1`,
// `std::vector<float> r = {1, 2};`. The words are put right before layout, so that all behind them
// is read and only the one mistake is told. Each form is one that no text of ours has.
#include "lang/foreign/word_changes.h"

#include <algorithm>
#include <array>
#include <utility>

namespace fathom::lang {

namespace {

constexpr std::size_t longest_type = 40, longest_list = 400; // words
constexpr std::array<std::string_view, 8> list_types = {"Vec",  "vector", "List",     "Array",
                                                        "list", "array",  "Sequence", "Iterable"};
constexpr std::array<std::string_view, 5> float_types = {"f32", "f64", "float", "double", "number"};
constexpr std::array<std::string_view, 13> int_types = {"i8",  "i16",  "i32",    "i64",   "u8",
                                                        "u16", "u32",  "u64",    "usize", "isize",
                                                        "int", "uint", "integer"};
constexpr std::array<std::string_view, 9> scopes = {"std",    "core", "glm",  "f32",  "f64",
                                                    "consts", "math", "Math", "cmath"};
constexpr std::array<std::string_view, 6> makers = {"new",        "splat", "from",
                                                    "from_array", "of",    "make"};
constexpr std::array<std::string_view, 9> visibilities = {
    "pub", "public", "private", "protected", "inline", "unsafe", "extern", "export", "static"};
constexpr std::array<std::string_view, 6> constants = {"const",    "static", "constexpr",
                                                       "readonly", "final",  "val"};

bool ends_value(Tok kind) {
    return is_one_of(kind, {Tok::Name, Tok::Number, Tok::Close, Tok::ListClose});
}

class Forms : WordChanges {
  public:
    using WordChanges::WordChanges;

    // Empty where there are none.
    std::vector<Token> run() {
        for (std::size_t i = 0; i < words_.size(); ++i) {
            const std::size_t done = out_.size();
            const bool begins = std::exchange(begins_line_, false);
            line_begins_ = begins;
            const bool found = by_list_type(i) || by_reference(i) || by_cast(i) || by_macro(i) ||
                               by_declaration(i) || by_path(i) || by_include(i) || by_template(i) ||
                               by_word(i) || by_constant(i) || by_braces(i) || by_spread(i);
            if (!found && changed_) out_.push_back(words_[i]);
            if (begins && out_.size() > done) out_[done].first_on_line = true;
            if (begins && out_.size() == done) begins_line_ = true;
        }
        return std::move(out_);
    }

  private:
    Diagnostic &say(Span at, std::string message) {
        return diagnostics_.add(Code::ForeignSyntax, at, std::move(message));
    }
    // What stands in [first, past) goes; what is behind it stands where it stood.
    void drop(std::size_t first, std::size_t past, std::size_t &i) {
        begin_change(first);
        begins_line_ = begins_line_ || words_[first].first_on_line || line_begins_;
        i = past - 1;
    }
    bool at_start(std::size_t i) const { return fresh(i) || line_begins_; }

    // Where only a type can stand: behind `->`, or the `:` of a name that is declared.
    bool is_type_place(std::size_t i) const {
        if (before(i) == Tok::Arrow) return true;
        if (before(i) != Tok::Colon || i < 3 || kind(i - 2) != Tok::Name) return false;
        const Tok head = kind(i - 3);
        if (is_one_of(head, {Tok::Let, Tok::Var, Tok::Param})) return true;
        if (head == Tok::Name) // `let mut x: T`, `const X: T`
            return text(i - 3) == "mut" || is_one_of(text(i - 3), constants);
        if (head != Tok::Open && head != Tok::Comma) return false;
        int depth = 0;
        constexpr std::size_t longest_head = 200;
        for (std::size_t k = i - 3, steps = 0; steps < longest_head; --k, ++steps) {
            if (is_one_of(kind(k), {Tok::Close, Tok::ListClose})) ++depth;
            if (is_one_of(kind(k), {Tok::Open, Tok::ListOpen}) && depth-- == 0)
                return k > 1 && kind(k) == Tok::Open && kind(k - 1) == Tok::Name &&
                       kind(k - 2) == Tok::Fn;
            if (k == 0) break;
        }
        return false;
    }

    // The end of `Vec<f32>`, `std::vector<float>`, `List[float]` that begins at `i`, and the word of
    // what it holds; 0 where there is none.
    std::size_t list_type(std::size_t i, std::size_t &item) const {
        std::size_t k = i;
        if (is(k, "std") && kind(k + 1) == Tok::Colon && kind(k + 2) == Tok::Colon) k += 3;
        if (kind(k) != Tok::Name || !is_one_of(text(k), list_types)) return 0;
        const Tok open = kind(k + 1);
        if (open != Tok::Less && open != Tok::ListOpen) return 0;
        item = k + 2;
        while (is_one_of(kind(item), {Tok::Amp, Tok::Colon}) || is(item, "std") ||
               is(item, "const") || is(item, "glm"))
            ++item;
        if (kind(item) != Tok::Name) return 0;
        std::size_t end = item + 1; // C++'s and Rust's sizes
        if (kind(end) == Tok::Comma && kind(end + 1) == Tok::Number) end += 2;
        return kind(end) == (open == Tok::Less ? Tok::Greater : Tok::ListClose) ? end : 0;
    }

    bool by_list_type(std::size_t &i) {
        if (kind(i) != Tok::Name || !is_type_place(i)) return false;
        std::size_t item = 0;
        const std::size_t end = list_type(i, item);
        if (end == 0) return false;
        begin_change(i);
        const std::string ours = "[" + std::string(text(item)) + "]";
        say(words(i, end), "a list's type stands in brackets")
            .help(to_write(ours), {{span(words_[i].begin, words_[item].begin), "["},
                                   {span(words_[item].end, words_[end].end), "]"}});
        put(Tok::ListOpen, words_[i].begin, words_[item].begin);
        out_.push_back(words_[item]);
        put(Tok::ListClose, words_[item].end, words_[end].end);
        i = end;
        return true;
    }

    // `&T`, `&x`, `&mut x`, where no operator can stand.
    bool by_reference(std::size_t &i) {
        if (kind(i) != Tok::Amp || words_[i].first_on_line ||
            !is_one_of(kind(i + 1), {Tok::Name, Tok::ListOpen}) ||
            !is_one_of(before(i), {Tok::Colon, Tok::Arrow, Tok::In, Tok::Open, Tok::ListOpen,
                                   Tok::Comma, Tok::Assign, Tok::Return}))
            return false;
        const std::size_t past = is(i + 1, "mut") && kind(i + 2) == Tok::Name ? i + 2 : i + 1;
        say(span(words_[i].begin, words_[past - 1].end),
            "a value is given as it is: there are no references")
            .help("leave " + in_code(text(words_[i].begin, words_[past - 1].end)) + " away",
                  {{span(words_[i].begin, words_[past].begin), ""}});
        drop(i, past, i);
        return true;
    }

    // `x as f32`.
    bool by_cast(std::size_t &i) {
        if (!is(i, "as") || words_[i].first_on_line || !ends_value(before(i)) ||
            kind(i + 1) != Tok::Name)
            return false;
        const bool to_float = is_one_of(text(i + 1), float_types);
        if (!to_float && !is_one_of(text(i + 1), int_types)) return false;
        std::size_t first = i - 1; // of the value
        for (std::size_t steps = 0; first > 0 && steps < longest_list; ++steps) {
            const Tok k = kind(first), ahead = kind(first - 1);
            if (k == Tok::Close || k == Tok::ListClose) {
                const Tok open = k == Tok::Close ? Tok::Open : Tok::ListOpen;
                int depth = 0;
                for (; first > 0; --first, ++steps) {
                    depth += kind(first) == k ? 1 : kind(first) == open ? -1 : 0;
                    if (depth == 0) break;
                }
                if (first > 0 && kind(first - 1) == Tok::Name && touch(first - 1, first)) --first;
            } else if (ahead == Tok::Dot && first > 1)
                first -= 2;
            else
                break;
        }
        const Span cast = words(i, i + 1);
        const Span gap = span(words_[i - 1].end, words_[i + 1].end);
        if (to_float)
            say(cast, "a whole number is converted by itself")
                .help("leave " + in_code(text(cast.begin, cast.end)) + " away", {{gap, ""}});
        else {
            const std::string value = text(words_[first].begin, words_[i - 1].end);
            const bool whole = kind(first) == Tok::Open && kind(i - 1) == Tok::Close;
            std::vector<Edit> edits{
                {span(words_[first].begin, words_[first].begin), whole ? "int" : "int("},
                {gap, whole ? "" : ")"}};
            say(cast, "a number is converted by a call")
                .help(to_write(whole ? "int" + value : "int(" + value + ")"), std::move(edits));
        }
        drop(i, i + 2, i);
        return true;
    }

    // `vec![1, 2]`, `vec![0.0; 5]`, `println!("{}", x)`; the lexer has reported the sign.
    bool by_macro(std::size_t &i) {
        const bool sign = kind(i) == Tok::Name && kind(i + 1) == Tok::Bad && text(i + 1) == "!" &&
                          touch(i, i + 1);
        const Tok open = kind(i + 2);
        if (!sign || (open != Tok::Open && open != Tok::ListOpen)) return false;
        const std::string name(text(i));
        const Span head = words(i, i + 1);
        diagnostics_.withdraw(Code::ForeignSyntax, words(i + 1, i + 1));
        if (name == "vec" && open == Tok::ListOpen) {
            const bool repeated = kind(i + 4) == Tok::End && kind(i + 6) == Tok::ListClose;
            Diagnostic &d = say(head, "a list stands in brackets");
            if (repeated) {
                const std::string list = "[for i in 0.." + std::string(text(i + 5)) + " { " +
                                         std::string(text(i + 3)) + " }]";
                d.help(to_write(list), {{words(i, i + 6), list}});
            } else
                d.help("leave " + in_code("vec!") + " away", {{head, ""}});
            const bool first = words_[i].first_on_line;
            begin_change(i);
            put(Tok::ListOpen, words_[i + 2].begin, words_[i + 2].end, first);
            i += 2;
            if (!repeated) return true;
            out_.push_back(words_[i + 1]);
            i += 3;
            return true;
        }
        begin_change(i);
        if (name == "print" || name == "println" || name == "eprintln") {
            const std::size_t close = head_of_print(i + 2);
            const bool shows = kind(i + 3) == Tok::String && kind(i + 4) == Tok::Comma && close > 0;
            std::vector<Edit> edits{{head, "print"}};
            if (shows) edits.push_back({span(words_[i + 3].begin, words_[i + 5].begin), ""});
            say(head, "a value is shown by `print`").help("write `print(x)`", std::move(edits));
            const std::uint32_t begin = words_[i].begin + (name[0] == 'e' ? 1 : 0);
            put(Tok::Name, begin, begin + 5, words_[i].first_on_line);
            out_.push_back(words_[i + 2]);
            i += shows ? 4 : 2;
            return true;
        }
        say(head, "there are no macros").help("leave the `!` away", {{words(i + 1, i + 1), ""}});
        out_.push_back(words_[i]);
        ++i;
        return true;
    }

    // Of `("…", x)` the end; 0 where it holds more values, or none.
    std::size_t head_of_print(std::size_t open) const {
        const std::size_t close = close_of(open, longest_list);
        int commas = 0, depth = 0;
        for (std::size_t k = open; k < close; ++k) {
            depth += is_one_of(kind(k), {Tok::Open, Tok::ListOpen})     ? 1
                     : is_one_of(kind(k), {Tok::Close, Tok::ListClose}) ? -1
                                                                        : 0;
            commas += depth == 1 && kind(k) == Tok::Comma ? 1 : 0;
        }
        return commas == 1 ? close : 0;
    }

    // `Vec3::new(…)`, `std::f32::consts::PI`.
    bool by_path(std::size_t &i) {
        const bool within = before(i) == Tok::Colon && before(i - 1) == Tok::Colon;
        if (kind(i) != Tok::Name || within || is_use(i)) return false;
        std::size_t last = i;
        while (kind(last + 1) == Tok::Colon && kind(last + 2) == Tok::Colon &&
               kind(last + 3) == Tok::Name && touch(last, last + 1) && touch(last + 1, last + 2))
            last += 3;
        if (last == i) return false;
        if (is_one_of(text(i), scopes)) {
            const Span path = span(words_[i].begin, words_[last - 1].end);
            say(path, "the mathematical functions need no module")
                .help(to_write(text(last)), {{span(path.begin, words_[last].begin), ""}});
            begin_change(i);
            put(Tok::Name, words_[last].begin, words_[last].end, words_[i].first_on_line);
            i = last;
            return true;
        }
        if (last != i + 3 || !is_one_of(text(last), makers) || kind(last + 1) != Tok::Open)
            return false;
        const Span tail = span(words_[i].end, words_[last].end);
        say(tail, "a value is made by a call of what it is")
            .help("leave " + in_code(text(tail.begin, tail.end)) + " away", {{tail, ""}});
        begin_change(i);
        out_.push_back(words_[i]);
        i = last;
        return true;
    }
    bool is_use(std::size_t i) const { return i > 0 && (is(i - 1, "use") || is(i - 1, "using")); }

    // OpenSCAD's `include <lib/std.scad>`.
    bool by_include(std::size_t &i) {
        if ((!is(i, "include") && !is(i, "use")) || !fresh(i) || kind(i + 1) != Tok::Less)
            return false;
        std::size_t end = i + 2;
        while (end < words_.size() && !words_[end].first_on_line && kind(end) != Tok::Greater &&
               kind(end) != Tok::End)
            ++end;
        const std::size_t past = kind(end + 1) == Tok::End ? end + 2 : end + 1;
        if (kind(end) != Tok::Greater || words_[end].first_on_line ||
            (past < words_.size() && !words_[past].first_on_line && kind(past - 1) != Tok::End))
            return false;
        say(words(i, end), "a library of another language cannot be read")
            .help("leave the line away; another scene is brought in by `import \"file.sdf\"`",
                  {{span(words_[i].begin, words_[std::min(past, words_.size()) - 1].end), ""}});
        drop(i, std::min(past, words_.size()), i);
        return true;
    }

    // `template <typename T>`.
    bool by_template(std::size_t &i) {
        if (!is(i, "template") || kind(i + 1) != Tok::Less || kind(i + 2) != Tok::Name ||
            kind(i + 3) != Tok::Name)
            return false;
        std::size_t end = i + 4;
        while (kind(end) != Tok::Greater && kind(end) != Tok::End && end < i + longest_type) ++end;
        if (kind(end) != Tok::Greater || end + 1 >= words_.size()) return false;
        say(words(i, end), "a function without types takes values of any type")
            .help("leave it away", {{span(words_[i].begin, words_[end + 1].begin), ""}});
        drop(i, end + 1, i);
        return true;
    }

    // `pub fn`, `export const`: what says who may see it.
    bool by_word(std::size_t &i) {
        if (kind(i) != Tok::Name || !at_start(i) || !is_one_of(text(i), visibilities)) return false;
        std::size_t past = i + 1;
        if (kind(past) == Tok::Open && is(i, "pub") && kind(past + 2) == Tok::Close) past += 3;
        const bool declares =
            is_one_of(kind(past), {Tok::Fn, Tok::Let, Tok::Var}) || is(past, "function") ||
            (is(i, "pub") && kind(past) == Tok::Name && is_one_of(text(past), constants));
        if (!declares || words_[past].first_on_line) return false;
        say(words(i, past - 1), "every name that does not begin with `_` is public")
            .help("leave " + in_code(text(words_[i].begin, words_[past - 1].end)) + " away",
                  {{span(words_[i].begin, words_[past].begin), ""}});
        drop(i, past, i);
        return true;
    }

    // `const R: f32 = 1.5`, `static H: f32 = 2`, `val x: Int = 1`.
    bool by_constant(std::size_t &i) {
        if (kind(i) != Tok::Name || !at_start(i) || !is_one_of(text(i), constants) ||
            kind(i + 1) != Tok::Name || kind(i + 2) != Tok::Colon || kind(i + 3) == Tok::Colon)
            return false;
        say(words(i, i), "a name is bound with `let`").help("write `let`", {{words(i, i), "let"}});
        begin_change(i);
        put(Tok::Let, words_[i].begin, words_[i].end, words_[i].first_on_line);
        return true;
    }

    // `std::vector<float> r = …`, `Shape* s = …`, `const auto& s = …`, `float r[] = …`.
    bool by_declaration(std::size_t &i) {
        if (kind(i) != Tok::Name || !at_start(i)) return false;
        std::size_t k = i, item = 0;
        while (is_one_of(text(k), constants) && kind(k) == Tok::Name && kind(k + 1) == Tok::Name)
            ++k;
        std::size_t name = 0, past = 0;
        if (const std::size_t end = list_type(k, item); end > 0) {
            name = end + 1;
            if (kind(name) == Tok::Amp) ++name;
            past = name + 1;
        } else if (is_one_of(kind(k + 1), {Tok::Star, Tok::Amp}) && kind(k + 2) == Tok::Name) {
            name = k + 2;
            past = name + 1;
        } else if (kind(k + 1) == Tok::Name && kind(k + 2) == Tok::ListOpen) {
            name = k + 1;
            past = kind(k + 3) == Tok::ListClose ? k + 4 : k + 5;
            if (kind(past - 1) != Tok::ListClose) return false;
        }
        const bool braces =
            item > 0 && name > 0 && is_one_of(kind(past), {Tok::Body, Tok::Trailing});
        if (item > 0 && name > 0 && kind(name) == Tok::Name &&
            (kind(past) == Tok::End || fresh(past)))
            return without_values(i, name);
        if (name == 0 || kind(name) != Tok::Name || (kind(past) != Tok::Assign && !braces) ||
            words_[past].first_on_line)
            return false;
        const std::string let = "let " + std::string(text(name));
        const std::size_t close = braces ? close_of(past, longest_list) : 0;
        if (braces && close == 0) return false;
        const Span head = words(i, braces ? past : past - 1);
        std::vector<Edit> edits{{head, braces ? let + " = [" : let}};
        if (braces) edits.push_back({words(close, close), "]"}); // `rs{0.2, 0.3}`
        say(head, "a name is bound with `let`")
            .help(to_write(let + (braces ? " = [ … ]" : " = …")), std::move(edits));
        begin_change(i);
        put(Tok::Let, words_[i].begin, words_[i].begin, words_[i].first_on_line);
        put(Tok::Name, words_[name].begin, words_[name].end);
        if (braces) {
            put(Tok::Assign, words_[past].begin, words_[past].begin);
            put(Tok::ListOpen, words_[past].begin, words_[past].end);
            braces_.push_back(close);
            i = past;
            return true;
        }
        i = past - 1;
        array_ = kind(past + 1) == Tok::Body;
        return true;
    }

    // `std::vector<float> r;`
    bool without_values(std::size_t &i, std::size_t name) {
        const Span head = words(i, name);
        const std::string let = "let " + std::string(text(name)) + " = []";
        say(head, "a name is bound together with its value").help(to_write(let), {{head, let}});
        begin_change(i);
        put(Tok::Let, words_[i].begin, words_[i].begin, words_[i].first_on_line);
        out_.push_back(words_[name]);
        const std::uint32_t end = words_[name].end;
        for (const Tok sign : {Tok::Assign, Tok::ListOpen, Tok::ListClose}) put(sign, end, end);
        i = name;
        return true;
    }

    // `= { 1, 2 };`, `= vec3[2](a, b)`, `= float[](1, 2)`.
    bool by_braces(std::size_t &i) {
        const auto it = std::ranges::find(braces_, i);
        if (it != braces_.end()) {
            braces_.erase(it);
            put(kind(i) == Tok::Body || kind(i) == Tok::Open ? Tok::ListOpen : Tok::ListClose,
                words_[i].begin, words_[i].end, words_[i].first_on_line);
            return true;
        }
        if (!is_one_of(before(i), {Tok::Assign, Tok::In})) return false;
        std::size_t open = i;
        if (kind(i) == Tok::Name && is_type_word(text(i)) && kind(i + 1) == Tok::ListOpen) {
            open = kind(i + 2) == Tok::ListClose ? i + 3 : i + 4;
            if (kind(open - 1) != Tok::ListClose || kind(open) != Tok::Open ||
                may_be_declared(text(i)))
                return false;
        } else if (kind(i) != Tok::Body || !holds_values(i))
            return false;
        const std::size_t close = close_of(open, longest_list);
        if (close == 0) return false;
        const Span head = words(i, open);
        std::vector<Edit> edits{{head, "["}, {words(close, close), "]"}};
        braces_.push_back(close);
        for (std::size_t k = open + 1; k < close; ++k)
            if (kind(k) == Tok::Body && holds_values(k))
                for (const std::size_t b : {k, close_of(k, longest_list)}) {
                    braces_.push_back(b);
                    edits.push_back({words(b, b), b == k ? "[" : "]"});
                }
        say(head, "a list stands in brackets").help("write `[ … ]`", std::move(edits));
        begin_change(i);
        put(Tok::ListOpen, head.begin, head.end);
        i = open;
        array_ = false;
        return true;
    }

    // Whether a brace holds values with commas between them, of which not all are names.
    bool holds_values(std::size_t open) const {
        const std::size_t close = close_of(open, longest_list);
        int depth = 0, commas = 0;
        bool value = array_;
        for (std::size_t k = open; k < close; ++k) {
            if (is_one_of(kind(k), {Tok::Body, Tok::Open, Tok::ListOpen})) ++depth;
            if (is_one_of(kind(k), {Tok::BraceClose, Tok::Close, Tok::ListClose})) --depth;
            value = value || is_one_of(kind(k), {Tok::Number, Tok::String, Tok::Open});
            if (depth != 1) continue;
            commas += kind(k) == Tok::Comma ? 1 : 0;
            if (is_one_of(kind(k), {Tok::Colon, Tok::End, Tok::Let, Tok::For, Tok::Return,
                                    Tok::FatArrow, Tok::Assign, Tok::If}))
                return false;
        }
        return close > 0 && value && (commas > 0 || (array_ && close > open + 1));
    }

    // `union(*shapes)`, `union(...shapes)`: the only argument.
    bool by_spread(std::size_t &i) {
        if (text(i) == "**" && is_one_of(before(i), {Tok::Open, Tok::Comma}) &&
            kind(i + 1) == Tok::Name) { // `f(**options)`
            diagnostics_.withdraw(Code::ForeignSyntax, words(i, i));
            say(words(i, i + 1), "arguments are given one by one, by their places or names")
                .help("write each, as in `f(radius: 0.5, height: 2)`");
            drop(i, i + 1, i);
            return true;
        }
        const bool sign = kind(i) == Tok::Star || (kind(i) == Tok::DotDot && text(i) == "...");
        if (!sign || before(i) != Tok::Open || i < 2 || kind(i - 2) != Tok::Name ||
            !touch(i - 2, i - 1) || // `y (* tau 0.1)`, of a Lisp
            !is_one_of(kind(i + 1), {Tok::Name, Tok::ListOpen}) || words_[i].first_on_line)
            return false;
        const std::size_t close = close_of(i - 1, longest_list);
        int depth = 0;
        for (std::size_t k = i; k < close; ++k) {
            depth += is_one_of(kind(k), {Tok::Open, Tok::ListOpen})     ? 1
                     : is_one_of(kind(k), {Tok::Close, Tok::ListClose}) ? -1
                                                                        : 0;
            if (depth == 0 && kind(k) == Tok::Comma) return false;
        }
        if (close == 0) return false;
        say(words(i, i), "a list is given as it is, not spread out")
            .help("leave " + in_code(text(i)) + " away", {{words(i, i), ""}});
        drop(i, i + 1, i);
        return true;
    }

    bool line_begins_ = false; // this word stands where one that began a line was left away
    bool begins_line_ = false; // so does the next one
    bool array_ = false;       // a list is declared whose values come next
    std::vector<std::size_t> braces_;
};

} // namespace

std::vector<Token> read_foreign_forms(const Source &source, SourceId id,
                                      const std::vector<Token> &words, Diagnostics &diagnostics) {
    return Forms(source, id, words, diagnostics).run();
}

} // namespace fathom::lang
