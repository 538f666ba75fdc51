// What is said where no table knows a name or a value: what there is of that kind, how the value
// would be called, which part of the point a letter is, or that a thing can be left away.
#include "typecheck/remedies.h"

#include "base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace fathom::typecheck {

namespace {

constexpr std::size_t farthest_bracket = 4000; // bytes that are searched for a bracket

bool is_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

// The bracket that closes the one at `open`; `npos`: it is far, or there is none.
std::size_t closing(std::string_view all, std::size_t open) {
    int depth = 0;
    for (std::size_t i = open; i < all.size() && i < open + farthest_bracket; ++i) {
        if (std::string_view("([{").find(all[i]) != std::string_view::npos) ++depth;
        if (std::string_view(")]}").find(all[i]) != std::string_view::npos && --depth == 0)
            return i;
    }
    return all.npos;
}

// The `(` of the call around a place; `npos`: none.
std::size_t call_around(std::string_view all, std::size_t place) {
    int depth = 0;
    for (std::size_t i = place, n = 0; i-- > 0 && n < farthest_bracket; ++n) {
        const char c = all[i];
        if (c == ')' || c == ']' || c == '}') ++depth;
        if ((c == '(' || c == '[' || c == '{') && depth-- == 0) return c == '(' ? i : all.npos;
    }
    return all.npos;
}

std::string_view callee_before(std::string_view all, std::size_t open) {
    std::size_t begin = open;
    while (begin > 0 && is_letter(all[begin - 1])) --begin;
    return all.substr(begin, open - begin);
}

// Where an expression ends that goes on from `at`: at a comma or a bracket of its surroundings.
std::size_t end_of_argument(std::string_view all, std::size_t at) {
    int depth = 0;
    for (; at < all.size(); ++at) {
        const char c = all[at];
        if (c == '(' || c == '[' || c == '{') ++depth;
        if ((c == ')' || c == ']' || c == '}') && depth-- == 0) return at;
        if (depth == 0 && (c == ',' || c == '\n' || c == ';')) return at;
    }
    return at;
}

std::string_view trimmed(std::string_view s) {
    const std::size_t begin = s.find_first_not_of(" \t\n"), end = s.find_last_not_of(" \t\n");
    return begin == s.npos ? std::string_view() : s.substr(begin, end - begin + 1);
}

// What a parameter may be given, by its name.
std::string_view value_for(const Formal &formal) {
    constexpr std::pair<std::string_view, std::string_view> values[] = {
        {"s", "sphere(1)"}, {"a", "sphere(1)"}, {"b", "box(1)"},   {"axis", "X"},
        {"normal", "Y"},    {"from", "Y"},      {"to", "X"},       {"angle", "30deg"},
        {"n", "6"},         {"count", "6"},     {"list", "[1, 2]"}};
    for (const auto &[name, value] : values)
        if (formal.name == name) return value;
    return formal.is_angle           ? "30deg"
           : formal.vector_size == 3 ? "[1, 2, 3]"
           : formal.vector_size == 2 ? "[1, 2]"
                                     : "1";
}

} // namespace

std::string_view what_there_is(const Value &object) {
    switch (object.kind) {
    case ValueKind::Shape:
        return "a shape is changed by `translate`, `rotate`, `scale`, `mirror`, `repeat`, "
               "`offset`, `shell`, `paint`, and joined to another by `|`, `-` and `&`";
    case ValueKind::List:
        return "a list has `l[i]` and `len(l)`; others are made of it by `map`, `filter`, `fold`, "
               "`sort`, `reverse`, `concat`, `zip`, and by a loop, `[for x in l { … }]`";
    case ValueKind::Range:
        return "in steps a range is `range(0, 10, 2)`, backwards `reverse(0..10)`";
    case ValueKind::String:
        return "strings are joined by `+`, which shows numbers too, and compared by `==`";
    case ValueKind::Int:
    case ValueKind::Float:
        return "what is computed of a number is a function: `abs(x)`, `floor(x)`";
    case ValueKind::Vec:
    case ValueKind::Field:
        return "a vector has its parts, `v.x` and `v.zyx`; what is computed of it is a function, "
               "as `length(v)`";
    case ValueKind::Material:
        return "a material is made whole: `material(diffuse: red, exponent: 50)`";
    case ValueKind::Poison:
    case ValueKind::Unit:
    case ValueKind::None:
    case ValueKind::Bool:
    case ValueKind::Mat:
    case ValueKind::Closure:
    case ValueKind::Builtin:
    case ValueKind::Overloads:
    case ValueKind::ConstField:
    case ValueKind::CachedField:
    case ValueKind::ImageField:
    case ValueKind::Region:
    case ValueKind::Setting:
    case ValueKind::Module: return {};
    }
    return {};
}

