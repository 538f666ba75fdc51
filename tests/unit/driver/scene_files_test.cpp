// What a scene may read: its own folder and the -I folders, and nothing else, whatever its paths
// say.
#include "base/picture.h"
#include "driver/scene_files.h"
#include "scratch_folder.h"
#include "tests/support/decoded.h"

#include <catch2/catch.hpp>
#include <cstring>

using namespace fathom;
using driver::SceneFiles;
using typecheck::LoadedText;
using typecheck::LoadError;
namespace fs = std::filesystem;

namespace {

struct Answer {
    std::string text, name, identity, error;
    bool outside = false;
};

Answer ask(SceneFiles &files, const std::string &path, const std::string &from) {
    auto result = files.loader().text(path, from);
    if (auto *error = std::get_if<LoadError>(&result))
        return {"", "", "", error->why, error->reason == LoadError::Reason::Outside};
    LoadedText text = std::get<LoadedText>(result);
    return {text.text, text.name, text.identity, "", false};
}

} // namespace

TEST_CASE("an import is found beside its importer, then in the -I folders") {
    ScratchFolder folder;
    folder.write("scene/main.sdf", "");
    folder.write("scene/parts/a.sdf", "a");
    folder.write("scene/parts/b.sdf", "b");
    folder.write("library/c.sdf", "c");
    SceneFiles files(folder / "scene", {folder / "library"}, {});
    std::string root = files.add_root(folder / "scene/main.sdf");
    Answer a = ask(files, "parts/a.sdf", root);
    CHECK(a.text == "a");
    CHECK(a.name == (folder / "scene/parts/a.sdf").string());
    CHECK(ask(files, "b.sdf", a.identity).text ==
          "b"); // relative to the importer, not to the scene
    CHECK(ask(files, "b.sdf", root).error == "no such file");
    CHECK(ask(files, "c.sdf", a.identity).text == "c");
    // One file, however it is named, has one identity.
    CHECK(ask(files, "parts/../parts/./a.sdf", root).identity == a.identity);
}

TEST_CASE("nothing outside is read, nor told whether it exists") {
    ScratchFolder folder;
    folder.write("secret.sdf", "secret");
    folder.write("scene/main.sdf", "");
    fs::create_symlink(folder / "secret.sdf", folder / "scene/innocent.sdf");
    fs::create_directory_symlink(folder.path(), folder / "scene/up");
    SceneFiles files(folder / "scene", {}, {});
    std::string root = files.add_root(folder / "scene/main.sdf");
    for (std::string path : {"../secret.sdf", "innocent.sdf", "up/secret.sdf", "../nothing.sdf"}) {
        INFO(path);
        CHECK(ask(files, path, root).outside);
    }
    CHECK(ask(files, (folder / "secret.sdf").string(), root).outside);
    CHECK(ask(files, "/etc/passwd", root).outside);
    // A neighbour whose name begins alike is outside too.
    folder.write("scene-other/x.sdf", "x");
    CHECK(ask(files, "../scene-other/x.sdf", root).outside);
    for (const auto &[file, state] : files.touched())
        CHECK(file.string().find("secret") == std::string::npos);
}

TEST_CASE("a missing file beside a scene that is named without a folder is missing, not outside") {
    SceneFiles files("", {}, {});
    Answer a = ask(files, "there is no such file.png", files.add_root("scene.sdf"));
    CHECK_FALSE(a.outside);
    CHECK(a.error == "no such file");
}

TEST_CASE("a name is looked for once, and one that no system would open not at all") {
    ScratchFolder folder;
    SceneFiles files(folder.path(), {}, {});
    const std::string root = files.add_root(folder / "main.sdf");
    CHECK(ask(files, "a.sdf", root).error == "no such file");
    folder.write("a.sdf", "a");
    CHECK(ask(files, "a.sdf", root).error == "no such file"); // it was asked for
    CHECK(ask(files, "./a.sdf", root).text == "a");
    CHECK(ask(files, std::string(4094, '/') + "ab", root).outside);
    const std::string error = ask(files, std::string(4097, 'a'), root).error;
    CHECK(error == "the name has 4097 bytes, and no more than 4096 are looked for");
}

TEST_CASE("a link within the allowed folders is followed") {
    ScratchFolder folder;
    folder.write("scene/real.sdf", "real");
    fs::create_symlink("real.sdf", folder / "scene/link.sdf");
    SceneFiles files(folder / "scene", {}, {});
    std::string root = files.add_root(folder / "scene/main.sdf");
    CHECK(ask(files, "link.sdf", root).identity == ask(files, "real.sdf", root).identity);
}

