// The frame code in GLSL: camera ray, march, shading, output; ir/shading.h line by line. Knows the
// scene only as the functions
//   float sdf(vec3), where it has_safe_radius farther than its ball vec2 fathom_safe_radius(vec3),
//   where it is not what points are shaded by float fathom_shaded(vec3), Hit fathom_hit(vec3),
//   fathom_Material fathom_material(Hit, vec3 local normal), fathom_Lighting
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
//                            numbers, hit 0 a miss, 1 a hit, 2 undecided; 3 linear colour
//
// A text with `passes` is for a host of ours that draws a picture by passes (render-gl/passes.h): a
// draw takes at most fathom_turns steps a ray, and what a ray that is not done needs to go on is
// written beside the picture (march.glsl says what). There, and where a host draws through the noise
// cache, the alpha of an undecided ray is 0.5; by passes that of a ray that came close to something
// on its way (ir/shading.h, CLOSE) is 0.875. Every other text has one pass, and as many
// steps a ray as `max_steps`: a ray that has no more is undecided, and drawn as what it is nearest
// to.
#pragma once

#include <string>

namespace fathom::glsl {

struct MarcherOptions {
    bool boxed = false;           // rays live between FATHOM_LO and FATHOM_HI
    bool unit_slope = false;      // Scene::unit_slope
    bool exact = false;           // Scene::exact
    bool films = false;           // Scene::films
    bool shaded_apart = false;    // Scene::shaded is not the distance
    bool has_safe_radius = false; // the field says how far it has_safe_radius
    bool passes = false;          // a picture is drawn by passes
    bool four_outputs = false;    // … whose host has no more outputs than four
    bool cheap = false;           // the field is a few operations
    bool skip_shading = false;
    bool classic = false;       // Lighting::classic
    bool local_normals = false; // some material reads its normal
    bool default_sun = false;
    bool pick = false;      // writes fathom_pick too (emit.h)
    bool cached = false;    // some field is read through the noise cache (cache.h)
    bool far_cells = false; // rays may call `fathom_clear` (prune.h)
    bool around = false; // outside of the cells the field may be less than the distance (prune.h)
    int lights = 0;
    int max_steps = 256; // a ray, of the eye or of a light, where there are no passes
    double epsilon = 5e-4;
    double far = 0;      // 0: by the rule
    double estimate = 0; // Frame::estimate
    double radius = 1;
    std::string center, lo, hi; // GLSL text
    std::string zero;           // an int 0 that the compiler cannot know to be 0
};

std::string marcher_text(const MarcherOptions &options);

// How many steps a ray may take in a picture of one pass: 64 * bound * ln(lengths), between 256 and
// 65,536, where Mesa's llvmpipe ends a shader's loops. `bound`: the largest slope that was proved;
// `lengths`: how many tolerances long the way through the scene is. A ray that meets a plane head on
// comes nearer by the factor 1 - 1/bound with each step, so that bound * ln(lengths) steps are what
// it needs; 64 times that is for those which graze surfaces on their way.
int steps_in_one_pass(double bound, double lengths);

// A shader that shows the field itself and not a picture of it, for the viewer's analysis. It knows
// nothing of materials and lights, and writes as fathom_pick
//   fathom_mode 4, the slice: (distance, t, 0, 1) where the ray meets the plane fathom_plane (unit
//                  normal, offset), else 0
//   fathom_mode 5, the check of steps: (verdict, t of the march, t of the check, steps). Verdict 0:
//                  they agree; 1: the march passed a surface; 2: the march is undecided; 3: the
//                  check ran out of steps
std::string probe_text(MarcherOptions options);

} // namespace fathom::glsl
