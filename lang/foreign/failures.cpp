// What other languages write where a rule of the grammar could not go on; see builder.h.
#include "lang/foreign/foreign.h"

#include <algorithm>
#include <array>

namespace fathom::lang {

bool ForeignSyntax::foreign_instead(Index at, std::string message, const std::string &replacement) {
    foreign(span(at), std::move(message)).help(to_write(replacement), {{span(at), replacement}});
    return true;
}

// Where a statement or an expression should begin.
bool ForeignSyntax::foreign_operand(Wanted wanted, Index at) {
    const Tok found = kind(at);
    const Index before = at > 0 ? at - 1 : 0;
    if (found == Tok::Plus) {
        foreign(span(at), "a value needs no `+` before it").help("leave it away", {{span(at), ""}});
        return true;
    }
    if (found == Tok::PlusPlus || found == Tok::MinusMinus) {
        const std::string op = found == Tok::PlusPlus ? " += 1" : " -= 1";
        Diagnostic &d = foreign(span(at), "there is no " + in_code(text(at)));
        if (kind(at + 1) == Tok::Name)
            d.help("write `" + std::string(text(at + 1)) + op + "`",
                   {{span(at), ""}, {{id_, token(at + 1).end, token(at + 1).end}, op}});
        return true;
    }
    if (found == Tok::For && kind(before) == Tok::ListOpen && call_of_row(before)) return true;
    if (found == Tok::Let && is_one_of(kind(before), {Tok::Open, Tok::FreshOpen}) &&
        lisp_let(before))
        return true;
    if (list_spread(at) || column_of_rows(at) || let_of_value(at) ||
        (found == Tok::Arrow && lisp_arrow(at)) || bars_of_amount(at))
        return true;
    if (found == Tok::Let && kind(before) == Tok::If) {
        foreign(span(before, at), "a condition binds no name: every name has a value")
            .help("bind it before: `let x = …`, and then `if x > 0 { … }`");
        return true;
    }
    if (found == Tok::For && wanted == Wanted::Expression) {
        if (loop_among_entries(at)) return true;
        diagnostics_.add(Code::WrongPlace, span(at), "a `for` has no value")
            .help("write `[for … { … }]` for a list, `union { for … { … } }` for a shape");
        return true;
    }
    if (found == Tok::Greater && kind(before) == Tok::Bar && token(before).end == token(at).begin) {
        foreign_pipe(at);
        return true;
    }
    if (found == Tok::Greater && kind(before) == Tok::Greater &&
        token(before).end == token(at).begin) {
        foreign_pipe(at);
        return true;
    }
    if (found == Tok::Question && kind(before) == Tok::Question) {
        Index end = at + 1;
        while (!ends_statement(end) &&
               !is_one_of(kind(end), {Tok::Comma, Tok::Close, Tok::ListClose}))
            end = match(end) > end ? match(end) + 1 : end + 1;
        const bool nothing = before > 0 && is_foreign_value(text(before - 1)); // `null ?? 1`
        const Span away =
            nothing ? Span{id_, token(before - 1).begin, token(std::min(at + 1, end)).begin}
                    : Span{id_, token(before - 1).end, token(end - 1).end};
        foreign(span(before, at), "there is no `??`: every name has a value")
            .help("leave it away", {{away, ""}});
        return true;
    }
    if (wanted == Wanted::Statement && bars_of_amount(at)) return true;
    if (wanted == Wanted::Statement && found == Tok::In && is_type_word(text(at + 1)) &&
        kind(at + 2) == Tok::Name) {
        lost_.push_back(at + 2);
        return foreign_stream(at, at + 2);
    }
    if (wanted == Wanted::Statement && found == Tok::In && at > 0 && at == let_until_) {
        failed_ = at; // told at the `let`
        return true;
    }
    if (wanted == Wanted::Statement && found == Tok::In) {
        foreign(span(at), "a name is known to the end of its block, without `in`")
            .help("leave it away", {{span(at), ""}});
        return true;
    }
    if (wanted == Wanted::Statement && foreign_modifier(at)) return true;
    if (found == Tok::Fn) {
        Diagnostic &d = foreign(span(at), "a function without a name is written `p => …`");
        if (kind(at + 1) == Tok::LambdaOpen)
            d.help("leave `fn` away", {{span(at), ""}});
        else
            d.help("write `x => 2 * x`, or `(x, y) => x + y`");
        return true;
    }
    return missing_operand(at);
}

// In brackets, where an element ended and neither a comma nor the bracket's end follows.
bool ForeignSyntax::foreign_list(Index at) {
    const Tok found = kind(at);
    if (found == Tok::Comma && loop_among_entries(at)) return true;
    if (found == Tok::Colon && (foreign_scope(at) || foreign_slice(at))) return true;
    if (found == Tok::Colon) {
        foreign(span(at), "a range is written with `..`, or `..=` with its end")
            .help("write `..=`", {{span(at), "..="}});
        return true;
    }
    if (found == Tok::For) {
        const Index open = enclosing(at), close = match(open);
        const std::string list = nested_loops(open, at);
        Diagnostic &d = foreign(span(at), "in a list, the loop stands before what it gives");
        if (!list.empty() && list.find('\n') == std::string::npos)
            d.help(to_write(list), {{span(open, close), list}});
        else
            d.help("write `[for … { … }]`");
        return true;
    }
    return foreign_group(at, true);
}

// Whether the argument that stands at `at`, between its comma and that, is a function without a name.
bool ForeignSyntax::is_body_of_lambda(Index open, Index at) const {
    for (Index i = at; i-- > open + 1;) {
        if (match(i) < i) i = match(i);
        if (kind(i) == Tok::Comma) return false;
        if (kind(i) == Tok::FatArrow) return true;
    }
    return false;
}

// The same in parentheses; `list` in brackets.
bool ForeignSyntax::foreign_group(Index at, bool list) {
    const Tok found = kind(at);
    const Index before = at > 0 ? at - 1 : 0;
    if (foreign_lambda(at) || separated_unit(at)) return true;
    if (found == Tok::Colon && kind(at + 1) == Tok::Name && touch(at, at + 1) && !list &&
        !touch(at - 1, at) && lisp_call(at))
        return true;
    if (foreign_word_operator(at) || foreign_comparison(at) || foreign_scope(at) ||
        bars_of_amount(at))
        return true;
    const Index open = enclosing(at);
    const bool head = open >= 2 && kind(open - 2) == Tok::Fn;
    if (head && is_one_of(kind(before), {Tok::Open, Tok::Comma}) && foreign_parameter(at))
        return true;
    if (head && found == Tok::In && kind(at + 1) == Tok::Name && kind(at + 2) == Tok::Name) {
        changed_parameter(at, at + 1); // `in vec3 p`
        return true;
    }
    if ((head || kind(open) == Tok::LambdaOpen) && found == Tok::Name &&
        kind(before) == Tok::Name && kind(at + 1) == Tok::Name && !is_type_word(text(before))) {
        changed_parameter(before, at); // `inout vec3 p`
        return true;
    }
    if ((head || kind(open) == Tok::LambdaOpen) && found == Tok::Name &&
        kind(before) == Tok::Name && !token(at).first_on_line) {
        const bool swapped = is_type_word(text(at));
        const bool typed = swapped || is_type_word(text(before)) ||
                           type_named(text(before)) != TypeName::Unknown ||
                           (text(before)[0] >= 'A' && text(before)[0] <= 'Z');
        if (!typed) { // `fn leg(x z)`
            const std::uint32_t end = token(before).end;
            diagnostics_.add(Code::SyntaxError, span(at), "parameters are parted by commas")
                .help("write `,`", {{{id_, end, end}, ","}});
            return true;
        }
        const std::string name(text(swapped ? before : at)), type(text(swapped ? at : before));
        foreign(span(before, at), "a parameter's type stands behind its name, after a `:`")
            .help(to_write(name + ": " + type), {{span(before, at), name + ": " + type}});
        return true;
    }
    if (found == Tok::If) {
        foreign_choice(value_start(open + 1, at), at);
        return true;
    }
    if (found == Tok::For) {
        const Index close = match(open);
        Diagnostic &d = diagnostics_.add(Code::WrongPlace, span(at), "a `for` has no value");
        const std::string list = at > open + 1 ? nested_loops(open, at) : std::string();
        if (at == open + 1 && kind(at + 1) == Tok::Name && kind(at + 2) != Tok::In) // Lisp's
            d.help("a loop is written `for i in list { … }`");
        else if (!list.empty() && list.find('\n') == std::string::npos) // `sum(x for x in l)`
            d.help(to_write(list), {{span(open + 1, close - 1), list}});
        else if (at == open + 1 && kind(open - 1) == Tok::Name)
            d.help("a block takes it", {{span(open), " { "}, {span(close), " }"}});
        else
            d.help("write `[for … { … }]` for a list, `union { for … { … } }` for a shape");
        return true;
    }
    if (list && list_spread(at)) return true;
    if (found == Tok::DotDot && text(at) == "...") {
        foreign(span(at), "a list is not spread out").help("lists are joined by `concat(a, b)`");
        return true;
    }
    if (foreign_concat(at) || joined_by_space(at, list)) return true;
    const bool grouping = open > 0 && kind(open) == Tok::Open && kind(open - 1) != Tok::Name &&
                          kind(open - 1) != Tok::Close && kind(open - 1) != Tok::ListClose;
    if (grouping && foreign_product(at)) return true;
    if (!list && found == Tok::Assign && (grouping || kind(open) == Tok::FreshOpen))
        return foreign_instead(at, "a comparison is written `==`", "==");
    if (!list && found == Tok::End && text(at) == ";" && !ends_statement(at + 1))
        return parted_by_semicolon(at, open);
    if (grouping && found == Tok::Comma) { // a tuple
        const Index close = match(open);
        foreign(span(open), "a vector or a list stands in brackets")
            .help("write `[ … ]`", {{span(open), "["}, {span(close), "]"}});
        return true;
    }
    const bool equation = !list && found == Tok::Assign && open > 0 &&
                          (is_body_of_lambda(open, at) || text(open - 1) == "implicit");
    if (equation) { // `p => p.x ^ 2 = 1`
        const Index right = at + 1;
        Index end = right;
        bool sum = false;
        while (end < match(open) && kind(end) != Tok::Comma) {
            sum = sum || is_one_of(kind(end), {Tok::Plus, Tok::Minus});
            end = match(end) > end ? match(end) + 1 : end + 1;
        }
        std::vector<Edit> edits{{span(at), sum ? "- (" : "-"}};
        if (sum && end > right)
            edits.push_back({{id_, token(end - 1).end, token(end - 1).end}, ")"});
        diagnostics_.add(Code::SyntaxError, span(at), "a surface is where its function is 0")
            .help("write `-`: `a - b` is 0 where a equals b", std::move(edits));
        return true;
    }
    if (found == Tok::Arrow && kind(before) == Tok::Name && is_declared(std::string(text(before))))
        return foreign_instead(at, "a part of a value stands behind a `.`", ".");
    if (found == Tok::Arrow)
        return foreign_instead(at, "a function without a name is written with `=>`", "=>");
    return false;
}

// Curv's `let` of several names, with the `in` behind them: what it takes to bind each.
std::vector<Edit> ForeignSyntax::names_of_let(Index let) {
    constexpr Index farthest = 2000; // words
    std::vector<Edit> edits{{{id_, token(let).begin, token(let).end}, ""}};
    for (Index i = let + 1;
         i < tokens_.tokens.size() && i<let + farthest; i = match(i)> i ? match(i) + 1 : i + 1) {
        const bool begins = kind(i - 1) == Tok::End || i == let + 1;
        if (!begins) continue;
        if (kind(i) == Tok::In) {
            let_until_ = i;
            edits.push_back({span(i), ""});
            break;
        }
        if (kind(i) == Tok::BraceClose || kind(i) == Tok::Let) break;
        if (kind(i) == Tok::Name && kind(i + 1) == Tok::Assign)
            edits.push_back({{id_, token(i).begin, token(i).begin}, "let "});
    }
    if (let_until_ <= let) edits.resize(1);
    return edits;
}

// `inout vec3 p`, `const float r`, at the word and at the type: a parameter is given, and never changed.
void ForeignSyntax::changed_parameter(Index word, Index type) {
    const bool known = type_named(text(type)) != TypeName::Unknown;
    const std::string name(text(type + 1)),
        ours = name + (known ? ": " + std::string(text(type)) : "");
    Diagnostic &d =
        foreign(span(word, type + 1), "a parameter's type stands behind its name, after a `:`");
    if (text(word) == "inout" || text(word) == "out") d.note(std::string(changes_nothing));
    d.help(to_write(ours), {{span(word, type + 1), ours}});
}

// Where a declaration's name should stand.
bool ForeignSyntax::foreign_name(Index at) {
    const Tok found = kind(at);
    const Index before = at > 0 ? at - 1 : 0;
    if (label_of_param(at) || keyword_as_name(at)) return true;
    if (kind(before) == Tok::Fn && (found == Tok::Open || found == Tok::LambdaOpen)) {
        foreign(span(before), "a function without a name is written `x => …`")
            .help("name it, as in `fn f(x) = 2 * x`, or write `x => 2 * x`");
        return true;
    }
    if (kind(before) == Tok::Let && at < tokens_.tokens.size() &&
        (found == Tok::End || found == Tok::Open)) {
        const Index close = match(at);
        if (found == Tok::Open && kind(close + 1) == Tok::Assign && kind(at + 1) == Tok::Name &&
            kind(at + 2) != Tok::Assign) { // `let (a, b) = …`
            failed_ = close + 1;
            destructuring(before, at + 1, close, close + 1);
            return true;
        }
        std::vector<Edit> edits;
        if (found == Tok::End) // Curv's: the names follow on lines of their own
            edits = names_of_let(before);
        else if (kind(at + 1) == Tok::Name && kind(at + 2) == Tok::Assign)
            edits = {{span(at), ""}, {span(close), ";"}}, lost_.push_back(at + 1);
        foreign(span(before), "each name is bound by a `let` of its own")
            .help("write `let a = 1`, and what uses it behind that", std::move(edits));
        return true;
    }
    return foreign_loop(at);
}

// `for i = 1, 8 do … end`, at the `=`.
bool ForeignSyntax::foreign_count(Index at) {
    const auto is = [&](Index i, const char *word) {
        return kind(i) == Tok::Name && text(i) == word;
    };
    const auto next = [&](Index i) { return match(i) > i ? match(i) + 1 : i + 1; };
    Index comma = at + 1;
    while (!ends_statement(comma) && kind(comma) != Tok::Comma) comma = next(comma);
    Index begin = comma + 1;
    while (!ends_statement(begin) && kind(begin) != Tok::Comma && !is(begin, "do"))
        begin = next(begin);
    if (kind(comma) != Tok::Comma || !is(begin, "do")) return false;
    Index end = begin + 1;
    for (int open = 1; end < tokens_.tokens.size(); ++end) {
        if (is(end, "do") || is(end, "then")) ++open;
        if (is(end, "end") && --open == 0) break;
    }
    if (end == tokens_.tokens.size()) return false;
    failed_ = end;
    foreign(span(at), "a loop runs over what stands behind `in`, and its body stands in braces")
        .help("write `for i in 1..=8 { … }`",
              {{span(at), "in"},
               {{id_, token(comma).begin, token(comma + 1).begin}, "..="},
               {span(begin), "{"},
               {span(end), "}"}});
    return true;
}

// Behind the variable of a `for`.
bool ForeignSyntax::foreign_in(Index at) {
    const Tok found = kind(at);
    if (found == Tok::Colon && kind(at + 1) == Tok::Assign) { // Go's
        const Index name = at - 1, test = at + 4, brace = test + 6;
        const bool simple = kind(at + 3) == Tok::End && text(test) == text(name) &&
                            kind(test + 1) == Tok::Less && kind(test + 3) == Tok::End &&
                            text(test + 4) == text(name) && kind(test + 5) == Tok::PlusPlus;
        Index end = at;
        while (end < tokens_.tokens.size() && match(end) == end && !token(end).first_on_line) ++end;
        failed_ = end;
        Diagnostic &d = foreign(span(name - 1, at + 1), "a loop is written `for i in 0..8 { … }`");
        if (!simple) return true;
        const std::string head = std::string(text(name)) + " in " + std::string(text(at + 2)) +
                                 ".." + std::string(text(test + 2));
        d.help(to_write("for " + head + " { … }"), {{span(name, brace - 1), head}});
        return true;
    }
    if ((found == Tok::Assign && foreign_count(at)) || foreign_for_words(at)) return true;
    if (found == Tok::Assign)
        return foreign_instead(at, "a loop runs over what stands behind `in`", "in");
    if (found == Tok::Name && text(at) == "of")
        return foreign_instead(at, "a loop runs over what stands behind `in`", "in");
    if (is_one_of(found, {Tok::Number, Tok::Open, Tok::ListOpen, Tok::Name})) {
        const std::uint32_t end = token(at - 1).end;
        diagnostics_.add(Code::SyntaxError, span(at), "`in` is missing before this")
            .help("write `in`", {{{id_, end, end}, " in"}});
        return true;
    }
    if (found == Tok::Comma) {
        loop_over_pairs(at);
        return true;
    }
    return false;
}

// Behind the head of a function.
bool ForeignSyntax::foreign_function_body(Index at) {
    const Tok found = kind(at);
    if (found == Tok::Colon) {
        const bool type = kind(at + 1) == Tok::Name &&
                          (kind(at + 2) == Tok::Body || kind(at + 2) == Tok::Trailing ||
                           kind(at + 2) == Tok::Assign);
        if (type) return foreign_instead(at, "a function's result stands behind `->`", " ->");
        const Index first = at + 1;
        Index end = first;
        while (!ends_statement(end)) end = match(end) > end ? match(end) + 1 : end + 1;
        Diagnostic &d = foreign(span(at), "a function's body stands in braces, or behind a `=`");
        std::vector<Edit> edits;
        if (end > first && !token(first).first_on_line && kind(first) != Tok::Return)
            d.help("write `=`", {{span(at), " ="}});
        else
            d.help("write `{ … }`", indented_body(at, edits) ? edits : std::vector<Edit>{});
        return true;
    }
    if (found == Tok::Name && type_named(text(at)) != TypeName::Unknown &&
        !token(at).first_on_line &&
        is_one_of(kind(at + 1), {Tok::Body, Tok::Trailing, Tok::Assign})) {
        const std::uint32_t end = token(at - 1).end;
        foreign(span(at), "a function's result stands behind `->`")
            .help(to_write("-> " + std::string(text(at))), {{{id_, end, end}, " ->"}});
        return true;
    }
    if (found == Tok::End && text(at) != ";") { // on the lines below
        std::vector<Edit> edits;
        Index head = at;
        while (head > 0 && kind(head) != Tok::Fn) --head;
        if (!indented_body(at, edits)) return false;
        lost_.push_back(head + 1);
        foreign(span(head, at - 1), "a function's body stands in braces, or behind a `=`")
            .help("write `{ … }`", std::move(edits));
        return true;
    }
    if (found == Tok::FatArrow)
        return foreign_instead(at, "the body of a `fn` stands behind `=`", "=");
    const bool value = is_one_of(found, {Tok::Name, Tok::Number, Tok::Open, Tok::ListOpen, Tok::If,
                                         Tok::Minus, Tok::LambdaName});
    if (value && !token(at).first_on_line) { // `fn ball(r) sphere(r)`
        const std::uint32_t end = token(at - 1).end;
        diagnostics_.add(Code::SyntaxError, span(at), "a function's short body stands behind `=`")
            .help("write `=`", {{{id_, end, end}, " ="}});
        return true;
    }
    return false;
}

// `typeof x == "number"`, behind the word.
bool ForeignSyntax::asks_for_type(Index at) {
    constexpr std::array<std::string_view, 3> words = {"typeof", "sizeof", "type"};
    if (at == 0 || kind(at - 1) != Tok::Name || !is_one_of(text(at - 1), words) ||
        kind(at) != Tok::Name || token(at).first_on_line || may_be_declared(text(at - 1)))
        return false;
    foreign(span(at - 1), "every name has one type, which nobody asks for")
        .help("leave the question away");
    return true;
}

bool ForeignSyntax::foreign_failure(Wanted wanted, Index at) {
    if (asks_for_type(at)) return true;
    switch (wanted) {
    case Wanted::Statement:
    case Wanted::Expression: return foreign_operand(wanted, at);
    case Wanted::CloseList: return foreign_list(at);
    case Wanted::CloseParen: return foreign_group(at, false);
    case Wanted::AssignSign: return foreign_binding(at);
    case Wanted::Type:
        if (at > 0 && kind(at - 1) == Tok::Arrow &&
            is_one_of(kind(at), {Tok::Body, Tok::Trailing, Tok::StrayBrace, Tok::Assign})) {
            const std::uint32_t end = token(at - 2).end;
            diagnostics_.add(Code::SyntaxError, span(at - 1), "a result's type stands behind `->`")
                .help("leave it away, or write the type", {{{id_, end, token(at - 1).end}, ""}});
            return true;
        }
        if (at == 0 || kind(at - 1) != Tok::Colon) return false;
        if (is_one_of(kind(at),
                      {Tok::Number, Tok::String, Tok::Color, Tok::True, Tok::False, Tok::Minus})) {
            foreign(span(at - 1), "a value stands behind `=`, a type behind `:`")
                .help("write `=`", {{span(at - 1), " ="}});
            return true;
        }
        if (kind(at) != Tok::Assign) return false;
        foreign(span(at - 1, at), "a name is bound with `=`")
            .help("leave the `:` away", {{span(at - 1), ""}});
        return true;
    case Wanted::Name: return foreign_name(at);
    case Wanted::In: return foreign_in(at);
    case Wanted::FunctionBody: return foreign_function_body(at);
    case Wanted::Block: return foreign_body(at);
    case Wanted::ImportPath: return foreign_import(at);
    case Wanted::CloseBrace:
    case Wanted::OpenParen:
        if (kind(at) == Tok::Name) { // `fn f x = …`
            Index past = at;
            while (kind(past) == Tok::Name) ++past;
            if (kind(past) != Tok::Assign && kind(past) != Tok::Body) return false;
            foreign_curried(at - 2, at - 1, past);
            return true;
        }
        if (kind(at) != Tok::Body && kind(at) != Tok::Assign) return false;
        diagnostics_
            .add(Code::SyntaxError, span(at - 1), "a function's parameters stand in parentheses")
            .help("without parameters, write " + in_code(std::string(text(at - 1)) + "()"),
                  {{{id_, token(at - 1).end, token(at - 1).end}, "()"}});
        return true;
    case Wanted::MemberName:
        if (at == 0 || !ends_statement(at)) return false;
        diagnostics_.add(Code::SyntaxError, span(at - 1), "a name is missing behind this `.`")
            .help("leave it away, or name what is done: `.translate(x: 1)`", {{span(at - 1), ""}});
        return true;
    case Wanted::TypeArrow:
        if (at < 2 || kind(at - 1) != Tok::Close || match(at - 1) < 2) return false;
        foreign(span(match(at - 1), at - 1), "a row of types is none: several values are a vector "
                                             "or a list")
            .help("leave the type away, or write `vec2`, `vec3`, `[float]`",
                  {{{id_, token(match(at - 1) - 2).end, token(at - 1).end}, ""}});
        return true;
    case Wanted::TypeNumber: // `Option<f32>`
        if (at < 2 || kind(at) != Tok::Name || kind(at + 1) != Tok::Greater ||
            type_named(text(at - 2)) != TypeName::Unknown)
            return false;
        foreign(span(at - 2, at + 1), "a value has one type, and none within another")
            .help("write the type alone, or leave it away",
                  {{span(at - 2, at + 1), std::string(text(at))}});
        return true;
    case Wanted::ParameterName: return foreign_parameter(at);
    case Wanted::TypeEnd:
    case Wanted::Arrow:
    case Wanted::TernaryColon:
    case Wanted::StatementEnd: return false;
    }
    return false;
}

} // namespace fathom::lang
