// Hashing and noise: the meaning of the ops Hash, Perlin, Simplex, ValueNoise, Worley and
// SpotNoise, with what is certain about their ranges and slopes. Written to be ported line by line:
// 32-bit unsigned arithmetic that wraps, float arithmetic, choices without branches. Knows nothing
// of graphs.
//
// T is float, double, or a number type of someone else's (a dual number) that has + - * /,
// comparison, floor, sqrt, min and max by ADL, and `plain(x)`: its value as a float or double.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

namespace fathom::ir::sem {

constexpr float plain(float x) { return x; }
constexpr double plain(double x) { return x; }

template <class T> struct V3 { T x, y, z; };

// -- hashing

// A bijection of 32-bit words in which every input bit moves every output bit about half of the
// time: the multiply-xorshift form whose constants Wellons found by search ("lowbias32").
constexpr std::uint32_t scramble(std::uint32_t h) {
    h ^= h >> 16;
    h *= 0x7feb352du;
    h ^= h >> 15;
    h *= 0x846ca68bu;
    h ^= h >> 16;
    return h;
}

// One more word into a running hash; chained, so that equal words in other places hash apart.
constexpr std::uint32_t hash_more(std::uint32_t h, std::uint32_t word) {
    return scramble((h ^ word) + 0x9e3779b9u);
}

// A lattice point's hash, axis after axis: the shift between the multiplications keeps it from
// being linear, so that it has no period on the lattice; neighbours share the first two lines.
// `salt` gives another independent lattice.
constexpr std::uint32_t hash_lattice(std::uint32_t x, std::uint32_t y, std::uint32_t z,
                                     std::uint32_t salt) {
    std::uint32_t h = (x ^ salt) * 0x9e3779b1u;
    h = ((h ^ (h >> 15)) + y) * 0x85ebca77u;
    h = ((h ^ (h >> 13)) + z) * 0xc2b2ae3du;
    return scramble(h);
}

// Equal numbers hash equal: -0 as +0. A double is first rounded to the float that the shader has.
inline std::uint32_t hash_word(float x) { return x == 0.0f ? 0u : std::bit_cast<std::uint32_t>(x); }
inline std::uint32_t hash_word(double x) { return hash_word(static_cast<float>(x)); }
constexpr std::uint32_t hash_word(std::int32_t x) { return static_cast<std::uint32_t>(x); }

// 0 <= x < 1, a multiple of 2^-24: exact in a float. GLSL: float(h >> 8) * (1.0 / 16777216.0)
template <class T> T unit(std::uint32_t h) {
    return T(static_cast<float>(h >> 8) * (1.0f / 16777216.0f));
}

// Op Hash: the components in order, begun with their number so that a float and a vec2 with y = 0
// hash apart. hash(x) = unit(hash_more(n, word(x)) …), n = 1, 2, 3, 4 components.
inline std::uint32_t hash_begin(int components) { return static_cast<std::uint32_t>(components); }

// -- the lattice

// A whole number as a lattice coordinate. Beyond +-2^30 (where floats have no fractions left) and
// for NaN it is 0, so that the conversion is defined everywhere. GLSL: uint(int(abs(x) <=
// 1073741824.0 ? x : 0.0))
template <class F> std::uint32_t lattice(F whole) {
    const F inside = whole <= F(1073741824.0) ? (whole >= F(-1073741824.0) ? whole : F(0)) : F(0);
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(inside));
}

// Perlin's quintic of 2002, 6t^5 - 15t^4 + 10t^3: first and second derivative 0 at both ends; slope
// at most 15/8.
template <class T> T fade(T t) { return t * t * t * (t * (t * T(6) - T(15)) + T(10)); }

template <class T> T mix1(T a, T b, T t) { return a + t * (b - a); }

// -- Perlin's improved noise (2002)

