// Templates: the files of backend-glsl/templates, built into the program. A template is GLSL (or
// a page's HTML, style and script) with holes and directives:
//   $NAME          a hole; what fills it is not looked through again. Where it has a line to
//                  itself, it stands for whole lines, or none
//   $if NAME       the lines up to $else or $end, where NAME is filled by some text; `$if !NAME`
//                  where it is filled by none. They nest
//   $include name  another template's lines
//   $# …           a remark that is left out
// A directive has its line to itself. `tests/unit/glsl` compiles each GLSL template on its own.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace fathom::glsl {

// What fills the holes, by name. A flag is a name that is filled by "1" or by nothing.
using Values = std::map<std::string, std::string, std::less<>>;

// The template whose file has this name before its end, filled. Every name that it reads has to be among the values.
std::string expand(std::string_view name, const Values &values);

// Text of one's own, filled alike; without directives.
std::string fill(std::string_view form, const Values &values);

// The names of all templates that are GLSL.
std::vector<std::string_view> template_names();

} // namespace fathom::glsl
