// docs/cli.md against `fathom help`: each names what the other does, no more and no less.
#include "shell.h"

#include "backend-glsl/targets.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>

namespace {

using Options = std::map<std::string, std::set<std::string>>; // by command

std::string read(const fs::path &file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

// The options in a text: `-o`, `--size`, wherever a word begins with a hyphen and a letter.
std::set<std::string> options_in(const std::string &text) {
    const auto letter = [&](std::size_t i) {
        return i < text.size() && (std::isalnum(static_cast<unsigned char>(text[i])) != 0);
    };
    std::set<std::string> found;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '-' || (i > 0 && (letter(i - 1) || text[i - 1] == '-'))) continue;
        std::size_t end = i;
        while (end < text.size() && text[end] == '-') ++end;
        if (end - i > 2 || !letter(end) || std::isdigit(static_cast<unsigned char>(text[end])))
            continue;
        while (letter(end) || (end < text.size() && text[end] == '-' && letter(end + 1))) ++end;
        found.insert(text.substr(i, end - i));
        i = end;
    }
    return found;
}

// The left column of a help page: what is indented by two blanks.
std::string left_column(const std::string &help) {
    std::istringstream lines(help);
    std::string text;
    for (std::string line; std::getline(lines, line);)
        if (line.starts_with("  ") && !line.starts_with("   "))
            text += line.substr(0, line.find("  ", 2)) + "\n";
    return text;
}

std::set<std::string> commands_in_help(const ScratchFolder &folder) {
    const std::string help = shell(folder, "fathom help").out;
    std::istringstream lines(help.substr(std::min(help.find("Subcommands:"), help.size())));
    std::set<std::string> names;
    for (std::string line; std::getline(lines, line);)
        if (line.starts_with("  ") && !line.starts_with("   "))
            names.insert(line.substr(2, line.find(' ', 2) - 2));
    return names;
}

// `## fathom NAME` and what follows, up to the next heading of that rank.
std::map<std::string, std::string> sections(const std::string &page) {
    std::map<std::string, std::string> found;
    std::istringstream lines(page);
    std::string name;
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("## ")) {
            name = line.starts_with("## fathom ") ? line.substr(10) : line.substr(3);
            found[name];
        } else {
            found[name] += line + "\n";
        }
    }
    return found;
}

} // namespace

TEST_CASE("help lists every command") {
    ScratchFolder folder;
    const Result help = shell(folder, "fathom help");
    CHECK(help.exit == 0);
    CHECK(help.err.empty());
    CHECK(commands_in_help(folder) ==
          std::set<std::string>{"view", "check", "compile", "render", "mesh", "eval", "import",
                                "export", "fmt", "doc", "explain", "lsp", "bench", "help", "merge",
                                "farm", "measure", "slice", "volume"});
    for (const char *same : {"fathom --help", "fathom -h"}) {
        INFO(same);
        CHECK(shell(folder, same).out == help.out);
    }
    const Result nothing = shell(folder, "fathom");
    CHECK(nothing.exit == 2);
    CHECK(nothing.out.empty());
    CHECK(contains(nothing.err, "bench"));
    CHECK(contains(shell(folder, "fathom help help").out, "COMMAND"));
}

TEST_CASE("docs/cli.md names each command and option that help names, and no other") {
    ScratchFolder folder;
    const auto page = sections(read(fs::path(FATHOM_SOURCE_DIR) / "docs/cli.md"));
    const std::set<std::string> everywhere =
        options_in(left_column(shell(folder, "fathom help").out));
    CHECK(everywhere.count("--color") == 1);
    REQUIRE(page.count("Everywhere") == 1);
    CHECK(options_in(page.at("Everywhere")) == everywhere);
    std::size_t checked = 0;
    for (const std::string &command : commands_in_help(folder)) {
        INFO(command);
        REQUIRE(page.count(command) == 1);
        std::set<std::string> real =
            options_in(left_column(shell(folder, "fathom help " + command).out));
        std::set<std::string> told = options_in(page.at(command));
        for (const std::string &option : everywhere) real.erase(option), told.erase(option);
        CHECK(told == real);
        checked += real.size();
    }
    CHECK(checked > 30);
    const std::set<std::string> others{"", "Everywhere", "For scenes"};
    for (const auto &[name, text] : page) {
        INFO("docs/cli.md has a section on " << name);
        CHECK(others.count(name) + commands_in_help(folder).count(name) == 1);
    }
}