TEST_CASE("all that was looked for is remembered, found or not, for the watcher") {
    ScratchFolder folder;
    folder.write("scene/a.sdf", "a");
    SceneFiles files(folder / "scene", {folder / "scene"}, {});
    std::string root = files.add_root(folder / "scene/main.sdf");
    ask(files, "a.sdf", root);
    ask(files, "missing.sdf", root);
    REQUIRE(files.touched().count(folder / "scene/a.sdf") == 1);
    CHECK(files.touched().at(folder / "scene/a.sdf").exists);
    REQUIRE(files.touched().count(folder / "scene/missing.sdf") == 1);
    CHECK_FALSE(files.touched().at(folder / "scene/missing.sdf").exists);
}

TEST_CASE("a picture goes through PNG and comes back linear") {
    std::string png = encode_png({2, 1, {255, 0, 128, 255, 0, 255, 10, 255}});
    std::string error;
    std::optional<ir::ImageData> image = test::decoded_image(png, error);
    REQUIRE(image);
    CHECK(image->width == 2);
    CHECK(image->height == 1);
    CHECK(image->rgba[0] == 1.0f);
    CHECK(image->rgba[1] == 0.0f);
    CHECK(image->rgba[2] == Approx(0.21586f).epsilon(1e-4)); // sRGB 128/255
    CHECK(image->rgba[3] == 1.0f);
    CHECK(image->rgba[6] == Approx(10 / 255.0 / 12.92).epsilon(1e-4));
    for (std::size_t size = 0; size < png.size() - 12;
         ++size) // cut off anywhere before the end mark
        CHECK_FALSE(test::decoded_image(png.substr(0, size), error));
    CHECK_FALSE(test::decoded_image("\xff\xd8 and no JPEG", error));
    CHECK_FALSE(test::decoded_image("GIF89a", error));
    CHECK(error == "neither a PNG nor a JPEG picture");
}

TEST_CASE("a grid is read from raw and from ascii, and a broken one is refused") {
    std::string header = "NRRD0004\n# a comment\ntype: float\ndimension: 3\nsizes: 2 2 3\n";
    std::string error;
    auto ascii =
        test::decoded_grid(header + "encoding: ascii\n\n0 1 2 3 4 5 6 7 8 9 10 11\n", error);
    REQUIRE(ascii);
    CHECK(ascii->size == std::array<int, 3>{2, 2, 3});
    CHECK(ascii->values[11] == 11.0f);
    std::string raw(12 * sizeof(float), '\0');
    for (std::size_t i = 0; i < 12; ++i) {
        float value = static_cast<float>(i);
        std::memcpy(raw.data() + i * sizeof(float), &value, sizeof value);
    }
    auto binary = test::decoded_grid(header + "encoding: raw\nendian: little\n\n" + raw, error);
    REQUIRE(binary);
    CHECK(binary->values == ascii->values);
    CHECK_FALSE(test::decoded_grid(header + "encoding: raw\n\n" + raw.substr(1), error));
    CHECK_FALSE(test::decoded_grid(header + "encoding: ascii\n\n0 1 nan", error));
    CHECK_FALSE(test::decoded_grid("NRRD0004\ntype: float\ndimension: 3\nsizes: 4096 4096 4096\n\n",
                                   error));
    CHECK_FALSE(test::decoded_grid("NRRD0004\ntype: float", error));
    CHECK_FALSE(test::decoded_grid("", error));
    for (const char *dimension : {"-3", "3.5", "1e300", "many", "-inf"})
        CHECK_FALSE(
            test::decoded_grid("NRRD0004\ntype: float\ndimension: " + std::string(dimension) +
                                   "\nsizes: 2 2 2\nencoding: ascii\n\n0 1 2 3 4 5 6 7\n",
                               error));
}

