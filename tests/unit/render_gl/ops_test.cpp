// Every op in a shader against its meaning (ir/fold.h), over arguments that break careless code. The arguments come from
// a table, one row a pixel, so that no compiler can fold them.
#include "ir/fold.h"
#include "tests/unit/glsl/op_cases.h"
#include "tests/unit/glsl/scenes.h"
#include "tests/unit/render_gl/harness.h"

#include <cmath>
#include <limits>

using namespace fathom;
using namespace fathom::scenes;
using ir::Constant;
using ir::NodeId;

namespace {

// A small generator of its own, so that a failure can be repeated.
struct Random {
    std::uint32_t state = 12345;
    std::uint32_t next() { return state = state * 1664525u + 1013904223u; }
    double unit() { return (next() >> 8) * (1.0 / 16777216.0); }
};

// Whole numbers and halves, both signs of 0, tiny and large; and where an op can bear it, the largest.
float nasty(Random &random, Op op) {
    const bool trig = op == Op::Sin || op == Op::Cos || op == Op::Tan;
    const bool noise = op == Op::Perlin || op == Op::Simplex || op == Op::ValueNoise || op == Op::Worley ||
                       op == Op::SpotNoise;
    constexpr float special[] = {0.0f,  -0.0f, 1.0f,  -1.0f, 0.5f,    -0.5f,  2.0f,   -2.0f,  3.0f, -3.0f, 1.5f,
                                 -1.5f, 1e-6f, -1e-6f, 0.1f,  0.9999f, 10.0f, -10.0f, 100.0f, -7.25f};
    constexpr float extreme[] = {1e6f, -1e6f, 1e9f, -1e9f, 1e-20f, -1e-20f, 3e38f, -3e38f};
    const double kind = random.unit();
    if (kind < 0.5) return special[random.next() % std::size(special)];
    if (kind < 0.6 && !trig && !noise) return extreme[random.next() % std::size(extreme)];
    return static_cast<float>((random.unit() - 0.5) * (trig ? 12 : 20));
}

double nasty_value(Random &random, Op op, Type type) {
    if (type == Type::Bool) return random.next() & 1u;
    if (type == Type::Int) {
        constexpr double special[] = {0, 1, -1, 2, -2, 3, 7, -7, 100, 65536, -65536};
        return special[random.next() % std::size(special)];
    }
    // A spot's radius and density; below that, coordinates divided by it leave what float32 can tell apart.
    if (op == Op::SpotNoise && type == Type::Float) return static_cast<float>(0.2 + 9 * random.unit());
    return nasty(random, op);
}

// How far a shader's float may be from the exact value: drivers are allowed a few units in the last place, more in the
// functions that they compute by fits.
double tolerance(Op op, double expected, double scale) {
    double relative = 4e-6, absolute = 1e-6;
    if (op == Op::Pow || op == Op::Exp || op == Op::Exp2 || op == Op::Sinh || op == Op::Cosh) relative = 1e-4;
    if (op == Op::Sin || op == Op::Cos || op == Op::Tan || op == Op::Atan || op == Op::Atan2 || op == Op::Asin ||
        op == Op::Acos || op == Op::Tanh)
        absolute = 1e-5, relative = 1e-4;
    if (op == Op::Perlin || op == Op::Simplex || op == Op::ValueNoise || op == Op::Worley || op == Op::SpotNoise)
        absolute = 2e-5;
    return absolute + relative * std::max(std::abs(expected), scale);
}

} // namespace