// The product with one of the 12 directions to the middles of a cube's edges (four of them twice),
// by the top four bits of the hash, as in Perlin's paper; the permutation table is replaced by the
// hash of the lattice point.
template <class T> T edge_gradient(std::uint32_t h, T x, T y, T z) {
    const std::uint32_t k = h >> 28;
    const T u = k < 8u ? x : y;
    const T v = k < 4u ? y : ((k | 2u) == 14u ? x : z);
    return ((k & 1u) == 0u ? u : -u) + ((k & 2u) == 0u ? v : -v);
}

// 0 at lattice points. |grad| reaches 2 * 15/8 = 3.75 at cell centres; no more than 3.7542 (branch
// and bound over the cell with intervals, times a grid of directions); |value| <= 1.0364.
constexpr double perlin_slope = 3.7542;
constexpr double perlin_range = 1.0364;
// Second derivatives along lines: 14.465 is attained; certify_test.cpp proves the bound.
constexpr double perlin_bend = 15.2;
template <class T> T perlin(T px, T py, T pz) {
    using std::floor;
    const auto fx = floor(plain(px)), fy = floor(plain(py)), fz = floor(plain(pz));
    const std::uint32_t ix = lattice(fx), iy = lattice(fy), iz = lattice(fz);
    const T x = px - T(fx), y = py - T(fy), z = pz - T(fz);
    const T x1 = x - T(1), y1 = y - T(1), z1 = z - T(1);
    const T a = edge_gradient(hash_lattice(ix, iy, iz, 0u), x, y, z);
    const T b = edge_gradient(hash_lattice(ix + 1u, iy, iz, 0u), x1, y, z);
    const T c = edge_gradient(hash_lattice(ix, iy + 1u, iz, 0u), x, y1, z);
    const T d = edge_gradient(hash_lattice(ix + 1u, iy + 1u, iz, 0u), x1, y1, z);
    const T e = edge_gradient(hash_lattice(ix, iy, iz + 1u, 0u), x, y, z1);
    const T f = edge_gradient(hash_lattice(ix + 1u, iy, iz + 1u, 0u), x1, y, z1);
    const T g = edge_gradient(hash_lattice(ix, iy + 1u, iz + 1u, 0u), x, y1, z1);
    const T h = edge_gradient(hash_lattice(ix + 1u, iy + 1u, iz + 1u, 0u), x1, y1, z1);
    const T u = fade(x), v = fade(y), w = fade(z);
    return mix1(mix1(mix1(a, b, u), mix1(c, d, u), v), mix1(mix1(e, f, u), mix1(g, h, u), v), w);
}

// -- value noise

// Random values 0..1 at lattice points, joined by the quintic. |grad| <= 1.9069, certified as above
// (1.875 is reached).
constexpr double value_noise_slope = 1.9069;
constexpr double value_noise_bend = 7.5; // of second derivatives, as above; 7.03 is attained
template <class T> T value_noise(T px, T py, T pz) {
    using std::floor;
    const auto fx = floor(plain(px)), fy = floor(plain(py)), fz = floor(plain(pz));
    const std::uint32_t ix = lattice(fx), iy = lattice(fy), iz = lattice(fz);
    const std::uint32_t salt = 0x68e31da4u;
    const T a = unit<T>(hash_lattice(ix, iy, iz, salt));
    const T b = unit<T>(hash_lattice(ix + 1u, iy, iz, salt));
    const T c = unit<T>(hash_lattice(ix, iy + 1u, iz, salt));
    const T d = unit<T>(hash_lattice(ix + 1u, iy + 1u, iz, salt));
    const T e = unit<T>(hash_lattice(ix, iy, iz + 1u, salt));
    const T f = unit<T>(hash_lattice(ix + 1u, iy, iz + 1u, salt));
    const T g = unit<T>(hash_lattice(ix, iy + 1u, iz + 1u, salt));
    const T h = unit<T>(hash_lattice(ix + 1u, iy + 1u, iz + 1u, salt));
    const T u = fade(px - T(fx)), v = fade(py - T(fy)), w = fade(pz - T(fz));
    return mix1(mix1(mix1(a, b, u), mix1(c, d, u), v), mix1(mix1(e, f, u), mix1(g, h, u), v), w);
}

