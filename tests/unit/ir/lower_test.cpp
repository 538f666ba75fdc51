// What each kind of shape computes, against formulas written another way.
#include "ir/passes/verify.h"
#include "ir/semantics.h"
#include "tests/unit/ir/scenes.h"

#include <catch2/catch.hpp>

using namespace fathom;
using namespace fathom::test;

namespace {

// The lowered distance is `expected` at random points, and hit agrees with it.
void agrees(const Scene &scene, const std::function<double(P)> &expected, double radius = 3) {
    REQUIRE(verify(scene) == "");
    Reference reference(scene);
    Random random;
    for (int i = 0; i < 300; ++i) {
        const P p = random.point(radius);
        CAPTURE(p[0], p[1], p[2]);
        CHECK(reference.distance(p) == Approx(expected(p)).margin(1e-12));
        CHECK(reference.hit(p).distance == Approx(expected(p)).margin(1e-12));
    }
}

const P a_at{0.4, 0.1, -0.2}, b_at{-0.3, 0.5, 0.1};
double a_of(P p) { return length(minus(p, a_at)) - 0.9; }
double b_of(P p) { return box_distance(minus(p, b_at), {1.2, 0.8, 1.4}); }

struct Two : Builder {
    ShapeId a = moved(sphere(0.9), a_at[0], a_at[1], a_at[2]);
    ShapeId b = moved(box(1.2, 0.8, 1.4), b_at[0], b_at[1], b_at[2]);
};

} // namespace

TEST_CASE("combinations") {
    Two t;
    SECTION("empty") {
        agrees(t.lowered(t.add(ShapeKind::Empty, {})), [](P) { return 1e9; });
    }
    SECTION("union") {
        agrees(t.lowered(t.add(ShapeKind::Union, {t.a, t.b})),
               [](P p) { return std::min(a_of(p), b_of(p)); });
    }
    SECTION("difference") {
        const ShapeId not_b = t.add(ShapeKind::Complement, {t.b});
        agrees(t.lowered(t.add(ShapeKind::Intersection, {t.a, not_b})),
               [](P p) { return std::max(a_of(p), -b_of(p)); });
    }
    SECTION("exclusive or") {
        agrees(t.lowered(t.add(ShapeKind::Xor, {t.a, t.b})), [](P p) {
            return std::max(std::min(a_of(p), b_of(p)), -std::max(a_of(p), b_of(p)));
        });
    }
    SECTION("lerp: t of the first") {
        agrees(t.lowered(t.add(ShapeKind::Lerp, {t.a, t.b}, {t.n(0.3)})),
               [](P p) { return 0.3 * a_of(p) + 0.7 * b_of(p); });
    }
    SECTION("offset, shell, displacement") {
        agrees(t.lowered(t.add(ShapeKind::Offset, {t.b}, {t.n(0.2)})),
               [](P p) { return b_of(p) - 0.2; });
        Two u;
        agrees(u.lowered(u.add(ShapeKind::Shell, {u.b}, {u.n(0.2)})),
               [](P p) { return std::abs(b_of(p)) - 0.1; });
        Two w;
        const NodeId wave = w.g.make(Op::Sin, {w.g.component(w.g.point(), 1)});
        agrees(w.lowered(w.add(ShapeKind::Displace, {w.a}, {w.g.mul(w.n(0.1), wave)})),
               [](P p) { return a_of(p) - 0.1 * std::sin(p[1]); });
    }
    SECTION("extrusion") {
        const ShapeId flat = t.circle(0.7);
        agrees(t.lowered(t.add(ShapeKind::Extrude, {flat}, {t.n(1.5)})), [](P p) {
            const double d = std::hypot(p[0], p[1]) - 0.7, h = std::abs(p[2]) - 0.75;
            return std::hypot(std::max(d, 0.0), std::max(h, 0.0)) + std::min(std::max(d, h), 0.0);
        });
    }
}

