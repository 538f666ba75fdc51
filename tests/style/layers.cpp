// Who may include whom (docs/architecture.md), read off every #include; and the few rules of style
// that a program can see. Knows nothing of what the code does.
#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

// A folder of the house, and the folders that it sees besides itself.
const std::map<std::string, Names> sees{
    {"base", {}},
    {"lang", {"base"}},
    {"ir", {"base"}},
    {"proof", {"base", "ir"}},
    {"typecheck", {"base", "lang", "ir"}},
    {"backend-glsl", {"base", "ir"}},
    {"backend-cpu", {"base", "ir"}},
    {"mesh", {"base", "ir", "backend-cpu"}},
    {"save-format", {"base", "ir"}},
    {"driver",
     {"base", "lang", "ir", "proof", "typecheck", "backend-cpu", "save-format", "system"}},
    {"api",
     {"base", "lang", "ir", "proof", "typecheck", "backend-glsl", "backend-cpu", "mesh",
      "save-format", "driver", "render-gl"}},
    {"render-gl", {"base", "ir", "backend-glsl"}},
    {"viewer", {"base", "ir", "backend-glsl", "save-format", "driver", "render-gl", "system"}},
    {"system", {}},
    {"lsp", {"base", "system"}},                  // and the public headers
    {"bindings", {}},                             // the library's public headers alone
    {"cli", {"base", "viewer", "lsp", "system"}}, // and the public headers
};

// Foreign headers, by how their names begin, and the only folder (or file) that may see them.
const std::map<std::string, std::string> owners{
    {"tao/", "lang/"},          {"yaml.h", "save-format/"},    {"GLFW/", "viewer/"},
    {"imgui", "viewer/"},       {"epoxy/", "render-gl/"},      {"GL/", "render-gl/"},
    {"EGL/", "render-gl/"},     {"glslang/", "backend-glsl/"}, {"spirv", "backend-glsl/"},
    {"CLI/", "cli/"},           {"jpeglib.h", "driver/"},      {"sys/inotify.h", "driver/"},
    {"pybind11/", "bindings/"}, {"openexr", "cli/"},           {"fast_float/", "base/"},
    {"openvdb/", "driver/"},
};
// Seen by one file alone.
const Names lonely{"tao/", "CLI/", "openexr", "fast_float/", "sys/inotify.h"};

// Below the driver nothing opens a file, prints, or reads a clock or a locale.
const Names pure{"base",         "lang",        "ir",   "proof",      "typecheck",
                 "backend-glsl", "backend-cpu", "mesh", "save-format"};
const Names impure_headers{"fstream",  "iostream", "filesystem", "cstdio", "stdio.h",
                           "chrono",   "ctime",    "time.h",     "locale", "clocale",
                           "locale.h", "unistd.h", "fcntl.h"};

struct Include {
    std::string folder, file, name; // "lang", "lang/parse.cpp", "base/source.h"
    int line = 0;
};

struct SourceFile {
    std::string folder, file;
    std::vector<std::string> lines;
};

std::vector<SourceFile> read_sources() {
    std::vector<SourceFile> files;
    fs::path root = FATHOM_SOURCE_DIR;
    for (const auto &[folder, seen] : sees) {
        if (!fs::exists(root / folder)) continue;
        for (const fs::directory_entry &entry : fs::recursive_directory_iterator(root / folder)) {
            std::string extension = entry.path().extension().string();
            if (extension != ".cpp" && extension != ".h") continue;
            SourceFile file{folder, fs::relative(entry.path(), root).generic_string(), {}};
            std::ifstream in(entry.path());
            for (std::string line; std::getline(in, line);) file.lines.push_back(line);
            files.push_back(file);
        }
    }
    return files;
}

std::vector<Include> includes_of(const SourceFile &file) {
    std::vector<Include> found;
    for (std::size_t i = 0; i < file.lines.size(); ++i) {
        const std::string &line = file.lines[i];
        std::size_t at = line.find_first_not_of(" \t");
        if (at == line.npos || line[at] != '#') continue;
        at = line.find_first_not_of(" \t", at + 1);
        if (at == line.npos || line.compare(at, 7, "include") != 0) continue;
        std::size_t open = line.find_first_of("<\"", at),
                    close = line.find_first_of(">\"", open + 1);
        if (open == line.npos || close == line.npos) continue;
        found.push_back({file.folder, file.file, line.substr(open + 1, close - open - 1),
                         static_cast<int>(i + 1)});
    }
    return found;
}

std::string place(const Include &include) {
    return include.file + ":" + std::to_string(include.line) + " includes " + include.name;
}

} // namespace

TEST_CASE("a folder includes only what its layer may see") {
    std::size_t counted = 0;
    for (const SourceFile &file : read_sources())
        for (const Include &include : includes_of(file)) {
            ++counted;
            std::string folder = include.name.substr(0, include.name.find('/'));
            if (folder == include.name || !sees.count(folder) || folder == include.folder) continue;
            INFO(place(include));
            CHECK(sees.at(include.folder).count(folder) == 1);
        }
    CHECK(counted > 100); // the test reads what it means to read
}

