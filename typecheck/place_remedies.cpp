// Solids whose place is given to them, as POV-Ray and GLSL do it: `sphere([0, 1, 0], 1)`,
// `box(a, b)` from corner to corner, `cylinder(a, b, r)` from end to end. Here they stand about the
// origin and are moved, and painted, by what stands behind them.
#include "typecheck/remedies.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace fathom::typecheck {

namespace {

int size_of(const Interpreter &ev, const Value &v) {
    if (is_scalar(ev, v)) return 1;
    return is_numeric(v) ? ir::components(numeric_type(ev, v)) : 0;
}

// 3 for a solid of the library, 2 for a flat shape, 0 for what else it has.
int dimensions_of(Interpreter &ev, std::string_view name) {
    const auto f = look_up(ev, ev.prelude_frame, intern(ev, std::string(name)));
    if (!f || f->kind != ValueKind::Closure) return 0;
    const Closure &c = ev.closures[f->id];
    const lang::Function &function = c.ast->functions[c.function];
    const auto formals = formals_of(ev, c);
    if (!function.result || formals.empty() || formals[0].name == "s") return 0;
    return function.result->named == lang::TypeName::Shape    ? 3
           : function.result->named == lang::TypeName::Shape2 ? 2
                                                              : 0;
}

std::string row(const std::array<double, 3> &of, int size) {
    return size == 2 ? fmt::format("[{:.6g}, {:.6g}]", of[0], of[1])
                     : fmt::format("[{:.6g}, {:.6g}, {:.6g}]", of[0], of[1], of[2]);
}

struct Placed {
    std::string given; // to the solid
    std::string moved; // behind the call
};

// Known numbers that stand there as a vector in brackets.
bool is_literal(const Interpreter &ev, const Argument &a) {
    return a.value.kind == ValueKind::Vec && source_text(ev, a.span).starts_with('[');
}

// Of a solid with an axis, where the last argument names another one.
bool stands_along_y(std::string_view solid, std::string_view last) {
    constexpr std::array<std::string_view, 6> axes{"X", "Y", "Z", "-X", "-Y", "-Z"};
    constexpr std::array<std::string_view, 3> without_axis{"sphere", "ellipsoid", "box"};
    return std::ranges::find(axes, last) != axes.end() &&
           std::ranges::find(without_axis, solid) == without_axis.end();
}

// From corner to corner; nothing where these are a size and a place.
std::optional<Placed> between_corners(const Interpreter &ev, const Argument &a, const Argument &b,
                                      int size) {
    const bool known = a.value.kind == ValueKind::Vec && b.value.kind == ValueKind::Vec;
    std::array<double, 3> extent{}, middle{};
    bool moved = !known, flat = false, is_size = known;
    for (std::size_t i = 0; known && i < std::size_t(size); ++i) {
        extent[i] = std::fabs(b.value.num[i] - a.value.num[i]);
        middle[i] = (a.value.num[i] + b.value.num[i]) / 2;
        flat = flat || extent[i] == 0;
        is_size = is_size && a.value.num[i] > 0;
        moved = moved || middle[i] != 0;
    }
    if (flat || (is_size && b.value.num[0] < a.value.num[0])) return std::nullopt;
    if (is_literal(ev, a) && is_literal(ev, b))
        return Placed{row(extent, size),
                      moved ? fmt::format(".translate({})", row(middle, size)) : ""};
    const std::string from = operand_source(ev, a.span), to = operand_source(ev, b.span);
    return Placed{fmt::format("{} - {}", to, from),
                  moved ? fmt::format(".translate(({} + {}) / 2)", from, to) : ""};
}

// From end to end: the length, and how what stands along Y comes there.
Placed between_ends(const Interpreter &ev, const Argument &a, const Argument &b) {
    if (!is_literal(ev, a) || !is_literal(ev, b)) {
        const std::string from = operand_source(ev, a.span), to = operand_source(ev, b.span);
        const std::string way = fmt::format("{} - {}", to, from);
        return {fmt::format("length({})", way),
                fmt::format(".orient(Y, {}).translate(({} + {}) / 2)", way, from, to)};
    }
    std::array<double, 3> way{}, middle{};
    for (std::size_t i = 0; i < 3; ++i) {
        way[i] = b.value.num[i] - a.value.num[i];
        middle[i] = (a.value.num[i] + b.value.num[i]) / 2;
    }
    Placed out{fmt::format("{:.6g}", std::hypot(way[0], way[1], way[2])), ""};
    if (way[0] != 0 || way[1] < 0 || way[2] != 0)
        out.moved = fmt::format(".orient(Y, {})", row(way, 3));
    if (middle != std::array<double, 3>{})
        out.moved += fmt::format(".translate({})", row(middle, 3));
    return out;
}

} // namespace

bool help_with_paint(const Interpreter &ev, Diagnostic &d, std::span<const Formal> formals,
                     std::span<const Argument> args) {
    const Argument &last = args.back();
    const bool paints = last.value.kind == ValueKind::Material || last.value.color;
    const bool of_library = !formals.empty() && formals[0].declared.source;
    if (args.size() != formals.size() + 1 || args.size() < 2 || !of_library || last.name ||
        last.trailing || !paints)
        return false;
    const auto end = behind_call(ev, last.span);
    if (!end) return false;
    const std::string paint = fmt::format(".paint({})", text(ev.sources, last.span));
    d.help(
        fmt::format("write `{}` behind it", paint),
        {{{last.span.source, args[args.size() - 2].span.end, last.span.end}, ""}, {*end, paint}});
    return true;
}

