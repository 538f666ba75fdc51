// A random search over tilings: cells that a hash mirrors, turns or draws in another way, cells whose
// neighbours are looked at, and waves that a hash scales. Many are off by a little, so that they
// jump at the borders of their cells. Whatever the checker accepts is measured there (judge.h).
// FATHOM_EFFORT=20 is the long form.
#include "judge.h"
#include "tests/support/effort.h"

#include <catch2/catch.hpp>

using namespace fathom;
using namespace fathom::test;

namespace {

class Tiling : public Chance {
  public:
    using Chance::Chance;

    std::string scene() {
        const std::string head =
            "fn own(p: vec2) -> float = fract(sin(dot(p, vec2(27.609, 57.583))) * 43758.5453)\n"
            "implicit(p => {\n";
        return head +
               (pick(5) < 3   ? cells()
                : often()     ? neighbours()
                : pick(3) < 2 ? rows()
                              : waves()) +
               "}, within: ball(2))\n";
    }

  private:
    // A number that a field without a jump needs, or now and then another.
    std::string nearly(double right) {
        constexpr double off[] = {0.03, -0.03, 0.002, 0.2};
        return number(pick(8) == 0 ? right + off[pick(4)] : right);
    }
    std::string solid() {
        return of({"length(vec2(d, p.y)) - 0.1", "max(d - 0.1, abs(p.y) - 0.2)", "p.y + 0.3 * d"});
    }
    std::string chosen() {
        return of({"hash(id) > 0.5", "hash(id) < 0.3", "own(id) < 0.5", "hash(id + 3) > hash(id)",
                   "floor(3 * hash(id)) == 1", "id.x % 2 == 0", "id.x > id.y",
                   "step(0.5, hash(id)) > 0", "hash(id) > 0.5 and id.y > 0"});
    }
    // Of the point in its cell, from -0.5 to 0.5: what keeps the middles of all sides.
    std::string moved() {
        switch (pick(8)) {
        case 0: return "vec2(" + nearly(0) + " - q.x, q.y)";
        case 1: return "vec2(q.x, " + nearly(-1) + " * q.y)";
        case 2: return "q.yx";
        case 3: return "vec2(-q.y, " + nearly(1) + " * q.x)";
        case 4: return "-q";
        case 5: return "rotate2(q, floor(4 * hash(id)) * pi / " + nearly(2) + ")";
        case 6: return "q * vec2(2 * step(0.5, hash(id)) - " + nearly(1) + ", 1)";
        default: return "(if q.x > " + nearly(0) + " { q } else { vec2(-q.x, q.y) })";
        }
    }
    std::string drawn() {
        const std::string r = nearly(0.5);
        switch (pick(8)) {
        case 0:
            return "min(abs(length(q - 0.5) - " + r + "), abs(length(q + 0.5) - " + nearly(0.5) +
                   "))";
        case 1: return "abs(min(length(q - 0.5), length(q + 0.5)) - " + r + ")";
        case 2: return "min(abs(q.x), abs(q.y - " + nearly(0) + "))";
        case 3: return "abs(abs(q.x + " + nearly(1) + " * q.y) - 0.5) * 0.7";
        case 4:
            return "abs(length(q - (if q.x + q.y > " + nearly(0) + " { 0.5 } else { -0.5 })) - " +
                   r + ")";
        case 5: return "abs(length((if q.x > -q.y { q } else { -q }) - 0.5) - " + r + ")";
        case 6: return "abs(length(q - sign(q.x + q.y + " + nearly(0) + ") * 0.5) - " + r + ")";
        default: return "length(max(abs(q) - " + nearly(0.5) + ", 0))";
        }
    }
    // Comparisons that are equal in places with an inside, at which arms need not meet.
    std::string flat() {
        const std::string x = of({"q.x", "q.y", "p.x", "p.y"});
        const std::string top =
            of({"max(" + x + ", 0) <= 0", "min(" + x + ", 0) < 0", "sign(max(" + x + ", 0)) == 0",
                "max(0.25, " + x + ") > 0.25", "abs(" + x + ") + " + x + " <= 0",
                "fract(max(" + x + ", 0)) <= 0", "floor(max(" + x + ", 0)) > 0"});
        const std::string arm = of({"min(" + x + ", 0) * hash(id)", "max(" + x + ", 0) * hash(id)",
                                    x + " * hash(id)", "min(0, 0.25 - " + x + ") * hash(id)"});
        return often() ? "(if " + top + " { " + arm + " } else { 0 })"
                       : "(if " + top + " { 0 } else { " + arm + " })";
    }
    std::string of(std::initializer_list<std::string> texts) {
        return texts.begin()[pick(texts.size())];
    }
    std::string of(std::initializer_list<const char *> texts) { return Chance::of(texts); }

