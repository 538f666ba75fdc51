// What the module that writes OpenVDB files is given, and what the program that reads them answers, in
// plain C, so that they and the library need no compiler in common.
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

// Numbers that are no distances: `components` a voxel, 1 or 3, at places of their own; 0 is background.
struct FathomVdbNumbers {
    const char *name;
    int components;
    std::size_t count;
    const std::int32_t *at;
    const float *values;
};

// The bytes of a file go to `take`, in pieces. Gives 0, or 1 with words in `why`, which has `room`
// bytes.
// Where `fields` is 0 the file is one of `distances`, else one of so many grids of `numbers`, and of
// `grid` only the origin and the side are read.
using FathomWriteVdb = int (*)(const FathomVdbGrid *grid, const FathomVdbNumbers *numbers,
                               std::size_t fields,
                               void (*take)(void *to, const char *bytes, std::size_t count),
                               void *to, char *why, std::size_t room);

// The box of all voxels of a grid that have a value of their own, one more to each side, and where
// its first voxel and its last one lie.
struct FathomVdbBox {
    std::uint64_t size[3]; // voxels along x, y and z
    double lo[3], hi[3];
};

// The program fathom-read-vdb gets a file by its standard input, and as its arguments the bytes that
// it may take, 0 for any, and the name of a grid, empty for the only one. It answers with this and
// then as many floats as the size's product, x the fastest; or, where `good` is 0, with words to the
// end.
struct FathomVdbAnswer {
    std::uint64_t good;
    FathomVdbBox box;
};
}
