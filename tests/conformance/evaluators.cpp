// The evaluators under test. Another joins by a row here: a name, and the answers to a question.
#include "backend-cpu/tape.h"
#include "tests/conformance/questions.h"

#include <algorithm>
#include <bit>

namespace fathom::conformance {

using ir::Constant;
using ir::NodeId;
using ir::Type;

namespace {

// The folding of constants while a graph is made: what is left is a constant, of the canonical
// value, but where that has a NaN, which may be left to whoever runs it.
std::vector<Constant> folded(const Question &question) {
    std::vector<Constant> answers;
    for (const auto &row : question.rows) {
        ir::Graph graph;
        std::vector<NodeId> args;
        for (const Constant &arg : row) args.push_back(graph.constant(arg));
        const NodeId made = graph.make(question.c.op, question.c.result, args, question.payload);
        const Constant exact = canonical(question, row);
        const bool left = !graph.is_constant(made) &&
                          std::ranges::any_of(exact.value, [](double x) { return x != x; });
        answers.push_back(left                      ? exact
                          : graph.is_constant(made) ? graph.constant_of(made)
                                                    : Constant{});
    }
    return answers;
}

float as_cell(Type type, double value) {
    if (type == Type::Int || type == Type::Bool)
        return std::bit_cast<float>(static_cast<std::int32_t>(value));
    return static_cast<float>(value);
}
double from_cell(Type type, float cell) {
    if (type == Type::Int || type == Type::Bool) return std::bit_cast<std::int32_t>(cell);
    return cell;
}

// All rows in `batch` points at a time.
std::vector<Constant> on_tape(const Question &question, std::size_t batch) {
    ir::Scene scene;
    std::vector<NodeId> params;
    std::vector<std::vector<float>> in;
    for (std::size_t k = 0; k < question.c.args.size(); ++k) {
        const Type type = question.c.args[k];
        params.push_back(scene.graph.fresh_var(type));
        for (std::size_t i = 0; i < static_cast<std::size_t>(ir::components(type)); ++i) {
            std::vector<float> &column = in.emplace_back();
            for (const auto &row : question.rows) column.push_back(as_cell(type, row[k].value[i]));
        }
    }
    const NodeId result =
        scene.graph.make(question.c.op, question.c.result,
                         with_fixed(question, scene.graph, params), question.payload);
    const cpu::Program program = cpu::compile(scene, params, std::span(&result, 1));
    cpu::Scratch scratch = cpu::make_scratch(program, {});
    const auto size = static_cast<std::size_t>(ir::components(question.c.result));
    std::vector<Constant> answers(question.rows.size(), {question.c.result, {}});
    for (std::size_t first = 0; first < answers.size(); first += batch) {
        const std::size_t n = std::min(batch, answers.size() - first);
        std::vector<const float *> from;
        for (const auto &column : in) from.push_back(column.data() + first);
        std::vector<std::vector<float>> out(size, std::vector<float>(n));
        std::vector<float *> to;
        for (auto &column : out) to.push_back(column.data());
        cpu::evaluate(program, scratch, from.data(), to.data(), n);
        for (std::size_t row = 0; row < n; ++row)
            for (std::size_t i = 0; i < size; ++i)
                answers[first + row].value[i] = from_cell(question.c.result, out[i][row]);
    }
    return answers;
}

// The value beside the gradient, where the result is one float.
std::vector<Constant> on_duals(const Question &question) {
    if (question.c.result != Type::Float) return on_tape(question, 1000);
    ir::Scene scene;
    std::vector<NodeId> params;
    std::vector<std::vector<float>> in;
    for (std::size_t k = 0; k < question.c.args.size(); ++k) {
        const Type type = question.c.args[k];
        params.push_back(scene.graph.fresh_var(type));
        for (std::size_t i = 0; i < static_cast<std::size_t>(ir::components(type)); ++i) {
            std::vector<float> &column = in.emplace_back();
            for (const auto &row : question.rows) column.push_back(as_cell(type, row[k].value[i]));
        }
    }
    const NodeId result =
        scene.graph.make(question.c.op, question.c.result,
                         with_fixed(question, scene.graph, params), question.payload);
    const cpu::Program program = cpu::compile(scene, params, std::span(&result, 1));
    cpu::GradientScratch scratch = cpu::make_gradient_scratch(program, {});
    std::vector<const float *> from;
    for (const auto &column : in) from.push_back(column.data());
    std::vector<std::vector<float>> out(4, std::vector<float>(question.rows.size()));
    float *to[] = {out[0].data(), out[1].data(), out[2].data(), out[3].data()};
    cpu::evaluate_gradient(program, scratch, from.data(), to, question.rows.size());
    std::vector<Constant> answers;
    for (float value : out[0]) answers.push_back({Type::Float, {value}});
    return answers;
}

} // namespace

std::vector<Evaluator> evaluators() {
    return {
        {"folding", folded},
        {"tape, batches", [](const Question &q) { return on_tape(q, 1000); }},
        {"tape, seven at a time", [](const Question &q) { return on_tape(q, 7); }},
        {"tape, one by one", [](const Question &q) { return on_tape(q, 1); }},
        {"dual numbers", on_duals},
    };
}

} // namespace fathom::conformance
