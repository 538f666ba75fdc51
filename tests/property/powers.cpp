// A random search over sums of powers and their roots, as power smooth minima and maxima are
// (lipschitz.md, 2.40): powers of whole, broken and negative exponents and of params, of numbers that
// may be 0, joined by sums, quotients and inverses, and roots of these that fit, or nearly. And over
// signs times functions of what they are of, which are 0 there, or nearly (2.1); over rounded sizes
// and what norms are made of (2.2, 2.3).
// Whatever the checker accepts is measured (judge.h). FATHOM_EFFORT=10 is the long form.
#include "judge.h"

#include <catch2/catch.hpp>

using namespace fathom;
using namespace fathom::test;

namespace {

class PowerMean : public Chance {
  public:
    using Chance::Chance;

    std::string scene() {
        of_param_ = pick(4) == 0;
        const double k = pick(4) == 0 ? 1 + 7 * random() : double(1 + pick(9));
        k_ = of_param_ ? "k" : number(k);
        std::string out =
            of_param_ ? "param k = 3 in " + of({"1..4", "2..8", "3..3.5", "3..16"}) + "\n" : "";
        out += "implicit(p => {\n";
        const std::size_t parts = 2 + pick(2), style = pick(5);
        for (std::size_t i = 0; i < parts; ++i) {
            const std::string own = pick(10) == 0 ? power(name(i), pick(5)) : power(name(i), style);
            out += "  let " + name(i) + " = " + part() + "\n";
            out += "  let " + name(i) + "k = " + own + "\n";
        }
        const bool falls = style >= 3;
        out += "  let m = " + (pick(8) == 0 ? odd_one() : joined(parts == 3, falls)) + "\n";
        return out + "  " + root() + " - " + between(0.1, 0.8) + "\n}, within: ball(2))\n";
    }

  private:
    bool of_param_ = false, sum_falls_ = false;
    std::string k_;

    static std::string name(std::size_t i) { return std::string(1, "abc"[i]); }
    std::string vector() {
        return "vec3(" + between(-1, 1) + ", " + between(-1, 1) + ", " + between(-1, 1) + ")";
    }
    std::string part() {
        const std::string above = between(0.2, 1);
        switch (pick(10)) {
        case 0: return "length(p - " + vector() + ")";
        case 1: return "max(dot(p, " + vector() + ") + 0.4, " + of({"0.1", "0.3", "0"}) + ")";
        case 2: return "dot(p, " + vector() + ") + " + between(2, 5);
        case 3: return "length(vec2(length(p.xz) - 0.8, p.y)) + " + of({"0", "0.3"});
        case 4: return "abs(p.x) + " + above;
        case 5: return "1.5 + " + between(0.1, 1) + " * sin(3 * p.y + p.z)";
        case 6: return "length(max(abs(p - " + vector() + ") - 0.3, 0)) + " + above;
        default: return "length(p - " + vector() + ") + " + above;
        }
    }
    std::string power(const std::string &x, std::size_t style) {
        const std::string up = "pow(" + x + ", " + k_ + ")";
        switch (style) {
        case 0: return between(0.5, 2) + " * " + up;
        case 3: return "1 / " + up;
        case 4: return "pow(" + x + ", -" + k_ + ")";
        default: return up;
        }
    }
    std::string joined(bool three, bool falls) {
        sum_falls_ = falls;
        if (pick(3) == 0) return three ? "ak + bk + ck" : "ak + bk";
        if (falls || pick(3) == 0)
            return three ? "1 / (1 / ak + 1 / bk + 1 / ck)" : "1 / (1 / ak + 1 / bk)";
        return three ? of({"ak * bk * ck / (ak * bk + bk * ck + ck * ak)",
                           "ck * (ak * bk) / (ak * ck + (bk * ck + ak * bk))"})
                     : of({"ak * bk / (ak + bk)", "(bk * ak) / (ak + bk)",
                           "0.5 * ak * bk / (bk + ak)"});
    }
    // What is nearly such.
    std::string odd_one() {
        return of({"ak * bk / (ak + 2 * bk)", "ak * bk / (ak + bk + 0.1)", "ak * ak / (ak + bk)",
                   "ak / (ak + bk)", "ak * bk", "ak - 0.1 * bk", "ak / (ak + bk) * bk"});
    }
    std::string root() {
        const std::string fits = sum_falls_ ? "-1 / " : "1 / ",
                          inverse = sum_falls_ ? "1 / " : "-1 / ";
        switch (pick(12)) {
        case 0: return "sqrt(m)";
        case 1: return "pow(m, " + between(0.1, 1.4) + ")";
        case 2: return of({"1 / sqrt(m)", "m"});
        case 3: return "1 / pow(m, " + inverse + k_ + ")";
        default: return "pow(m, " + fits + k_ + ")";
        }
    }
};

class SignedFunction : public Chance {
  public:
    using Chance::Chance;

