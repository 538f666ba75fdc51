// An adversary of the proof: random fields and shapes of the kinds that have been proved wrongly
// before. Whatever the checker accepts is measured where such fields go wrong: on borders and next
// to them, at 0, over params' ends and inside, over time. FATHOM_EFFORT and FATHOM_SEED in the
// environment make it longer, or another; FATHOM_SHOW says what each scene came to.
// Long: one generator and its table of hostile calls.
#include "judge.h"
#include "tests/support/effort.h"

#include <catch2/catch.hpp>

using namespace fathom;
using namespace fathom::test;

namespace {

// Shapes of the library with an argument that its conditions are about.
constexpr std::array library = {
    "sphere(@)",
    "box([1, @, 1])",
    "rounded_box([1, 1, 1], radius: @ * 0.5)",
    "box_frame([1, 1, 1], thickness: @ * 0.5)",
    "torus(1, @)",
    "torus(@, 0.2)",
    "capped_torus(1, 0.2, angle: @)",
    "capped_torus(1, 0.2, angle: 3 * @)",
    "capped_torus(@, 0.2, angle: 2)",
    "link(1 + 2 * @, 0.4, 0.1)",
    "link(3, @, 0.2)",
    "link(3, 0.5, @)",
    "cylinder(@, 1)",
    "cylinder(1, @)",
    "rounded_cylinder(0.7, 1.2, @)",
    "capsule([-1, 0, 0], [1, 0.5, 0], radius: @)",
    "capsule([-@, 0, 0], [@, 0, 0], radius: 0.3)",
    "cone(@, 1)",
    "cone(1, @)",
    "capped_cone(@, @, 1)",
    "capped_cone(@, 0.5, 1)",
    "capped_cone(0.5, 0.2, @)",
    "round_cone(@, 0.5, 2)",
    "round_cone(0.5, 0.5 + @, 1)",
    "round_cone(0.5, 0.3, @)",
    "plane([@, 0, 0])",
    "slab(@)",
    "ellipsoid([1, @, 0.7])",
    "superquadric([1, 0.8, 1], @, 1)",
    "superquadric([1, 0.8, 1], 0.5, 2 * @)",
    "superquadric([1, @, 1], 0.5, 1)",
    "helix(@, 0.4, turns: 3, thickness: 0.15)",
    "helix(0.8, @, turns: 3, thickness: 0.15)",
    "helix(0.8, 0.4, turns: @, thickness: 0.15)",
    "helix(0.8, 0.4, turns: 3, thickness: @)",
    "tubes([[-1, 0, 0], [0, 0.5, 0], [1, 0, 0]], radius: @)",
    "heightfield(q => sin(q.x) * cos(q.y), [@, 1], depth: 1)",
    "heightfield(q => sin(q.x) * cos(q.y), [1, 1], depth: @)",
    "circle(@).extrude(0.5)",
    "ellipse([1, @]).extrude(0.5)",
    "rectangle([@, 1]).extrude(0.5)",
    "rounded_rectangle([1, 1], radius: @).extrude(0.5)",
    "regular_polygon(5, @).extrude(0.5)",
    "star(5, 1, @).extrude(0.4)",
    "star(5, 0.3 + @, 0.3).extrude(0.4)",
    "segment([-0.5, 0], [0.5, 0.2], thickness: @).extrude(0.4)",
    "arc(1, @, thickness: 0.2).extrude(0.4)",
    "arc(@, 2, thickness: 0.2).extrude(0.4)",
    "ring(1, @).extrude(0.4)",
    "bezier([-1, 0], [0, 1], [1, @], thickness: 0.2).extrude(0.4)",
    "circle(1).extrude(@)",
    "circle(1).extrude(1, taper: @)",
    "rectangle([1, 0.5]).extrude(@, twist: 1)",
    "circle(0.3).revolve(@)",
    "prism(6, 0.8, @)",
    "prism(6, @, 1)",
    "pyramid([1, @, 1])",
    "pyramid([@, 1, 1])",
    "tetrahedron(@)",
    "octahedron(@)",
    "dodecahedron(@)",
    "icosahedron(@)",
    "gdf([[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]], radius: @, exponent: 12)",
    "gdf_cube(0.8, exponent: 1 + @)",
    "gdf_octahedron(0.8, exponent: @)",
    "gdf_blend([X, Y, Z], [[1, 1, 1], [-1, 1, 1]], @, 0.5, radius: 0.8)",
    "metaballs([[-0.6, 0, 0], [0.5, 0.1, 0], [0, 0.7, 0]], radius: @)",
    "menger(@, iterations: 2)",
    "gyroid(@, thickness: 0.1) & sphere(1.4)",
    "gyroid(1, thickness: @) & sphere(1.4)",
    "schwarz_p(@, thickness: 0.1) & sphere(1.4)",
    "box(1).rotate(0.5, axis: [@, 0, 0])",
    "box(1).orient(Y, [@, 0, 0])",
    "box(1).scale(@)",
    "sphere(1).scale([1, @, 0.8])",
    "dfmodel.scale(sphere(0.5), @ + 0.5)",
    "box([1, 1, 0.5]).reflect([@, 0, 0])",
    "box(1).bend(0.3, axis: Y, towards: [@, 0, 0])",
    "box([1, 1, 1]).taper(@)",
    "sphere(0.5).elongate([@, 0, 0])",
    "hyperize(sphere(1), 1 + @)",
    "box(1).shell(@)",
    "smooth_union(@) { sphere(0.7); sphere(0.5).translate(x: 0.8) }",
    "round_union(@) { sphere(0.7); sphere(0.5).translate(x: 0.8) }",
    "chamfer_difference(@) { box(1.6); cylinder(0.5, 3) }",
    "stairs_union(@, 3) { box([2, 0.4, 2]); cylinder(0.5, 2) }",
    "columns_union(@, 3) { box([2, 0.4, 2]); cylinder(0.5, 2) }",
    "pipe(sphere(1), plane(Y, 0.3), @)",
    "engrave(sphere(1), slab(0.6), @)",
    "groove(sphere(1), slab(0.6), width: @, depth: 0.1)",
    "groove(sphere(1), slab(0.6), width: 0.1, depth: @)",
    "tongue(sphere(1), slab(0.6), width: @, depth: @)",
    "blend(box(1.4), sphere(1), @)",
    "pseudonorm_blend(sphere(0.6).translate(x: -0.5), sphere(0.6).translate(x: 0.5), 1 + @)",
};

class Adversary : public Chance {
  public:
    using Chance::Chance;

