// Scenes that nobody would write: random trees of the library's shapes, combinators and
// deformations, as text, so that everything from the parser on takes part. The same from the same
// seed. And their cutting down to what still fails.
#pragma once

#include <cstdint>
#include <cstdio>
#include <fmt/format.h>
#include <memory>
#include <string>
#include <vector>

namespace fathom::test {

struct Dice {
    std::uint64_t state;
    double next() { // splitmix64; 0 <= x < 1
        std::uint64_t z = state += 0x9e3779b97f4a7c15u;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return double((z ^ (z >> 31)) >> 11) * 0x1p-53;
    }
    double in(double lo, double hi) { return lo + (hi - lo) * next(); }
    int below(int n) { return int(next() * n); }
    bool chance(double p) { return next() < p; }
};

// A term: `text` with its parts' texts for each `$`.
struct Term {
    std::string text;
    bool flat = false;
    std::vector<std::shared_ptr<Term>> parts;
};
using TermPtr = std::shared_ptr<Term>;

inline std::string text_of(const Term &term) {
    std::string out;
    std::size_t next = 0;
    for (char c : term.text)
        if (c == '$')
            out += text_of(*term.parts[next++]);
        else
            out += c;
    return out;
}

class RandomScene {
  public:
    explicit RandomScene(std::uint64_t seed) : dice_{seed} {}

    TermPtr solid(int depth) {
        if (depth <= 0 || dice_.chance(0.08)) return primitive();
        if (dice_.chance(0.1)) return lifted(depth - 1);
        return dice_.chance(0.45) ? combined(depth, false) : changed(depth);
    }
    // The params that the numbers above became.
    const std::vector<std::string> &params() const { return params_; }

  private:
    Dice dice_;
    std::vector<std::string> params_;

    static std::string number(double x) {
        char text[32];
        std::snprintf(text, sizeof text, "%.3g", x);
        return text;
    }
    std::string n(double lo, double hi) { return number(dice_.in(lo, hi)); }
    // A number that may be a slider. Its range may reach what is degenerate or of other sign.
    std::string slider(double lo, double hi) {
        if (params_.size() >= 3 || !dice_.chance(0.2)) return n(lo, hi);
        double a = dice_.in(lo, hi), b = dice_.in(lo, hi);
        if (a > b) std::swap(a, b);
        const std::string name = fmt::format("k{}", params_.size());
        params_.push_back("param " + name + " = " + number(a) + " in " + number(a) + ".." +
                          number(b + 0.01) + "\n");
        return name;
    }
    std::string vec(double lo, double hi) {
        return "[" + n(lo, hi) + ", " + n(lo, hi) + ", " + n(lo, hi) + "]";
    }
    std::string vec2(double lo, double hi) { return "[" + n(lo, hi) + ", " + n(lo, hi) + "]"; }
    std::string axis() {
        static const char *names[] = {"X", "Y", "Z"};
        return dice_.chance(0.9) ? names[dice_.below(3)] : "[1, 2, -1]";
    }
    std::string two_axes() {
        static const char *names[] = {"X, towards: Y", "Y, towards: X", "Z, towards: X",
                                      "X, towards: Z", "Y, towards: Z", "Z, towards: Y"};
        return names[dice_.below(6)];
    }
    static TermPtr term(std::string text, std::vector<TermPtr> parts = {}, bool flat = false) {
        return std::make_shared<Term>(Term{std::move(text), flat, std::move(parts)});
    }

