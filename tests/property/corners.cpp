// A random search over what is joined by a length of numbers of known signs, as rounded unions are
// (lipschitz.md, 2.36). Whatever the checker accepts is measured (judge.h). FATHOM_EFFORT=10 is the long
// form.
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

} // namespace

TEST_CASE("a length of numbers of known signs is no steeper than proved") {
    const Judged judged = judge_scenes<Corner>(effort(80), 400);
    CHECK(judged.wrong == 0);
    CHECK(judged.accepted > judged.scenes * 3 / 4);
}
