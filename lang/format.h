// The one style of `fathom fmt`: idempotent, keeps every comment, never changes what a program
// means.
#pragma once

#include "base/diagnostic.h"
#include "lang/ast.h"

#include <string>

namespace fathom::lang {

// The formatted text; the source must have parsed without an error.
std::string format(const Sources &sources, const Ast &ast);

// An indented, stable picture of the tree for goldens (`ast` section).
std::string dump(const Ast &ast);

} // namespace fathom::lang
