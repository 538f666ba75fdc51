// Meshes of scenes whose topology, volume and corners are known.
#include "driver/compile.h"
#include "mesh/appearance.h"
#include "mesh/crumbs.h"
#include "mesh/mesh.h"
#include "tests/support/mesh_checks.h"

#include <catch2/catch.hpp>

#include <numbers>

using namespace fathom;

namespace {

mesh::Made mesh_of(const std::string &text, const mesh::Settings &settings) {
    const driver::Compilation c =
        driver::compile_text("mesh.sdf", text, FATHOM_SOURCE_DIR "/examples/parts", {});
    INFO(text);
    REQUIRE(c.good());
    return mesh::make_mesh(c.scene, settings);
}

mesh::Made mesh_of(const std::string &text, int resolution) {
    mesh::Settings settings;
    settings.resolution = resolution;
    return mesh_of(text, settings);
}

test::Survey checked(const mesh::Made &made) {
    REQUIRE(made.failure == mesh::Failure::None);
    const test::Survey found = test::survey(made.mesh.vertices, made.mesh.triangles);
    CHECK(found.border_edges == 0);
    CHECK(found.crowded_edges == 0);
    CHECK(found.turned_edges == 0);
    CHECK(found.pinched == 0);
    CHECK(found.degenerate == 0);
    CHECK(found.equal_points == 0);
    CHECK(test::crossings(made.mesh.vertices, made.mesh.triangles) == 0);
    CHECK(found.volume > 0); // the outside is where it belongs
    return found;
}

} // namespace

TEST_CASE("a ball: closed, of genus 0, with its volume and area") {
    const test::Survey found = checked(mesh_of("sphere(1)", 32));
    CHECK(found.components == 1);
    CHECK(found.genus == 0);
    CHECK(found.volume == Approx(4.0 / 3 * std::numbers::pi).epsilon(0.01));
    CHECK(found.area == Approx(4 * std::numbers::pi).epsilon(0.01));
}

TEST_CASE("components and genus where they are known") {
    struct Known {
        const char *text;
        int resolution;
        std::size_t components;
        long genus;
    };
    const Known known[] = {
        {"torus(1, 0.3)", 24, 1, 1},
        {"torus(1, 0.3)", 61, 1, 1},
        {"menger(2, 1)", 40, 1, 5},
        {"menger(2, 2)", 64, 1, 81},
        {"sphere(0.5).translate(x: -1) | sphere(0.5).translate(x: 1)", 40, 2, 0},
        {"sphere(1).shell(0.1)", 60, 2, 0},
        {"box(1) | box(1).translate(x: 2.5) | torus(0.4, 0.1).translate(y: 2)", 70, 3, 1},
    };
    for (const Known &k : known) {
        INFO(k.text << " at " << k.resolution);
        const test::Survey found = checked(mesh_of(k.text, k.resolution));
        CHECK(found.components == k.components);
        CHECK(found.genus == k.genus);
    }
}

TEST_CASE("sharp edges and corners are kept") {
    for (const int resolution : {9, 20, 33}) {
        const mesh::Made made = mesh_of("box([2, 1, 1.5])", resolution);
        const test::Survey found = checked(made);
        CHECK(found.volume == Approx(3).epsilon(1e-4));
        CHECK(found.area == Approx(2 * (2 + 3 + 1.5)).epsilon(1e-4));
        std::size_t corners = 0;
        for (const mesh::Point &p : made.mesh.vertices)
            corners += std::fabs(std::fabs(p[0]) - 1) < 1e-4 &&
                       std::fabs(std::fabs(p[1]) - 0.5) < 1e-4 &&
                       std::fabs(std::fabs(p[2]) - 0.75) < 1e-4;
        CHECK(corners == 8);
    }
}

