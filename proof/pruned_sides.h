// What a side of a border is in one case (agreement.h): with what is decided by ranges written as what
// it is.
#pragma once

#include "proof/border_ranges.h"
#include "proof/polynomials.h"

namespace fathom::proof {

// What is so in a case.
struct Assumed {
    std::map<NodeId, NodeId> is;       // comparisons, signs and whole numbers: a constant
    std::map<NodeId, Interval> within; // unknown numbers
};

class PrunedSides {
  public:
    PrunedSides(Graph &graph, const Notes &notes, Work &work)
        : graph_(graph), notes_(notes), work_(work) {}

    void enter(const Assumed &given); // a case
    NodeId of(NodeId id);
    SideRanges &ranges() { return ranges_; }
    Expansion &forms() { return forms_; }

    NodeId formed(NodeId made); // in one form
    // Does it change between steps? Then what a comparison of it chooses has a border of its own.
    bool moves(NodeId id) const;
    std::optional<Interval> halved(NodeId id) const; // of an unknown number: its range
    // What single precision may lose of the difference of two numbers, as they are computed.
    double lost_of_single(NodeId a, NodeId b);

  private:
    NodeId pruned(NodeId id);
    NodeId loop_of_others(NodeId loop);
    std::optional<NodeId> decided(const ir::Node &node, const std::vector<NodeId> &args);
    std::optional<NodeId> compared(const ir::Node &node, const std::vector<NodeId> &args);
    std::optional<NodeId> by_range(const ir::Node &node, const std::vector<NodeId> &args);
    std::optional<double> sign_of(NodeId x, double below, bool at_0);
    std::optional<NodeId> size(NodeId of);
    std::optional<NodeId> root(NodeId of);
    double rounding_of(NodeId id) const;

    Graph &graph_;
    Notes notes_;
    Work &work_;
    Assumed given_;
    Expansion forms_{graph_, &work_, Expansion::Counts::Nothing};
    SideRanges ranges_{graph_, notes_, work_, forms_};
    std::unordered_map<NodeId, NodeId> known_;
};

} // namespace fathom::proof
