// An adversary of fields that read distances alone (docs/lipschitz.md, 2.28): from points and axes
// that move, turn and are folded, of coordinates that are scaled by one number or by three, below
// functions that rise and fall, and within distances again; a few read the point itself besides.
// FATHOM_EFFORT and FATHOM_SEED make it longer, or another.
#include "judge.h"

#include <catch2/catch.hpp>

using namespace fathom::test;

namespace {

class OfDistances : public Chance {
  public:
    using Chance::Chance;

    std::string scene() {
        const std::size_t n = 1 + pick(3);
        std::string text = "param k = 0.3 in " + of({"-1..1", "0..1", "0.1..2"}) + "\n", field;
        for (std::size_t i = 0; i < n; ++i) {
            const std::string name = "f" + std::to_string(i);
            text += part(name);
            const std::string one = name + "(p)";
            if (i == 0)
                field = one;
            else
                field = joined(field, one);
        }
        if (pick(4) == 0) field = "(" + field + ") * " + between(0.2, 3);
        return text + "implicit(p => " + field + ", within: " +
               of({"ball(2)", "ball(1.2)", "aabb([-1.5, -1, -2], [1.5, 1, 2])",
                   "aabb([-0.5, -1, 0.1], [1.5, 2, 1.5])"}) +
               ")\n";
    }

  private:
    std::string number_that_moves(double reach) {
        const std::string by = between(-reach, reach);
        switch (pick(5)) {
        case 0: return by + " * sin(" + between(0.3, 2) + " * time)";
        case 1: return by + " * k";
        case 2: return by + " + 0.2 * cos(time + k)";
        default: return by;
        }
    }
    std::string angle() { return pick(3) == 0 ? "time" : of({"k", "0.6", "2 * k", "1.3 + k"}); }
    // Statements that make q of p.
    std::string coordinates() {
        std::string out = "  var q = p\n";
        for (std::size_t i = 0, n = 1 + pick(3); i < n; ++i) switch (pick(7)) {
            case 0:
            case 1:
                out += "  q -= vec3(" + number_that_moves(1) + ", " + number_that_moves(1) + ", " +
                       number_that_moves(1) + ")\n";
                break;
            case 2: {
                const std::string a = angle(), axes = of({"xy", "yz", "xz"});
                const std::string x(1, axes[0]), y(1, axes[1]);
                const auto at = [&](const std::string &c) {
                    if (c == x) return "cos(" + a + ") * q." + x + " - sin(" + a + ") * q." + y;
                    if (c == y) return "sin(" + a + ") * q." + x + " + cos(" + a + ") * q." + y;
                    return "q." + c;
                };
                out += "  q = vec3(" + at("x") + ", " + at("y") + ", " + at("z") + ")\n";
                break;
            }
            case 3: out += "  q = " + of({"abs(q)", "vec3(abs(q.x), q.y, q.z)"}) + "\n"; break;
            case 4: out += "  q *= " + between(0.4, 2) + "\n"; break;
            default:
                out += "  q *= vec3(" + between(0.3, 2) + ", " + between(0.3, 2) + ", " +
                       of({"1", "1 + 0.5 * k", "0.5"}) + ")\n";
            }
        return out;
    }
    // A function of r and rr, and of y where an axis is what r is from.
    std::string profile(int depth) {
        const std::string a = between(0.2, 1.5), b = between(0.1, 2);
        switch (pick(depth > 0 ? 13 : 10)) {
        case 0: return a + " * exp(-" + b + " * rr)";
        case 1: return "max(" + a + " - rr, 0) ^ " + of({"2", "3", "1.5"});
        case 2: return a + " / (rr + " + b + ")";
        case 3: return "sin(" + between(1, 6) + " * r) / 3";
        case 4: return "sqrt(rr + " + b + ")";
        case 5: return "smoothstep(" + between(0, 0.5) + ", " + between(0.7, 2) + ", r)";
        case 6: return "r - " + a;
        case 7: return "log(1 + " + b + " * rr)";
        case 8: return "length(vec2(r - " + a + ", y)) - 0.2";
        case 9: return "r * rr / " + between(2, 6) + " - 0.3 * y";
        case 10: return "length(vec2(" + profile(depth - 1) + ", " + of({"y", "r"}) + ")) - 0.2";
        case 11: return joined(profile(depth - 1), profile(depth - 1));
        default: return "abs(" + profile(depth - 1) + " - " + a + ")";
        }
    }
    std::string part(const std::string &name) {
        const bool axis = often();
        const std::string measured =
            axis ? of({"  let rr = q.x * q.x + q.z * q.z\n  let r = sqrt(rr)\n  let y = q.y\n",
                       "  let r = length(q.xz)\n  let rr = r * r\n  let y = q.y\n"})
                 : of({"  let rr = dot(q, q)\n  let r = length(q)\n", "  let r = length(q)\n"
                                                                      "  let rr = dot(q, q)\n"}) +
                       "  let y = " + (pick(8) == 0 ? "p.x" : "0") + "\n";
        return "fn " + name + "(p: vec3) -> float {\n" + coordinates() + measured + "  " +
               profile(2) + "\n}\n";
    }
    std::string joined(const std::string &a, const std::string &b) {
        switch (pick(5)) {
        case 0: return "min(" + a + ", " + b + ")";
        case 1: return "max(" + a + ", -(" + b + "))";
        case 2: return "(" + a + ") * (" + b + ")";
        default: return a + " + " + b;
        }
    }
};

} // namespace

TEST_CASE("fields of distances are no steeper than proved") {
    const Judged judged = judge_scenes<OfDistances>(effort(40), 1200);
    CHECK(judged.wrong == 0);
    CHECK(judged.accepted > judged.scenes / 2);
}
