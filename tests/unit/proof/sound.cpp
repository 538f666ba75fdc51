// Families of fields that single rules have got wrong: what jumps, overflows or is no number is
// never bounded, and its neighbours that are continuous are.
#include "build.h"

#include "proof/continuity.h"

#include <catch2/catch.hpp>

using namespace fathom;
using namespace fathom::test;

namespace {

bool bounded(Scenery &s, NodeId field, proof::Cell box = cube(2.3)) {
    return std::isfinite(s.bound(field, box).lipschitz);
}
NodeId fract(Scenery &s, NodeId x) { return s.call(Op::Fract, x); }
NodeId tent(Scenery &s, NodeId x) { return s.call(Op::Abs, s.g.sub(fract(s, x), s.n(0.5))); }
NodeId hash(Scenery &s, NodeId x) { return s.g.make(Op::Hash, Type::Float, {x}); }

} // namespace

TEST_CASE("a number made of a truth jumps where the truth turns") {
    for (int truth = 0; truth < 7; ++truth)
        for (int number = 0; number < 6; ++number) {
            Scenery s;
            const NodeId less = s.g.make(Op::Less, {s.n(0.3), s.x}),
                         other = s.g.make(Op::LessEqual, {s.y, s.x});
            const std::array truths{less,
                                    other,
                                    s.call(Op::Not, less),
                                    s.g.make(Op::And, {less, other}),
                                    s.g.make(Op::Or, {less, other}),
                                    s.g.make(Op::Equal, {s.x, s.n(0.3)}),
                                    s.g.make(Op::Select, {less, other, s.call(Op::Not, other)})};
            const NodeId t = truths[static_cast<std::size_t>(truth)];
            const NodeId as_float = s.g.make(Op::ToFloat, Type::Float, {t});
            const NodeId as_int = s.g.make(Op::ToInt, Type::Int, {t});
            const std::array numbers{
                as_float,
                s.g.make(Op::ToFloat, Type::Float, {as_int}),
                hash(s, as_float),
                s.g.make(Op::Mix, {s.x, s.y, as_float}),
                s.g.mul(s.x, s.g.add(as_float, s.n(1))),
                s.g.make(Op::Perlin, Type::Float, {s.g.add(s.p, s.vec(as_float, s.n(0), s.n(0)))})};
            INFO("truth " << truth << ", number " << number);
            CHECK(!bounded(s, numbers[static_cast<std::size_t>(number)]));
            if (truth != 5) // elsewhere it does not turn
                CHECK(bounded(s, numbers[static_cast<std::size_t>(number)],
                              {{Interval(-2, 0), Interval(0.1, 1), Interval(0, 1)}}));
        }
}

TEST_CASE("a truth that is the same for all points makes no jump") {
    Scenery s;
    const NodeId k = s.parameter(0, 1), on = s.g.make(Op::Less, {s.n(0.5), k});
    CHECK(bounded(s, s.g.mul(s.x, s.g.make(Op::ToFloat, Type::Float, {on}))));
    CHECK(bounded(s, s.g.make(Op::Select, {on, s.x, s.g.add(s.y, s.n(3))})));
}

TEST_CASE("steps that turn at one border are taken together") {
    for (const double shift : {0.0, 1.0, -1.0, 2.0, 0.5}) {
        Scenery s;
        INFO("shift " << shift);
        const NodeId u = s.g.add(s.x, s.n(shift)), f = fract(s, s.x), g = fract(s, u);
        const NodeId i = s.call(Op::Floor, s.x), j = s.call(Op::Floor, u);
        const bool whole = std::floor(shift) == shift;
        CHECK(!bounded(s, s.g.mul(f, fract(s, s.g.add(u, s.n(whole ? 1 : 0))))));
        CHECK(!bounded(s, s.g.mul(s.g.mul(hash(s, i), f), s.g.mul(hash(s, j), g))));
        CHECK(bounded(s, s.g.mul(tent(s, s.x), tent(s, u))));
        CHECK(bounded(s, s.g.mul(f, s.g.sub(s.n(1), f))));
        CHECK(bounded(s, s.g.mul(f, s.g.sub(s.n(1), g))) == whole);
        // noise whose neighbour is asked by another argument
        const NodeId mixed = s.g.make(Op::Mix, {hash(s, i), hash(s, j), f});
        CHECK(bounded(s, mixed) == (shift == 1));
    }
}

