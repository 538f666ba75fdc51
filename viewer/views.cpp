#include "viewer/views.h"

#include <algorithm>

namespace fathom::viewer {
namespace {

constexpr int gap = 2; // pixels between tiles

} // namespace

void show_views(Views &views, int count) {
    if (count > views.count) {
        // What becomes visible looks at what the first looks at, along an axis.
        constexpr std::array sides{Side::Top, Side::Front, Side::Right};
        for (int i = std::max(views.count, 1); i < count; ++i) {
            Camera &camera = views.cameras[static_cast<std::size_t>(i)];
            camera = views.cameras[0];
            camera.orthographic = true;
            look_from(camera, sides[static_cast<std::size_t>(i - 1)]);
        }
    }
    views.count = count;
    views.active = std::min(views.active, count - 1);
}

std::vector<gl::Tile> tiles_of(const Views &views, int width, int height) {
    if (views.count == 1) return {{0, 0, width, height}};
    const int left = (width - gap) / 2, right = width - gap - left;
    if (views.count == 2) return {{0, 0, left, height}, {left + gap, 0, right, height}};
    const int top = (height - gap) / 2, bottom = height - gap - top;
    return {{0, 0, left, top},
            {left + gap, 0, right, top},
            {0, top + gap, left, bottom},
            {left + gap, top + gap, right, bottom}};
}

int tile_at(const std::vector<gl::Tile> &tiles, double x, double y) {
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        const gl::Tile &t = tiles[i];
        if (x >= t.x && y >= t.y && x < t.x + t.width && y < t.y + t.height)
            return static_cast<int>(i);
    }
    return -1;
}

std::string view_name(const Camera &camera) {
    for (auto [side, name] :
         {std::pair{Side::Front, "front"}, {Side::Right, "right"}, {Side::Top, "top"}}) {
        Camera other = camera;
        look_from(other, side);
        if (other.yaw == camera.yaw && other.pitch == camera.pitch) return name;
    }
    return "";
}

} // namespace fathom::viewer
