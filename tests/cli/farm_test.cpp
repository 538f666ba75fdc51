// `fathom farm` without an engine: its folder, its units run by hand, killed, and brought to an end;
// stand-ins for the engines' programs tell what they were asked for.
#include "shell.h"

#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>

namespace {

struct Farm : ScratchFolder {
    Farm() {
        fs::create_directories(path() / "lib");
        fs::create_directories(path() / "scenes/parts");
        fs::create_directories(path() / "bin");
        write("scenes/a.sdf", "import \"parts/b.sdf\"\nimport \"c.sdf\"\n"
                              "sphere(r).translate(x: 0.3 * time + s)\nrender(time: 100)\n"
                              "camera(at: [0, 1, 5])\n");
        write("scenes/parts/b.sdf", "let r = 1\n");
        write("lib/c_1.sdf", "let s = 0.1\n");
        fs::create_symlink("c_1.sdf",
                           path() / "lib/c.sdf"); // is copied by the name that is imported
        // Stands for GNU parallel: the units of the list, one after the other.
        program("parallel",
                "#!/bin/sh\nwhile [ \"$1\" != -a ]; do shift; done\nlist=$2\n"
                "for run; do :; done\nwhile read -r unit; do \"$run\" \"$unit\" </dev/null; "
                "done <\"$list\"\n");
        // Stands for Slurm: it runs nothing, and notes what it was asked.
        program("sleep", "#!/bin/sh\n"); // what waits before it tries again does so at once
        program("sbatch", "#!/bin/sh\necho \"$@\" >>sbatch.log\nwc -l <sbatch.log\n");
    }
    void program(const std::string &name, const std::string &text) const {
        write("bin/" + name, text);
        fs::permissions(*this / ("bin/" + name), fs::perms::owner_all);
    }
    Result run(const std::string &words) const {
        return shell(*this, "PATH=\"$PWD/bin:$PATH\"; " + words);
    }
    Result farm(const std::string &words) const { return run("fathom farm " + words); }
    std::string whole(const std::string &words) const {
        CHECK(run("fathom render scenes/a.sdf -I lib --backend cpu -o whole_####.png " + words)
                  .exit == 0);
        return read("whole_0004.png");
    }
};

const std::string job_film = "scenes/a.sdf -I lib --size 24x18 --frames 0..10 --fps 5 ";

} // namespace

TEST_CASE("a job folder holds all that its units need") {
    const Farm folder;
    const Result made = folder.farm("parallel " + job_film + "--out job --chunk 4 --dry-run");
    INFO(made.err);
    REQUIRE(made.exit == 0);
    CHECK(contains(made.out, "--only 0..=3"));
    CHECK(contains(made.out, "--only 8..=9"));
    CHECK(contains(made.out, "parallel"));
    const auto manifest = nlohmann::json::parse(folder.read("job/manifest.json"));
    CHECK(manifest["units"] == 3);
    CHECK(contains(folder.farm("status job").out,
                   "0 of 3 units are done, 0 at work, 0 failed, 3 missing"));
    // The scene is there: what it was made of may go.
    for (const char *gone : {"scenes", "lib"})
        fs::rename(folder / gone, folder / (std::string("was_") + gone));
    CHECK(folder.run("cd job && ./run 1").exit == 0);
    CHECK(contains(folder.farm("status job").out, "1 of 3 units are done"));
    CHECK(folder.farm("collect job").exit == 0);
    CHECK(contains(folder.farm("status job").out, "3 of 3 units are done"));
    for (const char *gone : {"scenes", "lib"})
        fs::rename(folder / (std::string("was_") + gone), folder / gone);
    CHECK(folder.whole("--size 24x18 --frames 0..10 --fps 5") ==
          folder.read("job/frames/frame_0004.png"));
    const Result again = folder.farm("parallel " + job_film + "--out job --chunk 4");
    CHECK(again.exit == 2);
    CHECK(contains(again.err, "collect job"));
}

