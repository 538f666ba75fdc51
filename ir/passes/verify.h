// The rules that a lowered scene obeys on its way to a back end: argument order, types, payloads in
// range, no free variables, no Point in functions, … In comes a lowered scene, out go words. It
// never repairs, and sees no shapes.
#pragma once

#include "ir/scene.h"

#include <string>

namespace fathom::ir {

// The first broken rule in words, or an empty string. For assertions and tests.
std::string verify(const Scene &scene);

} // namespace fathom::ir
