// The vectors that a field reads the point through: moved, turned and folded coordinates, and
// distances from points and axes. A field of such a vector is the same field of another point
// (docs/lipschitz.md, 2.28). Says nothing of slopes.
#pragma once

#include "proof/field.h"
#include "proof/read_through.h"

#include <array>
#include <functional>
#include <vector>

namespace fathom::proof {

constexpr std::size_t max_nodes_composed = 700; // of a field that is looked into

// A vector that an expression reads the point through alone: its components by axis, of which
// those that are none stand still.
struct Inner {
    std::vector<NodeId> replaced;         // expressions, in the order of `components`
    std::array<NodeId, 3> components{};   // by axis
    NodeId distance;                      // the component that is one, or none
    std::vector<NodeId> lengths, squares; // expressions that are it, and its square
};

// The vectors of at most three components that `root` reads the point through.
class Inners {
  public:
    Inners(ir::Graph &graph, ReadThrough &read, NodeId root);

    // Of moved and turned coordinates: many, what is made of others first.
    std::vector<Inner> affine();
    // Of what is made of folded ones, too: one whose last parts are sums, and the last of all.
    std::vector<Inner> folded();
    // Of vectors that something else is added to, as noise: the largest.
    std::vector<Inner> warped();
    // The distance of moved, turned and folded coordinates from 0, of two or all three of them, and
    // what is read beside it: fewer components than the expression reads coordinates.
    std::vector<Inner> radial();

  private:
    bool is_warped(NodeId id);
    bool collect();
    void choose(const std::function<bool(NodeId)> &is_such, std::size_t most,
                std::vector<Inner> &out);
    bool try_these(const std::vector<NodeId> &chosen, std::vector<Inner> &out);

    ir::Graph &graph_;
    ReadThrough &read_;
    NodeId root_;
    std::vector<NodeId> parts_, warped_, sums_; // sums_: what may be a distance or its square
};

// `root` with the point in the place of the vector.
NodeId seen_from(ir::Graph &graph, NodeId root, const Inner &inner);

// Where a vector of slope `slope` takes a region: a box, and a ball about what the middle becomes.
struct Image {
    Cell box;
    Zone ball;
    bool has_ball = false;
    Domain domain() const { return {box, has_ball ? &ball : nullptr}; }
};
Image image_of(Flattening &context, const Ranges &ranges, NodeId vector, double slope,
               const Domain &domain);

} // namespace fathom::proof