// `sphere {1}`: a block behind a call whose last parameter is no list of shapes.
bool told_of_block(Interpreter &ev, const Value &v, Span place, What what) {
    const std::string_view written = text(ev.sources, place);
    if (v.kind != ValueKind::List || !written.starts_with('{') || what.of.empty()) return false;
    std::vector<Edit> edits;
    if (written.ends_with('}') && written.find_first_of("\n;") == written.npos) {
        const std::string_view all = ev.sources[place.source].text;
        const std::string_view inner = written.substr(1, written.size() - 2);
        std::uint32_t begin = place.begin;
        while (begin > 0 && all[begin - 1] == ' ') --begin;
        const auto skipped =
            static_cast<std::uint32_t>(std::min(inner.find_first_not_of(' '), inner.size()));
        const auto kept = static_cast<std::uint32_t>(inner.find_last_not_of(' ') + 1);
        edits = {{{place.source, begin, place.begin + 1 + skipped}, "("},
                 {{place.source, place.begin + 1 + std::max(kept, skipped), place.end}, ")"}};
    }
    report(ev, Code::TypeMismatch, place,
           fmt::format("`{}` takes no block: braces hold shapes that are put together", what.of))
        .help("its arguments stand in parentheses", edits);
    return true;
}

void help_with_uncalled(Interpreter &ev, Diagnostic &d, const Value &v, Span place) {
    if (v.kind != ValueKind::Closure || is_library_place(ev, place)) return;
    const std::span<const Formal> formals = formals_of(ev, ev.closures[v.id]);
    const bool ready = std::ranges::all_of(formals, [](const Formal &f) { return f.optional; });
    const std::string name = operand_source(ev, place);
    if (name.find_first_of("\n(") != std::string::npos) return;
    std::string given;
    for (const Formal &f : formals)
        if (!f.optional) given += fmt::format("{}{}", given.empty() ? "" : ", ", value_for(f));
    d.help(fmt::format("a function gives its value where it is called: `{}({})`", name, given),
           ready ? std::vector<Edit>{{{place.source, place.end, place.end}, "()"}}
                 : std::vector<Edit>{});
}

std::string example_of(Interpreter &ev, std::string_view name, std::span<const Formal> formals) {
    const auto function = look_up(ev, ev.prelude_frame, intern(ev, std::string(name)));
    if (function && function->kind == ValueKind::Closure) {
        const Closure c = ev.closures[function->id];
        const std::string_view doc = c.ast->functions[c.function].doc;
        constexpr std::string_view mark = "Example: `";
        if (const std::size_t begin = doc.find(mark); begin != doc.npos) {
            const std::size_t first = begin + mark.size(), end = doc.find('`', first);
            if (end != doc.npos) return std::string(doc.substr(first, end - first));
        }
    }
    if (formals.empty() || formals[0].name != "s") return {};
    std::string list;
    for (const Formal &f : formals.subspan(1))
        if (!f.optional) list += fmt::format("{}{}", list.empty() ? "" : ", ", value_for(f));
    return fmt::format("{}.{}({})", value_for(formals[0]), name, list);
}

