// A random search over what is joined by a length of numbers of known signs, as rounded unions are
// (lipschitz.md, 2.36); over numbers that `if` keeps in order, as the least and the second of several
// (2.37), some in the wrong order; and over loops of folds that swap components by comparing them, and
// turn by the time (2.7). Whatever the checker accepts is measured (judge.h). FATHOM_EFFORT=20 is the
// long form.
#include "judge.h"

#include <catch2/catch.hpp>

using namespace fathom;
using namespace fathom::test;

namespace {

class Corner : public Chance {
  public:
    using Chance::Chance;

    std::string scene() {
        std::string out = "implicit(p => {\n";
        const std::size_t parts = 2 + pick(3);
        for (std::size_t i = 0; i < parts; ++i) out += "  let " + name(i) + " = " + part() + "\n";
        return out + "  " + joined(parts) + "\n}, within: ball(2))\n";
    }

  private:
    static std::string name(std::size_t i) { return std::string(1, "abcd"[i]); }
    std::string vector() {
        return "vec3(" + between(-1, 1) + ", " + between(-1, 1) + ", " + between(-1, 1) + ")";
    }
    std::string part() {
        switch (pick(8)) {
        case 0: return "length(p - " + vector() + ") - " + between(0.2, 1);
        case 1: return "dot(p, " + vector() + ") + " + between(-0.5, 0.5);
        case 2: return between(0.2, 1) + " - length(p.xz)";
        case 3: return of({"p.x", "-p.x", "p.y - 0.3", "abs(p.y) - 0.4", "0.3 - p.z"});
        case 4: return "0.2 * sin(" + between(1, 6) + " * p.x + p.y)";
        case 5: return "max(abs(p.x) - 0.5, abs(p.z) - " + between(0.2, 1) + ")";
        case 6: return "length(vec2(length(p.xz) - 0.8, p.y)) - 0.3";
        default: return "0.5 * p.x * p.y";
        }
    }
    // Above 0, below 0, or of any sign.
    std::string limited(std::size_t i) {
        switch (pick(5)) {
        case 0: return "max(" + between(0, 0.4) + " - " + name(i) + ", 0)";
        case 1: return "min(" + name(i) + ", 0)";
        case 2: return name(i);
        default: return "max(" + name(i) + ", 0)";
        }
    }
    std::string joined(std::size_t parts) {
        const std::string k = between(0.05, 0.5);
        switch (pick(6)) {
        case 0: return "max(" + k + ", min(a, b)) - length(max(" + k + " - vec2(a, b), 0))";
        case 1: return "min(-" + k + ", max(a, b)) + length(max(" + k + " + vec2(a, b), 0))";
        case 2: return "length(max(vec2(a, b), 0)) + min(max(a, b), 0)";
        case 3: return "length(max(vec2(a, b), 0)) - " + k;
        default: break;
        }
        std::string out = "length(vec" + std::to_string(parts) + "(";
        for (std::size_t i = 0; i < parts; ++i) out += (i > 0 ? ", " : "") + limited(i);
        return out + ")) - " + k;
    }
};

class Ordered : public Chance {
  public:
    using Chance::Chance;

    std::string scene() {
        const bool cells = often(), three = pick(3) == 0, by_square = pick(4) == 0;
        std::string out = "implicit(p => {\n", turns = "  ", ends = "  ";
        out += cells ? "  let n = floor(p.xz)\n  let u = p.xz - n\n" : "";
        const std::string far = of({"8", "9", "1e3"});
        out += "  var d1 = " + (pick(8) == 0 ? "9.5" : far) + "\n  var d2 = " + far + "\n";
        out += three ? "  var d3 = " + far + "\n" : "";
        if (cells)
            out += "  for j in -1..=1 { for i in -1..=1 {\n    let g = vec2(i, j)\n"
                   "    let o = 0.5 + " +
                   of({"0", "0.1", "0.2"}) +
                   " * sin(tau * vec2(hash(n + g), hash(n + g + 7)))\n    let r = g + o - u\n";
        else
            out += "  for i in 0..5 {\n    let r = p - vec3(cos(" + between(1, 3) +
                   " * i), 0.3 * i - 0.6, sin(2 * i))\n";
        out += by_square ? "    let d = dot(r, r)\n" : "    let d = length(r)\n";
        out += kept(three) + (cells ? "  } }\n" : "  }\n");
        const std::string a = by_square ? "sqrt(d1)" : "d1", b = by_square ? "sqrt(d2)" : "d2",
                          c = three ? (by_square ? "sqrt(d3)" : "d3") : b;
        switch (pick(4)) {
        case 0: out += "  p.y + 0.3 * (" + b + " - " + a + ")\n"; break;
        case 1: out += "  " + c + " - " + a + " - 0.1\n"; break;
        case 2: out += "  0.5 * (" + a + " + " + c + ") - 0.4\n"; break;
        default: out += "  " + b + " - 0.5\n"; break;
        }
        return out + "}, within: ball(2))\n";
    }

