// Meshes of random scenes: closed, oriented 2-manifolds without triangles that cross, whatever the
// scene; and their certificates, which claim no less than what is measured.
// FATHOM_EFFORT and FATHOM_SEED in the environment make it longer, or another.
#include "driver/compile.h"
#include "mesh/certify.h"
#include "mesh/simplify.h"
#include "random_scenes.h"
#include "tests/support/effort.h"
#include "tests/support/mesh_checks.h"

#include <catch2/catch.hpp>

#include <cstdlib>

using namespace fathom;

namespace {

double to_segment(const test::Exact &p, const test::Exact &a, const test::Exact &b) {
    const test::Exact d = test::minus(b, a), w = test::minus(p, a);
    const test::Real t = std::clamp<test::Real>(test::dot_of(w, d) / test::dot_of(d, d), 0, 1);
    test::Exact away;
    for (std::size_t i = 0; i < 3; ++i) away[i] = w[i] - t * d[i];
    return static_cast<double>(std::sqrt(test::dot_of(away, away)));
}

// The distance of a point from a mesh, triangle by triangle.
double to_mesh(const mesh::Mesh &mesh, const mesh::Point &point) {
    const test::Exact p = test::exact(point);
    double best = 1e30;
    for (const auto &t : mesh.triangles) {
        const test::Exact a = test::exact(mesh.vertices[t[0]]),
                          b = test::exact(mesh.vertices[t[1]]),
                          c = test::exact(mesh.vertices[t[2]]);
        best = std::min({best, to_segment(p, a, b), to_segment(p, b, c), to_segment(p, c, a)});
        const test::Exact n = test::cross_of(test::minus(b, a), test::minus(c, a));
        const auto inside = [&](const test::Exact &u, const test::Exact &v) {
            return test::dot_of(test::cross_of(test::minus(v, u), test::minus(p, u)), n) >= 0;
        };
        if (inside(a, b) && inside(b, c) && inside(c, a))
            best =
                std::min(best, static_cast<double>(std::fabs(test::dot_of(test::minus(p, a), n)) /
                                                   std::sqrt(test::dot_of(n, n))));
    }
    return best;
}

// Points of the surface: where the field changes its sign on random ways through a box.
mesh::Points surface_points(const mesh::Field &field, const ir::Box &box, test::Dice &dice) {
    constexpr std::size_t ways = 40, samples = 65;
    constexpr int halvings = 40;
    mesh::Evaluator evaluator(field);
    mesh::Points found, points;
    std::vector<float> values;
    for (std::size_t w = 0; w < ways; ++w) {
        mesh::Point from, to;
        for (std::size_t i = 0; i < 3; ++i) {
            from[i] = static_cast<float>(dice.in(box.lo[i] - 0.01, box.hi[i] + 0.01));
            to[i] = static_cast<float>(dice.in(box.lo[i] - 0.01, box.hi[i] + 0.01));
        }
        const auto between = [&](double t) {
            mesh::Point p;
            for (std::size_t i = 0; i < 3; ++i)
                p[i] = static_cast<float>(from[i] + t * (double(to[i]) - from[i]));
            return p;
        };
        const auto negative = [&](double t) {
            points.clear();
            points.add(between(t));
            values_at(evaluator, *field.whole, points, values);
            return values[0] < 0;
        };
        for (std::size_t k = 1; k < samples; ++k) {
            double low = double(k - 1) / (samples - 1), high = double(k) / (samples - 1);
            const bool sign = negative(low);
            if (negative(high) == sign) continue;
            for (int h = 0; h < halvings; ++h)
                (negative(0.5 * (low + high)) == sign ? low : high) = 0.5 * (low + high);
            found.add(between(high));
        }
    }
    return found;
}

// What is measured is never more than what was claimed.
void hold_against(const mesh::Made &made, const mesh::Certificate &certificate,
                  const mesh::Field &field, test::Dice &dice) {
    mesh::Evaluator evaluator(field);
    mesh::Points points;
    for (const mesh::Point &p : made.mesh.vertices) points.add(p);
    std::vector<float> values;
    values_at(evaluator, *field.whole, points, values);
    const double rounding = 1e-4 * certificate.mesh_to_surface + 1e-6;
    float farthest = 0; // the field is never more than the distance
    for (const float d : values) farthest = std::max(farthest, std::fabs(d));
    CHECK(farthest <= certificate.mesh_to_surface + rounding);
    const mesh::Points surface = surface_points(field, made.box, dice);
    double missed = 0;
    for (std::size_t k = 0; k < surface.size(); ++k)
        missed = std::max(missed, to_mesh(made.mesh, surface[k]));
    CHECK(missed <= certificate.surface_to_mesh + rounding);
    const test::Survey found = test::survey(made.mesh.vertices, made.mesh.triangles);
    CHECK(certificate.components == found.components);
    CHECK(certificate.genus == found.genus);
    CHECK(certificate.mesh_volume == Approx(found.volume).epsilon(1e-6));
    CHECK(certificate.least_volume <= certificate.largest_volume);
}

} // namespace

