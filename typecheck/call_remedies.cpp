// What to write in place of a call whose function is the wrong one for its arguments, or which
// lacks what nobody wrote: another function, a transform behind it, a seed, `p =>`.
#include "typecheck/remedies.h"

#include "base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

namespace fathom::typecheck {

namespace {

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

// The name that ends before `end`; empty: none.
std::string_view word_before(std::string_view all, std::size_t end) {
    std::size_t begin = end;
    while (begin > 0 && is_word(all[begin - 1])) --begin;
    return all.substr(begin, end - begin);
}

std::size_t skip_back(std::string_view all, std::size_t at) {
    while (at > 0 && std::string_view(" \t\n").find(all[at - 1]) != std::string_view::npos) --at;
    return at;
}

constexpr std::size_t farthest = 4000; // that a text is searched from a place

// The bracket that is open at a place, and the last comma behind it; `npos`: none.
struct Around {
    std::size_t open = std::string_view::npos, comma = std::string_view::npos;
};
Around around(std::string_view all, std::size_t place) {
    Around found;
    int depth = 0;
    for (std::size_t i = place, n = 0; i-- > 0 && n < farthest; ++n) {
        const char c = all[i];
        if (c == ')' || c == ']' || c == '}') ++depth;
        if (c == ',' && depth == 0 && found.comma == all.npos) found.comma = i;
        if ((c == '(' || c == '[' || c == '{') && depth-- == 0) {
            found.open = i;
            return found;
        }
    }
    return found;
}

// How often a word stands in a text.
std::size_t count_of(std::string_view all, std::string_view word) {
    std::size_t count = 0;
    for (std::size_t at = all.find(word); at != all.npos; at = all.find(word, at + 1)) ++count;
    return count;
}

std::string plain(double x) { return format_shortest(x + 0.0); }

} // namespace

// -- other functions -----------------------------------------------------------------------------

std::string axis_text(const Interpreter &ev, const Value &v, Span span) {
    if (v.kind != ValueKind::String) return source_text(ev, span);
    const std::string &inside = ev.strings[v.id];
    if (inside.size() != 1) return {};
    const char axis = static_cast<char>(std::toupper(static_cast<unsigned char>(inside[0])));
    return axis >= 'X' && axis <= 'Z' ? std::string(1, axis) : std::string();
}

bool lies_along_y(std::string_view function) {
    constexpr std::array<std::string_view, 13> shapes = {
        "cylinder",         "cone",  "capped_cone", "round_cone", "torus", "capped_torus",
        "rounded_cylinder", "prism", "pyramid",     "capsule",    "helix", "disk",
        "superquadric"};
    return std::ranges::find(shapes, function) != shapes.end();
}

bool names_an_axis(std::string_view argument) {
    return argument == "axis" || argument == "direction" || argument == "normal" ||
           argument == "orientation" || argument == "dir";
}

std::string_view rounded_form(std::string_view function, std::string_view argument) {
    constexpr std::array<std::string_view, 9> names = {
        "round", "rounding", "radius", "r", "fillet", "bevel", "chamfer", "roundness", "rounded"};
    const bool rounds = std::ranges::find(names, argument) != names.end();
    return function == "box" && rounds         ? "rounded_box"
           : function == "rectangle" && rounds ? "rounded_rectangle"
                                               : std::string_view();
}

bool slab_between(const Interpreter &ev, std::span<const Argument> args,
                  std::span<const std::size_t> unknown, Fix &fix) {
    if (unknown.size() != 2 || args.size() != 2) return false;
    const Argument &a = args[unknown[0]], &b = args[unknown[1]];
    const char axis = a.name->text[0];
    const auto bounds = [](const Argument &x, char digit) {
        return x.name->text.size() == 2 && x.name->text[1] == digit;
    };
    if (axis < 'x' || axis > 'z' || b.name->text[0] != axis || !bounds(a, '0') || !bounds(b, '1'))
        return false;
    const auto is_number = [](const Argument &x) {
        return x.value.kind == ValueKind::Int || x.value.kind == ValueKind::Float;
    };
    std::string thickness, middle;
    if (a.plain_literal && b.plain_literal && is_number(a) && is_number(b)) {
        thickness = plain(b.value.num[0] - a.value.num[0]);
        const double m = (a.value.num[0] + b.value.num[0]) / 2;
        if (m != 0) middle = plain(m);
    } else {
        const std::string low = operand_source(ev, a.span), high = operand_source(ev, b.span);
        thickness = high + " - " + low;
        middle = "(" + low + " + " + high + ") / 2";
    }
    const auto end = behind_call(ev, args.back().span);
    if (!end) return false;
    const std::string inside =
        fmt::format("{}, axis: {}", thickness, static_cast<char>(axis - 'x' + 'X'));
    const std::string moved = middle.empty() ? "" : fmt::format(".translate({}: {})", axis, middle);
    const Span first = whole_argument(a);
    fix.message = fmt::format("a slab lies round the origin: `slab({}){}`", inside, moved);
    fix.edits.push_back({{first.source, first.begin, whole_argument(b).end}, inside});
    if (!moved.empty()) fix.edits.push_back({*end, moved});
    return true;
}

bool cone_between(const Interpreter &ev, std::span<const Argument> args,
                  std::span<const std::size_t> unknown, Span callee, Fix &fix) {
    const Argument *bottom = nullptr, *top = nullptr;
    if (std::ranges::any_of(args, [](const Argument &a) { return !a.name || a.trailing; }))
        return false;
    for (std::size_t i : unknown) {
        const std::string name(args[i].name->text);
        if (name == "r1" || name == "d1") bottom = &args[i];
        if (name == "r2" || name == "d2") top = &args[i];
    }
    if (!bottom || !top) return false;
    const bool pointed = top->plain_literal && top->value.num[0] == 0;
    const auto rename = [&](const Argument &a, std::string_view ours) {
        fix.edits.push_back({a.name->span, std::string(ours)});
        if (a.name->text[0] != 'd') return;
        const bool grouped = operand_source(ev, a.span) != source_text(ev, a.span);
        if (grouped) fix.edits.push_back({{a.span.source, a.span.begin, a.span.begin}, "("});
        fix.edits.push_back({{a.span.source, a.span.end, a.span.end}, grouped ? ") / 2" : " / 2"});
    };
    fix.edits.push_back({callee, pointed ? "cone" : "capped_cone"});
    rename(*bottom, pointed ? "radius" : "bottom");
    if (pointed)
        fix.edits.push_back(
            {with_comma(args, static_cast<std::size_t>(top - args.data()), callee), ""});
    else
        rename(*top, "top");
    fix.message += fmt::format("{}a cone {}", fix.message.empty() ? "" : "; ",
                               pointed ? "is `cone(radius: …, height: …)`"
                                       : "without its tip is `capped_cone(bottom: …, top: …, "
                                         "height: …)`");
    return true;
}

bool no_shape_before(Interpreter &ev, std::string_view name, const lang::Function &function,
                     std::span<const Argument> args, Span callee) {
    if (args.empty() || function.parameters.empty() || !function.parameters[0].type) return false;
    using lang::TypeName;
    const lang::TypeExpr &type = *function.parameters[0].type;
    const bool takes_shape = type.kind == lang::TypeExpr::Kind::Name &&
                             (type.named == TypeName::Shape || type.named == TypeName::AnyShape);
    const bool by_angle = function.parameters.size() > 1 && function.parameters[1].type &&
                          function.parameters[1].type->name == "angle";
    const bool turns = name == "rotate" && by_angle && args.size() == 2 && !args[1].name &&
                       args[0].value.kind == ValueKind::Shape &&
                       args[1].value.kind == ValueKind::Vec && args[1].value.size == 3;
    if (turns) {
        report(ev, Code::TypeMismatch, args[1].span,
               fmt::format("`angle` of `rotate` wants an `angle`, this is {}",
                           describe(ev, args[1].value)))
            .help("`.rotate_euler([x, y, z])` turns about all three axes, `.rotate(angle, axis)` "
                  "about one",
                  {{callee, "rotate_euler"}});
        return true;
    }
    const bool numbers = std::ranges::all_of(args, [&](const Argument &a) {
        return !a.trailing && a.value.kind != ValueKind::Poison && is_numeric(a.value);
    });
    const bool method = !args[0].name && args[0].span.begin < callee.begin;
    if (!takes_shape || !numbers || method) return false;
    report(ev, Code::MissingArgument, callee, fmt::format("`{}` has no shape to change", name))
        .help(fmt::format("it stands behind one: `sphere(1).{}(…)`", name));
    return true;
}

Value report_two_dots(Interpreter &ev, Span from, Span to) {
    report(ev, Code::TypeMismatch, from, "a range goes from one number to another, this is a shape")
        .help("a function is applied by one dot", {{{from.source, from.end, to.begin}, "."}});
    return poison();
}

// -- what a call lacks ---------------------------------------------------------------------------

std::string loop_variable(const Interpreter &ev, Span place) {
    const std::string_view all = ev.sources[place.source].text;
    std::size_t at = place.begin;
    constexpr int most_blocks = 20;
    for (int i = 0; i < most_blocks; ++i) {
        // the parameter of a lambda: `map(0..5, i => …)`
        const Around found = around(all, at);
        const std::size_t begin = found.open == all.npos ? 0 : found.open + 1;
        const std::size_t from = std::max(begin, at > farthest ? at - farthest : 0);
        const std::size_t found_arrow = all.substr(from, at - from).rfind("=>");
        const std::size_t arrow = found_arrow == all.npos ? all.npos : from + found_arrow;
        if (arrow != all.npos && around(all, arrow).open == found.open)
            if (const auto name = word_before(all, skip_back(all, arrow)); !name.empty())
                return std::string(name);
        if (found.open == all.npos) return {};
        at = found.open;
        if (all[at] != '{') continue;
        const std::size_t start = all.find_last_of("\n;{}[", at == 0 ? 0 : at - 1);
        const std::string_view head =
            all.substr(start == all.npos ? 0 : start + 1, at - (start == all.npos ? 0 : start + 1));
        const std::size_t word = head.find_first_not_of(" \t");
        if (word == head.npos || !head.substr(word).starts_with("for ")) continue;
        const std::size_t in = head.find(" in ");
        if (in != head.npos) return std::string(word_before(head, skip_back(head, in)));
    }
    return {};
}

std::string seed_text(const Interpreter &ev, Span place) {
    const std::string_view before = std::string_view(ev.sources[place.source].text);
    const std::string variable = loop_variable(ev, place);
    const std::size_t line = before.rfind('\n', place.begin);
    // each of a loop's body is told apart by a second number
    constexpr std::size_t most = 50'000; // bytes that are counted in
    const std::size_t near = place.begin > most ? place.begin - most : 0;
    const std::size_t from = variable.empty() || line == before.npos ? near : std::max(line, near);
    const std::size_t others = count_of(before.substr(from, place.begin - from), "random(") +
                               count_of(before.substr(from, place.begin - from), "random.");
    if (variable.empty()) return fmt::to_string(others + 1);
    return others == 0 ? variable : fmt::format("{}, {}", variable, others);
}

// The call around a place, or around the calls around it, that takes a function of the point.
std::optional<Edit> point_edit(const Interpreter &ev, const std::string &name, Span place,
                               std::string &function) {
    constexpr std::array<std::string_view, 9> takers = {"implicit", "implicit2", "displace",
                                                        "distort",  "paint",     "repaint",
                                                        "cached",   "blend",     "taper"};
    const std::string_view all = ev.sources[place.source].text;
    std::size_t at = place.begin;
    constexpr int most_calls = 20;
    for (int i = 0; i < most_calls; ++i) {
        const Around found = around(all, at);
        if (found.open == all.npos || all[found.open] == '{') return std::nullopt;
        const std::string_view callee = word_before(all, found.open);
        if (all[found.open] == '(' && std::ranges::find(takers, callee) != takers.end()) {
            std::size_t begin = (found.comma == all.npos ? found.open : found.comma) + 1;
            begin = all.find_first_not_of(" \t\n", begin);
            if (begin == all.npos || begin > place.begin) return std::nullopt;
            const std::string_view argument = all.substr(begin, place.begin - begin);
            if (argument.find("=>") != argument.npos || argument.find(':') != argument.npos)
                return std::nullopt;
            function = callee;
            const auto start = static_cast<std::uint32_t>(begin);
            return Edit{{place.source, start, start}, name + " => "};
        }
        at = found.open;
    }
    return std::nullopt;
}

// -- methods -------------------------------------------------------------------------------------

// The call of a library's function that an expression begins with: `sphere(2).translate(x: 1)`.
static const lang::Call *first_call(const File &ast, lang::ExprId id) {
    while (true) {
        const auto *call = std::get_if<lang::Call>(&ast.exprs[id].kind);
        if (!call) return nullptr;
        const auto *member = std::get_if<lang::Member>(&ast.exprs[call->callee].kind);
        if (!member) return call;
        id = member->object;
    }
}

std::vector<Edit> part_of_shape(Interpreter &ev, const File &ast, const lang::Member &member,
                                std::string &made_of) {
    constexpr std::size_t most_statements = 1000, most_exprs = 20'000, most_edits = 20;
    const auto *object = std::get_if<lang::Name>(&ast.exprs[member.object].kind);
    const auto &stmts = ast.blocks[ast.root].stmts;
    if (!object || stmts.size() > most_statements || ast.exprs.size() > most_exprs) return {};
    const lang::Stmt *bound = nullptr;
    for (const lang::Stmt &s : stmts) {
        const auto *let = std::get_if<lang::Let>(&s.kind);
        if (!let || let->name.text != object->text) continue;
        if (bound) return {};
        bound = &s;
    }
    const lang::Call *made =
        bound ? first_call(ast, std::get<lang::Let>(bound->kind).value) : nullptr;
    const auto *maker = made ? std::get_if<lang::Name>(&ast.exprs[made->callee].kind) : nullptr;
    if (!maker) return {};
    const auto function = look_up(ev, ev.prelude_frame, intern(ev, maker->text));
    if (!function || function->kind != ValueKind::Closure) return {};
    const std::span<const Formal> formals = formals_of(ev, ev.closures[function->id]);
    const std::string part(member.name.text == "r" ? "radius" : member.name.text);
    const lang::Argument *given = nullptr;
    for (std::size_t i = 0; i < made->arguments.size() && !given; ++i) {
        const lang::Argument &a = made->arguments[i];
        const bool is_part =
            a.name ? a.name->text == part : i < formals.size() && formals[i].name == part;
        if (is_part) given = &a;
    }
    if (!given) return {};
    const Span value = ast.exprs[given->value].span;
    std::string name = source_text(ev, value);
    std::vector<Edit> edits;
    made_of = fmt::format("`{}`", name);
    if (!std::holds_alternative<lang::Name>(ast.exprs[given->value].kind)) {
        if (look_up(ev, ev.prelude_frame, intern(ev, part)) ||
            count_of(ev.sources[value.source].text, "let " + part) > 0)
            return {};
        const Span before{value.source, bound->span.begin, bound->span.begin};
        edits.push_back({before, fmt::format("let {} = {}; ", part, name)});
        edits.push_back({value, part});
        made_of = fmt::format("a name for it, `let {} = {}`", part, name);
        name = part;
    }
    for (const lang::Expr &e : ast.exprs) {
        const auto *m = std::get_if<lang::Member>(&e.kind);
        const auto *of = m ? std::get_if<lang::Name>(&ast.exprs[m->object].kind) : nullptr;
        if (of && of->text == object->text && m->name.text == member.name.text)
            edits.push_back({e.span, name});
    }
    return edits.size() > most_edits ? std::vector<Edit>{} : edits;
}

std::string names_left(std::span<const Formal> formals, std::span<const Given> given) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < formals.size(); ++i)
        if (!given[i].given && !formals[i].takes_rest)
            names.push_back(fmt::format("`{}:`", formals[i].name));
    if (names.empty() || names.size() > 4) return "";
    return fmt::format(": {}", fmt::join(names, " or "));
}

