// A claim about a choice's border, proved by cases. Knows nothing of whole fields.
#pragma once

#include "ir/graph.h"
#include "proof/carried.h"
#include "proof/work.h"

#include <algorithm>
#include <vector>

namespace fathom::proof {

struct Ranges;

// `of` has one value for all sides of the choice (a Select, Sign or Step, or a comparison, which is
// true or false), where u = v and, with that comparison true or false, the choice's condition is
// not the same.
struct Claim {
    ir::NodeId of, choice;
    ir::NodeId comparison, u, v; // comparison: of a Select
};

// What proofs have looked at so far, and what they take their steps off.
struct Looked {
    Work &work;
    const Ranges *ranges; // of params and the time; or none
    int cases = 0, on_lines = 0;
    std::size_t left = 6'000'000; // steps of the algebra: beyond, nothing more is proved
    void take(std::size_t steps) {
        work.take(steps);
        left -= std::min(left, steps);
    }
    bool spent() const { return left == 0 || work.spent(); }
    Apart moved{};     // by what is granted, the field
    bool near = false; // a proof holds where no coordinate is above `near_enough` alone (on_line.h)
    // Of the last proof: which numbers, beside what the claim is of, it takes for equal on all sides
    // though they differ a little, and by how much.
    bool beside = false; // as of Granted
    Apart apart{};
    std::vector<Granted> places{};
    void begin() { beside = false, apart = {}, places.clear(); }
    bool granted() const { return beside || apart.back() > 0; }
};

// A number, or a comparison of such, that is made of signs, steps, truths and constants alone: it
// turns only where one of these does.
bool is_count(const ir::Graph &graph, ir::NodeId id);

// The same claim for a vector that the point is read through as if it were the point: claims of which
// each is enough. `reach`: what no coordinate of it is beyond, near enough to the origin (tape.h).
struct Inside {
    Claim claim;
    ir::NodeId vector;
    double reach;
};
std::vector<Inside> seen_from_inside(ir::Graph &graph, const Claim &claim);

// True is a proof; false is none. The second proves by what the sides are to each other alone, which
// is less, and takes few cases whatever else the field has.
bool is_proved(ir::Graph &graph, const Claim &claim, Looked &looked);
bool is_proved_alike(ir::Graph &graph, const Claim &claim, Looked &looked);

} // namespace fathom::proof
