// A text's fields as subroutines of GL 4.0, for NVIDIA's compiler: it writes a function out at each
// of its calls, and links a text with three calls of a large field in up to 18 s; one that it has
// to call is compiled once. docs/performance.md (On a card) has figures. Needs a current context.
#pragma once

#include <string>
#include <vector>

namespace fathom::gl {

bool wants_subroutines(); // whether the driver is NVIDIA's, with GL 4.0

// The text with `sdf`, `fathom_safe_radius` and `fathom_shaded`, where it has them, as subroutine
// uniforms of one subroutine each. No other function is: that driver computes wrong what calls a
// subroutine from within one (580.159).
std::string with_subroutines(const std::string &text);

// The fragment shader's subroutines by location of their uniforms, as glUniformSubroutinesuiv
// wants them each time that the program has become current. Empty where it has none.
std::vector<unsigned> subroutines_of(unsigned program);

} // namespace fathom::gl
