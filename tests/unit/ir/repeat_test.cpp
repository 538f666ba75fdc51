// Repetition and instance_tables against the plain union of all copies.
#include "ir/passes/verify.h"
#include "tests/unit/ir/scenes.h"

#include <catch2/catch.hpp>

using namespace fathom;
using namespace fathom::test;

namespace {

using Copy = std::function<double(P, P)>; // (point in the cell's space, id) -> distance

// The union of the copies, written out.
double brute_lattice(P p, P cell, std::array<int, 3> lo, std::array<int, 3> hi, P shift,
                     bool mirrored, const Copy &f) {
    double minimum = 1e9;
    for (int i = lo[0]; i <= hi[0]; ++i)
        for (int j = lo[1]; j <= hi[1]; ++j)
            for (int k = lo[2]; k <= hi[2]; ++k) {
                const std::array<int, 3> id{i, j, k};
                P q = p;
                for (std::size_t a = 0; a < 3; ++a) {
                    q[a] -= (id[a] - shift[a]) * cell[a];
                    if (mirrored && cell[a] > 0 && id[a] % 2 != 0) q[a] = -q[a];
                }
                minimum = std::min(minimum, f(q, {double(i), double(j), double(k)}));
            }
    return minimum;
}

void plan(Builder &t, ShapeId repeat, std::array<int, 3> neighbors) {
    t.fact(repeat).repeat.neighbors = neighbors;
}

// A motif that fits its cell and lies to one side of it.
ShapeId motif(Builder &t) { return t.moved(t.sphere(0.15), 0.3, 0.1, -0.2); }
double motif_at(P q, P) { return length({q[0] - 0.3, q[1] - 0.1, q[2] + 0.2}) - 0.15; }

void equals(const Scene &scene, double radius, const std::function<double(P)> &expected) {
    REQUIRE(verify(scene) == "");
    Reference reference(scene);
    Random random;
    for (int i = 0; i < 400; ++i) {
        const P p = random.point(radius);
        CAPTURE(p[0], p[1], p[2]);
        CHECK(reference.distance(p) == Approx(expected(p)).margin(1e-9));
        CHECK(reference.hit(p).distance == Approx(expected(p)).margin(1e-9));
    }
}

} // namespace

TEST_CASE("an endless lattice of equal copies: two a axis are exact") {
    for (int neighbors : {2, 3, 4}) {
        Builder t;
        const ShapeId all = t.lattice(motif(t), {1, 1.2, 1}, {1e9, 1e9, 1e9});
        plan(t, all, {neighbors, neighbors, neighbors}); // 8 are written out, 27 and 64 looped over
        equals(t.lowered(all), 3, [](P p) {
            return brute_lattice(p, {1, 1.2, 1}, {-5, -5, -5}, {5, 5, 5}, {0, 0, 0}, false,
                                 motif_at);
        });
    }
}

TEST_CASE("a loop over copies keeps the lowered scene small") {
    const auto size = [](int neighbors) {
        Builder t;
        const ShapeId all = t.lattice(motif(t), {1, 1, 1}, {1e9, 1e9, 1e9});
        plan(t, all, {neighbors, neighbors, neighbors});
        t.lowered(all);
        return t.g.size();
    };
    CHECK(size(9) < size(3) + 20);
}

TEST_CASE("a finite lattice is centred, clamped and leaves other axes alone") {
    for (std::array<int, 3> count : {std::array<int, 3>{3, 0, 4}, {1, 0, 2}, {2, 0, 1}}) {
        Builder t;
        const ShapeId all =
            t.lattice(motif(t), {1, 0, 1.5}, {double(count[0]), 1e9, double(count[2])});
        plan(t, all, {2, 0, 2});
        equals(t.lowered(all), 6, [&](P p) {
            return brute_lattice(p, {1, 0, 1.5}, {0, 0, 0}, {count[0] - 1, 0, count[2] - 1},
                                 {(count[0] - 1) / 2.0, 0, (count[2] - 1) / 2.0}, false, motif_at);
        });
    }
}

