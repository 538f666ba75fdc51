// Answers to the forms that people bring from GLSL, OpenSCAD, Python and C: each says what to write
// instead, with the edit where that is mechanical. What no other language has either: failures.cpp.
#include "lang/builder.h"

#include <algorithm>
#include <array>
#include <unordered_set>

namespace fathom::lang {

namespace {

template <std::size_t N>
bool is_one_of(std::string_view word, const std::array<std::string_view, N> &words) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

constexpr std::array<std::string_view, 24> type_words = {
    "float", "int",   "bool",  "string", "vec2",   "vec3",     "vec4",   "mat2",
    "mat3",  "mat4",  "color", "shape",  "shape2", "material", "light",  "double",
    "ivec2", "ivec3", "uint",  "bvec2",  "bvec3",  "field",    "region", "number"};
constexpr std::array<std::string_view, 13> qualifiers = {
    "const",   "uniform", "static",  "auto",  "local", "final", "highp",
    "mediump", "lowp",    "varying", "inout", "out",   "mut"};
constexpr std::array<std::string_view, 6> function_words = {"def", "function", "func",
                                                            "fun", "module",   "void"};
constexpr std::array<std::string_view, 11> transforms = {
    "translate", "rotate",         "scale",          "mirror",     "color", "resize",
    "offset",    "linear_extrude", "rotate_extrude", "multmatrix", "twist"};
constexpr std::array<std::string_view, 5> math_modules = {"math", "Math", "np", "numpy", "glm"};
constexpr std::array<std::string_view, 9> value_words = {
    "True", "False", "TRUE", "FALSE", "None", "null", "NULL", "nil", "undefined"};

std::string code(std::string_view text) { return "`" + brief(text) + "`"; }

} // namespace

std::string brief(std::string_view text) {
    constexpr std::size_t longest = 80;
    return text.size() > longest || text.find('\n') != std::string_view::npos ? "…"
                                                                              : std::string(text);
}

bool is_foreign_value(std::string_view name) { return is_one_of(name, value_words); }
bool is_foreign_module(std::string_view name) { return is_one_of(name, math_modules); }

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
            foreign(foreign_name.span, "the mathematical functions need no module")
                .help("write " + code(member->name.text), {{qualifier, ""}});
            expr.kind = Name{member->name.text, member->name.word};
        } else if (name[0] == 'T' || name[0] == 'F') {
            const bool value = name[0] == 'T';
            foreign(foreign_name.span, "truth values are written small")
                .help(value ? "write `true`" : "write `false`",
                      {{foreign_name.span, value ? "true" : "false"}});
            expr.kind = Bool{value};
        } else if (std::holds_alternative<Name>(expr.kind)) {
            foreign(foreign_name.span, "there is no " + code(name) + ": every name has a value")
                .note("the shape that is nowhere is `empty`, the list without items `[]`");
            expr.kind = Poison{};
        }
    }
}

// -- loops ---------------------------------------------------------------------------------------