// -- simplex noise

// One corner's part: (1/2 - d^2)+^4 (g.d). The radius^2 is 1/2, not Perlin's 0.6, because 1/2 is
// the squared distance of a corner to the far side of its simplices: with more the noise is
// discontinuous there and has no slope bound at all.
template <class T> T simplex_corner(std::uint32_t h, T x, T y, T z) {
    const T s = T(0.5) - (x * x + y * y + z * z);
    const T t = s < T(0) ? T(0) : s;
    return t * t * t * t * edge_gradient(h, x, y, z);
}

// The cubic lattice is squeezed along its diagonal by x -> x - (x+y+z)/6, so that its six
// tetrahedra a cube become equal; the middle corners are found by the order of the coordinates. 0
// at lattice points.
constexpr double simplex_scale = 76.0;
constexpr double simplex_slope =
    7.4; // 6.89 is reached; tests/unit/ir/certify_test.cpp says how this was proved
constexpr double simplex_range = 1.0; // 0.9886 is reached
template <class T> T simplex(T px, T py, T pz) {
    using std::floor;
    const auto s = (plain(px) + plain(py) + plain(pz)) * (1.0f / 3.0f);
    const auto fx = floor(plain(px) + s), fy = floor(plain(py) + s), fz = floor(plain(pz) + s);
    const auto t = (fx + fy + fz) * (1.0f / 6.0f);
    const T x = px - T(fx - t), y = py - T(fy - t), z = pz - T(fz - t);
    const bool xy = plain(x) >= plain(y), yz = plain(y) >= plain(z), xz = plain(x) >= plain(z);
    // Each coordinate's rank: how many of the other two it is not below (ties to the first).
    const int rx = int(xy) + int(xz), ry = int(!xy) + int(yz), rz = int(!xz) + int(!yz);
    const int ax = rx == 2, ay = ry == 2,
              az = rz == 2; // second corner: the largest coordinate's axis
    const int bx = rx >= 1, by = ry >= 1, bz = rz >= 1; // third: all but the smallest
    const std::uint32_t ix = lattice(fx), iy = lattice(fy), iz = lattice(fz);
    const std::uint32_t salt = 0xb5297a4du;
    const T g1(1.0f / 6.0f), g2(1.0f / 3.0f), g3(0.5f);
    const T a = simplex_corner(hash_lattice(ix, iy, iz, salt), x, y, z);
    const T b = simplex_corner(
        hash_lattice(ix + std::uint32_t(ax), iy + std::uint32_t(ay), iz + std::uint32_t(az), salt),
        x - T(ax) + g1, y - T(ay) + g1, z - T(az) + g1);
    const T c = simplex_corner(
        hash_lattice(ix + std::uint32_t(bx), iy + std::uint32_t(by), iz + std::uint32_t(bz), salt),
        x - T(bx) + g2, y - T(by) + g2, z - T(bz) + g2);
    const T d = simplex_corner(hash_lattice(ix + 1u, iy + 1u, iz + 1u, salt), x - T(1) + g3,
                               y - T(1) + g3, z - T(1) + g3);
    return T(simplex_scale) * (a + b + c + d);
}

// -- Worley's cellular noise

// One point in every unit cell, anywhere in it: 11, 11 and 10 bits of the cell's hash.
template <class T> V3<T> worley_point(std::uint32_t h) {
    return {T((static_cast<float>(h & 2047u) + 0.5f) * (1.0f / 2048.0f)),
            T((static_cast<float>((h >> 11) & 2047u) + 0.5f) * (1.0f / 2048.0f)),
            T((static_cast<float>(h >> 22) + 0.5f) * (1.0f / 1024.0f))};
}

