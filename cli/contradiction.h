// What the options of one command cannot mean together, or what nothing would read.
#pragma once

#include "cli/command.h"

#include <functional>
#include <string>

namespace fathom::cli {

// Whether an option was given, by its name.
using Given = std::function<bool(const char *option)>;

// What is wrong, and what to write; empty where nothing is.
std::string contradiction(const Command &command, const Given &given);

} // namespace fathom::cli
