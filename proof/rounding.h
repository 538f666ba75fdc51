// How far what evaluators compute in single precision may lie from the field as written: a bound on
// the error, node by node, over a box of points and all params and times. The model of arithmetic
// and what it takes on faith: docs/trusted.md, 2.
#pragma once

#include "base/diagnostic.h"
#include "proof/machine.h"

#include <map>
#include <memory>

namespace fathom::proof {

// One number of a field on its way.
struct Rounded {
    Interval value; // in exact arithmetic, with the evaluator's own decisions
    // The evaluator's number x' is as near as |x' - x| <= error + relative |x|; infinity: unknown.
    double error = 0, relative = 0;
    // Where it is linear in the point, its gradient; of what does not vary 0.
    bool linear = true;
    std::array<double, 3> gradient{};
    // Where the error is unknown: both numbers are at least this, as 1/|q| near q = 0 is large.
    double above = -ir::rounding::infinity;
    // Where it is a sum of squares or the like: its root is as near to the evaluator's number's as
    // root_error + root_relative sqrt(x).
    double root_error = ir::rounding::infinity, root_relative = 0;
    // Where it is an angle: borders at which it decides lie that far off, and all of it is no
    // farther than `reach` from its axis.
    double off = ir::rounding::infinity, reach = 0;
};

// What some nodes are made of and they themselves, arguments first; calls and loops count as one.
std::vector<NodeId> reached_from(const ir::Graph &graph, const std::vector<NodeId> &roots);

// A function of the lowered scene, (vec3) -> float or Hit, evaluated with errors.
class RoundingMachine {
  public:
    RoundingMachine(const ir::Scene &scene, ir::FunctionId function);

    // The largest error in the cell: of the value, and of where the evaluator decides (which cell of
    // a repetition, which arm of an `if`); infinity where none was found. `time`, `params`: what they
    // may be, the params by component.
    double error(const Cell &cell, Interval time,
                 const std::vector<std::array<Interval, 4>> &params);
    Interval value() const { return value_; }  // of the last run, in exact arithmetic
    std::size_t work() const { return work_; } // nodes run so far
    std::size_t most_work = 200'000;           // of one run; beyond it the error is infinity

  private:
    struct Step { // a node; components lie in the plan's frame from `out` on
        NodeId id;
        std::vector<std::uint32_t> args;
        std::vector<int> sizes;
        std::uint32_t out = 0;
        int n = 1;
    };
    struct Plan { // what some nodes are made of, in order
        std::vector<Step> steps;
        std::vector<Rounded> frame;
        std::vector<std::uint32_t> results;
    };
    friend struct RoundingRule; // rounding_rules.cpp
    Plan &plan_of(const std::vector<NodeId> &roots);
    void run(Plan &plan);
    void run_step(Plan &plan, const Step &step); // rounding_rules.cpp
    void run_call(Plan &plan, const Step &step, ir::FunctionId function);
    void run_loop(Plan &plan, const Step &step);
    void set_var(NodeId var, const Rounded *values);
    Ranges::Sampled sampled(Op op, std::uint32_t payload);

    const ir::Scene &scene_;
    ir::FunctionId function_;
    std::map<std::vector<NodeId>, std::unique_ptr<Plan>> plans_;
    std::vector<std::vector<Rounded>> vars_; // by Var payload
    Work reading_;                    // without end: images and grids have limits of their own
    std::unique_ptr<Ranges> sampled_; // of images and grids, where some are read
    Interval time_;
    std::vector<std::array<Interval, 4>> params_;
    Interval value_;
    double misplaced_ = 0; // how far from their borders decisions are taken
    std::size_t work_ = 0, limit_ = 0;
};

// Bounds the error of a lowered scene's distance by where rays go. Where the bound is larger than
// the tolerance with which rays arrive, points are tried (trials.h): where the error is seen, the
// marched distance is lowered by it and its place warned of; where most of them are off by more than
// the scene, the scene is refused; where none is seen, that is an axiom of the scene. Fills
// Scene::rounding. `times` as in Options (prove.h).
void bound_rounding(ir::Scene &scene, Diagnostics &diagnostics,
                    const std::optional<Interval> &times = {});

} // namespace fathom::proof
