// Fields that grow along each ray alike (proof/homogeneous.h): told apart from others, and nowhere
// steeper than is found on the faces of a cube.
#include "proof/homogeneous.h"
#include "build.h"
#include "ir/passes/dump.h"
#include "ir/passes/walk.h"

#include <catch2/catch.hpp>

using namespace fathom;
using namespace fathom::test;

namespace {

using Spot = std::array<double, 3>;

// Expressions at random of a degree that is meant, and now and then of another.
struct AlongRays {
    Scenery s;
    Graph &g = s.g;
    proof::Dice dice;
    explicit AlongRays(std::uint64_t seed) : dice{seed} {}

    int pick(int n) { return std::min(n - 1, int(dice.next() * n)); }
    NodeId number() { return g.number(std::round((dice.next() * 4 - 2) * 16) / 16 + 0.03125); }
    NodeId vector(int depth) { // of degree 1
        const int kind = depth <= 0 ? 4 : pick(6);
        if (kind >= 4) return s.p;
        const NodeId of = vector(depth - 1);
        if (kind == 0) return s.call(Op::Abs, of);
        if (kind == 1) return g.mul(of, number());
        if (kind == 2) return g.make(Op::Cross, {of, g.vec3(0.6, 0, 0.8)});
        return g.make(Op::Max, {of, g.vec3(0, 0, 0)});
    }
    NodeId two(Op op, int a, int b, int depth) {
        const NodeId first = scalar(a, depth - 1), second = scalar(b, depth - 1);
        return g.make(op, {first, second});
    }
    NodeId scalar(int degree, int depth) {
        if (pick(40) == 0) degree = pick(3); // a slip
        if (depth <= 0) {
            const NodeId one = g.component(s.p, pick(3));
            return degree == 0 ? number() : degree == 1 ? one : g.mul(one, s.y);
        }
        constexpr Op both[] = {Op::Add, Op::Sub, Op::Min, Op::Max, Op::Mod};
        switch (pick(7)) {
        case 0: return two(both[pick(5)], degree, degree, depth);
        case 1: return g.mul(number(), scalar(degree, depth - 1));
        case 2: return s.call(pick(2) ? Op::Abs : Op::Neg, scalar(degree, depth - 1));
        case 3: { // a choice
            const int of = pick(3);
            const NodeId less = two(pick(2) ? Op::Less : Op::LessEqual, of, of, depth);
            const NodeId a = scalar(degree, depth - 1), b = scalar(degree, depth - 1);
            return g.make(Op::Select, {less, a, b});
        }
        case 4:
            return degree == 0 ? pick(2) ? two(Op::Div, 1, 1, depth) : two(Op::Step, 1, 1, depth)
                               : two(Op::Mul, degree - 1, 1, depth);
        case 5:
            if (degree == 0) {
                constexpr Op any[] = {Op::Sin, Op::Exp, Op::Atan, Op::Floor, Op::Sign, Op::Fract};
                return s.call(any[pick(6)], scalar(0, depth - 1));
            }
            if (degree == 2) {
                const NodeId v = vector(depth - 1), w = vector(depth - 1);
                return g.make(Op::Dot, {v, w});
            }
            return pick(2) ? s.length(vector(depth - 1)) : s.call(Op::Sqrt, scalar(2, depth - 1));
        default: {
            const NodeId a = scalar(degree, depth - 1), b = scalar(degree, depth - 1);
            const NodeId t = scalar(pick(8) ? 0 : 1, depth - 1);
            return g.make(Op::Mix, {a, b, t});
        }
        }
    }
    double value(NodeId field, const Spot &at, double k) {
        const NodeId found =
            ir::substitute(g, field, {{s.p, g.vec3(k * at[0], k * at[1], k * at[2])}});
        return g.as_number(found).value_or(NAN); // of a division by 0
    }
    Spot point() { return {dice.next() * 4 - 2, dice.next() * 4 - 2, dice.next() * 4 - 2}; }
};

} // namespace

TEST_CASE("what is said to grow along each ray alike does so") {
    int told = 0, others = 0, wrong = 0;
    for (std::uint64_t seed = 0; seed < 3000; ++seed) {
        AlongRays m(seed);
        const NodeId field = m.g.add(m.scalar(1, 4), m.g.number(-0.75));
        if (!m.g.reads(field).point) continue;
        bool grows = true;
        for (int i = 0; i < 6; ++i) {
            const Spot a = m.point(), b = m.point(); // whatever is added last
            const double once = m.value(field, a, 1) - m.value(field, b, 1);
            for (const double k : {0.25, 8.0}) { // powers of two: roundings are the same
                const double more = m.value(field, a, k) - m.value(field, b, k);
                const double off = std::fabs(more - k * once);
                grows = grows && !(off > 1e-9 * (1 + std::fabs(more) + std::fabs(k * once)));
            }
        }
        const bool said = proof::is_homogeneous(m.g, field);
        told += said, others += !said;
        if (!said || grows) continue;
        ++wrong;
        INFO(seed << "\n" << ir::dump(m.g, field));
        CHECK(grows);
    }
    CHECK(wrong == 0);
    CHECK(told > 800);
    CHECK(others > 200);
}

