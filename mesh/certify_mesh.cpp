// From the mesh to the surface: docs/meshes.md, 6, theorem 6.
#include "mesh/inquiry.h"

#include <algorithm>
#include <cmath>

namespace fathom::mesh {
namespace {

constexpr int finest_piece = 4; // divisions of a triangle into four
constexpr int own_pieces = 2;   // … before edges of other cells are asked for, too
constexpr std::size_t piece_of_mesh = 512;

Real3 sum_of(const Triangle3 &piece) { return along(along(piece[0], piece[1], 1), piece[2], 1); }

Real3 middle_of(const Inquiry &inquiry, std::uint32_t triangle) {
    return along({}, sum_of(inquiry.triangles[triangle]), 1.0 / 3);
}

struct Shard {
    Triangle3 corners;
    std::uint32_t triangle = 0; // whose piece it is
};

// The crossed edges of the patches that a triangle goes through.
void find_own_roots(const Inquiry &inquiry, std::uint32_t triangle,
                    std::vector<std::uint32_t> &roots) {
    roots.clear();
    const Loops &loops = inquiry.made.loops;
    for (const std::uint32_t v : inquiry.made.mesh.triangles[triangle]) {
        if (v >= loops.patches.size()) continue; // on an edge or a face
        const Patch &patch = loops.patches[v];
        for (std::uint32_t k = patch.first; k < patch.first + patch.count; ++k)
            roots.push_back(static_cast<std::uint32_t>(loops.members[k]));
    }
}

double first_root(const Inquiry &inquiry, const std::vector<std::uint32_t> &roots, const Real3 &to,
                  double enough) {
    double d = 2 * inquiry.allowed;
    for (std::size_t k = 0; k < roots.size() && d > enough; ++k)
        d = std::min(d, distance(to, real(inquiry.made.roots[roots[k]])) +
                            inquiry.made.root_slack[roots[k]]);
    return d;
}

// How far a triangle may be from the surface: its pieces from the places where it crosses edges.
// Pieces that are farther than is allowed are left over.
double farthest_on(const Inquiry &inquiry, std::uint32_t number, Candidates &candidates,
                   std::vector<Shard> &left) {
    const Triangle3 &triangle = inquiry.triangles[number];
    find_own_roots(inquiry, number, candidates.own);
    candidates.found_near = false;
    double farthest = 0;
    std::vector<Triangle3> pieces{triangle}, next;
    for (int depth = 0; !pieces.empty(); ++depth, std::swap(pieces, next)) {
        next.clear();
        for (const Triangle3 &piece : pieces) {
            const Real3 middle = along({}, sum_of(piece), 1.0 / 3);
            const double radius = std::max({distance(middle, piece[0]), distance(middle, piece[1]),
                                            distance(middle, piece[2])});
            const double enough = inquiry.allowed - radius;
            double d = first_root(inquiry, candidates.own, middle, enough);
            if (d > enough && enough >= 0 && depth >= own_pieces) {
                if (!candidates.found_near) {
                    Real3 lo = triangle[0], hi = triangle[0];
                    for (const Real3 &p : triangle)
                        for (std::size_t i = 0; i < 3; ++i)
                            lo[i] = std::min(lo[i], p[i]), hi[i] = std::max(hi[i], p[i]);
                    for (std::size_t i = 0; i < 3; ++i)
                        lo[i] -= inquiry.allowed, hi[i] += inquiry.allowed;
                    inquiry.by_root.find(lo, hi, candidates.near);
                    candidates.found_near = true;
                }
                d = first_root(inquiry, candidates.near, middle, enough);
            }
            if (d <= enough) {
                farthest = std::max(farthest, (d + radius) * outward);
            } else if (depth == finest_piece) {
                left.push_back({piece, number});
            } else {
                Triangle3 m; // the middles of its sides
                for (std::size_t k = 0; k < 3; ++k)
                    for (std::size_t i = 0; i < 3; ++i)
                        m[k][i] = 0.5 * (piece[k][i] + piece[(k + 1) % 3][i]);
                next.push_back(m);
                for (std::size_t k = 0; k < 3; ++k)
                    next.push_back({piece[k], m[k], m[(k + 2) % 3]});
            }
        }
    }
    return farthest;
}

// The same of a triangle that may be many cells large: each piece is held against the edges about it.
double farthest_over(const Inquiry &inquiry, std::uint32_t number, std::vector<std::uint32_t> &near,
                     std::vector<Shard> &left) {
    constexpr double small = 0.6, smallest = 1.0 / 16; // of what is allowed: a piece's radius
    double farthest = 0;
    std::vector<Triangle3> pieces{inquiry.triangles[number]};
    while (!pieces.empty()) {
        const Triangle3 piece = pieces.back();
        pieces.pop_back();
        const Real3 middle = along({}, sum_of(piece), 1.0 / 3);
        const double radius = std::max(
            {distance(middle, piece[0]), distance(middle, piece[1]), distance(middle, piece[2])});
        const double enough = inquiry.allowed - radius;
        if (radius <= small * inquiry.allowed) {
            inquiry.by_root.find(along(middle, {1, 1, 1}, -enough),
                                 along(middle, {1, 1, 1}, enough), near);
            const double d = first_root(inquiry, near, middle, enough);
            if (d <= enough) {
                farthest = std::max(farthest, (d + radius) * outward);
                continue;
            }
            if (radius <= smallest * inquiry.allowed) {
                left.push_back({piece, number});
                continue;
            }
        }
        Triangle3 m; // the middles of its sides
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t i = 0; i < 3; ++i)
                m[k][i] = 0.5 * (piece[k][i] + piece[(k + 1) % 3][i]);
        pieces.push_back(m);
        for (std::size_t k = 0; k < 3; ++k) pieces.push_back({piece[k], m[k], m[(k + 2) % 3]});
    }
    return farthest;
}

// Where a piece's signs are asked: its middle, and so many ways from it at each of some distances.
constexpr std::size_t ways = 16;
constexpr std::array<double, 3> steps{0.125, 0.25, 0.5}; // of what is allowed

// Along the piece's normal, the axes and the diagonals, both ways.
std::array<Real3, ways> ways_from(const Triangle3 &piece) {
    std::array<Real3, ways> found{};
    const Real3 n = outer(minus(piece[1], piece[0]), minus(piece[2], piece[0]));
    const double length = std::sqrt(inner(n, n));
    for (std::size_t i = 0; i < 3; ++i) {
        found[0][i] = length > 0 ? n[i] / length : 0;
        found[1][i] = -found[0][i];
        found[2 + 2 * i][i] = 1;
        found[3 + 2 * i][i] = -1;
        for (std::size_t k = 0; k < 8; ++k)
            found[8 + k][i] = (k >> i & 1 ? 1 : -1) / std::sqrt(3.0);
    }
    return found;
}

// Pieces far from all edges that the surface crosses: it lies between the middle of such a piece and
// a point with another sign.
void certify_some(const Inquiry &inquiry, std::span<const Shard> left, Evaluator &evaluator,
                  Certificate &certificate) {
    constexpr std::size_t looks = 1 + ways * steps.size();
    Points points;
    Point lo{}, hi{};
    const auto add = [&](const Real3 &at) {
        const Point p{static_cast<float>(at[0]), static_cast<float>(at[1]),
                      static_cast<float>(at[2])};
        for (std::size_t i = 0; i < 3; ++i) {
            lo[i] = points.size() > 0 ? std::min(lo[i], p[i]) : p[i];
            hi[i] = points.size() > 0 ? std::max(hi[i], p[i]) : p[i];
        }
        points.add(p);
    };
    for (const Shard &shard : left) {
        const Real3 middle = along({}, sum_of(shard.corners), 1.0 / 3);
        add(middle);
        for (const double step : steps)
            for (const Real3 &way : ways_from(shard.corners))
                add(along(middle, way, step * inquiry.allowed));
    }
    cpu::Boxes boxes;
    std::vector<float> values;
    values_at(evaluator, *tape_in(evaluator, boxes, inquiry.field.whole, lo, hi), points, values);
    for (std::size_t k = 0; k < left.size(); ++k) {
        const Triangle3 &piece = left[k].corners;
        const double size = std::max({distance(piece[0], piece[1]), distance(piece[1], piece[2]),
                                      distance(piece[2], piece[0])}) +
                            4 * inquiry.made.octree.lattice.ulp; // points are rounded to floats
        const std::span<const float> here = std::span(values).subspan(k * looks, looks);
        double far = 2 * inquiry.allowed;
        for (std::size_t s = steps.size(); s-- > 0;)
            for (std::size_t w = 0; w < ways; ++w)
                if ((here[1 + s * ways + w] <= 0) != (here[0] <= 0))
                    far = (steps[s] * inquiry.allowed + size) * outward;
        if (far <= inquiry.allowed)
            certificate.mesh_to_surface = std::max(certificate.mesh_to_surface, far);
        else
            certificate.unproved.push_back(
                {points[k * looks], middle_of(inquiry, left[k].triangle)});
    }
}

void certify_left(const Inquiry &inquiry, const std::vector<Shard> &left, unsigned threads,
                  Progress &progress, Certificate &certificate) {
    constexpr std::size_t group = 64;
    std::vector<Certificate> found((left.size() + group - 1) / group);
    in_parallel(
        found.size(), threads, progress, [&] { return Evaluator(inquiry.field); },
        [&](Evaluator &evaluator, std::size_t number) {
            const std::size_t first = number * group;
            certify_some(inquiry,
                         std::span(left).subspan(first, std::min(group, left.size() - first)),
                         evaluator, found[number]);
        });
    for (const Certificate &some : found) {
        certificate.mesh_to_surface = std::max(certificate.mesh_to_surface, some.mesh_to_surface);
        certificate.unproved.insert(certificate.unproved.end(), some.unproved.begin(),
                                    some.unproved.end());
    }
}

} // namespace

