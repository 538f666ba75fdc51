// Distance functions and operators as people write them, each as a field of the user's own
// (idioms.sdf): what the checker says of them, beside the steepest slope that is found by trying.
// docs/idioms.md is the table of it; FATHOM_UPDATE=1 writes it anew.
#include "driver/compile.h"
#include "tests/support/steepest.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <sstream>

using namespace fathom;
using namespace fathom::test;

namespace {

struct Idiom {
    std::string name, text;
};
std::vector<Idiom> idioms_in(const char *file) {
    std::ifstream in(std::string(FATHOM_SOURCE_DIR "/tests/property/") + file);
    std::vector<Idiom> out;
    for (std::string line; std::getline(in, line);)
        if (line.starts_with("//==== "))
            out.push_back({line.substr(7), ""});
        else if (!out.empty())
            out.back().text += line + "\n";
    return out;
}

// The bound within ball(2), for all of its params' ranges; nothing where it is refused.
std::optional<double> proved(const Idiom &idiom) {
    const driver::Compilation c =
        driver::compile_text("idiom.sdf", idiom.text + "implicit(f, within: ball(2))\n", "", {});
    const auto &said = c.diagnostics.items();
    if (!c.good() || std::ranges::count(said, Code::RangeUnproved, &Diagnostic::code) > 0)
        return {};
    double bound = 0;
    for (std::size_t i = 0; i < c.scene.shapes.size(); ++i)
        if (c.scene.shapes[ir::ShapeId{i}].kind == ir::ShapeKind::Leaf)
            bound = std::max(bound, c.scene.facts[i].lipschitz_sup);
    return bound;
}

// The steepest slope that is found in the ball by trying, of the field as it is: with the params as
// they stand, at the ends of their ranges and between, and at some times.
double seen(const Idiom &idiom) {
    driver::Compilation c =
        driver::compile_text("idiom.sdf", idiom.text + "implicit(f, estimate: 1)\n", "", {});
    INFO(idiom.name);
    REQUIRE(c.good());
    const bool moves = !c.scene.params.empty() || idiom.text.find("time") != std::string::npos;
    Sampler choices(c.scene);
    double steepest = 0;
    for (int round = 0; round < (moves ? 8 : 1); ++round) {
        for (ir::Param &param : c.scene.params)
            for (std::size_t k = 0; round > 0 && k < 4; ++k) {
                const double at = round < 3 ? round - 1 : choices.random();
                param.value[k] = param.lo[k] + (param.hi[k] - param.lo[k]) * at;
                if (param.type == ir::Type::Int) param.value[k] = std::round(param.value[k]);
            }
        Sampler sampler(c.scene, round == 0 ? 0 : 10 * choices.random());
        for (const double apart : {1e-3, 1e-2, 0.3})
            steepest =
                std::max(steepest, steepest_slope(sampler, 1.9, apart, moves ? 4'000 : 15'000));
    }
    return steepest;
}

constexpr const char *head = R"(# Idioms

Distance functions and operators as people write them, from memory of the lists of Inigo Quilez, of
hg_sdf and of the usual folds. Each is a field of the user's own, `implicit(f, within: ball(2))`, in
`tests/property/idioms.sdf`. The bound is what the checker proves, for all params and times; beside
it stands the steepest slope that was found by trying points, params and times. A dash: no bound is
proved, and the field is refused. Made by `tests/property/idioms.cpp`.

| idiom | bound | seen |
| --- | --- | --- |
)";

