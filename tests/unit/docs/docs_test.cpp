// Every program in the documentation is checked and proved: what a page shows has to work.
#include "driver/compile.h"

#include <catch2/catch.hpp>

#include <fstream>
#include <sstream>

using namespace fathom;

namespace {

std::string file_text(const std::filesystem::path &path) {
    std::ifstream file(path);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

// The text between ```sdf and the next ```.
std::vector<std::string> programs(const std::string &page) {
    std::vector<std::string> out;
    const std::string open = "```sdf\n";
    for (std::size_t at = page.find(open); at != std::string::npos; at = page.find(open, at)) {
        at += open.size();
        std::size_t end = page.find("```", at);
        out.push_back(page.substr(at, end - at));
        at = end;
    }
    return out;
}

} // namespace

TEST_CASE("the programs on the pages of docs/ work") {
    const std::filesystem::path root = FATHOM_SOURCE_DIR;
    std::size_t count = 0;
    for (const char *page : {"docs/language.md", "docs/tutorial.md", "docs/from-fathom.md",
                             "docs/from-shadertoy.md", "docs/from-openscad.md", "docs/from-curv.md",
                             "docs/from-bauble.md", "docs/from-python.md"}) {
        for (const std::string &program : programs(file_text(root / page))) {
            INFO(page << ":\n" << program);
            driver::Compilation c =
                driver::compile_text("example.sdf", program, root / "examples", {});
            std::string report;
            for (const Diagnostic &d : c.diagnostics.sorted())
                if (d.severity == Severity::Error) report += to_text(d, c.sources, false);
            INFO(report);
            CHECK(c.good());
            ++count;
        }
    }
    CHECK(count > 20);
}

TEST_CASE("docs/limits.md lists every limit with what it is unless said") {
    const std::string page = file_text(std::filesystem::path(FATHOM_SOURCE_DIR) / "docs/limits.md");
    for (const LimitRow &row : limit_rows()) {
        std::string usual = std::to_string(row.usual);
        for (std::size_t i = usual.size(); i > 3; i -= 3) usual.insert(i - 3, ",");
        const std::string line = std::string("| `") + row.name + "` | " + usual + " | " + row.unit +
                                 " | " + row.what + " |\n";
        INFO(line);
        CHECK(page.find(line) != std::string::npos);
    }
}
