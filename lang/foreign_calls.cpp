// Answers to calls as other languages write them: transforms before what they move, arguments
// without parentheses, lambdas, units apart from their numbers, slices, imports.
#include "lang/builder.h"
#include "lang/lexer.h"

#include <algorithm>
#include <array>
#include <utility>

namespace fathom::lang {

namespace {

constexpr std::array<std::string_view, 13> transforms = {
    "translate", "rotate",         "scale",          "mirror",     "color", "resize", "projection",
    "offset",    "linear_extrude", "rotate_extrude", "multmatrix", "twist", "render"};
// What OpenSCAD calls the shapes and transforms that are juxtaposed there.
constexpr std::pair<std::string_view, std::string_view> scad_names[] = {
    {"linear_extrude", "extrude"},
    {"rotate_extrude", "revolve"},
    {"color", "paint"},
    {"mirror", "reflect"},
    {"cube", "box"},
    {"square", "rectangle"}};

// What a distance field has no need of, or has no parts for.
constexpr std::array<std::string_view, 8> needless_arguments = {
    "center", "convexity", "slices", "segments", "angle", "steps", "centre", "resolution"};

} // namespace

bool is_foreign_transform(std::string_view name) { return is_one_of(name, transforms); }

// A transform of OpenSCAD as it is written here: angles in degrees, `:` behind names, of which
// nothing more is said.
std::string Builder::transform_text(Index name) const {
    const Index open = name + 1, close = match(open);
    std::string out(text(name));
    const bool rotate = out == "rotate", color = out == "color";
    if (rotate && kind(open + 1) == Tok::ListOpen) out = "rotate_euler";
    for (const auto &[theirs, ours] : scad_names)
        if (out == theirs) out = ours;
    std::uint32_t end = token(name).end;
    int depth = 0;
    bool angle = true; // in the first argument
    for (Index i = open; i < close; ++i)
        if (kind(i) == Tok::Assign) diagnostics_.withdraw(Code::ForeignSyntax, span(i));
    for (Index i = open; i <= close; ++i) {
        if (depth == 1 && kind(i) == Tok::Name && kind(i + 1) == Tok::Assign &&
            is_one_of(text(i), needless_arguments)) {
            while (i < close && kind(i) != Tok::Comma) i = match(i) > i ? match(i) + 1 : i + 1;
            if (kind(i) == Tok::Comma)
                end = token(i + 1).begin;
            else {
                while (out.ends_with(' ') || out.ends_with(',')) out.pop_back();
                out += ")";
            }
            continue;
        }
        if (match(i) > i) ++depth;
        if (match(i) < i) --depth;
        if (kind(i) == Tok::Comma && depth == 1) angle = false;
        if (color && kind(i) == Tok::Comma && depth == 1) { // an alpha, which nothing draws
            i = close - 1;
            end = token(close).begin;
            continue;
        }
        const bool assign = kind(i) == Tok::Assign;
        if (!assign) out += text(end, token(i).begin);
        const std::string_view word = text(i);
        const bool in_degrees = rotate && angle && kind(i) == Tok::Number && word != "0" &&
                                word.find_first_not_of("0123456789.") == std::string_view::npos;
        const bool twists = kind(i) == Tok::Number && kind(i - 1) == Tok::Assign &&
                            text(i - 2) == "twist"; // in degrees
        const bool alone =
            kind(i) == Tok::Name &&
            is_one_of(kind(i - 1), {Tok::Open, Tok::FreshOpen, Tok::ListOpen, Tok::Comma}) &&
            is_one_of(kind(i + 1), {Tok::Close, Tok::ListClose, Tok::Comma});
        if (assign)
            out += token(i).end < token(i + 1).begin ? ":" : ": ";
        else if (color && kind(i) == Tok::String)
            out += word.substr(1, word.size() - 2);
        else
            out += std::string(word) + (in_degrees || twists       ? "deg"
                                        : rotate && angle && alone ? " * 1deg"
                                                                   : "");
        end = token(i).end;
    }
    return out;
}

// `translate([1, 2, 3]) rotate(…) sphere(1)`: transforms stand behind what they move.
bool Builder::juxtaposed_calls(Index first, Index at) {
    if (kind(first) != Tok::Name || kind(first + 1) != Tok::Open ||
        !is_one_of(text(first), transforms))
        return false;
    constexpr int longest_chain = 20;
    std::string chain;
    Index shape = first;
    for (int links = 0; links < longest_chain && kind(shape) == Tok::Name &&
                        kind(shape + 1) == Tok::Open && kind(match(shape + 1) + 1) == Tok::Name;
         ++links) {
        const Index close = match(shape + 1);
        chain.insert(0, "." + transform_text(shape));
        shape = close + 1;
    }
    if (shape < at) return false;
    failed_ = shape;
    const Index end = statement_end(first);
    std::string moved(text(shape));
    for (const auto &[theirs, ours] : scad_names)
        if (moved == theirs) moved = ours;
    Diagnostic &d =
        foreign(span(first, match(first + 1)), "a transform stands behind the shape that it moves");
    if (text(first) == "color" && kind(match(first + 1) - 2) == Tok::Comma)
        d.note("what light passes through is not drawn: the alpha is left away");
    d.help("write " + in_code(moved + "(…)" + chain),
           {{{id_, token(first).begin, token(shape).end}, moved},
            {{id_, token(end - 1).end, token(end - 1).end}, chain}});
    return true;
}

// Python's `lambda p: …`, at the `p`.
bool Builder::foreign_lambda(Index at) {
    if (at == 0 || kind(at) != Tok::Name || kind(at - 1) != Tok::Name || text(at - 1) != "lambda")
        return false;
    const std::string head = std::string(text(at)) + " =>";
    Diagnostic &d = foreign(span(at - 1), "a function without a name is written `p => …`");
    if (kind(at + 1) == Tok::Colon)
        d.help("write " + in_code(head + " …"), {{span(at - 1, at + 1), head}});
    return true;
}

// `45 deg`, `5 mm`.
bool Builder::separated_unit(Index at) {
    if (at == 0 || kind(at) != Tok::Name || kind(at - 1) != Tok::Number) return false;
    const std::string_view unit = text(at);
    if (is_length_unit(unit) && !is_declared(std::string(unit))) {
        diagnostics_
            .add(Code::BadNumber, span(at - 1, at),
                 "a length has no unit: all of a scene are in the same")
            .help("leave " + in_code(unit) + " away",
                  {{{id_, token(at - 1).end, token(at).end}, ""}});
        return true;
    }
    const bool degrees = is_degree_word(unit);
    const bool radians = unit == "rad" || unit == "radians";
    if (radians || (unit == "turns" && at > 1)) {
        const bool turns = unit == "turns";
        Diagnostic &d =
            diagnostics_.add(Code::BadNumber, span(at - 1, at),
                             turns ? "the unit of turns is `turn`, and touches its number"
                                   : "an angle is in radians as it is");
        if (turns)
            d.help("write `turn`", {{{id_, token(at - 1).end, token(at).end}, "turn"}});
        else
            d.help("leave " + in_code(unit) + " away",
                   {{{id_, token(at - 1).end, token(at).end}, ""}});
        return true;
    }
    if (!degrees && unit != "deg" && unit != "rad" && unit != "turn") return false;
    const std::string angle = std::string(text(at - 1)) + (degrees ? "deg" : std::string(unit));
    diagnostics_.add(Code::BadNumber, span(at - 1, at), "a unit touches its number")
        .help("write " + in_code(angle), {{span(at - 1, at), angle}});
    return true;
}

// `l[1:3]`, at the colon.
bool Builder::foreign_slice(Index at) {
    const Index open = enclosing(at), close = match(open);
    const Tok before = open > 0 ? kind(open - 1) : Tok::End;
    const bool index = kind(open) == Tok::ListOpen &&
                       (before == Tok::Name || before == Tok::Close || before == Tok::ListClose);
    if (!index) return false;
    Diagnostic &d = foreign(span(open, close), "an index is one number; a list has no slices");
    const std::string way = "[for i in a..b { list[i] }]";
    if (before != Tok::Name || at == open + 1 || at + 1 == close || kind(open - 2) == Tok::Dot) {
        d.help("write " + in_code(way));
        return true;
    }
    const std::string from(text(token(open + 1).begin, token(at - 1).end)),
        to(text(token(at + 1).begin, token(close - 1).end)), list(text(open - 1));
    const std::string written = "[for i in " + from + ".." + to + " { " + list + "[i] }]";
    d.help("write " + in_code(written), {{span(open - 1, close), written}});
    return true;
}

// `import parts/arch.sdf`, `import math`.
bool Builder::foreign_import(Index at) {
    if (kind(at) != Tok::Name && kind(at) != Tok::Dot && kind(at) != Tok::DotDot) return false;
    Index end = at;
    while (!ends_statement(end) && kind(end) != Tok::As && text(end) != "as") ++end;
    if (kind(end - 1) != Tok::Name && kind(end - 1) != Tok::String) return false;
    const std::string written(text(token(at).begin, token(end - 1).end));
    if (is_foreign_module(written)) {
        failed_ = end;
        foreign(span(at), "the mathematical functions need no module")
            .help("leave the line away",
                  {{{id_, token(at - 1).begin, token(statement_end(at) - 1).end}, ""}});
        return true;
    }
    Index from = at; // `import sphere from "shapes"`
    while (!ends_statement(from) && text(from) != "from") ++from;
    if (kind(from) == Tok::Name && kind(from + 1) == Tok::String) {
        failed_ = from;
        foreign(span(at - 1, from),
                "`import` brings all names of a file, and the library needs none")
            .help("leave the line away, or write `import \"file.sdf\"`",
                  {{{id_, token(at - 1).begin, token(statement_end(at) - 1).end}, ""}});
        return true;
    }
    constexpr std::array<std::string_view, 16> theirs = {
        "bpy",   "bmesh", "mathutils", "random", "os",       "sys",       "time",    "scipy",
        "cmath", "sdf",   "trimesh",   "solid",  "cadquery", "build123d", "libfive", "matplotlib"};
    if (is_one_of(text(at), theirs) && !written.ends_with("sdf\"") && !written.ends_with(".sdf")) {
        failed_ = end;
        foreign(span(at), "a library of another language cannot be brought in")
            .help("leave the line away",
                  {{{id_, token(at - 1).begin, token(statement_end(at) - 1).end}, ""}});
        return true;
    }
    const std::string path = "\"" + written + (written.ends_with(".sdf") ? "\"" : ".sdf\"");
    foreign(span(at, end - 1), "a module is named by its file, in double quotes")
        .help("write `import " + path + "`", {{span(at, end - 1), path}});
    return true;
}

// -- names in the parentheses, as libfive and Bauble have them -------------------------------------

// Without parentheses around all of it.
static std::string bare(const std::string &value) {
    int depth = 0;
    for (std::size_t i = 0; i < value.size(); ++i) {
        depth += value[i] == '(' ? 1 : value[i] == ')' ? -1 : 0;
        if (depth == 0 && i + 1 < value.size()) return value;
    }
    return value.starts_with('(') ? value.substr(1, value.size() - 2) : value;
}

// One value as it is written here, and past it; empty where it is none.
std::string Builder::lisp_value(Index &at) const {
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
std::string Builder::lisp_part(Index at, Index end) const {
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
    std::string arguments;
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
            axis = std::string("axis: ") + static_cast<char>(value[0] - 'x' + 'X');
            continue;
        }
        arguments += (arguments.empty() ? "" : ", ") + bare(value);
    }
    if (!axis.empty()) arguments += (arguments.empty() ? "" : ", ") + axis;
    if (!named.empty()) arguments += named.substr(arguments.empty() ? 2 : 0);
    return (moves ? "translate" : name) + "(" + arguments + ")";
}