    std::string scene() {
        std::string out = "implicit(p => {\n  let u = " + turning() +
                          "\n  let w = " + of({"1", "cos(p.y)", "(1 + 0.2 * p.z)", "length(p)"}) +
                          "\n  ";
        const std::string sign = this->sign();
        switch (pick(6)) {
        case 0: out += "let d = " + sign + " * " + function() + " + " + function(); break;
        case 1: out += "let d = " + sign + " * w * " + function(); break;
        case 2: out += "let d = " + sign + " * " + function() + " * " + this->sign(); break;
        case 3: out += "let d = " + sign + " * (" + function() + " + " + function() + ")"; break;
        default: out += "let d = " + sign + " * " + function(); break;
        }
        return out + "\n  " + of({"d", "d - 0.1", "max(d, length(p) - 1)", "0.3 * d + p.y"}) +
               "\n}, within: ball(2))\n";
    }

  private:
    std::string turning() {
        return of({"p.x", "p.x + 0.3 * p.y", "length(p) - 1", "p.y - 0.2 * sin(3 * p.x)",
                   "sin(2 * p.x)", "dot(p, p) - 1", "p.x * p.y", "p.x - time * 0.1"});
    }
    std::string sign() {
        if (pick(8) == 0) return of({"(if u < 0 { 1 } else { 0 })", "step(0, u)", "sign(p.y)"});
        return of({"sign(u)", "sign(u)", "sign(-u)", "(2 * step(0, u) - 1)", "sign(2 * u)"});
    }
    std::string function() {
        const std::string k = between(0.5, 4), off = pick(6) == 0 ? between(0.9, 1.1) : "1";
        switch (pick(13)) {
        case 11: // steps of single precision at the corners are 4.9e-4
            return of(
                {"0.1 * asin(sin(9 * u))", "0.1 * acos(cos(8 * u))", "0.1 * asin(cos(10 * u))"});
        case 0: return "log(abs(u) + sqrt(u * u + " + off + "))";
        case 1: return "log(" + off + " + " + k + " * abs(u))";
        case 2: return "(" + off + " - exp(-" + k + " * abs(u)))";
        case 3: return "pow(abs(u), " + between(1, 3) + ")";
        case 4: return "(sqrt(abs(u) + 1) - " + off + ")";
        case 5: return "tanh(" + k + " * abs(u))";
        case 6: return "atan(" + k + " * abs(u))";
        case 7: return "(" + off + " - cos(" + k + " * u))";
        case 8: return "smoothstep(0, " + k + ", abs(u))";
        case 9: return "exp2(abs(u))";
        case 10: return "(cosh(u) - " + off + ")";
        default: return "abs(u) / (" + k + " + abs(u))";
        }
    }
};

// Sizes with their corners rounded, norms of powers of what is never below 0, or nearly is, and
// inverses of cosh.
class RoundedNorm : public Chance {
  public:
    using Chance::Chance;

    std::string scene() {
        std::string out =
            "implicit(p => {\n  var q = " + of({"p", "p.zxy", "1.5 * p", "p * p.yzx"}) + " - " +
            vector() + "\n";
        for (std::size_t i = 1 + pick(3); i > 0; --i)
            out += "  q = " + rounded() + "\n  q.xz = rotate2(q.xz, " + between(-2, 2) + ")\n";
        return out + "  " + norm() + " - " + between(0.2, 0.6) + "\n}, within: ball(2))\n";
    }

