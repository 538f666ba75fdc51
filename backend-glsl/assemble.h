// The scene's own part of a text: data, helpers, functions, materials, lights. Knows no target.
#pragma once

#include "backend-glsl/module.h"

namespace fathom::glsl {

struct SceneText {
    std::string tables;    // constants, where the data stands in the text
    std::string functions; // helpers, the scene's functions, `sdf`
    std::string
        shading; // fathom_hit, fathom_material, fathom_lighting, fathom_light, fathom_background
    bool local_normals = false;
    int lights = 0;
};

// Some functions of the scene and what they need, and nothing else.
SceneText assemble_functions(Module &module, std::span<const ir::FunctionId> wanted);

// `with_shading`: also what shading needs beyond the materials.
SceneText assemble(Module &module, bool with_shading);

} // namespace fathom::glsl
