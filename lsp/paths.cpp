#include "lsp/paths.h"

#include "lsp/requests.h"

#include <algorithm>

namespace fathom::lsp {
namespace {

namespace fs = std::filesystem;

// A file or a folder that gets another name.
struct Move {
    std::string from, to;
};

std::string moved(const std::string &path, const std::vector<Move> &moves) {
    for (const Move &move : moves) {
        if (path == move.from) return move.to;
        if (path.starts_with(move.from + "/")) return move.to + path.substr(move.from.size());
    }
    return path;
}

bool is_there(const Workspace &workspace, const std::string &path) {
    std::error_code error;
    return workspace.documents.contains(uri_of(path)) || fs::is_regular_file(path, error);
}

// The edits of a file's text after which it names what it named, once all is moved.
Json edits_for(const Workspace &workspace, const File &file, const std::vector<Move> &moves) {
    const fs::path home = fs::path(moved(file.path, moves)).parent_path();
    Json edits = Json::array();
    for (const NamedFile &named : named_files(file)) {
        const std::string written = file.text.substr(named.at.begin, named.at.end - named.at.begin);
        const std::string target = moved(named.path, moves);
        if ((home / written).lexically_normal() == target || !is_there(workspace, named.path))
            continue;
        const std::string now = fs::path(written).is_absolute()
                                    ? target
                                    : fs::path(target).lexically_relative(home).generic_string();
        if (now.find_first_of("\"\\\n") != now.npos) continue; // no string can say it
        edits.push_back({{"range", range_json(file.reading->lines, named.at)}, {"newText", now}});
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
Json document_links(Workspace &workspace, const Json &params) {
    const File file = file_of(document_of(workspace, params));
    Json links = Json::array();
    for (const NamedFile &named : named_files(file)) {
        std::error_code error;
        if (fs::is_regular_file(named.path, error))
            links.push_back({{"range", range_json(file.reading->lines, named.at)},
                             {"target", uri_of(named.path)}});
    }
    return links;
}

// Before files and folders get other names: what names them, or stands in them, is written anew.
Json will_rename_files(Workspace &workspace, const Json &params) {
    std::vector<Move> moves;
    for (const Json &one : params.at("files"))
        moves.push_back({path_of(one.at("oldUri").get<std::string>()),
                         path_of(one.at("newUri").get<std::string>())});
    std::erase_if(moves, [](const Move &move) { return move.from.empty() || move.to.empty(); });
    Json changes = Json::object();
    for (const File &file : all_files(workspace))
        if (Json edits = edits_for(workspace, file, moves); !edits.empty())
            changes[uri_of(file.path)] = std::move(edits);
    return {{"changes", std::move(changes)}};
}

} // namespace fathom::lsp
