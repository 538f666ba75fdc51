// Pictures drawn through the noise cache: the three passes of a frame (thesis, 7.3), and which
// fields the cache holds. One CachedView keeps its cache over frames, views, params and reloads of
// a scene: only what a field computes itself makes its values stale. Needs a current context of
// GL 4.2.
#pragma once

#include "base/diagnostic.h"
#include "render-gl/cache_store.h"
#include "render-gl/program.h"
#include "render-gl/render.h"

#include <map>
#include <memory>

namespace fathom::gl {

// Whether the current context can draw through the cache; else why not, in words.
std::string cache_unavailable();

struct CacheSettings {
    int max_age = 4; // 1 to cache_ages
    bool show_misses = false;
};

// One frame's pixels that found and that missed.
struct CacheTally {
    std::uint64_t hits = 0, misses = 0;
    std::uint64_t missing_pixels = 0;
};

class CachedView {
  public:
    CachedView() = default;
    ~CachedView();
    CachedView(const CachedView &) = delete;
    CachedView &operator=(const CachedView &) = delete;

    // Takes a scene's programs. What the cache already holds of the same fields stays. An empty
    // text where all went well and some field is kept; else why the scene is drawn exactly.
    std::string use(const ir::Scene &scene, const CacheSize &size, Diagnostics &diagnostics,
                    int part_stride = 0); // of a scene that was lowered with its parts
    bool ready() const { return picture_.has_value(); }

    // Draws a frame, and lets the cache learn what it missed. False where there is no memory.
    bool draw(const FrameInputs &inputs, const std::vector<ir::Param> &params,
              const CacheSettings &settings);
    // The same picture by another program, into the same place; the cache learns nothing.
    bool draw_exactly(const Program &program, const FrameInputs &inputs,
                      const std::vector<ir::Param> &params);
    void forget();                                        // empties the cache
    unsigned framebuffer() const { return framebuffer_; } // colour 0: RGBA32F, as the mode says
    Pixels read_pixels() const;
    CacheTally read_tally() const;

    CacheStore &store() { return store_; }
    const CacheStore &store() const { return store_; }
    // The number in the cache's keys of Graph::caches' i-th field; -1 where it is not kept.
    int number_of(std::uint32_t cache) const;

  private:
    bool resize(int width, int height);
    void release();
    void renew(const std::vector<ir::Param> &params, int ages);
    void sweep(int field);
    void publish();
    void draw_cells(const Program &program);
    void set_fields(const Program &program) const;

    CacheStore store_;
    std::optional<Program> picture_, fill_, reserve_, publish_, sweep_;
    std::vector<glsl::KeptField> kept_;
    std::vector<int> numbers_; // by kept_
    std::map<int, std::vector<double>>
        meanings_; // by number: the meaning and the params' values it was filled with
    int first_unit_ = 0, ages_ = 0;
    std::uint32_t frame_ = 0;
    int width_ = 0, height_ = 0;
    unsigned framebuffer_ = 0, places_framebuffer_ = 0, sweep_framebuffer_ = 0;
    unsigned color_ = 0, misses_ = 0, tally_ = 0, places_ = 0, sweep_target_ = 0;
};

} // namespace fathom::gl
