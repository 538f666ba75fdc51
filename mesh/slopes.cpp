#include "mesh/slopes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fathom::mesh {
namespace {

constexpr double inward = 1 - 1e-6;    // what sums of doubles may take
constexpr std::size_t most_levels = 9; // that are chosen
constexpr double along_gradient = 0.9; // the cosine from where a number may vary as the field does

// The axis along which a number changes fastest for sure.
double least_slope(const Varying &number) {
    double best = 0;
    for (std::size_t i = 0; i < 3; ++i)
        best = std::max(best, inward * std::max(number.slope[i].lo, -number.slope[i].hi));
    return best;
}

// Of a number that an evaluator has over a box and, behind that, at its middle.
Level level_of(Register where, const cpu::Shortener &ranges, const Varying &number, double slope) {
    const std::uint32_t at = where.address;
    Level level{where,
                ranges.lo[at],
                ranges.hi[at],
                slope,
                number.error,
                {},
                {},
                {ranges.lo[at + 1], ranges.hi[at + 1]}};
    for (std::size_t i = 0; i < 3; ++i) {
        level.gradient[i] = 0.5 * (number.slope[i].lo + number.slope[i].hi);
        level.slopes[i] = {number.slope[i].lo, number.slope[i].hi};
    }
    return level;
}

// Whether a number may be what the field depends on somewhere here: it changes in the same direction.
bool may_hold(const Level &level, const std::array<std::vector<float>, 4> &slopes) {
    for (std::size_t k = 0; k < slopes[0].size(); ++k) {
        double product = 0, a = 0, b = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            product += level.gradient[i] * slopes[1 + i][k];
            a += level.gradient[i] * level.gradient[i];
            b += double(slopes[1 + i][k]) * slopes[1 + i][k];
        }
        if (std::fabs(product) > along_gradient * std::sqrt(a * b)) return true;
    }
    return false;
}

} // namespace

double cosine(const Level &x, const Level &y) {
    double product = 0, a = 0, b = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        product += x.gradient[i] * y.gradient[i];
        a += x.gradient[i] * x.gradient[i];
        b += y.gradient[i] * y.gradient[i];
    }
    return std::fabs(product) / std::sqrt(a * b);
}

std::vector<Level> chosen_levels(const std::vector<Level> &levels,
                                 const std::array<std::vector<float>, 4> &slopes) {
    constexpr double parallel = 0.9999;
    std::vector<Level> first, more, unseen;
    for (const bool seen : {true, false})
        for (const Level &level : levels) {
            if (may_hold(level, slopes) != seen || !(level.lo < level.hi)) continue;
            const auto is_new = [&](const std::vector<Level> &all) {
                return std::ranges::none_of(
                    all, [&](const Level &one) { return cosine(one, level) > parallel; });
            };
            if (seen)
                (is_new(first) ? first : more).push_back(level);
            else if (is_new(first) && is_new(unseen))
                unseen.push_back(level);
        }
    std::stable_partition(unseen.begin(), unseen.end(), has_cut);
    first.insert(first.end(), unseen.begin(), unseen.end());
    first.insert(first.end(), more.begin(), more.end());
    if (first.size() > most_levels) first.resize(most_levels);
    std::ranges::sort(first, {}, [](const Level &level) { return level.where.step; });
    return first;
}

Tie tie_of(const Level &level, const Level &other, const Point &lo, const Point &hi) {
    constexpr double of_doubles = 1e-9;    // what their rounding may take, of what is added up
    constexpr double underflow = 0x1p-140; // of floats, many times over
    double product = 0, squares = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        product += level.gradient[i] * other.gradient[i];
        squares += level.gradient[i] * level.gradient[i];
    }
    Tie tie;
    tie.share = product / squares;
    const Interval share{tie.share, tie.share}, less{-tie.share, -tie.share};
    // The difference at the middle, and how far from there it may come to be.
    const Interval middle = Interval{other.middle[0], other.middle[1]} +
                            less * Interval{level.middle[0], level.middle[1]};
    const Point at = middle_point(lo, hi);
    double spread = 2 * (other.error + size(share) * level.error) + underflow;
    for (std::size_t i = 0; i < 3; ++i) {
        const Interval mine{level.slopes[i][0], level.slopes[i][1]},
            its{other.slopes[i][0], other.slopes[i][1]};
        const double reach = std::max(double(hi[i]) - at[i], double(at[i]) - lo[i]);
        spread += (size(its + less * mine) + of_doubles * (size(its) + size(share * mine))) * reach;
    }
    spread += of_doubles * (size(middle) + size(share) * (size({level.lo, level.hi})));
    tie.lo = middle.lo - spread;
    tie.hi = middle.hi + spread;
    return tie;
}

