// A scene cut open, for pictures of what is inside.
#pragma once

#include "ir/scene.h"

#include <limits>

namespace fathom::ir {

// What is kept lies between two planes across an axis; an infinite one cuts nothing off.
struct Section {
    int axis = 2;
    double from = -std::numeric_limits<double>::infinity();
    double to = std::numeric_limits<double>::infinity();
};

// Of a scene that is built and not yet proved: its solid is the part of it that is kept, and the
// faces of the cut have a colour of their own. As `solid & plane(…).paint(#e5793f)` does.
void cut_open(Scene &scene, const Section &section);

} // namespace fathom::ir
