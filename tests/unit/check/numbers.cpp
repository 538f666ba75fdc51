// Numbers that single precision does not hold, in every numeric place of the language: each is
// refused where it stands, or the scene has a field that is a number everywhere.
#include "compiled.h"

#include "backend-cpu/tape.h"
#include "backend-glsl/emit.h"
#include "base/single.h"
#include "tests/support/effort.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <set>

using namespace fathom;

namespace {

struct Entry {
    std::string name, text;
};

// Numbers that no scene can hold, wherever they stand; and those that some places can take.
const std::vector<std::string> none{"1e-45", "1e-39",       "1e39",
                                    "1e308", "(inf - inf)", "(1e30 * 1e30)"};
const std::vector<std::string> nasty{"0",    "(-0.0)", "1.2e-38", "1e-20", "2e-18", "5e17", "1e19",
                                     "1e38", "-1e38",  "inf",     "-inf",  "small", "large"};
// Read only where a text names them.
const std::string params = "param small = 1.0 in 1e-18..1.0\nparam large = 1.0 in 1.0..1e18\n";

// The examples of the library, as the comments have them.
std::vector<Entry> examples() {
    std::vector<Entry> out;
    for (const typecheck::LibraryEntry &e :
         typecheck::library_entries(driver::standard_library())) {
        const std::string mark = "Example: `";
        const std::size_t at = e.doc.find(mark);
        if (at == std::string::npos) continue;
        const std::size_t begin = at + mark.size();
        const std::string import = e.module.empty() ? "" : "import \"dfmodel\" as dfmodel\n";
        out.push_back({e.name, import + e.doc.substr(begin, e.doc.find('`', begin) - begin)});
        // each parameter that the example leaves out, once
        const std::string text = out.back().text;
        const std::size_t call = text.find(e.name + "(");
        if (call == std::string::npos) continue;
        for (std::size_t p = e.signature.find(" = "); p != std::string::npos;
             p = e.signature.find(" = ", p + 1)) {
            const std::size_t colon = e.signature.rfind(':', p);
            const std::size_t start = e.signature.find_last_of("(, ", colon) + 1;
            const std::string name = e.signature.substr(start, colon - start);
            const std::string type = e.signature.substr(colon + 2, p - colon - 2);
            if (type != "float" && type != "vec2" && type != "vec3" && type != "int") continue;
            if (text.find(name + ":") != std::string::npos) continue;
            int depth = 0;
            std::size_t end = call + e.name.size();
            do depth += text[end] == '(' ? 1 : text[end] == ')' ? -1 : 0;
            while (depth > 0 && ++end < text.size());
            const bool first = text[end - 1] == '(';
            out.push_back({e.name, text.substr(0, end) + (first ? "" : ", ") + name + ": 1" +
                                       text.substr(end)});
        }
    }
    return out;
}

// What the checker has built in.
const std::vector<Entry> built_in{
    {"vec2", "box(vec3(vec2(1, 2), 1))"},
    {"vec3", "implicit(p => length(p * vec3(1, 0.5, 0.7)) - 1, within: ball(2))"},
    {"vec4", "sphere(length(vec4(1, 0.5, 0.25, 0.125)))"},
    {"mat2", "implicit(p => length(mat2(1, 0, 0.5, 1) * p.xy) - 1, within: ball(2))"},
    {"mat3", "implicit(p => length(mat3(1) * p) - 1, within: ball(2))"},
    {"mat4", "implicit(p => length(mat4(1) * vec4(p, 1)) - 1.5, within: ball(2))"},
    {"transpose",
     "implicit(p => length(transpose(mat2(1, 0, 0.5, 1)) * p.xy) - 1, within: ball(2))"},
    {"length", "implicit(p => length(p + [1, 2, 3]) - 1, within: ball(2))"},
    {"dot", "implicit(p => dot(p, [1, 2, 3]) - 1, within: ball(2))"},
    {"cross", "implicit(p => length(cross(p, [1, 2, 3])) - 1, within: ball(2))"},
    {"normalize", "implicit(p => dot(p, normalize([1, 2, 3])) - 1, within: ball(2))"},
    {"int", "sphere(int(1.5))\nimplicit(p => p.x - int(1.5), within: ball(2))"},
    {"float", "sphere(float(1))"},
    {"div", "sphere(div(7, 2))"},
    {"rgb", "sphere(1).paint(rgb(0.5, 0.25, 1))"},
    {"hash", "sphere(1 + hash(0.5))\nimplicit(p => p.x + hash([1, 2, 3]), within: ball(2))"},
    {"len", "sphere(len([1, 2, 3]))"},
    {"map", "for x in map([1, 2, 3], i => 2 * i) { sphere(x) }"},
    {"filter", "for x in filter([1, 2, 3], i => i < 2) { sphere(x) }"},
    {"fold", "sphere(fold([1, 2, 3], 0.5, (a, b) => a + b))\n"
             "implicit(p => fold([1, 2, 3], 0.5, (a, b) => min(a, b * p.x)), within: ball(2))"},
    {"zip", "for x in zip([1, 2], [3, 4], (a, b) => a * b) { sphere(x) }"},
    {"concat", "for x in concat([1, 2], [3]) { sphere(x) }"},
    {"reverse", "for x in reverse([1, 2, 3]) { sphere(x) }"},
    {"sort", "for x in sort([2, 1, 3]) { sphere(x) }"},
    {"range", "for x in range(1, 3, 0.5) { sphere(x) }"},
    {"random", "sphere(random(1, 2, 3))\nbox(random([1, 1, 1], [2, 2, 2], 4))"},
    {"pick", "sphere(pick([1, 2, 3], 4))"},
    {"shuffle", "for x in shuffle([1, 2, 3], 4) { sphere(x) }"},
    {"print", "print(1)\nsphere(1)"},
    {"assert", "assert(1 < 2)\nsphere(1)"},
    {"implicit", "implicit(p => 0.5 * length(p) - 1, lipschitz: 1)"},
    {"implicit", "implicit(p => 0.5 * length(p) - 1, estimate: 1)"},
    {"cached", "sphere(1).displace(cached(p => 0.1 * fbm(3 * p, octaves: 4), cell: 0.05))"},
    {"hide", "sphere(1) | sphere(2).hide()"},
    {"only", "sphere(1).only()"},
    {"lipschitz", "sphere(lipschitz(box(1).twist(0.5)))"},
    {"implicit2", "implicit2(p => 0.5 * length(p) - 1, lipschitz: 1).extrude(1)"},
    {"implicit2", "implicit2(p => 0.5 * length(p) - 1, estimate: 1).extrude(1)"},
    {"ball", "implicit(p => p.x, within: ball(1, at: [1, 2, 3]))"},
    {"aabb", "implicit(p => p.x, within: aabb([-1, -2, -1], [1, 2, 1]))"},
    {"tube", "implicit(p => p.x, within: tube([0, 1, 0], 1))"},
    {"image", "box(1).paint(material(texture: image(\"tiles.png\", 0.5), texture_scale: 0.5))"},
    {"material", "sphere(1).paint(material(diffuse: [1, 0.5, 0], specular: [1, 1, 1], exponent: 8, "
                 "emission: [0, 0, 1]))"},
    {"camera", "sphere(1)\ncamera(at: [5, 3, 6], look_at: [0, 1, 0], fov: 0.8)"},
    {"light", "sphere(1)\nlight(at: [5, 3, 6], color: [1, 1, 1], intensity: 0.8)"},
    {"sun", "sphere(1)\nsun(direction: [5, 3, 6], color: [1, 1, 1], intensity: 0.8)"},
    {"lighting", "sphere(1)\nlighting(ambient: 0.2, ambient_occlusion: 1, shadow_darkness: 0.6, "
                 "soft_shadows: 0.03, specular_intensity: 0.5)"},
    {"background", "sphere(1)\nbackground([0.5, 0.5, 1])\n"},
    {"render", "sphere(1).rotate(time)\nrender(max_steps: 300, epsilon: 1e-4, far: 100, time: 10)"},
};
// Functions of one, two and three numbers, asked at both times.
const std::vector<std::vector<std::string>> functions{
    {
#define FATHOM_FUNCTION(name, function, ...) #function,
#include "ir/ops.def"
#include "tests/support/effort.h"
        "abs", "sign", "floor", "ceil", "round", "trunc", "fract"},
    {"pow", "mod", "min", "max", "step", "atan"},
    {"clamp", "mix", "smoothstep"}};

std::vector<Entry> of_functions() {
    std::vector<Entry> out;
    for (std::size_t n = 0; n < functions.size(); ++n)
        for (const std::string &name : functions[n]) {
            std::string more;
            for (std::size_t i = 0; i < n; ++i) more += i == 0 ? ", 0.5" : ", 0.75";
            out.push_back({name, "sphere(1 + abs(" + name + "(0.25" + more + ")))"});
            out.push_back({name, "implicit(p => p.y + " + name + "(0.25 * p.x" + more +
                                     "), within: ball(2))"});
        }
    return out;
}

// Where the numbers of a text stand; those of strings, names and colours are none.
std::vector<std::pair<std::size_t, std::size_t>> numbers_of(const std::string &text) {
    std::vector<std::pair<std::size_t, std::size_t>> out;
    const auto word = [&](std::size_t i) {
        return std::isalnum(static_cast<unsigned char>(text[i])) || text[i] == '_';
    };
    for (std::size_t i = 0; i < text.size();) {
        std::size_t end = i + 1;
        if (text[i] == '"') {
            end = text.find('"', end) + 1;
        } else if (text[i] == '#' || word(i)) {
            while (end < text.size() &&
                   (word(end) ||
                    (text[end] == '.' && std::isdigit(text[i]) &&
                     std::isdigit(static_cast<unsigned char>(text[end + 1]))) ||
                    (text[end] == '-' && text[end - 1] == 'e' && std::isdigit(text[i]))))
                ++end;
            if (std::isdigit(static_cast<unsigned char>(text[i]))) out.push_back({i, end - i});
        }
        i = end;
    }
    return out;
}

constexpr double reach = longest * 1.001; // boxes are rounded outward

bool said(const driver::Compilation &c, Code code) {
    return std::ranges::any_of(c.diagnostics.items(),
                               [&](const Diagnostic &d) { return d.code == code; });
}

// Whether all constants below a node are numbers of single precision, or infinite.
bool constants_fit(const ir::Graph &graph, ir::NodeId root) {
    std::vector<ir::NodeId> todo{root};
    std::set<ir::NodeId> seen;
    while (!todo.empty()) {
        const ir::NodeId id = todo.back();
        todo.pop_back();
        if (!id || !seen.insert(id).second) continue;
        const ir::Node &node = graph[id];
        if (graph.is_constant(id))
            for (const double part : graph.constant_of(id).value)
                if (!std::isinf(part) && !fits_single(part)) return false;
        if (node.op == ir::Op::Call)
            todo.push_back(graph.function(ir::FunctionId{std::size_t{node.payload}}).result);
        if (node.op == ir::Op::Loop) {
            const ir::Loop &loop = graph.loop(ir::LoopId{std::size_t{node.payload}});
            todo.insert(todo.end(), loop.next.begin(), loop.next.end());
            todo.push_back(loop.condition);
        }
        const auto args = graph.args(id);
        todo.insert(todo.end(), args.begin(), args.end());
    }
    return true;
}

// Nothing, or what is wrong with the answer to a text.
std::string fault_of(const std::string &text, bool to_shader) {
    const driver::Compilation c =
        driver::compile_text("scene.sdf", text, FATHOM_SOURCE_DIR "/examples/parts", {});
    for (const Diagnostic &d : c.diagnostics.items())
        if (d.severity == Severity::Error &&
            (d.primary.span.source != SourceId{std::size_t{0}} ||
             (d.primary.span.end <= d.primary.span.begin && d.code != Code::EmptyScene)))
            return "an error without a place: " + d.message;
    if (!c.good()) return "";
    const ir::Scene &scene = c.scene;
    for (const ir::TopLevel &top : scene.top_level) {
        const ir::ShapeFact &fact = scene.facts[top.shape.index];
        if (!(fact.lipschitz_sup > 0 && fact.lipschitz_sup <= reach)) return "a bound of none";
        for (std::size_t i = 0; i < 3; ++i)
            for (const double end : {fact.bounds.lo[i], fact.bounds.hi[i]})
                if (std::isnan(end) || (std::isfinite(end) && std::abs(end) > reach))
                    return "a box of none";
    }
    if (said(c, Code::DegenerateRange)) return ""; // at an end of it there is no shape, it says
    const std::array<float, 7> x{0.3f, 0, 1, -5, 100, 0, 0.6f}, y{0.2f, 0, 2, 0.1f, 3, 1, 0.6f},
        z{-0.4f, 0, 3, 7, 50, 0, 0.6f};
    const cpu::Program program = cpu::compile(scene, scene.distance);
    for (const bool low : {true, false}) {
        cpu::Inputs inputs = cpu::inputs_of(scene, low ? 0 : scene.render.time_end);
        for (std::size_t i = 0; i < scene.params.size(); ++i)
            if (scene.params[i].has_range)
                inputs.params[i] = low ? scene.params[i].lo : scene.params[i].hi;
        cpu::Scratch scratch = cpu::make_scratch(program, inputs);
        std::array<float, 7> d{};
        const float *in[] = {x.data(), y.data(), z.data()};
        float *out[] = {d.data()};
        cpu::evaluate(program, scratch, in, out, d.size());
        for (std::size_t i = 0; i < d.size(); ++i)
            if (std::isnan(d[i]))
                return fmt::format("no number at point {}{}", i, (low ? ", low" : ", high"));
    }
    if (!constants_fit(scene.graph, scene.graph.function(scene.distance).result))
        return "a constant of none";
    if (!to_shader) return "";
    Diagnostics of_shader;
    glsl::emit(scene, {}, of_shader);
    return of_shader.has_errors() ? of_shader.items()[0].message : "";
}

} // namespace