TEST_CASE(
    "meshes of random scenes are closed, do not cross themselves, and are as near as claimed") {
    const std::uint64_t count = std::uint64_t(test::effort(8)), seed = std::uint64_t(test::seed());
    std::size_t made_meshes = 0, triangles = 0, kept_triangles = 0, certified = 0;
    for (std::uint64_t number = 0; number < count; ++number) {
        test::Dice dice{seed * 1'000'003 + number};
        test::RandomScene scene(seed * 7919 + number);
        const test::TermPtr term = scene.solid(2 + dice.below(2));
        std::string text;
        for (const std::string &param : scene.params()) text += param;
        text += text_of(*term) + "\n";
        const driver::Compilation c =
            driver::compile_text("random.sdf", text, FATHOM_SOURCE_DIR "/examples/parts", {});
        if (!c.good()) continue;
        mesh::Settings settings;
        settings.resolution = 8 + dice.below(24);
        settings.threads = 2;
        if (dice.chance(0.2)) settings.bounds = ir::Box{{-0.5, -0.7, -0.6}, {0.9, 0.8, 0.7}};
        const mesh::Made made = mesh::make_mesh(c.scene, settings);
        INFO(text << "resolution " << settings.resolution << (settings.bounds ? ", cut" : ""));
        if (made.failure == mesh::Failure::Empty || made.failure == mesh::Failure::Endless ||
            made.failure == mesh::Failure::Unseen || // said: of what is nearly all cut away
            made.failure == mesh::Failure::Flat)
            continue;
        REQUIRE(made.failure == mesh::Failure::None);
        ++made_meshes;
        triangles += made.mesh.triangles.size();
        const test::Survey found = test::survey(made.mesh.vertices, made.mesh.triangles);
        CHECK(found.border_edges == 0);
        CHECK(found.crowded_edges == 0);
        CHECK(found.turned_edges == 0);
        CHECK(found.pinched == 0);
        CHECK(found.degenerate == 0);
        CHECK(found.equal_points == 0);
        CHECK(test::crossings(made.mesh.vertices, made.mesh.triangles) == 0);
        mesh::Progress progress;
        const mesh::Lattice &lattice = made.octree.lattice;
        const double side = lattice.side(lattice.level);
        const mesh::Simplified fewer =
            simplify(made.mesh, {}, {dice.in(0.05, 1) * side, side, 2}, progress);
        const test::Survey left = test::survey(fewer.mesh.vertices, fewer.mesh.triangles);
        CHECK(left.closed());
        CHECK((left.components == found.components && left.genus == found.genus));
        CHECK(test::crossings(fewer.mesh.vertices, fewer.mesh.triangles) == 0);
        kept_triangles += fewer.mesh.triangles.size();
        const mesh::Certificate certificate = certify(c.scene, settings, made, progress);
        if (!certificate.certified()) continue;
        ++certified;
        hold_against(made, certificate, mesh::Field(c.scene, settings.time, settings.bounds), dice);
    }
    CHECK(made_meshes > count / 3);
    CHECK(certified > made_meshes / 4);
    CHECK(kept_triangles < triangles);
    WARN(made_meshes << " meshes, " << triangles << " triangles, " << kept_triangles
                     << " when simplified, " << certified << " certified");
}
