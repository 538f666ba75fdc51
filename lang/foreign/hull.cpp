// Convex hulls of OpenSCAD that are other shapes here: of two balls, and of balls, posts or discs in the
// corners of a box.
#include "base/text.h"
#include "lang/foreign/foreign.h"

#include <algorithm>
#include <utility>

namespace fathom::lang {
namespace {

std::string as_operand(const std::string &value) {
    return value.find_first_of(" +-*/%?<>=&|") == value.npos ? value : "(" + value + ")";
}
// The middle of two values, or how far they are apart.
std::string middle_of(const std::string &lo, const std::string &hi) {
    const auto a = parse_number(lo), b = parse_number(hi);
    return a && b ? format_shortest((*a + *b) / 2)
                  : "(" + as_operand(lo) + " + " + as_operand(hi) + ") / 2";
}
std::string apart(const std::string &lo, const std::string &hi) {
    const auto a = parse_number(lo), b = parse_number(hi);
    return a && b ? format_shortest(*b - *a) : as_operand(hi) + " - " + as_operand(lo);
}

} // namespace

// The arguments of a call: those with a name by it, those without by their place, as `0`.
std::vector<std::pair<std::string, std::string>> ForeignSyntax::named_arguments(Index open) const {
    std::vector<std::pair<std::string, std::string>> found;
    int place = 0;
    for (Index i = open + 1, end = i; i < match(open); i = end + 1) {
        for (end = i; end < match(open) && kind(end) != Tok::Comma;)
            end = match(end) > end ? match(end) + 1 : end + 1;
        const bool has_name = kind(i + 1) == Tok::Assign;
        if (kind(i) == Tok::Bad) continue; // `$fn`
        found.emplace_back(has_name ? std::string(text(i)) : std::to_string(place++),
                           value_text(has_name ? i + 2 : i, end));
    }
    return found;
}

// `hull() { for (x = [-10, 10], y = [-5, 5]) translate([x, y, 0]) cylinder(r = 2, h = 4); }`: what is
// in the corners of a box, grown by a radius.
bool ForeignSyntax::hull_of_loops(Index first, Index begin) {
    struct Axis {
        std::string name, lo, hi;
    };
    std::vector<Axis> loops;
    Index at = begin;
    int braces = 0;
    const auto skip_ends = [&] {
        for (; is_one_of(kind(at), {Tok::End, Tok::Body, Tok::Trailing, Tok::StrayBrace}); ++at)
            braces += kind(at) != Tok::End;
    };
    const auto is_list = [&](Index i) {
        return is_one_of(kind(i), {Tok::ListOpen, Tok::FreshListOpen}) && match(i) > i;
    };
    const auto items = [&](Index list) {
        std::vector<std::string> found;
        for (Index i = list + 1, end = i; i < match(list); i = end + 1) {
            for (end = i; end < match(list) && kind(end) != Tok::Comma;) {
                if (kind(end) == Tok::Colon) return std::vector<std::string>{}; // a range
                end = match(end) > end ? match(end) + 1 : end + 1;
            }
            found.push_back(value_text(i, end));
        }
        return found;
    };
    for (skip_ends(); kind(at) == Tok::For && kind(at + 1) == Tok::Open && match(at + 1) > at;
         skip_ends()) {
        for (Index i = at + 2; i < match(at + 1);) {
            if (kind(i) != Tok::Name || kind(i + 1) != Tok::Assign || !is_list(i + 2)) return false;
            const std::vector<std::string> ends = items(i + 2);
            if (ends.size() != 2) return false;
            loops.push_back({std::string(text(i)), ends[0], ends[1]});
            i = match(i + 2) + 1;
            if (kind(i) == Tok::Comma) ++i;
        }
        at = match(at + 1) + 1;
    }
    if (loops.empty() || text(at) != "translate" || kind(at + 1) != Tok::Open || !is_list(at + 2))
        return false;
    std::vector<std::string> place = items(at + 2), sides;
    if (place.size() == 2) place.push_back("0");
    if (place.size() != 3 || match(at + 2) + 1 != match(at + 1)) return false;
    std::size_t used = 0;
    for (std::string &item : place) {
        const auto axis = std::ranges::find(loops, item, &Axis::name);
        sides.push_back(axis == loops.end() ? "" : apart(axis->lo, axis->hi));
        if (axis == loops.end()) continue;
        item = middle_of(axis->lo, axis->hi);
        ++used;
    }
    const Index shape = match(at + 1) + 1, args = shape + 1;
    if (used != loops.size() || kind(args) != Tok::Open || match(args) <= args ||
        !ends_statement(match(args) + 1))
        return false;
    Index last = match(args);
    for (Index i = last + 1; braces > 0; ++i) {
        if (kind(i) == Tok::End) continue;
        if (kind(i) != Tok::BraceClose) return false; // something else stands there
        last = i;
        --braces;
    }
    const bool ball = text(shape) == "sphere", disc = text(shape) == "circle",
               post = text(shape) == "cylinder";
    if (ball ? used != 3 : (!disc && !post) || used != 2 || sides[0].empty() || sides[1].empty())
        return false;
    std::string radius, height = "1";
    bool center = false;
    for (const auto &[name, value] : named_arguments(args)) {
        if (name == "r" || name == (post ? "1" : "0")) radius = value;
        if (name == "d") radius = half_of(value);
        if (post && (name == "h" || name == "0")) height = value;
        center = center || (name == "center" && value == "true");
        if (name == "r1" || name == "r2" || name == "d1" || name == "d2") return false;
    }
    if (radius.empty()) return false;
    if (post && !center)
        place[2] = place[2] == "0" ? half_of(height) : place[2] + " + " + half_of(height);
    const std::string flat =
        "rectangle([" + sides[0] + ", " + sides[1] + "]).offset(" + radius + ")";
    const std::string written =
        (ball ? "box([" + sides[0] + ", " + sides[1] + ", " + sides[2] + "]).offset(" + radius + ")"
         : post ? flat + ".extrude(" + height + ")"
                : flat) +
        ".translate([" + place[0] + ", " + place[1] + (disc ? "" : ", " + place[2]) + "])";
    for (Index i = begin; i < last; ++i)
        if (kind(i) == Tok::Open) forget_arguments(i);
    failed_ = last;
    foreign(span(first), "there is no convex hull")
        .help("of what stands in the corners of a box it is that box with round edges: write " +
                  in_code(written),
              {{span(first, last), written}});
    return true;
}

// `hull() { sphere(1); translate([3, 0, 0]) sphere(1); }`: two balls of one radius are a capsule.
bool ForeignSyntax::foreign_hull(Index first) {
    if (text(first) != "hull" || kind(first + 1) != Tok::Open || match(first + 1) <= first + 1 ||
        may_be_declared(text(first)))
        return false;
    const Index open = match(first + 1) + 1, close = match(open);
    if (hull_of_loops(first, open)) return true;
    if (close <= open) return false;
    std::vector<std::string> centers, radii;
    const auto vector_at = [&](Index at) { // in parentheses
        const Index list = at + 1;
        return is_one_of(kind(list), {Tok::ListOpen, Tok::FreshListOpen}) &&
                       match(list) + 1 == match(at)
                   ? value_text(list, match(at))
                   : std::string();
    };
    for (Index i = open + 1; i < close; ++i) {
        if (kind(i) == Tok::End) continue;
        std::string center = "[0, 0, 0]";
        if (text(i) == "translate" && kind(i + 1) == Tok::Open && match(i + 1) > i + 1) {
            center = vector_at(i + 1);
            i = match(i + 1) + 1;
        }
        if (text(i) != "sphere" || kind(i + 1) != Tok::Open || match(i + 1) <= i + 1) return false;
        radii.push_back(radius_of(i));
        i = match(i + 1) + 1;
        if (kind(i) == Tok::Dot && text(i + 1) == "translate" && kind(i + 2) == Tok::Open) {
            center = vector_at(i + 2);
            i = match(i + 2) + 1;
        }
        if (center.empty() || radii.back().empty() || !ends_statement(i)) return false;
        centers.push_back(std::move(center));
    }
    if (radii.size() != 2) return false;
    for (Index i = open; i < close; ++i)
        if (kind(i) == Tok::Open) forget_arguments(i);
    failed_ = close;
    Diagnostic &d = foreign(span(first), "there is no convex hull");
    const std::string written = "capsule(" + centers[0] + ", " + centers[1] + ", " + radii[0] + ")";
    if (radii[0] == radii[1])
        d.help("of two balls it is a capsule: write " + in_code(written),
               {{span(first, close), written}});
    else
        d.help("of two balls of different size it is a cone with round ends, `round_cone(bottom: " +
               brief(radii[0]) + ", top: " + brief(radii[1]) +
               ", height: …)`, the centres so far apart along y, turned by `.orient`");
    return true;
}

} // namespace fathom::lang
