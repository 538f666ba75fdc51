// Vectors that are turned: each component a sum of another vector's components times numbers, as
// rotations by any angle are, however they are written. Decided on expressions. Knows nothing of
// cells or slopes.
#pragma once

#include "ir/graph.h"

#include <functional>
#include <optional>
#include <unordered_set>
#include <vector>

namespace fathom::proof {

struct LinearMap {
    ir::NodeId of;                     // the vector v of M v + c
    double norm = 1;                   // a bound of M's spectral norm
    bool whole = false;                // M's rows are of one length and at right angles, as many as
                                       // v has components
    std::vector<ir::NodeId> constants; // what M and c are made of: holds where none of these varies
    // Where some of them do: M is made of the sine and the cosine of one angle that varies, and of
    // what does not, as c is.
    struct Turning {
        ir::NodeId angle;
        double norm = 1; // a bound of the spectral norm of dM/d angle
        // A bit a column: those of M, and those of dM/d angle, that are not 0.
        unsigned columns = 0, moving = 0;
    };
    std::optional<Turning> turning{};
};

// `vector` as M v + c; nothing where that is not seen. `varies` says which vectors may be v;
// `turned` holds those already known to be: they are not looked into.
std::optional<LinearMap> turned(ir::Graph &graph, ir::NodeId vector,
                                const std::function<bool(ir::NodeId)> &varies,
                                const std::unordered_set<ir::NodeId> &turned);

// A scalar that is one component of a vector turned: c x + s y, or c x - s y, with c and s the cosine
// and the sine of one angle. Nothing is looked into.
std::optional<LinearMap> turned_part(ir::Graph &graph, ir::NodeId scalar);

// The same for a matrix alone: a bound of its spectral norm, from M M^T.
std::optional<double> matrix_norm(ir::Graph &graph, ir::NodeId matrix);

} // namespace fathom::proof