TEST_CASE("blends are those of blends.h, folded in order") {
    for (int profile = 0; profile < 5; ++profile) {
        Two t;
        const ShapeId c = t.sphere(0.5);
        const ShapeId blend = t.add(ShapeKind::Blend, {t.a, t.b, c}, {t.n(0.4), t.n(3)},
                                    static_cast<std::uint32_t>(profile));
        const auto two = [profile](double x, double y) {
            switch (static_cast<Profile>(profile)) {
            case Profile::Smooth: return sem::blend_smooth(x, y, 0.4);
            case Profile::Round: return sem::blend_round(x, y, 0.4);
            case Profile::Chamfer: return sem::blend_chamfer(x, y, 0.4);
            case Profile::Stairs: return sem::blend_stairs(x, y, 0.4, 3.0);
            case Profile::Columns: return sem::blend_columns(x, y, 0.4, 3.0);
            }
            return 0.0;
        };
        agrees(t.lowered(blend), [&](P p) { return two(two(a_of(p), b_of(p)), length(p) - 0.5); });
    }
}

namespace {

// Seams, as hg_sdf's users know them.
// A pipe of radius r along the line where both surfaces meet. L = sqrt(La^2 + Lb^2).
double seam_pipe(double a, double b, double r) { return std::sqrt(a * a + b * b) - r; }
// a with a V-shaped notch, r deep, where b's surface meets it. L = max(La, Lb); with hg_sdf's
// sqrt(1/2) it would be sqrt 2 times that, for the same contour.
double seam_engrave(double a, double b, double r) {
    return std::max(a, 0.5 * (a + r - std::fabs(b)));
}
// a with a groove `width` wide and `depth` deep, or a tongue as wide and as high, along b's
// surface. L = max(La, Lb).
double seam_groove(double a, double b, double width, double depth) {
    return std::max(a, std::min(a + depth, 0.5 * width - std::fabs(b)));
}
double seam_tongue(double a, double b, double width, double depth) {
    return std::min(a, std::max(a - depth, std::fabs(b) - 0.5 * width));
}

} // namespace

TEST_CASE("seams are those of hg_sdf, and the pseudo-norm that of blends.h") {
    for (int kind = 0; kind < 4; ++kind) {
        Two t;
        const ShapeId seam = t.add(ShapeKind::Seam, {t.a, t.b}, {t.n(0.2), t.n(0.1)},
                                   static_cast<std::uint32_t>(kind));
        agrees(t.lowered(seam), [&](P p) {
            const double a = a_of(p), b = b_of(p);
            switch (static_cast<SeamKind>(kind)) {
            case SeamKind::Pipe: return seam_pipe(a, b, 0.2);
            case SeamKind::Engrave: return seam_engrave(a, b, 0.2);
            case SeamKind::Groove: return seam_groove(a, b, 0.2, 0.1);
            case SeamKind::Tongue: return seam_tongue(a, b, 0.2, 0.1);
            }
            return 0.0;
        });
    }
    Two t;
    agrees(t.lowered(t.add(ShapeKind::PseudoNorm, {t.a, t.b}, {t.n(3)})),
           [](P p) { return sem::pseudonorm(a_of(p), b_of(p), 3.0); });
}

