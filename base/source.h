// Source texts and places in them. A place is a pair of byte offsets; lines and columns exist only
// when something is printed. Opens no file: the driver reads, everything else is given text.
#pragma once

#include "base/ids.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace fathom {

struct Source;
using SourceId = Id<Source>;

// A place in a long line, so that a column is found without reading the line from its begin.
struct Milestone {
    std::uint32_t offset = 0; // where a code point begins
    std::uint32_t column = 0; // of it, from 1
};

// A text with its name and the offsets of its lines.
struct Source {
    std::string
        name; // as the user wrote it on the command line or in `import`; raw bytes (encode.h)
    std::string text;                       // UTF-8, as read
    std::vector<std::uint32_t> line_starts; // byte offsets; filled by Sources::add
    SourceId made_from; // the source that was imported as this text, which then is no file itself
    std::vector<Milestone> milestones; // every 256 bytes of a line that is longer; by offset
};

// Bytes [begin, end) of one source.
struct Span {
    SourceId source;
    std::uint32_t begin = 0;
    std::uint32_t end = 0;

    friend auto operator<=>(const Span &, const Span &) = default;
};

// The smallest span that holds both; both lie in one source.
Span join(Span a, Span b);

// Lines and columns count from 1; columns count Unicode code points.
struct Position {
    std::uint32_t line = 1;
    std::uint32_t column = 1;
};

// All texts of a compilation, by id.
class Sources {
  public:
    SourceId add(std::string name, std::string text, SourceId made_from = {});
    const Source &operator[](SourceId id) const { return sources_[id]; }
    std::size_t size() const { return sources_.size(); }

  private:
    Arena<Source> sources_;
};

// Line and column, from 1, of a byte offset. Takes the logarithm of the text's length, however long
// its lines are.
Position position(const Source &source, std::uint32_t offset);
std::string_view line_text(const Source &source, std::uint32_t line); // without its line end
// The text that a span covers.
std::string_view text(const Sources &sources, Span span);

} // namespace fathom
