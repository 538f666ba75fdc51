// Arguments to parameters, and what is said where they do not fit.
#include "typecheck/remedies.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fathom::typecheck {

static std::string signature_text(std::string_view name, std::span<const Formal> formals) {
    std::string out = std::string(name) + "(";
    for (std::size_t i = 0; i < formals.size(); ++i)
        out += fmt::format("{}{}{}", i ? ", " : "", formals[i].name,
                           formals[i].optional ? " = …" : "");
    return out + ")";
}

static void report_unknown_arguments(Interpreter &ev, std::string_view name,
                                     std::span<const Formal> formals,
                                     std::span<const Argument> args,
                                     const std::vector<std::size_t> &unknown, Span callee) {
    std::string list;
    for (std::size_t i = 0; i < unknown.size(); ++i)
        list += fmt::format("{}`{}`",
                            i == 0                    ? ""
                            : i + 1 == unknown.size() ? " and "
                                                      : ", ",
                            args[unknown[i]].name->text);
    Fix fix = remedy_of_corners(ev, name, formals, args);
    if (fix.edits.empty()) fix = remedy_of_arguments(ev, name, formals, args, unknown, callee);
    if (!fix.edits.empty() && ev.quiet == 0) join_sign_edits(ev, args, fix);
    Diagnostic &d = report(
        ev, Code::UnknownArgument, args[unknown[0]].name->span,
        fmt::format("`{}` has no argument{} {}", name, unknown.size() == 1 ? "" : "s", list));
    if (!fix.message.empty()) d.help(fix.message, fix.edits);
    d.note(fmt::format("it is `{}`", signature_text(name, formals)));
}

// `s.scale(1, 2, 3)`, `s.rotate(90, 0, 0)`: numbers behind the shape that are one vector.
static void help_with_row(Interpreter &ev, Diagnostic &d, std::string_view name,
                          std::span<const Formal> formals, std::span<const Argument> args) {
    const auto row = args.subspan(1);
    if (row.size() < 2 || !std::ranges::all_of(row, [&](const Argument &b) {
            return !b.name && !b.trailing && is_scalar(ev, b.value);
        }))
        return;
    if (name == "rotate" && row.size() == 3)
        d.help(
            "angles about all three axes are one vector: `rotate_euler([x, y, z])`; about one it "
            "is `rotate(90deg, axis: X)`");
    else if (formals.size() > 1 && formals[1].vector_size > 0) {
        const Fix fix = remedy_of_row(row, formals[1].vector_size);
        d.help(fix.message, fix.edits);
    }
}

// The comma of `sphere(1,5)`, where one argument is too many.
static std::optional<Span> decimal_comma(const Interpreter &ev, std::span<const Formal> formals,
                                         std::span<const Argument> args) {
    if (args.size() != formals.size() + 1) return std::nullopt;
    for (std::size_t i = 0; i + 1 < args.size(); ++i) {
        const Argument &a = args[i], &b = args[i + 1];
        if (a.name || b.name || a.value.kind != ValueKind::Int || b.value.kind != ValueKind::Int ||
            !a.plain_literal || !b.plain_literal || a.span.source != b.span.source)
            continue;
        const Span between{a.span.source, a.span.end, b.span.begin};
        if (between.begin < between.end && text(ev.sources, between) == ",") return between;
    }
    return std::nullopt;
}

// `print("r is", r)` as one string.
static void help_with_prints(const Interpreter &ev, Diagnostic &d, std::span<const Argument> args) {
    std::vector<Edit> edits;
    for (std::size_t i = 0; i + 1 < args.size(); ++i) {
        const Span a = args[i].span, b = args[i + 1].span;
        if (args[i + 1].name || args[i + 1].trailing || a.source != b.source) {
            edits.clear();
            break;
        }
        const std::string_view written = text(ev.sources, a);
        const bool literal = written.size() > 1 && written.ends_with('"');
        if (!literal)
            edits.push_back({{a.source, a.end, b.begin}, " + \" \" + "});
        else
            edits.push_back(
                {{a.source, a.end - 1, b.begin},
                 written.size() == 2 || written[written.size() - 2] == ' ' ? "\" + " : " \" + "});
    }
    d.help("a string shows a value where it is joined to it, by `+`", std::move(edits));
}

