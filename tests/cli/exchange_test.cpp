// `fathom import` and `fathom export` as scripts see them: exit statuses, what --strict and
// --partial do, what is left behind, and files that mean harm. Save files are opened by the other
// commands too.
#include "base/picture.h"
#include "shell.h"
#include "tests/support/effort.h"

#include <catch2/catch.hpp>

#include <fmt/format.h>
#include <fstream>

namespace {

const char *const good = "- 0.3\n- {}\n- []\n- [Generic, Distance field, {Children: [[Sphere, "
                         "Sphere 1, {Radius: 0.5}]]}]\n"
                         "- [LightingNode, Lighting, {}]\n- 100\n";
const char *const odd = "- 0.3\n- {}\n- []\n- [Generic, Distance field, {Children: [[Spheer, s, "
                        "{}], [Sphere, Sphere 1, {Radius: 0.5}]]}]\n";
const char *const broken = "- 0.3\n- {}\n- []\n- [Generic, Distance field, {Children: [[Sphere, "
                           "Sphere 1, {Radius: 0.5}], [Box, b, {Size\n";

struct SaveFiles : ScratchFolder {
    SaveFiles() {
        write("good.yaml", good);
        write("odd.yaml", odd);
        write("broken.yaml", broken);
        write("empty.yaml", "");
        write("mapping.yaml", "Version: 0.3\n");
        write("latin.yaml",
              "- 0.3\n- {}\n- []\n- [Generic, r, {Children: [[Sphere, \"\xe4\", {}]]}]\n");
        write("tab.yaml", "- 0.3\n- {}\n- []\n-\t- Generic\n");
    }
};

} // namespace

TEST_CASE("an import's exit status tells how much was understood") {
    SaveFiles folder;
    CHECK(shell(folder, "fathom import good.yaml -o a.sdf").exit == 0);
    CHECK(shell(folder, "fathom check a.sdf").exit == 0);
    CHECK(shell(folder, "fathom import nothing.yaml -o b.sdf").exit == 3);
    CHECK(shell(folder, "fathom import").exit == 2);
    CHECK(shell(folder, "fathom import good.yaml -o none/a.sdf").exit == 3);

    Result warned = shell(folder, "fathom import odd.yaml -o odd.sdf");
    CHECK(warned.exit == 0);
    CHECK(
        contains(warned.err, "odd.yaml:4:42: warning[yaml-value]: there is no node type `Spheer`"));
    CHECK(contains(warned.err, "did you mean `Sphere`?"));
    CHECK(contains(folder.read("odd.sdf"), "sphere(0.5)"));

    for (const char *name : {"broken", "empty", "mapping", "latin", "tab"}) {
        INFO(name);
        Result result =
            shell(folder, std::string("fathom import ") + name + ".yaml -o " + name + ".sdf");
        CHECK(result.exit == 1);
        CHECK(contains(result.err, std::string(name) + ".yaml:"));
        CHECK(contains(result.err, "error[yaml-structure]"));
        CHECK(contains(result.err, "--partial"));
        CHECK(!std::filesystem::exists(folder / (std::string(name) + ".sdf")));
    }
}

TEST_CASE(
    "--strict takes nothing that is not understood; --partial takes what came before the break") {
    SaveFiles folder;
    Result strict = shell(folder, "fathom import --strict odd.yaml -o odd.sdf");
    CHECK(strict.exit == 1);
    CHECK(contains(strict.err, "error[yaml-value]: there is no node type `Spheer`"));
    CHECK(!std::filesystem::exists(folder / "odd.sdf"));
    CHECK(shell(folder, "fathom import --strict good.yaml -o a.sdf").exit == 0);
    CHECK(shell(folder, "fathom import --strict --partial odd.yaml -o odd.sdf").exit ==
          1); // not broken: only not understood
    CHECK(!std::filesystem::exists(folder / "odd.sdf"));

    CHECK(shell(folder, "fathom import --partial broken.yaml -o part.sdf").exit == 1);
    CHECK(contains(folder.read("part.sdf"), "sphere(0.5)"));
    CHECK(shell(folder, "fathom check part.sdf").exit == 0);
}

TEST_CASE("a failed import or export leaves the old file, and nothing half-written") {
    SaveFiles folder;
    folder.write("old.sdf", "sphere(3)\n");
    folder.write("old.yaml", "old\n");
    folder.write("wrong.sdf", "spere(1)\n");
    CHECK(shell(folder, "fathom import broken.yaml -o old.sdf").exit == 1);
    CHECK(folder.read("old.sdf") == "sphere(3)\n");
    CHECK(shell(folder, "fathom export wrong.sdf -o old.yaml").exit == 1);
    CHECK(folder.read("old.yaml") == "old\n");
    folder.write("long.yaml", std::string(good).replace(std::string(good).find("Sphere 1"), 8,
                                                        std::string(70000, 'x')));
    CHECK(shell(folder, "trap '' XFSZ; (ulimit -f 8; exec '" FATHOM_PROGRAM
                        "' import long.yaml -o old.sdf)")
              .exit == 3); // a full disk
    CHECK(folder.read("old.sdf") == "sphere(3)\n");
    for (const auto &entry : std::filesystem::directory_iterator(folder.path())) {
        const std::string name = entry.path().filename().string();
        CHECK((name.ends_with(".yaml") || name.ends_with(".sdf")));
    }
}

