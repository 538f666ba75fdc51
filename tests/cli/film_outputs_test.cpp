// Where films go: pipes, ffmpeg, and what is left where they are ended.
#include "film_scenes.h"

#include "base/picture.h"

#include <catch2/catch.hpp>

#include <sstream>

TEST_CASE("frames go to a pipe as PNG, PAM or raw bytes") {
    const FilmScenes folder;
    const std::string film = "--size 5x4 --frames 0..3 -o - --stream ";
    CHECK(folder.render("--size 5x4 --frames 0..3 -o f#.png").exit == 0);
    std::string rgb, pam, png;
    for (const char *file : {"f0.png", "f1.png", "f2.png"}) {
        png += folder.read(file);
        std::string one;
        const std::vector<std::uint8_t> rgba = fathom::decode_png(folder.read(file))->rgba;
        for (std::size_t i = 0; i < rgba.size(); ++i)
            if (i % 4 != 3) one += static_cast<char>(rgba[i]);
        rgb += one;
        pam += "P7\nWIDTH 5\nHEIGHT 4\nDEPTH 3\nMAXVAL 255\nTUPLTYPE RGB\nENDHDR\n" + one;
    }
    CHECK(folder.render(film + "png").out == png);
    CHECK(folder.render(film + "pam").out == pam);
    CHECK(folder.render(film + "raw").out == rgb);
    CHECK(folder.render("--size 5x4 --frames 0..3 -o f#.png --stream raw").exit == 2);
}

TEST_CASE("SIGTERM ends a picture at once, with its own status and nothing half written") {
    const FilmScenes folder;
    folder.write("f0.png", "what was there");
    // It would take minutes.
    const Result ended =
        shell(folder, "timeout 60 sh -c \"'" FATHOM_PROGRAM
                      "' render still.sdf --backend cpu --samples 256 "
                      "--size 16000x16000 --progress json -o f0.png 2>words & p=\\$!; "
                      "until grep -q progress words; do sleep 0.1; done; "
                      "kill \\$p; wait \\$p; echo \\$?\"");
    CHECK(ended.out == "4\n");
    CHECK(folder.read("f0.png") == "what was there");
    CHECK(contains(folder.read("words"), "ended by SIGTERM"));
    for (const auto &entry : fs::directory_iterator(folder.path()))
        CHECK_FALSE(contains(entry.path().filename().string(), "fathom-tmp"));
}

// Stands for ffmpeg: writes what it was told and how many bytes it got to its last word.
const char *const stand_in = "#!/bin/sh\nfor last; do :; done\n"
                             "{ echo \"$@\" | sed \"s, [^ ]*$,,\"; wc -c; } >\"$last\"\n";

TEST_CASE("a film's frames go to ffmpeg, and its file appears when it is whole") {
    const FilmScenes folder;
    fs::create_directories(folder / "bin");
    const auto with = [&](const std::string &ffmpeg, const std::string &words) {
        folder.write("bin/ffmpeg", ffmpeg);
        fs::permissions(folder / "bin/ffmpeg", fs::perms::owner_all);
        return shell(folder, "PATH=\"$PWD/bin:$PATH\"; fathom " + words);
    };
    const std::string film =
        "render still.sdf --backend cpu --size 16x12 --frames 0..=6:2 --fps 12 ";
    for (const char *suffix : {"mp4", "webm", "gif", "apng", "GIF"}) {
        INFO(suffix);
        const std::string out = std::string("a.") + suffix;
        CHECK(with(stand_in, film + "-o " + out).exit == 0);
        const std::string told = folder.read(out);
        CHECK(contains(told, "-f rawvideo -pix_fmt rgba -s 16x12 -r 12 -i -"));
        CHECK(contains(told, "-f " + std::string(suffix == std::string("GIF") ? "gif" : suffix)));
        CHECK(contains(told, "\n" + std::to_string(4 * 16 * 12 * 4)));
    }
    // Whatever goes wrong, the old film stays, and nothing is left beside it.
    const std::string old = folder.read("a.mp4");
    const Result failed =
        with("#!/bin/sh\ncat >/dev/null; echo no such codec >&2; exit 1\n", film + "-o a.mp4");
    CHECK(failed.exit == 3);
    CHECK(contains(failed.err, "no such codec"));
    const Result gone = with("#!/bin/sh\nexit 0\n", film + "--size 160x120 -o a.mp4");
    CHECK(gone.exit == 3);
    const Result none = shell(folder, "PATH=/nowhere; fathom " + film + "-o a.mp4");
    CHECK(none.exit == 3);
    CHECK(contains(none.err, "ffmpeg"));
    CHECK(contains(none.err, "a_####.png"));
    CHECK(with(stand_in, film + "--size 15x12 -o a.mp4").exit == 3); // an even side is wanted
    CHECK(folder.read("a.mp4") == old);
    CHECK(with(stand_in, film + "-o f#.png").exit == 0);
    CHECK(with(stand_in, "merge 'f#.png' --frames 0..=6:2 --fps 12 -o c.gif").exit == 0);
    CHECK(folder.read("c.gif") == folder.read("a.gif"));
    fs::remove(folder / "f4.png");
    const Result lacking = with(stand_in, "merge 'f#.png' --frames 0..=6:2 -o d.gif");
    CHECK(lacking.exit == 3);
    CHECK(contains(lacking.err, "frames 4"));
    CHECK_FALSE(fs::exists(folder / "d.gif"));
    for (const auto &entry : fs::directory_iterator(folder.path()))
        CHECK_FALSE(contains(entry.path().filename().string(), "fathom-tmp"));
}