// Two or three numbers.
static bool is_point(const Interpreter &ev, const Value &v) {
    if (v.kind == ValueKind::Vec) return true;
    return v.kind == ValueKind::List && ev.lists[v.id].size() > 1 && ev.lists[v.id].size() < 4 &&
           is_scalar(ev, ev.lists[v.id][0]);
}

static void report_too_many(Interpreter &ev, std::string_view name, std::span<const Formal> formals,
                            std::span<const Argument> args, const Argument &first) {
    std::size_t given = 0;
    for (const Argument &b : args) given += b.trailing ? 0 : 1;
    Diagnostic &d = report(ev, Code::TooManyArguments, first.span,
                           fmt::format("`{}` takes {} argument{}, not {}", name, formals.size(),
                                       formals.size() == 1 ? "" : "s", given))
                        .note(fmt::format("it is `{}`", signature_text(name, formals)));
    if (const auto comma = decimal_comma(ev, formals, args)) {
        d.help("a fraction is written with a point", {{*comma, "."}});
    } else if (name == "paint" && args.size() == 4 && args[0].value.kind == ValueKind::Shape &&
               std::ranges::all_of(args.subspan(1), [&](const Argument &b) {
                   return !b.name && is_scalar(ev, b.value);
               })) {
        const Span row = join(args[1].span, args[3].span);
        const std::string written = fmt::format("rgb({})", text(ev.sources, row));
        d.help(fmt::format("write `{}`", written), {{row, written}});
    } else if (help_with_paint(ev, d, formals, args) ||
               help_with_place(ev, d, name, formals, args)) {
        return;
    } else if (args[0].value.kind == ValueKind::Shape) {
        help_with_shape(d, name);
        help_with_row(ev, d, name, formals, args);
    } else if (!formals.empty() && formals[0].vector_size > 0 &&
               std::ranges::all_of(
                   args, [&](const Argument &b) { return !b.name && is_scalar(ev, b.value); })) {
        const Fix fix = remedy_of_row(args, formals[0].vector_size);
        d.help(fix.message, fix.edits);
    } else if (name == "print" && args[0].value.kind == ValueKind::String) {
        help_with_prints(ev, d, args);
    } else if (formals.size() == 1 && formals[0].name == "points" &&
               std::ranges::all_of(args, [&](const Argument &b) {
                   return !b.name && !b.trailing && is_point(ev, b.value);
               })) {
        const Span row = join(args.front().span, args.back().span);
        d.help("a list stands in brackets",
               {{{row.source, row.begin, row.begin}, "["}, {{row.source, row.end, row.end}, "]"}});
    } else if (name == "background")
        d.help("a gradient is a function of the direction: "
               "`background(d => mix(white, skyblue, saturate(d.y)))`");
    else if (name == "sphere" && args.size() == 3)
        d.help("a ball elsewhere is `sphere(1).translate([x, y, z])`, a stretched one "
               "`ellipsoid([1, 2, 3])`");
    else if (name == "cylinder" || name == "cone")
        d.help("a cone without its tip is `capped_cone(bottom, top, height)`");
    leave_last_away(ev, d, args, first);
}

