#include "lsp/session.h"

#include "lsp/kept.h"

#include <fathom/reference.h>

namespace fathom::lsp {

OpenText &text_of(Session &session, const Json &params) {
    const auto found =
        session.texts.find(params.at("textDocument").at("uri").get_ref<const std::string &>());
    if (found == session.texts.end()) throw UnknownDocument();
    return found->second;
}

const Lines &lines_of(Session &session, OpenText &text) {
    if (!text.lines) text.lines = lines_of(session.workspace.text(text.path).value_or(""));
    return *text.lines;
}

std::size_t offset_of(Session &session, OpenText &text, const Json &position) {
    return offset_at(lines_of(session, text).text, position_of(position));
}

v1::Stretch stretch_of(Session &session, OpenText &text, const Json &range) {
    return {offset_of(session, text, range.at("start")), offset_of(session, text, range.at("end"))};
}

Json range_json(const Lines &lines, v1::Stretch at) {
    return json_of(range_of(lines, at.begin, at.end));
}

Json edits_json(const Lines &lines, const std::vector<v1::TextEdit> &edits) {
    Json all = Json::array();
    for (const v1::TextEdit &edit : edits)
        all.push_back({{"range", range_json(lines, edit.at)}, {"newText", edit.text}});
    return all;
}

std::string Places::uri(const std::string &path) const {
    for (const auto &[uri, text] : session_.texts)
        if (text.path == path) return uri;
    return uri_of(path);
}

const Lines *Places::lines(const std::string &path) {
    for (auto &[uri, text] : session_.texts)
        if (text.path == path) return &lines_of(session_, text);
    const auto [found, is_new] = closed_.try_emplace(path);
    if (is_new) {
        const auto text = session_.workspace.text(path);
        if (!text) {
            closed_.erase(found);
            return nullptr;
        }
        found->second = lines_of(*text);
    }
    return &found->second;
}

Json Places::edits(const v1::WorkspaceEdit &changes) {
    Json all = Json::object();
    for (const auto &[path, edits] : changes)
        if (const Lines *of = lines(path)) all[uri(path)] = edits_json(*of, edits);
    return {{"changes", std::move(all)}};
}

Json Places::location(const v1::Location &place) {
    if (!place.library) {
        const Lines *of = lines(place.path);
        return of ? Json{{"uri", uri(place.path)}, {"range", range_json(*of, place.at)}} : Json();
    }
    static const std::vector<v1::LibraryText> texts = v1::library_texts();
    for (const v1::LibraryText &text : texts) {
        if (text.file != place.path) continue;
        const std::string name = text.file.ends_with(".sdf") ? text.file : text.file + ".sdf";
        if (const auto file = kept_file("library/" + name, text.text))
            return {{"uri", uri_of(file->string())},
                    {"range", range_json(lines_of(text.text), place.at)}};
    }
    return nullptr;
}

} // namespace fathom::lsp