// Fields that jump, each next to one that does not: by another number, another sign, another point
// that is read. None may be proved.
constexpr std::array near_misses = {
    "sign(p.x) * length(p.xy)",
    // 0/0 wherever they are evaluated, or in a half
    "p.y + min(abs(p.x), 0) * min(abs(p.x), 0) / (2 - 2.0)",
    "p.y + max(p.x, 0) * max(p.x, 0) / max(p.x, 0)",
    "p.y + min(time, 0) / min(time, 0)",
    "sign(p.x) * (abs(p.x) + 0.001)",
    "sign(p.x) * abs(p.x - 0.01)",
    "sign(p.y) * abs(p.x)",
    "(if p.x < 0 { -1 } else { 1 }) * length(p)",
    "(if p.x < 0 { -1 } else { 1 }) * max(p.x, 0.01)",
    "1e-12 * sign(p.x) + 1e-12 * p.y",
    "if p.x < 0 { 1e13 * pow(p.y, 8) + 5 } else { 1e13 * pow(p.y, 8) }",
    "sign(p.y) * min(abs(p.x) * (if p.y > 0 { 1 } else { 0 }), 1)",
    "if p.x < 0 { min(p.y, 1) } else { max(p.y, 1) }",
    "sign(p.x) * max(min(p.y, p.z), abs(p.x))",
    "1e6 * (p.y + 1e-3 * sign(p.x))",
    "sign(if p.x > 0 { 1 } else { -1 }) + p.y",
    "sign(if p.x > 0.5 { p.x } else { p.x - 2 }) * max(abs(p.x) - 1, 0) + sign(p.x - 0.5)",
    "sign(fract(p.x) - 0.5) * abs(fract(p.x) - 0.5) + p.y",
    "sign(((p.x + 0.5) % 1) - 0.5) * abs(p.y)",
    "if p.x > 0 { length(p) } else { length(p - vec3(0, 0.001, 0)) }",
    "if p.x > 0 and p.y > 0 { p.x } else { 0 }",
    "if p.x > 0 or p.y > 0 { p.x } else { 0 }",
    "if p.x * p.x > p.y { p.x - sqrt(max(p.y, 0)) } else { 0 }",
    "if p.x * p.y > 0 { p.x } else { 0 }",
    "if p.x > 0 { p.y } else { -p.y }",
    "abs(if p.x > 0 { p.y } else { -p.y }) + (if p.x > 0 { p.y } else { -p.y })",
    "sqrt(if p.x > 0 { p.y * p.y } else { p.z * p.z })",
    "sqrt(max(if p.x > 0 { p.y } else { p.z }, 0))",
    "float(p.x > 0) * length(p.xz)",
    "step(0, p.x) * length(p)",
    "step(p.y, p.x) * (p.x + p.y)",
    "step(0, p.x) * p.y",
    "sign(p.x * p.x - p.y) * (p.x - p.y)",
    "sign(length(p) - 1) * (length(p.xy) - 1)",
    "sign(max(p.x, p.y)) * min(abs(p.x), abs(p.y) + 0.01)",
    "(if abs(p.x) < 1 { 1 } else { -1 }) * (p.x - 1)",
    "(if p.x < 1 and p.x > -1 { 1 } else { -1 }) * (1 - p.x)",
    "p.x - 0.7 * clamp(round(p.x / 0.7), -1.5, 1)",
    "length(vec2(p.x - 0.7 * clamp(round(p.x / 0.6), -1, 1), p.y))",
    "p.x - 0.7 * clamp(round(p.x / 0.7), -1, 1)",
    "abs(p.x - 0.7 * clamp(round(p.x / 0.7), -1, 1) - 0.1)",
    "2 * fract(p.x) - 1",
    "abs(2 * fract(p.x) - 0.9)",
    "abs((if p.x > 1 { p.x - 2 } else { p.x }) + 0.1)",
    "abs(if p.x > 1 { p.x - 2.1 } else { p.x })",
    "abs(if p.y > 1 { p.x - 2 } else { p.x })",
    "(((p.x + 0.5) % 1) - 0.5) * ((floor(p.x + 0.5) % 3) * 2 - 1)",
    "pow(p.x * p.x * p.x + pow(p.y, 3), 1 / 3)",
    "pow(pow(p.x, 4) + pow(p.y, 4), 1 / 8)",
    "pow(pow(p.x, 8) + pow(p.y, 4), 1 / 8)",
    "pow(pow(p.x, 4) - pow(p.y, 4), 1 / 4)",
    "sqrt(max(p.x, p.y) - 1)",
    "sqrt(min(p.x * p.x, p.y))",
    // one comparison in several choices
    "if p.x < 0 or p.x > 1 { if p.x < 0 { p.y } else { p.y + p.x - 1 } } else { p.y + 0.001 }",
    "if p.x < 0 or p.x > 1 { if p.x < 0 { p.y } else { p.y + p.x } } else { p.y }",
    "(if p.x < 0 { 1 } else { -1 }) * (if p.x > 0 { 1 } else { -1 }) * p.y",
    "float(p.x < 0) * p.y + (if p.x < 0 { 0 } else { p.y + 0.001 })",
    // on a line: a number is another, arms meet on a part alone, or up to 500
    "if max(-0.6 * p.x * p.x + 0.72 * (1.2 - 2 * p.y), 0.3 * abs(p.x) - 0.848528137 * p.y) < 0 "
    "{ length(p.xy) - 0.9 } else if abs(p.x) < 0.848528137 { 0.301 - p.y } "
    "else { length(vec2(abs(p.x) - 0.848528137, p.y - 0.3)) }",
    "if max(-0.6 * p.x * p.x + 0.72 * (1.2 - 2 * p.y), 0.3 * abs(p.x) - 0.848528137 * p.y) < 0 "
    "{ length(p.xy) - 0.9 } else if abs(p.x) < 0.84 { 0.3 - p.y } "
    "else { length(vec2(abs(p.x) - 0.848528137, p.y - 0.3)) }",
    "if p.x < 0 { max(p.y, 0) } else { max(p.y, -0.5) }",
    "if p.x < 0 { abs(p.y) } else { max(abs(p.y), 0.001) }",
    "if p.x < 0 { p.y * p.y } else { max(p.y * p.y, 0.001 * p.y) }",
    "if p.x < 0 { p.y } else { max(p.y, sqrt(p.y * p.y + 0.0001) - 1) }",
    "if p.x < 0 { p.y } else { min(p.y, 500) }",
    "if p.y < p.x * p.x { length(p.xy) } else { abs(p.x) * sqrt(1 + p.y) + 0.0001 }",
    // counts
    "if round(p.x) % 2 == 0 { p.x - round(p.x) } else { round(p.x) - p.x + 0.001 }",
    "if round(p.x) % 3 == 0 { p.x - round(p.x) } else { round(p.x) - p.x }",
    "if round(p.x) > 1 { p.x - round(p.x) } else { round(p.x) - p.x }",
    "abs(p.x - round(p.x) + (if round(p.x) > 2 { round(p.x) - 2 } else { 0 }) + "
    "(if (if round(p.x) > 2 { 2 } else { round(p.x) }) < -1 { round(p.x) + 2.1 } else { 0 }))",
    "abs(((p.x + 0.25) % 0.5) - 0.25 + (if floor((p.x + 0.25) / 0.5) > 2 "
    "{ 0.51 * (floor((p.x + 0.25) / 0.5) - 2) } else { 0 }))",
    "abs(((p.x + 0.25) % 0.5) - 0.25 + (if floor((p.x + 0.25) / 0.5) > 2 "
    "{ 0.5 * (floor((p.x + 0.25) / 0.5) - 1) } else { 0 }))",
    "mix([0.1, 0.4, 0.2, 0.5][int(floor(clamp(2 * p.x + 1.5, 0, 3)))], [0.1, 0.4, 0.2, 0.5]"
    "[min(int(floor(clamp(2 * p.x + 1.5, 0, 3))) + 1, 2)], fract(clamp(2 * p.x + 1.5, 0, 3)))",
    "min(floor(p.x), 1) + fract(p.x)",
    // angles: another count, another angle, another length, a part of a turn
    "length(vec2(length(p.xy) * cos(((atan(p.y, p.x) + 0.3) % 1.2) - 0.6) - 1, p.z))",
    "length(vec2(length(p.xy) * cos((atan(p.y, p.x) % (2 * pi / 5)) - pi / 4) - 1, p.z))",
    "length(vec2(length(p.xz) * cos((atan(p.y, p.x) % (pi / 3)) - pi / 6) - 1, p.z))",
    "length(p.xy) * sin((atan(p.y, p.x) % (pi / 3)) - pi / 6) + p.z",
    "length(p.xy) * cos((atan(p.y, p.x) % (pi / 3)) - pi / 6 + 0.01) + p.z",
    "length(p.xy) * sin(abs((atan(p.y, p.x) % (pi / 3)) - pi / 6.01)) + p.z",
    "length(p.xy - 0.1) * cos((atan(p.y, p.x) % (pi / 3)) - pi / 6) + p.z",
    "p.z + 0.1 * floor(atan(p.y, p.x) * 3 / pi)",
    "p.z * (1 + floor(atan(p.y, p.x) * 3 / pi) % 2)",
    // what vanishes on another axis, not quite, or turns by another count
    "length(p.xz) * sin(2.5 * atan(p.z, p.x))",
    "length(p.xy) * sin(5 * atan(p.z, p.x))",
    "length(p.xz - 0.01) * sin(5 * atan(p.z, p.x))",
    "max(length(p.xz), 0.01) * sin(5 * atan(p.z, p.x))",
    "smoothstep(-0.1, 0.5, length(p.xz)) * sin(5 * atan(p.z, p.x))",
    "min(length(p.xz), -0.1) * sin(5 * atan(p.z, p.x))",
    "length(p.xz) * floor(atan(p.z, p.x))",
    "length(p.xz) * atan(p.z, p.x)",
    "length(fract(p.xz) - 0.5) * sin(5 * atan(fract(p.z) - 0.5, fract(p.x) - 0.5))",
    "sqrt(length(p.xz)) * sin(5 * atan(p.z, p.x))",
    "atan(pow(atan(p.z, p.x), 2), 1)", // an angle of an angle
    "p.y + 0.1 * abs(atan(abs(atan(p.z, p.x)), 2) - 0.3)",
    // squares that are not complete: less by a little, of a product, of a linear term
    "sqrt(dot(p, p) + 0.809 - 1.8 * length(p.xy))",
    "sqrt(dot(p, p) + 0.80999990 - 1.8 * length(p.xy))",
    "sqrt(p.x * p.x - 1.9999999 * p.x * p.y + 0.9999998 * p.y * p.y)",
    "sqrt(p.x * p.x + 2.01 * p.x * p.y + p.y * p.y)",
    "sqrt(p.x * p.x - 0.001 * p.x)",
    "sqrt(p.x * p.x - length(p.yz) + 0.25)",
    // signed roots: of what is no square, of squares that do not meet, by another's sign
    "sign(p.x) * sqrt(abs(p.x))",
    "sign(if p.x < 0 { -p.x * p.x } else { p.x * p.x + 0.0001 }) * "
    "sqrt(abs(if p.x < 0 { -p.x * p.x } else { p.x * p.x + 0.0001 }))",
    "sign(p.y) * sqrt(abs(if p.x < 0 { -p.x * p.x } else { p.x * p.x }))",
    // counts: one border is not met, or another count
    "if sign(p.x) + sign(p.y) < 1 { p.z } else { p.z + p.x }",
    "if sign(p.x) + sign(p.y) < 1 { p.z } else { p.z + p.x * p.y + 0.001 }",
    "sign(p.x) * abs(sign(2 * p.x)) * p.y",
    "if sign(p.x) + sign(-p.x) < 0.5 { p.y } else { p.z }",
    "(if sign(p.x) + sign(2 * p.x) < 1 { -1 } else { 1 }) * p.y",
    // truths that are chosen, as early returns make them: one border is not met
    "if (if p.x < 0 { false } else { p.y > 0 }) { p.x } else { 0 }",
    "if (if p.x < 0 { false } else { p.x > p.y }) { min(p.x, p.x - p.y) + 0.001 } else { 0 }",
    "float(if p.x < 0 { false } else { p.y > 0 }) * p.x",
    // an angle in a vector that is rounded
    "length(vec3(atan(p.y, p.x), p.x, p.z) - round(vec3(atan(p.y, p.x), p.x, p.z)))",
    // what all uses of a step go through: another corner, a use beside it, a step that moves along
    "mix(fract(sin(floor(p.x)) * 437.5), fract(sin(floor(p.x) + 2) * 437.5), fract(p.x))",
    "mix(fract(sin(floor(p.x)) * 437.5), fract(sin(floor(p.x) + 1) * 437.6), fract(p.x))",
    "abs(fract(p.x) - 0.5) + 0.01 * floor(p.x)",
    "abs(floor(2 * p.x) - 2 * floor(p.x) - 0.5) + 0.1 * floor(2 * p.x)",
    "abs(floor(2 * p.x) - 2 * floor(p.x) - 0.5) + 0.1 * floor(p.x)",
    "abs(floor(2 * p.x) - 2 * floor(p.x) - 0.4) + abs(fract(2 * p.x) - 0.5)",
    // mixes as sums: another sign, another corner
    "mix(hash(floor(p.x)), hash(floor(p.x) + 1), fract(p.x)) + "
    "(hash(floor(p.x)) - hash(floor(p.x) + 1)) * fract(p.x)",
    // the middle by cases: another value, too wide, another number of waves, another place
    "if p.x == 0 { 1.01 } else { sin(p.x) / p.x }",
    "if abs(p.x) < 0.1 { 1 } else { sin(p.x) / p.x }",
    "if p.x == 0 { 1 } else { sin(2 * p.x) / p.x }",
    "if p.x == 0.001 { 1 } else { sin(p.x) / p.x + 0.01 }",
    "if p.x == 0 { p.y } else { p.y + p.x + 0.001 }",
    "if p.x == 0 { p.y } else { 2 * p.y }",
    // a fold that turns the other way, by a matrix
    "length(mat2([cos(round(atan(p.z, p.x) * 6 / tau)), sin(round(atan(p.z, p.x) * 6 / tau))], "
    "[-sin(round(atan(p.z, p.x) * 6 / tau)), cos(round(atan(p.z, p.x) * 6 / tau))]) * p.xz - 1)",
    "length(rotate2(p.xz, round(atan(p.z, p.x) * 6 / tau) * tau / 6) - vec2(1, 0))",
    "length(rotate2(p.xz, -round(atan(p.z, p.x) * 6 / tau) * tau / 6) - vec2(1, 0.01))",
    // hashes and steps of numbers that rounding alone makes other ones
    "p.y + 0.3 * (if p.x < p.z { hash(time) } else { hash(time * 1.0000002) })",
    "p.y + 0.3 * (if abs(p.x) < 0.5 { hash(time) } else { hash(time * 1.0000002) })",
    "p.y + 0.3 * (if p.x < p.z { hash(3 * (time + 0.1)) } else { hash(3 * time + 0.3) })",
    "p.y + 0.3 * (if p.x < 0 { hash(time * 0.1 + time * 0.2) } else { hash(time * 0.3) })",
    "p.y + (if p.x < p.z { floor(time * 0.1 + time * 0.2) } else { floor(time * 0.3) })",
    "p.y + (if p.x < p.z { fract(43758.54 * sin(time)) } else { fract(43758.55 * sin(time)) })",
    "mix(hash(0.1 * floor(p.x)), hash(0.1 * floor(p.x) + 0.1), fract(p.x))",
    "mix(fract(sin(12.9898 * floor(p.x)) * 43758.5453), "
    "fract(sin(12.9898 * floor(p.x) + 12.9898) * 43758.5453), fract(p.x))",
    "mix(hash(0.3 * floor(p)), hash(0.3 * floor(p) + vec3(0.3, 0, 0)), fract(p.x))",
    // logarithms and quotients of what may be 0, or less
    "log(exp(p.x) - 0.5)",
    "log(exp(p.x) * p.y)",
    "p.y + 0.1 * clamp(1 / p.x, 0, 4)",
    "p.y + 0.1 * max(1 / dot(p, p), 1)",
    "p.y + 0.1 * min(1 / (p.x * p.y), 4)",
    // roots of sums that hold a small square more
    "if p.z < 0 { length(vec2(p.x, 0.0006)) } else { abs(p.x) }",
    "p.x + (if p.z < 0 { length(vec2(p.x - p.y, 0.0007 * p.y)) } else { abs(p.x - p.y) })",
    "if p.z < 0 { sqrt(p.x * p.x - 1.9999998 * p.x * p.y + p.y * p.y) } else { abs(p.x - p.y) }",
    "p.y - 0.2 * (if p.x < 0 { length(vec3(p.x, p.z, 0.0007)) } else { length(p.xz) })",
    // norms of powers: two powers, no size
    "pow(pow(abs(p.x), 2.5) + pow(abs(p.y), 2.4), 1 / 2.5)",
    "pow(pow(abs(p.x), 0.9) + pow(abs(p.y), 0.9), 1 / 0.9)",
    "pow(pow(pow(abs(p.x), 4) + pow(abs(p.z), 4), 0.7) + pow(abs(p.y), 3), 1 / 3)",
    "pow(pow(abs(p.x), 1.2 + sin(time)) + pow(abs(p.y), 1.2 + sin(time)), 1 / (1.2 + sin(time)))",
    "pow(pow(abs(p.x), 3 + sin(time)) + pow(abs(p.y), 3 - sin(time)), 1 / (3 + sin(time)))",
    "pow(pow(abs(p.x), 3 + sin(time)) + pow(p.y, 3 + sin(time)), 1 / (3 + sin(time)))",
    // a quotient that is nothing on the border, nearly
    "if length(p) < 1 { 0 } else { (length(p) - 0.999) / max(length(p.xy), 0.3) }",
    "if length(p) < 1 { 0 } else { length(p) * (length(p) - 1.001) / max(length(p.xy), 0.3) }",
    "if p.x < 1 { 0 } else { (p.x - 1) / p.y }",
    // lengths of a choice: another vector, another length, a sign, a component
    "length(if dot(p.xy, p.xy) < dot(p.xz, p.xz) { p.xy } else { p.xz + 0.001 })",
    "length(if dot(p.xy, p.xy) < 2 * dot(p.xz, p.xz) { p.xy } else { p.xz })",
    "if dot(p.xy, p.xy) < dot(p.xz, p.xz) { length(p.xy) } else { length(p) }",
    "if p.x * p.x < p.y * p.y { p.x } else { p.y }",
    "length((if dot(p.xy, p.xy) < dot(p.xz, p.xz) { p.xy } else { p.xz }) - 0.1)",
    "(if dot(p.xy, p.xy) < dot(p.xz, p.xz) { p.xy } else { p.xz }).y",
    // vectors by component
    "length(if p.x > 1 { vec2(p.x - 2.1, p.y) } else { p.xy })",
    "length((if p.x > 1 { vec2(p.x - 2, p.y) } else { p.xy }) - vec2(0.1, 0))",
    "length(if p.x > 1 { vec2(p.x - 2, p.y + 0.001) } else { p.xy })",
};

