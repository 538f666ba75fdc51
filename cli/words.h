// Words of the command line: each function reads one into its place, or says what it wanted; an
// empty answer is a good word.
#pragma once

#include "cli/command.h"

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fathom::cli {

std::string read_pair(const std::string &word, int &first, int &second); // 1280x720: 1 to 65536
// A coordinate of a point: beyond 1e18 no number says where anything is.
std::optional<double> read_coordinate(std::string_view word);
std::string read_point(const std::string &word, std::array<double, 3> &point); // 0,1.5,-2
// -1,-1,0,1,1,2: the least corner of a box, then the greatest.
std::string read_box(const std::string &word, std::array<std::array<double, 3>, 2> &box);
// 0..48, 0..=47, 0..=240:2, 7, and lists of them by commas: frames from 0 to 1,000,000.
std::string read_frames(const std::string &word, FrameList &frames);
// 1.5, 0..10:0.2, 0..=10:0.2, and lists of them by commas: 1 to 100,000 finite numbers.
std::string read_heights(const std::string &word, std::vector<double> &heights);
// name=0..1 and name=0..=1: two finite numbers.
std::string read_sweep(const std::string &word, std::vector<Sweep> &sweeps);
// z=0.5..2, z=..0.5, z=0.5..: what is kept of a scene that is cut open.
std::string read_section(const std::string &word, std::optional<v1::Section> &section);
std::string word_of_section(const v1::Section &section); // the same, to be read again
// 16, or 4..8 and 4..=7: samples of a pixel, 0 to 256.
std::string read_samples(const std::string &word, RenderCommand &command);
std::string read_tile(const std::string &word, std::optional<std::pair<int, int>> &tile); // 0/4
// 0,100,640,20: x and y of the upper left pixel, width and height.
std::string read_region(const std::string &word, std::optional<std::array<int, 4>> &region);
// name=value, of `-D`; the value is an expression of the language, which is not read here.
std::string read_override(const std::string &word, std::vector<Definition> &overrides);

} // namespace fathom::cli
