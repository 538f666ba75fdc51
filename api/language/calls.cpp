#include "api/language/calls.h"

#include <algorithm>

namespace fathom::language {
namespace {

Form form_of(std::string signature, std::string_view doc) {
    Signature read = read_signature(signature);
    return {std::move(signature), std::string(doc), std::move(read)};
}

std::string one_line(std::string_view text) {
    std::string line;
    for (char c : text) {
        const bool space = c == ' ' || c == '\n' || c == '\t' || c == '\r';
        if (!space) line += c;
        if (space && !line.empty() && line.back() != ' ') line += ' ';
    }
    return line;
}

std::vector<Form> library(const Workspace &workspace, const std::string &name,
                          const std::string &module) {
    std::vector<Form> forms;
    for (const v1::LibraryEntry *entry : library_forms(workspace, name, module))
        if (entry->signature.find('(') != std::string::npos)
            forms.push_back(form_of(entry->signature, entry->doc));
    return forms;
}

} // namespace

Form form_of(const File &home, const Declaration &declared) {
    const lang::Function &function = home.reading->syntax.ast.functions[declared.function];
    std::string head =
        one_line(home.text.substr(function.head.begin, function.head.end - function.head.begin));
    if (head.starts_with("fn ")) return form_of(head.substr(3), function.doc);
    if (!head.starts_with('(')) head = "(" + head + ")"; // `x => …`
    return form_of(declared.name + head, function.doc);
}

std::vector<Form> forms_of(Workspace &workspace, const File &file, const Use &use) {
    if (const auto target = target_of(workspace, file, use)) {
        const auto home = file_at(workspace, target->path);
        if (!home) return {};
        const Declaration &declared = home->reading->names.declarations[target->declaration];
        if (!declared.function) return {};
        return {form_of(*home, declared)};
    }
    if (use.module)
        return library(workspace, use.name, file.reading->names.declarations[*use.module].path);
    return library(workspace, use.name, "");
}

std::vector<Form> forms_named(Workspace &workspace, const File &file, const std::string &name) {
    for (const Declaration &declared : file.reading->names.declarations)
        if (declared.name == name && declared.function) return {form_of(file, declared)};
    return forms_of(workspace, file, {name, {}, UsedAs::Callee, {}, {}, {}, false});
}

std::string parameter_at(const std::vector<Form> &forms, std::size_t index, std::size_t count) {
    std::string name;
    for (const Form &form : forms) {
        const std::vector<std::string> &names = form.read.names;
        // the last one may take all that is left, which has no name
        if (index >= names.size() || count > names.size()) return "";
        const std::string &text = form.read.parameters[index];
        if (index + 1 == names.size() && text.find("[_") != text.npos) return "";
        if (!name.empty() && name != names[index]) return "";
        name = names[index];
    }
    return name;
}

} // namespace fathom::language
