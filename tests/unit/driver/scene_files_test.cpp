// What a scene may read: its own folder and the -I folders, and nothing else, whatever its paths
// say.
#include "base/picture.h"
#include "driver/image.h"
#include "driver/scene_files.h"
#include "scratch_folder.h"

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
    SceneFiles files(folder / "scene", {folder / "library"});
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
    SceneFiles files(folder / "scene", {});
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
    SceneFiles files("", {});
    Answer a = ask(files, "there is no such file.png", files.add_root("scene.sdf"));
    CHECK_FALSE(a.outside);
    CHECK(a.error == "no such file");
}

TEST_CASE("a link within the allowed folders is followed") {
    ScratchFolder folder;
    folder.write("scene/real.sdf", "real");
    fs::create_symlink("real.sdf", folder / "scene/link.sdf");
    SceneFiles files(folder / "scene", {});
    std::string root = files.add_root(folder / "scene/main.sdf");
    CHECK(ask(files, "link.sdf", root).identity == ask(files, "real.sdf", root).identity);
}

TEST_CASE("all that was looked for is remembered, found or not, for the watcher") {
    ScratchFolder folder;
    folder.write("scene/a.sdf", "a");
    SceneFiles files(folder / "scene", {folder / "scene"});
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
    std::optional<ir::ImageData> image = driver::decode_image(png, error);
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
        CHECK_FALSE(driver::decode_image(png.substr(0, size), error));
    CHECK_FALSE(driver::decode_image("\xff\xd8 and no JPEG", error));
    CHECK_FALSE(driver::decode_image("GIF89a", error));
    CHECK(error == "neither a PNG nor a JPEG picture");
}

TEST_CASE("a grid is read from raw and from ascii, and a broken one is refused") {
    std::string header = "NRRD0004\n# a comment\ntype: float\ndimension: 3\nsizes: 2 2 3\n";
    std::string error;
    auto ascii =
        driver::decode_grid(header + "encoding: ascii\n\n0 1 2 3 4 5 6 7 8 9 10 11\n", error);
    REQUIRE(ascii);
    CHECK(ascii->size == std::array<int, 3>{2, 2, 3});
    CHECK(ascii->values[11] == 11.0f);
    std::string raw(12 * sizeof(float), '\0');
    for (std::size_t i = 0; i < 12; ++i) {
        float value = static_cast<float>(i);
        std::memcpy(raw.data() + i * sizeof(float), &value, sizeof value);
    }
    auto binary = driver::decode_grid(header + "encoding: raw\nendian: little\n\n" + raw, error);
    REQUIRE(binary);
    CHECK(binary->values == ascii->values);
    CHECK_FALSE(driver::decode_grid(header + "encoding: raw\n\n" + raw.substr(1), error));
    CHECK_FALSE(driver::decode_grid(header + "encoding: ascii\n\n0 1 nan", error));
    CHECK_FALSE(driver::decode_grid(
        "NRRD0004\ntype: float\ndimension: 3\nsizes: 4096 4096 4096\n\n", error));
    CHECK_FALSE(driver::decode_grid("NRRD0004\ntype: float", error));
    CHECK_FALSE(driver::decode_grid("", error));
}
