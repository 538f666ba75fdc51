// Endless cells (growth.h, machine_far.cpp): products of what grows and what falls faster have slopes
// at all points, which are not exceeded; what only seems to fall has none.
#include "build.h"

#include "proof/growth.h"
#include "tests/support/reference_eval.h"

#include <catch2/catch.hpp>

#include <functional>
#include <random>

using namespace fathom;
using namespace fathom::test;

namespace {

struct Faraway {
    Scenery s;
    Graph &g = s.g;
    NodeId x = s.x, y = s.y, z = s.z;
    NodeId n(double v) { return g.number(v); }
    NodeId square(NodeId v) { return g.make(Op::Dot, {v, v}); }
    NodeId r2() { return square(s.p); }
    NodeId mul(NodeId a, NodeId b) { return g.mul(a, b); }
    NodeId over(NodeId a, NodeId b) { return g.div(a, b); }
    NodeId plus_1(NodeId a) { return g.add(n(1), a); }
    NodeId exp(NodeId a) { return s.call(Op::Exp, a); }
    NodeId falls(NodeId a) { return exp(g.neg(a)); }
    NodeId power(NodeId a, double e) { return g.make(Op::Pow, {a, n(e)}); }
    NodeId xz() { return g.make(Op::Make, Type::Vec2, {x, z}); }
    double bound(NodeId field) { return s.bound(field).lipschitz; }
};

struct FarField {
    const char *name;
    std::function<NodeId(Faraway &)> of;
    double steepest, most; // its slope, and what may be proved
};
const std::vector<FarField> far_fields{
    {"a coordinate in a Gaussian", [](Faraway &b) { return b.mul(b.x, b.falls(b.r2())); }, 1, 1.06},
    {"a coordinate over 1 and its square",
     [](Faraway &b) { return b.over(b.x, b.plus_1(b.mul(b.x, b.x))); }, 1, 1.06},
    {"a square over 1 and all squares",
     [](Faraway &b) { return b.over(b.mul(b.y, b.y), b.plus_1(b.r2())); }, 0.6495, 0.72},
    {"the exponential of a fourth and a sixth power",
     [](Faraway &b) { return b.falls(b.g.add(b.power(b.x, 4), b.power(b.y, 6))); }, 2.14, 2.4},
    {"what waves faster and falls", // sin(x^2) exp(-x^2)
     [](Faraway &b) {
         const NodeId x2 = b.mul(b.x, b.x);
         return b.mul(b.s.sin(x2), b.falls(x2));
     },
     0.59, 0.64},
    {"a product over a sum", // x z / (1 + x^2 + z^2)
     [](Faraway &b) { return b.over(b.mul(b.x, b.z), b.plus_1(b.square(b.xz()))); }, 0.5, 0.7},
    {"a window about a coordinate",
     [](Faraway &b) {
         const NodeId s = b.g.make(Op::Smoothstep, {b.n(1), b.n(2), b.s.length(b.s.p)});
         return b.mul(b.x, b.g.sub(b.n(1), s));
     },
     1.96, 2.1},
    {"a coordinate by the falling length",
     [](Faraway &b) { return b.mul(b.x, b.falls(b.s.length(b.s.p))); }, 1, 1.06},
    {"a power over an exponential",
     [](Faraway &b) { return b.over(b.mul(b.x, b.x), b.plus_1(b.exp(b.s.length(b.s.p)))); }, 0.29,
     0.45},
    {"a height over two coordinates", // y - x exp(-sqrt(x^2 + z^2)): as steep whatever y is
     [](Faraway &b) { return b.g.sub(b.y, b.mul(b.x, b.falls(b.s.length(b.xz())))); }, 1.41, 1.5},
    {"a turn by an angle that falls slowly", // 2 / (1 + r^2)
     [](Faraway &b) {
         const NodeId a = b.over(b.n(2), b.plus_1(b.r2()));
         return b.g.sub(b.mul(b.s.cos(a), b.x), b.mul(b.s.sin(a), b.z));
     },
     1.6, 1.8},
    {"a third power over a square", // all slopes are bounded, and grow no more
     [](Faraway &b) { return b.over(b.power(b.x, 3), b.plus_1(b.r2())); }, 1.29, 12},
};

} // namespace

TEST_CASE("what grows times what falls faster has a slope at all points") {
    for (const auto &[name, of, steepest, most] : far_fields) {
        INFO(name);
        Faraway b;
        const double bound = b.bound(of(b));
        CHECK(bound >= steepest * 0.999);
        CHECK(bound <= most);
    }
}

