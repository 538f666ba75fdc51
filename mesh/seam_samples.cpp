#include "mesh/seam_samples.h"

#include "mesh/seams.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fathom::mesh {
namespace {

// Some places in a box, none of them likely to lie in a plane that people choose.
constexpr double shares[][3] = {{0.51, 0.49, 0.53}, {0.07, 0.19, 0.11}, {0.93, 0.13, 0.23},
                                {0.17, 0.91, 0.29}, {0.89, 0.83, 0.17}, {0.13, 0.23, 0.91},
                                {0.87, 0.31, 0.83}, {0.29, 0.87, 0.79}, {0.79, 0.93, 0.93}};
constexpr std::size_t places = std::size(shares);

Point place_in(const Extent &box, const double (&share)[3]) {
    Point p{};
    for (std::size_t i = 0; i < 3; ++i)
        p[i] = static_cast<float>(box.lo[i] + share[i] * (double(box.hi[i]) - box.lo[i]));
    return p;
}

void add_places(const Extent &box, Points &points) {
    for (const auto &share : shares) points.add(place_in(box, share));
}

double squared_slope(const std::array<std::vector<float>, 4> &slopes, std::size_t k) {
    double squares = 0;
    for (std::size_t i = 0; i < 3; ++i) squares += double(slopes[1 + i][k]) * slopes[1 + i][k];
    return squares;
}

// Whether a value so far from 0 may fall to it within a box, by its slope.
bool in_reach(double value, double squared_slope, const Extent &box) {
    constexpr double reach = 1.5; // diagonals
    double diagonal = 0;
    for (std::size_t i = 0; i < 3; ++i)
        diagonal += (double(box.hi[i]) - box.lo[i]) * (double(box.hi[i]) - box.lo[i]);
    return value * value <= reach * reach * squared_slope * diagonal;
}

// Those boxes whose middle is not far from surface: one place is soon looked at. What the others are.
std::vector<std::size_t> near_surface(Evaluator &evaluator, const cpu::ShortTape &tape,
                                      std::span<const Extent> boxes,
                                      std::vector<Sighting> &others) {
    Points points;
    for (const Extent &box : boxes) points.add(place_in(box, shares[0]));
    std::array<std::vector<float>, 4> slopes;
    gradients_at(evaluator, tape, points, slopes);
    std::vector<std::size_t> near;
    for (std::size_t n = 0; n < boxes.size(); ++n)
        if (const double squares = squared_slope(slopes, n);
            !(squares > 0) || in_reach(slopes[0][n], squares, boxes[n]))
            near.push_back(n);
        else
            others[n].seen = slopes[0][n] <= 0 ? Seen::AllSolid : Seen::AllEmpty;
    return near;
}

// Whether slopes have one direction at more than half of the places of a box, which begin at `from`.
bool rise_one_way(const std::array<std::vector<float>, 4> &slopes, std::size_t from) {
    constexpr double parallel = 0.9999;
    for (std::size_t first = from; first < from + places; ++first) {
        std::size_t alike = 0;
        for (std::size_t k = from; k < from + places; ++k) {
            double product = 0;
            for (std::size_t i = 1; i < slopes.size(); ++i)
                product += double(slopes[i][first]) * slopes[i][k];
            alike += product > 0 && product >= parallel * std::sqrt(squared_slope(slopes, first) *
                                                                    squared_slope(slopes, k));
        }
        if (2 * alike > places) return true;
    }
    return false;
}

// One box that may hold a seam as far as is known.
struct Suspect {
    std::size_t number = 0; // of the box
    bool solid = false;
    bool crossed = false;                       // it has surface,
    Point at{};                                 // since there is another sign
    float first = 0, nearest = 0;               // to 0 of all values: of the first step, and of all
    std::array<std::vector<float>, 3> planes{}; // as Sighting's, by the last step
};

// Where the field is 0 beyond a place, if it is as steep all the way and along an axis.
void guess_plane(const std::array<std::vector<float>, 4> &slopes, std::size_t k, const Point &at,
                 const Extent &box, double thin, Suspect &suspect) {
    constexpr double straight = 0.9999; // of a slope's square
    constexpr std::size_t most_planes = 2;
    const double squares = squared_slope(slopes, k);
    for (std::size_t i = 0; i < 3; ++i) {
        const double slope = slopes[1 + i][k];
        if (!(squares > 0) || slope * slope < straight * squares) continue;
        const auto guess = static_cast<float>(at[i] - slopes[0][k] / slope);
        std::vector<float> &planes = suspect.planes[i];
        if (guess > box.lo[i] && guess < box.hi[i] && planes.size() < most_planes &&
            std::ranges::none_of(planes,
                                 [&](float plane) { return std::fabs(plane - guess) < 8 * thin; }))
            planes.push_back(guess);
    }
}

// Takes one step from each place of a box towards 0, and beyond. False: it holds no seam.
bool step_in(const std::array<std::vector<float>, 4> &slopes, std::size_t from, int step,
             const Extent &box, double thin, Suspect &suspect, Points &points) {
    constexpr int few_steps = 3;
    constexpr double beyond = 1.5;   // of Newton's step
    constexpr float a_little = 0.8f; // than the nearest place at first
    float least = std::numeric_limits<float>::infinity();
    for (std::size_t k = from; k < from + places; ++k) {
        const float value = slopes[0][k];
        suspect.crossed = (value <= 0) != suspect.solid && std::fabs(value) > most_thin * thin;
        if (suspect.crossed) {
            suspect.at = points[k];
            return false;
        }
        least = std::min(least, std::fabs(value));
    }
    suspect.nearest = std::min(suspect.nearest, least);
    suspect.planes = {};
    for (std::size_t k = from; k < from + places; ++k)
        guess_plane(slopes, k, points[k], box, thin, suspect);
    if (step == few_steps && suspect.nearest > a_little * suspect.first) return false;
    for (std::size_t k = from; k < from + places; ++k) {
        const double squares = squared_slope(slopes, k);
        if (!(squares > 0)) continue;
        const double by = beyond * slopes[0][k] / squares;
        for (std::size_t i = 0; i < 3; ++i)
            points.at[i][k] = std::clamp(
                static_cast<float>(points.at[i][k] - by * slopes[1 + i][k]), box.lo[i], box.hi[i]);
    }
    return true;
}

// The places of the boxes that are left, one after the other.
void keep_places(const std::vector<std::size_t> &kept, Points &points) {
    for (std::vector<float> &axis : points.at) {
        for (std::size_t n = 0; n < kept.size(); ++n)
            std::copy_n(axis.begin() + static_cast<std::ptrdiff_t>(kept[n]), places,
                        axis.begin() + static_cast<std::ptrdiff_t>(n * places));
        axis.resize(kept.size() * places);
    }
}

} // namespace