TEST_CASE("a number in every numeric place is refused there, or means something") {
    std::vector<Entry> entries = examples();
    const std::vector<Entry> more = of_functions();
    entries.insert(entries.end(), built_in.begin(), built_in.end());
    entries.insert(entries.end(), more.begin(), more.end());
    std::set<std::string> asked;
    for (const Entry &e : entries) asked.insert(e.name);
    const auto library = typecheck::library_entries(driver::standard_library());
    std::set<std::string> documented; // an overload may stand below the one that says it
    for (const typecheck::LibraryEntry &e : library)
        if (!e.doc.empty()) documented.insert(e.name);
    for (const typecheck::LibraryEntry &e : library) {
        INFO(e.name);
        const bool constant = e.signature.find('(') == std::string::npos;
        CHECK((constant || asked.count(e.name) == 1));
        CHECK((constant || documented.count(e.name) == 1));
    }
    // The places take turns with the numbers; FATHOM_EFFORT=6 tries every number in every place.
    const std::size_t stride = test::effort(1) >= 6 ? 1 : 6;
    std::size_t asked_texts = 0;
    for (const Entry &e : entries) {
        const auto numbers = numbers_of(e.text);
        const auto with = [&](std::pair<std::size_t, std::size_t> place,
                              const std::string &number) {
            return e.text.substr(0, place.first) + number +
                   e.text.substr(place.first + place.second);
        };
        for (const auto &place : numbers) {
            const std::size_t first = asked_texts % stride;
            for (std::size_t turn = first; turn < nasty.size(); turn += stride) {
                const std::string &number = nasty[turn];
                const bool param = number == "small" || number == "large";
                const std::string text = (param ? params : "") + with(place, number);
                // the validator of shaders takes longer than all else, so it sees some
                const std::string fault = fault_of(text, ++asked_texts % 16 == 0);
                if (!fault.empty()) FAIL_CHECK(text << "\n=> " << fault);
            }
        }
        if (numbers.empty()) continue;
        for (const std::string &number : none) {
            const std::string text = with(numbers.front(), number);
            INFO(text);
            const driver::Compilation c =
                driver::compile_text("scene.sdf", text, FATHOM_SOURCE_DIR "/examples/parts", {});
            CHECK((said(c, Code::BadNumber) || said(c, Code::NumberRange)));
        }
    }
    CHECK(asked_texts * stride > 10'000);
}

TEST_CASE("what is no number of single precision is refused where it arises") {
    const auto place = [](const std::string &text) -> std::string {
        const driver::Compilation c = test::compiled(text);
        std::string out;
        for (const Diagnostic &d : c.diagnostics.sorted()) {
            if (d.severity != Severity::Error) continue;
            const Span s = d.primary.span;
            out += (out.empty() ? "" : ", ") + std::string(code_name(d.code)) + " `" +
                   text.substr(s.begin, s.end - s.begin) + "`";
            CHECK(d.fix);
        }
        return out;
    };
    // as text
    CHECK(place("sphere(1e39)") == "bad-number `1e39`");
    CHECK(place("sphere(1).translate(x: 1e308)") == "bad-number `1e308`");
    CHECK(place("sphere(4.9e-324)") == "bad-number `4.9e-324`");
    CHECK(place("sphere(1).rotate(1e38turn)") == "bad-number `1e38turn`");
    // as what is computed
    CHECK(place("box([1, inf - inf, 1])") == "number-range `inf - inf`");
    CHECK(place("sphere(exp(1000))") == "number-range `exp(1000)`");
    CHECK(place("box([1, 2, 1] / 0)") == "number-range `[1, 2, 1] / 0`");
    CHECK(place("sphere(1e30 * 1e30)") == "number-range `1e30 * 1e30`");
    CHECK(place("sphere(1e30 ^ 2)") == "number-range `1e30 ^ 2`");
    CHECK(place("sphere(length([1e30, 1] * 1e30))") == "number-range `[1e30, 1] * 1e30`");
    CHECK(place("sphere(sin(inf))") == "number-range `sin(inf)`");
    CHECK(place("let a = -8\nsphere(a ^ 0.5)") == "number-range `a ^ 0.5`");
    CHECK(place("let m = mat2(1e30) * mat2(1e30)\nsphere(m[0][0])") ==
          "number-range `mat2(1e30) * mat2(1e30)`");
    CHECK(place("fn f() { var x = 1e30\n x *= x\n x }\nsphere(f())") == "number-range `x *= x`");
    CHECK(place("sphere(int(1e30))") == "number-range `1e30`");
    // as what a shape or a setting is made of
    CHECK(place("sphere(inf)") == "number-range `inf`");
    CHECK(place("sphere(1e19)") == "number-range `1e19`");
    CHECK(place("sphere(1).rotate(inf)") == "number-range `inf`");
    CHECK(place("sphere(1).translate([0, 1e20, 0])") == "number-range `[0, 1e20, 0]`");
    CHECK(place("polygon([[0, 0], [1, 0], [inf, 1], [0, 1], [-1, 0]]).extrude(1)") ==
          "number-range `[[0, 0], [1, 0], [inf, 1], [0, 1], [-1, 0]]`");
    CHECK(place("sphere(1)\ncamera(at: [inf, 0, 0])") == "number-range `[inf, 0, 0]`");
    CHECK(place("sphere(1)\nlight(at: [1, 2, 3], intensity: 1e20)") == "number-range `1e20`");
    CHECK(place("sphere(1)\nrender(far: 1e20)") == "number-range `1e20`");
    CHECK(place("sphere(1)\nrender(time: inf)") == "number-range `inf`");
    CHECK(place("sphere(1).paint([inf, 0, 0])") == "number-range `[inf, 0, 0]`");
    CHECK(place("implicit(p => length(p) - 1, within: ball(inf))") == "number-range `inf`");
    CHECK(place("param a = 1.0 in 0.5..inf\nsphere(a)") == "number-range `inf`");
    CHECK(place("param a = 1.0 in 0.5..1e30\nsphere(a)") == "number-range `1e30`");
    // as part of a field
    CHECK(place("implicit(p => length(p) - inf, within: ball(1))") ==
          "number-range `length(p) - inf`");
    CHECK(place("implicit(p => dot(p, [0, inf, 0]), within: ball(1))") ==
          "number-range `dot(p, [0, inf, 0])`");
    CHECK(place("implicit(p => length([p.x, inf]), within: ball(1))") ==
          "number-range `length([p.x, inf])`");
    CHECK(place("sphere(1).displace(p => inf)") == "number-range `sphere(1).displace(p => inf)`");
    // as what shapes come to, one over another
    CHECK(place("sphere(1).scale(1e15).scale(1e15)") ==
          "number-range `sphere(1).scale(1e15).scale(1e15)`");
    CHECK(place("sphere(1).scale(1e-15).scale(1e-15)") ==
          "number-range `sphere(1).scale(1e-15).scale(1e-15)`");
    CHECK(place("param a = 1.0 in 0.5..1e10\nsphere(a * a)") == "number-range `sphere(a * a)`");
    CHECK(place("render(time: 1e10)\nsphere(1).translate(x: 1e10 * time)") ==
          "number-range `sphere(1).translate(x: 1e10 * time)`");
    CHECK(place("implicit(p => 1e30 * p.x, within: ball(1))") ==
          "number-range `implicit(p => 1e30 * p.x, within: ball(1))`");
}

TEST_CASE("infinity and the smallest numbers have their meanings") {
    const auto good = [](const std::string &text) {
        const driver::Compilation c = test::compiled(text);
        for (const Diagnostic &d : c.diagnostics.items()) UNSCOPED_INFO(d.message);
        return c.good();
    };
    CHECK(good("sphere(0.1).repeat([1, 1, 1], count: [3, inf, 3])"));
    CHECK(good("sphere(0.1).repeat([1, 1, 1], count: inf)"));
    CHECK(good("gdf_icosahedron(1, exponent: inf)"));
    CHECK(good("pseudonorm_blend(sphere(1), box(1), inf)"));
    CHECK(good("assert(-inf < 1 and 1 < inf and 1 / inf == 0 and 2 * inf == inf)\nsphere(1)"));
    CHECK(good("sphere(fold([3, 1, 2], inf, (a, b) => min(a, b)))"));
    CHECK(good("sphere(sort([inf, 1, 3])[0])"));
    CHECK(good("sphere(1).displace(p => 0.1 * clamp(sin(p.x), 0, inf))"));
    CHECK(good("fn least(p: vec3) -> float {\n  var d = inf\n"
               "  for i in 0..3 { d = min(d, length(p - [i, 0, 0]) - 0.2) }\n  d\n}\n"
               "implicit(least, within: ball(4))"));
    CHECK(good("fn least(p: vec3) -> float {\n  var d = 1e30\n"
               "  for i in 0..3 { d = min(d, length(p - [i, 0, 0]) - 0.2) }\n  d\n}\n"
               "implicit(least, within: ball(4))"));
    // less than single precision holds is 0, and so is less than a shape can be told from
    CHECK(good("assert(1e-30 * 1e-30 == 0)\nsphere(1)"));
    CHECK(good("sphere(1).translate(x: 0.3 - 0.1 * 3 + 1e-25)"));
    CHECK(good("implicit(p => 1e-30 * p.x, within: ball(1))"));
    const driver::Compilation c = test::compiled("implicit(p => 1e-30 * p.x, within: ball(1))");
    CHECK(c.scene.facts[c.scene.top_level[0].shape.index].lipschitz_sup >= shortest);
}

TEST_CASE("a slider is set to a number that shapes can have") {
    for (const std::string value : {"1e39", "1e20", "inf", "inf - inf", "exp(1000)"}) {
        driver::CompileOptions options;
        options.overrides = {{"a", value}};
        const driver::Compilation c =
            driver::compile_text("scene.sdf", "param a = 1.0 in 0.5..2.0\nsphere(a)", ".", options);
        INFO(value);
        CHECK(c.usage_errors.size() == 1);
    }
}