TEST_CASE("every op means in a shader what it means everywhere") {
    if (!has_context()) return;
    constexpr int rows = 256;
    for (std::size_t index = 0; index < ir::op_count(); ++index) {
        const Op op = static_cast<Op>(index);
        for (const Case &c : cases_of(op))
            for (std::uint32_t payload : payloads_of(op)) {
                std::string types;
                for (Type t : c.args) types += std::string(" ") + ir::type_name(t);
                CAPTURE(ir::info(op).name, types, ir::type_name(c.result), payload);

                // The arguments' numbers, and what comes of them.
                Random random;
                ir::Table table{rows, 0, {}};
                for (Type t : c.args) table.stride += ir::components(t);
                std::vector<Constant> expected;
                std::vector<double> scales;
                for (int row = 0; row < rows; ++row) {
                    std::vector<Constant> args;
                    double scale = 0;
                    for (Type t : c.args) {
                        Constant arg{t, {}};
                        for (int i = 0; i < ir::components(t); ++i) {
                            const double v = nasty_value(random, op, t);
                            arg.value[static_cast<std::size_t>(i)] = v;
                            table.data.push_back(static_cast<float>(v));
                            scale = std::max(scale, std::abs(v));
                        }
                        args.push_back(arg);
                    }
                    const auto value = ir::evaluate(op, c.result, args, payload);
                    REQUIRE(value);
                    expected.push_back(*value);
                    scales.push_back(scale);
                }

                const int components = ir::components(c.result);
                ir::Scene scene = scenes::of_field([&](ir::Graph &g, NodeId p) {
                    const ir::TableId id = g.add_table(table);
                    const NodeId row = g.make(Op::ToInt, Type::Int, {g.component(p, 0)});
                    std::vector<NodeId> args;
                    int column = 0;
                    for (Type t : c.args) {
                        args.push_back(g.make(Op::TableRead, t, {row}, ir::table_slot(id, column)));
                        column += ir::components(t);
                    }
                    const NodeId value = g.make(op, c.result, args, payload);
                    std::vector<NodeId> parts;
                    const auto add = [&](NodeId part) {
                        const Type t = g[part].type;
                        parts.push_back(t == Type::Float ? part : g.make(Op::ToFloat, Type::Float, {part}));
                    };
                    if (ir::is_matrix(c.result)) {
                        const int n = ir::side(c.result);
                        for (int i = 0; i < n * n; ++i)
                            add(g.component(g.make(Op::Column, ir::vector_type(n), {value}, static_cast<std::uint32_t>(i / n)), i % n));
                    } else if (ir::is_vector(c.result)) {
                        for (int i = 0; i < components; ++i) add(g.component(value, i));
                    } else {
                        add(value);
                    }
                    NodeId chosen = parts.back();
                    for (int i = components - 2; i >= 0; --i)
                        chosen = g.make(Op::Select, {g.make(Op::Less, {g.component(p, 1), g.number(i + 0.5)}),
                                                     parts[static_cast<std::size_t>(i)], chosen});
                    return chosen;
                });
                Diagnostics diagnostics;
                const glsl::Output output = glsl::emit(
                    scene, {.target = glsl::Target::Glsl330, .field_only = true, .buffers = true}, diagnostics);
                for (const Diagnostic &d : diagnostics.items()) UNSCOPED_INFO(d.message);
                REQUIRE_FALSE(diagnostics.has_errors());
                const std::vector<float> found = run_shader(output, rows, components);
                int wrong = 0;
                for (int row = 0; row < rows; ++row)
                    for (int i = 0; i < components; ++i) {
                        const double want = static_cast<float>(expected[static_cast<std::size_t>(row)].value[static_cast<std::size_t>(i)]);
                        const float got = found[static_cast<std::size_t>(i * rows + row)];
                        if (std::isnan(want)) continue; // unspecified
                        const double scale = ir::is_vector(c.args[0]) || ir::is_matrix(c.args[0]) || c.args.size() > 1 || op == Op::Fract
                                                 ? scales[static_cast<std::size_t>(row)]
                                                 : 0;
                        // What overflows float on the way has no stated value.
                        const bool huge = scale > 1e15 && op != Op::Min && op != Op::Max && op != Op::Select;
                        const bool good = std::isinf(want) || std::abs(want) > 1e37 || huge
                                              ? !std::isinf(want) || huge || std::abs(got) > 1e30 || std::isnan(got)
                                              : std::abs(got - want) <= tolerance(op, want, scale);
                        if (!good && ++wrong <= 3) {
                            std::string args;
                            for (int k = 0; k < table.stride; ++k)
                                args += " " + std::to_string(table.data[static_cast<std::size_t>(row * table.stride + k)]);
                            UNSCOPED_INFO("of" << args << ": component " << i << " is " << got << ", not " << want);
                        }
                    }
                CHECK(wrong == 0);
            }
    }
}
