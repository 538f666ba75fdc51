// A text is edited and compiled again with what earlier compilations found of its fields: all that
// is said and made of it is what a compilation of that text alone says and makes, to the bit; and an
// edit has only the fields searched that it touches. FATHOM_EFFORT=4 tries all examples, not a
// quarter.
#include "driver/compile.h"
#include "driver/verdict.h"
#include "ir/passes/dump.h"
#include "programs.h"
#include "random_scenes.h"
#include "tests/support/effort.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <bit>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>

using namespace fathom;
namespace fs = std::filesystem;

namespace {

std::string read(const fs::path &file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

driver::Compilation compiled(const std::string &text, const fs::path &folder,
                             proof::BoundCache *bounds) {
    driver::CompileOptions options;
    options.bounds = bounds;
    options.limits.proof = 20'000'000; // less work for both: what is cut off is cut off in both
    return driver::compile_text("a.sdf", text, folder, options);
}

// All that is said of a text and made of it, numbers by their bits.
struct Said {
    std::string out;
    void add(double x) { out += std::to_string(std::bit_cast<std::uint64_t>(x)) + ' '; }
    void add(const ir::Box &box) {
        for (std::size_t i = 0; i < 3; ++i) add(box.lo[i]), add(box.hi[i]);
    }
    void add(ir::NodeId id) { out += std::to_string(id.index) + ' '; }

    void add(const ir::ShapeFact &fact) {
        out += "\nfact " + std::to_string(int(fact.kind)) + std::to_string(int(fact.status)) + ' ';
        add(fact.lipschitz);
        add(fact.lipschitz_sup);
        add(fact.bounds);
        for (std::size_t i = 0; i < 3; ++i) {
            out += fact.symmetric[i] ? '1' : '0';
            add(fact.moment_arm[i]);
            out += std::to_string(fact.repeat.neighbors[i]) + ' ';
        }
        for (double x : {fact.outward, fact.inward, fact.curvature, fact.round, fact.detour})
            add(x);
        out += fact.local ? '1' : '0';
        out += fact.guard ? '1' : '0';
        add(fact.repeat.copy);
        for (const ir::PartialSum &sum : fact.partial) {
            add(sum.terms);
            for (double x : {sum.slope, sum.maximum, sum.minimum}) add(x);
        }
    }
    void add(const ir::CellBounds &cells) {
        add(cells.box);
        for (const auto *all : {&cells.lipschitz, &cells.way, &cells.bend})
            for (double x : *all) add(x);
    }
};

std::string said(const driver::Compilation &c) {
    Said all;
    all.out = driver::verdict_json(c);
    for (const Diagnostic &d : c.diagnostics.items()) all.out += to_text(d, c.sources, false);
    all.out += std::to_string(c.evaluations) + ' ' + std::to_string(c.proof_steps) + ' ' +
               std::to_string(c.scene.graph.size());
    for (const ir::ShapeFact &fact : c.scene.facts) all.add(fact);
    for (const auto &[shape, cells] : c.scene.cells) {
        all.out += std::to_string(shape.index) + ' ';
        all.add(cells);
    }
    for (const ir::CacheFact &fact : c.scene.caches) all.add(fact.slope), all.add(fact.span);
    all.add(c.scene.bounds);
    all.add(c.scene.far);
    all.add(c.scene.rounding.subtracted);
    for (const ir::Axiom &axiom : c.scene.axioms)
        all.out += axiom.says + ' ' + std::to_string(axiom.at.begin) + '\n';
    if (c.good()) {
        all.out += ir::dump(c.scene.graph, c.scene.distance);
        all.out += ir::dump(c.scene.graph, c.scene.hit);
    }
    return all.out;
}

// Where the literal numbers of a text are.
std::vector<std::pair<std::size_t, std::size_t>> numbers_in(const std::string &text) {
    std::vector<std::pair<std::size_t, std::size_t>> out;
    const auto digit = [&](std::size_t i) {
        return i < text.size() && std::isdigit(static_cast<unsigned char>(text[i]));
    };
    const auto in_word = [&](std::size_t i) {
        return std::isalnum(static_cast<unsigned char>(text[i])) || text[i] == '_' ||
               text[i] == '#';
    };
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (!digit(i) || (i > 0 && (in_word(i - 1) || text[i - 1] == '.'))) continue;
        std::size_t end = i;
        while (digit(end) || (end < text.size() && text[end] == '.' && digit(end + 1))) ++end;
        out.emplace_back(i, end);
        i = end;
    }
    return out;
}

// One edit as people make them; it need not compile.
std::string edited(const std::string &text, test::Dice &dice) {
    std::vector<std::size_t> lines{0};
    for (std::size_t i = 0; i < text.size(); ++i)
        if (text[i] == '\n') lines.push_back(i + 1);
    const std::size_t line = lines[std::size_t(dice.below(int(lines.size())))];
    const std::size_t line_end = std::min(text.find('\n', line), text.size());
    std::string out = text;
    switch (dice.below(6)) {
    case 0: return out.insert(0, "// all places move\n\n");
    case 1: return out + "\nsphere(0.25).translate(x: " + std::to_string(dice.below(9)) + ")\n";
    case 2: return out.erase(line, line_end - line); // leaves names undefined, perhaps
    case 3: return out.insert(0, "param added = 0.5 in 0..1\nlet unused = 3 * added\n");
    default: break; // most of all, numbers
    }
    const auto numbers = numbers_in(text);
    if (numbers.empty()) return out + "\nbox(1)\n";
    const auto [begin, end] = numbers[std::size_t(dice.below(int(numbers.size())))];
    const double value = std::strtod(text.substr(begin, end - begin).c_str(), nullptr);
    char number[32];
    if (text.substr(begin, end - begin).find('.') == std::string::npos)
        std::snprintf(number, sizeof number, "%d", int(value) + 1);
    else
        std::snprintf(number, sizeof number, "%.4g", value * dice.in(0.8, 1.3) + 0.01);
    return out.replace(begin, end - begin, number);
}

void compare_over_edits(std::string text, const fs::path &folder, proof::BoundCache &bounds,
                        int edits, test::Dice &dice) {
    for (int i = 0; i <= edits; ++i) {
        INFO(text);
        const std::string with = said(compiled(text, folder, &bounds));
        const std::string without = said(compiled(text, folder, nullptr));
        CHECK((with == without));
        const std::size_t before = bounds.searches();
        CHECK((said(compiled(text, folder, &bounds)) == with));
        CHECK(bounds.searches() == before); // nothing changed, nothing is searched
        text = edited(text, dice);
    }
}

} // namespace

