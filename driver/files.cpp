#include "driver/files.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <list>
#include <mutex>
#include <set>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace fathom::driver {
namespace {

class Descriptor {
  public:
    explicit Descriptor(int fd) : fd_(fd) {}
    Descriptor(const Descriptor &) = delete;
    Descriptor &operator=(const Descriptor &) = delete;
    ~Descriptor() {
        if (fd_ >= 0) ::close(fd_);
    }
    int get() const { return fd_; }
    bool open(int fd) { return (fd_ = fd) >= 0; } // of one that is closed
    // Closing is where some file systems report that the disk is full.
    int close() {
        int result = ::close(fd_);
        fd_ = -1;
        return result == 0 ? 0 : errno;
    }

  private:
    int fd_;
};

// While it lives, an interrupt waits: a temporary file is never left behind by Ctrl-C.
class HoldInterrupts {
  public:
    HoldInterrupts() {
        sigset_t set;
        sigemptyset(&set);
        for (int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) sigaddset(&set, signal);
        pthread_sigmask(SIG_BLOCK, &set, &old_);
    }
    HoldInterrupts(const HoldInterrupts &) = delete;
    HoldInterrupts &operator=(const HoldInterrupts &) = delete;
    ~HoldInterrupts() { pthread_sigmask(SIG_SETMASK, &old_, nullptr); }

  private:
    sigset_t old_;
};

std::optional<std::string> read_descriptor(int fd, std::size_t expected, std::size_t limit,
                                           std::string &error) {
    std::string bytes;
    bytes.resize(std::min(expected, limit) + 1);
    std::size_t used = 0;
    for (;;) {
        if (used == bytes.size()) bytes.resize(std::max<std::size_t>(2 * used, 1 << 16));
        ssize_t count = ::read(fd, bytes.data() + used, bytes.size() - used);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) {
            error = error_words(errno);
            return std::nullopt;
        }
        if (count == 0) break;
        used += static_cast<std::size_t>(count);
        if (used > limit) {
            error = fmt::format("larger than {} MiB", limit >> 20);
            return std::nullopt;
        }
    }
    bytes.resize(used);
    return bytes;
}

} // namespace

std::string error_words(int error) {
    const char *words = strerrordesc_np(error);
    std::string text = words ? words : "unknown error";
    if (text.size() > 1 && text[0] >= 'A' && text[0] <= 'Z' && text[1] >= 'a')
        text[0] = static_cast<char>(text[0] - 'A' + 'a');
    return text;
}

FileStamp stamp_of(const std::filesystem::path &file) {
    struct stat status {};
    if (::stat(file.c_str(), &status) != 0) return {};
    return {true,
            static_cast<std::uint64_t>(status.st_dev),
            static_cast<std::uint64_t>(status.st_ino),
            static_cast<std::uint64_t>(status.st_size),
            status.st_mtim.tv_sec,
            status.st_mtim.tv_nsec};
}

std::filesystem::path last_saved(const Stamps &before, const Stamps &after) {
    std::filesystem::path newest;
    std::pair<std::int64_t, std::int64_t> when;
    if (before.empty()) return newest;
    for (const auto &[file, stamp] : after) {
        const auto old = before.find(file);
        if (!stamp.exists || (old != before.end() && old->second == stamp)) continue;
        const std::pair written{stamp.seconds, stamp.nanoseconds};
        if (newest.empty() || written > when) newest = file, when = written;
    }
    return newest;
}

std::optional<std::string> read_file(const std::filesystem::path &path, std::size_t limit,
                                     std::string &error) {
    // Without O_NONBLOCK the open of a pipe that no one writes to would wait for ever.
    Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    if (file.get() < 0) {
        error = errno == ENOENT ? "no such file" : error_words(errno);
        return std::nullopt;
    }
    struct stat status {};
    if (::fstat(file.get(), &status) != 0) {
        error = error_words(errno);
        return std::nullopt;
    }
    if (!S_ISREG(status.st_mode)) {
        error = S_ISDIR(status.st_mode) ? "is a directory" : "is not a regular file";
        return std::nullopt;
    }
    return read_descriptor(file.get(), static_cast<std::size_t>(status.st_size), limit, error);
}

std::optional<std::string> read_standard_input(std::size_t limit, std::string &error) {
    return read_descriptor(STDIN_FILENO, 1 << 16, limit, error);
}

int write_all(int descriptor, std::string_view bytes) {
    while (!bytes.empty()) {
        ssize_t count = ::write(descriptor, bytes.data(), bytes.size());
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return errno;
        bytes.remove_prefix(static_cast<std::size_t>(count));
    }
    return 0;
}

