// One row for each kernel of kernels.def: what it lies within (ranges.h). A kernel without a row
// here does not compile.
#pragma once

#include "backend-cpu/prune/ranges.h"

namespace fathom::cpu::FATHOM_ISA::range {

using R = Range;

#define FATHOM_RANGE(name, parameters, ...)                                                        \
    struct name##Row {                                                                             \
        static auto run parameters { __VA_ARGS__ }                                                 \
    };

// -- moving
FATHOM_RANGE(CopyF, (R a), return a;)
FATHOM_RANGE(CopyI, (R a), return a;)
// -- floats
FATHOM_RANGE(NegF, (R a), return neg(a);)
FATHOM_RANGE(AddF, (R a, R b), return add(a, b);)
FATHOM_RANGE(SubF, (R a, R b), return sub(a, b);)
FATHOM_RANGE(MulF, (R a, R b), return mul(a, b);)
FATHOM_RANGE(DivF, (R a, R b), return div(a, b);)
FATHOM_RANGE(ModF, (R a, R b), return mod(a, b);)
FATHOM_RANGE(PowF, (R a, R b), return pow(a, b);)
FATHOM_RANGE(MinF, (R a, R b), return minimum(a, b);)
FATHOM_RANGE(MaxF, (R a, R b), return maximum(a, b);)
FATHOM_RANGE(StepF, (R edge, R x),
             return R{x.lo < edge.hi ? 0.0f : 1.0f, x.hi < edge.lo ? 0.0f : 1.0f};)
FATHOM_RANGE(Atan2F, (R y, R x), return atan2(y, x);)
FATHOM_RANGE(AbsF, (R a), return abs(a);)
FATHOM_RANGE(SignF, (R a), return R{sem::sign(a.lo), sem::sign(a.hi)};)
FATHOM_RANGE(FloorF, (R a), return R{std::floor(a.lo), std::floor(a.hi)};)
FATHOM_RANGE(CeilF, (R a), return R{std::ceil(a.lo), std::ceil(a.hi)};)
FATHOM_RANGE(RoundF, (R a), return R{sem::round(a.lo), sem::round(a.hi)};)
FATHOM_RANGE(TruncF, (R a), return R{std::trunc(a.lo), std::trunc(a.hi)};)
FATHOM_RANGE(FractF, (R a), const float n = std::floor(a.lo);
             const bool one = n == std::floor(a.hi);
             return one ? tidy(a.lo - n, a.hi - n) : (size(a) < endless ? R{0, 1} : everything());)
#define FATHOM_FUNCTION(name, function, ...) FATHOM_RANGE(name##F, (R a), return function(a);)
#include "ir/ops.def"
FATHOM_RANGE(SinCos, (R a), return std::array<R, 2>{sin(a), cos(a)};)
FATHOM_RANGE(Power2, (R a), return power<2>(a);)
FATHOM_RANGE(Power3, (R a), return power<3>(a);)
FATHOM_RANGE(Power4, (R a), return power<4>(a);)
FATHOM_RANGE(Power5, (R a), return power<5>(a);)
FATHOM_RANGE(Power6, (R a), return power<6>(a);)
FATHOM_RANGE(Power7, (R a), return power<7>(a);)
FATHOM_RANGE(Power8, (R a), return power<8>(a);)
FATHOM_RANGE(ClampF, (R a, R b, R c),
             return R{sem::clamp(a.lo, b.lo, c.lo), sem::clamp(a.hi, b.hi, c.hi)};)
FATHOM_RANGE(MixF, (R a, R b, R c), return mix(a, b, c);)
FATHOM_RANGE(SmoothstepF, (R a, R b, R c), return smoothstep(a, b, c);)
// -- ints
FATHOM_RANGE(NegI, (R a), return neg(a);)
FATHOM_RANGE(AddI, (R a, R b), return integer(add(a, b));)
FATHOM_RANGE(SubI, (R a, R b), return integer(sub(a, b));)
FATHOM_RANGE(MulI, (R a, R b), return integer(mul(a, b));)
FATHOM_RANGE(DivI, (R a, R b), const R q = div(a, b); const float m = size(a);
             return b.lo > 0 || b.hi < 0 ? integer(std::trunc(q.lo), std::trunc(q.hi))
                                         : integer(-m, m);)
