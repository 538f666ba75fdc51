// Runs the real program through a shell, in a folder of its own.
#pragma once

#include "scratch_folder.h"

#include <cstdlib>
#include <sys/wait.h>

namespace fs = std::filesystem;

struct Result {
    int exit = -1;
    std::string out, err;
};

// Runs a shell line in the folder, with `fathom` for the program.
inline Result shell(const ScratchFolder &folder, const std::string &line) {
    std::string whole = "cd '" + folder.path().string() +
                        "' && fathom() { '" FATHOM_PROGRAM "' \"$@\"; } && { " + line +
                        "; } >.out 2>.err";
    int status = std::system(whole.c_str());
    Result result{WIFEXITED(status) ? WEXITSTATUS(status) : -1, folder.read(".out"),
                  folder.read(".err")};
    fs::remove(folder / ".out");
    fs::remove(folder / ".err");
    return result;
}

inline bool contains(const std::string &text, const std::string &part) {
    return text.find(part) != text.npos;
}
