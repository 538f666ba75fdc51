// Files that the program shows to an editor: the library's texts, the pages of diagnostics, pictures
// of the library's entries. They lie in the user's cache, a folder a version ($XDG_CACHE_HOME, else
// ~/.cache), and are read-only.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace fathom::lsp {

// The file `name` ("library/solids.sdf") with these bytes, written unless it holds them already. A
// name stands for the same bytes always. Nothing where it cannot be written.
std::optional<std::filesystem::path> kept_file(const std::string &name, std::string_view bytes);

// The picture that an entry's `Example:` makes, 160 by 120 pixels, drawn when it is first wanted on
// this machine. Nothing where it has no example, or none that makes a solid.
std::optional<std::filesystem::path>
picture_of_entry(const std::string &name, const std::string &module, const std::string &doc);

} // namespace fathom::lsp
