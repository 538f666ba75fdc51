// What the system tells of folders: that some name in one changed. Of the systems' ways only Linux's
// inotify is known, and to folder_events.cpp alone; elsewhere nothing is told.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace fathom::driver {

class FolderEvents {
  public:
    FolderEvents();
    ~FolderEvents();
    FolderEvents(const FolderEvents &) = delete;
    FolderEvents &operator=(const FolderEvents &) = delete;

    // Why nothing is told: the system has no way for it, or gives no more of it. Empty where it is.
    const std::string &refusal() const { return refusal_; }
    // Readable (poll) once there is something to read; -1 where nothing is told.
    int descriptor() const { return refusal_.empty() ? inotify_ : -1; }

    // The folders to watch from now on, in place of those before, each with the names in it that
    // matter. A folder that there is not is none.
    void watch(std::map<std::filesystem::path, std::vector<std::string>> names);

    // What has come since: whether a name that matters was among it, whether the last event on one
    // left its file complete, and whether a folder, or a link on the way to a file, came or went, so
    // that `watch` should be called anew.
    struct Batch {
        bool relevant = false;
        bool complete = false;
        bool folders_changed = false;
    };
    Batch read();

  private:
    void refuse(int error, const char *what);

    int inotify_ = -1;
    std::string refusal_;
    std::map<int, std::filesystem::path> folders_; // by watch descriptor
    std::map<std::filesystem::path, std::vector<std::string>> names_;
};

} // namespace fathom::driver
