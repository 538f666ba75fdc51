// A field at single points: what single precision makes of it, beside what is meant. Both take the
// decisions that single precision takes (which cell, which arm, which turn of a loop), so that they
// differ by what rounding does to a value and not by where it decides.
#pragma once

#include "ir/scene.h"
#include "proof/machine.h"

#include <map>
#include <memory>

namespace fathom::proof {

struct Trial {
    double meant = 0, computed = 0; // NaN: too much work
    double error() const;           // infinity where the computed one is no number and the other is
};

class Trials {
  public:
    // A function of the lowered scene, (vec3) -> float. Images and grids are taken to be 0.
    Trials(const ir::Scene &scene, ir::FunctionId function);
    Trial at(const std::array<double, 3> &point, double time,
             const std::vector<std::array<double, 4>> &params);
    std::size_t work() const { return work_; } // nodes evaluated so far

  private:
    // How a number depends on the point. What does not is what evaluators make of it: the field is
    // proved for all such numbers. What does by decisions alone (a cell's hash) is the same for all
    // points of a cell, and its digits mean nothing once it is more than scaled and added up.
    enum class Varies : std::uint8_t { Never, Steps, Smoothly };
    struct Number {
        ir::Constant meant, computed;
        Varies varies = Varies::Never;
    };
    struct Plan { // what some nodes are made of, in order
        struct Step {
            NodeId id;
            std::vector<std::uint32_t> args; // places in the frame
            std::uint32_t out = 0;           // a loop's values lie side by side
        };
        std::vector<Step> steps;
        std::vector<Number> frame;
        std::vector<std::uint32_t> results;
    };
    Plan &plan_of(const std::vector<NodeId> &roots);
    void run(Plan &plan);
    void run_call(Plan &plan, const Plan::Step &step, ir::FunctionId function);
    void run_loop(Plan &plan, const Plan::Step &step);
    void run_step(Plan &plan, const Plan::Step &step);

    const ir::Scene &scene_;
    ir::FunctionId function_;
    std::map<std::vector<NodeId>, std::unique_ptr<Plan>> plans_;
    std::vector<Number> vars_; // by Var payload
    double time_ = 0;
    std::vector<std::array<double, 4>> params_;
    std::vector<ir::Constant> args_; // of the op in hand
    std::size_t work_ = 0, limit_ = 0;
};

} // namespace fathom::proof
