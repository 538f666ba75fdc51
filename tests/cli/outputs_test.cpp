// Results: that a file holds what its name says, that what cannot be written is refused with what
// to write, and that no option is taken and then not read.
#include "shell.h"
#include "tests/support/decoded.h"

#include "backend-glsl/targets.h"

#include <array>
#include <catch2/catch.hpp>
#include <openexr.h>

namespace glsl = fathom::glsl;

namespace {

struct OutputScenes : ScratchFolder {
    OutputScenes() {
        write("good.sdf", "sphere(1)\n");
        write("counted.sdf", "param n = 3 in 1..6\nparam size = 0.4 in 0.1..0.5\n"
                             "for i in 0..n { sphere(size + 0.01 * n).translate(x: i) }\n");
    }
    std::size_t files() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(path()), fs::directory_iterator()));
    }
};

const std::string small = " --size 8x8 --backend cpu ";

struct Rgba {
    float r = 0, g = 0, b = 0, a = 0;
};

// The pixels of an EXR file of that size.
std::vector<Rgba> exr_of(const OutputScenes &folder, const std::string &name, int width,
                         int height) {
    exr_context_t file;
    exr_context_initializer_t ways = EXR_DEFAULT_CONTEXT_INITIALIZER;
    REQUIRE(exr_start_read(&file, (folder.path() / name).c_str(), &ways) == EXR_ERR_SUCCESS);
    exr_attr_box2i_t window;
    REQUIRE(exr_get_data_window(file, 0, &window) == EXR_ERR_SUCCESS);
    REQUIRE((window.min.x == 0 && window.min.y == 0 && window.max.x == width - 1 &&
             window.max.y == height - 1));
    const std::size_t count = static_cast<std::size_t>(width * height);
    // A, B, G, R, as they lie in the file; version 3.1.5 of the library exchanges interleaved ones
    std::array<std::vector<float>, 4> planes;
    for (std::vector<float> &plane : planes) plane.resize(count);
    int lines = 0;
    REQUIRE(exr_get_scanlines_per_chunk(file, 0, &lines) == EXR_ERR_SUCCESS);
    for (int y = 0; y < height; y += lines) {
        exr_chunk_info_t chunk;
        REQUIRE(exr_read_scanline_chunk_info(file, 0, y, &chunk) == EXR_ERR_SUCCESS);
        exr_decode_pipeline_t pipeline;
        REQUIRE(exr_decoding_initialize(file, 0, &chunk, &pipeline) == EXR_ERR_SUCCESS);
        REQUIRE(pipeline.channel_count == 4);
        for (int i = 0; i < 4; ++i) {
            exr_coding_channel_info_t &channel = pipeline.channels[i];
            CHECK(channel.channel_name == std::string(1, "ABGR"[i]));
            CHECK(channel.data_type == EXR_PIXEL_HALF);
            float *to = planes[std::size_t(i)].data() + y * width;
            channel.decode_to_ptr = reinterpret_cast<std::uint8_t *>(to);
            channel.user_data_type = EXR_PIXEL_FLOAT;
            channel.user_bytes_per_element = sizeof(float);
            channel.user_pixel_stride = sizeof(float);
            channel.user_line_stride = width * static_cast<int>(sizeof(float));
        }
        REQUIRE(exr_decoding_choose_default_routines(file, 0, &pipeline) == EXR_ERR_SUCCESS);
        CHECK(exr_decoding_run(file, 0, &pipeline) == EXR_ERR_SUCCESS);
        exr_decoding_destroy(file, &pipeline);
    }
    exr_finish(&file);
    std::vector<Rgba> pixels(count);
    for (std::size_t i = 0; i < count; ++i)
        pixels[i] = {planes[3][i], planes[2][i], planes[1][i], planes[0][i]};
    return pixels;
}

} // namespace

