// OpenSCAD's transforms, which stand before what they move: each as it is written here, for the
// same solid.
#include "base/text.h"
#include "lang/foreign/foreign.h"

#include <algorithm>
#include <array>

namespace fathom::lang {

namespace {

struct Transform {
    std::string_view theirs, ours;
    std::string_view behind; // what makes the same solid of it
};
constexpr Transform transforms[] = {{"translate", "translate", ""},
                                    {"rotate", "rotate", ""},
                                    {"scale", "scale", ""},
                                    {"mirror", "reflect", ""},
                                    {"color", "paint", ""},
                                    {"resize", "resize", ""},
                                    {"projection", "projection", ""},
                                    {"offset", "offset", ""},
                                    {"linear_extrude", "extrude", ""},
                                    {"rotate_extrude", "revolve", ".orient(Y, Z)"}, // about z
                                    {"multmatrix", "multmatrix", ""},
                                    {"twist", "twist", ""},
                                    {"render", "", ""}}; // draws the same

// What becomes of the value of an argument.
enum class Turned { Kept, Degrees, OtherWay, Color, Away };
struct TransformArgument {
    std::string_view transform, theirs; // the names; of the first and second argument `1` and `2`
    std::string_view ours;              // empty: without a name
    Turned turned;
};
constexpr TransformArgument transform_arguments[] = {
    {"translate", "v", "", Turned::Kept},
    {"scale", "v", "", Turned::Kept},
    {"mirror", "v", "", Turned::Kept},
    {"rotate", "1", "", Turned::Degrees},
    {"rotate", "a", "", Turned::Degrees},
    {"rotate", "2", "axis", Turned::Kept},
    {"rotate", "v", "axis", Turned::Kept},
    {"color", "1", "", Turned::Color},
    {"color", "c", "", Turned::Color},
    {"color", "2", "", Turned::Away},
    {"color", "alpha", "", Turned::Away},
    {"offset", "r", "", Turned::Kept},
    {"offset", "delta", "", Turned::Kept},
    {"offset", "chamfer", "", Turned::Away},
    {"linear_extrude", "h", "height", Turned::Kept},
    {"linear_extrude", "twist", "twist", Turned::OtherWay},
    {"linear_extrude", "scale", "taper", Turned::Kept}};

// What a distance field has no need of, or has no parts for.
constexpr std::array<std::string_view, 8> needless_arguments = {
    "center", "convexity", "slices", "segments", "angle", "steps", "centre", "resolution"};

bool is_degrees(std::string_view number) {
    return number.find_first_not_of("0123456789.") == std::string_view::npos;
}

} // namespace

bool is_foreign_transform(std::string_view name) {
    return std::ranges::find(transforms, name, &Transform::theirs) != std::end(transforms);
}

// The words from `from` up to `to`, with `:` behind the names of arguments.
std::string ForeignSyntax::value_text(Index from, Index to) const {
    std::string out;
    std::uint32_t end = token(from).begin;
    for (Index i = from; i < to; ++i) {
        const bool assign = kind(i) == Tok::Assign;
        if (!assign) out += text(end, token(i).begin);
        out += !assign ? text(i) : token(i).end < token(i + 1).begin ? ":" : ": ";
        end = token(i).end;
    }
    return out;
}

// An angle in degrees: each term of a sum has one unit; what is no sum of products has it behind.
std::string ForeignSyntax::degrees_text(Index from, Index to) const {
    if (to == from + 1 && kind(from) == Tok::Number)
        return std::string(text(from)) +
               (text(from) == "0" || !is_degrees(text(from)) ? "" : "deg");
    const auto next = [&](Index i) { return match(i) > i ? match(i) + 1 : i + 1; };
    bool sums = true; // and products
    for (Index i = from; i < to; i = next(i))
        sums = sums && !is_one_of(kind(i), {Tok::Question, Tok::Less, Tok::Greater, Tok::If});
    if (!sums) return "(" + value_text(from, to) + ") * 1deg";
    std::string out;
    std::uint32_t end = token(from).begin;
    for (Index term = from; term < to;) {
        Index unit = to, past = term;
        bool whole = true; // the number is a factor of the whole term
        while (past < to && (past == term || !is_one_of(kind(past), {Tok::Plus, Tok::Minus}))) {
            const bool divides = past > term && kind(past - 1) == Tok::Slash;
            if (is_one_of(kind(past), {Tok::Percent, Tok::Caret})) whole = false;
            if (unit == to && !divides && kind(past) == Tok::Number && is_degrees(text(past)))
                unit = past;
            past = next(past);
        }
        if (past == term) past = term + 1;
        if (!whole) unit = to;
        const bool signs = past == term + 1 && is_one_of(kind(term), {Tok::Plus, Tok::Minus});
        const bool zero = unit == term && past == term + 1 && text(unit) == "0";
        out += text(end, token(term).begin);
        if (unit < past) {
            out += value_text(term, unit + 1) + (zero ? "" : "deg");
            if (unit + 1 < past) {
                out += text(token(unit).end, token(unit + 1).begin);
                out += value_text(unit + 1, past);
            }
        } else {
            out += value_text(term, past) + (signs ? "" : " * 1deg");
        }
        end = token(past - 1).end;
        term = past;
    }
    return out;
}

// What leaves of a whole turn about z the angle that `rotate_extrude` is given; empty where that is
// no plain number.
std::string ForeignSyntax::cut_of_revolution(Index name) const {
    for (Index i = name + 2; i<match(name + 1); i = match(i)> i ? match(i) + 1 : i + 1) {
        const bool named = text(i) == "angle" && is_one_of(kind(i + 1), {Tok::Assign, Tok::Colon});
        const auto angle = named && is_one_of(kind(i + 3), {Tok::Comma, Tok::Close})
                               ? parse_number(text(i + 2))
                               : std::nullopt;
        if (!angle || *angle <= 0 || *angle >= 360) continue;
        const std::string a = std::string(text(i + 2)) + "deg";
        const std::string end = "plane([sin(" + a + "), -cos(" + a + "), 0], 0)";
        if (*angle > 180) return ".difference(plane(Y, 0) & " + end + ")";
        return ".difference(plane(Y, 0))" + (*angle < 180 ? ".difference(" + end + ")" : "");
    }
    return {};
}

// A transform of OpenSCAD as it is written here, of which nothing more is said.
// `flat`: of what has two dimensions.
std::string ForeignSyntax::transform_text(Index name, bool flat) const {
    const Index open = name + 1, close = match(open);
    const auto *row = std::ranges::find(transforms, text(name), &Transform::theirs);
    if (row == std::end(transforms) || row->ours.empty()) return {};
    const auto next = [&](Index i) { return match(i) > i ? match(i) + 1 : i + 1; };
    std::string ours(row->ours), arguments, height, twist;
    bool centered = false, list = false, has_axis = false;
    int place = 0;
    forget_arguments(open);
    for (Index from = open + 1, to = from; from < close; from = to + 1) {
        for (to = from; to < close && kind(to) != Tok::Comma;) to = next(to);
        if (to == from) continue;
        ++place;
        const bool named =
            kind(from) == Tok::Name && is_one_of(kind(from + 1), {Tok::Assign, Tok::Colon});
        const std::string_view theirs = named ? text(from) : place == 1 ? "1" : "2";
        const Index value = named ? from + 2 : from;
        if (value >= to || kind(from) == Tok::Bad) continue; // `$fn = 64`
        has_axis = has_axis || theirs == "2" || theirs == "v";
        if (theirs == "center" || theirs == "centre") centered = text(value) == "true";
        if (named && is_one_of(theirs, needless_arguments)) continue;
        const auto *found = std::ranges::find_if(transform_arguments, [&](const auto &a) {
            return a.transform == text(name) && a.theirs == theirs;
        });
        const bool known = found != std::end(transform_arguments);
        Index end = to;
        const bool third = flat && kind(value) == Tok::ListOpen && match(value) + 1 == to &&
                           text(name) != "color"; // of three parts, the third goes
        if (third) {
            Index comma = value;
            for (Index i = value + 1, commas = 0; i < to - 1; i = next(i))
                if (kind(i) == Tok::Comma && ++commas == 2) comma = i;
            if (comma > value) end = comma;
        }
        std::string written = value_text(value, end) + (end < to ? "]" : "");
        switch (known ? found->turned : Turned::Kept) {
        case Turned::Kept: break;
        case Turned::Away: continue;
        case Turned::Color:
            if (kind(value) == Tok::String) written = written.substr(1, written.size() - 2);
            break;
        case Turned::OtherWay: { // also in degrees
            const bool negative = kind(value) == Tok::Minus && to == value + 2;
            const bool sum = !negative && to > value + 1;
            written = negative         ? degrees_text(value + 1, to)
                      : sum            ? "-(" + degrees_text(value, to) + ")"
                      : written == "0" ? written
                                       : "-" + degrees_text(value, to);
            break;
        }
        case Turned::Degrees:
            list = kind(value) == Tok::ListOpen && match(value) + 1 == to;
            if (value + 1 == to && kind(value) == Tok::Name && names_vector(text(value))) {
                ours = "rotate_euler";
                has_axis = true;
            }
            if (end < to) { // about z
                list = false;
                written = degrees_text(end + 1, to - 1);
                break;
            }
            if (!list) {
                written = degrees_text(value, to);
                break;
            }
            written = "[";
            for (Index a = value + 1, b = a; a < to - 1; a = b + 1) {
                for (b = a; b < to - 1 && kind(b) != Tok::Comma;) b = next(b);
                written += text(token(a - 1).end, token(a).begin);
                written += degrees_text(a, b) + (b < to - 1 ? "," : "]");
            }
            break;
        }
        if (ours == "extrude" && (theirs == "1" || theirs == "height" || theirs == "h"))
            height = written;
        if (ours == "extrude" && theirs == "twist" && written != "0") twist = written;
        const std::string_view our_name = known ? found->ours : named ? theirs : "";
        arguments += arguments.empty() ? "" : ", ";
        arguments += our_name.empty() ? written : std::string(our_name) + ": " + written;
    }
    if (list) ours = "rotate_euler";
    if (ours == "rotate" && !has_axis && !flat && place > 0) arguments += ", axis: Z";
    std::string out = ours + "(" + arguments + ")" + std::string(row->behind);
    if (ours == "revolve") out += cut_of_revolution(name);
    if (!twist.empty()) out += ".rotate(" + half_of(twist) + ", axis: Z)"; // 0 at the bottom
    if (!height.empty() && !centered) out += ".translate(z: " + half_of(height) + ")";
    return out;
}

// Whether a name stands for a vector: `turned = [90, 0, 0]`, `for (a = [[90, 0, 0], …])`.
bool ForeignSyntax::names_vector(std::string_view name) const {
    for (Index i = 1; may_look_far() && i + 3 < tokens_.tokens.size(); ++i) {
        if (text(i) != name || kind(i) != Tok::Name || kind(i + 2) != Tok::ListOpen ||
            !is_one_of(kind(i + 1), {Tok::Assign, Tok::In}))
            continue;
        const bool turns = kind(i - 1) == Tok::For || (i > 1 && kind(i - 2) == Tok::For);
        return turns == (kind(i + 3) == Tok::ListOpen);
    }
    return false;
}

// What a transform does there and not here, or not in the same way; empty: nothing.
std::string_view ForeignSyntax::lost_of_transform(Index name) const {
    const std::string_view theirs = text(name);
    const Index close = match(name + 1);
    for (Index i = name + 2; i<close; i = match(i)> i ? match(i) + 1 : i + 1) {
        const bool named = is_one_of(kind(i + 1), {Tok::Assign, Tok::Colon});
        if (theirs == "color" && (kind(i) == Tok::Comma || (named && text(i) == "alpha")))
            return "what light passes through is not drawn: the alpha is left away";
        if (named && theirs == "offset" && (text(i) == "delta" || text(i) == "chamfer"))
            return "`offset` rounds the corners that `delta` keeps sharp; a sharp outline is made "
                   "larger by its own numbers";
        if (named && theirs == "rotate_extrude" && text(i) == "angle" && text(i + 2) != "360" &&
            cut_of_revolution(name).empty())
            return "`revolve` turns all the way round: cut off what is not wanted, as with "
                   "`- box([4, 9, 4]).translate([2, 0, 2])`";
        if (named && theirs == "linear_extrude" && text(i) == "scale" && text(i + 2) == "[")
            return "`taper` is one number: both directions become smaller alike";
    }
    return {};
}

// `translate([1, 2, 3]) rotate(…) sphere(1)`: transforms stand behind what they move.
bool ForeignSyntax::juxtaposed_calls(Index first, Index at) {
    if (kind(first) != Tok::Name || kind(first + 1) != Tok::Open ||
        !is_foreign_transform(text(first)))
        return false;
    if (text(first) == "render" && kind(first + 2) == Tok::Name && text(first + 2) != "convexity")
        return false; // a setting of ours
    constexpr int longest_chain = 20;
    std::string chain;
    Index shape = first;
    std::array<std::string_view, longest_chain> lost;
    std::size_t links = 0;
    std::array<Index, longest_chain> names;
    std::size_t solid_from = 0; // the links from there on move what is flat, if that is
    const auto moves = [&](Index i) {
        return kind(i) == Tok::Name && kind(i + 1) == Tok::Open && is_foreign_transform(text(i)) &&
               is_one_of(kind(match(i + 1) + 1), {Tok::Name, Tok::For, Tok::If});
    };
    for (; links < longest_chain && moves(shape); ++links) {
        names[links] = shape;
        lost[links] = lost_of_transform(shape);
        if (text(shape).ends_with("_extrude")) solid_from = links + 1;
        shape = match(shape + 1) + 1;
    }
    if (shape < at) return false;
    const bool flat = solid_from > 0 || is_flat_shape(text(shape));
    for (std::size_t i = 0; i < links; ++i)
        if (const auto one = transform_text(names[i], flat && i >= solid_from); !one.empty())
            chain.insert(0, "." + one);
    failed_ = shape;
    Index end = statement_end(first);
    const bool statement = kind(shape) != Tok::Name;      // a loop or a choice
    constexpr std::string_view meeting = "intersection_"; // before `for`
    const std::string_view before = text(0, token(shape).begin);
    const std::string block = before.ends_with(meeting) ? "intersection { " : "union { ";
    if (kind(shape) == Tok::If && goes_on_with_else(end))
        for (++end; !ends_statement(end);) end = match(end) > end ? match(end) + 1 : end + 1;
    const Index past = match(shape + 1) + 1;
    const Solid solid = solid_of(shape, true);
    const bool whole = !solid.text.empty() && past == end; // nothing behind it
    // `translate(v) ring(6) cube(1);`: what a function is given stands in its braces
    const bool takes = kind(shape + 1) == Tok::Open && kind(past) == Tok::Name && past < end &&
                       !token(past).first_on_line;
    const std::string moved = whole       ? solid.text
                              : statement ? block + std::string(text(shape)) + " … }"
                                          : std::string(text(shape)) + "(…)";
    if (whole) forget_arguments(shape + 1);
    Diagnostic &d =
        foreign(span(first, match(first + 1)), "a transform stands behind the shape that it moves");
    for (std::size_t i = 0; i < links; ++i)
        if (!lost[i].empty() &&
            std::find(lost.begin(), lost.begin() + i, lost[i]) == lost.begin() + i)
            d.note(std::string(lost[i]));
    if (whole && !solid.lost.empty()) d.note(std::string(solid.lost));
    const std::string written = in_code(moved + chain);
    std::vector<Edit> edits{
        {{id_, token(first).begin, token(shape).begin}, statement ? block : ""}};
    const std::uint32_t last = token(end - 1).end;
    if (whole) {
        edits.push_back({{id_, token(shape).begin, last}, solid.text + chain});
    } else {
        if (takes) edits.push_back({{id_, token(past - 1).end, token(past).begin}, " { "});
        edits.push_back(
            {{id_, last, last}, (takes ? " }" : "") + std::string(statement ? " }" : "") + chain});
    }
    d.help(written == in_code("…")
               ? "write the shape, and behind it what is done to it, the nearest "
                 "first"
               : "write " + written,
           std::move(edits));
    return true;
}

// A statement that OpenSCAD alone would have, and that is told as a whole.
bool ForeignSyntax::of_openscad(Index first) {
    if (kind(first) != Tok::Name || kind(first + 1) != Tok::Open) return false;
    const Index behind = match(first + 1) + 1;
    const bool moves = is_foreign_transform(text(first)) && !may_be_declared(text(first)) &&
                       is_one_of(kind(behind), {Tok::Name, Tok::For, Tok::If}) &&
                       (kind(behind) == Tok::Name || !token(behind).first_on_line);
    return (moves && juxtaposed_calls(first, first)) || foreign_solid(first) ||
           foreign_minkowski(first) || foreign_hull(first);
}

} // namespace fathom::lang
