// Every example and every entry of the library again, by the second checker of slopes
// (tests/support/second_check.h), which shares nothing with the proof: the marched field is nowhere
// certainly steeper than 1. Where the second checker reaches a bound of its own it says the same.
#include "driver/compile.h"
#include "driver/verdict.h"
#include "ir/lower/lower.h"
#include "tests/support/effort.h"
#include "tests/support/library_entries.h"
#include "tests/support/second_check.h"

#include <catch2/catch.hpp>

#include <cstdio>
#include <filesystem>

using namespace fathom;
namespace fs = std::filesystem;

namespace {

const fs::path root = FATHOM_SOURCE_DIR;

struct Counts {
    int all = 0, bounded = 0, silent = 0; // bounded: by both; silent: no gradient was enclosed
};

// Long ways off, rays march by the way to boxes; near it, by what was proved.
void check_again(const std::string &name, driver::Compilation c, Counts &counts) {
    if (c.scene.top_level.empty()) return; // a statement
    INFO(name);
    REQUIRE(c.good());
    if (driver::judge(c.scene).status != ir::ProofStatus::Proved) return; // nothing is promised
    // In what a region leaves out a step is no slope of anything: it is the way out, or longer.
    for (const ir::ShapeFact &fact : c.scene.facts)
        if (fact.detour > 1) return;
    // Steps by cells are as long as is safe, and no slope of anything.
    c.scene.cells.clear();
    ir::lower(c.scene);
    const long work = test::effort(4'000); // nodes that it evaluates
    std::array<double, 3> lo{-4, -4, -4}, hi{4, 4, 4};
    if (!c.scene.bounds.empty())
        for (std::size_t k = 0; k < 3; ++k) {
            const double room = 0.1 * (c.scene.bounds.hi[k] - c.scene.bounds.lo[k]);
            lo[k] = c.scene.bounds.lo[k] - room, hi[k] = c.scene.bounds.hi[k] + room;
        }
    const test::second::Result found = test::second::slopes(
        c.scene, c.scene.distance, 0.37 * c.scene.render.time_end, lo, hi, work);
    std::printf("%-32s %.4f at least, %.4f at most\n", name.c_str(), found.seen, found.at_most);
    INFO("at [" << found.where[0] << ", " << found.where[1] << ", " << found.where[2] << "]");
    CHECK(found.seen <= 1 + 1e-6);
    ++counts.all;
    counts.bounded += found.at_most < test::second::endless;
    counts.silent += found.seen == 0;
}

} // namespace

TEST_CASE("a second checker finds nothing steeper than what is proved") {
    Counts counts;
    for (const fs::directory_entry &entry : fs::directory_iterator(root / "examples"))
        if (entry.path().extension() == ".sdf")
            check_again(entry.path().filename().string(), driver::compile_file(entry.path(), {}),
                        counts);
    for (const test::LibraryExample &entry : test::library_examples())
        check_again(entry.name,
                    driver::compile_text("entry.sdf", entry.text, root / "examples/parts", {}),
                    counts);
    std::printf("%d programs; of %d the second checker has a bound, too, of %d it encloses no "
                "gradient\n",
                counts.all, counts.bounded, counts.silent);
    CHECK(counts.all > 120);
    CHECK(counts.bounded > counts.all / 3);
    CHECK(counts.silent < counts.all / 10);
}
