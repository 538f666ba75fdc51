// What the commands that draw share. They stand on the driver still, and not on the library's API as
// the others do (docs/architecture.md).
#pragma once

#include "cli/terminal.h"
#include "driver/compile.h"

namespace fathom::cli {

driver::CompileOptions compile_options(const SceneArguments &scene);
// Proved for what is drawn: the params' values as given, and these times, in seconds.
driver::CompileOptions compile_options(const SceneArguments &scene, double first, double last);

// Prints all diagnostics, and what else keeps a compilation from being good, and says how the
// command ends.
Exit report(const driver::Compilation &compilation, const SceneArguments &scene,
            Terminal &terminal);
bool in_proved_time(const ir::Scene &scene, double first, double last, Terminal &terminal);
void print_diagnostics(const Diagnostics &diagnostics, const Sources &sources, Terminal &terminal);

// Whether `out` is a file that the scene reads; says so.
bool overwrites(const driver::Compilation &compilation, const std::string &out, Terminal &terminal);

} // namespace fathom::cli
