// A random search over grids of hexagons by two lattices, written as people write them and off by a
// little, and over folds of an angle inside of others and twists by a part of a turn. Whatever the
// checker accepts is measured (judge.h). FATHOM_EFFORT=20 is the long form.
#include "judge.h"
#include "tests/support/effort.h"

#include <catch2/catch.hpp>

using namespace fathom;
using namespace fathom::test;

namespace {

class NearlyRight : public Chance {
  public:
    using Chance::Chance;

  protected:
    // A number that a field without a jump needs, or now and then another.
    double nearly(double right) {
        constexpr double off[] = {0.03, -0.03, 0.004, 0.3, -0.5};
        return pick(20) == 0 ? right + off[pick(5)] : right;
    }
    std::string text(double x) {
        char out[32];
        std::snprintf(out, sizeof out, "%.9g", x);
        return out;
    }
};

class Hexagons : public NearlyRight {
  public:
    using NearlyRight::NearlyRight;

    std::string scene() {
        const double x = of_scale(), y = x * (pick(3) == 0 ? 0.75 + random() : 1.7320508);
        const bool turned = pick(4) == 0;
        std::string out = "let s = vec2(" + text(float(turned ? y : x)) + ", " +
                          text(float(turned ? x : y)) +
                          ")\nparam k = 0.2 in -1..2\nimplicit(p => {\n";
        const std::string at = of({"p.xz", "p.xz", "(p.xz - vec2(0.3, 0.2))", "p.zy",
                                   "(p.xz + vec2(0.2 * time, k))", "rotate2(p.xz, k)"});
        const std::string first = grid(at, 0, 0),
                          second = other(at, turned ? y : x, turned ? x : y);
        out += "  let a = " + first + "\n  let b = " + second + "\n";
        const std::string by = of({"dot(@, @)", "dot(@, @)", "length(@)", "length(@)"}),
                          more = pick(12) == 0 ? "1.1 * " : "";
        out += "  let g = if " + with(by, "a") + of({" < ", " < ", " <= "}) + more + with(by, "b") +
               " { a } else { b }\n";
        if (pick(3) == 0) return out + "  " + cells(at, x) + "\n}, within: ball(2))\n";
        return out + "  " + solid() + "\n}, within: ball(2))\n";
    }

  private:
    double of_scale() { return pick(3) == 0 ? 0.5 : pick(3) == 0 ? 0.8 : 1; }
    static std::string with(std::string text, const std::string &name) {
        for (std::size_t i = text.find('@'); i != std::string::npos; i = text.find('@'))
            text.replace(i, 1, name);
        return text;
    }
    // The way from a lattice's points, its borders midway, `shift` of a period beside the first one's;
    // or its borders `off` it.
    std::string grid(const std::string &at, double shift, double off) {
        const std::string c = text(nearly(0.5) + shift), h = text(nearly(0.5)),
                          o = text(shift + off),
                          moved = shift == 0 && off == 0 ? at : "(" + at + " - s * " + o + ")";
        if (off != 0) return at + " - s * (floor((" + at + " - s * " + o + ") / s) + " + c + ")";
        switch (pick(9)) {
        case 0: return moved + " % s - s / 2";
        case 1: return "(fract(" + moved + " / s) - " + h + ") * s";
        case 2: return moved + " - s * round(" + moved + " / s - 0.5) - s * " + h;
        case 3: return moved + " - (ceil(" + moved + " / s) - " + h + ") * s";
        case 4: return moved + " - s * floor(" + moved + " / s) - s * 0.5";
        case 5: return at + " - s * (round((" + at + " - s * " + c + ") / s) + " + c + ")";
        default: return at + " - s * (floor(" + moved + " / s) + " + c + ")";
        }
    }
    std::string other(const std::string &at, double x, double y) {
        if (pick(3) > 0) return grid(at, nearly(0.5), 0);
        // borders as they are often written, of which not all are midway
        const double u = pick(3) == 0 ? x * (0.2 + 0.6 * random()) : x / 2,
                     v = pick(3) == 0 ? y * (0.1 + 0.8 * random()) : y * 0.57735;
        return at + " - s * (floor((" + at + " - vec2(" + text(float(u)) + ", " + text(float(v)) +
               ")) / s) + " + of({"1", "1", "1", "2", "0.9"}) + ")";
    }
    // Solids that differ from cell to cell, ended about where the next cell begins.
    std::string cells(const std::string &at, double period) {
        const double r = 0.2 + 0.25 * random(), way = period / 2 - r;
        const std::string size = text(float(r)), end = text(float(way * (0.4 + 0.7 * random()))),
                          id = "let id = " + at + " - g\n  ",
                          height = of({"0.3 * sin(2 * id.x + id.y)", "0.3 * hash(id)",
                                       "0.2 * fract(sin(dot(id, vec2(12.9, 78.2))) * 437.5)",
                                       "0.2 * sin(time + id.y)"});
        const std::string column = "abs(p.y) - 0.1 - " + height;
        switch (pick(4)) {
        case 0: return id + "min(max(length(g) - " + size + ", " + column + "), " + end + ")";
        case 1:
            return id + "let w = vec2(max(dot(abs(g), s / length(s)), abs(g.x)) - " + size + ", " +
                   column + ")\n  min(min(max(w.x, w.y), 0) + length(max(w, 0)), " + end + ")";
        case 2:
            return id + "min(length(vec3(g.x, p.y - " + height + ", g.y)) - " + size + ", " + end +
                   ")";
        default:
            return id + "min(max(max(dot(abs(g), s * 0.5), abs(g).x) - " + size + ", " + column +
                   "), " + end + ")";
        }
    }
    std::string solid() {
        const std::string r = between(0.2, 0.45);
        switch (pick(8)) {
        case 0: return "length(vec3(g.x, p.y, g.y)) - " + r;
        case 1: return "max(length(g) - " + r + ", abs(p.y) - 0.2)";
        case 2: return "max(dot(abs(g), s * 0.5), abs(g).x) - " + r;
        case 3: return "max(dot(abs(g), s / length(s)), abs(g.x)) - " + r;
        case 4: return "dot(g, g) - " + r;
        case 5: return "min(dot(a, a), dot(b, b)) - " + r;
        case 6: return "max(abs(g.x), abs(g.y)) - " + r;
        default: return "0.4 * cos(4 * length(g)) + p.y";
        }
    }
};

class Turned : public NearlyRight {
  public:
    using NearlyRight::NearlyRight;

