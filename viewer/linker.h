// Decides whether the graphics driver has to compile anything for a fresh shader, and has it do so
// where it must. The same text, or one that differs in literals that were edited before, keeps its
// program: only numbers go to the card. One for each kind of shader; needs a current context. Knows
// no window.
#pragma once

#include "render-gl/program.h"
#include "viewer/slots.h"

#include <string>

namespace fathom::viewer {

// A linked program and what it took.
struct Link {
    std::optional<gl::Program> program; // where one had to be made; else the one before goes on
    std::vector<float> edited;          // what stands in its slots
    double driver_ms = 0;
    std::string error; // of the driver, as printed
};

// Links texts of one kind of shader.
class Linker {
  public:
    Link link(const glsl::Output &output, const ir::Scene &scene);

  private:
    bool same_data(const glsl::Output &output, const ir::Scene &scene) const;

    bool linked_ = false;
    Slots slots_;
    std::size_t table_floats_ = 0;
    std::vector<ir::ImageData> images_; // that the program holds as textures
    std::vector<ir::GridData> grids_;
};

} // namespace fathom::viewer