TEST_CASE("mirrored repetition reflects every other cell") {
    Builder t;
    const ShapeId all = t.lattice(motif(t), {1, 0, 1}, {1e9, 1e9, 1e9}, {}, true);
    plan(t, all, {2, 0, 2});
    equals(t.lowered(all), 3, [](P p) {
        return brute_lattice(p, {1, 0, 1}, {-5, 0, -5}, {5, 0, 5}, {0, 0, 0}, true, motif_at);
    });
}

TEST_CASE("copies that differ: the guard keeps a bound, and the surface is the union's") {
    for (double n : {1e9, 5.0}) {
        Builder t;
        const NodeId id = t.g.fresh_var(Type::Vec3);
        // radius 0.05 + 0.4*hash(id): between none of its neighbours' sizes
        const NodeId radius = t.g.add(t.n(0.05), t.g.mul(t.n(0.4), t.g.make(Op::Hash, {id})));
        const ShapeId all = t.lattice(t.sphere(radius), {1, 0, 1}, {n, 1e9, n}, id);
        plan(t, all, {2, 0, 2});
        t.fact(all).repeat.guard = true;
        t.fact(all).repeat.copy = {{-0.45, -0.45, -0.45}, {0.45, 0.45, 0.45}};
        const Scene &scene = t.lowered(all);
        REQUIRE(verify(scene) == "");
        Reference reference(scene);
        const auto copy = [](P q, P cell) {
            const Constant value{Type::Vec3, {cell[0], cell[1], cell[2]}};
            const double h = evaluate(Op::Hash, Type::Float, std::span(&value, 1), 0)->value[0];
            return length(q) - (0.05 + 0.4 * h);
        };
        const bool endless = n > 100;
        Random random;
        int exact = 0;
        for (int i = 0; i < 600; ++i) {
            const P p = random.point(3);
            const double truth =
                endless
                    ? brute_lattice(p, {1, 0, 1}, {-6, 0, -6}, {6, 0, 6}, {0, 0, 0}, false, copy)
                    : brute_lattice(p, {1, 0, 1}, {0, 0, 0}, {4, 0, 4}, {2, 0, 2}, false, copy);
            const double d = reference.distance(p);
            CAPTURE(p[0], p[1], p[2]);
            CHECK(d <= truth + 1e-9);
            CHECK((d < 0) == (truth < 0));
            exact += std::abs(d - truth) < 1e-9;
        }
        CHECK(exact > 200); // not merely a bound
        if (!endless) {     // from afar the guard is a box, not a slab: it lets the ray come near
            const P far{0, 40, 0};
            CHECK(reference.distance(far) > 39);
        }
    }
}

TEST_CASE("a guard along one axis leaves walls alone that the own copy just fills") {
    Builder t;
    const ShapeId all =
        t.lattice(t.moved(t.sphere(0.5), 0.3, 0, 0), {1, 0, 1}, {1e9, 1e9, 1e9}, {}, true);
    plan(t, all, {3, 0, 1}); // it reaches over x's wall, and up to z's
    t.fact(all).repeat.guard = true;
    t.fact(all).repeat.copy = {{-0.8, -0.5, -0.500001}, {0.8, 0.5, 0.500001}};
    Reference reference(t.lowered(all));
    Random random;
    for (int i = 0; i < 400; ++i) {
        P p = random.point(3);
        if (i % 2) p[2] = std::round(p[2]) + 0.5;
        const double truth =
            brute_lattice(p, {1, 0, 1}, {-5, 0, -5}, {5, 0, 5}, {0, 0, 0}, true, [](P q, P) {
                return length({q[0] - 0.3, q[1], q[2]}) - 0.5;
            });
        const double d = reference.distance(p);
        CAPTURE(p[0], p[1], p[2]);
        CHECK(d <= truth + 1e-9);
        CHECK(d >= std::min(truth, 0.5) - 1e-9);
    }
}