TEST_CASE("a picture is of the kind that its suffix says") {
    OutputScenes folder;
    for (const char *name : {"a.png", "a.PNG"}) {
        CHECK(shell(folder, "fathom render good.sdf" + small + "-o " + name).exit == 0);
        CHECK(folder.read(name).starts_with("\x89PNG"));
    }
    for (const char *name : {"a.jpg", "a.jpeg", "a.JPG"}) {
        CHECK(shell(folder, "fathom render good.sdf" + small + "-o " + name).exit == 0);
        CHECK(folder.read(name).starts_with("\xff\xd8\xff"));
    }
    CHECK(shell(folder, "fathom render good.sdf" + small + "-o -").out.starts_with("\x89PNG"));
    CHECK(shell(folder, "fathom render good.sdf" + small + "-o /dev/null").exit == 0);
    const std::size_t before = folder.files();
    for (const char *name : {"a.tiff", "a", "a.webp", "a.sdf", "a.png.bak", ".png"}) {
        INFO(name);
        const Result refused = shell(folder, "fathom render good.sdf" + small + "-o " + name);
        CHECK(refused.exit == 2);
        CHECK(contains(refused.err, "picture"));
    }
    CHECK(folder.files() == before);
}

TEST_CASE("a section shows what lies inside, as the text that cuts the solid does") {
    OutputScenes folder;
    const std::string solid = "sphere(1).shell(0.2).paint(blue)",
                      camera = "camera(at: [1, 2, 5])\n";
    folder.write("whole.sdf", camera + solid);
    folder.write("cut.sdf",
                 camera + "(" + solid +
                     ") & plane(Z, 0.25).paint(material(diffuse: #e5793f, specular: black))");
    const auto rendered = [&](const std::string &words) {
        const std::string line = "fathom render --size 64x48 --samples 1 --backend cpu -o a.png ";
        REQUIRE(shell(folder, line + words).exit == 0);
        return fathom::decode_png(folder.read("a.png"))->rgba;
    };
    const auto whole = rendered("whole.sdf"), cut = rendered("cut.sdf"),
               section = rendered("whole.sdf --section z=..0.25");
    std::size_t orange = 0, differ = 0;
    for (std::size_t i = 0; i < whole.size(); i += 4) {
        orange += section[i] > section[i + 2] + 60;
        for (std::size_t k = i; k < i + 3; ++k) differ += std::abs(cut[k] - section[k]) > 2;
    }
    CHECK(orange > 40);
    CHECK(differ < 10); // of 9,216 numbers: pixels on the rim
    CHECK(rendered("whole.sdf --section z=-3..4") == whole);
    folder.write("ball.sdf", "sphere(1)\n");
    const std::string nothing =
        shell(folder, "fathom render ball.sdf -o none.png --size 16x16 --section z=50..60").err;
    CHECK(contains(nothing, "the section z=50..60 keeps nothing of this scene"));
    CHECK(contains(nothing, "its solid lies from z = -"));
    CHECK(contains(nothing, "`--section z=.."));
    for (const char *wrong : {"z=1", "w=..1", "z=..", "z=2..1", "z=0..0", "z=a..", "z"})
        CHECK(contains(
            shell(folder, std::string("fathom render whole.sdf -o a.png --section ") + wrong).err,
            "a section is AXIS=A..B"));
}

TEST_CASE("a JPEG shows the picture that the PNG shows, as finely as is asked") {
    OutputScenes folder;
    const std::string line = "fathom render good.sdf --size 64x48 --backend cpu ";
    REQUIRE(shell(folder, line + "-o a.png").exit == 0);
    REQUIRE(shell(folder, line + "-o a.jpg").exit == 0);
    REQUIRE(shell(folder, line + "-o b.jpg --quality 90").exit == 0);
    REQUIRE(shell(folder, line + "-o c.jpg --quality 20").exit == 0);
    CHECK(folder.read("a.jpg") == folder.read("b.jpg"));
    CHECK(folder.read("c.jpg").size() < folder.read("a.jpg").size());
    std::string error;
    const auto png = fathom::test::decoded_image(folder.read("a.png"), error);
    const auto jpeg = fathom::test::decoded_image(folder.read("a.jpg"), error);
    REQUIRE(png);
    REQUIRE(jpeg);
    REQUIRE(jpeg->width == 64);
    REQUIRE(jpeg->height == 48);
    double sum = 0;
    for (std::size_t i = 0; i < png->rgba.size(); ++i)
        sum += std::abs(png->rgba[i] - jpeg->rgba[i]);
    CHECK(sum / static_cast<double>(png->rgba.size()) < 0.01);
    CHECK(shell(folder, line + "-o a.png --quality 50").exit == 2);
    CHECK(shell(folder, line + "-o a.jpg --quality 0").exit == 2);
}