    TermPtr primitive() {
        switch (dice_.below(36)) {
        case 0: return term("sphere(" + slider(0.2, 1) + ")");
        case 1: return term("box(" + vec(0.2, 1.6) + ")");
        case 2: return term("rounded_box(" + vec(0.6, 1.6) + ", " + n(0.02, 0.25) + ")");
        case 3: return term("box_frame(" + vec(0.6, 1.6) + ", " + n(0.05, 0.2) + ")");
        case 4: return term("torus(" + n(0.4, 1) + ", " + n(0.1, 0.35) + ")");
        case 5:
            return term("capped_torus(" + n(0.4, 1) + ", " + n(0.1, 0.3) + ", " + n(0.3, 2.8) +
                        ")");
        case 6:
            return term("link(" + n(0.8, 1.6) + ", " + n(0.2, 0.4) + ", " + n(0.05, 0.15) + ")");
        case 7: return term("cylinder(" + slider(0.2, 0.8) + ", " + n(0.2, 1.6) + ")");
        case 8: return term("rounded_cylinder(0.6, " + n(0.5, 1.5) + ", " + n(0.02, 0.2) + ")");
        case 9: return term("capsule(" + vec(-1, 1) + ", " + vec(-1, 1) + ", " + n(0.1, 0.4) + ")");
        case 10: return term("cone(" + n(0.3, 1) + ", " + n(0.4, 1.6) + ")");
        case 11:
            return term("capped_cone(" + n(0.3, 1) + ", " + n(0.1, 0.5) + ", " + n(0.4, 1.6) + ")");
        case 12:
            return term("round_cone(" + n(0.3, 0.6) + ", " + n(0.1, 0.3) + ", " + n(0.5, 1.2) +
                        ")");
        case 13:
            return term(
                fmt::format("prism({}, {}, {})", 3 + dice_.below(5), n(0.3, 1), n(0.3, 1.5)));
        case 14: return term("pyramid(" + vec(0.5, 1.6) + ")");
        case 15: return term("tetrahedron(" + n(0.5, 1.2) + ")");
        case 16: return term("icosahedron(" + n(0.5, 1.2) + ")");
        case 17: return term("ellipsoid(" + vec(0.3, 1.2) + ")");
        case 18:
            return term("superquadric(" + vec(0.4, 1) + ", " + n(0.4, 1.8) + ", " + n(0.4, 1.8) +
                        ")");
        case 19: return term("gdf_octahedron(" + n(0.4, 1) + ", " + n(2, 12) + ")");
        case 20: return term("helix(0.7, 0.5, " + n(1, 3) + ", " + n(0.05, 0.2) + ")");
        case 21: return term("(box(2.4) & plane(" + vec(-1, 1) + ", " + n(-0.3, 0.3) + "))");
        case 22: return term("metaballs([" + vec(-0.6, 0.6) + ", " + vec(-0.6, 0.6) + "], 0.6)");
        case 23: return term("menger(" + n(1, 2) + ", 2)");
        case 24:
            return term("implicit(p => dot(sin(" + n(2, 4) + "*p), cos(2*p.zxy)), within: ball(" +
                        n(0.6, 1.4) + ", at: " + vec(-0.3, 0.3) + "))");
        case 25: // steep in the corners
            return term(
                "implicit(p => p.x^4 + p.y^4 + p.z^2 * p.x^2 - " + n(0.05, 0.3) + ", within: " +
                (dice_.chance(0.5) ? "ball(2)" : "aabb([-2, -1, -1.5], [1.5, 1.8, 1])") + ")");
        case 26: return term("octahedron(" + n(0.5, 1.2) + ")");
        case 27: return term("dodecahedron(" + n(0.5, 1.2) + ")");
        case 28: {
            static const char *solids[] = {"tetrahedron",          "cube",
                                           "dodecahedron",         "icosahedron",
                                           "truncated_octahedron", "truncated_icosahedron"};
            return term("gdf_" + std::string(solids[dice_.below(6)]) + "(" + n(0.4, 1) +
                        (dice_.chance(0.5) ? ", " + n(2, 12) : "") + ")");
        }
        case 29: return term("distance_grid(\"rock.nrrd\").scale(" + n(0.5, 1.2) + ")");
        case 30:
            return term("sphere(" + n(0.4, 1) + ").displace_map(image(\"pebbles.png\"), " +
                        n(0.02, 0.15) + ", scale: " + n(0.3, 2) + ")");
        case 31:
            return term("cylinder(" + n(0.3, 0.8) + ", " + n(0.4, 1.5) +
                        ").displace_map(image(\"pebbles.png\"), " + n(0.02, 0.1) + ")");
        case 32:
            return term("tubes([" + vec(-1, 1) + ", " + vec(-1, 1) + ", " + vec(-1, 1) + "], " +
                        n(0.05, 0.2) + ")");
        case 33:
            return term("heightfield(q => 0.2 * sin(" + n(1, 4) + " * q.x) + 0.1 * noise(2 * q), " +
                        vec2(0.8, 2) + ", depth: " + n(0.2, 0.8) + ")");
        case 34:
            return term(std::string(dice_.chance(0.5) ? "gyroid(" : "schwarz_p(") + n(0.6, 1.5) +
                        ", " + n(0.05, 0.3) + ").within(ball(" + n(0.6, 1.3) + "))");
        default: return term("sphere(0.5).translate(" + vec(-1, 1) + ")");
        }
    }

