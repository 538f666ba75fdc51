// What every evaluator is asked: an op with the types of tests/unit/glsl/op_cases.h and rows of
// arguments that break careless code; and how far an answer in float32 may be from the canonical
// one in double.
#pragma once

#include "ir/passes/fold.h"
#include "tests/unit/glsl/op_cases.h"

#include <functional>
#include <string>

namespace fathom::conformance {

struct Question {
    scenes::Case c;
    std::uint32_t payload = 0;
    std::vector<std::vector<ir::Constant>> rows; // every float among them is a float32
    bool fixed = false; // the last argument is the same in all rows, and a constant of the graph
    std::string name() const; // "Add vec3 vec3"
};

std::vector<Question> questions();
// The arguments to ask for with, where `args` are what the rows say.
std::vector<ir::NodeId> with_fixed(const Question &question, ir::Graph &graph,
                                   std::vector<ir::NodeId> args);
// The canonical answer (ir/passes/fold.h), in double.
ir::Constant canonical(const Question &question, const std::vector<ir::Constant> &row);
// Why the answer is wrong; empty if it is not.
std::string fault(const Question &question, std::size_t row, const ir::Constant &answer);

struct Evaluator {
    std::string name;
    std::function<std::vector<ir::Constant>(const Question &)> answers; // one a row
};
std::vector<Evaluator> evaluators();

// Reproducible numbers.
struct Random {
    std::uint32_t state = 1;
    std::uint32_t next() {
        state = state * 1664525u + 1013904223u;
        return state >> 8;
    }
    std::uint32_t below(std::size_t n) { return next() % static_cast<std::uint32_t>(n); }
    double between(double lo, double hi) { return lo + (hi - lo) * next() / 16777216.0; }
};

} // namespace fathom::conformance
