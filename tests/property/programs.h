// Random programs that are well typed by construction: what the tests of the whole compiler are fed
// with. Knows the language as its pages describe it, nothing of the compiler. One build gives the
// same text for the same seed.
#pragma once

#include <string>

namespace programs {

// A whole scene: functions, parameters, loops, lists, shapes, fields, materials, settings.
std::string scene(unsigned seed);

// `fn f(a: float, b: vec3, n: int) -> float { … }` with the functions that it calls: it may be
// called at scene time and at field time alike.
std::string function(unsigned seed);

} // namespace programs