TEST_CASE("units that are killed, lost or cut short are made again, and no others") {
    const Farm folder;
    REQUIRE(folder.farm("parallel " + job_film + "--out job --chunk 2 --dry-run").exit == 0);
    CHECK(folder.run("for i in 0 1 2; do job/run $i; done").exit == 0);
    folder.write("job/frames/frame_0001.png", "cut short");
    fs::remove(folder / "job/frames/frame_0004.png");
    const std::string kept = folder.read("job/frames/frame_0005.png");
    CHECK(contains(folder.farm("status job").out,
                   "1 of 5 units are done, 0 at work, 0 failed, 4 missing"));
    // A worker that is killed in the middle of a unit: its frames so far are whole, its lock is free.
    folder.program("killed", "#!/bin/sh\n'" FATHOM_PROGRAM "' \"$@\" --only 6; kill -9 $PPID\n");
    CHECK(folder.run("FATHOM=\"$PWD/bin/killed\" job/run 3").exit != 0);
    CHECK(contains(folder.farm("status job").out, "unit 3: missing"));
    CHECK(folder.farm("collect job").exit == 0);
    CHECK(contains(folder.farm("status job").out, "5 of 5 units are done"));
    std::size_t made = 0;
    for (int unit = 0; unit < 5; ++unit) {
        const std::string log = folder.read("job/logs/" + std::to_string(unit));
        for (std::size_t at = log.find("\"made\""); at != log.npos;
             at = log.find("\"made\"", at + 1))
            ++made;
    }
    CHECK(made == 10 + 2); // those that were broken, and none twice besides
    CHECK(folder.read("job/frames/frame_0005.png") == kept);
    CHECK(folder.whole("--size 24x18 --frames 0..10 --fps 5") ==
          folder.read("job/frames/frame_0004.png"));
}

TEST_CASE("a unit is tried again where that may help, and not where it cannot") {
    const Farm folder;
    REQUIRE(folder.farm("parallel " + job_film + "--out job --chunk 5 --dry-run").exit == 0);
    folder.program("once", "#!/bin/sh\n[ -e tried ] || { touch tried; exit 3; }\n'" FATHOM_PROGRAM
                           "' \"$@\"\n");
    CHECK(folder.run("FATHOM=\"$PWD/bin/once\" job/run 0").exit == 0);
    CHECK(contains(folder.read("job/state/0"), "end 3\nbegin"));
    folder.program("wrong", "#!/bin/sh\nexit 1\n");
    CHECK(folder.run("FATHOM=\"$PWD/bin/wrong\" job/run 1").exit == 1);
    CHECK(contains(folder.farm("status job").out, "unit 1: failed, frames 5..=9, status 1"));
    CHECK(folder.farm("collect job").exit == 3);
    CHECK_FALSE(contains(folder.read("job/state/1"), "end 0"));
    fs::remove(folder / "job/state/1"); // what was wrong is mended
    CHECK(folder.farm("collect job").exit == 0);
}

TEST_CASE("a unit is made by one process at a time; another one waits or leaves it") {
    const Farm folder;
    REQUIRE(folder.farm("parallel " + job_film + "--out job --chunk 10 --dry-run").exit == 0);
    const Result held =
        folder.run("exec 8>>job/state/0.lock; flock 8; job/run 0; echo $?; "
                   "fathom farm status job; "
                   "{ FATHOM_FARM_WAIT=1 job/run 0; } 8>&- & exec 8>&-; wait $!; echo $?");
    CHECK(held.out.starts_with("75\n"));
    CHECK(contains(held.out, "unit 0: at work"));
    CHECK(held.out.ends_with("0\n"));
    CHECK(contains(folder.farm("status job").out, "1 of 1 units are done"));
}

TEST_CASE("a controller ends where its engine was ended, and says so") {
    const Farm folder;
    folder.program("parallel", "#!/bin/sh\necho round >>rounds\nexit 255\n");
    const Result ended = folder.farm("parallel " + job_film + "--out job --chunk 5");
    CHECK(ended.exit == 3);
    CHECK(contains(ended.err, "parallel ended with 255"));
    CHECK(folder.read("rounds") == "round\n");
    // One that comes to nothing is not run for ever.
    folder.program("parallel", "#!/bin/sh\necho round >>rounds\n");
    CHECK(folder.farm("collect job").exit == 3);
    CHECK(folder.read("rounds").size() < 6 * 6);
    fs::remove(folder / "bin/parallel");
    const Result none = shell(folder, "PATH=/nowhere; fathom farm collect job");
    CHECK(none.exit == 3);
    CHECK(contains(none.err, "GNU parallel"));
}

TEST_CASE("tiles of frames are joined to the frames that one process makes") {
    const Farm folder;
    const Result made = folder.farm("parallel " + job_film + "--out job --chunk 5 --tiles 3");
    INFO(made.err);
    CHECK(made.exit == 0);
    CHECK(folder.whole("--size 24x18 --frames 0..10 --fps 5") ==
          folder.read("job/frames/frame_0004.png"));
    // One large picture
    CHECK(
        folder.farm("parallel scenes/a.sdf -I lib --size 30x40 --samples 2 --out poster --tiles 5")
            .exit == 0);
    CHECK(
        folder
            .run(
                "fathom render scenes/a.sdf -I lib --size 30x40 --samples 2 --backend cpu -o p.png")
            .exit == 0);
    CHECK(folder.read("poster/frames/picture.png") == folder.read("p.png"));
}