// The distance to the nearest point, and never more than 1. All points nearer than 1 lie in the 27
// cells round p, so this is exactly min(1, distance): continuous and of slope 1, which the distance
// to the nearest of 27 is not (that jumps in the 0.08 % of space where no point is nearer than 1).
constexpr double worley_slope = 1.0;
template <class T> T worley(T px, T py, T pz) {
    using std::floor;
    using std::sqrt;
    const auto fx = floor(plain(px)), fy = floor(plain(py)), fz = floor(plain(pz));
    const std::uint32_t ix = lattice(fx), iy = lattice(fy), iz = lattice(fz);
    const T x = px - T(fx), y = py - T(fy), z = pz - T(fz);
    T minimum(1);
    const auto cell = [&](int i, int j, int k) {
        const V3<T> q = worley_point<T>(hash_lattice(ix + std::uint32_t(i), iy + std::uint32_t(j),
                                                     iz + std::uint32_t(k), 0x1b56c4e9u));
        const T dx = x - (T(float(i)) + q.x), dy = y - (T(float(j)) + q.y),
                dz = z - (T(float(k)) + q.z);
        const T d = dx * dx + dy * dy + dz * dz;
        minimum = d < minimum ? d : minimum;
    };
    // Written out, not looped over: loops over batches of points vectorise only where none is
    // inside.
    [&]<int... n>(std::integer_sequence<int, n...>) {
        (cell(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1), ...);
    }
    (std::make_integer_sequence<int, 27>{});
    return sqrt(minimum);
}

// -- spot noise (sparse convolution; Lewis 1989, thesis 7.1)

// Spots (1 - t^2)^3, t the distance over `radius`, at random places and with random weights -1..1;
// `density` of them, on the average, in a cube of side `radius`: floor(density + u) with u random
// in a cell. Cells have side `radius`, so every spot that reaches p lies in the 27 cells round it.
// Divided by sqrt(density), so that the deviation stays 0.31.
//
// With at most n = ceil(density) spots in a cell the sums over the 27 cells of what one spot there
// can do are at most 27.5 for the slope (a spot's is 6t(1-t^2)^2 <= 96/(25 sqrt 5)) and 8.1 for the
// value (tests/unit/ir/certify_test.cpp).
constexpr int spot_maximum = 8;     // density is clamped to 0..8
constexpr double spot_slope = 27.5; // |grad| <= spot_slope * n / (radius * sqrt(max(density, 1)))
constexpr double spot_range = 8.1;  // |value| <= spot_range * n / sqrt(max(density, 1))
template <class T> T spot_noise(T px, T py, T pz, T radius, T density) {
    using std::floor;
    using std::sqrt;
    const T r = radius < T(1e-6f) ? T(1e-6f) : radius;
    const T n = density < T(0) ? T(0) : (density < T(spot_maximum) ? density : T(spot_maximum));
    const T qx = px / r, qy = py / r, qz = pz / r;
    const auto fx = floor(plain(qx)), fy = floor(plain(qy)), fz = floor(plain(qz));
    const std::uint32_t ix = lattice(fx), iy = lattice(fy), iz = lattice(fz);
    const T x = qx - T(fx), y = qy - T(fy), z = qz - T(fz);
    T sum(0);
    for (int k = -1; k <= 1; ++k)
        for (int j = -1; j <= 1; ++j)
            for (int i = -1; i <= 1; ++i) {
                std::uint32_t h = hash_lattice(ix + std::uint32_t(i), iy + std::uint32_t(j),
                                               iz + std::uint32_t(k), 0x3c6ef372u);
                const int count = static_cast<int>(floor(plain(n) + unit<float>(h)));
                for (int spot = 0; spot < count; ++spot) {
                    h = hash_more(h, 1u); // its place
                    const V3<T> q = worley_point<T>(h);
                    const T dx = x - (T(float(i)) + q.x), dy = y - (T(float(j)) + q.y),
                            dz = z - (T(float(k)) + q.z);
                    const T s = T(1) - (dx * dx + dy * dy + dz * dz);
                    const T t = s < T(0) ? T(0) : s;
                    h = hash_more(h, 2u); // its weight
                    sum = sum + (unit<T>(h) * T(2) - T(1)) * (t * t * t);
                }
            }
    return sum / sqrt(n < T(1) ? T(1) : n);
}

} // namespace fathom::ir::sem
