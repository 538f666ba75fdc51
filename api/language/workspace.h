// What is known of open texts, the files beside them, and the library. A text is read and compiled
// when that is first wanted, and again after it changed.
#pragma once

#include "api/impl.h"
#include "api/language/names.h"

#include "proof/prove.h"

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace fathom::language {

// A text's tree and its names.
struct Reading {
    Syntax syntax;
    Names names;
};

// What came of a text: the compiler's own result, and what it says.
struct Compiled {
    driver::Compilation compilation;
    std::vector<v1::Diagnostic> diagnostics;
    std::optional<proof::Explanation> explanation; // of the bounds, once someone asked
    bool good() const { return compilation.good(); }
};

// An open text.
struct Document {
    std::string path, text;
    std::optional<Compiled> compiled; // of the text as it is
    std::optional<Compiled> replaced; // of an earlier one: freed with the next, as it takes time
    std::shared_ptr<const Reading> reading; // of the text as it is
    std::set<std::string> asked_for;        // paths that compiling it wanted to read
    // Of names, as the last compilations knew them: half-typed texts go on having types.
    std::optional<std::map<std::string, std::string, std::less<>>> types; // none: never checked
    bool types_are_new = false;                                           // of the text as it is
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
    std::map<std::string, Document> documents; // by path
    std::vector<std::string> roots;            // folders that belong to it
    std::vector<v1::LibraryEntry> library;
    std::multimap<std::string, std::size_t, std::less<>> entries; // of `library`, by name
    std::vector<Constant> constants;                              // by name

    v1::ProofCache proofs; // from one edit to the next
    // Whether nobody waits for the compilation in hand any more; may be empty.
    std::function<bool()> outdated;

    struct Cached {
        std::filesystem::file_time_type time;
        File file;
    };
    std::map<std::string, Cached> closed; // files that were read, by path
};

const Workspace &workspace_with_library();

// Throws `Outdated` where nobody waits for it any more.
struct Outdated : std::exception {
    const char *what() const noexcept override { return "no longer wanted"; }
};
const Compiled &compiled(Workspace &workspace, Document &document);
// The same, or nothing where the proof takes longer than a reader of a hover waits.
const Compiled *compiled_soon(Workspace &workspace, Document &document);
// Types of names: of the text as it is where `anew`, else also of an earlier one. Nothing is proved.
const std::map<std::string, std::string, std::less<>> &types_of(Workspace &workspace,
                                                                Document &document, bool anew);
const proof::Explanation &explanation(Workspace &workspace, Document &document);
const Reading &reading(Document &document);

// Compiles a text as the file `path`, with texts in place of files, by path; the rest as it stands.
v1::CompileResult compile_as(Workspace &workspace, const std::string &path, const std::string &text,
                             const std::map<std::string, std::string> &instead = {});

File file_of(Document &document);
// The text at a path: the open one, else the file's, of at most 1 MiB.
std::optional<File> file_at(Workspace &workspace, const std::string &path);
// What a text imports as `path`, seen from the file that says so.
std::string imported_path(const std::string &from, const std::string &path);
// All scenes of the workspace: what is open, and at most 2,000 `.sdf` files of its folders
// (without one, of the folder of each open text). Hidden folders are left out.
std::vector<File> all_files(Workspace &workspace);

std::vector<const v1::LibraryEntry *>
library_forms(const Workspace &workspace, const std::string &name, const std::string &module = "");
const Constant *constant_named(const Workspace &workspace, std::string_view name);

// A function's parameters as its signature says them: "radius: float = 1".
struct Signature {
    std::vector<std::string> parameters;
    std::vector<std::string> names; // of the parameters
    std::string result;             // "shape"; empty where none is said
};
Signature read_signature(const std::string &signature);

} // namespace fathom::language
