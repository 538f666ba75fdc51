// What is said of a file that makes no shape. Private to typecheck.
#pragma once

#include "typecheck/interpreter.h"

namespace fathom::typecheck {

// Names the shape or the field that the file declares, with the line that draws it. `frame` is that of
// the file's names.
void report_no_shape(Interpreter &ev, const File &ast, std::uint32_t frame);

} // namespace fathom::typecheck
