// Answers to the forms that people bring from GLSL, OpenSCAD, Python and C: each says what to write
// instead, with the edit where that is mechanical. What no other language has either: failures.cpp.
#include "base/text.h"
#include "lang/builder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_set>

namespace fathom::lang {

namespace {

constexpr std::array<std::string_view, 24> type_words = {
    "float", "int",   "bool",  "string", "vec2",   "vec3",     "vec4",   "mat2",
    "mat3",  "mat4",  "color", "shape",  "shape2", "material", "light",  "double",
    "ivec2", "ivec3", "uint",  "bvec2",  "bvec3",  "field",    "region", "number"};
constexpr std::array<std::string_view, 13> qualifiers = {
    "const",   "uniform", "static",  "auto",  "local", "final", "highp",
    "mediump", "lowp",    "varying", "inout", "out",   "mut"};
constexpr std::array<std::string_view, 6> function_words = {"def", "function", "func",
                                                            "fun", "module",   "void"};
constexpr std::array<std::string_view, 5> math_modules = {"math", "Math", "np", "numpy", "glm"};
constexpr std::array<std::string_view, 10> value_words = {
    "True", "False", "TRUE", "FALSE", "None", "null", "NULL", "nil", "undefined", "undef"};

} // namespace

std::string in_code(std::string_view text) { return "`" + brief(text) + "`"; }

std::string brief(std::string_view text) {
    constexpr std::size_t longest = 80;
    return text.size() > longest || text.find('\n') != std::string_view::npos ? "…"
                                                                              : std::string(text);
}

bool is_type_word(std::string_view word) { return is_one_of(word, type_words); }
bool is_foreign_value(std::string_view name) { return is_one_of(name, value_words); }
bool is_foreign_module(std::string_view name) {
    return name == "console" || is_one_of(name, math_modules);
}

// `True`, `None`, `math.sin`, unless the file has such a name of its own.
void Builder::settle_foreign_names() {
    if (foreign_names_.empty()) return;
    const std::unordered_set<std::string_view> declared(declared_.begin(), declared_.end());
    for (const ForeignName &foreign_name : foreign_names_) {
        const std::string name(text(foreign_name.span.begin, foreign_name.span.end));
        if (declared.contains(name)) continue;
        Expr &expr = ast_.exprs[foreign_name.expr];
        if (const Member *member = std::get_if<Member>(&expr.kind)) {
            const Span qualifier{id_, foreign_name.span.begin, member->name.span.begin};
            const Span all{id_, qualifier.begin, member->name.span.end};
            if (name == "console") {
                foreign(all, "a value is shown by `print`").help("write `print`", {{all, "print"}});
                expr.kind = Name{"print", word("print")};
                continue;
            }
            if (member->name.text == "PI" || member->name.text == "TAU") {
                const std::string ours = member->name.text == "PI" ? "pi" : "tau";
                foreign(all, "the mathematical constants need no module")
                    .help("write " + in_code(ours), {{all, ours}});
                expr.kind = Name{ours, word(ours == "pi" ? "pi" : "tau")};
                continue;
            }
            foreign(foreign_name.span, "the mathematical functions need no module")
                .help("write " + in_code(member->name.text), {{qualifier, ""}});
            expr.kind = Name{member->name.text, member->name.word};
        } else if (name[0] == 'T' || name[0] == 'F') {
            const bool value = name[0] == 'T';
            foreign(foreign_name.span, "truth values are written small")
                .help(value ? "write `true`" : "write `false`",
                      {{foreign_name.span, value ? "true" : "false"}});
            expr.kind = Bool{value};
        } else if (std::holds_alternative<Name>(expr.kind)) {
            foreign(foreign_name.span, "there is no " + in_code(name) + ": every name has a value")
                .note("the shape that is nowhere is `empty`, the list without items `[]`");
            expr.kind = Poison{};
        }
    }
}

// `range` ends before its end, and these languages at it where a step meets it.
static std::string range_up_to(const std::string &from, const std::string &to,
                               const std::string &by) {
    const auto a = parse_number(from), b = parse_number(to), step = parse_number(by);
    std::string end = to + " + 0.001 * " + by;
    if (a && b && step && *step != 0) {
        const double last = *a + std::floor((*b - *a) / *step + 1e-9) * *step;
        const auto is_whole = [](double x) { return x == std::floor(x); };
        const bool whole = is_whole(*a) && is_whole(*b) && is_whole(*step);
        end = format_shortest(whole ? last + (*step > 0 ? 1 : -1) : last + *step / 2);
    }
    return "range(" + from + ", " + end + ", " + by + ")";
}

// -- loops ---------------------------------------------------------------------------------------

// `for (…)` with what stands in the parentheses: `i in list`, `i = [0:8]`, `int i = 0; i < 8; i++`.
bool Builder::foreign_loop(Index at) {
    if (at == 0 || kind(at - 1) != Tok::For ||
        (kind(at) != Tok::Open && kind(at) != Tok::FreshOpen))
        return false;
    const Index close = match(at);
    const auto inside = [&](Index first, Index last) { // [first, last)
        return first < last ? std::string(text(token(first).begin, token(last - 1).end))
                            : std::string();
    };
    const auto find = [&](Index from, Index to, Tok wanted) {
        while (from < to && kind(from) != wanted)
            from = match(from) > from ? match(from) + 1 : from + 1;
        return std::min(from, to);
    };
    Diagnostic &d = foreign(span(at - 1, close), "a loop is written `for i in 0..8 { … }`");
    const auto propose = [&](const std::string &head) {
        std::vector<Edit> edits{{span(at, close), head}};
        Index end = close + 1; // of a body without braces
        while (!ends_statement(end) && kind(end) != Tok::ListClose && kind(end) != Tok::Close)
            end = match(end) > end ? match(end) + 1 : end + 1;
        if (kind(close + 1) != Tok::Body && end > close + 1) {
            edits.push_back({{id_, token(close + 1).begin, token(close + 1).begin}, "{ "});
            edits.push_back({{id_, token(end - 1).end, token(end - 1).end}, " }"});
        }
        d.help("write `for " + head + " { … }`", std::move(edits));
        return true;
    };
    Index i = at + 1;
    while (kind(i) == Tok::Let || kind(i) == Tok::Var ||
           (kind(i) == Tok::Name && kind(i + 1) == Tok::Name && text(i + 1) != "of"))
        ++i;
    if (kind(i) == Tok::Name && kind(i + 1) == Tok::Name && text(i + 1) == "of")
        return propose(std::string(text(i)) + " in " + inside(i + 2, close));
    if (kind(i) == Tok::Name && kind(i + 1) == Tok::In) return propose(inside(i, close));
    while (i < close && kind(i + 1) != Tok::Assign) ++i;
    if (i >= close || kind(i) != Tok::Name) return true;
    const std::string name(text(i));
    const Index value = i + 2, end_value = find(value, close, Tok::End);
    if (end_value == close) {
        if (kind(value) != Tok::ListOpen) return propose(name + " in " + inside(value, close));
        const Index end = match(value);
        if (end + 1 != close) {
            d.help("write a loop for each variable, one in another");
            return true;
        }
        const Index one = find(value + 1, end, Tok::Colon);
        if (one == end) return propose(name + " in " + inside(value, close));
        const Index two = find(one + 1, end, Tok::Colon);
        const std::string from = inside(value + 1, one);
        if (two == end) return propose(name + " in " + from + "..=" + inside(one + 1, end));
        const std::string by = inside(one + 1, two);
        return propose(name + " in " + range_up_to(from, inside(two + 1, end), by));
    }
    const Index test = end_value + 1, end_test = find(test, close, Tok::End);
    const bool below = kind(test + 1) == Tok::Less, upto = kind(test + 1) == Tok::LessEqual;
    if (end_test == close || text(test) != name || (!below && !upto)) return true;
    const std::string from = inside(value, end_value), to = inside(test + 2, end_test);
    const Index count = end_test + 1;
    const bool by_one = kind(count) == Tok::PlusPlus || kind(count + 1) == Tok::PlusPlus;
    if (by_one) return propose(name + " in " + from + (below ? ".." : "..=") + to);
    if (kind(count + 1) != Tok::PlusAssign) return true;
    const std::string by = inside(count + 2, close);
    return propose(
        name + " in " +
        (below ? "range(" + from + ", " + to + ", " + by + ")" : range_up_to(from, to, by)));
}

// -- declarations --------------------------------------------------------------------------------

// The parameters between two parentheses, as they would be written here.
std::string Builder::parameters_text(Index open) const {
    const Index close = match(open);
    std::string out;
    for (Index i = open + 1; i < close;) {
        Index end = i;
        while (end < close && kind(end) != Tok::Comma)
            end = match(end) > end ? match(end) + 1 : end + 1;
        while (i + 1 < end && (is_one_of(text(i), qualifiers) || kind(i) == Tok::In)) ++i;
        if (!out.empty()) out += ", ";
        const bool type_first = kind(i) == Tok::Name && kind(i + 1) == Tok::Name && i + 1 < end;
        const std::string rest(end > i ? text(token(i).begin, token(end - 1).end) : "");
        if (!type_first)
            out += rest;
        else
            out += std::string(text(i + 1)) + ": " + std::string(text(i)) +
                   std::string(text(token(i + 1).end, token(end - 1).end));
        i = end + 1;
    }
    return out;
}

// Is the name that is declared here given another value in the rest of its block?
bool Builder::is_assigned_after(Index name) const {
    constexpr std::array changes{Tok::Assign,     Tok::PlusAssign,  Tok::MinusAssign,
                                 Tok::StarAssign, Tok::SlashAssign, Tok::OtherAssign};
    const Index open = enclosing(name), partner = match(open),
                end = partner > open ? partner : Index(tokens_.tokens.size());
    for (Index i = name + 1; i < end; ++i) {
        if (kind(i) != Tok::Name || text(i) != text(name)) continue;
        const Tok before = kind(i - 1); // a named argument, another declaration
        if (before == Tok::Open || before == Tok::Comma || before == Tok::Name) continue;
        Index at = i + 1;
        while (kind(at) == Tok::Dot && kind(at + 1) == Tok::Name) at += 2;
        if (std::ranges::find(changes, kind(at)) != changes.end()) return true;
    }
    return false;
}

// `vec2 x = …`, `const x = …`, `float f(vec3 p) {`, `def f(x):`, `module f() {`.
bool Builder::foreign_head(Index first) {
    Index name = first;
    while (kind(name + 1) == Tok::Name) ++name;
    if (name == first || kind(name) != Tok::Name) return false;
    const std::string word(text(first)), declared(text(name));
    const std::string type(text(name - 1));
    const bool has_type = !is_one_of(type, qualifiers) && !is_one_of(type, function_words);

    if (kind(name + 1) == Tok::Open) {
        const bool is_function = is_one_of(word, function_words) || is_one_of(type, type_words);
        if (!is_function) return false;
        const Index close = match(name + 1);
        if (declared.starts_with("main") && word == "void") {
            foreign(span(first, name), "a scene has no " + in_code(declared))
                .note("the shapes that stand at top level are the scene");
            return true;
        }
        const bool colon = kind(close + 1) == Tok::Colon;
        std::string head = "fn " + declared + "(" + parameters_text(name + 1) + ")";
        if (has_type) head += " -> " + type;
        if (colon) {
            std::vector<Edit> edits{{span(first, close), head}};
            if (!indented_body(close + 1, edits)) edits.clear();
            foreign(span(first, name),
                    "a function is declared with `fn`, and its body stands in braces")
                .help("write `" + head + " { … }`", std::move(edits));
            return true;
        }
        foreign(span(first, name), "a function is declared with `fn`")
            .help("write " + in_code(head), {{span(first, close), head}});
        return true;
    }
    const bool curv = name == first + 1 && !is_one_of(word, qualifiers) &&
                      !is_one_of(word, type_words) && !is_one_of(word, function_words);
    if (kind(name + 1) == Tok::Assign && curv) {
        const std::string head = "fn " + word + "(" + declared + ")";
        lost_.push_back(first);
        foreign(span(first, name), "a function is declared with `fn`")
            .help("write " + in_code(head), {{span(first, name), head}});
        return true;
    }
    if (kind(name + 1) == Tok::Assign) {
        const bool changes = is_assigned_after(name);
        const std::string let =
            (changes ? "var " : "let ") + declared + (has_type && !changes ? ": " + type : "");
        Diagnostic &d = foreign(span(first, name),
                                changes    ? "a name that is assigned to later is bound with `var`"
                                : has_type ? "a type stands behind its name, after `let`"
                                           : "a name is bound with `let`");
        d.help("write " + in_code(let + " = …"), {{span(first, name), let}});
        return true;
    }
    if (is_one_of(type, type_words) && ends_statement(name + 1)) {
        lost_.push_back(name);
        foreign(span(first, name), "a name is bound together with its value")
            .help(word == "uniform" ? "a number from outside is `param " + declared +
                                          " = 1 in 0..2`, the seconds are `time`"
                                    : "write `let " + declared + ": " + type + " = …`");
        return true;
    }
    return false;
}

// -- where a statement should have ended ---------------------------------------------------------

bool Builder::foreign_junk(Index first, Index at) {
    const Tok found = kind(at);
    if (kind(first) == Tok::Name && kind(first + 1) == Tok::Name && foreign_head(first))
        return true;
    if (found == Tok::Name && juxtaposed_calls(first, at)) return true;
    const bool after_loop =
        (kind(first) == Tok::For || kind(first) == Tok::While) && kind(at - 1) == Tok::BraceClose;
    // what begins another statement wants a line of its own, and no operator does
    const bool starts = found == Tok::Name || found == Tok::Number || found == Tok::Let ||
                        found == Tok::Var || found == Tok::For || found == Tok::If ||
                        found == Tok::While || found == Tok::Return;
    if (after_loop && !ends_statement(at) && !starts) {
        Diagnostic &d = diagnostics_.add(Code::WrongPlace, span(at),
                                         "a loop has no value that this could apply to");
        d.label(span(first), "the loop");
        if (kind(first) == Tok::For && found == Tok::Dot)
            d.help("wrap it in `union { … }`",
                   {{{id_, token(first).begin, token(first).begin}, "union { "},
                    {{id_, token(at - 1).end, token(at - 1).end}, " }"}});
        return true;
    }
    if (foreign_lambda(at) || separated_unit(at)) return true;
    if (found == Tok::Name && kind(at - 1) == Tok::Name && text(at - 1) == "new") {
        foreign(span(at - 1), "nothing is made with `new`")
            .help("leave it away", {{{id_, token(at - 1).begin, token(at).begin}, ""}});
        return true;
    }
    if (found == Tok::String && kind(at - 1) == Tok::String &&
        token(at - 1).end == token(at).begin) { // `"""…"""`
        const bool whole = kind(at + 1) == Tok::String && ends_statement(at + 2);
        std::vector<Edit> edits;
        if (whole)
            edits.push_back({span(at - 1, at + 1),
                             "// " + std::string(text(token(at).begin + 1, token(at).end - 1))});
        foreign(span(at - 1, whole ? at + 1 : at), "a comment begins with `//`")
            .help("write `// …`", std::move(edits));
        return true;
    }
    if (found == Tok::In && kind(first) == Tok::Let) {
        foreign(span(at), "a name is known to the end of its block, without `in`")
            .help("end the `let`, with a line's end or `;`",
                  {{{id_, token(at - 1).end, token(at).end}, ";"}});
        return true;
    }
    if (found == Tok::String && kind(at - 1) == Tok::Name && token(at - 1).end == token(at).begin)
        return joined_by_space(at, false);
    const std::string name(text(first));
    const bool all = name == "assert" || name == "print" || name == "echo"; // `assert 1 < 2`
    const bool literal = found == Tok::Number || found == Tok::String || found == Tok::Color ||
                         (all && found == Tok::Name);
    if (literal && kind(first) == Tok::Name && at == first + 1) {
        Diagnostic &d = foreign(span(first, at), "a call's arguments stand in parentheses");
        const Index last = all ? statement_end(first) - 1 : at;
        d.help("write " +
                   in_code(name + "(" + std::string(text(token(at).begin, token(last).end)) + ")"),
               {{{id_, token(first).end, token(at).begin}, "("},
                {{id_, token(last).end, token(last).end}, ")"}});
        return true;
    }
    if (found == Tok::Arrow) {
        foreign(span(at), "a function without a name is written with `=>`")
            .help("write `=>`", {{span(at), "=>"}});
        return true;
    }
    if (found == Tok::FatArrow) {
        if (kind(first) != Tok::Name || kind(first + 1) != Tok::Open || match(first + 1) + 1 != at)
            return false;
        foreign(span(first, at), "a function with a name is declared with `fn`")
            .help("write `fn " + std::string(text(token(first).begin, token(at - 1).end)) + " = …`",
                  {{{id_, token(first).begin, token(first).begin}, "fn "}, {span(at), "="}});
        return true;
    }
    if (found == Tok::Colon) {
        if (kind(first) != Tok::Name || at != first + 1) return false;
        if (first > 0 && kind(first - 1) == Tok::Trailing) { // `torus{major: 2}`
            const Index open = first - 1;
            foreign(span(open), "a call's arguments stand in parentheses")
                .help("write `( … )`", {{span(open), "("}, {span(match(open)), ")"}});
            return true;
        }
        foreign(span(first), "a new name is bound with `let`")
            .help("write `let " + name + "`",
                  {{{id_, token(first).begin, token(first).begin}, "let "}});
        return true;
    }
    if (found == Tok::OtherAssign) {
        if (kind(first) != Tok::Name) return false;
        const std::string target(text(token(first).begin, token(at - 1).end));
        const std::string op(text(at).substr(0, 1));
        foreign(span(at), "there is no " + in_code(text(at)))
            .help("write `" + target + " = " + target + " " + op + " …`",
                  {{span(at), "= " + target + " " + op}});
        return true;
    }
    if (found == Tok::Comma) {
        if (kind(first) == Tok::Name && at == first + 1 && kind(at + 1) == Tok::Name) {
            foreign(span(first, at + 1), "each name is bound by a `let` of its own")
                .help("write `let " + name + " = …`");
            for (Index i = first; kind(i) == Tok::Name; i += 2) lost_.push_back(i);
            return true;
        }
        if (kind(first) != Tok::Let && kind(first) != Tok::Var) return false;
        if (kind(at + 1) == Tok::Name) lost_.push_back(at + 1);
        foreign(span(at), "each name is bound by a `let` of its own")
            .help("write `; let`", {{span(at), "; " + std::string(text(first))}});
        return true;
    }
    if (found == Tok::If) {
        foreign_choice(value_start(first, at), at);
        return true;
    }
    if (found != Tok::In) return false;
    foreign(span(at), "there is no operator `in`");
    return true;
}

} // namespace fathom::lang