// What stands in parentheses, with Bauble's pipe: `(box 1 | move x 2)`.
std::string Builder::lisp_form(Index open) const {
    const Index close = match(open);
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
bool Builder::lisp_binding(Index open) {
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
        d.help("write " + in_code(head + " = " + value),
               {{span(open, close), head + " = " + value}});
    return true;
}

// `(sphere 100)`, also within `(union (sphere 100) …)`, at the argument.
bool Builder::lisp_call(Index at) {
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
    if (!call.empty() && call != "()")
        d.help("write " + in_code(call), {{span(open, match(open)), call}});
    else if (open + 1 == inner)
        d.help("write " + in_code(std::string(text(inner)) + "(" + std::string(text(at)) + ")"));
    else
        d.help("write " + in_code(std::string(text(open + 1)) + "(…, …)") +
               ", with commas between the arguments");
    return true;
}

// Two values with nothing between them: `translate(y 1)`, `[sphere 1, box 2]`, `f"text"`.
bool Builder::joined_by_space(Index at, bool list) {
    const Tok found = kind(at);
    const Index name = at - 1;
    const bool value = found == Tok::Number || found == Tok::String || found == Tok::Color ||
                       found == Tok::ListOpen || (found == Tok::Name && !token(at).first_on_line);
    if (at < 2 || kind(name) != Tok::Name || !value) return false;
    const Tok before = kind(name - 1);
    const std::uint32_t end = token(name).end;
    if (found == Tok::String && end == token(at).begin) {
        const std::string joined = joined_string(text(at), "{");
        Diagnostic &d = foreign(span(name, at), "a string holds no values");
        if (joined.empty())
            d.help("join it to them: `\"r = \" + r`");
        else
            d.help("write " + in_code(joined), {{span(name, at), joined}});
        return true;
    }
    if (text(name) == "new") {
        foreign(span(name), "nothing is made with `new`")
            .help("leave it away", {{{id_, token(name).begin, token(at).begin}, ""}});
        return true;
    }
    if (lisp_call(at)) return true;
    if (list && call_of_row(enclosing(at))) return true;
    if (found == Tok::Name || (before != Tok::Comma && before != Tok::Open &&
                               before != Tok::ListOpen && before != Tok::FreshListOpen))
        return false;
    const Index open = enclosing(at);
    const bool argument =
        !list && open > 0 && kind(open - 1) == Tok::Name && !is_declared(std::string(text(name)));
    if (argument) {
        foreign(span(name, at), "an argument is named with `:`")
            .help("write " + in_code(std::string(text(name)) + ": " + std::string(text(at))),
                  {{{id_, end, end}, ":"}});
        return true;
    }
    if (found == Tok::ListOpen) return false;
    foreign(span(name, at), "a call's arguments stand in parentheses")
        .help("write " + in_code(std::string(text(name)) + "(" + std::string(text(at)) + ")"),
              {{{id_, end, token(at).begin}, "("}, {{id_, token(at).end, token(at).end}, ")"}});
    return true;
}

} // namespace fathom::lang
