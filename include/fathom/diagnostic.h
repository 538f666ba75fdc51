/** @file
 *  What the compiler says of a text, as data: an error, a warning or a note, with its place and the
 *  edits that would mend it. Printed forms are the business of who shows them.
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
#include <string>
#include <vector>

namespace fathom::FATHOM_V1 {

enum class Severity { Error, Warning, Note };

/** A stretch of a text. Lines and columns count from 1, columns count Unicode code points; the end
 *  is one past the last code point. Offsets are bytes. `line` is 0 where there is no place. */
struct Place {
    std::string file;
    int line = 0, column = 0, end_line = 0, end_column = 0;
    std::size_t begin = 0, end = 0;
};

/** A second place that a diagnostic points at, and what is there. */
struct Label {
    Place at;
    std::string message;
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

} // namespace fathom::FATHOM_V1