void leave_last_away(const Interpreter &ev, Diagnostic &d, std::span<const Argument> args,
                     const Argument &first) {
    const auto wrong = [](const Argument &a) { return is_poison(a.value); };
    if (d.fix || first.trailing || first.name || &first != &args.back() || args.size() < 2 ||
        is_function(first.value) || first.value.kind == ValueKind::Shape ||
        std::ranges::any_of(args, wrong))
        return;
    const Span before = args[args.size() - 2].span;
    d.help(fmt::format("leave `{}` away", source_text(ev, first.span)),
           {{{first.span.source, before.end, first.span.end}, ""}});
}

void help_with_second_call(const Interpreter &ev, Diagnostic &d, Span call) {
    if (!call.source || is_library_place(ev, call)) return;
    const std::string_view all = ev.sources[call.source].text;
    const std::size_t next = all.find_first_not_of(" \t", call.end);
    const std::string_view written = text(ev.sources, call);
    if (next == all.npos || all[next] != '(' || !written.ends_with("()")) return;
    d.help("what a function is given stands in its first parentheses",
           {{{call.source, call.end - 2, static_cast<std::uint32_t>(next)}, ""}});
}

Fix part_of_point(const Interpreter &ev, const std::string &name, Span place) {
    if (name.size() != 1 || name[0] < 'x' || name[0] > 'z' || !place.source) return {};
    const std::string_view all = ev.sources[place.source].text;
    if (ev.in_field > 0) {
        const std::string point = loop_variable(ev, place);
        if (point.empty() || point == name) return {};
        const std::string part = point + "." + name;
        return {fmt::format("a part of the point is `{}`", part), {{place, part}}};
    }
    std::string function;
    if (const auto edit = point_edit(ev, "p", place, function))
        return {fmt::format("the point is the argument of a function, and `{0}` a part of it: "
                            "`{1}(p => … p.{0} …)`",
                            name, function),
                {*edit, {place, "p." + name}}};
    // `s.cut(y > 0)`: what is on one side of a plane
    const std::size_t open = call_around(all, place.begin);
    const std::size_t sign = all.find_first_not_of(" \t", place.end);
    if (open == all.npos || sign == all.npos || (all[sign] != '<' && all[sign] != '>')) return {};
    const std::size_t value = sign + (all.substr(sign + 1).starts_with('=') ? 2 : 1);
    const std::size_t end = end_of_argument(all, value);
    const std::string level(trimmed(all.substr(value, end - value)));
    if (level.empty() || trimmed(all.substr(open + 1, place.begin - open - 1)).size() > 0)
        return {"half of space is a shape: `plane(Y, 0)` is what lies below y = 0", {}};
    const char axis = static_cast<char>(name[0] - 'x' + 'X');
    const bool below = all[sign] == '<';
    const bool plain = level.find_first_not_of("0123456789.") == level.npos;
    const std::string negated = level == "0" ? level : plain ? "-" + level : "-(" + level + ")";
    const std::string half = below ? fmt::format("plane({}, {})", axis, level)
                                   : fmt::format("plane(-{}, {})", axis, negated);
    return {fmt::format("half of space is a shape: where {} {} {} it is `{}`", name, all[sign],
                        level, half),
            {{{place.source, place.begin, static_cast<std::uint32_t>(end)}, half}}};
}

