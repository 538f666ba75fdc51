// Up to four views of one scene beside each other, and how the window is divided among them. Knows
// no window.
#pragma once

#include "render-gl/canvas.h"
#include "viewer/camera.h"

#include <array>
#include <string>
#include <vector>

namespace fathom::viewer {

// How many views there are, and which is active.
struct Views {
    std::array<Camera, 4> cameras; // the first is the scene's
    int count = 1, active = 0;     // 1, 2 or 4 are shown; the active one takes keys
    friend bool operator==(const Views &, const Views &) = default;
    Camera &camera() { return cameras[static_cast<std::size_t>(active)]; }
    const Camera &camera() const { return cameras[static_cast<std::size_t>(active)]; }
};

// One, two side by side, or four: the first upper left, then from the top, the front and the right,
// without perspective.
void show_views(Views &views, int count);

// Where each view lies in the window, in pixels.
std::vector<gl::Tile> tiles_of(const Views &views, int width, int height);
int tile_at(const std::vector<gl::Tile> &tiles, double x, double y); // -1 on the lines between

std::string view_name(const Camera &camera); // "front", "top", "right", or ""

} // namespace fathom::viewer