    std::string scene(std::size_t kind) {
        static constexpr std::array makers = {
            &Adversary::truths,      &Adversary::steps,  &Adversary::lattice,
            &Adversary::choices,     &Adversary::smooth, &Adversary::exponentials,
            &Adversary::powers,      &Adversary::ratios, &Adversary::conditions,
            &Adversary::repetitions, &Adversary::loops,  &Adversary::nested,
            &Adversary::angles,      &Adversary::uses,   &Adversary::noise,
            &Adversary::turns,       &Adversary::cells,  &Adversary::sized,
            &Adversary::tilings,     &Adversary::spirals};
        return (this->*makers[kind % makers.size()])();
    }
    static constexpr std::size_t kinds = 20;

  private:
    // A linear form whose borders others share.
    std::string linear() {
        return "(" +
               of({"p.x", "p.x + 1", "p.x - 1", "p.x + 0.5", "p.x - 0.5", "2 * p.x", "0.5 * p.x",
                   "-p.x", "1 - p.x", "p.y", "p.x + p.y", "p.x - p.y", "3 * p.x + 1", "p.x / 0.25",
                   "p.x + 1e-3", "p.x + time", "p.x + k", "p.x * 1.0000001"}) +
               ")";
    }
    std::string flat() { // the point alone, smooth
        return of({"p.x", "p.y", "p.z", "(p.x + p.y)", "sin(3 * p.x)", "cos(p.y)", "p.x * p.y",
                   "length(p)", "(length(p) - 1)", "0.7", "time * 0.001", "k"});
    }
    std::string truth(int depth = 1) {
        if (depth > 0 && pick(4) == 0) {
            const std::string a = truth(depth - 1), b = truth(depth - 1);
            return of({"(", "(not "}) + a + of({" and ", " or "}) + b + ")";
        }
        return "(" + (often() ? linear() : flat()) + of({" < ", " > ", " <= ", " >= "}) +
               (often() ? "0" : flat()) + ")";
    }
    std::string step() {
        const std::string u = linear();
        switch (pick(9)) {
        case 0: return "floor(" + u + ")";
        case 1: return "ceil(" + u + ")";
        case 2: return "round(" + u + ")";
        case 3: return "fract(" + u + ")";
        case 4: return "(" + u + " % 1)";
        case 5: return "(" + u + " % 0.5)";
        case 6: return "(" + u + " - round(" + u + "))";
        case 7: return "(" + u + " - floor(" + u + "))";
        default: return "hash(floor(" + u + "))";
        }
    }
    // Continuous at its own borders, or nearly.
    std::string tent() {
        const std::string u = linear();
        switch (pick(7)) {
        case 0: return "abs(fract(" + u + ") - 0.5)";
        case 1: return "abs(" + u + " - round(" + u + "))";
        case 2: return "fract(" + u + ") * (1 - fract(" + u + "))";
        case 3: return "sin(pi * fract(" + u + "))";
        case 4: return "abs(" + u + " % 1 - 0.5)";
        case 5: return "min(fract(" + u + "), 1 - fract(" + u + "))";
        default: return "(ceil(" + u + ") - " + u + ") * (" + u + " - floor(" + u + "))";
        }
    }
    std::string param() { return "param k = 0.5 in " + of({"0..1", "-1..1", "0.25..3"}) + "\n"; }
    std::string field(const std::string &f) {
        return param() + "implicit(p => " + of({"length(p) - 1", "p.y", "p.x + 0.3"}) +
               " + 0.2 * (" + f + "), within: " +
               of({"ball(2)", "aabb([-1.5, -1, -2], [1.5, 2, 1.5])", "everywhere"}) + ")\n";
    }