TEST_CASE("steps turn together where they round one number, or twice it") {
    Scenery s;
    const auto joined = [&](NodeId a, NodeId b, NodeId part) { // b is a + 1 but for rounding
        return s.g.make(Op::Mix, {hash(s, s.call(Op::Floor, a)), hash(s, s.call(Op::Floor, b)),
                                  fract(s, part)});
    };
    const NodeId one = s.n(1), sum = s.g.add(s.x, s.y);
    CHECK(bounded(s, joined(s.x, s.g.add(s.x, one), s.x)));
    CHECK(bounded(s, joined(s.x, s.g.add(s.x, one), s.g.sub(s.x, s.n(5)))));
    CHECK(bounded(s, joined(sum, s.g.add(sum, one), sum)));
    const NodeId other = s.g.add(s.g.add(s.x, one), s.y); // rounds x + 1 first
    CHECK(!bounded(s, joined(sum, other, sum)));
    CHECK(!bounded(s, joined(sum, s.g.add(sum, one), other)));
    const NodeId k = s.parameter(1, 2), times = s.g.mul(k, s.x);
    const NodeId again = s.g.div(s.x, s.g.div(one, k));
    CHECK(bounded(s, joined(times, s.g.add(times, one), times)));
    CHECK(!bounded(s, joined(times, s.g.add(times, one), again)));
    // the same node in the end
    CHECK(fract(s, s.g.add(s.x, s.n(3))) == fract(s, s.x));
    CHECK(fract(s, s.g.sub(s.x, s.n(0.5))) == fract(s, s.g.add(s.x, s.n(0.5))));
    CHECK(s.call(Op::Floor, s.g.sub(s.x, s.n(2))) == s.g.add(s.call(Op::Floor, s.x), s.n(-2)));
    CHECK(s.call(Op::Floor, s.g.add(s.x, s.n(0.1))) != s.call(Op::Floor, s.x));
}

TEST_CASE("a border has a value of its own") {
    Scenery s;
    const NodeId floor = s.call(Op::Floor, s.x), ceil = s.call(Op::Ceil, s.x);
    CHECK(!bounded(s, s.g.sub(ceil, floor))); // 1, and 0 on the border
    CHECK(!bounded(s, hash(s, s.g.sub(ceil, floor))));
    CHECK(bounded(s, s.g.make(Op::Mix, {hash(s, floor), hash(s, ceil), fract(s, s.x)})));
    CHECK(bounded(s, s.g.mul(s.g.sub(ceil, s.x), s.g.sub(s.x, floor))));
    CHECK(!bounded(s, s.g.add(floor, s.call(Op::Floor, s.g.neg(s.x)))));
}

TEST_CASE("borders that lie on others' are taken one after another") {
    Scenery s;
    const NodeId twice = s.g.mul(s.n(2), s.x);
    const auto noise = [&](NodeId x) {
        const NodeId i = s.call(Op::Floor, x);
        return s.g.make(Op::Mix, {hash(s, i), hash(s, s.g.add(i, s.n(1))), fract(s, x)});
    };
    CHECK(bounded(s, s.g.add(noise(s.x), noise(twice))));
    CHECK(bounded(s, s.g.mul(noise(s.x), noise(twice))));
    CHECK(!bounded(s, s.g.mul(fract(s, s.x), fract(s, twice))));
    CHECK(!bounded(s, s.g.add(fract(s, s.x), s.g.mul(s.n(-1), fract(s, twice)))));
}

TEST_CASE("x^n for whole n of any size is what evaluators make of it") {
    for (const double n : {65.0, 66.0, 101.0, 128.0, 1001.0}) {
        Scenery s;
        INFO("n " << n);
        const proof::Cell box{{Interval(-1.02, 0.5), Interval(0), Interval(0)}};
        const auto b = s.bound(s.g.make(Op::Pow, {s.x, s.n(n)}), box);
        CHECK(b.lipschitz >= n * std::pow(1.02, n - 1));
        CHECK(b.lipschitz <= 1.1 * n * std::pow(1.02, n - 1));
    }
}

