// Bounds that the user states: proved where that can be done, refused where two points are seen
// between which the field is steeper, and assumed otherwise.
#include "compiled.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace fathom;
using namespace fathom::test;

namespace {

driver::Compilation stated(const std::string &field, double bound,
                           const std::string &region = "ball(2)") {
    return compiled(
        fmt::format("implicit(p => {}, within: {}, lipschitz: {})\n", field, region, bound));
}

std::vector<Code> error_codes(const driver::Compilation &c) {
    std::vector<Code> out;
    for (const Diagnostic &d : c.diagnostics.items())
        if (d.severity == Severity::Error) out.push_back(d.code);
    return out;
}

ir::ShapeFact fact(const driver::Compilation &c) {
    return c.scene.facts[c.scene.top_level.at(0).shape.index];
}

// Equal for x > -4 and all numbers, which no rule sees.
const std::string unseen = "0.5 * (if p.y > 0.3 { atan(p.x + 4) } else { pi / 2 - atan(1 / (p.x + "
                           "4)) })";

} // namespace

TEST_CASE("a stated bound is refuted by a jump, however small and wherever it is") {
    for (const std::string jump :
         {"floor(3 * p.x)", "ceil(p.x - 0.3)", "round(p.z)", "fract(2 * p.x)", "trunc(p.x)",
          "(3 * p.y) % 1.3", "sign(p.z - 0.31)", "step(0.3, p.x)", "hash(floor(5 * p.xz))",
          "float(p.x > 1.7)", "(if length(p.xz) < 0.4 { 1 } else { 0 })",
          "(if p.x > 1.5 and p.y > 0.4 { 1 } else { 0 })", "float(int(p.x * 2))"})
        for (const double size : {0.05, 0.005}) {
            INFO(jump << " by " << size);
            CHECK(error_codes(stated(fmt::format("length(p) - 1 + {} * {}", size, jump), 1.5)) ==
                  std::vector<Code>{Code::LipschitzViolated});
        }
    CHECK(error_codes(
              stated("length(p.xz) - 0.5 + 0.002 * atan(p.z, p.x)", 2, "ball(2) - tube(Y, 0.2)")) ==
          std::vector<Code>{Code::LipschitzViolated});
}

TEST_CASE("a stated bound is refuted where the field is smooth and steeper") {
    for (const auto &[field, steep] : std::vector<std::pair<std::string, double>>{
             {"length(p) - 1 + 0.2 * min(1, worley(2 * p))", 1.1},
             {"length(p) - 1", 0.98},
             {"0.1 * sin(12 * p.x) * sin(12 * p.y) * sin(12 * p.z)", 1.15},
             {"p.y - 0.1 * smoothstep(1.4, 1.45, p.x)", 2.5},
             {"length(p) - 1 + 0.3 * noise(2 * p)", 1.2}}) {
        INFO(field);
        CHECK(error_codes(stated(field, steep)) == std::vector<Code>{Code::LipschitzViolated});
    }
}

TEST_CASE("a stated bound is refuted at an end of a param's range") {
    CHECK(error_codes(compiled("param k = 0.5 in 0..3\nimplicit(p => (p.y - k * p.x) + 0 * " +
                               unseen + ", within: ball(2), lipschitz: 2.5)\n")) ==
          std::vector<Code>{Code::LipschitzViolated});
}

TEST_CASE("what is proved to be no steeper than stated is proved") {
    for (const auto &[field, bound, found] : std::vector<std::tuple<std::string, double, double>>{
             {"length(p) - 1", 1, 1},
             {"length(p) - 1", 3, 1},
             {"p.y - 0.5 * sin(2 * p.x)", 1.4142136, 1.4142136},
             {"0.5 * p.y", 4, 1}}) {
        INFO(field);
        const driver::Compilation c = stated(field, bound);
        CHECK(error_codes(c).empty());
        CHECK(fact(c).status == ir::ProofStatus::Proved);
        CHECK(fact(c).lipschitz_sup <= found * (1 + 1e-6));
        CHECK(c.scene.axioms.size() == 0);
    }
}

TEST_CASE("what is neither proved nor refuted is assumed") {
    const driver::Compilation c = stated("length(p) - 1 + " + unseen, 1.5);
    CHECK(error_codes(c).empty());
    CHECK(fact(c).status == ir::ProofStatus::Assumed);
    CHECK(fact(c).lipschitz_sup == Approx(1.5));
    REQUIRE(c.scene.axioms.size() == 1);
    CHECK(c.scene.axioms[0].kind == ir::Axiom::Kind::Assumed);
    // its sides meet, and the rounding of double precision alone is no jump
    for (const std::string meets :
         {"min(0.2, length(fract(p) - 0.5))",
          "mix(hash(floor(p.x)), hash(floor(p.x) + 1), "
          "smoothstep(0, 1, fract(p.x)))",
          "abs(fract(p.x) - 0.5)", "(if p.x > 0.3 { p.x } else { 0.3 })"}) {
        INFO(meets);
        CHECK(error_codes(stated("0.3 * p.y + " + meets + " + 0.01 * " + unseen, 2.2)).empty());
    }
}

// Parts of a field are looked at apart. A loop stands for its first value there, and its others are
// read beside it.
TEST_CASE("a stated bound is looked into where a loop has several values") {
    const driver::Compilation c = compiled(R"(
fn ns(p: vec2) -> float {
  let i = floor(p)
  let f = fract(p)
  let low = mix(hash(i), hash(i + vec2(1, 0)), f.x)
  mix(low, mix(hash(i + vec2(0, 1)), hash(i + vec2(1, 1)), f.x), f.y)
}
fn octave(at: vec2) -> float {
  let uv = vec2(ns(at))
  var wv = 1 - abs(sin(uv))
  wv.x
}
fn waves(p: vec3) -> float {
  var freq = 0.4
  var amp = 0.4
  var uv = vec2(p.x * 0.75, p.z)
  var h = 0.0
  for i in 0..3 {
    let d = octave(uv * freq) + octave(uv + 3)
    h += d * amp
    uv *= 2
    freq *= 1.9
  }
  p.y - h
}
implicit(waves, within: aabb([-1, -1, -1], [1, 1, 1]), lipschitz: 30)
)");
    CHECK(error_codes(c).empty());
    CHECK(fact(c).lipschitz_sup <= 30);
}
