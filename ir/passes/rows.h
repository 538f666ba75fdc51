// Expressions that are alike but for their constants, and the table of these. In come such
// expressions; out go a skeleton to compare them by, the constants of each as a row, the columns
// that differ, and one expression that reads them from a table. It never decides which expressions
// are worth a table: the checker (typecheck/instances.cpp) and the GLSL back end
// (backend-glsl/reroll.cpp) do.
#pragma once

#include "ir/graph.h"

#include <functional>
#include <vector>

namespace fathom::ir {

// The constants of a tree, each a Const node. A graph has a constant once: those that are equal to
// the bit are one node.
using Row = std::vector<NodeId>;

// A tree with its constants taken out, in the order of a walk; and these.
struct Skeleton {
    std::vector<std::uint64_t> words;
    Row row;
};
// Appends an expression; false, and not all of it, where `words` outgrows `most`. An invalid id is
// a word of its own.
bool take_apart(const Graph &graph, NodeId id, std::size_t maximum, Skeleton &out);

// The tree again, with what `other` gives for the number and the node of each constant in the order
// of the same walk. `next`, the number of the first, moves on.
using OtherConstant = std::function<NodeId(std::size_t, NodeId)>;
NodeId put_together(Graph &graph, NodeId id, const OtherConstant &other, std::size_t &next);

// Where each constant of some rows of equal length stands in a table: its first column, or -1 where
// it is the same in all of them, or `wanted` is false of it. Equal ones stand once. Columns are
// numbered from `first` on; the number of all.
int lay_out(const Graph &graph, const std::vector<Row> &rows, const std::vector<bool> &wanted,
            int first, std::vector<int> &column);
// A row's constants at their columns. Tables hold ints and bools as floats.
void fill_row(const Graph &graph, const Row &row, const std::vector<int> &column, float *out);
NodeId read_table(Graph &graph, Type type, NodeId row, std::uint32_t slot);

constexpr int max_columns = 4000; // of a table (Graph: table_slot)

} // namespace fathom::ir