static void report_missing(Interpreter &ev, std::string_view name, std::span<const Formal> formals,
                           std::span<const Argument> args, const Formal &missing, Span call) {
    Diagnostic &d = report(ev, Code::MissingArgument, call,
                           fmt::format("`{}` wants an argument `{}`", name, missing.name));
    d.note(fmt::format("it is `{}`", signature_text(name, formals)));
    if (name == "repeat" && !args.empty() && args.back().trailing)
        d.help("many are made by a loop: `for i in 0..5 { … }`");
    const auto required = std::ranges::count_if(
        formals, [](const Formal &f) { return !f.optional && !f.takes_rest; });
    if (required == 1 && formals.back().takes_rest && !args.empty() && args.back().trailing)
        d.help(fmt::format("write `{}(0.2) {{ … }}`", name));
    if (name == "range" && args.size() == 1) { // Python's
        const Span before{args[0].span.source, args[0].span.begin, args[0].span.begin};
        d.help("a range begins somewhere: `range(0, n)`, or `0..n`", {{before, "0, "}});
    }
    if (name == "rgb" && args.size() == 1 && is_numeric(args[0].value) &&
        ir::components(numeric_type(ev, args[0].value)) == 3) {
        const Span of = args[0].span;
        d.help("a vector of three numbers is a color already",
               {{{call.source, call.begin, of.begin}, ""}, {{call.source, of.end, call.end}, ""}});
    }
    if (!d.fix && args.empty()) help_with_second_call(ev, d, call);
    if (!d.fix)
        if (const std::string example = example_of(ev, name, formals); !example.empty())
            d.help(fmt::format("as in `{}`", example));
    if (!is_library_place(ev, missing.declared)) d.label(missing.declared, "declared here");
}

// The parameter that still wants an argument, where there is one such and one argument for it.
static std::string_view only_one_left(std::span<const Formal> formals,
                                      std::span<const Argument> args,
                                      std::span<const Given> bound) {
    std::string_view left;
    std::size_t unnamed = 0;
    bool named = false, function = false; // a function is what a shape's copies are made by
    for (const Argument &a : args) {
        named = named || a.name;
        const bool counts = named && !a.name && !a.trailing;
        unnamed += counts ? 1 : 0;
        function = function || (counts && is_function(a.value));
    }
    for (std::size_t i = 0; i < formals.size(); ++i) {
        const bool given = bound[i].given || std::ranges::any_of(args, [&](const Argument &a) {
                               return a.name && a.name->text == formals[i].name;
                           });
        const bool wanted = !formals[i].optional || (function && formals[i].name == "copies");
        if (given || !wanted || formals[i].takes_rest) continue;
        if (!left.empty()) return {};
        left = formals[i].name;
    }
    return unnamed == 1 ? left : std::string_view();
}

// Where the named arguments are the first ones, in their order: without the names.
static std::vector<Edit> names_away(std::span<const Formal> formals,
                                    std::span<const Argument> args) {
    std::vector<Edit> edits;
    bool unnamed = false;
    for (std::size_t i = 0; i < args.size(); ++i) {
        const Argument &a = args[i];
        unnamed = unnamed || !a.name;
        if (!a.name) continue;
        if (unnamed || i >= formals.size() || formals[i].name != a.name->text) return {};
        edits.push_back({{a.span.source, a.name->span.begin, a.span.begin}, ""});
    }
    return edits;
}

static void report_order(Interpreter &ev, std::span<const Formal> formals,
                         std::span<const Argument> args, std::span<const Given> bound,
                         const Argument &a, Span first_named) {
    Diagnostic &d = report(ev, Code::ArgumentOrder, a.span,
                           "an argument without a name stands behind one with a name")
                        .label(first_named, "named here");
    const auto place = static_cast<std::size_t>(&a - args.data());
    if (place > 0 && args[place - 1].value.kind == ValueKind::Int && a.plain_literal) {
        const Span between{a.span.source, args[place - 1].span.end, a.span.begin};
        if (text(ev.sources, between) == ",") { // `cylinder(radius: 0,5, height: 2)`
            d.help("a fraction is written with a point", {{between, "."}});
            return;
        }
    }
    const std::string_view left = only_one_left(formals, args, bound);
    if (const auto edits = names_away(formals, args); left.empty() && !edits.empty())
        d.help("the arguments stand in their order, and need no names", edits);
    else if (left.empty())
        d.help("put it in front, or name it too" + names_left(formals, bound));
    else
        d.help(fmt::format("write `{}: {}`", left, text(ev.sources, a.span)),
               {{{a.span.source, a.span.begin, a.span.begin}, fmt::format("{}: ", left)}});
}