TEST_CASE("a smooth minimum has one width") {
    const auto smooth = [](Scenery &s, NodeId k, NodeId other, double least = 1) {
        const NodeId a = s.x, b = s.y, zero = s.n(0);
        const NodeId way = s.call(Op::Abs, s.g.sub(a, b));
        const NodeId h = s.g.make(Op::Max, {s.g.sub(k, way), zero});
        const NodeId below = s.g.mul(s.n(4), s.g.make(Op::Max, {k, other}));
        const NodeId bulge = s.g.div(s.g.mul(h, h), below);
        return least > 0 ? s.g.sub(s.g.make(Op::Min, {a, b}), bulge)
                         : s.g.add(s.g.make(Op::Max, {a, b}), bulge);
    };
    for (const double sign : {1.0, -1.0}) {
        Scenery s;
        CHECK(s.bound(smooth(s, s.n(0.9), s.n(1e-3), sign), cube(2)).lipschitz < 1.01);
        CHECK(s.bound(smooth(s, s.n(0.9), s.parameter(0, 2), sign), cube(2)).lipschitz < 1.01);
        const NodeId read = s.g.mul(s.n(20), s.call(Op::Abs, s.z));
        CHECK(s.bound(smooth(s, s.n(0.9), read, sign), cube(2)).lipschitz > 1.5);
        // a width below 0 is none: the least (greatest) itself
        const auto value = s.bound(smooth(s, s.parameter(-2, -1), s.n(1e-3), sign),
                                   {{Interval(3, 4), Interval(-1, 0), Interval(0)}})
                               .value;
        CHECK(value.contains(sign > 0 ? -0.5 : 3.5));
    }
}

TEST_CASE("what leaves single precision is bounded only where it comes back") {
    Scenery s;
    const NodeId u = s.g.mul(s.n(60), s.x), e = s.call(Op::Exp, u), one = s.n(1);
    CHECK(!bounded(s, s.g.div(e, s.g.add(one, e))));      // infinity over infinity
    CHECK(!bounded(s, s.call(Op::Log, s.g.add(one, e)))); // infinity, where it is 120
    CHECK(!bounded(s, e));
    CHECK(!bounded(s, s.call(Op::Log, s.g.mul(e, s.n(0.5)))));
    CHECK(bounded(s, s.g.div(one, s.g.add(one, e))));
    CHECK(bounded(s, s.call(Op::Log, s.g.add(one, e)), cube(1.4)));
    const NodeId sum = s.g.add(e, s.call(Op::Exp, s.g.mul(s.n(60), s.y)));
    CHECK(s.bound(s.call(Op::Log, sum), cube(4)).lipschitz == Approx(60)); // made without overflow
    CHECK(s.bound(s.call(Op::Log, sum)).lipschitz == Approx(60));
}

TEST_CASE("what holds inf is bounded only where it comes back") {
    Scenery s;
    const NodeId k = s.parameter(0, 4), inf = s.n(ir::rounding::infinity), one = s.n(1);
    const NodeId late = s.g.make(Op::Less, {s.n(2), k});
    const NodeId some = s.g.make(Op::Select, {late, inf, one});
    CHECK(!bounded(s, s.g.add(s.y, s.sin(some)))); // the sine of inf is no number
    CHECK(!bounded(s, s.g.mul(s.y, s.call(Op::Fract, some))));
    const NodeId other = s.g.make(Op::Select, {late, inf, s.n(3)});
    CHECK(!bounded(s, s.g.mul(s.y, s.g.sub(some, other))));
    CHECK(bounded(s, s.g.add(s.y, s.g.div(one, some))));
    CHECK(bounded(s, s.g.make(Op::Min, {s.y, some})));
    CHECK(bounded(s, s.g.mul(s.y, s.g.make(Op::Min, {some, one}))));
    // by the point, it jumps
    const NodeId right = s.g.make(Op::Less, {s.n(0), s.x});
    for (const double limit : {ir::rounding::infinity, -ir::rounding::infinity}) {
        const NodeId arm = s.g.make(Op::Select, {right, s.n(limit), s.y});
        CHECK(!bounded(s, arm));
        CHECK(!bounded(s, s.g.sub(arm, one)));
        CHECK(!bounded(s, s.g.make(Op::Clamp, {arm, s.n(-1), one})));
        CHECK(!bounded(s, s.call(Op::Atan, arm)));
    }
}