// Where the text ends that stands above a line which has nothing before its `-`; none where a comment
// or nothing stands there.
static std::optional<std::uint32_t> end_of_line_above(std::string_view before) {
    const std::size_t line = before.find_last_not_of(" \t");
    if (line == before.npos || before[line] != '\n') return std::nullopt;
    const std::size_t last = before.find_last_not_of(" \t\r\n");
    if (last == before.npos || (before[last] != ')' && before[last] != '}')) return std::nullopt;
    const std::size_t begin = before.rfind('\n', last);
    const std::string_view above = before.substr(begin == before.npos ? 0 : begin + 1,
                                                 last - (begin == before.npos ? 0 : begin));
    if (above.find("//") != above.npos || above.find('"') != above.npos) return std::nullopt;
    return static_cast<std::uint32_t>(last + 1);
}

void report_negated_shape(Interpreter &ev, Span place, Span operand) {
    Diagnostic &d = report(ev, Code::LineContinues, place, "a shape cannot be negated");
    const std::string_view before = text(ev.sources, {place.source, 0, place.begin});
    const std::size_t last = before.find_last_not_of(" \t");
    if (last != before.npos && std::string_view("-|&").find(before[last]) != before.npos) {
        d.help(before[last] == '-' ? "one `-` cuts the shape behind it out"
                                   : "`a - b` cuts b out of a: leave the sign before the `-` away",
               {before[last] == '-'
                    ? Edit{{place.source, place.begin, operand.begin}, ""}
                    : Edit{{place.source, static_cast<std::uint32_t>(last), place.begin}, ""}});
    } else if (last == before.npos || std::string_view("(,[=").find(before[last]) == before.npos) {
        std::vector<Edit> edits;
        if (const auto above = end_of_line_above(before))
            edits = {{{place.source, *above, *above}, " -"},
                     {{place.source, place.begin, operand.begin}, ""}};
        d.help("to cut it out of the shape on the line above, move the `-` to the end of that "
               "line; the space around a shape is `complement(s)`",
               std::move(edits));
    } else // `max(a, -b)`
        d.help("b is cut out of a by `a - b`; the space around a shape is `complement(s)`",
               {{{place.source, place.begin, operand.begin}, "complement("},
                {{place.source, place.end, place.end}, ")"}});
}

