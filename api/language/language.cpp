// The public workspace: questions by paths, answered without exceptions.
#include "api/language/features.h"

#include <fathom/language.h>

namespace fathom::v1 {

struct Workspace::Impl {
    language::Workspace workspace;
};

namespace {

namespace in = fathom::language;

struct NotOpen : std::exception {
    const char *what() const noexcept override { return "this text is not open"; }
};

template <class T, class Work> Answer<T> answered(Work work) noexcept {
    Answer<T> answer;
    const auto failed = [&](Outcome outcome, const char *why) {
        answer.value = T{};
        answer.outcome = outcome;
        try {
            answer.why = why;
        } catch (const std::bad_alloc &) { // the outcome says enough
        }
    };
    try {
        answer.value = work();
    } catch (const NotOpen &why) {
        failed(Outcome::NotOpen, why.what());
    } catch (const in::Refusal &why) {
        failed(Outcome::Refused, why.what());
    } catch (const in::Outdated &why) {
        failed(Outcome::Outdated, why.what());
    } catch (const std::bad_alloc &) {
        failed(Outcome::Failed, "there is not enough memory");
    } catch (const std::exception &why) {
        failed(Outcome::Failed, why.what());
    }
    return answer;
}

// `impl`: null where there was no memory for it.
in::Workspace &whole(const std::unique_ptr<Workspace::Impl> &impl) {
    if (!impl) throw std::bad_alloc();
    return impl->workspace;
}

// Of an open text.
template <class T, class Work> Answer<T> of_text(const std::unique_ptr<Workspace::Impl> &impl,
                                                 const std::string &path, Work work) noexcept {
    return answered<T>([&] {
        in::Workspace &workspace = whole(impl);
        const auto found = workspace.documents.find(path);
        if (found == workspace.documents.end()) throw NotOpen();
        return work(workspace, found->second);
    });
}

// The same for a stretch or a place that may lie beyond the text's end.
Stretch inside(const in::Document &document, Stretch within) {
    const std::size_t end = std::min(within.end, document.text.size());
    return {std::min(within.begin, end), end};
}
std::size_t inside(const in::Document &document, std::size_t at) {
    return std::min(at, document.text.size());
}

// What imports a text may compile differently once that has changed.
std::vector<std::string> changed(in::Workspace &workspace, in::Document &document) {
    std::vector<std::string> paths;
    document.reading.reset();
    for (auto &[path, other] : workspace.documents) {
        if (&other != &document && !other.asked_for.contains(document.path)) continue;
        if (other.compiled) other.replaced = std::move(other.compiled);
        other.compiled.reset();
        other.types_are_new = false;
        paths.push_back(path);
    }
    return paths;
}

template <class T, class Work> T whole_or_empty(Work work) noexcept {
    return guarded(work, [](const Diagnostic &) { return T{}; });
}

using Paths = std::vector<std::string>;

} // namespace

Workspace::Workspace() {
    impl_ = whole_or_empty<std::unique_ptr<Impl>>([] {
        std::unique_ptr<Impl> impl(new Impl{in::workspace_with_library()});
        impl->workspace.proofs = ProofCache::of_bytes();
        return impl;
    });
}
Workspace::Workspace(Workspace &&) noexcept = default;
Workspace &Workspace::operator=(Workspace &&) noexcept = default;
Workspace::~Workspace() = default;

void Workspace::set_folders(std::vector<std::string> folders) {
    if (impl_) impl_->workspace.roots = std::move(folders);
}

void Workspace::set_outdated(std::function<bool()> outdated) {
    if (impl_) impl_->workspace.outdated = std::move(outdated);
}

Paths Workspace::set_text(const std::string &path, std::string text) {
    return whole_or_empty<Paths>([&] {
        in::Workspace &workspace = whole(impl_);
        in::Document &document = workspace.documents[path];
        document.path = path;
        document.text = std::move(text);
        return changed(workspace, document);
    });
}

Paths Workspace::close(const std::string &path) {
    return whole_or_empty<Paths>([&]() -> Paths {
        in::Workspace &workspace = whole(impl_);
        const auto found = workspace.documents.find(path);
        if (found == workspace.documents.end()) return {};
        Paths paths = changed(workspace, found->second); // who imports it sees the file again
        std::erase(paths, path);
        workspace.documents.erase(found);
        return paths;
    });
}

Paths Workspace::files_changed() {
    return whole_or_empty<Paths>([&] {
        Paths paths;
        in::Workspace &workspace = whole(impl_);
        for (auto &[path, document] : workspace.documents) {
            changed(workspace, document);
            paths.push_back(path);
        }
        return paths;
    });
}

std::optional<std::string_view> Workspace::text(const std::string &path) {
    return whole_or_empty<std::optional<std::string_view>>(
        [&]() -> std::optional<std::string_view> {
            in::Workspace &workspace = whole(impl_);
            if (const auto open = workspace.documents.find(path); open != workspace.documents.end())
                return open->second.text;
            if (!in::file_at(workspace, path)) return std::nullopt;
            return workspace.closed.at(path).file.text;
        });
}

Answer<std::vector<Diagnostic>> Workspace::diagnostics(const std::string &path) {
    return of_text<std::vector<Diagnostic>>(impl_, path, [](auto &workspace, auto &document) {
        return in::compiled(workspace, document).diagnostics;
    });
}

Answer<Hover> Workspace::hover(const std::string &path, std::size_t at) {
    return of_text<Hover>(impl_, path, [&](auto &workspace, auto &document) {
        return in::hover(workspace, document, inside(document, at));
    });
}

Answer<std::vector<BoundAt>> Workspace::bounds(const std::string &path) {
    return of_text<std::vector<BoundAt>>(impl_, path, [](auto &workspace, auto &document) {
        return in::bounds(workspace, document);
    });
}

Answer<Explanation> Workspace::explanation(const std::string &path) {
    return of_text<Explanation>(
        impl_, path, [](auto &workspace, auto &document) { return in::why(workspace, document); });
}

Answer<std::vector<ArgumentName>> Workspace::argument_names(const std::string &path,
                                                            Stretch within) {
    return of_text<std::vector<ArgumentName>>(impl_, path, [&](auto &workspace, auto &document) {
        return in::argument_names(workspace, document, inside(document, within));
    });
}

Answer<std::vector<CompletionItem>> Workspace::completion(const std::string &path, std::size_t at,
                                                          bool snippets) {
    return of_text<std::vector<CompletionItem>>(impl_, path, [&](auto &workspace, auto &document) {
        return in::completion(workspace, document, inside(document, at), snippets);
    });
}

Answer<SignatureHelp> Workspace::signature_help(const std::string &path, std::size_t at) {
    return of_text<SignatureHelp>(impl_, path, [&](auto &workspace, auto &document) {
        return in::signature_help(workspace, document, inside(document, at));
    });
}

Answer<std::optional<Location>> Workspace::definition(const std::string &path, std::size_t at) {
    return of_text<std::optional<Location>>(impl_, path, [&](auto &workspace, auto &document) {
        return in::definition(workspace, document, inside(document, at));
    });
}

Answer<std::vector<Location>> Workspace::references(const std::string &path, std::size_t at,
                                                    bool with_declaration) {
    return of_text<std::vector<Location>>(impl_, path, [&](auto &workspace, auto &document) {
        return in::references(workspace, document, inside(document, at), with_declaration);
    });
}

Answer<std::vector<Highlight>> Workspace::highlights(const std::string &path, std::size_t at) {
    return of_text<std::vector<Highlight>>(impl_, path, [&](auto &workspace, auto &document) {
        return in::highlights(workspace, document, inside(document, at));
    });
}

Answer<std::vector<DocumentSymbol>> Workspace::symbols(const std::string &path) {
    return of_text<std::vector<DocumentSymbol>>(
        impl_, path, [](auto &, auto &document) { return in::symbols(document); });
}

Answer<std::vector<WorkspaceSymbol>> Workspace::find_symbols(const std::string &query) {
    return answered<std::vector<WorkspaceSymbol>>(
        [&] { return in::find_symbols(whole(impl_), query); });
}

Answer<std::vector<DocumentLink>> Workspace::links(const std::string &path) {
    return of_text<std::vector<DocumentLink>>(
        impl_, path, [](auto &, auto &document) { return in::links(document); });
}

Answer<std::optional<Stretch>> Workspace::renamable(const std::string &path, std::size_t at) {
    return of_text<std::optional<Stretch>>(impl_, path, [&](auto &workspace, auto &document) {
        return in::renamable(workspace, document, inside(document, at));
    });
}

Answer<WorkspaceEdit> Workspace::rename(const std::string &path, std::size_t at,
                                        const std::string &name) {
    return of_text<WorkspaceEdit>(impl_, path, [&](auto &workspace, auto &document) {
        return in::rename(workspace, document, inside(document, at), name);
    });
}

Answer<WorkspaceEdit> Workspace::rename_files(const std::vector<RenamedFile> &files) {
    return answered<WorkspaceEdit>([&] { return in::rename_files(whole(impl_), files); });
}

Answer<std::vector<SemanticToken>> Workspace::tokens(const std::string &path, Stretch within) {
    return of_text<std::vector<SemanticToken>>(impl_, path, [&](auto &workspace, auto &document) {
        return in::tokens(workspace, document, inside(document, within));
    });
}

Answer<std::vector<FoldingRange>> Workspace::folding(const std::string &path) {
    return of_text<std::vector<FoldingRange>>(
        impl_, path, [](auto &, auto &document) { return in::folding(document); });
}

Answer<std::vector<Stretch>> Workspace::selections(const std::string &path, std::size_t at) {
    return of_text<std::vector<Stretch>>(impl_, path, [&](auto &, auto &document) {
        return in::selections(document, inside(document, at));
    });
}

Answer<std::vector<ColorAt>> Workspace::colors(const std::string &path) {
    return of_text<std::vector<ColorAt>>(impl_, path, [](auto &workspace, auto &document) {
        return in::colors(workspace, document);
    });
}

Answer<std::vector<TextEdit>> Workspace::format(const std::string &path, Stretch within) {
    return of_text<std::vector<TextEdit>>(impl_, path, [&](auto &, auto &document) {
        return in::format(document, inside(document, within));
    });
}

Answer<std::vector<TextEdit>> Workspace::format_typed(const std::string &path, std::size_t at,
                                                      char typed) {
    return of_text<std::vector<TextEdit>>(impl_, path, [&](auto &, auto &document) {
        return in::format_typed(document, inside(document, at), typed);
    });
}

Answer<std::vector<CodeAction>> Workspace::actions(const std::string &path, Stretch within,
                                                   const ActionKinds &kinds) {
    return of_text<std::vector<CodeAction>>(impl_, path, [&](auto &workspace, auto &document) {
        return in::actions(workspace, document, inside(document, within), kinds);
    });
}

std::vector<std::string> color_texts(const std::array<double, 4> &rgba) {
    return whole_or_empty<std::vector<std::string>>(
        [&] { return in::color_texts(in::workspace_with_library(), rgba); });
}

} // namespace fathom::v1
