// A deterministic smoke of tests/fuzz/compile_fuzz.cpp: whole programs broken at random, and those
// of the project, are answered by reports that print, or by a shader that glslang accepts.
// FATHOM_EFFORT=n tries n times as many.
#include "programs.h"
#include "tests/support/effort.h"
#include "tests/support/whole.h"
#include "tests/unit/lang/programs.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace {

void try_text(const std::string &text) {
    INFO(text);
    CHECK(fathom::test::whole_compiler(text).fault == "");
}

} // namespace

TEST_CASE("mutated random scenes") {
    for (unsigned seed = 0; seed < static_cast<unsigned>(fathom::test::effort(300)); ++seed)
        try_text(lang_test::mutated(programs::scene(seed), seed));
}

TEST_CASE("mutated scenes of the project") {
    std::vector<std::string> texts;
    for (const char *folder : {"tests/golden/cases", "tests/fuzz/seeds"})
        for (const auto &entry :
             std::filesystem::directory_iterator(std::filesystem::path(FATHOM_SOURCE_DIR) / folder))
            if (entry.path().extension() == ".sdf") {
                std::ifstream file(entry.path());
                std::stringstream text;
                text << file.rdbuf();
                texts.push_back(text.str().substr(0, 1200));
            }
    std::sort(texts.begin(), texts.end());
    REQUIRE(texts.size() > 50);
    for (unsigned seed = 0; seed < static_cast<unsigned>(fathom::test::effort(300)); ++seed)
        try_text(lang_test::mutated(texts[seed % texts.size()], seed));
}
