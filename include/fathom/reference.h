/** @file
 *  What the language consists of, for programs that colour texts, complete names and show pages:
 *  its words, the library's constants, and the codes of diagnostics with their pages. The library's
 *  functions are `library_entries()` (fathom/scene.h).
 *
 *  @code
 *  #include <fathom/reference.h>
 *  #include <cstdio>
 *
 *  int main() {
 *      for (const std::string &word : fathom::vocabulary().keywords)
 *          std::printf("%s ", word.c_str());
 *      for (const fathom::DiagnosticCode &code : fathom::diagnostic_codes())
 *          if (code.name == "unknown-name") {
 *              std::printf("\n%s\n%s", code.summary.c_str(), code.page.c_str());
 *              return code.page.empty() ? 1 : 0;
 *          }
 *      return 1;
 *  }
 *  @endcode
 */
#pragma once

#include <fathom/scene.h>

#include <cstdint>

namespace fathom::FATHOM_V1 {

/** The fixed words of the language. */
struct Vocabulary {
    std::vector<std::string> keywords;          /**< "and": never a name */
    std::vector<std::string> keywords_in_place; /**< "as", "limit": names elsewhere */
    std::vector<std::string> types;             /**< "float" */
    std::vector<std::string> units;             /**< "deg": behind a number */
    std::vector<std::string> signs;             /**< "=>"; none stands before one that begins it */
};
FATHOM_API Vocabulary vocabulary();

/** A constant that every scene sees. */
struct LibraryConstant {
    std::string name, type;           /**< type: "float", "vec3", "color" */
    std::optional<std::uint32_t> rgb; /**< of a named colour: 0xrrggbb, sRGB */
};
FATHOM_API std::vector<LibraryConstant> library_constants(); /**< by name */

/** A file of the standard library, as the compiler reads it. */
struct LibraryText {
    std::string file, text; /**< file: "shapes.sdf", as LibraryEntry::file */
};
FATHOM_API std::vector<LibraryText> library_texts();

/** A code of diagnostics, and its page of docs/diagnostics in Markdown. */
struct DiagnosticCode {
    std::string name, summary, page;     /**< name: "unknown-name"; summary: one line */
    Severity severity = Severity::Error; /**< unless the diagnostic itself says another */
};
FATHOM_API std::vector<DiagnosticCode> diagnostic_codes();

} // namespace fathom::FATHOM_V1
