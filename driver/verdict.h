// What `check` says of a whole scene (semantics.md, 19), for people and as the JSON document of the
// command line. Knows nothing of commands.
#pragma once

#include "driver/compile.h"

#include <optional>
#include <string>
#include <string_view>

namespace fathom::driver {

// The facts of a checked scene that a verdict states.
struct Verdict {
    std::optional<double> lipschitz; // the largest before division among the top-level shapes;
                                     // none: no shape, no bound
    ir::ProofStatus status = ir::ProofStatus::Proved; // the worst
    bool exact = true;                                // only if all are
};

Verdict judge(const ir::Scene &scene); // of a good compilation
// `proved`, `assumed` or `estimated`.
std::string_view status_name(ir::ProofStatus status);
std::string verdict_json(const Compilation &compilation); // with its line end

} // namespace fathom::driver