TEST_CASE("what answers other languages has one door") {
    const std::string room = "lang/foreign/", door = "lang/foreign/foreign.h";
    const Names touched{"lang/reading.h", "lang/lexer.h", "lang/token.h", "lang/vocabulary.h"};
    bool entered = false;
    for (const SourceFile &file : read_sources())
        for (const Include &include : includes_of(file)) {
            const bool inside = file.file.starts_with(room);
            INFO(place(include));
            if (!inside && include.name.starts_with(room)) CHECK(include.name == door);
            if (inside && include.name.starts_with("lang/") && !include.name.starts_with(room))
                CHECK(touched.count(include.name) == 1);
            entered = entered || (!inside && include.name == door);
        }
    CHECK(entered);
}

TEST_CASE("a foreign library is seen by one folder") {
    std::map<std::string, Names> users;
    for (const SourceFile &file : read_sources())
        for (const Include &include : includes_of(file))
            for (const auto &[prefix, owner] : owners) {
                if (!include.name.starts_with(prefix)) continue;
                INFO(place(include));
                CHECK(include.file.starts_with(owner));
                users[prefix].insert(include.file);
            }
    for (const std::string &prefix : lonely) {
        INFO(prefix << " is for one file alone");
        CHECK(users[prefix].size() == 1);
    }
}

TEST_CASE("where every bit is accounted for, no library computes") {
    std::size_t users = 0;
    for (const SourceFile &file : read_sources())
        for (const Include &include : includes_of(file)) {
            if (!include.name.starts_with("glm/")) continue;
            ++users;
            INFO(place(include));
            for (const char *exact :
                 {"proof/", "typecheck/", "ir/passes/", "ir/lower/", "ir/interval", "ir/semantics",
                  "backend-cpu/kernels/", "backend-cpu/prune/", "backend-cpu/compile/",
                  "backend-cpu/evaluate", "mesh/"})
                CHECK_FALSE(file.file.starts_with(exact));
        }
    CHECK(users >= 6);
}

TEST_CASE("below the driver nothing opens a file, prints, or reads a clock or a locale") {
    for (const SourceFile &file : read_sources())
        for (const Include &include : includes_of(file)) {
            INFO(place(include));
            CHECK_FALSE((pure.count(include.folder) && impure_headers.count(include.name)));
        }
}

TEST_CASE("a header says in its first lines what it is for") {
    for (const SourceFile &file : read_sources()) {
        if (!file.file.ends_with(".h")) continue;
        INFO(file.file);
        REQUIRE(!file.lines.empty());
        CHECK(file.lines.front().starts_with("//"));
        bool once = false;
        for (const std::string &line : file.lines) once = once || line == "#pragma once";
        CHECK(once);
    }
}

// With a default a new op or kind would be passed over in silence where it has to be thought of.
// Numbers of foreign libraries (keys, GL's constants) are no enumerations of ours.
TEST_CASE("a switch over ops, kinds or codes has no default") {
    const auto indentation = [](const std::string &line) { return line.find_first_not_of(' '); };
    std::size_t switches = 0;
    for (const SourceFile &file : read_sources())
        for (std::size_t i = 0; i < file.lines.size(); ++i) {
            const std::size_t at = indentation(file.lines[i]);
            if (at == std::string::npos || file.lines[i].compare(at, 8, "switch (") != 0) continue;
            ++switches;
            bool enumeration = false;
            std::size_t fallback = 0;
            for (std::size_t k = i + 1; k < file.lines.size(); ++k) {
                const std::string &line = file.lines[k];
                if (indentation(line) != at) continue;
                if (line.compare(at, 1, "}") == 0) break;
                const std::string label = line.substr(at, line.find(' ', at + 5) - at);
                enumeration |= label.starts_with("case ") && label.find("::") != label.npos;
                if (line.compare(at, 8, "default:") == 0) fallback = k + 1;
            }
            INFO(file.file << ":" << fallback);
            CHECK_FALSE((enumeration && fallback > 0));
        }
    CHECK(switches > 50); // the test reads what it means to read
}

// What only Linux has stands in one file each, which has a fallback: its names, and that file.
TEST_CASE("no other file calls what only Linux has") {
    const std::map<std::string, std::string> calls{{"inotify_", "driver/folder_events.cpp"},
                                                   {"EGL_PLATFORM", "render-gl/context.cpp"},
                                                   {"pipe2(", "system/system.cpp"},
                                                   {"accept4(", "system/system.cpp"},
                                                   {"SOCK_CLOEXEC", "system/system.cpp"},
                                                   {"SO_PEERCRED", "system/system.cpp"},
                                                   {"memfd_create(", "system/system.cpp"},
                                                   {"/proc/", "system/system.cpp"},
                                                   {"epoll_", "none"},
                                                   {"eventfd(", "none"},
                                                   {"signalfd(", "none"},
                                                   {"prctl(", "system/system.cpp"},
                                                   {"gettid(", "none"},
                                                   {"sched_", "none"}};
    std::set<std::string> seen;
    for (const SourceFile &file : read_sources())
        for (const std::string &line : file.lines)
            for (const auto &[name, owner] : calls) {
                const std::size_t at = line.find(name);
                if (at == line.npos || at > line.find("//")) continue;
                INFO(file.file << ": " << line);
                CHECK(file.file.starts_with(owner.substr(0, owner.rfind('.'))));
                seen.insert(name);
            }
    CHECK(seen.size() == 9); // all but what nothing calls
}
