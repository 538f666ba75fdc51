// What to write in place of what other languages have, and the edits that carry a call over.
#include "typecheck/remedies.h"

#include "base/suggest.h"
#include "base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace fathom::typecheck {

void help_with_shape(Diagnostic &d, std::string_view name) {
    constexpr const char *painted = "a shape is given a colour or a material by `.paint(…)`";
    constexpr std::pair<std::string_view, std::string_view> ways[] = {
        {"min", "shapes are united with `|`"},
        {"max", "shapes are intersected with `&`"},
        {"mix", "shapes are mixed by `blend(a, b, t)`"},
        {"smin", "shapes flow together in `smooth_union(k) { a; b }`"},
        {"smax", "shapes meet smoothly in `smooth_intersection(k) { a; b }`"},
        {"length", "a distance is measured from a function of the point: `implicit(p => …)`"},
        {"smoothstep", "shapes flow together in `smooth_union(r) { … }`"},
        {"abs", "a shape's skin is `.shell(thickness)`"},
        {"round", "`.offset(r)` rounds what is convex and grows by r; boxes have `rounded_box`"},
        {"mod", "a shape is repeated by `.repeat(cell)`"},
        {"fract", "a shape is repeated by `.repeat(cell)`"},
        {"color", painted},
        {"colour", painted},
        {"material", painted},
        {"texture", painted}};
    for (const auto &[known, way] : ways)
        if (name == known) d.help(std::string(way));
    constexpr std::array<std::string_view, 5> joints = {"smooth", "round", "chamfer", "stairs",
                                                        "columns"};
    if (std::ranges::find(joints, name.substr(0, name.find('_'))) != joints.end() &&
        name.find('_') != name.npos)
        d.help(fmt::format("the shapes stand in a block behind it: `{}(r) {{ … }}`", name));
}

void help_with_shapes(const Interpreter &ev, Diagnostic &d, const CallSite &site,
                      std::span<const Value> args) {
    constexpr std::pair<std::string_view, std::string_view> functions[] = {
        {"min", "union"}, {"max", "intersection"}, {"mix", "blend"}};
    const auto is_shape = [](const Value &v) { return v.kind == ValueKind::Shape; };
    const auto ours = std::ranges::find(functions, site.name,
                                        &std::pair<std::string_view, std::string_view>::first);
    const bool shapes = args.size() > 1 && std::ranges::all_of(args.first(2), is_shape);
    if (ours == std::end(functions) || !shapes || is_library_place(ev, site.callee))
        return help_with_shape(d, site.name);
    d.help(site.name == "mix"   ? "shapes are mixed by `blend(a, b, t)`"
           : site.name == "min" ? "shapes are united by `union(a, b)`, or `a | b`"
                                : "what shapes have in common is `intersection(a, b)`, or `a & b`",
           {{site.callee, std::string(ours->second)}});
}

void help_with_cut(Diagnostic &d, const Value &cut) {
    if (cut.kind == ValueKind::Region)
        d.help("regions are cut by regions: `ball(3) - tube(Y, 0.1)`");
    else if (is_numeric(cut))
        d.help("`.offset(r)` moves a shape's surface outwards by r, `.offset(-r)` inwards");
}

std::string source_text(const Interpreter &ev, Span span) {
    return std::string(text(ev.sources, span));
}

// With parentheses where operators stand in it.
std::string operand_source(const Interpreter &ev, Span span) {
    const std::string s = source_text(ev, span);
    int depth = 0;
    for (std::size_t i = 0; i < s.size(); ++i) {
        if (s[i] == '(' || s[i] == '[' || s[i] == '{') ++depth;
        if (s[i] == ')' || s[i] == ']' || s[i] == '}') --depth;
        if (depth == 0 && std::string_view("|&+-*/%^<>=?").find(s[i]) != std::string_view::npos)
            return "(" + s + ")";
    }
    return s;
}

Span whole_argument(const Argument &a) { return a.name ? join(a.name->span, a.span) : a.span; }