FATHOM_RANGE(ModI, (R a, R b), const float n = std::floor(a.lo / b.lo), m = size(b);
             if (b.lo == b.hi && b.lo > 0 && n == std::floor(a.hi / b.lo) &&
                 size(a) <= whole) return integer(a.lo - n * b.lo, a.hi - n * b.lo);
             return integer(b.lo > 0 ? R{0, m} : hull(R{-m, m}, a));)
FATHOM_RANGE(MinI, (R a, R b), return minimum(a, b);)
FATHOM_RANGE(MaxI, (R a, R b), return maximum(a, b);)
FATHOM_RANGE(AbsI, (R a), return abs(a);)
FATHOM_RANGE(SignI, (R a), return R{sem::sign(a.lo), sem::sign(a.hi)};)
FATHOM_RANGE(ClampI, (R a, R b, R c),
             return R{sem::clamp(a.lo, b.lo, c.lo), sem::clamp(a.hi, b.hi, c.hi)};)
// -- comparison and choice
FATHOM_RANGE(LessF, (R a, R b), return less(a, b);)
FATHOM_RANGE(LessEqualF, (R a, R b), return less_equal(a, b);)
FATHOM_RANGE(EqualF, (R a, R b), return equal(a, b);)
FATHOM_RANGE(NotEqualF, (R a, R b), return opposite(equal(a, b));)
FATHOM_RANGE(LessI, (R a, R b), return less(a, b);)
FATHOM_RANGE(LessEqualI, (R a, R b), return less_equal(a, b);)
FATHOM_RANGE(EqualI, (R a, R b), return equal(a, b);)
FATHOM_RANGE(NotEqualI, (R a, R b), return opposite(equal(a, b));)
FATHOM_RANGE(And, (R a, R b), return minimum(a, b);)
FATHOM_RANGE(Or, (R a, R b), return maximum(a, b);)
FATHOM_RANGE(Not, (R a), return opposite(a);)
FATHOM_RANGE(SelectF, (R c, R a, R b), return select(c, a, b);)
FATHOM_RANGE(SelectI, (R c, R a, R b), return select(c, a, b);)
FATHOM_RANGE(FloatOfInt, (R a), return a;)
FATHOM_RANGE(IntOfFloat, (R a), return integer(std::trunc(a.lo), std::trunc(a.hi));)
// -- vectors
FATHOM_RANGE(Dot2, (R ax, R ay, R bx, R by), return dot(ax, ay, bx, by);)
FATHOM_RANGE(Dot3, (R ax, R ay, R az, R bx, R by, R bz), return dot(ax, ay, az, bx, by, bz);)
FATHOM_RANGE(Dot4, (R ax, R ay, R az, R aw, R bx, R by, R bz, R bw),
             return add(dot(ax, ay, az, bx, by, bz), mul(aw, bw));)
FATHOM_RANGE(Length2, (R x, R y), return length(x, y);)
FATHOM_RANGE(Length3, (R x, R y, R z), return length(x, y, z);)
FATHOM_RANGE(Length4, (R x, R y, R z, R w),
             return sqrt(add(add(add(square(x), square(y)), square(z)), square(w)));)
FATHOM_RANGE(Cross, (R ax, R ay, R az, R bx, R by, R bz),
             return std::array<R, 3>{sub(mul(ay, bz), mul(az, by)), sub(mul(az, bx), mul(ax, bz)),
                                     sub(mul(ax, by), mul(ay, bx))};)
FATHOM_RANGE(Normalize1, (R x), return normalized(x, square(x));)
FATHOM_RANGE(Normalize2, (R x, R y), const R s = add(square(x), square(y));
             return std::array<R, 2>{normalized(x, s), normalized(y, s)};)
FATHOM_RANGE(Normalize3, (R x, R y, R z), const R s = add(add(square(x), square(y)), square(z));
             return std::array<R, 3>{normalized(x, s), normalized(y, s), normalized(z, s)};)
FATHOM_RANGE(Normalize4, (R x, R y, R z, R w),
             const R s = add(add(add(square(x), square(y)), square(z)), square(w));
             return std::array<R, 4>{normalized(x, s), normalized(y, s), normalized(z, s),
                                     normalized(w, s)};)
// -- noise; a hash of numbers that are known is known
FATHOM_RANGE(HashI, (R a), if (!points(a) || size(a) > whole) return R{0, 1};
             const float h = hash<float>(static_cast<I>(a.lo)); return R{h, h};)
FATHOM_RANGE(Hash1, (R x), if (!points(x)) return R{0, 1}; const float h = hash<float>(x.lo);
             return R{h, h};)
