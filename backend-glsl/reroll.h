// Long lists of like operands as loops over tables. What a combination of hundreds of shapes says
// one by one, a driver compiles in minutes: its time grows faster than the text. The checker makes
// tables of unions (typecheck/instances.cpp); here is what it must leave: operands in an order that
// counts. Knows operations, not shapes.
#pragma once

#include "ir/scene.h"

#include <map>
#include <optional>

namespace fathom::glsl {

struct Rerolled {
    ir::Scene scene;                             // a copy with the loops and tables added
    std::map<std::uint32_t, ir::NodeId> results; // by FunctionId: what it is to hand back instead
};

// Such lists as Folds whose turn i computes, to the bit, what operand i did. Nothing where there is
// no such list.
std::optional<Rerolled> rerolled(const ir::Scene &scene);

} // namespace fathom::glsl
