// The options of the commands that look at a solid: mesh, measure, slice, volume.
#include "base/single.h"
#include "base/text.h"
#include "cli/option_rows.h"
#include "cli/solid.h"
#include "cli/words.h"

#include <cmath>
#include <fmt/format.h>

namespace fathom::cli {

std::vector<OptionRow> solid_rows(SolidArguments &solid) {
    return {
        {"--tolerance", "T",
         "the side of the cells that the surface is looked for in: 0.01 of the scene's units, or "
         "0.01mm",
         [&](const std::string &word) { return read_length(word, solid.tolerance); }},
        {"--resolution", "N",
         fmt::format("instead: cells along the longest side of the solid's box, {} unless said",
                     solid.resolution),
         [&](const std::string &word) {
             const std::optional<double> number = parse_number(word);
             if (!number || !(*number >= 1 && *number <= 8000) || *number != std::floor(*number))
                 return fmt::format("wants a whole number from 1 to 8000, not `{}`", word);
             solid.resolution = static_cast<int>(*number);
             return std::string();
         }},
        {"--bounds", "X,Y,Z,X,Y,Z",
         "cut the solid off at a box: its least corner, then its greatest",
         [&](const std::string &word) { return read_box(word, solid.bounds.emplace()); }},
        {"--part", "NAME", "that part of the scene alone; `fathom measure --parts` lists them",
         [&](const std::string &word) {
             solid.part = word;
             return std::string(word.empty() ? "wants a name" : "");
         }},
        {"--time", "T", "seconds; with --frames, when frame 0 is", [&](const std::string &word) {
             const std::optional<double> number = parse_number(word);
             if (!number || !fits_single(*number))
                 return fmt::format("wants seconds, as 2.5, not `{}`", word);
             solid.time = *number;
             return std::string();
         }}};
}

std::vector<OptionRow> solid_film_rows(SolidArguments &solid) {
    return {{"--frames", "FRAMES",
             "a file for each of these frames: A..B leaves B out, A..=B takes it in, :N is a step; "
             "lists by commas",
             [&](const std::string &word) { return read_frames(word, solid.frames); }},
            frame_rate_row(solid.frame_rate),
            {"--sweep", "NAME=A..B",
             "move a param over the frames: A at the first, B after the last; A..=B: at the last",
             [&](const std::string &word) { return read_sweep(word, solid.sweeps); }}};
}

OptionRow units_row(SolidArguments &solid, const std::string &what_for) {
    return {"--units", "UNIT", "what a length of 1 is, " + what_for, [&](const std::string &word) {
                if (!unit_named(word))
                    return fmt::format("wants {}, not `{}`", listed(unit_names()), word);
                solid.units = word;
                return std::string();
            }};
}

OptionRow simplify_row(Length &tolerance) {
    return {"--simplify", "TOL",
            "fewer triangles, no farther than this length from those of the cells",
            [&](const std::string &word) { return read_length(word, tolerance); }};
}

std::vector<OptionRow> slice_rows(SliceCommand &command) {
    std::vector<OptionRow> rows;
    for (const char axis : {'x', 'y', 'z'})
        rows.push_back({fmt::format("--{}", axis), "HEIGHTS",
                        fmt::format("across {}: A..B:STEP leaves B out, A..=B:STEP takes it in; "
                                    "one number; lists by commas",
                                    axis),
                        [&command, axis](const std::string &word) {
                            command.axis = axis;
                            return read_heights(word, command.heights);
                        }});
    return rows;
}

std::vector<OptionRow> volume_rows(VolumeCommand &command) {
    std::vector<OptionRow> rows{
        {"--voxel", "S", "the side of a voxel, a length as of `mesh --tolerance`",
         [&](const std::string &word) { return read_length(word, command.voxel); }},
        {"--band", "N", "of a .vdb: voxels to each side of the surface, 3 unless said",
         [&](const std::string &word) {
             const std::optional<double> number = parse_number(word);
             if (!number || !(*number >= 1 && *number <= 1000))
                 return fmt::format("wants a number from 1 to 1000, not `{}`", word);
             command.band = *number;
             return std::string();
         }},
        {"--field", "FUNCTION",
         "instead of distances what a function of the point gives: its name in the scene, or "
         "`p => …`; of a .vdb several",
         [&](const std::string &word) {
             command.solid.fields.push_back(word);
             return std::string(word.empty() ? "wants a function" : "");
         }}};
    for (OptionRow &row : solid_rows(command.solid))
        if (row.name != "--tolerance") rows.push_back(std::move(row));
    return rows;
}

std::vector<OptionRow> measure_rows(MeasureCommand &command) {
    return {{"--density", "D",
             "also the mass: of a volume of 1, or in g/cm3 where --units says what a length is",
             [&](const std::string &word) {
                 const std::optional<double> number = parse_number(word);
                 if (!number || !(*number > 0) || !fits_single(*number))
                     return fmt::format("wants a number above 0, as 7.85, not `{}`", word);
                 command.density = *number;
                 return std::string();
             }},
            {"--parts", "", "measure each part of the scene, too", {}, &command.parts},
            {"--between", "PART,PART", "how far two parts are apart; may be given again",
             [&](const std::string &word) {
                 const std::size_t comma = word.find(',');
                 if (comma == word.npos || comma == 0 || comma + 1 == word.size() ||
                     word.find(',', comma + 1) != word.npos)
                     return fmt::format("wants two parts, as ball,box#2, not `{}`", word);
                 command.between.emplace_back(word.substr(0, comma), word.substr(comma + 1));
                 return std::string();
             }}};
}

} // namespace fathom::cli
