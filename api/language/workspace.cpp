#include "api/language/workspace.h"

#include "typecheck/check.h"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iterator>
#include <set>

namespace fathom::language {
namespace {

namespace fs = std::filesystem;

std::optional<std::string> read_whole(const fs::path &file, std::uintmax_t most) {
    std::error_code error;
    if (!fs::is_regular_file(file, error) || fs::file_size(file, error) > most || error)
        return std::nullopt;
    std::ifstream in(file, std::ios::binary);
    if (!in) return std::nullopt;
    return std::string(std::istreambuf_iterator<char>(in), {});
}

// The compiler has its own limits of a file's size; this one is above them.
constexpr std::uintmax_t any_size = std::uintmax_t{1} << 40, most_of_a_text = 1 << 20;

std::shared_ptr<const Reading> read_text(const std::string &text) {
    auto made = std::make_shared<Reading>();
    made->syntax = read_syntax(text);
    made->names = names_of(made->syntax.ast);
    return made;
}

// What a text imports: `instead`, else what is open, else the files beside it.
v1::FileProvider files_beside(Workspace &workspace, const fs::path &folder,
                              const std::map<std::string, std::string> &instead,
                              std::set<std::string> *asked_for) {
    return [&workspace, instead, asked_for,
            folder](const std::string &name) -> std::optional<std::string> {
        const fs::path file = folder / name;
        if (asked_for) asked_for->insert(file.string());
        if (const auto found = instead.find(file.string()); found != instead.end())
            return found->second;
        if (const auto open = workspace.documents.find(file.string());
            open != workspace.documents.end())
            return open->second.text;
        std::error_code error; // a link that leads out of the folder is not followed
        const fs::path real = fs::weakly_canonical(file, error),
                       root = fs::weakly_canonical(folder, error);
        const fs::path way = real.lexically_relative(root);
        if (error || way.empty() || *way.begin() == "..") return std::nullopt;
        return read_whole(file, any_size);
    };
}

// A fault of ours, or a lack of memory, is the only thing that is said of the text then.
Compiled compile(Workspace &workspace, Document &document, bool types_alone) {
    const auto work = [&] {
        const v1::FileProvider files =
            files_beside(workspace, fs::path(document.path).parent_path(), {}, &document.asked_for);
        driver::CompileOptions options;
        if (workspace.proofs.impl()) options.bounds = &workspace.proofs.impl()->bounds;
        options.cancelled = workspace.outdated;
        options.types_alone = types_alone;
        Compiled made{
            driver::compile_loaded(document.path, document.text, v1::loader_of(files), options),
            {},
            {}};
        made.diagnostics = v1::translated(made.compilation.diagnostics, made.compilation.sources);
        return made;
    };
    return v1::guarded(work, [](v1::Diagnostic why) {
        Compiled made;
        made.compilation.unreadable = why.message;
        made.diagnostics.push_back(std::move(why));
        return made;
    });
}

} // namespace

static Workspace made_from_library() {
    Workspace workspace;
    workspace.library = v1::library_entries();
    for (std::size_t i = 0; i < workspace.library.size(); ++i)
        workspace.entries.emplace(workspace.library[i].name, i);
    for (typecheck::LibraryConstant &constant : typecheck::library_constants())
        workspace.constants.push_back(
            {std::move(constant.name), std::move(constant.type), constant.rgb});
    std::ranges::sort(workspace.constants, {}, &Constant::name);
    return workspace;
}

const Workspace &workspace_with_library() {
    static const Workspace made = made_from_library();
    return made;
}

v1::CompileResult compile_as(Workspace &workspace, const std::string &path, const std::string &text,
                             const std::map<std::string, std::string> &instead) {
    v1::CompileOptions options;
    options.files = files_beside(workspace, fs::path(path).parent_path(), instead, nullptr);
    options.cache = workspace.proofs;
    options.cancelled = workspace.outdated;
    v1::CompileResult result = v1::compile_text(path, text, options);
    if (std::ranges::any_of(result.diagnostics,
                            [](const auto &said) { return said.code == "cancelled"; }))
        throw Outdated();
    return result;
}

static void keep_types(Document &document, const driver::Compilation &from) {
    std::map<std::string, std::string, std::less<>> types;
    for (const typecheck::NameFact &name : from.names) types.try_emplace(name.name, name.type);
    if (!from.good() && document.types) types.merge(*document.types); // of what cannot be read now
    document.types = std::move(types);
    document.types_are_new = true;
}

const Compiled &compiled(Workspace &workspace, Document &document) {
    if (!document.compiled) {
        document.asked_for.clear();
        document.replaced.reset();
        Compiled made = compile(workspace, document, false);
        if (made.compilation.cancelled) throw Outdated();
        document.compiled = std::move(made);
        keep_types(document, document.compiled->compilation);
    }
    return *document.compiled;
}

const Compiled *compiled_soon(Workspace &workspace, Document &document) {
    using Clock = std::chrono::steady_clock;
    constexpr std::chrono::milliseconds patience{300};
    const auto end = Clock::now() + patience;
    const std::function<bool()> outdated = workspace.outdated;
    bool late = false;
    workspace.outdated = [&] {
        late = Clock::now() > end;
        return late || (outdated && outdated());
    };
    const Compiled *made = nullptr;
    try {
        made = &compiled(workspace, document);
    } catch (const Outdated &) {
        workspace.outdated = outdated;
        if (!late) throw;
    }
    workspace.outdated = outdated;
    return made;
}

const std::map<std::string, std::string, std::less<>> &types_of(Workspace &workspace,
                                                                Document &document, bool anew) {
    if (!document.types || (anew && !document.types_are_new)) {
        const Compiled made = compile(workspace, document, true);
        if (made.compilation.cancelled) throw Outdated();
        keep_types(document, made.compilation);
    }
    return *document.types;
}

const proof::Explanation &explanation(Workspace &workspace, Document &document) {
    const driver::Compilation &compilation = compiled(workspace, document).compilation;
    if (!document.compiled->explanation)
        document.compiled->explanation = proof::explain(compilation.scene);
    return *document.compiled->explanation;
}

const Reading &reading(Document &document) {
    if (!document.reading) document.reading = read_text(document.text);
    return *document.reading;
}

std::optional<File> file_at(Workspace &workspace, const std::string &path) {
    if (const auto open = workspace.documents.find(path); open != workspace.documents.end())
        return file_of(open->second);
    std::error_code error;
    const fs::file_time_type time = fs::last_write_time(path, error);
    if (error) return std::nullopt;
    const auto cached = workspace.closed.find(path);
    if (cached != workspace.closed.end() && cached->second.time == time) return cached->second.file;
    std::optional<std::string> text = read_whole(path, most_of_a_text);
    if (!text) return std::nullopt;
    File file{path, *text, read_text(*text)};
    workspace.closed[path] = {time, file};
    return file;
}

File file_of(Document &document) {
    (void)reading(document);
    return {document.path, document.text, document.reading};
}

std::string imported_path(const std::string &from, const std::string &path) {
    return (fs::path(from).parent_path() / path).lexically_normal().string();
}

std::vector<File> all_files(Workspace &workspace) {
    constexpr std::size_t most_files = 2000;
    std::set<std::string> paths;
    std::set<fs::path> folders(workspace.roots.begin(), workspace.roots.end());
    for (const auto &[path, document] : workspace.documents) {
        paths.insert(path);
        if (workspace.roots.empty()) folders.insert(fs::path(path).parent_path());
    }
    for (const fs::path &folder : folders) {
        std::error_code error;
        fs::recursive_directory_iterator entry(
            folder, fs::directory_options::skip_permission_denied, error);
        for (std::size_t seen = 0; !error && entry != fs::recursive_directory_iterator() &&
                                   paths.size() < most_files && seen < 20 * most_files;
             entry.increment(error), ++seen) {
            const fs::path &path = entry->path();
            const bool hidden = path.filename().string().starts_with('.');
            if (hidden && entry->is_directory(error)) entry.disable_recursion_pending();
            if (!hidden && path.extension() == ".sdf") paths.insert(path.string());
        }
    }
    std::vector<File> files;
    for (const std::string &path : paths)
        if (std::optional<File> file = file_at(workspace, path)) files.push_back(std::move(*file));
    return files;
}

std::vector<const v1::LibraryEntry *>
library_forms(const Workspace &workspace, const std::string &name, const std::string &module) {
    std::vector<const v1::LibraryEntry *> forms;
    const auto [first, last] = workspace.entries.equal_range(name);
    for (auto entry = first; entry != last; ++entry)
        if (workspace.library[entry->second].module == module)
            forms.push_back(&workspace.library[entry->second]);
    return forms;
}

const Constant *constant_named(const Workspace &workspace, std::string_view name) {
    const auto found = std::ranges::lower_bound(workspace.constants, name, {}, &Constant::name);
    return found == workspace.constants.end() || found->name != name ? nullptr : &*found;
}

Signature read_signature(const std::string &signature) {
    Signature read;
    const std::size_t open = signature.find('(');
    if (open == signature.npos) return read;
    int depth = 0;
    std::size_t begin = open + 1, close = signature.size();
    const auto take = [&](std::size_t end) {
        std::string part = signature.substr(begin, end - begin);
        part.erase(0, part.find_first_not_of(' '));
        if (!part.empty()) {
            read.names.push_back(part.substr(0, part.find_first_of(": =")));
            read.parameters.push_back(std::move(part));
        }
        begin = end + 1;
    };
    for (std::size_t i = open; i < close; ++i) {
        const char c = signature[i];
        if (c == '(' || c == '[') ++depth;
        if (c == ',' && depth == 1) take(i);
        if ((c == ')' || c == ']') && --depth == 0) {
            take(i);
            close = i;
        }
    }
    if (const std::size_t arrow = signature.find("-> ", close); arrow != signature.npos)
        read.result = signature.substr(arrow + 3);
    return read;
}

} // namespace fathom::language
