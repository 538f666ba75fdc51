// Numbers that people write with few digits for a root or for a part of a turn, as `1.73` for sqrt(3):
// sides that meet by the exact number differ by it. Proves nothing.
#pragma once

#include "ir/graph.h"

#include <optional>
#include <string>
#include <vector>

namespace fathom::proof {

struct Inexact {
    std::string written, digits; // "1.73", and the number with as many as are enough: "1.7320508"
    const char *exact;           // "sqrt(3)"
};
// The number below these that is off by most of itself.
std::optional<Inexact> inexact_number(const ir::Graph &graph, const std::vector<ir::NodeId> &roots);

} // namespace fathom::proof
