#include "typecheck/told_apart.h"

#include "ir/passes/without_waves.h"

namespace fathom::typecheck {

ir::NodeId told_apart(Interpreter &ev, ir::NodeId number, Span place) {
    if (const auto known = ev.told_apart.find(number); known != ev.told_apart.end())
        return known->second;
    constexpr std::size_t of_a_step = 2; // in time
    std::size_t visits = 0;
    const ir::NodeId written = ir::without_waves(ev.scene.graph, number, visits);
    spend(ev, place, visits / of_a_step); // where no work is left that is an error already
    return ev.told_apart[number] = written;
}

} // namespace fathom::typecheck
