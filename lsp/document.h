// An open text, and places in it: the protocol counts lines and UTF-16 units from 0, the library
// bytes. Knows nothing of messages.
#pragma once

#include <fathom/scene.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace fathom::lsp {

// A place as the protocol has it.
struct Position {
    int line = 0, character = 0;
};
struct Range {
    Position start, end;
};

// The byte of a position; positions beyond a line's end are its end, beyond the text's its end.
std::size_t offset_at(std::string_view text, Position position);

// A byte in a long line, and the UTF-16 units that stand before it in the line.
struct Milestone {
    std::size_t offset = 0;
    int character = 0;
};

// Where the lines of a text begin. The text has to outlive it.
struct Lines {
    std::string_view text;
    std::vector<std::size_t> begins{0};
    std::vector<Milestone> milestones{}; // every 256 bytes of a line that is longer; by offset
};
Lines lines_of(std::string_view text);
// The position of a byte, which may be the text's end. Takes the logarithm of the text's length,
// however long its lines are.
Position position_at(const Lines &lines, std::size_t offset);
Range range_of(const Lines &lines, std::size_t begin, std::size_t end);
// A stretch of a text that is not at hand: exact where its lines hold no character beyond U+FFFF.
Range range_of(const fathom::v1::Place &place);

// A path as a `file:` address, and back; empty where the address is no file's.
std::string uri_of(const std::string &path);
std::string path_of(std::string_view uri);

} // namespace fathom::lsp
