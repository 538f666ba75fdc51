// What a draw of ours changes in a context of somebody else's, put back where it ends.
#pragma once

#include <array>
#include <utility>
#include <vector>

namespace fathom::gl {

// Keeps the state of the current context that programs and passes change or are disturbed by, and
// sets it as they need it: nothing is blended, tested or masked, pixels lie in memory row by row, and
// no sampler object stands before a texture. What is bound to units of textures and images, and the
// targets of buffers that textures read or that are copied, are not kept.
class KeptState {
  public:
    KeptState();
    ~KeptState();
    KeptState(const KeptState &) = delete;
    KeptState &operator=(const KeptState &) = delete;

    // The lower left pixels of the framebuffer that was bound: to be drawn over next, or by the
    // first colour of another.
    void draw_over(int width, int height) const;
    void copy_over(unsigned framebuffer, int width, int height) const;

  private:
    int draw_ = 0, read_ = 0, renderbuffer_ = 0, program_ = 0, vertices_ = 0, unit_ = 0, pack_ = 0,
        unpack_ = 0, depth_func_ = 0, polygons_ = 0;
    unsigned char depth_mask_ = 0;
    std::array<int, 4> viewport_{};
    std::array<unsigned char, 4> color_mask_{};
    std::vector<std::pair<unsigned, bool>> enabled_;
    std::vector<std::pair<unsigned, int>> pixels_; // how they lie in memory
};

} // namespace fathom::gl
