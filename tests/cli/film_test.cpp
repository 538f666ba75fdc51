// Films and their parts: frames, what moves over them, tiles, ranges of samples and what joins them.
// All by the CPU, which gives the same bytes for any division.
#include "film_scenes.h"

#include "base/picture.h"

#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>

#include <sstream>

namespace {

std::string frames_there(const ScratchFolder &folder) {
    std::string all;
    for (int i = 0; i < 40; ++i) {
        char name[32];
        std::snprintf(name, sizeof name, "f%02d.png", i);
        if (fs::exists(folder / name)) all += (all.empty() ? "" : " ") + std::to_string(i);
    }
    return all;
}

std::vector<nlohmann::json> events(const std::string &lines) {
    std::vector<nlohmann::json> all;
    std::istringstream in(lines);
    for (std::string line; std::getline(in, line);)
        if (line.starts_with("{")) all.push_back(nlohmann::json::parse(line));
    return all;
}

} // namespace

TEST_CASE("frames are ranges with steps, single ones, and lists of both") {
    const std::pair<const char *, const char *> lists[] = {{"0..3", "0 1 2"},
                                                           {"0..=3", "0 1 2 3"},
                                                           {"0..=8:3", "0 3 6"},
                                                           {"0..9:3", "0 3 6"},
                                                           {"0..=9:3", "0 3 6 9"},
                                                           {"7", "7"},
                                                           {"9,0..2,5..=6", "0 1 5 6 9"}};
    for (const auto &[word, made] : lists) {
        INFO(word);
        const FilmScenes folder;
        CHECK(folder.render("--size 4x4 -o f##.png --frames " + std::string(word)).exit == 0);
        CHECK(frames_there(folder) == made);
    }
    const FilmScenes folder;
    for (const char *word : {"3..3", "1..0", "-1..2", "0..4:0", "0..4:", "0.5..2", "1,", ",1", "a",
                             "0..3,2", "0..2000000", ""}) {
        INFO(word);
        const Result refused =
            folder.render("--size 4x4 -o f##.png --frames '" + std::string(word) + "'");
        CHECK(refused.exit == 2);
    }
    CHECK(frames_there(folder).empty());
}

TEST_CASE("a frame is the same however the film is divided") {
    const FilmScenes folder;
    // What is proved hangs on all of the film's times: also for one of its frames.
    const std::string film = sized + "--frames 0..=6:2 --fps 3 --sweep size=0.6..1.4 -o ";
    CHECK(folder.render(film + "w##.png").exit == 0);
    CHECK(folder.render(film + "p##.png --only 2").exit == 0);
    CHECK(folder.render(film + "p##.png --only 4..=6:2 --jobs 1").exit == 0);
    CHECK_FALSE(fs::exists(folder / "p00.png"));
    for (const char *number : {"02", "04", "06"}) {
        INFO(number);
        const std::string whole = folder.read("w" + std::string(number) + ".png");
        CHECK(whole.starts_with("\x89PNG"));
        CHECK(folder.read("p" + std::string(number) + ".png") == whole);
    }
    const Result none = folder.render(film + "p##.png --only 3");
    CHECK(none.exit == 2);
    CHECK(contains(none.err, "no frame 3"));
}

