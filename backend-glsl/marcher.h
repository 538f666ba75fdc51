// The frame code in GLSL: camera ray, march, shading, output; ir/shading.h line by line. Knows the
// scene only as the functions
//   float sdf(vec3), where it has_safe_radius farther than its ball vec2 fathom_safe_radius(vec3), Hit
//   fathom_hit(vec3), fathom_Material fathom_material(Hit, vec3 local normal), fathom_Lighting
//   fathom_lighting(), fathom_Light fathom_light(int), vec3 fathom_background(vec3)
// and the host as these inputs (uniforms; where a target has no host of ours, globals that its main
// sets):
//   vec2 fathom_resolution   the whole picture's size in pixels
//   vec2 fathom_offset       the sample's place in the pixel, from its top left, 0..1
//                            (ir::sample_offset)
//   vec3 fathom_origin, fathom_right, fathom_up, fathom_forward; float fathom_extent, fathom_focus;
//   int fathom_orthographic  ir::View
//   vec3 fathom_sun          towards the default sun, where the scene has no light
//   float fathom_time        seconds
//   int fathom_mode          0 the picture, sRGB; 1 steps as a heat map; 2 (steps, t, paint, hit) as
//                            numbers; 3 linear colour
#pragma once

#include <string>

namespace fathom::glsl {

struct MarcherOptions {
    bool boxed = false; // rays live between FATHOM_LO and FATHOM_HI
    bool steep = false; // ir::steep
    bool has_safe_radius =
        false;          // the field says how far it has_safe_radius; only where it is steep
    bool cheap = false; // the field is a few operations
    bool skip_shading = false;
    bool local_normals = false; // some material reads its normal
    bool default_sun = false;
    bool pick = false;      // writes fathom_pick too (emit.h)
    bool cached = false;    // some field is read through the noise cache (cache.h)
    bool far_cells = false; // rays may call `fathom_clear` (prune.h)
    bool around = false; // outside of the cells the field may be less than the distance (prune.h)
    int lights = 0;
    int max_steps = 256;
    double epsilon = 5e-4;
    double far = 0; // 0: by the rule
    double radius = 1;
    std::string center, lo, hi; // GLSL text
    std::string zero;           // an int 0 that the compiler cannot know to be 0
};

std::string marcher_text(const MarcherOptions &options);

// A shader that shows the field itself and not a picture of it, for the viewer's analysis. It knows
// nothing of materials and lights, and writes as fathom_pick
//   fathom_mode 4, the slice: (distance, t, 0, 1) where the ray meets the plane fathom_plane (unit
//                  normal, offset), else 0
//   fathom_mode 5, the check of steps: (verdict, t of the march, t of the check, steps). Verdict 0:
//                  they agree; 1: the march passed a surface; 2: the march ran out of steps; 3: the
//                  check did
std::string probe_text(const MarcherOptions &options);

} // namespace fathom::glsl
