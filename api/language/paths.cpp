#include "api/language/paths.h"

#include "api/language/features.h"

#include <algorithm>

namespace fathom::language {
namespace {

namespace fs = std::filesystem;

using Move = v1::RenamedFile;

std::string moved(const std::string &path, const std::vector<Move> &moves) {
    for (const Move &move : moves) {
        if (path == move.from) return move.to;
        if (path.starts_with(move.from + "/")) return move.to + path.substr(move.from.size());
    }
    return path;
}

bool is_there(const Workspace &workspace, const std::string &path) {
    std::error_code error;
    return workspace.documents.contains(path) || fs::is_regular_file(path, error);
}

// The edits of a file's text after which it names what it named, once all is moved.
std::vector<v1::TextEdit> edits_for(const Workspace &workspace, const File &file,
                                    const std::vector<Move> &moves) {
    const fs::path home = fs::path(moved(file.path, moves)).parent_path();
    std::vector<v1::TextEdit> edits;
    for (const NamedFile &named : named_files(file)) {
        const std::string written = file.text.substr(named.at.begin, named.at.end - named.at.begin);
        const std::string target = moved(named.path, moves);
        if ((home / written).lexically_normal() == target || !is_there(workspace, named.path))
            continue;
        const std::string now = fs::path(written).is_absolute()
                                    ? target
                                    : fs::path(target).lexically_relative(home).generic_string();
        if (now.find_first_of("\"\\\n") != now.npos) continue; // no string can say it
        edits.push_back({stretch_of(named.at), now});
    }
    return edits;
}

} // namespace

Named named_by(const Syntax &syntax, const lang::Token &string) {
    const std::vector<lang::Token> &tokens = syntax.words.tokens;
    const auto at = std::ranges::lower_bound(tokens, string.begin, {}, &lang::Token::begin);
    if (at != tokens.begin() && std::prev(at)->kind == lang::Tok::Import) return Named::Scene;
    const auto call = call_around(syntax, string.begin);
    if (!call) return Named::Nothing;
    return call->name == "image"           ? Named::Image
           : call->name == "distance_grid" ? Named::Grid
                                           : Named::Nothing;
}

bool may_be(Named what, std::string_view ending) {
    switch (what) {
    case Named::Nothing: return false;
    case Named::Scene: return ending == ".sdf";
    case Named::Image: return ending == ".png" || ending == ".jpg" || ending == ".jpeg";
    case Named::Grid: return ending == ".nrrd";
    }
    return false;
}

std::vector<NamedFile> named_files(const File &file) {
    std::vector<NamedFile> files;
    for (const lang::Token &token : file.reading->syntax.words.tokens) {
        if (token.kind != lang::Tok::String || token.end < token.begin + 2 ||
            named_by(file.reading->syntax, token) == Named::Nothing)
            continue;
        const Span at{{}, token.begin + 1, token.end - 1};
        files.push_back(
            {at, imported_path(file.path, file.text.substr(at.begin, at.end - at.begin))});
    }
    return files;
}

// Those that are there.
std::vector<v1::DocumentLink> links(Document &document) {
    std::vector<v1::DocumentLink> all;
    for (const NamedFile &named : named_files(file_of(document))) {
        std::error_code error;
        if (fs::is_regular_file(named.path, error))
            all.push_back({stretch_of(named.at), named.path});
    }
    return all;
}

v1::WorkspaceEdit rename_files(Workspace &workspace, std::vector<v1::RenamedFile> files) {
    std::erase_if(files, [](const Move &move) { return move.from.empty() || move.to.empty(); });
    v1::WorkspaceEdit changes;
    for (const File &file : all_files(workspace))
        if (auto edits = edits_for(workspace, file, files); !edits.empty())
            changes[file.path] = std::move(edits);
    return changes;
}

} // namespace fathom::language
