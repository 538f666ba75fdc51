#include "driver/watch.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <poll.h>
#include <set>
#include <sys/eventfd.h>
#include <sys/inotify.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace fathom::driver {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr std::uint32_t interesting = IN_CLOSE_WRITE | IN_MODIFY | IN_ATTRIB | IN_CREATE |
                                      IN_MOVED_TO | IN_MOVED_FROM | IN_DELETE | IN_DELETE_SELF |
                                      IN_MOVE_SELF | IN_ONLYDIR;

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

Watcher::Watcher() {
    wake_ = ::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
    inotify_ = ::inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
    if (inotify_ < 0) poll_from_now_on(errno, "fs.inotify.max_user_instances");
}

void Watcher::poll_from_now_on(int error, const char *what) {
    polls_because_ = "the system gives no more file watches (" +
                     (error == EMFILE || error == ENOSPC ? std::string(what) : error_words(error)) +
                     "): files are looked at twice a second instead";
}

Watcher::~Watcher() {
    if (inotify_ >= 0) ::close(inotify_);
    if (wake_ >= 0) ::close(wake_);
}

void Watcher::watch(const std::map<fs::path, FileStamp> &files) {
    files_.clear();
    for (const auto &[file, state] : files) {
        std::error_code error;
        files_[fs::absolute(file, error).lexically_normal()] = state;
    }
    compare_first_ = true;
    if (polls_because_.empty()) rewatch_folders();
}

void Watcher::rewatch_folders() {
    names_.clear();
    std::set<fs::path> wanted;
    for (const auto &[file, state] : files_) {
        for (const fs::path &place : places(file)) {
            // A folder that does not exist (yet, or for a moment) is watched for at its nearest
            // ancestor.
            fs::path name = place;
            std::error_code error;
            while (name.has_relative_path() && !fs::is_directory(name.parent_path(), error))
                name = name.parent_path();
            names_[name.parent_path()].push_back(name.filename().string());
            wanted.insert(name.parent_path());
        }
    }
    for (auto it = folders_.begin(); it != folders_.end();) {
        if (wanted.erase(it->second)) {
            ++it;
        } else {
            ::inotify_rm_watch(inotify_, it->first);
            it = folders_.erase(it);
        }
    }
    for (const fs::path &folder : wanted) watch_folder(folder);
}

void Watcher::watch_folder(const fs::path &folder) {
    int id = ::inotify_add_watch(inotify_, folder.c_str(), interesting);
    if (id >= 0)
        folders_[id] = folder;
    else if (errno != ENOENT && errno != ENOTDIR) // gone since: its ancestor tells
        poll_from_now_on(errno, "fs.inotify.max_user_watches");
}

Watcher::Batch Watcher::read_events() {
    Batch batch;
    alignas(inotify_event) std::array<char, 1 << 16> buffer;
    for (;;) {
        ssize_t count = ::read(inotify_, buffer.data(), buffer.size());
        if (count <= 0) break;
        for (ssize_t at = 0; at < count;) {
            const auto *event = reinterpret_cast<const inotify_event *>(buffer.data() + at);
            at += static_cast<ssize_t>(sizeof(inotify_event) + event->len);
            if (event->mask & IN_Q_OVERFLOW) { // events were lost: anything may have changed
                batch.relevant = batch.complete = batch.folders_changed = true;
                continue;
            }
            auto folder = folders_.find(event->wd);
            if (folder == folders_.end()) continue;
            if (event->mask & (IN_DELETE_SELF | IN_MOVE_SELF | IN_IGNORED)) {
                // A moved folder is still watched, under its new name: what stands at the old one
                // now is news.
                if (event->mask & IN_MOVE_SELF) ::inotify_rm_watch(inotify_, event->wd);
                folders_.erase(folder);
                batch.relevant = batch.folders_changed = true;
                batch.complete = false;
                continue;
            }
            if (!event->len) continue;
            auto names = names_.find(folder->second);
            if (names == names_.end()) continue;
            std::string_view name = event->name;
            if (std::find(names->second.begin(), names->second.end(), name) == names->second.end())
                continue;
            batch.relevant = true;
            batch.complete = (event->mask & (IN_CLOSE_WRITE | IN_MOVED_TO)) != 0;
            struct stat status {};
            // A folder on the way to a file, or a symbolic link, came or went: the places change.
            fs::path place = folder->second / name;
            if ((event->mask & IN_ISDIR) ||
                (::lstat(place.c_str(), &status) == 0 && S_ISLNK(status.st_mode)))
                batch.folders_changed = true;
        }
    }
    return batch;
}

void Watcher::settle(bool complete) {
    steady_clock::time_point end = steady_clock::now() + longest_burst;
    for (;;) {
        milliseconds quiet = complete ? quiet_after_complete : quiet_after_incomplete;
        milliseconds left = std::chrono::duration_cast<milliseconds>(end - steady_clock::now());
        if (left.count() <= 0) return;
        pollfd ready{inotify_, POLLIN, 0};
        int count = ::poll(&ready, 1, static_cast<int>(std::min(quiet, left).count()));
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return;
        Batch batch = read_events();
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
        if (!polls_because_.empty()) return wait_polling(end);
        milliseconds left = std::chrono::ceil<milliseconds>(end - steady_clock::now());
        std::array<pollfd, 2> ready{pollfd{inotify_, POLLIN, 0}, pollfd{wake_, POLLIN, 0}};
        int count = ::poll(ready.data(), ready.size(),
                           static_cast<int>(std::max<std::int64_t>(0, left.count())));
        if (count <= 0) return false; // also on an interrupt: the caller may have to end
        if (ready[1].revents) {
            std::uint64_t value = 0;
            if (::read(wake_, &value, sizeof value) > 0) return false;
        }
        Batch batch = read_events();
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
        pollfd woken{wake_, POLLIN, 0};
        if (::poll(&woken, 1, static_cast<int>(std::max<std::int64_t>(0, pause.count()))) != 0) {
            std::uint64_t value = 0;
            if (woken.revents && ::read(wake_, &value, sizeof value) > 0) return changed;
            return changed; // an interrupt: the caller may have to end
        }
        const bool again = compare();
        if (changed && !again) return true;
        changed = changed || again;
        if (!changed && left <= pause) return false;
    }
}

void Watcher::wake() {
    std::uint64_t one = 1;
    if (::write(wake_, &one, sizeof one) < 0) return; // full: a wake is pending already
}

} // namespace fathom::driver