TEST_CASE("docs/cli.md shows the JSON document as it is") {
    ScratchFolder folder;
    folder.write("a.sdf", "box(1).rotate(90)\n");
    const std::string page = read(fs::path(FATHOM_SOURCE_DIR) / "docs/cli.md");
    const std::size_t begin = page.find("```json\n");
    REQUIRE(begin != page.npos);
    const std::string shown = page.substr(begin, page.find("```\n", begin + 8) - begin);
    const auto keys = [](const std::string &json) {
        std::set<std::string> found;
        const std::regex key("\"([a-z_]+)\":");
        for (std::sregex_iterator i(json.begin(), json.end(), key), end; i != end; ++i)
            found.insert((*i)[1]);
        return found;
    };
    const std::string real = shell(folder, "fathom check --json a.sdf").out;
    CHECK(keys(shown) == keys(real));
}

TEST_CASE("the examples and the library are formatted") {
    ScratchFolder folder;
    std::string files;
    std::size_t count = 0;
    for (const char *where : {"examples", "examples/parts", "stdlib"})
        for (const auto &entry : fs::directory_iterator(fs::path(FATHOM_SOURCE_DIR) / where))
            if (entry.path().extension() == ".sdf") {
                files += " '" + entry.path().string() + "'";
                ++count;
            }
    CHECK(count > 45);
    const Result check = shell(folder, "fathom fmt --check" + files);
    CHECK(check.out == "");
    CHECK(check.exit == 0);
}

TEST_CASE("docs/shaders.md has a row for each target, and help names them in the same order") {
    ScratchFolder folder;
    std::vector<std::string> known;
    for (const fathom::glsl::Target target : fathom::glsl::all_targets())
        known.emplace_back(fathom::glsl::traits_of(target).name);
    std::istringstream page(read(fs::path(FATHOM_SOURCE_DIR) / "docs/shaders.md"));
    std::vector<std::string> told;
    for (std::string line; std::getline(page, line);)
        if (line.starts_with("| `")) told.push_back(line.substr(3, line.find('`', 3) - 3));
    CHECK(told == known);
    const std::string help = shell(folder, "fathom help compile").out;
    std::size_t at = help.find("--target");
    REQUIRE(at != help.npos);
    for (const std::string &name : known) {
        INFO(name);
        at = help.find(name, at);
        REQUIRE(at != help.npos);
    }
}

TEST_CASE(
    "the commands of docs/from-fathom.md do what the page says, with the scene that it shows") {
    const std::string page = read(fs::path(FATHOM_SOURCE_DIR) / "docs/from-fathom.md");
    const std::string open = "```sdf\n", prompt = "\n$ fathom ";
    const std::size_t program = page.find(open) + open.size();
    ScratchFolder folder;
    folder.write("bracket.sdf", page.substr(program, page.find("```", program) - program));
    std::size_t count = 0;
    for (std::size_t at = page.find(prompt); at != page.npos; at = page.find(prompt, at + 1)) {
        const std::string line = page.substr(at + 3, page.find('\n', at + 1) - at - 3);
        const Result made = shell(folder, line);
        INFO(line << '\n' << made.err);
        CHECK(made.exit == 0);
        ++count;
    }
    CHECK(count == 6);
    for (const char *name : {"bracket.png", "cut.png", "bracket.3mf", "whole.3mf", "bracket.glb"})
        CHECK(fs::exists(folder / name));
    CHECK(contains(folder.read("bracket.glb"), "\"name\":\"bolt\""));
    CHECK(contains(folder.read("bracket.glb"), "\"name\":\"steel\""));
}