    std::string truths() {
        const std::string number =
            often() ? "float(" + truth() + ")" : "float(int(" + truth() + ") + 1)";
        switch (pick(6)) {
        case 0: return field(number);
        case 1: return field("hash(vec2(" + number + ", 1))");
        case 2: return field(flat() + " * " + number);
        case 3: return field("noise(p + " + number + ")");
        case 4: return field("mix(" + flat() + ", " + flat() + ", " + number + ")");
        default: return param() + "sphere(1).displace(p => 0.1 * " + number + ")\n";
        }
    }
    std::string steps() {
        switch (pick(6)) {
        case 0: return field(step() + " * " + step());
        case 1: return field(step() + " * " + tent());
        case 2: return field(tent() + " * " + tent());
        case 3: return field(tent() + " + " + step() + " * " + tent());
        case 4: return field("max(" + tent() + ", " + tent() + ") * " + step());
        default: return field(step() + " * " + step() + " * " + step());
        }
    }
    std::string lattice() {
        const std::string u = linear(), v = often() ? u : linear(),
                          at = of({"floor", "floor", "ceil", "round"}),
                          next = of({" + 1", " + 1", " - 1", " + 2"});
        const std::string f = often() ? "fract(" + v + ")" : "smoothstep(0, 1, fract(" + v + "))";
        const std::string way = pick(4) == 0 ? "(1 - " + f + ")" : f;
        std::string mixed = "mix(hash(" + at + "(" + u + ")), hash(" + at + "(" + u + ")" + next +
                            "), " + way + ")";
        if (pick(3) == 0) mixed += " * " + tent();
        if (pick(3) == 0) mixed += of({" + ", " * "}) + step();
        return field(mixed);
    }
    std::string choices() {
        const std::string u = linear(), v = of({"0", "1", "0.5", "p.y"});
        const std::string a = often() ? u : step(), b = often() ? v : step();
        const std::string order = of({" < ", " <= ", " > "});
        switch (pick(3)) {
        case 0: return field("if " + u + order + v + " { " + a + " } else { " + b + " }");
        case 1:
            return field("if " + step() + order + of({"0.5", "0", "1"}) + " { " + tent() +
                         " } else { " + tent() + " }");
        default:
            return field("if " + truth() + " { " + tent() + " } else { " + of({"0", "0.5"}) + " }");
        }
    }
    std::string smooth() {
        const std::string k = of({"0.9", "k", "0.2", "(k - 0.5)", "(0.5 + p.y * 0.1)", "-0.3"}),
                          a = "(length(p) - 1)", b = of({"p.y", "p.x", "(length(p - X) - 0.5)"});
        const std::string width = of({"max(", "max(", "("}),
                          other = of({"0.001", "20 * abs(p.y)", "abs(p.x)", "2"});
        const std::string below = width == "(" ? k : "max(" + k + ", " + other + ")";
        const std::string h = "max(" + k + " - abs(" + a + " - " + b + "), 0)";
        const std::string sum =
            often() ? "min(" + a + ", " + b + ") - " : "max(" + a + ", " + b + ") + ";
        const std::string body =
            pick(3) == 0 ? "{ let h = clamp(0.5 + 0.5 * (" + b + " - " + a + ") / " + below +
                               ", 0, 1)\n mix(" + b + ", " + a + ", h) - " + k + " * h * (1 - h) }"
                         : "{ let h = " + h + "\n" + sum + "h * h / (4 * " + below + ") }";
        return param() + "implicit(p => " + body + ", within: ball(2))\n";
    }
    std::string exponentials() {
        const std::string n = of({"4", "32", "64", "200", "(30 * k)"}),
                          u = n + " * " + of({"p.x", "(length(p) - 1)", "(length(p - X) - 0.5)"}),
                          v = n + " * " + of({"p.y", "(length(p + X) - 0.5)", "p.x"});
        const std::string within =
            ", within: " + of({"ball(2)", "aabb([-4, -4, -4], [4, 4, 4])", "everywhere"}) + ")\n";
        switch (pick(7)) {
        case 0:
            return param() + "implicit(p => -log(exp(-" + u + ") + exp(-" + v + ")) / " + n +
                   within;
        case 1:
            return param() + "implicit(p => log2(exp2(" + u + ") + exp2(" + v + ")) / " + n +
                   within;
        case 2:
            return param() + "implicit(p => exp(" + u + ") / (1 + exp(" + u + ")) - 0.5" + within;
        case 3: return param() + "implicit(p => 1 / (1 + exp(-" + u + ")) - 0.5" + within;
        case 4: return param() + "implicit(p => log(1 + exp(" + u + ")) - 0.5" + within;
        case 5:
            return param() + "implicit(p => log(exp(" + u + ") * exp(" + v + ")) - 0.5" + within;
        default: return param() + "implicit(p => min(log(exp(" + u + ") + 1), 170) - 0.5" + within;
        }
    }
    std::string powers() {
        const std::string n = of({"2", "3", "7", "64", "65", "66", "101", "128", "0.5", "2.5", "-1",
                                  "-3", "65.5", "2.00000001", "16777217"}),
                          x = of({"p.x", "(p.x - 0.5)", "abs(p.x)", "(0.6 * p.x)", "(-p.y)",
                                  "(p.x + 2.5)"});
        return field("pow(" + x + ", " + n + ")" + of({"", " * 0.01", " * p.y"}));
    }
    std::string ratios() {
        const std::string u = of({"p.x", "(5 * p.x)", "length(p)", "(p.x + p.y)", "(p.x * k)",
                                  "p.x * p.y", "(length(p) - 1)"});
        switch (pick(4)) {
        case 0: return field("sin(" + u + ") / " + u);
        case 1: return field("sin(" + u + ") / (" + u + " + 0.001)");
        case 2: return field("length(p.xy) * sin(" + u + ") / (" + u + ")");
        default: return field("p.y * sin(" + u + ") / " + u);
        }
    }
    std::string argument() {
        return of({"k", "k", "time", "(0.5 + 0.4 * sin(time))", "(k - 1)", "abs(k)", "0.3 * time",
                   "0.7", "-0.5", "(k + 0.3)"});
    }
    std::string conditions() {
        std::string shape = std::string(library[pick(library.size())]), out;
        for (char c : shape) out += c == '@' ? argument() : std::string(1, c);
        if (pick(3) == 0) out = "(" + out + ").offset(0.05)";
        return "import \"dfmodel\" as dfmodel\n" + param() + out + "\n" +
               "render(time: " + of({"1", "3", "10"}) + ")\n";
    }
    std::string repetitions() {
        const std::string motif =
            of({"ellipsoid([0.3, 0.1, 0.5])", "ellipsoid([0.5, 0.2, 0.3])",
                "sphere(0.4).scale([1, 0.3, 0.6])", "superquadric([0.4, 0.3, 0.5], 0.4, 1.5)",
                "box([0.5, 0.3, 0.4]).scale([1, 0.4, 1])",
                "(sphere(0.3) & box(0.4).translate(x: 0.1))"});
        const std::string turned =
            "rotate(" + between(0.1, 1.4) + ", axis: " + of({"X", "Y", "Z"}) + ")";
        std::string shape = motif + "." + turned;
        if (often())
            shape += ".translate([" + between(-0.3, 0.3) + ", " + between(-0.2, 0.2) + ", " +
                     between(-0.3, 0.3) + "])";
        const std::string cell =
            "[" + (often() ? "0" : between(0.7, 1.4)) + ", 0, " + between(0.7, 1.5) + "]";
        shape += ".repeat(" + cell + of({"", "", ", count: [3, 1, 4]"}) + ")";
        return pick(3) == 0 ? "(" + shape + ").offset(0.02)\n" : shape + "\n";
    }
    std::string loops() {
        const std::string inner =
            of({"floor(p.x)", "fract(p.x)", "float(p.x > 0)", "i0", "f0", "abs(f0 - 0.5)",
                "hash(i0)", "sin(pi * f0)", "(s * f0 * (1 - f0))"});
        return param() +
               "implicit(p => {\n let i0 = floor(p.x)\n let f0 = fract(p.x)\n var s = 0.0\n"
               " for i in 0..3 { s = s + 0.1 * " +
               inner + " * (i + 1) }\n p.y + 0.2 * (s" + of({" + ", " * "}) + tent() +
               of({"", " + f0", " * f0 * (1 - f0)"}) + ")\n}, within: ball(2))\n";
    }

