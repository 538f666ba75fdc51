// Small edits of a scene's text, by its tree: a param's value, the camera. All other bytes stay as
// they are; a save file is written anew, with all that it held. Opens none of them.
#pragma once

#include "driver/compile.h"

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace fathom::driver {

// No statement of it is half written: it parses.
bool can_be_read(const std::string &text);

// How the text writes a param's value, so that another value can be written the same way.
struct Notation {
    bool hex = false; // a colour as `#d08030`
    std::string unit; // of an angle: "deg", "turn", or "" for radians and for what is no angle
};
Notation notation_of_param(const std::string &text, std::string_view name);

// The text with the param's value replaced; nothing where it declares no such param.
std::optional<std::string> with_param(const std::string &text, std::string_view name,
                                      std::string_view value);

// The text with its `camera(…)` statement replaced by this one, or with it as a new last line.
std::string with_camera(const std::string &text, std::string_view camera);

// What a window shows beside the scene's camera is kept in comments, `// view 2: camera(…)`, one a
// line: they are replaced by these, or stand at the end.
std::string with_views(const std::string &text, const std::vector<std::string> &cameras);
std::vector<std::string> views_in(const std::string &text);

bool is_save_file(const std::filesystem::path &file); // .yaml, .yml: imported before it is compiled

// A save file's text, seen from that `camera(…)`: imported, and exported again. Its paths are read
// from `folder`. Else the sentence that says why it cannot be.
struct EditError {
    std::string sentence;
};
std::variant<std::string, EditError> save_file_with_camera(const std::string &yaml,
                                                           std::string_view camera,
                                                           const std::filesystem::path &folder,
                                                           const CompileOptions &options);

} // namespace fathom::driver
