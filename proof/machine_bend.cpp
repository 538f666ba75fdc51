// How much a field can bend: for every value v of a tape a bound on |d²v/ds²| along straight lines,
// s the length, beside the machine's norm n. A line's derivative of v is Lipschitz with it, so
// kinks have none. Only what displacements are made of has a rule; all else is infinity, which is
// true.
//
// With n the norms, b the bends, by the product and chain rules (docs/lipschitz.md, 4):
//   a + b         ba + bb
//   a * b         max|a| bb + max|b| ba + 2 na nb, by component: |u o v| <= |u| |v|
//   f(a)          max|f'| ba + max|f''| na^2
//   |a|           ba + na^2 / min|a|
//   a.xx          sqrt 2 ba, as one component stands there twice
//   M a, M fixed  |M|_F ba
//   noise of q    c bq + c2 nq^2, with the certified slope c and bend c2 of ir/noise.h
#include "ir/noise.h"
#include "proof/instruction_rules.h"

#include <algorithm>
#include <cmath>

namespace fathom::proof {

using ir::rounding::infinity;
using ir::rounding::times;
using ir::rounding::up;

namespace {

double above(double x) { return x == 0 ? 0 : up(x, 8); } // what is straight stays so
bool fixed(double norm, double bend) { return norm == 0 && bend == 0; }

// The rule of an op. Only what displacements are made of has one.
enum class Bend : std::uint8_t {
    Unknown,
    None,
    Part,
    Swizzle,
    Splat,
    Sum,
    Product,
    Quotient,
    Vector,
    Dot,
    Matrix,
    Length,
    Wave,
    Perlin,
    ValueNoise,
};
constexpr ir::OpTable<Bend> bend_of_op{
    {Op::Point, Bend::None},      {Op::Neg, Bend::Part},
    {Op::Swizzle, Bend::Swizzle}, {Op::Splat, Bend::Splat},
    {Op::Add, Bend::Sum},         {Op::Sub, Bend::Sum},
    {Op::Mul, Bend::Product},     {Op::Div, Bend::Quotient},
    {Op::Make, Bend::Vector},     {Op::Dot, Bend::Dot},
    {Op::MatMul, Bend::Matrix},   {Op::Length, Bend::Length},
    {Op::Sin, Bend::Wave},        {Op::Cos, Bend::Wave},
    {Op::Perlin, Bend::Perlin},   {Op::ValueNoise, Bend::ValueNoise},
};

} // namespace

// Of what has no slope: is it the same at all points of the cell? Else it steps from one value to
// another, where the jump is not seen by the field: as `x sign(x)`, which has a ridge there.
bool Step::stands_still() const {
    if (is_one_value()) return true;
    return std::ranges::all_of(in.args,
                               [&](Slot s) { return fixed(machine.norm_[s], machine.bend_[s]); });
}

double Step::bend() const {
    if (machine.norm_[out] == infinity) return infinity;
    if (machine.norm_[out] == 0) return stands_still() ? 0 : infinity;
    const auto bend_of = [&](int arg) {
        return machine.bend_[in.args[static_cast<std::size_t>(arg)]];
    };
    const auto most = [&](int arg) { // of the components
        double all = 0;
        for (int c = 0; c < size(arg); ++c) all = std::max(all, value(arg, c).magnitude());
        return all;
    };
    const auto long_at_most = [&](int arg) {
        return machine.box_length(in.args[static_cast<std::size_t>(arg)]).hi;
    };
    const auto product = [&](double a, double b) {
        return above(times(a, bend_of(1)) + times(b, bend_of(0)) + 2 * times(norm(0), norm(1)));
    };
    const auto through = [&](double slope, double second) { // of a function of argument 0
        return above(times(slope, bend_of(0)) + times(second, norm(0) * norm(0)));
    };
    const auto length = [&] {
        const Interval l = machine.box_length(in.args[0]);
        if (in.args.size() > 1 || !(l.lo > 0)) return infinity;
        return above(bend_of(0) + norm(0) * norm(0) / l.lo);
    };
    switch (in.form) {
    case Form::Square: return above(2 * times(most(0), bend_of(0)) + 2 * norm(0) * norm(0));
    case Form::Norm: return length();
    case Form::Wave:
    case Form::Sinc:
    case Form::Hyperbolic:
    case Form::Corner:
    case Form::OddPower:
    case Form::Smooth:
    case Form::LogSum:
    case Form::PNorm:
    case Form::HeldWave:
    case Form::Joined:
    case Form::Opposite:
    case Form::Loop: return infinity;
    case Form::Plain: break;
    }
    switch (bend_of_op[in.op]) {
    case Bend::None: return 0;
    case Bend::Part: return bend_of(0);
    case Bend::Swizzle: return above(std::sqrt(double(repeats_of_swizzle())) * bend_of(0));
    case Bend::Splat: return above(std::sqrt(double(n)) * bend_of(0));
    case Bend::Sum: return above(bend_of(0) + bend_of(1));
    case Bend::Product: return product(most(0), most(1));
    case Bend::Quotient: {
        double least = infinity;
        for (int c = 0; c < size(1); ++c) least = std::min(least, value(1, c).mignitude());
        return fixed(norm(1), bend_of(1)) && least > 0 ? above(bend_of(0) / least) : infinity;
    }
    case Bend::Vector: {
        double squares = 0;
        for (int a = 0; a < int(in.args.size()); ++a) squares += bend_of(a) * bend_of(a);
        return above(std::sqrt(squares));
    }
    case Bend::Dot: return product(long_at_most(0), long_at_most(1));
    case Bend::Matrix:
        if (fixed(norm(0), bend_of(0))) return above(times(long_at_most(0), bend_of(1)));
        if (fixed(norm(1), bend_of(1))) return above(times(long_at_most(1), bend_of(0)));
        return infinity;
    case Bend::Length: return length();
    case Bend::Wave: return through(1, 1);
    case Bend::Perlin: return through(ir::sem::perlin_slope, ir::sem::perlin_bend);
    case Bend::ValueNoise: return through(ir::sem::value_noise_slope, ir::sem::value_noise_bend);
    case Bend::Unknown: return infinity;
    }
    return infinity;
}

} // namespace fathom::proof
