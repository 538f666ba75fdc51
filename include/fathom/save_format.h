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

struct ImportOptions {
    bool strict = false;      /**< what is wrong in the content is an error, not a warning */
    std::string asset_prefix; /**< put before the relative paths of textures and grids: the way from
                                   the text's folder to the save file's ("../saves/") */
    /** Where the text will stand. Then what of the save file no compiler takes (a grid that is not
     *  there) is left out alone; files that the scene names are read for that. Empty: not tried. */
    std::filesystem::path scene;
};

struct Imported {
    std::string text;      /**< of the language; what could be read, where it is not complete */
    bool complete = false; /**< the file's structure was sound */
    std::vector<Diagnostic> diagnostics;
    std::size_t dropped = 0; /**< diagnostics beyond the most that are kept */
    std::size_t nodes = 0;   /**< of the scene's tree, that were read */
    Texts texts{};
};

/** `strict`: what is wrong in the content is an error instead of a warning. */
FATHOM_API Imported import_yaml(std::string_view name, std::string_view yaml, bool strict = false);
FATHOM_API Imported import_yaml(std::string_view name, std::string_view yaml,
                                const ImportOptions &options);

struct ExportOptions {
    /** Where the text will stand. Then paths of images and grids are written as seen from there,
     *  with a warning for each that lies outside of its folder. Empty: as the scene has them. */
    std::filesystem::path out;
};

/** The scene at the present values of its params and at time 0; empty where it takes more than the
 *  limits that the scene was compiled with, which is among the diagnostics. */
FATHOM_API std::string export_yaml(const Scene &scene,
                                   std::vector<Diagnostic> *diagnostics = nullptr);
FATHOM_API std::string export_yaml(const Scene &scene, const ExportOptions &options,
                                   std::vector<Diagnostic> *diagnostics = nullptr);

} // namespace fathom::FATHOM_V1
