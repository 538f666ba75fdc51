// What is said of a name that nobody declared: the one that is likely to be meant, of the kind that
// is wanted there, or how such a thing is declared or done here.
#include "typecheck/remedies.h"

#include "base/suggest.h"
#include "base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace fathom::typecheck {

bool may_compare_names(Interpreter &ev, std::size_t count) {
    constexpr std::size_t most_compared = 3'000'000; // names, over all that nobody declared
    ev.names_compared += count;
    return ev.names_compared <= most_compared;
}

namespace {

// Whether a function may be called as `object.f(…)`.
bool takes(Interpreter &ev, const Value &f, const Value &object) {
    if (f.kind == ValueKind::Overloads) {
        const std::vector<Value> forms = ev.lists[f.id];
        return std::ranges::any_of(forms,
                                   [&](const Value &form) { return takes(ev, form, object); });
    }
    if (f.kind != ValueKind::Closure) return true;
    const Closure c = ev.closures[f.id];
    const auto &parameters = c.ast->functions[c.function].parameters;
    return !parameters.empty() && (!parameters[0].type || accepts(ev, object, *parameters[0].type));
}

// Whether a name is one of the kind that is wanted. A function is seldom wanted as a value, and so
// only where little is mistyped.
bool fits(Interpreter &ev, std::uint32_t frame, const std::string &name,
          const std::string &candidate, const Wanted &wanted) {
    const auto v = look_up(ev, frame, intern(ev, candidate));
    if (!v) return false;
    if (is_poison(*v)) return true;
    if (wanted.use == Use::Called)
        return is_function(*v) &&
               (!wanted.object || is_poison(*wanted.object) || takes(ev, *v, *wanted.object));
    constexpr std::size_t long_enough = 5;
    return !is_function(*v) || (name.size() >= long_enough && edit_distance(name, candidate) <= 1);
}

// The nearest of those that fit.
std::string nearest_fitting(Interpreter &ev, std::uint32_t frame, const std::string &name,
                            std::string_view word, std::vector<std::string> &names,
                            const Wanted &wanted) {
    constexpr int most_tries = 10;
    constexpr std::size_t short_word = 4;
    for (int i = 0; i < most_tries; ++i) {
        std::string near = nearest_name(word, names);
        // of short words the beginning says more: `rot` is no `dot`
        if (!near.empty() && word.size() <= short_word && edit_distance(near, word) > 0 &&
            near[0] != word[0])
            if (const std::string begun = shortest_begun_by(word, names);
                !begun.empty() && word.size() > 2)
                near = begun;
        if (word.size() < short_word && wanted.object && near[0] != word[0]) return {};
        // of what is further off, the first letter at least is right
        const auto small = [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; };
        const bool far =
            !near.empty() && small(near[0]) != small(word[0]) && edit_distance(near, word) > 1;
        if (near.empty() || (!far && fits(ev, frame, name, near, wanted))) return near;
        std::erase(names, near);
    }
    return {};
}

} // namespace

// A name that is spelled like one of these but for capital letters and `_`, and fits; empty: none.
static std::string same_letters(Interpreter &ev, std::uint32_t frame, const std::string &plain,
                                const std::vector<std::string> &names, const Wanted &wanted) {
    for (const std::string &name : names)
        if (plain_name(name) == plain && fits(ev, frame, name, name, wanted)) return name;
    return {};
}

std::string likely_name(Interpreter &ev, std::uint32_t frame, std::string_view written,
                        const Wanted &wanted) {
    const std::string name(written);
    const auto known = [&](std::string_view theirs) -> std::string {
        const std::string ours(name_from_elsewhere(theirs));
        const bool fit =
            !ours.empty() && fits(ev, frame, ours, ours, wanted) &&
            (wanted.use == Use::Called || !is_function(*look_up(ev, frame, intern(ev, ours))));
        return fit ? ours : std::string();
    };
    const bool capital = name[0] >= 'A' && name[0] <= 'Z';
    if (capital && !way_from_elsewhere(name).empty() && name_from_elsewhere(name) == "repeat")
        return {}; // a list, and no row of shapes
    if (std::string ours = known(name); !ours.empty()) return ours;
    if (!way_from_elsewhere(name).empty()) return {};
    if (!may_compare_names(ev, ev.symbol_names.size())) return {};
    std::vector<std::string> names = visible_names(ev, frame);
    // `smoothUnion`, and with what another library puts around its names: `sdBox`, `createCube`
    constexpr std::size_t shortest = 3;
    for (const std::string &within : names_within(name)) {
        if (within.size() < shortest) continue;
        if (std::string ours = same_letters(ev, frame, within, names, wanted); !ours.empty())
            return ours;
        if (std::string ours = known(within); !ours.empty()) return ours;
    }
    for (const std::string_view prefix : {"sdf_", "sd_", "op_", "sdf", "sd", "op"}) {
        if (!name.starts_with(prefix) || name.size() < prefix.size() + shortest) continue;
        const std::string rest = name.substr(prefix.size());
        const std::string near = nearest_fitting(ev, frame, rest, rest, names, wanted);
        if (!near.empty() && edit_distance(near, rest) <= 1) return near;
    }
    return nearest_fitting(ev, frame, name, name, names, wanted);
}

