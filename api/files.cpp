#include "driver/files.h"
#include "api/impl.h"

#include "driver/watch.h"

#include <algorithm>
#include <cerrno>
#include <thread>

namespace fathom::v1 {
namespace {

// What `read` reads, or nothing and why where there is no memory for it.
template <class Read> std::optional<std::string> or_why(Read read, std::string &why) noexcept {
    return guarded(read, [&](Diagnostic failed) {
        why = std::move(failed.message);
        return std::optional<std::string>();
    });
}

} // namespace

std::optional<std::string> read_file(const std::filesystem::path &file, std::size_t limit,
                                     std::string &why) {
    return or_why([&] { return driver::read_file(file, limit, why); }, why);
}

std::optional<std::string> read_standard_input(std::size_t limit, std::string &why) {
    return or_why([&] { return driver::read_standard_input(limit, why); }, why);
}

std::string write_file(const std::filesystem::path &file, std::string_view bytes) {
    return guarded([&] { return driver::write_file(file, bytes); },
                   [](Diagnostic failed) { return std::move(failed.message); });
}

std::string write_files(const std::vector<FileBytes> &files, std::size_t &failed) {
    failed = 0;
    return guarded(
        [&] {
            std::vector<driver::FileBytes> all;
            for (const FileBytes &one : files) all.push_back({one.file, one.bytes});
            return driver::write_files(all, failed);
        },
        [](Diagnostic failure) { return std::move(failure.message); });
}

int write_all(int descriptor, std::string_view bytes) {
    return driver::write_all(descriptor, bytes);
}

int make_temporary(const std::filesystem::path &target, std::string &name) {
    return guarded([&] { return driver::make_temporary(target, name); },
                   [](const Diagnostic &) {
                       errno = ENOMEM;
                       return -1;
                   });
}

std::string error_words(int error) { return driver::error_words(error); }

struct Watcher::Impl {
    driver::Watcher watcher;
    bool failed = false; // it could not be told what to watch
};

namespace {

// In place of what was to be watched: something may have changed.
bool changed_perhaps(std::chrono::milliseconds timeout) {
    std::this_thread::sleep_for(std::min(timeout, std::chrono::milliseconds(500)));
    return true;
}

} // namespace

Watcher::Watcher()
    : impl_(guarded([] { return std::make_unique<Impl>(); },
                    [](const Diagnostic &) { return std::unique_ptr<Impl>(); })) {}
Watcher::~Watcher() = default;

void Watcher::watch(const CompileResult &result) {
    if (!impl_) return;
    impl_->failed = guarded(
        [&] {
            static const driver::Stamps none;
            const auto &texts = result.texts.impl();
            impl_->watcher.watch(texts && texts->compilation ? texts->compilation->files : none);
            return false;
        },
        [](const Diagnostic &) { return true; });
}

bool Watcher::wait(std::chrono::milliseconds timeout) {
    if (!impl_ || impl_->failed) return changed_perhaps(timeout);
    return guarded([&] { return impl_->watcher.wait(timeout); },
                   [&](const Diagnostic &) { return changed_perhaps(timeout); });
}

void Watcher::wake() {
    if (impl_) impl_->watcher.wake();
}

std::string Watcher::polls_because() const {
    return guarded([&] { return impl_ ? impl_->watcher.polls_because() : std::string(); },
                   [](const Diagnostic &) { return std::string(); });
}

} // namespace fathom::v1
