// Answers to the forms that people bring from GLSL, OpenSCAD, Python and C: each says what to write
// instead, with the edit where that is mechanical. What no other language has either: failures.cpp.
#include "base/text.h"
#include "lang/foreign/foreign.h"
#include "lang/vocabulary.h"

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
// Of HLSL, Metal, WGSL, Rust, Unity and three.js.
constexpr std::pair<std::string_view, std::string_view> types_of_others[] = {
    {"float2", "vec2"},   {"float3", "vec3"},   {"float4", "vec4"},   {"half", "float"},
    {"half2", "vec2"},    {"half3", "vec3"},    {"half4", "vec4"},    {"fixed", "float"},
    {"fixed3", "vec3"},   {"fixed4", "vec4"},   {"double", "float"},  {"f32", "float"},
    {"f64", "float"},     {"i32", "int"},       {"u32", "int"},       {"uint", "int"},
    {"number", "float"},  {"vec2f", "vec2"},    {"vec3f", "vec3"},    {"vec4f", "vec4"},
    {"float2x2", "mat2"}, {"float3x3", "mat3"}, {"float4x4", "mat4"}, {"mat2x2", "mat2"},
    {"mat3x3", "mat3"},   {"mat4x4", "mat4"},   {"Vec2", "vec2"},     {"Vec3", "vec3"},
    {"Vector2", "vec2"},  {"Vector3", "vec3"},  {"boolean", "bool"},  {"matrix3", "mat3"},
};
constexpr std::array<std::string_view, 5> math_modules = {"math", "Math", "np", "numpy", "glm"};
constexpr std::array<std::string_view, 10> value_words = {
    "True", "False", "TRUE", "FALSE", "None", "null", "NULL", "nil", "undefined", "undef"};

} // namespace

bool is_type_word(std::string_view word) {
    return is_one_of(word, type_words) || our_type(word) != word;
}
std::string_view our_type(std::string_view type) {
    for (const auto &[theirs, ours] : types_of_others)
        if (theirs == type) return ours;
    return type;
}
bool is_foreign_value(std::string_view name) { return is_one_of(name, value_words); }
bool is_foreign_module(std::string_view name) {
    return name == "console" || is_one_of(name, math_modules);
}