Fix name_before_value(Interpreter &ev, std::uint32_t frame, const std::string &name, Span place) {
    if (!place.source) return {};
    const std::string_view all = ev.sources[place.source].text;
    const std::size_t open = call_around(all, place.begin);
    const std::size_t comma = all.find_first_not_of(" \t", place.end);
    if (open == all.npos || comma == all.npos || all[comma] != ',') return {};
    const std::size_t before = all.find_last_not_of(" \t\n", place.begin - 1);
    if (all[before] != '(' && all[before] != ',') return {};
    const auto f = look_up(ev, frame, intern(ev, std::string(callee_before(all, open))));
    if (!f || f->kind == ValueKind::Builtin || !is_function(*f)) return {};
    const auto has = [&](const Value &form, std::string_view word) {
        if (form.kind != ValueKind::Closure) return false;
        return std::ranges::any_of(formals_of(ev, ev.closures[form.id]),
                                   [&](const Formal &x) { return x.name == word; });
    };
    const std::vector<Value> forms =
        f->kind == ValueKind::Overloads ? ev.lists[f->id] : std::vector<Value>{*f};
    const auto names = [&](std::string_view word) {
        return std::ranges::any_of(forms, [&](const Value &form) { return has(form, word); });
    };
    const std::size_t value = comma + 1, end = end_of_argument(all, value);
    const std::string written(trimmed(all.substr(value, end - value)));
    if (!names(name) || written.empty() || names(written)) return {};
    return {
        fmt::format("an argument is named with `:`: `{}: {}`", name, written),
        {{{place.source, static_cast<std::uint32_t>(comma), static_cast<std::uint32_t>(comma + 1)},
          ":"}}};
}

void help_with_whole(const Interpreter &ev, Diagnostic &d, const Value &v, Span place) {
    constexpr double turn = 6.283185307179586;
    const std::string_view written = is_library_place(ev, place) ? "" : text(ev.sources, place);
    const double parts = v.kind == ValueKind::Float && v.num[0] > 0 ? turn / v.num[0] : 0;
    const bool angle = written.ends_with("deg") || written.ends_with("turn");
    if (angle && std::abs(parts - std::round(parts)) < 1e-4) // `repeat_polar(45deg)`
        d.help(fmt::format("it is a number of parts: a turn has {} of these", std::round(parts)),
               {{place, fmt::format("{}", std::round(parts))}});
    else
        d.help("`int(x)` cuts the fraction off");
}

void help_with_operand(Interpreter &ev, Diagnostic &d, const Value &v, bool united, Span place) {
    if (is_function(v)) return help_with_uncalled(ev, d, v, place);
    if (v.kind == ValueKind::List)
        d.help("the shapes of a list are one as `union(list)`");
    else if (v.kind == ValueKind::Material || v.color)
        d.help("a shape is given a colour or a material by `.paint(…)`");
    else if (is_numeric(v) && numeric_type(ev, v) == ir::Type::Bool)
        d.help(united ? "conditions are joined with `or`" : "conditions are joined with `and`");
    else if (is_scalar(ev, v))
        d.help(united ? "shapes flow together in `smooth_union(0.2, a, b)`"
                      : "shapes meet smoothly in `smooth_intersection(0.2, a, b)`");
}

std::optional<Edit> point_of_shape(Interpreter &ev, std::uint32_t frame, Span place) {
    const std::string_view all = ev.sources[place.source].text;
    const std::size_t open = call_around(all, place.begin);
    const std::size_t comma = all.find_first_not_of(" \t", place.end);
    if (open == all.npos || comma == all.npos || all[comma] != ',' ||
        !trimmed(all.substr(open + 1, place.begin - open - 1)).empty())
        return std::nullopt;
    const std::string callee(callee_before(all, open));
    const std::string ours = look_up(ev, frame, intern(ev, callee))
                                 ? callee
                                 : likely_name(ev, frame, callee, {Use::Called, nullptr, nullptr});
    const auto f = look_up(ev, ev.prelude_frame, intern(ev, ours));
    if (!f || f->kind != ValueKind::Closure) return std::nullopt;
    const Closure &c = ev.closures[f->id];
    const lang::Function &function = c.ast->functions[c.function];
    const bool shape = function.result && function.result->named == lang::TypeName::Shape;
    if (!shape || formals_of(ev, c).empty() || formals_of(ev, c)[0].name == "s")
        return std::nullopt;
    const std::size_t next = all.find_first_not_of(" \t\n", comma + 1);
    return Edit{{place.source, place.begin, static_cast<std::uint32_t>(next)}, ""};
}

