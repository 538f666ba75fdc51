// Changes of a text that keep its meaning, as edits: what can be said from the tree and the names
// alone. Who offers one compiles the new text first (actions.cpp). Opens no file.
#pragma once

#include "api/language/names.h"

#include <fathom/language.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace fathom::language {

using v1::TextEdit, v1::CodeAction;

// The text with all edits done; they do not overlap.
std::string edited(std::string_view text, std::vector<TextEdit> edits);

// `begin` to `end`: the selection, which may be empty. Nothing where that is no place for it.
std::optional<CodeAction> extract_let(const Syntax &, const Names &, std::size_t begin,
                                      std::size_t end);
std::optional<CodeAction> extract_function(const Syntax &, const Names &, std::size_t begin,
                                           std::size_t end);
// A literal as a `param`: of a number the range is from half of it to twice as much.
std::optional<CodeAction> extract_param(const Syntax &, const Names &, std::size_t begin,
                                        std::size_t end);
// A `let` without a type: its value in place of all its uses.
std::optional<CodeAction> inline_let(const Syntax &, const Names &, std::size_t at);
// The angle at a byte in the other units; equal in single precision.
std::vector<CodeAction> convert_units(const Syntax &, std::size_t at);

// What an argument's parameter is called: of the use that names the function, the argument's place
// (the object before a dot is 0) and how many there are; empty where that is not sure.
using ParameterName =
    std::function<std::string(const Use &use, std::size_t index, std::size_t count)>;
// The argument at a byte and all that follow it by their names.
std::optional<CodeAction> name_argument(const Syntax &, const Names &, std::size_t at,
                                        const ParameterName &parameter);

} // namespace fathom::language
