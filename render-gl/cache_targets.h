// What the passes of a frame through the noise cache draw into. Needs a current context of GL 4.2;
// knows no scene, no cache and no shader.
#pragma once

namespace fathom::gl {

// The framebuffers of the passes, at the size of the picture.
struct CacheTargets {
    CacheTargets() = default;
    ~CacheTargets() { release(); }
    CacheTargets(const CacheTargets &) = delete;
    CacheTargets &operator=(const CacheTargets &) = delete;

    // False where there is no memory for it. `pick`: with a place for what each pixel shows
    // (emit.h).
    bool resize(int width, int height, bool pick);
    void release();
    void draw_into(bool counted) const; // of `picture`: all outputs, or colour and pick alone
    void clear_counts() const;          // all pixels computed, none missed

    int width = 0, height = 0;
    unsigned picture = 0;  // a framebuffer: colour 0 RGBA32F, picks, misses, tally, starts, depth
    unsigned rest = 0;     // another: the same colour, picks and depth, and the wishes
    unsigned reserved = 0; // a third: the places
    unsigned color = 0, picks = 0, misses = 0, tally = 0, starts = 0, wishes = 0, places = 0;

  private:
    bool make();
    unsigned depth_ = 0;
    bool pick_ = false;
};

// A texture without mipmaps that is a framebuffer's attachment.
unsigned target_2d(int format, int width, int height, unsigned framebuffer, unsigned attachment);

} // namespace fathom::gl