// A text as its words and signs; spaces go with what stands before them.
static std::vector<std::string_view> words_of(std::string_view all) {
    const auto is_word = [](char c) {
        return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
               c == '_' || c == '.';
    };
    std::vector<std::string_view> words;
    for (std::size_t begin = 0; begin < all.size();) {
        std::size_t end = begin + 1;
        if (is_word(all[begin]) && all[begin] != '.')
            while (end < all.size() && is_word(all[end])) ++end;
        words.push_back(all.substr(begin, end - begin));
        begin = end;
    }
    return words;
}

std::vector<Edit> least_edits(const Interpreter &ev, Span place, std::string_view written) {
    constexpr std::size_t most_words = 300; // the table is quadratic
    const std::string_view all = text(ev.sources, place);
    const auto before = words_of(all), after = words_of(written);
    const std::size_t n = before.size(), m = after.size();
    if (n > most_words || m > most_words) return {{place, std::string(written)}};
    // the length of the longest common row of words behind each pair of places
    std::vector<std::size_t> same((n + 1) * (m + 1));
    const auto at = [&](std::size_t i, std::size_t k) -> std::size_t & {
        return same[i * (m + 1) + k];
    };
    for (std::size_t i = n; i-- > 0;)
        for (std::size_t k = m; k-- > 0;)
            at(i, k) = before[i] == after[k] ? at(i + 1, k + 1) + before[i].size()
                                             : std::max(at(i + 1, k), at(i, k + 1));
    std::vector<Edit> edits;
    std::uint32_t begin = place.begin, end = place.begin; // of what goes
    std::string fresh;
    const auto flush = [&] {
        if (begin < end || !fresh.empty()) edits.push_back({{place.source, begin, end}, fresh});
        fresh.clear();
    };
    std::size_t i = 0, k = 0;
    while (i < n || k < m) {
        if (i < n && k < m && before[i] == after[k]) {
            flush();
            end += static_cast<std::uint32_t>(before[i].size());
            begin = end;
            ++i, ++k;
        } else if (k < m && (i == n || at(i, k + 1) >= at(i + 1, k)))
            fresh += after[k++];
        else
            end += static_cast<std::uint32_t>(before[i++].size());
    }
    flush();
    return edits;
}

// -- the order of arguments ----------------------------------------------------------------------

Fix remedy_of_duplicate(Interpreter &ev, std::string_view function, std::span<const Argument> args,
                        const Argument &named, Span call) {
    std::string list = source_text(ev, named.span);
    for (const Argument &a : args) {
        if (a.trailing) return {};
        if (&a != &named) list += ", " + source_text(ev, whole_argument(a));
    }
    const std::string written = fmt::format("{}({})", function, list);
    if (written.find('\n') != std::string::npos) return {};
    return {fmt::format("`{}` stands first: `{}`", named.name->text, written), {{call, written}}};
}

Fix remedy_of_row(std::span<const Argument> row, int vector_size, bool place) {
    Fix fix{"a vector is written in brackets: `[x, y, z]`", {}};
    const bool flat = place && row.size() == 2 && vector_size == 3; // `translate(1, 2)`
    if (static_cast<int>(row.size()) != vector_size && !flat) return fix;
    const Span first = row.front().span, last = row.back().span;
    fix.edits = {{{first.source, first.begin, first.begin}, "["},
                 {{last.source, last.end, last.end}, flat ? ", 0]" : "]"}};
    return fix;
}

// The arguments in the order of the parameters that take them, where all have places alone and
// some do not fit theirs.
static std::optional<std::vector<std::size_t>>
other_order(Interpreter &ev, const lang::Function &function, std::span<const Argument> args) {
    constexpr std::size_t most = 6;
    const auto &parameters = function.parameters;
    if (args.size() > std::min(most, parameters.size()) || args.size() < 2 ||
        std::ranges::any_of(args, [](const Argument &a) { return a.name || a.trailing; }))
        return std::nullopt;
    const auto takes = [&](std::size_t p, std::size_t a) {
        return !parameters[p].type || accepts(ev, args[a].value, *parameters[p].type);
    };
    std::vector<std::size_t> order;
    bool fit = true;
    for (std::size_t p = 0; p < args.size(); ++p) {
        fit = fit && takes(p, p);
        std::size_t a = 0;
        while (a < args.size() && (std::ranges::find(order, a) != order.end() || !takes(p, a))) ++a;
        if (a == args.size()) return std::nullopt;
        order.push_back(a);
    }
    return fit ? std::nullopt : std::optional(order);
}