TEST_CASE("rings of copies") {
    for (int count : {1, 2, 5, 12})
        for (int sectors : {2, 3, 12}) {
            Builder t;
            const NodeId id = t.g.fresh_var(Type::Vec3);
            const ShapeId piece = t.moved(t.sphere(0.2), 1.5, 0.1, -0.15);
            const ShapeId all = t.ring(piece, count, 1, id);
            plan(t, all, {sectors, 0, 0});
            equals(t.lowered(all), 3, [&](P p) {
                double minimum = 1e9;
                for (int k = 0; k < count; ++k) {
                    // the copy turned by a counter-clockwise seen from +y: x to -z
                    const double a = k * 8 * std::atan(1.0) / count;
                    const P c{1.5 * std::cos(a) - 0.15 * std::sin(a), 0.1,
                              -1.5 * std::sin(a) - 0.15 * std::cos(a)};
                    minimum = std::min(minimum, length(minus(p, c)) - 0.2);
                }
                return minimum;
            });
        }
}

TEST_CASE("a ring's copies know their number") {
    Builder t;
    const NodeId id = t.g.fresh_var(Type::Vec3);
    const NodeId radius = t.g.add(t.n(0.1), t.g.mul(t.n(0.05), t.g.component(id, 0)));
    const ShapeId all = t.ring(t.moved(t.sphere(radius), 2, 0, 0), 6, 2, id);
    plan(t, all, {2, 0, 0});
    Reference reference(t.lowered(all));
    for (int k = 0; k < 6; ++k) {
        const double a = k * 8 * std::atan(1.0) / 6;
        CHECK(reference.distance({3 * std::cos(a), 3 * std::sin(a), 0}) ==
              Approx(1 - (0.1 + 0.05 * k)));
    }
}

TEST_CASE("instances: a loop over rows") {
    for (bool smooth : {false, true}) {
        Builder t;
        Table table{6, 4, {}};
        Random random;
        for (int i = 0; i < 24; ++i) table.data.push_back(static_cast<float>(random.in(0.2, 1)));
        const TableId rows = t.g.add_table(table);
        InstanceTable instance_table{t.g.fresh_var(Type::Int), 6, smooth};
        const NodeId center =
            t.g.make(Op::TableRead, Type::Vec3, {instance_table.index}, table_slot(rows, 0));
        const NodeId size =
            t.g.make(Op::TableRead, Type::Float, {instance_table.index}, table_slot(rows, 3));
        const ShapeId ball = t.add(translated(t.g, t.sphere(t.g.mul(size, t.n(0.3))), center));
        t.scene.shapes.instance_tables.push_back(instance_table);
        const ShapeId all =
            t.add(ShapeKind::Instances, {t.painted(ball, t.g.splat(size, Type::Vec3))},
                  smooth ? std::vector{t.n(0.2)} : std::vector<NodeId>{});
        const Scene &scene = t.lowered(all);
        const auto row = [&](int i, std::size_t c) {
            return double(table.data[static_cast<std::size_t>(4 * i) + c]);
        };
        const auto ball_at = [&](P p, int i) {
            return length(minus(p, {row(i, 0), row(i, 1), row(i, 2)})) - 0.3 * row(i, 3);
        };
        equals(scene, 2, [&](P p) {
            double result = 1e9;
            for (int i = 0; i < 6; ++i) {
                const double d = ball_at(p, i), h = std::max(0.2 - std::abs(result - d), 0.0);
                result = std::min(result, d) - (smooth ? h * h / 0.8 : 0);
            }
            return result;
        });
        // The colour is the nearest ball's own.
        Reference reference(scene);
        for (int i = 0; i < 50; ++i) {
            const P p = random.point(2);
            int nearest = 0;
            for (int k = 1; k < 6; ++k)
                if (ball_at(p, k) < ball_at(p, nearest)) nearest = k;
            CHECK(reference.diffuse(p)[0] == Approx(row(nearest, 3)));
        }
    }
}
