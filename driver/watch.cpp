#include "driver/watch.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <fcntl.h>
#include <poll.h>
#include <unistd.h>
#include <utility>

namespace fathom::driver {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using std::chrono::steady_clock;

// A complete save (closed after writing, renamed into place) is followed by no more than this of
// its own noise; an incomplete one (created, truncated, deleted) is waited for, but not for ever:
// some programs keep a file open.
constexpr milliseconds quiet_after_complete{2};
constexpr milliseconds quiet_after_incomplete{60};
constexpr milliseconds longest_burst{400};
constexpr milliseconds look_again{500}; // where the system tells nothing

// A file's folder and, where the name or a folder above is a symbolic link, every place on the way
// to what it means.
std::vector<fs::path> places(const fs::path &file) {
    std::error_code error;
    fs::path current = fs::absolute(file, error).lexically_normal();
    std::vector<fs::path> result{current};
    for (int links = 0; links < 16 && fs::is_symlink(current, error); ++links) {
        fs::path next = fs::read_symlink(current, error);
        if (error) break;
        current = (next.is_absolute() ? next : current.parent_path() / next).lexically_normal();
        result.push_back(current);
    }
    return result;
}

} // namespace

Watcher::Wake::Wake() {
    if (::pipe(ends.data()) != 0) return; // nothing wakes: waits end by their time
    for (const int end : ends) {
        ::fcntl(end, F_SETFL, O_NONBLOCK);
        ::fcntl(end, F_SETFD, FD_CLOEXEC);
    }
}

Watcher::Wake::~Wake() {
    for (const int end : ends)
        if (end >= 0) ::close(end);
}

std::string Watcher::polls_because() const {
    return events_.refusal().empty()
               ? ""
               : events_.refusal() + ": files are looked at twice a second instead";
}

void Watcher::watch(const std::map<fs::path, FileStamp> &files) {
    files_.clear();
    for (const auto &[file, state] : files) {
        std::error_code error;
        files_[fs::absolute(file, error).lexically_normal()] = state;
    }
    compare_first_ = true;
    if (told()) rewatch_folders();
}

void Watcher::rewatch_folders() {
    std::map<fs::path, std::vector<std::string>> names;
    for (const auto &[file, state] : files_) {
        for (const fs::path &place : places(file)) {
            // A folder that does not exist (yet, or for a moment) is watched for at its nearest
            // ancestor.
            fs::path name = place;
            std::error_code error;
            while (name.has_relative_path() && !fs::is_directory(name.parent_path(), error))
                name = name.parent_path();
            names[name.parent_path()].push_back(name.filename().string());
        }
    }
    events_.watch(std::move(names));
}

void Watcher::settle(bool complete) {
    steady_clock::time_point end = steady_clock::now() + longest_burst;
    for (;;) {
        milliseconds quiet = complete ? quiet_after_complete : quiet_after_incomplete;
        milliseconds left = std::chrono::duration_cast<milliseconds>(end - steady_clock::now());
        if (left.count() <= 0) return;
        pollfd ready{events_.descriptor(), POLLIN, 0};
        int count = ::poll(&ready, 1, static_cast<int>(std::min(quiet, left).count()));
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return;
        const FolderEvents::Batch batch = events_.read();
        if (batch.folders_changed) rewatch_folders();
        if (batch.relevant) complete = batch.complete;
    }
}

bool Watcher::compare() {
    bool changed = false;
    for (auto &[file, state] : files_) {
        FileStamp now = stamp_of(file);
        if (now == state) continue;
        state = now;
        changed = true;
    }
    return changed;
}

bool Watcher::wait(milliseconds timeout) {
    if (std::exchange(compare_first_, false) && compare()) return true;
    steady_clock::time_point end = steady_clock::now() + timeout;
    for (;;) {
        if (!told()) return wait_polling(end);
        milliseconds left = std::chrono::ceil<milliseconds>(end - steady_clock::now());
        std::array<pollfd, 2> ready{pollfd{events_.descriptor(), POLLIN, 0},
                                    pollfd{wake_.ends[0], POLLIN, 0}};
        int count = ::poll(ready.data(), ready.size(),
                           static_cast<int>(std::max<std::int64_t>(0, left.count())));
        if (count <= 0) return false; // also on an interrupt: the caller may have to end
        if (ready[1].revents) {
            std::array<char, 64> wakes;
            if (::read(wake_.ends[0], wakes.data(), wakes.size()) > 0) return false;
        }
        const FolderEvents::Batch batch = events_.read();
        if (batch.folders_changed) rewatch_folders();
        if (!batch.relevant) continue;
        settle(batch.complete);
        if (compare()) return true;
    }
}

// A file that changed is looked at again until it rests.
bool Watcher::wait_polling(steady_clock::time_point end) {
    bool changed = compare();
    for (;;) {
        const milliseconds left = std::chrono::ceil<milliseconds>(end - steady_clock::now());
        const milliseconds pause = changed ? quiet_after_incomplete : std::min(left, look_again);
        pollfd woken{wake_.ends[0], POLLIN, 0};
        if (::poll(&woken, 1, static_cast<int>(std::max<std::int64_t>(0, pause.count()))) != 0) {
            std::array<char, 64> wakes;
            if (woken.revents && ::read(wake_.ends[0], wakes.data(), wakes.size()) > 0)
                return changed;
            return changed; // an interrupt: the caller may have to end
        }
        const bool again = compare();
        if (changed && !again) return true;
        changed = changed || again;
        if (!changed && left <= pause) return false;
    }
}

void Watcher::wake() {
    if (::write(wake_.ends[1], "", 1) < 0) return; // full: a wake is pending already
}

} // namespace fathom::driver
