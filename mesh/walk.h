// Boxes of space that are in a solid, out of it, or open, and what they add up to: the open ones are
// divided until they say what the solid measures in them (docs/measure.md, 1 and 2).
#pragma once

#include "mesh/measure.h"

#include <limits>

namespace fathom::mesh {

inline constexpr double unbounded = std::numeric_limits<double>::infinity();
inline constexpr double rounding_share = 1e-9; // of a sum, by the size of its terms

struct Block {
    Point lo, hi;
};

// What cells add up to. Moments are about a middle; an open cell's part of the solid is anything
// from none of it to all.
struct CellSums {
    double inside = 0, open = 0;
    Real3 moment{}, least_moment{}, most_moment{}; // of what is inside; of what is open
    double sizes = 0;                              // of all moments' terms
    double least_area = 0, most_area = 0;
    std::size_t open_places = 0; // boxes of which no greatest area is known, and the first of them
    Real3 open_place{};
    bool looked = true; // at slopes: else all that is open is an open place
    Real3 outer_lo{unbounded, unbounded, unbounded}, outer_hi{-unbounded, -unbounded, -unbounded};
    Real3 known_lo = outer_lo, known_hi = outer_hi; // of points that are in the solid

    void know(const Point &lo, const Point &hi) {
        for (std::size_t i = 0; i < 3; ++i) {
            known_lo[i] = std::min<double>(known_lo[i], lo[i]);
            known_hi[i] = std::max<double>(known_hi[i], hi[i]);
        }
    }
    void add(const Point &lo, const Point &hi, Space space, const Real3 &middle) {
        if (space == Space::Outside) return;
        double volume = 1;
        for (std::size_t i = 0; i < 3; ++i) {
            volume *= double(hi[i]) - lo[i];
            outer_lo[i] = std::min<double>(outer_lo[i], lo[i]);
            outer_hi[i] = std::max<double>(outer_hi[i], hi[i]);
        }
        for (std::size_t i = 0; i < 3; ++i) {
            const double a = lo[i] - middle[i], b = hi[i] - middle[i];
            sizes += volume * std::max(std::fabs(a), std::fabs(b));
            if (space == Space::Inside) moment[i] += volume * 0.5 * (a + b);
            if (space == Space::Open) {
                least_moment[i] += volume * std::min(a, 0.0);
                most_moment[i] += volume * std::max(b, 0.0);
            }
        }
        (space == Space::Inside ? inside : open) += volume;
        if (space == Space::Inside) know(lo, hi);
    }
    // An open cell of which so much is inside, between two shares.
    void add_part(const Point &lo, const Point &hi, double least, double most,
                  const Real3 &middle) {
        double volume = 1;
        for (std::size_t i = 0; i < 3; ++i) {
            volume *= double(hi[i]) - lo[i];
            outer_lo[i] = std::min<double>(outer_lo[i], lo[i]);
            outer_hi[i] = std::max<double>(outer_hi[i], hi[i]);
        }
        inside += least * volume, open += (most - least) * volume;
        for (std::size_t i = 0; i < 3; ++i) {
            const double a = lo[i] - middle[i], b = hi[i] - middle[i];
            sizes += volume * std::max(std::fabs(a), std::fabs(b));
            least_moment[i] += volume * a * (a < 0 ? most : least);
            most_moment[i] += volume * b * (b > 0 ? most : least);
        }
    }
    void add_open_place(const Point &lo, const Point &hi) {
        for (std::size_t i = 0; open_places == 0 && i < 3; ++i)
            open_place[i] = 0.5 * (double(lo[i]) + hi[i]);
        ++open_places;
    }
    void add(const CellSums &other) {
        inside += other.inside, open += other.open, sizes += other.sizes;
        least_area += other.least_area, most_area += other.most_area;
        if (open_places == 0) open_place = other.open_place;
        open_places += other.open_places;
        looked = looked && other.looked;
        for (std::size_t i = 0; i < 3; ++i) {
            moment[i] += other.moment[i];
            least_moment[i] += other.least_moment[i];
            most_moment[i] += other.most_moment[i];
            outer_lo[i] = std::min(outer_lo[i], other.outer_lo[i]);
            outer_hi[i] = std::max(outer_hi[i], other.outer_hi[i]);
            known_lo[i] = std::min(known_lo[i], other.known_lo[i]);
            known_hi[i] = std::max(known_hi[i], other.known_hi[i]);
        }
    }
};

// One thread's memory.
struct Splitter {
    explicit Splitter(const Field &field) : evaluator(field) {}
    Evaluator evaluator;
    bool by_zeros = false; // of the leaf at hand no slopes are known, but where it is 0
    cpu::Boxes boxes;
};

// What a walk over open boxes goes by.
struct Walk {
    Real3 middle{};           // of moments
    double ulp = 0, thin = 0; // seam_thickness
    bool flat = false;        // nothing changes along z: boxes are divided across x and y alone
    int by_planes = 0, by_dividing = 0; // how often they are divided
    int spare = 0;                      // boxes of a leaf that are divided more often
    bool looks = true;                  // at slopes
    double followed = 0;                // steps of loops at a look
};

// The parts of each of some open boxes, by halves: those that stay open. What the others add is added.
// `graph`: that they are in.
std::vector<Block> divided(Splitter &splitter, const cpu::ShortTape &tape,
                           const std::vector<Block> &whole, const Walk &walk, CellSums &sums,
                           Graph *graph = nullptr);

// A tape that holds in a box, shorter than the one that it was made of.
TapePtr tape_in(Splitter &splitter, const TapePtr &tape, const Block &piece);

// A box that may hold surface, and a tape that holds in it.
struct OpenBlock {
    Block piece;
    TapePtr tape;
};

// What open boxes add, by a walk without levels, which are chosen as the effort allows.
CellSums sums_of_open(const Field &field, const std::vector<OpenBlock> &open, Walk walk,
                      unsigned threads, Progress &progress, const MeasureEffort &effort);

// What is enclosed by that. `middle`: that of the moments. Without `used_bound`.
Measures measures_of(const CellSums &sums, const Real3 &middle);

} // namespace fathom::mesh
