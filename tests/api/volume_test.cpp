// Volumes as users of the library meet them.
#include <catch2/catch.hpp>

#include <cmath>
#include <fathom/fathom.h>

namespace {

fathom::Scene cloud() {
    fathom::CompileOptions options;
    options.fields = {"density", "p => [p.y, -p.x, 2]"};
    fathom::CompileResult result = fathom::compile_text(
        "cloud.sdf", "fn density(p) = max(0, 1 - length(p))\nsphere(1)\n", options);
    REQUIRE(result.scene);
    return *result.scene;
}

struct Block {
    std::array<double, 3> lo, hi;
    // Negative inside.
    double distance(const std::array<double, 3> &p) const {
        double outside = 0, most = -1e9;
        for (std::size_t i = 0; i < 3; ++i) {
            const double way = std::max(lo[i] - p[i], p[i] - hi[i]);
            outside += std::pow(std::max(way, 0.0), 2);
            most = std::max(most, way);
        }
        return most > 0 ? std::sqrt(outside) : most;
    }
};

fathom::Volume volume_of(const std::string &text, double side) {
    const fathom::CompileResult result = fathom::compile_text("solid.sdf", text + "\n");
    REQUIRE(result.scene);
    fathom::VolumeOptions options;
    options.side = side;
    fathom::Volume volume = fathom::make_volume(*result.scene, options);
    REQUIRE(volume);
    return volume;
}

template <class Do> void each_voxel(const fathom::Volume &volume, Do look) {
    std::size_t k = 0;
    for (int z = 0; z < volume.counts[2]; ++z)
        for (int y = 0; y < volume.counts[1]; ++y)
            for (int x = 0; x < volume.counts[0]; ++x, ++k)
                look(std::array<double, 3>{volume.origin[0] + volume.side * x,
                                           volume.origin[1] + volume.side * y,
                                           volume.origin[2] + volume.side * z},
                     volume.distances[k]);
}

} // namespace

TEST_CASE("where parts touch, and on faces, stored numbers are distances within the error") {
    const struct {
        const char *text;
        double side;
        Block block;
    } cases[] = {{"box(1).translate(x: 0.5).mirror(X)", 0.25, {{-1, -0.5, -0.5}, {1, 0.5, 0.5}}},
                 {"box(1) | box(1).translate(x: 1)", 0.125, {{-0.5, -0.5, -0.5}, {1.5, 0.5, 0.5}}},
                 // A seam between floats, at 0.3: some voxels find a gap of an ulp there.
                 {"box(1).translate(x: 0.8) | box(1).translate(x: -0.2)",
                  0.1,
                  {{-0.7, -0.5, -0.5}, {1.3, 0.5, 0.5}}},
                 {"box([1.1, 1, 1]).translate(x: 1.85) | box([1.1, 1, 1]).translate(x: 0.75)",
                  0.1,
                  {{0.2, -0.5, -0.5}, {2.4, 0.5, 0.5}}}};
    for (const auto &[text, side, block] : cases) {
        INFO(text);
        const fathom::Volume volume = volume_of(text, side);
        REQUIRE(volume.error);
        CHECK(*volume.error < side / 2);
        std::size_t wrong = 0;
        each_voxel(volume, [&](const std::array<double, 3> &p, float stored) {
            wrong += std::fabs(stored - block.distance(p)) > *volume.error;
        });
        CHECK(wrong == 0);
    }
}

TEST_CASE("a sheet without thickness does not turn the space about it into solid") {
    // Two sides of what is taken away lie in sides of the block: there the field is 0.
    const fathom::Volume volume =
        volume_of("box([2, 2, 2]) - box([2, 2, 1]).translate(z: 0.5)", 0.25);
    each_voxel(volume, [&](const std::array<double, 3> &p, float stored) {
        if (p[2] > 0.2) CHECK(stored > 0);
        if (p[2] < -0.2 && std::fabs(p[0]) < 0.8 && std::fabs(p[1]) < 0.8 && p[2] > -0.8)
            CHECK(stored < 0);
    });
}

TEST_CASE("a volume of a field has the field's values at the voxels") {
    const fathom::Scene scene = cloud();
    fathom::VolumeOptions options;
    options.side = 0.5;
    options.field = 0;
    const fathom::Volume density = fathom::make_volume(scene, options);
    options.field = 1;
    const fathom::Volume wind = fathom::make_volume(scene, options);
    REQUIRE((density && wind));
    CHECK((density.components == 1 && wind.components == 3));
    CHECK((density.counts == wind.counts && density.origin == wind.origin));
    std::size_t k = 0;
    for (int z = 0; z < wind.counts[2]; ++z)
        for (int y = 0; y < wind.counts[1]; ++y)
            for (int x = 0; x < wind.counts[0]; ++x, ++k) {
                CHECK(wind.values[3 * k] == float(wind.origin[1] + 0.5 * y));
                CHECK(wind.values[3 * k + 1] == -float(wind.origin[0] + 0.5 * x));
                CHECK(wind.values[3 * k + 2] == 2);
            }
    CHECK(density.values.size() == k);
    options.field = 2;
    CHECK(fathom::make_volume(scene, options).status == fathom::MeshStatus::BadOptions);
}

TEST_CASE("fields on one lattice go into one OpenVDB file, and others say why not") {
    const fathom::Scene scene = cloud();
    fathom::VolumeOptions options;
    options.resolution = 8;
    options.field = 0;
    const fathom::Volume density = fathom::make_volume(scene, options);
    options.field = 1;
    const fathom::Volume wind = fathom::make_volume(scene, options);
    options.resolution = 9;
    const fathom::Volume finer = fathom::make_volume(scene, options);
    options.field.reset();
    const fathom::Volume distances = fathom::make_volume(scene, options);
    REQUIRE((density && wind && finer && distances));
    using Volumes = std::vector<fathom::NamedVolume>;
    const fathom::VdbFile both = fathom::vdb_file(Volumes{{"density", &density}, {"v", &wind}});
    if (both.bytes.empty()) // a build without OpenVDB
        CHECK(both.message.find(".nrrd") != std::string::npos);
    else
        CHECK(both.bytes.size() > fathom::vdb_file(density).bytes.size());
    for (const Volumes &wrong :
         {Volumes{}, Volumes{{"density", nullptr}}, Volumes{{"density", &density}, {"v", &finer}},
          Volumes{{"density", &density}, {"surface", &distances}}}) {
        const fathom::VdbFile none = fathom::vdb_file(wrong);
        CHECK(none.bytes.empty());
        CHECK(none.message.find("one lattice") != std::string::npos);
    }
}
