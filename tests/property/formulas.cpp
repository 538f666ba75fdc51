// A random search over formulas of the whole language: scalars and points made of everything that
// may stand in a field, with choices, steps and waves whose sides meet, or nearly. Whatever the
// checker accepts is measured (judge.h). FATHOM_EFFORT=80 is the long form.
// Long: one grammar, whose rules call each other.
#include "judge.h"
#include "judge_shader.h"
#include "tests/support/effort.h"

#include <catch2/catch.hpp>

using namespace fathom;
using namespace fathom::test;

namespace {

class Formula : public Chance {
  public:
    using Chance::Chance;

    std::string scene() {
        std::string out = "param k = 0.5 in " + of({"0..1", "-1..1", "0.25..3", "0.5..0.5001"}) +
                          "\nparam m = 1 in " + of({"0.5..2", "-2..2", "0..1"}) + "\n";
        lists_ = pick(4) == 0;
        if (lists_)
            out += "let list = [0.1, 0.4, " + between(-0.3, 0.6) +
                   ", 0.25]\n"
                   "let places = [[0.5, 0, 0.2], [-0.6, 0.3, 0], [0, -0.5, " +
                   between(-0.5, 0.5) + "]]\n";
        if (const bool own = pick(3) == 0) {
            out += "fn own(p: vec3, k: float) -> float {\n" + body(2) + "}\n";
            function_ = own; // which does not call itself
        }
        out += "implicit(p => {\n" + body(3) + "}, within: " +
               of({"ball(2)", "ball(2)", "aabb([-1.5, -1, -2], [1.5, 2, 1.5])", "tube(Y, 1.2)",
                   "everywhere"}) +
               ")\n";
        return out + "render(time: " + of({"1", "3", "10"}) + ")\n";
    }

  private:
    bool lists_ = false, function_ = false;

    // What the point becomes, what is named on the way, and the field.
    std::string body(std::size_t depth) {
        std::string out = "  var q = p\n";
        for (std::size_t i = pick(3); i > 0; --i) out += "  q = " + point() + "\n";
        if (pick(4) == 0) out += loop();
        out += "  let a = " + scalar(depth - 1) + "\n  let b = " + scalar(depth - 1) + "\n";
        if (pick(3) == 0) out += "  if " + truth() + " { return " + solid() + " }\n";
        switch (pick(4)) {
        case 0: return out + "  " + scalar(depth) + "\n";
        case 1: return out + "  " + solid() + " + 0.2 * " + scalar(depth) + "\n";
        case 2:
            return out + "  " + of({"min", "max"}) + "(" + solid() + ", " + scalar(depth) + ")\n";
        default: return out + "  p.y + 0.3 * " + scalar(depth) + "\n";
        }
    }
    std::string loop() {
        const std::string n = of({"2", "3", "4"});
        switch (pick(7)) {
        case 0:
            return "  for i in 0.." + n +
                   " { q = abs(q) - vec3(0.5, 0.3, 0.1 * i)\n q.xy = "
                   "rotate2(q.xy, " +
                   of({"0.5", "k", "0.1 * time", "i"}) + ") }\n";
        case 1: return "  for i in 0.." + n + " { q = " + point() + " }\n";
        case 2:
            return "  var s = " + scalar(1) + "\n  for i in 0.." + n + " { s = " +
                   of({"abs(s) - 0.3", "max(s, q.x - 0.2 * i)", "s + 0.2 * sin(s + i)",
                       "0.5 * s + 0.2 * abs(fract(s) - 0.5)", "min(s, length(q - 0.3 * i) - 0.2)",
                       "if s > 0.5 { 1 - s } else { s }", "if q.x > 0.2 * i { s } else { -s }"}) +
                   " }\n  q.x = s\n";
        case 3:
            return "  for i in 0.." + n + " { if " +
                   of({"q.x < 0", "length(q) > 1", "q.x < q.y", "q.x + q.z > i"}) + " { " +
                   of({"break", "q.x = -q.x", "q.xy = q.yx", "q = q / 2", "q.x = 0 - q.x"}) +
                   " }\n q = q" + of({"", " * 1.5 - 0.5", " - vec3(0.3, 0, 0)"}) + " }\n";
        case 4:
            return "  var n = 0\n  while q.x > 0.5 limit 4 {\n q.x -= " + of({"0.5", "1", "k"}) +
                   "\n n += 1 }\n";
        case 5:
            return "  var s = 0.0\n  for i in 0.." + n +
                   " { s += sin(2 * s + q.x) / (1 + i) }\n  q.y += 0.2 * s\n";
        default:
            return "  for i in 0.." + n + " { q -= 2 * min(0, dot(q, " +
                   of({"vec3(0.6, 0, 0.8)", "vec3(0.8, -0.6, 0)", "vec3(1, 1, 0) / sqrt(2)",
                       "vec3(0.6, 0, 0.81)"}) +
                   ")) * vec3(0.6, 0, 0.8)\n q = 1.5 * q - 0.4 }\n";
        }
    }
    std::string solid() {
        return of({"(length(q) - 1)", "(length(p) - 1)", "p.y", "(p.x + 0.3)",
                   "(length(max(abs(q) - 0.5, 0)) - 0.1)",
                   "(length(vec2(length(q.xz) - 0.7, q.y)) "
                   "- 0.2)",
                   "(max(abs(q.x), abs(q.y)) - 0.6)", "(q.y - 0.2 * q.x)", "q.z"});
    }

