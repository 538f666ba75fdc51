// Scalars as sums of products: what continuity.h compares. Decided on the expressions, never by
// sampling.
#pragma once

#include "ir/graph.h"
#include "proof/work.h"

#include <map>
#include <optional>
#include <unordered_map>
#include <vector>

namespace fathom::proof {

using ir::Graph;
using ir::NodeId;
using ir::Op;

// Sum of coefficient * product of atoms; an atom is a node that is not itself a sum or product of
// numbers.
using Monomial = std::vector<NodeId>; // sorted, repeats allowed
using Polynomial = std::map<Monomial, double>;

// The sum as nodes.
NodeId rebuilt(Graph &graph, const Polynomial &polynomial);

// Writes nodes as polynomials, each node once. Sums and products beyond these numbers are nothing that
// is worth comparing, nor is what takes longer.
class Expansion {
  public:
    explicit Expansion(Graph &graph, Work *work = nullptr) : graph_(graph), work_(work) {}
    std::optional<Polynomial> of(NodeId id);
    std::optional<Polynomial> multiply(const Polynomial &a, const Polynomial &b);

  private:
    std::optional<Polynomial> written(NodeId id);
    std::optional<Polynomial> squared(NodeId factor);
    std::optional<Polynomial> sum_of(NodeId a, double by, NodeId b);
    bool take(std::size_t steps);

    Graph &graph_;
    Work *work_;
    std::unordered_map<NodeId, std::optional<Polynomial>> known_;
    std::size_t left_ = 50'000; // nodes and products of terms
    int depth_ = 0;
};

// One scalar's.
std::optional<Polynomial> polynomial(Graph &graph, NodeId id, Work *work = nullptr);

} // namespace fathom::proof