  private:
    std::string vector() {
        return "vec3(" + between(-1, 1) + ", " + between(-1, 1) + ", " + between(-1, 1) + ")";
    }
    std::string rounded() {
        const std::string c = between(0.001, 0.3);
        switch (pick(9)) {
        case 0: return "sqrt(q * q + vec3(" + c + ", 0.02, " + of({"0.3", "0", "-0.01"}) + "))";
        case 1: return "sqrt(" + c + " * " + c + " + q * q) - " + c;
        case 2: return "sqrt(" + of({"q * q.yzx", "2 * q * q", "q * q"}) + " + " + c + ")";
        case 3: return "sqrt(q * q " + of({"+ 0.01 * p.x * p.x", "- 0.001", "+ vec3(q.x)"}) + ")";
        case 4: return "max(q, " + of({"0", "0", "-0.1", "0.1"}) + ")";
        case 5: return "clamp(q, 0, " + between(0.5, 3) + ")";
        default: return "sqrt(q * q + " + c + ") - " + between(0.1, 0.8);
        }
    }
    std::string of_directions() {
        const std::string n = of({"2", "3", "4", "6", "9", "12", "2.5", "1.5"});
        std::string sum;
        for (std::size_t i = 2 + pick(5); i > 0; --i)
            sum += (sum.empty() ? "" : " + ") +
                   ("pow(abs(dot(q, " + vector() + ")" + of({"", "", " - 0.2"}) + "), " + n + ")");
        return "pow(" + sum + ", 1 / " + n + ")";
    }
    std::string norm() {
        const std::string n = of({"3", "5", "2.5", "1.5", "1", "7"}),
                          root = pick(6) == 0 ? between(0.2, 1) : "1 / " + n;
        const std::string with = "pow(max(q.x, 0), " + n + ") + pow(q.y, " + n + ") + pow(" +
                                 of({"abs(q.z)", "max(q.z, 0)", "clamp(q.z, 0, 1)", "q.z"}) + ", " +
                                 n + ")";
        switch (pick(8)) {
        case 6:
        case 7: return of_directions();
        case 0: return "pow(" + with + ", " + root + ")";
        case 1: {
            const std::string m = "let m = " + of({"max(q, 0)", "max(q, -0.1)", "abs(q)"}) + "\n  ";
            return m + "pow(pow(m.x, " + n + ") + pow(m.y, " + n + ") + pow(m.z, " + n + "), " +
                   root + ")";
        }
        case 2: return "acosh(" + of({"1", "max(1, 1)", "0.9"}) + " + 0.5 * dot(q, q))";
        case 3: return "acosh(1 + " + of({"q.x * q.x", "abs(q.y)", "length(q)"}) + ")";
        case 4: return "length(max(q, 0)) + min(max(q.x, max(q.y, q.z)), 0)";
        default: return "length(q)";
        }
    }
};

} // namespace

TEST_CASE("rounded sizes and norms are refused, or are no steeper than proved") {
    const Judged judged = judge_scenes<RoundedNorm>(effort(20), 2400);
    CHECK(judged.wrong == 0);
    CHECK(judged.accepted > judged.scenes / 3);
    CHECK(judged.accepted < judged.scenes);
}

TEST_CASE("signs times functions are refused, or do not jump") {
    const Judged judged = judge_scenes<SignedFunction>(effort(40), 800);
    CHECK(judged.wrong == 0);
    CHECK(judged.accepted > judged.scenes / 4);
    CHECK(judged.accepted < judged.scenes);
}

TEST_CASE("roots of sums of powers are refused, or are no steeper than proved") {
    const Judged judged = judge_scenes<PowerMean>(effort(28), 1200);
    CHECK(judged.wrong == 0);
    CHECK(judged.accepted > judged.scenes / 2);
    CHECK(judged.accepted < judged.scenes);
}
