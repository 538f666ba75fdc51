// Each rule of the proof has a theorem, and each theorem a test that attacks it: the table at the end
// of docs/lipschitz.md against its sections, the files of proof/ and the tests that it names.
#include "repository.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <sstream>

using namespace fathom::style;

namespace {

const std::filesystem::path root = FATHOM_SOURCE_DIR;

std::string text_of(const std::filesystem::path &file) {
    std::string out;
    for (const std::string &line : lines_of(file)) out += line + "\n";
    return out;
}

struct Row {
    std::string section, where, test_file, test_case;
};

// The rows of the table, and all that the section about it says.
struct Page {
    std::vector<Row> rows;
    std::set<std::string> sections; // "2", "2.1", …
    std::string about;
};

std::string trimmed(const std::string &text) {
    const auto from = text.find_first_not_of(' '), to = text.find_last_not_of(' ');
    return from == text.npos ? "" : text.substr(from, to - from + 1);
}

Page read_page() {
    Page out;
    bool inside = false;
    for (const std::string &line : lines_of(root / "docs/lipschitz.md")) {
        if (line.starts_with("##")) {
            const std::string title = line.substr(line.find(' ') + 1);
            std::string number = title.substr(0, title.find(' '));
            if (number.ends_with(".")) number.pop_back();
            out.sections.insert(number);
            inside = number == "11";
            continue;
        }
        if (!inside) continue;
        out.about += line + "\n";
        if (!line.starts_with("| ") || line.starts_with("| section") || line.starts_with("| ---"))
            continue;
        std::vector<std::string> cells;
        std::istringstream parts(line.substr(1));
        for (std::string cell; std::getline(parts, cell, '|');) cells.push_back(trimmed(cell));
        REQUIRE(cells.size() == 3);
        const std::size_t end = cells[2].find("`: ");
        INFO(line);
        REQUIRE(cells[2].starts_with("`"));
        REQUIRE(end != std::string::npos);
        out.rows.push_back(
            {cells[0], cells[1], cells[2].substr(1, end - 1), cells[2].substr(end + 3)});
    }
    return out;
}

bool has_word(const std::string &text, const std::string &word) {
    const std::string ends = " \n;|,.:";
    for (std::size_t at = text.find(word); at != text.npos; at = text.find(word, at + 1)) {
        const bool begins = at == 0 || ends.find(text[at - 1]) != ends.npos;
        const std::size_t after = at + word.size();
        if (begins && (after == text.size() || ends.find(text[after]) != ends.npos)) return true;
    }
    return false;
}

} // namespace

TEST_CASE("each section that states a rule of the proof has a test that attacks it") {
    const Page page = read_page();
    REQUIRE(page.rows.size() > 20);
    // What it is about; what others have; this table.
    const std::set<std::string> without_rule{"1", "8", "11"};
    for (const std::string &section : page.sections) {
        if (without_rule.contains(section)) continue;
        INFO("section " << section);
        CHECK(
            std::ranges::any_of(page.rows, [&](const Row &row) { return row.section == section; }));
    }
    for (const Row &row : page.rows) {
        INFO("section " << row.section << ": " << row.test_file << ": " << row.test_case);
        CHECK(page.sections.contains(row.section));
        REQUIRE(std::filesystem::exists(root / row.test_file));
        CHECK(text_of(root / row.test_file).find("TEST_CASE(\"" + row.test_case) !=
              std::string::npos);
    }
}

TEST_CASE("each file of the proof and each form of an instruction has a theorem") {
    const Page page = read_page();
    for (const std::string &file : files_below(root / "proof")) {
        if (!file.ends_with(".cpp")) continue;
        INFO("proof/" << file);
        CHECK(has_word(page.about, file));
    }
    std::string all;
    for (const Row &row : page.rows) all += row.where + "\n";
    bool inside = false;
    int forms = 0;
    for (const std::string &line : lines_of(root / "proof/tape.h")) {
        if (line.starts_with("enum class Form")) {
            inside = true;
            continue;
        }
        if (inside && line.starts_with("};")) break;
        if (!inside) continue;
        const std::string word = trimmed(line.substr(0, line.find(',')));
        INFO("Form::" << word);
        CHECK(has_word(all, word));
        ++forms;
    }
    CHECK(forms > 10);
}
