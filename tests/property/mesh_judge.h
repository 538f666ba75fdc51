// What is measured of a mesh and of its surface, against what its certificate says.
#pragma once

#include "mesh/certify.h"
#include "random_scenes.h"
#include "tests/support/mesh_checks.h"

#include <catch2/catch.hpp>

namespace fathom::test {

inline double to_segment(const Exact &p, const Exact &a, const Exact &b) {
    const Exact d = minus(b, a), w = minus(p, a);
    const Real t = std::clamp<Real>(dot_of(w, d) / dot_of(d, d), 0, 1);
    Exact away;
    for (std::size_t i = 0; i < 3; ++i) away[i] = w[i] - t * d[i];
    return static_cast<double>(std::sqrt(dot_of(away, away)));
}

inline double to_triangle(const Exact &p, const std::array<Exact, 3> &t) {
    double best =
        std::min({to_segment(p, t[0], t[1]), to_segment(p, t[1], t[2]), to_segment(p, t[2], t[0])});
    const Exact n = cross_of(minus(t[1], t[0]), minus(t[2], t[0]));
    for (std::size_t k = 0; k < 3; ++k)
        if (dot_of(cross_of(minus(t[(k + 1) % 3], t[k]), minus(p, t[k])), n) < 0) return best;
    return std::min(
        best, static_cast<double>(std::fabs(dot_of(minus(p, t[0]), n)) / std::sqrt(dot_of(n, n))));
}

// Whether a point is no farther from a mesh than `reach`, triangle by triangle.
inline bool near_mesh(const mesh::Mesh &mesh, const mesh::Point &point, double reach) {
    return std::ranges::any_of(mesh.triangles, [&](const auto &t) {
        for (std::size_t i = 0; i < 3; ++i) {
            const auto [lo, hi] = std::minmax(
                {mesh.vertices[t[0]][i], mesh.vertices[t[1]][i], mesh.vertices[t[2]][i]});
            if (point[i] < lo - reach || point[i] > hi + reach) return false;
        }
        return to_triangle(exact(point), {exact(mesh.vertices[t[0]]), exact(mesh.vertices[t[1]]),
                                          exact(mesh.vertices[t[2]])}) <= reach;
    });
}

// Points of the surface: where the field changes its sign on random ways through a box, and keeps the
// new one for a while, as it does not in the gap between parts that touch.
inline mesh::Points surface_points(const mesh::Field &field, const ir::Box &box, Dice &dice) {
    constexpr std::size_t ways = 60, samples = 129;
    constexpr int halvings = 40;
    constexpr double kept = 1e-4; // of a way
    mesh::Evaluator evaluator(field);
    mesh::Points found, points;
    std::vector<float> values;
    double size = 0;
    for (std::size_t i = 0; i < 3; ++i) size = std::max(size, box.hi[i] - box.lo[i]);
    for (std::size_t w = 0; w < ways; ++w) {
        mesh::Point from, to;
        for (std::size_t i = 0; i < 3; ++i) {
            from[i] = static_cast<float>(dice.in(box.lo[i] - 0.01 * size, box.hi[i] + 0.01 * size));
            to[i] = static_cast<float>(dice.in(box.lo[i] - 0.01 * size, box.hi[i] + 0.01 * size));
        }
        const auto between = [&](double t) {
            mesh::Point p;
            for (std::size_t i = 0; i < 3; ++i)
                p[i] = static_cast<float>(from[i] + t * (double(to[i]) - from[i]));
            return p;
        };
        const auto solid = [&](double t) {
            points.clear();
            points.add(between(t));
            values_at(evaluator, *field.whole, points, values);
            return values[0] <= 0;
        };
        for (std::size_t k = 1; k < samples; ++k) {
            double low = double(k - 1) / (samples - 1), high = double(k) / (samples - 1);
            const bool sign = solid(low);
            if (solid(high) == sign) continue;
            for (int h = 0; h < halvings; ++h)
                (solid(0.5 * (low + high)) == sign ? low : high) = 0.5 * (low + high);
            if (solid(low - kept) == sign && solid(high + kept) != sign) found.add(between(high));
        }
    }
    return found;
}

// What the survey of a mesh has to say.
inline Survey judged(const mesh::Mesh &mesh) {
    const Survey found = survey(mesh.vertices, mesh.triangles);
    CHECK(found.border_edges == 0);
    CHECK(found.crowded_edges == 0);
    CHECK(found.turned_edges == 0);
    CHECK(found.pinched == 0);
    CHECK(found.degenerate == 0);
    CHECK(found.equal_points == 0);
    CHECK(crossings(mesh.vertices, mesh.triangles) == 0);
    return found;
}

// What is measured is never more than what was claimed: of a mesh that is not certified, of the surface
// outside of the cells that are listed.
inline void hold_against(const mesh::Made &made, const mesh::Certificate &certificate,
                         const mesh::Field &field, Dice &dice) {
    constexpr std::array<std::array<float, 3>, 4> places{
        {{1.f / 3, 1.f / 3, 1.f / 3}, {0.5f, 0.5f, 0}, {0, 0.5f, 0.5f}, {0.8f, 0.1f, 0.1f}}};
    const mesh::Mesh &mesh = made.mesh;
    mesh::Evaluator evaluator(field);
    const double rounding = 1e-4 * certificate.mesh_to_surface + 16 * made.octree.lattice.ulp;
    if (certificate.certified()) {
        mesh::Points points;
        for (const mesh::Point &p : mesh.vertices) points.add(p);
        for (const auto &t : mesh.triangles)
            for (const auto &place : places) {
                mesh::Point p{};
                for (std::size_t k = 0; k < 3; ++k)
                    for (std::size_t i = 0; i < 3; ++i) p[i] += place[k] * mesh.vertices[t[k]][i];
                points.add(p);
            }
        std::vector<float> values;
        values_at(evaluator, *field.whole, points, values);
        float farthest = 0; // the field is never more than the distance
        for (const float d : values) farthest = std::max(farthest, std::fabs(d));
        CHECK(farthest <= certificate.mesh_to_surface + rounding);
    }
    const mesh::Lattice &lattice = made.octree.lattice;
    const auto listed = [&](const mesh::Point &p) {
        return std::ranges::any_of(certificate.undecided, [&](const mesh::Cell &cell) {
            const std::int32_t side = lattice.cells(cell.level);
            for (std::size_t i = 0; i < 3; ++i)
                if (p[i] < double(lattice.at(i, cell.at[i])) - rounding ||
                    p[i] > double(lattice.at(i, cell.at[i] + side)) + rounding)
                    return false;
            return true;
        });
    };
    const mesh::Points surface = surface_points(field, made.box, dice);
    std::size_t missed = 0;
    for (std::size_t k = 0; k < surface.size(); ++k)
        missed += !near_mesh(mesh, surface[k], certificate.surface_to_mesh + rounding) &&
                  !listed(surface[k]);
    CHECK(missed == 0);
    const Survey found = survey(mesh.vertices, mesh.triangles);
    CHECK(certificate.components == found.components);
    CHECK(certificate.genus == found.genus);
    CHECK(certificate.mesh_volume == Approx(found.volume).epsilon(1e-6));
    CHECK(certificate.least_volume <= certificate.largest_volume);
}

} // namespace fathom::test
