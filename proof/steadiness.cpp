// By instruction in their order, a loop's body until nothing changes. Proof: docs/lipschitz.md, 2.43.
#include "proof/steadiness.h"

#include <algorithm>

namespace fathom::proof {
namespace {

// Of these the values are few, and decided: equal ones are the same number.
constexpr ir::OpSet decided{Op::Floor, Op::Ceil,     Op::Round, Op::Trunc, Op::Sign,
                            Op::Step,  Op::ToInt,    Op::Less,  Op::Equal, Op::LessEqual,
                            Op::And,   Op::NotEqual, Op::Or,    Op::Not,   Op::Hash};

struct Marker {
    Tape &tape;
    std::vector<bool> wavers; // by slot

    void mark(std::vector<Instruction> &block) {
        for (Instruction &in : block) {
            if (in.form == Form::Loop) {
                mark(tape.loops[in.payload]);
                continue;
            }
            in.wavers = in.varies && (in.args.empty() || std::ranges::any_of(in.args, [&](Slot s) {
                                          return wavers[s];
                                      }));
            wavers[in.out] = in.wavers && !(in.form == Form::Plain && decided[in.op]);
        }
    }
    void mark(Loop &loop) {
        for (std::size_t k = 0; k < loop.vars.size(); ++k)
            wavers[loop.vars[k]] = wavers[loop.start[k]];
        for (bool changes = true; changes;) { // at most once a variable
            changes = false;
            mark(loop.body);
            for (std::size_t k = 0; k < loop.vars.size(); ++k)
                if (wavers[loop.next[k]] && !wavers[loop.vars[k]])
                    wavers[loop.vars[k]] = changes = true;
        }
        for (std::size_t k = 0; k < loop.vars.size(); ++k)
            wavers[loop.ends[k]] = wavers[loop.vars[k]];
    }
};

} // namespace

void mark_wavering(Tape &tape) {
    Marker{tape, std::vector<bool>(tape.first.size())}.mark(tape.each);
}

} // namespace fathom::proof
