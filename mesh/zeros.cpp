#include "mesh/zeros.h"

#include <algorithm>
#include <cmath>

namespace fathom::mesh {
namespace {

using cpu::Kernel;

constexpr std::size_t most_sheets = 16;

void add(const Zeros &zeros, Zeros &all) {
    all.known = all.known && zeros.known;
    for (const Linear &sheet : zeros.sheets)
        if (std::ranges::find(all.sheets, sheet) == all.sheets.end()) all.sheets.push_back(sheet);
    if (all.sheets.size() > most_sheets) all.known = false;
    if (!all.known) all.sheets.clear();
}

// Where one of some numbers is 0.
Zeros any_of(std::span<const Operand> in) {
    Zeros all{true, {}};
    for (const Operand &one : in) add(*one.zeros, all);
    return all;
}

// Of a number that is one of two everywhere: not of one that is always the other.
Zeros one_of_two(std::span<const Operand> in, bool a_alone, bool b_alone) {
    return any_of(a_alone ? in.first(1) : b_alone ? in.subspan(1) : in);
}

// a + b, of which one is not 0 just where one of some numbers is above 0, and the other where none is:
// it is 0 where the greatest of these is.
Zeros of_halves(const Varying::Half &a, const Varying::Half &b, const std::vector<Zeros> &by_id) {
    if (!a.of.known || a.of != b.of || a.above == b.above) return {};
    Zeros all{true, {}};
    for (const std::uint32_t id : a.of.of)
        if (id != 0) add(by_id[id], all);
    return all;
}

// How much of a number's mean slope is sure.
double steadiness(const Linear &number) {
    const double length = std::hypot(number.slope[0], number.slope[1], number.slope[2]);
    double least = length;
    for (std::size_t i = 0; i < 3 && length > 0; ++i)
        least -= std::fabs(number.slope[i]) / length * number.spread[i];
    return length > 0 ? least / length : 0;
}

// Where all of them are 0: where any one is. The one of the fewest sheets, and of these the steadiest.
Zeros all_of(std::span<const Operand> in) {
    const Zeros *best = nullptr;
    for (const Operand &one : in) {
        const Zeros &zeros = *one.zeros;
        if (!zeros.known) continue;
        const bool fewer = !best || zeros.sheets.size() < best->sheets.size();
        const bool steadier = best && zeros.sheets.size() == 1 && best->sheets.size() == 1 &&
                              steadiness(zeros.sheets[0]) > steadiness(best->sheets[0]);
        if (fewer || steadier) best = &zeros;
    }
    return best ? *best : Zeros{};
}

// Of a·a + b·b + …
bool is_sum_of_squares(std::span<const Operand> in) {
    const std::size_t half = in.size() / 2;
    for (std::size_t k = 0; k < half; ++k)
        if (in[k].address != in[half + k].address) return false;
    return true;
}

} // namespace

bool is_steady(const Linear &number) {
    constexpr double least = 0.2; // below, its place may be many times as large as the box is wide
    return steadiness(number) > least;
}

Zeros zeros_of(Kernel kernel, std::span<const Operand> in, const std::optional<Linear> &itself,
               const std::vector<Zeros> &by_id) {
    if (itself && is_steady(*itself)) return {true, {*itself}};
    const auto is_one = [&](std::initializer_list<Kernel> of) {
        return std::ranges::find(of, kernel) != of.end();
    };
    if (is_one({Kernel::CopyF, Kernel::NegF, Kernel::AbsF, Kernel::SqrtF, Kernel::SignF,
                Kernel::Power2, Kernel::Power3, Kernel::Power4, Kernel::Power5, Kernel::Power6,
                Kernel::Power7, Kernel::Power8, Kernel::DivF}))
        return any_of(in.first(1));
    if (is_one({Kernel::MinF, Kernel::MaxF})) {
        const Interval a = in[0].number->range, b = in[1].number->range;
        const bool a_less = a.hi < b.lo, b_less = b.hi < a.lo, least = kernel == Kernel::MinF;
        return one_of_two(in, least ? a_less : b_less, least ? b_less : a_less);
    }
    if (is_one({Kernel::MulF, Kernel::ClampF, Kernel::MaxNeg, Kernel::MinMax, Kernel::MaxMin}))
        return any_of(in);
    if (is_one({Kernel::AddF})) return of_halves(in[0].number->half, in[1].number->half, by_id);
    if (is_one({Kernel::SelectF}))
        return one_of_two(in.subspan(1), in[0].number->range.lo > 0, in[0].number->range.hi <= 0);
    if (is_one({Kernel::Length2, Kernel::Length3, Kernel::MaxAbs})) return all_of(in);
    if (is_one({Kernel::Dot2, Kernel::Dot3, Kernel::Dot4}) && is_sum_of_squares(in))
        return all_of(in.first(in.size() / 2));
    return {};
}

} // namespace fathom::mesh
