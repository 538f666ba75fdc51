// The shader as an evaluator: every op by the GLSL that is written for it, run off screen. Drivers
// may be less exact than a processor, so it has a measure of its own.
#include "tests/conformance/questions.h"
#include "tests/unit/glsl/scenes.h"
#include "tests/unit/render_gl/harness.h"

#include <cmath>
#include <fmt/format.h>

using namespace fathom;
using namespace fathom::conformance;
using ir::Constant;
using ir::NodeId;
using ir::Op;
using ir::Type;

namespace {

// A table holds floats, so an int travels as two of 16 bits each.
int columns_of(Type type) { return type == Type::Int ? 2 : ir::components(type); }

ir::Table table_of(const Question &question) {
    ir::Table table{static_cast<int>(question.rows.size()), 0, {}};
    for (Type type : question.c.args) table.stride += columns_of(type);
    for (const auto &row : question.rows)
        for (const Constant &arg : row) {
            if (arg.type == Type::Int) {
                const double high = std::floor(arg.value[0] / 65536);
                table.data.push_back(static_cast<float>(high));
                table.data.push_back(static_cast<float>(arg.value[0] - high * 65536));
                continue;
            }
            for (int i = 0; i < ir::components(arg.type); ++i)
                table.data.push_back(static_cast<float>(arg.value[static_cast<std::size_t>(i)]));
        }
    return table;
}

// The result's numbers, floats or ints, each a node; an int is cut in two as above.
std::vector<NodeId> numbers_of(ir::Graph &g, NodeId value) {
    const Type type = g[value].type;
    std::vector<NodeId> parts;
    if (type == Type::Int) {
        const NodeId size = g.integer(65536);
        const NodeId low = g.make(Op::Mod, {value, size});
        parts = {g.make(Op::Div, {g.make(Op::Sub, {value, low}), size}), low};
        for (NodeId &part : parts) part = g.make(Op::ToFloat, Type::Float, {part});
    } else if (type == Type::Bool) {
        parts = {g.make(Op::ToFloat, Type::Float, {value})};
    } else if (type == Type::Float) {
        parts = {value};
    } else if (ir::is_vector(type)) {
        for (int i = 0; i < ir::components(type); ++i) parts.push_back(g.component(value, i));
    } else {
        const int n = ir::side(type);
        for (int i = 0; i < n * n; ++i)
            parts.push_back(g.component(
                g.make(Op::Column, ir::vector_type(n), {value}, static_cast<std::uint32_t>(i / n)),
                i % n));
    }
    return parts;
}

// One answer a row: sdf(vec3(row, number, 0)) picks the arguments by x and the number of the result
// by y.
std::vector<Constant> in_shader(const Question &question) {
    int count = 0;
    const ir::Scene scene = scenes::of_field([&](ir::Graph &g, NodeId p) {
        const ir::TableId table = g.add_table(table_of(question));
        const NodeId row = g.make(Op::ToInt, Type::Int, {g.component(p, 0)});
        const auto read = [&](Type type, int column) {
            return g.make(Op::TableRead, type, {row}, ir::table_slot(table, column));
        };
        std::vector<NodeId> args;
        int column = 0;
        for (Type type : question.c.args) {
            args.push_back(
                type == Type::Int
                    ? g.make(Op::Add, {g.make(Op::Mul, {read(type, column), g.integer(65536)}),
                                       read(type, column + 1)})
                    : read(type, column));
            column += columns_of(type);
        }
        args = with_fixed(question, g, args);
        const std::vector<NodeId> parts =
            numbers_of(g, g.make(question.c.op, question.c.result, args, question.payload));
        count = static_cast<int>(parts.size());
        NodeId chosen = parts.back();
        for (int i = count - 2; i >= 0; --i)
            chosen = g.make(Op::Select, {g.make(Op::Less, {g.component(p, 1), g.number(i + 0.5)}),
                                         parts[static_cast<std::size_t>(i)], chosen});
        return chosen;
    });
    Diagnostics diagnostics;
    const glsl::Output output = glsl::emit(
        scene, {.target = glsl::Target::Glsl330, .field_only = true, .buffers = true}, diagnostics);
    for (const Diagnostic &d : diagnostics.items()) UNSCOPED_INFO(d.message);
    REQUIRE_FALSE(diagnostics.has_errors());
    const std::size_t rows = question.rows.size();
    const std::vector<float> found = run_shader(output, static_cast<int>(rows), count);
    std::vector<Constant> answers(rows, {question.c.result, {}});
    for (std::size_t row = 0; row < rows; ++row)
        for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
            const double number = found[i * rows + row];
            if (question.c.result == Type::Int)
                answers[row].value[0] += i == 0 ? number * 65536 : number;
            else
                answers[row].value[i] = number;
        }
    return answers;
}