// Fields with the steepest slope that they have, by pieces: the bound is no less, and hardly more.
struct Steep {
    const char *field;
    double slope;
};
constexpr std::array steep = {
    Steep{"abs(p.x) + p.x", 2},
    Steep{"max(p.x, 0) - min(p.x, 0)", 1},
    Steep{"min(p.x, p.y) + max(p.x, 0)", 2},
    Steep{"min(p.x + p.y, 2 * p.x)", 2},
    Steep{"abs(p.x - p.y) + abs(p.x + p.y)", 2},
    Steep{"abs(p.x - p.y) - abs(p.x + p.y) + p.x + p.y", 3.1622777},
    Steep{"max(abs(p.x), abs(p.y)) + min(abs(p.x), abs(p.y))", 1.4142136},
    Steep{"length(vec2(length(p.xz), p.x))", 1.4142136},
    Steep{"length(vec2(length(p.xz), 2 * p.y))", 2},
    Steep{"length(vec3(p.x, abs(p.x), p.y))", 1.4142136},
    Steep{"length(vec2(2 * abs(p.x), min(p.y, 0)))", 2},
    Steep{"length(p.xy - vec2(clamp(p.x, -0.5, 0.5), -p.y))", 2},
    Steep{"length(p.xy - vec2(clamp(p.x, -0.5, 0.5), 0))", 1},
    Steep{"length(p.xy - 3 * min(dot(p.xy, vec2(0.6, 0.8)), 0) * vec2(0.6, 0.8))", 2},
    Steep{"length(p.xy - 2 * min(dot(p.xy, vec2(0.6, 0.8)), 0) * vec2(0.6, 0.8))", 1},
    Steep{"length(if p.x < p.y { p.yx } else { p.xy })", 1},
    Steep{"length(if p.x < p.y { 2 * p.yx } else { 2 * p.xy })", 2},
    Steep{"max(0.2, min(p.x, p.y)) - length(max(vec2(0.2 - p.x, 0.2 - p.y), 0))", 1},
    Steep{"min(-0.2, max(p.x, p.y)) + length(max(vec2(0.2 + p.x, 0.2 + p.y), 0))", 1},
    Steep{"max(0.2, min(p.x, p.y)) + length(max(vec2(0.2 - p.x, 0.2 - p.y), 0))", 1},
    Steep{"max(0.2, min(p.x, p.y)) - length(max(vec2(0.3 - p.x, 0.2 - p.y), 0))", 2},
    Steep{"abs(p.x - round(p.x)) + p.x", 2},
    Steep{"p.y - (if round(p.y) % 2 == 0 { p.y - round(p.y) } else { round(p.y) - p.y })", 2},
    Steep{"min(p.x, 0.3) - min(p.x, 0.4) + p.x", 1},
    Steep{"if p.x == 0 { p.y } else { p.y + p.x }", 1.4142136},
    // weights at right angles to what they mix, and not
    Steep{"mix(p.x, -p.x, saturate(p.y))", 4.1231056},
    Steep{"mix(p.x, -p.x, saturate(p.x))", 3},
    Steep{"mix(0.6 * p.x + 0.8 * p.y, -0.6 * p.x - 0.8 * p.y, saturate(0.8 * p.x - 0.6 * p.y))",
          4.1231056},
    Steep{"(0.6 * p.x + 0.8 * p.y) + 2 * (0.8 * p.x - 0.6 * p.y)", 2.236068},
    Steep{"sqrt(4 * p.x * p.x + 4 * p.x * p.y + p.y * p.y + p.z * p.z)", 2.236068},
    Steep{"sign(if p.x < 0 { -4 * p.x * p.x } else { 4 * p.x * p.x }) * "
          "sqrt(abs(if p.x < 0 { -4 * p.x * p.x } else { 4 * p.x * p.x }))",
          2},
    // exponentials: the slope of a logarithm is what they change by, of themselves
    Steep{"log(2 * exp(2 * p.x) + 3 * exp(p.y) + exp(-p.z))", 2},
    Steep{"-log(exp(-3 * length(p)) * exp(p.x))", 4},
    Steep{"log2(sqrt(exp2(2 * p.x) + exp2(p.y) / 7) + 1e-3)", 1},
    Steep{"log(exp(p.x) + exp(3 * p.x - 6))", 3},
    // what single precision has exactly
    Steep{"p.y + mix(hash(floor(p.x)), hash(floor(p.x) + 1), fract(p.x))", 1.4142136},
    Steep{"p.y + mix(hash(0.5 * floor(p.x)), hash(0.5 * floor(p.x) + 0.5), fract(p.x))", 1.4142136},
    Steep{"p.y + 0.1 * mix(fract(sin(12.9898 * floor(p.x)) * 43758.5453), "
          "fract(sin(12.9898 * (floor(p.x) + 1)) * 43758.5453), fract(p.x))",
          1.0049},
    Steep{"if sign(p.x) + sign(p.y) < 1 { p.z } else { p.z + min(p.x, p.y) }", 1.4142136},
    Steep{"length(max(vec2(-length(p.xy) - 0.3, 2 * length(p.xy) - 1), 0)) + "
          "min(max(-length(p.xy) - 0.3, 2 * length(p.xy) - 1), 0)",
          2},
    Steep{"length(if dot(p.xy, p.xy) < dot(p.xz, p.xz) { p.xy } else { p.xz })", 1},
    Steep{"length(if dot(p.xy, p.xy) < dot(2 * p.xz, 2 * p.xz) { p.xy } else { 2 * p.xz })", 2},
    // about an axis
    Steep{"length(p.xz) * sin(3 * atan(p.z, p.x))", 3},
    Steep{"3 * min(length(vec2(p.x, 2 * p.z)), 0.3) * cos(4 * atan(2 * p.z, p.x))", 24},
    Steep{"p.y + 0.3 * smoothstep(0, 0.2, length(p.xz)) * sin(20 * atan(p.z, p.x))", 33.7},
    // norms of powers below 2, of norms, and of a power that time moves
    Steep{"pow(pow(abs(p.x), 1.5) + pow(abs(p.y), 1.5) + pow(abs(p.z), 1.5), 1 / 1.5)", 1.2009369},
    Steep{"pow(pow(pow(abs(p.x), 4) + pow(abs(p.z), 4), 3 / 4) + pow(abs(p.y), 3), 1 / 3)", 1},
    Steep{
        "pow(pow(pow(abs(p.x), 3) + pow(abs(p.y), 3), 1.5 / 3) + pow(abs(2 * p.x), 1.5), 1 / 1.5)",
        2.447},
    Steep{
        "pow(pow(abs(p.x), 3 + sin(time)) + pow(abs(2 * p.y), 3 + sin(time)), 1 / (3 + sin(time)))",
        2},
    // what moves along with two numbers: a mean of them, one that goes beyond either, three times one
    Steep{"min(p.x, p.y) - 0.025 * pow(max(1 - 2.5 * abs(p.x - p.y), 0), 3) * "
          "(4 - max(1 - 2.5 * abs(p.x - p.y), 0))",
          1},
    Steep{"min(p.x, p.y) - 0.4 * pow(max(1 - 2.5 * abs(p.x - p.y), 0), 2)", 2.236068},
    Steep{"min(p.x, -p.x) - 0.208 * pow(max(1 - 2.5 * abs(2 * p.x), 0), 2)", 1.08},
    Steep{"min(p.x, p.y) - 0.8 * max(1 - 2.5 * abs(p.x - p.y), 0)", 2.236068},
    Steep{"min(p.x, p.y) - 0.4 * max(1 - 2.5 * abs(p.x - p.y), 0)", 1},
    Steep{"1.5 * (p.x + p.y - sqrt((p.x - p.y) * (p.x - p.y) + 0.04))", 3},
    Steep{"-(p.x - p.y - sqrt((p.x + p.y) * (p.x + p.y) + 0.04)) / 2", 1},
    Steep{"-(p.x - p.y - 1.1 * sqrt((p.x + p.y) * (p.x + p.y) + 0.04)) / 2", 1.05119},
};

} // namespace

