// Before it reads a text, glslang makes tables of all built-in functions of the text's version: of
// 3.30 they take three times as long as of 1.30, and several times as long as a small shader. A text
// that says nothing that only one of them knows is therefore read as 1.30.
#pragma once

#include <optional>
#include <string>

namespace fathom::glsl {

// A fragment shader of "#version 330 core" as one of 1.30: valid only where `text` is. Nothing where
// that is not certain; where the result is not valid, nothing is said of `text`.
std::optional<std::string> for_small_tables(const std::string &text);

} // namespace fathom::glsl