TEST_CASE("Slurm gets arrays in blocks of a thousand, and a job that joins them") {
    const Farm folder;
    const Result made =
        folder.farm("slurm scenes/a.sdf -I lib --size 4x4 --frames 0..2500 --out job "
                    "--chunk 1 -- --partition=night --time=10");
    INFO(made.err);
    REQUIRE(made.exit == 0);
    const std::string log = folder.read("sbatch.log");
    CHECK(contains(log, "FATHOM_FIRST=0 --array=0-999 --partition=night --time=10"));
    CHECK(contains(log, "FATHOM_FIRST=1000 --array=0-999 "));
    CHECK(contains(log, "FATHOM_FIRST=2000 --array=0-499 "));
    CHECK(contains(log, "--dependency=afterany:1:2:3 "));
    // As Slurm would: a task of the second array.
    CHECK(folder.run("FATHOM_FIRST=1000 SLURM_ARRAY_TASK_ID=7 job/array.sbatch").exit == 0);
    CHECK(fs::exists(folder / "job/frames/frame_1007.png"));
    fs::remove(folder / "sbatch.log");
    CHECK(folder.farm("collect job").exit == 0);
    CHECK(contains(folder.read("sbatch.log"), "FATHOM_FIRST=1000 --array=0-6,8-999 "));
}

TEST_CASE("a farm says what it cannot do before it makes a folder") {
    const Farm folder;
    const auto refused = [&](const std::string &words, int status, const std::string &why) {
        INFO(words);
        const Result result = folder.farm(words);
        CHECK(result.exit == status);
        CHECK_THAT(result.err, Catch::Contains(why));
        CHECK_FALSE(fs::exists(folder / "job/manifest.json"));
    };
    refused("parallel " + job_film, 2, "--out");
    refused("parallel - --frames 0..3 --out job", 2, "standard input");
    refused("parallel " + job_film + "--out job --tiles 19", 2, "has 18");
    refused("parallel " + job_film + "--out job --tiles 2 --backend gl", 2, "--backend cpu");
    refused("parallel scenes/none.sdf --frames 0..3 --out job", 3, "none.sdf");
    refused("parallel " + job_film + "--out job --film a.png", 2, ".mp4");
    refused("parallel " + job_film + "--out 'job {}'", 2, "without { }");
    refused("slurm " + job_film + "--out 'job %j'", 2, "without %");
    refused("parallel " + job_film + "--out job -D nothing=1", 2, "nothing");
    refused("night " + job_film + "--out job", 2, "night");
    refused("status job", 3, "no job folder");
    refused("collect " + std::string("job --tiles 2"), 2, "--tiles");
}

TEST_CASE("a folder's name may have what a shell reads otherwise") {
    const Farm folder;
    const std::string name = "'a job; $x \"%j\"'";
    const Result made = folder.farm("parallel " + job_film + "--out " + name + " --chunk 5 && cd " +
                                    name + " && ls frames | wc -l");
    INFO(made.err);
    CHECK(made.exit == 0);
    CHECK(contains(made.out, "10\n"));
}

TEST_CASE("a manifest that farm did not write is refused, with the entry that is wrong") {
    const Farm folder;
    REQUIRE(folder.farm("parallel " + job_film + "--out job --chunk 4 --dry-run").exit == 0);
    const auto manifest = nlohmann::json::parse(folder.read("job/manifest.json"));
    const auto refused = [&](const char *entry, const nlohmann::json &value) {
        INFO(entry << ": " << value.dump());
        auto other = manifest;
        other[entry] = value;
        folder.write("job/manifest.json", other.dump());
        for (const char *action : {"status", "collect"}) {
            const Result result = folder.farm(std::string(action) + " job");
            CHECK(result.exit == 3);
            CHECK_THAT(result.err, Catch::Contains(entry) || Catch::Contains("type must be"));
        }
    };
    refused("tiles", 2147483647);
    refused("tiles", 0);
    refused("chunk", 0);
    refused("chunk", 1e99);
    refused("frames", "");
    refused("frames", "-5..3");
    refused("frames", "0..4294967296");
    refused("frames", nlohmann::json::array({1}));
    refused("size", "2000000000x2000000000");
    refused("samples", -7);
    refused("fps", -1);
    refused("fps", nullptr);
    refused("film", "../a.mp4");
    refused("film", "/a.mp4");
    refused("film", "a.png");
    std::string many = "0..1000001";
    for (int i = 0; i < 1000; ++i) many += ",0..1000001";
    refused("frames", many);
    for (const char *text : {"", "[", "{}", "7"}) {
        folder.write("job/manifest.json", text);
        CHECK(folder.farm("status job").exit == 3);
    }
    // What no process can wait for is not waited for.
    folder.write("job/manifest.json", manifest.dump());
    CHECK(folder.run("mkfifo job/state/0.lock job/state/1 job/frames/frame_0009.png").exit == 0);
    CHECK(contains(folder.farm("status job").out, "3 missing"));
}