std::vector<Level> levels_in(Evaluator &evaluator, const cpu::ShortTape &tape, cpu::Boxes &boxes,
                             const Point &lo, const Point &hi) {
    std::vector<Level> levels;
    if (tape.steps.size() > longest_tape) return levels;
    slopes_over(evaluator, tape, boxes, {lo, hi}, [&](Register where, const Varying &number) {
        if (const double slope = least_slope(number); slope > 0 && !number.jumps)
            levels.push_back(level_of(where, evaluator.ranges, number, slope));
    });
    return levels;
}

namespace {

// The field, as it is cut off at bounds.
struct CutField {
    Varying number;            // what it is and how it changes
    Interval middle;           // its float at the middle
    std::vector<Linear> faces; // the bounds that the field may be 0 at
};

// How far a coordinate is beyond one of the ends that the field is cut off at, as a number of the box.
Varying beyond_end(const SlopeQuestion &in, std::size_t axis, float end, bool high) {
    constexpr double unit_roundoff = 0x1.01p-24;
    const double sign = high ? 1 : -1;
    Varying number;
    number.known = true;
    const double a = sign * (double(in.lo[axis]) - end), b = sign * (double(in.hi[axis]) - end);
    number.error = unit_roundoff * std::max(std::fabs(a), std::fabs(b));
    number.range = {std::min(a, b) - number.error, std::max(a, b) + number.error};
    number.slope[axis] = {sign, sign};
    number.slope[3] = {sign * in.along[axis], sign * in.along[axis]};
    return number;
}

// Of what was found of a tape's numbers: the greatest of the field and of how far the place is beyond
// each end of the bounds.
CutField cut_field_in(const Slopes &slopes, const Evaluator &evaluator, const SlopeQuestion &in) {
    const Field &field = evaluator.field;
    const std::uint32_t result = field.program.results[0].address;
    CutField cut{
        slopes.at(result), {evaluator.ranges.lo[result + 1], evaluator.ranges.hi[result + 1]}, {}};
    const Point at = middle_point(in.lo, in.hi);
    for (std::size_t i = 0; field.cut && i < 3; ++i)
        for (const bool high : {false, true}) {
            const float end = (*field.cut)[high][i];
            const Varying face = beyond_end(in, i, end, high);
            if (face.range.hi < cut.number.range.lo) continue;
            const double there = high ? at[i] - end : end - at[i]; // as floats have it
            cut.middle = {std::max(cut.middle.lo, there), std::max(cut.middle.hi, there)};
            Varying both = through(cpu::Kernel::MaxF, {cut.number, face});
            both.jumps = cut.number.jumps, both.beyond = cut.number.beyond;
            cut.number = both;
            if (face.range.lo <= 0 && face.range.hi >= 0)
                cut.faces.push_back(linear_of(face, {there, there}, in.lo, in.hi));
        }
    return cut;
}

std::optional<Linear> linear_in(const CutField &cut, const Evaluator &evaluator, const Point &lo,
                                const Point &hi) {
    const Varying &number = cut.number;
    if (!number.known || (number.jumps && !evaluator.field.proved)) return std::nullopt;
    Linear linear = linear_of(number, cut.middle, lo, hi);
    linear.jumps = number.jumps;
    return std::isfinite(linear.value + linear.off) ? std::optional(linear) : std::nullopt;
}

} // namespace

std::optional<Linear> linear_over(Evaluator &evaluator, const cpu::ShortTape &tape,
                                  cpu::Boxes &boxes, const Point &lo, const Point &hi) {
    const std::optional<Rising> rising = rising_over(evaluator, tape, boxes, lo, hi, {});
    return rising ? std::optional(rising->linear) : std::nullopt;
}

std::optional<Rising> rising_over(Evaluator &evaluator, const cpu::ShortTape &tape,
                                  cpu::Boxes &boxes, const Point &lo, const Point &hi,
                                  const std::array<double, 3> &along) {
    const cpu::Program::Slot &result = evaluator.field.program.results[0];
    if (result.shared || tape.steps.size() > longest_tape) return std::nullopt;
    const SlopeQuestion question{lo, hi, along};
    const Slopes slopes = slopes_over(evaluator, tape, boxes, question);
    const CutField cut = cut_field_in(slopes, evaluator, question);
    const std::optional<Linear> linear = linear_in(cut, evaluator, lo, hi);
    if (!linear) return std::nullopt;
    const Interval rise = cut.number.slope[3];
    return Rising{*linear, rise.lo - 1e-9 * size(rise)};
}

Unknown why_unknown(const Evaluator &evaluator, const cpu::ShortTape &tape) {
    const Field &field = evaluator.field;
    const cpu::Program::Slot &result = field.program.results[0];
    if (tape.steps.size() > longest_tape) return {Unknown::Why::TooLong, {}};
    if (result.shared || !evaluator.slopes) return {};
    const Slopes slopes{field.parts, evaluator.ranges, *evaluator.slopes};
    if (const auto missing = slopes.missing_at(result.address))
        return {Unknown::Why::Step, *missing};
    const bool jumps = slopes.at(result.address).jumps && !field.proved;
    return {jumps ? Unknown::Why::Jump : Unknown::Why::NoNumber, {}};
}

