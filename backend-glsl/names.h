// Names of the emitted text: the user's own where GLSL allows them, unique, never a reserved word.
#pragma once

#include <string>
#include <string_view>
#include <unordered_set>

namespace fathom::glsl {

// A keyword, reserved word, type or built-in of GLSL 4.50 or GLSL ES 3.00, or a name that a
// target's host declares.
bool is_reserved(std::string_view name);

// One scope's names. A local scope is a copy of the global one: locals never hide what they might
// have to call.
class Names {
  public:
    // `wanted`, made legal (ASCII letters, digits, no `__`, no `gl_` or `fathom_` in front) and
    // unique (`_2`, `_3`, …).
    std::string unique(std::string_view wanted);
    // `prefix` with the first number that is free: f1, f2, …
    std::string numbered(char prefix);

  private:
    std::unordered_set<std::string> taken_;
    int next_ = 1;
};

} // namespace fathom::glsl