    std::string cells() {
        const std::string size = of({"1", "1", "0.5", "0.75", "1.25"}),
                          whole = of({"floor", "floor", "round"});
        std::string out = "  let id = " + whole + "(p.xz / " + size + ")\n  var q = p.xz / " +
                          size + " - id" + (whole == "floor" ? " - " + nearly(0.5) : "") + "\n";
        for (std::size_t i = pick(3); i > 0; --i)
            out += often() ? "  q = if " + chosen() + " { " + moved() + " } else { q }\n"
                           : "  q = " + moved() + "\n";
        out += pick(3) == 0
                   ? "  let d = if " + chosen() + " { " + drawn() + " } else { " + drawn() + " }\n"
                   : "  let d = " + drawn() + "\n";
        return out + "  " + solid() + (pick(5) == 0 ? " + " + flat() : "") + "\n";
    }
    // Balls or boxes of a cell and those beside it, of which some are too large for those that are
    // looked at; along one axis or two.
    std::string neighbours() {
        const bool round = often(), row = pick(3) > 0;
        const std::string from = pick(6) == 0 ? "0"
                                 : round      ? "-1"
                                              : "0",
                          cell = row ? "vec2(x, 0)" : "vec2(x, y)",
                          r = of({"0.3", "0.5 * hash(c)", "0.7 * hash(c)", "0.1 + 0.9 * hash(c)",
                                  "0.2 + 0.3 * hash(c)", "0.4 * own(c)"}),
                          off = of({"0", "0", "0", "0.1 * (hash(c) - 0.5)", "0.1 * sin(3 * c)",
                                    "0.5 * sin(tau * vec2(hash(c), hash(c + 7)))"});
        const std::string ball = "length(q - " + cell + " - " + off + ") - " + r,
                          box = "max(abs(q.x - x), abs(q.y)) - " + r;
        const std::string at = row ? "vec2(p.x, 0)" : "p.xz";
        return "  let i = " + std::string(round ? "round" : "floor") + "(" + at +
               ")\n  let q = p.xz - i\n  var d = 10.0\n  for x in " + from + "..=1 {" +
               (row ? "" : " for y in " + from + "..=1 {") + "\n    let c = i + " + cell +
               "\n    d = min(d, " + (row && pick(4) == 0 ? box : ball) + ")\n  }" +
               (row ? "" : " }") + "\n  " + solid() + "\n";
    }
    // Rows and blocks that end, of copies that differ by their number or rise with it, cut by a
    // distance that now and then is more than the way to the next copy that is not looked at.
    std::string rows() {
        const bool block = pick(3) == 0;
        const std::string size = of({"1", "0.75", "0.5"}), whole = of({"round", "floor"}),
                          lo = number(-double(pick(3))), hi = nearly(double(pick(3))),
                          beside = of({"0", "0", "1"}), at = block ? "p.xz" : "p.x",
                          id = block ? "c.x" : "c";
        const auto limited = [&](const std::string &n) {
            return pick(4) == 0 ? n : "clamp(" + n + ", " + lo + ", " + hi + ")";
        };
        const std::string up = of({"0", "0.3 * " + id, "0.2 * sin(" + id + ")",
                                   "0.25 * abs(" + id + ")", "-0.5 * " + id}),
                          r = of({"0.1", "0.05 + 0.1 * hash(c)", "0.1 + 0.02 * " + id,
                                  "0.2 * hash(c)", "(if " + id + " > 0 { 0.15 } else { 0.1 })"}),
                          middle = whole == "floor" ? " + 0.5" : "";
        const std::string way = block ? "length(vec3(q.x, p.y - " + up + ", q.y))"
                                      : "length(vec2(q, p.y - " + up + "))";
        const std::string box =
            "max(abs(q" + std::string(block ? ".x" : "") + "), abs(p.y - " + up + ") - 0.2)";
        return "  let n = " + limited(whole + "(" + at + " / " + size + ")") +
               "\n  var d = 9.0\n  for k in -" + beside + "..=" + beside +
               " {\n    let c = " + limited("n + k") + "\n    let q = " + at + " - " + size +
               " * (c" + middle + ")\n    d = min(d, " + (pick(3) == 0 ? box : way) + " - " + r +
               ")\n  }\n  min(d, " + number(0.05 + 0.1 * double(pick(8))) + ")\n";
    }
    std::string waves() {
        const std::string pi = of({"pi", "3.14159265", "3.1415927", "3.1416", "3.14159"}),
                          n = number(double(pick(4) + 1) + (pick(8) == 0 ? 0.1 : 0)),
                          by = of({"hash(floor(p.x))",
                                   "(if hash(floor(p.x)) > 0.5 { 1 } else { -1 })",
                                   "(2 * (floor(p.x) % 2) - 1)", "own(floor(p.xx))",
                                   "floor(3 * hash(floor(p.x)))", "hash(floor(p.x) + 1)"}),
                          wave = of({"sin(" + n + " * " + pi + " * fract(p.x))",
                                     "(1 - cos(2 * " + pi + " * p.x))", "sin(" + pi + " * p.x)",
                                     "fract(p.x) * (1 - fract(p.x))",
                                     "(0.5 - abs(fract(p.x) - " + nearly(0.5) + "))"});
        return "  p.y - 0.2 * " + by + " * " + wave + "\n";
    }
};

} // namespace

TEST_CASE("a tiling is refused, or does not jump where its cells meet") {
    const Judged judged = judge_scenes<Tiling>(effort(100), 1000);
    CHECK(judged.wrong == 0);
    CHECK(judged.accepted > judged.scenes / 5);
    CHECK(judged.accepted < judged.scenes * 4 / 5);
}