TEST_CASE("what only nearly meets is refused") {
    for (const char *field : near_misses) {
        const Idiom idiom{field, "fn f(p: vec3) -> float = " + std::string(field) + "\n"};
        const std::optional<double> bound = proved(idiom);
        INFO(field << ": " << bound.value_or(0));
        CHECK(!bound);
    }
    const std::vector<Idiom> whole = idioms_in("jumps.sdf"); // an idiom with a number changed
    REQUIRE(whole.size() > 20);
    for (const Idiom &idiom : whole) {
        const std::optional<double> bound = proved(idiom);
        INFO(idiom.name << ": " << bound.value_or(0));
        CHECK(!bound);
    }
}

// In a region less a tube, about whose axis an angle turns.
TEST_CASE("an angle's cut is met by whole turns alone") {
    const auto bound_of = [](const std::string &field) -> std::optional<double> {
        const driver::Compilation c = driver::compile_text(
            "turns.sdf", "implicit(p => " + field + ", within: ball(2) - tube(Y, 0.3))\n", "", {});
        if (!c.good()) return {};
        return c.scene.facts[c.scene.root.index].lipschitz_sup;
    };
    for (const char *met :
         {"length(vec2(length(p.xz) - 1, (p.y - atan(p.z, p.x) / tau + 0.5) % 1 - 0.5))",
          "length(vec2(length(p.xz) - 1, (p.y - atan(p.z, p.x) / pi) % 0.5 - 0.25))",
          "length(p.xz) - 1 - 0.1 * sin(4 * atan(p.z, p.x) + 6 * p.y)",
          "max(length(p.xz) - 1, 0.2 * cos(atan(p.z, p.x) - 4 * p.y))",
          "abs(cos(1.5 * atan(p.z, p.x))) + p.y",
          "abs(fract(2 * p.y + atan(p.z, p.x) / tau) - 0.5) + p.y"}) {
        INFO(met);
        const std::optional<double> bound = bound_of(met);
        CHECK(bound.value_or(100) < 14); // a way round the tube is longer: 2.12 times the slope
    }
    for (const char *jumps :
         {"length(vec2(length(p.xz) - 1, (p.y - atan(p.z, p.x) / 6 + 0.5) % 1 - 0.5))",
          "length(vec2(length(p.xz) - 1, (p.y - 1.5 * atan(p.z, p.x) / tau + 0.5) % 1 - 0.5))",
          "length(vec2(length(p.xz) - 1, (p.y - atan(p.z, p.x) / tau) % 0.7 - 0.35))",
          "length(p.xz) - 1 - 0.1 * sin(4.5 * atan(p.z, p.x) + 6 * p.y)",
          "0.1 * cos(1.5 * atan(p.z, p.x)) + 0.1 * sin(1.5 * atan(p.z, p.x)) + p.y",
          "0.1 * floor(p.y - atan(p.z, p.x) / tau) + p.y",
          "abs(fract(2 * p.y + atan(p.z, p.x) / tau) - 0.4) + p.y",
          "abs(fract(2 * p.y + 1.1 * atan(p.z, p.x) / tau) - 0.5) + p.y"}) {
        INFO(jumps);
        CHECK(!bound_of(jumps));
    }
}