    std::string coordinate() {
        return of({"q.x",
                   "q.y",
                   "q.z",
                   "q.x",
                   "p.x",
                   "p.y",
                   "p.z",
                   "(p.x + p.y)",
                   "(q.x - q.z)",
                   "(2 * p.x)",
                   "(q.y + 0.5)",
                   "(1 - p.x)",
                   "(p.x - k)",
                   "(p.x + 0.1 * time)",
                   "(m * q.x)",
                   "length(q)",
                   "length(p.xz)",
                   "length(q.xy)",
                   "dot(q, vec3(0.6, 0, "
                   "0.8))",
                   "max(q.x, q.y)",
                   "abs(q.x)",
                   "atan(p.z, p.x)",
                   "atan(q.y, q.x)"});
    }
    std::string period() { return of({"1", "0.5", "0.75", "0.8", "(1 / 3)", "2", "1.5"}); }
    std::string close() { return of({"", "", "", " + 1e-3", " - 0.01", " + k * 0.01"}); }

    // A choice, a step or a wave that its other half is to meet; now and then it misses.
    std::string meeting(std::size_t depth) {
        const std::string u = coordinate(), v = of({"0", "0.5", "q.y", "p.z", "k", "length(p.xy)"}),
                          e = scalar(depth), c = of({"0.5", "-1", "1", "2", "k"}), w = period();
        const std::string wave = of_wave(u, w), half = "(0.5 * " + w + ")";
        switch (pick(22)) {
        case 0:
            return "(if " + u + order() + v + " { " + e + " } else { " + e + " + " + c + " * (" +
                   u + " - " + v + ")" + close() + " })";
        case 1:
            return "(if " + u + order() + v + " { " + c + " * (" + v + " - " + u + ") } else { 0" +
                   close() + " })";
        case 2: return "sign(" + u + close() + ") * min(abs(" + u + "), 0.5)";
        case 3: return "sign(" + u + ") * (" + u + ") * abs(" + e + ")";
        case 4: return "(if " + u + order() + "0 { -1 } else { 1 }) * length(vec2(" + u + ", 0))";
        case 5: return "abs(" + wave + close() + ")";
        case 6: return "(" + wave + ") * (" + wave + ")";
        case 7: return "cos(" + of({"3", "pi", "k"}) + " * " + wave + ")";
        case 8: return "length(vec2(" + wave + ", " + e + "))";
        case 9: return "(" + wave + ") * (" + of_wave(u, w) + ")";
        case 10:
            return "sin(" + of({"tau", "pi", "2 * tau", "3"}) + " / " + w + " * (" + wave + "))";
        case 11: return "(" + half + " - abs(" + wave + ")) * (floor(" + u + " / " + w + ") % 2)";
        case 12:
            return "(" + wave + ") * ((" + of({"floor", "round"}) + "(" + u + " / " + w +
                   of({"", " + 0.5"}) + ") % 2) * 2 - 1)";
        case 13:
            return "(if " + std::string(of({"floor", "round"})) + "(" + u + ") % 2 == 0 { " + u +
                   " - round(" + u + ") } else { round(" + u + ") - " + u + " })";
        case 14:
            return "(floor(" + u + ") + " +
                   of({"(fract(", "smoothstep(0, 1, fract(", "sqrt(fract("}) + u + "))" + ")";
        case 15:
            return "mix(hash(floor(" + u + ")), hash(floor(" + u + ")" +
                   of({" + 1", " + 1", " - 1"}) + "), " + of({"fract(", "1 - fract(", "fract("}) +
                   u + "))";
        case 16:
            return "(" + u + " - 0.7 * clamp(round(" + u + " / 0.7), -1, " + of({"1", "2", "1.5"}) +
                   "))";
        case 17: return "step(" + v + ", " + u + ") * (" + u + " - " + v + ")";
        case 18:
            return "(if " + u + " < " + v + " or " + u + " > 1 { " + e + " } else { " + e +
                   " + min(" + u + " - " + v + ", 1 - " + u + ") })";
        case 19:
            return "(if abs(" + u + ") < 0.5 { " + e + " } else { " + e + " + " + c + " * (abs(" +
                   u + ") - 0.5)" + close() + " })";
        case 20: return "(float(" + u + " > " + v + ") * max(" + u + " - " + v + close() + ", 0))";
        default:
            return "sqrt(if " + u + order() + v + " { " + u + " * " + u + " } else { " + v + " * " +
                   u + " })";
        }
    }
    std::string order() { return of({" < ", " > ", " <= ", " >= "}); }
    std::string of_wave(const std::string &u, const std::string &w) {
        const std::string half = "(0.5 * " + w + ")";
        switch (pick(9)) {
        case 0: return "(" + u + " - " + w + " * round(" + u + " / " + w + "))";
        case 1: return "(" + w + " * round(" + u + " / " + w + ") - " + u + ")";
        case 2: return "((" + u + " + " + half + ") % " + w + " - " + half + ")";
        case 3: return "(" + half + " - (" + u + " + " + half + ") % " + w + ")";
        case 4: return "(" + w + " * fract(" + u + " / " + w + ") - " + half + ")";
        case 5: return "(" + half + " - " + w + " * fract(" + u + " / " + w + "))";
        case 6: return "(" + u + " % " + w + " - " + half + ")";
        case 7: return "(" + u + " - " + w + " * floor(" + u + " / " + w + ") - " + half + ")";
        default: return "(" + w + " * ceil(" + u + " / " + w + ") - " + half + " - " + u + ")";
        }
    }
    std::string truth() {
        const std::string one =
            "(" + coordinate() + order() + of({"0", "0.5", "k", "q.y", "1"}) + ")";
        switch (pick(6)) {
        case 0: return "(not " + one + ")";
        case 1: return "(" + one + of({" and ", " or "}) + truth() + ")";
        default: return one;
        }
    }

