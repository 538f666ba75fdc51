// The options of `render`, as rows: `farm` takes those that decide the pixels too. Knows no library
// for command lines.
#pragma once

#include "cli/command.h"

#include <functional>
#include <string>
#include <vector>

namespace fathom::cli {

// An option with a word, whose reader says what is wrong with it (words.h), or a flag.
struct OptionRow {
    std::string name, type, help;
    std::function<std::string(const std::string &)> read; // of an option
    bool *flag = nullptr;                                 // of a flag
};

std::vector<OptionRow> picture_rows(RenderCommand &command); // what is drawn, and how
std::vector<OptionRow> film_rows(RenderCommand &command);    // which frames, and what moves
std::vector<OptionRow> part_rows(RenderCommand &command);    // which part of them is made
OptionRow frame_rate_row(double &frame_rate);
OptionRow quality_row(int &quality);

// The words of the rows of pictures and films, which read back as the command has them.
std::vector<std::string> words_of_pictures(const RenderCommand &command);

// Of what looks at a solid (solid_rows.cpp): which, how finely, and when.
std::vector<OptionRow> solid_rows(SolidArguments &solid);
std::vector<OptionRow> solid_film_rows(SolidArguments &solid); // of mesh, slice and volume
OptionRow units_row(SolidArguments &solid, const std::string &what_for);
std::vector<OptionRow> measure_rows(MeasureCommand &command);
OptionRow simplify_row(Length &tolerance);
std::vector<OptionRow> slice_rows(SliceCommand &command);
std::vector<OptionRow> volume_rows(VolumeCommand &command);

} // namespace fathom::cli