TEST_CASE("a swept param has its ends' values at the film's first frame and at or after its last") {
    const FilmScenes folder;
    const auto pixels = [&](const std::string &words) {
        CHECK(folder.render(sized + "-o a.png " + words).exit == 0);
        const std::string file = words.find("--frames") != words.npos ? "a_0004.png" : "a.png";
        return fathom::decode_png(folder.read(file))->rgba;
    };
    // The time stands still: a rate of 1000 frames a second would move it by less than a float shows.
    const std::string film = "--frames 0..=4:2 --fps 1000 --time 1 --only 4 ";
    const auto at = [&](const std::string &value) { return pixels(film + "-D size=" + value); };
    CHECK(pixels(film + "--sweep size=1..=1.8") == at("1.8"));
    CHECK(pixels(film + "--sweep size=1..1.5") == at("1.4")); // of 5 steps, the 4th
    CHECK(pixels(film + "--sweep size=1..=1.8") != at("1"));
    CHECK(pixels(film + "--sweep count=1..=5") == pixels(film + "-D count=5")); // it decides shapes
    const Result wrong = folder.render(sized + "-o a.png --frames 0..3 --sweep size=1..5");
    CHECK(wrong.exit == 2);
    CHECK(contains(wrong.err, "size"));
    CHECK(folder.render(sized + "-o a.png --frames 0..3 --sweep none=1..2").exit == 2);
    CHECK(folder.render(sized + "-o a.png --frames 0..3 --sweep size=1").exit == 2);
}

TEST_CASE("parts with more samples where they are rough join to the very picture") {
    const FilmScenes folder;
    const std::string same = sized + "--time 0.7 ";
    CHECK(folder.render(same + "-o whole.png").exit == 0);
    CHECK(folder.render(same + "--samples 1 -o one.png").exit == 0);
    CHECK(folder.render(same + "--samples 4 -o four.png").exit == 0);
    CHECK(folder.read("whole.png") != folder.read("one.png"));
    CHECK(folder.read("whole.png") != folder.read("four.png"));
    std::string parts;
    for (int i = 0; i < 7; ++i) {
        const std::string file = "t" + std::to_string(i) + ".png";
        CHECK(folder.render(same + "--tile " + std::to_string(i) + "/7 -o " + file).exit == 0);
        parts += file + " ";
    }
    CHECK(shell(folder, "fathom merge " + parts + "-o merged.png").exit == 0);
    CHECK(folder.read("merged.png") == folder.read("whole.png"));
    // A tile with one sample everywhere is no part of it.
    CHECK(folder.render(same + "--samples 1 --tile 3/7 -o t3.png").exit == 0);
    CHECK(shell(folder, "fathom merge " + parts + "-o merged.png").exit != 0);
}

TEST_CASE("tiles, regions and ranges of samples join to the very picture") {
    const FilmScenes folder;
    const std::string same = sized + "--time 0.7 ";
    CHECK(folder.render(same + "--samples 5 -o whole.png").exit == 0);
    const std::string whole = folder.read("whole.png");
    const auto merged = [&](const std::string &words) {
        const Result result = shell(folder, "fathom merge " + words + " -o merged.png");
        INFO(result.err);
        CHECK(result.exit == 0);
        return folder.read("merged.png");
    };
    for (const int n : {1, 2, 7, 31}) {
        std::string parts;
        for (int i = 0; i < n; ++i) {
            const std::string tile = std::to_string(i) + "/" + std::to_string(n);
            const std::string file = "t" + std::to_string(i) + ".png";
            CHECK(
                folder.render(same + "--samples 5 --jobs 1 --tile " + tile + " -o " + file).exit ==
                0);
            parts = file + " " + parts; // in any order
        }
        CHECK(merged(parts) == whole);
    }
    for (const char *region : {"0,0,17,31", "17,0,23,9", "17,9,5,22", "22,9,18,22"})
        CHECK(folder
                  .render(same + "--samples 5 --region " + region + " -o r" +
                          std::string(region, 2) + std::string(region).substr(3, 1) + region[5] +
                          ".png")
                  .exit == 0);
    CHECK(merged("r*.png") == whole);
    for (const char *range : {"0..1", "1..3", "3..=4"})
        CHECK(folder.render(same + "--samples " + range + " -o s" + range[0] + ".sums").exit == 0);
    CHECK(merged("s3.sums s0.sums s1.sums") == whole);
    CHECK(merged("--samples 5 s*.sums") == whole);
    // Samples and tiles at once; the shutter too, whose samples have times of their own.
    const std::string blurred = sized + "--frames 2..4 --only 2 --fps 4 --shutter 0.9 ";
    CHECK(folder.render(blurred + "--samples 4 -o b#.png").exit == 0);
    for (const char *tile : {"0/2", "1/2"})
        for (const char *range : {"0..3", "3..4"})
            CHECK(folder
                      .render(blurred + "--samples " + range + " --tile " + tile + " -o b" +
                              tile[0] + range[0] + "_#.sums")
                      .exit == 0);
    CHECK(merged("b0*.sums b1*.sums") == folder.read("b2.png"));
    CHECK(folder.read("b2.png") != whole);
}