// `True`, `None`, `math.sin`, unless the file has such a name of its own.
void ForeignSyntax::settle_foreign_names() {
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
                    .help(to_write(ours), {{all, ours}});
                expr.kind = Name{ours, word(ours == "pi" ? "pi" : "tau")};
                continue;
            }
            if (member->name.text == "array" || member->name.text == "asarray") {
                foreign(all, "a vector or a list stands in brackets")
                    .help("leave " + in_code(text(all.begin, all.end)) + " away", {{all, ""}});
                expr.kind = Poison{};
                continue;
            }
            foreign(foreign_name.span, "the mathematical functions need no module")
                .help(to_write(member->name.text), {{qualifier, ""}});
            expr.kind = Name{member->name.text, member->name.word};
        } else if (name[0] == 'T' || name[0] == 'F') {
            const bool value = name[0] == 'T';
            foreign(foreign_name.span, "truth values are written small")
                .help(value ? "write `true`" : "write `false`",
                      {{foreign_name.span, value ? "true" : "false"}});
            expr.kind = Bool{value};
        } else if (std::holds_alternative<Name>(expr.kind)) {
            foreign(foreign_name.span, "there is no " + in_code(name) + ": every name has a value")
                .help("leave what asks for it away; the shape that is nowhere is `empty`, the list "
                      "without items `[]`");
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

// The end of the statement on the deeper line below a header that ends at `at`; else `at`.
ForeignSyntax::Index ForeignSyntax::body_below(Index at) const {
    constexpr int most_headers = 8; // one in another
    const Index first = at + 1;
    const auto column = [&](Index i) {
        const std::size_t line = std::string_view(source_.text).rfind('\n', token(i).begin);
        return token(i).begin - (line == std::string_view::npos ? 0 : line + 1);
    };
    Index header = at;
    while (header > 0 && !token(header).first_on_line) --header;
    if (kind(at) != Tok::End || text(at) == ";" || first >= tokens_.tokens.size() ||
        !token(first).first_on_line || column(first) <= column(header))
        return at;
    Index end = first;
    for (int headers = 0; headers < most_headers; ++headers) {
        const bool nests = is_one_of(kind(end), {Tok::For, Tok::If, Tok::While});
        while (!ends_statement(end)) end = match(end) > end ? match(end) + 1 : end + 1;
        if (!nests || kind(end - 1) != Tok::Close || kind(end) != Tok::End) break;
        ++end;
    }
    return end;
}

// OpenSCAD's `x = [0, 1], y = [0:3]` up to `close`, as the heads of loops, one in another; empty
// where it is none.
std::string ForeignSyntax::scad_heads(Index name, Index close) const {
    std::string head;
    while (name < close) {
        const Index open = name + 2, end = match(open);
        if (kind(name) != Tok::Name || kind(name + 1) != Tok::Assign ||
            kind(open) != Tok::ListOpen || end <= open)
            return {};
        std::vector<std::string> parts;
        for (Index first = open + 1, i = first; i <= end; i = match(i) > i ? match(i) + 1 : i + 1) {
            if (i < end && kind(i) != Tok::Colon) continue;
            parts.emplace_back(first < i ? text(token(first).begin, token(i - 1).end) : "");
            first = i + 1;
        }
        const std::string list(text(token(open).begin, token(end).end));
        head += (head.empty() ? "" : " { for ") + std::string(text(name)) + " in " +
                (parts.size() == 1   ? list
                 : parts.size() == 2 ? parts[0] + "..=" + parts[1]
                                     : range_up_to(parts[0], parts[2], parts[1]));
        if (end + 1 < close && kind(end + 1) != Tok::Comma) return {};
        name = end + 2;
    }
    return head;
}

// `for (…)` with what stands in the parentheses: `i in list`, `i = [0:8]`, `int i = 0; i < 8; i++`.
bool ForeignSyntax::foreign_loop(Index at) {
    if (at == 0 || kind(at - 1) != Tok::For ||
        (kind(at) != Tok::Open && kind(at) != Tok::FreshOpen))
        return false;
    const Index close = match(at);
    const auto inside = [&](Index first, Index last) { // [first, last)
        std::string out;
        for (Index i = first; i < last; ++i) {
            if (i > first) out += text(token(i - 1).end, token(i).begin);
            out += text(i) == "..<" ? ".." : text(i); // put right with the rest
        }
        return out;
    };
    const auto find = [&](Index from, Index to, Tok wanted) {
        while (from < to && kind(from) != wanted)
            from = match(from) > from ? match(from) + 1 : from + 1;
        return std::min(from, to);
    };
    for (Index i = at; i < close; ++i)
        if (text(i) == "..<") diagnostics_.withdraw(Code::ForeignSyntax, span(i));
    Diagnostic &d = foreign(span(at - 1, close), "a loop is written `for i in 0..8 { … }`");
    const auto propose = [&](const std::string &head) {
        std::vector<Edit> edits{{span(at, close), (touch(at - 1, at) ? " " : "") + head}};
        const auto inner = std::ranges::count(head, '{'); // loops within the first
        std::string closed = " }";
        for (auto n = inner; n > 0; --n) closed += " }";
        Index end = close + 1; // of a body without braces
        const bool below = body_below(close + 1) > close + 1;
        if (below) {
            end = body_below(close + 1);
            edits[0].replacement += " {";
            edits.push_back({{id_, token(end - 1).end, token(end - 1).end}, closed});
            failed_ = end - 1;
        }
        while (!ends_statement(end) && kind(end) != Tok::ListClose && kind(end) != Tok::Close)
            end = match(end) > end ? match(end) + 1 : end + 1;
        if (!below && kind(close + 1) != Tok::Body && end > close + 1) {
            edits.push_back({{id_, token(close + 1).begin, token(close + 1).begin}, "{ "});
            edits.push_back({{id_, token(end - 1).end, token(end - 1).end}, closed});
        } else if (!below && inner > 0) {
            const Index last = match(close + 1);
            edits.push_back({{id_, token(last).end, token(last).end}, closed.substr(2)});
        }
        d.help("write `for " + head + " { … }`", std::move(edits));
        return true;
    };
    if (kind(close + 1) == Tok::In && kind(at + 2) == Tok::Comma) return loop_of_tuple(at, d);
    Index i = at + 1;
    while (kind(i) == Tok::Let || kind(i) == Tok::Var ||
           (kind(i) == Tok::Name && text(i) == "const") ||
           (kind(i) == Tok::Name && kind(i + 1) == Tok::Name && text(i + 1) != "of"))
        ++i;
    if (is_one_of(kind(i), {Tok::ListOpen, Tok::FreshListOpen, Tok::Open})) { // `[i, r] of l`
        std::string lets, head = loop_of_parts(i, inside(match(i) + 2, close), lets);
        if (head.empty()) return true;
        propose(head);
        const Index body = match(close + 1) > close + 1 ? close + 2 : close + 1;
        if (d.fix) d.fix->edits.push_back({{id_, token(body).begin, token(body).begin}, lets});
        return true;
    }
    if (kind(i) == Tok::Name && kind(i + 1) == Tok::Name && text(i + 1) == "of")
        return propose(std::string(text(i)) + " in " + inside(i + 2, close));
    if (kind(i) == Tok::Name && kind(i + 1) == Tok::In) return propose(inside(i, close));
    Index colon = i; // `const auto &r : radii`
    while (colon < close && !is_one_of(kind(colon), {Tok::Colon, Tok::Assign, Tok::End})) ++colon;
    const bool typed = kind(colon) == Tok::Colon && kind(colon + 2) == Tok::Assign; // `i: i32 = 0`
    if (!typed && kind(colon) == Tok::Colon && kind(colon - 1) == Tok::Name && colon + 1 < close)
        return propose(std::string(text(colon - 1)) + " in " + inside(colon + 1, close));
    while (i < close && kind(i + 1) != Tok::Assign) ++i;
    if (i >= close || kind(i) != Tok::Name) return true;
    const std::string name(text(typed ? colon - 1 : i));
    const Index value = i + 2, end_value = find(value, close, Tok::End);
    if (end_value == close) {
        if (kind(value) != Tok::ListOpen) return propose(name + " in " + inside(value, close));
        const Index end = match(value);
        if (end + 1 != close) {
            const std::string head = scad_heads(i, close);
            if (head.empty()) {
                d.help("write a loop for each variable, one in another");
                return true;
            }
            return propose(head);
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
    const bool above = kind(test + 1) == Tok::Greater, downto = kind(test + 1) == Tok::GreaterEqual;
    if (end_test == close || text(test) != name || (!below && !upto && !above && !downto))
        return true;
    const std::string from = inside(value, end_value), to = inside(test + 2, end_test);
    const Index count = end_test + 1;
    if (above || downto) { // `i > 0; i--`
        const bool one = kind(count) == Tok::MinusMinus || kind(count + 1) == Tok::MinusMinus;
        if (!one && kind(count + 1) != Tok::MinusAssign) return true;
        const std::string down = "-" + (one ? std::string("1") : inside(count + 2, close));
        return propose(name + " in " +
                       (above ? "range(" + from + ", " + to + ", " + down + ")"
                              : range_up_to(from, to, down)));
    }
    const bool by_one = kind(count) == Tok::PlusPlus || kind(count + 1) == Tok::PlusPlus;
    if (by_one) return propose(name + " in " + from + (below ? ".." : "..=") + to);
    if (kind(count + 1) != Tok::PlusAssign) return true;
    const std::string by = inside(count + 2, close);
    return propose(
        name + " in " +
        (below ? "range(" + from + ", " + to + ", " + by + ")" : range_up_to(from, to, by)));
}

// -- where a statement should have ended ---------------------------------------------------------

// `sphere(r) where r = 2`, at the word.
bool ForeignSyntax::where_clause(Index first, Index at) {
    if (kind(at) != Tok::Name || text(at) != "where" || kind(at + 1) != Tok::Name ||
        kind(at + 2) != Tok::Assign)
        return false;
    failed_ = at + 2;
    const Index end = statement_end(first);
    const std::string let =
        "let " + std::string(text(token(at + 1).begin, token(end - 1).end)) + "; ";
    lost_.push_back(at + 1);
    foreign(span(at), "a name is bound before it is used")
        .help(to_write(let + "…"), {{{id_, token(first).begin, token(first).begin}, let},
                                    {{id_, token(at - 1).end, token(end - 1).end}, ""}});
    return true;
}

// OpenSCAD's `ring() sphere(1)` and `ring(6) sphere(1)`, at the shape.
bool ForeignSyntax::shape_behind_call(Index first, Index at) {
    if (kind(first) != Tok::Name || kind(first + 1) != Tok::Open || at != match(first + 1) + 1 ||
        kind(at) != Tok::Name || kind(at + 1) != Tok::Open || token(at).first_on_line ||
        (at > first + 3 && !may_be_declared(text(first))))
        return false;
    const Index end = statement_end(first);
    const Solid solid = match(at + 1) + 1 == end ? solid_of(at, true) : Solid{};
    if (!solid.text.empty()) forget_arguments(at + 1);
    const std::string shape =
        solid.text.empty() ? std::string(text(token(at).begin, token(end - 1).end)) : solid.text;
    const bool empty = at == first + 3;
    const std::string head(text(token(first).begin, token(at - 1).end));
    const std::string written =
        empty ? std::string(text(first)) + "(" + shape + ")" : head + " { " + shape + " }";
    foreign(span(first, at - 1), empty ? "what a function is given stands in its parentheses"
                                       : "the shapes that a function is given stand in braces")
        .help(to_write(written), {{span(first, end - 1), written}});
    return true;
}

bool ForeignSyntax::foreign_junk(Index first, Index at) {
    const Tok found = kind(at);
    const std::string name(text(first));
    if (kind(first) == Tok::Name && at == first + 1 && mistyped_keyword(first)) return true;
    if (kind(first) == Tok::Name && kind(first + 1) == Tok::Name && foreign_head(first))
        return true;
    if (found == Tok::Name && juxtaposed_calls(first, at)) return true;
    if (counted_block(first, at)) return true;
    if (is_declared(name) && foreign_word_operator(at)) return true; // `a union b`
    if (remark(first, at) || where_clause(first, at) || shape_behind_call(first, at)) return true;
    if (foreign_word_operator(at) || foreign_scope(at)) return true;
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
    if (foreign_lambda(at) || separated_unit(at) || words_of_range(first, at)) return true;
    if (text(first + 1) != text(at) && foreign_product(at)) return true; // else its own name
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
    const bool binds = is_one_of(kind(first), {Tok::Let, Tok::Fn, Tok::Param}) ||
                       (kind(first) == Tok::Name && kind(first + 1) == Tok::Assign);
    if (found == Tok::In && binds) { // Curv's `let s = sphere 1 in union [s, …]`
        foreign(span(at), "a name is known to the end of its block, without `in`")
            .help("end the statement, with a line's end or `;`",
                  {{{id_, token(at - 1).end, token(at).end}, ";"}});
        return true;
    }
    if (found == Tok::String && kind(at - 1) == Tok::Name && token(at - 1).end == token(at).begin)
        return joined_by_space(at, false);
    const bool all = name == "assert" || name == "print" || name == "echo"; // `assert 1 < 2`
    const bool value =
        is_one_of(found, {Tok::Number, Tok::String, Tok::Color, Tok::Name, Tok::True, Tok::False});
    if (all && value && kind(first) == Tok::Name && at == first + 1) {
        Diagnostic &d = foreign(span(first, at), "a call's arguments stand in parentheses");
        const Index last = statement_end(first) - 1;
        d.help("write " +
                   in_code(name + "(" + std::string(text(token(at).begin, token(last).end)) + ")"),
               {{{id_, token(first).end, token(at).begin}, "("},
                {{id_, token(last).end, token(last).end}, ")"}});
        return true;
    }
    return applied_without_dot(at) || spaced_statement(at) || juxtaposed_arguments(at) ||
           junk_by_sign(first, at);
}

// The same by the sign, or the keyword, that should not stand there.
bool ForeignSyntax::junk_by_sign(Index first, Index at) {
    const Tok found = kind(at);
    const std::string name(text(first));
    if (found == Tok::Arrow && at > 0 && kind(at - 1) == Tok::Name &&
        is_declared(std::string(text(at - 1))))
        return foreign_instead(at, "a part of a value stands behind a `.`", ".");
    if (found == Tok::Arrow && !token(at).first_on_line) {
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
    const Index bound = kind(first) == Tok::Let ? first + 1 : first;
    if (found == Tok::Assign && kind(bound) == Tok::Name && kind(bound + 1) == Tok::Assign &&
        at == bound + 3 && kind(at - 1) == Tok::Name &&
        !token(at).first_on_line) { // `let a = b = 1`, `a = b = 1`
        const Index end = statement_end(first);
        diagnostics_.withdraw(Code::ForeignSyntax, span(bound));
        const std::string a(text(bound)), b(text(at - 1)),
            value(text(token(at).end, token(end - 1).end));
        lost_.push_back(at - 1);
        foreign(span(first, at), "each name is bound by a `let` of its own")
            .help("write " + in_code("let " + b + " =" + value + "; let " + a + " = " + b),
                  {{span(first, end - 1), "let " + b + " =" + value + "; let " + a + " = " + b}});
        return true;
    }
    if (found == Tok::Number && kind(first) == Tok::Param && kind(first + 2) == Tok::Assign) {
        const std::uint32_t end = token(at - 1).end;
        foreign(span(at), "a param's range stands behind `in`")
            .help("write `in`", {{{id_, end, end}, " in"}});
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
        const bool walrus = kind(at + 1) == Tok::Assign;
        std::vector<Edit> edits{{{id_, token(first).begin, token(first).begin}, "let "}};
        if (walrus) edits.push_back({span(at), ""});
        if (walrus) lost_.push_back(first);
        foreign(span(first), "a new name is bound with `let`")
            .help("write `let " + name + (walrus ? " = …`" : "`"), std::move(edits));
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
    if (found == Tok::Comma && kind(first) == Tok::Param && kind(first + 2) == Tok::Assign) {
        foreign(span(at), "a param's range stands behind `in`")
            .help("write `in`", {{span(at), " in"}});
        return true;
    }
    if (found == Tok::Comma) {
        if (kind(first) == Tok::Name && at == first + 1 && kind(at + 1) == Tok::Name) {
            Index assign = at; // `a, b = 1, 2`
            while (is_one_of(kind(assign), {Tok::Name, Tok::Comma})) ++assign;
            if (kind(assign) == Tok::Assign) {
                destructuring(first, first, assign, assign);
                return true;
            }
            foreign(span(first, at + 1), "each name is bound by a `let` of its own")
                .help("write `let " + name + " = …`");
            for (Index i = first; kind(i) == Tok::Name; i += 2) lost_.push_back(i);
            return true;
        }
        if (kind(first) != Tok::Let && kind(first) != Tok::Var) return false;
        if (kind(at + 1) != Tok::Name || kind(at + 2) != Tok::Assign) {
            if (!ends_statement(at + 1) && !token(at + 1).first_on_line) return false;
            foreign(span(at), "a statement ends with its line, without a comma")
                .help("leave it away", {{span(at), ends_statement(at + 1) ? "" : ";"}});
            return true;
        }
        if (kind(at + 1) == Tok::Name) lost_.push_back(at + 1);
        std::vector<Edit> edits{{span(at), "; " + std::string(text(first))}};
        for (Edit &further : further_names(at + 1, at + 1)) edits.push_back(std::move(further));
        foreign(span(at), "each name is bound by a `let` of its own")
            .help("write `; let`", std::move(edits));
        return true;
    }
    if (found == Tok::If) {
        foreign_choice(value_start(first, at), at);
        return true;
    }
    if (found != Tok::In) return false;
    foreign(span(at), "there is no operator `in`").help("compare with each: `n == 1 or n == 2`");
    return true;
}

} // namespace fathom::lang
