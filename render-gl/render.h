// Off-screen pictures of a scene: emits, builds, draws strip by strip, reads back. Needs a current
// context.
#pragma once

#include "base/diagnostic.h"
#include "base/picture.h"
#include "render-gl/passes.h"

#include <functional>
#include <optional>

namespace fathom::gl {

// An off-screen picture: size, view, time and samples.
struct Request {
    int width = 800, height = 600;
    int samples = 1; // a pixel; 0: by how rough it is (base/picture.h), of a program by passes
    double time = 0;
    std::optional<ir::View> view{};         // else the scene's own
    std::function<bool(double)> progress{}; // called now and then with 0..1; false stops
    int turns =
        0; // steps that one draw gives a ray; 0: as the program says. No picture depends on it
};

// Rows from the top, RGBA.
struct Pixels {
    int width = 0, height = 0;
    std::vector<float> rgba;
    // Rays from the eye; of these, and of samples with rays from lights, those that ended neither in
    // a hit nor in a miss.
    std::uint64_t rays = 0, undecided = 0, undecided_shadows = 0, passed = 0;
};

// Waits until all commands given so far are done.
void finish();

// The largest width and height that the context can draw at once.
int largest_side();

// What `mode` writes, averaged over the samples. Nothing where `progress` stopped it or the
// framebuffer cannot be made (too large, no memory).
std::optional<Pixels> draw(const Program &program, const ir::Scene &scene, const Request &request,
                           Mode mode);

// The whole way. Nothing where the scene cannot be emitted or built (said in `diagnostics`), or it
// was stopped.
std::optional<Picture> render(const ir::Scene &scene, const Request &request,
                              Diagnostics &diagnostics);

} // namespace fathom::gl