    TermPtr flat(int depth) {
        if (depth <= 0 || dice_.chance(0.3)) switch (dice_.below(14)) {
            case 0: return term("circle(" + n(0.1, 0.8) + ")", {}, true);
            case 1: return term("rectangle(" + vec2(0.2, 1.4) + ")", {}, true);
            case 2: return term("ellipse(" + vec2(0.2, 0.8) + ")", {}, true);
            case 3: return term("rounded_rectangle(" + vec2(0.6, 1.2) + ", 0.2)", {}, true);
            case 4:
                return term("polygon([[0, 0], " + vec2(0.3, 1) + ", [" + n(-1, 0) + ", 0.8]])", {},
                            true);
            case 5: return term("regular_polygon(5, " + n(0.3, 0.9) + ")", {}, true);
            case 6: return term("star(5, " + n(0.6, 1) + ", " + n(0.2, 0.5) + ")", {}, true);
            case 7: return term("segment(" + vec2(-1, 1) + ", " + vec2(-1, 1) + ", 0.2)", {}, true);
            case 8: return term("arc(0.7, " + n(0.5, 5) + ", 0.15)", {}, true);
            case 9: return term("ring(" + n(0.6, 1) + ", " + n(0.2, 0.5) + ")", {}, true);
            case 10:
                return term("implicit2(p => sin(" + n(2, 4) + " * p.x) * cos(2 * p.y) - " +
                                n(0, 0.4) + ", within: ball(" + n(0.6, 1.4) +
                                ", at: " + vec2(-0.3, 0.3) + "))",
                            {}, true);
            case 11: // steep in the corners
                return term("implicit2(p => p.x^4 + p.x * p.y^2 - " + n(0.05, 0.3) +
                                ", within: aabb([-1, -0.9], [0.8, 1.2])" +
                                (dice_.chance(0.5) ? "" : " - ball(0.2)") + ")",
                            {}, true);
            case 12:
                return term("implicit2(p => max(length(p - " + vec2(-0.3, 0.3) + ") - 0.8, " +
                                n(0.2, 0.7) + " - length(p)))",
                            {}, true);
            default:
                return term("bezier(" + vec2(-1, 0) + ", " + vec2(-1, 1) + ", " + vec2(0, 1) +
                                ", 0.15)",
                            {}, true);
            }
        if (dice_.chance(0.4)) return combined(depth, true);
        TermPtr s = flat(depth - 1);
        switch (dice_.below(8)) {
        case 0: return term("$.translate(" + vec2(-0.8, 0.8) + ")", {s}, true);
        case 1: return term("$.rotate(" + slider(-3, 3) + ")", {s}, true);
        case 2: return term("$.scale(" + vec2(0.5, 1.6) + ")", {s}, true);
        case 3: return term("$.offset(" + slider(-0.15, 0.3) + ")", {s}, true);
        case 4: return term("$.shell(" + n(0.05, 0.2) + ")", {s}, true);
        case 5: return term(fmt::format("$.repeat_polar({})", 2 + dice_.below(6)), {s}, true);
        case 6: return term("$.repeat(" + vec2(0.6, 2) + ", count: [2, 3])", {s}, true);
        default: return term("$.mirror(X)", {s}, true);
        }
    }
    TermPtr lifted(int depth) {
        TermPtr s = flat(depth < 2 ? depth : 2);
        switch (dice_.below(4)) {
        case 0: return term("$.extrude(" + n(0.2, 1.5) + ")", {s});
        case 1:
            return term("$.extrude(" + n(0.4, 1.5) + ", twist: " + slider(-2, 2) +
                            ", taper: " + n(0.3, 1.5) + ")",
                        {s});
        case 2: return term("$.revolve()", {s});
        default: return term("$.revolve(" + n(0, 1) + ")", {s});
        }
    }