TEST_CASE("arms whose factors are no numbers do not agree") {
    Scenery s;
    const auto times = [&](double a, double b, NodeId x) {
        return s.g.mul(s.n(a), s.g.mul(s.n(b), x));
    };
    const NodeId y = s.call(Op::Abs, s.y);
    CHECK(!proof::same(s.g, times(1e200, 1e200, y), times(1e200, 2e200, y)));
    CHECK(proof::same(s.g, times(2, 6, y), times(3, 4, y)));
}

TEST_CASE("sin(u)/u is asked off 0") {
    Scenery s;
    const NodeId u = s.g.mul(s.n(3), s.x), ratio = s.g.div(s.sin(u), u);
    CHECK(s.bound(ratio, cube(2)).lipschitz == Approx(3 * 0.4362).epsilon(0.06));
    const auto at = s.bound(ratio, {{Interval(0), Interval(0), Interval(0)}}).value;
    CHECK(at.lo > 0.99);
    CHECK(at.hi < 1.01);
}

TEST_CASE("copies of a field that is only a bound are held by their boxes") {
    for (const bool exact : {true, false}) {
        Scenery s;
        const ShapeId motif =
            exact ? s.sphere(0.4) : s.add(scaled(s.g, s.sphere(0.4), s.g.vec3(1, 0.5, 0.7)));
        const ShapeId moved = s.add(translated(s.g, motif, s.g.vec3(0.1, 0, 0)));
        Repetition r;
        r.along = {true, false, false};
        s.scene.shapes.repetitions.push_back(r);
        const ShapeId all =
            s.add(ShapeKind::Repeat, {moved}, {s.g.vec3(1.2, 0, 0), s.g.vec3(1e9, 1, 1)}, 0);
        const auto plan = s.prove(all).repeat;
        CHECK(plan.guard == !exact);
        CHECK(plan.hold == !exact);
    }
}

TEST_CASE("a jump is one beside large numbers, too") {
    Scenery s;
    const NodeId large = s.g.mul(s.n(1e13), s.g.make(Op::Pow, {s.y, s.n(6)})),
                 less = s.g.make(Op::Less, {s.x, s.n(0)});
    const proof::Cell box{{Interval(-1, 1), Interval(-1e-3, 1e-3), Interval(0)}};
    CHECK(!bounded(s, s.g.make(Op::Select, {less, s.g.add(large, s.n(5)), large}), box));
    CHECK(bounded(s, s.g.make(Op::Select, {less, s.g.add(large, s.x), large}), box));
}

TEST_CASE("of hashes by sines single precision makes others, so their range alone is known") {
    Scenery s;
    proof::Work work;
    const proof::Ranges ranges = proof::ranges_of(s.scene, work);
    const auto value = [&](NodeId field, double at) {
        proof::Flattening context{s.g, work};
        const proof::Tape tape = proof::flatten(context, field);
        proof::Machine machine(tape, ranges);
        machine.run(proof::Cell{{Interval(at), Interval(0.0), Interval(0.0)}});
        return machine.value(0);
    };
    const NodeId n = s.call(Op::Floor, s.x);
    const auto fract = [&](NodeId of) { return s.call(Op::Fract, of); };
    const NodeId by_sine = fract(s.g.mul(s.sin(s.g.mul(n, s.n(12.9898))), s.n(43758.5453)));
    CHECK(value(by_sine, 7.3) == Interval(0, 1));
    const NodeId again = fract(s.g.mul(fract(s.g.mul(n, s.n(0.1031))), s.n(33.33)));
    CHECK(value(again, 7.3) == Interval(0, 1));
    const NodeId rest = s.g.make(Op::Mod, {s.g.mul(s.sin(n), s.n(43758.5453)), s.n(2)});
    CHECK(value(rest, 7.3) == Interval(0, 2));
    CHECK(value(fract(s.g.mul(n, s.n(0.5))), 7.3).width() < 1e-9); // exact
    CHECK(value(fract(s.sin(s.x)), 0.5).width() < 1e-9);           // moves with the point
}