namespace {

constexpr std::string_view temporary_mark = ".fathom-tmp";
constexpr std::size_t temporary_tail = 6; // what mkostemp makes of the name's end

// A symbolic link stays one: what it leads to is written, also where nothing stands there yet.
// Empty for a ring of links.
std::filesystem::path followed(std::filesystem::path path) {
    std::error_code error;
    for (int links = 0; links < 40; ++links) {
        if (!std::filesystem::is_symlink(path, error)) return path;
        const std::filesystem::path next = std::filesystem::read_symlink(path, error);
        if (error) return path;
        path = next.is_absolute() ? next : path.parent_path() / next;
    }
    return {};
}

// Removes what writes left behind that were killed. A file that is being written is locked. Once a
// folder and process: only another process can have been killed.
void sweep(const std::filesystem::path &folder) {
    static std::mutex mutex;
    static std::set<std::filesystem::path> swept;
    std::lock_guard lock(mutex);
    std::error_code error;
    if (!swept.insert(std::filesystem::absolute(folder, error)).second) return;
    std::filesystem::directory_iterator entries(folder, error), end;
    for (; !error && entries != end; entries.increment(error)) {
        const std::string name = entries->path().filename().string();
        const std::size_t tail = temporary_mark.size() + temporary_tail;
        if (name.size() <= tail + 1 || name[0] != '.' ||
            name.compare(name.size() - tail, temporary_mark.size(), temporary_mark) != 0)
            continue;
        Descriptor file(
            ::open(entries->path().c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
        struct stat status {};
        if (file.get() < 0 || ::fstat(file.get(), &status) != 0 || !S_ISREG(status.st_mode))
            continue;
        if (::flock(file.get(), LOCK_EX | LOCK_NB) == 0) ::unlink(entries->path().c_str());
    }
}

} // namespace

int make_temporary(const std::filesystem::path &target, std::string &name) {
    const std::filesystem::path folder = target.parent_path();
    const std::string pattern =
        (folder / ("." + target.filename().string() + std::string(temporary_mark) +
                   std::string(temporary_tail, 'X')))
            .string();
    for (;;) {
        name = pattern;
        const int file = ::mkostemp(name.data(), O_CLOEXEC);
        if (file < 0) return -1;
        // Who sweeps the folder holds the lock until the file is gone: it is waited for.
        while (::flock(file, LOCK_EX) != 0 && errno == EINTR) {
        }
        struct stat status {};
        if (::fstat(file, &status) == 0 && status.st_nlink > 0) return file;
        ::close(file);
    }
}

namespace {

// The whole of a file beside its target, locked until it is renamed. Removed where it was not.
struct Prepared {
    explicit Prepared(std::filesystem::path to) : target(std::move(to)) {}
    std::filesystem::path target;
    std::string temporary{};
    Descriptor lock{-1};
    ~Prepared() {
        if (!temporary.empty()) ::unlink(temporary.c_str());
    }
};

// Whether a target is written in place; then it was, or there is the reason.
bool written_in_place(const std::filesystem::path &target, std::string_view bytes,
                      std::string &why) {
    struct stat old {};
    if (::stat(target.c_str(), &old) != 0 || S_ISREG(old.st_mode)) return false;
    if (S_ISDIR(old.st_mode)) {
        why = "is a directory";
        return true;
    }
    Descriptor file(::open(target.c_str(), O_WRONLY | O_CLOEXEC));
    if (const int error = file.get() < 0 ? errno : write_all(file.get(), bytes))
        why = error_words(error);
    return true;
}

// Why it failed, or nothing.
std::string prepare(std::string_view bytes, Prepared &prepared) {
    const std::filesystem::path &target = prepared.target;
    struct stat old {};
    const bool exists = ::stat(target.c_str(), &old) == 0;
    if (exists && ::access(target.c_str(), W_OK) != 0) return error_words(errno);
    const std::filesystem::path folder = target.parent_path().empty() ? "." : target.parent_path();
    sweep(folder);
    std::string temporary;
    Descriptor file(make_temporary(folder / target.filename(), temporary));
    if (file.get() < 0) return error_words(errno);
    prepared.temporary = temporary;
    if (!prepared.lock.open(::fcntl(file.get(), F_DUPFD_CLOEXEC, 0))) return error_words(errno);
    const mode_t mask = ::umask(0);
    ::umask(mask);
    const mode_t mode = exists ? (old.st_mode & 07777) : (0666 & ~mask);
    int error = write_all(file.get(), bytes);
    if (!error && ::fchmod(file.get(), mode) != 0) error = errno;
    if (!error && ::fsync(file.get()) != 0) error = errno;
    const int close_error = file.close();
    if (!error) error = close_error;
    return error ? error_words(error) : "";
}

} // namespace

std::string write_file(const std::filesystem::path &named, std::string_view bytes) {
    std::size_t failed = 0;
    return write_files({{named, bytes}}, failed);
}

std::string write_files(const std::vector<FileBytes> &files, std::size_t &failed) {
    const HoldInterrupts hold;
    std::list<Prepared> all; // none is moved
    std::string why;
    for (failed = 0; failed < files.size(); ++failed) {
        const auto &[named, bytes] = files[failed];
        const std::filesystem::path target = followed(named);
        if (target.empty()) return error_words(ELOOP);
        const bool in_place = written_in_place(target, bytes, why);
        if (!in_place) why = prepare(bytes, all.emplace_back(target));
        if (!why.empty()) return why;
    }
    failed = 0;
    for (Prepared &prepared : all) {
        if (::rename(prepared.temporary.c_str(), prepared.target.c_str()) != 0)
            return error_words(errno);
        prepared.temporary.clear();
        ++failed;
    }
    return "";
}

} // namespace fathom::driver
