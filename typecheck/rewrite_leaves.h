// A shape's tree made anew with something done to each of its base shapes: how an image comes to
// lie on a whole scene by the natural parametrisation of its parts. Private to typecheck; knows
// nothing of images.
#pragma once

#include "typecheck/interpreter.h"

#include <functional>
#include <tuple>

namespace fathom::typecheck {

// A line of the plane: a point of it, and its direction (0: there is none, or it is not known). One
// side of it is meant: that to the right, or, below maps that mirror, to the left.
struct Line {
    std::array<double, 2> at{}, along{};
    bool left = false;
    bool known() const { return along[0] != 0 || along[1] != 0; }
    friend bool operator==(const Line &, const Line &) = default;
    friend bool operator<(const Line &a, const Line &b) {
        return std::tie(a.at, a.along, a.left) < std::tie(b.at, b.along, b.left);
    }
};

// Where a base shape stands below the shape that is rewritten.
struct Below {
    bool inverted = false; // below an odd number of complements: its outside is the whole's inside
    ir::NodeId factor;     // its lengths times this are those of the whole
    Line axis{};           // the line that was given with the whole, in the base shape's own space
};

// A base shape is one of the library's solids, an extruded or turned flat shape, a flat shape, or a
// field of the user's own. `rewrite` gives what shall stand in its place.
using RewriteLeaf = std::function<ir::ShapeId(ir::ShapeId, const Below &)>;

// Whether the paint of a rewritten shape stays.
enum class Paints : std::uint8_t {
    Keep,
    KeepWhole,
    Strip
}; // KeepWhole: what is painted already is left as it is

ir::ShapeId rewrite_leaves(Interpreter &ev, ir::ShapeId shape, Paints paints,
                           const RewriteLeaf &rewrite, Line axis = {});

} // namespace fathom::typecheck