TEST_CASE("what agrees up to a distance alone is proved up to there") {
    const std::string field = "fn f(p: vec3) -> float = "
                              "if p.x < 0 { p.y } else { min(p.y, sqrt(p.y * p.y + 1) + 2000) }\n",
                      jumps = "fn f(p: vec3) -> float = "
                              "if p.x < 0 { p.y } else { min(p.y, max(p.y, 0) * 0.5 + 1500) }\n";
    const auto good = [](const std::string &text, const std::string &region) {
        return driver::compile_text("near.sdf", text + "implicit(f, within: " + region + ")\n", "",
                                    {})
            .good();
    };
    CHECK(good(field, "ball(2)"));
    CHECK(good(jumps, "ball(2)"));
    CHECK_FALSE(good(jumps, "ball(5000)"));
}

// The algebra of cases counts: the work that is allowed is not used up, nor minutes.
TEST_CASE("a field of many cases is answered by little work") {
    driver::CompileOptions options;
    options.limits.proof = 15'000'000;
    const driver::Compilation c =
        driver::compile_text("cases.sdf",
                             "param k = 0.5 in 0..1\n"
                             "implicit(p => {\n"
                             "  var q = cross(p, vec3(0.6, 0.6, 0.6))\n"
                             "  q = (q + 0.575) % 0.75 - 0.375\n"
                             "  for i in 0..4 {\n"
                             "    q = abs(q) - vec3(0.5, 0.3, 0.1 * i)\n"
                             "    q.xy = rotate2(q.xy, i)\n"
                             "  }\n"
                             "  if not (length(q.xy) > k) { return (q.y - 0.2 * q.x) }\n"
                             "  let s = (if q.y <= 0 { -1 } else { 1 }) * length(vec2(q.y, 0))\n"
                             "  if q.x < k or q.x > 1 { atan(s) }\n"
                             "  else { atan(s) + min(q.x - k, 1 - q.x) }\n"
                             "}, within: ball(2))\n",
                             "", options);
    REQUIRE_FALSE(c.good());
    for (const Diagnostic &d : c.diagnostics.items()) CHECK(d.code == Code::FieldJump);
}

