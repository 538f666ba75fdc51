#include "viewer/editor_line.h"

#include "base/text.h"
#include "driver/files.h"
#include "system/system.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>
#include <utility>

namespace fathom::viewer {
namespace {

// The whole number at a text's beginning; nothing where none stands there.
template <class Number> std::optional<Number> number_at(std::string_view text) {
    Number number{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end == text.data()) return std::nullopt;
    return number;
}

} // namespace

std::unique_ptr<EditorLine> EditorLine::to(const std::filesystem::path &socket,
                                           std::function<void()> heard, std::string &error) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (socket.string().size() >= sizeof address.sun_path) {
        error = "the socket's name is too long";
        return nullptr;
    }
    std::strcpy(address.sun_path, socket.c_str());
    const int descriptor = system::open_socket();
    if (descriptor < 0 ||
        ::connect(descriptor, reinterpret_cast<sockaddr *>(&address), sizeof address) != 0) {
        error = driver::error_words(errno);
        if (descriptor >= 0) ::close(descriptor);
        return nullptr;
    }
    return std::unique_ptr<EditorLine>(new EditorLine(descriptor, std::move(heard)));
}

EditorLine::EditorLine(int descriptor, std::function<void()> heard)
    : descriptor_(descriptor), heard_(std::move(heard)), thread_([this] { run(); }) {}

EditorLine::~EditorLine() {
    ::shutdown(descriptor_, SHUT_RDWR); // which ends the thread's read
    thread_.join();
    ::close(descriptor_);
}

Typed EditorLine::take() {
    std::lock_guard lock(mutex_);
    return std::exchange(typed_, {});
}

bool EditorLine::open() const {
    std::lock_guard lock(mutex_);
    return open_;
}

void EditorLine::clicked(const std::string &file, unsigned line, unsigned column) {
    const std::string record = fmt::format("clicked {} {} {}\n", line, column, file);
    (void)::send(descriptor_, record.data(), record.size(), MSG_NOSIGNAL);
}

bool EditorLine::understood(std::string &bytes) {
    const std::size_t end = bytes.find('\n');
    if (end == bytes.npos) return false;
    const std::string line = bytes.substr(0, end);
    std::size_t taken = end + 1;
    std::lock_guard lock(mutex_);
    if (line.starts_with("text ")) {
        const auto length = number_at<std::size_t>(std::string_view(line).substr(5));
        if (length && bytes.size() - taken < *length) return false;
        if (length) typed_.text = bytes.substr(taken, *length);
        taken += length.value_or(0);
        typed_.params.clear(); // of the text before
    } else if (line.starts_with("cursor ")) {
        if (const auto at = number_at<std::uint32_t>(std::string_view(line).substr(7)))
            typed_.cursor = *at;
    } else if (line.starts_with("param ")) {
        const std::size_t blank = line.find(' ', 6);
        if (blank != line.npos)
            if (const auto value = parse_number(std::string_view(line).substr(blank + 1)))
                typed_.params.emplace_back(line.substr(6, blank - 6), *value);
    }
    bytes.erase(0, taken);
    return true;
}

void EditorLine::run() {
    std::string bytes;
    std::array<char, 1 << 16> block{};
    for (;;) {
        const ssize_t count = ::read(descriptor_, block.data(), block.size());
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) break;
        bytes.append(block.data(), static_cast<std::size_t>(count));
        while (understood(bytes)) {
        }
        heard_();
    }
    {
        std::lock_guard lock(mutex_);
        open_ = false;
    }
    heard_();
}

} // namespace fathom::viewer