// Another use of a name that was told: its edit goes with the first. True where there was one.
static bool told_before(Interpreter &ev, const std::string &name, Span place) {
    constexpr std::size_t most_edits = 20, most_names = 1000;
    if (ev.unknown_names.size() > most_names) return false;
    const auto [it, fresh] = ev.unknown_names.try_emplace({place.source.index, name}, place);
    if (fresh || it->second == place) return false;
    Diagnostic *first = ev.diagnostics.find(Code::UnknownName, it->second);
    if (!first) return false;
    if (first->fix && !first->fix->edits.empty() && first->fix->edits[0].span == it->second &&
        first->fix->edits.size() < most_edits) {
        const std::string ours = first->fix->edits[0].replacement;
        const auto same = [&](const Edit &e) { return e.span == place; };
        if (std::ranges::none_of(first->fix->edits, same))
            first->fix->edits.push_back({place, ours});
    }
    return true;
}

bool type_told_before(Interpreter &ev, std::string_view name, Span place) {
    return told_before(ev, ":" + std::string(name), place);
}

bool lacking(const Interpreter &ev, std::string_view name, const std::string &near) {
    return ev.modules[ev.current_module].lacks_names && (near.empty() || name.size() < 5);
}

// `45*deg`, `5 * mm`: the unit touches its number, and lengths have none.
static std::vector<Edit> unit_edit(const Interpreter &ev, const std::string &name, Span place) {
    if (name == "t") return {{place, "time"}};
    if (name == "e") return {{place, "exp(1)"}};
    const bool length = name == "mm" || name == "cm";
    if (name != "deg" && !length) return {};
    const std::string_view before = text(ev.sources, {place.source, 0, place.begin});
    const std::size_t sign = before.find_last_not_of(" \t");
    if (sign == before.npos || before[sign] != '*' || sign == 0) return {};
    const std::size_t last = before.find_last_not_of(" \t", sign - 1);
    if (last == before.npos || (!length && (before[last] < '0' || before[last] > '9'))) return {};
    const auto end = static_cast<std::uint32_t>(last + 1);
    return {{{place.source, end, length ? place.end : place.begin}, ""}};
}

// Whether `x` stands alone as an argument, where an axis may be meant.
static bool is_whole_argument(const Interpreter &ev, Span place) {
    const std::string_view all = ev.sources[place.source].text;
    const std::size_t before = place.begin == 0 ? all.npos
                                                : all.find_last_not_of(" \t\n", place.begin - 1),
                      behind = all.find_first_not_of(" \t\n", place.end);
    int depth = 0; // a part of a vector is no axis
    constexpr std::size_t farthest = 200;
    for (std::size_t i = place.begin, n = 0; i-- > 0 && n < farthest; ++n) {
        if (all[i] == ')' || all[i] == ']') ++depth;
        if ((all[i] == '(' || all[i] == '[') && depth-- == 0) {
            if (all[i] == '[') return false;
            break;
        }
    }
    constexpr std::array<std::string_view, 16> takers = {
        "rotate", "mirror",     "reflect", "orient", "plane", "slab",     "bend",         "twist",
        "taper",  "turnaround", "tube",    "flip",   "spin",  "symmetry", "repeat_polar", "cross"};
    const bool named = before != all.npos && all[before] == ':';
    const std::size_t near = place.begin > farthest ? place.begin - farthest : 0;
    const std::string_view ahead = all.substr(near, place.begin - near);
    const bool taken = std::ranges::any_of(
        takers, [&](std::string_view taker) { return ahead.find(taker) != ahead.npos; });
    return (named || taken) && before != all.npos && behind != all.npos &&
           std::string_view("(,:").find(all[before]) != std::string_view::npos &&
           std::string_view("),").find(all[behind]) != std::string_view::npos;
}