TEST_CASE("random programs under edits") {
    test::Dice dice{0xed17};
    // one for all of them, and so small that it has to forget
    proof::BoundCache bounds(200'000);
    proof::BoundCache roomy;
    for (int i = 0; i < test::effort(8); ++i) {
        INFO(i);
        compare_over_edits(programs::scene(unsigned(i)), "", roomy, 2, dice);
        test::RandomScene scene(std::uint64_t(i) + 500);
        const std::string solid = test::text_of(*scene.solid(3));
        std::string params;
        for (const std::string &param : scene.params()) params += param;
        const std::string text = params + solid + "\n";
        CHECK((said(compiled(text, FATHOM_SOURCE_DIR "/examples", &bounds)) ==
               said(compiled(text, FATHOM_SOURCE_DIR "/examples", nullptr))));
        CHECK(bounds.bytes() <= 200'000);
    }
}

TEST_CASE("the examples under edits") {
    test::Dice dice{0xe8a3};
    proof::BoundCache bounds;
    std::vector<fs::path> files;
    for (const fs::directory_entry &entry : fs::directory_iterator(FATHOM_SOURCE_DIR "/examples"))
        if (entry.path().extension() == ".sdf") files.push_back(entry.path());
    std::ranges::sort(files);
    const std::size_t every = test::effort(1) >= 4 ? 1 : 4;
    REQUIRE(files.size() > every);
    for (std::size_t i = 0; i < files.size(); i += every) {
        const fs::path &file = files[i];
        INFO(file.filename().string());
        const std::string text = read(file);
        CHECK(compiled(text, file.parent_path(), &bounds).good());
        const std::string edit = edited(text, dice);
        INFO(edit);
        CHECK((said(compiled(edit, file.parent_path(), &bounds)) ==
               said(compiled(edit, file.parent_path(), nullptr))));
    }
}

TEST_CASE("an edit has searched what it touches, and no more") {
    constexpr int fields = 12;
    const auto scene = [](int changed, const std::string &number, const std::string &before) {
        std::string text = before;
        for (int i = 0; i < fields; ++i)
            text += "implicit(p => sin(" + (i == changed ? number : std::to_string(i + 1)) +
                    " * p.x) * cos(p.y) + 0.3 * p.z, within: ball(2)).translate(x: " +
                    std::to_string(5 * i) + ")\n";
        return text;
    };
    proof::BoundCache bounds;
    const auto searches = [&](const std::string &text) {
        const std::size_t before = bounds.searches();
        REQUIRE(compiled(text, "", &bounds).good());
        return bounds.searches() - before;
    };
    const std::size_t all = searches(scene(-1, "", ""));
    CHECK(all >= fields);
    CHECK(searches(scene(-1, "", "")) == 0);
    const std::size_t one = searches(scene(3, "4.5", ""));
    CHECK(one >= 1);
    CHECK(one <= all / fields + 1);
    CHECK(searches(scene(3, "4.5", "// a line above\n\n")) == 0);
    CHECK(searches(scene(3, "4", "")) == 0); // and back
    CHECK(searches(scene(-1, "", "param k = 1 in 0..2\nsphere(k)\n")) == 0);
    CHECK(searches(scene(7, "-3", "param k = 1 in 0..2\nsphere(k)\n")) <= all / fields + 1);
}

TEST_CASE("what a field reads is part of what is remembered") {
    const auto scene = [](const std::string &range, const std::string &region,
                          const std::string &time) {
        return "param k = 1 in " + range + "\nrender(time: " + time + ")\n" +
               "implicit(p => sin(k * p.x) + 0.2 * sin(time * p.y) + p.z, within: ball(" + region +
               "))\n";
    };
    proof::BoundCache bounds;
    for (const std::string &text :
         {scene("0..2", "2", "1"), scene("0..3", "2", "1"), scene("0..3", "4", "1"),
          scene("0..3", "4", "2"), scene("0..2", "2", "1")})
        CHECK((said(compiled(text, "", &bounds)) == said(compiled(text, "", nullptr))));
}
