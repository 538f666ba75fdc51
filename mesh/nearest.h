// The nearest point of a mesh: a tree of boxes over its triangles.
#pragma once

#include "mesh/polygons.h"

#include <optional>

namespace fathom::mesh {

struct Nearest {
    double distance = 0; // no less than the true one, by rounding alone
    std::uint32_t triangle = 0;
    std::array<double, 3> shares{}; // of its corners: their weights at the nearest point
};

class TriangleTree {
  public:
    explicit TriangleTree(const Mesh &mesh);                              // which outlives it
    TriangleTree(const Mesh &mesh, std::vector<std::uint32_t> triangles); // of these alone
    // Of triangles that are nearer than `within`; none where there are none. One as near as `enough`
    // will do.
    std::optional<Nearest> nearest(const std::array<double, 3> &to, double within,
                                   double enough = 0) const;
    std::optional<Nearest> nearest(const Point &to, double within) const {
        return nearest(std::array<double, 3>{to[0], to[1], to[2]}, within);
    }

  private:
    struct Branch {
        Point lo{}, hi{};
        std::uint32_t first = 0,
                      count = 0;    // of the triangles, in `order_`; count 0: of two branches
        std::uint32_t children = 0; // the first
    };
    void divide(std::uint32_t branch);
    void enclose(Branch &branch) const;
    const Mesh &mesh_;
    std::vector<Branch> branches_;
    std::vector<std::uint32_t> order_;
};

} // namespace fathom::mesh
