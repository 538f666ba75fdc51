// The numbers that the templates of the noise cache share, by name. For cache.cpp and
// cache_passes.cpp alone.
#pragma once

#include "backend-glsl/cache.h"
#include "backend-glsl/template.h"

namespace fathom::glsl {

Values cache_numbers();

} // namespace fathom::glsl
