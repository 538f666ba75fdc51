// Tells when a file, or any other that the scene read, was saved. Watches *directories*, so that an
// editor's atomic renames, delete-and-create and backup dances are seen; joins bursts. Where the
// system gives no watches, it looks at the files twice a second, and says so. Knows nothing of what
// the files hold.
#pragma once

#include "driver/files.h"
#include "driver/folder_events.h"

#include <array>
#include <chrono>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace fathom::driver {

// Waits until one of a set of files is saved.
class Watcher {
  public:
    // Why it looks at the files instead of being told (FolderEvents::refusal). Empty where it is told.
    std::string polls_because() const;

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
    void settle(bool complete);
    bool compare();
    bool wait_polling(std::chrono::steady_clock::time_point end);

    bool told() const { return events_.refusal().empty(); }

    struct Wake { // a pipe: a byte in it ends a wait
        Wake();
        ~Wake();
        Wake(const Wake &) = delete;
        Wake &operator=(const Wake &) = delete;
        std::array<int, 2> ends{-1, -1};
    } wake_;
    FolderEvents events_;
    std::map<std::filesystem::path, FileStamp> files_; // absolute; as last reported
    bool compare_first_ = false;
};

} // namespace fathom::driver
