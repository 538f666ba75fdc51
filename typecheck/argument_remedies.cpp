// What to write in place of arguments that other languages have, and the edits that make it so.
#include "typecheck/remedies.h"

#include "base/suggest.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace fathom::typecheck {

// -- arguments -----------------------------------------------------------------------------------

namespace {

constexpr std::pair<std::string_view, std::string_view> argument_names[] = {
    {"color", "diffuse"},
    {"colour", "diffuse"},
    {"albedo", "diffuse"},
    {"ambient", "diffuse"},
    {"shininess", "exponent"},
    {"emissive", "emission"},
    {"position", "at"},
    {"pos", "at"},
    {"center", "at"},
    {"eye", "at"},
    {"target", "look_at"},
    {"lookat", "look_at"},
    {"dir", "direction"},
    {"h", "height"},
    {"r", "radius"},
    {"r1", "major"},
    {"r2", "minor"},
    {"R", "major"},
    {"r", "minor"},
    {"r1", "bottom"},
    {"r2", "top"},
    {"bottom_radius", "bottom"},
    {"top_radius", "top"},
    {"radius1", "major"},
    {"radius2", "minor"},
    {"radius", "r"},
    {"radius", "k"},
    {"r", "k"},
    {"amount", "r"},
    {"distance", "r"},
    {"n", "sides"},
    {"n", "count"},
    {"count", "n"},
    {"factor", "by"},
    {"v", "axis"},
    {"v", "by"},
    {"vector", "by"},
    {"a", "angle"},
    {"degrees", "angle"},
    {"faces", "sides"},
    {"width", "size"},
    {"dimensions", "size"},
    {"thick", "thickness"},
    {"width", "thickness"},
    {"step", "cell"},
    {"spacing", "cell"},
    {"period", "cell"},
    {"size", "cell"},
    {"material", "material"},
    {"normal", "axis"},
    {"rounding", "radius"},
    {"round_radius", "radius"},
    {"length", "height"},
    {"roundRadius", "radius"},
    {"location", "at"},
    {"energy", "intensity"},
    {"strength", "intensity"},
    {"brightness", "intensity"},
    {"base_color", "diffuse"},
    {"baseColor", "diffuse"},
    {"major_radius", "major"},
    {"minor_radius", "minor"},
    {"majorRadius", "major"},
    {"minorRadius", "minor"},
    {"depth", "height"},
    {"vertices", "points"}};

// What only other ways of making shapes need.
constexpr std::array<std::string_view, 14> needless = {
    "center", "centre", "centered", "segments", "resolution",   "convexity", "slices",
    "fn",     "rings",  "samples",  "steps",    "subdivisions", "detail",    "quality"};

// What is set elsewhere in a scene.
constexpr std::array<std::string_view, 8> no_shapes = {
    "camera", "light", "sun", "lighting", "background", "render", "material", "print"};

// What a shape's call elsewhere takes, and what does it here; empty: none.
std::string_view method_for(std::string_view argument) {
    constexpr std::pair<std::string_view, std::string_view> methods[] = {
        {"color", "paint"},        {"colour", "paint"},          {"material", "paint"},
        {"at", "translate"},       {"position", "translate"},    {"pos", "translate"},
        {"location", "translate"}, {"center", "translate"},      {"rotation", "rotate_euler"},
        {"origin", "translate"},   {"translation", "translate"}, {"texture", "paint"}};
    for (const auto &[theirs, ours] : methods)
        if (theirs == argument) return ours;
    return {};
}

// Where the call ends whose last argument this is, before its `)`; nothing where a block follows.
std::optional<Span> behind_call(const Interpreter &ev, Span last) {
    const std::string_view all = ev.sources[last.source].text;
    const std::size_t close = all.find_first_not_of(" \t\n,", last.end);
    if (close == all.npos || all[close] != ')') return std::nullopt;
    const auto at = static_cast<std::uint32_t>(close + 1);
    return Span{last.source, at, at};
}

// What physically based materials have.
bool is_gloss(std::string_view name) {
    return name == "roughness" || name == "metallic" || name == "metalness" || name == "gloss" ||
           name == "glossiness" || name == "smoothness" || name == "reflectivity";
}

bool has(std::span<const Formal> formals, std::string_view name) {
    return std::ranges::any_of(formals, [&](const Formal &f) { return f.name == name; });
}

// The argument with the comma that it needs no more.
Span with_comma(std::span<const Argument> args, std::size_t at, Span callee) {
    const Span own = whole_argument(args[at]);
    if (at > 0 && args[at - 1].span.begin >= callee.end)
        return {own.source, args[at - 1].span.end, own.end};
    if (at + 1 < args.size() && !args[at + 1].trailing)
        return {own.source, own.begin, whole_argument(args[at + 1]).begin};
    return own;
}

// The axis that an argument's name says: `x`; of a box also `width`, `height`, `depth`.
char axis_of(std::string_view name, std::string_view function) {
    if (name == "x" || name == "y" || name == "z") return name[0];
    if (function != "box" && function != "rectangle" && function != "ellipsoid") return ' ';
    if (name == "width" || name == "w") return 'x';
    if (name == "height" || name == "h") return 'y';
    return name == "depth" || name == "d" || name == "length" ? 'z' : ' ';
}

// `x: 2, z: 3` of a function that takes an axis, or a vector.
bool letters_remedy(Interpreter &ev, std::string_view function, std::span<const Formal> formals,
                    std::span<const Argument> args, const std::vector<std::size_t> &letters,
                    Span callee, Fix &fix) {
    const auto letter = [&](std::size_t i) { return axis_of(args[i].name->text, function); };
    const Argument &first = args[letters[0]];
    std::array<std::string, 3> parts;
    parts.fill(function == "scale" ? "1" : "0");
    for (std::size_t i : letters)
        parts[std::size_t(letter(i) - 'x')] = source_text(ev, args[i].span);
    std::string vector = "[" + parts[0] + ", " + parts[1] + ", " + parts[2] + "]";
    const auto named = [&](const Argument &a) {
        return a.name && (a.name->text == "angle" || a.name->text == "axis");
    };
    const bool turns = has(formals, "angle") && has(formals, "axis");
    if (turns && std::ranges::any_of(args, named)) return false;
    if (turns && letters.size() == 1) {
        const std::string axis(1, static_cast<char>(letter(letters[0]) - 'x' + 'X'));
        const std::string value = source_text(ev, first.span) + ", axis: " + axis;
        fix = {fmt::format("write `{}({})`", function, value), {{whole_argument(first), value}}};
        return true;
    }
    if (turns) fix.edits.push_back({callee, "rotate_euler"});
    const auto taken = std::ranges::find_if(formals, [](const Formal &f) {
        return f.vector_size > 0 && f.name != "axis" && f.name != "towards";
    });
    if (!turns && taken == formals.end()) return false;
    if (!turns && taken->vector_size == 2) vector = "[" + parts[0] + ", " + parts[1] + "]";
    fix.message = fmt::format("write `{}({})`", turns ? "rotate_euler" : function, vector);
    fix.edits.push_back({whole_argument(first), vector});
    for (std::size_t i = 1; i < letters.size(); ++i)
        fix.edits.push_back({with_comma(args, letters[i], callee), ""});
    return true;
}

std::string our_argument(std::string_view theirs, std::span<const Formal> formals) {
    for (const auto &[elsewhere, ours] : argument_names)
        if (elsewhere == theirs && has(formals, ours)) return std::string(ours);
    std::vector<std::string> names;
    for (const Formal &f : formals)
        if (f.name[0] != '_') names.emplace_back(f.name);
    const std::string near = nearest_name(theirs, names);
    return near.empty() ? shortest_begun_by(theirs, names) : near; // `r` for `radius`
}

} // namespace