TEST_CASE("what an export cannot say is a warning") {
    SaveFiles folder;
    folder.write("loop.sdf", "implicit(p => { var d = 0.0\n for i in 0..5000 { d += 0.0001 * "
                             "sin(p.x + i) }\n length(p) - 1 + 0.01 * d }, lipschitz: 2)\n"
                             "sphere(1)\n");
    Result result = shell(folder, "fathom export loop.sdf -o loop.yaml");
    CHECK(result.exit == 0);
    CHECK(contains(result.err, "loop.sdf:1:1: warning[unsupported]: the save format has no words "
                               "for this function of the point"));
    CHECK(contains(folder.read("loop.yaml"), "Sphere 1"));
}

TEST_CASE("a target without images says which shape reads one, and what to take") {
    ScratchFolder folder;
    folder.write("a.png", fathom::encode_png({1, 1, {10, 20, 30, 255}}));
    folder.write("a.sdf", "box(1)\nlet im = image(\"a.png\")\n"
                          "sphere(1).paint(p => im(p.xz).rgb).translate(x: 2)\n");
    for (const char *target : {"shadertoy", "glslviewer"}) {
        const Result made =
            shell(folder, std::string("fathom compile a.sdf --target ") + target + " -o a.frag");
        CHECK(made.exit == 1);
        CHECK(contains(made.err, "a.sdf:3:1: error[unsupported]: images and grids cannot be put "
                                 "into a text for `" +
                                     std::string(target) + "`"));
        CHECK(contains(made.err, "sphere(1).paint(p => im(p.xz).rgb)"));
        CHECK(contains(made.err, "`glsl450`, `glsl330`, `es300`"));
    }
}

TEST_CASE("an export into another folder finds the scene's files again") {
    ScratchFolder folder;
    const std::vector<std::uint8_t> shades{0,   0,   0,   255, 255, 255, 255, 255,
                                           128, 128, 128, 255, 30,  30,  30,  255};
    folder.write("scenes/img/a.png", fathom::encode_png({2, 2, shades}));
    folder.write("scenes/a.sdf", "import \"img/b.sdf\" as b\n"
                                 "sphere(1).displace_map(image(\"img/a.png\"), 0.2)\nb.two()\n");
    // one that another file names, as it sees it
    folder.write("scenes/img/b.sdf",
                 "fn two() = sphere(1).displace_map(image(\"a.png\"), 0.3).translate(x: 4)\n");
    const char *const points = " --at 1.2,0.3,0.1 --at 4.5,1,0.7";
    const Result scene = shell(folder, std::string("fathom eval scenes/a.sdf") + points);
    REQUIRE(scene.exit == 0);
    Result made = shell(folder, "fathom export scenes/a.sdf -o a.yaml");
    CHECK(made.exit == 0);
    CHECK_FALSE(contains(made.err, "does not lie"));
    CHECK(contains(folder.read("a.yaml"), "scenes/img/a.png"));
    CHECK_FALSE(contains(folder.read("a.yaml"), folder.path().string()));
    CHECK(shell(folder, std::string("fathom eval a.yaml") + points).out == scene.out);
    // beside it a reader has to be allowed to look
    folder.write("other/x", "");
    made = shell(folder, "fathom export scenes/a.sdf -o other/a.yaml");
    CHECK(made.exit == 0);
    CHECK(contains(made.err, "`../scenes/img/a.png` does not lie in the save file's folder"));
    CHECK(shell(folder, std::string("fathom eval other/a.yaml -I .") + points).out == scene.out);
}

TEST_CASE("save files are scenes to all commands, and pass through a pipe") {
    SaveFiles folder;
    CHECK(shell(folder, "fathom check good.yaml").exit == 0);
    CHECK(shell(folder, "fathom eval good.yaml --at 2,0,0").out.substr(0, 3) == "1.5");
    CHECK(shell(folder, "fathom check broken.yaml").exit == 1);
    Result odd = shell(folder, "fathom check odd.yaml");
    CHECK(odd.exit == 0);
    CHECK(contains(odd.err, "odd.yaml:4:42: warning[yaml-value]"));
    CHECK(shell(folder, "fathom export good.yaml -o again.yaml").exit == 0);
    CHECK(contains(folder.read("again.yaml"), "Radius: 0.5"));
    Result piped = shell(
        folder,
        "cat good.yaml | fathom import - | fathom export - | fathom import - | fathom check -");
    CHECK(piped.exit == 0);
}

TEST_CASE("a large file is imported in bounded memory") {
    const int megabytes = fathom::test::effort(25);
    ScratchFolder folder;
    {
        std::ofstream out(folder / "big.yaml");
        out << "- 0.3\n- {}\n- []\n- - Generic\n  - Distance field\n  - Children:\n";
        std::string block;
        for (int i = 0; block.size() < 1000000; ++i)
            block += fmt::format("    - [Sphere, a sphere with a name that is long enough, "
                                 "{{Radius: 0.{}, Offset: {{X: 0, Y: 0}}}}]\n",
                                 i % 9 + 1);
        for (int i = 0; i < megabytes; ++i) out << block;
    }
    CHECK(std::filesystem::file_size(folder / "big.yaml") > std::uintmax_t(megabytes) * 1'000'000);
    // Of 100 MB: 2 GB of addresses; 0.6 GB are used.
    CHECK(shell(folder, fmt::format("ulimit -v {}; fathom import big.yaml -o big.sdf",
                                    200'000 + 18'000 * megabytes))
              .exit == 0);
    CHECK(std::filesystem::file_size(folder / "big.sdf") > std::uintmax_t(megabytes) * 500'000);
}