    std::string scene() {
        std::string out = "fn fold(p: vec2, n: float) -> vec2 {\n  let g = tau / n\n  let a = " +
                          of({"(atan(p.y, p.x) + g / 2) % g - g / 2",
                              "atan(p.y, p.x) - g * round(atan(p.y, p.x) / g)",
                              "atan(p.y, p.x) - g * floor(atan(p.y, p.x) / g + 0.5)",
                              "abs((atan(p.y, p.x) + g / 2) % g - g / 2)"}) +
                          "\n  vec2(cos(a), sin(a)) * length(p)\n}\nimplicit(point => {\n"
                          "  var p = point\n";
        return out + (often() ? nested() + "}, within: ball(2))\n"
                              : twisted() + "}, within: aabb([-2, -2, -2], [-0.3, 2, 2]))\n");
    }

  private:
    std::string nested() {
        std::string out, plane = "xz";
        for (std::size_t i = 2 + pick(2); i > 0; --i) {
            out += "  p." + plane + " = fold(p." + plane + ", " +
                   text(nearly(double(2 + pick(7)))) + ")\n";
            out += "  p" + (pick(8) == 0 ? "." + plane.substr(1) : ".x") +
                   " -= " + between(0.2, 1) + "\n";
            if (pick(5) == 0) out += "  p.y = abs(p.y) - " + between(0, 0.4) + "\n";
            plane = of({"xy", "xy", "xz", "yz"});
        }
        return out + "  " +
               of({"length(p) - 0.2", "length(vec2(p.x, p.y)) - 0.2",
                   "max(abs(p.x), abs(p.y)) - 0.3", "length(p - vec3(0.3, 0, 0)) - 0.1",
                   "length(max(abs(p) - 0.2, 0)) - 0.05"}) +
               "\n";
    }
    std::string twisted() {
        const double quarters = double(1 + pick(6));
        const std::string rate = text(nearly(quarters / 4));
        std::string out = "  let v = vec2(length(p.xz) - 1, p.y)\n  var r = rotate2(v, " +
                          of({"", "-"}) + rate + " * atan(p.z, p.x)" +
                          (pick(4) == 0 ? " + time" : "") + ")\n";
        if (pick(3) == 0) out += "  r = fold(r, " + text(nearly(4)) + ")\n";
        if (pick(3) == 0) out += "  r = abs(r) - " + between(0, 0.2) + "\n";
        return out + "  " +
               of({"max(abs(r.x), abs(r.y)) - 0.2", "max(abs(r.x), 1.02 * abs(r.y)) - 0.2",
                   "length(max(abs(r) - 0.15, 0)) - 0.05", "abs(r.x) + abs(r.y) - 0.3",
                   "length(max(abs(r) - vec2(0.15, 0.1), 0)) - 0.05", "max(abs(r.x), r.y) - 0.2",
                   "min(abs(r.x), abs(r.y)) - 0.05", "abs(r.x * r.y) - 0.02",
                   "length(r - vec2(0.2, 0)) - 0.1", "r.x * r.x * r.y * r.y - 0.01"}) +
               "\n";
    }
    std::string of(std::initializer_list<std::string> texts) {
        return texts.begin()[pick(texts.size())];
    }
    std::string of(std::initializer_list<const char *> texts) { return Chance::of(texts); }
};

// What turns about an axis and vanishes on it, beside what is the same all around, or nearly (2.19).
class BesideTurn : public Chance {
  public:
    using Chance::Chance;