// `scene { … }`, `scene.add(s)`: as a union, and away.
static std::optional<Edit> scene_edit(const Interpreter &ev, const std::string &name, Span place) {
    const std::string_view all = ev.sources[place.source].text;
    const std::string_view behind = all.substr(place.end);
    constexpr std::string_view add = ".add(";
    if (name != "scene") return std::nullopt;
    if (behind.starts_with(add)) {
        const auto open = static_cast<std::uint32_t>(place.end + add.size() - 1);
        return Edit{{place.source, place.begin, open}, ""};
    }
    const std::size_t next = behind.find_first_not_of(" \t");
    if (next == behind.npos || behind[next] != '{') return std::nullopt;
    return Edit{place, "union"};
}

// Whether a call of something behind the name's `.` follows.
static bool calls_member(const Interpreter &ev, Span place) {
    const std::string_view behind =
        std::string_view(ev.sources[place.source].text).substr(place.end);
    if (!behind.starts_with('.')) return false;
    const std::size_t end = behind.find_first_not_of(
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_", 1);
    return end != behind.npos && end > 1 && behind[end] == '(';
}

// Where the file binds the name at its top, further down.
static std::optional<Span> bound_below(const Wanted &wanted, const std::string &name, Span place) {
    if (!wanted.ast) return std::nullopt;
    const auto &stmts = wanted.ast->blocks[wanted.ast->root].stmts;
    constexpr std::size_t most_statements = 10'000;
    for (std::size_t i = 0; i < std::min(stmts.size(), most_statements); ++i) {
        const lang::StmtKind &kind = stmts[i].kind;
        const lang::Identifier *bound = nullptr;
        if (auto *l = std::get_if<lang::Let>(&kind)) bound = &l->name;
        if (auto *p = std::get_if<lang::Param>(&kind)) bound = &p->name;
        if (bound && bound->text == name && bound->span.begin > place.begin) return bound->span;
    }
    return std::nullopt;
}

// `ff8800`.
static bool is_hex_color(std::string_view name) {
    const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
    const auto is_hex = [&](char c) {
        return is_digit(c) || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F');
    };
    return (name.size() == 6 || name.size() == 8) && std::ranges::all_of(name, is_hex) &&
           std::ranges::any_of(name, is_digit);
}

// `np.linspace` was told to need no module; where there is no such function, only that is said.
static void leave_module(Interpreter &ev, Span place) {
    const std::size_t dot = text(ev.sources, place).find('.');
    if (dot == std::string_view::npos) return;
    const auto end = static_cast<std::uint32_t>(place.begin + dot);
    ev.diagnostics.withdraw(Code::ForeignSyntax, {place.source, place.begin, end});
}

// Whether a name that is called may stand in a library of another language, which was told; `near`
// is a name of ours like it.
static bool may_be_lost(const Interpreter &ev, const std::string &name, const std::string &near,
                        Span place) {
    constexpr std::size_t few_letters = 4; // which are near to many words, as `leg` to `len`
    if (!near.empty() && (name.size() > few_letters || near[0] != name[0])) return false;
    return std::ranges::any_of(ev.diagnostics.items(), [&](const Diagnostic &d) {
        return d.code == Code::ForeignSyntax && d.primary.span.source == place.source &&
               d.message.starts_with("a library of another language");
    });
}

// Whether what a call is given first, as `([0, 0, 0], …)`, is a vector of three parts.
static bool is_given_vec3(const Interpreter &ev, Span name) {
    constexpr std::uint32_t looked_at = 200;
    const std::string_view behind =
        std::string_view(ev.sources[name.source].text).substr(name.end, looked_at);
    if (behind.starts_with("(vec3(")) return true;
    const std::string_view first = behind.substr(0, behind.find(']'));
    return first.starts_with("([") && std::ranges::count(first, ',') == 2;
}

void report_unknown_name(Interpreter &ev, std::uint32_t frame, std::string_view written, Span place,
                         const Wanted &wanted) {
    const std::string name(written);
    if (std::ranges::any_of(name, [](char c) { return (c & 0x80) != 0; })) return; // letters, told
    std::string near = likely_name(ev, frame, name, wanted);
    if (near == "segment" && is_given_vec3(ev, place)) near = "capsule"; // it is flat
    if (name.size() == 1 && place.source && !is_whole_argument(ev, place)) near.clear();
    if (lacking(ev, name, near)) return; // one cause, one report
    const bool of_user = ev.quiet == 0 && !is_library_place(ev, place);
    if (of_user && told_before(ev, name, place)) return;
    const std::string_view way = way_from_elsewhere(name);
    if (of_user && (!way.empty() || near.empty())) leave_module(ev, place);
    Diagnostic &d = report(ev, Code::UnknownName, place,
                           fmt::format("nothing here is called `{}`", short_name(name)));
    if (const auto below = bound_below(wanted, name, place)) {
        d.label(*below, "bound here").help("a name is known below the place where it is bound");
        return;
    }
    if (ev.in_field == 0 && (name == "p" || name == "pos" || name == "uv")) {
        std::string function;
        if (const auto edit = of_user ? point_of_shape(ev, frame, place) : std::nullopt) {
            d.help("the library's shapes are given no point: leave it away", {*edit});
            return;
        }
        if (const auto edit = of_user ? point_edit(ev, name, place, function) : std::nullopt)
            d.help(fmt::format("the point is the argument of a function: `{}({} => …)`", function,
                               name),
                   {*edit});
        else
            d.help("the point is the argument of a function: `implicit(p => length(p) - 1)`");
        return;
    }
    if (ev.in_field > 0 && name.starts_with("sd")) { // a shape is none of a field's numbers
        d.help("a function of the point is made of numbers: a ball is `length(p - c) - r`; the "
               "library's shapes stand outside of it, as `sphere(r).translate(c)`");
        return;
    }
    for (Fix fix : {part_of_point(ev, name, place), constant_of_vector(ev, name, place),
                    clock_of_unity(ev, name, place)})
        if (of_user && !d.fix && !fix.message.empty())
            d.help(std::move(fix.message), std::move(fix.edits));
    if (d.fix) return;
    for (const auto &remedy :
         {without_call(ev, name, place), name_before_value(ev, frame, name, place)})
        if (of_user && !d.fix && !remedy.message.empty()) d.help(remedy.message, remedy.edits);
    if (d.fix) return;
    if (is_hex_color(name)) {
        d.help(fmt::format("a colour by its hexadecimal digits is `#{}`", name),
               {{place, "#" + name}});
        return;
    }
    if (const auto edit = of_user ? scene_edit(ev, name, place) : std::nullopt)
        d.help(std::string(way), {*edit});
    else if (Fix alone =
                 of_user && !way.empty() ? without_qualifier(ev, frame, name, place) : Fix{};
             !alone.message.empty())
        d.help(std::move(alone.message), std::move(alone.edits));
    else if (!way.empty())
        d.help(std::string(way), unit_edit(ev, name, place));
    if (of_user && wanted.use == Use::Called && way.empty() && !d.fix &&
        may_be_lost(ev, name, near, place)) {
        d.help(fmt::format("where it was in a library that cannot be read, declare it here: "
                           "`fn {}() {{ … }}`",
                           short_name(name)));
        return;
    }
    if (!near.empty()) d.help(fmt::format("did you mean `{}`?", near), {{place, near}});
    if (name == "cube" || name == "square")
        d.note(fmt::format("a `{}` has its middle at the origin", near));
    if (d.fix) return;
    if (name == "dfmodel") {
        d.help("it is a part of the library, brought by `import \"dfmodel\" as dfmodel`",
               {{{place.source, 0, 0}, "import \"dfmodel\" as dfmodel\n"}});
        return;
    }
    if (of_user && calls_member(ev, place)) // `arch.door(2)`
        d.help(fmt::format("what is in another file is brought by `import \"{0}.sdf\" as {0}`; a "
                           "value is bound by `let {0} = …`",
                           short_name(name)));
    else if (wanted.use == Use::Called)
        d.help(fmt::format("a function is declared before it is called: `fn {}(x) = …`",
                           short_name(name)));
    else
        d.help(fmt::format("a name is bound before it is used: `let {} = …`", short_name(name)));
}

// -- signs ---------------------------------------------------------------------------------------

// One sign between two operands for another, where nothing that binds tighter follows.
std::vector<Edit> sign_edit(const Interpreter &ev, Span a, Span b, char sign,
                            std::string_view ours) {
    if (ours.empty() || is_library_place(ev, a) || a.source != b.source || b.begin < a.end)
        return {};
    const std::string_view between = text(ev.sources, {a.source, a.end, b.begin});
    const std::string_view all = ev.sources[a.source].text;
    const std::size_t next = all.find_first_not_of(" \t", b.end), at = between.find(sign);
    if (at == between.npos || between.find(sign, at + 1) != between.npos ||
        (next != all.npos && std::string_view("-&*.").find(all[next]) != std::string_view::npos))
        return {};
    const auto place = static_cast<std::uint32_t>(a.end + at);
    return {{{a.source, place, place + 1}, std::string(ours)}};
}

} // namespace fathom::typecheck