bool shape_out_of_place(Interpreter &ev, std::string_view name, const lang::Function &function,
                        std::span<const Formal> formals, std::span<const Argument> args,
                        Span call) {
    const bool lone_list = args.size() == 1 && args[0].value.kind == ValueKind::List;
    if ((args.size() < 2 && !lone_list) || function.parameters.empty() ||
        !function.parameters[0].type || std::ranges::any_of(args, [](const Argument &a) {
            return a.trailing || is_poison(a.value);
        }))
        return false;
    using lang::TypeName;
    const lang::TypeExpr &type = *function.parameters[0].type;
    const bool takes_shape = type.kind == lang::TypeExpr::Kind::Name &&
                             (type.named == TypeName::Shape || type.named == TypeName::Shape2 ||
                              type.named == TypeName::AnyShape);
    const auto is_shape = [](const Argument &a) { return a.value.kind == ValueKind::Shape; };
    const auto is_shapes = [&](const Argument &a) { // or a list of them
        if (a.value.kind != ValueKind::List) return is_shape(a);
        const std::vector<Value> &items = ev.lists[a.value.id];
        return !items.empty() && std::ranges::all_of(items, [](const Value &v) {
            return v.kind == ValueKind::Shape;
        });
    };
    const auto join_others = [&](const Argument &moved) {
        std::string list;
        for (const Argument &a : args)
            if (&a != &moved)
                list += (list.empty() ? "" : ", ") + source_text(ev, whole_argument(a));
        return list;
    };
    const auto say = [&](std::string message, std::string written) {
        Diagnostic &d = report(ev, Code::TypeMismatch, args[0].span, std::move(message));
        if (written.find('\n') == std::string::npos)
            d.help(fmt::format("write `{}`", written), least_edits(ev, call, written));
        return true;
    };
    if (const auto order =
            formals.back().takes_rest ? std::nullopt : other_order(ev, function, args)) {
        const bool method = source_text(ev, args[0].span) ==
                            source_text(ev, call).substr(0, args[0].span.end - args[0].span.begin);
        const bool chained = method || takes_shape;
        const std::string first = source_text(ev, args[(*order)[0]].span);
        const std::size_t shapes = static_cast<std::size_t>(std::ranges::count_if(args, is_shape));
        std::string list;
        for (std::size_t i = 1; i < order->size(); ++i)
            list += (i > 1 ? ", " : "") + source_text(ev, args[(*order)[i]].span);
        const std::string written =
            chained && (method || shapes == 1)
                ? fmt::format("{}.{}({})", operand_source(ev, args[(*order)[0]].span), name, list)
                : fmt::format("{}({}, {})", name, first, list);
        std::size_t wrong = 0;
        while (wrong + 1 < order->size() && (*order)[wrong] == wrong) ++wrong;
        Diagnostic &d =
            report(ev, Code::TypeMismatch, args[wrong].span,
                   takes_shape && !is_shape(args[0])
                       ? fmt::format("the shape stands first, before what `{}` does to it", name)
                       : fmt::format("`{}` of `{}` stands before this", formals[wrong].name, name));
        if (written.find('\n') == std::string::npos)
            d.help(fmt::format("write `{}`", written), least_edits(ev, call, written));
        return true;
    }
    if (takes_shape && !args[0].name && !is_shape(args[0])) {
        const auto shape = std::ranges::find_if(args, is_shape);
        if (shape == args.end() || shape->name) return false;
        return say(
            fmt::format("the shape stands first, before what `{}` does to it", name),
            fmt::format("{}.{}({})", operand_source(ev, shape->span), name, join_others(*shape)));
    }
    if (formals.back().takes_rest && type.named == TypeName::Float && !args[0].name &&
        is_shapes(args[0])) {
        const auto number = std::ranges::find_if(
            args, [&](const Argument &a) { return !a.name && is_scalar(ev, a.value); });
        const bool alone =
            std::ranges::all_of(args, [&](const Argument &a) { return !a.name && is_shapes(a); });
        if (alone && !formals[0].optional) { // the number is nowhere
            std::string list;
            for (const Argument &a : args) list += ", " + source_text(ev, a.span);
            Diagnostic &d = report(
                ev, Code::MissingArgument, args[0].span,
                fmt::format("`{}` wants `{}`, a number, before the shapes", name, formals[0].name));
            const std::string written = fmt::format("{}(0.2{})", name, list);
            d.help(fmt::format("write `{}`", written.find('\n') == std::string::npos
                                                 ? written
                                                 : fmt::format("{}(0.2, …)", name)));
            return true;
        }
        if (number == args.end()) return false;
        std::string numbers, others;
        for (const Argument &a : args) {
            std::string &list = !a.name && is_scalar(ev, a.value) ? numbers : others;
            list += (list.empty() ? "" : ", ") + source_text(ev, whole_argument(a));
        }
        return say(
            fmt::format("`{}` of `{}` stands first, before the shapes", formals[0].name, name),
            fmt::format("{}({}, {})", name, numbers, others));
    }
    return false;
}