bool help_with_place(Interpreter &ev, Diagnostic &d, std::string_view name,
                     std::span<const Formal> formals, std::span<const Argument> args) {
    if (args.size() < 2 || args.size() > 5 || formals.empty() || !formals[0].declared.source ||
        is_library_place(ev, args[0].span))
        return false;
    const int dimensions = dimensions_of(ev, name);
    if (dimensions == 0) return false;
    std::vector<int> sizes;
    for (const Argument &a : args) {
        if (a.name || a.trailing || a.value.color) return false;
        sizes.push_back(size_of(ev, a.value));
        if (sizes.back() == 0) return false;
    }
    const auto behind = behind_call(ev, args.back().span);
    if (!behind) return false;
    const Span all = join(args.front().span, args.back().span);
    const auto say = [&](std::string_view message, const std::string &given,
                         const std::string &moved) {
        std::vector<Edit> edits{{all, given}};
        if (!moved.empty()) edits.push_back({*behind, moved});
        d.help(std::string(message), std::move(edits));
        return true;
    };
    const auto source = [&](std::size_t i) { return source_text(ev, args[i].span); };
    const int of_vector = formals[0].vector_size;
    if ((name == "box" || name == "rectangle") && args.size() == 2 && sizes[0] == of_vector) {
        if (sizes[1] == 1) {
            const Span before = args[0].span;
            const std::string_view text = ev.sources[before.source].text;
            const std::size_t callee = // the argument may begin with such a name, too
                before.begin > 0 ? text.rfind(name, before.begin - 1) : text.npos;
            if (callee == text.npos) return false;
            const auto at = static_cast<std::uint32_t>(callee);
            d.help(fmt::format("with round edges it is `rounded_{}`", name),
                   {{{before.source, at, at}, "rounded_"}});
            return true;
        }
        if (sizes[1] == of_vector)
            if (const auto placed = between_corners(ev, args[0], args[1], of_vector))
                return say("it is given its size, and stands about the origin", placed->given,
                           placed->moved);
    }
    const bool ends = sizes.size() > 2 && sizes[0] == 3 && sizes[1] == 3;
    if (ends && (name == "cylinder" || name == "cone" || name == "capped_cone")) {
        if (args.size() != formals.size() + 1) return false;
        const Placed placed = between_ends(ev, args[0], args[1]);
        const std::string radii =
            source(2) + (name == "capped_cone" ? ", " + source(3) : std::string());
        return say("it stands along Y about the origin; with round ends from one point to another "
                   "it is `capsule(a, b, radius)`",
                   fmt::format("{}, {}", radii, placed.given), placed.moved);
    }
    if (args.size() != formals.size() + 1) return false;
    const auto is_point = [&](const Formal &f) { return f.vector_size == dimensions; };
    if (std::ranges::count_if(formals, is_point) > 1)
        return false; // `capsule(a, b, r)` has a place
    if (const std::string axis = source(args.size() - 1);
        dimensions == 3 && stands_along_y(name, axis)) {
        const std::string given = source_text(ev, join(args[0].span, args[args.size() - 2].span));
        return axis == "Y" ? say("its axis is Y", given, "")
                           : say("its axis is Y: `.orient` turns it", given,
                                 fmt::format(".orient(Y, {})", axis));
    }
    const auto fits = [&](std::size_t i, std::size_t formal) {
        const Formal &f = formals[formal];
        return sizes[i] == (f.vector_size > 0 ? f.vector_size : 1) ||
               (sizes[i] == 1 && !f.is_place);
    };
    const auto is_size = [&](const Argument &a) {
        const auto positive = [](double x) { return x > 0; };
        return a.value.kind != ValueKind::Vec ||
               std::all_of(a.value.num.begin(), a.value.num.begin() + a.value.size, positive);
    };
    std::size_t which = args.size(); // of the arguments is the place
    for (const std::size_t i : {std::size_t(0), args.size() - 1}) {
        bool good = sizes[i] == dimensions;
        for (std::size_t k = 0; k < formals.size(); ++k) good = good && fits(k < i ? k : k + 1, k);
        if (good && (which == args.size() || is_size(args[0]))) which = i;
    }
    if (which == args.size()) return false;
    const bool first = which == 0;
    return say("it stands about the origin: `.translate` moves it",
               source_text(ev, first ? join(args[1].span, args.back().span)
                                     : join(args[0].span, args[args.size() - 2].span)),
               fmt::format(".translate({})", source(which)));
}

Fix remedy_of_corners(const Interpreter &ev, std::string_view name, std::span<const Formal> formals,
                      std::span<const Argument> args) {
    constexpr std::array<std::pair<std::string_view, std::string_view>, 6> corners{
        {{"min", "max"},
         {"lo", "hi"},
         {"lower", "upper"},
         {"from", "to"},
         {"a", "b"},
         {"p1", "p2"}}};
    if ((name != "box" && name != "rectangle") || args.size() != 2 || !args[0].name ||
        !args[1].name || formals.empty() || !formals[0].declared.source)
        return {};
    const std::pair names{args[0].name->text, args[1].name->text};
    const int size = formals[0].vector_size;
    const auto behind = behind_call(ev, args[1].span);
    if (std::ranges::find(corners, names) == corners.end() || !behind ||
        size_of(ev, args[0].value) != size || size_of(ev, args[1].value) != size)
        return {};
    const auto placed = between_corners(ev, args[0], args[1], size);
    if (!placed) return {};
    const Span all = join(whole_argument(args[0]), whole_argument(args[1]));
    std::vector<Edit> edits{{all, placed->given}};
    if (!placed->moved.empty()) edits.push_back({*behind, placed->moved});
    return {"it is given its size, and stands about the origin", std::move(edits)};
}

} // namespace fathom::typecheck
