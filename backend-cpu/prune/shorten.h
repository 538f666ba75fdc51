// Shorter tapes for parts of space. A tape's steps are run over ranges (ranges.h) for up to 64
// boxes at once; where an operand of a minimum, a maximum, a blend or a choice wins all over a box,
// the other is not computed there, nor what only it needs; and of a loop that carries a least value
// through the rows of a table only the rows are kept that can change it. What is left computes the
// same floats to the bit at every point of the box.
//
// Knows no space but boxes; cells.cpp makes a hierarchy of them.
#pragma once

#include "backend-cpu/kernels/kernels.h"
#include "backend-cpu/tape.h"

#include <array>
#include <span>

namespace fathom::cpu {

inline constexpr std::size_t max_boxes = 64;
inline constexpr std::uint32_t no_part = 0xffffffffu;

// How a step's value can be one of its operands'.
enum class Choice : std::uint8_t { None, Least, Greatest, Blend, Select };

// What shortening knows of a step.
struct Part {
    std::uint32_t first_slot = 0; // in PruneProgram::slots: those written, then those read
    std::uint32_t writes = 0, reads = 0;
    std::uint32_t operands = 0; // how many stand in the table's
    std::uint32_t surely = 0;   // the first of those written: whatever happens
    float cost = 1;             // kernels
    std::int32_t decision = -1; // of a RowLoop's: which
    Choice choice = Choice::None;
    std::uint32_t chosen[2] = {no_part, no_part}; // what it becomes when one wins; none: nothing
    std::uint32_t operand[2] = {0, 0};            // their addresses
    std::uint32_t margin = no_part;               // address of a Blend's r, a Select's condition
    // What is run over ranges in its place, if anything. A ball joined to another field: the ball
    // alone, into memory of its own; then the joining. less(x, y) ? x : y: min(x, y).
    std::uint32_t ball = no_part, ball_operands = 0, join = no_part, join_operands = 0;
};

// A loop whose iterations may be left out: all that it carries is chosen between what it was and
// what the iteration adds.
struct RowLoop {
    bool droppable = false;
    bool renewable =
        false; // what an iteration adds does not depend on what was before, and where it
               // wins over that, it wins over what the loop began with
    std::int32_t minimum = -1; // renewable, and the rest goes with the minimum that this decision
                               // keeps: then order is nothing; -1: not so
    bool chain = false;        // of blended balls, which a Cut may shorten
    std::int32_t iterations = 0;
    struct Decision {
        std::uint32_t part = 0;
        int kept = 0; // which operand is what it was
    };
    std::vector<Decision> decisions;
};

// The steps of a program with what may be left out of each.
struct PruneProgram {
    const Program *program = nullptr;
    Inputs inputs;
    std::vector<Step> table; // the program's steps, then what they may become
    std::vector<Part> parts; // of each
    std::vector<std::uint32_t> operands, slots;
    std::size_t slot_count = 0;
    std::vector<RowLoop> loops;                    // by Program::loops
    std::vector<std::array<float, 2>> read_ranges; // by Program::reads and column
    std::vector<std::uint32_t> first_read_range;
    std::vector<std::array<float, 2>> image_ranges; // by Program::images and channel
};
// Analyses a program for given inputs.
PruneProgram prune_program_of(const Program &program, const Inputs &inputs);

// A Selection with its memory.
struct ShortTape {
    std::vector<std::uint32_t> steps, rows;
    std::vector<Selection::Rows> loops;
    float cost = 0;   // kernels a point
    float shapes = 1; // operands of choices, and rows: what a cell may leave out
    bool cut = false; // has a Cut that the tape it was made from does not have
    void clear();
    Selection selection(const PruneProgram &parts) const;
};
ShortTape whole_tape(const PruneProgram &parts);

// Up to `max_boxes` axis-parallel boxes, one bit each in the results.
struct Boxes {
    std::size_t count = 0; // a multiple of 16, at most max_boxes
    std::array<std::array<float, max_boxes>, 3> lo{}, hi{};
};

// One thread's memory for it.
struct Shortener {
    explicit Shortener(const PruneProgram &parts);
    static constexpr std::size_t no_ends = std::size_t(-1);
    std::vector<float> lo, hi; // by address
    struct Chosen {
        std::uint64_t wins[2] = {0, 0}; // bit k: in box k
        std::size_t ends = no_ends;     // of a minimum: where they begin in `ends`
    };
    struct Iteration {
        std::uint64_t neutral = 0, renewed = 0; // nothing changes; nothing of before is left
        std::uint64_t beyond = 0;               // of a chain: may be cut off
    };
    struct LoopRun {
        std::uint32_t first_iteration = 0, first_low = 0, cuts = no_part;
        std::size_t ends = no_ends;                        // of what it carries: its upper end
        std::array<std::uint32_t, max_boxes + 1> listed{}; // where each box's begin
    };
    std::vector<Chosen> chosen; // by step of the tape at hand
    // By box: of a minimum its own upper end, then its operands' lower ones; of a loop that carries
    // one the upper end alone.
    std::vector<float> ends;
    std::vector<Iteration> iterations;
    std::vector<std::array<Cut, max_boxes>> cuts; // of chains
    std::vector<float> lows;                      // least loops and chains: by iteration and box
    std::vector<LoopRun> loop_runs;
    std::vector<std::uint32_t> listed; // by box of a loop: iterations that may change something
    std::vector<std::uint32_t> kept;   // iterations of the loop at hand, from the last
    struct Live {
        std::uint64_t boxes = 0;   // in which the value matters
        std::uint64_t bounded = 0; // of these: as far as it is not above its cutoff
        std::uint32_t epoch = 0;   // for which this is
    };
    std::vector<Live> live;    // by slot
    std::vector<float> cutoff; // by register and box
    std::uint32_t epoch = 0;
    std::size_t boxes = 0;
    std::array<float, max_boxes> result_lo{}, result_hi{}; // of the first result, by box
};

// What `run_over` does, in parts: between them the ranges of what was computed so far may be read, and
// narrowed. `steps`: some of a tape's, those before them run.
void enter_boxes(const PruneProgram &parts, Shortener &shortener, const Boxes &boxes);
void run_steps(const PruneProgram &parts, Shortener &shortener, const Selection &steps);
void take_results(const PruneProgram &parts, Shortener &shortener);
// First what a tape that holds in all boxes comes to in each, then what of it is left in some.
void run_over(const PruneProgram &parts, Shortener &shortener, const Selection &from,
              const Boxes &boxes);
// What the tape comes to alone: no tape is shortened by it.
void run_values(const PruneProgram &parts, Shortener &shortener, const Selection &from,
                const Boxes &boxes);
// Into tapes[box] for each of `boxes`, a bit each. Not in `cuts`: no Cut but those that the tape had.
void shorten(const PruneProgram &parts, Shortener &shortener, const Selection &from,
             std::uint64_t boxes, std::uint64_t cuts, std::span<ShortTape> tapes);

} // namespace fathom::cpu
