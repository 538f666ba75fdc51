// Reading images and grids between their samples. T is a number type as in ir/semantics.h; the data
// are floats.
#pragma once

#include "ir/scene.h"
#include "ir/semantics.h"

#include <array>

namespace fathom::cpu {

// A coordinate's cell and the way through it.
template <class T> struct Cell1 {
    int index;
    T way;
};
template <class T> Cell1<T> cell_of(T x) {
    using ir::sem::plain;
    using std::floor;
    float whole = floor(plain(x));
    int index = ir::sem::saturate(whole);
    return {index, x - T(whole)};
}
inline int wrap(int i, int n) { return ir::sem::int_mod(i, n); }
inline int inside(int i, int n) { return i < 0 ? 0 : (i < n ? i : n - 1); }

// Bilinear and repeated, v from the image's lower edge up; samples stand in the middles of their
// squares, at (i + 1/2)/size. Nothing where there are none.
template <class T> std::array<T, 4> sample_image(const ir::ImageData &image, T u, T v) {
    using ir::sem::plain;
    std::array<T, 4> out{T(0), T(0), T(0), T(0)};
    if (image.width < 1 || image.height < 1) return out;
    auto x = cell_of((u - T(std::floor(plain(u)))) * T(float(image.width)) - T(0.5f));
    auto y = cell_of((T(1) - (v - T(std::floor(plain(v))))) * T(float(image.height)) -
                     T(0.5f)); // rows run downward
    auto at = [&](int i, int j, std::size_t c) {
        auto row = static_cast<std::size_t>(wrap(j, image.height)),
             width = static_cast<std::size_t>(image.width);
        return T(
            image.rgba[(row * width + static_cast<std::size_t>(wrap(i, image.width))) * 4 + c]);
    };
    for (std::size_t c = 0; c < 4; ++c) {
        T low = ir::sem::mix(at(x.index, y.index, c), at(x.index + 1, y.index, c), x.way);
        T high = ir::sem::mix(at(x.index, y.index + 1, c), at(x.index + 1, y.index + 1, c), x.way);
        out[c] = ir::sem::mix(low, high, y.way);
    }
    return out;
}

// Trilinear between samples at the corners 0 and 1 and evenly between them, clamped outside; x runs
// fastest.
template <class T> T sample_grid(const ir::GridData &grid, T px, T py, T pz) {
    auto [nx, ny, nz] = grid.size;
    if (nx < 1 || ny < 1 || nz < 1) return T(0);
    auto place = [](T p, int n) {
        return cell_of(ir::sem::clamp(p, T(0), T(1)) * T(float(n - 1)));
    };
    auto x = place(px, nx), y = place(py, ny), z = place(pz, nz);
    auto at = [&, nx = nx, ny = ny, nz = nz](int i, int j, int k) {
        auto a = static_cast<std::size_t>(inside(i, nx)),
             b = static_cast<std::size_t>(inside(j, ny)),
             c = static_cast<std::size_t>(inside(k, nz));
        return T(
            grid.values[(c * static_cast<std::size_t>(ny) + b) * static_cast<std::size_t>(nx) + a]);
    };
    auto along_x = [&](int j, int k) {
        return ir::sem::mix(at(x.index, j, k), at(x.index + 1, j, k), x.way);
    };
    auto along_xy = [&](int k) {
        return ir::sem::mix(along_x(y.index, k), along_x(y.index + 1, k), y.way);
    };
    return ir::sem::mix(along_xy(z.index), along_xy(z.index + 1), z.way);
}

} // namespace fathom::cpu
