// What a name means across files: the declaration in this text, in an imported one, or none of ours.
#pragma once

#include "api/language/workspace.h"

namespace fathom::language {

struct Target {
    std::string path;
    std::size_t declaration = 0; // index into the file's names
    friend bool operator==(const Target &, const Target &) = default;
};

// What a use means; nothing for a name of the library, or that nothing declares.
std::optional<Target> target_of(Workspace &workspace, const File &file, const Use &use);
// What lies at a byte: a declaration's own name or a use.
std::optional<Target> target_at(Workspace &workspace, const File &file, std::size_t offset);

// A place that says a name.
struct Mention {
    std::string path;
    Span at;
    bool declared = false, written = false; // the declaration; an assignment
    bool doubtful = false;                  // names.h
};
std::vector<Mention> mentions_of(Workspace &workspace, const Target &target,
                                 const std::vector<File> &files);

} // namespace fathom::language
