// A shader that is valid by glslang's small tables (backend-glsl/small_tables.h) is valid by those
// of its own version: the texts of all examples, and these broken at random, above all by words that
// versions disagree on. FATHOM_EFFORT=n breaks n times as many.
#include "backend-glsl/small_tables.h"
#include "backend-glsl/emit.h"
#include "backend-glsl/validate.h"
#include "driver/compile.h"
#include "tests/support/effort.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <filesystem>
#include <random>

using namespace fathom;
using glsl::Stage;
using glsl::Tables;

namespace {

std::vector<std::filesystem::path> example_files() {
    std::vector<std::filesystem::path> files;
    for (const auto &entry : std::filesystem::directory_iterator(FATHOM_SOURCE_DIR "/examples"))
        if (entry.path().extension() == ".sdf") files.push_back(entry.path());
    std::ranges::sort(files);
    return files;
}

std::string text_of(const std::filesystem::path &file, glsl::Target target) {
    driver::Compilation compilation = driver::compile_file(file.string(), {});
    REQUIRE(compilation.good());
    glsl::Options options;
    options.target = target;
    return glsl::emit(compilation.scene, options, compilation.diagnostics).text;
}

bool by_small_tables(const std::string &text) {
    const auto same = glsl::for_small_tables(text);
    return same && !glsl::validate(*same, Stage::Fragment, Tables::All);
}

bool by_its_own(const std::string &text) {
    return !glsl::validate(text, Stage::Fragment, Tables::All);
}

const std::vector<std::string> words{"varying",
                                     "attribute",
                                     "gl_FragColor = vec4(1.0)",
                                     "gl_Color",
                                     "gl_FragCoord",
                                     "gl_FragDepth",
                                     "gl_MaxDrawBuffers",
                                     "texture2D",
                                     "texture2DRect",
                                     "textureCube",
                                     "textureLod",
                                     "textureSize",
                                     "texelFetch",
                                     "sampler2D",
                                     "samplerBuffer",
                                     "usampler2D",
                                     "isampler2DRect",
                                     "sampler2DMS",
                                     "patch",
                                     "sample",
                                     "smooth",
                                     "flat",
                                     "noperspective",
                                     "centroid",
                                     "invariant",
                                     "precise",
                                     "double",
                                     "1.0lf",
                                     "0u",
                                     "uint",
                                     "uvec3",
                                     "int",
                                     "bool",
                                     "float",
                                     "vec3",
                                     "mat3",
                                     "mat2x3",
                                     "layout(location = 0)",
                                     "precision highp float;",
                                     "highp",
                                     "const",
                                     "in",
                                     "out",
                                     "inout",
                                     "uniform",
                                     "inverse",
                                     "determinant",
                                     "transpose",
                                     "outerProduct",
                                     "floatBitsToInt",
                                     "uintBitsToFloat",
                                     "packHalf2x16",
                                     "fma",
                                     "bitCount",
                                     "noise1",
                                     "ftransform",
                                     "dFdx",
                                     "round",
                                     "isnan",
                                     "sinh",
                                     "mix",
                                     "&",
                                     "|",
                                     "<<",
                                     ">>",
                                     "%",
                                     "^",
                                     "~",
                                     "?",
                                     ":",
                                     ";",
                                     "(",
                                     ")",
                                     "{",
                                     "}",
                                     "[",
                                     "]",
                                     ",",
                                     "=",
                                     "==",
                                     "+=",
                                     "-",
                                     "!",
                                     "1",
                                     "1.0",
                                     "true",
                                     "-1",
                                     "1e9",
                                     "p",
                                     "discard;",
                                     "break;",
                                     "continue;",
                                     "return;",
                                     "switch (1) { default: break; }",
                                     "#undef GL_ES",
                                     "__VERSION__",
                                     "GL_core_profile",
                                     "#extension GL_ARB_gpu_shader5 : enable",
                                     "#version 130",
                                     "asm",
                                     "union",
                                     "class",
                                     "template",
                                     "common",
                                     "filter",
                                     "struct",
                                     "void",
                                     "main",
                                     "sdf"};

bool in_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

// Where words and other marks begin in it.
std::vector<std::size_t> marks_of(const std::string &text) {
    std::vector<std::size_t> marks;
    for (std::size_t i = text.find('\n') + 1; i < text.size(); ++i)
        if (!std::isspace(static_cast<unsigned char>(text[i])) &&
            !(in_word(text[i]) && in_word(text[i - 1])))
            marks.push_back(i);
    return marks;
}

std::size_t end_of(const std::string &text, std::size_t mark) {
    std::size_t end = mark + 1;
    if (in_word(text[mark]))
        while (end < text.size() && in_word(text[end])) ++end;
    return end;
}

// A word left out, doubled, put in, or in the place of another.
std::string broken(const std::string &text, std::mt19937 &random) {
    const std::vector<std::size_t> marks = marks_of(text);
    const auto any = [&](const auto &list) { return list[random() % list.size()]; };
    const std::size_t at = any(marks), end = end_of(text, at), other = any(marks);
    const std::string here = text.substr(at, end - at),
                      there = text.substr(other, end_of(text, other) - other), word = any(words);
    std::string result = text;
    switch (random() % 5) {
    case 0: return result.erase(at, end - at);
    case 1: return result.insert(at, here + " ");
    case 2: return result.insert(at, word + " ");
    case 3: return result.replace(at, end - at, word);
    default: return result.replace(at, end - at, there);
    }
}

} // namespace

