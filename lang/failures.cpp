// What is said where the text cannot be read and no other language explains it: what was wanted,
// what was found, and the bracket that it concerns.
#include "lang/builder.h"

#include <array>
#include <utility>

namespace fathom::lang {

namespace {

constexpr std::array<std::string_view, 7> joining = {
    "union",        "intersection",      "difference",         "smooth_union",
    "smooth_blend", "smooth_difference", "smooth_intersection"};

std::string wanted_text(Wanted wanted) {
    switch (wanted) {
    case Wanted::Expression: return "an expression";
    case Wanted::Statement: return "a statement";
    case Wanted::CloseParen: return "`,` or `)`";
    case Wanted::CloseList: return "`,` or `]`";
    case Wanted::CloseBrace: return "`}`";
    case Wanted::Name: return "a name";
    case Wanted::ParameterName: return "a parameter's name";
    case Wanted::OpenParen: return "`(` and the parameters";
    case Wanted::AssignSign: return "`=` and a value";
    case Wanted::Type: return "a type";
    case Wanted::TypeEnd: return "`>`";
    case Wanted::TypeNumber: return "a number, as in `shape<1.5>`";
    case Wanted::TypeArrow: return "`->` and a type, as in `(vec3) -> float`";
    case Wanted::FunctionBody: return "`{` or `=` and the function's body";
    case Wanted::Block: return "`{`";
    case Wanted::In: return "`in`";
    case Wanted::Arrow: return "`=>`";
    case Wanted::MemberName: return "a name after the `.`";
    case Wanted::ImportPath: return "a file's name in double quotes";
    case Wanted::TernaryColon: return "`:`";
    case Wanted::StatementEnd: return "the end of the statement";
    }
    return "";
}

bool begins_operand(Tok kind) {
    return is_one_of(kind, {Tok::Name, Tok::LambdaName, Tok::Number, Tok::String, Tok::Color,
                            Tok::True, Tok::False, Tok::Open, Tok::FreshOpen, Tok::LambdaOpen,
                            Tok::ListOpen, Tok::FreshListOpen, Tok::If, Tok::Not});
}

bool begins_statement(Tok kind) {
    return is_one_of(kind, {Tok::Let, Tok::Var, Tok::Fn, Tok::Param, Tok::Import, Tok::For,
                            Tok::While, Tok::Break, Tok::Return});
}

bool is_keyword(Tok kind) {
    return is_one_of(kind, {Tok::Let, Tok::Var, Tok::Fn, Tok::Param, Tok::Import, Tok::For, Tok::In,
                            Tok::If, Tok::Else, Tok::While, Tok::Break, Tok::Return, Tok::And,
                            Tok::Or, Tok::Not, Tok::True, Tok::False});
}

} // namespace

void Builder::fail(Wanted wanted, Index at) {
    failed_ = at;
    if (!already_reported(wanted, at) && !foreign_failure(wanted, at)) generic_failure(wanted, at);
    throw Abandon{};
}

// A word that is none was reported when it was read, a bracket that is missing when it was missed.
bool Builder::already_reported(Wanted wanted, Index at) const {
    const auto is_virtual = [&](Index i) {
        return token(i).begin == token(i).end && kind(i) != Tok::End;
    };
    if (at < tokens_.tokens.size() && (kind(at) == Tok::Bad || is_virtual(at))) return true;
    if (renamed_.contains(at)) return true;
    if (at > 0 && kind(at - 1) == Tok::Bad && kind(at) != Tok::Comma && kind(at) != Tok::End)
        return true;
    if (wanted != Wanted::CloseParen && wanted != Wanted::CloseList) return false;
    return is_virtual(match(enclosing(at)));
}

std::string Builder::describe(Index at) const {
    if (at >= tokens_.tokens.size()) return "the end of the file";
    const Token &t = token(at);
    if (t.kind == Tok::End) return t.begin == t.end ? "the end of the line" : "`;`";
    if (t.kind == Tok::String) return "a string";
    if (t.kind == Tok::Number) return "the number `" + std::string(text(at)) + "`";
    if (is_keyword(t.kind)) return "the keyword `" + std::string(text(at)) + "`";
    return "`" + std::string(text(at)) + "`";
}

// `s.translate[1, 2, 3]` as a call.
std::vector<Edit> Builder::call_of_list(Index open) const {
    const Index close = match(open);
    if (open == 0 || kind(open - 1) != Tok::Name || kind(close) != Tok::ListClose) return {};
    return {{{id_, token(open - 1).end, token(open).begin}, "("},
            {{id_, token(close).end, token(close).end}, ")"}};
}

// Long: a case for each thing that was wanted, with the usual slips at its place.
void Builder::generic_failure(Wanted wanted, Index at) {
    const Tok found = kind(at);
    const bool exists = at < tokens_.tokens.size();
    if (exists && found == Tok::StrayBrace && (foreign_record(at) || set_of_points(at))) return;
    if (exists && found == Tok::StrayBrace) {
        Diagnostic &d = diagnostics_.add(Code::SyntaxError, span(at), "a block cannot stand here")
                            .note("`{` opens a block behind a callee, a header, a function's head "
                                  "or `=>`");
        Index first = at; // of the statement
        while (first > 0 && kind(first - 1) != Tok::End && match(first - 1) < first)
            first = match(first - 1);
        const bool is_value = at > first && kind(at - 1) == Tok::Assign;
        if (is_value && kind(first) == Tok::Fn) // `fn f(x) = { … }`
            d.help("a function's body in braces takes no `=`",
                   {{{id_, token(at - 1).begin, token(at).begin}, ""}});
        else if (is_value && kind(first) == Tok::Let) // `let a = { … }`
            d.help("write its statements before it, or a function: `fn name() { … }`");
        else
            d.help("to put shapes together, write `union { … }`");
        return;
    }
    if (exists && found == Tok::Else) {
        if (std::exchange(body_missing_, false)) return; // the cause was reported
        diagnostics_.add(Code::SyntaxError, span(at), "this `else` belongs to no `if`");
        return;
    }
    if (exists && wanted == Wanted::CloseList && found == Tok::Comma && range_of_param(at)) return;
    if (exists && wanted == Wanted::CloseList && found == Tok::Comma && call_of_row(enclosing(at)))
        return;
    if (exists && wanted == Wanted::CloseList && found == Tok::Comma) { // no list: an index
        diagnostics_.add(Code::SyntaxError, span(at), "an index is one number")
            .label(span(enclosing(at)), "of this index")
            .help("the arguments of a call stand in `( … )`", call_of_list(enclosing(at)));
        return;
    }
    Diagnostic &d = diagnostics_.add(Code::SyntaxError, span(at),
                                     "expected " + wanted_text(wanted) + ", found " + describe(at));
    switch (wanted) {
    case Wanted::CloseParen:
    case Wanted::CloseList:
    case Wanted::CloseBrace: {
        d.label(span(enclosing(at)), "opened here");
        if (found == Tok::Name && kind(at - 1) == Tok::Number && kind(at + 1) != Tok::Colon &&
            kind(at + 1) != Tok::Assign) {
            const std::uint32_t end = token(at - 1).end;
            const bool product =
                at > 1 && // `2 + 3 sin(x)`
                is_one_of(kind(at - 2), {Tok::Plus, Tok::Minus, Tok::Star, Tok::Slash, Tok::Caret,
                                         Tok::FatArrow, Tok::Less, Tok::Greater});
            if (product)
                d.help("to multiply, write `*`", {{{id_, end, end}, " *"}});
            else
                d.help("a comma or a `*` is missing before it");
        } else if (begins_operand(found) && ends_operand(kind(at - 1)) &&
                   wanted != Wanted::CloseBrace) {
            const std::uint32_t end = token(at - 1).end;
            d.help("a comma may be missing", {{{id_, end, end}, ","}});
        }
        break;
    }
    case Wanted::Name:
    case Wanted::ParameterName:
    case Wanted::MemberName:
        if (exists && is_keyword(found)) d.note("a keyword cannot be a name");
        break;
    case Wanted::StatementEnd:
        if (found == Tok::Comma) {
            const bool last = at + 1 >= tokens_.tokens.size() || kind(at + 1) == Tok::End;
            Index first = at; // of the statement
            while (first > 0 && kind(first - 1) != Tok::End && match(first - 1) <= first - 1)
                first = match(first - 1);
            if (kind(first) == Tok::Return && !last) { // `return 1, 2`
                const std::uint32_t end = token(statement_end(first) - 1).end;
                d.help("several values are one as a list",
                       {{{id_, token(first + 1).begin, token(first + 1).begin}, "["},
                        {{id_, end, end}, "]"}});
                break;
            }
            d.help("statements stand on lines of their own, without commas",
                   {{span(at), last ? "" : ";"}});
        }
        if (is_one_of(found, {Tok::Let, Tok::Var, Tok::Fn, Tok::Param}) &&
            kind(at + 1) == Tok::Name)
            lost_.push_back(at + 1);
        if (begins_operand(found) && kind(at - 1) == Tok::Name && !token(at).first_on_line)
            d.help("a call's arguments stand in parentheses, " +
                   in_code(std::string(text(at - 1)) + "(…)") +
                   ", and what is done to a shape behind a `.`");
        if ((begins_operand(found) || begins_statement(found)) && kind(at - 1) != Tok::Name) {
            const std::uint32_t end = token(at - 1).end;
            const bool shapes = found == Tok::Name && kind(at - 1) == Tok::Close &&
                                kind(at + 1) == Tok::Open && !token(at).first_on_line;
            const Index open = shapes ? match(at - 1) : 0;
            if (open > 0 && open < at && is_one_of(text(open - 1), joining)) // `union() a, b`
                d.help("the shapes that are joined stand in braces: " +
                       in_code(std::string(text(token(open - 1).begin, token(at - 1).end)) +
                               " { … }"));
            else if (found == Tok::Name && kind(at - 1) == Tok::Close && !token(at).first_on_line &&
                     kind(at + 1) == Tok::End) // `sphere(1) red`
                d.help("what is done to a shape stands behind a `.`, as in " +
                       in_code(".paint(" + std::string(text(at)) + ")") +
                       "; another statement begins a new line");
            else if (shapes) // `sphere(1) box(1)`
                d.help("an operator is missing: `a | b` unites shapes, `a - b` cuts b out of a, "
                       "`a & b` is what both have in common");
            else
                d.help("begin a new line, or part statements by `;`", {{{id_, end, end}, ";"}});
        }
        break;
    case Wanted::OpenParen: d.note("a function without parameters has empty parentheses"); break;
    case Wanted::Statement:
        if (is_one_of(found, {Tok::Bar, Tok::Amp}))
            d.help("it stands between two shapes: leave it away here",
                   {{{id_, token(at).begin,
                      kind(at + 1) == Tok::End ? token(at).end : token(at + 1).begin},
                     ""}});
        break;
    case Wanted::Expression:
    case Wanted::AssignSign:
    case Wanted::Type:
    case Wanted::TypeEnd:
    case Wanted::TypeNumber:
    case Wanted::TypeArrow:
    case Wanted::FunctionBody:
    case Wanted::Block:
    case Wanted::In:
    case Wanted::Arrow:
    case Wanted::ImportPath:
    case Wanted::TernaryColon: break;
    }
}

} // namespace fathom::lang