TEST_CASE("parts of the examples join, also where shapes are left out cell by cell") {
    const FilmScenes folder;
    for (const char *name : {"temple", "night_city", "orrery", "everything"}) {
        INFO(name);
        const std::string render = "fathom render '" FATHOM_SOURCE_DIR "/examples/" +
                                   std::string(name) + ".sdf' --size 60x45 --backend cpu ";
        CHECK(shell(folder, render + "--samples 2 -o whole.png").exit == 0);
        for (const char *part : {"--region 0,0,33,45", "--region 33,0,27,7", "--region 33,7,27,38"})
            for (const char *samples : {"0..1", "1..2"})
                CHECK(shell(folder, render + part + " --jobs 1 --samples " + samples + " -o p" +
                                        part[11] + samples[0] + part[9] + part[12] + ".sums")
                          .exit == 0);
        CHECK(shell(folder, "fathom merge p*.sums -o joined.png; rm p*.sums").exit == 0);
        CHECK(folder.read("joined.png") == folder.read("whole.png"));
        CHECK_FALSE(folder.read("whole.png").empty());
    }
}

TEST_CASE("merge names what is missing, and joins nothing that does not belong together") {
    const FilmScenes folder;
    for (const char *tile : {"0/3", "1/3", "2/3"})
        CHECK(folder.render(sized + "--tile " + tile + " -o t" + tile[0] + ".png").exit == 0);
    for (const char *range : {"0..1", "2..4"})
        CHECK(folder.render(sized + "--samples " + range + " -o s" + range[0] + ".sums").exit == 0);
    CHECK(folder.render(sized + "--time 1 --tile 2/3 -o later.png").exit == 0);
    CHECK(folder.render(sized + "-D size=1.5 --tile 2/3 -o larger.png").exit == 0);
    CHECK(folder.render("--size 40x30 --tile 2/3 -o other.png").exit == 0);
    const std::string cut = folder.read("t2.png");
    folder.write("cut.png", cut.substr(0, cut.size() - 30));
    std::string flipped = folder.read("s2.sums");
    flipped[flipped.size() - 9] = static_cast<char>(flipped[flipped.size() - 9] ^ 1);
    folder.write("flipped.sums", flipped);
    const auto refused = [&](const std::string &words, const std::string &why) {
        INFO(words);
        const Result result = shell(folder, "fathom merge " + words + " -o merged.png");
        CHECK(result.exit == 3);
        CHECK_THAT(result.err, Catch::Contains(why));
        CHECK_FALSE(fs::exists(folder / "merged.png"));
    };
    refused("t0.png t2.png", "x 0..40, y 10..20, samples 0..1");
    refused("s0.sums s2.sums", "samples 1..2");
    refused("--samples 4 s0.sums s2.sums", "samples 1..2");
    refused("--samples 3 s0.sums s2.sums", "samples 2..4");
    refused("s0.sums s0.sums", "overlap");
    refused("t0.png t1.png t2.png t1.png", "overlap");
    refused("t0.png t1.png later.png", "different scenes, options");
    refused("t0.png t1.png larger.png", "different scenes, options");
    refused("t0.png t1.png other.png", "different");
    refused("t0.png t1.png cut.png", "not a whole PNG");
    refused("s0.sums flipped.sums", "not whole");
    refused("t0.png t1.png s0.sums", "finished pixels");
    refused("t0.png t1.png none.png", "none.png");
    refused("t0.png ball.sdf", "not a whole PNG");
    CHECK(shell(folder, "fathom merge t0.png t1.png t2.png -o merged.png").exit == 0);
}

