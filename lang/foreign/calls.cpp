// Answers to calls as other languages write them: arguments without parentheses, lambdas, units
// apart from their numbers, slices, imports.
#include "lang/foreign/foreign.h"
#include "lang/lexer.h"

#include <algorithm>
#include <array>

namespace fathom::lang {

// Python's `lambda p: …`, at the `p`.
bool ForeignSyntax::foreign_lambda(Index at) {
    if (at == 0 || kind(at) != Tok::Name || kind(at - 1) != Tok::Name || text(at - 1) != "lambda")
        return false;
    const std::string head = std::string(text(at)) + " =>";
    Diagnostic &d = foreign(span(at - 1), "a function without a name is written `p => …`");
    if (kind(at + 1) == Tok::Colon) d.help(to_write(head + " …"), {{span(at - 1, at + 1), head}});
    return true;
}

// `45 deg`, `5 mm`.
bool ForeignSyntax::separated_unit(Index at) {
    if (at == 0 || kind(at) != Tok::Name) return false;
    if ((text(at) == "deg" || is_degree_word(text(at))) && kind(at - 1) == Tok::Name &&
        !token(at).first_on_line && !is_declared(std::string(text(at)))) { // `a deg`
        const bool whole = at > 1 && kind(at - 2) != Tok::Dot;
        const std::string written = "radians(" + std::string(text(at - 1)) + ")";
        foreign(span(at - 1, at), "a unit touches a number; what a name holds is converted")
            .help("write " + in_code(whole ? written : "radians(…)"),
                  whole ? std::vector<Edit>{{span(at - 1, at), written}} : std::vector<Edit>{});
        return true;
    }
    if (kind(at - 1) != Tok::Number) return false;
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
        .help(to_write(angle), {{span(at - 1, at), angle}});
    return true;
}

// `l[1:3]`, at the colon.
bool ForeignSyntax::foreign_slice(Index at) {
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
    d.help(to_write(written), {{span(open - 1, close), written}});
    return true;
}

// `import parts/arch.sdf`, `import math`.
bool ForeignSyntax::foreign_import(Index at) {
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

// Two values with nothing between them: `translate(y 1)`, `[sphere 1, box 2]`, `f"text"`.
bool ForeignSyntax::joined_by_space(Index at, bool list) {
    const Tok found = kind(at);
    const Index name = at - 1;
    const bool value = found == Tok::Number || found == Tok::String || found == Tok::Color ||
                       found == Tok::ListOpen || (found == Tok::Name && !token(at).first_on_line);
    const Index row = enclosing(at); // `(box [1 2 3])`
    if (list && row > 1 && kind(row - 1) == Tok::Name && enclosing(row) == row - 2 &&
        kind(at - 1) != Tok::Name && lisp_call(row))
        return true;
    if (found == Tok::FreshOpen && at > 1 && kind(name) == Tok::Name) return lisp_call(at);
    if (at < 2 || kind(name) != Tok::Name || !value) return false;
    if (list && text(name) == "each" && list_spread(name)) return true;
    const Tok before = kind(name - 1);
    const std::uint32_t end = token(name).end;
    if (found == Tok::String && end == token(at).begin) {
        const std::string joined = joined_string(text(at), "{");
        Diagnostic &d = foreign(span(name, at), "a string holds no values");
        if (joined.empty())
            d.help("join it to them: `\"r = \" + r`");
        else
            d.help(to_write(joined), {{span(name, at), joined}});
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
            .help(to_write(std::string(text(name)) + ": " + std::string(text(at))),
                  {{{id_, end, end}, ":"}});
        return true;
    }
    if (found == Tok::ListOpen) return false;
    foreign(span(name, at), "a call's arguments stand in parentheses")
        .help(to_write(std::string(text(name)) + "(" + std::string(text(at)) + ")"),
              {{{id_, end, token(at).begin}, "("}, {{id_, token(at).end, token(at).end}, ")"}});
    return true;
}

} // namespace fathom::lang
