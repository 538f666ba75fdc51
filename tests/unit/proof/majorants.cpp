// Quotients by a scale that is carried along (machine_majorants.cpp): in no cell less steep than the
// field is at a point of it, whatever vector and scale are multiplied by.
#include "build.h"

#include "tests/support/effort.h"

#include <catch2/catch.hpp>

#include <random>

using namespace fathom;
using namespace fathom::test;

namespace {

struct Escape {
    Scenery s;
    Graph &g = s.g;
    std::mt19937 random;
    NodeId z = s.p, d = g.number(1);
    NodeId c = s.p;

    double any(double lo, double hi) { return std::uniform_real_distribution(lo, hi)(random); }
    int pick(int n) { return std::uniform_int_distribution(0, n - 1)(random); }
    NodeId n(double x) { return g.number(x); }
    NodeId all(double x) { return g.vec3(x, x, x); }
    NodeId dot(NodeId a, NodeId b) { return g.make(Op::Dot, {a, b}); }
    NodeId some_vector() { return g.vec3(any(-1, 1), any(-1, 1), any(-1, 1)); }

    void fold() {
        const double b = any(0.4, 1.2);
        const NodeId held = g.make(Op::Clamp, {z, all(-b), all(b)});
        if (pick(8) == 0) { // not one by one
            z = g.sub(g.mul(n(2), held), g.swizzle(z, std::array{1, 0, 2}));
            return;
        }
        switch (pick(6)) {
        case 0: z = g.make(Op::Abs, {z}); break;
        case 1: z = g.sub(g.make(Op::Abs, {z}), some_vector()); break;
        case 2: z = g.sub(g.make(Op::Fract, {z}), all(0.5)); break;
        case 3: z = g.make(Op::Max, {g.swizzle(z, std::array{2, 1, 0}), all(-b)}); break;
        case 4: z = g.add(g.sub(z, held), some_vector()); break;
        default: z = g.sub(g.mul(n(2), held), z);
        }
    }
    // A factor by the size of a vector, which is z in most cases.
    NodeId factor() {
        NodeId of = z;
        if (pick(8) == 0) of = g.sub(z, some_vector());
        if (pick(12) == 0) of = s.p;
        const NodeId r2 = pick(12) == 0 ? dot(z, g.swizzle(z, std::array{1, 0, 2})) : dot(of, of);
        const NodeId above = g.make(Op::Max, {r2, n(any(0.05, 0.4))});
        switch (pick(8)) {
        case 0: return g.div(n(any(0.5, 2)), above);
        case 1: return g.make(Op::Clamp, {g.div(n(1), above), n(1), n(4)});
        case 2: return g.make(Op::Max, {g.div(n(any(0.5, 2)), above), n(1)});
        case 3: return g.div(n(1), g.make(Op::Clamp, {r2, n(0.2), n(1)}));
        case 4: return g.div(n(1), g.add(r2, n(any(0.1, 1))));
        case 5: return g.div(n(1), s.call(Op::Sqrt, above));
        case 6: return g.mul(above, n(any(0.2, 1)));
        default: return g.div(n(1), g.mul(above, above));
        }
    }
    void invert() {
        if (pick(3) == 0) { // by `if`
            const NodeId r2 = dot(z, z), inner = g.make(Op::Less, {r2, n(0.25)}),
                         outer = g.make(Op::Less, {r2, n(1)});
            const double other = pick(3) == 0 ? any(1, 8) : 4;
            const NodeId by = pick(4) == 0 ? n(1) : r2;
            const auto chosen = [&](NodeId of, double first, NodeId second) {
                const NodeId over =
                    ir::is_vector(g[of].type) ? g.splat(second, g[of].type) : second;
                const NodeId next = g.make(Op::Select, {outer, g.div(of, over), of});
                return g.make(Op::Select, {inner, g.mul(of, n(first)), next});
            };
            const NodeId turned = chosen(z, 4, r2);
            d = chosen(d, other, by);
            z = turned;
            return;
        }
        const NodeId k = factor();
        if (pick(5) == 0) { // of what is moved
            const NodeId o = some_vector();
            z = g.add(g.mul(g.sub(z, o), k), o);
        } else {
            z = g.mul(z, k);
        }
        switch (pick(8)) {
        case 0: d = g.mul(d, factor()); break;
        case 1: break;
        case 2: d = g.mul(d, s.call(Op::Sqrt, k)); break;
        default: d = g.mul(k, d);
        }
    }
    void move() {
        const double by = std::array{2.0, -1.5, 3.0, 1.2, 1.0}[std::size_t(pick(5))];
        z = g.mul(n(by), z);
        if (pick(3) != 0) z = g.add(z, pick(3) == 0 ? some_vector() : c);
        d = g.mul(d, n(pick(3) == 0 ? any(0.5, 3) : std::fabs(by)));
        if (pick(3) != 0) d = g.add(d, n(pick(3) == 0 ? any(0.1, 2) : 1));
    }
    NodeId field(unsigned seed) {
        random.seed(seed);
        c = pick(2) == 0 ? s.p : g.mul(s.p, n(any(0.5, 3)));
        for (int turns = 1 + pick(4); turns > 0; --turns) {
            if (pick(5) != 0) fold();
            if (pick(5) != 0) invert();
            if (pick(5) != 0) move();
        }
        const NodeId below = pick(3) == 0 ? s.call(Op::Abs, d) : d;
        switch (pick(8)) {
        case 0: return g.div(g.component(z, 1), below);
        case 5: return g.div(g.mul(n(0.25), s.call(Op::Abs, g.component(z, 2))), below);
        case 6: return g.div(g.make(Op::Max, {g.component(z, 0), g.component(z, 1)}), below);
        case 7: return s.length(g.div(s.call(Op::Abs, g.sub(z, some_vector())), below));
        case 1: return g.div(g.sub(s.length(z), n(1)), below);
        case 2: return s.length(g.div(z, below));
        case 3: return g.div(dot(z, some_vector()), below);
        default: return g.div(s.length(z), below);
        }
    }
};

// Without what this test is about, and as if no choice jumped: slopes hold beside borders alone.
proof::Tape without_majorants(proof::Tape tape) {
    for (proof::Instruction &instruction : tape.each) instruction.has_majorant = false;
    tape.has_majorants = false;
    return tape;
}
void join_choices(proof::Tape &tape) {
    for (proof::Instruction &instruction : tape.each) {
        if (instruction.op == Op::Select) instruction.form = proof::Form::Joined;
        instruction.cancels = instruction.cancels || instruction.op == Op::Select;
    }
}

} // namespace