TEST_CASE("files are kept where they are whole and of this scene and these options") {
    const FilmScenes folder;
    const std::string film = "--frames 0..3 --skip-existing --progress json -o f##.png ";
    const auto made = [&](const std::string &words) {
        const Result result = folder.render(sized + film + words);
        CHECK(result.exit == 0);
        std::string list;
        for (const auto &event : events(result.err))
            if (event["event"] == "made") list += std::to_string(event["frame"].get<int>());
        return list;
    };
    CHECK(made("") == "012");
    CHECK(made("") == "");
    const std::string file = folder.read("f01.png");
    folder.write("f01.png", file.substr(0, file.size() - 1));
    CHECK(made("") == "1");
    folder.write("f01.png", folder.read("f02.png")); // another frame
    CHECK(made("") == "1");
    folder.write("f00.png", "");
    CHECK(made("--jobs 2") == "0"); // threads change no pixel
    CHECK(made("-D size=1.2") == "012");
    CHECK(made("-D size=1.2 --samples 2") == "012");
    CHECK(made("-D size=1.2 --samples 2 --fps 10") == "012");
    folder.write("ball.sdf", folder.read("ball.sdf") + "// the same solid, another text\n");
    CHECK(made("-D size=1.2 --samples 2 --fps 10") == "012");
    CHECK(folder.render(sized + "--skip-existing -o a.jpg").exit == 2);
}

TEST_CASE("an imported file is part of what a picture is of, where the scene lies is not") {
    const FilmScenes folder;
    fs::create_directories(folder / "here/parts");
    fs::create_directories(folder / "there/parts");
    fs::create_directories(folder / "lib");
    for (const char *place : {"here", "there"}) {
        folder.write(std::string(place) + "/a.sdf",
                     "import \"parts/b.sdf\"\nimport \"c.sdf\"\nsphere(r + s)\n");
        folder.write(std::string(place) + "/parts/b.sdf", "let r = 0.5\n");
    }
    folder.write("lib/c.sdf", "let s = 0.5\n");
    const auto render = [&](const std::string &scene) {
        const Result result = shell(folder, "fathom render " + scene +
                                                " -I lib --backend cpu --size 9x9 "
                                                "--skip-existing --progress json -o a.png");
        INFO(result.err);
        CHECK(result.exit == 0);
        return events(result.err).back()["event"] == "made";
    };
    CHECK(render("here/a.sdf"));
    CHECK_FALSE(render("there/a.sdf"));
    folder.write("there/parts/b.sdf", "let r = 0.50\n");
    CHECK(render("there/a.sdf"));
    folder.write("lib/c.sdf", "let s = 0.4\n");
    CHECK(render("there/a.sdf"));
    CHECK_FALSE(render("there/a.sdf"));
}