// -- functions of the point ----------------------------------------------------------------------

void help_with_parts(const Interpreter &ev, Diagnostic &d, const Value &field, Span place) {
    constexpr std::string_view letters = "xyz";
    const std::string help = "the point is one vector, whose parts are `p.x`, `p.y` and `p.z`";
    const std::string_view written = is_library_place(ev, place) ? "" : text(ev.sources, place);
    const std::size_t arrow = written.find("=>");
    if (field.kind != ValueKind::Closure || arrow == written.npos || !written.starts_with('(')) {
        d.help(help);
        return;
    }
    const Closure &c = ev.closures[field.id];
    const auto &parameters = c.ast->functions[c.function].parameters;
    const std::size_t head = written.substr(0, arrow).rfind(')');
    if (parameters.size() > letters.size() || head == written.npos) return;
    std::vector<Edit> edits{
        {{place.source, place.begin, static_cast<std::uint32_t>(place.begin + head + 1)}, "p"}};
    for (std::size_t i = arrow; i < written.size();) {
        std::size_t end = i;
        while (end < written.size() && is_word(written[end])) ++end;
        if (end == i) {
            ++i;
            continue;
        }
        const std::string_view word = written.substr(i, end - i);
        const auto same = std::ranges::find_if(
            parameters, [&](const lang::Parameter &p) { return p.name.text == word; });
        if (word == "p" && same == parameters.end()) return;
        const auto at = static_cast<std::uint32_t>(place.begin + i);
        if (same != parameters.end() && written[i - 1] != '.')
            edits.push_back({{place.source, at, static_cast<std::uint32_t>(at + word.size())},
                             std::string("p.") + letters[std::size_t(same - parameters.begin())]});
        i = end;
    }
    d.help(help, std::move(edits));
}

