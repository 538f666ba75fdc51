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

std::optional<Span> behind_call(const Interpreter &ev, Span last) {
    const std::string_view all = ev.sources[last.source].text;
    const std::size_t close = all.find_first_not_of(" \t\n,", last.end);
    if (close == all.npos || all[close] != ')') return std::nullopt;
    const auto at = static_cast<std::uint32_t>(close + 1);
    return Span{last.source, at, at};
}

Span with_comma(std::span<const Argument> args, std::size_t at, Span callee) {
    const Span own = whole_argument(args[at]);
    if (at > 0 && args[at - 1].span.begin >= callee.end)
        return {own.source, args[at - 1].span.end, own.end};
    if (at + 1 < args.size() && !args[at + 1].trailing)
        return {own.source, own.begin, whole_argument(args[at + 1]).begin};
    return own;
}

namespace {

// What others call our arguments, in small letters without `_`, with spaces around. Where a function
// has several of ours, the first row counts.
struct ArgumentNames {
    std::string_view ours, theirs;
};
constexpr ArgumentNames argument_names[] = {
    {"y", " up height vertical "},
    {"x", " right horizontal "},
    {"z", " forward "},
    {"diffuse", " color colour albedo ambient basecolor "},
    {"exponent", " shininess hardness "},
    {"emission", " emissive glow "},
    {"at", " position pos center eye location origin from "},
    {"look_at", " target lookat to focus "},
    {"direction", " dir position pos from towards "},
    {"height", " h length depth "},
    {"radius", " r rounding roundradius "},
    {"major", " r1 R radius1 majorradius radius outer ringradius "},
    {"minor", " r2 r radius2 minorradius thickness thick tube tuberadius inner "},
    {"bottom", " r1 bottomradius base "},
    {"top", " r2 topradius tip "},
    {"r", " radius amount distance "},
    {"k", " radius r smoothness smooth blend fillet amount "},
    {"sides", " n faces nsides numsides "},
    {"count", " n times num number repetitions "},
    {"n", " count times num number copies "},
    {"by", " factor v vector offset delta displacement translation amount "},
    {"axis", " v normal direction around dir "},
    {"angle", " a degrees "},
    {"size", " width dimensions extent extents dims scale length "},
    {"thickness", " thick width wall "},
    {"cell", " step spacing period size gap distance interval "},
    {"intensity", " energy strength brightness power luminosity "},
    {"points", " vertices corners path coords pts "},
    {"material", " color colour "},
    {"fov", " fieldofview angle viewangle "},
    {"color", " tint "},
    {"a", " start p1 from "},
    {"b", " end p2 to "},
    {"octaves", " octave layers "},
    {"alpha", " lacunarity "},
    {"beta", " gain persistence "},
    {"rate", " amount twist strength angle "},
    {"specular", " reflection highlight "},
    {"texture", " map image file "},
    {"max_steps", " steps "},
    {"far", " maxdistance farplane "},
    {"time", " seconds duration "},
    {"ambient", " ambientlight "},
    {"ambient_occlusion", " ao "},
    {"shadow_darkness", " shadow shadows "},
    {"soft_shadows", " softness "}};

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

// What physically based materials have.
bool is_gloss(std::string_view name) {
    return name == "roughness" || name == "metallic" || name == "metalness" || name == "gloss" ||
           name == "glossiness" || name == "smoothness" || name == "reflectivity";
}

bool has(std::span<const Formal> formals, std::string_view name) {
    return std::ranges::any_of(formals, [&](const Formal &f) { return f.name == name; });
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
    if (function == "plane" && args.size() == 1) { // `plane(y: -1)`
        const std::string value =
            fmt::format("{}, {}", static_cast<char>(letter(letters[0]) - 'x' + 'X'),
                        source_text(ev, first.span));
        fix = {fmt::format("write `plane({})`", value), {{whole_argument(first), value}}};
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
    const std::string plain = theirs.size() > 1 ? plain_name(theirs) : std::string(theirs);
    for (const Formal &f : formals)
        if (plain_name(f.name) == plain) return std::string(f.name);
    const std::string word = " " + plain + " ";
    for (const auto &[ours, elsewhere] : argument_names)
        if (elsewhere.find(word) != elsewhere.npos && has(formals, ours)) return std::string(ours);
    std::vector<std::string> names;
    for (const Formal &f : formals)
        if (f.name[0] != '_') names.emplace_back(f.name);
    const std::string near = nearest_name(theirs, names);
    return near.empty() ? shortest_begun_by(theirs, names) : near; // `r` for `radius`
}

// The unknown arguments of one call, and what is proposed for them so far.
class Remedy {
  public:
    Remedy(Interpreter &ev, std::string_view function, std::span<const Formal> formals,
           std::span<const Argument> args, Span callee)
        : ev_(ev), function_(function), formals_(formals), args_(args), callee_(callee) {}

    Fix of(const std::vector<std::size_t> &unknown) {
        std::vector<std::size_t> letters, others;
        const auto axes = std::ranges::count_if(
            unknown, [&](std::size_t i) { return axis_of(args_[i].name->text, function_) != ' '; });
        const bool all_axes = axes == (function_ == "rectangle" ? 2 : 3);
        for (std::size_t i : unknown) {
            const std::string name(args_[i].name->text);
            const bool is_letter = all_axes ? axis_of(name, function_) != ' '
                                            : name == "x" || name == "y" || name == "z";
            (is_letter ? letters : others).push_back(i);
        }
        if (!letters.empty() &&
            !letters_remedy(ev_, function_, formals_, args_, letters, callee_, fix_))
            others.insert(others.begin(), letters.begin(), letters.end());
        if (function_ == "repeat" && row_along(unknown)) return fix_;
        if (function_ == "slab" && slab_between(ev_, args_, unknown, fix_)) return fix_;
        if (function_ == "cylinder" || function_ == "cone")
            cone_ = cone_between(ev_, args_, unknown, callee_, fix_);
        alone_ = others.size() == 1;
        for (std::size_t i : others)
            if (!behind(i) && !elsewhere(args_[i].name->text, i)) ours(i);
        take_away();
        return fix_;
    }

  private:
    void say(std::string help) { fix_.message += fix_.message.empty() ? help : "; " + help; }
    void leave(std::size_t i) { left_.push_back(i); }
    // What goes, with the commas that parted it: arguments that stand together go together.
    void take_away() {
        std::ranges::sort(left_);
        for (std::size_t k = 0; k < left_.size();) {
            const std::size_t first = left_[k];
            std::size_t last = first;
            while (++k < left_.size() && left_[k] == last + 1) last = left_[k];
            const Span own = join(whole_argument(args_[first]), whole_argument(args_[last]));
            Span gone = own;
            if (first > 0 && args_[first - 1].span.begin >= callee_.end)
                gone = {own.source, args_[first - 1].span.end, own.end};
            else if (last + 1 < args_.size() && !args_[last + 1].trailing)
                gone = {own.source, own.begin, whole_argument(args_[last + 1]).begin};
            fix_.edits.push_back({gone, ""});
        }
        left_.clear();
    }
    bool is_given(std::string_view ours) const {
        const auto is_it = [&](const Argument &b) { return b.name && b.name->text == ours; };
        return std::ranges::any_of(args_, is_it);
    }
    bool is_free(std::string_view ours) const {
        return std::ranges::find(proposed_, ours) == proposed_.end() && !is_given(ours);
    }

    // `s.repeat(3, along: X, spacing: 1)`: a row of so many, so far apart.
    bool row_along(const std::vector<std::size_t> &unknown) {
        std::string axis, step = "1", count;
        Span row = args_[0].span;
        for (std::size_t i = 0; i < args_.size(); ++i) {
            const Argument &a = args_[i];
            if (a.value.kind == ValueKind::Shape && i == 0) continue;
            if (a.trailing || !row.source) return false;
            const std::string name(a.name ? a.name->text : std::string_view());
            const Span whole = whole_argument(a);
            row = count.empty() && axis.empty() && row == args_[0].span ? whole : join(row, whole);
            if (names_an_axis(name) || name == "along" || name == "dir")
                axis = axis_text(ev_, a.value, a.span);
            else if (name.empty() && a.value.kind == ValueKind::Int && count.empty())
                count = source_text(ev_, a.span);
            else if (name == "count" || name == "n" || name == "times" || name == "copies")
                count = source_text(ev_, a.span);
            else if (name == "cell" || our_argument(name, formals_) == "cell")
                step = source_text(ev_, a.span);
            else
                return false;
        }
        if (unknown.empty() || axis.size() != 1 || axis[0] < 'X' || axis[0] > 'Z') return false;
        const auto vector = [&](const std::string &x, const char *other) {
            std::string out = "[";
            for (char c = 'X'; c <= 'Z'; ++c) {
                out += c == 'X' ? "" : ", ";
                out += c == axis[0] ? x : std::string(other);
            }
            return out + "]";
        };
        std::string written = vector(step, "0");
        if (!count.empty()) written += ", count: " + vector(count, "1");
        fix_ = {fmt::format("a row is `repeat({})`", written), {{row, written}}};
        return true;
    }

    // `sphere(1, color: red)`, `torus(1, 0.2, axis: Z)`: what is done behind the call.
    bool behind(std::size_t i) {
        const Argument &a = args_[i];
        const std::string name(a.name->text);
        const bool is_setting = std::ranges::find(no_shapes, function_) != no_shapes.end();
        if (is_setting || args_.back().trailing || has(formals_, "at") || has(formals_, "material"))
            return false;
        std::string call;
        const std::string axis = axis_text(ev_, a.value, a.span);
        if (names_an_axis(name) && lies_along_y(function_) && !axis.empty())
            call = fmt::format(".orient(Y, {})", axis);
        else if ((name == "x" || name == "y" || name == "z") && formals_[0].name != "s")
            call = fmt::format(".translate({}: {})", name, source_text(ev_, a.span));
        else if (const auto method = method_for(name);
                 !method.empty() && (name != "center" || a.value.kind != ValueKind::Bool))
            call = fmt::format(".{}({})", method, source_text(ev_, a.span));
        const auto end = call.empty() ? std::nullopt : behind_call(ev_, args_.back().span);
        if (!end) return false;
        leave(i);
        if (call == ".orient(Y, Y)") {
            say(fmt::format("it lies along Y as it is: leave `{}` away", name));
            return true;
        }
        say(fmt::format("write `{}` behind it", call));
        const auto same =
            std::ranges::find_if(fix_.edits, [&](const Edit &e) { return e.span == *end; });
        if (same == fix_.edits.end())
            fix_.edits.push_back({*end, std::move(call)});
        else
            same->replacement += call;
        return true;
    }

    // What is said otherwise, or set elsewhere.
    bool elsewhere(std::string_view name, std::size_t i) {
        const bool camera = function_ == "camera";
        const bool diameter = name == "d" || name == "diameter" || name == "dia";
        const bool end = name == "r1" || name == "r2" || name == "d1" || name == "d2";
        if (camera && (name == "up" || name == "rotation" || name == "roll")) {
            say(fmt::format("a camera stands upright, and looks at a place: leave `{}` away, and "
                            "say `look_at: [0, 0, 0]`",
                            name));
            if (name == "up") leave(i);
        } else if (camera && (name == "lens" || name == "zoom")) {
            say("the angle of view is `fov: 45deg`");
            leave(i);
        } else if (camera && (name == "near" || name == "far" || name == "clip_end")) {
            say("a scene is drawn as far as `render(far: …)` says");
            leave(i);
        } else if (function_ == "render" &&
                   (name == "width" || name == "height" || name == "size" || name == "w" ||
                    name == "h" || name == "resolution")) {
            if (fix_.message.find("--size") == std::string::npos)
                say("the size of a picture is said where it is made: `fathom render --size`");
            leave(i);
        } else if (camera && is_given("at") &&
                   (name == "from" || our_argument(name, formals_) == "at")) {
            say("a camera is `at` a place, and looks at `look_at`");
            for (const Argument &a : args_)
                if (&a == &args_[i] || (a.name && a.name->text == "at"))
                    fix_.edits.push_back({a.name->span, &a == &args_[i] ? "at" : "look_at"});
        } else if (chooses_rows(function_, name)) {
            say("a field is given one point, not rows of them: leave `axis` away");
            leave(i);
        } else if (function_ == "light" && name == "type") {
            say("a light from afar is `sun(direction: …)`, any other has no type");
            leave(i);
        } else if (function_ == "light" && (name == "dir" || name == "direction")) {
            say("a light from afar is `sun(direction: …)`");
            fix_.edits.push_back({callee_, "sun"});
            fix_.edits.push_back({args_[i].name->span, "direction"});
        } else if (function_ == "sun" && (name == "angle" || name == "elevation" ||
                                          name == "azimuth" || name == "rotation")) {
            say("where the sun stands is a direction: `sun(direction: [0.4, 1, 0.3])`");
        } else if (function_ == "plane" && (name == "size" || name == "width")) {
            say("a plane has no end; with one it is `box([10, 0.1, 10])`");
            leave(i);
        } else if (function_ == "slab" && name.size() == 2 && name[0] >= 'x' && name[0] <= 'z') {
            if (fix_.message.empty())
                say(fmt::format("a slab lies round the origin: `slab(1, axis: {})`, moved by "
                                "`.translate`",
                                static_cast<char>(name[0] - 'x' + 'X')));
        } else if (std::ranges::find(needless, name) != needless.end() && !has(formals_, "at") &&
                   !has(formals_, "max_steps")) {
            say(fmt::format("shapes are centred and smooth: leave `{}` away", name));
            leave(i);
        } else if (const auto rounded = rounded_form(function_, name); !rounded.empty()) {
            if (std::exchange(rounded_, true)) return true;
            say(fmt::format("write `{}(…, radius: {})`", rounded, source_text(ev_, args_[i].span)));
            fix_.edits.push_back({callee_, std::string(rounded)});
            fix_.edits.push_back({args_[i].name->span, "radius"});
        } else if (diameter && has(formals_, "radius") && is_free("radius")) {
            halve(args_[i]);
        } else if (end && cone_) { // told
        } else if (end && has(formals_, "radius")) {
            if (fix_.message.find("capped_cone") == std::string::npos)
                say("a cone without its tip is `capped_cone(bottom: …, top: …, height: …)`");
        } else if (function_ == "material" && is_gloss(name)) {
            leave(i);
            if (std::exchange(told_gloss_, true)) return true;
            say(fmt::format("for `{}` there is `exponent`, from 1 (dull) to 1000 (glossy), and "
                            "`specular`, the highlight's colour",
                            name));
        } else if (auto smooth = smooth_form(ev_, function_, args_, i, callee_);
                   !smooth.edits.empty()) {
            say(smooth.message);
            fix_.edits.insert(fix_.edits.end(), smooth.edits.begin(), smooth.edits.end());
            if (i > 0) leave(i);
        } else if (name == "within" && function_ != "within") {
            say("a region stands behind the whole: `.within(ball(3))`");
        } else
            return false;
        return true;
    }

    void halve(const Argument &a) {
        proposed_.emplace_back("radius");
        const std::string value = operand_source(ev_, a.span);
        const bool grouped = value != source_text(ev_, a.span);
        say(fmt::format("write `radius: {} / 2`", value));
        fix_.edits.push_back({a.name->span, "radius"});
        if (grouped) fix_.edits.push_back({{a.span.source, a.span.begin, a.span.begin}, "("});
        fix_.edits.push_back({{a.span.source, a.span.end, a.span.end}, grouped ? ") / 2" : " / 2"});
    }

    // The one parameter that has to be given and is not, where one argument alone is unknown.
    std::string wanted_still() const {
        std::string wanted;
        std::size_t place = 0;
        const auto unnamed = static_cast<std::size_t>(
            std::ranges::count_if(args_, [](const Argument &a) { return !a.name && !a.trailing; }));
        for (const Formal &f : formals_) {
            const bool given =
                place++ < unnamed || std::ranges::any_of(args_, [&](const Argument &a) {
                    return a.name && a.name->text == f.name;
                });
            if (given || f.optional || f.takes_rest) continue;
            if (!wanted.empty()) return {};
            wanted = f.name;
        }
        if (wanted.empty() && formals_.size() == 1 && args_.size() == 1) wanted = formals_[0].name;
        return alone_ && is_free(wanted) ? wanted : std::string();
    }

    // An argument of ours by another name.
    void ours(std::size_t i) {
        const std::string name(args_[i].name->text);
        std::string taken = our_argument(name, formals_);
        if (taken.empty() && way_from_elsewhere(name).empty()) taken = wanted_still();
        if (const auto way = way_from_elsewhere(name); taken.empty() && !way.empty())
            say(std::string(way)), leave(i);
        else if (taken.empty())
            say(fmt::format("leave `{}` away", name)), leave(i);
        if (taken.empty() || !is_free(taken)) return;
        proposed_.push_back(taken);
        say(alone_ ? fmt::format("did you mean `{}`?", taken)
                   : fmt::format("write `{}` for `{}`", taken, name));
        fix_.edits.push_back({args_[i].name->span, taken});
    }

    Interpreter &ev_;
    std::string_view function_;
    std::span<const Formal> formals_;
    std::span<const Argument> args_;
    Span callee_;
    Fix fix_;
    std::vector<std::string> proposed_; // each of our arguments once
    std::vector<std::size_t> left_;     // arguments that are left away
    bool told_gloss_ = false, cone_ = false, rounded_ = false, alone_ = false;
};

} // namespace

Fix remedy_of_arguments(Interpreter &ev, std::string_view function, std::span<const Formal> formals,
                        std::span<const Argument> args, const std::vector<std::size_t> &unknown,
                        Span callee) {
    return Remedy(ev, function, formals, args, callee).of(unknown);
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