TEST_CASE("no quotient by a scale is steeper than proved, in any cell") {
    int told = 0, cells = 0, fields = 0, points = 0;
    for (int trial = 0; trial < effort(400); ++trial) {
        INFO("trial " << trial);
        Escape e;
        proof::Work work{};
        work.left = 100'000'000;
        proof::Flattening context{e.g, work};
        const NodeId root = e.field(unsigned(trial));
        proof::Tape tape = proof::flatten(context, root);
        if (!tape.has_majorants || tape.too_large) continue;
        join_choices(tape);
        ++fields;
        const proof::Tape other = without_majorants(tape);
        const proof::Ranges ranges = proof::ranges_of(e.s.scene, work);
        proof::Machine without(other, ranges);
        for (int i = 0; i < 24; ++i) {
            const double half = std::pow(10, -e.any(0, 5));
            proof::Cell cell, whole;
            std::array<double, 3> at{};
            for (std::size_t k = 0; k < 3; ++k) {
                at[k] = e.any(-1.5, 1.5);
                cell.p[k] = Interval(at[k] - half, at[k] + half);
            }
            proof::Machine with(tape, ranges); // one anew asks in its first cell
            with.run(cell);
            without.run(cell);
            if (without.norm() == ir::rounding::infinity) continue;
            ++cells;
            told += with.norm() < 0.9 * without.norm();
            const double most = with.norm();
            for (int point = 0; point < 12; ++point) {
                for (std::size_t k = 0; k < 3; ++k)
                    whole.p[k] = at[k] + (point == 0 ? 0 : half * e.any(-1, 1));
                without.run(whole);
                if (without.norm() == ir::rounding::infinity) continue;
                // where a step jumps, as along `fract(p.x + abs(p.x))`, it is both sides' hull
                if (without.value(0).width() > 1e-9 * without.value(0).magnitude()) continue;
                ++points;
                INFO("half a cell of " << half << " at " << whole.p[0].lo << " " << whole.p[1].lo
                                       << " " << whole.p[2].lo);
                CHECK(without.norm() <= most * (1 + 1e-9) + 1e-12);
            }
        }
    }
    CHECK(fields > 100);
    CHECK(told > cells / 8);
    CHECK(points > 8 * cells);
}

TEST_CASE("a scale that is multiplied as the vector is keeps the field flat") {
    // z k + p over d k + 1, n times: the vector's Jacobian is at most the scale
    double bounds[2];
    for (const int turns : {3, 8}) {
        Escape e;
        for (int i = 0; i < turns; ++i) {
            const NodeId held = e.g.make(Op::Clamp, {e.z, e.all(-1), e.all(1)});
            e.z = e.g.sub(e.g.mul(e.n(2), held), e.z);
            const NodeId inverse = e.g.div(e.n(1), e.dot(e.z, e.z));
            const NodeId k = e.g.make(Op::Clamp, {inverse, e.n(1), e.n(4)});
            e.z = e.g.add(e.g.mul(e.g.mul(e.z, k), e.n(2)), e.s.p);
            e.d = e.g.add(e.g.mul(e.g.mul(e.d, k), e.n(2)), e.n(1));
        }
        proof::Work work{};
        work.left = 100'000'000;
        proof::Flattening context{e.g, work};
        const proof::Ranges ranges = proof::ranges_of(e.s.scene, work);
        const proof::Tape tape = proof::flatten(context, e.g.div(e.s.length(e.z), e.d));
        proof::Machine machine(tape, ranges);
        machine.run({{Interval(-1, 1), Interval(-1, 1), Interval(-1, 1)}});
        bounds[turns == 8] = machine.norm();
    }
    CHECK(bounds[0] < 16);
    CHECK(bounds[1] < 16); // by its choices alone it would be 10^10
}