TEST_CASE("keyframes have their values at the keys' times, and easings theirs at the ends") {
    const ScratchFolder folder;
    // How far [0, 9, 0] is from a ball of radius 1 at height y: 8 - y.
    const auto height = [&](const std::string &y, const std::string &time) {
        folder.write("a.sdf", "sphere(1).translate(y: " + y + ")\nrender(time: 10)\n");
        return 8 - std::stod(shell(folder, "fathom eval a.sdf --at 0,9,0 --time " + time).out);
    };
    const std::string keys = "[[1, 0.5], [2, 1.5], [4, -1]]";
    const std::pair<const char *, double> moments[] = {{"0", 0.5},  {"1", 0.5},    {"1.5", 1},
                                                       {"2", 1.5},  {"3", 0.25},   {"4", -1},
                                                       {"9.5", -1}, {"2.5", 0.875}};
    for (const auto &[time, value] : moments) {
        INFO(time);
        CHECK(height("keyframes(" + keys + ", time)", time) == Approx(value).margin(1e-6));
    }
    CHECK(height("keyframes(" + keys + ", time, ease_in)", "1.5") == Approx(0.75));
    CHECK(height("keyframes(" + keys + ", time, t => ease_out(t, 3))", "3") ==
          Approx(1.5 - 2.5 * 0.875));
    CHECK(height("keyframes([[0, 9, 1, 9], [2, 9, 3, 9]], time).y", "1") == Approx(2));
    CHECK(height("keyframes([[3, 7]], time)", "0") == Approx(7));
    for (const char *ease :
         {"ease_in(time / 2)", "ease_out(time / 2)", "ease_in_out(time / 2)", "ease_back(time / 2)",
          "ease_bounce(time / 2)", "ease_in(time / 2, 1)"}) {
        INFO(ease);
        CHECK(height(ease, "0") == Approx(0).margin(1e-6));
        CHECK(height(ease, "2") == Approx(1));
        CHECK(height(ease, "5") == Approx(1));
    }
    // What is proved knows that nothing outside of the keys' values is taken: a radius is above 0.
    folder.write("b.sdf", "sphere(keyframes([[0, 1], [2, 0.1], [3, 2], [4, 0.1]], time))\n");
    CHECK(shell(folder, "fathom check b.sdf").exit == 0);
    folder.write("c.sdf", "sphere(keyframes([[0, 1], [2, -0.1], [3, 2]], time))\n");
    CHECK(shell(folder, "fathom check c.sdf").exit == 1);
}

TEST_CASE("a turntable goes around, and its frames have one time") {
    const FilmScenes folder;
    CHECK(folder.render(sized + "--turntable 4 --time 0.5 -o t#.png").exit == 0);
    CHECK(folder.render(sized + "--time 0.5 -o one.png").exit == 0);
    const auto pixels = [&](const std::string &file) {
        return fathom::decode_png(folder.read(file))->rgba;
    };
    CHECK(pixels("t0.png") == pixels("one.png"));
    CHECK(pixels("t1.png") != pixels("t0.png"));
    CHECK_FALSE(fs::exists(folder / "t4.png"));
    // From behind: a mirror image of a scene that is one of itself.
    folder.write("pair.sdf",
                 "sphere(0.5).translate(x: 0.6).paint(red)\nsphere(0.3).translate(x: -0.6)\n"
                 "camera(at: [0, 0, 5])\nlight(at: [0, 9, 0])\n");
    CHECK(shell(folder, "fathom render pair.sdf --backend cpu --size 40x30 --samples 1 "
                        "--turntable 2 -o p#.png")
              .exit == 0);
    const fathom::Picture front = *fathom::decode_png(folder.read("p0.png")),
                          back = *fathom::decode_png(folder.read("p1.png"));
    int differ = 0;
    for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 40; ++x)
            for (int c = 0; c < 3; ++c)
                differ +=
                    std::abs(front.rgba[static_cast<std::size_t>(4 * (40 * y + x) + c)] -
                             back.rgba[static_cast<std::size_t>(4 * (40 * y + 39 - x) + c)]) > 4;
    CHECK(differ < 12); // pixels of an edge, by rounding
    CHECK(pixels("p0.png") != pixels("p1.png"));
}

TEST_CASE("an open shutter blurs what moves, and nothing else") {
    const FilmScenes folder;
    const auto picture = [&](const std::string &scene, const std::string &words) {
        CHECK(shell(folder, "fathom render " + scene +
                                " --backend cpu --size 32x24 --samples 8 "
                                "--frames 1 --fps 2 -o a#.png " +
                                words)
                  .exit == 0);
        return fathom::decode_png(folder.read("a1.png"))->rgba;
    };
    CHECK(picture("still.sdf", "--shutter 1") == picture("still.sdf", ""));
    CHECK(picture("ball.sdf", "--shutter 1") != picture("ball.sdf", ""));
    CHECK(folder.render(sized + "--shutter 0.5 -o a.png").exit == 2); // one sample
    // What it sees has to be proved: the shutter closes after the last moment.
    folder.write("short.sdf", "sphere(1).translate(x: time)\nrender(time: 1)\n");
    const std::string last =
        "fathom render short.sdf --backend cpu --size 8x8 --samples 2 --frames 0..=2 "
        "--fps 2 -o a#.png ";
    CHECK(shell(folder, last).exit == 0);
    CHECK(shell(folder, last + "--shutter 0.5").exit == 2);
}