Fix remedy_of_arguments(Interpreter &ev, std::string_view function, std::span<const Formal> formals,
                        std::span<const Argument> args, const std::vector<std::size_t> &unknown,
                        Span callee) {
    Fix fix;
    std::vector<std::size_t> letters, others;
    const auto axes = std::ranges::count_if(
        unknown, [&](std::size_t i) { return axis_of(args[i].name->text, function) != ' '; });
    const bool all_axes = axes == (function == "rectangle" ? 2 : 3);
    for (std::size_t i : unknown) {
        const std::string &name = args[i].name->text;
        const bool is_letter =
            all_axes ? axis_of(name, function) != ' ' : name == "x" || name == "y" || name == "z";
        (is_letter ? letters : others).push_back(i);
    }
    std::vector<std::string> proposed; // each of our arguments once
    const auto is_free = [&](std::string_view ours) {
        return std::ranges::find(proposed, ours) == proposed.end() &&
               std::ranges::none_of(
                   args, [&](const Argument &b) { return b.name && b.name->text == ours; });
    };
    if (!letters.empty() && !letters_remedy(ev, function, formals, args, letters, callee, fix))
        others.insert(others.begin(), letters.begin(), letters.end());
    const auto say = [&](std::string help) {
        fix.message += fix.message.empty() ? help : "; " + help;
    };
    bool told_gloss = false;
    for (std::size_t i : others) {
        const Argument &a = args[i];
        const std::string &name = a.name->text;
        const std::string_view method =
            std::ranges::find(no_shapes, function) == no_shapes.end() ? method_for(name) : "";
        const auto end = method.empty() || args.back().trailing || has(formals, "at")
                             ? std::nullopt
                             : behind_call(ev, args.back().span);
        const bool of_shape = end && (name != "center" || a.value.kind != ValueKind::Bool);
        const bool diameter = name == "d" || name == "diameter" || name == "dia";
        if (of_shape) { // `sphere(1, color: red)`
            say(fmt::format("write `.{}({})` behind it", method, source_text(ev, a.span)));
            fix.edits.push_back({with_comma(args, i, callee), ""});
            std::string call = fmt::format(".{}({})", method, source_text(ev, a.span));
            const auto same =
                std::ranges::find_if(fix.edits, [&](const Edit &e) { return e.span == *end; });
            if (same == fix.edits.end())
                fix.edits.push_back({*end, std::move(call)});
            else
                same->replacement += call;
        } else if (function == "camera" && (name == "up" || name == "rotation" || name == "roll")) {
            say(fmt::format("a camera stands upright, and looks at a place: leave `{}` away, and "
                            "say `look_at: [0, 0, 0]`",
                            name));
            if (name == "up") fix.edits.push_back({with_comma(args, i, callee), ""});
        } else if (function == "camera" && (name == "lens" || name == "zoom" || name == "near" ||
                                            name == "far" || name == "clip_end")) {
            say(name == "lens" || name == "zoom"
                    ? "the angle of view is `fov: 45deg`"
                    : "a scene is drawn as far as `render(far: …)` says");
        } else if (function == "light" && name == "type") {
            say("a light from afar is `sun(direction: …)`");
        } else if (function == "plane" && (name == "size" || name == "width")) {
            say("a plane has no end; with one it is `box([10, 0.1, 10])`");
        } else if (function == "slab" && name.size() == 2 && name[0] >= 'x' && name[0] <= 'z') {
            if (fix.message.empty())
                say(fmt::format("a slab lies round the origin: `slab(1, axis: {})`, moved by "
                                "`.translate`",
                                static_cast<char>(name[0] - 'x' + 'X')));
        } else if (std::ranges::find(needless, name) != needless.end() && !has(formals, "at")) {
            say(fmt::format("shapes are centred and smooth: leave `{}` away", name));
            fix.edits.push_back({with_comma(args, i, callee), ""});
        } else if (diameter && has(formals, "radius") && is_free("radius")) {
            proposed.emplace_back("radius");
            const std::string value = operand_source(ev, a.span);
            const bool grouped = value != source_text(ev, a.span);
            say(fmt::format("write `radius: {} / 2`", value));
            fix.edits.push_back({a.name->span, "radius"});
            if (grouped) fix.edits.push_back({{a.span.source, a.span.begin, a.span.begin}, "("});
            fix.edits.push_back(
                {{a.span.source, a.span.end, a.span.end}, grouped ? ") / 2" : " / 2"});
        } else if ((name == "r1" || name == "r2") && has(formals, "radius")) {
            if (name == "r2" && fix.message.find("capped_cone") != std::string::npos) continue;
            say("a cone without its tip is `capped_cone(bottom: …, top: …, height: …)`");
        } else if (function == "material" && is_gloss(name)) {
            if (std::exchange(told_gloss, true)) continue;
            say(fmt::format("for `{}` there is `exponent`, from 1 (dull) to 1000 (glossy), and "
                            "`specular`, the highlight's colour",
                            name));
        } else if (name == "within" && function != "within") {
            say("a region stands behind the whole: `.within(ball(3))`");
        } else if (const std::string ours = our_argument(name, formals);
                   !ours.empty() && is_free(ours)) {
            proposed.push_back(ours);
            say(others.size() == 1 ? fmt::format("did you mean `{}`?", ours)
                                   : fmt::format("write `{}` for `{}`", ours, name));
            fix.edits.push_back({a.name->span, ours});
        }
    }
    return fix;
}

