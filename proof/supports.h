// Which coordinates each component of a value depends on: in the point's axes, or in those of a
// vector that is the point turned, moved and scaled. Parts that depend on different ones have
// gradients at right angles. Knows nothing of cells.
#pragma once

#include "proof/tape.h"

namespace fathom::proof {

class Supports {
  public:
    explicit Supports(const Tape &tape) : tape_(tape) {}

    // The point, and vectors whose Jacobian is a multiple of an orthogonal matrix everywhere.
    bool is_base(Slot s) const;
    void make_base(Slot s);
    // After an instruction's slot is made: from its arguments.
    void follow(const Instruction &instruction);
    // Do these components of a vector, a bit each, depend on other coordinates than a value does?
    bool apart(Slot value, Slot vector, unsigned components) const;
    // Two bits an argument: arguments of different numbers depend on different coordinates.
    std::uint32_t groups(const std::vector<Slot> &args) const;

  private:
    static constexpr Slot none = ~Slot(0);
    struct Support {
        Slot base = none; // none where mask is 0 (a constant) or where nothing is known
        std::uint8_t mask = 0;
    };
    static Support both(Support a, Support b);
    static bool apart(Support a, Support b);
    Support at(Slot s, int component) const;
    Support all(Slot s) const;
    void set(Slot s, int component, Support support);

    const Tape &tape_;
    std::vector<Support> known_; // by component of the tape
};

// Do two arguments of an instruction depend on different coordinates, by Supports::groups?
inline bool in_other_group(const Instruction &in, int a, int b) {
    return (in.groups >> (2 * a) & 3) != (in.groups >> (2 * b) & 3);
}

} // namespace fathom::proof