static bool is_direction(const Formal &formal) {
    return formal.is_place &&
           (formal.name == "axis" || formal.name == "normal" || formal.name == "direction");
}

// `plane(-1)`, `s.mirror(1)`: one number would be a vector of equal parts.
static void report_number_as_direction(Interpreter &ev, std::string_view name, const Formal &formal,
                                       std::span<const Argument> args, const Given &given) {
    Diagnostic &d =
        report(ev, Code::TypeMismatch, given.span,
               fmt::format("`{}` of `{}` is a direction, not a number", formal.name, name));
    if (name == "plane" && args.size() == 1 && !args[0].name) {
        const std::string written = fmt::format("Y, {}", text(ev.sources, given.span));
        d.help(fmt::format("a level is `plane({})`", written), {{given.span, written}});
    } else
        d.help("the axes are `X`, `Y` and `Z`; any other direction is a vector, `[1, 2, 0]`");
}

std::optional<std::vector<Given>> bind_arguments(Interpreter &ev, std::string_view name,
                                                 std::span<const Formal> formals,
                                                 std::span<const Argument> args, Span call,
                                                 Span callee) {
    // a block that could not be read: reported, and perhaps the arguments
    if (!args.empty() && args.back().trailing && is_poison(args.back().value)) return std::nullopt;
    Given nothing;
    nothing.span = callee;
    std::vector<Given> bound(formals.size(), nothing);
    bool ok = true;
    std::optional<Span> first_named;
    bool told_order = false;
    std::size_t next = 0;
    std::vector<Value> rest;
    Span rest_span = callee;
    bool has_rest = !formals.empty() && formals.back().takes_rest;
    std::vector<std::size_t> unknown, by_place; // arguments; by_place: of each parameter
    by_place.assign(formals.size(), args.size());
    auto give = [&](std::size_t i, const Argument &a) {
        if (bound[i].given) {
            Diagnostic &d = report(
                ev, Code::DuplicateArgument, a.name ? a.name->span : a.span,
                fmt::format("`{}` is given twice in this call of `{}`", formals[i].name, name));
            d.label(bound[i].span, by_place[i] < args.size() && a.name ? "given here, by its place"
                                                                       : "given here");
            if (i == 0 && by_place[0] < args.size() && a.name)
                if (Fix fix = remedy_of_duplicate(ev, name, args, a, call); !fix.message.empty())
                    d.help(fix.message, fix.edits);
            ok = false;
            return;
        }
        if (!a.name && !a.trailing) by_place[i] = static_cast<std::size_t>(&a - args.data());
        bound[i] = {a.value, a.span, true, a.plain_literal};
    };
    for (const Argument &a : args) {
        if (a.trailing) {
            if (formals.empty()) {
                report(ev, Code::TooManyArguments, a.span,
                       fmt::format("`{}` takes no block", name));
                return std::nullopt;
            }
            if (!rest.empty()) { // shapes before the block join it
                const std::vector<Value> &block = ev.lists[a.value.id];
                rest.insert(rest.end(), block.begin(), block.end());
            } else
                give(formals.size() - 1, a);
            continue;
        }
        if (a.name) {
            first_named = a.name->span;
            std::size_t i = 0;
            while (i < formals.size() && formals[i].symbol != a.symbol) ++i;
            if (i == formals.size() || a.name->text[0] == '_') {
                unknown.push_back(static_cast<std::size_t>(&a - args.data()));
                ok = false;
                continue;
            }
            give(i, a);
            continue;
        }
        if (first_named && std::exchange(told_order, true)) continue;
        if (first_named) {
            report_order(ev, formals, args, bound, a, *first_named);
            ok = false;
            continue;
        }
        if (has_rest && next + 1 >= formals.size()) {
            rest.push_back(a.value);
            rest_span = rest.size() == 1 ? a.span : join(rest_span, a.span);
            continue;
        }
        while (next < formals.size() && bound[next].given) ++next;
        if (next >= formals.size()) {
            report_too_many(ev, name, formals, args, a);
            return std::nullopt;
        }
        give(next++, a);
    }
    if (!rest.empty()) {
        Argument a;
        a.value = rest.size() == 1 && rest[0].kind == ValueKind::List && formals.back().opens_list
                      ? rest[0]
                      : list_value(ev, std::move(rest));
        a.span = rest_span;
        give(formals.size() - 1, a);
    }
    if (!unknown.empty()) report_unknown_arguments(ev, name, formals, args, unknown, callee);
    // `light(1, 2, 3)`: one number fills a size, but is no place
    const bool of_user = !ev.modules[ev.current_module].library;
    for (std::size_t i = 0; ok && of_user && i < formals.size(); ++i) {
        if (is_direction(formals[i]) && bound[i].given && is_scalar(ev, bound[i].value)) {
            report_number_as_direction(ev, name, formals[i], args, bound[i]);
            return std::nullopt;
        }
        const std::size_t first = by_place[i];
        std::size_t end = first;
        while (end < args.size() && !args[end].name && !args[end].trailing &&
               is_scalar(ev, args[end].value))
            ++end;
        if (!is_vector_by_numbers(formals, i, end - first)) continue;
        const Fix fix =
            remedy_of_row(args.subspan(first, end - first), formals[i].vector_size, true);
        report(ev, Code::TypeMismatch, join(args[first].span, args[end - 1].span),
               fmt::format("`{}` of `{}` is one vector, not {} numbers", formals[i].name, name,
                           end - first))
            .help(fix.message, fix.edits);
        return std::nullopt;
    }
    for (std::size_t i = 0; i < formals.size(); ++i) {
        if (bound[i].given || formals[i].optional) continue;
        if (!ok) return std::nullopt;
        report_missing(ev, name, formals, args, formals[i], call);
        return std::nullopt;
    }
    if (!ok) return std::nullopt;
    return bound;
}

