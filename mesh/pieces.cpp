#include "mesh/pieces.h"

#include <numeric>

namespace fathom::mesh {

std::vector<std::uint32_t> pieces_of(const Mesh &mesh) {
    std::vector<std::uint32_t> parent(mesh.vertices.size());
    std::iota(parent.begin(), parent.end(), 0u);
    const auto root = [&](std::uint32_t v) {
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    };
    for (const auto &t : mesh.triangles) {
        parent[root(t[0])] = root(t[1]);
        parent[root(t[1])] = root(t[2]);
    }
    for (std::uint32_t v = 0; v < parent.size(); ++v) parent[v] = root(v);
    return parent;
}

} // namespace fathom::mesh
