// The scene through the noise cache, its misses in red: the first view, drawn anew until the cache
// knows all that it shows. Draws and counts; knows no window. Needs a current context of GL 4.2,
// and says so where there is none.
#pragma once

#include "render-gl/cache_passes.h"

#include <optional>
#include <string>

namespace fathom::viewer {

class Cached {
  public:
    // The scene or a value changed: what is known of it stays where it is still right.
    void scene_changed() { taken_ = false; }
    void view_changed() { frames_ = 0; }

    // One frame. An empty text, or why the scene is drawn exactly.
    std::string draw(const ir::Scene &scene, int part_stride, const gl::FrameInputs &inputs,
                     const std::vector<ir::Param> &params);
    bool settled() const {
        return frames_ > 0 && (1000 * tally_.misses <= tally_.hits || frames_ >= most_frames);
    }
    std::string words() const; // "noise cache: 12000 found, 31 missed"
    unsigned framebuffer() const { return view_.framebuffer(); }

  private:
    static constexpr int most_frames = 256; // what is missed then has no room
    gl::CachedView view_;
    gl::CacheTally tally_;
    int frames_ = 0; // since something changed
    bool taken_ = false;
};

} // namespace fathom::viewer
