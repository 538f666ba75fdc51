#include "mesh/collapse.h"

#include "mesh/exact.h"
#include "mesh/grid.h"

#include <algorithm>
#include <cmath>
#include <queue>

namespace fathom::mesh {
namespace {

constexpr double turning = 0.5;     // the cosine of how far a triangle may turn
constexpr double sliver = 1e-3;     // twice the area by the square of the longest side
constexpr double by_length = 1e-12; // of the square of an edge's length: short ones go first

// The mean of the squares of the distances from planes, by their weights.
struct Quadric {
    std::array<double, 10> sums{}; // of n n', of n d, of d d
    double weights = 0;
    double at(const Real3 &p) const {
        const double sum =
            sums[0] * p[0] * p[0] + sums[1] * p[1] * p[1] + sums[2] * p[2] * p[2] +
            2 * (sums[3] * p[0] * p[1] + sums[4] * p[0] * p[2] + sums[5] * p[1] * p[2] +
                 sums[6] * p[0] + sums[7] * p[1] + sums[8] * p[2]) +
            sums[9];
        return weights > 0 ? sum / weights : 0;
    }
    void add(const Real3 &n, double d, double weight) {
        const std::array<double, 10> some{n[0] * n[0], n[1] * n[1], n[2] * n[2], n[0] * n[1],
                                          n[0] * n[2], n[1] * n[2], n[0] * d,    n[1] * d,
                                          n[2] * d,    d * d};
        for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += weight * some[k];
        weights += weight;
    }
    void add(const Quadric &other) {
        for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += other.sums[k];
        weights += other.weights;
    }
};

// A vertex that may go, and the state of it for which that was found.
struct Offer {
    double cost = 0;
    std::uint32_t vertex = 0, state = 0;
    friend bool operator<(const Offer &x, const Offer &y) { // the queue's first is the greatest
        return std::tuple(x.cost, x.vertex, x.state) > std::tuple(y.cost, y.vertex, y.state);
    }
};

class Collapser {
  public:
    Collapser(const Mesh &mesh, const std::vector<std::uint8_t> &locked,
              const std::vector<Point> &colors, float paint, double tolerance)
        : mesh_(mesh), locked_(locked), colors_(colors), paint_(paint),
          most_(tolerance * tolerance), triangles_(mesh.triangles),
          alive_(mesh.triangles.size(), 1), at_(mesh.vertices.size()),
          quadrics_(mesh.vertices.size()), state_(mesh.vertices.size(), 0) {
        // About one of them, so that squares lose little.
        for (const Point &p : mesh.vertices)
            places_.push_back(minus(real(p), real(mesh.vertices[0])));
        find_quadrics();
    }

    std::vector<std::array<std::uint32_t, 3>> run() {
        for (std::uint32_t v = 0; v < at_.size(); ++v) offer(v);
        while (!offers_.empty()) {
            const Offer next = offers_.top();
            offers_.pop();
            if (next.state == state_[next.vertex]) remove(next.vertex);
        }
        std::vector<std::array<std::uint32_t, 3>> left;
        for (std::size_t t = 0; t < triangles_.size(); ++t)
            if (alive_[t]) left.push_back(triangles_[t]);
        return left;
    }

  private:
    struct Way { // into which vertex one goes, and what that costs
        double cost = 0, length = 0;
        std::uint32_t to = 0;
    };

    Real3 normal_of(const Real3 &a, const Real3 &b, const Real3 &c) const {
        return outer(minus(b, a), minus(c, a));
    }

    void find_quadrics() {
        double area = 0;
        for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
            const auto &[a, b, c] = triangles_[t];
            const Real3 n = normal_of(places_[a], places_[b], places_[c]);
            area += std::sqrt(inner(n, n)) / static_cast<double>(triangles_.size());
            for (const std::uint32_t v : triangles_[t]) at_[v].push_back(t);
        }
        for (const auto &t : triangles_) {
            Real3 n = normal_of(places_[t[0]], places_[t[1]], places_[t[2]]);
            const double size = std::sqrt(inner(n, n));
            if (!(size > 0)) continue;
            for (double &x : n) x /= size;
            // The plane of a small triangle says little: its vertices are rounded.
            const double weight = std::min(1.0, size / area);
            for (const std::uint32_t v : t) quadrics_[v].add(n, -inner(n, places_[t[0]]), weight);
        }
    }

    // The vertices about one, each once.
    void ring_of(std::uint32_t v, std::vector<std::uint32_t> &ring) const {
        ring.clear();
        for (const std::uint32_t t : at_[v])
            for (const std::uint32_t w : triangles_[t])
                if (w != v) ring.push_back(w);
        std::ranges::sort(ring);
        ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
    }