  private:
    std::string kept(bool three) {
        const std::string less = of({"<", "<", "<="}), wrong = pick(5) == 0 ? "d" : "d1";
        if (three)
            return "    if d " + less + " d1 {\n      d3 = d2\n      d2 = " + wrong +
                   "\n      d1 = d\n    } else if d " + less +
                   " d2 {\n      d3 = d2\n      d2 = d\n    } else if d < d3 { d3 = d }\n";
        switch (pick(4)) {
        case 0:
            return "    if d " + less + " d1 {\n      d2 = " + wrong +
                   "\n      d1 = d\n    } else { d2 = min(d2, d) }\n";
        case 1:
            return "    if d " + less +
                   " d2 {\n      d2 = d\n      if d2 < d1 {\n"
                   "        d2 = d1\n        d1 = " +
                   (wrong == "d" ? "0.9 * d" : "d") + "\n      }\n    }\n";
        default:
            return "    if d " + less + " d1 {\n      d2 = " + wrong +
                   "\n      d1 = d\n    } else if d " + of({"<", "<="}) + " d2 { d2 = d }\n";
        }
    }
};

class Swapped : public Chance {
  public:
    using Chance::Chance;

    std::string scene() {
        std::string out = "param k = 0.3 in -1..2\nimplicit(point => {\n  var p = point\n";
        const bool loop = often();
        index_ = loop ? "i" : "1";
        out += loop ? "  for i in 0.." + number(double(2 + pick(4))) + " {\n" : "";
        for (std::size_t i = 2 + pick(4); i > 0; --i) out += "    " + fold() + "\n";
        out += loop ? "  }\n" : "";
        return out + "  " +
               of({"length(p) - 0.7", "max(abs(p.x), abs(p.y)) - 0.4", "p.x",
                   "length(max(abs(p) - 0.3, 0))", "0.5 * (p.x + p.y)", "min(p.x, p.y + p.z)"}) +
               "\n}, within: ball(2))\n";
    }

  private:
    std::string index_;
    int normals_ = 0;

    // Over a plane whose normal depends on the loop's index, of length 1 or nearly.
    std::string reflection() {
        const std::string turn = between(0, 3) + " + " + between(-1, 1) + " * " + index_;
        const std::string n =
            of({"normalize(vec3(1, @, 0.3))", "vec3(cos(@), sin(@), 0)", "normalize(vec3(@, 0, 1))",
                "vec3(sin(@), 0, cos(@)) * 1.2", "vec3(1, @, 0)", "normalize(vec3(k, @, 1))"});
        std::string normal;
        for (const char c : n) normal += c == '@' ? "(" + turn + ")" : std::string(1, c);
        const std::string own = "n" + number(double(++normals_));
        return "let " + own + " = " + normal + "\n    p -= " + of({"2", "2", "2", "1", "2.3"}) +
               " * min(0, dot(p, " + own + ") - " + of({"0", "0", "0.2"}) + ") * " + own;
    }
    // Of two numbers that may be equal on a set with an inside, too.
    std::string compared(const std::string &a, const std::string &b) {
        const std::string less = of({" < ", " <= ", " > ", " >= "});
        switch (pick(5)) {
        case 0: return "max(" + a + ", 0)" + less + "max(" + b + ", 0)";
        case 1: return "abs(" + a + ")" + less + "abs(" + b + ")";
        default: return a + less + b;
        }
    }
    std::string fold() {
        const std::string two = of({"xy", "xz", "yz"}), a = "p." + two.substr(0, 1),
                          b = "p." + two.substr(1), back = two.substr(1) + two.substr(0, 1);
        switch (pick(15)) {
        case 8:
        case 9: return reflection();
        case 10: return a + " = abs(" + a + ")" + of({"", " - 0.2"});
        case 11:
        case 12: {
            const std::string matrix =
                of({"mat2([0.8, 0.6], [-0.6, 0.8])", "mat2([0.8, -0.6], [0.6, 0.8])",
                    "mat2([0, 1], [1, 0])", "mat2([1, 0.5], [0, 1])"});
            const int side = pick(3);
            return "p." + two + " = " +
                   (side == 0   ? matrix + " * p." + two
                    : side == 1 ? "p." + two + " * " + matrix
                                : matrix + " * vec2(abs(" + a + "), " + b + ")");
        }
        case 13: return "p *= " + of({"1.25", "0.8", "-1"});
        case 0: return "p = abs(p) - " + between(0, 0.4);
        case 1:
            return "p." + two + " = if " + compared(a, b) + " { p." + back + " } else { p." + two +
                   " }";
        case 2: return "if " + a + of({" < ", " <= "}) + b + " { p." + two + " = p." + back + " }";
        case 3: return "p." + two + " = vec2(max(" + a + ", " + b + "), min(" + a + ", " + b + "))";
        case 4: return "p." + two + " = vec2(max(" + a + ", " + b + "), max(" + a + ", 0.1))";
        case 5: {
            const std::string angle = of({"0.3 + 0.2 * sin(time)", "time", "k", "0.7"});
            return "p." + two + " = vec2(cos(" + angle + ") * " + a + " + sin(" + angle + ") * " +
                   b + ", cos(" + angle + ") * " + b + " - sin(" + angle + ") * " +
                   (pick(6) == 0 ? b : a) + ")";
        }
        case 6: return "p." + two + " = rotate2(p." + two + ", k)";
        case 7:
            return "p." + two + " = vec2(min(" + a + ", " + b + "), if " + a + " < " + b + " { " +
                   b + " } else { " + a + " })";
        default: return "p = p - vec3(" + between(-0.3, 0.3) + ", 0.1, " + between(0, 0.3) + ")";
        }
    }
};

// Solids in frames of unit vectors that move, or of what nearly are such (2.47).
class Framed : public Chance {
  public:
    using Chance::Chance;

