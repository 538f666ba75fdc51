// Solids as people build them, at random: unions, cuts and blends of two to eight parts whose sizes
// and places are round, so that faces are flush, edges meet and walls and gaps are thin, turned or
// not. As text of the language; the same from the same seed.
#pragma once

#include "random_scenes.h"

#include <cmath>

namespace fathom::test {

class RandomSolid {
  public:
    explicit RandomSolid(std::uint64_t seed) : dice_{seed} {}

    std::string text() {
        std::string solid = of(2 + dice_.below(7));
        if (dice_.chance(0.15))
            solid = "(" + solid + ").rotate(" + any(0.1, 3) + ", axis: [1, 2, 3])";
        if (dice_.chance(0.1)) solid = "(" + solid + ").scale(" + any(0.05, 20) + ")";
        return solid;
    }

  private:
    Dice dice_;

    static std::string number(double x) { return fmt::format("{:.4g}", x); }
    std::string any(double lo, double hi) { return number(dice_.in(lo, hi)); }
    // A multiple of an eighth: what is put together of such numbers is flush.
    std::string round(double lo, double hi) { return number(std::round(8 * dice_.in(lo, hi)) / 8); }
    std::string size() { return dice_.chance(0.6) ? round(0.25, 1.25) : any(0.2, 1.2); }
    std::string place() { return dice_.chance(0.6) ? round(-0.75, 0.75) : any(-0.8, 0.8); }
    std::string thin() { return any(0.004, 0.06); }
    std::string sizes() { return "[" + size() + ", " + size() + ", " + size() + "]"; }
    std::string places() { return "[" + place() + ", " + place() + ", " + place() + "]"; }
    std::string axis() {
        static const char *names[] = {"X", "Y", "Z", "[1, 2, 3]", "[1, 1, 0]"};
        return names[dice_.below(5)];
    }

    std::string flat() {
        switch (dice_.below(5)) {
        case 0: return "circle(" + any(0.15, 0.6) + ")";
        case 1: return "rectangle([" + size() + ", " + size() + "])";
        case 2: return fmt::format("regular_polygon({}, {})", 3 + dice_.below(5), any(0.2, 0.6));
        case 3: return "star(5, " + any(0.4, 0.7) + ", " + any(0.15, 0.35) + ")";
        default:
            return "(rectangle([" + size() + ", " + size() + "]) - circle(" + any(0.1, 0.3) + "))";
        }
    }

    std::string primitive() {
        switch (dice_.below(15)) {
        case 0:
        case 1:
        case 2: return "box(" + sizes() + ")";
        case 3: return "sphere(" + size() + ")";
        case 4: return "cylinder(" + any(0.1, 0.6) + ", " + size() + ")";
        case 5: return "torus(" + any(0.4, 0.7) + ", " + any(0.05, 0.25) + ")";
        case 6: return "cone(" + any(0.2, 0.7) + ", " + size() + ")";
        case 7: return "rounded_box(" + sizes() + ", " + any(0.02, 0.1) + ")";
        case 8: return "box_frame(" + sizes() + ", thickness: " + any(0.02, 0.1) + ")";
        case 9: return "capsule(" + places() + ", " + places() + ", " + any(0.03, 0.2) + ")";
        case 10: return "tetrahedron(" + any(0.3, 0.7) + ")";
        case 11: return "octahedron(" + any(0.3, 0.8) + ")";
        case 12: return flat() + ".extrude(" + size() + ")";
        case 13: return flat() + ".revolve(" + any(0.3, 0.8) + ")";
        default: return "ellipsoid([" + any(0.2, 0.9) + ", " + any(0.2, 0.9) + ", 0.5])";
        }
    }

    // What tells good meshes from bad ones: thin walls and gaps, flush faces, what only touches.
    std::string hard() {
        const std::string a = round(0.5, 1.25), b = round(0.5, 1), t = thin();
        switch (dice_.below(12)) {
        case 0: return "box([" + a + ", " + t + ", " + b + "])"; // a wall
        case 1:                                                  // a gap
            return "(box(1).translate(x: 0.5) | box(1).translate(x: -0.5 - " + t + "))";
        case 2: return "(box([" + a + ", " + b + ", 1]) - box([" + b + " / 2, " + b + ", 0.5]))";
        case 3:
            return "(box(" + b + ") | box([" + b + ", 0.25, " + a + "]).translate(y: " + b +
                   " / 2 + 0.125))"; // flush
        case 4:
            return "(box(0.5) | box(0.5).translate([0.5, 0.5, " + any(0, 0.5) + "]))"; // an edge
        case 5: return "(box(0.5) | box(0.5).translate([0.5, 0.5, 0.5]))";             // a corner
        case 6: return "(sphere(0.5) | sphere(0.25).translate(x: 0.75))";
        case 7: return "((box([1, 0.5, 1]) - cylinder(0.3, 0.5)) | cylinder(0.3, 0.5))"; // a plug
        case 8:
            return "(" + primitive() + " | sphere(" + any(0.008, 0.04) + ").translate(" + places() +
                   "))";                                                         // a crumb
        case 9: return "(sphere(0.5) | box([1, 0.25, 1]).translate(y: -0.625))"; // tangent
        case 10: return "(box(" + a + ") - box(" + a + " - " + t + "))";         // a thin shell
        default: return "cylinder(" + t + ", " + a + ")";                        // a wire
        }
    }

    std::string moved(const std::string &solid) {
        std::string out = solid;
        if (dice_.chance(0.3))
            out += ".rotate(" + (dice_.chance(0.4) ? std::string("90deg") : any(0.1, 3)) +
                   ", axis: " + axis() + ")";
        return out + ".translate(" + places() + ")";
    }

    std::string leaf() {
        const std::string solid = dice_.chance(0.35) ? hard() : primitive();
        switch (dice_.below(12)) {
        case 0: return moved(solid + ".shell(" + any(0.02, 0.1) + ")");
        case 1: return moved(solid + ".offset(" + any(0.01, 0.1) + ")");
        case 2: {
            const int n = 2 + dice_.below(2);
            return moved(fmt::format("{}.scale(0.5).repeat([{}, {}, {}], count: [{}, {}, 1])",
                                     solid, round(0.5, 0.75), round(0.5, 0.75), "1", n, 2));
        }
        case 3:
            return fmt::format("{}.scale(0.5).translate(x: {}).repeat_polar({})", solid,
                               round(0.25, 0.75), 2 + dice_.below(4));
        default: return moved(solid);
        }
    }

    std::string of(int parts) {
        if (parts <= 1) return leaf();
        const int left = 1 + dice_.below(parts - 1);
        const std::string a = of(left), b = of(parts - left);
        const std::string both = " { " + a + "; " + b + " }", r = any(0.02, 0.25);
        switch (dice_.below(11)) {
        case 0:
        case 1:
        case 2:
        case 3: return "(" + a + " | " + b + ")";
        case 4:
        case 5: return "(" + a + " - " + b + ")";
        case 6: return "(" + a + " & " + b + ".offset(" + any(0.05, 0.3) + "))";
        case 7: return "smooth_union(" + r + ")" + both;
        case 8: return "smooth_difference(" + r + ")" + both;
        case 9: return "round_union(" + r + ")" + both;
        default: return "chamfer_union(" + r + ")" + both;
        }
    }
};

} // namespace fathom::test
