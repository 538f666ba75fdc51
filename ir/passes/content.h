// What an expression is made of, apart from the graph that it stands in: its words. Equal words are
// the same function of the same inputs. In come a graph and a node; out go words, or of words the
// same nodes in a new graph. Names and places are no part of it.
#pragma once

#include "ir/graph.h"

namespace fathom::ir {

// Nodes count from 0, arguments before users, in the order in which the root comes to them; so do
// the inputs of each kind. A table's formula is left out, as its data say the same.
struct Content {
    std::vector<std::uint32_t> words;
    // By their numbers in the words, what the inputs are in the graph: the payloads of Param, Var
    // (free or bound), Image, Grid and Cached.
    std::vector<std::uint32_t> params, vars, images, grids, caches;
};
Content content_of(const Graph &graph, NodeId root);

// The root of these words in `graph`, which is empty. Inputs have their numbers for payloads.
NodeId rebuilt(Graph &graph, std::span<const std::uint32_t> words);

} // namespace fathom::ir