FATHOM_RANGE(Hash2, (R x, R y), if (!points(x, y)) return R{0, 1};
             const float h = hash<float>(x.lo, y.lo); return R{h, h};)
FATHOM_RANGE(Hash3, (R x, R y, R z), if (!points(x, y, z)) return R{0, 1};
             const float h = hash<float>(x.lo, y.lo, z.lo); return R{h, h};)
FATHOM_RANGE(Hash4, (R x, R y, R z, R w), if (!points(x, y, z, w)) return R{0, 1};
             const float h = hash<float>(x.lo, y.lo, z.lo, w.lo); return R{h, h};)
FATHOM_RANGE(Perlin, (R x, R y, R z), return noise(x, y, z, -1.05f, 1.05f);)
FATHOM_RANGE(Simplex, (R x, R y, R z), return noise(x, y, z, -1.05f, 1.05f);)
FATHOM_RANGE(ValueNoise, (R x, R y, R z), return noise(x, y, z, -few, 1 + few);)
FATHOM_RANGE(Worley, (R x, R y, R z), return noise(x, y, z, 0, 1);)
FATHOM_RANGE(SpotNoise, (R x, R y, R z, R radius, R density),
             const float maximum = static_cast<float>(1.001 * sem::spot_range) * 8;
             return radius.lo > 1e-3f && size(density) < endless
                        ? noise(div(x, radius), div(y, radius), div(z, radius), -maximum, maximum)
                        : everything();)
// -- blends
FATHOM_RANGE(BlendSmooth, (R a, R b, R r), return blend_smooth(a, b, r);)
FATHOM_RANGE(BlendRound, (R a, R b, R r),
             return blended([](float x, float y, float k) { return sem::blend_round(x, y, k); }, a,
                            b, r);)
FATHOM_RANGE(BlendChamfer, (R a, R b, R r),
             return blended([](float x, float y, float k) { return sem::blend_chamfer(x, y, k); },
                            a, b, r);)
FATHOM_RANGE(BlendStairs, (R a, R b, R r, [[maybe_unused]] R n), // g <= r/2, whatever n
             const R m = minimum(a, b);
             const bool is = apart(a, b, r); const float by = greater(r.hi, 0);
             return is ? m : tidy(m.lo - (0.5f + few) * by - few * sem::abs(m.lo), m.hi);)
FATHOM_RANGE(BlendColumns,
             (R a, R b, R r, [[maybe_unused]] R n), // a column may stand r before them
             const R m = minimum(a, b);
             const float by = (1 + few) * greater(r.hi, 0);
             return tidy(m.lo - by - few * sem::abs(m.lo) - few, m.hi);)
// -- several operations at once
FATHOM_RANGE(MulAdd, (R a, R b, R c), return add(mul(a, b), c);)
FATHOM_RANGE(AbsSub, (R a, R b), return sub(abs(a), b);)
FATHOM_RANGE(MaxAbs, (R a, R b), return maximum(abs(a), abs(b));)
FATHOM_RANGE(Slab, (R lo, R x, R hi), return maximum(sub(lo, x), sub(x, hi));)
FATHOM_RANGE(MinMax, (R a, R b, R c), return minimum(a, maximum(b, c));)
FATHOM_RANGE(MaxMin, (R a, R b, R c), return maximum(a, minimum(b, c));)
FATHOM_RANGE(MaxNeg, (R a, R b), return maximum(a, neg(b));)
FATHOM_RANGE(SubAbs, (R a, R b), return abs(sub(a, b));)
FATHOM_RANGE(LengthPositive3, (R x, R y, R z),
             return length(maximum(x, {0, 0}), maximum(y, {0, 0}), maximum(z, {0, 0}));)
FATHOM_RANGE(Distance3, (R x, R y, R z, R cx, R cy, R cz),
             return length(sub(x, cx), sub(y, cy), sub(z, cz));)
FATHOM_RANGE(Ball, (R x, R y, R z, R cx, R cy, R cz, R r), return ball(x, y, z, cx, cy, cz, r);)
FATHOM_RANGE(MinBall, (R a, R x, R y, R z, R cx, R cy, R cz, R r),
             return minimum(a, ball(x, y, z, cx, cy, cz, r));)
FATHOM_RANGE(SmoothBall, (R a, R x, R y, R z, R cx, R cy, R cz, R r, R k),
             return blend_smooth(a, ball(x, y, z, cx, cy, cz, r), k);)

#undef FATHOM_RANGE

} // namespace fathom::cpu::FATHOM_ISA::range
