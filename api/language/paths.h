// The files that a text names: what it imports, its images and its grids.
#pragma once

#include "api/language/workspace.h"

#include <string_view>

namespace fathom::language {

// What a string of a text names, by where it stands.
enum class Named { Nothing, Scene, Image, Grid };
Named named_by(const Syntax &syntax, const lang::Token &string);
bool may_be(Named what, std::string_view ending); // an ending with its dot

struct NamedFile {
    Span at;          // the path as it is written, without the quotes
    std::string path; // what it leads to, whether that is there or not
};
std::vector<NamedFile> named_files(const File &file);

} // namespace fathom::language
