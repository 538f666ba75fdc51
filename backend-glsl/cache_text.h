// What the texts of the noise cache share: their numbers by name, and where a key lies. For
// cache.cpp and cache_passes.cpp alone.
#pragma once

#include "backend-glsl/cache.h"

#include <map>

namespace fathom::glsl {

using Values = std::map<std::string, std::string, std::less<>>;

Values cache_numbers();
std::string cache_hashing(); // fathom_cache_slot and fathom_cache_place
std::string
cache_known(); // bool fathom_known(ivec4 key), by fathom_cache_index and what hashing wants

} // namespace fathom::glsl
