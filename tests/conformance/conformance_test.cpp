// One suite for all ops and all evaluators.
#include "tests/conformance/questions.h"

#include "backend-cpu/kernels/kernels.h"
#include "backend-cpu/tape.h"

#include <catch2/catch.hpp>

#include <bit>
#include <cmath>
#include <set>

using namespace fathom;
using namespace fathom::conformance;
using ir::Constant;
using ir::NodeId;
using ir::Op;
using ir::Type;

TEST_CASE("every evaluator gives every op its meaning") {
    const std::vector<Question> all = questions();
    for (const Evaluator &evaluator : evaluators())
        for (const Question &question : all) {
            INFO(evaluator.name << ": " << question.name());
            const std::vector<Constant> answers = evaluator.answers(question);
            REQUIRE(answers.size() == question.rows.size());
            int wrong = 0;
            for (std::size_t row = 0; row < answers.size(); ++row) {
                const std::string fault = conformance::fault(question, row, answers[row]);
                if (!fault.empty() && ++wrong <= 3) UNSCOPED_INFO(fault);
            }
            CHECK(wrong == 0);
        }
}

TEST_CASE("all ops that have values are asked") {
    std::set<Op> asked;
    for (const Question &question : questions()) asked.insert(question.c.op);
    CHECK(asked.size() ==
          ir::op_count - 23); // inputs, data, structure and hits have none of their own
}

TEST_CASE("a kernel gives the same bits on every instruction set, with registers and with shared "
          "operands") {
    using namespace fathom::cpu;
    constexpr std::size_t n = 77, room = 128;
    constexpr float numbers[] = {0.0f,  -0.0f, 1.0f,  -1.0f,  0.5f, -2.5f, 3.25f,
                                 1e-6f, 1e9f,  -1e9f, 100.0f, 0.1f, -7.25f};
    const std::vector<LoopSet> sets = point_loop_sets();
    for (std::uint32_t v = 0; v < sets[0].loops.size(); ++v) {
        const Kernel kernel = kernel_of_variant(v);
        const auto ins = static_cast<std::uint32_t>(kernel_inputs(kernel)),
                   outs = static_cast<std::uint32_t>(kernel_outputs(kernel));
        // Ints and truths are read from the same words: small whole numbers, as the kernel's name
        // says.
        const std::string name = kernel_name(kernel);
        const bool whole = name.ends_with("I") || name == "And" || name == "Or" || name == "Not" ||
                           name == "FloatOfInt";
        Random random{v + 1};
        std::vector<Word> cells((outs + ins) * room);
        for (std::uint32_t i = 0; i < ins; ++i)
            for (std::size_t k = 0; k < n; ++k) {
                const bool truth = name.starts_with("Select") && i == 0;
                Word &cell = cells[(outs + i) * room + k];
                if (truth || name == "And" || name == "Or" || name == "Not")
                    cell = random.below(2);
                else if (whole)
                    cell = random.below(20) - 10;
                else
                    cell = std::bit_cast<Word>(random.below(3)
                                                   ? float(random.between(-9, 9))
                                                   : numbers[random.below(std::size(numbers))]);
                if ((mask_of_variant(v) >> i & 1) && k > 0) cell = cells[(outs + i) * room];
            }
        std::vector<std::uint32_t> operands;
        for (std::uint32_t i = 0; i < outs + ins; ++i)
            operands.push_back(i * static_cast<std::uint32_t>(room));
        std::vector<Word> expected = cells;
        sets[0].loops[best_variant(kernel, 0).index](expected.data(), operands.data(), n);
        for (const LoopSet &set : sets) {
            INFO(set.name << ": " << name << ", shared " << mask_of_variant(v));
            std::vector<Word> found = cells;
            set.loops[v](found.data(), operands.data(), n);
            int wrong = 0;
            for (std::size_t i = 0; i < found.size(); ++i) {
                const float a = std::bit_cast<float>(found[i]),
                            b = std::bit_cast<float>(expected[i]);
                wrong += found[i] != expected[i] && !(std::isnan(a) && std::isnan(b));
            }
            CHECK(wrong == 0);
        }
    }
}