std::vector<Sighting> look_for_seams(Evaluator &evaluator, const cpu::ShortTape &tape,
                                     std::span<const Extent> boxes, double thin) {
    constexpr int steps = 6;
    constexpr float nearer = 0.25f; // than the nearest place at first
    std::vector<Sighting> seen(boxes.size());
    const std::vector<std::size_t> near = near_surface(evaluator, tape, boxes, seen);
    Points points;
    for (const std::size_t n : near) add_places(boxes[n], points);
    std::vector<float> values;
    values_at(evaluator, tape, points, values);
    std::vector<Suspect> suspects;
    std::vector<std::size_t> kept; // where the places of those begin
    for (std::size_t n = 0; n < near.size(); ++n) {
        const std::span<const float> here = std::span(values).subspan(n * places, places);
        Suspect suspect{.number = near[n], .solid = here[0] <= 0};
        suspect.first = std::numeric_limits<float>::infinity();
        for (const float value : here) suspect.first = std::min(suspect.first, std::fabs(value));
        suspect.nearest = suspect.first;
        if (!std::ranges::all_of(here, [&](float v) { return (v <= 0) == suspect.solid; })) {
            const auto [low, high] = std::ranges::minmax_element(here);
            seen[near[n]].ends = {place_in(boxes[near[n]], shares[low - here.begin()]),
                                  place_in(boxes[near[n]], shares[high - here.begin()])};
            continue;
        }
        suspects.push_back(suspect);
        kept.push_back(n * places);
    }
    keep_places(kept, points);
    std::array<std::vector<float>, 4> slopes;
    for (int step = 0; step <= steps && !suspects.empty(); ++step) {
        gradients_at(evaluator, tape, points, slopes);
        kept.clear();
        std::vector<Suspect> left;
        for (std::size_t k = 0; k < suspects.size(); ++k) {
            if (step == 0) seen[suspects[k].number].one_way = rise_one_way(slopes, k * places);
            if (step_in(slopes, k * places, step, boxes[suspects[k].number], thin, suspects[k],
                        points)) {
                kept.push_back(k * places);
                left.push_back(suspects[k]);
            } else if (!suspects[k].crossed) {
                seen[suspects[k].number].seen = suspects[k].solid ? Seen::AllSolid : Seen::AllEmpty;
            } else {
                const Extent &box = boxes[suspects[k].number];
                seen[suspects[k].number].ends = {place_in(box, shares[0]), suspects[k].at};
            }
        }
        keep_places(kept, points);
        suspects = std::move(left);
    }
    for (Suspect &suspect : suspects) {
        Sighting &sighting = seen[suspect.number];
        sighting.seen = suspect.solid ? Seen::AllSolid : Seen::AllEmpty;
        if (suspect.nearest > nearer * suspect.first) continue;
        for (auto &planes : suspect.planes) std::ranges::sort(planes);
        sighting.seen = suspect.solid ? Seen::MaySolid : Seen::MayEmpty;
        sighting.planes = std::move(suspect.planes);
    }
    return seen;
}

void slopes_in(Evaluator &evaluator, const cpu::ShortTape &tape, const Extent &box,
               std::array<std::vector<float>, 4> &slopes) {
    Points points;
    add_places(box, points);
    gradients_at(evaluator, tape, points, slopes);
}

} // namespace fathom::mesh
