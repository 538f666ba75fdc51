// `fathom volume` as scripts see it.
#include "shell.h"
#include "tests/support/decoded.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>

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
        CHECK(contains(none.err, "without OpenVDB"));
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
    CHECK_FALSE(contains(bytes, std::string("\x02\0\0\0Cd", 6))); // a grid's name
    CHECK(shell(folder, "fathom volume ring.sdf --resolution 24 -o again.vdb").exit == 0);
    CHECK(folder.read("again.vdb") == bytes);
    folder.write("two.sdf", "sphere(1).paint(#f00) | sphere(1).translate(x: 3).paint(#00f)\n");
    CHECK(shell(folder, "fathom volume two.sdf --resolution 24 -o two.vdb").exit == 0);
    CHECK(contains(folder.read("two.vdb"), "Cd"));
}

// Numbers that the program printed.
static std::vector<double> numbers_in(const std::string &text) {
    std::istringstream in(text);
    return {std::istream_iterator<double>(in), {}};
}

TEST_CASE("a level set of OpenVDB comes back as the solid that it was made of") {
    ScratchFolder folder;
    folder.write("ring.sdf", "torus(1, 0.3).rotate(90deg, axis: X).translate(x: 3)\n");
    folder.write("back.sdf", "distance_grid(\"ring.vdb\")\n");
    folder.write("junk.vdb", std::string(" BDV\0\0\0\0", 8) + "and no more");
    folder.write("junk.sdf", "distance_grid(\"junk.vdb\")\n");
    const bool with_vdb = FATHOM_WITH_VDB;
    if (!with_vdb) {
        const Result none = shell(folder, "fathom check junk.sdf");
        CHECK(none.exit == 1);
        CHECK(contains(none.err, "without OpenVDB"));
        return;
    }
    REQUIRE(shell(folder, "fathom volume ring.sdf --voxel 0.05 -o ring.vdb").exit == 0);
    CHECK(shell(folder, "fathom check back.sdf").exit == 0);
    // In the band both are the distance, but for the sampling; beyond it the level set is cut off.
    const std::string points = " 4 0 0.2  4.35 0 0  2.7 0.7 0.1  3 1.3 0.1  3 -0.72 0.02";
    const auto was = numbers_in(shell(folder, "fathom eval ring.sdf" + points).out);
    const auto is = numbers_in(shell(folder, "fathom eval back.sdf" + points).out);
    REQUIRE((was.size() >= 5 && is.size() == was.size()));
    const std::size_t columns = was.size() / 5; // the value is the first of them
    for (std::size_t i = 0; i < was.size(); i += columns)
        CHECK(is[i] == Approx(was[i]).margin(0.02));
    // The pictures frame the solid alike: few pixels differ.
    const std::string size = " --size 96x72 -o ";
    REQUIRE(shell(folder, "fathom render ring.sdf" + size + "ring.png").exit == 0);
    REQUIRE(shell(folder, "fathom render back.sdf" + size + "back.png").exit == 0);
    std::string error;
    const auto a = fathom::test::decoded_image(folder.read("ring.png"), error);
    const auto b = fathom::test::decoded_image(folder.read("back.png"), error);
    REQUIRE((a && b && a->rgba.size() == b->rgba.size()));
    std::size_t differ = 0, drawn = 0;
    // The first and last columns and rows that hold some of it.
    std::array<std::array<std::size_t, 4>, 2> sides{{{96, 0, 72, 0}, {96, 0, 72, 0}}};
    for (std::size_t k = 0; k < a->rgba.size(); k += 4) {
        differ += std::abs(a->rgba[k] - b->rgba[k]) > 0.1f;
        drawn += std::abs(a->rgba[k] - a->rgba[0]) > 0.1f;
        const std::size_t x = k / 4 % 96, y = k / 4 / 96;
        for (std::size_t which : {0u, 1u}) {
            const std::vector<float> &rgba = which == 0 ? a->rgba : b->rgba;
            if (!(std::abs(rgba[k] - rgba[0]) > 0.1f)) continue;
            auto &[left, right, top, bottom] = sides[which];
            left = std::min(left, x), right = std::max(right, x);
            top = std::min(top, y), bottom = std::max(bottom, y);
        }
    }
    for (std::size_t side = 0; side < 4; ++side)
        CHECK(double(sides[0][side]) == Approx(double(sides[1][side])).margin(2));
    CHECK(drawn > 500);  // of 6,912
    CHECK(differ < 600); // a pixel along the outlines

    const auto refused = [&](const std::string &scene, const std::string &words) {
        const Result made = shell(folder, "fathom check " + scene);
        INFO(made.err);
        CHECK(made.exit == 1);
        CHECK(contains(made.err, words));
    };
    refused("junk.sdf", "OpenVDB: ");
    const std::string whole = folder.read("ring.vdb");
    folder.write("junk.vdb", whole.substr(0, whole.size() / 2));
    refused("junk.sdf", "the file ends too early, or is broken");
    // A byte of the head, each in turn: whatever OpenVDB makes of it, the program answers.
    for (std::size_t i = 8; i < 700; i += 29) {
        std::string broken = whole;
        broken[i] = static_cast<char>(broken[i] ^ 0x7f);
        folder.write("junk.vdb", broken);
        const Result made = shell(folder, "fathom check junk.sdf");
        INFO("byte " << i << ": " << made.err);
        CHECK((made.exit == 0 || made.exit == 1));
    }
    // Two small balls far apart: few voxels, and a box that no memory holds.
    folder.write("far.sdf", "sphere(0.2) | sphere(0.2).translate([60, 60, 60])\n");
    REQUIRE(shell(folder, "fathom volume far.sdf --voxel 0.06 -o junk.vdb --certify off").exit ==
            0);
    refused("junk.sdf", "memory-limit");
    refused("junk.sdf", "--limit memory=");
}