void join_sign_edits(Interpreter &ev, std::span<const Argument> args, Fix &fix) {
    const auto sign_of = [&](const Argument &a) -> std::optional<Span> {
        if (!a.name || !a.name->span.source || a.span.begin < a.name->span.end) return std::nullopt;
        const Span between{a.span.source, a.name->span.end, a.span.begin};
        const std::size_t sign = text(ev.sources, between).find('=');
        if (sign == std::string_view::npos) return std::nullopt;
        const auto at = static_cast<std::uint32_t>(between.begin + sign);
        return Span{a.span.source, at, at + 1};
    };
    for (const Argument &a : args) {
        const auto sign = sign_of(a);
        const Diagnostic *told = sign ? ev.diagnostics.find(Code::ForeignSyntax, *sign) : nullptr;
        if (!told || !told->fix) continue;
        bool kept = false;
        for (const Edit &edit : told->fix->edits) {
            const bool gone = std::ranges::any_of(fix.edits, [&](const Edit &e) {
                return e.span.begin < edit.span.end && edit.span.begin < e.span.end;
            });
            if (gone) continue;
            fix.edits.push_back(edit);
            kept = true;
        }
        if (kept) fix.message += "; an argument is named with `:`";
        ev.diagnostics.withdraw(Code::ForeignSyntax, *sign);
        return; // one report is for all of a call
    }
}

} // namespace fathom::typecheck