    std::string scalar(std::size_t depth) {
        if (depth == 0)
            return pick(4) == 0 ? of({"0.3", "1", "k", "0.1 * time", "sin(time)", "m"})
                                : coordinate();
        const std::string u = scalar(depth - 1);
        switch (pick(34)) {
        case 0: return "sin(" + of({"1", "3", "k", "pi"}) + " * " + u + ")";
        case 1: return "abs(" + u + ")";
        case 2: return "clamp(" + u + ", " + of({"-0.5", "0", "q.y", "-k"}) + ", 1)";
        case 3: return "sqrt(" + u + " * " + u + of({" + 0.01)", ")", " + k * k)"});
        case 4: return "exp(-" + of({"abs(", "(0.5 + ", "max(0, "}) + u + "))";
        case 5: return "pow(abs(" + u + "), " + of({"2", "1.5", "3", "1", "k + 1", "0.5"}) + ")";
        case 6: return "pow(" + u + ", " + of({"2", "3", "4", "5", "66"}) + ")";
        case 7: return "atan(" + u + of({")", ", 0.5)", ", 1 + abs(q.y))"});
        case 8: return "tanh(" + u + ")";
        case 9: return "log(1 + abs(" + u + "))";
        case 10: return "smoothstep(" + of({"-0.5", "0", "-k - 0.1"}) + ", 1, " + u + ")";
        case 11: return "(" + u + " / (abs(" + scalar(depth - 1) + ") + 0.5))";
        case 12: return "(" + u + " * " + scalar(depth - 1) + ")";
        case 13: return "(" + u + " * abs(" + u + "))";
        case 14: return "(" + u + " + " + scalar(depth - 1) + ")";
        case 15: return "(" + u + " - " + scalar(depth - 1) + ")";
        case 16: return "min(" + u + ", " + scalar(depth - 1) + ")";
        case 17: return "max(" + u + ", " + scalar(depth - 1) + ")";
        case 18:
            return "mix(" + u + ", " + scalar(depth - 1) + ", " +
                   of({"0.3", "k", "smoothstep(0, 1, q.x)", "clamp(q.x, 0, 1)"}) + ")";
        case 19: return "length(vec2(" + u + ", " + scalar(depth - 1) + "))";
        case 20: {
            const std::string v = scalar(depth - 1), h = "max(0.3 - abs(" + u + " - " + v + "), 0)";
            return of({"(min(", "(max("}) + u + ", " + v + ")" + of({" - ", " + "}) + h + " * " +
                   h + of({" / 1.2)", " / 1)", " / 1.2)"});
        }
        case 21: return "(2 * noise(" + point() + "))";
        case 22: return "length(" + point() + ")";
        case 23: return "(" + point() + ")." + of({"x", "y", "z"});
        case 24:
            return function_ ? "own(" + point() + ", " + of({"k", "0.3"}) + ")"
                             : meeting(depth - 1);
        case 25:
            if (!lists_) return meeting(depth - 1);
            return of(
                {"list[int(clamp(floor(2 * q.x), 0, 3))]",
                 "mix(list[int(floor(clamp(q.x, 0, 2)))], list[int(floor(clamp(q.x, 0, 2))) + "
                 "1], fract(clamp(q.x, 0, 2)))",
                 "fold(places, 9, (s, c) => min(s, length(q - c)))",
                 "fold(list, 0, (s, x) => s + x * sin(q.x + x))",
                 "length(q - places[int(q.x > 0)])"});
        default: return meeting(depth - 1);
        }
    }