    void ways_from(std::uint32_t v) {
        ways_.clear();
        ring_of(v, ring_);
        for (const std::uint32_t u : ring_) {
            Quadric both = quadrics_[v];
            both.add(quadrics_[u]);
            const double cost = std::max(both.at(places_[u]), 0.0);
            const Real3 d = minus(places_[u], places_[v]);
            if (cost <= most_) ways_.push_back({cost, inner(d, d), u});
        }
        const auto rank = [](const Way &w) { return w.cost + by_length * w.length; };
        std::ranges::stable_sort(ways_, {}, rank);
    }

    void offer(std::uint32_t v) {
        if (at_[v].empty() || locked_[v]) return;
        ways_from(v);
        if (!ways_.empty())
            offers_.push({ways_[0].cost + by_length * ways_[0].length, v, state_[v]});
    }

    // Twice the area by the square of the longest side.
    static double shape_of(const Real3 &a, const Real3 &b, const Real3 &c, const Real3 &normal) {
        const Real3 x = minus(b, a), y = minus(c, b), z = minus(a, c);
        const double longest = std::max({inner(x, x), inner(y, y), inner(z, z)});
        return longest > 0 ? std::sqrt(inner(normal, normal)) / longest : 0;
    }

    bool good(std::uint32_t v, std::uint32_t u) {
        ring_of(u, other_ring_);
        std::size_t common = 0;
        for (const std::uint32_t w : other_ring_) common += std::ranges::binary_search(ring_, w);
        if (common != 2 || (ring_.size() == 3 && other_ring_.size() == 3)) return false;
        if (!colors_.empty())
            for (const std::uint32_t w : ring_)
                for (std::size_t i = 0; i < 3; ++i)
                    if (std::fabs(colors_[v][i] - colors_[w][i]) > paint_) return false;
        double worst_before = 1, worst_after = 1;
        for (const std::uint32_t t : at_[v]) {
            std::array<std::uint32_t, 3> now = triangles_[t];
            const Real3 before = normal_of(places_[now[0]], places_[now[1]], places_[now[2]]);
            worst_before = std::min(
                worst_before, shape_of(places_[now[0]], places_[now[1]], places_[now[2]], before));
            if (std::ranges::find(now, u) != now.end()) continue; // goes away
            std::ranges::replace(now, v, u);
            const Real3 after = normal_of(places_[now[0]], places_[now[1]], places_[now[2]]);
            if (!(inner(before, after) >
                  turning * std::sqrt(inner(before, before) * inner(after, after))))
                return false;
            if (is_flat(mesh_.vertices[now[0]], mesh_.vertices[now[1]], mesh_.vertices[now[2]]))
                return false;
            worst_after = std::min(
                worst_after, shape_of(places_[now[0]], places_[now[1]], places_[now[2]], after));
        }
        return worst_after >= std::min(sliver, worst_before);
    }

    void remove(std::uint32_t v) {
        ways_from(v);
        const std::vector<Way> ways = ways_;
        for (const Way &way : ways) {
            if (!good(v, way.to)) continue;
            const std::uint32_t u = way.to;
            const std::vector<std::uint32_t> about = ring_;
            for (const std::uint32_t t : at_[v]) {
                if (std::ranges::find(triangles_[t], u) != triangles_[t].end()) {
                    alive_[t] = 0;
                    for (const std::uint32_t w : triangles_[t])
                        if (w != v) std::erase(at_[w], t);
                } else {
                    std::ranges::replace(triangles_[t], v, u);
                    at_[u].push_back(t);
                }
            }
            at_[v].clear();
            quadrics_[u].add(quadrics_[v]);
            for (const std::uint32_t w : about) ++state_[w], offer(w);
            return;
        }
    }

    const Mesh &mesh_;
    const std::vector<std::uint8_t> &locked_;
    const std::vector<Point> &colors_;
    float paint_;
    double most_;
    std::vector<std::array<std::uint32_t, 3>> triangles_;
    std::vector<std::uint8_t> alive_;
    std::vector<std::vector<std::uint32_t>> at_; // by vertex: its triangles
    std::vector<Real3> places_;
    std::vector<Quadric> quadrics_;
    std::vector<std::uint32_t> state_; // by vertex: changes with what is about it
    std::priority_queue<Offer> offers_;
    std::vector<std::uint32_t> ring_, other_ring_;
    std::vector<Way> ways_;
};

} // namespace

std::vector<std::array<std::uint32_t, 3>> collapsed(const Mesh &mesh,
                                                    const std::vector<std::uint8_t> &locked,
                                                    const std::vector<Point> &colors, float paint,
                                                    double tolerance) {
    return Collapser(mesh, locked, colors, paint, tolerance).run();
}

} // namespace fathom::mesh
