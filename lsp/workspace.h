// What the server knows: the open texts, the files beside them, the library. A text is read and
// compiled when that is first wanted, and again after it changed.
#pragma once

#include "lsp/json.h"
#include "lsp/names.h"

#include "driver/compile.h"
#include "proof/prove.h"

#include <fathom/fathom.h>

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace fathom::lsp {

// A text's tree, its names, and where its lines begin.
struct Reading {
    Syntax syntax;
    Names names;
    Lines lines;
};

// What came of a text: the compiler's own result, and what it says as the client is told it.
struct Compiled {
    driver::Compilation compilation;
    std::vector<fathom::v1::Diagnostic> diagnostics;
    std::optional<proof::Explanation> explanation; // of the bounds, once someone asked
    bool good() const { return compilation.good(); }
};

// A text that a client has open.
struct Document {
    std::string uri, path, text;
    int version = 0;
    std::optional<Compiled> compiled; // of the text as it is
    std::optional<Compiled> replaced; // of an earlier one: freed with the next, as it takes time
    std::shared_ptr<const Reading> reading; // of the text as it is
    bool published = false;                 // its diagnostics were sent
    std::set<std::string> asked_for;        // paths that compiling it wanted to read
    // Of names, as the last compilations knew them: half-typed texts go on having types.
    std::optional<std::map<std::string, std::string, std::less<>>> types; // none: never compiled
};

// A text of the workspace, open or not.
struct File {
    std::string path, text;
    std::shared_ptr<const Reading> reading;
};

// A value of the library that is no function.
struct Constant {
    std::string name, type;
    std::optional<std::uint32_t> rgb; // of a named colour
};

struct Workspace {
    std::map<std::string, Document> documents; // by address
    std::vector<std::string> roots;            // folders that the client opened
    std::vector<fathom::v1::LibraryEntry> library;
    std::multimap<std::string, std::size_t, std::less<>> entries; // of `library`, by name
    std::vector<Constant> constants;                              // by name
    bool snippets = false;                          // the client takes snippets from completion
    std::vector<std::pair<std::string, Json>> said; // methods and params that go before the answer

    fathom::v1::ProofCache proofs; // from one edit to the next; a server's own
    // Whether nobody waits for the compilation in hand any more; may be empty.
    std::function<bool()> outdated;

    struct Cached {
        std::filesystem::file_time_type time;
        File file;
    };
    std::map<std::string, Cached> closed; // files that were read, by path
};

Workspace workspace_with_library();

// Throws `UnknownDocument` where the address is of no open text.
struct UnknownDocument : std::exception {
    const char *what() const noexcept override { return "this text is not open"; }
};
Document &document_at(Workspace &workspace, const std::string &uri);

// Throws `Outdated` where nobody waits for it any more.
struct Outdated : std::exception {
    const char *what() const noexcept override { return "no longer wanted"; }
};
const Compiled &compiled(Workspace &workspace, Document &document);
const proof::Explanation &explanation(Workspace &workspace, Document &document);
const Reading &reading(Document &document);

// Compiles a text as the file `path`, with texts in place of files, by path; the rest as it stands.
fathom::v1::CompileResult compile_as(Workspace &workspace, const std::string &path,
                                     const std::string &text,
                                     const std::map<std::string, std::string> &instead = {});

File file_of(Document &document);
// The text at a path: the open one, else the file's, of at most 1 MiB.
std::optional<File> file_at(Workspace &workspace, const std::string &path);
// What a text imports as `path`, seen from the file that says so.
std::string imported_path(const std::string &from, const std::string &path);
// All scenes of the workspace: what is open, and at most 2,000 `.sdf` files of the client's folders
// (without one, of the folder of each open text). Hidden folders are left out.
std::vector<File> all_files(Workspace &workspace);

std::vector<const fathom::v1::LibraryEntry *>
library_forms(const Workspace &workspace, const std::string &name, const std::string &module = "");
const Constant *constant_named(const Workspace &workspace, std::string_view name);

// A function's parameters as its signature says them: "radius: float = 1".
struct Signature {
    std::vector<std::string> parameters;
    std::vector<std::string> names; // of the parameters
    std::string result;             // "shape"; empty where none is said
};
Signature read_signature(const std::string &signature);

} // namespace fathom::lsp