TEST_CASE("what falls along another axis, too slowly, or jumps far out has none") {
    Faraway b;
    const NodeId one_x = b.plus_1(b.s.call(Op::Abs, b.x)), x2 = b.mul(b.x, b.x);
    const NodeId gauss = b.falls(b.r2());
    for (const NodeId field : {
             b.mul(b.x, b.falls(b.mul(b.y, b.y))),
             b.over(b.mul(x2, x2), b.plus_1(b.r2())),
             b.over(b.mul(b.x, b.y), one_x),
             b.over(b.s.sin(b.power(b.x, 3)), one_x),
             b.mul(b.s.call(Op::Floor, b.x), gauss),
             b.mul(b.s.call(Op::Fract, b.mul(b.x, b.y)), gauss),
             b.over(b.falls(x2), b.g.sub(b.y, b.n(300))),
             b.mul(b.s.call(Op::Log, b.g.sub(b.n(300), b.x)), gauss),
             b.mul(b.s.call(Op::Sqrt, b.g.sub(b.x, b.n(300))), b.over(b.n(1), b.plus_1(b.r2()))),
             b.mul(b.x, b.falls(b.g.sub(x2, b.mul(x2, b.y)))),
         })
        CHECK_FALSE(b.bound(field) < 1e6);
}

TEST_CASE(
    "products that leave single precision where rays go have no bound, though their slope has") {
    Faraway b;
    const NodeId x2 = b.mul(b.x, b.x), x3 = b.mul(x2, b.x), x6 = b.mul(x3, x3), x7 = b.mul(x6, b.x);
    CHECK(b.bound(b.over(x6, b.plus_1(x6))) < 3); // 10^36 at 10^6
    const proof::FieldBound found = b.s.bound(b.over(x7, b.plus_1(b.mul(x7, b.x))));
    CHECK_FALSE(found.lipschitz < 1e6);
    CHECK(found.trouble == proof::Trouble::Overflow);
    CHECK(b.bound(b.over(b.n(1), b.plus_1(b.mul(x7, b.x)))) < 3); // 1 over infinity is 0
}

TEST_CASE("products of powers bound what they are of") {
    using proof::Growth;
    std::mt19937 random(3);
    const auto any = [&](double lo, double hi) {
        return std::uniform_real_distribution(lo, hi)(random);
    };
    const auto value = [](const Growth &a, const std::array<double, 3> &p) {
        double out = a.by;
        for (unsigned set = 1; set < 8; ++set) {
            double size = 1;
            for (unsigned i = 0; i < 3; ++i)
                if (set >> i & 1) size = std::max(size, std::fabs(p[i]));
            out *= std::pow(size, double(a.power[set]) / Growth::unit);
        }
        return out;
    };
    for (int trial = 0; trial < 4000; ++trial) {
        proof::Cell cell;
        unsigned endless = 0;
        for (unsigned i = 0; i < 3; ++i) {
            const double from = any(1, 4);
            cell.p[i] = any(0, 1) < 0.7 ? Interval(from, ir::rounding::infinity) : Interval(-1, 2);
            if (!cell.p[i].finite()) endless |= 1u << i;
        }
        const proof::FarOut out(cell.p);
        REQUIRE(out.holds() == (endless != 0));
        if (endless == 0) continue;
        const auto growth = [&](bool positive) {
            Growth a{any(0.1, 3)};
            for (unsigned set = 1; set < 8; ++set)
                if ((set & ~endless) == 0 && any(0, 1) < 0.4)
                    a.power[set] = int(any(positive ? 0 : -3, 3) * Growth::unit);
            return a;
        };
        const Growth a = growth(false), b = growth(false), c = growth(true), d = growth(true);
        const Growth sum = out.sum(a, b), greater = out.greater(a, b),
                     least = proof::FarOut::least_sum(c, d), power = proof::to_power(a, -1.3, true),
                     falls = out.exponential(c, 0.7, true), rises = out.exponential(c, 0.7, false);
        for (int k = 0; k < 20; ++k) {
            std::array<double, 3> p{};
            const double far = std::pow(10, any(0, 3));
            for (std::size_t i = 0; i < 3; ++i)
                p[i] = cell.p[i].finite() ? any(-1, 2) : cell.p[i].lo + far * any(0, 1) * any(0, 1);
            const double at_a = value(a, p), at_b = value(b, p), at_c = value(c, p);
            constexpr double over = 1 + 1e-9;
            CHECK(at_a <= out.most(a) * over);
            CHECK(at_a * over >= out.least(a));
            if (sum.known()) CHECK(at_a + at_b <= value(sum, p) * over);
            if (greater.known()) CHECK(std::max(at_a, at_b) <= value(greater, p) * over);
            CHECK((at_c + value(d, p)) * over >= value(least, p));
            CHECK(std::pow(at_a, -1.3) <= value(power, p) * over);
            if (falls.known()) CHECK(std::exp(-0.7 * at_c) <= value(falls, p) * over);
            if (rises.by > 0 && at_c < 500) CHECK(std::exp(0.7 * at_c) * over >= value(rises, p));
        }
    }
}