TEST_CASE("maps act on the object") {
    Builder t;
    const ShapeId child = t.moved(t.box(1, 2, 0.5), 0.7, 0, 0);
    const auto f = [](P p) { return box_distance({p[0] - 0.7, p[1], p[2]}, {1, 2, 0.5}); };
    SECTION("a quarter turn about y takes x to -z") {
        const NodeId turn = rotation(t.g, t.v(0, 1, 0), t.n(std::acos(0.0)));
        agrees(t.lowered(t.add(rotated(t.g, child, turn))), [&](P p) {
            return f({-p[2], p[1], p[0]});
        });
    }
    SECTION("euler angles: about x, then y, then z") {
        const double q = std::acos(0.0);
        // x -> (x) x -> (y) -z; y -> z -> x -> y; z -> -y -> -y -> x
        agrees(t.lowered(t.add(rotated(t.g, child, rotation_euler(t.g, t.v(q, q, q))))), [&](P p) {
            return f({-p[2], p[1], p[0]});
        });
    }
    SECTION("orient") {
        const NodeId turn = rotation_between(t.g, t.v(2, 0, 0), t.v(0, 3, 0));
        agrees(t.lowered(t.add(rotated(t.g, child, turn))), [&](P p) {
            return f({p[1], -p[0], p[2]});
        });
        const NodeId back = rotation_between(t.g, t.v(1, 0, 0), t.v(-1, 0, 0));
        Reference reference(t.g);
        const Constant m = reference(back);
        CHECK(m.value[0] == Approx(-1));
        CHECK(m.value[4] * m.value[8] - m.value[5] * m.value[7] ==
              Approx(-1)); // a turn, no reflection
    }
    SECTION("uniform and other scales") {
        agrees(t.lowered(t.add(scaled(t.g, child, t.v(2, 2, 2)))), [&](P p) {
            return 2 * f({p[0] / 2, p[1] / 2, p[2] / 2});
        });
        Builder u;
        const ShapeId same = u.moved(u.box(1, 2, 0.5), 0.7, 0, 0);
        agrees(u.lowered(u.add(scaled(u.g, same, u.v(2, 0.5, -1)))), [&](P p) {
            return 0.5 * f({p[0] / 2, p[1] / 0.5, -p[2]});
        });
    }
    SECTION("twist") {
        agrees(t.lowered(t.add(twisted(t.g, child, t.n(0.8), 1))), [&](P p) {
            const double a = -0.8 * p[1], c = std::cos(a), s = std::sin(a);
            return f({c * p[0] + s * p[2], p[1], -s * p[0] + c * p[2]}); // a turn about y
        });
    }
    SECTION("bend: a straight rod along y curves towards x") {
        agrees(t.lowered(t.add(bent(t.g, child, t.n(0.4), 1, 0))), [&](P p) {
            const double a = 0.4 * p[1];
            return f({std::cos(a) * p[0] - std::sin(a) * p[1],
                      std::sin(a) * p[0] + std::cos(a) * p[1], p[2]});
        });
        Builder u;
        const ShapeId rod = u.box(0.1, 2, 0.1);
        Reference reference(u.lowered(u.add(bent(u.g, rod, u.n(0.4), 1, 0))));
        CHECK(reference.distance({std::tan(0.4 * 0.8) * 0.8, 0.8, 0}) < 0);
        CHECK(reference.distance({-std::tan(0.4 * 0.8) * 0.8, 0.8, 0}) > 0);
    }
    SECTION("taper") {
        agrees(t.lowered(t.add(tapered(t.g, child, t.n(0.25), t.n(-1), t.n(1), 1))), [&](P p) {
            const double c = 1 - 0.75 * std::clamp((p[1] + 1) / 2, 0.0, 1.0);
            return c * f({p[0] / c, p[1], p[2] / c});
        });
    }
    SECTION("mirror, elongate, revolve, distort") {
        agrees(t.lowered(t.add(folded(t.g, child, mirror_point(t.g, t.g.point(), 0)))), [&](P p) {
            return f({std::abs(p[0]), p[1], p[2]});
        });
        Builder u;
        const NodeId q = u.g.sub(
            u.g.point(), u.g.make(Op::Clamp, {u.g.point(), u.v(-0.5, 0, 0), u.v(0.5, 0, 0)}));
        agrees(u.lowered(u.add(folded(u.g, u.sphere(0.5), q))), [](P p) {
            return length({p[0] - std::clamp(p[0], -0.5, 0.5), p[1], p[2]}) - 0.5;
        });
        Builder w;
        agrees(w.lowered(w.add(revolved(w.g, w.circle(0.3), w.n(1)))),
               [](P p) { return std::hypot(std::hypot(p[0], p[2]) - 1, p[1]) - 0.3; });
        Builder d;
        const ShapeId warped = d.add(distorted(d.g, d.sphere(1), d.g.make(Op::Sin, {d.g.point()})));
        d.fact(warped).lipschitz = d.n(2);
        agrees(d.lowered(warped), [](P p) {
            return (length({std::sin(p[0]), std::sin(p[1]), std::sin(p[2])}) - 1) / 2;
        });
    }
}

