// The GLSL functions named `fathom_…` that ops and the marcher need: ports of ir/semantics.h,
// ir/noise.h and ir/blends.h.
#pragma once

#include "backend-glsl/module.h"

namespace fathom::glsl {

// The texts of what was asked for and of all that these need, callees first.
std::string helper_text(const std::set<HelperKey> &wanted);

// In noise.cpp.
struct NoiseHelper {
    const char *name;
    std::vector<HelperKey> needs;
    const char *text;
};
const std::vector<NoiseHelper> &noise_library();
std::string hash_helper(const std::string &type);

} // namespace fathom::glsl