    // Value noise by hand in the plane, right or nearly.
    std::string noise() {
        const std::string hash =
            of({"hash(c)", "fract(sin(dot(c, vec2(12.9898, 78.233))) * 43758.5453)",
                "3 * hash(c) - k", "sin(2 * c.x + c.y)", "hash(c) * (1 + 0.1 * c.y)", "c.x * c.y",
                "hash(c) * fract(0.3 * c.x)"});
        const std::string f = of({"fract(x)", "x - i", "fract(x)", "fract(x.yx)", "abs(fract(x))"});
        const std::string ease =
            of({"f", "f * f * (3 - 2 * f)", "smoothstep(0, 1, f)",
                "f * f * f * (f * (f * 6 - 15) + 10)", "f * f", "2 * f - f * f",
                "0.5 - 0.5 * cos(pi * f)", "f * (1.5 - 0.5 * f * f)", "f * f * (4 - 3 * f)",
                "f * (4 * f * f - 6 * f + 3)"});
        const std::string sum = of(
            {"mix(mix(a, b, u.x), mix(c, d, u.x), u.y)", "mix(mix(a, c, u.y), mix(b, d, u.y), u.x)",
             "mix(a, b, u.x) + (c - a) * u.y * (1 - u.x) + (d - b) * u.x * u.y",
             "a + (b - a) * u.x + (c - a) * u.y + (a - b - c + d) * u.x * u.y",
             "a * (1 - u.x) * (1 - u.y) + b * u.x * (1 - u.y) + u.y * (c * (1 - u.x) + d * u.x)",
             "a + (b - a) * u.x + (c - a) * u.y + (a - b + c + d) * u.x * u.y",
             "mix(mix(a, b, u.y), mix(c, d, u.x), u.y)", "mix(a, b, u.x) * mix(a, c, u.y)",
             "mix(a, c, u.y) + mix(a, b, u.x) * k"});
        const std::string at =
            of({"p.xz", "2 * p.xy", "[p.x + p.y, p.x - p.y]", "p.xx", "[p.x, 2 * p.x]",
                "[length(p), p.y]", "p.xz + 0.2 * sin(3 * p.zx)", "[p.x * p.y, p.z]", "k * p.yz",
                "[abs(p.x), p.z]", "[0.6 * p.x + 0.8 * p.z, 0.8 * p.x - 0.6 * p.z]"});
        return "fn h(c: vec2) = " + hash + "\nfn n(x: vec2) {\n let i = floor(x)\n let f = " + f +
               "\n let u = " + ease + "\n let a = h(i)\n let b = h(i + [1, 0])\n" +
               " let c = h(i + [0, 1])\n let d = h(i + 1)\n " + sum + "\n}\n" +
               field("n(" + at + ")" + (often() ? "" : " + 0.5 * n(2 * " + at + ")"));
    }