TEST_CASE("the bound by pieces is the steepest slope") {
    for (const Steep &one : steep) {
        const Idiom idiom{one.field, "fn f(p: vec3) -> float = " + std::string(one.field) + "\n"};
        const std::optional<double> bound = proved(idiom);
        INFO(one.field << ": " << bound.value_or(-1));
        REQUIRE(bound);
        CHECK(*bound >= one.slope * (1 - 1e-6));
        CHECK(*bound <= std::max(one.slope, 1.0) * 1.06);
        CHECK(seen(idiom) <= *bound * 1.002);
    }
}

TEST_CASE("what people write has the bound that the table says, and no steeper slope") {
    const std::vector<Idiom> all = idioms_in("idioms.sdf");
    REQUIRE(all.size() > 100);
    std::string page = head;
    int accepted = 0, tight = 0;
    for (const Idiom &idiom : all) {
        const std::optional<double> bound = proved(idiom);
        const double steepest = seen(idiom);
        INFO(idiom.name << ": " << bound.value_or(-1) << ", seen " << steepest);
        if (bound) CHECK(steepest <= *bound * 1.002);
        accepted += bound.has_value();
        tight += bound && *bound <= 1.3 * std::max(steepest, 1.0);
        page += fmt::format("| {} | {} | {:.2f} |\n", idiom.name,
                            bound ? fmt::format("{:.3g}", *bound) : "-", steepest);
    }
    page += fmt::format(
        "\nOf {} idioms {} are proved, {} of them within 1.3 times what was seen, or 1.\n",
        all.size(), accepted, tight);
    const std::string file = FATHOM_SOURCE_DIR "/docs/idioms.md";
    std::stringstream now;
    now << std::ifstream(file).rdbuf();
    if (now.str() == page) return;
    const char *update = std::getenv("FATHOM_UPDATE");
    if (update && std::string(update) == "1") std::ofstream(file) << page;
    FAIL("docs/idioms.md is not what the checker says now; FATHOM_UPDATE=1 writes it anew");
}
