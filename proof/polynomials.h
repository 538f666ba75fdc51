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
    enum class Counts { Steps, Nothing }; // as work; in both cases it ends where that is spent
    explicit Expansion(Graph &graph, Work *work = nullptr, Counts counts = Counts::Steps)
        : graph_(graph), work_(work), counts_(counts) {}
    // It stays where it is until of_next is asked.
    const std::optional<Polynomial> &of(NodeId id);
    // Of one of many, each of which may take as long as if it were alone, or longer: what is known
    // of its parts is not asked again. What gave up, and what was written beside it, is forgotten.
    const std::optional<Polynomial> &of_next(NodeId id);
    std::optional<Polynomial> multiply(const Polynomial &a, const Polynomial &b);

  private:
    std::optional<Polynomial> written(NodeId id);
    std::optional<Polynomial> squared(NodeId factor);
    std::optional<Polynomial> sum_of(NodeId a, double by, NodeId b);
    bool take(std::size_t steps);

    static constexpr std::size_t most_steps = 50'000; // nodes and products of terms
    static constexpr std::size_t most_known = 4'000;  // before they are forgotten
    Graph &graph_;
    Work *work_;
    Counts counts_;
    std::unordered_map<NodeId, std::optional<Polynomial>> known_;
    std::size_t left_ = most_steps;
    bool gave_up_ = false; // some node took too long, or is too deep: others are written less far
    int depth_ = 0;
};

// One scalar's.
std::optional<Polynomial> polynomial(Graph &graph, NodeId id, Work *work = nullptr);

} // namespace fathom::proof