TEST_CASE("the texts of all examples are read by small tables") {
    for (const auto &file : example_files())
        for (const glsl::Target target : {glsl::Target::Glsl330, glsl::Target::GlslViewer}) {
            const std::string text = text_of(file, target);
            CAPTURE(file.string());
            if (!text.starts_with("#version 330 core\n")) continue; // of later versions
            const auto same = glsl::for_small_tables(text);
            REQUIRE(same);
            const auto complaint = glsl::validate(*same, Stage::Fragment, Tables::All);
            if (complaint) FAIL_CHECK(complaint->line << ": " << complaint->message);
            CHECK(by_its_own(text));
        }
}

TEST_CASE("what small tables take is valid") {
    std::mt19937 random(static_cast<unsigned>(test::seed()));
    std::vector<std::string> texts;
    for (const char *name : {"01_sphere", "06_gyroid_ball", "03_colonnade", "chess"})
        texts.push_back(text_of(std::string(FATHOM_SOURCE_DIR "/examples/") + name + ".sdf",
                                glsl::Target::Glsl330));
    int taken = 0, refused = 0;
    for (int i = 0; i < test::effort(400); ++i) {
        const std::string text = broken(texts[static_cast<std::size_t>(i) % texts.size()], random);
        const bool small = by_small_tables(text);
        CAPTURE(text);
        if (small) CHECK(by_its_own(text));
        ++(small ? taken : refused);
    }
    CHECK(taken > 0);
    CHECK(refused > taken);
}

TEST_CASE("what is not valid is refused with the words of the text's own version") {
    const std::string head = "#version 330 core\nout vec4 color;\nvoid main() {\n    ";
    for (const char *line :
         {"color = texture2D(missing, vec2(0.0));", "color = vec4(ftransform());",
          "int sampler2DRect = 1;", "int samplerBuffer = 1;", "color = vec4(x);",
          "float x = 1.0 color = vec4(x);", "color = vec4(inverse(1.0));", "int x = 1.0;",
          "color = vec4(floatBitsToInt(true));", "color = floatBitsToUint(1.0);", "int asm = 1;",
          "color = vec4(gl_Nothing);", "main();", "int x = gl_FragCoord;"}) {
        const std::string text = head + line + "\n}\n";
        CAPTURE(text);
        const auto complaint = glsl::validate(text);
        const auto own = glsl::validate(text, Stage::Fragment, Tables::All);
        REQUIRE(own);
        REQUIRE(complaint);
        CHECK(complaint->line == own->line);
        CHECK(complaint->message == own->message);
    }
}
