#include "mesh/exact.h"

#include <algorithm>
#include <cmath>

namespace fathom::mesh {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

// A number as a sum of doubles that do not overlap, the smallest first.
using Sum = std::vector<double>;

void grow(Sum &sum, double b) {
    double q = b;
    Sum next;
    for (const double e : sum) { // Knuth's exact sum of two
        const double s = q + e, shadow = s - q, rest = (q - (s - shadow)) + (e - shadow);
        if (rest != 0) next.push_back(rest);
        q = s;
    }
    if (q != 0 || next.empty()) next.push_back(q);
    sum = std::move(next);
}
Sum difference(float a, float b) {
    Sum sum{double(a)};
    grow(sum, -double(b));
    return sum;
}
Sum product(const Sum &a, const Sum &b) {
    Sum sum{0};
    for (const double x : a)
        for (const double y : b) {
            const double high = x * y;
            grow(sum, std::fma(x, y, -high));
            grow(sum, high);
        }
    return sum;
}
Sum less(const Sum &a, const Sum &b) {
    Sum sum = a;
    for (const double x : b) grow(sum, -x);
    return sum;
}
Sum plus(const Sum &a, const Sum &b) {
    Sum sum = a;
    for (const double x : b) grow(sum, x);
    return sum;
}
int sign_of(const Sum &a) { return a.back() > 0 ? 1 : a.back() < 0 ? -1 : 0; }

int exact_side(const Point &a, const Point &b, const Point &c, const Point &d) {
    std::array<Sum, 3> u, v, w;
    for (std::size_t i = 0; i < 3; ++i) {
        u[i] = difference(a[i], d[i]);
        v[i] = difference(b[i], d[i]);
        w[i] = difference(c[i], d[i]);
    }
    Sum whole{0};
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
        whole = plus(whole, product(u[i], less(product(v[j], w[k]), product(v[k], w[j]))));
    }
    return -sign_of(whole);
}

// Whether a way and a triangle in one plane meet, as seen down an axis.
bool meet_flat(const Point &p, const Point &q, const std::array<Point, 3> &t, std::size_t axis) {
    const auto in_triangle = [&](const Point &x) {
        int least = 1, most = -1;
        for (std::size_t k = 0; k < 3; ++k) {
            const int turn = turn_of(t[k], t[(k + 1) % 3], x, axis);
            least = std::min(least, turn), most = std::max(most, turn);
        }
        return least >= 0 || most <= 0;
    };
    if (in_triangle(p) || in_triangle(q)) return true;
    for (std::size_t k = 0; k < 3; ++k) {
        const Point &u = t[k], &v = t[(k + 1) % 3];
        const int a = turn_of(p, q, u, axis), b = turn_of(p, q, v, axis),
                  c = turn_of(u, v, p, axis), d = turn_of(u, v, q, axis);
        if (a == 0 && b == 0 && c == 0 && d == 0)
            continue;                              // on one line: an end would be in it, or
        if (a * b <= 0 && c * d <= 0) return true; // … another side is met
    }
    return false;
}

// The axis down which a triangle is seen best.
std::size_t best_axis(const std::array<Point, 3> &t) {
    std::array<double, 3> u, v;
    for (std::size_t i = 0; i < 3; ++i)
        u[i] = double(t[1][i]) - t[0][i], v[i] = double(t[2][i]) - t[0][i];
    std::size_t best = 0;
    double most = -1;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
        const double seen = std::fabs(u[j] * v[k] - u[k] * v[j]);
        if (seen > most && turn_of(t[0], t[1], t[2], i) != 0) most = seen, best = i;
    }
    return best;
}

// Whether all of a way lies beyond all of a triangle along one of the axes.
bool beyond(const Point &p, const Point &q, const std::array<Point, 3> &t) {
    for (std::size_t i = 0; i < 3; ++i) {
        const auto [lo, hi] = std::minmax(p[i], q[i]);
        if (lo > std::max({t[0][i], t[1][i], t[2][i]}) ||
            hi < std::min({t[0][i], t[1][i], t[2][i]}))
            return true;
    }
    return false;
}

