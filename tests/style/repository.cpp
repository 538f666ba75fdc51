#include "repository.h"

#include <cctype>
#include <fstream>

namespace fathom::style {

namespace {

bool begins_comment(const std::string &line, std::size_t at, bool hash) {
    if (hash) return line[at] == '#';
    return line.compare(at, 2, "//") == 0 || line.compare(at, 2, "$#") == 0; // $#: in templates
}

// What follows the first comment sign of a line that is not in a string; empty without one.
std::string comment_of(const std::string &line, bool hash) {
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (line[i] == '\\') {
            ++i;
        } else if (line.compare(i, 3, "'\"'") == 0) {
            i += 2; // the sign itself opens no string
        } else if (line[i] == '"') {
            quoted = !quoted;
        } else if (!quoted && begins_comment(line, i, hash)) {
            const std::size_t text = line.find_first_not_of(hash ? "#" : "/$#", i);
            return text == line.npos ? "" : line.substr(text);
        }
    }
    return "";
}

bool is_fence(const std::string &line) {
    const std::size_t at = line.find_first_not_of(' ');
    return at != line.npos && line.compare(at, 3, "```") == 0;
}

std::string anchor_of(const std::string &heading) {
    std::string anchor;
    for (const char c : heading) {
        const auto byte = static_cast<unsigned char>(c);
        if (std::isalnum(byte) || byte >= 128 || c == '-' || c == '_')
            anchor += static_cast<char>(std::tolower(byte));
        else if (c == ' ')
            anchor += '-';
    }
    return anchor;
}

// As .gitignore has it, so that one is left out also while it is being configured; and any other.
bool is_build_tree(const std::filesystem::path &folder) {
    const std::string name = folder.filename().string();
    return name == "build" || name.starts_with("build-") || name == "node_modules" ||
           std::filesystem::exists(folder / "CMakeCache.txt");
}

} // namespace

std::set<std::string> files_below(const std::filesystem::path &root) {
    namespace fs = std::filesystem;
    std::set<std::string> files;
    for (auto entry = fs::recursive_directory_iterator(root);
         entry != fs::recursive_directory_iterator(); ++entry) {
        const bool hidden = entry->path().filename().string().starts_with(".");
        if (entry->is_directory()) {
            if (hidden || is_build_tree(entry->path())) entry.disable_recursion_pending();
        } else if (!hidden) {
            files.insert(fs::relative(entry->path(), root).generic_string());
        }
    }
    return files;
}

std::vector<std::string> lines_of(const std::filesystem::path &file) {
    std::ifstream in(file);
    std::vector<std::string> lines;
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
}

std::vector<ProseLine> prose_of(const std::string &path, const std::vector<std::string> &lines) {
    const std::string extension = std::filesystem::path(path).extension().string();
    const std::set<std::string> slashes{".cpp", ".h", ".def", ".glsl", ".sdf", ".in"};
    std::vector<ProseLine> prose;
    bool fenced = false;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const int line = static_cast<int>(i + 1);
        if (extension != ".md") {
            const std::string text = comment_of(lines[i], !slashes.contains(extension));
            if (!text.empty()) prose.push_back({text, line});
        } else if (is_fence(lines[i])) {
            fenced = !fenced;
        } else if (!fenced) {
            prose.push_back({lines[i], line});
        }
    }
    return prose;
}

Headings headings_of(const std::vector<std::string> &page) {
    Headings headings;
    std::map<std::string, int> seen;
    for (const ProseLine &line : prose_of("page.md", page)) {
        const std::size_t begin = line.text.find_first_not_of('#');
        if (begin == 0 || begin == line.text.npos || line.text[begin] != ' ') continue;
        const std::string title = line.text.substr(begin + 1);
        std::size_t end = title.find_first_not_of("0123456789.");
        if (end != title.npos && end > 0 && title[end] == ' ') {
            if (title[end - 1] == '.') --end;
            headings.numbers.insert(title.substr(0, end));
        }
        const std::string anchor = anchor_of(title);
        const int before = seen[anchor]++;
        headings.anchors.insert(before == 0 ? anchor : anchor + "-" + std::to_string(before));
    }
    return headings;
}

} // namespace fathom::style
