// A lowered function as a tape: straight runs of kernels over batches of points in
// structure-of-arrays registers, with real calls and real loops, so that its length is linear in
// the scene. Programs are values: compile once, share between threads, give each thread a Scratch
// of its own. Knows nothing of rays and pictures.
#pragma once

#include "backend-cpu/kernels/cells.h"
#include "ir/scene.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace fathom::cpu {

// The numbers that are the same for every point of a picture.
struct Inputs {
    std::vector<std::array<double, 4>> params; // as Scene::params
    double time = 0;
};
Inputs inputs_of(const ir::Scene &scene, double time); // with the params' present values

// What one step of a tape does.
enum class StepKind : std::uint8_t {
    Run,        // target: a kernel's variant; operands: outputs, then inputs
    TableRead,  // target: index into Program::reads; operands: outputs, then the row
    Image,      // target: Program::images; operands: outputs, then u, v
    Grid,       // target: Program::grids; operands: the output, then x, y, z
    Call,       // target: Program::blocks; arguments and results are copied by Runs around it
    Loop,       // target: Program::loops
    BreakUnless // operands: a bool; leaves the loop when no point wants another iteration
};

// One step of a tape: what it does, to what, and where its operands stand.
struct Step {
    StepKind kind = StepKind::Run;
    bool once = false; // the operands are the same for every point: run for one
    std::uint32_t target = 0;
    std::uint32_t operands = 0; // where its operands begin in Program::operands
};

// Addresses count cells of the scratch: a register is batch_size cells, a number that all points
// share is one.
struct Loop {
    std::uint32_t block = 0;
    std::uint32_t count = 0; // address
    bool once = false;       // the count is the same for every point
    std::uint32_t index = 0; // address of one cell
    int max_count = 0;
    bool breaks = false; // it may end before its count
    struct Carried {
        std::uint32_t var = 0, next = 0; // addresses; may be the same
    };
    std::vector<Carried> carried;
    std::int32_t balls = -1; // into Program::ball_loops
};

// A loop whose iterations each join a ball to what it carries (ball_rows.h).
struct BallRows {
    bool smooth = false;                             // blended with radius k, or the lesser
    std::uint32_t carried = 0, place[3] = {}, k = 0; // addresses
    std::vector<float> numbers;                      // four a row: the centre, the radius
};

// A read of one row of a table; the row number is clamped.
struct Read {
    std::uint32_t first = 0; // into Program::table_data
    int rows = 0, stride = 0, columns = 0;
};

// A compiled function: blocks of steps, and the data that they read. Immutable.
struct Program {
    struct Block {
        std::uint32_t first = 0, last = 0; // steps
    };
    struct Slot {
        std::uint32_t address = 0;
        ir::Type type = ir::Type::Float; // Float, Int or Bool
        bool shared = false;             // one cell for all points
    };
    struct Shared { // cells filled once per Scratch
        enum class Kind : std::uint8_t { Float, Int, Time, Param } kind = Kind::Float;
        std::uint32_t address = 0;
        Word bits = 0;                          // Float, Int
        std::uint32_t param = 0, component = 0; // Param
        ir::Type type = ir::Type::Float;        // Param: Float, Int or Bool
    };

    std::vector<Step> steps;
    std::vector<std::uint32_t> operands;
    std::vector<Block> blocks; // the last is the compiled function itself
    std::vector<Loop> loops;
    std::vector<BallRows> ball_loops;
    std::vector<Read> reads;
    std::vector<float> table_data;
    std::vector<ir::ImageData> images;
    std::vector<ir::GridData> grids;
    std::vector<Shared> shared;
    std::vector<Slot> params, results; // one a component
    std::size_t first_register = 0;    // addresses below are of numbers that all points share
    std::size_t registers = 0;         // of batch_size cells
    std::size_t cells = 0;             // of a scratch, all told
};

// Minima and maxima that stand next to each other run as one kernel, which is the faster; or apart,
// so that pruning.h can leave operands of each out. Values are the same.
enum class Choices : std::uint8_t { Joined, Apart };

Program compile(const ir::Scene &scene, ir::FunctionId function, Choices choices = Choices::Joined);
// Expressions in `params` (Vars), all their results one after the other.
Program compile(const ir::Scene &scene, std::span<const ir::NodeId> params,
                std::span<const ir::NodeId> results);

// The memory that one thread evaluates a program in: made once, used for any number of batches.
struct Scratch {
    Scratch() = default;
    Scratch(Scratch &&) = default; // never copied: `cells` points into `memory`
    Scratch &operator=(Scratch &&) = default;
    std::vector<Word> memory;
    Word *cells = nullptr; // aligned to a cache line
};
Scratch make_scratch(const Program &program, const Inputs &inputs);

// n points: in[c] and out[c] are the c-th component of the parameters and of the result, one number
// a point; of an Int or Bool component the number's value as a float's bits
// (std::bit_cast<std::int32_t>). Allocates nothing.
void evaluate(const Program &program, Scratch &scratch, const float *const *in, float *const *out,
              std::size_t n);

// A chain of blends, its rows in their order, of which those are left out that are at least T
// wherever it is run. While the rows before a point's nearest ones are unknown, so is the number
// that they leave, but for a lower bound: blends rise with what they blend, and T with anything
// up to T - k is that thing. So the chain is begun with no more than `start` <= T - k, and where a
// row then comes that is less than what is carried by `drop` >= k, what was before is forgotten
// there, bound or not: from that row on all is exact. Where none comes it is not known.
struct Cut {
    float start = std::numeric_limits<float>::infinity(); // none: nothing is left out so
    float drop = 0;
    bool any() const { return start < std::numeric_limits<float>::infinity(); }
};

// Some steps of a program's last block, in an order of their own, calls spliced in: what is left of
// it where parts are known not to matter (shorten.h). Of each loop among them the iterations that
// matter.
struct Selection {
    struct Rows {
        std::uint32_t first = 0, count = 0;
        bool all = false;
        Cut cut;
    };
    const Step *table = nullptr;             // what `steps` counts
    const std::uint32_t *operands = nullptr; // of the table
    std::span<const std::uint32_t> steps;
    std::span<const Rows> loops; // of the Loop steps among them, in order
    const std::uint32_t *rows = nullptr;
    // The same steps once more, one after the other with their operands, where they are run often.
    std::span<const Step> packed{};
    const std::uint32_t *packed_operands = nullptr;
};
// Gives how many points there are whose value is not known for a Cut, and which, in `unknown`.
std::size_t evaluate(const Program &program, Scratch &scratch, const float *const *in,
                     float *const *out, std::size_t n, const Selection &selection,
                     std::uint32_t *unknown);

// Value and gradient by the first three input components, from the same tape run over dual numbers.
// At a kink one of the sides', the same that decides the value. The result is a float: out is
// value, d/dx, d/dy, d/dz.
struct GradientScratch {
    GradientScratch() = default;
    GradientScratch(GradientScratch &&) = default; // never copied: `cells` points into `memory`
    GradientScratch &operator=(GradientScratch &&) = default;
    std::vector<DualCell> memory;
    DualCell *cells = nullptr;
};
GradientScratch make_gradient_scratch(const Program &program, const Inputs &inputs);
void evaluate_gradient(const Program &program, GradientScratch &scratch, const float *const *in,
                       float *const *out, std::size_t n);
// The same by some of the program's steps, none of whose loops has a Cut.
void evaluate_gradient(const Program &program, GradientScratch &scratch, const float *const *in,
                       float *const *out, std::size_t n, const Selection &selection);

std::string dump(const Program &program); // one line a step, for tests and for reading

} // namespace fathom::cpu