std::vector<Edit> type_away(const Interpreter &ev, Span type) {
    const std::string_view all = ev.sources[type.source].text;
    std::size_t begin = type.begin == 0 ? all.npos : all.find_last_not_of(" \t", type.begin - 1);
    if (begin == all.npos || is_library_place(ev, type)) return {};
    if (all[begin] == '>' && begin > 0 && all[begin - 1] == '-')
        begin = all.find_last_not_of(" \t", begin - 2) + 1;
    else if (all[begin] != ':')
        return {};
    return {{{type.source, static_cast<std::uint32_t>(begin), type.end}, ""}};
}

Fix without_call(const Interpreter &ev, const std::string &name, Span place) {
    constexpr std::array<std::string_view, 8> wrappers = {"list", "Some", "Ok",     "dbg",
                                                          "str",  "Box",  "String", "tuple"};
    constexpr std::array<std::string_view, 9> pictures = {
        "show", "display", "draw", "plot", "output", "preview", "view", "visualize", "scene"};
    const bool picture = std::ranges::find(pictures, name) != pictures.end();
    if (!place.source || (!picture && std::ranges::find(wrappers, name) == wrappers.end()))
        return {};
    const std::string_view all = ev.sources[place.source].text;
    if (!all.substr(place.end).starts_with('(')) return {};
    const std::size_t close = closing(all, place.end);
    if (close == all.npos || close == place.end + 1) return {};
    std::vector<Edit> edits{{{place.source, place.begin, place.end + 1}, ""}};
    const auto at = [&](std::size_t i) { return static_cast<std::uint32_t>(i); };
    const bool joins = name == "str" || name == "String";
    for (std::size_t i = end_of_argument(all, place.end + 1); i < close;
         i = end_of_argument(all, i + 1)) {
        if (!joins || all[i] != ',') return {};
        edits.push_back({{place.source, at(i), at(i + 1)}, " +"});
    }
    edits.push_back({{place.source, at(close), at(close + 1)}, ""});
    return {fmt::format("{}leave `{}( … )` away",
                        picture ? "the shapes of a file are the scene: " : "", name),
            std::move(edits)};
}

void help_with_rendered(const Interpreter &ev, Diagnostic &d, Span shape) {
    std::vector<Edit> edits;
    constexpr std::string_view call = "render(";
    const std::string_view all =
        shape.source ? std::string_view(ev.sources[shape.source].text) : std::string_view();
    if (shape.source && all.substr(0, shape.begin).ends_with(call) &&
        all.substr(shape.end).starts_with(')'))
        edits = {
            {{shape.source, shape.begin - static_cast<std::uint32_t>(call.size()), shape.begin},
             ""},
            {{shape.source, shape.end, shape.end + 1}, ""}};
    d.help(
        "the shapes of a file are the scene; `render(…)` says how many steps a ray may take, and "
        "how far",
        std::move(edits));
}

Fix without_qualifier(Interpreter &ev, std::uint32_t frame, const std::string &name, Span place) {
    if (!place.source) return {};
    const std::string_view all = ev.sources[place.source].text;
    if (!all.substr(place.end).starts_with('.')) return {};
    std::size_t end = place.end + 1;
    while (end < all.size() && is_letter(all[end])) ++end;
    if (end == place.end + 1 || end >= all.size() || all[end] != '(') return {};
    const std::string member(all.substr(place.end + 1, end - place.end - 1));
    const std::string near = look_up(ev, frame, intern(ev, member))
                                 ? member
                                 : likely_name(ev, frame, member, {Use::Called, nullptr, nullptr});
    if (near.empty()) return {};
    return {fmt::format("the library's names stand alone: `{}(…)`, without `{}.`", near, name),
            {{{place.source, place.begin, static_cast<std::uint32_t>(end)}, near}}};
}

