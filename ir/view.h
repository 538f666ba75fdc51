// Where a picture is taken from, and the numbers of one frame that the marchers share (shading.h says
// how they are used). Evaluates the scene's closed expressions (params and time only); knows no
// back end.
#pragma once

#include "ir/scene.h"

#include <array>
#include <glm/vec3.hpp>
#include <vector>

namespace fathom::ir {

// Right-handed: right x up = -forward. All three unit.
struct View {
    glm::dvec3 origin{}, right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1};
    double extent = 1; // perspective: tan(fov/2); orthographic: half the height of what is seen
    double focus = 1;  // how far away is what is looked at
    bool orthographic = false;
};

// The value of a closed expression (Const, Param, Time and what is made of them) at a time and with
// the params' present values; column-major, bools and ints as numbers. All zero for an invalid id.
std::array<double, 16> value_of(const Scene &scene, NodeId id, double time);

// From `position` towards `target`; up is y, or, looking along it, minus z (z when looking up).
View look_at(glm::dvec3 position, glm::dvec3 target, double extent, bool orthographic);

// Sets Scene::bounds, extent and far from what is known of its shapes, at the time 0.
void find_extent(Scene &scene);

// The scene's camera, or the rule of semantics.md, 23: from [3, 3, 5]'s direction, 45 degrees, as near
// as the solid fills nine tenths of the picture's height, or of its width, or of four thirds of its
// height where it is wider. `aspect`: width / height.
View view_of(const Scene &scene, double time, double aspect);

// How far a box reaches along a direction: the greatest product with a point of it.
double reach_of(const Box &box, const std::array<double, 3> &direction);

// The directions that decide how near that is: outward and towards the viewer, square to the sides of
// pictures of several widths. How far a solid reaches along each: Scene::framed_reach.
std::vector<std::array<double, 3>> framing_directions();

// Gone around what it looks at, in radians: about y, and upwards, where straight up and down are the
// ends; and `distance` times as far from it.
View turned(View view, double around, double above, double distance);

// The ray of a place in the picture, x and y in pixels from the top left (a pixel's middle is at
// +0.5):
//   u = (2x/width - 1) * width/height, v = 1 - 2y/height
//   perspective: origin, normalize(forward + extent*(u*right + v*up))
//   orthographic: origin + extent*(u*right + v*up), forward
// Sample k of a pixel stands at this offset in it: k = 0 in the middle, the others by the R2
// sequence (Roberts 2018: multiples of the plastic number's powers), so that any number of them is
// spread evenly and more can be added.
std::array<double, 2> sample_offset(int k);

// What shading.h calls by these names, for a picture `height` pixels high.
struct Frame {
    double slack = 0, pixel = 0;
    double tolerance_base = 0, tolerance_slope = 0; // tolerance(t) = base + slope*t
    double far = 0;    // render.far, or 100 * max(radius, distance from origin to centre)
    double radius = 1; // of the finite parts' bounding sphere; 1 when there are none
    // How far occlusion looks where Lighting does not say: shading.h's part of half the height that
    // is seen at the focus. So it follows what one looks at, and neither how the solid is written nor
    // a lawn around it matters.
    double occlusion_reach = 0;
    glm::dvec3 center{};
    bool boxed = false; // every part is finite: rays live between `lo` and `hi` alone (a little
                        // larger than the bounds)
    glm::dvec3 lo{}, hi{};
    bool unit_slope = false; // Scene::unit_slope
    bool exact = false;      // Scene::exact
    bool films = false;      // Scene::films; not with estimates, whose sign tells of no inside
    // Where some shape's bound is an estimate, of which nothing is known: the greatest bound of all
    // shapes, at least 1. Else 0.
    double estimate = 0;
};
Frame frame_of(const Scene &scene, const View &view, int height);

// How many evaluations a ray may take: render.max_steps, where it is set.
int budget_of(const Scene &scene);

// Scene::lights at a time; where there are none, white sun from the upper left behind `view`.
struct LightValue {
    bool directional = true;
    glm::dvec3 position{}, color{}; // directional: the unit vector towards the light
};
std::vector<LightValue> lights_of(const Scene &scene, double time, const View &view);

} // namespace fathom::ir
