// What is used twice is written once: functions for shared shapes, with the variables that they
// read as parameters. And the marched field over random trees: safe, equal to what the hit says,
// and verified.
#include "ir/passes/verify.h"
#include "tests/unit/ir/scenes.h"

#include <catch2/catch.hpp>

using namespace fathom;
using namespace fathom::test;

TEST_CASE("doubling thirty times over stays small") {
    const auto doubled = [](int times, std::size_t &size) {
        Builder t;
        ShapeId s = t.add(ShapeKind::Union, {t.sphere(0.5), t.moved(t.box(1, 1, 1), 1, 0, 0),
                                             t.moved(t.sphere(0.3), 0, 1, 0)});
        for (int i = 0; i < times; ++i)
            s = t.add(ShapeKind::Union,
                      {t.moved(s, std::pow(2, i), 0, 0), t.moved(s, -std::pow(2, i), 0, 0)});
        const Scene &scene = t.lowered(s);
        REQUIRE(verify(scene) == "");
        size = t.g.size();
        return scene.graph.function_count();
    };
    std::size_t ten = 0, thirty = 0;
    doubled(10, ten);
    doubled(30, thirty);
    CHECK(thirty < 4 * ten);

    std::size_t size = 0;
    CHECK(doubled(4, size) < 30);
}

TEST_CASE("a shape used once, or cheap, is written where it is used") {
    Builder t;
    const ShapeId ball = t.sphere(0.5);
    t.lowered(t.add(ShapeKind::Union, {t.moved(ball, 1, 0, 0), t.moved(ball, 0, 1, 0),
                                       t.moved(t.box(1, 1, 1), 0, 0, 2)}));
    CHECK(t.scene.graph.function_count() == 3); // distance, hit, background
}

TEST_CASE("functions are named after the library") {
    Builder t;
    Library library;
    library.name = "crate";
    library.has_claims = true;
    t.scene.shapes.libraries.push_back(library);
    const ShapeId crate = t.add(ShapeKind::Library, {t.box(1, 2, 3)});
    t.lowered(t.add(ShapeKind::Union, {t.moved(crate, 1, 0, 0), t.moved(crate, 0, 1, 0)}));
    std::vector<std::string> names;
    for (std::size_t i = 0; i < t.g.function_count(); ++i)
        names.push_back(t.g.function(FunctionId{i}).name);
    CHECK(names.front() == "crate");
}

TEST_CASE("a shared shape takes the variables around it as arguments") {
    Builder t;
    const NodeId id = t.g.fresh_var(Type::Vec3);
    const NodeId size = t.g.add(t.n(0.1), t.g.mul(t.n(0.02), t.g.component(id, 0)));
    const ShapeId pair =
        t.add(ShapeKind::Union, {t.sphere(size), t.moved(t.sphere(size), 0, 0.5, 0),
                                 t.moved(t.sphere(size), 0, -0.5, 0)});
    const ShapeId all = t.lattice(pair, {1, 0, 0}, {5, 1e9, 1e9}, id);
    t.fact(all).repeat.neighbors = {3, 0, 0};
    const Scene &scene = t.lowered(all);
    REQUIRE(verify(scene) == "");
    CHECK(scene.graph.function(FunctionId{std::size_t{0}}).params.size() == 2);
    Reference r(scene);
    for (int i = 0; i < 5; ++i)
        CHECK(r.distance({i - 2.0, 0.5, 0.4}) == Approx(0.4 - (0.1 + 0.02 * i)));
}

TEST_CASE("a function of the user's and a loop inside a shape") {
    Builder t;
    // f(v) = length(v), called; and a loop that sums 4 waves
    const NodeId v = t.g.fresh_var(Type::Vec3);
    const FunctionId f = t.g.add_function({"f", {}, {v}, t.g.make(Op::Length, {v})});
    Loop record;
    record.count = t.g.integer(4);
    record.index = t.g.fresh_var(Type::Int);
    record.vars = {t.g.fresh_var(Type::Float)};
    const NodeId phase =
        t.g.add(t.g.component(t.g.point(), 0), t.g.make(Op::ToFloat, {record.index}));
    record.next = {t.g.add(record.vars[0], t.g.make(Op::Sin, {phase}))};
    record.max_count = 4;
    const NodeId waves = t.g.make(Op::Loop, Type::Float, {t.n(0)}, t.g.add_loop(record).index);
    const ShapeId leaf =
        t.leaf(t.g.add(t.g.call(f, std::array{t.g.point()}), t.g.mul(t.n(0.1), waves)));
    const ShapeId both = t.add(ShapeKind::Union, {leaf, t.moved(leaf, 3, 0, 0)});
    const Scene &scene = t.lowered(both);
    REQUIRE(verify(scene) == "");
    Reference r(scene);
    const auto field = [](P p) {
        double sum = 0;
        for (int i = 0; i < 4; ++i) sum += std::sin(p[0] + i);
        return length(p) + 0.1 * sum;
    };
    Random random;
    for (int i = 0; i < 50; ++i) {
        const P p = random.point(3);
        CHECK(r.distance(p) == Approx(std::min(field(p), field({p[0] - 3, p[1], p[2]}))));
    }
}