void help_with_condition(const Interpreter &ev, Diagnostic &d, Span place) {
    const std::string help = "a solid is where its function is below 0: `length(p) - 1` for "
                             "`length(p) < 1`";
    const std::string_view written = is_library_place(ev, place) ? "" : text(ev.sources, place);
    const std::size_t sign = written.find('<');
    const bool plain = sign != written.npos && written.find('<', sign + 1) == written.npos &&
                       written.find(" and ") == written.npos &&
                       written.find(" or ") == written.npos && written.find('{') == written.npos;
    if (!plain) {
        d.help(help);
        return;
    }
    const std::size_t length = written.substr(sign + 1).starts_with('=') ? 2 : 1;
    const std::size_t right = written.find_first_not_of(" \t", sign + length);
    if (right == written.npos) return;
    const auto at = [&](std::size_t i) { return static_cast<std::uint32_t>(place.begin + i); };
    std::vector<Edit> edits{{{place.source, at(sign), at(sign + length)}, "-"}};
    const Span rest{place.source, at(right), place.end};
    if (operand_source(ev, rest) != source_text(ev, rest)) {
        edits.push_back({{place.source, rest.begin, rest.begin}, "("});
        edits.push_back({{place.source, rest.end, rest.end}, ")"});
    }
    d.help(help, std::move(edits));
}

} // namespace fathom::typecheck
