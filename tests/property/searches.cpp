// A random search over the nearest of several points, found one after another (lipschitz.md, 2.44),
// some by the wrong comparison or read by other than a length; and over cells that are counted by what
// a wave leaves of the point (2.43), which rounding alone may make another number at each point.
// Whatever the checker accepts is measured (judge.h). FATHOM_EFFORT=20 is the long form.
#include "judge.h"

#include <catch2/catch.hpp>

using namespace fathom;
using namespace fathom::test;

namespace {

class Nearest : public Chance {
  public:
    using Chance::Chance;

    std::string scene() {
        const std::size_t count = 2 + pick(5);
        std::string points;
        for (std::size_t i = 0; i < count; ++i) points += (i > 0 ? ", " : "") + point();
        const bool first = often(), by_square = pick(3) == 0, by_row = pick(3) == 0;
        const std::string d = by_square ? "dot(r, r)" : "length(r)";
        std::string out = "let at = [" + points + "]\nimplicit(p => {\n";
        if (first)
            out += "  let start = p - at[0]\n  var q = start\n  var best = " +
                   std::string(by_square ? "dot(start, start)" : "length(start)") + "\n";
        else
            out += "  var q = " + of({"p", "p", "vec3(0, 0, 0)", "p - at[0]"}) +
                   "\n  var best = " + of({"1000", "1000.0", "100", "1e9", "3", "0.9"}) +
                   " + 0.0\n";
        out += by_row ? "  var row = 0\n" : "";
        out += "  for i in " + std::string(first ? "1" : "0") + ".." + number(double(count)) +
               " {\n    let r = p - at[i]\n    let d = " + d + "\n    if " + compared() + " { " +
               (pick(12) == 0 ? "best = 0.9 * d" : "best = d") +
               (by_row ? "\n row = i }\n" : "\n q = r }\n") + "  }\n";
        if (by_row) out += "  q = p - at[row]\n";
        return out + "  " +
               of({"length(q) - 0.3", "length(q) - 0.3", "sqrt(dot(q, q)) - 0.3",
                   "0.5 * length(q) + 0.3 * p.y", "min(length(q), 0.4) - 0.2", "length(q.xz) - 0.2",
                   "length(q) - 0.1 * best", "length(q - vec3(0.01, 0, 0)) - 0.3", "q.y"}) +
               "\n}, within: ball(2))\n";
    }

  private:
    std::string point() {
        return "[" + between(-1, 1) + ", " + between(-1, 1) + ", " + between(-1, 1) + "]";
    }
    std::string compared() {
        return of({"d < best", "d < best", "d < best", "d <= best", "best > d", "d < 0.97 * best",
                   "d > best"});
    }
};

class Counted : public Chance {
  public:
    using Chance::Chance;

    std::string scene() {
        const double m = std::array{1.0, 0.7, 0.5, 1.3, 0.8}[pick(5)];
        m_ = pick(6) == 0 ? "k" : number(m);
        const std::string shift = of({"0", "0.35", "0.5", "0.1"});
        std::string out = "param k = " + number(m) + " in " + number(0.9 * m) + ".." +
                          number(1.1 * m) +
                          "\nfn left(a: vec2, b: vec2) -> vec2 = a - b\nimplicit(p => {\n";
        out += "  let q = " + wave(shift) + "\n  let s = abs(q) - " + number(0.15 * m) + "\n";
        return out + "  min(length(s) - " + number(0.1 * m) + " * " + told() + ", " +
               number(m * (pick(5) == 0 ? 0.6 : 0.08)) + ")\n}, within: ball(2))\n";
    }

  private:
    std::string m_;
    std::string wave(const std::string &shift) {
        switch (pick(4)) {
        case 0: return "(p.xz + " + shift + ") % " + m_ + " - " + m_ + " / 2";
        case 1: return m_ + " * (fract(p.xz / " + m_ + " + " + shift + ") - 0.5)";
        case 2: return "p.xz - " + m_ + " * round(p.xz / " + m_ + ")";
        default: return "mod(p.xz, " + m_ + ") - 0.5 * " + m_;
        }
    }
    std::string count() {
        return of({"p.xz - q", "(p.xz - q) / k", "left(p.xz, q)", "p.xz - q + 0.5 * k",
                   "floor((p.xz - q) / k)", "round((p.xz - q) / k)", "q - p.xz",
                   "p.xz - 0.99 * q"});
    }
    std::string told() {
        const std::string n = count();
        switch (pick(6)) {
        case 0: return "fract(sin(dot(" + n + ", vec2(12.9898, 78.233))) * 43758.5453)";
        case 1: return "(if (" + n + ").x > 0.1 { 1 } else { 0 })";
        case 2: return "(if (" + n + ").y < 0 { 0.3 } else { 1 })";
        case 3: return "step(0.5, hash((" + n + ").x))";
        default: return "hash(" + n + ")";
        }
    }
};

} // namespace

TEST_CASE("the nearest of several points is refused, or does not jump") {
    const Judged judged = judge_scenes<Nearest>(effort(40), 400);
    CHECK(judged.wrong == 0);
    CHECK(judged.accepted > judged.scenes / 4);
    CHECK(judged.accepted < judged.scenes);
}

TEST_CASE("cells that are counted by what a wave leaves are refused, or are of one number") {
    const Judged judged = judge_scenes<Counted>(effort(40), 400);
    CHECK(judged.wrong == 0);
    CHECK(judged.accepted > judged.scenes / 8);
    CHECK(judged.accepted < judged.scenes);
}
