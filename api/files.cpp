#include "driver/files.h"
#include "api/impl.h"

#include "driver/watch.h"

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

int write_all(int descriptor, std::string_view bytes) {
    return driver::write_all(descriptor, bytes);
}

std::string error_words(int error) { return driver::error_words(error); }

struct Watcher::Impl {
    driver::Watcher watcher;
};

Watcher::Watcher() : impl_(std::make_unique<Impl>()) {}
Watcher::~Watcher() = default;

void Watcher::watch(const CompileResult &result) {
    static const driver::Stamps none;
    const auto &texts = result.texts.impl();
    impl_->watcher.watch(texts && texts->compilation ? texts->compilation->files : none);
}

bool Watcher::wait(std::chrono::milliseconds timeout) { return impl_->watcher.wait(timeout); }
void Watcher::wake() { impl_->watcher.wake(); }
std::string Watcher::polls_because() const { return impl_->watcher.polls_because(); }

} // namespace fathom::v1
