// Answers to the words and blocks that people bring from Python, JavaScript, Curv and OpenSCAD:
// statements that begin with a word of theirs, records, pipes. Bodies without braces are in
// bodies.cpp, the forms that look like ours in answers.cpp.
#include "lang/foreign/foreign.h"

#include "lang/lexer.h"

#include <algorithm>
#include <array>

namespace fathom::lang {

namespace {

struct ForeignWord {
    std::string_view word, message, help;
    bool drop = false;     // the statement can be left away
    bool declares = false; // the next word, whose uses are no new errors
};

// Words that begin a statement elsewhere. They are names here, so only what follows tells: no `=`,
// no `.`, and a `(` only where `called`.
constexpr ForeignWord statement_words[] = {
    {"class", "there are no classes", "a function with parameters makes the variants of a shape",
     false, true},
    {"impl", "there are no methods of types",
     "`p.f(x)` is `f(p, x)`: any function is applied by a dot"},
    {"trait", "there are no user-defined types", "the types are those of the language", true, true},
    {"mod", "a module is a file of its own", "a file is brought in by `import \"file.sdf\"`"},
    {"namespace", "a module is a file of its own", "a file is brought in by `import \"file.sdf\"`"},
    {"struct", "there are no records", "give each part a name of its own with `let`", false, true},
    {"enum", "there are no enumerations", "give each number a name of its own with `let`"},
    {"interface", "there are no user-defined types", "leave it away", true, true},
    {"typedef", "there are no user-defined types", "the types are those of the language"},
    {"type", "there are no user-defined types", "leave it away", true, true},
    {"from", "the library needs no import", "a file is brought in by `import \"file.sdf\"`", true},
    {"include", "a file is brought in by `import`", "write `import \"file.sdf\"`"},
    {"use", "the library needs no import", "a file is brought in by `import \"file.sdf\"`", true},
    {"using", "the library needs no import", "a file is brought in by `import \"file.sdf\"`", true},
    {"precision", "every number is of single precision", "leave the line away", true},
    {"shader_type", "a scene is no shader", "leave the line away", true},
    {"render_mode", "a scene is no shader", "leave the line away", true},
    {"global", "a function reads the names around it as they are", "leave the line away", true},
    {"nonlocal", "a function reads the names around it as they are", "leave the line away", true},
    {"del", "a name lasts as long as its block", "leave the line away", true},
    {"async", "a scene waits for nothing", "a function is declared with `fn`"},
    {"await", "a scene waits for nothing", "leave the word away"},
    {"yield", "a list is made by a loop in brackets", "write `[for i in 0..n { … }]`"},
    {"raise", "a scene throws nothing", "a condition is tested by `assert(condition, \"why\")`"},
    {"throw", "a scene throws nothing", "a condition is tested by `assert(condition, \"why\")`"},
    {"try", "a scene catches nothing", "a condition is tested by `assert(condition, \"why\")`"},
    {"except", "a scene catches nothing", "a condition is tested by `assert(condition, \"why\")`"},
    {"finally", "a scene catches nothing", "leave the word away"},
    {"with", "a transform stands behind the shape that it moves",
     "write `sphere(1).translate(x: 1)`"},
    {"loop", "a loop is written `for i in 0..8 { … }`",
     "write `for i in 0..n { … }`, or `while true limit 100 { … }`"},
    {"foreach", "a loop is written `for i in 0..8 { … }`", "write `for x in list { … }`"},
    {"unless", "a choice is written with `if`", "write `if not (condition) { … }`"},
    {"until", "a loop is written with `while`", "write `while not (condition) { … }`"},
    {"parametric", "a parameter is declared with `param`", "write `param r = 2 in 1..3`"},
    {"elif", "a choice goes on with `else if`", "write `} else if condition { … }`"},
    {"switch", "a choice is written with `if`", "write `if a { … } else if b { … } else { … }`"},
    {"match", "a choice is written with `if`", "write `if a { … } else if b { … } else { … }`"},
    {"do", "a loop begins with its condition", "write `while condition limit n { … }`"}};

bool begins_value(Tok kind) {
    return is_one_of(kind, {Tok::Name, Tok::Number, Tok::String, Tok::Open, Tok::ListOpen,
                            Tok::FreshListOpen, Tok::LambdaName, Tok::If});
}

} // namespace

// -- statements ----------------------------------------------------------------------------------

bool ForeignSyntax::foreign_statement(Index first) {
    if (kind(first) == Tok::Name && named_group(first)) return true;
    const auto begins_record = [&](Index i) {
        return kind(i) == Tok::StrayBrace || kind(i) == Tok::Trailing;
    };
    const bool binds = kind(first) == Tok::Let || kind(first) == Tok::Var ||
                       (kind(first) == Tok::Name && text(first) == "const");
    // `let [a, b] = …`, `const { sphere } = require(…)`
    const bool list = kind(first + 1) == Tok::ListOpen || kind(first + 1) == Tok::FreshListOpen;
    if (binds && (begins_record(first + 1) || list)) {
        const Index close = match(first + 1);
        if (kind(close + 1) != Tok::Assign) return false;
        failed_ = close + 1;
        const bool library = kind(close + 2) == Tok::Name && text(close + 2) == "require";
        withdraw_quotes(first);
        if (!library) {
            destructuring(first, first + 2, close, close + 1);
            return true;
        }
        foreign(span(first, close), "each name is bound by a `let` of its own")
            .help("the library needs no import: leave the line away",
                  {{{id_, token(first).begin, token(statement_end(first) - 1).end}, ""}});
        return true;
    }
    // `import { a } from '…'`, `import("part.stl")`
    if (kind(first) == Tok::Import && kind(first + 1) != Tok::String) {
        failed_ = first + 1;
        const Index end = statement_end(first);
        if (begins_record(first + 1)) {
            withdraw_quotes(first);
            foreign(span(first), "`import` brings all names of a file, and the library needs none")
                .help("leave the line away, or write `import \"file.sdf\"`",
                      {{{id_, token(first).begin, token(end - 1).end}, ""}});
            return true;
        }
        if (kind(first + 1) == Tok::Star) { // `import *`, `import * from "parts.sdf"`
            const bool named = kind(end - 1) == Tok::String;
            withdraw_quotes(first);
            Diagnostic &d =
                foreign(span(first, first + 1),
                        "`import` brings all names of a file, and the library needs none");
            if (named)
                d.help("leave `* from` away",
                       {{{id_, token(first + 1).begin, token(end - 1).begin}, ""}});
            else
                d.help("leave the line away",
                       {{{id_, token(first).begin, token(end - 1).end}, ""}});
            return true;
        }
        if (kind(first + 1) == Tok::Open && kind(first + 2) == Tok::String) {
            foreign(span(first, match(first + 1)), "a mesh cannot be brought in")
                .help("`import \"file.sdf\"` brings another scene's names, `distance_grid(file)` a "
                      "grid of distances (OpenVDB, NRRD)");
            return true;
        }
        return false;
    }
    if (called_record(binds ? first + 3 : first + 2) || of_openscad(first)) return true;
    if (kind(first) != Tok::Name) return false;
    if ((text(first) == "module" && kind(first + 1) == Tok::Dot && text(first + 2) == "exports") ||
        (text(first) == "exports" && !may_be_declared("exports") &&
         is_one_of(kind(first + 1), {Tok::Dot, Tok::Assign}))) {
        failed_ = first + 1;
        foreign(span(first, first + 1), "the shapes of a file are the scene")
            .help("leave it away",
                  {{{id_, token(first).begin, token(statement_end(first) - 1).end}, ""}});
        return true;
    }
    if (text(first) == "export" && kind(first + 1) == Tok::Name && text(first + 1) == "default") {
        failed_ = first + 1;
        foreign(span(first, first + 1), "the shapes of a file are the scene")
            .help("leave `export default` away",
                  {{{id_, token(first).begin, token(first + 2).begin}, ""}});
        return true;
    }
    if (curv_block(first) || print_stream(first) || python_import(first) || of_other_program(first))
        return true;
    const auto *row = std::ranges::find(statement_words, text(first), &ForeignWord::word);
    if (row == std::end(statement_words) || is_declared(std::string(text(first)))) return false;
    const Tok next = kind(first + 1);
    const bool called = (text(first) == "switch" || text(first) == "match") &&
                        kind(match(first + 1) + 1) == Tok::Trailing;
    const bool caught =
        is_one_of(text(first), std::array<std::string_view, 3>{"try", "except", "finally"});
    const bool block = caught || text(first) == "do" || text(first) == "loop";
    const bool applies = next == Tok::Name || next == Tok::Fn || next == Tok::Less ||
                         next == Tok::True || next == Tok::False ||
                         (next == Tok::Trailing && block) || (next == Tok::Colon && caught) ||
                         (next == Tok::Open && called);
    if (!applies || ((called || block) && may_be_declared(text(first)))) return false;
    failed_ = first + 1;
    std::vector<Edit> unused;
    for (Index i = first + 1; i < tokens_.tokens.size() && !ends_statement(i);
         i = match(i) > i ? match(i) + 1 : i + 1)
        if (kind(i) == Tok::Colon) {
            indented_body(i, unused);
            break;
        }
    if (next == Tok::Trailing) { // `try { … } catch (e) { … }`
        const Index after = match(first + 1) + 1;
        if (kind(after) == Tok::Name && !token(after).first_on_line) failed_ = after;
    }
    if (text(first) == "parametric" && curv_slider(first)) return true;
    if (text(first) == "try" && tried_block(first)) return true;
    if (c_statement(first)) return true;
    if (text(first) == "enum") {
        enumeration(first);
        return true;
    }
    if (next == Tok::Name && row->declares) lost_.push_back(first + 1);
    Diagnostic &d = foreign(span(first), std::string(row->message));
    const Index end = statement_end(first);
    if (text(first) == "async" || text(first) == "await")
        d.help("leave the word away", {{{id_, token(first).begin, token(first + 1).begin}, ""}});
    else if (row->drop)
        d.help(std::string(row->help), {{{id_, token(first).begin, token(end - 1).end}, ""}});
    else
        d.help(std::string(row->help));
    return true;
}

// Whether the file has such a name of its own, above or below, or may bring one by an import.
bool ForeignSyntax::may_be_declared(std::string_view name) {
    if (!all_declared_) {
        all_declared_.emplace();
        for (Index i = 0; i + 1 < tokens_.tokens.size(); ++i) {
            const Tok k = kind(i);
            has_import_ = has_import_ || k == Tok::Import;
            const bool declares = k == Tok::Let || k == Tok::Var || k == Tok::Fn || k == Tok::Param;
            if (declares && kind(i + 1) == Tok::Name) all_declared_->insert(text(i + 1));
        }
    }
    return has_import_ || all_declared_->contains(name) || is_declared(std::string(name));
}

// What was said of the strings in a statement that goes as a whole.
void ForeignSyntax::withdraw_quotes(Index first) {
    for (Index i = first, end = statement_end(first); i < end; ++i)
        if (kind(i) == Tok::String) diagnostics_.withdraw(Code::ForeignSyntax, span(i));
}

// -- operators -----------------------------------------------------------------------------------

// `a if c else b`, at the `if`; `start` is where `a` begins.
void ForeignSyntax::foreign_choice(Index start, Index at) {
    Diagnostic &d = foreign(span(at), "a choice begins with its condition");
    Index other = at + 1;
    const auto step = [&](Index i) { return match(i) > i ? match(i) + 1 : i + 1; };
    const auto stops = [&](Index i) {
        return ends_statement(i) || kind(i) == Tok::Comma || kind(i) == Tok::Close ||
               kind(i) == Tok::ListClose;
    };
    while (!stops(other) && kind(other) != Tok::Else) other = step(other);
    Index end = other + 1;
    while (!stops(end)) end = step(end);
    if (kind(other) != Tok::Else || start >= at || end == other + 1) {
        d.help("write `if c { a } else { b }`");
        return;
    }
    const auto part = [&](Index first, Index past) {
        return std::string(text(token(first).begin, token(past - 1).end));
    };
    const std::string written = "if " + part(at + 1, other) + " { " + part(start, at) +
                                " } else { " + part(other + 1, end) + " }";
    if (written.find('\n') == std::string::npos)
        d.help(to_write(written), {{span(start, end - 1), written}});
}

// Where the value begins that stands before a token: behind a `=`, a bracket or a comma.
ForeignSyntax::Index ForeignSyntax::value_start(Index first, Index at) const {
    Index start = at;
    while (start > first) {
        const Index before = start - 1;
        if (match(before) < before) {
            start = match(before);
            continue;
        }
        const Tok k = kind(before);
        if (k == Tok::Assign || k == Tok::Comma || k == Tok::Colon || k == Tok::Return ||
            k == Tok::FatArrow || k == Tok::End || k == Tok::In || match(before) > before)
            break;
        start = before;
    }
    return start;
}

// `sphere(1) >> rotate(x)` and `a |> f(x)`, whose sign ends at `at`.
void ForeignSyntax::foreign_pipe(Index at) {
    if (spaced_statement(at)) return;
    const Index sign = at - 1, start = value_start(0, sign);
    Diagnostic &d = foreign(span(sign, at), "there is no operator " +
                                                in_code(text(token(sign).begin, token(at).end)));
    const bool call = kind(sign - 1) == Tok::Close && kind(start) == Tok::Name;
    bool chain = call; // of calls: an operand by itself
    for (Index i = start; chain && i<sign; i = match(i)> i ? match(i) + 1 : i + 1)
        chain = kind(i) == Tok::Name || kind(i) == Tok::Dot || kind(i) == Tok::Open;
    const Index name = at + 1, open = at + 2;
    const bool ready =
        kind(name) == Tok::Name && is_one_of(kind(open), {Tok::Open, Tok::Trailing, Tok::Number,
                                                          Tok::Name, Tok::ListOpen, Tok::Color});
    if (!chain || !ready) {
        d.help("a function is applied by a dot: `s.rotate(30deg)` for `rotate(s, 30deg)`");
        return;
    }
    std::vector<Edit> edits;
    pipe_edits(sign, edits);
    d.help("a function is applied by a dot", std::move(edits));
}

// `[1, 2] ++ [3]`, of which the first is the operand on top.
bool ForeignSyntax::foreign_concat(Index at) {
    if (kind(at) != Tok::PlusPlus || ends_statement(at + 1)) return false;
    if (!begins_value(kind(at + 1))) { // `while (i++ < 5)`
        foreign(span(at), "there is no `++` within a value")
            .help("a name is counted up by `i += 1`, a statement of its own in a function; a loop "
                  "that counts is `for i in 0..5 { … }`");
        return true;
    }
    const Index start = value_start(0, at);
    Index end = at + 1;
    while (!ends_statement(end) && kind(end) != Tok::Comma && kind(end) != Tok::Close &&
           kind(end) != Tok::ListClose && kind(end) != Tok::PlusPlus)
        end = match(end) > end ? match(end) + 1 : end + 1;
    if (end == at + 1) return false;
    foreign(span(at), "lists are joined by `concat`")
        .help("write `concat(a, b)`", {{{id_, token(start).begin, token(start).begin}, "concat("},
                                       {{id_, token(at - 1).end, token(at + 1).begin}, ", "},
                                       {{id_, token(end - 1).end, token(end - 1).end}, ")"}});
    return true;
}

// -- records -------------------------------------------------------------------------------------

// `f({a: 1})`, `f{a: 1}`, `{"a": 1}`: a brace where a value would stand.
bool ForeignSyntax::foreign_record(Index brace) {
    const Index close = match(brace);
    const bool names = kind(brace + 2) == Tok::Colon;
    const bool arguments = brace > 0 && is_one_of(kind(brace - 1), {Tok::Open, Tok::Comma}) &&
                           kind(close + 1) == Tok::Close && kind(brace + 1) == Tok::Name;
    if (parameters_in_braces(brace) || named_record(brace)) return true;
    if (!names && kind(brace + 1) != Tok::BraceClose) return false;
    if (arguments && names) {
        foreign(span(brace), "arguments with names need no braces")
            .help("leave the braces away", {{span(brace), ""}, {span(close), ""}});
        return true;
    }
    foreign(span(brace), "there are no records")
        .help("give each part a name of its own with `let`");
    return true;
}

} // namespace fathom::lang
