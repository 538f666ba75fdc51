// What differs between two texts, as `diff -u` writes it, so that `patch` and people can read it.
#pragma once

#include <string>
#include <string_view>

namespace fathom::cli {

// With three lines around each change; empty where the texts are equal. Both sides bear the name.
std::string unified_diff(std::string_view name, std::string_view before, std::string_view after);

} // namespace fathom::cli
