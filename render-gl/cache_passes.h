// Pictures drawn through the noise cache: the passes of a frame (thesis, 7.3), and which fields the
// cache holds. One CachedView keeps its cache over frames, views, params and reloads of
// a scene: only what a field computes itself makes its values stale. Needs a current context of
// GL 4.2.
#pragma once

#include "base/diagnostic.h"
#include "render-gl/cache_store.h"
#include "render-gl/cache_targets.h"
#include "render-gl/cache_worth.h"
#include "render-gl/program.h"
#include "render-gl/render.h"

#include <map>
#include <memory>

namespace fathom::gl {

// Whether the current context can draw through the cache; else why not, in words.
std::string cache_unavailable();

// Size, precision and ageing of the noise cache.
struct CacheSettings {
    int max_age = 4; // 1 to cache_ages
    // Pixels whose cells would be narrower than so many of them are computed: what no two pixels
    // share is found by no later frame either, unless nothing moves at all.
    double min_pixels = 1;
    bool show_misses = false; // in red
    // Draws exactly where counted work says that look-ups do not pay, and while params are edited
    // that a cached field reads: such a frame would find nothing.
    bool weigh = true;
};

using glsl::PixelState;

// One frame: look-ups that found their value; pixels whose value was absent; pixels that were
// computed, those among them.
struct CacheTally {
    std::uint64_t hits = 0, misses = 0, computed = 0;
};

// What a CachedView is made with.
struct CacheOptions {
    int part_stride = 0; // of a scene that was lowered with its parts
    bool pick = false;   // the programs write what each pixel shows, too (emit.h)
};

// All that depends on the scene. Programs belong to every context that shares with the one that
// made them.
struct CachePrograms {
    Program cached, rest, exact; // the picture by cached values alone, by computing what these left
                                 // over, by computing all
    Program fill;                // a cell's corners
    std::vector<glsl::CachedField> fields;
    CachePrices prices;
    bool pick = false;
};
// Or why there are none, in words.
std::variant<CachePrograms, std::string>
build_cache_programs(const ir::Scene &scene, const CacheOptions &options, Diagnostics &diagnostics);

// One view of a scene through the noise cache, and the cache itself.
class CachedView {
  public:
    CachedView() = default;
    ~CachedView();
    CachedView(const CachedView &) = delete;
    CachedView &operator=(const CachedView &) = delete;

    // Takes a scene's programs. What the cache already holds of the same fields stays, as does a
    // cache that has grown. An empty text where all went well; else why the scene is drawn exactly.
    std::string use(CachePrograms programs, const CacheSize &size);
    std::string use(const ir::Scene &scene, const CacheSize &size, Diagnostics &diagnostics,
                    const CacheOptions &options = {}); // builds them, too
    bool ready() const { return programs_.has_value(); }
    void drop() { programs_.reset(); } // the scene is another now; the cells stay

    // Draws a frame, and lets the cache learn what it missed; or exactly, see CacheSettings::weigh.
    // False where there is no memory.
    bool draw(const FrameInputs &inputs, const std::vector<ir::Param> &params,
              const CacheSettings &settings);
    // The same picture into the same place without the cache, which learns nothing.
    bool draw_exactly(const FrameInputs &inputs, const std::vector<ir::Param> &params);
    void forget();                                // empties the cache
    bool looked_up() const { return looked_up_; } // the last frame was not drawn exactly
    void weigh_anew() { worth_ = {}, store_.forget_counts(); }
    unsigned framebuffer() const { return targets_.picture; } // colour 0: RGBA32F, as the mode says
    int width() const { return targets_.width; }
    int height() const { return targets_.height; }
    Pixels read_pixels() const;
    CacheTally read_tally() const;
    std::vector<PixelState> read_states() const; // rows from the top

    CacheStore &store() { return store_; }
    const CacheStore &store() const { return store_; }
    const std::vector<glsl::CachedField> &fields() const {
        return programs_->fields;
    } // ready() alone
    // The number in the cache's keys of Graph::caches' i-th field; -1 where it is not cached.
    int number_of(std::uint32_t cache) const;

  private:
    std::string build_passes();
    void number_fields();
    bool edited(const std::vector<ir::Param> &params);
    void renew(const std::vector<ir::Param> &params, int ages);
    void sweep(int field);
    void publish();
    void set_fields(const Program &program) const;
    void begin_picture() const;
    void draw_cached_frame(const FrameInputs &inputs, const std::vector<ir::Param> &params,
                           const CacheSettings &settings);
    void reserve(int ages);
    void fill(const FrameInputs &inputs, const std::vector<ir::Param> &params);
    void tint();
    void judge(bool weigh);
    bool grow();
    std::vector<std::uint32_t> read_counted() const;

    CacheStore store_;
    CacheWorth worth_;
    CacheGrowth growth_;
    bool looked_up_ = false, too_small_ = false;
    std::optional<CachePrograms> programs_;
    std::optional<Program> reserve_, publish_, sweep_, tint_;
    std::vector<int> numbers_; // by the programs' fields
    std::map<int, std::vector<double>>
        meanings_;             // by number: the meaning and the params' values it was filled with
    std::vector<double> read_; // what the cached fields read of the params, in the frame before
    int first_unit_ = 0, ages_ = 0;
    std::uint32_t frame_ = 0;
    std::size_t sweep_cells_ = 0; // that the target of sweep() is made for
    CacheTargets targets_;
    unsigned sweep_framebuffer_ = 0, sweep_target_ = 0;
    unsigned changed_ = 0; // a query: whether the frame's reserving changed anything
};

} // namespace fathom::gl
