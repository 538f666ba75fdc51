// The GLSL functions named `fathom_…` that ops and the marcher need: ports of ir/semantics.h,
// ir/noise.h and ir/blends.h. They stand in helpers/*.glsl, each after a line
//   $helper NAME[:FORM] [needs NAME[:TYPE] …]
// FORM says for which types there is one:
//   (none)           only this one
//   int, float, …    for that type, under the same name as those for others
//   T                $T stands for float, vec2, vec3, vec4
//   each             written for floats; for vectors it is called component by component
#pragma once

#include "backend-glsl/module.h"

#include <vector>

namespace fathom::glsl {

// The texts of what was wanted and of all that these need, callees first.
std::string helper_text(const std::set<HelperKey> &wanted);

// Every helper, by name and form.
std::vector<HelperKey> helper_forms();

} // namespace fathom::glsl