    // Vectors that turn with an angle of their own, off an axis or through it.
    std::string turns() {
        const std::string angle = of({"2 * p.y", "k * p.y", "1.5 * atan(p.z, p.x)", "length(p.xz)",
                                      "p.x + p.y", "sin(3 * p.y)", "p.x * p.z", "-p.y + 0.3",
                                      "2 * atan(p.z, p.x) + p.y", "0.5 * p.x", "3 * length(p)"});
        const std::string q = of({"vec3(p.x, p.z, p.y)", "vec3(length(p.xz) - 1, p.y, 0)", "2 * p",
                                  "p.zyx + 0.3", "vec3(p.xz, length(p))", "vec3(abs(p.xz), p.y)",
                                  "0.6 * p.xyz + 0.8 * p.zxy", "vec3(p.xy - 0.5, p.x)"});
        const std::string w =
            of({"vec3(c * q.x + s * q.y, c * q.y - s * q.x, q.z)", "vec3(m * q.xy, q.z)",
                "vec3(q.xy * m, q.z) + 0.1", "vec3(c * q.x - s * q.y, 0, s * q.x + c * q.y)",
                "vec3(c * q.x + s * q.y, c * q.y + s * q.x, q.z)", "vec3(m * m * q.xy, q.x)",
                "vec3(c * q.x, s * q.y, q.z)", "vec3(2 * (m * q.xy), -q.z)", "vec3(m * q.yz, c)"});
        const std::string part =
            of({"length(w) - 0.8", "length(w.xy) - 0.5", "length(vec2(abs(w.x) - 0.4, w.y)) - 0.1",
                "w.x", "w.y + w.z", "max(abs(w.x), abs(w.y)) - 0.5", "length(w.xz - 0.3)"});
        return param() + "implicit(p => {\n let a = " + angle + "\n let c = cos(a)\n" +
               " let s = sin(a)\n let m = mat2([c, s], [-s, c])\n let q = " + q +
               "\n let w = " + w + "\n 0.5 * (" + part + ")\n}, within: " +
               of({"ball(2)", "ball(1.5)", "tube(Y, 1)", "ball(1, at: [0.2, 0, 0])",
                   "aabb([-1.5, -1, -2], [1.5, 2, 1.5])"}) +
               ")\n";
    }

