#include "api/language/targets.h"

namespace fathom::language {
namespace {

constexpr int most_imports = 32; // one in the other, so that files that import each other end

// What an import of the file brings under a name: its own, or what it imports itself.
std::optional<Target> exported(Workspace &workspace, const std::string &path,
                               const std::string &name, int depth = 0) {
    if (depth > most_imports || name.starts_with('_')) return std::nullopt;
    const std::optional<File> file = file_at(workspace, path);
    if (!file) return std::nullopt;
    const Names &names = file->reading->names;
    for (std::size_t i = 0; i < names.declarations.size(); ++i)
        if (names.declarations[i].top_level && names.declarations[i].name == name)
            return Target{path, i};
    for (std::size_t import : names.open_imports)
        if (auto found = exported(workspace, imported_path(path, names.declarations[import].path),
                                  name, depth + 1))
            return found;
    return std::nullopt;
}

// Forms of one function are one declaration, the first, for whoever looks for it or renames it.
bool is_form_of(const Declaration &a, const Declaration &b) {
    return a.by == DeclaredBy::Function && b.by == DeclaredBy::Function && a.top_level &&
           b.top_level && a.name == b.name;
}

std::size_t first_form(const Names &names, std::size_t declared) {
    for (std::size_t i = 0; i < declared; ++i)
        if (is_form_of(names.declarations[i], names.declarations[declared])) return i;
    return declared;
}

// The parameter that a call names, of a function of whatever file.
std::optional<Target> parameter_target(Workspace &workspace, const File &file, const Use &use) {
    if (!use.callee) return std::nullopt;
    const auto called = target_of(workspace, file, file.reading->names.uses[*use.callee]);
    const auto in = called ? file_at(workspace, called->path) : std::nullopt;
    if (!in) return std::nullopt;
    const Names &names = in->reading->names;
    const lang::FunctionId function = names.declarations[called->declaration].function;
    const auto found = names.parameters.find({function.index, use.name});
    if (!function || found == names.parameters.end()) return std::nullopt;
    return Target{called->path, found->second};
}

} // namespace

std::optional<Target> target_of(Workspace &workspace, const File &file, const Use &use) {
    if (use.declaration) return Target{file.path, *use.declaration};
    const Names &names = file.reading->names;
    if (use.as == UsedAs::Argument) return parameter_target(workspace, file, use);
    if (use.module)
        return exported(workspace, imported_path(file.path, names.declarations[*use.module].path),
                        use.name);
    for (std::size_t import : names.open_imports)
        if (auto found = exported(
                workspace, imported_path(file.path, names.declarations[import].path), use.name))
            return found;
    return std::nullopt;
}

std::optional<Target> target_at(Workspace &workspace, const File &file, std::size_t offset) {
    if (auto declared = file.reading->names.declaration_at(offset))
        return Target{file.path, first_form(file.reading->names, *declared)};
    const Use *use = file.reading->names.use_at(offset);
    return use ? target_of(workspace, file, *use) : std::nullopt;
}

std::vector<Mention> mentions_of(Workspace &workspace, const Target &target,
                                 const std::vector<File> &files) {
    std::vector<Mention> all;
    const auto home = file_at(workspace, target.path);
    if (!home) return all;
    const Declaration &meant = home->reading->names.declarations[target.declaration];
    all.push_back({target.path, meant.at, true, true, false});
    for (const Declaration &other : home->reading->names.declarations)
        if (&other != &meant && is_form_of(other, meant))
            all.push_back({target.path, other.at, true, true, false});
    const bool local = !meant.top_level && meant.by != DeclaredBy::Parameter;
    for (const File &file : files) {
        if (local && file.path != target.path) continue;
        for (const Use &use : file.reading->names.uses)
            if (use.name == meant.name && target_of(workspace, file, use) == target)
                all.push_back({file.path, use.at, false, use.as == UsedAs::Target, use.doubtful});
    }
    return all;
}

} // namespace fathom::language
