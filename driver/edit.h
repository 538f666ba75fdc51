// Small edits of a scene's text, by its tree: a param's value, the camera. All other bytes stay as
// they are. Opens no file.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fathom::driver {

// The text with the param's value replaced; nothing where it declares no such param.
std::optional<std::string> with_param(const std::string &text, std::string_view name,
                                      std::string_view value);

// The text with its `camera(…)` statement replaced by this one, or with it as a new last line.
std::string with_camera(const std::string &text, std::string_view camera);

// What a window shows beside the scene's camera is kept in comments, `// view 2: camera(…)`, one a
// line: they are replaced by these, or stand at the end.
std::string with_views(const std::string &text, const std::vector<std::string> &cameras);
std::vector<std::string> views_in(const std::string &text);

} // namespace fathom::driver
