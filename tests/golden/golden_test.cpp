// Runs every case below tests/golden/cases; FATHOM_UPDATE=1 rewrites what differs, and fails that
// run. And what each code owes: a case that reports it, and a page whose wrong example reports it
// and whose fixed one does not.
#include "base/diagnostic.h"
#include "driver/compile.h"
#include "golden/runner.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

namespace {

namespace fs = std::filesystem;
using namespace fathom;

const fs::path root = FATHOM_SOURCE_DIR;

std::vector<fs::path> case_files() {
    std::vector<fs::path> files;
    for (const fs::directory_entry &entry :
         fs::recursive_directory_iterator(root / "tests/golden/cases"))
        // A folder `parts` holds what cases import.
        if (entry.path().extension() == ".sdf" && entry.path().parent_path().filename() != "parts")
            files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

struct Ran {
    fs::path path;
    golden::Case golden;
    golden::Outcome outcome; // empty where the file is no case
};

// Each case, run once for all tests.
const std::vector<Ran> &cases() {
    static const std::vector<Ran> ran = [] {
        std::vector<Ran> all;
        for (const fs::path &file : case_files()) {
            all.push_back({file, golden::read_case(file.string()), {}});
            if (all.back().golden.error.empty())
                all.back().outcome = golden::run_case(all.back().golden);
        }
        return all;
    }();
    return ran;
}

std::string read(const fs::path &file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

// The ```sdf blocks of a page under a heading.
std::vector<std::string> examples(const std::string &page, const std::string &heading) {
    std::vector<std::string> found;
    std::istringstream lines(page);
    std::string current;
    bool under = false, in_block = false;
    for (std::string line; std::getline(lines, line);) {
        if (!in_block && line.starts_with("## ")) under = line == "## " + heading;
        if (in_block && line == "```") {
            if (under) found.push_back(current);
            in_block = false;
        } else if (in_block) {
            current += line + "\n";
        } else if (line == "```sdf") {
            in_block = true;
            current.clear();
        }
    }
    return found;
}

// Codes that no text of a scene can raise, as flags ask for them, or save files (their golden cases are those of the save
// format's tests), what only `compile` says (tests/cli), and what only a bug of ours can raise.
const std::set<std::string> without_scene{"yaml-structure", "yaml-value",     "yaml-version",
                                          "fixed-param",    "shader-invalid", "unsupported",
                                          "unproved"};

std::set<std::string> codes_of(const std::string &program) {
    driver::Compilation compilation =
        driver::compile_text("example.sdf", program, root / "tests/golden/cases", {});
    std::set<std::string> codes;
    for (const Diagnostic &diagnostic : compilation.diagnostics.items())
        codes.emplace(code_name(diagnostic.code));
    return codes;
}

} // namespace

TEST_CASE("golden cases") {
    bool update = std::getenv("FATHOM_UPDATE") && std::string(std::getenv("FATHOM_UPDATE")) == "1";
    for (const auto &[file, golden, outcome] : cases()) {
        INFO(fs::relative(file, root).string());
        if (!golden.error.empty()) {
            FAIL_CHECK(golden.error);
            continue;
        }
        bool differs = false;
        for (std::size_t i = 0; i < golden.sections.size(); ++i) {
            if (golden.sections[i].text == outcome.actual[i].text) continue;
            differs = true;
            FAIL_CHECK(golden.sections[i].stage
                       << ": "
                       << golden::difference(golden.sections[i].text, outcome.actual[i].text));
        }
        if (differs && update)
            std::ofstream(file, std::ios::binary) << golden::write_case(golden, outcome.actual);
        INFO("a case reports an error if, and only if, its name begins with `fail_`");
        CHECK(outcome.has_errors == golden.file.starts_with("fail_"));
    }
    CHECK(cases().size() >= 40);
}

TEST_CASE("each fix that a message proposes fixes what it is about") {
    std::size_t fixed = 0;
    for (const auto &[file, golden, outcome] : cases()) {
        if (!golden.error.empty()) continue; // "golden cases" says so
        INFO(golden.file << "\n" << outcome.fixed.program);
        CHECK(outcome.fixed.stuck.empty());
        fixed += outcome.fixed.program != golden.program;
    }
    CHECK(fixed >= 40);
}

TEST_CASE("each code has a golden case that reports it") {
    std::set<std::string> reported = without_scene;
    for (const Ran &ran : cases())
        reported.insert(ran.outcome.codes.begin(), ran.outcome.codes.end());
    for (Code code : all_codes()) {
        INFO(code_name(code));
        CHECK(reported.count(std::string(code_name(code))) == 1);
    }
}

TEST_CASE("each code has a page, whose wrong example reports it and whose fixed one does not") {
    for (Code code : all_codes()) {
        std::string name(code_name(code));
        std::string page = read(root / "docs/diagnostics" / (name + ".md"));
        INFO("docs/diagnostics/" << name << ".md");
        CHECK(page.starts_with("# " + name + "\n"));
        if (without_scene.count(name)) continue;
        std::vector<std::string> wrong = examples(page, "Wrong"), fixed = examples(page, "Fixed");
        CHECK(!wrong.empty());
        CHECK(!fixed.empty());
        for (const std::string &program : wrong) {
            INFO("wrong:\n" << program);
            CHECK(codes_of(program).count(name) == 1);
        }
        for (const std::string &program : fixed) {
            INFO("fixed:\n" << program);
            CHECK(codes_of(program).empty());
        }
    }
}

TEST_CASE("no page is of a code that does not exist") {
    for (const fs::directory_entry &entry : fs::directory_iterator(root / "docs/diagnostics")) {
        INFO(entry.path().filename().string());
        CHECK(code_by_name(entry.path().stem().string()).has_value());
    }
}

TEST_CASE("the program in the README is right as it stands there") {
    std::string page = read(root / "README.md");
    std::size_t begin = page.find("```\nlet "), end = page.find("\n```", begin + 4);
    REQUIRE(begin != page.npos);
    REQUIRE(end != page.npos);
    std::string program = page.substr(begin + 4, end - begin - 3);
    INFO(program);
    CHECK(codes_of(program).empty());
    CHECK(std::count(program.begin(), program.end(), '\n') <= 12);
}
