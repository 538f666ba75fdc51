// Meshes of random scenes: closed, oriented 2-manifolds without triangles that cross, whatever the
// scene; and their certificates, which claim no less than what is measured.
// FATHOM_EFFORT and FATHOM_SEED in the environment make it longer, or another.
#include "driver/compile.h"
#include "mesh/simplify.h"
#include "mesh_judge.h"
#include "tests/support/effort.h"

using namespace fathom;

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
            (made.failure == mesh::Failure::Outside && settings.bounds) ||
            made.failure == mesh::Failure::Unseen ||    // said: of what is nearly all cut away,
            made.failure == mesh::Failure::Unbounded || // … and of what may have no end
            made.failure == mesh::Failure::Flat)
            continue;
        REQUIRE(made.failure == mesh::Failure::None);
        ++made_meshes;
        triangles += made.mesh.triangles.size();
        const test::Survey found = test::judged(made.mesh);
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
        certified += certificate.certified();
        test::hold_against(made, certificate, mesh::Field(c.scene, settings.time, settings.bounds),
                           dice);
    }
    CHECK(made_meshes > count / 3);
    CHECK(certified > made_meshes / 4);
    CHECK(kept_triangles < triangles);
    WARN(made_meshes << " meshes, " << triangles << " triangles, " << kept_triangles
                     << " when simplified, " << certified << " certified");
}