namespace {

struct FarScene : Faraway {
    std::mt19937 &random;
    explicit FarScene(std::mt19937 &dice) : random(dice) {}
    double any(double lo, double hi) { return std::uniform_real_distribution(lo, hi)(random); }
    int one_of(int n) { return int(any(0, n - 1e-9)); }
    NodeId coordinate() { return std::array{x, y, z}[std::size_t(one_of(3))]; }
    NodeId vector() {
        const NodeId moved = g.sub(s.p, g.vec3(any(-1, 1), any(-1, 1), any(-1, 1)));
        return one_of(8) == 0 ? xz() : one_of(2) == 0 ? s.p : moved;
    }
    NodeId size() { // at least 0
        const NodeId u = g.add(mul(n(any(-2, 2)), coordinate()), mul(n(any(-2, 2)), coordinate()));
        NodeId w;
        switch (one_of(12)) {
        case 0: w = power(coordinate(), 4); break;
        case 1: w = s.call(Op::Abs, u); break;
        case 2: w = mul(u, u); break;
        case 3:
        case 4:
        case 5: w = s.length(vector()); break;
        default: w = square(vector());
        }
        if (one_of(4) == 0) w = g.add(w, power(coordinate(), 2 * (1 + one_of(3))));
        return mul(n(any(0.2, 3)), w);
    }
    NodeId grows() {
        const NodeId a = coordinate();
        switch (one_of(8)) {
        case 0: return mul(a, coordinate());
        case 1: return g.sub(mul(a, a), mul(n(any(-2, 2)), coordinate()));
        case 2: return s.length(vector());
        case 3: return power(a, 3);
        case 4: return s.sin(mul(a, coordinate()));
        case 5: return s.call(Op::Log, plus_1(size()));
        default: return g.add(a, n(any(-1, 1)));
        }
    }
    NodeId falling() {
        switch (one_of(7)) {
        case 0: return over(n(1), plus_1(size()));
        case 1: return power(plus_1(size()), any(-3, -0.2));
        case 2: return g.sub(n(1), power(s.call(Op::Tanh, size()), 2));
        case 3: return over(n(1), plus_1(exp(size())));
        case 4: return s.call(Op::InverseSqrt, plus_1(size()));
        default: return falls(size());
        }
    }
    NodeId field() {
        const NodeId a = falling();
        switch (one_of(7)) {
        case 0: return mul(grows(), a);
        case 1: return mul(mul(grows(), grows()), mul(a, falling()));
        case 2: return g.make(Op::Mix, {y, g.sub(s.length(s.p), n(1)), falls(size())});
        case 3: return g.add(mul(grows(), a), mul(grows(), falling()));
        case 4: // a turn that fades
            return g.sub(mul(s.cos(mul(n(any(-3, 3)), a)), x),
                         mul(s.sin(mul(n(any(-3, 3)), a)), z));
        case 5: return s.length(g.add(s.p, mul(g.vec3(any(-1, 1), 1, 0), mul(grows(), a))));
        default: return over(mul(grows(), grows()), plus_1(mul(size(), size())));
        }
    }
};

} // namespace

TEST_CASE("no product of what grows and what falls is steeper than proved, near or far") {
    std::mt19937 random(11);
    int accepted = 0;
    constexpr int trials = 160;
    for (int trial = 0; trial < trials; ++trial) {
        FarScene b(random);
        const NodeId field = b.field();
        const double bound = b.bound(field);
        if (!(bound < 1e6)) continue;
        ++accepted;
        INFO(trial << ": " << bound);
        Reference reference(b.s.scene);
        const auto value = [&](const std::array<double, 3> &at) {
            reference.point = at;
            return reference.number(field);
        };
        for (int k = 0; k < 300; ++k) {
            const double far = k % 2 ? 3 : std::pow(10, b.any(0, 6));
            std::array<double, 3> p{}, q{};
            double way = 0;
            const double apart = std::pow(10, b.any(-4, 0));
            for (std::size_t i = 0; i < 3; ++i) {
                const double scale = b.one_of(3) == 0 ? 1 : far; // near an axis or a plane
                p[i] = b.any(-scale, scale),
                q[i] = p[i] + apart * std::min(scale, 10.0) * b.any(-1, 1);
                way += (q[i] - p[i]) * (q[i] - p[i]);
            }
            const double a = value(p), c = value(q), rounding = 1e-11 * (std::fabs(a) + far);
            CHECK(std::fabs(a - c) <= bound * std::sqrt(way) * (1 + 1e-9) + rounding);
        }
    }
    CHECK(accepted >= trials * 3 / 8); // the others grow along some axis
}
