#include "driver/folder_events.h"

#include "driver/files.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <set>
#include <sys/stat.h>
#include <unistd.h>

#if defined(__linux__) && !defined(FATHOM_NO_INOTIFY)
#include <sys/inotify.h>

namespace fathom::driver {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t interesting = IN_CLOSE_WRITE | IN_MODIFY | IN_ATTRIB | IN_CREATE |
                                      IN_MOVED_TO | IN_MOVED_FROM | IN_DELETE | IN_DELETE_SELF |
                                      IN_MOVE_SELF | IN_ONLYDIR;

} // namespace

FolderEvents::FolderEvents() {
    inotify_ = ::inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
    if (inotify_ < 0) refuse(errno, "fs.inotify.max_user_instances");
}

FolderEvents::~FolderEvents() {
    if (inotify_ >= 0) ::close(inotify_);
}

void FolderEvents::refuse(int error, const char *what) {
    refusal_ = "the system gives no more file watches (" +
               (error == EMFILE || error == ENOSPC ? std::string(what) : error_words(error)) + ")";
}

void FolderEvents::watch(std::map<fs::path, std::vector<std::string>> names) {
    names_ = std::move(names);
    std::set<fs::path> wanted;
    for (const auto &[folder, in_it] : names_) wanted.insert(folder);
    for (auto it = folders_.begin(); it != folders_.end();) {
        if (wanted.erase(it->second)) {
            ++it;
        } else {
            ::inotify_rm_watch(inotify_, it->first);
            it = folders_.erase(it);
        }
    }
    for (const fs::path &folder : wanted) {
        const int id = ::inotify_add_watch(inotify_, folder.c_str(), interesting);
        if (id >= 0)
            folders_[id] = folder;
        else if (errno != ENOENT && errno != ENOTDIR) // gone since: its ancestor tells
            refuse(errno, "fs.inotify.max_user_watches");
    }
}

FolderEvents::Batch FolderEvents::read() {
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

} // namespace fathom::driver

#else

namespace fathom::driver {

FolderEvents::FolderEvents() : refusal_("this system's file watches are not known") {}
FolderEvents::~FolderEvents() = default;
void FolderEvents::watch(std::map<std::filesystem::path, std::vector<std::string>>) {}
FolderEvents::Batch FolderEvents::read() { return {}; }

} // namespace fathom::driver

#endif
