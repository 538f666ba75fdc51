// The images and grids of a scene while it is checked: which were named, which could not be read,
// and what is known of their numbers, each measured once. Reads nothing itself.
#pragma once

#include "typecheck/check.h"

#include <array>
#include <map>
#include <string>
#include <unordered_map>

namespace fathom::typecheck {

struct Interpreter;

// What is known of an image's brightness.
struct ImageFacts {
    double minimum = 0, maximum = 0, mean = 0;
    double slope_u = 0, slope_v = 0; // per image: bilinear, so the largest step between neighbours
};

// What is known of a grid's trilinear field.
struct GridFacts {
    double least = 0, greatest = 0;
    double steepest = 0; // per unit of space
};

// What has been asked of files so far.
struct Assets {
    std::map<std::string, std::uint32_t> numbers{}; // by kind and name, or identity
    std::map<std::string, LoadError> absent{};      // by kind and name, why it could not be read
    std::unordered_map<std::uint32_t, std::uint32_t> heights{}; // of an image: that image's number
    std::unordered_map<std::uint32_t, ImageFacts> image_facts{};
    std::unordered_map<std::uint32_t, GridFacts> grid_facts{};
};

ImageFacts facts_of_image(Assets &assets, std::uint32_t index, const ir::ImageData &image);
GridFacts facts_of_grid(Assets &assets, std::uint32_t index, const ir::GridData &grid);

using Corners = std::array<std::array<double, 3>, 2>;
// The box that holds what is inside: of all cells that have a corner there. `margin`: by how much a
// value may be on the other side, for what interpolation rounds.
Corners inside_box(const ir::GridData &grid, double level, bool above, double margin);

// Counts what it takes to look for a file of that name; false where it is too much.
bool spend_on_lookup(Interpreter &ev, Span place, std::string_view path);

} // namespace fathom::typecheck
