// A cell's tape as it is run: its steps one after the other with their operands, without the copies
// that stand where one operand of a choice won. What reads a copy reads what was copied instead.
#pragma once

#include "backend-cpu/prune/shorten.h"

namespace fathom::cpu {

class Packer {
  public:
    explicit Packer(const PruneProgram &parts);
    // Appends the tape's steps to `steps`, with their operands in `operands`. They give the same
    // results to the bit, in the same places.
    void pack(const ShortTape &tape, std::vector<Step> &steps,
              std::vector<std::uint32_t> &operands);

  private:
    // What a register holds from one write of it to the next.
    struct Value {
        std::uint32_t last_use = 0; // position in the tape after which it is not needed
        std::uint32_t at = 0;       // register
        std::uint32_t result = 0;   // register of the result that it is; none: no result
    };

    bool is_register(std::uint32_t address) const;
    std::uint32_t register_of(std::uint32_t address) const;
    bool is_copy(std::uint32_t id) const;
    void pin(const ShortTape &tape);
    bool find_values(const ShortTape &tape);
    bool find_step(std::uint32_t id, std::uint32_t position);
    bool find_results();
    bool place(const ShortTape &tape, std::vector<Step> &steps,
               std::vector<std::uint32_t> &operands);
    void begin_places();
    void release(std::uint32_t value);
    bool take(std::uint32_t value);
    void copy_results(std::vector<Step> &steps, std::vector<std::uint32_t> &operands);
    void as_it_is(const ShortTape &tape, std::vector<Step> &steps,
                  std::vector<std::uint32_t> &operands) const;

    const PruneProgram &parts_;
    const Program &program_;
    std::vector<char> pinned_, result_; // by register: loops and calls count on it; holds a result
    std::vector<char> taken_;           // by register of a result
    std::vector<std::uint32_t> holds_;  // by register: the value
    std::vector<Value> values_;
    std::vector<std::uint32_t> operands_; // of each step that stays: values, none for other places
    std::vector<std::uint32_t> free_;     // registers
    std::uint32_t initial_ = 0;           // so many values are there before the first step
};

} // namespace fathom::cpu