TEST_CASE("each leaf of the outermost tree is divided by its own bound") {
    Builder t;
    const ShapeId steep =
        t.leaf(t.g.mul(t.n(4), t.g.sub(t.g.make(Op::Length, {t.g.point()}), t.n(1))));
    const ShapeId flat = t.leaf(t.g.mul(t.n(0.5), t.g.component(t.g.point(), 1)));
    const ShapeId grown = t.add(ShapeKind::Offset, {steep}, {t.n(2)}); // takes the raw field
    const ShapeId far = t.moved(grown, 5, 0, 0);
    t.scene.params.push_back({});
    t.scene.params[0].value[0] = 3;
    const NodeId bound = t.g.add(t.g.param(0, Type::Float), t.n(1));
    const ShapeId all = t.add(ShapeKind::Union, {steep, flat, far});
    t.fact(steep).lipschitz = bound;
    t.fact(flat).lipschitz = t.n(0.5);
    t.fact(grown).lipschitz = t.n(4);
    agrees(t.lowered(all), [](P p) {
        const double apart = 4 * (length({p[0] - 5, p[1], p[2]}) - 1) - 2;
        return std::min({length(p) - 1, p[1], apart / 4});
    });
}

TEST_CASE("a guarded shape is never nearer than its box") {
    Builder t;
    const ShapeId weak =
        t.leaf(t.g.mul(t.n(0.1), t.g.sub(t.g.make(Op::Length, {t.g.point()}), t.n(1))));
    t.fact(weak).guard = true;
    t.fact(weak).bounds = {{-1, -1, -1}, {1, 1, 1}};
    agrees(
        t.lowered(weak),
        [](P p) {
            return std::max(0.1 * (length(p) - 1), fathom::test::box_distance(p, {2, 2, 2}));
        },
        5);
}

TEST_CASE("within: the part inside the region, and a bound outside") {
    struct Case {
        Region region;
        std::function<double(P)> distance;
        std::function<P(P)> nearest;
    };
    Builder t;
    const auto clamp3 = [](P p, P lo, P hi) {
        return P{std::clamp(p[0], lo[0], hi[0]), std::clamp(p[1], lo[1], hi[1]),
                 std::clamp(p[2], lo[2], hi[2])};
    };
    const std::vector<Case> cases{
        {{RegionKind::Ball, t.v(0.5, 0, 0), t.n(1.2), 1, {}},
         [](P p) {
             return length(minus(p, {0.5, 0, 0})) - 1.2;
         },
         [](P p) {
             const P v = minus(p, {0.5, 0, 0});
             const double s = std::min(1.0, 1.2 / length(v));
             return P{0.5 + s * v[0], s * v[1], s * v[2]};
         }},
        {{RegionKind::Box, t.v(0, 0.5, 0), t.v(2, 1, 3), 1, {}},
         [](P p) {
             return box_distance(minus(p, {0, 0.5, 0}), {2, 1, 3});
         },
         [&](P p) {
             return clamp3(p, {-1, 0, -1.5}, {1, 1, 1.5});
         }},
        {{RegionKind::Tube, {}, t.n(0.8), 2, {}},
         [](P p) { return std::hypot(p[0], p[1]) - 0.8; },
         [](P p) {
             const double s = std::min(1.0, 0.8 / std::hypot(p[0], p[1]));
             return P{s * p[0], s * p[1], p[2]};
         }},
    };
    const auto f = [](P p) { return std::sin(2 * p[0]) + std::sin(3 * p[1]) + p[2]; };
    const double bound = std::sqrt(4 + 9 + 1);
    for (const Case &c : cases) {
        Builder u;
        u.scene.graph = t.scene.graph;
        const NodeId p = u.g.point();
        const auto wave = [&](double k, int i) {
            return u.g.make(Op::Sin, {u.g.mul(u.n(k), u.g.component(p, i))});
        };
        const ShapeId field = u.leaf(u.g.add(u.g.add(wave(2, 0), wave(3, 1)), u.g.component(p, 2)));
        const ShapeId part = u.within(field, c.region);
        u.fact(field).lipschitz = u.n(bound);
        const auto expected = [&](P at) {
            const double sd = c.distance(at), g = f(sd > 0 ? c.nearest(at) : at) / bound;
            return sd > 0 ? std::hypot(length(minus(at, c.nearest(at))), std::max(g, 0.0))
                          : std::max(g, sd);
        };
        const Scene &scene = u.lowered(part);
        agrees(scene, expected);
        // 1-Lipschitz, inside and out.
        Reference reference(scene);
        Random random{7};
        for (int i = 0; i < 500; ++i) {
            const P a = random.point(2), d = random.point(0.3);
            const P b{a[0] + d[0], a[1] + d[1], a[2] + d[2]};
            CHECK(std::abs(reference.distance(a) - reference.distance(b)) <=
                  length(d) * (1 + 1e-9));
        }
    }
}

