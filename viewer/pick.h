// What a pixel's part is to its user: the words that made it, where they stand, its bound, where it
// lies. Reads a compiled scene; knows no window and no GL.
#pragma once

#include "driver/compile.h"
#include "ir/view.h"

#include <string>

namespace fathom::viewer {

struct Part {
    int number = 0;    // 0: none
    std::string words; // "box(2).at(X)", one line of them
    std::string file;  // as compiled
    std::uint32_t line = 0, column = 0;
    double lipschitz = 1;
    ir::ProofStatus status = ir::ProofStatus::Proved;
    ir::FieldKind kind = ir::FieldKind::Bound;
};

Part part_of(const driver::Compilation &compilation, int number);

// The same part in a scene that was compiled anew: the same words on the same line, else the same
// words, else the same line; number 0 where there is none.
Part found_again(const driver::Compilation &compilation, const Part &part);

// A box in the world that holds the part wherever it stands (empty: it does not, or fills no finite
// box).
ir::Box world_box(const ir::Scene &scene, ir::ShapeId part, double time);

std::string part_line(const Part &part); // "box(2).at(X) | L 1 proved, exact | scene.sdf:3"

} // namespace fathom::viewer
