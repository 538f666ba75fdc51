// Opens a place of a file in the user's editor. Knows how editors are told a line, nothing of
// windows.
#pragma once

#include <string>
#include <vector>

namespace fathom::viewer {

// `editor` as in $EDITOR, words and all. The file goes as an absolute path, so that no name is
// taken for an option or a command, and as one word: no shell sees it.
std::vector<std::string> editor_command(const std::string &editor, const std::string &file,
                                        unsigned line, unsigned column);
bool needs_terminal(const std::string &editor); // vim, nano, …: it has no window of its own
// `terminal` as in $TERMINAL.
std::vector<std::string> in_terminal(const std::string &terminal,
                                     const std::vector<std::string> &command);

// $VISUAL, else $EDITOR, else nothing.
std::string users_editor();

// Starts the editor and does not wait. What was done, or why it was not, in words.
std::string open_in_editor(const std::string &editor, const std::string &file, unsigned line,
                           unsigned column);

} // namespace fathom::viewer
