// `fathom view`: a window that follows a scene's file. Knows no command line.
#pragma once

#include "driver/compile.h"

#include <filesystem>
#include <string>

namespace fathom::viewer {

struct Settings {
    std::filesystem::path file;
    driver::CompileOptions options;
    int width = 1280, height = 800;
    std::filesystem::path record; // a folder: a picture of the window goes there after every reload; empty: none
};

// Runs until the window is closed. An empty text, or the sentence that says why there is no window.
std::string run(const Settings &settings);

} // namespace fathom::viewer