TEST_CASE(
    "without a background pixels are transparent by what covers them, in a PNG and in an EXR") {
    OutputScenes folder;
    folder.write("black.sdf", "sphere(1).paint(tomato)\nbackground(d => black)\n");
    // A ground without an end fades.
    folder.write("ground.sdf", "plane(Y, 0).paint(white)\nbackground(d => black)\n"
                               "camera(at: [0, 1, 5], look_at: [0, 1, 0])\n");
    for (const std::string name : {"black", "ground"}) {
        const std::string line =
            "fathom render " + name + ".sdf --size 48x32 --samples 4 --backend cpu ";
        REQUIRE(shell(folder, line + "-o opaque.png").exit == 0);
        REQUIRE(shell(folder, line + "--alpha -o clear.png").exit == 0);
        REQUIRE(shell(folder, line + "--alpha -o clear.exr").exit == 0);
        REQUIRE(shell(folder, line + "-o opaque.exr").exit == 0);
        std::string error;
        const auto opaque = fathom::test::decoded_image(folder.read("opaque.png"), error),
                   clear = fathom::test::decoded_image(folder.read("clear.png"), error);
        const std::vector<Rgba> exr = exr_of(folder, "clear.exr", 48, 32),
                                whole = exr_of(folder, "opaque.exr", 48, 32);
        REQUIRE((opaque && clear));
        int none = 0, some = 0, all = 0;
        for (std::size_t i = 0; i < exr.size(); ++i) {
            const float *pixel = clear->rgba.data() + 4 * i, alpha = pixel[3];
            ++(alpha == 0 ? none : alpha < 1 ? some : all);
            CHECK(std::abs(exr[i].a - alpha) < 0.003);
            CHECK(whole[i].a == 1);
            const float linear[3] = {exr[i].r, exr[i].g, exr[i].b},
                        over[3] = {whole[i].r, whole[i].g, whole[i].b};
            for (std::size_t c = 0; c < 3; ++c) {
                CHECK(std::abs(pixel[c] * alpha - opaque->rgba[4 * i + c]) < 0.015);
                CHECK(std::abs(linear[c] - pixel[c] * alpha) < 0.015);
                CHECK(linear[c] == over[c]); // over black
            }
        }
        CHECK((none > 100 && some > 20 && all > 100));
        // One sample, and more where the outline needs them.
        REQUIRE(
            shell(folder, "fathom render " + name + ".sdf --size 48x32 --alpha -o a.png").exit ==
            0);
        const auto rough = fathom::test::decoded_image(folder.read("a.png"), error);
        int between = 0;
        for (std::size_t i = 3; i < rough->rgba.size(); i += 4)
            between += rough->rgba[i] > 0 && rough->rgba[i] < 1;
        CHECK(between > 20);
    }
    const std::string line = "fathom render black.sdf --size 8x8 --alpha ";
    CHECK(shell(folder, line + "-o -").out.starts_with("\x89PNG"));
    const std::size_t before = folder.files();
    for (const char *out : {"-o a.jpg", "-o a.gif --frames 0..2", "-o a.sums", "-o - --stream raw",
                            "-o b.png --backend gl", "-o b.png --frames 0..4 --contact-sheet 2x2"})
        CHECK(shell(folder, line + out).exit == 2);
    CHECK(shell(folder, "fathom render black.sdf -o b.exr --quality 3").exit == 2);
    CHECK(shell(folder, "fathom render black.sdf -o b.exr --skip-existing").exit == 2);
    CHECK(shell(folder, "fathom merge -o b.exr a.png").exit == 2);
    CHECK(
        shell(folder, "fathom farm parallel black.sdf --out job --frames 0..2 --film a.mp4 --alpha")
            .exit == 2);
    CHECK(folder.files() == before);
    // With an open shutter each sample has a time, and what moves is transparent where it was in part.
    folder.write("moves.sdf",
                 "box(1).translate(x: 4 * time)\ncamera(at: [0, 0, 9], look_at: [0, 0, 0])\n");
    REQUIRE(
        shell(
            folder,
            "fathom render moves.sdf --size 48x32 --samples 8 --shutter 1 --fps 1 --alpha -o m.exr")
            .exit == 0);
    int between = 0;
    for (const Rgba &pixel : exr_of(folder, "m.exr", 48, 32)) between += pixel.a > 0 && pixel.a < 1;
    CHECK(between > 60);
}