    TermPtr combined(int depth, bool flat_ones) {
        auto part = [&] { return flat_ones ? flat(depth - 1) : solid(depth - 1); };
        TermPtr a = part(), b = part();
        const std::string by = flat_ones ? vec2(-0.7, 0.7) : vec(-0.7, 0.7);
        b = term("$.translate(" + by + ")", {b}, flat_ones);
        const std::string both = " { $; $ }", r = slider(0.05, 0.6);
        const std::string steps = fmt::to_string(1 + dice_.below(4));
        auto two = [&](const std::string &text) { return term(text, {a, b}, flat_ones); };
        static const char *sets[] = {"union", "intersection", "difference"};
        const std::string set = sets[dice_.below(3)];
        switch (dice_.below(14)) {
        case 0: return two("($ | $)");
        case 1: return two("($ & $)");
        case 2: return two("($ - $)");
        case 3: return two("xor" + both);
        case 4: return two("smooth_" + set + "(" + r + ")" + both);
        case 5: return two("round_" + set + "(" + r + ")" + both);
        case 6: return two("chamfer_" + set + "(" + r + ")" + both);
        case 7: return two("stairs_" + set + "(" + r + ", " + steps + ")" + both);
        case 8: return two("columns_" + set + "(" + r + ", " + steps + ")" + both);
        case 9: {
            static const char *seams[] = {"pipe($, $, 0.1)", "engrave($, $, 0.1)",
                                          "groove($, $, 0.15, 0.1)", "tongue($, $, 0.15, 0.1)"};
            return two(seams[dice_.below(4)]);
        }
        case 10: return two("blend($, $, " + slider(0, 1) + ")");
        case 11:
            if (flat_ones) return two("blend($, $, " + n(-0.5, 1.5) + ")");
            return two(std::string("blend($, $, p => ") +
                       (dice_.chance(0.5) ? "clamp(p.x + 0.5, 0, 1)).within(ball(2))"
                                          : "0.5 + 0.5 * sin(" + n(1, 4) + " * p.y))"));
        case 12: return two("pseudonorm_blend($, $, " + n(1, 6) + ")");
        default: return term("smooth_union(" + r + ") { $; $; $ }", {a, b, part()}, flat_ones);
        }
    }

