/** @file
 *  The parts that a scene lists, by name, and each of them as a scene of its own.
 *
 *  @code
 *  #include <fathom/parts.h>
 *  #include <cstdio>
 *
 *  int main() {
 *      const auto result = fathom::compile_text(
 *          "pair.sdf", "sphere(1)\nbox(1).translate(x: 3)\nbox(2).translate(x: 6)\n");
 *      if (!result) return 1;
 *      for (const fathom::Part &part : fathom::parts_of(*result.scene))
 *          std::printf("%s, line %d\n", part.name.c_str(), part.at.line);
 *      const auto second = fathom::part_of(*result.scene, "box#2");
 *      return second ? 0 : 1;
 *  }
 *  @endcode
 */
#pragma once

#include <fathom/scene.h>

namespace fathom::FATHOM_V1 {

/** What one statement of a scene gives: one shape, or all shapes of a list or of a loop's passes. */
struct Part {
    /** The first word of the statement: the name that a `let` or a `fn` gave it, or the library's.
     *  The second of a name is `name#2`, and so on. `part` where it begins with no word. */
    std::string name;
    Place at;
};

/** In the order of the text. Empty without memory for them. */
FATHOM_API std::vector<Part> parts_of(const Scene &scene) noexcept;

/** The scene with that part alone, where and as it stands in the whole. Nothing where there is no part
 *  of that name, or no memory for it. */
FATHOM_API std::optional<Scene> part_of(const Scene &scene, std::string_view name) noexcept;

} // namespace fathom::FATHOM_V1