TEST_CASE("a contact sheet shows frames of the film, each as it is alone") {
    const FilmScenes folder;
    CHECK(folder.render("--size 8x6 --frames 0..10 --contact-sheet 2x3 -o sheet.png").exit == 0);
    CHECK(folder.render("--size 8x6 --frames 0..10 -o f##.png").exit == 0);
    const fathom::Picture sheet = *fathom::decode_png(folder.read("sheet.png"));
    CHECK((sheet.width == 16 && sheet.height == 18));
    int cell = 0;
    for (const char *file : {"f00.png", "f01.png", "f03.png", "f05.png", "f06.png", "f08.png"}) {
        const fathom::Picture frame = *fathom::decode_png(folder.read(file));
        bool same = true;
        for (int y = 0; y < 6; ++y)
            for (int i = 0; i < 4 * 8; ++i)
                same = same && frame.rgba[static_cast<std::size_t>(4 * 8 * y + i)] ==
                                   sheet.rgba[static_cast<std::size_t>(
                                       4 * (16 * (6 * (cell / 2) + y) + 8 * (cell % 2)) + i)];
        INFO(file);
        CHECK(same);
        ++cell;
    }
    CHECK(folder.render("--size 8x6 --frames 0..3 --contact-sheet 4x4 -o few.png").exit == 0);
    const fathom::Picture few = *fathom::decode_png(folder.read("few.png"));
    CHECK((few.width == 24 && few.height == 6));
}

TEST_CASE("options that a command cannot have together are refused with the way out") {
    const FilmScenes folder;
    const auto refused = [&](const std::string &words, const std::string &why) {
        INFO(words);
        const Result result = shell(folder, "fathom render ball.sdf " + words);
        CHECK(result.exit == 2);
        CHECK_THAT(result.err, Catch::Contains(why));
    };
    refused("-o a.mp4", "--frames");
    refused("-o a.png --sweep size=1..2", "--frames");
    refused("-o a.png --only 1", "--frames");
    refused("-o a.png --contact-sheet 2x2", "--frames");
    refused("-o a.png --samples 2..4", ".sums");
    refused("-o a.png --samples 0", "1 to 256");
    refused("-o a.png --samples 250..300", "256");
    refused("-o a.png --tile 4/4", "0 to N - 1");
    refused("-o a.png --tile 0/900", "720");
    refused("-o a.png --region 0,0,1281,1", "not within");
    refused("-o a.png --region 0,0,0,1", "WIDTH");
    refused("-o a.png --tile 0/2 --backend gl", "--backend cpu");
    refused("-o a.gif --frames 0..3 --only 1", "merge");
    refused("-o a.png --frames 0..2 --region 0,0,1,1 --tile 0/1", "both say a part");
    refused("-o a.txt", ".png");
    CHECK(shell(folder, "fathom merge a.png b.png --frames 0..3 -o a.mp4").exit == 2);
    CHECK(shell(folder, "fathom merge a.png -o a.mp4").exit == 2);
}

TEST_CASE("room for the frames is asked for before the first is made") {
    const FilmScenes folder;
    const Result full =
        shell(folder, "timeout 20 '" FATHOM_PROGRAM "' render still.sdf --backend cpu "
                      "--size 8192x8192 --frames 0..=100000 -o f#.png");
    CHECK(full.exit == 3);
    CHECK(contains(full.err, "free"));
}
