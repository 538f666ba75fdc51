// Where each node of a function's body is computed: in the innermost block that holds all its uses,
// but outside every loop whose variables it does not read; and whether it gets a name of its own or
// is written where it is used. So a shared node is computed once, an arm of a choice only where it
// is chosen, and the text is linear in the graph. Knows nodes, not their spelling.
#pragma once

#include "ir/graph.h"

#include <span>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

namespace fathom::glsl {

using BlockId = int; // index into Schedule::blocks; 0 is the function's body

struct Block {
    BlockId parent = -1;
    int depth = 0;
    ir::NodeId owner; // the Select or Loop that opens it
    bool loop = false;
    std::vector<ir::NodeId> statements; // what gets a name, or is a loop, in order
};

struct Schedule {
    std::vector<Block> blocks;
    std::unordered_map<ir::NodeId, BlockId> home; // of every node that is needed
    std::unordered_map<ir::NodeId, BlockId> loop; // of a Loop
    std::unordered_map<ir::NodeId, std::pair<BlockId, BlockId>>
        arms;                                 // of a Select whose arms are blocks
    std::unordered_map<ir::NodeId, int> rows; // Vars that count loops: their largest value plus one
    std::unordered_set<ir::NodeId> named_;
    bool named(ir::NodeId id) const { return named_.contains(id); }
};

// Costs nothing to write twice: inputs, variables, constants, parts of such.
bool is_trivial(const ir::Graph &graph, ir::NodeId id);

Schedule schedule(const ir::Graph &graph, std::span<const ir::NodeId> roots);

} // namespace fathom::glsl
