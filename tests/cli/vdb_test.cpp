// OpenVDB files that others write: grids by name, where they stand, and what is refused.
#include "shell.h"

#include <catch2/catch.hpp>

using Approx = Catch::Detail::Approx;

#ifdef MAKE_VDB
namespace {

struct Files : ScratchFolder {
    Files() { REQUIRE(shell(*this, MAKE_VDB " .").exit == 0); }
    Result check(const std::string &call) {
        write("a.sdf", call + "\n");
        return shell(*this, "fathom check a.sdf");
    }
    // The marched field at a point.
    double at(const std::string &call, const std::string &point) {
        write("a.sdf", call + "\n");
        const Result made = shell(*this, "fathom eval a.sdf " + point);
        INFO(made.err);
        REQUIRE(made.exit == 0);
        return std::stod(made.out);
    }
    void refused(const std::string &call, const std::string &words) {
        const Result made = check(call);
        INFO(call << ": " << made.err);
        CHECK(made.exit == 1);
        CHECK(contains(made.err, words));
    }
};

} // namespace

TEST_CASE("one of several grids of an OpenVDB file is named") {
    Files files;
    files.refused(
        "distance_grid(\"two.vdb\")",
        "several grids of numbers (`density`, `heat`): name one, as by `grid: \"density\"`");
    files.refused("distance_grid(\"two.vdb\", grid: \"smoke\")",
                  "no grid `smoke` of numbers, those it has are `density`, `heat`");
    files.refused("distance_grid(\"two.vdb\", grid: \"mist\")", "no grid `mist` of numbers");
    files.refused("distance_grid(\"alike.vdb\", grid: \"density\")", "`density[0]`, `density[1]`");
    CHECK(files.at("distance_grid(\"alike.vdb\", grid: \"density[1]\")", "1 0 0") ==
          Approx(0).margin(0.01));
    const std::string small = "distance_grid(\"two.vdb\", grid: \"density\")",
                      large = "distance_grid(\"two.vdb\", grid: \"heat\")";
    CHECK(files.at(small, "0.5 0 0") == Approx(0).margin(0.01));
    CHECK(files.at(large, "0.5 0 0") < -0.2);
    CHECK(files.at(large, "1 0 0") == Approx(0).margin(0.01));
    // Both in one scene: each is read, and each is what it is.
    const std::string both = large + " - " + small;
    CHECK(files.at(both, "0.25 0 0") > 0.05);
    CHECK(files.at(both, "0.5 0 0") == Approx(0).margin(0.01));
    CHECK(files.at(both, "0.75 0 0") < -0.05);
    CHECK(files.at(both, "1 0 0") == Approx(0).margin(0.01));
    // A save file says which one.
    files.write("a.sdf", small + "\n");
    const Result saved =
        shell(files, "fathom export a.sdf -o a.yaml && fathom import a.yaml -o b.sdf");
    INFO(saved.err);
    CHECK(saved.exit == 0);
    CHECK(contains(files.read("b.sdf"), "grid: \"density\""));
    CHECK(shell(files, "fathom eval b.sdf 0.6 0.1 0").out ==
          shell(files, "fathom eval a.sdf 0.6 0.1 0").out);
    // A file of another kind has no names.
    files.write("cube.nrrd",
                "NRRD0004\ntype: float\ndimension: 3\nsizes: 2 2 2\nencoding: ascii\n\n"
                "-1 1 1 1 1 1 1 1\n");
    files.refused("distance_grid(\"cube.nrrd\", grid: \"density\")", "leave `grid` out");
}

TEST_CASE("OpenVDB files are read by a program that the shell finds by its name") {
    Files files;
    // What a stranger has put beside the scene is not run.
    files.write("fathom", "not the program\n");
    files.write("fathom-read-vdb", "#!/bin/sh\ntouch met\n");
    files.write("libfathom-vdb.so", "not the module\n");
    REQUIRE(shell(files, "chmod +x fathom-read-vdb").exit == 0);
    files.write("a.sdf", "distance_grid(\"stretched.vdb\")\n");
    const Result made =
        shell(files, "PATH=$(dirname '" FATHOM_PROGRAM "'):$PATH env fathom check a.sdf");
    INFO(made.err);
    CHECK(made.exit == 0);
    CHECK_FALSE(fs::exists(files / "met"));
}

TEST_CASE("a grid of OpenVDB stands where its transform says, or is refused") {
    Files files;
    // 0.1 apart along x and z, 0.2 along y, and 5 higher.
    const std::string stretched = "distance_grid(\"stretched.vdb\")";
    CHECK(files.at(stretched, "0 5 0") < -0.5);
    CHECK(files.at(stretched, "0 7 0") == Approx(0).margin(0.01));
    CHECK(files.at(stretched, "1 5 0") == Approx(0).margin(0.01));
    for (const char *file : {"turned", "mirrored", "perspective"})
        files.refused("distance_grid(\"" + std::string(file) + ".vdb\")",
                      "turned, sheared, mirrored or in perspective");
    files.refused("distance_grid(\"empty.vdb\")", "the grid has no voxels");
    files.refused("distance_grid(\"nan.vdb\")", "a value that is no finite number");
    files.refused("distance_grid(\"tile.vdb\")", "more than 1,073,741,824");
}
#endif
