// The pages of docs/diagnostics, built into the program (cmake/embed.cmake).
#pragma once

#include <string_view>
#include <utility>
#include <vector>

namespace fathom::driver {

// ("unknown-name.md", its text), one a code.
const std::vector<std::pair<std::string_view, std::string_view>> &diagnostic_pages();

} // namespace fathom::driver