TEST_CASE("no file holds something else than its suffix says") {
    OutputScenes folder;
    folder.write("save.yaml", "[]\n");
    const std::size_t before = folder.files();
    for (const char *line :
         {"fathom compile good.sdf -o a.png", "fathom compile good.sdf -o a.html",
          "fathom compile good.sdf -o a.HTML", "fathom compile good.sdf -o a.spv",
          "fathom compile good.sdf --target html -o a.frag",
          "fathom compile good.sdf --target spirv -o a.glsl", "fathom compile good.sdf -o a.sdf",
          "fathom export good.sdf -o a.sdf", "fathom import save.yaml -o a.yaml",
          "fathom compile good.sdf -o a.jpg"}) {
        INFO(line);
        const Result refused = shell(folder, line);
        CHECK(refused.exit == 2);
        CHECK(contains(refused.err, "writes"));
    }
    CHECK(folder.files() == before);
    CHECK(contains(shell(folder, "fathom compile good.sdf -o a.html").err, "--target html"));
    for (const char *line :
         {"fathom compile good.sdf -o a.frag", "fathom compile good.sdf -o a.txt",
          "fathom compile good.sdf -o a", "fathom compile good.sdf --target html -o a.html",
          "fathom compile good.sdf --target spirv -o a.spv", "fathom export good.sdf -o a.yaml"}) {
        INFO(line);
        CHECK(shell(folder, line).exit == 0);
    }
}

TEST_CASE("every target writes a file of its suffix, and no other known one") {
    OutputScenes folder;
    for (const glsl::Target target : glsl::all_targets()) {
        const std::string name = glsl::traits_of(target).name;
        const std::string line = "fathom compile good.sdf --target " + name + " -o a";
        INFO(line);
        CHECK(shell(folder, line + glsl::traits_of(target).suffix).exit == 0);
        CHECK(shell(folder, line + ".sdf").exit == 2);
        for (const glsl::Target other : glsl::all_targets()) {
            const std::string suffix = glsl::traits_of(other).suffix;
            if (suffix == glsl::traits_of(target).suffix) continue;
            const Result refused = shell(folder, line + suffix);
            CHECK(refused.exit == 2);
            // The way to what the suffix promises is a line that works.
            const std::size_t begin = refused.err.find("; `fathom compile") + 3;
            const std::string way = refused.err.substr(begin, refused.err.find('`', begin) - begin);
            CHECK(shell(folder, way + " good.sdf -o b" + suffix).exit == 0);
        }
        const bool page = glsl::traits_of(target).form == glsl::Form::Page;
        CHECK(shell(folder, "fathom compile good.sdf --field-only --target " + name).exit ==
              (page ? 2 : 0));
        CHECK(shell(folder, "fathom compile good.sdf --noise-cache -o a.frag --target " + name)
                  .exit == (glsl::traits_of(target).noise_cache ? 0 : 2));
    }
}

TEST_CASE("what cannot be written is refused, with what to write") {
    OutputScenes folder;
    const std::size_t before = folder.files();
    const auto refused = [&](const std::string &line, const std::string &remedy) {
        INFO(line);
        const Result result = shell(folder, line);
        CHECK(result.exit == 2);
        CHECK(result.out.empty());
        CHECK_THAT(result.err, Catch::Contains(remedy));
    };
    refused("fathom render good.sdf" + small + "--frames 0..2 -o /dev/null", ".png");
    refused("fathom render good.sdf" + small + "-o ''", "wants a name");
    refused("fathom compile good.sdf -o ''", "wants a name");
    refused("fathom view good.sdf --record ''", "wants a name");
    const std::string last = std::string(" or ") + glsl::traits_of(glsl::all_targets().back()).name;
    refused("fathom compile good.sdf --target HTML", last + ", not `HTML`");
    refused("fathom compile good.sdf --target ''", last + ", not ``");
    refused("fathom compile good.sdf --target html --field-only", "--target es300 --field-only");
    refused("fathom compile good.sdf --noise-cache -o -", "name the first by -o");
    refused("fathom compile good.sdf --noise-cache", "name the first by -o");
    CHECK(folder.files() == before);
}

