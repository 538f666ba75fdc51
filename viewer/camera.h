// The viewer's camera: turns round a target, without roll. Knows no window and no scene's text.
#pragma once

#include "ir/view.h"

#include <string>

namespace fathom::viewer {

// A point of view on a sphere round the target; angles in radians.
struct Camera {
    glm::dvec3 target{};
    double yaw = 0, pitch = 0; // of the eye as seen from the target: yaw 0 on +z, pitch up; radians
    double distance = 5;
    double slope = 0.4142135623730951; // tan(fov/2)
    bool orthographic = false;
    friend bool operator==(const Camera &, const Camera &) = default;
};

// The standard views of the keys.
enum class Side { Front, Right, Top };

// The orbit camera that sees what a view sees, roll apart.
Camera camera_of(const ir::View &view);
ir::View view_of(const Camera &camera);

// Drags, in fractions of the window's height.
void orbit(Camera &camera, double dx, double dy);
void pan(Camera &camera, double dx, double dy);
void dolly(Camera &camera, double steps); // > 0 nearer
void fly(Camera &camera,
         const glm::dvec3 &by); // right, up, forward, in units of the distance to the target
void look_from(Camera &camera, Side side);
void frame(Camera &camera, const glm::dvec3 &center, double radius, double aspect);

// `camera(at: […], look_at: […], fov: …deg)`: a line to paste into the scene.
std::string camera_line(const Camera &camera);

// How far apart isolines stand: 1, 2 or 5 times a power of ten, about twelve from the middle of the
// picture to its edge.
double isoline_step(const Camera &camera);

} // namespace fathom::viewer
