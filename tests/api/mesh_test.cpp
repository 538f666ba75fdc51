// Meshes as users of the library meet them.
#include <catch2/catch.hpp>

#include <fathom/fathom.h>

#include <cmath>
#include <limits>

namespace {

fathom::Scene scene_of(std::string_view text) {
    fathom::CompileResult result = fathom::compile_text("test.sdf", text);
    REQUIRE(result.scene);
    return *result.scene;
}

} // namespace

TEST_CASE("a mesh is a value, with a normal for each vertex, the same for any number of threads") {
    const fathom::Scene scene = scene_of("param r = 1 in 0.5..2\nsphere(r)\n");
    fathom::MeshOptions options;
    options.resolution = 20;
    options.threads = 1;
    const fathom::Mesh mesh = fathom::make_mesh(scene, options);
    REQUIRE(mesh);
    CHECK(mesh.message.empty());
    CHECK(mesh.undecided_cells == 0);
    REQUIRE(mesh.normals.size() == mesh.vertices.size());
    for (std::size_t k = 0; k < mesh.vertices.size(); ++k) {
        double radius = 0, along = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            radius += double(mesh.vertices[k][i]) * mesh.vertices[k][i];
            along += double(mesh.vertices[k][i]) * mesh.normals[k][i];
        }
        CHECK(std::sqrt(radius) == Approx(1).margin(1e-3));
        CHECK(along == Approx(1).margin(0.01));
    }
    options.threads = 7;
    const fathom::Mesh again = fathom::make_mesh(scene, options);
    CHECK(again.vertices == mesh.vertices);
    CHECK(again.triangles == mesh.triangles);
    const auto larger = scene.with({{"r", {2}}});
    REQUIRE(larger);
    CHECK(fathom::make_mesh(*larger.scene, options).vertices != mesh.vertices);
}

TEST_CASE("a mesh that cannot be made is empty and says why") {
    const fathom::Scene ball = scene_of("sphere(1)\n");
    fathom::MeshOptions options;
    const auto refused = [&](const fathom::Scene &scene, fathom::MeshStatus status) {
        const fathom::Mesh mesh = fathom::make_mesh(scene, options);
        CHECK(mesh.status == status);
        CHECK_FALSE(mesh.message.empty());
        CHECK((mesh.vertices.empty() && mesh.triangles.empty()));
    };
    refused(scene_of("plane(Y, 0)\n"), fathom::MeshStatus::Endless);
    refused(scene_of("sphere(1) & sphere(1).translate(x: 5)\n"), fathom::MeshStatus::Empty);
    options.tolerance = 1e-9;
    refused(ball, fathom::MeshStatus::TooFine);
    options.tolerance = std::numeric_limits<double>::quiet_NaN();
    refused(ball, fathom::MeshStatus::BadOptions);
    options = {};
    options.resolution = 0;
    refused(ball, fathom::MeshStatus::BadOptions);
    options = {};
    options.bounds = fathom::Box{{1, 1, 1}, {0, 0, 0}};
    refused(ball, fathom::MeshStatus::BadOptions);
    options = {};
    options.time = 11; // nothing would be proved of it
    const fathom::Scene moving = scene_of("sphere(1 + time / 10)\nrender(time: 10)\n");
    refused(moving, fathom::MeshStatus::BadOptions);
    options.time = 9;
    CHECK(fathom::make_mesh(moving, options));
    options.bounds.reset();
    int calls = 0;
    options.progress = [&](double share) {
        CHECK((share >= 0 && share <= 1));
        return ++calls < 2;
    };
    refused(ball, fathom::MeshStatus::Cancelled);
    CHECK(calls == 2);
}

TEST_CASE("progress rises to the end") {
    fathom::MeshOptions options;
    options.resolution = 16;
    double last = 0;
    options.progress = [&](double share) {
        CHECK(share >= last);
        last = share;
        return true;
    };
    CHECK(fathom::make_mesh(scene_of("sphere(1)\n"), options));
    CHECK(last > 0.8);
}

TEST_CASE("formats by suffix") {
    CHECK(fathom::mesh_format("a.stl") == fathom::MeshFormat::Stl);
    CHECK(fathom::mesh_format("b/A.GLB") == fathom::MeshFormat::Glb);
    CHECK_FALSE(fathom::mesh_format(".stl"));
    CHECK_FALSE(fathom::mesh_format("stl"));
    CHECK_FALSE(fathom::mesh_format("a.png"));
}

TEST_CASE("limits of a compilation") {
    fathom::CompileOptions options;
    options.limits["work"] = "10";
    CHECK_FALSE(fathom::compile_text("a.sdf", "for i in 0..100 { sphere(i + 1) }\n", options));
    options.limits = {{"wrk", "10"}};
    const fathom::CompileResult result = fathom::compile_text("a.sdf", "sphere(1)\n", options);
    CHECK_FALSE(result);
    REQUIRE(result.diagnostics.size() == 1);
    CHECK(result.diagnostics[0].code == "usage");
}
