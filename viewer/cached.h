// The scene through the noise cache, while it is moved: the first view, by cached values where they
// are, and what the cache did. Draws, counts and chooses; knows no window. Needs a current context
// of GL 4.2, and says so where there is none.
#pragma once

#include "render-gl/cache_choice.h"
#include "render-gl/cache_passes.h"

#include <optional>
#include <string>

namespace fathom::viewer {

// What the panel shows of the last frame, and of the cells.
struct CacheFigures {
    gl::CacheTally tally;
    gl::CacheCounts counts;
    gl::CacheOccupancy occupancy;
    gl::CacheChoice choice;
    bool looked_up = false;
};

// The cached view of the window's scene, once it is built.
class Cached {
  public:
    // Another scene is shown: cells stay where they are still right, programs are another's.
    void scene_changed();
    void view_changed() { frames_ = 0; }

    // Takes programs that the worker built for the scene that is shown, or why there are none.
    void take(std::variant<gl::CachePrograms, std::string> programs);
    // Builds them here, where no worker can.
    void build(const ir::Scene &scene, int part_stride);
    bool requested() const { return requested_; } // there are programs, or it is known why not
    bool ready() const { return view_.ready(); }
    bool looked_up() const {
        return view_.looked_up();
    } // the last frame; else it was drawn exactly
    const std::string &why_not() const { return why_not_; }

    // One frame. False where the card has no memory for it.
    bool draw(const gl::FrameInputs &inputs, const std::vector<ir::Param> &params,
              bool show_misses);
    bool settled() const { // nothing is missed any more, or there is no room for it
        return frames_ > 0 && (figures_.tally.misses == 0 || frames_ >= max_frames);
    }
    // What the last frame did; the cells are counted now and then, since all of them are read back.
    void count();
    const CacheFigures &figures() const { return figures_; }
    std::string words() const; // "noise cache: 12000 found, 31 missed"
    unsigned framebuffer() const { return view_.framebuffer(); }
    gl::CacheChoice choice;

  private:
    static constexpr int max_frames = 256;
    static constexpr int count_cells_every = 16;
    gl::CachedView view_;
    CacheFigures figures_;
    std::string why_not_;
    int frames_ = 0; // since something changed
    int counted_ = 0;
    bool requested_ = false;
};

} // namespace fathom::viewer
