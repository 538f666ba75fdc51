// A deterministic smoke of the fuzz target: texts of the project, broken at random, give a whole
// tree and reports that can be printed; and a program without an error formats lawfully.
#include "programs.h"
#include "support.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

using lang_test::Parsed;

namespace {

void check_survives(const std::string &text) {
    const Parsed parsed(text);
    INFO(text);
    REQUIRE(lang_test::defect(parsed) == "");
    for (const fathom::Diagnostic &d : parsed.diagnostics.items()) {
        CHECK_FALSE(to_text(d, parsed.sources, false).empty());
        CHECK_FALSE(to_json(d, parsed.sources).empty());
        CHECK(d.primary.span.source == parsed.id);
        CHECK(d.primary.span.begin <= d.primary.span.end);
        CHECK(d.primary.span.end <= text.size());
    }
    if (!parsed.diagnostics.items().empty()) return;
    const Parsed again(parsed.formatted());
    INFO(again.text());
    REQUIRE(again.report() == "");
    CHECK(again.tree() == parsed.tree());
    CHECK(again.formatted() == again.text());
}

} // namespace

TEST_CASE("mutated files of the project") {
    const auto files = lang_test::corpus();
    REQUIRE(files.size() > 10);
    for (unsigned seed = 0; seed < 3000; ++seed) {
        const lang_test::File &file = files[seed % files.size()];
        INFO(file.path << " seed " << seed);
        check_survives(lang_test::mutated(file.text.substr(0, 3000), seed));
    }
}

TEST_CASE("mutated random programs") {
    for (unsigned seed = 0; seed < 3000; ++seed)
        check_survives(lang_test::mutated(lang_test::random_program(seed), seed));
}

TEST_CASE("every beginning of a file") {
    for (const lang_test::File &file : lang_test::corpus()) {
        if (file.path.find("colonnade") == std::string::npos &&
            file.path.find("tree") == std::string::npos)
            continue;
        for (std::size_t length = 0; length < file.text.size() && length < 1500; ++length)
            check_survives(file.text.substr(0, length));
    }
}

TEST_CASE("the acceptance scenes are read without an error") {
    std::size_t scenes = 0;
    for (const lang_test::File &file : lang_test::corpus()) {
        if (file.path.rfind("examples/", 0) != 0 && file.path.rfind("stdlib/", 0) != 0 &&
            file.path.find("12_errors") == std::string::npos)
            continue;
        ++scenes;
        INFO(file.path);
        CHECK(Parsed(file.text).report() == "");
    }
    CHECK(scenes >= 13);
}