    std::string scene() {
        const std::string rate = of({"3", "5", "k", "8", "1", "2"}),
                          rest = of({"", "", " + time", " - 4 * r", " + 2 * p.y", " + q"});
        std::string out = "param k = 4 in 2..6\nparam q = 0.3 in -1..1\n"
                          "implicit(p => {\n  let r = length(p.xz)\n  let a = atan(p.z, p.x)\n";
        out += "  let turns = " + of({"sin(", "cos("}) + rate + " * a" + rest + ")\n";
        out += "  let m = " +
               of({"r", "min(r, 0.5)", "smoothstep(0, 0.6, r)", "tanh(r)", "p.x", "abs(p.z)",
                   "clamp(r, 0, 0.4)", "0.5 * sin(r)"}) +
               "\n";
        out += "  let still = " +
               of({"length(p) - 1", "r - 1", "length(vec2(r - 1, p.y)) - 0.3", "r + 0.3 * p.y",
                   "max(r - 1, abs(p.y) - 0.5)", "dot(p.xz, p.xz) - 1", "sqrt(dot(p, p) + 0.1) - 1",
                   // what is not the same all around
                   "length(p - vec3(0.3, 0, 0)) - 1", "p.x", "length(p.xy) - 1", "p.x + r",
                   "length(vec3(p.x, p.y, 1.1 * p.z)) - 1", "length(p * vec3(1, 2, 1)) - 1",
                   "abs(p.x) - 1", "p.x * p.z + r"}) +
               "\n";
        const std::string by = between(0.05, 0.5), product = of({"turns * m", "m * turns"});
        switch (pick(4)) {
        case 0: out += "  let d = still - " + by + " * (" + product + ")\n"; break;
        case 1: out += "  let d = " + by + " * turns * m + still\n"; break;
        case 2: out += "  let d = still - (" + product + ") * " + by + "\n"; break;
        default: out += "  let d = still + " + by + " * m * turns\n"; break;
        }
        return out + "  " + of({"d", "max(d, abs(p.y) - 0.6)", "min(d, p.y + 0.5)"}) +
               "\n}, within: ball(2))\n";
    }
};

} // namespace

TEST_CASE("what turns beside what is the same all around is no steeper than proved") {
    const Judged judged = judge_scenes<BesideTurn>(effort(60), 1000);
    CHECK(judged.wrong == 0);
    CHECK(judged.accepted > judged.scenes / 3);
}

TEST_CASE("hexagons of two lattices are refused, or do not jump") {
    const Judged judged = judge_scenes<Hexagons>(effort(60), 1000);
    CHECK(judged.wrong == 0);
    CHECK(judged.accepted > judged.scenes / 4);
    CHECK(judged.accepted < judged.scenes * 9 / 10);
}

TEST_CASE("folds and twists of angles are refused, or do not jump") {
    const Judged judged = judge_scenes<Turned>(effort(30), 600);
    CHECK(judged.wrong == 0);
    CHECK(judged.accepted > judged.scenes / 5);
    CHECK(judged.accepted < judged.scenes * 9 / 10);
}

TEST_CASE("a section turns by a quarter about its ring where it is the same then") {
    // by a part of the angle, in a region less a tube about its axis
    const auto bound_of = [](const std::string &section,
                             const std::string &by) -> std::optional<double> {
        const driver::Compilation c = driver::compile_text(
            "turns.sdf",
            "implicit(p => { let r = rotate2(vec2(length(p.xz) - 1, p.y), " + by +
                " * atan(p.z, p.x))\n  " + section + " - 0.2 }, within: ball(2) - tube(Y, 0.3))\n",
            "", {});
        if (!c.good()) return {};
        return c.scene.facts[c.scene.root.index].lipschitz_sup;
    };
    struct Twist {
        std::string section, by;
    };
    for (const auto &[section, by] :
         {Twist{"max(abs(r.x), abs(r.y))", "0.25"}, Twist{"max(abs(r.x), abs(r.y))", "-0.75"},
          Twist{"abs(r.x) + abs(r.y)", "0.75"}, Twist{"length(max(abs(r) - 0.1, 0))", "0.25"},
          Twist{"max(abs(r.x), abs(r.y))", "time + 0.25"}}) {
        INFO(section << " by " << by);
        CHECK(bound_of(section, by).value_or(100) < 15); // 2.12 times the slope beside the tube
    }
    for (const auto &[section, by] :
         {Twist{"max(abs(r.x), 0.98 * abs(r.y))", "0.25"}, Twist{"max(abs(r.x), r.y)", "0.25"},
          Twist{"max(abs(r.x), abs(r.y))", "0.252"}, Twist{"length(r - 0.1)", "0.25"},
          Twist{"max(abs(r.x), abs(r.y))", "time * 0.25"},
          Twist{"length(max(abs(r) - vec2(0.1, 0.12), 0))", "0.75"}}) {
        INFO(section << " by " << by);
        CHECK(!bound_of(section, by));
    }
}
