// One switch from operations to kernels. Componentwise ones go component by component; products of
// matrices leave out what is multiplied by a constant 0, so that a turn about an axis costs what it
// would by hand.
#include "backend-cpu/compile/select.h"

#include "ir/powers.h"

#include <cassert>
#include <cmath>

namespace fathom::cpu {

using namespace ir;

namespace {

using Values = std::vector<Value>;
using Arguments = std::span<const Values>;

Values by_component(Builder &builder, Kernel kernel, Arguments args, std::size_t output = 0) {
    Values out;
    for (std::size_t i = 0; i < args[0].size(); ++i) {
        Values in;
        for (const Values &arg : args) in.push_back(arg[i]);
        out.push_back(builder.outputs(kernel, in)[output]);
    }
    return out;
}

Values chain(Builder &builder, Kernel kernel, Arguments args) {
    Value sum = args[0][0];
    for (const Values &arg : args.subspan(1)) sum = builder.make(kernel, {sum, arg[0]});
    return {sum};
}

Values joined(Arguments args) {
    Values all;
    for (const Values &arg : args) all.insert(all.end(), arg.begin(), arg.end());
    return all;
}

Kernel for_size(std::size_t size, std::array<Kernel, 4> kernels) { return kernels[size - 1]; }

Value sum_of_products(Builder &builder, const Values &a, const Values &b) {
    Values left, right;
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (builder.number_of(a[i]) == 0.0f || builder.number_of(b[i]) == 0.0f) continue;
        left.push_back(a[i]);
        right.push_back(b[i]);
    }
    Values both = left;
    both.insert(both.end(), right.begin(), right.end());
    if (left.empty()) return builder.number(0);
    return builder.outputs(
        for_size(left.size(), {Kernel::MulF, Kernel::Dot2, Kernel::Dot3, Kernel::Dot4}), both)[0];
}

Values multiply(Builder &builder, const Values &a, Type a_type, const Values &b, Type b_type) {
    auto n = static_cast<std::size_t>(side(is_matrix(a_type) ? a_type : b_type));
    auto row = [&](std::size_t r) {
        Values values;
        for (std::size_t c = 0; c < n; ++c) values.push_back(a[c * n + r]);
        return values;
    };
    auto column = [&](std::size_t c) {
        auto begin = b.begin() + static_cast<std::ptrdiff_t>(c * n);
        return Values(begin, begin + static_cast<std::ptrdiff_t>(n));
    };
    Values out;
    if (!is_matrix(b_type))
        for (std::size_t r = 0; r < n; ++r) out.push_back(sum_of_products(builder, row(r), b));
    else if (!is_matrix(a_type))
        for (std::size_t c = 0; c < n; ++c) out.push_back(sum_of_products(builder, a, column(c)));
    else
        for (std::size_t c = 0; c < n; ++c)
            for (std::size_t r = 0; r < n; ++r)
                out.push_back(sum_of_products(builder, row(r), column(c)));
    return out;
}

Values blend(Builder &builder, Profile profile, Arguments args) {
    Value r = args[0][0], n = args[1][0], sum = args[2][0];
    for (const Values &arg : args.subspan(3)) {
        switch (profile) {
        case Profile::Smooth: sum = builder.make(Kernel::BlendSmooth, {sum, arg[0], r}); break;
        case Profile::Round: sum = builder.make(Kernel::BlendRound, {sum, arg[0], r}); break;
        case Profile::Chamfer: sum = builder.make(Kernel::BlendChamfer, {sum, arg[0], r}); break;
        case Profile::Stairs: sum = builder.make(Kernel::BlendStairs, {sum, arg[0], r, n}); break;
        case Profile::Columns: sum = builder.make(Kernel::BlendColumns, {sum, arg[0], r, n}); break;
        }
    }
    return {sum};
}

// x^y; where y is a whole constant by products (ir/powers.h).
Value power(Builder &builder, Value x, Value y) {
    constexpr std::array<Kernel, largest_power - 1> rows{
        Kernel::Power2, Kernel::Power3, Kernel::Power4, Kernel::Power5,
        Kernel::Power6, Kernel::Power7, Kernel::Power8};
    const float n = builder.number_of(y).value_or(0);
    if (n == 0.5f) return builder.make(Kernel::SqrtF, {x});
    if (n == -1) return builder.make(Kernel::DivF, {builder.number(1), x});
    const std::vector<int> factors = power_factors(std::abs(n));
    if (factors.empty()) return builder.make(Kernel::PowF, {x, y});
    for (const int factor : factors)
        x = builder.make(rows[static_cast<std::size_t>(factor) - 2], {x});
    return n > 0 ? x : builder.make(Kernel::DivF, {builder.number(1), x});
}

Value choose(Builder &builder, Value condition, Value yes, Value no, bool is_float) {
    return builder.make(is_float ? Kernel::SelectF : Kernel::SelectI, {condition, yes, no});
}

// A hit's values: distance, paint, point, extra; the paint alone is an int.
Values choose_hit(Builder &builder, Value condition, const Values &yes, const Values &no,
                  std::size_t from) {
    Values out(no.begin(), no.begin() + static_cast<std::ptrdiff_t>(from));
    for (std::size_t i = from; i < no.size(); ++i)
        out.push_back(choose(builder, condition, yes[i], no[i], i != 1));
    return out;
}

Values fill_paint(Builder &builder, const Values &hit, const Values &paint) {
    Value unpainted = builder.make(Kernel::LessI, {hit[1], builder.integer(0)});
    return choose_hit(builder, unpainted, paint, hit, 1);
}

Values nearest(Builder &builder, Arguments args) {
    Values best = args[0];
    for (const Values &arg : args.subspan(1))
        best = choose_hit(builder, builder.make(Kernel::LessF, {arg[0], best[0]}), arg, best, 0);
    return best;
}

Values farthest(Builder &builder, Arguments args) {
    Values best = args[0];
    for (const Values &arg : args.subspan(1))
        best = choose_hit(builder, builder.make(Kernel::LessF, {best[0], arg[0]}), arg, best, 0);
    return fill_paint(builder, best, args[0]);
}

} // namespace

