// What a pixel's part is to its user: the words that made it, where they stand, its bound, where it
// lies. Reads a compiled scene; knows no window and no GL.
#pragma once

#include "driver/compile.h"
#include "ir/view.h"

#include <string>

namespace fathom::viewer {

// What is shown about the part under the pointer.
struct Part {
    int number = 0;    // 0: none
    std::string words; // "box(2).at(X)", one line of them
    Span place;        // of the words, in the compilation's sources
    std::string file;  // to open: as compiled; of an imported text the file that it was made from
    std::uint32_t line = 0, column = 0; // in that file; 0 where the words do not stand in it
    double lipschitz = 1;
    ir::ProofStatus status = ir::ProofStatus::Proved;
    ir::FieldKind kind = ir::FieldKind::Bound;
};

// The part of that number; empty where there is none.
Part part_of(const driver::Compilation &compilation, int number);

// The part whose words are the fewest that hold a byte of a file's text; number 0 where none does.
Part part_at(const driver::Compilation &compilation, const std::string &file, std::uint32_t byte);

// The same part in a scene that was compiled anew: on the line that was the part's before the edit
// (lines_after), by its words, else by its turn there. Where that line has gone, the same words on
// a line that is new; number 0 where there are none or several.
Part found_again(const driver::Compilation &before, const Part &part,
                 const driver::Compilation &now);

// A box in the world that holds the part wherever it stands (empty: it does not, or fills no finite
// box).
ir::Box world_box(const ir::Scene &scene, ir::ShapeId part, double time);

std::string place_of(const Part &part);  // "scene.sdf:3"
std::string part_line(const Part &part); // "box(2).at(X) | L 1 proved, exact | scene.sdf:3"

} // namespace fathom::viewer