    std::string scene() {
        std::string out = "param k = 0.5 in 0.2..1\nparam n = 1 in -1..1\nimplicit(p => {\n";
        out += "  let a = " + vector() + "\n  let b = " + vector() + " + vec3(0, 0, 2.5)\n";
        out += "  let d = b - a\n  let up = " +
               of({"vec3(0, 1, 0)", "vec3(1, 0, 0)", "vec3(0.6, 0.8, 0)", "vec3(0, k, 0.1)"}) +
               "\n";
        out += "  let w = " +
               of({"normalize(d)", "normalize(d)", "d / length(d)", "d / sqrt(dot(d, d))",
                   "0.4 * d"}) +
               "\n";
        out += "  let u = " +
               of({"normalize(cross(w, up))", "normalize(cross(up, w))", "normalize(cross(d, up))",
                   "cross(w, up)"}) +
               "\n";
        out += "  let v = " +
               of({"cross(u, w)", "cross(w, u)", "normalize(cross(u, d))", "cross(u, up)", "up"}) +
               "\n  let o = p - " + of({"a", "b", "vec3(0)", "0.5 * (a + b)"}) + "\n";
        out += "  let q = " +
               of({"vec3(dot(u, o), dot(v, o), dot(w, o))", "o * mat3(u, v, w)",
                   "transpose(mat3(u, v, w)) * o", "mat3(u, v, w) * o",
                   "u * o.x + v * o.y + w * o.z"}) +
               "\n";
        return out + "  " +
               of({"length(max(abs(q) - vec3(0.3, 0.2, 0.5), 0)) - 0.1",
                   "max(abs(q.x) - 0.3, length(q.yz) - 0.4)",
                   "length(vec2(length(q.xz) - 0.5, q.y)) - 0.2", "q.x + 0.1 * sin(4 * q.y)",
                   "length(q) - 0.5", "min(length(q.xy) - 0.2, abs(q.z) - 0.1)"}) +
               "\n}, within: ball(2))\n";
    }

  private:
    std::string vector() {
        const auto part = [&] {
            return of({"0.3", "-0.4", "k", "n", "0.5 * cos(time)", "0.5 * sin(time)", "k * n",
                       "0.2 + 0.3 * k"});
        };
        const std::string x = part(), y = part();
        return "vec3(" + x + ", " + y + ", " + part() + ")";
    }
};

} // namespace

TEST_CASE("what stands in a frame that moves is refused, or is no steeper than proved") {
    const Judged judged = judge_scenes<Framed>(effort(30), 400);
    CHECK(judged.wrong == 0);
    CHECK(judged.accepted > judged.scenes / 2);
}

TEST_CASE("folds that swap and turn are no steeper than proved") {
    const Judged judged = judge_scenes<Swapped>(effort(20), 400);
    CHECK(judged.wrong == 0);
    CHECK(judged.accepted > judged.scenes / 2);
}

TEST_CASE("a length of numbers of known signs is no steeper than proved") {
    const Judged judged = judge_scenes<Corner>(effort(28), 400);
    CHECK(judged.wrong == 0);
    CHECK(judged.accepted > judged.scenes * 3 / 4);
}

TEST_CASE("numbers that are kept in order are refused, or do not jump") {
    const Judged judged = judge_scenes<Ordered>(effort(20), 400);
    CHECK(judged.wrong == 0);
    CHECK(judged.accepted > judged.scenes / 3);
    CHECK(judged.accepted < judged.scenes);
}
