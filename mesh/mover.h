// Moves places near a surface to it, a few that lie near each other at once, by a tape that is shortened
// for these (docs/meshes.md, 12).
#pragma once

#include "mesh/curve.h"
#include "mesh/grid.h"
#include "mesh/parallel.h"

#include <optional>
#include <span>

namespace fathom::mesh {

// Moves points outside of the solid along the field's slope to where it is `level`, and never
// beyond its surface.
struct Mover {
    explicit Mover(const Field &field) : evaluator(field) {}
    Evaluator evaluator;
    Points points;
    std::array<std::vector<float>, 4> slope;
    std::vector<float> values;
    std::vector<std::size_t> going;
    std::vector<double> share; // of Newton's step
    struct Near {
        Point lo{}, hi{};
        TapePtr tape; // holds there
    };
    Near near;

    // A tape that holds at all of the points, which lie near each other.
    const cpu::ShortTape &tape_at();

    void move(std::span<Point> at, float level, float sign);

    // The field at places near each other, and its slope.
    void look_at(std::span<const Point> at);

    // How far from each point the field has another sign, by looks along its slope; none: not seen.
    void look_beyond(std::span<const Point> at, float level, float sign,
                     std::vector<std::optional<float>> &far);
};

constexpr std::size_t moved_at_once = 256;
using Numbers = std::span<const std::uint32_t>;

// Calls work(mover, which, some) for places that lie near each other, by their numbers: `some` are
// theirs, and may be moved.
template <class Work> void by_some(const Field &field, std::span<Point> at, unsigned threads,
                                   Progress &progress, Work work) {
    std::vector<Real3> places;
    places.reserve(at.size());
    for (const Point &p : at) places.push_back(real(p));
    const std::vector<std::uint32_t> order = order_along_curve(places);
    in_parallel((at.size() + moved_at_once - 1) / moved_at_once, threads, progress,
                [&] { return Mover(field); },
                [&](Mover &mover, std::size_t number) {
                    const std::size_t first = number * moved_at_once;
                    const auto which =
                        std::span(order).subspan(first, std::min(moved_at_once, at.size() - first));
                    std::vector<Point> some;
                    for (const std::uint32_t k : which) some.push_back(at[k]);
                    work(mover, which, some);
                    for (std::size_t n = 0; n < which.size(); ++n) at[which[n]] = some[n];
                });
}

// The field at places, and its slope there.
std::array<std::vector<float>, 4> slopes_at(const Field &field, std::span<Point> at,
                                            unsigned threads, Progress &progress);

} // namespace fathom::mesh
