// Code actions: the fixes of diagnostics, and changes that keep the meaning. What would not compile
// is not offered.
#include "api/language/features.h"

#include "api/language/calls.h"
#include "api/language/refactor.h"

#include <algorithm>

namespace fathom::language {
namespace {

void add_fixes(Workspace &workspace, Document &document, v1::Stretch within,
               std::vector<CodeAction> &all) {
    for (const v1::Diagnostic &diagnostic : compiled(workspace, document).diagnostics) {
        if (diagnostic.edits.empty() || diagnostic.at.file != document.path ||
            diagnostic.at.end < within.begin || within.end < diagnostic.at.begin)
            continue;
        CodeAction fix{diagnostic.help, CodeAction::Kind::Fix, diagnostic, {}};
        for (const v1::Edit &edit : diagnostic.edits)
            if (edit.at.file == document.path)
                fix.edits.push_back({{edit.at.begin, edit.at.end}, edit.replacement});
        if (fix.edits.size() == diagnostic.edits.size()) // else of another file, too
            all.push_back(std::move(fix));
    }
}

bool wanted(CodeAction::Kind kind, const v1::ActionKinds &kinds) {
    switch (kind) {
    case CodeAction::Kind::Fix: return kinds.fixes;
    case CodeAction::Kind::Extract: return kinds.extractions;
    case CodeAction::Kind::Inline: return kinds.inlinings;
    case CodeAction::Kind::Rewrite: return kinds.rewritings;
    }
    return false;
}

std::vector<CodeAction> all_refactorings(Workspace &workspace, Document &document,
                                         std::size_t begin, std::size_t end) {
    const Reading &read = reading(document);
    std::vector<CodeAction> all;
    const auto add = [&all](std::optional<CodeAction> one) {
        if (one) all.push_back(std::move(*one));
    };
    if (begin < end) {
        add(extract_let(read.syntax, read.names, begin, end));
        add(extract_function(read.syntax, read.names, begin, end));
    }
    add(extract_param(read.syntax, read.names, begin, end));
    if (begin != end) return all;
    add(inline_let(read.syntax, read.names, begin));
    const File file = file_of(document);
    add(name_argument(read.syntax, read.names, begin,
                      [&](const Use &use, std::size_t index, std::size_t count) {
                          const std::vector<Form> forms = forms_of(workspace, file, use);
                          return parameter_at(forms, index, count);
                      }));
    for (CodeAction &one : convert_units(read.syntax, begin)) all.push_back(std::move(one));
    return all;
}

} // namespace

std::vector<CodeAction> actions(Workspace &workspace, Document &document, v1::Stretch within,
                                const v1::ActionKinds &kinds) {
    std::vector<CodeAction> all;
    if (kinds.fixes) add_fixes(workspace, document, within, all);
    // each costs a compilation
    if (!(kinds.extractions || kinds.inlinings || kinds.rewritings) ||
        !compiled(workspace, document).good())
        return all;
    for (CodeAction &one : all_refactorings(workspace, document, within.begin, within.end))
        if (wanted(one.kind, kinds) &&
            compile_as(workspace, document.path, edited(document.text, one.edits)))
            all.push_back(std::move(one));
    return all;
}

} // namespace fathom::language