TEST_CASE("no field that grows along each ray alike is steeper than proved, anywhere") {
    int proved = 0, less = 0;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        AlongRays m(seed + 10'000);
        const NodeId field = m.scalar(1, 3);
        if (!m.g.reads(field).point || !proof::is_homogeneous(m.g, field)) continue;
        const proof::FieldBound found = m.s.bound(field);
        if (!std::isfinite(found.lipschitz)) continue;
        ++proved;
        less += found.lipschitz < 1.06 * found.sampled;
        double steepest = 0;
        for (int i = 0; i < 300; ++i) {
            const Spot at = m.point();
            const double size = std::pow(10, m.dice.next() * 10 - 5);
            Spot other = at;
            for (double &x : other) x += (m.dice.next() - 0.5) * (i % 3 ? 1e-4 : 1);
            double run = 0;
            for (std::size_t k = 0; k < 3; ++k) run += std::pow(size * (at[k] - other[k]), 2);
            const double rise = m.value(field, at, size) - m.value(field, other, size);
            steepest = std::max(steepest, std::fabs(rise) / std::sqrt(run));
        }
        INFO(seed);
        CHECK(steepest <= found.lipschitz * (1 + 1e-6));
    }
    CHECK(proved > 60);
    CHECK(less > proved / 2);
}

TEST_CASE("blends of norms have the slope of both together") {
    Scenery s;
    Graph &g = s.g;
    const NodeId size = s.call(Op::Abs, s.p);
    const NodeId most =
        g.make(Op::Max, {g.component(size, 0),
                         g.make(Op::Max, {g.component(size, 1), g.component(size, 2)})});
    const NodeId field =
        g.sub(g.sub(g.mul(s.n(1.6), most), g.mul(s.n(0.8), s.length(s.p))), s.n(0.6));
    CHECK(s.bound(field).lipschitz < 1.33); // 1.311 is true, 2.4 are both

    const NodeId moved = ir::substitute(g, field, {{s.p, g.sub(s.p, g.vec3(0.3, -2, 1))}});
    CHECK_FALSE(proof::is_homogeneous(g, moved));
    CHECK(s.bound(moved).lipschitz < 1.33);
}

TEST_CASE("what is added inside, or is no number at the origin, does not grow alike") {
    Scenery s;
    Graph &g = s.g;
    const NodeId size = s.length(s.p);
    const auto is = [&](NodeId field) { return proof::is_homogeneous(g, field); };
    CHECK(is(g.sub(size, s.n(1))));
    CHECK(is(g.add(s.n(1), g.sub(s.n(2), size))));
    CHECK_FALSE(is(g.make(Op::Max, {size, s.n(1)})));
    CHECK(is(g.make(Op::Max, {s.x, s.n(0)})));
    CHECK_FALSE(is(g.mul(size, size)));
    CHECK(is(g.div(g.mul(s.x, s.y), size)));
    CHECK_FALSE(is(g.mul(size, s.sin(s.x))));
    CHECK(is(g.mul(size, s.sin(g.div(s.x, size)))));
    const NodeId four = s.n(4);
    const NodeId sum = g.add({g.make(Op::Pow, {s.x, four}), g.make(Op::Pow, {s.y, four})});
    CHECK(is(g.make(Op::Pow, {sum, s.n(0.25)})));
    CHECK_FALSE(is(g.make(Op::Pow, {sum, s.n(0.2499)})));
    proof::Work work;
    proof::Flattening context{g, work};
    const proof::Ranges ranges = proof::ranges_of(s.scene, work);
    CHECK_FALSE(proof::bound_along_rays(context, ranges, g.div(g.mul(s.x, s.y), size), {}, 100, 0));
    CHECK(proof::bound_along_rays(context, ranges, g.add(size, s.x), {}, 100, 0));
}

TEST_CASE("loops grow along each ray alike as what they carry does") {
    Scenery s;
    Graph &g = s.g;
    // var s = 0; for i { s = max(s, abs(p.x)*i) + by }
    for (const bool grows : {true, false}) {
        Loop loop;
        loop.count = g.integer(5);
        loop.max_count = 5;
        loop.index = g.fresh_var(Type::Int);
        loop.vars = {g.fresh_var(Type::Float)};
        const NodeId turn = g.make(Op::ToFloat, Type::Float, {loop.index});
        const NodeId next = g.make(Op::Max, {loop.vars[0], g.mul(s.call(Op::Abs, s.x), turn)});
        loop.next = {g.add(next, grows ? s.call(Op::Abs, s.y) : s.n(0.5))};
        const NodeId made = g.make(Op::Loop, Type::Float, {s.n(0)}, g.add_loop(loop).index);
        CHECK(proof::is_homogeneous(g, made) == grows);
    }
}
