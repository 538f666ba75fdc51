// Changes of texts: names, files' names, form, fixes, refactorings.
#include "lsp/requests.h"

#include <algorithm>

namespace fathom::lsp {
namespace {

const char *name_of(v1::CodeAction::Kind kind) {
    switch (kind) {
    case v1::CodeAction::Kind::Fix: return "quickfix";
    case v1::CodeAction::Kind::Extract: return "refactor.extract";
    case v1::CodeAction::Kind::Inline: return "refactor.inline";
    case v1::CodeAction::Kind::Rewrite: return "refactor.rewrite";
    }
    return "";
}

// What the client asks for: kinds whose names begin with one of `only`.
v1::ActionKinds kinds_of(const Json &context) {
    const Json only = context.value("only", Json());
    const auto wanted = [&only](v1::CodeAction::Kind kind) {
        const std::string_view name = name_of(kind);
        return !only.is_array() || only.empty() ||
               std::ranges::any_of(only, [name](const Json &one) {
                   return one.is_string() && name.starts_with(one.get<std::string>());
               });
    };
    // a refactoring costs a compilation, so a cursor that only passes by gets none
    constexpr int automatic = 2;
    const bool asked = context.value("triggerKind", 1) != automatic;
    return {wanted(v1::CodeAction::Kind::Fix), asked && wanted(v1::CodeAction::Kind::Extract),
            asked && wanted(v1::CodeAction::Kind::Inline),
            asked && wanted(v1::CodeAction::Kind::Rewrite)};
}

} // namespace

Json prepare_rename(Session &session, const Json &params) {
    OpenText &text = text_of(session, params);
    const auto at = taken(
        session.workspace.renamable(text.path, offset_of(session, text, params.at("position"))));
    if (!at) return nullptr;
    const Lines &lines = lines_of(session, text);
    return {{"range", range_json(lines, *at)},
            {"placeholder", lines.text.substr(at->begin, at->end - at->begin)}};
}

Json rename(Session &session, const Json &params) {
    OpenText &text = text_of(session, params);
    return Places(session).edits(
        taken(session.workspace.rename(text.path, offset_of(session, text, params.at("position")),
                                       params.at("newName").get<std::string>())));
}

Json will_rename_files(Session &session, const Json &params) {
    std::vector<v1::RenamedFile> files;
    for (const Json &one : params.at("files"))
        files.push_back({path_of(one.at("oldUri").get<std::string>()),
                         path_of(one.at("newUri").get<std::string>())});
    return Places(session).edits(taken(session.workspace.rename_files(files)));
}

Json formatting(Session &session, const Json &params) {
    OpenText &text = text_of(session, params);
    const Lines &lines = lines_of(session, text);
    return edits_json(lines, taken(session.workspace.format(text.path, {0, lines.text.size()})));
}

Json range_formatting(Session &session, const Json &params) {
    OpenText &text = text_of(session, params);
    return edits_json(
        lines_of(session, text),
        taken(session.workspace.format(text.path, stretch_of(session, text, params.at("range")))));
}

Json on_type_formatting(Session &session, const Json &params) {
    OpenText &text = text_of(session, params);
    const std::string typed = params.at("ch");
    return edits_json(lines_of(session, text),
                      taken(session.workspace.format_typed(
                          text.path, offset_of(session, text, params.at("position")),
                          typed.empty() ? '\n' : typed.front())));
}

Json code_actions(Session &session, const Json &params) {
    OpenText &text = text_of(session, params);
    const Lines &lines = lines_of(session, text);
    Json all = Json::array();
    for (const v1::CodeAction &action :
         taken(session.workspace.actions(text.path, stretch_of(session, text, params.at("range")),
                                         kinds_of(params.value("context", Json::object()))))) {
        Json one{{"title", action.title},
                 {"kind", name_of(action.kind)},
                 {"edit", {{"changes", {{text.uri, edits_json(lines, action.edits)}}}}}};
        if (action.fixes) one["diagnostics"] = {diagnostic_json(session, text, *action.fixes)};
        all.push_back(std::move(one));
    }
    return all;
}

} // namespace fathom::lsp