bool color_in_quotes(Interpreter &ev, std::string_view name, std::span<const Formal> formals,
                     std::span<const Given> given) {
    for (std::size_t i = 0; i < formals.size(); ++i) {
        const Given &g = given[i];
        if (!g.given || formals[i].name != "material") continue;
        if (g.value.kind == ValueKind::Vec && g.value.ints && g.value.size == 3)
            warn_of_bytes(ev, g.span,
                          std::array{integer(g.value.num[0]), integer(g.value.num[1]),
                                     integer(g.value.num[2])});
        if (g.value.kind != ValueKind::String) continue;
        Diagnostic &d = report(ev, Code::TypeMismatch, g.span,
                               fmt::format("{} wants a color or a material, this is a string",
                                           quoted(formals[i].name, name)));
        help_with_value(ev, d, g.value, lang::TypeName::Color, g.span);
        return true;
    }
    return false;
}

// -- values --------------------------------------------------------------------------------------

// What a style sheet calls a colour, `#ff8800`, `ff8800`, `rgb(255, 136, 0)`, as it is written here;
// empty: none.
static std::string color_in(std::string_view style) {
    const std::string_view digits = style.starts_with('#') ? style.substr(1) : style;
    const bool hex = digits.find_first_not_of("0123456789abcdefABCDEF") == digits.npos;
    if (hex && (digits.size() == 3 || digits.size() == 6 || digits.size() == 8))
        return fmt::format("#{}", digits);
    const std::size_t open = style.find('(');
    if (!style.starts_with("rgb") || open == style.npos) return {};
    std::string color = "#";
    for (std::size_t at = open; color.size() < 7;) {
        at = style.find_first_of("0123456789", at);
        if (at == style.npos) return {};
        const std::size_t end = std::min(style.find_first_not_of("0123456789", at), style.size());
        const auto part = parse_number(style.substr(at, end - at));
        if (!part || *part > 255) return {};
        color += fmt::format("{:02x}", static_cast<int>(*part));
        at = end;
    }
    return color;
}

// `rgb(255, 128, 0)`, `[255, 128, 0]`: of the parts one is too large for any light.
void warn_of_bytes(Interpreter &ev, Span place, std::span<const Value> parts) {
    constexpr double brightest = 16;
    double maximum = 0;
    if (parts.size() != 3) return;
    for (const Value &v : parts) {
        if (v.kind != ValueKind::Int || v.num[0] < 0 || v.num[0] > 255) return;
        maximum = std::max(maximum, v.num[0]);
    }
    if (maximum <= brightest) return;
    const std::string hex =
        fmt::format("#{:02x}{:02x}{:02x}", static_cast<int>(parts[0].num[0]),
                    static_cast<int>(parts[1].num[0]), static_cast<int>(parts[2].num[0]));
    report(ev, Code::Units, place,
           fmt::format("the parts of a colour go from 0 to 1, and one of these is {}", maximum))
        .help(fmt::format("write `{}` if parts of 255 are meant", hex), {{place, hex}});
}

