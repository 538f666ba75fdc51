// The line to an editor's language server: texts, places of the cursor and values of params come in,
// places that were clicked go out. Knows the socket and its words, nothing of windows.
//
// Both sides speak in records, a line each: `text N` and then N bytes, the scene's text as it is
// being typed; `cursor N`, a byte of that text; `param NAME VALUE`, of a param whose number alone
// was changed, in the units of scene time (radians). The window answers `clicked LINE COLUMN FILE`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace fathom::viewer {

// What came since it was asked last, the newest of each kind.
struct Typed {
    std::optional<std::string> text;
    std::optional<std::uint32_t> cursor; // a byte of the text
    std::vector<std::pair<std::string, double>> params;
};

class EditorLine {
  public:
    // Connects to a socket; `heard` is called on the line's thread whenever something came. None,
    // and the reason in `error`, where nobody listens.
    static std::unique_ptr<EditorLine> to(const std::filesystem::path &socket,
                                          std::function<void()> heard, std::string &error);
    ~EditorLine();
    EditorLine(const EditorLine &) = delete;
    EditorLine &operator=(const EditorLine &) = delete;

    Typed take();
    bool open() const; // false once the editor has gone
    void clicked(const std::string &file, unsigned line, unsigned column);

  private:
    EditorLine(int descriptor, std::function<void()> heard);
    void run();
    bool understood(std::string &bytes); // takes one record off; false where it is not whole

    int descriptor_;
    std::function<void()> heard_;
    mutable std::mutex mutex_; // over the two below
    Typed typed_;
    bool open_ = true;
    std::thread thread_;
};

} // namespace fathom::viewer