static bool is_shape_list(const lang::TypeExpr &type) {
    return type.kind == lang::TypeExpr::Kind::List &&
           (type.items[0].named == lang::TypeName::Shape ||
            type.items[0].named == lang::TypeName::Shape2 ||
            type.items[0].named == lang::TypeName::AnyShape);
}

static bool is_place(std::string_view name) {
    return name == "at" || name == "look_at" || name == "direction" || name == "by" ||
           name == "axis" || name == "normal";
}

std::span<const Formal> formals_of(Interpreter &ev, const Closure &c) {
    std::optional<std::vector<Formal>> &formals = ev.files[c.ast->place].formals[c.function.index];
    if (formals) return *formals;
    formals.emplace();
    const lang::Function &f = c.ast->functions[c.function];
    for (const lang::Parameter &p : f.parameters) {
        Formal formal;
        formal.symbol = symbol_of(*c.ast, p.name);
        formal.name = p.name.text;
        formal.optional = p.default_value.has_value();
        formal.takes_rest = &p == &f.parameters.back() && p.type && is_shape_list(*p.type);
        formal.is_angle = p.type && p.type->in_radians;
        if (p.type && p.type->named == lang::TypeName::Vec2) formal.vector_size = 2;
        if (p.type && p.type->named == lang::TypeName::Vec3) formal.vector_size = 3;
        formal.takes_function = p.type && p.type->kind == lang::TypeExpr::Kind::Function;
        formal.is_place = c.library && formal.vector_size > 0 && is_place(p.name.text);
        if (p.default_value) {
            const auto *name = std::get_if<lang::Name>(&c.ast->exprs[*p.default_value].kind);
            formal.no_limit = name && name->text == "inf";
        }
        formal.declared = p.name.span;
        formals->push_back(formal);
    }
    return *formals;
}

