// Code actions: the fixes of diagnostics, and changes that keep the meaning. What would not compile
// is not offered.
#include "lsp/requests.h"

#include "lsp/calls.h"
#include "lsp/refactor.h"

#include <algorithm>

namespace fathom::lsp {
namespace {

Json edits_json(const Lines &lines, const std::vector<TextEdit> &edits) {
    Json all = Json::array();
    for (const TextEdit &edit : edits)
        all.push_back(
            {{"range", json_of(range_of(lines, edit.begin, edit.end))}, {"newText", edit.text}});
    return all;
}

void add_fixes(Workspace &workspace, Document &document, std::size_t begin, std::size_t end,
               Json &actions) {
    for (const fathom::v1::Diagnostic &diagnostic : compiled(workspace, document).diagnostics) {
        if (diagnostic.edits.empty() || diagnostic.at.file != document.path ||
            diagnostic.at.end < begin || end < diagnostic.at.begin)
            continue;
        Json edits = Json::array();
        for (const fathom::v1::Edit &edit : diagnostic.edits)
            if (edit.at.file == document.path)
                edits.push_back(
                    {{"range", place_of(document, edit.at)}, {"newText", edit.replacement}});
        if (edits.size() != diagnostic.edits.size()) continue; // of another file too
        actions.push_back({{"title", diagnostic.help},
                           {"kind", "quickfix"},
                           {"diagnostics", {diagnostic_json(document, diagnostic)}},
                           {"edit", {{"changes", {{document.uri, std::move(edits)}}}}}});
    }
}

std::vector<Refactoring> all_refactorings(Workspace &workspace, Document &document,
                                          std::size_t begin, std::size_t end) {
    const Reading &read = reading(document);
    std::vector<Refactoring> all;
    const auto add = [&all](std::optional<Refactoring> one) {
        if (one) all.push_back(std::move(*one));
    };
    if (begin < end) {
        add(extract_let(read.syntax, read.names, begin, end));
        add(extract_function(read.syntax, read.names, begin, end));
    }
    add(extract_param(read.syntax, read.names, begin, end));
    if (begin != end) return all;
    add(inline_let(read.syntax, read.names, begin));
    const File file{document.path, document.text, document.reading};
    add(name_argument(read.syntax, read.names, begin,
                      [&](const Use &use, std::size_t index, std::size_t count) {
                          const std::vector<Form> forms = forms_of(workspace, file, use);
                          return parameter_at(forms, index, count);
                      }));
    for (Refactoring &one : convert_units(read.syntax, begin)) all.push_back(std::move(one));
    return all;
}

} // namespace

Json code_actions(Workspace &workspace, const Json &params) {
    Document &document = document_of(workspace, params);
    const Json &range = params.at("range");
    const std::size_t begin = offset_at(document.text, position_of(range.at("start"))),
                      end = offset_at(document.text, position_of(range.at("end")));
    const Json context = params.value("context", Json::object());
    const Json only = context.value("only", Json());
    const auto wanted = [&only](std::string_view kind) {
        return !only.is_array() || only.empty() ||
               std::ranges::any_of(only, [kind](const Json &one) {
                   return one.is_string() && kind.starts_with(one.get<std::string>());
               });
    };
    Json actions = Json::array();
    if (wanted("quickfix")) add_fixes(workspace, document, begin, end, actions);
    // each costs a compilation, so a cursor that only passes by gets none
    constexpr int automatic = 2;
    if (context.value("triggerKind", 1) == automatic || !compiled(workspace, document).good())
        return actions;
    for (const Refactoring &one : all_refactorings(workspace, document, begin, end)) {
        if (!wanted(one.kind)) continue;
        const std::string after = edited(document.text, one.edits);
        if (!compile_as(workspace, document.path, after)) continue;
        actions.push_back(
            {{"title", one.title},
             {"kind", one.kind},
             {"edit",
              {{"changes", {{document.uri, edits_json(reading(document).lines, one.edits)}}}}}});
    }
    return actions;
}

} // namespace fathom::lsp
