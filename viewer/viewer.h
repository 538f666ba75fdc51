// `fathom view`: a window that follows a scene's file. Knows no command line.
#pragma once

#include "base/limits.h"

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace fathom::viewer {

// What `fathom view` is told.
struct Settings {
    std::filesystem::path file;
    std::vector<std::filesystem::path> include_folders;
    std::vector<std::pair<std::string, std::string>> values; // of params: name and text
    Limits limits;
    bool strict_proof = false;
    int width = 1280, height = 800;
    std::filesystem::path
        record; // a folder: a picture of the window goes there after every reload; empty: none
    std::filesystem::path
        editor;             // a socket: of an editor whose text is shown as it is typed; empty:
                            // none
    bool save_view = false; // the view is written into the file when the window closes
    bool still = false;     // time stands, from the start
    bool one_context =
        false; // the driver links on the window's thread, as where contexts cannot share
    std::function<void(const std::string &)>
        tell{}; // a line for each reload that is on the screen; may be empty
};

// Runs until the window is closed. An empty text, or the sentence that says why there is no window.
std::string run(const Settings &settings);

} // namespace fathom::viewer