    TermPtr changed(int depth) {
        TermPtr s = solid(depth - 1);
        auto one = [&](const std::string &text) { return term(text, {s}); };
        const std::string counts = dice_.chance(0.5) ? ", count: [3, 2, 2]" : "";
        static const char *along[] = {"[$, 0, 0]", "[0, $, $]", "[$, $, $]", "[0, $, 0]"};
        auto cell = [&] {
            std::string out;
            for (char c : std::string(along[dice_.below(4)])) {
                if (c == '$')
                    out += n(0.8, 3);
                else
                    out += c;
            }
            return out;
        };
        switch (dice_.below(29)) {
        case 0: return one("$.translate(" + vec(-1, 1) + ")");
        case 1: return one("$.rotate(" + slider(-3, 3) + ", " + axis() + ")");
        case 2: return one("$.scale(" + slider(0.4, 1.6) + ")");
        case 3: return one("$.scale(" + vec(0.4, 1.6) + ")");
        case 4: return one("$.scale([-1, 1, " + n(0.5, 1) + "])");
        case 5: return one("$.mirror(" + axis() + ")");
        case 6: return one("$.turnaround(" + axis() + ")");
        case 7: return one("$.reflect(" + axis() + ")");
        case 8:
        case 9: return one("$.twist(" + slider(-3, 3) + ", " + axis() + ")");
        case 10:
        case 11: return one("$.bend(" + slider(-1.5, 1.5) + ", " + two_axes() + ")");
        case 12:
        case 13:
            return one("$.taper(" + slider(0.2, 1.6) + ", " + axis() + ", " + n(-1, -0.2) + ", " +
                       n(0.2, 1) + ")");
        case 14: return one("$.elongate(" + vec(0, 0.6) + ")");
        case 15: return one("$.hyperize(" + n(1, 2) + ")");
        case 16: return one("$.offset(" + slider(-0.2, 0.3) + ")");
        case 17: return one("$.shell(" + slider(0.03, 0.3) + ")");
        case 18:
            return one("$.displace(p => " + slider(0, 0.15) + " * sin(" + n(2, 9) +
                       " * p.x) * sin(6 * p.y))");
        case 19: {
            static const char *fields[] = {"fbm(2 * p, 2)",  "ridged(1.5 * p, 3)",
                                           "worley(2 * p)",  "turbulence(2 * p, 3)",
                                           "simplex(3 * p)", "value_noise(3 * p)"};
            return one("$.displace(p => 0.1 * " + std::string(fields[dice_.below(6)]) + ")");
        }
        case 20: return one("$.distort(p => [p.x + 0.2 * sin(2 * p.y), p.y, p.z - 0.1 * p.x])");
        case 21:
        case 22: return one("$.repeat(" + cell() + counts + ")");
        case 23:
            return one(
                "$.repeat([" + n(1, 3) + ", 0, " + n(1, 3) + "]" +
                (dice_.chance(0.5) ? ", count: [3, 1, 2]" : "") +
                ", copies: (s, id) => s.rotate(6 * hash(id)).translate(y: 0.4 * hash(id.zxy)))");
        case 24: return one("$.repeat_mirror(" + cell() + ")");
        case 25:
            return one(fmt::format("$.translate({}).repeat_polar({}, {})", vec(-1, 1),
                                   2 + dice_.below(9), axis()));
        case 26:
            return one(fmt::format(
                "$.translate(x: {}).repeat_polar({}, {}, (s, id) => s.scale(0.6 + 0.4 * hash(id)))",
                n(0.2, 1.5), 2 + dice_.below(9), axis()));
        case 27: {
            static const char *regions[] = {
                "ball(0.9, at: [0.2, 0, 0.1])",
                "aabb([-0.7, -0.5, -0.6], [0.5, 0.8, 0.9])",
                "tube(Y, 0.6)",
                "ball(1.1) - tube(Y, 0.3)",
                "ball(1.2) - ball(0.4, at: [0.2, 0.1, 0])",
                "ball(1.2) - aabb([-0.3, -0.2, -0.4], [0.3, 0.5, 0.2])"};
            return one("$.within(" + std::string(regions[dice_.below(6)]) + ")");
        }
        default: return one("(box(2.2) & complement($))");
        }
    }
};

// All trees with one node replaced by one of its parts of the same kind, the largest cuts first.
inline void cuts(const TermPtr &root, const TermPtr &at, std::vector<TermPtr> &out) {
    struct Rebuild {
        static TermPtr with(const TermPtr &tree, const Term *old, const TermPtr &now) {
            if (tree.get() == old) return now;
            auto copy = std::make_shared<Term>(*tree);
            for (TermPtr &part : copy->parts) part = with(part, old, now);
            return copy;
        }
    };
    for (const TermPtr &part : at->parts)
        if (part->flat == at->flat) out.push_back(Rebuild::with(root, at.get(), part));
    for (const TermPtr &part : at->parts) cuts(root, part, out);
}

} // namespace fathom::test
