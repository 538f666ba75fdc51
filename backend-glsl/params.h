// What a text says of its inputs in words: the defaults that its language cannot hold, and the
// params that stand in it as constants. Knows nothing of how expressions are written.
#pragma once

#include "backend-glsl/emit.h"

namespace fathom::glsl {

// A param's value and range as the language writes them: `3`, `[0.5, 1, 2]`; `1..6`, or nothing
// where it has no range.
std::string value_text(const ir::Param &param);
std::string range_text(const ir::Param &param);

// A comment that names each structural param with its value, range and place; empty where there
// are none. `place` gives one line, or nothing.
std::string fixed_params_comment(const ir::Scene &scene,
                                 const std::function<std::string(Span)> &place);

// A uniform as it is declared, and what a host sets it to for the scene's first view.
struct Default {
    std::string type, name, value, range;
};

// A comment that lists them, for languages whose uniforms have no initialisers.
std::string defaults_comment(const std::vector<Default> &defaults);

} // namespace fathom::glsl