TEST_CASE(
    "edges along diagonals of the lattice take no more triangles than others, and no crumbs") {
    // An even number of cells puts the lattice's corners into the planes of the edges.
    for (const char *text :
         {"tetrahedron(1)", "box(2) - tetrahedron(0.8)",
          "box(1).rotate(45deg, axis: X) | box(1).rotate(45deg, axis: Y).translate(x: 1.5)"})
        for (const int resolution : {12, 24, 31}) {
            INFO(text << " at " << resolution);
            const mesh::Made along = mesh_of(text, resolution);
            const test::Survey found = checked(along),
                               turned = checked(mesh_of("(" + std::string(text) +
                                                            ").rotate(0.1, axis: [1, 2, 3])",
                                                        resolution));
            CHECK(found.genus == 0);
            CHECK(found.components == turned.components);
            CHECK(found.volume == Approx(turned.volume).epsilon(0.01));
            const double side = along.octree.lattice.side(along.octree.lattice.level);
            CHECK(double(along.mesh.triangles.size()) < 8 * found.area / (side * side));
        }
    const mesh::Made ridge = mesh_of("tetrahedron(1)", 24);
    CHECK(ridge.mesh.triangles.size() < 10'000);
    std::size_t on_edge = 0; // from [1, 1, 1] to [1, -1, -1]: it is drawn, and sharp
    for (const mesh::Point &p : ridge.mesh.vertices)
        on_edge += std::fabs(p[1] - p[2]) < 1e-3 && p[0] > 0.57;
    CHECK(on_edge > 20);
}

TEST_CASE(
    "a sharp edge or a tip that only divided cells show is drawn in one piece with the rest") {
    for (const char *text : // each had one to three crumbs beside it
         {"(sphere(1) - sphere(1).translate(x: 0.5)).rotate(0.4, axis: [1, 2, 3])",
          "rectangle([0.2, 0.14]).translate(x: 0.58).extrude(0.4, twist: 60deg)"}) {
        INFO(text);
        const mesh::Made made = mesh_of(text, 128);
        CHECK(checked(made).components == 1);
        CHECK(mesh::find_crumbs(made.octree, made.loops).count == 0);
    }
    // Balls that are smaller than a cell stay.
    const char *dust = "sphere(0.004).repeat([0.1, 0.1, 0.1], count: [5, 5, 5])";
    CHECK(checked(mesh_of(dust, 128)).components == 125);
}

TEST_CASE("solids that touch, and ones finer than the cells, still give a closed mesh") {
    for (const char *text : {"box(1) | box(1).translate([1, 1, 0])",      // along an edge
                             "box(1) | box(1).translate([1, 1, 1])",      // at a corner
                             "box(1) | box(1).translate(x: 1.0001)",      // all but
                             "gyroid(0.5, 0.05).within(ball(1))",         //
                             "menger(2, 3)", "sphere(1) - sphere(0.999)", //
                             "(sphere(1) | sphere(0.3).translate(x: 1.2)) - box([0.01, 3, 3])"})
        for (const int resolution : {7, 18}) {
            INFO(text << " at " << resolution);
            checked(mesh_of(text, resolution));
        }
}

TEST_CASE("a thin wall between the corners of the lattice is found") {
    const mesh::Made made =
        mesh_of("sphere(0.4).translate(x: -4) | box([0.01, 1.5, 1.5]).translate(x: 2)", 100);
    const test::Survey found = checked(made);
    CHECK(found.components == 2);
    CHECK(found.volume == Approx(0.01 * 2.25 + 4.0 / 3 * std::numbers::pi * 0.064).epsilon(0.02));
}

TEST_CASE("the same mesh for any number of threads") {
    mesh::Settings settings;
    settings.resolution = 50;
    std::optional<mesh::Mesh> first;
    for (const unsigned threads : {1u, 2u, 5u, 16u}) {
        settings.threads = threads;
        const mesh::Made made =
            mesh_of("smooth_union(0.2) { sphere(1); box(1.4).rotate(0.3, axis: X) }", settings);
        REQUIRE(made.failure == mesh::Failure::None);
        if (!first) first = made.mesh;
        CHECK(made.mesh.vertices == first->vertices);
        CHECK(made.mesh.normals == first->normals);
        CHECK(made.mesh.triangles == first->triangles);
    }
}

TEST_CASE("what has no end, is empty or is too fine gives no mesh, and says which") {
    CHECK(mesh_of("plane(Y, 0)", 20).failure == mesh::Failure::Endless);
    CHECK(mesh_of("sphere(1) & sphere(1).translate(x: 5)", 20).failure == mesh::Failure::Empty);
    mesh::Settings settings;
    settings.side = 1e-7;
    CHECK(mesh_of("sphere(1)", settings).failure == mesh::Failure::TooFine);
    settings = {};
    settings.side = 0.01;
    CHECK(mesh_of("sphere(1).translate(x: 1e6)", settings).failure == mesh::Failure::TooFine);
}

TEST_CASE("bounds cut the solid off, with sharp edges") {
    mesh::Settings settings;
    settings.resolution = 30;
    settings.bounds = ir::Box{{-1, -1, -1}, {1, 2, 1}};
    const test::Survey found = checked(mesh_of("plane(Y, 0)", settings));
    CHECK(found.components == 1);
    CHECK(found.volume == Approx(4).epsilon(1e-3));
}

TEST_CASE("the survey counts what is wrong with a mesh") {
    // A tetrahedron; then without a side, with a side turned, and with another one stuck through it.
    const std::vector<test::MeshPoint> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const std::vector<test::MeshTriangle> solid{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
    const test::Survey good = test::survey(points, solid);
    CHECK((good.closed() && good.genus == 0 && good.components == 1));
    CHECK(good.volume == Approx(1.0 / 6));
    CHECK(test::crossings(points, solid) == 0);
    CHECK(test::survey(points, std::span(solid).first(3)).border_edges == 3);
    std::vector<test::MeshTriangle> turned = solid;
    std::swap(turned[0][0], turned[0][1]);
    CHECK(test::survey(points, turned).turned_edges == 3);
    std::vector<test::MeshPoint> two = points;
    std::vector<test::MeshTriangle> both = solid;
    for (const test::MeshPoint &p : points) two.push_back({p[0] + 0.1f, p[1] + 0.15f, p[2] - 0.3f});
    for (const test::MeshTriangle &t : solid) both.push_back({t[0] + 4, t[1] + 4, t[2] + 4});
    CHECK(test::survey(two, both).closed());
    CHECK(test::crossings(two, both) > 0);
    std::vector<test::MeshTriangle> pinched = solid; // two solids at one vertex
    for (const test::MeshTriangle &t : solid) {
        const auto of = [](std::uint32_t v) { return v == 0 ? 0 : v + 4; };
        pinched.push_back({of(t[0]), of(t[1]), of(t[2])});
    }
    CHECK(test::survey(two, pinched).pinched == 1);
}

TEST_CASE("triangles are judged without rounding") {
    // In one plane: apart, with a side in common, and one over the other.
    const std::vector<test::MeshPoint> flat{{0, 0, 1},       {1, 0, 1},    {0, 1, 1}, {1, 1, 1},
                                            {0.9f, 0.2f, 1}, {0.1f, 0, 1}, {3, 0, 1}, {3, 1, 1}};
    CHECK(test::crossings(flat, std::vector<test::MeshTriangle>{{0, 1, 2}, {1, 3, 2}}) == 0);
    CHECK(test::crossings(flat, std::vector<test::MeshTriangle>{{0, 1, 2}, {1, 6, 7}}) == 0);
    CHECK(test::crossings(flat, std::vector<test::MeshTriangle>{{0, 1, 2}, {4, 3, 5}}) == 1);
    CHECK(test::crossings(flat, std::vector<test::MeshTriangle>{{0, 1, 2}, {0, 1, 4}}) == 1);
    // A strip that is flat but for a billionth of a billionth; a way that ends so far before a plane.
    const float tiny = 3.46944695e-18f;
    const std::vector<test::MeshPoint> strip{
        {0.15695107f, -0.124024272f, 7.5e-10f},  {0.297438741f, tiny, -5.6e-9f},
        {0.15695107f, tiny, -5.6e-9f},           {0.297438741f, -0.124024272f, 7.5e-10f},
        {0.437926412f, -0.124024272f, 7.5e-10f}, {0.437926412f, 0, -5.6e-9f}};
    CHECK(test::crossings(strip, std::vector<test::MeshTriangle>{{0, 1, 2}, {3, 4, 5}}) == 0);
    const test::Exact a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0};
    CHECK(test::side_of(a, b, c, {0.3L, 0.3L, 1e-40L}) == 1);
    CHECK(test::side_of({1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, -1 + 0x1p-24L}) == 1);
}

TEST_CASE("a mesh can be cancelled") {
    mesh::Settings settings;
    int calls = 0;
    settings.progress = [&](double) { return ++calls < 3; };
    CHECK(mesh_of("sphere(1)", settings).failure == mesh::Failure::Cancelled);
    CHECK(calls == 3);
}

TEST_CASE("vertices have the colour of the paint where they are, whatever space it stands in") {
    const auto colored = [](const std::string &text) {
        const driver::Compilation c = driver::compile_text("mesh.sdf", text, "", {});
        INFO(text);
        REQUIRE(c.good());
        mesh::Settings settings;
        settings.resolution = 16;
        const mesh::Made made = mesh::make_mesh(c.scene, settings);
        REQUIRE(made.failure == mesh::Failure::None);
        return std::pair(made.mesh,
                         mesh::colors_of(c.scene, 0, made.mesh, made.octree.lattice.unit));
    };
    const auto [pair, of_pair] =
        colored("sphere(1).paint(#f00) | sphere(1).translate(x: 3).paint(#00f)");
    REQUIRE(of_pair.size() == pair.vertices.size());
    for (std::size_t k = 0; k < of_pair.size(); ++k)
        CHECK(of_pair[k] ==
              (pair.vertices[k][0] < 1.5f ? mesh::Point{1, 0, 0} : mesh::Point{0, 0, 1}));
    // A field of the point and the normal, turned with the shape: its upper half looks to +x.
    const auto [turned, of_turned] = colored(
        "sphere(1).paint((p, n) => [saturate(n.y), 0, 0]).rotate(-90deg, axis: Z).translate(x: 2)");
    for (std::size_t k = 0; k < of_turned.size(); ++k)
        CHECK(of_turned[k][0] == Approx(std::max(turned.vertices[k][0] - 2, 0.0f)).margin(0.05));
}
