// Methods of other libraries whose name is another thing here, or an operator: `s.material("gold")`,
// `random.uniform(0, 1)`, `p.add(q).multiplyScalar(2)`.
#include "typecheck/remedies.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

namespace fathom::typecheck {

namespace {

bool is_arithmetic(const Value &v) {
    return v.kind == ValueKind::Int || v.kind == ValueKind::Float || v.kind == ValueKind::Vec ||
           v.kind == ValueKind::Field;
}

// The operator that does what a method of numbers or vectors does elsewhere; 0: none.
char operator_of(std::string_view method) {
    struct Named {
        std::string_view name;
        char sign;
    };
    constexpr std::array<Named, 14> named = {{{"add", '+'},
                                              {"plus", '+'},
                                              {"addScalar", '+'},
                                              {"sub", '-'},
                                              {"minus", '-'},
                                              {"subtract", '-'},
                                              {"subScalar", '-'},
                                              {"mul", '*'},
                                              {"times", '*'},
                                              {"multiply", '*'},
                                              {"multiplyScalar", '*'},
                                              {"div", '/'},
                                              {"divide", '/'},
                                              {"divideScalar", '/'}}};
    const auto found = std::ranges::find(named, method, &Named::name);
    return found == named.end() ? '\0' : found->sign;
}

// `a.sub(b)`: `(a - b)`.
bool is_operator_method(Interpreter &ev, const Value &object, const File &ast,
                        const lang::Member &member, const lang::Call &call, Span place) {
    const char sign = is_arithmetic(object) ? operator_of(member.name.text) : '\0';
    if (sign == '\0') return false;
    Diagnostic &d =
        report(ev, Code::UnknownMember, member.name.span,
               fmt::format("numbers and vectors have no method `{}`", member.name.text));
    if (call.arguments.size() != 1 || call.arguments[0].name || call.trailing || !place.source) {
        d.help(fmt::format("that is the operator `{}`", sign));
        return true;
    }
    const lang::Expr &argument = ast.exprs[call.arguments[0].value];
    const std::string_view before = text(ev.sources, {place.source, 0, member.name.span.begin});
    const auto dot = static_cast<std::uint32_t>(before.rfind('.')); // the object may end with a `)`
    const bool compound = std::holds_alternative<lang::Binary>(argument.kind) ||
                          std::holds_alternative<lang::Unary>(argument.kind);
    d.help(fmt::format("that is the operator `{}`", sign),
           {{{place.source, place.begin, place.begin}, "("},
            {{place.source, dot, argument.span.begin},
             fmt::format(" {} {}", sign, compound ? "(" : "")},
            {{place.source, argument.span.end, place.end}, compound ? "))" : ")"}});
    return true;
}

} // namespace

Fix constant_of_vector(const Interpreter &ev, std::string_view name, Span place) {
    const std::string plain = plain_name(name);
    const bool flat = plain == "vec2" || plain == "vector2";
    if ((!flat && plain != "vec3" && plain != "vector3") || !place.source) return {};
    const std::string_view behind =
        std::string_view(ev.sources[place.source].text).substr(place.end);
    if (!behind.starts_with('.')) return {};
    std::size_t end = 1;
    while (end < behind.size() && std::isalpha(static_cast<unsigned char>(behind[end]))) ++end;
    struct Named {
        std::string_view name, solid, flat;
    };
    constexpr std::array<Named, 6> named = {{{"zero", "[0, 0, 0]", "[0, 0]"},
                                             {"one", "[1, 1, 1]", "[1, 1]"},
                                             {"right", "[1, 0, 0]", "[1, 0]"},
                                             {"left", "[-1, 0, 0]", "[-1, 0]"},
                                             {"up", "[0, 1, 0]", "[0, 1]"},
                                             {"down", "[0, -1, 0]", "[0, -1]"}}};
    const auto found =
        std::ranges::find(named, plain_name(behind.substr(1, end - 1)), &Named::name);
    if (found == named.end()) return {};
    const std::string written(flat ? found->flat : found->solid);
    return {fmt::format("a vector is written by its parts: `{}`", written),
            {{{place.source, place.begin, static_cast<std::uint32_t>(place.end + end)}, written}}};
}

Fix clock_of_unity(const Interpreter &ev, std::string_view name, Span place) {
    struct Clock {
        std::string_view name;
        std::array<std::string_view, 4> parts; // x, y, z, w
    };
    constexpr std::array<Clock, 3> clocks = {
        {{"_Time", {"(time / 20)", "time", "(2 * time)", "(3 * time)"}},
         {"_SinTime", {"sin(time / 8)", "sin(time / 4)", "sin(time / 2)", "sin(time)"}},
         {"_CosTime", {"cos(time / 8)", "cos(time / 4)", "cos(time / 2)", "cos(time)"}}}};
    const auto clock = std::ranges::find(clocks, name, &Clock::name);
    if (clock == clocks.end() || !place.source) return {};
    constexpr std::size_t most_edits = 20;
    const auto is_word = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
    };
    const std::string_view all = ev.sources[place.source].text;
    std::vector<Edit> edits; // of each use: a name is told once
    for (std::size_t at = place.begin; at != all.npos && edits.size() < most_edits;
         at = all.find(name, at + 1)) {
        const std::size_t dot = at + name.size();
        const std::size_t part =
            dot + 1 < all.size() ? std::string_view("xyzw").find(all[dot + 1]) : all.npos;
        if ((at > 0 && is_word(all[at - 1])) || part == all.npos || all[dot] != '.' ||
            (dot + 2 < all.size() && is_word(all[dot + 2])))
            continue;
        edits.push_back(
            {{place.source, static_cast<std::uint32_t>(at), static_cast<std::uint32_t>(dot + 2)},
             std::string(clock->parts[part])});
    }
    return {"the seconds are `time`", std::move(edits)};
}

bool is_foreign_method(Interpreter &ev, const Value &object, const File &ast,
                       const lang::Member &member, const lang::Call &call, Span place) {
    if (is_operator_method(ev, object, ast, member, call, place)) return true;
    const std::string name(member.name.text);
    if (object.kind == ValueKind::Shape && name == "material") {
        Diagnostic &d = report(ev, Code::UnknownMember, member.name.span,
                               "`material` makes a material, and is no function of a shape");
        const bool alone = call.arguments.size() == 1 && !call.arguments[0].name;
        if (alone)
            d.help("a shape is given a colour or a material by `.paint(…)`",
                   {{member.name.span, "paint"}});
        else
            d.help("a shape is given one by `.paint(material(…))`",
                   {{member.name.span, "paint(material"},
                    {{place.source, place.end, place.end}, ")"}});
        return true;
    }
    constexpr std::array<std::string_view, 6> theirs = {"uniform", "random",    "rand",
                                                        "randint", "randrange", "range"};
    const bool random = object.kind == ValueKind::Builtin &&
                        builtins()[object.id].name == std::string_view("random");
    if (!random || std::ranges::find(theirs, name) == theirs.end()) return false;
    Diagnostic &d =
        report(ev, Code::UnknownMember, member.name.span,
               fmt::format("there is no function `{}` for {}", name, describe(ev, object)));
    const auto end = static_cast<std::uint32_t>(place.end - 1);
    const std::string seed = (call.arguments.empty() ? "" : ", ") + seed_text(ev, place);
    d.help("a random number is `random(seed)`, from 0 to 1, or `random(lo, hi, seed)`",
           {{{place.source, ast.exprs[member.object].span.end, member.name.span.end}, ""},
            {{place.source, end, end}, seed}});
    return true;
}

} // namespace fathom::typecheck
