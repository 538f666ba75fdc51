/** @file
 *  The YAML save format, both ways. Nothing is lost without a diagnostic.
 *
 *  @code
 *  #include <fathom/save_format.h>
 *  #include <cstdio>
 *
 *  int main() {
 *      const auto result = fathom::compile_text("ball.sdf", "sphere(1)\n");
 *      if (!result) return 1;
 *      const std::string yaml = fathom::export_yaml(*result.scene);
 *      const fathom::Imported back = fathom::import_yaml("ball.yaml", yaml);
 *      std::printf("%s", back.text.c_str());
 *      return back.complete ? 0 : 1;
 *  }
 *  @endcode
 */
#pragma once

#include <fathom/scene.h>

namespace fathom::FATHOM_V1 {

struct Imported {
    std::string text;      /**< of the language; what could be read, where it is not complete */
    bool complete = false; /**< the file's structure was sound */
    std::vector<Diagnostic> diagnostics;
};

/** `strict`: what is wrong in the content is an error instead of a warning. */
FATHOM_API Imported import_yaml(std::string_view name, std::string_view yaml, bool strict = false);

/** The scene at the present values of its params and at time 0. */
FATHOM_API std::string export_yaml(const Scene &scene,
                                   std::vector<Diagnostic> *diagnostics = nullptr);

} // namespace fathom::FATHOM_V1
