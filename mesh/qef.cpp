#include "mesh/qef.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace fathom::mesh {
namespace {

using Matrix = std::array<Vector, 3>;

constexpr double least_share = 0.01; // of the largest eigenvalue: smaller ones say nothing

struct Sum { // |n.x - d|^2 over all planes, about the mean of their points
    Matrix squares{};
    Vector right{}, mean{};
};

Sum sum_of(std::span<const Plane> planes) {
    Sum sum;
    for (const Plane &plane : planes)
        for (std::size_t i = 0; i < 3; ++i)
            sum.mean[i] += plane.point[i] / static_cast<double>(planes.size());
    for (const Plane &plane : planes) {
        double d = 0;
        for (std::size_t i = 0; i < 3; ++i) d += plane.normal[i] * (plane.point[i] - sum.mean[i]);
        for (std::size_t i = 0; i < 3; ++i) {
            sum.right[i] += plane.normal[i] * d;
            for (std::size_t j = 0; j < 3; ++j)
                sum.squares[i][j] += plane.normal[i] * plane.normal[j];
        }
    }
    return sum;
}

double error_at(const Sum &sum, const Vector &x) { // but for a constant
    double error = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        error -= 2 * sum.right[i] * x[i];
        for (std::size_t j = 0; j < 3; ++j) error += sum.squares[i][j] * x[i] * x[j];
    }
    return error;
}

// The eigenvectors of a symmetric matrix as the columns of `vectors`, by Jacobi's rotations; what is
// left of the matrix has the eigenvalues on its diagonal.
void diagonalize(Matrix &m, Matrix &vectors) {
    vectors = {Vector{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    constexpr int sweeps = 12;
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        const double off = m[0][1] * m[0][1] + m[0][2] * m[0][2] + m[1][2] * m[1][2];
        const double on = m[0][0] * m[0][0] + m[1][1] * m[1][1] + m[2][2] * m[2][2];
        if (off <= 1e-30 * on) return;
        for (std::size_t p = 0; p < 2; ++p)
            for (std::size_t q = p + 1; q < 3; ++q) {
                if (m[p][q] == 0) continue;
                const double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
                const double t =
                    (theta < 0 ? -1 : 1) / (std::fabs(theta) + std::sqrt(theta * theta + 1));
                const double c = 1 / std::sqrt(t * t + 1), s = t * c;
                for (std::size_t k = 0; k < 3; ++k) {
                    const double x = m[k][p], y = m[k][q];
                    m[k][p] = c * x - s * y, m[k][q] = s * x + c * y;
                }
                for (std::size_t k = 0; k < 3; ++k) {
                    const double x = m[p][k], y = m[q][k];
                    m[p][k] = c * x - s * y, m[q][k] = s * x + c * y;
                }
                for (std::size_t k = 0; k < 3; ++k) {
                    const double x = vectors[k][p], y = vectors[k][q];
                    vectors[k][p] = c * x - s * y, vectors[k][q] = s * x + c * y;
                }
            }
    }
}

// The least of the sum where some coordinates are held: of the others only those directions move
// that the planes say enough of.
Vector least(const Sum &sum, const std::array<bool, 3> &held, const Vector &at) {
    Matrix m{}, vectors{};
    Vector right{}, x{};
    for (std::size_t i = 0; i < 3; ++i) {
        if (held[i]) {
            x[i] = at[i];
            continue;
        }
        right[i] = sum.right[i];
        for (std::size_t j = 0; j < 3; ++j) {
            if (held[j])
                right[i] -= sum.squares[i][j] * at[j];
            else
                m[i][j] = sum.squares[i][j];
        }
    }
    const double largest = std::max({sum.squares[0][0], sum.squares[1][1], sum.squares[2][2]});
    diagonalize(m, vectors);
    for (std::size_t k = 0; k < 3; ++k) {
        const double value = m[k][k];
        if (!(value > least_share * largest)) continue;
        double along = 0;
        for (std::size_t i = 0; i < 3; ++i) along += vectors[i][k] * right[i];
        for (std::size_t i = 0; i < 3; ++i)
            if (!held[i]) x[i] += vectors[i][k] * along / value;
    }
    return x;
}

bool within(const Vector &x, const Vector &lo, const Vector &hi) {
    for (std::size_t i = 0; i < 3; ++i)
        if (!(x[i] >= lo[i] && x[i] <= hi[i])) return false;
    return true;
}

// Each coordinate free, at its low end or at its high end: the least of all that lie in the box.
Vector least_in(const Sum &sum, const Vector &lo, const Vector &hi) {
    Vector best{};
    double best_error = std::numeric_limits<double>::infinity();
    constexpr int cases = 27, all_free = 0;
    for (int number = all_free; number < cases; ++number) {
        std::array<bool, 3> held{};
        Vector at{};
        for (std::size_t i = 0, rest = static_cast<std::size_t>(number); i < 3; ++i, rest /= 3) {
            held[i] = rest % 3 != 0;
            at[i] = rest % 3 == 1 ? lo[i] : hi[i];
        }
        Vector x = least(sum, held, at);
        for (std::size_t i = 0; i < 3; ++i)
            if (held[i]) x[i] = at[i];
        if (!within(x, lo, hi)) continue;
        const double error = error_at(sum, x);
        if (error < best_error) best = x, best_error = error;
        if (number == all_free) break;
    }
    return best;
}

} // namespace

Vector meeting_point(std::span<const Plane> planes, const Vector &lo, const Vector &hi) {
    const Sum sum = sum_of(planes);
    Vector from{}, to{};
    for (std::size_t i = 0; i < 3; ++i) from[i] = lo[i] - sum.mean[i], to[i] = hi[i] - sum.mean[i];
    Vector x = least_in(sum, from, to);
    for (std::size_t i = 0; i < 3; ++i) x[i] = std::clamp(x[i] + sum.mean[i], lo[i], hi[i]);
    return x;
}

Vector meeting_point_on(std::span<const Plane> planes, std::size_t axis, double at,
                        const Vector &lo, const Vector &hi) {
    Vector from = lo, to = hi;
    from[axis] = to[axis] = at;
    return meeting_point(planes, from, to);
}

} // namespace fathom::mesh