TEST_CASE("a picture's folder is looked for before the picture is made") {
    OutputScenes folder;
    fs::create_directory(folder / "folder.png");
    for (const char *out : {"none/a.png", "folder.png"}) {
        INFO(out);
        // At this size it would take minutes.
        const Result refused = shell(folder, std::string("timeout 20 '" FATHOM_PROGRAM "' render "
                                                         "good.sdf --backend cpu --samples 256 "
                                                         "--size 4096x4096 -o ") +
                                                 out);
        CHECK(refused.exit == 3);
        CHECK(contains(refused.err, "cannot write"));
    }
    CHECK(contains(shell(folder, "fathom render good.sdf -o none/a.png").err, "no folder `none`"));
    // Of all frames, before the first one.
    fs::create_directory(folder / "f0");
    CHECK(shell(folder, "fathom render good.sdf" + small + "--frames 0..2 -o f#/a.png").exit == 3);
    CHECK_FALSE(fs::exists(folder / "f0/a.png"));
}

TEST_CASE("no option is taken that nothing reads") {
    OutputScenes folder;
    for (const char *line :
         {"render good.sdf --size 8x8 --backend cpu -o a.png --fps 24",
          "render good.sdf --size 8x8 --backend cpu --cache -o a.png",
          "check good.sdf --json --explain", "check good.sdf -I nowhere",
          "check good.sdf -I good.sdf", "eval good.sdf --at nan,0,0", "eval good.sdf --at inf,0,0",
          "eval good.sdf", "help nonsense", "help render check", "check good.sdf -D nothing=1"}) {
        INFO(line);
        const Result refused = shell(folder, std::string("fathom ") + line);
        CHECK(refused.exit == 2);
        CHECK(refused.out.empty());
        CHECK(refused.err.starts_with("fathom: "));
    }
    for (const char *line : {"check --watch -", "compile --watch -"}) {
        const Result refused = shell(
            folder, std::string("echo 'sphere(1)' | timeout 20 '" FATHOM_PROGRAM "' ") + line);
        CHECK(refused.exit == 2);
        CHECK(contains(refused.err, "standard input is none"));
    }
}

TEST_CASE("no result is written over a file that the scene reads") {
    OutputScenes folder;
    REQUIRE(shell(folder, "fathom render good.sdf" + small + "-o tiles_0001.png").exit == 0);
    const std::string image = folder.read("tiles_0001.png");
    folder.write("tiled.sdf", "import \"module.frag\"\n"
                              "box(1).paint(material(texture: image(\"tiles_0001.png\")))\n");
    folder.write("module.frag", "let one = 1\n");
    for (const std::string &line : {"render tiled.sdf" + small + "-o tiles_0001.png",
                                    "render tiled.sdf" + small + "--frames 0..3 -o tiles.png",
                                    std::string("compile tiled.sdf -o module.frag")}) {
        INFO(line);
        const Result refused = shell(folder, "fathom " + line);
        CHECK(refused.exit == 2);
        CHECK(contains(refused.err, "that is the file that is read"));
    }
    CHECK(folder.read("tiles_0001.png") == image);
    CHECK_FALSE(fs::exists(folder / "tiles_0000.png"));
    CHECK(folder.read("module.frag") == "let one = 1\n");
}