TEST_CASE("a grid of integers is read in both orders of bytes, and a broken one is refused") {
    std::string error;
    const std::string head = "NRRD0004\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n";
    const auto first = [&](const std::string &text) {
        const auto grid = test::decoded_grid(text, error);
        INFO(error);
        REQUIRE(grid);
        return grid->values[0];
    };
    const std::string bytes = "\xff\xfe" + std::string(14, '\1');
    CHECK(first(head + "type: uchar\n\n" + bytes) == 255);
    CHECK(first(head + "type: signed char\n\n" + bytes) == -1);
    CHECK(first(head + "type: unsigned short\nendian: little\n\n" + bytes) == 0xfeff);
    CHECK(first(head + "type: uint16\nendian: big\n\n" + bytes) == 0xfffe);
    CHECK(first(head + "type: short\nendian: big\n\n" + bytes) == -2);
    const std::string zeros(62, '\0');
    CHECK(first(head + "type: int\nendian: big\n\n" + bytes + zeros) == -130815);
    CHECK(first(head + "type: uint64\nendian: little\n\n" + "\1\1" + zeros) == 257);
    const auto refused = [&](const std::string &text, const std::string &words) {
        error.clear();
        CHECK_FALSE(test::decoded_grid(text, error));
        INFO(error);
        CHECK(error.find(words) != error.npos);
    };
    refused(head + "type: block\n\n" + bytes, "whose `type` is `block`");
    refused(head + "type: short\nendian: middle\n\n" + bytes, "neither `little` nor `big`");
    refused(head + "type: short\n\n" + bytes.substr(1), "fewer values");
    refused(head + "type: uchar\nbyte skip: 3\n\n" + bytes, "`byte skip`");
    refused(head + "type: uchar\ndata file: other.raw\n\n", "one file");
    refused(head + "type: uchar\nspace directions: (0,1,0) (1,0,0) (0,0,1)\n\n" + bytes,
            "`rotate`");
    refused("NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: bzip2\n\n" + bytes,
            "whose `encoding` is `bzip2`");
    const std::string packed =
        "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: gzip\n\n";
    refused(packed + "no gzip at all", "fewer values");
    refused(packed, "fewer values");
    refused("PK\3\4", "neither an NRRD nor an OpenVDB grid");
    // More than any limit allows, and so much that only a limit forbids it.
    refused("NRRD0004\ntype: uchar\ndimension: 3\nsizes: 4096 4096 4096\n\n", "crop it");
    typecheck::Room room{std::size_t{640} << 20, 20'000'000, 0};
    const auto large =
        driver::decode_grid("NRRD0004\ntype: uchar\ndimension: 3\nsizes: 1000 1000 1000\n\n", room);
    CHECK(std::get<LoadError>(large).reason == LoadError::Reason::TooLarge);
    CHECK(std::get<LoadError>(large).why ==
          "its box has 1000 x 1000 x 1000 values, which take more memory than is left");
}

// A progressive JPEG of one component whose every block is empty, with `scans` scans of 12 bytes
// each that say nothing more (ITU T.81, G).
static std::string scanned_jpeg(int side, int scans) {
    const auto marker = [](std::initializer_list<int> bytes) {
        std::string out;
        for (int b : bytes) out += static_cast<char>(b);
        return out;
    };
    const auto table = [&](int kind, int symbol) { // one code, of one bit
        return marker({0xff, 0xc4, 0, 20, kind, 1}) + std::string(15, '\0') + marker({symbol});
    };
    std::string bytes = marker({0xff, 0xd8, 0xff, 0xdb, 0, 67, 0}) + std::string(64, '\1');
    bytes +=
        marker({0xff, 0xc2, 0, 11, 8, side >> 8, side & 255, side >> 8, side & 255, 1, 1, 0x11, 0});
    bytes += table(0x00, 0) + table(0x10, 0xe0); // an end of 2^14 blocks and as many as 14 bits say
    bytes += marker({0xff, 0xda, 0, 8, 1, 1, 0, 0, 0, 0});
    bytes += std::string(static_cast<std::size_t>(side / 8 * (side / 8) / 8), '\0');
    for (int i = 0; i < scans; ++i) bytes += marker({0xff, 0xda, 0, 8, 1, 1, 0, 1, 63, 0, 0, 1});
    return bytes + marker({0xff, 0xd9});
}

TEST_CASE("a JPEG of many scans takes room for each, and no more than there is") {
    typecheck::Room room{std::size_t{1} << 30, 20'000'000, std::size_t{1} << 24};
    const auto few = driver::decode_image(scanned_jpeg(1024, 5), room);
    REQUIRE(std::holds_alternative<ir::ImageData>(few));
    CHECK(std::get<ir::ImageData>(few).width == 1024);
    CHECK(room.steps < 20'000'000 - 5 * 1024 * 1024 / 16);
    CHECK(room.bytes == (std::size_t{1} << 30) - std::size_t{1024} * 1024 * 16);
    const auto many = driver::decode_image(scanned_jpeg(1024, 20'000), room);
    REQUIRE(std::holds_alternative<LoadError>(many));
    CHECK(std::get<LoadError>(many).reason == LoadError::Reason::TooMuchWork);
}

TEST_CASE("images and grids are refused for which there is no room") {
    using Reason = LoadError::Reason;
    const auto reason = [](const auto &answer) { return std::get<LoadError>(answer).reason; };
    const std::string png = encode_png({64, 64, std::vector<std::uint8_t>(4 * 64 * 64)});
    typecheck::Room small{64 * 64 * 16, 1'000'000, 1'000'000};
    CHECK(reason(driver::decode_image(png, small)) == Reason::TooLarge);
    typecheck::Room few{1'000'000, 1'000'000, 64 * 64 - 1};
    CHECK(reason(driver::decode_image(png, few)) == Reason::TooManyPixels);
    typecheck::Room idle{1'000'000, 10, 1'000'000};
    CHECK(reason(driver::decode_image(png, idle)) == Reason::TooMuchWork);
    const std::string grid =
        "NRRD0004\ntype: float\ndimension: 3\nsizes: 2 2 2\nencoding: ascii\n\n0 1 2 3 4 5 6 7\n";
    typecheck::Room none{31, 1'000, 0};
    CHECK(reason(driver::decode_grid(grid, none)) == Reason::TooLarge);
}
