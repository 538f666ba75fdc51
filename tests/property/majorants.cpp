// A random search over fields that are folded and inverted in a loop and divided by a scale which is
// carried along (lipschitz.md, 2.45): box folds, mirrors, swaps and waves, inversions by `clamp`,
// `max` or `if`, about the origin or another point, with what is added, as people write them; and
// scales that are multiplied by something else, by less, or too late.
// Whatever the checker accepts is measured (judge.h). FATHOM_EFFORT=10 is the long form.
#include "judge.h"

#include <catch2/catch.hpp>

using namespace fathom;
using namespace fathom::test;

namespace {

class Scaled : public Chance {
  public:
    using Chance::Chance;

    std::string scene() {
        right_ = often();
        const std::string size = between(0.5, 2.5);
        std::string out = "fn f(p: vec3) -> float {\n  let c = " + size +
                          " * p\n  var z = " + of({"c", "c", "p", "c - vec3(0.2, 0.1, 0)"}) +
                          "\n  var d = " + of({"1.0", "1.0", right_ ? "1.0" : "0.4"}) + "\n";
        if (right_) out += "  d = max(d, " + size + ")\n";
        out += "  for i in 0.." + number(double(1 + pick(5))) + " {\n";
        if (pick(8) != 0) out += "    z = " + fold() + "\n";
        if (pick(6) != 0) out += inversion();
        const std::string by = of({"2", "1.5", "-1.5", "3", "1.2", "1"});
        const bool adds = pick(3) != 0;
        out += "    z = " + of({"", ""}) + by + " * z" +
               (adds ? of({" + c", " + p", " - c", " - vec3(0.5, 0.3, 0.1)"}) : "") + "\n";
        const std::string wrong = right_ ? by : of({by.c_str(), "1", "0.5", "2"});
        out += "    d = d * abs(" + wrong + ")" +
               (adds || pick(4) == 0 ? right_ ? of({" + 1", " + "
                                                            "2.5"})
                                              : of({" + 1", " + 0.1", ""})
                                     : "") +
               "\n  }\n";
        return out + "  " + field() + "\n}\nimplicit(f, within: ball(2))\n";
    }

  private:
    bool right_ = false;

    std::string fold() {
        switch (pick(8)) {
        case 0: return "abs(z)";
        case 1: return "abs(z) - vec3(0.4, 0.3, 0.5)";
        case 2: return "if z.x < z.y { z.yxz } else { z }";
        case 3: return "z - 2 * min(0, dot(z, vec3(0.6, 0.8, 0))) * vec3(0.6, 0.8, 0)";
        case 4: return "clamp(z, -vec3(1, 0.8, 0.7), vec3(1, 0.8, 0.7)) * 2 - z";
        case 5: return "abs(2 * fract(0.5 * z + 0.5) - 1)";
        case 6: return right_ ? "clamp(z, -1, 1) * 2 - z" : "clamp(z, -1, 1) * 2 - z.yxz";
        default: return "clamp(z, -1, 1) * 2 - z";
        }
    }
    std::string inversion() {
        const std::string centre =
            pick(5) == 0 ? of({" - vec3(0.3, 0.2, 0)", right_ ? "" : " - p"}) : "";
        const std::string of_z = "(z" + centre + ")";
        std::string out = "    let r2 = dot(" + of_z + ", " +
                          (right_ || often() ? of_z : of({"z.yxz", "p"})) + ")\n";
        if (pick(3) == 0) {
            const std::string by = right_ ? "/= r2" : of({"/= r2", "*= 1 / r2", "/= max(r2, 0.3)"});
            return out + "    if r2 < 0.25 { z *= 4\n d *= " + (right_ ? "4" : of({"4", "2"})) +
                   " } else if r2 < 1 { z /= r2\n d " + by + " }\n";
        }
        out += "    let k = " +
               of({"clamp(1 / r2, 1, 4)", "1.2 / max(r2, 0.2)", "max(0.7 / max(r2, 0.1), 1)",
                   "1 / clamp(r2, 0.2, 1)", "1 / (0.3 + r2)", "clamp(1 / max(r2, 0.01), 0.5, 9)"}) +
               "\n";
        out += centre.empty() || often() ? "    z = k * z\n"
                                         : "    z = " + of_z + " * k + vec3(0.3, 0.2, 0)\n";
        const std::string wrong = of({"k", "sqrt(k)", "k * k", "1 / k", "1"});
        return out + "    d *= " + (right_ ? "k" : wrong) + "\n";
    }
    std::string field() {
        const std::string d = of({"d", "d", "abs(d)"});
        switch (pick(7)) {
        case 0: return "0.25 * abs(z.y) / " + d;
        case 1: return "(length(z) - 1) / " + d;
        case 2: return "length(z / " + d + ") - 0.1";
        case 3: return "(length(max(abs(z) - 1, 0)) - 0.1) / " + d;
        case 4: return "max(length(z.xy) - 1, abs(z.z)) / " + d;
        case 5: return "dot(z, vec3(0.6, 0, 0.8)) / " + d;
        default: return "length(z) / " + d + " - 0.02";
        }
    }
};

} // namespace

TEST_CASE("what is folded and inverted over its scale is refused, or is no steeper than proved") {
    const Judged judged = judge_scenes<Scaled>(effort(10), 900);
    CHECK(judged.wrong == 0);
    CHECK(judged.accepted > judged.scenes / 3);
    CHECK(judged.accepted < judged.scenes);
}
