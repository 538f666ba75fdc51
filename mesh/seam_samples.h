// Which boxes are worth a search for seams (seams.h), by samples: nothing is proved by them. Most boxes
// that ranges do not decide hold surface, or are only loosely known.
#pragma once

#include "mesh/field.h"

#include <optional>
#include <span>

namespace fathom::mesh {

// A box between two corners.
struct Extent {
    Point lo{}, hi{};
};

// What samples in a box say: that it has surface; that it may be solid but for gaps, or empty but for
// sheets; or that all of it is solid, or empty, and far from 0.
enum class Seen : std::uint8_t { NoSeam, MaySolid, MayEmpty, AllSolid, AllEmpty };

struct Sighting {
    Seen seen = Seen::NoSeam;
    // Along each axis: where planes at right angles to it seem to lie.
    std::array<std::vector<float>, 3> planes{};
    // Two places of different signs, where it has surface.
    std::optional<std::array<Point, 2>> ends{};
    // The field rises in one direction at more than half of the samples: it may depend on one number.
    bool one_way = false;
};

// `thin`: of slabs, as in seam_in. The boxes share the runs of the tape, which holds in all of them.
std::vector<Sighting> look_for_seams(Evaluator &evaluator, const cpu::ShortTape &tape,
                                     std::span<const Extent> boxes, double thin);

// The slopes at those samples, of one box.
void slopes_in(Evaluator &evaluator, const cpu::ShortTape &tape, const Extent &box,
               std::array<std::vector<float>, 4> &slopes);

} // namespace fathom::mesh
