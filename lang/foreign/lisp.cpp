// Answers to calls with their names in the parentheses, as libfive and Bauble have them:
// `(sphere 100)`, `(box 1 | move x 2)`, `(def r 20)`, `(let [r 2] (sphere r))`.
#include "base/text.h"
#include "lang/foreign/foreign.h"

#include <array>
#include <utility>

namespace fathom::lang {

// Without parentheses around all of it.
static std::string bare(const std::string &value) {
    int depth = 0;
    for (std::size_t i = 0; i < value.size(); ++i) {
        depth += value[i] == '(' ? 1 : value[i] == ')' ? -1 : 0;
        if (depth == 0 && i + 1 < value.size()) return value;
    }
    return value.starts_with('(') ? value.substr(1, value.size() - 2) : value;
}

static std::string doubled(const std::string &value) {
    const auto number = parse_number(value);
    if (number) return format_shortest(*number * 2);
    return "2 * " +
           (value.find_first_of(" ") == value.npos || value[0] == '[' ? value : "(" + value + ")");
}

// One value as it is written here, and past it; empty where it is none.
std::string ForeignSyntax::lisp_value(Index &at) const {
    const Tok found = kind(at);
    const bool joined = token(at).end == token(at + 1).begin;
    if (found == Tok::Minus && kind(at + 1) == Tok::Number && joined)
        return "-" + std::string(text((at += 2) - 1));
    if (found == Tok::Name && kind(at + 1) == Tok::Minus && joined) return {}; // `box-exact`
    if (is_one_of(found,
                  {Tok::Number, Tok::Name, Tok::String, Tok::Color, Tok::True, Tok::False})) {
        std::string value(text(at++));
        while (is_one_of(kind(at), {Tok::Slash, Tok::Star}) && touch(at - 1, at) &&
               touch(at, at + 1) && is_one_of(kind(at + 1), {Tok::Number, Tok::Name})) {
            value += " " + std::string(text(at)) + " " + std::string(text(at + 1)); // `tau/4`
            at += 2;
        }
        return value;
    }
    if (found == Tok::Open || found == Tok::FreshOpen) {
        const Index open = std::exchange(at, match(at) + 1);
        return lisp_form(open);
    }
    if (found != Tok::ListOpen && found != Tok::FreshListOpen) return {};
    const Index close = match(at++);
    std::string list = "[";
    while (at < close) {
        if (kind(at) == Tok::Comma) ++at;
        const std::string item = lisp_value(at);
        if (item.empty()) return {};
        list += (list.size() > 1 ? ", " : "") + item;
    }
    ++at;
    return list + "]";
}

// `name a b` up to `end`, as a call; `+ a b` as a sum.
std::string ForeignSyntax::lisp_part(Index at, Index end) const {
    const Tok head = kind(at);
    std::string name(text(at));
    std::string axis, named;
    if (head == Tok::Name && kind(at + 1) == Tok::Minus && touch(at, at + 1)) { // `rotate-y`
        const std::string_view part = text(at += 2);
        if (part != "x" && part != "y" && part != "z") return {};
        axis = std::string("axis: ") + static_cast<char>(part[0] - 'x' + 'X');
    }
    const bool moves = name == "move" || name == "translate";
    if (is_one_of(head, {Tok::Plus, Tok::Minus, Tok::Star, Tok::Slash})) {
        std::string sum;
        int terms = 0;
        for (Index i = at + 1; i < end; ++terms) {
            const std::string value = lisp_value(i);
            if (value.empty()) return {};
            sum += (terms > 0 ? " " + name + " " : "") + value;
        }
        return terms == 0 ? "" : terms == 1 ? name + sum : "(" + sum + ")";
    }
    if (head != Tok::Name) { // the value that goes into a pipe
        const std::string value = lisp_value(at);
        return at == end ? value : std::string();
    }
    std::string arguments, before; // `before`: without the last
    int values = 0;
    for (Index i = at + 1; i < end;) {
        if (kind(i) == Tok::Colon && kind(i + 1) == Tok::Name && touch(i, i + 1)) { // `:r 10`
            const std::string key(text(i + 1));
            const std::string value = lisp_value(i += 2);
            if (value.empty()) return {};
            const bool rounds = key == "r" && (name == "union" || name == "intersect" ||
                                               name == "subtract" || name == "difference");
            if (rounds) { // they flow together
                name = name == "union"       ? "smooth_union"
                       : name == "intersect" ? "smooth_intersection"
                                             : "smooth_difference";
                arguments = bare(value) + (arguments.empty() ? "" : ", ") + arguments;
                continue;
            }
            if (key == "r" && name == "box") name = "rounded_box";
            named += ", " + (key == "r" ? std::string("radius") : key) + ": " + bare(value);
            continue;
        }
        const std::string_view word = text(i);
        const bool alone = i == at + 1 && i + 1 == end && kind(at - 1) != Tok::Bar; // `(sphere x)`
        const bool names_axis = !alone && (word == "x" || word == "y" || word == "z");
        std::string value = lisp_value(i);
        if (value.empty()) return {};
        if (names_axis && moves && i < end) {
            const std::string by = lisp_value(i);
            if (by.empty()) return {};
            value += ": " + bare(by);
        } else if (names_axis) {
            if (!axis.empty()) return {}; // `(mirror s x z)`
            axis = std::string("axis: ") + static_cast<char>(value[0] - 'x' + 'X');
            continue;
        }
        before = arguments + (arguments.empty() ? "" : ", ");
        arguments = before + bare(value);
        ++values;
    }
    // Bauble gives halves: of a box, and of the height of a cylinder along an axis.
    if (((name == "box" || name == "rect") && values == 1) ||
        (name == "cylinder" && values == 2 && !axis.empty()))
        arguments = before + doubled(arguments.substr(before.size()));
    if (!axis.empty()) arguments += (arguments.empty() ? "" : ", ") + axis;
    if (!named.empty()) arguments += named.substr(arguments.empty() ? 2 : 0);
    return (moves ? "translate" : name) + "(" + arguments + ")";
}

// Janet's `(-> (sphere 1) (move x 1))`: what each makes of the value before it.
std::string ForeignSyntax::lisp_thread(Index open) const {
    const Index close = match(open);
    Index at = open + 2;
    if (kind(at) == Tok::Greater) ++at; // `->>`
    std::string out = lisp_value(at);
    while (!out.empty() && at < close) {
        const bool form = is_one_of(kind(at), {Tok::Open, Tok::FreshOpen});
        const std::string call =
            form ? lisp_part(at + 1, match(at)) : std::string(text(at)) + "()"; // `shell`
        if (call.empty() || (!form && kind(at) != Tok::Name)) return {};
        out += "." + call;
        at = form ? match(at) + 1 : at + 1;
    }
    return out;
}

// `(fn [x] (f x))` as `x => f(x)`; at its first bracket.
std::string ForeignSyntax::lisp_function(Index open) const {
    const Index list = open + 2, close = match(open), end = match(list);
    if (!is_one_of(kind(list), {Tok::ListOpen, Tok::FreshListOpen, Tok::Open}) || end <= list)
        return {};
    std::string names;
    for (Index i = list + 1; i < end; ++i)
        names += (names.empty() ? "" : ", ") + std::string(text(i));
    Index at = end + 1;
    const std::string value = bare(lisp_value(at));
    if (value.empty() || at != close) return {};
    return (end == list + 2 ? names : "(" + names + ")") + " => " + value;
}

// What stands in parentheses, with Bauble's pipe: `(box 1 | move x 2)`.
std::string ForeignSyntax::lisp_form(Index open) const {
    const Index close = match(open);
    if (kind(open + 1) == Tok::Arrow) return lisp_thread(open);
    if (kind(open + 1) == Tok::Fn) return lisp_function(open);
    const bool infix = is_one_of(kind(open + 1), {Tok::Number, Tok::Name}) &&
                       is_one_of(kind(open + 2), {Tok::Slash, Tok::Star, Tok::Plus}) &&
                       token(open + 2).end < token(open + 3).begin;
    if (infix) return std::string(text(token(open).begin, token(close).end)); // `(tau / 8)`
    std::string out;
    for (Index first = open + 1, i = first; i <= close; ++i) {
        if (match(i) > i && i < close) i = match(i);
        if (i < close && kind(i) != Tok::Bar) continue;
        const bool alone = out.empty() && i < close && first + 1 == i; // `(s | move x 2)`
        const std::string part = alone ? std::string(text(first)) : lisp_part(first, i);
        const bool call = kind(first) == Tok::Name && first + 1 < i; // else it may be a union
        if (part.empty() || (!out.empty() && !call)) return {};
        out += (out.empty() ? "" : ".") + part;
        first = i + 1;
    }
    return out;
}

// `(define (f x) …)`, `(def r 20)`.
bool ForeignSyntax::lisp_binding(Index open) {
    const Index define = open + 1, close = match(open);
    if (!is_one_of(text(define), std::array<std::string_view, 4>{"define", "def", "defn", "var"}))
        return false;
    const bool janet = kind(define + 1) == Tok::Name && kind(define + 2) == Tok::ListOpen &&
                       text(define) == "defn"; // `(defn f [x] …)`
    const bool function = janet || kind(define + 1) == Tok::Open;
    const Index name = define + (function && !janet ? 2 : 1);
    if (kind(name) != Tok::Name) return false;
    std::string head(text(name));
    Index at = name + 1;
    if (function) {
        if (janet) ++at;
        const Index end = match(janet ? define + 2 : define + 1);
        std::string parameters;
        for (; at < end; ++at)
            parameters += (parameters.empty() ? "" : ", ") + std::string(text(at));
        head = "fn " + head + "(" + parameters + ")";
        at = end + 1;
    } else
        head = "let " + head;
    const std::string value = bare(lisp_value(at));
    lost_.push_back(name);
    Diagnostic &d = foreign(span(open, define), function ? "a function is declared with `fn`"
                                                         : "a name is bound with `let`");
    if (value.empty() || at != close)
        d.help("write " + in_code(head + " = …"));
    else
        d.help(to_write(head + " = " + value), {{span(open, close), head + " = " + value}});
    return true;
}

// `(let [r 2] (sphere r))`, `(let ((r 2)) (sphere r))`, at its bracket: names, and then what uses them.
bool ForeignSyntax::lisp_let(Index open) {
    const Index let = open + 1, close = match(open);
    const Index list = let + (kind(let + 1) == Tok::Star && touch(let, let + 1) ? 2 : 1); // `let*`
    const bool pairs = kind(list) == Tok::Open && kind(list + 1) == Tok::Open; // Scheme's
    if (kind(let) != Tok::Let || kind(close) != Tok::Close ||
        (!pairs && !is_one_of(kind(list), {Tok::ListOpen, Tok::FreshListOpen})))
        return false;
    std::string written;
    bool plain = true;
    const auto add = [&](const std::string &head, Index &at) {
        const std::string value = bare(lisp_value(at));
        plain = plain && !value.empty();
        written += (written.empty() ? "" : "; ") + head + value;
    };
    Index at = list + 1;
    while (plain && at < match(list)) {
        const Index end = match(at);
        if (pairs && end > at) ++at;
        plain = kind(at) == Tok::Name;
        lost_.push_back(at);
        const std::string name(text(at++));
        add("let " + name + " = ", at);
        if (pairs) plain = plain && at == end, at = end + 1;
    }
    at = match(list) + 1;
    while (plain && at < close) add("", at);
    failed_ = close;
    Diagnostic &d = foreign(span(open, let), "a name is known to the end of its block");
    if (plain && written.find('\n') == std::string::npos)
        d.help(to_write(written), {{span(open, close), written}});
    else
        d.help("write `let r = 2`, and on the next line what uses it");
    return true;
}

// `(-> (sphere 1) (move x 1))`, at the arrow.
bool ForeignSyntax::lisp_arrow(Index at) {
    if (at == 0 || !is_one_of(kind(at - 1), {Tok::Open, Tok::FreshOpen, Tok::LambdaOpen}))
        return false;
    const Index open = at - 1;
    const std::string written = lisp_thread(open);
    failed_ = match(open);
    Diagnostic &d = foreign(span(open, at), "what is done to a shape stands behind a `.`");
    if (written.empty())
        d.help("write `sphere(1).translate(x: 1)`");
    else
        d.help(to_write(written), {{span(open, match(open)), written}});
    return true;
}

// `(sphere 100)`, also within `(union (sphere 100) …)`, at the argument.
bool ForeignSyntax::lisp_call(Index at) {
    const auto stands_apart = [&](Index i) { // no call's bracket, or one behind a space
        const Tok before = i == 0 ? Tok::End : kind(i - 1);
        return !is_one_of(before, {Tok::Name, Tok::Close, Tok::ListClose}) ||
               token(i - 1).end < token(i).begin;
    };
    const auto is_form = [&](Index i) {
        return kind(match(i)) == Tok::Close && stands_apart(i) && match(i) > i;
    };
    Index open = enclosing(at);
    const Index inner = open + 1;
    if (inner + 1 != at || !is_form(open)) return false;
    for (Index around = enclosing(open); around < open && match(around) > open && is_form(around);
         around = enclosing(open))
        open = around;
    if (lisp_binding(open)) return true;
    std::string call = lisp_form(open);
    const Tok before = open == 0 ? Tok::End : kind(open - 1); // Curv's `f 1 (g 2)` keeps them
    if (is_one_of(before, {Tok::Number, Tok::Close, Tok::ListClose})) call = "(" + call + ")";
    Diagnostic &d = foreign(span(open, open + 1), "a call's name stands before its parentheses");
    if (call.find("box(") != call.npos)
        d.note("boxes are given there by half their size, or by two corners");
    if (!call.empty() && call != "()")
        d.help(to_write(call), {{span(open, match(open)), call}});
    else if (open + 1 == inner)
        d.help("write " + in_code(std::string(text(inner)) + "(" + std::string(text(at)) + ")"));
    else
        d.help("write " + in_code(std::string(text(open + 1)) + "(…, …)") +
               ", with commas between the arguments");
    return true;
}

} // namespace fathom::lang
