// What of the point an expression reads, and what it reads of it beside some of its parts: so that a
// field of what is moved, turned or folded is seen as one of any point. Knows nothing of cells or
// slopes.
#pragma once

#include "ir/graph.h"

#include <map>
#include <unordered_set>
#include <vector>

namespace fathom::proof {

struct Below {
    unsigned coordinates = 0; // of the point that are read, a bit each
    bool is_affine = true;    // in the point: sums, multiples, vectors and matrices of these
    bool is_fold = true;      // … of sizes, remainders, rounded numbers and limits, too
};

bool is_affine_op(ir::Op op); // of what is affine, and of numbers
// Remembers what it has found: for one graph, whose nodes may become more.
class ReadThrough {
  public:
    explicit ReadThrough(const ir::Graph &graph) : graph_(graph) {}

    const Below &below(ir::NodeId id);
    // The point itself or some of its coordinates.
    bool is_coordinates(ir::NodeId id) const;
    // The coordinates that these read but through one of `parts`.
    unsigned beside(std::vector<ir::NodeId> roots, const std::unordered_set<ir::NodeId> &parts);

  private:
    const ir::Graph &graph_;
    std::map<ir::NodeId, Below> known_;
};

} // namespace fathom::proof
