// What the program says about the user's text, and its two printed forms: text for people, JSON for
// editors. One table of codes (codes.def). Knows nothing of the language or of any phase.
#pragma once

#include "base/source.h"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fathom {

// How much a diagnostic matters: only errors make a compilation fail.
enum class Severity { Error, Warning, Note };

// One enumerator per row of codes.def: `lipschitz-unbounded` is Code::LipschitzUnbounded.
enum class Code {
#define FATHOM_CODE(name, text, severity, summary) name,
#include "base/codes.def"
#undef FATHOM_CODE
};

std::string_view code_name(Code code);    // "unknown-name"
std::string_view code_summary(Code code); // one line, for `fathom explain` and the docs
Severity code_severity(Code code);        // the severity a code has unless said
// The code of that kebab-case name; none where there is no such code.
std::optional<Code> code_by_name(std::string_view name);
// All codes, in the order of codes.def.
std::vector<Code> all_codes();

// A further place in the text, with words about it.
struct Label {
    Span span;
    std::string message; // may be empty for the primary label
};

// One replacement of text; `span` may be empty (an insertion).
struct Edit {
    Span span;
    std::string replacement;
};

// A proposed edit of the text, with the words that propose it.
struct Fix {
    std::string message;     // printed after `help: `
    std::vector<Edit> edits; // empty where the fix is not mechanical
};

// One report: a code, a place, a message, and what helps to understand it.
struct Diagnostic {
    Code code{};
    Severity severity = Severity::Error;
    std::string message; // lower case, no full stop, code in backticks
    Label primary;       // the narrowest wrong thing; a span without a source is "no place"
    std::vector<Label> related;
    std::vector<std::string> notes;
    std::optional<Fix> fix;

    Diagnostic &label(Span span, std::string text) &;
    Diagnostic &note(std::string text) &;
    Diagnostic &help(std::string text, std::vector<Edit> edits = {}) &;
};

// Collects; drops exact repeats (same code, place and message); cuts every text to 2,000 bytes,
// keeps at most 200 of them and 1 MiB, and counts the rest, so that a hostile file cannot fill the
// memory.
class Diagnostics {
  public:
    // Adds one with the code's own severity and hands it back to be refined at once; the reference
    // is good until the next add.
    Diagnostic &add(Code code, Span primary, std::string message);
    void add(Diagnostic diagnostic);
    // Takes one back which a later phase knows better: what reads the text cannot tell shapes from
    // conditions.
    void withdraw(Code code, Span primary);
    // The one of that code and place, to be refined; null where there is none.
    Diagnostic *find(Code code, Span primary);
    bool has_errors() const { return errors_ > 0; }
    std::size_t errors() const { return errors_; }
    std::size_t warnings() const;
    std::size_t dropped() const { return dropped_; }
    const std::vector<Diagnostic> &items() const { return items_; }
    std::vector<Diagnostic> sorted() const; // by place

  private:
    Diagnostic *keep(Diagnostic diagnostic);

    std::vector<Diagnostic> items_;
    Diagnostic overflow_;
    std::size_t errors_ = 0;
    std::size_t dropped_ = 0;
};

// `FILE:LINE:COL: error[code]: message`, then the source line with the place underlined, the
// related labels, notes and the help. `color` adds ANSI colours.
std::string to_text(const Diagnostic &diagnostic, const Sources &sources, bool color);

// One JSON object, as `check --json` prints it, without a trailing line end: "code severity message
// file line column end_line end_column label labels notes fix". Ends are one past the last code
// point. Without a place, file and numbers are null.
nlohmann::ordered_json to_json(const Diagnostic &diagnostic, const Sources &sources);
// The source, line and columns of a span, as every place in JSON names them; all null without one.
nlohmann::ordered_json place_json(const Sources &sources, Span span);
// A document as text on one line: pure ASCII, so that no name in it can steer a terminal.
std::string json_text(const nlohmann::ordered_json &document);

} // namespace fathom