namespace {

constexpr double of_slopes = 1e-8; // what their rounding may take

// The corners of a box towards which a number falls and rises, where it does along each axis: so what
// of the box it is below 0 in is in one piece with the first, and what it is above 0 in with the second.
std::optional<std::array<Point, 2>> ends_of(const Linear &sheet, const Point &lo, const Point &hi) {
    std::array<Point, 2> ends{};
    for (std::size_t i = 0; i < 3; ++i) {
        if (std::fabs(sheet.slope[i]) < (1 - of_slopes) * sheet.spread[i]) return std::nullopt;
        const bool rises = sheet.slope[i] > 0;
        ends[0][i] = rises ? lo[i] : hi[i];
        ends[1][i] = rises ? hi[i] : lo[i];
    }
    return ends;
}

// The sheet, or its negative, by the field's sign at those ends at which the sheet's is sure. At an end
// where it is not, the sheet is next to 0, no farther than it is off.
std::optional<Linear> like_field(Evaluator &evaluator, const cpu::ShortTape &tape, Linear sheet,
                                 const Point &lo, const Point &hi) {
    const auto ends = ends_of(sheet, lo, hi);
    if (!ends) return std::nullopt;
    Points points;
    for (const Point &end : *ends) points.add(end);
    std::vector<float> values;
    values_at(evaluator, tape, points, values);
    const Point middle = middle_point(lo, hi);
    for (std::size_t i = 0; i < 3; ++i)
        sheet.off += 2 * of_slopes * sheet.spread[i] * (double(hi[i]) - lo[i]);
    bool same = true, opposite = true, sure = false; // of what is sure
    for (std::size_t k = 0; k < 2; ++k) {
        double reached = sheet.value;
        for (std::size_t i = 0; i < 3; ++i)
            reached += sheet.slope[i] * (double((*ends)[k][i]) - middle[i]);
        if (std::fabs(reached) <= sheet.off) continue;
        sure = true;
        same = same && (reached > 0 ? values[k] > 0 : values[k] < 0);
        opposite = opposite && (reached > 0 ? values[k] < 0 : values[k] > 0);
    }
    if (!sure || !(same || opposite)) return std::nullopt;
    if (same) return sheet;
    sheet.value = -sheet.value;
    for (double &slope : sheet.slope) slope = -slope;
    return sheet;
}

} // namespace

Border border_over(Evaluator &evaluator, const cpu::ShortTape &tape, cpu::Boxes &boxes,
                   const Point &lo, const Point &hi) {
    const Field &field = evaluator.field;
    const cpu::Program::Slot &result = field.program.results[0];
    Border border;
    if (!field.proved || result.shared || tape.steps.size() > longest_tape) return border;
    const SlopeQuestion question{lo, hi, {}, true};
    const Slopes slopes = slopes_over(evaluator, tape, boxes, question);
    const CutField cut = cut_field_in(slopes, evaluator, question);
    border.linear = linear_in(cut, evaluator, lo, hi);
    border.zeros = slopes.zeros_at(result.address);
    // Where the greatest of several numbers is 0 one of them is.
    if (cut.number.range.lo > 0)
        border.zeros = {true, {}};
    else if (!cut.faces.empty() && !cut.number.jumps && border.linear && is_steady(*border.linear))
        border.zeros = {true, {*border.linear}};
    else if (border.zeros.known)
        border.zeros.sheets.insert(border.zeros.sheets.end(), cut.faces.begin(), cut.faces.end());
    if (std::ranges::any_of(border.zeros.sheets, [](const Linear &sheet) {
            return !std::isfinite(sheet.value + sheet.off);
        }))
        border.zeros = {};
    if (!border.zeros.known || border.zeros.sheets.size() != 1) return border;
    border.like = like_field(evaluator, tape, border.zeros.sheets[0], lo, hi);
    return border;
}

std::optional<double> least_slope_along(Evaluator &evaluator, const cpu::ShortTape &tape,
                                        cpu::Boxes &boxes, const Point &lo, const Point &hi,
                                        const std::array<double, 3> &along) {
    const cpu::Program::Slot &result = evaluator.field.program.results[0];
    if (result.shared || tape.steps.size() > longest_tape) return std::nullopt;
    const SlopeQuestion question{lo, hi, along};
    const Slopes slopes = slopes_over(evaluator, tape, boxes, question);
    const Varying field = cut_field_in(slopes, evaluator, question).number;
    if (!field.known || (field.jumps && !evaluator.field.proved)) return std::nullopt;
    return field.slope[3].lo - 1e-9 * size(field.slope[3]);
}

} // namespace fathom::mesh