// `45` of `45deg`.
static std::string_view without_unit(std::string_view number) {
    for (const std::string_view unit : {"deg", "turn", "rad"})
        if (number.ends_with(unit)) number.remove_suffix(unit.size());
    return number;
}

void help_with_value(Interpreter &ev, Diagnostic &d, const Value &v, lang::TypeName wanted,
                     Span place) {
    using lang::TypeName;
    if (!place.source || is_library_place(ev, place)) {
        if (v.kind == ValueKind::String && wanted == TypeName::Color)
            d.help("colours are written without quotes: `red`, `#ff0000`");
        return;
    }
    const std::string written = source_text(ev, place);
    const bool list = written.starts_with('[') && written.ends_with(']');
    if (wanted == TypeName::Vec3 && list && is_numeric(v) && numeric_type(ev, v) == ir::Type::Vec2)
        d.help("a vec3 has three parts", {{{place.source, place.end - 1, place.end - 1}, ", 0"}});
    if (wanted == TypeName::Vec2 && is_numeric(v) && numeric_type(ev, v) == ir::Type::Vec3)
        help_with_plane(ev, d, place);
    if (wanted == TypeName::Float && is_function(v))
        d.help(ev.in_field > 0 ? "a function gives a number where it is called: `f(p)`"
                               : "a function gives a number where it is called, `f(x)`; a shape is "
                                 "made of a function of the point by `implicit(f, within: …)`");
    if (v.kind == ValueKind::String && !written.starts_with('"') &&
        (wanted == TypeName::Color || wanted == TypeName::Material))
        d.help("colours are written without quotes where they are named: `let c = red`");
    if (v.kind != ValueKind::String || !written.starts_with('"')) return;
    const std::string &inside = ev.strings[v.id];
    if ((wanted == TypeName::Float || wanted == TypeName::Int) &&
        parse_number(without_unit(inside)))
        d.help("a number is written without quotes", {{place, inside}});
    else if (wanted == TypeName::Float || wanted == TypeName::Int)
        d.help("a text is no number: one is written without quotes, as `2` or `45deg`");
    if (wanted == TypeName::Vec3 && axis_text(ev, v, place).empty())
        d.help("a text is no vector: one is written `[1, 2, 3]`, without quotes; a number fills "
               "all three parts");
    if (const std::string axis = axis_text(ev, v, place); wanted == TypeName::Vec3 && !axis.empty())
        d.help("the axes are `X`, `Y` and `Z`, without quotes", {{place, axis}});
    if (wanted != TypeName::Color && wanted != TypeName::Material) return;
    const auto named = look_up(ev, ev.prelude_frame, intern(ev, inside));
    if (inside.ends_with(".png") || inside.ends_with(".jpg") || inside.ends_with(".jpeg")) {
        const std::string image = fmt::format("material(texture: image({}))", written);
        d.help(fmt::format("a picture lies on a shape by `{}`", image), {{place, image}});
        return;
    }
    const std::string color = named && !is_function(*named) ? inside : color_in(inside);
    d.help(color.empty() ? fmt::format("no colour is called `{}`: one is `red`, `#8a5a2b`, or a "
                                       "`material(diffuse: red)`",
                                       short_name(inside))
                         : "colours are written without quotes: `red`, `#ff0000`",
           color.empty() ? std::vector<Edit>{} : std::vector<Edit>{{place, color}});
}

std::string_view way_of_part(std::string_view part) {
    constexpr std::pair<std::string_view, std::string_view> ways[] = {
        {"position", "a shape is moved by `.translate(…)`, which gives a new one"},
        {"location", "a shape is moved by `.translate(…)`, which gives a new one"},
        {"rotation", "a shape is turned by `.rotate(angle, axis: Y)`, which gives a new one"},
        {"rotation_euler", "a shape is turned by `.rotate_euler([x, y, z])`"},
        {"quaternion", "a shape is turned by `.rotate(angle, axis: Y)`"},
        {"scale", "a shape is scaled by `.scale(2)`, which gives a new one"},
        {"material", "a shape is given a colour or a material by `.paint(…)`"},
        {"color", "a shape is given a colour or a material by `.paint(…)`"},
        {"colour", "a shape is given a colour or a material by `.paint(…)`"}};
    for (const auto &[theirs, way] : ways)
        if (theirs == part) return way;
    return {};
}