// Long: a case for each op.
std::vector<Value> select(Builder &builder, const Node &node, Arguments args,
                          std::span<const Type> types) {
    const bool whole = !types.empty() && (types.back() == Type::Int || types.back() == Type::Bool);
    auto each = [&](Kernel kernel) {
        assert(!whole);
        return by_component(builder, kernel, args);
    };
    auto either = [&](Kernel floats, Kernel ints) {
        return by_component(builder, whole ? ints : floats, args);
    };
    auto together = [&](Kernel kernel) { return builder.outputs(kernel, joined(args)); };
    const std::size_t size = args.empty() ? 0 : args[0].size();

    if (node.op == Op::Sin || node.op == Op::Cos) // the other one is often wanted, too
        return by_component(builder, Kernel::SinCos, args, node.op == Op::Sin ? 0 : 1);
    switch (node.op) {
    case Op::Neg: return either(Kernel::NegF, Kernel::NegI);
    case Op::Add: return either(Kernel::AddF, Kernel::AddI);
    case Op::Sub: return either(Kernel::SubF, Kernel::SubI);
    case Op::Mul: return either(Kernel::MulF, Kernel::MulI);
    case Op::Div: return either(Kernel::DivF, Kernel::DivI);
    case Op::Mod: return either(Kernel::ModF, Kernel::ModI);
    case Op::Min: return either(Kernel::MinF, Kernel::MinI);
    case Op::Max: return either(Kernel::MaxF, Kernel::MaxI);
    case Op::Abs: return either(Kernel::AbsF, Kernel::AbsI);
    case Op::Sign: return either(Kernel::SignF, Kernel::SignI);
    case Op::Clamp: return either(Kernel::ClampF, Kernel::ClampI);
    case Op::Pow: {
        Values out;
        for (std::size_t i = 0; i < size; ++i)
            out.push_back(power(builder, args[0][i], args[1][i]));
        return out;
    }
    case Op::Step: return each(Kernel::StepF);
    case Op::Atan2: return each(Kernel::Atan2F);
    case Op::Floor: return each(Kernel::FloorF);
    case Op::Ceil: return each(Kernel::CeilF);
    case Op::Round: return each(Kernel::RoundF);
    case Op::Trunc: return each(Kernel::TruncF);
    case Op::Fract: return each(Kernel::FractF);
#define FATHOM_FUNCTION(name, ...)                                                                 \
    case Op::name: {                                                                               \
        return each(Kernel::name##F);                                                              \
    }
#include "ir/ops.def"
    case Op::Mix: return each(Kernel::MixF);
    case Op::Smoothstep: return each(Kernel::SmoothstepF);

    case Op::Dot:
        return together(for_size(size, {Kernel::MulF, Kernel::Dot2, Kernel::Dot3, Kernel::Dot4}));
    case Op::Length:
        return together(
            for_size(size, {Kernel::AbsF, Kernel::Length2, Kernel::Length3, Kernel::Length4}));
    case Op::Cross: return together(Kernel::Cross);
    case Op::Normalize:
        return together(for_size(size, {Kernel::Normalize1, Kernel::Normalize2, Kernel::Normalize3,
                                        Kernel::Normalize4}));

    case Op::Less: return either(Kernel::LessF, Kernel::LessI);
    case Op::LessEqual: return either(Kernel::LessEqualF, Kernel::LessEqualI);
    case Op::Equal: return either(Kernel::EqualF, Kernel::EqualI);
    case Op::NotEqual: return either(Kernel::NotEqualF, Kernel::NotEqualI);
    case Op::And: return {builder.make(Kernel::And, {args[0][0], args[1][0]})};
    case Op::Or: return {builder.make(Kernel::Or, {args[0][0], args[1][0]})};
    case Op::Not: return {builder.make(Kernel::Not, {args[0][0]})};
    case Op::Select: {
        Values out;
        for (std::size_t i = 0; i < args[1].size(); ++i)
            out.push_back(choose(builder, args[0][0], args[1][i], args[2][i],
                                 !whole && !(node.type == Type::Hit && i == 1)));
        return out;
    }

    case Op::ToFloat:
        if (!whole) return args[0];
        return {builder.make(Kernel::FloatOfInt, {args[0][0]})};
    case Op::ToInt:
        if (whole) return args[0];
        return {builder.make(Kernel::IntOfFloat, {args[0][0]})};
    case Op::Splat: return Values(static_cast<std::size_t>(components(node.type)), args[0][0]);
    case Op::Make: return joined(args);
    case Op::Swizzle: {
        Values out;
        for (int i = 0; i < swizzle_size(node.payload); ++i)
            out.push_back(args[0][static_cast<std::size_t>(swizzle_component(node.payload, i))]);
        return out;
    }
    case Op::Column: {
        auto n = static_cast<std::size_t>(side(types[0]));
        auto begin = args[0].begin() + static_cast<std::ptrdiff_t>(node.payload * n);
        return {begin, begin + static_cast<std::ptrdiff_t>(n)};
    }
    case Op::MatMul: return multiply(builder, args[0], types[0], args[1], types[1]);
    case Op::Transpose: {
        auto n = static_cast<std::size_t>(side(types[0]));
        Values out;
        for (std::size_t c = 0; c < n; ++c)
            for (std::size_t r = 0; r < n; ++r) out.push_back(args[0][r * n + c]);
        return out;
    }

    case Op::Hash:
        if (whole) return together(Kernel::HashI);
        return together(
            for_size(size, {Kernel::Hash1, Kernel::Hash2, Kernel::Hash3, Kernel::Hash4}));
    case Op::Perlin: return together(Kernel::Perlin);
    case Op::Simplex: return together(Kernel::Simplex);
    case Op::ValueNoise: return together(Kernel::ValueNoise);
    case Op::Worley: return together(Kernel::Worley);
    case Op::SpotNoise: return together(Kernel::SpotNoise);

    case Op::Union: return chain(builder, Kernel::MinF, args);
    case Op::Intersection: return chain(builder, Kernel::MaxF, args);
    case Op::Blend: return blend(builder, static_cast<Profile>(node.payload), args);

    case Op::MakeHit: return joined(args);
    case Op::HitDistance: return {args[0][0]};
    case Op::HitPaint: return {args[0][1]};
    case Op::HitPoint: return {args[0][2], args[0][3], args[0][4]};
    case Op::HitExtra: return {args[0][5], args[0][6], args[0][7], args[0][8]};
    case Op::NearestHit: return nearest(builder, args);
    case Op::FarthestHit: return farthest(builder, args);
    case Op::HitWith: {
        Values out = args[0];
        out[0] = args[1][0];
        return out;
    }
    case Op::FillPaint: {
        Values paint = joined(args.subspan(1));
        paint.insert(paint.begin(), args[0][0]); // its distance, so that both are hits
        return fill_paint(builder, args[0], paint);
    }

    case Op::Const:
    case Op::Point:
    case Op::Normal:
    case Op::Direction:
    case Op::Time:
    case Op::Param:
    case Op::Var:
    case Op::TableRead:
    case Op::Image:
    case Op::Grid:
    case Op::Call:
    case Op::Loop:
    case Op::LoopResult:
    case Op::Cached: break;
    }
    assert(!"build.cpp does these");
    return {};
}

} // namespace fathom::cpu