    // What a param or the time makes larger and smaller, by one number twice, or nearly.
    std::string sized() {
        const std::string size =
            of({"w", "w", "1 + 0.4 * sin(time)", "0.5 + fract(time)", "w * (1 + 0.3 * sin(time))",
                "1 / w", "min(1, w)", "min(w, 1.2)", "max(w, 1.2)", "w - 0.35",
                "0.4 + 4 * fract(time) * (1 - fract(time))"});
        const std::string q =
            of({"p / s", "p / s", "p * (1 / s)", "p / (2 * s)", "vec3(p.x, p.y / s, p.z)",
                "p / s + 0.2", "abs(p / s)", "vec3(c * p.x - n * p.z, p.y, n * p.x + c * p.z) / s",
                "s * p", "(p - w) / s", "p / (s * s)", "p / s - round(p / s)", "p.zxy / vec3(s)",
                "(p / s + 1) % 2 - 1", "p / vec3(w, 1.2, w)", "p * vec3(1.2, w, 1)",
                "p / s - clamp(round(p / s), -1, 2)"});
        const std::string d = of(
            {"length(q) - 0.5", "length(max(abs(q) - 0.4, 0))", "sqrt(dot(q, q)) - 0.5",
             "max(abs(q.x), abs(q.y)) - 0.3", "smin(length(q) - 0.4, q.y, 0.2)",
             "mmin(length(q) - 0.4, q.y, 0.2)", "smin(length(q) - 0.4, q.y, 0.2 * s)",
             "pow(pow(abs(q.x), 4) + pow(abs(q.y), 4) + pow(abs(q.z), 4), 1 / 4) - 0.5",
             "if q.x > q.y { q.x } else { q.y }", "length(q - vec3(0, clamp(q.y, -0.5, 0.5), 0))",
             "length(q) + 0.1 * sin(5 * q.x)", "length(q.xz) - 0.1 * noise(3 * q)", "q.x * q.y",
             "length(vec2(length(q.xz) - 0.6, q.y)) - 0.2", "mix(length(q), q.x, 0.3)",
             "dot(q, vec3(0.6, 0, 0.8)) - 0.2", "log(1 + dot(q, q))", "length(q) - p.y"});
        const std::string made =
            of({"s * d", "s * d", "d * s - 0.1", "d / s", "2 * s * d", "d * 0.5 * s", "s * (s * d)",
                "d / (1 / s)", "s * (d - 0.2)", "w * d", "s * abs(d)", "-s * d", "s * d + d / s"});
        return "param w = 0.9 in " + std::string(of({"0.4..1.6", "0.5..2", "-1..1", "0.9..1"})) +
               "\nfn smin(a, b, k) { let h = max(k - abs(a - b), 0)\n min(a, b) - h * h / (4 * k) "
               "}" +
               "\nfn mmin(a, b, k) { let h = clamp(0.5 + 0.5 * (b - a) / k, 0, 1)\n" +
               " mix(b, a, h) - k * h * (1 - h) }\nimplicit(p => {\n let s = " + size +
               "\n let c = cos(w)\n let n = sin(w)\n let q = " + q + "\n let d = " + d +
               "\n 0.4 * (" + made + ")\n}, within: ball(2))\n";
    }

    // The nearer of two grids that are half a period apart, or nearly.
    std::string tilings() {
        const std::string shift = of({"h", "h", "-h", "1.5 * r", "0.9 * h", "vec2(h.x, 0)", "r"});
        const std::string pair = of(
            {"let a = p.xz % r - h\n let b = (p.xz - S) % r - h",
             "let a = p.xz - r * round(p.xz / r)\n let u = p.xz + S\n let b = u - r * round(u / r)",
             "let a = p.xz % r - h\n let u = p.xz - S\n let b = u - r * round(u / r)",
             "let a = fract(p.xz) - 0.5\n let b = fract(p.xz - S) - 0.5"});
        const std::string nearer =
            of({"dot(a, a) < dot(b, b)", "length(a) < length(b)", "abs(a.x) < abs(b.x)",
                "dot(a, a) <= dot(b, b)", "max(abs(a.x), abs(a.y)) < max(abs(b.x), abs(b.y))",
                "length(a) < 1.1 * length(b)", "dot(abs(a), r) < dot(abs(b), r)", "a.x < b.x"});
        const std::string measure = of(
            {"max(dot(abs(g), vec2(0.5, 0.8660254)), abs(g.x)) - 0.4",
             "length(vec3(g.x, p.y, g.y)) - 0.3", "length(g) - 0.3", "length(vec3(g, p.y)) - 0.3",
             "max(abs(g.x), abs(g.y)) - 0.4", "length(g - 0.1)", "dot(g, g)", "abs(g.x * g.y)",
             "g.x * g.y", "length(vec2(length(g) - 0.2, p.y)) - 0.1", "length(abs(g) - 0.2)",
             "min(dot(abs(g), r), 0.3)", "length(2 * g + p.y)", "cos(6 * g.x) * 0.1"});
        std::string text =
            "let r = " + std::string(of({"vec2(1, 1.7320508)", "vec2(1, 1)", "vec2(0.8, -1.25)"})) +
            "\n let h = r / 2\n " + pair + "\n let g = if " + nearer +
            " { a } else { b }\n 0.4 * (" + measure + ")";
        for (std::size_t at; (at = text.find('S')) != text.npos;) text.replace(at, 1, shift);
        return param() + "implicit(p => {\n " + text + "\n}, within: " +
               of({"ball(2)", "everywhere", "aabb([-1.5, -1, -2], [1.5, 2, 1.5])"}) + ")\n";
    }