void report_unknown_member(Interpreter &ev, const Value &object, const File &ast,
                           const lang::Member &member, Span place) {
    const lang::Identifier &name = member.name;
    const Span behind{place.source, ast.exprs[member.object].span.end, place.end};
    std::vector<Edit> edits;
    std::string made_of;
    if (object.kind == ValueKind::Shape && ev.quiet == 0)
        edits = part_of_shape(ev, ast, member, made_of);
    if (!edits.empty()) { // one report for all places
        const auto [it, fresh] =
            ev.unknown_names.try_emplace({place.source.index, source_text(ev, place)}, place);
        if (!fresh && it->second != place) return;
    }
    Diagnostic &d = report(ev, Code::UnknownMember, name.span,
                           fmt::format("{} has no member `{}`", describe(ev, object), name.text));
    const bool counts = name.text == "length" || name.text == "size" || name.text == "count";
    if (object.kind == ValueKind::List && counts && place.source)
        d.help("write `len(…)`",
               {{{place.source, place.begin, place.begin}, "len("}, {behind, ")"}});
    else if (object.kind == ValueKind::Shape) {
        if (const auto way = way_of_part(name.text); !way.empty())
            d.help(std::string(way));
        else if (const auto elsewhere = way_from_elsewhere(name.text); !elsewhere.empty())
            d.help(std::string(elsewhere));
        else if (const auto own = own_value(ev, ast, name.text); !own.message.empty())
            d.help(own.message, {{{behind.source, behind.begin, name.span.end}, own.call}});
        else if (!edits.empty())
            d.help("a shape does not tell what it was made of: use " + made_of, std::move(edits));
        else
            d.help(fmt::format("a shape does not tell what it was made of: bind that first, as in "
                               "`let {} = 1`, and use it in both places",
                               short_name(name.text)));
    }
}

// -- bodies ----------------------------------------------------------------------------------------

bool report_unfinished(Interpreter &ev, const Closure &c, const lang::Function &f,
                       std::string_view name) {
    if (c.ast->blocks[f.body].stmts.empty()) return false;
    const lang::Stmt &last = c.ast->blocks[f.body].stmts.back();
    const auto say = [&](std::string_view what, std::string help, Edit edit) {
        report(ev, Code::MissingValue, last.span,
               fmt::format("{} ends with {}, and so has no value",
                           f.name ? fmt::format("`{}`", name) : "this function", what))
            .help(std::move(help), {std::move(edit)});
        return true;
    };
    const auto without_head = [&](lang::ExprId value) {
        return Edit{{last.span.source, last.span.begin, c.ast->exprs[value].span.begin}, ""};
    };
    if (auto *l = std::get_if<lang::Let>(&last.kind))
        return say(
            "a `let`",
            fmt::format("leave `let {} =` away: the last expression is the value", l->name.text),
            without_head(l->value));
    if (auto *v = std::get_if<lang::Var>(&last.kind))
        return say(
            "a `var`",
            fmt::format("leave `var {} =` away: the last expression is the value", v->name.text),
            without_head(v->value));
    if (auto *a = std::get_if<lang::Assign>(&last.kind)) {
        lang::ExprId target = a->target;
        while (true) {
            const lang::ExprKind &kind = c.ast->exprs[target].kind;
            if (auto *m = std::get_if<lang::Member>(&kind))
                target = m->object;
            else if (auto *i = std::get_if<lang::Index>(&kind))
                target = i->object;
            else
                break;
        }
        const std::string variable(text(ev.sources, c.ast->exprs[target].span));
        return say("an assignment", fmt::format("end it with the value: `{}`", variable),
                   {{last.span.source, last.span.end, last.span.end}, "; " + variable});
    }
    return false;
}

} // namespace fathom::typecheck