std::span<const Formal> formals_of(Interpreter &ev, const Builtin &builtin) {
    const std::size_t place = static_cast<std::size_t>(&builtin - builtins().data());
    std::optional<std::vector<Formal>> &formals = ev.builtin_formals[place];
    if (formals) return *formals;
    formals.emplace();
    for (const BuiltinParameter &p : builtin.parameters) {
        Formal formal;
        formal.symbol = intern(ev, p.name);
        formal.name = p.name;
        formal.optional = p.optional;
        formal.is_angle = p.is_angle;
        formal.is_place = is_place(p.name);
        if (formal.is_place) formal.vector_size = 3;
        formals->push_back(formal);
    }
    if (builtin.variadic) {
        formals->back().takes_rest = true;
        formals->back().opens_list = !builtin.parameters.back().lists;
    }
    return *formals;
}

// `rotate_euler([0, 90, 0])`: each plain literal of more than a turn.
static void warn_of_degrees_in_vector(Interpreter &ev, const Formal &formal, const Given &given,
                                      const Value &v) {
    const auto large = [&](int i) { return std::abs(v.num[static_cast<std::size_t>(i)]) > 6.5; };
    std::string written = "[";
    bool any = false;
    for (int i = 0; i < v.size; ++i) {
        const double x = v.num[static_cast<std::size_t>(i)];
        any = any || large(i);
        written += fmt::format("{}{}{}", i ? ", " : "", x, x == 0 ? "" : "deg");
    }
    written += "]";
    if (!any) return;
    report(ev, Code::Units, given.span, fmt::format("`{}` are in radians", formal.name))
        .help(fmt::format("write `{}` if degrees are meant", written), {{given.span, written}});
}

// The number in `i * 30`, of those that are parts of a full turn in degrees; nothing: none.
static std::optional<Span> degrees_in_product(const Interpreter &ev, Span place) {
    constexpr std::string_view parts = " 10 15 20 30 36 40 45 60 72 90 120 180 360 ";
    const std::string_view written = text(ev.sources, place);
    const std::size_t sign = written.find(" * ");
    if (sign == written.npos || written.find_first_of("*/+-%^", sign + 2) != written.npos)
        return std::nullopt;
    const auto is_part = [&](std::string_view word) {
        return parts.find(" " + std::string(word) + " ") != parts.npos;
    };
    const auto at = [&](std::size_t begin, std::size_t end) {
        return Span{place.source, static_cast<std::uint32_t>(place.begin + begin),
                    static_cast<std::uint32_t>(place.begin + end)};
    };
    if (is_part(written.substr(sign + 3))) return at(sign + 3, written.size());
    return is_part(written.substr(0, sign)) ? std::optional(at(0, sign)) : std::nullopt;
}

// `rotate(90)`: a plain literal of more than a turn; `rotate(i * 30)`, `cos(i * 30)`.
void warn_of_degrees(Interpreter &ev, const Formal &formal, const Given &given, const Value &v) {
    if (!formal.is_angle || is_library_place(ev, given.span)) return;
    if (!given.plain_literal) {
        const auto part =
            given.value.kind == ValueKind::Int ? degrees_in_product(ev, given.span) : std::nullopt;
        if (!part) return;
        const std::string degrees = source_text(ev, *part) + "deg";
        report(ev, Code::Units, given.span, fmt::format("`{}` is in radians", formal.name))
            .help(fmt::format("write `{}` if degrees are meant", degrees), {{*part, degrees}});
        return;
    }
    if (v.kind == ValueKind::Vec) return warn_of_degrees_in_vector(ev, formal, given, v);
    if (!is_scalar(ev, v) || std::abs(v.num[0]) <= 6.5) return;
    report(ev, Code::Units, given.span,
           fmt::format("`{}` is in radians, and {} of them are {:.0f} turns", formal.name, v.num[0],
                       std::abs(v.num[0]) / 6.283185307179586))
        .help(fmt::format("write `{}deg` if degrees are meant", v.num[0]),
              {{given.span, fmt::format("{}deg", v.num[0])}});
}

} // namespace fathom::typecheck