// About where a way meets a triangle, ends and borders included.
std::optional<Point> meeting_of(const Point &p, const Point &q, const std::array<Point, 3> &t) {
    if (beyond(p, q, t)) return std::nullopt; // as the signs below would say, at more cost
    const int from = side_of(t[0], t[1], t[2], p), to = side_of(t[0], t[1], t[2], q);
    if (from * to > 0) return std::nullopt;
    if (from == 0 && to == 0) {
        if (!meet_flat(p, q, t, best_axis(t))) return std::nullopt;
        Point middle;
        for (std::size_t i = 0; i < 3; ++i) middle[i] = 0.5f * (p[i] + q[i]);
        return middle;
    }
    const int a = side_of(p, q, t[0], t[1]), b = side_of(p, q, t[1], t[2]),
              c = side_of(p, q, t[2], t[0]);
    if (!((a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0))) return std::nullopt;
    std::array<double, 3> u, v, w, x;
    for (std::size_t i = 0; i < 3; ++i) {
        u[i] = double(t[1][i]) - t[0][i], v[i] = double(t[2][i]) - t[0][i];
        w[i] = double(p[i]) - t[0][i], x[i] = double(q[i]) - t[0][i];
    }
    double above = 0, below = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
        const double n = u[j] * v[k] - u[k] * v[j];
        above += n * w[i], below += n * x[i];
    }
    const double share = above != below ? std::clamp(above / (above - below), 0.0, 1.0) : 0.5;
    Point at;
    for (std::size_t i = 0; i < 3; ++i)
        at[i] = static_cast<float>(p[i] + share * (double(q[i]) - p[i]));
    return at;
}

} // namespace

int side_of(const Point &a, const Point &b, const Point &c, const Point &d) {
    constexpr double error = 1e-15; // of the sum of all sizes: 8 roundings one after the other
    std::array<double, 3> u, v, w;
    for (std::size_t i = 0; i < 3; ++i)
        u[i] = double(a[i]) - d[i], v[i] = double(b[i]) - d[i], w[i] = double(c[i]) - d[i];
    double whole = 0, size = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
        const double one = v[j] * w[k], other = v[k] * w[j];
        whole += u[i] * (one - other);
        size += std::fabs(u[i]) * (std::fabs(one) + std::fabs(other));
    }
    if (std::fabs(whole) > error * size) return whole > 0 ? -1 : 1;
    return size > 0 ? exact_side(a, b, c, d) : 0;
}

int turn_of(const Point &a, const Point &b, const Point &c, std::size_t axis) {
    constexpr double error = 1e-15;
    const std::size_t j = (axis + 1) % 3, k = (axis + 2) % 3;
    const double one = (double(b[j]) - a[j]) * (double(c[k]) - a[k]),
                 other = (double(b[k]) - a[k]) * (double(c[j]) - a[j]), whole = one - other;
    if (std::fabs(whole) > error * (std::fabs(one) + std::fabs(other))) return whole > 0 ? 1 : -1;
    // Of floats that are not equal the difference is not 0, nor is a product of two such.
    if (one == 0 && other == 0) return 0;
    return sign_of(less(product(difference(b[j], a[j]), difference(c[k], a[k])),
                        product(difference(b[k], a[k]), difference(c[j], a[j]))));
}

bool is_flat(const Point &a, const Point &b, const Point &c) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (turn_of(a, b, c, axis) != 0) return false;
    return true;
}

std::optional<Point> crossing_of(std::span<const Point> points, const Triangle &s,
                                 const Triangle &t) {
    std::array<Point, 3> a, b;
    for (std::size_t k = 0; k < 3; ++k) a[k] = points[s[k]], b[k] = points[t[k]];
    std::array<std::size_t, 3> in_s{}, in_t{};
    std::size_t shared = 0;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            if (s[i] == t[j]) in_s[shared] = i, in_t[shared] = j, ++shared;
    if (shared == 3) return a[0];
    if (shared == 2) { // they meet in their edge alone unless one is folded onto the other
        const std::size_t i = 3 - in_s[0] - in_s[1], j = 3 - in_t[0] - in_t[1];
        if (side_of(a[0], a[1], a[2], b[j]) != 0) return std::nullopt;
        const std::size_t axis = best_axis(a);
        const Point &u = a[in_s[0]], &v = a[in_s[1]];
        if (turn_of(u, v, a[i], axis) * turn_of(u, v, b[j], axis) < 0) return std::nullopt;
        return a[i];
    }
    // What two triangles have in common besides a vertex that they share ends on a side of one of them
    // that does not begin there.
    for (std::size_t k = 0; k < 3; ++k) {
        if (shared == 0 || (k + 1) % 3 == in_s[0])
            if (const auto at = meeting_of(a[(k + 2) % 3], a[k], b)) return at;
        if (shared == 0 || (k + 1) % 3 == in_t[0])
            if (const auto at = meeting_of(b[(k + 2) % 3], b[k], a)) return at;
    }
    return std::nullopt;
}

} // namespace fathom::mesh
