// Messages of the language server protocol over two file descriptors: a header with the length, then
// JSON. Knows nothing of what messages mean.
#pragma once

#include <optional>
#include <string>

namespace fathom::lsp {

class Transport {
  public:
    Transport(int in, int out) : in_(in), out_(out) {}

    // The next message's body; nothing at the end of the input. What is no header is skipped up to
    // one that is; a body above 64 MiB is skipped too.
    std::optional<std::string> read();

    // Whether a message, or the end, is there to be read without waiting.
    bool pending() const;

    // False where nobody reads any more.
    bool write(const std::string &body);

  private:
    bool fill(); // more bytes into `bytes_`; false at the end

    int in_, out_;
    std::string bytes_; // read, not yet handed out
};

} // namespace fathom::lsp