TEST_CASE("random trees: steps are safe, hits agree, scenes verify") {
    Random random;
    for (int tree = 0; tree < 40; ++tree) {
        Builder t;
        std::vector<ShapeId> pool;
        for (int i = 0; i < 4; ++i) {
            // Spheres whose fields are steeper or flatter than a distance, and say so.
            const double slope = random.in(0.3, 5);
            const ShapeId ball = t.leaf(t.g.mul(
                t.n(slope), t.g.sub(t.g.make(Op::Length, {t.g.point()}), t.n(random.in(0.3, 1)))));
            t.fact(ball).lipschitz = t.n(slope);
            const ShapeId shown = random.next() < 0.5 ? t.painted(ball, t.v(1, 0, 0)) : ball;
            pool.push_back(t.moved(shown, random.in(-1, 1), random.in(-1, 1), random.in(-1, 1)));
        }
        const auto any = [&] {
            return pool[static_cast<std::size_t>(random.in(0, double(pool.size())))];
        };
        for (int i = 0; i < 8; ++i) {
            const ShapeId a = any(), b = any();
            switch (static_cast<int>(random.in(0, 8))) {
            case 0: pool.push_back(t.add(ShapeKind::Union, {a, b})); break;
            case 1:
                pool.push_back(
                    t.add(ShapeKind::Intersection, {a, t.add(ShapeKind::Complement, {b})}));
                break;
            case 2: pool.push_back(t.add(ShapeKind::Xor, {a, b})); break;
            case 3: {
                const NodeId axis = t.v(random.in(-1, 1), random.in(-1, 1), random.in(-1, 1));
                pool.push_back(t.add(rotated(t.g, a, rotation(t.g, axis, t.n(random.in(0, 6))))));
                break;
            }
            case 4: {
                const double s = random.in(0.5, 2);
                pool.push_back(t.add(scaled(t.g, a, t.v(s, s, -s))));
                break;
            }
            case 5: pool.push_back(t.add(folded(t.g, a, mirror_point(t.g, t.g.point(), 1)))); break;
            case 6:
                pool.push_back(t.within(a, {RegionKind::Ball, t.v(0.2, 0, 0), t.n(1.5), 1, {}}));
                break;
            case 7: pool.push_back(t.painted(a, t.v(0, 1, 0))); break;
            }
            // Raw bounds, as the analysis would have them: max over children, and of
            // factor*L/scale.
            const ShapeId made = pool.back();
            const std::size_t count = t.scene.shapes.size();
            t.fact(made);
            for (std::size_t k = 0; k < count; ++k) {
                ShapeFact &fact = t.scene.facts[k];
                for (ShapeId child : t.scene.shapes[ShapeId{k}].children)
                    fact.lipschitz_sup =
                        std::max(fact.lipschitz_sup,
                                 t.scene.facts[child.index].lipschitz
                                     ? *t.g.as_number(t.scene.facts[child.index].lipschitz)
                                     : t.scene.facts[child.index].lipschitz_sup);
            }
        }
        const Scene &scene = t.lowered(pool.back());
        REQUIRE(verify(scene) == "");
        Reference r(scene);
        for (int i = 0; i < 60; ++i) {
            const P p = random.point(3);
            const double d = r.distance(p);
            CHECK(r.hit(p).distance == Approx(d).margin(1e-12));
            const P u = random.point(1);
            const double step = std::abs(d) * (1 - 1e-9) * random.next() / length(u);
            const double there =
                r.distance({p[0] + step * u[0], p[1] + step * u[1], p[2] + step * u[2]});
            CAPTURE(tree, p[0], p[1], p[2], d);
            CHECK((there < -1e-12  ? -1
                   : there > 1e-12 ? 1
                                   : 0) *
                      (d < 0 ? -1 : 1) >=
                  0); // no surface in between
        }
    }
}

TEST_CASE("verify finds what is broken") {
    Builder t;
    t.lowered(t.sphere(1));
    REQUIRE(verify(t.scene) == "");
    SECTION("a Point in a function") {
        t.scene.distance = t.g.add_function(
            {"d", {}, {t.g.fresh_var(Type::Vec3)}, t.g.make(Op::Length, {t.g.point()})});
        CHECK(verify(t.scene).find("reads Point") != std::string::npos);
    }
    SECTION("a free variable") {
        const NodeId p = t.g.fresh_var(Type::Vec3), q = t.g.fresh_var(Type::Vec3);
        t.scene.distance = t.g.add_function({"d", {}, {p}, t.g.make(Op::Length, {q})});
        CHECK(verify(t.scene).find("free variable") != std::string::npos);
    }
    SECTION("a call of a later function") {
        const NodeId p = t.g.fresh_var(Type::Vec3);
        const FunctionId later{t.g.function_count() + 1};
        const NodeId call = t.g.make(Op::Call, Type::Float, std::array{p}, t.scene.distance.index);
        t.g.add_function({"d", {}, {p}, call});
        CHECK(verify(t.scene) == "");
        t.scene.distance = later;
        CHECK(verify(t.scene) == "no function distance");
    }
    SECTION("a parameter that is not there") {
        const NodeId p = t.g.fresh_var(Type::Vec3);
        t.scene.distance = t.g.add_function({"d", {}, {p}, t.g.param(3, Type::Float)});
        CHECK(verify(t.scene).find("no such parameter") != std::string::npos);
    }
    SECTION("wrong types") {
        const NodeId p = t.g.fresh_var(Type::Vec3);
        const NodeId hash = t.g.make(Op::Perlin, Type::Float, std::array{t.g.component(p, 0)});
        t.scene.distance = t.g.add_function({"d", {}, {p}, hash});
        CHECK(verify(t.scene).find("no vec3") != std::string::npos);
    }
    SECTION("another signature") {
        t.scene.hit = t.scene.distance;
        CHECK(verify(t.scene) == "hit has another signature");
    }
}
