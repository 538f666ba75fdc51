// Volumes as users of the library meet them.
#include <catch2/catch.hpp>

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

} // namespace

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
