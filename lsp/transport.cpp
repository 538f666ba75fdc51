#include "lsp/transport.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <poll.h>
#include <unistd.h>

namespace fathom::lsp {
namespace {

constexpr std::size_t max_header = 4096;

// The number after `Content-Length:` in a header; nothing where there is none.
std::optional<std::size_t> length_in(std::string_view header) {
    constexpr std::string_view key = "Content-Length:";
    const std::size_t at = header.find(key);
    if (at == header.npos) return std::nullopt;
    std::string_view rest = header.substr(at + key.size());
    rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
    std::size_t length = 0;
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), length);
    if (error != std::errc() || end == rest.data()) return std::nullopt;
    return length;
}

} // namespace

bool Transport::fill() {
    std::array<char, 1 << 16> block;
    for (;;) {
        const ssize_t count = ::read(in_, block.data(), block.size());
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return false;
        bytes_.append(block.data(), static_cast<std::size_t>(count));
        return true;
    }
}

std::optional<std::string> Transport::read() {
    for (;;) {
        const std::size_t end = bytes_.find("\r\n\r\n");
        if (end == bytes_.npos) {
            if (bytes_.size() > max_header) bytes_.erase(0, bytes_.size() - max_header);
            if (!fill()) return std::nullopt;
            continue;
        }
        const std::optional<std::size_t> length =
            length_in(std::string_view(bytes_).substr(0, end));
        bytes_.erase(0, end + 4);
        if (!length) continue;
        if (*length > max_body_) {
            std::size_t left = *length;
            while (left > 0) {
                if (bytes_.empty() && !fill()) return std::nullopt;
                const std::size_t skipped = std::min(left, bytes_.size());
                bytes_.erase(0, skipped);
                left -= skipped;
            }
            continue;
        }
        while (bytes_.size() < *length)
            if (!fill()) return std::nullopt;
        std::string body = bytes_.substr(0, *length);
        bytes_.erase(0, *length);
        return body;
    }
}

bool Transport::pending() const {
    if (!bytes_.empty()) return true;
    pollfd input{in_, POLLIN, 0};
    return ::poll(&input, 1, 0) > 0;
}

bool Transport::write(const std::string &body) {
    std::string message = "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
    for (std::size_t done = 0; done < message.size();) {
        const ssize_t count = ::write(out_, message.data() + done, message.size() - done);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return false;
        done += static_cast<std::size_t>(count);
    }
    return true;
}

} // namespace fathom::lsp