// The floats at the end of a file.
static std::vector<float> floats_at_end(const std::string &bytes, std::size_t count) {
    std::vector<float> out(count);
    REQUIRE(bytes.size() > count * sizeof(float));
    std::memcpy(out.data(), bytes.data() + bytes.size() - count * sizeof(float),
                count * sizeof(float));
    return out;
}

TEST_CASE("a volume holds what another function of the scene gives") {
    ScratchFolder folder;
    folder.write("cloud.sdf", "param thick = 2 in 0..4\n"
                              "fn density(p) = max(0, 1 - length(p)) * thick\n"
                              "fn tint(p) = vec3(p.x, 0.5, time)\nsphere(1)\n");
    const std::string about = " --bounds -1,-2,-1,1,2,1 --voxel 1 ";
    const Result made =
        shell(folder, "fathom volume cloud.sdf --field density --json -o d.nrrd" + about);
    INFO(made.err);
    REQUIRE(made.exit == 0);
    CHECK_FALSE(contains(made.err, "thick")); // it is read
    const Json json = Json::parse(made.out);
    CHECK((json["counts"] == Json{3, 5, 3} && json["components"] == 1 && json["voxels"] == 45));
    const std::vector<float> density = floats_at_end(folder.read("d.nrrd"), 45);
    for (std::size_t k = 0; k < density.size(); ++k) CHECK(density[k] == (k == 22 ? 2.0f : 0.0f));

    CHECK(shell(folder, "fathom volume cloud.sdf --field tint --time 3 -o t.npy" + about).exit ==
          0);
    const std::string tints = folder.read("t.npy");
    CHECK(contains(tints, "'shape': (3, 3, 5, 3)"));
    const std::vector<float> tint = floats_at_end(tints, 135);
    for (std::size_t k = 0; k < tint.size(); k += 3) {
        CHECK(tint[k] == float(k / 3 % 3) - 1);
        CHECK((tint[k + 1] == 0.5f && tint[k + 2] == 3.0f));
    }

    folder.write("none.sdf", "fn glow(p) = p.y\n"); // no solid, so only where bounds are given
    const std::string written = "fathom volume none.sdf --field 'p => glow(p) + 1' -o g.nrrd";
    CHECK(shell(folder, written + about).exit == 0);
    CHECK(floats_at_end(folder.read("g.nrrd"), 45)[0] == -1.0f);
    CHECK(shell(folder, written).exit == 1);
    const auto fails = [&](const std::string &arguments, int exit, const std::string &words) {
        const Result wrong = shell(folder, "fathom volume cloud.sdf -o w.nrrd " + arguments);
        INFO(wrong.err);
        CHECK(wrong.exit == exit);
        CHECK(contains(wrong.err, words));
        CHECK_FALSE(fs::exists(folder / "w.nrrd"));
    };
    fails("--field densty", 1, "did you mean `density`?");
    fails("--field 'sphere(1)'", 1, "gives a float or a vec3");
    fails("--field 'p => vec2(p.x, 1)'", 1, "gives a float or a vec3");
    fails("--field 'let a = 1'", 1, "no function of the point");
    fails("--field '('", 1, "--field:1:1");
    fails("--field density --certify off", 2, "--certify is of distances");
    fails("--field density --field tint", 2, "several fields are of a .vdb");
    if (!FATHOM_WITH_VDB) return;
    CHECK(shell(folder, "fathom volume cloud.sdf --field density --resolution 8 -o d.vdb").exit ==
          0);
    folder.write("back.sdf",
                 "distance_grid(\"d.vdb\", grid: \"density\", isovalue: 1, above: true)\n");
    const Result at = shell(folder, "fathom eval back.sdf 0 0 0  0.9 0 0");
    REQUIRE(at.exit == 0);
    const std::vector<double> found = numbers_in(at.out);
    REQUIRE(found.size() == 8);
    CHECK((found[0] < 0 && found[4] > 0));

    const Result several =
        shell(folder, "fathom volume cloud.sdf --field density --field tint --field 'p => p.x' "
                      "--field 'p => 2 * p.x' --json -o all.vdb" +
                          about);
    INFO(several.err);
    REQUIRE(several.exit == 0);
    const Json grids = Json::parse(several.out)["grids"];
    REQUIRE(grids.size() == 4);
    const std::pair<const char *, int> expected[] = {
        {"density", 1}, {"tint", 3}, {"density_2", 1}, {"density_3", 1}};
    for (std::size_t k = 0; k < 4; ++k)
        CHECK((grids[k]["name"] == expected[k].first &&
               grids[k]["components"] == expected[k].second));
    folder.write("twice.sdf",
                 "distance_grid(\"all.vdb\", grid: \"density_3\", isovalue: 1, above: true)\n");
    const Result twice = shell(folder, "fathom eval twice.sdf 1 0 0  -1 0 0");
    REQUIRE(twice.exit == 0);
    const std::vector<double> sides = numbers_in(twice.out); // 2 and -2, less 1, of a voxel's side
    REQUIRE(sides.size() == 8);
    CHECK((sides[0] < 0 && sides[4] > 0));
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
