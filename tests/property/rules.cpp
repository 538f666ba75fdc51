// Each rule of the analysis in a case where its bound is attained: never exceeded, nearly reached,
// and wrong at once when the rule is halved.
// Long: one table of cases.
#include "build.h"
#include "ir/lower/lower.h"
#include "ir/passes/verify.h"
#include "tests/property/rule_cases.h"
#include "tests/support/reference_eval.h"
#include "tests/support/second_check.h"
#include "tests/support/slopes.h"
#include "tests/support/spans.h"

#include <catch2/catch.hpp>

#include <fmt/format.h>
#include <functional>
#include <iostream>

using namespace fathom;
using namespace fathom::test;
using proof::Rule;

namespace {

// The case as it is marched, with what the rule adds times `factor`; what is proved of it.
double prove(const Case &test, double factor, Scenery &s) {
    ShapeId shape = test.build(s);
    Diagnostics diagnostics;
    proof::Options options;
    options.rules.factor[static_cast<std::size_t>(test.rule)] = factor;
    options.tighten = test.tighten;
    const double proved = s.prove(shape, diagnostics, options).lipschitz_sup;
    INFO(said(diagnostics));
    REQUIRE(!diagnostics.has_errors());
    for (ShapeFact &fact : s.scene.facts) fact.guard = false; // the rule alone
    lower(s.scene);
    REQUIRE(verify(s.scene).empty());
    return proved;
}

Slopes run(const Case &test, double factor, double &proved) {
    Scenery s;
    proved = prove(test, factor, s);
    double r = test.reach;
    return measure(s.scene, {-r, -r, -r}, {r, r, r}, 100'000);
}

ShapeId off_axis(Scenery &s, double x) {
    return s.add(translated(s.g, s.sphere(0.4), s.g.vec3(x, 0, 0)));
}

// Long: the table, a row for each rule.
std::vector<Case> cases() {
    std::vector<Case> out;
    out.push_back({"twist", Rule::Twist,
                   [](Scenery &s) { return s.add(twisted(s.g, off_axis(s, 1), s.n(3), 1)); },
                   0.95});
    out.push_back({"twist of a box", Rule::Twist,
                   [](Scenery &s) { return s.add(twisted(s.g, s.box(1.2, 5, 1.2), s.n(2), 1)); },
                   0.95});
    out.push_back({"taper of a twist of a box", Rule::Twist,
                   [](Scenery &s) {
                       const ShapeId turned = s.add(twisted(s.g, s.box(1.2, 5, 1.2), s.n(2), 1));
                       return s.add(tapered(s.g, turned, s.n(0.95), s.n(-2.5), s.n(2.5), 1));
                   },
                   0.9});
    out.push_back({"bend", Rule::Bend,
                   [](Scenery &s) { return s.add(bent(s.g, off_axis(s, 1), s.n(3), 1, 0)); },
                   0.95});
    out.push_back(
        {"taper", Rule::Taper,
         [](Scenery &s) { return s.add(tapered(s.g, s.sphere(0.5), s.n(0), s.n(-5), s.n(5), 1)); },
         0.9, 6});
    out.push_back({"distort", Rule::Distort,
                   [](Scenery &s) {
                       return s.add(
                           distorted(s.g, s.sphere(1), s.vec(s.g.add(s.x, s.y), s.y, s.z)));
                   },
                   0.95});
    out.push_back({"displace", Rule::Displace,
                   [](Scenery &s) {
                       return s.add(ShapeKind::Displace, {s.sphere(1)},
                                    {s.g.mul(s.n(0.3), s.sin(s.g.mul(s.n(5), s.x)))});
                   },
                   0.95});
    out.push_back({"blend with a varying weight", Rule::LerpVarying,
                   [](Scenery &s) {
                       NodeId t = s.g.add(s.n(0.5), s.g.mul(s.n(0.5), s.sin(s.g.mul(s.n(2), s.x))));
                       return s.add(
                           ShapeKind::Lerp,
                           {s.sphere(1), s.add(translated(s.g, s.sphere(1), s.g.vec3(2, 0, 0)))},
                           {t});
                   },
                   0.9, 6});
    out.push_back({"columns", Rule::Columns,
                   [](Scenery &s) {
                       return s.add(ShapeKind::Blend, {s.sphere(1), s.sphere(1)},
                                    {s.n(0.5), s.n(1)},
                                    static_cast<std::uint32_t>(Profile::Columns));
                   },
                   0.95});
    out.push_back({"pipe", Rule::Pipe,
                   [](Scenery &s) {
                       return s.add(ShapeKind::Seam, {s.sphere(1), s.sphere(1)}, {s.n(0.1)},
                                    static_cast<std::uint32_t>(SeamKind::Pipe));
                   },
                   0.95});
    out.push_back({"pseudo-norm", Rule::PseudoNorm,
                   [](Scenery &s) {
                       return s.add(ShapeKind::PseudoNorm, {s.sphere(1), s.sphere(1)}, {s.n(2)});
                   },
                   0.95});
    out.push_back({"field", Rule::Field,
                   [](Scenery &s) {
                       NodeId q = s.g.mul(s.p, s.n(3));
                       return s.leaf(s.g.make(
                           Op::Dot, {s.sin(q), s.cos(s.g.swizzle(q, std::array{2, 0, 1}))}));
                   },
                   0.85});
    out.push_back({"repeat", Rule::RepeatNeighbors,
                   [](Scenery &s) {
                       Repetition r;
                       r.along = {true, false, false};
                       s.scene.shapes.repetitions.push_back(r);
                       return s.add(ShapeKind::Repeat,
                                    {s.add(translated(s.g, s.sphere(0.15), s.g.vec3(0.3, 0, 0)))},
                                    {s.g.vec3(1, 0, 0), s.g.vec3(1e9, 1, 1)}, 0);
                   },
                   0.95});
    out.push_back(
        {"blend with a weight beyond 1", Rule::LerpWeights,
         [](Scenery &s) {
             return s.add(ShapeKind::Lerp,
                          {s.sphere(0.5), s.add(translated(s.g, s.sphere(0.5), s.g.vec3(2, 0, 0)))},
                          {s.n(2)});
         },
         0.95});
    out.push_back({"a blend whose radius varies", Rule::BlendRadius,
                   [](Scenery &s) {
                       NodeId r = s.g.add(s.n(0.5), s.g.mul(s.n(0.3), s.sin(s.g.mul(s.n(5), s.x))));
                       return s.add(ShapeKind::Blend, {s.sphere(1), s.sphere(1)}, {r, s.n(1)},
                                    static_cast<std::uint32_t>(Profile::Chamfer));
                   },
                   0.9});
    out.push_back({"x*|x|^c", Rule::Field,
                   [](Scenery &s) {
                       NodeId root = s.g.make(Op::Pow, {s.call(Op::Abs, s.x), s.n(0.5)});
                       return s.within(s.leaf(s.g.sub(s.g.mul(s.x, root), s.n(0.2))), s.ball(2));
                   },
                   0.95});
    out.push_back({"a blend by a clamped distance", Rule::LerpVarying,
                   [](Scenery &s) {
                       NodeId t = s.g.make(Op::Clamp, {s.length(s.p), s.n(0), s.n(1)});
                       return s.add(
                           ShapeKind::Lerp,
                           {s.add(translated(s.g, s.sphere(1), s.g.vec3(2, 0, 0))), s.sphere(1)},
                           {t});
                   },
                   0.9});
    out.push_back({"a taper measured whole", Rule::Tightened,
                   [](Scenery &s) {
                       return s.add(tapered(s.g, s.box(2, 1, 2), s.n(0.3), s.n(-0.5), s.n(0.5), 1));
                   },
                   0.75, 3, true});
    out.push_back({"a twist measured whole", Rule::Tightened,
                   [](Scenery &s) {
                       ShapeId tall = s.add(scaled(s.g, s.box(1, 1, 1), s.g.vec3(1, 2, 1)));
                       return s.add(twisted(s.g, tall, s.n(3), 1));
                   },
                   0.8, 3, true});
    // Half the angle from the x axis: near the poles as steep across a ball's border as along it.
    // Its bound in the region is stated, so that the rule for the hole is alone.
    out.push_back({"a raw field in a hole", Rule::Holes,
                   [](Scenery &s) {
                       NodeId off = s.length(s.g.swizzle(s.p, std::array{1, 2}));
                       Shape leaf;
                       leaf.kind = ShapeKind::Leaf;
                       leaf.args = {s.g.mul(s.n(0.5), s.g.make(Op::Atan2, {off, s.x}))};
                       leaf.assumed = 1.01;
                       Region region = s.ball(1);
                       region.less = {s.ball(0.5)};
                       return s.add(ShapeKind::Offset, {s.within(s.add(leaf), region)}, {s.n(0.4)});
                   },
                   0.95});
    out.push_back({"a ring", Rule::Sectors,
                   [](Scenery &s) {
                       Repetition r;
                       r.polar = true;
                       r.axis = 1;
                       s.scene.shapes.repetitions.push_back(r);
                       ShapeId motif = s.add(translated(s.g, s.sphere(0.2), s.g.vec3(1, 0, 0.3)));
                       return s.add(ShapeKind::Repeat, {motif}, {s.g.integer(5)}, 0);
                   },
                   0.95});
    return out;
}

} // namespace

TEST_CASE("no rule is exceeded, each is nearly attained, and none can be halved") {
    for (const Case &test : cases()) {
        SECTION(test.name) {
            double proved = 0, weakened = 0;
            Slopes truth = run(test, 1, proved);
            std::cout << test.name << ": proved " << proved << ", sampled/proved " << truth.steepest
                      << "\n";
            CHECK(truth.unsafe == 0);
            CHECK(truth.steepest <= 1 + 1e-3);
            CHECK(truth.steepest >= test.attained);
            Slopes broken = run(test, 0.5, weakened);
            CHECK((broken.unsafe > 0 || broken.steepest > 1 + 5e-3));
        }
    }
}

// What the second checker is good for: each rule that was weakened is found by it, too.
TEST_CASE("a second checker finds each rule that is halved") {
    constexpr long work = 150'000;
    for (const Case &test : cases()) {
        SECTION(test.name) {
            for (const double factor : {1.0, 0.5}) {
                Scenery s;
                prove(test, factor, s);
                const double r = test.reach;
                const second::Result found =
                    second::slopes(s.scene, s.scene.distance, 0, {-r, -r, -r}, {r, r, r}, work);
                std::cout << test.name << ", rule times " << factor << ": seen " << found.seen
                          << ", at most " << found.at_most << "\n";
                INFO("at [" << found.where[0] << ", " << found.where[1] << ", " << found.where[2]
                            << "]");
                if (factor == 1) CHECK(found.seen <= 1 + 1e-6);
                if (factor < 1) CHECK(found.seen > 1 + 5e-3);
            }
        }
    }
}

// What the marched field takes from elsewhere than the shape's own field: no point of the solid may
// be cut off by it. Against the field itself, which these rules leave as it is.
namespace {

std::vector<Case> cuts() {
    std::vector<Case> out;
    const auto waves = [](Scenery &s, double high, double often) {
        return s.g.mul(s.n(high), s.sin(s.g.mul(s.n(often), s.x)));
    };
    out.push_back({"the range shell", Rule::Shell,
                   [waves](Scenery &s) {
                       return s.add(ShapeKind::Displace, {s.sphere(1)}, {waves(s, 0.3, 5)});
                   },
                   0, 2});
    out.push_back({"nested octaves", Rule::Octaves,
                   [waves](Scenery &s) {
                       NodeId sum = s.g.add(waves(s, 0.2, 5), waves(s, 0.2, 11));
                       return s.add(ShapeKind::Displace, {s.sphere(1)},
                                    {s.g.mul(s.n(0.9), s.g.add(sum, waves(s, 0.1, 50)))});
                   },
                   0, 2});
    out.push_back({"the cylinder about a twist", Rule::Round,
                   [](Scenery &s) { return s.add(twisted(s.g, off_axis(s, 0.8), s.n(2), 1)); }, 0});
    // The surface lies across a hole: asked from the other side, the straight way is the shortest
    // against the one round it.
    out.push_back({"a detour round a hole", Rule::Detour,
                   [](Scenery &s) {
                       NodeId off = s.length(s.g.swizzle(s.p, std::array{1, 2}));
                       NodeId angle = s.g.make(Op::Atan2, {off, s.x});
                       Shape leaf;
                       leaf.kind = ShapeKind::Leaf;
                       leaf.args = {s.g.sub(s.n(1.4), s.g.mul(s.n(0.5), angle))};
                       leaf.assumed = 1.01;
                       Region region = s.ball(1);
                       region.less = {s.ball(0.5)};
                       return s.within(s.add(leaf), region);
                   },
                   0, 0.1, true, 0.55});
    out.push_back({"the cylinder about a bend", Rule::Round,
                   [](Scenery &s) { return s.add(bent(s.g, s.box(0.4, 2, 1), s.n(0.5), 1, 0)); }, 0,
                   2});
    return out;
}

// How many of random balls hold a point of the solid.
int balls_cut(const Case &test, double factor) {
    const auto lowered = [&](Scenery &s, bool plain) {
        ShapeId shape = test.build(s);
        Diagnostics diagnostics;
        proof::Options options;
        options.rules.factor[static_cast<std::size_t>(test.rule)] = factor;
        s.prove(shape, diagnostics, options);
        REQUIRE(!diagnostics.has_errors());
        if (plain)
            for (ShapeFact &fact : s.scene.facts)
                fact.guard = false, fact.outward = std::numeric_limits<double>::infinity();
        lower(s.scene);
        REQUIRE(verify(s.scene).empty());
    };
    Scenery marched, plain;
    lowered(marched, false), lowered(plain, true);
    Sampler distance(marched.scene), field(plain.scene);
    std::vector<Point3> centers, inside;
    const double r = test.reach;
    for (int i = 0; i < 300'000; ++i)
        centers.push_back(distance.in_box({test.x - r, -r, -r}, {test.x + r, r, r}));
    const std::vector<float> radii = distance.values(centers);
    for (std::size_t i = 0; i < centers.size(); ++i)
        inside.push_back(distance.in_ball(centers[i], std::max(radii[i], 0.0f) * 0.9999));
    const std::vector<float> found = field.values(inside);
    int cut = 0;
    for (std::size_t i = 0; i < centers.size(); ++i) cut += radii[i] > 1e-5f && found[i] < -1e-5f;
    return cut;
}

} // namespace

TEST_CASE("nothing of a solid is cut off, and half of what is left for it is too little") {
    for (const Case &test : cuts()) {
        SECTION(test.name) {
            CHECK(balls_cut(test, 1) == 0);
            CHECK(balls_cut(test, 0.5) > 0);
        }
    }
}

// What the rule of curvature adds to the balls: segments that are free by it.
namespace {

std::vector<Case> bends() {
    std::vector<Case> out;
    const auto waves = [](Scenery &s, double high, double often) {
        return s.g.mul(s.n(high), s.sin(s.g.mul(s.n(often), s.x)));
    };
    out.push_back({"waves on a sphere", Rule::Curvature,
                   [waves](Scenery &s) {
                       return s.add(ShapeKind::Displace, {s.sphere(2)}, {waves(s, 0.1, 12)});
                   },
                   0, 2.3});
    out.push_back({"waves on a plane", Rule::Curvature,
                   [waves](Scenery &s) {
                       return s.add(ShapeKind::Displace, {s.leaf(s.y)}, {waves(s, 0.1, 12)});
                   },
                   0, 2.3});
    // The sphere's own, which a displacement by its own height adds little to.
    out.push_back({"a small sphere, hardly displaced", Rule::Curvature,
                   [waves](Scenery &s) {
                       return s.add(ShapeKind::Displace, {s.sphere(0.5)}, {waves(s, 0.005, 6)});
                   },
                   0, 0.9});
    out.push_back({"noise on a rounded box", Rule::Curvature,
                   [](Scenery &s) {
                       NodeId noise = s.call(Op::Perlin, s.g.mul(s.p, s.n(2)));
                       ShapeId box = s.add(ShapeKind::Offset, {s.box(1, 1, 1)}, {s.n(0.5)});
                       return s.add(ShapeKind::Displace, {box}, {s.g.mul(s.n(0.1), noise)});
                   },
                   0, 1.3});
    out.push_back({"waves on what is moved, in a union", Rule::Curvature,
                   [waves](Scenery &s) {
                       ShapeId moved = s.add(translated(s.g, s.sphere(1), s.g.vec3(0.5, 0.2, 0)));
                       ShapeId rough = s.add(ShapeKind::Displace, {moved}, {waves(s, 0.05, 14)});
                       ShapeId turned =
                           s.add(rotated(s.g, rough, rotation(s.g, s.g.vec3(1, 1, 0), s.n(0.7))));
                       return s.add(ShapeKind::Union, {turned, s.box(1, 3, 1)});
                   },
                   0, 2});
    return out;
}

Spans spans_of(const Case &test, double factor) {
    Scenery s;
    ShapeId shape = test.build(s);
    Diagnostics diagnostics;
    proof::Options options;
    options.rules.factor[static_cast<std::size_t>(test.rule)] = factor;
    s.prove(shape, diagnostics, options);
    REQUIRE(!diagnostics.has_errors());
    lower(s.scene);
    REQUIRE(verify(s.scene).empty());
    REQUIRE(s.scene.safe_radius);
    const double r = test.reach;
    return measure_spans(s.scene, {-r, -r, -r}, {r, r, r}, 1'000'000);
}

} // namespace

TEST_CASE("between two samples that reach each other nothing lies, and half a bend is too little") {
    for (const Case &test : bends()) {
        SECTION(test.name) {
            const Spans truth = spans_of(test, 1);
            std::cout << test.name << ": " << truth.tried << " segments by curvature\n";
            CHECK(truth.tried > 1000);
            CHECK(truth.cut == 0);
            CHECK(truth.shorter == 0);
            // noise is nowhere near its bound, which holds for all of its lattices
            if (test.name.find("noise") == std::string::npos) CHECK(spans_of(test, 0.5).cut > 0);
        }
    }
}

// What mirrors, cuts or repeats a field may bend it upward without limit: no safe radius beyond the
// distance.
TEST_CASE("no safe radius by curvature goes through folds and cuts") {
    const auto rough = [](Scenery &s) {
        return s.add(ShapeKind::Displace, {s.sphere(1)},
                     {s.g.mul(s.n(0.1), s.sin(s.g.mul(s.n(9), s.x)))});
    };
    const auto reaches = [](Scenery &s, ShapeId shape) {
        Diagnostics diagnostics;
        s.prove(shape, diagnostics);
        lower(s.scene);
        return static_cast<bool>(s.scene.safe_radius);
    };
    Scenery alone, cut, inverted, sharp, thin;
    CHECK(reaches(alone, rough(alone)));
    CHECK_FALSE(reaches(cut, cut.add(ShapeKind::Intersection, {rough(cut), cut.box(1, 1, 1)})));
    CHECK_FALSE(reaches(inverted, inverted.add(ShapeKind::Complement, {rough(inverted)})));
    // edges that are as sharp as the surface comes, and a middle that it may reach
    const auto waves = [](Scenery &s, ShapeId shape) {
        return s.add(ShapeKind::Displace, {shape},
                     {s.g.mul(s.n(0.1), s.sin(s.g.mul(s.n(9), s.x)))});
    };
    CHECK_FALSE(reaches(sharp, waves(sharp, sharp.box(1, 1, 1))));
    CHECK_FALSE(reaches(thin, waves(thin, thin.sphere(0.1))));
}

TEST_CASE("half of an assumed bound is found out") {
    for (double part : {1.0, 0.5}) {
        Scenery s;
        Shape leaf;
        leaf.kind = ShapeKind::Leaf;
        leaf.args = {s.g.mul(s.n(2), s.sin(s.g.mul(s.n(3), s.x)))}; // as steep as 6, in places
        leaf.assumed = 6 * part;
        Diagnostics diagnostics;
        s.prove(s.add(leaf), diagnostics);
        CHECK(diagnostics.has_errors() == (part < 1));
    }
}

// In double precision: single precision would see little of what is far out.
TEST_CASE("each term of a slope far out is needed") {
    for (const FarCase &test : far_cases()) {
        Scenery s;
        const NodeId field = test.field(s);
        const auto bound = [&](double factor) {
            proof::Work work;
            proof::Flattening context{s.g, work};
            proof::Ranges ranges = proof::ranges_of(s.scene, work);
            ranges.rules.factor[std::size_t(test.rule)] = factor;
            return proof::bound_field(context, ranges, field, {{}, nullptr}, {}).lipschitz;
        };
        Reference reference(s.scene);
        const auto value = [&](double y) {
            reference.point = {0, y, 0};
            return reference.number(field);
        };
        double steepest = 0;
        for (double y = test.from; y < 30 * test.from; y *= 1.001) {
            const double way = 1e-5 * y;
            steepest = std::max(steepest, std::fabs(value(y + way) - value(y)) / way);
        }
        const double proved = bound(1), halved = bound(0.5);
        std::cout << "far out: " << test.name << ": proved " << proved << ", halved " << halved
                  << ", seen " << steepest << "\n";
        INFO(test.name);
        CHECK(proved >= steepest * (1 - 1e-4));
        CHECK(proved <= 2 * steepest);
        CHECK(halved < steepest * (1 - 1e-3));
    }
}

TEST_CASE("each rule has a case of its own") {
    // Those of expressions have theirs in expression_rules.cpp.
    for (std::size_t rule = 0; rule < std::size_t(Rule::Linear); ++rule) {
        std::vector<Case> all = cases();
        for (const std::vector<Case> &more : {cuts(), bends()})
            all.insert(all.end(), more.begin(), more.end());
        INFO("rule " << rule);
        const std::vector<FarCase> far = far_cases();
        const auto is_own = [&](const auto &one) { return std::size_t(one.rule) == rule; };
        CHECK((std::ranges::any_of(all, is_own) || std::ranges::any_of(far, is_own)));
    }
}

// Long: the table, a row for each kind.
TEST_CASE("kinds that must not lengthen, in float32") {
    struct Plain {
        std::string name;
        std::function<ShapeId(Scenery &)> build;
    };
    std::vector<Plain> plain;
    for (int profile = 0; profile < 4; ++profile)
        plain.push_back({fmt::format("profile {}", profile), [profile](Scenery &s) {
                             return s.add(ShapeKind::Blend,
                                          {s.sphere(1), s.add(translated(s.g, s.box(1, 1.5, 1),
                                                                         s.g.vec3(1, 0.3, 0)))},
                                          {s.n(0.5), s.n(3)}, static_cast<std::uint32_t>(profile));
                         }});
    for (int seam = 1; seam < 4; ++seam)
        plain.push_back({fmt::format("seam {}", seam), [seam](Scenery &s) {
                             return s.add(ShapeKind::Seam,
                                          {s.sphere(1), s.add(translated(s.g, s.box(1, 1.5, 1),
                                                                         s.g.vec3(1, 0.3, 0)))},
                                          {s.n(0.2), s.n(0.1)}, static_cast<std::uint32_t>(seam));
                         }});
    plain.push_back({"within", [](Scenery &s) {
                         NodeId f = s.g.sub(s.g.mul(s.x, s.x), s.g.mul(s.n(0.5), s.y));
                         return s.within(s.leaf(f), s.ball(1.5));
                     }});
    plain.push_back({"within, steep in the corners: a bound for each cell", [](Scenery &s) {
                         NodeId xx = s.g.mul(s.x, s.x), yy = s.g.mul(s.y, s.y);
                         NodeId f = s.g.sub(s.g.add(s.g.mul(xx, s.g.mul(xx, xx)), s.g.mul(yy, yy)),
                                            s.g.add(s.n(0.3), s.g.mul(s.z, s.n(0.1))));
                         return s.within(s.leaf(f), s.ball(2));
                     }});
    plain.push_back({"scale by a vector", [](Scenery &s) {
                         return s.add(scaled(s.g, s.box(1, 1, 1), s.g.vec3(0.5, 2, 1)));
                     }});
    plain.push_back({"xor", [](Scenery &s) {
                         return s.add(ShapeKind::Xor, {s.sphere(1), off_axis(s, 0.8)});
                     }});
    plain.push_back({"copies that differ", [](Scenery &s) {
                         Repetition r;
                         r.along = {true, false, true};
                         r.id = s.g.fresh_var(Type::Vec3);
                         s.scene.shapes.repetitions.push_back(r);
                         NodeId h = s.call(Op::Hash, r.id);
                         ShapeId motif = s.add(translated(s.g, s.box(0.4, 1, 0.4),
                                                          s.vec(s.g.mul(s.n(0.2), h), h, s.n(0))));
                         return s.add(ShapeKind::Repeat, {motif},
                                      {s.g.vec3(1, 0, 1), s.g.vec3(1e9, 1, 1e9)}, 0);
                     }});
    plain.push_back(
        {"a wide motif", [](Scenery &s) {
             Repetition r;
             r.along = {true, false, false};
             s.scene.shapes.repetitions.push_back(r);
             ShapeId motif = s.add(
                 rotated(s.g, s.box(3, 0.2, 0.2), rotation(s.g, s.g.vec3(0, 0, 1), s.n(0.5))));
             return s.add(ShapeKind::Repeat, {motif}, {s.g.vec3(1, 0, 0), s.g.vec3(1e9, 1, 1)}, 0);
         }});
    for (int n : {2, 3, 5, 12})
        plain.push_back({fmt::format("a ring of {}", n), [n](Scenery &s) {
                             Repetition r;
                             r.polar = true;
                             r.axis = 1;
                             s.scene.shapes.repetitions.push_back(r);
                             ShapeId motif =
                                 s.add(rotated(s.g, s.box(0.3, 0.5, 0.15),
                                               rotation(s.g, s.g.vec3(0, 1, 0), s.n(0.4))));
                             motif = s.add(translated(s.g, motif, s.g.vec3(1, 0, 0.1)));
                             return s.add(ShapeKind::Repeat, {motif}, {s.g.integer(n)}, 0);
                         }});
    plain.push_back({"a ring of what only bounds", [](Scenery &s) {
                         Repetition r;
                         r.polar = true;
                         r.axis = 2;
                         s.scene.shapes.repetitions.push_back(r);
                         ShapeId motif = s.add(
                             translated(s.g, s.add(scaled(s.g, s.sphere(0.4), s.g.vec3(1, 0.4, 2))),
                                        s.g.vec3(1, 0.2, 0)));
                         return s.add(ShapeKind::Repeat, {motif}, {s.g.integer(7)}, 0);
                     }});
    plain.push_back({"a twist of a union, by moment arm", [](Scenery &s) {
                         ShapeId arm = s.add(rotated(s.g, s.box(0.3, 0.3, 2),
                                                     rotation(s.g, s.g.vec3(1, 1, 0), s.n(0.7))));
                         ShapeId both = s.add(ShapeKind::Union,
                                              {s.add(translated(s.g, arm, s.g.vec3(0.7, 0, 0))),
                                               s.box(0.5, 3, 0.5)});
                         return s.add(twisted(s.g, both, s.n(1.5), 1));
                     }});
    plain.push_back({"a taper of a box", [](Scenery &s) {
                         return s.add(
                             tapered(s.g, s.box(1.2, 5, 1.2), s.n(0.3), s.n(-2.5), s.n(2.5), 1));
                     }});
    for (double off : {0.955, 0.3})
        plain.push_back(
            {fmt::format("a bend of what turns about an axis {} away", off), [off](Scenery &s) {
                 auto flat = [&](double x, double y) {
                     return s.g.make(Op::Make, Type::Vec2, {s.n(x), s.n(y)});
                 };
                 NodeId q = s.g.sub(s.call(Op::Abs, s.g.point(Type::Vec2)), flat(0.8, 0.5));
                 NodeId field = s.g.add(s.length(s.g.make(Op::Max, {q, flat(0, 0)})),
                                        s.g.make(Op::Min, {s.g.make(Op::Max, {s.g.component(q, 0),
                                                                              s.g.component(q, 1)}),
                                                           s.n(0)}));
                 ShapeId rectangle = s.claimed("rectangle", field, flat(-0.8, -0.5), flat(0.8, 0.5),
                                               {NodeId{}, NodeId{}, s.n(0.8)}, 2);
                 return s.add(bent(s.g, s.add(revolved(s.g, rectangle, s.n(off))), s.n(1.2), 1, 2));
             }});
    plain.push_back({"a taper that widens", [](Scenery &s) {
                         return s.add(
                             tapered(s.g, s.box(0.8, 2, 0.8), s.n(1.8), s.n(-1), s.n(1), 1));
                     }});
    plain.push_back({"a taper of a union, longer than its stretch", [](Scenery &s) {
                         ShapeId both =
                             s.add(ShapeKind::Union,
                                   {s.add(translated(s.g, s.sphere(0.5), s.g.vec3(0.6, 1, 0))),
                                    s.box(0.5, 3, 0.9)});
                         return s.add(tapered(s.g, both, s.n(0.4), s.n(-0.5), s.n(1), 1));
                     }});
    plain.push_back(
        {"a taper of a twist of what is extruded", [](Scenery &s) {
             NodeId flat = s.g.point(Type::Vec2);
             ShapeId disc = s.claimed("disc", s.g.sub(s.length(flat), s.n(0.5)),
                                      s.g.vec3(-0.5, -0.5, 0), s.g.vec3(0.5, 0.5, 0), {}, 2);
             Shape extruded;
             extruded.kind = ShapeKind::Extrude;
             extruded.dims = 3;
             extruded.children = {s.add(translated(s.g, disc, s.g.vec(std::array{0.2, 0.0})))};
             extruded.args = {s.n(2)};
             ShapeId turned = s.add(twisted(s.g, s.add(extruded), s.n(1), 2));
             return s.add(tapered(s.g, turned, s.n(0.5), s.n(-1), s.n(1), 2));
         }});
    plain.push_back({"a steep taper of a twist off its axis", [](Scenery &s) {
                         const ShapeId turned = s.add(twisted(s.g, off_axis(s, 0.8), s.n(2), 1));
                         return s.add(tapered(s.g, turned, s.n(0.1), s.n(-0.5), s.n(0.5), 1));
                     }});
    plain.push_back({"octaves of noise on a sphere", [](Scenery &s) {
                         NodeId sum = s.n(0);
                         for (int i = 0; i < 4; ++i) {
                             const double often = std::pow(2.0, i);
                             NodeId noise = s.call(Op::Perlin, s.g.mul(s.p, s.n(2 * often)));
                             sum = s.g.add(sum, s.g.div(noise, s.n(often)));
                         }
                         return s.add(ShapeKind::Displace, {s.sphere(1)}, {s.g.mul(s.n(0.1), sum)});
                     }});
    plain.push_back({"a bend of what only bounds", [](Scenery &s) {
                         ShapeId flat = s.add(scaled(s.g, s.sphere(1), s.g.vec3(1, 0.3, 0.5)));
                         return s.add(bent(s.g, flat, s.n(0.7), 0, 1));
                     }});
    plain.push_back({"a bend of a long box", [](Scenery &s) {
                         return s.add(bent(s.g, s.box(1.2, 5, 1.2), s.n(0.3), 1, 0));
                     }});
    for (const Plain &test : plain) {
        SECTION(test.name) {
            for (bool guards : {false, true}) {
                Scenery s;
                ShapeId shape = test.build(s);
                Diagnostics diagnostics;
                double proved = s.prove(shape, diagnostics).lipschitz_sup;
                INFO(said(diagnostics));
                REQUIRE(!diagnostics.has_errors());
                if (!guards)
                    for (ShapeFact &fact : s.scene.facts) fact.guard = false;
                lower(s.scene);
                Slopes found = measure(s.scene, {-3, -3, -3}, {3, 3, 3}, 100'000);
                if (!guards)
                    std::cout << test.name << ": proved " << proved << ", sampled/proved "
                              << found.steepest << "\n";
                INFO("at " << found.where[0] << " " << found.where[1] << " " << found.where[2]
                           << "; unsafe by " << found.unsafe_by << " from "
                           << found.unsafe_center[0] << " " << found.unsafe_center[1] << " "
                           << found.unsafe_center[2]);
                CHECK(found.unsafe == 0);
                // Lengths by cells are no field: they may jump (lipschitz.md, 6.1).
                if (s.scene.cells.empty()) CHECK(found.steepest <= 1 + 1e-3);
            }
        }
    }
}
