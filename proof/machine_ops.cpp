// The rule of each op: which function runs it (rule_of_op), and what all rules have in common. The
// rules stand by subject in machine_inputs.cpp, machine_arithmetic.cpp, machine_choices.cpp and
// machine_vectors.cpp. Proofs: docs/lipschitz.md, 2.
#include "proof/instruction_rules.h"

#include <algorithm>

namespace fathom::proof {
namespace {

bool even_aware(const Instruction &i) {
    if (i.form == Form::Norm || i.form == Form::Square || i.form == Form::Joined ||
        i.form == Form::Opposite || i.form == Form::PNorm || i.form == Form::HeldWave)
        return true;
    switch (ir::info(i.op).parity) {
    case ir::OpParity::Even:
    case ir::OpParity::Product:
    case ir::OpParity::Parts: return true;
    case ir::OpParity::None:
    case ir::OpParity::Odd:
    case ir::OpParity::Sum:
    case ir::OpParity::Own: break;
    }
    return i.op == Op::Neg || i.op == Op::Pow;
}

} // namespace

Step::Step(Machine &of, const Instruction &instruction)
    : machine(of), in(instruction), out(in.out), at(of.tape_.first[out]), n(of.tape_.size[out]) {
    if (!even_aware(in))
        for (int a = 0; a < int(in.args.size()); ++a)
            for (int c = 0; c < size(a); ++c) any_odd = any_odd || odd(a, c);
}

// A test's: all that is known of the slope, times `factor`.
void Machine::weaken(Slot s, double factor) {
    if (factor == 1 || norm_[s] == ir::rounding::infinity) return;
    norm_[s] *= factor;
    for (std::uint32_t i = tape_.first[s]; i < tape_.first[s] + tape_.size[s]; ++i)
        for (Interval &own : grad_[i]) own = own * Interval(factor);
}

// A rule that may say less than the op's own does.
void Machine::hold(const Instruction &instruction, Rule rule,
                   void (Machine::*apply)(const Instruction &)) {
    const double before = norm_[instruction.out];
    (this->*apply)(instruction);
    if (norm_[instruction.out] < before) weaken(instruction.out, ranges_.rules[rule]);
}

void Machine::step(const Instruction &in) {
    Step step(*this, in);
    step.run();
    if (const auto &weak = ranges_.rules.of_op; weak.factor != 1)
        if (weak.op == int(in.op) || weak.form == int(in.form)) weaken(in.out, weak.factor);
    if (far_out_.holds()) hold_far(in);
    hold(in, Rule::Raised, &Machine::hold_raised);
    if (in.turning) hold(in, Rule::Turning, &Machine::hold_turning);
    if (in.mean) hold(in, Rule::Mean, &Machine::hold_mean);
    if (in.around) hold(in, Rule::AroundAxis, &Machine::hold_around);
    if (in.beside_turn) hold(in, Rule::BesideTurn, &Machine::hold_beside_turn);
    if (in.between) hold(in, Rule::Between, &Machine::hold_between);
    if (in.along) hold(in, Rule::Along, &Machine::hold_along);
    if (in.ellipsoid) hold(in, Rule::Ellipsoid, &Machine::hold_ellipsoid);
    if (in.univariate) hold(in, Rule::Univariate, &Machine::hold_univariate);
    if (in.from_axis) hold(in, Rule::AxisAngle, &Machine::hold_angle);
    if (in.op == Op::Asin || in.op == Op::Acos) hold(in, Rule::Triangle, &Machine::hold_triangle);
    if (in.has_majorant) hold(in, Rule::Majorant, &Machine::hold_majorant);
    if (in.stands_at) {
        value_[tape_.first[in.out]] = *in.stands_at;
        relative_[in.out] = ir::rounding::infinity; // it was that of another value
        raised_[in.out] = {};
    }
    if (reads_values_) {
        step.read();
        decide(in);
    }
    if (!bend_.empty()) bend_[in.out] = step.bend();
}

// An argument that single precision may not hold, or of a length whose square it may not, is infinity
// there. What keeps the greater part of it, or says the same of all that is so large, may have it; of
// anything else the value is another (log), or none (infinity/infinity).
bool Step::overflows() const {
    const double most = squares_arguments(in) ? ir::rounding::max_squared : max_single;
    const auto large = [&](int arg) {
        for (int c = 0; c < size(arg); ++c)
            if (value(arg, c).magnitude() > most) return true;
        return false;
    };
    int many = 0;
    for (int a = 0; a < int(in.args.size()); ++a) many += large(a);
    if (many == 0) return false;
    const auto at_least_one = [&](int arg) {
        for (int c = 0; c < size(arg); ++c)
            if (value(arg, c).mignitude() < 1) return false;
        return true;
    };
    if (in.form != Form::Plain && in.form != Form::Joined && in.form != Form::Opposite) return true;
    constexpr ir::OpSet bear{Op::Neg,          Op::Abs,     Op::Min,       Op::Max,      Op::Union,
                             Op::Intersection, Op::Clamp,   Op::Exp,       Op::Exp2,     Op::Atan,
                             Op::Tanh,         Op::Less,    Op::LessEqual, Op::Select,   Op::Make,
                             Op::Splat,        Op::Swizzle, Op::Column,    Op::Transpose};
    if (bear[in.op]) return false;
    if (in.op == Op::Add || in.op == Op::Sub) return many > 1;
    if (in.op == Op::Mul) return many == 1 && !at_least_one(large(0) ? 1 : 0);
    return in.op != Op::Div || large(0);
}

namespace {

using OpRule = void (Step::*)();

// One for each op; `nothing` of what never comes here: calls and loops are flattened away,
// lengths become Form::Norm, and hits and paints are colours.
constexpr ir::OpTable<OpRule> rule_of_op{
    {Op::Const, &Step::constant},
    {Op::Point, &Step::point},
    {Op::Normal, &Step::unit_vector},
    {Op::Direction, &Step::unit_vector},
    {Op::Time, &Step::time},
    {Op::Param, &Step::param},
    {Op::Var, &Step::variable},
    {Op::Neg, &Step::negate},
    {Op::Add, &Step::add},
    {Op::Sub, &Step::add},
    {Op::Mul, &Step::product},
    {Op::Div, &Step::quotient},
    {Op::Mod, &Step::remainder},
    {Op::Pow, &Step::power},
    {Op::Min, &Step::extreme},
    {Op::Max, &Step::extreme},
    {Op::Union, &Step::combine},
    {Op::Intersection, &Step::combine},
    {Op::Blend, &Step::blend},
    {Op::Step, &Step::step_at},
    {Op::Sign, &Step::sign_of},
    {Op::Floor, &Step::floor_of},
    {Op::Ceil, &Step::ceil_of},
    {Op::Round, &Step::round_of},
    {Op::Trunc, &Step::trunc_of},
    {Op::ToInt, &Step::trunc_of},
    {Op::Fract, &Step::fraction},
    {Op::Atan2, &Step::angle},
    {Op::Abs, &Step::absolute},
    {Op::Clamp, &Step::clamped},
    {Op::Mix, &Step::mixed},
    {Op::Smoothstep, &Step::smoothstep},
    {Op::Dot, &Step::dot},
    {Op::Cross, &Step::cross},
    {Op::Normalize, &Step::normalize},
    {Op::Length, &Step::nothing},
    {Op::Less, &Step::compare},
    {Op::LessEqual, &Step::compare},
    {Op::Equal, &Step::compare},
    {Op::NotEqual, &Step::compare},
    {Op::And, &Step::both},
    {Op::Or, &Step::either},
    {Op::Not, &Step::opposite},
    {Op::Select, &Step::choose},
    {Op::ToFloat, &Step::to_float},
    {Op::Splat, &Step::splat},
    {Op::Make, &Step::make},
    {Op::Swizzle, &Step::swizzle},
    {Op::Column, &Step::column},
    {Op::Transpose, &Step::transpose},
    {Op::MatMul, &Step::multiply},
    {Op::TableRead, &Step::table_read},
    {Op::Hash, &Step::hash},
    {Op::Perlin, &Step::perlin},
    {Op::Simplex, &Step::simplex},
    {Op::ValueNoise, &Step::value_noise},
    {Op::Worley, &Step::worley},
    {Op::SpotNoise, &Step::spot_noise},
    {Op::Image, &Step::sampled},
    {Op::Grid, &Step::sampled},
    {Op::Cached, &Step::cached},
    {Op::Call, &Step::nothing},
    {Op::Loop, &Step::nothing},
    {Op::LoopResult, &Step::nothing},
    {Op::MakeHit, &Step::nothing},
    {Op::HitDistance, &Step::nothing},
    {Op::HitPaint, &Step::nothing},
    {Op::HitPoint, &Step::nothing},
    {Op::HitExtra, &Step::nothing},
    {Op::NearestHit, &Step::nothing},
    {Op::FarthestHit, &Step::nothing},
    {Op::HitWith, &Step::nothing},
    {Op::FillPaint, &Step::nothing},
// functions of one float: value and slope by their columns in the table
#define FATHOM_FUNCTION(name, function, ...)                                                       \
    {Op::name, &Step::of_one<[](Interval x) { return ir::function(x); },                           \
                             [](Interval x) { return ir::slope::function(x); }>},
#include "ir/ops.def"
};

consteval bool each_op_has_a_rule() {
    for (std::size_t i = 0; i < ir::op_count; ++i)
        if (!rule_of_op.names(static_cast<Op>(i))) return false;
    return true;
}
static_assert(each_op_has_a_rule(), "an op of ir/ops.def is missing in rule_of_op");

} // namespace

void Step::run() {
    if (machine.in_reach_ && overflows()) {
        for (int c = 0; c < n; ++c) set(c, Interval::everything(), none);
        return fail(Trouble::Overflow);
    }
    switch (in.form) {
    case Form::Wave: return wave();
    case Form::Sinc: return sinc();
    case Form::Hyperbolic: return hyperbolic();
    case Form::Norm: return length();
    case Form::Corner: return corner();
    case Form::Square: return squared();
    case Form::OddPower: return odd_power();
    case Form::Smooth: return smooth();
    case Form::LogSum: return log_sum();
    case Form::PNorm: return p_norm();
    case Form::HeldWave: return held_wave();
    case Form::Plain:
    case Form::Joined:
    case Form::Opposite:
    case Form::Loop: break;
    }
    (this->*rule_of_op[in.op])();
}

void Step::nothing() {
    for (int c = 0; c < n; ++c) set(c, Interval::everything(), none);
    fail(Trouble::Singular);
}

} // namespace fathom::proof