void help_with_region(const Interpreter &ev, Diagnostic &d, const Value &v, Span place) {
    if (!place.source || is_library_place(ev, place)) return;
    const std::string written = source_text(ev, place);
    if (is_numeric(v) && !ir::is_vector(numeric_type(ev, v)))
        d.help("what is within a radius is a ball", {{place, "ball(" + written + ")"}});
    const std::size_t open = written.find('(');
    if (v.kind != ValueKind::Shape || written.find(')') + 1 != written.size()) return;
    const std::string name = written.substr(0, open),
                      size = written.substr(open + 1, written.size() - open - 2);
    const bool one = !size.empty() &&
                     (size.find(',') == size.npos || (size.front() == '[' && size.back() == ']'));
    if (!one || size.find(':') != size.npos) return;
    if (name == "sphere") d.help("its region is a ball", {{place, "ball(" + size + ")"}});
    if (name == "box") d.help("its region", {{place, "aabb(" + size + " / -2, " + size + " / 2)"}});
}

void report_var_at_top(Interpreter &ev, const File &ast, const lang::Var &var, Span place) {
    Diagnostic &d =
        report(ev, Code::WrongPlace, place,
               "`var` stands inside a function; at the top of a file names do not change");
    for (const lang::Stmt &s : ast.blocks[ast.root].stmts) {
        auto *a = std::get_if<lang::Assign>(&s.kind);
        auto *name = a ? std::get_if<lang::Name>(&ast.exprs[a->target].kind) : nullptr;
        if (!name || name->text != var.name.text) continue;
        d.label(s.span, "changed here")
            .help(fmt::format("give each value a name of its own: `let {0} = …`, `let {0}2 = …`",
                              var.name.text));
        return;
    }
    d.help("write `let`", {{{place.source, place.begin, place.begin + 3}, "let"}});
}

void help_with_plane(const Interpreter &ev, Diagnostic &d, Span place) {
    const std::string written = source_text(ev, place);
    const std::size_t comma = written.rfind(',');
    if (written.starts_with('[') && written.ends_with(']') && comma != written.npos) {
        const auto at = static_cast<std::uint32_t>(place.begin + comma);
        d.help("a flat shape lies in the xy plane, and its vectors have two parts",
               {{{place.source, at, place.end - 1}, ""}});
        return;
    }
    d.help("two of its three parts make a vec2: `.xy`, or `.xz` seen from above",
           {{place, operand_source(ev, place) + ".xy"}});
}

Fix smooth_form(const Interpreter &ev, std::string_view function, std::span<const Argument> args,
                std::size_t at, Span callee) {
    constexpr std::array<std::string_view, 3> joins = {"union", "intersection", "difference"};
    constexpr std::array<std::string_view, 7> widths = {"smooth", "k",          "radius", "r",
                                                        "blend",  "smoothness", "fillet"};
    const Argument &width = args[at];
    const bool last = at > 0 && at + 1 == args.size();
    const bool first = at == 0 && args.size() > 1 && args[1].trailing;
    if (std::ranges::find(joins, function) == joins.end() ||
        std::ranges::find(widths, width.name->text) == widths.end() ||
        width.value.kind == ValueKind::Bool || (!last && !first))
        return {};
    const std::string value = source_text(ev, width.span);
    const std::string smooth = "smooth_" + std::string(function);
    Fix fix{fmt::format("write `{}({}{}`", smooth, value, first ? ") { … }" : ", …)"),
            {{callee, smooth}}};
    const Span place = whole_argument(args[0]);
    if (first)
        fix.edits.push_back({{place.source, place.begin, width.span.begin}, ""});
    else if (place.begin > callee.end)
        fix.edits.push_back({{place.source, place.begin, place.begin}, value + ", "});
    return fix;
}

bool chooses_rows(std::string_view function, std::string_view argument) {
    constexpr std::array<std::string_view, 7> names = {"length", "min", "max",      "sum",
                                                       "dot",    "abs", "normalize"};
    return argument == "axis" && std::ranges::find(names, function) != names.end();
}

} // namespace fathom::typecheck