// `for (…)` with what stands in the parentheses: `i in list`, `i = [0:8]`, `int i = 0; i < 8; i++`.
bool Builder::foreign_loop(Index at) {
    if (at == 0 || kind(at - 1) != Tok::For ||
        (kind(at) != Tok::Open && kind(at) != Tok::FreshOpen))
        return false;
    const Index close = tokens_.match[at];
    const auto inside = [&](Index first, Index last) { // [first, last)
        return first < last ? std::string(text(token(first).begin, token(last - 1).end))
                            : std::string();
    };
    const auto find = [&](Index from, Index to, Tok wanted) {
        while (from < to && kind(from) != wanted)
            from = tokens_.match[from] > from ? tokens_.match[from] + 1 : from + 1;
        return std::min(from, to);
    };
    Diagnostic &d = foreign(span(at - 1, close), "a loop is written `for i in 0..8 { … }`");
    const auto propose = [&](const std::string &head) {
        d.help("write `for " + head + "`", {{span(at, close), head}});
        return true;
    };
    Index i = at + 1;
    if (kind(i) == Tok::Name && kind(i + 1) == Tok::In) return propose(inside(i, close));
    while (i < close && kind(i + 1) != Tok::Assign) ++i;
    if (i >= close || kind(i) != Tok::Name) return true;
    const std::string name(text(i));
    const Index value = i + 2, end_value = find(value, close, Tok::End);
    if (end_value == close) {
        if (kind(value) != Tok::ListOpen) return propose(name + " in " + inside(value, close));
        const Index end = tokens_.match[value];
        const Index one = find(value + 1, end, Tok::Colon);
        if (one == end) return propose(name + " in " + inside(value, close));
        const Index two = find(one + 1, end, Tok::Colon);
        const std::string from = inside(value + 1, one);
        if (two == end) return propose(name + " in " + from + "..=" + inside(one + 1, end));
        const std::string by = inside(one + 1, two);
        return propose(name + " in range(" + from + ", " + inside(two + 1, end) + " + " + by +
                       ", " + by + ")");
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
    return propose(name + " in range(" + from + ", " + to + (below ? "" : " + " + by) + ", " + by +
                   ")");
}

// -- declarations --------------------------------------------------------------------------------

// The parameters between two parentheses, as they would be written here.
std::string Builder::parameters_text(Index open) const {
    const Index close = tokens_.match[open];
    std::string out;
    for (Index i = open + 1; i < close;) {
        Index end = i;
        while (end < close && kind(end) != Tok::Comma)
            end = tokens_.match[end] > end ? tokens_.match[end] + 1 : end + 1;
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
        const Index close = tokens_.match[name + 1];
        if (declared == "main" && word == "void") {
            foreign(span(first, name), "a scene has no `main`")
                .note("the shapes that stand at top level are the scene");
            return true;
        }
        const bool colon = kind(close + 1) == Tok::Colon;
        std::string head = "fn " + declared + "(" + parameters_text(name + 1) + ")";
        if (has_type) head += " -> " + type;
        if (colon) {
            foreign(span(first, name),
                    "a function is declared with `fn`, and its body stands in braces")
                .help("write `" + head + " { … }`");
            return true;
        }
        foreign(span(first, name), "a function is declared with `fn`")
            .help("write " + code(head), {{span(first, close), head}});
        return true;
    }
    if (kind(name + 1) == Tok::Assign) {
        const std::string let = "let " + declared + (has_type ? ": " + type : "");
        Diagnostic &d =
            foreign(span(first, name), has_type ? "a type stands behind its name, after `let`"
                                                : "a name is bound with `let`");
        d.help("write " + code(let + " = …"), {{span(first, name), let}});
        if (in_function_) d.note("a name that is assigned to later is bound with `var`");
        return true;
    }
    if (is_one_of(type, type_words) && ends_statement(name + 1)) {
        foreign(span(first, name), "a name is bound together with its value")
            .help("write `let " + declared + ": " + type + " = …`");
        return true;
    }
    return false;
}

// `translate([1, 2, 3]) rotate(…) sphere(1)`: transforms stand behind what they move.
bool Builder::juxtaposed_calls(Index first, Index at) {
    if (kind(first) != Tok::Name || kind(first + 1) != Tok::Open ||
        !is_one_of(text(first), transforms))
        return false;
    constexpr int longest_chain = 20;
    std::string chain;
    Index shape = first;
    for (int links = 0;
         links < longest_chain && kind(shape) == Tok::Name && kind(shape + 1) == Tok::Open &&
         kind(tokens_.match[shape + 1] + 1) == Tok::Name;
         ++links) {
        const Index close = tokens_.match[shape + 1];
        chain.insert(0, "." + std::string(text(token(shape).begin, token(close).end)));
        shape = close + 1;
    }
    if (shape < at) return false;
    failed_ = shape;
    const Index end = statement_end(first);
    foreign(span(first, tokens_.match[first + 1]),
            "a transform stands behind the shape that it moves")
        .help("write " + code(std::string(text(shape)) + "(…)" + chain),
              {{{id_, token(first).begin, token(shape).begin}, ""},
               {{id_, token(end - 1).end, token(end - 1).end}, chain}});
    return true;
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
    const std::string name(text(first));
    const bool literal = found == Tok::Number || found == Tok::String || found == Tok::Color;
    if (literal && kind(first) == Tok::Name && at == first + 1) {
        Diagnostic &d = foreign(span(first, at), "a call's arguments stand in parentheses");
        if (ends_statement(at + 1))
            d.help("write " + code(name + "(" + std::string(text(at)) + ")"),
                   {{{id_, token(first).end, token(at).begin}, "("},
                    {{id_, token(at).end, token(at).end}, ")"}});
        return true;
    }
    if (found == Tok::Arrow) {
        foreign(span(at), "a function without a name is written with `=>`")
            .help("write `=>`", {{span(at), "=>"}});
        return true;
    }
    if (found == Tok::FatArrow) {
        if (kind(first) != Tok::Name || kind(first + 1) != Tok::Open ||
            tokens_.match[first + 1] + 1 != at)
            return false;
        foreign(span(first, at), "a function with a name is declared with `fn`")
            .help("write `fn " + std::string(text(token(first).begin, token(at - 1).end)) + " = …`",
                  {{{id_, token(first).begin, token(first).begin}, "fn "}, {span(at), "="}});
        return true;
    }
    if (found == Tok::Colon) {
        if (kind(first) != Tok::Name || at != first + 1) return false;
        foreign(span(first), "a new name is bound with `let`")
            .help("write `let " + name + "`",
                  {{{id_, token(first).begin, token(first).begin}, "let "}});
        return true;
    }
    if (found == Tok::OtherAssign) {
        if (kind(first) != Tok::Name) return false;
        const std::string target(text(token(first).begin, token(at - 1).end));
        const std::string op(text(at).substr(0, 1));
        foreign(span(at), "there is no " + code(text(at)))
            .help("write `" + target + " = " + target + " " + op + " …`",
                  {{span(at), "= " + target + " " + op}});
        return true;
    }
    if (found == Tok::Comma) {
        if (kind(first) != Tok::Let && kind(first) != Tok::Var) return false;
        foreign(span(at), "each name is bound by a `let` of its own");
        return true;
    }
    if (found == Tok::If) {
        foreign(span(at), "a choice begins with its condition")
            .help("write `if c { a } else { b }`");
        return true;
    }
    if (found != Tok::In) return false;
    foreign(span(at), "there is no operator `in`");
    return true;
}

// Python's `lambda p: …`, at the `p`.
bool Builder::foreign_lambda(Index at) {
    if (at == 0 || kind(at) != Tok::Name || kind(at - 1) != Tok::Name || text(at - 1) != "lambda")
        return false;
    const std::string head = std::string(text(at)) + " =>";
    Diagnostic &d = foreign(span(at - 1), "a function without a name is written `p => …`");
    if (kind(at + 1) == Tok::Colon)
        d.help("write " + code(head + " …"), {{span(at - 1, at + 1), head}});
    return true;
}

// `45 deg`.
bool Builder::separated_unit(Index at) {
    if (at == 0 || kind(at) != Tok::Name || kind(at - 1) != Tok::Number) return false;
    if (text(at) != "deg" && text(at) != "rad" && text(at) != "turn") return false;
    const std::string angle = std::string(text(at - 1)) + std::string(text(at));
    diagnostics_.add(Code::BadNumber, span(at - 1, at), "a unit touches its number")
        .help("write " + code(angle), {{span(at - 1, at), angle}});
    return true;
}

// -- where a rule could not go on ----------------------------------------------------------------

bool Builder::foreign_failure(Wanted wanted, Index at) {
    const Tok found = kind(at);
    const Index before = at > 0 ? at - 1 : 0;
    const auto missing = [&](std::string message, std::string replacement) {
        foreign(span(at), std::move(message))
            .help("write " + code(replacement), {{span(at), replacement}});
        return true;
    };
    switch (wanted) {
    case Wanted::Statement:
    case Wanted::Expression:
        if (found == Tok::Plus) {
            foreign(span(at), "a value needs no `+` before it")
                .help("leave it away", {{span(at), ""}});
            return true;
        }
        if (found == Tok::PlusPlus || found == Tok::MinusMinus) {
            const std::string op = found == Tok::PlusPlus ? " += 1" : " -= 1";
            Diagnostic &d = foreign(span(at), "there is no " + code(text(at)));
            if (kind(at + 1) == Tok::Name)
                d.help("write `" + std::string(text(at + 1)) + op + "`",
                       {{span(at), ""}, {{id_, token(at + 1).end, token(at + 1).end}, op}});
            return true;
        }
        if (found == Tok::For && wanted == Wanted::Expression) {
            diagnostics_.add(Code::WrongPlace, span(at), "a `for` has no value")
                .help("write `[for … { … }]` for a list, `union { for … { … } }` for a shape");
            return true;
        }
        if (found == Tok::Bar && kind(at + 1) == Tok::Name && kind(at + 2) == Tok::Bar) {
            const std::string head = std::string(text(at + 1)) + " =>";
            foreign(span(at, at + 2), "a function without a name is written `p => …`")
                .help("write " + code(head + " …"), {{span(at, at + 2), head}});
            return true;
        }
        if (found == Tok::Greater && kind(before) == Tok::Bar &&
            token(before).end == token(at).begin) {
            foreign(span(before, at), "there is no operator `|>`")
                .help("write `a.f(b)` for `f(a, b)`");
            return true;
        }
        if (found == Tok::Fn) {
            foreign(span(at), "a function without a name is written `p => …`");
            return true;
        }
        if (found == Tok::Less && kind(before) == Tok::Import) return false;
        return false;
    case Wanted::CloseList:
        if (found == Tok::Colon) {
            foreign(span(at), "a range is written with `..`, or `..=` with its end")
                .help("write `..=`", {{span(at), "..="}});
            return true;
        }
        if (found == Tok::For) {
            const Index open = enclosing(at), close = tokens_.match[open];
            const std::string item(text(token(open + 1).begin, token(before).end));
            const std::string loop(text(token(at).begin, token(close - 1).end));
            const std::string list = "[" + loop + " { " + item + " }]";
            Diagnostic &d = foreign(span(at), "in a list, the loop stands before what it gives");
            if (list.find('\n') == std::string::npos)
                d.help("write " + code(list), {{span(open, close), list}});
            return true;
        }
        [[fallthrough]];
    case Wanted::CloseParen: {
        if (foreign_lambda(at) || separated_unit(at)) return true;
        const Index open = enclosing(at);
        const bool head = open >= 2 && kind(open - 2) == Tok::Fn;
        if ((head || kind(open) == Tok::LambdaOpen) && found == Tok::Name &&
            kind(before) == Tok::Name && !token(at).first_on_line) {
            const bool swapped = is_one_of(text(at), type_words);
            const std::string name(text(swapped ? before : at)), type(text(swapped ? at : before));
            foreign(span(before, at), "a parameter's type stands behind its name, after a `:`")
                .help("write " + code(name + ": " + type),
                      {{span(before, at), name + ": " + type}});
            return true;
        }
        if (found == Tok::If) {
            foreign(span(at), "a choice begins with its condition")
                .help("write `if c { a } else { b }`");
            return true;
        }
        if (found == Tok::Arrow)
            return missing("a function without a name is written with `=>`", "=>");
        return false;
    }
    case Wanted::AssignSign:
        if (found == Tok::EqualEqual) return missing("a name is bound with one `=`", "=");
        if (found == Tok::Open && kind(at - 2) == Tok::Let) {
            foreign(span(at - 2), "a function is declared with `fn`")
                .help("write `fn`", {{span(at - 2), "fn"}});
            return true;
        }
        if (found == Tok::Name && text(before) == "mut") {
            foreign(span(at - 2, before), "a name that changes is bound with `var`")
                .help("write `var`", {{span(at - 2, before), "var"}});
            return true;
        }
        if (found == Tok::Name && kind(before) == Tok::Name && kind(at + 1) == Tok::Assign) {
            const std::string typed = std::string(text(at)) + ": " + std::string(text(before));
            foreign(span(before, at), "a type stands behind its name")
                .help("write " + code(typed), {{span(before, at), typed}});
            return true;
        }
        return false;
    case Wanted::Type:
        if (found == Tok::Assign && kind(before) == Tok::Colon) {
            foreign(span(before, at), "a name is bound with `=`")
                .help("leave the `:` away", {{span(before), ""}});
            return true;
        }
        return false;
    case Wanted::Name: return foreign_loop(at);
    case Wanted::In:
        if (found == Tok::Assign) return missing("a loop runs over what stands behind `in`", "in");
        if (found == Tok::Name && text(at) == "of")
            return missing("a loop runs over what stands behind `in`", "in");
        return false;
    case Wanted::FunctionBody:
        if (found == Tok::Colon) {
            const bool type = kind(at + 1) == Tok::Name &&
                              (kind(at + 2) == Tok::Body || kind(at + 2) == Tok::Trailing ||
                               kind(at + 2) == Tok::Assign);
            if (type) return missing("a function's result stands behind `->`", " ->");
            foreign(span(at), "a function's body stands in braces, or behind a `=`")
                .help("write `{ … }`");
            return true;
        }
        if (found == Tok::FatArrow) return missing("the body of a `fn` stands behind `=`", "=");
        return false;
    case Wanted::Block: return foreign_body(at);
    case Wanted::ImportPath:
        if (found == Tok::Name) {
            const std::string path = "\"" + std::string(text(at)) + ".sdf\"";
            foreign(span(at), "a module is named by its file")
                .help("write `import " + path + "`", {{span(at), path}});
            return true;
        }
        return false;
    case Wanted::CloseBrace:
    case Wanted::ParameterName:
    case Wanted::OpenParen:
    case Wanted::TypeEnd:
    case Wanted::TypeNumber:
    case Wanted::TypeArrow:
    case Wanted::Arrow:
    case Wanted::MemberName:
    case Wanted::TernaryColon:
    case Wanted::StatementEnd: return false;
    }
    return false;
}

// `if a then b else c`, `for i in 0..3 do b`.
void Builder::foreign_then(Index at) {
    Diagnostic &d = foreign(span(at), "a body stands in braces");
    const auto end_of = [&](Index i) { // of the branch that begins there
        while (!ends_statement(i) && kind(i) != Tok::Else && kind(i) != Tok::Close &&
               kind(i) != Tok::ListClose && kind(i) != Tok::Comma)
            i = tokens_.match[i] > i ? tokens_.match[i] + 1 : i + 1;
        return i;
    };
    const auto before = [&](Index i) { return Span{id_, token(i).begin, token(i).begin}; };
    const auto behind = [&](Index i) { return Span{id_, token(i - 1).end, token(i - 1).end}; };
    const Index first = at + 1, end = end_of(first);
    if (end == first || kind(first) == Tok::Body) {
        d.help("write `{ … }`");
        return;
    }
    std::string told = "`{ " + std::string(text(token(first).begin, token(end - 1).end)) + " }";
    std::vector<Edit> edits{{span(at), "{"}, {behind(end), " }"}};
    const Index other = end + 1;
    if (kind(end) == Tok::Else && kind(other) != Tok::If && kind(other) != Tok::Body) {
        if (const Index last = end_of(other); last > other) {
            told += " else { " + std::string(text(token(other).begin, token(last - 1).end)) + " }";
            edits.push_back({before(other), "{ "});
            edits.push_back({behind(last), " }"});
        }
    }
    d.help("write " + told + "`", std::move(edits));
}

// A header without its `{`: `if a = b {`, `if x:`, `if (c) return 1`.
bool Builder::foreign_body(Index at) {
    const Tok found = kind(at);
    body_missing_ = true;
    if (at < tokens_.tokens.size() && found == Tok::End) {
        foreign(place(at), "a body stands in braces, which begin on the line of its header")
            .help("write `{ … }`");
        return true;
    }
    if (found == Tok::Assign) {
        foreign(span(at), "a comparison is written `==`").help("write `==`", {{span(at), "=="}});
        return true;
    }
    if (found == Tok::Colon) {
        foreign(span(at), "a body stands in braces").help("write `{ … }`");
        return true;
    }
    if (found == Tok::Name && (text(at) == "then" || text(at) == "do")) {
        foreign_then(at);
        return true;
    }
    const bool statement =
        found == Tok::Return || found == Tok::Break || found == Tok::Name || found == Tok::Number;
    if (!statement) return false;
    Index end = at;
    while (!ends_statement(end) && kind(end) != Tok::Else)
        end = tokens_.match[end] > end ? tokens_.match[end] + 1 : end + 1;
    foreign(span(at), "a body stands in braces")
        .help("write `{ " + std::string(text(token(at).begin, token(end - 1).end)) + " }`",
              {{{id_, token(at).begin, token(at).begin}, "{ "},
               {{id_, token(end - 1).end, token(end - 1).end}, " }"}});
    return true;
}

} // namespace fathom::lang
