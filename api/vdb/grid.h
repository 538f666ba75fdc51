// What the module that writes OpenVDB files is given, in plain C, so that it and the library need no
// compiler in common.
#pragma once

#include <cstddef>
#include <cstdint>

extern "C" {

// Voxel k is the point origin + side * at[3 k …].
struct FathomVdbGrid {
    double origin[3], side, background;
    std::size_t count;
    const std::int32_t *at;
    const float *distances;
    const float *colors; // three a voxel, or null
};

// The bytes of a file go to `take`, in pieces. Gives 0, or 1 with words in `why`.
using FathomWriteVdb = int (*)(const FathomVdbGrid *grid,
                               void (*take)(void *to, const char *bytes, std::size_t count),
                               void *to, char *why, std::size_t room);
}
