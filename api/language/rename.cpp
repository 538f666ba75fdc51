// Rename, in all files of the workspace. The new text is read again before it is handed out: each
// name has to mean what it meant, and what compiled has to compile.
#include "api/language/features.h"
#include "api/language/targets.h"

#include "lang/vocabulary.h"

#include <algorithm>
#include <fmt/format.h>

namespace fathom::language {
namespace {

bool is_name(std::string_view text) {
    const auto letter = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
    };
    if (text.empty() || !letter(text[0])) return false;
    for (char c : text)
        if (!letter(c) && (c < '0' || c > '9')) return false;
    const std::vector<std::string_view> keywords = lang::vocabulary().keywords;
    return std::ranges::find(keywords, text) == keywords.end();
}

// A file's mentions, by place, and its text with the new name there.
struct Rewritten {
    File before;
    std::vector<Span> at;
    std::string after;
};

// The new byte of an old one.
std::size_t moved(const Rewritten &file, std::size_t offset, std::ptrdiff_t longer) {
    std::ptrdiff_t shift = 0;
    for (Span at : file.at)
        if (at.begin < offset) shift += longer;
    return offset + static_cast<std::size_t>(shift);
}

// Whether each use of the file means the declaration that it meant, and nothing new means one.
bool means_the_same(const Rewritten &file, const std::string &new_name, std::ptrdiff_t longer) {
    const Syntax syntax = read_syntax(file.after);
    const Names now = names_of(syntax.ast);
    const Names &before = file.before.reading->names;
    if (now.uses.size() != before.uses.size() ||
        now.declarations.size() != before.declarations.size())
        return false;
    for (std::size_t i = 0; i < now.uses.size(); ++i) {
        const Use &old = before.uses[i], &renamed = now.uses[i];
        if (renamed.at.begin != moved(file, old.at.begin, longer) ||
            renamed.declaration != old.declaration || renamed.module != old.module)
            return false;
        // a name of another file or of the library that was called so before
        if (!old.declaration && !old.module && old.as != UsedAs::Argument && old.name == new_name)
            return false;
    }
    return true;
}

// Whether an import would now bring the file a name that it uses for the library's.
bool would_hide(Workspace &workspace, const File &file, const Target &target,
                const std::string &old_name, const std::string &new_name) {
    if (file.path == target.path) return false;
    const auto imports_it = [&] {
        const Use probe{old_name, {}, UsedAs::Value, {}, {}, {}, false};
        return target_of(workspace, file, probe) == target;
    };
    return std::ranges::any_of(file.reading->names.uses, [&](const Use &use) {
        return use.name == new_name && !use.declaration && !use.module &&
               use.as != UsedAs::Argument && imports_it();
    });
}

} // namespace

std::optional<v1::Stretch> renamable(Workspace &workspace, Document &document, std::size_t at) {
    const File file = file_of(document);
    const Names &names = file.reading->names;
    if (!target_at(workspace, file, at)) return std::nullopt;
    const auto declared = names.declaration_at(at);
    return stretch_of(declared ? names.declarations[*declared].at : names.use_at(at)->at);
}

v1::WorkspaceEdit rename(Workspace &workspace, Document &document, std::size_t at,
                         const std::string &new_name) {
    const auto target = target_at(workspace, file_of(document), at);
    if (!target) throw Refusal("only names that a text declares can be renamed");
    if (!is_name(new_name)) throw Refusal(fmt::format("`{}` is no name", new_name));
    const auto home = file_at(workspace, target->path);
    const std::string old_name = home->reading->names.declarations[target->declaration].name;
    const auto longer =
        static_cast<std::ptrdiff_t>(new_name.size()) - static_cast<std::ptrdiff_t>(old_name.size());
    std::map<std::string, Rewritten> rewritten;
    const std::vector<File> files = all_files(workspace);
    for (const File &other : files)
        if (would_hide(workspace, other, *target, old_name, new_name))
            throw Refusal(
                fmt::format("`{}` would mean something else then in {}", new_name, other.path));
    for (const Mention &mention : mentions_of(workspace, *target, files)) {
        if (mention.doubtful)
            throw Refusal(fmt::format(
                "two declarations may be meant where `{}` stands in line {}", old_name,
                line_of(file_at(workspace, mention.path)->reading->syntax, mention.at.begin)));
        Rewritten &part = rewritten[mention.path];
        part.at.push_back(mention.at);
    }
    std::map<std::string, std::string> texts;
    v1::WorkspaceEdit changes;
    for (auto &[path, part] : rewritten) {
        part.before = *file_at(workspace, path);
        part.after = part.before.text;
        std::ranges::sort(part.at);
        std::vector<v1::TextEdit> edits;
        for (std::size_t i = part.at.size(); i-- > 0;) {
            const Span at = part.at[i];
            part.after.replace(at.begin, at.end - at.begin, new_name);
            edits.push_back({stretch_of(at), new_name});
        }
        changes[path] = std::move(edits);
        texts[path] = part.after;
        if (!means_the_same(part, new_name, longer))
            throw Refusal(fmt::format("`{}` would mean something else then in {}", new_name, path));
    }
    for (const auto &[path, part] : rewritten)
        if (compile_as(workspace, path, part.before.text) &&
            !compile_as(workspace, path, part.after, texts))
            throw Refusal(fmt::format("{} would not compile any more", path));
    return changes;
}

} // namespace fathom::language
