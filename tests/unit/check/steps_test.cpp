// What people write with `floor`, `fract`, `round` and `%` in fields of their own, in the
// language's words.
#include "driver/compile.h"

#include <catch2/catch.hpp>

using namespace fathom;

namespace {

std::string codes(const std::string &text) {
    std::string out;
    const driver::Compilation c = driver::compile_text("scene.sdf", text, ".", {});
    for (const Diagnostic &d : c.diagnostics.items())
        if (d.severity == Severity::Error) out += std::string(code_name(d.code)) + " ";
    return out;
}

const std::string value_noise = R"(
fn own_noise(p: vec3) -> float {
  let i = floor(p)
  let f = p - i
  let u = f * f * (3 - 2 * f)
  mix(
    mix(mix(hash(i), hash(i + [1, 0, 0]), u.x), mix(hash(i + [0, 1, 0]), hash(i + [1, 1, 0]), u.x), u.y),
    mix(mix(hash(i + Z), hash(i + [1, 0, 1]), u.x), mix(hash(i + [0, 1, 1]), hash(i + [1, 1, 1]), u.x), u.y),
    u.z)
}
)";

} // namespace

TEST_CASE("repetition and noise by hand are proved continuous") {
    for (const std::string field :
         {"length(p - round(p)) - 0.3", "length(fract(p) - 0.5) - 0.3",
          "abs(p.x - floor(p.x) - 0.5) + p.y",
          "let m = 0.7; let q = p - m * floor(p / m + 0.5); length(q) - 0.2",
          "let a = (atan(p.z, p.x) + 0.3) % (tau / 6) - tau / 12; length(p.xz) * cos(a) - 1"}) {
        INFO(field);
        CHECK(codes("implicit(p => { " + field + " }, within: ball(2) - tube(Y, 0.3))\n").empty());
    }
    CHECK(codes(value_noise +
                "implicit(p => length(p) - 1 - 0.1 * own_noise(4 * p), within: ball(1.5))\n")
              .empty());
}

TEST_CASE("a step that reaches the surface is an error") {
    for (const std::string field :
         {"p.y - 0.3 * floor(p.x)", "length(fract(p) - 0.4) - 0.3", "p.y - 0.1 * hash(floor(p))",
          "let a = (atan(p.z, p.x) + 0.3) % 1 - 0.5; length(p.xz) * cos(a) - 1"}) {
        INFO(field);
        CHECK(!codes("implicit(p => { " + field + " }, within: ball(2) - tube(Y, 0.3))\n").empty());
    }
}