bool is_sine(Op op) {
    return op == Op::Sin || op == Op::Cos;
} // whose errors are of the angle's size

struct Measure {
    double absolute, relative;
};

// GLSL 4.60, 4.7.1 leaves most functions open; these are a few times what Mesa's fits are off by.
Measure measure_of(Op op) {
    if (op == Op::Perlin || op == Op::Simplex || op == Op::ValueNoise || op == Op::Worley ||
        op == Op::SpotNoise)
        return {2e-5, 4e-6};
    constexpr ir::OpSet near_exact{Op::Sqrt, Op::InverseSqrt, Op::Log, Op::Log2};
    constexpr ir::OpSet growing{Op::Pow, Op::Exp, Op::Exp2, Op::Sinh, Op::Cosh};
    if (growing[op]) return {1e-6, 1e-4};
    if (is_sine(op)) return {5e-7, 1.2e-7}; // which the proof relies on (trusted.md, 2)
    if ((ir::info(op).function && !near_exact[op]) || op == Op::Atan2) return {1e-5, 1e-4};
    return {1e-6, 4e-6};
}

std::string fault_in_shader(const Question &question, std::size_t index, const Constant &answer) {
    const std::vector<Constant> &row = question.rows[index];
    const Constant want = canonical(question, row);
    const auto [absolute, relative] = measure_of(question.c.op);
    const bool whole = question.c.result == Type::Int || question.c.result == Type::Bool;
    double scale = 0;
    bool tiny = false; // numbers that a processor may take for 0
    std::string text;
    for (const Constant &arg : row)
        for (int i = 0; i < ir::components(arg.type); ++i) {
            const double v = arg.value[static_cast<std::size_t>(i)];
            scale = std::max(scale, std::abs(v));
            tiny |= v != 0 && std::abs(v) < 1.2e-38;
            text += fmt::format(" {}", v);
        }
    if (tiny) return {};
    const bool cancels = is_sine(question.c.op) || row.size() > 1 ||
                         ir::components(row[0].type) > 1 || question.c.op == Op::Fract;
    for (std::size_t i = 0; i < static_cast<std::size_t>(ir::components(question.c.result)); ++i) {
        const double w = whole ? want.value[i] : static_cast<float>(want.value[i]),
                     got = answer.value[i];
        if (std::isnan(w) || w == got) continue; // NaN: no stated value
        if (!whole && scale > 1e15 && !(question.c.op == Op::Min || question.c.op == Op::Max))
            continue; // overflows on the way
        const double slack = absolute + relative * std::max(std::abs(w), cancels ? scale : 0);
        bool good = !whole && std::abs(got - w) <= slack;
        if (!whole && std::isinf(w)) // the sign of a zero that is divided by means nothing
            good = std::abs(got) > 1e37 &&
                   (question.c.op == Op::Pow || question.c.op == Op::InverseSqrt ||
                    std::signbit(w) == std::signbit(got));
        if (!whole &&
            question.c.op == Op::Mod) // next to a multiple of the divisor, either end of a turn
            good |= std::abs(std::abs(got - w) - std::abs(row[1].value[i])) <= slack;
        if (!good) return fmt::format(" of{}: component {} is {}, not {}", text, i, got, w);
    }
    return {};
}

} // namespace

TEST_CASE("a shader gives every op its meaning") {
    require_context();
    for (const Question &question : questions()) {
        INFO(question.name());
        const std::vector<Constant> answers = in_shader(question);
        int wrong = 0;
        for (std::size_t row = 0; row < answers.size(); ++row) {
            const std::string fault = fault_in_shader(question, row, answers[row]);
            if (!fault.empty() && ++wrong <= 3) UNSCOPED_INFO(fault);
        }
        CHECK(wrong == 0);
    }
}