TEST_CASE("a param that a shader holds as a constant is said, with its place and the way out") {
    OutputScenes folder;
    for (const glsl::Target target : glsl::all_targets()) {
        if (glsl::traits_of(target).form != glsl::Form::Text) continue;
        INFO(glsl::traits_of(target).name);
        const Result written = shell(folder, std::string("fathom compile counted.sdf --target ") +
                                                 glsl::traits_of(target).name);
        CHECK(written.exit == 0);
        CHECK(contains(written.err, "counted.sdf:1:7: note[fixed-param]"));
        CHECK(contains(written.err, "-D n=…"));
        CHECK_FALSE(contains(written.err, "size"));
        CHECK(contains(written.out, "n = 3 in 1..6  (counted.sdf:1)"));
        CHECK(contains(written.out, "-D NAME=VALUE"));
        // One value everywhere: the count, and the size that reads it.
        CHECK(contains(written.out, "const int param_n = 3;"));
        CHECK_FALSE(contains(written.out, "uniform int param_n"));
        CHECK_FALSE(contains(written.out, "\"name\": \"param_n\""));
    }
    // A page has a text for each of few values.
    const Result page = shell(folder, "fathom compile counted.sdf --target html");
    CHECK(contains(page.out, "\"name\": \"param_size\""));
    for (const char *n : {"1", "2", "3", "4", "5", "6"})
        CHECK(contains(page.out, std::string("\"values\": {\"n\": [") + n + "]}"));
    CHECK(page.out.find("{\"n\": [3]}") < page.out.find("{\"n\": [1]}")); // its own is the first
    CHECK(page.err.empty());
    const Result piped = shell(folder, "fathom compile - --target html <counted.sdf");
    CHECK(contains(piped.out, "\"values\": {\"n\": [6]}"));
    const Result other = shell(folder, "fathom compile counted.sdf --target es300 -D n=5");
    CHECK(contains(other.out, "n = 5 in 1..6"));
    CHECK(contains(other.out, "const int param_n = 5;"));
    CHECK(shell(folder, "fathom compile counted.sdf --target spirv -o a.spv").exit == 0);
    CHECK(shell(folder, "fathom check counted.sdf").err ==
          "counted.sdf: ok, proved, lipschitz 1, exact\n");
    // … and of a field that is proved at its value alone
    folder.write("divided.sdf", "param k = 0.2 in 0..1\nimplicit(p => length(p) - 1 + "
                                "0.01 * sin(p.x / k), within: ball(2))\n");
    const Result divided = shell(folder, "fathom check divided.sdf");
    CHECK(divided.exit == 0);
    CHECK(contains(divided.err, "warning[range-unproved]"));
    CHECK(contains(divided.err, "divided.sdf: ok, proved at the present values, lipschitz 1.05"));
}

TEST_CASE("a cell that cannot vanish stays a slider, one that can decides what there is") {
    OutputScenes folder;
    folder.write("cells.sdf", "param gap = 1 in 0.5..2.0\nparam row = 0 in 0.0..2.0\n"
                              "sphere(0.2).repeat([gap, 0, row])\n");
    const Result page = shell(folder, "fathom compile cells.sdf --target html");
    CHECK(contains(page.out, "\"name\": \"param_gap\""));
    CHECK_FALSE(contains(page.out, "\"name\": \"param_row\""));
    CHECK(contains(page.err, "cells.sdf:2:7: note[fixed-param]"));
}

TEST_CASE("GLSL ES says in words which values its uniforms want") {
    OutputScenes folder;
    const std::string text = shell(folder, "fathom compile counted.sdf --target es300").out;
    CHECK(contains(text, "//   name "));
    CHECK(contains(text, "//   fathom_resolution  "));
    CHECK(contains(text, "vec2(1280.0, 720.0)"));
    CHECK_FALSE(contains(text, "uniforms' defaults"));
    // Each uniform has a line in the list.
    std::istringstream lines(text);
    std::size_t uniforms = 0;
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with("uniform ")) continue;
        std::istringstream words(line);
        std::string word, type, name;
        words >> word >> type >> name;
        name.pop_back(); // the semicolon
        INFO(line);
        CHECK(contains(text, "//   " + name + " "));
        ++uniforms;
    }
    CHECK(uniforms > 10);
    const std::size_t size = text.find("//   param_size");
    REQUIRE(size != text.npos);
    const std::string line = text.substr(size, text.find('\n', size) - size);
    CHECK(contains(line, "float"));
    CHECK(contains(line, "0.4"));
    CHECK(line.ends_with("0.1..0.5"));
    CHECK(contains(shell(folder, "fathom compile counted.sdf").out, "uniforms' defaults"));
}

TEST_CASE("commands that write into one folder at a time leave each other's files alone") {
    ScratchFolder folder;
    folder.write("ball.sdf", "sphere(1)\n");
    const Result all = shell(folder, "for i in $(seq 40); do fathom mesh ball.sdf --resolution 8 "
                                     "-o many$i.obj & done; wait");
    CHECK(all.err == "");
    for (int k = 1; k <= 40; ++k)
        CHECK_FALSE(folder.read("many" + std::to_string(k) + ".obj").empty());
}
