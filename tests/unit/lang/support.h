// What the tests of lang share: reading a text, and checking that a tree is whole.
#pragma once

#include "base/diagnostic.h"
#include "lang/format.h"
#include "lang/parse.h"

#include <string>
#include <vector>

namespace lang_test {

struct Parsed {
    fathom::Sources sources;
    fathom::SourceId id;
    fathom::Diagnostics diagnostics;
    fathom::lang::Ast ast;

    explicit Parsed(std::string text)
        : id(sources.add("a.sdf", std::move(text))),
          ast(fathom::lang::parse(sources, id, diagnostics)) {}
    const std::string &text() const { return sources[id].text; }
    std::string tree() const { return fathom::lang::dump(ast); }
    std::string formatted() const { return fathom::lang::format(sources, ast); }
    // The codes of the errors, by place.
    std::vector<std::string> codes() const;
    std::string report() const; // all diagnostics as text
};

// The tree of a text that must have no error, in one line: `binary +(int 1, name a)`, statements
// parted by `; `. With an error, the report.
std::string tree_of(const std::string &text);

// The text with the diagnostic's edits made.
std::string apply_fix(const std::string &text, const fathom::Diagnostic &diagnostic);

// Nothing, or the first thing that is wrong with a tree: an id out of range, a node used twice or
// by a later node, a place outside the text.
std::string defect(const Parsed &parsed);

// All `.sdf` files of the project: examples, library, goldens' scenes.
struct File {
    std::string path, text;
};
std::vector<File> corpus();

} // namespace lang_test
