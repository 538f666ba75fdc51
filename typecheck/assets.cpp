// What is known of images and grids from their numbers, and what it takes to look for one.
#include "typecheck/assets.h"

#include "typecheck/interpreter.h"

#include <algorithm>
#include <cmath>

namespace fathom::typecheck {

std::optional<LoadError> too_long(std::string_view path) {
    if (path.size() <= longest_file_name) return std::nullopt;
    return LoadError{LoadError::Reason::Unreadable,
                     fmt::format("the name has {} bytes, and no more than {} are looked for",
                                 path.size(), longest_file_name)};
}

bool spend_on_lookup(Interpreter &ev, Span place, std::string_view path) {
    constexpr std::size_t itself = 100;
    // The system goes through all folders on the way for each of them.
    const auto folders = static_cast<std::size_t>(std::ranges::count(path, '/'));
    return spend(ev, place, itself + path.size() + folders * folders);
}

namespace {

ImageFacts measured(const ir::ImageData &image) {
    ImageFacts out{1e30, -1e30, 0, 0, 0};
    const auto at = [&](int x, int y) {
        return double(
            image.rgba[static_cast<std::size_t>(y % image.height * image.width + x % image.width) *
                       4]);
    };
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const double h = at(x, y);
            out.minimum = std::min(out.minimum, h), out.maximum = std::max(out.maximum, h);
            out.mean += h / (double(image.width) * image.height);
            out.slope_u = std::max(out.slope_u, std::fabs(at(x + 1, y) - h) * image.width);
            out.slope_v = std::max(out.slope_v, std::fabs(at(x, y + 1) - h) * image.height);
        }
    return out;
}

GridFacts measured(const ir::GridData &grid) {
    // In a cell each partial derivative is a mean of the steps along its four edges.
    const auto [nx, ny, nz] = grid.size;
    const auto at = [&, nx = nx, ny = ny](int x, int y, int z) {
        return double(grid.values[static_cast<std::size_t>((z * ny + y) * nx + x)]);
    };
    GridFacts out;
    const auto [least, greatest] = std::minmax_element(grid.values.begin(), grid.values.end());
    out.least = *least, out.greatest = *greatest;
    std::array<double, 3> spacing{};
    for (std::size_t i = 0; i < 3; ++i) spacing[i] = (grid.hi[i] - grid.lo[i]) / (grid.size[i] - 1);
    for (int z = 0; z + 1 < nz; ++z)
        for (int y = 0; y + 1 < ny; ++y)
            for (int x = 0; x + 1 < nx; ++x) {
                std::array<double, 3> d{};
                for (int i = 0; i < 2; ++i)
                    for (int j = 0; j < 2; ++j) {
                        d[0] = std::max(d[0],
                                        std::fabs(at(x + 1, y + i, z + j) - at(x, y + i, z + j)));
                        d[1] = std::max(d[1],
                                        std::fabs(at(x + i, y + 1, z + j) - at(x + i, y, z + j)));
                        d[2] = std::max(d[2],
                                        std::fabs(at(x + i, y + j, z + 1) - at(x + i, y + j, z)));
                    }
                out.steepest =
                    std::max(out.steepest,
                             std::hypot(d[0] / spacing[0], d[1] / spacing[1], d[2] / spacing[2]));
            }
    return out;
}

} // namespace

ImageFacts facts_of_image(Assets &assets, std::uint32_t index, const ir::ImageData &image) {
    const auto [it, added] = assets.image_facts.try_emplace(index);
    if (added) it->second = measured(image);
    return it->second;
}

GridFacts facts_of_grid(Assets &assets, std::uint32_t index, const ir::GridData &grid) {
    const auto [it, added] = assets.grid_facts.try_emplace(index);
    if (added) it->second = measured(grid);
    return it->second;
}

Corners inside_box(const ir::GridData &grid, double level, bool above, double margin) {
    std::array<int, 3> first = grid.size, last{-1, -1, -1};
    std::size_t index = 0;
    for (int z = 0; z < grid.size[2]; ++z)
        for (int y = 0; y < grid.size[1]; ++y)
            for (int x = 0; x < grid.size[0]; ++x) {
                const double value = grid.values[index++];
                if (above ? value < level - margin : value > level + margin) continue;
                const std::array at{x, y, z};
                for (std::size_t i = 0; i < 3; ++i) {
                    first[i] = std::min(first[i], at[i]);
                    last[i] = std::max(last[i], at[i]);
                }
            }
    Corners out{grid.lo, grid.hi};
    for (std::size_t i = 0; i < 3; ++i) {
        const double spacing = (grid.hi[i] - grid.lo[i]) / (grid.size[i] - 1);
        // The grid's own corners stay as they are.
        if (first[i] > 1) out[0][i] = grid.lo[i] + (first[i] - 1) * spacing;
        if (last[i] + 2 < grid.size[i]) out[1][i] = grid.lo[i] + (last[i] + 1) * spacing;
    }
    return out;
}

} // namespace fathom::typecheck
