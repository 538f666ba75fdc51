#include "mesh/mover.h"

#include <algorithm>
#include <cmath>

namespace fathom::mesh {
namespace {

constexpr int most_steps = 16; // of Newton's method

} // namespace

const cpu::ShortTape &Mover::tape_at() {
    Point lo{}, hi{};
    for (std::size_t i = 0; i < 3 && points.size() > 0; ++i) {
        const auto [least, most] = std::ranges::minmax(points.at[i]);
        lo[i] = least, hi[i] = most;
    }
    bool inside = near.tape != nullptr;
    for (std::size_t i = 0; i < 3; ++i)
        inside = inside && lo[i] >= near.lo[i] && hi[i] <= near.hi[i];
    if (inside) return *near.tape;
    constexpr float spare = 0.25f; // they will move
    float longest = 0;
    for (std::size_t i = 0; i < 3; ++i) longest = std::max(longest, hi[i] - lo[i]);
    for (std::size_t i = 0; i < 3; ++i) {
        near.lo[i] = lo[i] - spare * longest;
        near.hi[i] = hi[i] + spare * longest;
    }
    cpu::Boxes boxes;
    near.tape = tape_in(evaluator, boxes, evaluator.field.whole, near.lo, near.hi);
    return *near.tape;
}

void Mover::move(std::span<Point> at, float level, float sign) {
    near.tape = nullptr;
    share.assign(at.size(), 1);
    going.clear();
    for (std::size_t k = 0; k < at.size(); ++k) going.push_back(k);
    std::vector<Point> next(at.size());
    for (int step = 0; step < most_steps && !going.empty(); ++step) {
        points.clear();
        for (const std::size_t k : going) points.add(at[k]);
        gradients_at(evaluator, tape_at(), points, slope);
        std::vector<std::size_t> moved;
        points.clear();
        for (std::size_t n = 0; n < going.size(); ++n) {
            const std::size_t k = going[n];
            double squares = 0;
            for (std::size_t i = 0; i < 3; ++i)
                squares += double(slope[1 + i][n]) * slope[1 + i][n];
            const double above = double(sign) * slope[0][n] - level;
            if (!(squares > 1e-6 && std::isfinite(squares)) || !(std::fabs(above) > 0.25 * level))
                continue;
            for (std::size_t i = 0; i < 3; ++i)
                next[k][i] = static_cast<float>(at[k][i] - share[k] * sign * above *
                                                               slope[1 + i][n] / squares);
            moved.push_back(k);
            points.add(next[k]);
        }
        values_at(evaluator, tape_at(), points, values);
        for (std::size_t n = 0; n < moved.size(); ++n) {
            const std::size_t k = moved[n];
            if (sign * values[n] > 0)
                at[k] = next[k];
            else
                share[k] *= 0.5;
        }
        going = std::move(moved);
    }
}

void Mover::look_at(std::span<const Point> at) {
    points.clear();
    for (const Point &p : at) points.add(p);
    near.tape = nullptr;
    gradients_at(evaluator, tape_at(), points, slope);
}

void Mover::look_beyond(std::span<const Point> at, float level, float sign,
                        std::vector<std::optional<float>> &far) {
    constexpr std::array<float, 4> looks{2, 4, 16, 32}; // times the level
    far.assign(at.size(), {});
    look_at(at);
    points.clear();
    for (std::size_t k = 0; k < at.size(); ++k) {
        const double rate = std::hypot(slope[1][k], slope[2][k], slope[3][k]);
        for (const float look : looks) {
            Point p = at[k];
            for (std::size_t i = 0; rate > 1e-3 && i < 3; ++i)
                p[i] -= static_cast<float>(sign * look * level * slope[1 + i][k] / rate);
            points.add(p);
        }
    }
    values_at(evaluator, tape_at(), points, values);
    for (std::size_t k = 0; k < at.size(); ++k)
        for (std::size_t n = looks.size(); n-- > 0;)
            if (const std::size_t look = looks.size() * k + n;
                (values[look] <= 0) != (slope[0][k] <= 0))
                far[k] = static_cast<float>(distance(real(points[look]), real(at[k])) * (1 + 1e-6));
}

std::array<std::vector<float>, 4> slopes_at(const Field &field, std::span<Point> at,
                                            unsigned threads, Progress &progress) {
    std::array<std::vector<float>, 4> found;
    for (std::vector<float> &column : found) column.resize(at.size());
    by_some(field, at, threads, progress, [&](Mover &mover, Numbers which, std::span<Point> some) {
        mover.look_at(some);
        for (std::size_t i = 0; i < found.size(); ++i)
            for (std::size_t n = 0; n < which.size(); ++n) found[i][which[n]] = mover.slope[i][n];
    });
    return found;
}

} // namespace fathom::mesh