TEST_CASE("a carved region removes the solid there, and stays a bound") {
    // The whole ball is solid, less a tube of radius 0.3 about y: outside the tube's wall the
    // distance is known.
    Builder t;
    const ShapeId solid = t.leaf(t.n(-1));
    Region region{RegionKind::Ball, t.v(0, 0, 0), t.n(2), 1, {}};
    region.less.push_back({RegionKind::Tube, {}, t.n(0.3), 1, {}});
    const ShapeId part = t.within(solid, region);
    Reference reference(t.lowered(part));
    Random random;
    for (int i = 0; i < 300; ++i) {
        const P p = random.point(3);
        const double r = std::hypot(p[0], p[2]), d = reference.distance(p);
        CHECK((d < 0) == (length(p) < 2 && r > 0.3));
        if (r < 0.3 && std::abs(p[1]) < 1.9) CHECK(d == Approx(0.3 - r).margin(1e-12));
    }
    CHECK(std::isfinite(reference.distance({0, 0, 0})));
}

TEST_CASE("raw fields do not depend on proofs") {
    // An offset of a part within a region: the surface stays where it is when the bound is proved
    // tighter.
    for (double bound : {1.0, 4.0}) {
        Builder t;
        const NodeId p = t.g.point();
        const ShapeId field = t.leaf(t.g.sub(t.g.make(Op::Length, {p}), t.n(1)));
        const ShapeId part = t.within(field, {RegionKind::Ball, t.v(0, 0, 0), t.n(3), 1, {}});
        const ShapeId grown = t.add(ShapeKind::Offset, {part}, {t.n(0.25)});
        t.fact(field).lipschitz = t.n(bound);
        t.fact(grown).lipschitz = t.n(1);
        Reference reference(t.lowered(grown));
        CHECK(reference.distance({0, 1.5, 0}) == Approx(0.25));
    }
}

TEST_CASE("a displaced shape is left to its smooth field outside the displacement's range") {
    Builder t;
    const NodeId wave =
        t.g.mul(t.n(0.1), t.g.make(Op::Sin, {t.g.mul(t.n(40), t.g.component(t.g.point(), 1))}));
    const ShapeId rough = t.add(ShapeKind::Displace, {t.sphere(1)}, {wave});
    t.fact(rough).lipschitz = t.n(5); // 1 + 0.1*40
    t.fact(rough).outward = 0.1;
    const auto raw = [](P p) { return length(p) - 1 - 0.1 * std::sin(40 * p[1]); };
    agrees(t.lowered(rough), [&](P p) { return std::max(raw(p) / 5, length(p) - 1.1); });
    Reference reference(t.scene);
    Random random;
    for (int i = 0; i < 1000; ++i) {
        const P p = random.point(1.5);
        CHECK((reference.distance(p) < 0) == (raw(p) < 0)); // the same solid
    }
}