    // What turns about an axis by an angle and more, and fades there, or nearly.
    std::string spirals() {
        const std::string turns = of({"a", "2 * a", "-3 * a", "5 * a", "0.5 * a", "w * a", "a * r",
                                      "round(w) * a", "a + a", "a - 3 * a"});
        const std::string rest =
            of({"2 * r", "-3 * log(r + 0.2)", "p.y", "k * p.y", "sin(3 * p.y) + 1", "time",
                "p.x * p.y", "length(p)", "floor(3 * r)", "1 / (r + 0.1)", "abs(p.x)", "a",
                "noise(2 * p)", "atan(p.z, p.x + 0.3)", "sqrt(r)", "log(r)"});
        const std::string fades = of({"r",
                                      "min(r, 0.3)",
                                      "clamp(r, 0, 0.4)",
                                      "clamp(r, 0.1, 0.4)",
                                      "smoothstep(0, 0.5, r)",
                                      "smoothstep(-0.1, 0.5, r)",
                                      "0.7 * p.x",
                                      "abs(p.z)",
                                      "tanh(2 * r)",
                                      "sin(3 * r)",
                                      "cos(r)",
                                      "clamp(p.x, -0.3, 0.3)",
                                      "-r / 0.6",
                                      "r - 0.1",
                                      "min(r, -0.1)",
                                      "length(p)",
                                      "p.y",
                                      "r * r",
                                      "max(r, 0.1)",
                                      "sin(p.x)"});
        const std::string wave = of({"sin(u)", "cos(u)", "(0.2 + 0.5 * sin(u))", "abs(sin(u))",
                                     "sin(u) * cos(2 * u)", "max(cos(u), 0.2)", "exp(sin(u))",
                                     "fract(u)", "sin(u) * u", "sign(sin(u))", "cos(u + p.y)"});
        return "param k = 1 in -2..2\nparam w = 2 in 1..4\nimplicit(p => {\n let r = length(p.xz)" +
               std::string("\n let a = atan(p.z, p.x)\n let u = ") + turns + of({" + ", " - "}) +
               rest + "\n 0.3 * (" + fades + ") * " + wave + of({"", " - 0.1", " + 0.2 * p.y"}) +
               "\n}, within: ball(2))\n";
    }

    // Copies that differ from cell to cell, hidden at the cells' borders, or nearly.
    std::string cells() {
        const std::string r = "(" + between(0.05, 0.3) + " + " + between(0, 0.3) + " * hash(id))";
        const std::string d =
            of({"length(q) - R", "length(max(abs(q) - R, 0)) + min(max(q.x, q.y) - R, 0)",
                "max(abs(q.x), abs(q.y)) - R", "length(q - 0.1) - R", "length(q.xy) - R",
                "length(vec2(q.x * q.x + q.x, q.y)) - R", "sqrt(q.x * q.x + q.y * q.y + 0.01) - R",
                "length(q * (1 + q.x)) - R", "length(vec2(q.x + 0.3 * (id.y % 2), q.y)) - R"});
        const std::string m = between(0.05, 0.5);
        const std::string kept =
            of({"min(d, M)", "max(-d, -M)", "clamp(d, -1, M)", "clamp(-5 * d, -M, 0)",
                "smoothstep(M, 0, d)", "smoothstep(-0.1, M, d)", "smoothstep(R, 0, length(q))",
                "min(d, 0.5 - max(abs(q.x), abs(q.y)) + M)", "min(d, M - abs(q.x) + 0.2)",
                "max(M - d, 0) * hash(id)", "if d < M { d } else { M }"});
        std::string text =
            "let id = floor(p.xz)\n let q = " +
            std::string(of({"fract(p.xz) - 0.5", "p.xz - id - 0.5", "fract(p.xz)"})) +
            "\n let d = " + d + "\n 0.4 * (" + kept + ")";
        for (const auto &[name, value] : {std::pair{'R', r}, std::pair{'M', m}})
            for (std::size_t at = text.find(name); at != text.npos;
                 at = text.find(name, at + value.size()))
                text.replace(at, 1, value);
        return param() + "implicit(p => {\n " + text + " + " + of({"p.y", "0", "0.5 * p.x"}) +
               "\n}, within: " +
               of({"ball(2)", "everywhere", "aabb([-1.5, -1, -2], [1.5, 2, 1.5])"}) + ")\n";
    }

