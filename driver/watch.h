// Tells when a file, or any other that the scene read, was saved. Watches *directories*, so that an
// editor's atomic renames, delete-and-create and backup dances are seen; joins bursts. Where the
// system gives no watches, it looks at the files twice a second, and says so. Knows nothing of what
// the files hold.
#pragma once

#include "driver/files.h"

#include <chrono>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace fathom::driver {

// Waits until one of a set of files is saved.
class Watcher {
  public:
    Watcher();
    ~Watcher();
    Watcher(const Watcher &) = delete;
    Watcher &operator=(const Watcher &) = delete;

    // Why it looks at the files instead of being told: the system gave no inotify instance or watch
    // (its limits are reached). Empty where it is told.
    const std::string &polls_because() const { return polls_because_; }

    // The files to watch from now on, in place of those before, each with its state when it was
    // read: what was saved since then is news too, so nothing falls between reading and watching.
    // Files that do not exist are fine.
    void watch(const std::map<std::filesystem::path, FileStamp> &files);

    // Waits until a watched file has changed and the burst is over, or `timeout` has passed, or
    // `wake` is called. True: something changed. A file that is being written is waited for, to a
    // limit.
    bool wait(std::chrono::milliseconds timeout);

    // Ends a `wait` in another thread, now or the next one.
    void wake();

  private:
    void rewatch_folders();
    void watch_folder(const std::filesystem::path &folder);
    // Reads what the system has; says whether a watched name was among it and whether the last
    // event on one left its file complete.
    struct Batch {
        bool relevant = false;
        bool complete = false;
        bool folders_changed = false;
    };
    Batch read_events();
    void settle(bool complete);
    bool compare();
    void poll_from_now_on(int error, const char *what);
    bool wait_polling(std::chrono::steady_clock::time_point end);

    int inotify_ = -1;
    int wake_ = -1;
    std::string polls_because_;
    std::map<std::filesystem::path, FileStamp> files_; // absolute; as last reported
    bool compare_first_ = false;
    std::map<int, std::filesystem::path> folders_; // by watch descriptor
    std::map<std::filesystem::path, std::vector<std::string>>
        names_; // by folder: the names that matter there
};

} // namespace fathom::driver
