// `fathom volume` as scripts see it.
#include "shell.h"

#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>

using Json = nlohmann::json;

TEST_CASE("a volume goes out as NRRD, NumPy and OpenVDB, and comes back as a scene") {
    ScratchFolder folder;
    folder.write("ring.sdf", "param r = 1 in 0.5..2\ntorus(r, 0.3)\n");
    const Result made = shell(folder, "fathom volume ring.sdf --voxel 0.1 -o ring.nrrd --json");
    CHECK(made.exit == 0);
    CHECK(made.err.empty());
    const Json json = Json::parse(made.out);
    CHECK((json["side"] == 0.1 && json["band"].is_null() && json["undecided_cells"] == 0));
    CHECK(json["error"].get<double>() <= 0.0501);
    const std::string nrrd = folder.read("ring.nrrd");
    CHECK(nrrd.starts_with("NRRD0004\ntype: float\ndimension: 3\nsizes: "));
    CHECK(shell(folder, "cat ring.sdf | fathom volume - --voxel 0.1 -o -").out == nrrd);
    folder.write("back.sdf", "distance_grid(\"ring.nrrd\")\n");
    const Result at = shell(folder, "fathom eval back.sdf 1 0 0  1.5 0 0  0 0 0");
    REQUIRE(at.exit == 0);
    CHECK(std::stod(at.out) < -0.2); // where it was

    CHECK(shell(folder, "fathom volume ring.sdf --voxel 0.1 -o ring.npy").exit == 0);
    CHECK(folder.read("ring.npy").starts_with("\x93NUMPY"));

    const bool with_vdb = FATHOM_WITH_VDB;
    if (!with_vdb) {
        const Result none = shell(folder, "fathom volume ring.sdf --resolution 24 -o ring.vdb");
        CHECK(none.exit == 3);
        CHECK(contains(none.err, "built without OpenVDB"));
        CHECK_FALSE(fs::exists(folder / "ring.vdb"));
        return;
    }
    const Result vdb = shell(folder, "fathom volume ring.sdf --resolution 24 -o ring.vdb --json");
    INFO(vdb.err);
    CHECK(vdb.exit == 0);
    CHECK(Json::parse(vdb.out)["colors"] == false);
    const std::string bytes = folder.read("ring.vdb");
    CHECK(bytes.starts_with(" BDV"));
    CHECK(contains(bytes, "surface"));
    CHECK_FALSE(contains(bytes, "Cd"));
    CHECK(shell(folder, "fathom volume ring.sdf --resolution 24 -o again.vdb").exit == 0);
    CHECK(folder.read("again.vdb") == bytes);
    folder.write("two.sdf", "sphere(1).paint(#f00) | sphere(1).translate(x: 3).paint(#00f)\n");
    CHECK(shell(folder, "fathom volume two.sdf --resolution 24 -o two.vdb").exit == 0);
    CHECK(contains(folder.read("two.vdb"), "Cd"));
}

TEST_CASE("what has no volume says why, and writes nothing") {
    ScratchFolder folder;
    folder.write("ground.sdf", "plane(Y, 0)\n");
    folder.write("ball.sdf", "sphere(1)\n");
    folder.write("wrong.sdf", "shpere(1)\n");
    const auto fails = [&](const std::string &arguments, int exit, const std::string &words) {
        INFO(arguments);
        const Result made = shell(folder, "fathom volume " + arguments);
        CHECK(made.exit == exit);
        INFO(made.err);
        CHECK(contains(made.err, words));
        CHECK_FALSE(fs::exists(folder / "a.nrrd"));
    };
    fails("ground.sdf -o a.nrrd", 1, "`--bounds X,Y,Z,X,Y,Z`");
    fails("wrong.sdf -o a.nrrd", 1, "unknown-name");
    fails("none.sdf -o a.nrrd", 3, "none.sdf");
    fails("ball.sdf -o a.nrrd --voxel 1e-9", 2, "too fine");
    fails("ball.sdf -o a.nrrd --voxel 0", 2, "above 0");
    fails("ball.sdf -o a.nrrd --voxel 1 --resolution 4", 2, "one of them");
    fails("ball.sdf -o a.nrrd --band 3", 2, "of a .vdb");
    fails("ball.sdf -o a.stl", 2, "`fathom mesh`");
    fails("ball.sdf -o a.txt", 2, ".vdb, .nrrd or .npy");
    fails("ball.sdf -o none/a.nrrd", 3, "none");
    folder.write("steep.sdf", "sphere(1).displace(p => 0.18 * fbm(2.5 * p, octaves: 7))\n");
    const Result steep = shell(folder, "fathom volume steep.sdf --resolution 4 -o s.nrrd --json");
    CHECK(steep.exit == 0);
    CHECK(contains(steep.err, "no error is proved"));
    CHECK(contains(steep.out, "\"error\":null"));
}
