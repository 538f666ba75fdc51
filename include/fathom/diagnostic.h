/** @file
 *  What the compiler says of a text, as data: an error, a warning or a note, with its place and the
 *  edits that would mend it; and, for programs that show it in a terminal, as text (`printed`).
 *
 *  @code
 *  #include <fathom/scene.h>
 *  #include <cstdio>
 *
 *  int main() {
 *      const auto result = fathom::compile_text("ball.sdf", "shpere(1)\n");
 *      for (const fathom::Diagnostic &d : result.diagnostics) {
 *          std::printf("%s:%d:%d: %s\n", d.at.file.c_str(), d.at.line, d.at.column,
 *                      d.message.c_str());
 *          for (const fathom::Edit &edit : d.edits)
 *              std::printf("  write `%s`\n", edit.replacement.c_str());
 *      }
 *      return result ? 1 : 0;
 *  }
 *  @endcode
 */
#pragma once

#include <fathom/export.h>

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace fathom::FATHOM_V1 {

enum class Severity { Error, Warning, Note };

/** A stretch of a text. Lines and columns count from 1, columns count Unicode code points; the end
 *  is one past the last code point. Offsets are bytes. `line` is 0 where there is no place. */
struct Place {
    std::string file;
    int line = 0, column = 0, end_line = 0, end_column = 0;
    std::size_t begin = 0, end = 0;
    int text = -1; /**< the number of the text in `Texts`; -1 where there is no place */
};

/** A second place that a diagnostic points at, and what is there. */
struct Label {
    Place at;
    std::string message;
    bool primary = false; /**< the words are about the diagnostic's own place */
};

/** A replacement of a stretch of text; an insertion where the stretch is empty. */
struct Edit {
    Place at;
    std::string replacement;
};

/** One thing that is to be said. `code` is a name such as `unknown-name`, explained by
 *  `fathom explain CODE`; it does not change from version to version. */
struct Diagnostic {
    Severity severity = Severity::Error;
    std::string code;
    std::string message; /**< lower case, no full stop, code in backticks */
    Place at;
    std::vector<Label> related;
    std::vector<std::string> notes;
    std::string help;        /**< what to do; may be empty */
    std::vector<Edit> edits; /**< to be applied together; empty where no edit is known to help */
};

/** The texts that places lie in, numbered from 0: the scene's own, what it imports, and what was
 *  made of them (the text that a save file became). A handle: copies share what they hold; any
 *  number of threads may use one. Default-made it has none. */
class FATHOM_API Texts {
  public:
    Texts() = default;
    std::size_t count() const;
    /** Empty where there is no such text. They live as long as a copy of the handle. */
    std::string_view name(std::size_t number) const;
    std::string_view text(std::size_t number) const;

    struct Impl;
    explicit Texts(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}
    const std::shared_ptr<const Impl> &impl() const { return impl_; } // of the library's own use

  private:
    std::shared_ptr<const Impl> impl_;
};

/** The diagnostic as text for people, as `fathom check` prints it, with a line end: its line, the
 *  lines of the text with the places underlined, notes, and the lines as the edits would make them.
 *  `texts`: those that came with it. No byte of them steers a terminal; `color` adds ANSI colours.
 *  Empty without memory for it. */
FATHOM_API std::string printed(const Diagnostic &diagnostic, const Texts &texts,
                               bool color = false);

} // namespace fathom::FATHOM_V1
