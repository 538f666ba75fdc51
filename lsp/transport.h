// Messages of the language server protocol over two file descriptors: a header with the length, then
// JSON. Knows nothing of what messages mean.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace fathom::lsp {

class Transport {
  public:
    // `max_body`: of a message, in bytes.
    Transport(int in, int out, std::size_t max_body = std::size_t{64} << 20)
        : in_(in), out_(out), max_body_(max_body) {}

    // The next message's body; nothing at the end of the input. What is no header is skipped up to
    // one that is; a body above `max_body` is skipped too.
    std::optional<std::string> read();

    // Whether a message, or the end, is there to be read without waiting.
    bool pending() const;

    // False where nobody reads any more.
    bool write(const std::string &body);

  private:
    bool fill(); // more bytes into `bytes_`; false at the end

    int in_, out_;
    std::size_t max_body_;
    std::string bytes_; // read, not yet handed out
};

} // namespace fathom::lsp
