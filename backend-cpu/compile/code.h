// A function between graph and tape: one value a number, in static single assignment and without an
// order. Values know how deep in loops they stand, so that what does not change in a loop is
// computed before it. build.cpp makes it from the graph, fuse.cpp joins kernels while it grows,
// layout.cpp orders it and gives it registers.
#pragma once

#include "backend-cpu/kernels/kernels.h"
#include "backend-cpu/tape.h"

#include <unordered_map>

namespace fathom::cpu {

struct ValueInfo;
using Value = Id<ValueInfo>;
struct Instruction;
using InstructionId = Id<Instruction>;

// What is known of one value: one number for each point, or one for all.
struct ValueInfo {
    ir::Type type = ir::Type::Float;  // Float, Int or Bool
    bool shared = false;              // the same for every point
    bool used = false;                // by an instruction that stands: fused into none
    std::uint16_t level = 0;          // how many loops it stands in
    InstructionId made_by;            // none: a parameter, a loop's variable, or a source
    std::uint32_t source = no_source; // index into Code::sources
    static constexpr std::uint32_t no_source = std::numeric_limits<std::uint32_t>::max();
};

// What an instruction does: runs a kernel, reads data, calls a function or loops.
enum class InstructionKind : std::uint8_t { Kernel, TableRead, Image, Grid, Call, Loop };

// One step of a function before it has an order and registers.
struct Instruction {
    InstructionKind kind = InstructionKind::Kernel;
    Kernel kernel{};   // Kernel
    Mask mask = 0;     // Kernel: the variant's
    bool once = false; // Kernel, TableRead: everything is shared
    std::uint16_t level = 0;
    std::uint32_t payload = 0; // the table slot, image, grid, function or loop
    std::vector<Value> in;     // Loop: what its body reads from outside, filled by layout.cpp
    Value out;                 // the first of `outs` in a row
    std::uint32_t outs = 0;
};

// A number that is the same for every point and known before the first.
struct SourceValue {
    Program::Shared what;
    Value value;
};

// A loop of a function before layout: its block, what it carries, and when it ends.
struct LoopCode {
    Value count, index, condition; // condition: none when there is none
    Value active;                  // where iteration counts differ by point: which points go on
    std::vector<Value> vars, init, next; // one a component
    int max_count = 0;
    std::uint16_t level = 0; // of its body
};

// One Function of the graph.
struct Code {
    std::vector<Value> params, results;
    Arena<ValueInfo> values;
    Arena<Instruction> instructions;
    std::vector<LoopCode> loops;
    std::vector<SourceValue> sources;
    Choices choices = Choices::Joined;
};

// Grows a Code, one kernel at a time: equal ones once, neighbours fused, operands brought to a
// variant that exists.
class Builder {
  public:
    explicit Builder(Code &code) : code_(code) {}

    Value number(float value);
    Value integer(std::int32_t value);
    Value time();
    Value param(std::uint32_t param, std::uint32_t component, ir::Type type);
    Value variable(ir::Type type, bool shared, std::uint16_t level);
    Value make(Kernel kernel, std::initializer_list<Value> in) { return outputs(kernel, in)[0]; }
    // Outputs stand in a row: the first's successors are the others.
    std::vector<Value> outputs(Kernel kernel, std::span<const Value> in);
    // Any other instruction; never merged with an equal one.
    std::vector<Value> instruction(InstructionKind kind, std::uint32_t payload,
                                   std::span<const Value> in, std::span<const ir::Type> types);
    Value spread(Value shared); // as a register

    const Code &code() const { return code_; }
    std::optional<float> number_of(Value value) const; // a constant float's

  private:
    Value source(Program::Shared what, ir::Type type);
    std::vector<Value> emit(Kernel kernel, std::span<const Value> in, bool to_register);
    Code &code_;
    std::unordered_multimap<std::uint64_t, InstructionId> known_;
    std::unordered_multimap<std::uint64_t, Value> known_sources_;
};

// A shorter way to the same value: `kernel` of `in`, or what it becomes together with what made its
// inputs.
struct Fused {
    Kernel kernel;
    std::vector<Value> in;
};
std::optional<Value> simplify(const Builder &builder, Kernel kernel, std::span<const Value> in);
std::optional<Fused> fuse(Builder &builder, Kernel kernel, std::span<const Value> in);

// What is computed from what: a function, or several results at once.
struct Body {
    std::vector<ir::NodeId> params, results;
};
Body body_of(const ir::Graph &graph, ir::FunctionId function);

// What of a graph's functions becomes what: reached from one body, callers before callees.
struct Calls {
    std::vector<Body> bodies; // those that stay functions, callers first; the first is the root
    std::vector<std::vector<bool>>
        shared;                // by body: per parameter: the same for every point at every call
    std::vector<bool> inlined; // by FunctionId
    std::vector<std::uint32_t> body; // by FunctionId: index into `bodies`
};
Calls plan_calls(const ir::Scene &scene, const Body &root);

// Marks in `calls.shared` what the calls that it makes hand over.
Code build(const ir::Scene &scene, Calls &calls, std::size_t body, Choices choices);

// Orders the instructions of all functions, gives values registers, and writes the tape.
Program lay_out(const ir::Scene &scene, const Calls &calls, std::vector<Code> codes);

} // namespace fathom::cpu
