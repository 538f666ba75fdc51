#include "mesh/nearest.h"

#include "mesh/curve.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace fathom::mesh {
namespace {

using Real3 = std::array<double, 3>;

constexpr std::uint32_t few_triangles = 4;

double squared_way(const Real3 &p, const Point &lo, const Point &hi) {
    double squares = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const double way = std::max({0.0, lo[i] - p[i], p[i] - hi[i]});
        squares += way * way;
    }
    return squares;
}

double scalar(const Real3 &a, const Real3 &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// The nearest point of a triangle, as weights of its corners: by the region of the plane in which
// the foot lies (Ericson 2005, 5.1.5).
Real3 nearest_shares(const Real3 &p, const Real3 &a, const Real3 &b, const Real3 &c) {
    const auto minus = [](const Real3 &x, const Real3 &y) {
        return Real3{x[0] - y[0], x[1] - y[1], x[2] - y[2]};
    };
    const Real3 ab = minus(b, a), ac = minus(c, a), ap = minus(p, a), bp = minus(p, b),
                cp = minus(p, c);
    const double d1 = scalar(ab, ap), d2 = scalar(ac, ap), d3 = scalar(ab, bp), d4 = scalar(ac, bp),
                 d5 = scalar(ab, cp), d6 = scalar(ac, cp);
    if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
    if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
    if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
    const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        const double t = (d4 - d3) / (d4 - d3 + d5 - d6);
        return {0, 1 - t, t};
    }
    const double sum = va + vb + vc;
    return sum > 0 ? Real3{va / sum, vb / sum, vc / sum} : Real3{1, 0, 0};
}

// Triangles by their middles along a curve.
void sort_along_curve(const Mesh &mesh, std::vector<std::uint32_t> &triangles) {
    std::vector<Real3> middles;
    middles.reserve(triangles.size());
    for (const std::uint32_t t : triangles) {
        Real3 &m = middles.emplace_back();
        for (const std::uint32_t v : mesh.triangles[t])
            for (std::size_t i = 0; i < 3; ++i) m[i] += mesh.vertices[v][i] / 3.0;
    }
    const std::vector<std::uint32_t> before = triangles;
    const std::vector<std::uint32_t> order = order_along_curve(middles);
    for (std::size_t k = 0; k < order.size(); ++k) triangles[k] = before[order[k]];
}

std::vector<std::uint32_t> all_of(const Mesh &mesh) {
    std::vector<std::uint32_t> numbers(mesh.triangles.size());
    std::iota(numbers.begin(), numbers.end(), 0u);
    return numbers;
}

} // namespace

TriangleTree::TriangleTree(const Mesh &mesh) : TriangleTree(mesh, all_of(mesh)) {}

TriangleTree::TriangleTree(const Mesh &mesh, std::vector<std::uint32_t> triangles)
    : mesh_(mesh), order_(std::move(triangles)) {
    if (order_.empty()) return;
    sort_along_curve(mesh_, order_);
    branches_.push_back({{}, {}, 0, static_cast<std::uint32_t>(order_.size()), 0});
    for (std::uint32_t k = 0; k < branches_.size(); ++k) divide(k);
    for (std::size_t k = branches_.size(); k-- > 0;)
        enclose(branches_[k]); // the parts of one come after it
}

void TriangleTree::divide(std::uint32_t number) {
    Branch &branch = branches_[number];
    if (branch.count <= few_triangles) return;
    const std::uint32_t first = branch.first, count = branch.count, half = count / 2;
    branch.children = static_cast<std::uint32_t>(branches_.size());
    branch.count = 0;
    branches_.push_back({{}, {}, first, half, 0});
    branches_.push_back({{}, {}, first + half, count - half, 0});
}

void TriangleTree::enclose(Branch &branch) const {
    if (branch.count == 0) {
        const Branch &a = branches_[branch.children], &b = branches_[branch.children + 1];
        for (std::size_t i = 0; i < 3; ++i) {
            branch.lo[i] = std::min(a.lo[i], b.lo[i]);
            branch.hi[i] = std::max(a.hi[i], b.hi[i]);
        }
        return;
    }
    branch.lo = branch.hi = mesh_.vertices[mesh_.triangles[order_[branch.first]][0]];
    for (std::uint32_t k = branch.first; k < branch.first + branch.count; ++k)
        for (const std::uint32_t v : mesh_.triangles[order_[k]])
            for (std::size_t i = 0; i < 3; ++i) {
                branch.lo[i] = std::min(branch.lo[i], mesh_.vertices[v][i]);
                branch.hi[i] = std::max(branch.hi[i], mesh_.vertices[v][i]);
            }
}

std::optional<Nearest> TriangleTree::nearest(const Real3 &p, double within, double enough) const {
    std::optional<Nearest> found;
    if (branches_.empty()) return found;
    double best = within * within;
    std::array<std::uint32_t, 128> stack; // the tree is no deeper: each half has half of them
    std::size_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const Branch &branch = branches_[stack[--depth]];
        if (!(squared_way(p, branch.lo, branch.hi) < best)) continue;
        if (branch.count == 0) {
            const std::uint32_t a = branch.children, b = a + 1;
            const bool first = squared_way(p, branches_[a].lo, branches_[a].hi) <
                               squared_way(p, branches_[b].lo, branches_[b].hi);
            stack[depth++] = first ? b : a;
            stack[depth++] = first ? a : b;
            continue;
        }
        for (std::uint32_t k = branch.first; k < branch.first + branch.count; ++k) {
            const auto &t = mesh_.triangles[order_[k]];
            std::array<Real3, 3> corner;
            for (std::size_t c = 0; c < 3; ++c)
                for (std::size_t i = 0; i < 3; ++i) corner[c][i] = mesh_.vertices[t[c]][i];
            const Real3 shares = nearest_shares(p, corner[0], corner[1], corner[2]);
            double squares = 0;
            for (std::size_t i = 0; i < 3; ++i) {
                const double x =
                    shares[0] * corner[0][i] + shares[1] * corner[1][i] + shares[2] * corner[2][i];
                squares += (x - p[i]) * (x - p[i]);
            }
            if (!(squares < best)) continue;
            best = squares;
            found = Nearest{std::sqrt(squares), order_[k], shares};
            if (found->distance <= enough) return found;
        }
    }
    return found;
}

} // namespace fathom::mesh