void certify_mesh(const Inquiry &inquiry, unsigned threads, Progress &progress,
                  Certificate &certificate) {
    struct Found {
        double farthest = 0;
        std::vector<Shard> left;
    };
    std::vector<Found> found((inquiry.triangles.size() + piece_of_mesh - 1) / piece_of_mesh);
    in_parallel(
        found.size(), threads, progress, [] { return Candidates(); },
        [&](Candidates &candidates, std::size_t number) {
            const std::size_t end =
                std::min(inquiry.triangles.size(), (number + 1) * piece_of_mesh);
            for (std::size_t k = number * piece_of_mesh; k < end; ++k)
                if (const auto t = static_cast<std::uint32_t>(k);
                    !inquiry.proved_before(middle_of(inquiry, t)))
                    found[number].farthest = std::max(
                        found[number].farthest,
                        inquiry.own
                            ? farthest_on(inquiry, t, candidates, found[number].left)
                            : farthest_over(inquiry, t, candidates.near, found[number].left));
        });
    std::vector<Shard> left;
    for (const Found &some : found) {
        certificate.mesh_to_surface = std::max(certificate.mesh_to_surface, some.farthest);
        left.insert(left.end(), some.left.begin(), some.left.end());
    }
    certify_left(inquiry, left, threads, progress, certificate);
}

} // namespace fathom::mesh