TEST_CASE("gradients are what differences say, where there is one") {
    // Each number of an op's arguments moves along x, y or z; one float of its result is
    // differentiated.
    std::size_t compared = 0, asked = 0;
    for (const Question &question : questions()) {
        if (question.c.result == Type::Int || question.c.result == Type::Bool) continue;
        if (question.c.op == Op::Hash) continue; // has none
        INFO(question.name());
        Random random{7};
        for (int iteration = 0; iteration < 25; ++iteration) {
            ir::Scene scene;
            ir::Graph &g = scene.graph;
            const NodeId p = g.fresh_var(Type::Vec3);
            std::vector<NodeId> args;
            std::vector<Constant> at,
                slope; // the arguments at p = 0, and by which p_i each number moves
            for (Type type : question.c.args) {
                Constant base{type, {}}, moves{type, {}};
                std::vector<NodeId> numbers;
                for (std::size_t i = 0; i < static_cast<std::size_t>(ir::components(type)); ++i) {
                    const bool fixed = type == Type::Int || type == Type::Bool;
                    base.value[i] =
                        fixed ? random.below(2) : static_cast<float>(random.between(0.3, 2.3));
                    const bool size = question.c.op == Op::SpotNoise &&
                                      type == Type::Float; // a radius, a density
                    if (!fixed && !size && random.below(3) == 0) base.value[i] = -base.value[i];
                    moves.value[i] = fixed ? -1 : static_cast<double>(random.below(3));
                    if (!fixed)
                        numbers.push_back(g.add(g.number(base.value[i]),
                                                g.component(p, static_cast<int>(moves.value[i]))));
                }
                at.push_back(base);
                slope.push_back(moves);
                if (numbers.empty()) {
                    args.push_back(g.constant(base));
                } else if (ir::is_matrix(type)) {
                    std::vector<NodeId> columns;
                    const auto n = static_cast<std::size_t>(ir::side(type));
                    for (std::size_t c = 0; c < n; ++c)
                        columns.push_back(g.make(Op::Make, ir::vector_type(ir::side(type)),
                                                 std::span(numbers).subspan(c * n, n)));
                    args.push_back(g.make(Op::Make, type, columns));
                } else {
                    args.push_back(numbers.size() == 1 ? numbers[0]
                                                       : g.make(Op::Make, type, numbers));
                }
            }
            NodeId result = g.make(question.c.op, question.c.result, args, question.payload);
            const std::size_t part =
                random.below(static_cast<std::size_t>(ir::components(question.c.result)));
            if (ir::is_matrix(question.c.result)) {
                const auto n = static_cast<std::size_t>(ir::side(question.c.result));
                result = g.component(g.make(Op::Column, ir::vector_type(static_cast<int>(n)),
                                            {result}, static_cast<std::uint32_t>(part / n)),
                                     static_cast<int>(part % n));
            } else if (ir::is_vector(question.c.result)) {
                result = g.component(result, static_cast<int>(part));
            }
            const cpu::Program program =
                cpu::compile(scene, std::span(&p, 1), std::span(&result, 1));
            cpu::GradientScratch scratch = cpu::make_gradient_scratch(program, {});
            const float zero = 0;
            const float *in[] = {&zero, &zero, &zero};
            float out[4];
            float *to[] = {&out[0], &out[1], &out[2], &out[3]};
            cpu::evaluate_gradient(program, scratch, in, to, 1);
            for (int axis = 0; axis < 3; ++axis) {
                auto value = [&](double step) {
                    std::vector<Constant> moved = at;
                    for (std::size_t k = 0; k < at.size(); ++k)
                        for (std::size_t i = 0;
                             i < static_cast<std::size_t>(ir::components(at[k].type)); ++i)
                            if (slope[k].value[i] == axis) moved[k].value[i] += step;
                    return ir::evaluate(question.c.op, question.c.result, moved, question.payload)
                        ->value[part];
                };
                const double h = 1e-5, left = (value(0) - value(-h)) / h,
                             right = (value(h) - value(0)) / h;
                ++asked;
                if (!(std::abs(left - right) <= 1e-3 * (1 + std::abs(left))))
                    continue; // a kink or a jump
                ++compared;
                CAPTURE(axis, iteration);
                const double middle = (left + right) / 2;
                REQUIRE(std::abs(out[1 + axis] - middle) <= 2e-3 * (1 + std::abs(middle)));
            }
        }
    }
    CHECK(compared > asked * 4 / 5);
}
