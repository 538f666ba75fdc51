// Quotients of exponentials (ir/passes/exponential_ratios.h): the same numbers, also where they are
// 0/0 as written, and as steep as is proved.
#include "build.h"
#include "ir/passes/walk.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <functional>

using namespace fathom;
using namespace fathom::test;

namespace {

struct Ratio {
    const char *name;
    std::function<NodeId(Graph &, NodeId x, NodeId y)> node;
    std::function<double(double x, double y)> value;
};
NodeId exp_of(Graph &g, Op op, NodeId u) { return g.make(op, {u}); }

const std::vector<Ratio> ratios{
    {"x/tanh(x)", [](Graph &g, NodeId x, NodeId) { return g.div(x, g.make(Op::Tanh, {x})); },
     [](double x, double) { return x / std::tanh(x); }},
    {"x/(1 - exp(x))",
     [](Graph &g, NodeId x, NodeId) { return g.div(x, g.sub(g.number(1), exp_of(g, Op::Exp, x))); },
     [](double x, double) { return x / (1 - std::exp(x)); }},
    {"-x/(exp2(x/0.3) - 1)",
     [](Graph &g, NodeId x, NodeId) {
         return g.div(g.neg(x), g.sub(exp_of(g, Op::Exp2, g.div(x, g.number(0.3))), g.number(1)));
     },
     [](double x, double) { return -x / (std::exp2(x / 0.3) - 1); }},
    {"x/(1 - exp(-3 x))",
     [](Graph &g, NodeId x, NodeId) {
         const NodeId u = g.mul(g.number(-3), x);
         return g.div(x, g.sub(g.number(1), exp_of(g, Op::Exp, u)));
     },
     [](double x, double) { return x / (1 - std::exp(-3 * x)); }},
    {"a mean by exp(-x/0.2)",
     [](Graph &g, NodeId x, NodeId y) {
         const NodeId k = g.number(0.2), u = exp_of(g, Op::Exp, g.div(g.neg(x), k)),
                      v = exp_of(g, Op::Exp, g.div(g.neg(y), k));
         return g.div(g.add(g.mul(x, u), g.mul(v, y)), g.add(u, v));
     },
     [](double x, double y) {
         const double u = std::exp(-x / 0.2), v = std::exp(-y / 0.2);
         return (x * u + y * v) / (u + v);
     }},
    {"a mean by exp2(4 x)",
     [](Graph &g, NodeId x, NodeId y) {
         const NodeId u = exp_of(g, Op::Exp2, g.mul(g.number(4), x)),
                      v = exp_of(g, Op::Exp2, g.mul(g.number(4), y));
         return g.div(g.add(g.mul(y, v), g.mul(x, u)), g.add(v, u));
     },
     [](double x, double y) {
         const double u = std::exp2(4 * x), v = std::exp2(4 * y);
         return (x * u + y * v) / (u + v);
     }},
};

double value(Graph &g, NodeId p, NodeId node, double x, double y) {
    const NodeId found = ir::substitute(g, node, {{p, g.vec3(x, y, 0)}});
    REQUIRE(g.is_constant(found));
    return g.constant_of(found).value[0];
}

} // namespace

TEST_CASE("quotients of exponentials have the numbers that are written") {
    for (const Ratio &ratio : ratios) {
        INFO(ratio.name);
        Scenery s;
        const NodeId node = ratio.node(s.g, s.g.component(s.p, 0), s.g.component(s.p, 1));
        for (double x = -3; x <= 3; x += 0.37)
            for (double y = -2; y <= 2; y += 0.41)
                CHECK(value(s.g, s.p, node, x, y) == Approx(ratio.value(x, y)).margin(1e-6));
        const double near = ratio.value(1e-5, 0.3);
        CHECK(value(s.g, s.p, node, 0, 0.3) == Approx(near).margin(2e-5));
        CHECK(std::isfinite(value(s.g, s.p, node, 500, -500)));
        CHECK(std::isfinite(value(s.g, s.p, node, -500, 500)));
    }
}

TEST_CASE("quotients of exponentials are as steep as proved, and no steeper") {
    for (const Ratio &ratio : ratios)
        for (const double from : {-30.0, -4.0, -0.6, -0.05, 0.0, 0.03, 0.2, 3.0})
            for (const double width : {0.04, 0.5, 8.0}) {
                INFO(ratio.name << ", " << from << " and " << width << " wide");
                Scenery s;
                constexpr double y = 0.1; // not a number in the graph: its exponential would be one
                const NodeId node = ratio.node(s.g, s.g.component(s.p, 0), s.g.component(s.p, 1));
                proof::Work work;
                proof::Flattening context{s.g, work};
                const proof::Ranges ranges = proof::ranges_of(s.scene, work);
                proof::Domain domain;
                domain.box = {
                    {ir::Interval(from, from + width), ir::Interval(y), ir::Interval(0.0)}};
                const double bound =
                    proof::bound_field(context, ranges, node, domain, {}).lipschitz;
                double seen = 0;
                constexpr int steps = 400;
                for (int i = 0; i < steps; ++i) {
                    const double x = from + width * i / steps, h = width / steps;
                    const double at = value(s.g, s.p, node, x, y);
                    seen = std::max(seen, std::hypot(value(s.g, s.p, node, x + h, y) - at,
                                                     value(s.g, s.p, node, x, y + h) - at) /
                                              h);
                }
                CHECK(seen <= bound * (1 + 1e-6) + 1e-9);
                CHECK(bound <= 1.1 * seen + 0.01);
            }
}
