// What a scene rests on: the claims of library shapes that the analysis does not derive by itself.
#include "build.h"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace fathom;
using namespace fathom::test;

namespace {

// A ball whose library shape states that it is its own mirror image across all three planes.
ShapeId ball_at(Scenery &s, const std::string &name, double x, double y, double z) {
    const NodeId q = s.g.sub(s.p, s.g.vec3(x, y, z));
    return s.claimed(name, s.g.sub(s.length(q), s.n(1)), s.g.vec3(-2, -2, -2), s.g.vec3(2, 2, 2));
}

std::vector<std::string> symmetries(const Scene &scene) {
    std::vector<std::string> out;
    for (const Axiom &axiom : scene.axioms)
        if (axiom.says.ends_with(": symmetry")) out.push_back(axiom.says);
    return out;
}

} // namespace

TEST_CASE("a stated symmetry is an axiom where it is not derived, across whichever plane") {
    for (const auto &[x, y, z] : {std::array{0.5, 0.0, 0.0}, {0.0, 0.5, 0.0}, {0.0, 0.0, 0.5}}) {
        Scenery s;
        s.prove(ball_at(s, "beside", x, y, z));
        CHECK(symmetries(s.scene) == std::vector<std::string>{"beside: symmetry"});
    }
}

TEST_CASE("a stated symmetry that the expression shows is no axiom") {
    Scenery s;
    s.prove(ball_at(s, "about the origin", 0, 0, 0));
    CHECK(symmetries(s.scene).empty());
    CHECK(std::ranges::count(s.scene.axioms, "about the origin: exact", &Axiom::says) == 1);
}

TEST_CASE("a stated symmetry is an axiom among others of one scene, below what is made of them") {
    Scenery s;
    const std::vector<ShapeId> balls{ball_at(s, "about the origin", 0, 0, 0),
                                     ball_at(s, "beside", 0.5, 0, 0),
                                     ball_at(s, "above", 0, 0.5, 0)};
    const ShapeId all = s.add(ShapeKind::Union, balls);
    s.prove(s.add(translated(s.g, all, s.g.vec3(1, 2, 3))));
    CHECK(symmetries(s.scene) == std::vector<std::string>{"beside: symmetry", "above: symmetry"});
}

TEST_CASE("one leaf of two library shapes is looked at for each that states its symmetry") {
    Scenery s;
    const ShapeId first = ball_at(s, "beside", 0.5, 0, 0);
    Shape again = s.scene.shapes[first];
    s.scene.shapes.libraries.push_back(s.scene.shapes.libraries[again.payload]);
    s.scene.shapes.libraries.back().name = "the same";
    again.payload = static_cast<std::uint32_t>(s.scene.shapes.libraries.size() - 1);
    s.prove(s.add(ShapeKind::Union, {first, s.add(again)}));
    CHECK(symmetries(s.scene) ==
          std::vector<std::string>{"beside: symmetry", "the same: symmetry"});
}
