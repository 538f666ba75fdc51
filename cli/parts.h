// Parts of a picture as files, and how they are joined. A tile is a PNG with a note; a range of
// samples is a file of sums, `.sums`: a line that names the format, a line of JSON (the note, the
// rays that stayed undecided, a checksum), then three doubles a pixel, the lowest byte first.
#pragma once

#include "cli/identity.h"

#include <cstdint>
#include <span>
#include <string>
#include <variant>

namespace fathom::cli {

// Sums of samples of linear colours (cpu::summand): three numbers a pixel of the note's region.
struct Sums {
    Note note;
    std::uint64_t undecided = 0, undecided_shadows = 0;
    std::vector<double> values;
};
bool is_sums(std::string_view bytes);
std::string write_sums(const Sums &sums);
std::optional<Sums> read_sums(std::string_view bytes); // nothing where it is not whole

// A part of a picture: its pixels and which of their samples.
struct Block {
    int x = 0, y = 0, width = 0, height = 0, first_sample = 0, samples = 0;
    friend bool operator==(const Block &, const Block &) = default;
};
Block block_of(const Note &note);
std::string words_of(const Block &block); // "rows 0..20", "x 3..8, y 0..20, samples 4..8"
bool overlap(const Block &a, const Block &b);
// What of the whole none of the parts holds, as blocks that share nothing.
std::vector<Block> missing(const Block &whole, std::span<const Block> parts);

} // namespace fathom::cli