    // Steps of steps.
    std::string nested() {
        const std::string u = linear(), v = linear();
        const std::string inner = of({"floor", "fract", "round", "ceil"}) + "(" + v + ")";
        const std::string t =
            "(" + u + of({" + ", " - ", " * "}) + of({"", "2 * ", "0.5 * "}) + inner + ")";
        const std::string at = of({"floor", "round", "fract", "ceil"}) + "(" + t + ")";
        switch (pick(5)) {
        case 0: return field("abs(fract(" + t + ") - 0.5)");
        case 1: return field(at + " * " + tent());
        case 2:
            return field("mix(hash(floor(" + t + ")), hash(floor(" + t + ") + 1), fract(" + t +
                         "))");
        case 3:
            return field("mix(hash(" + inner + "), hash(" + inner + " + 1), fract(" + v + ")) * " +
                         at);
        default: return field("min(abs(fract(" + t + ") - 0.5), " + tent() + ")");
        }
    }
    // Sectors by the angle, at its cut as at their own borders.
    std::string angles() {
        const std::string n = of({"3", "4", "5", "6", "2.5", "5.5", "k"}),
                          shift = of({"0", "0.3", "pi", "time", "0.5 * s"});
        const std::string fold =
            of({"(a + s / 2) % s - s / 2", "a % s - s / 2", "a % s", "a - s * round(a / s)",
                "a - s * floor(a / s)", "abs(a % s - s / 2)", "floor(a / s) * s"});
        const std::string motif =
            of({"length(vec3(r * cos(b) - 1, p.y, r * sin(b))) - 0.2",
                "length(vec3(r * cos(b) - 1, p.y, r * abs(sin(b)) - 0.1)) - 0.2",
                "length(vec3(r * cos(b) - 1, p.y, r * sin(b) - 0.2)) - 0.2",
                "r - 1 - 0.2 * cos(3 * b)", "r - 1 - 0.1 * hash(floor(a / s))",
                "p.y - 0.2 * fract(a / tau) * (1 - fract(p.x))"});
        return param() + "implicit(p => {\n let s = tau / " + n + "\n let a = atan(" +
               of({"p.z, p.x", "p.x, p.z", "p.z, p.x + 0.5", "2 * p.z, p.x"}) + ") + " + shift +
               "\n let b = " + fold + "\n let r = length(p.xz)\n " + motif + "\n}, within: " +
               of({"aabb([-2, -1, -1.5], [-0.6, 1, 1.5])",
                   "aabb([-1.5, -1, -2], [1.5, 1, -0.6])"}) +
               ")\n";
    }
    // What shapes make of fields that jump.
    std::string uses() {
        const std::string f = pick(3) == 0   ? "float(" + truth() + ")"
                              : pick(2) == 0 ? step()
                                             : tent() + " * " + (often() ? tent() : step());
        switch (pick(5)) {
        case 0: return param() + "sphere(1).displace(p => 0.1 * " + f + ")\n";
        case 1: return param() + "blend(sphere(1), box(1.4), p => clamp(" + f + ", 0, 1))\n";
        case 2: return param() + "box(1).distort(p => p + vec3(0, 0.1 * " + f + ", 0))\n";
        case 3:
            return param() + "heightfield(q => { let p = vec3(q.x, q.y, 0.3)\n 0.1 * " + f +
                   " }, [3, 3], depth: 1)\n";
        default:
            return param() + "sphere(0.4).repeat([1.3, 0, 1.2], (s, id) => s.scale(" +
                   of({"0.5 + 0.5 * hash(id)", "0.2 * id.x", "1 - hash(id)", "k",
                       "[1, 0.5 + k * k, 0.8]"}) +
                   "))\n";
        }
    }
};

} // namespace

TEST_CASE("what an adversary writes is refused, or is as flat as proved") {
    const int scenes = effort(160), seed = test::seed();
    int accepted = 0, wrong = 0;
    for (int i = 0; i < scenes; ++i) {
        Adversary random(std::uint64_t(seed) * 1'000'003u + std::uint64_t(i));
        const std::string text = random.scene(std::size_t(i) % Adversary::kinds);
        const Verdict verdict = judge(text, random, 3000);
        accepted += verdict.accepted;
        wrong += !verdict.wrong.empty();
        if (std::getenv("FATHOM_SHOW"))
            std::printf("%s: %s", verdict.accepted ? "taken" : verdict.code.c_str(), text.c_str());
        if (!verdict.wrong.empty())
            std::printf("WRONG %d: %s\n%s", i, verdict.wrong.c_str(), text.c_str());
        std::fflush(stdout);
    }
    std::printf("%d of %d accepted\n", accepted, scenes);
    CHECK(wrong == 0);
    CHECK(accepted > scenes / 5);
}

TEST_CASE("a shape of the library is no steeper than proved at the ends of what it takes") {
    int accepted = 0, wrong = 0;
    for (const char *shape : library)
        for (const char *range : {"0..1", "-0.5..1", "0.05..1"})
            for (const bool raw : {false, true}) {
                Adversary random(1);
                std::string text;
                for (const char c : std::string(shape)) text += c == '@' ? "k" : std::string(1, c);
                if (raw) text = "(" + text + ").offset(0.01)";
                text = std::string("import \"dfmodel\" as dfmodel\nparam k = 0.5 in ") + range +
                       "\n" + text + "\n";
                const Verdict verdict = judge(text, random, 2000);
                accepted += verdict.accepted;
                wrong += !verdict.wrong.empty();
                if (std::getenv("FATHOM_SHOW"))
                    std::printf("%s: %s", verdict.accepted ? "taken" : verdict.code.c_str(),
                                text.c_str());
                if (!verdict.wrong.empty())
                    std::printf("WRONG: %s\n%s", verdict.wrong.c_str(), text.c_str());
            }
    std::printf("%d accepted\n", accepted);
    CHECK(wrong == 0);
    CHECK(accepted > int(library.size()));
}