    std::string point() {
        const std::string w = period(), n = of({"vec3(0.6, 0, 0.8)", "vec3(0.8, -0.6, 0)",
                                                "vec3(0.6, 0.6, 0.6)", "normalize(vec3(1, 1, 1))"});
        const std::string at = of({"q", "q", "q", "p", "(q + 0.2)", "(q - vec3(0.3, k, 0))"});
        switch (pick(26)) {
        case 0: return "(abs(" + at + ") - " + of({"0.5", "vec3(0.5, 0.2, 0)", "k"}) + ")";
        case 1: return "(" + at + " - " + w + " * round(" + at + " / " + w + "))";
        case 2: return "((" + at + " + 0.5 * " + w + ") % " + w + " - 0.5 * " + w + ")";
        case 3: return "(" + at + " - 0.7 * clamp(round(" + at + " / 0.7), -1, 1))";
        case 4: return "(clamp(" + at + ", -0.5, 0.5) * 2 - " + at + ")";
        case 5: return "(" + at + " - 2 * min(0, dot(" + at + ", " + n + ")) * " + n + ")";
        case 6: return at + ".yzx";
        case 7: return "(if q.x < q.y { q.yxz } else { " + of({"q", "q", "-q", "q + 1e-3"}) + " })";
        case 8:
            return "vec3(rotate2(q.xy, " + of({"0.4", "k", "time", "q.z", "0.3 * q.x"}) + "), q.z)";
        case 9: return "vec3(length(q.xz) - 0.6, q.y, " + of({"0", "atan(q.z, q.x)", "q.x"}) + ")";
        case 10: {
            const std::string of_turn = of({"5", "6", "3", "7", "2.5"});
            const std::string s = "(tau / " + of_turn + ")";
            const std::string t = of(
                {"atan(q.z, q.x)", "atan(q.z, q.x)", "(atan(q.z, q.x) + 0.3)", "atan(q.x, q.z)"});
            const std::string folded = of_wave(t, s);
            const std::string sine =
                of({"sin(#)", "sin(#)", "abs(sin(#))", "sin(abs(#))", "-sin(#)"});
            const std::size_t hole = sine.find('#');
            return "(length(q.xz) * vec3(cos(" + folded + "), 0, " + sine.substr(0, hole) + folded +
                   sine.substr(hole + 1) + ") + vec3(0, q.y, 0))";
        }
        case 11:
            return "(" + at + " * " + of({"0.5", "2", "vec3(1, 0.5, 2)", "(1 + 0.2 * k)"}) + ")";
        case 12: return "max(" + at + ", " + of({"0", "-0.3", "p", "vec3(0, -1, 0.2)"}) + ")";
        case 13:
            return "(" + at + " - vec3(0.5, 0.3, 0.1) * clamp(dot(" + at +
                   ", vec3(0.5, 0.3, 0.1)) / 0.35, 0, 1))";
        case 14: return "sin(" + of({"1", "2", "k"}) + " * " + at + ")";
        case 15:
            return "(" + at + " / " +
                   of({"(1 + dot(q, q))", "max(dot(q, q), 0.3)", "max(length(q), 0.5)"}) + ")";
        case 16: return "normalize(" + at + of({" + 3)", " + vec3(0, 3, 0))"});
        case 17: return "cross(" + at + ", " + n + ")";
        case 18:
            return "mix(q, p, " + of({"0.5", "k", "clamp(q.x, 0, 1)", "smoothstep(0, 1, q.y)"}) +
                   ")";
        case 19: return "vec3(" + coordinate() + ", " + coordinate() + ", q.z)";
        case 20:
            return "(mat3([0.6, 0.8, 0], [-0.8, 0.6, 0], [0, 0, " + of({"1", "-1", "k"}) + "]) * " +
                   at + ")";
        case 21: return "(if " + truth() + " { " + at + " } else { q })";
        case 22: return "vec3(" + meeting(1) + ", q.y, q.z)";
        case 23: return "(" + at + " + 0.2 * sin(3 * q.yzx))";
        case 24:
            return "(if dot(q, " + n + ") < 0 { q - 2 * dot(q, " + n + ") * " + n +
                   " } else { q })";
        default: return "min(" + at + ", " + at + ".yxz)";
        }
    }
};

} // namespace

TEST_CASE("a formula is refused, or is as flat as proved") {
    const Judged judged = judge_scenes<Formula>(effort(85), 3000, some_in_shader());
    CHECK(judged.again > 0);
    CHECK(judged.wrong == 0);
    CHECK(judged.accepted > judged.scenes / 6);
}

TEST_CASE("a shader that is steeper than proved is found") {
    const std::string text =
        "param k = 0.5 in 0..1\nimplicit(p => 0.8 * length(p - k * X) - 0.5)\n";
    for (const float times : {1.0f, 1.3f}) {
        const Evaluator other = [&](const ir::Scene &scene) -> Values {
            const Values field = in_shader(scene);
            return [=](const ir::Scene &now, double time, const std::vector<Point3> &points) {
                std::vector<float> out = field(now, time, points);
                for (float &x : out) x *= times;
                return out;
            };
        };
        Chance random(1);
        const Verdict verdict = judge(text, random, 400, other);
        INFO(verdict.wrong);
        CHECK(verdict.accepted);
        CHECK(verdict.wrong.empty() == (times == 1.0f));
    }
}
