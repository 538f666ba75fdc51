// Arguments to parameters, and what is said where they do not fit.
#include "typecheck/binding.h"

#include "base/suggest.h"

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

std::optional<std::vector<Given>> bind_arguments(Evaluator &ev, std::string_view name,
                                                 std::span<const Formal> formals,
                                                 std::span<const Argument> args, Span call,
                                                 Span callee) {
    Given nothing;
    nothing.span = callee;
    std::vector<Given> bound(formals.size(), nothing);
    bool ok = true;
    std::optional<Span> first_named;
    std::size_t next = 0;
    std::vector<Value> rest;
    Span rest_span = callee;
    bool has_rest = !formals.empty() && formals.back().takes_rest;
    auto give = [&](std::size_t i, const Argument &a) {
        if (bound[i].given) {
            Diagnostic &d = report(
                ev, Code::DuplicateArgument, a.name ? a.name->span : a.span,
                fmt::format("`{}` is given twice in this call of `{}`", formals[i].name, name));
            d.label(bound[i].span, "given here");
            ok = false;
            return;
        }
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
                std::vector<std::string> names;
                for (const Formal &f : formals) names.emplace_back(f.name);
                Diagnostic &d =
                    report(ev, Code::UnknownArgument, a.name->span,
                           fmt::format("`{}` has no argument `{}`", name, a.name->text));
                std::string near = nearest_name(a.name->text, names);
                if (near.empty()) near = shortest_begun_by(a.name->text, names); // `r` for `radius`
                if (a.name->text == "within" && name != "within")
                    d.help("a region stands behind the whole: `.within(ball(3))`");
                else if (!near.empty())
                    d.help(fmt::format("did you mean `{}`?", near), {{a.name->span, near}});
                d.note(fmt::format("it is `{}`", signature_text(name, formals)));
                ok = false;
                continue;
            }
            give(i, a);
            continue;
        }
        if (first_named) {
            report(ev, Code::ArgumentOrder, a.span,
                   "an argument without a name stands behind one with a name")
                .label(*first_named, "named here")
                .help("put it in front, or name it too");
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
            std::size_t given = 0;
            for (const Argument &b : args) given += b.trailing ? 0 : 1;
            Diagnostic &d =
                report(ev, Code::TooManyArguments, a.span,
                       fmt::format("`{}` takes {} argument{}, not {}", name, formals.size(),
                                   formals.size() == 1 ? "" : "s", given))
                    .note(fmt::format("it is `{}`", signature_text(name, formals)));
            if (args[0].value.kind == ValueKind::Shape)
                help_with_shape(d, name);
            else if (!formals.empty() && formals[0].is_vector &&
                     std::ranges::all_of(args, [&](const Argument &b) {
                         return !b.name && is_scalar(ev, b.value);
                     }))
                d.help("a vector is written in brackets: `[x, y, z]`");
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
    for (std::size_t i = 0; i < formals.size(); ++i) {
        if (bound[i].given || formals[i].optional) continue;
        if (!ok) return std::nullopt;
        Diagnostic &d = report(ev, Code::MissingArgument, call,
                               fmt::format("`{}` wants an argument `{}`", name, formals[i].name));
        d.note(fmt::format("it is `{}`", signature_text(name, formals)));
        if (!is_library_place(ev, formals[i].declared))
            d.label(formals[i].declared, "declared here");
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

static bool is_angle(std::string_view name) { return name == "angle" || name == "fov"; }

std::span<const Formal> formals_of(Evaluator &ev, const Closure &c) {
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
        formal.is_angle = is_angle(p.name.text);
        formal.is_vector = p.type && (p.type->named == lang::TypeName::Vec2 ||
                                      p.type->named == lang::TypeName::Vec3);
        if (p.default_value) {
            const auto *name = std::get_if<lang::Name>(&c.ast->exprs[*p.default_value].kind);
            formal.no_limit = name && name->text == "inf";
        }
        formal.declared = p.name.span;
        formals->push_back(formal);
    }
    return *formals;
}

std::span<const Formal> formals_of(Evaluator &ev, const Builtin &builtin) {
    const std::size_t place = static_cast<std::size_t>(&builtin - builtins().data());
    std::optional<std::vector<Formal>> &formals = ev.builtin_formals[place];
    if (formals) return *formals;
    formals.emplace();
    for (const BuiltinParameter &p : builtin.parameters) {
        Formal formal;
        formal.symbol = intern(ev, p.name);
        formal.name = p.name;
        formal.optional = p.optional;
        formal.is_angle = is_angle(p.name);
        formals->push_back(formal);
    }
    if (builtin.variadic) {
        formals->back().takes_rest = true;
        formals->back().opens_list = builtin.name != "concat"; // whose rest are lists
    }
    return *formals;
}

// `rotate(90)`: a plain literal of more than a turn.
void warn_of_degrees(Evaluator &ev, const Formal &formal, const Given &given, const Value &v) {
    if (!given.plain_literal || !formal.is_angle || !is_scalar(ev, v) || std::abs(v.num[0]) <= 6.5)
        return;
    report(ev, Code::Units, given.span,
           fmt::format("`{}` is in radians, and {} of them are {:.0f} turns", formal.name, v.num[0],
                       std::abs(v.num[0]) / 6.283185307179586))
        .help(fmt::format("write `{}deg` if degrees are meant", v.num[0]),
              {{given.span, fmt::format("{}deg", v.num[0])}});
}

} // namespace fathom::typecheck
