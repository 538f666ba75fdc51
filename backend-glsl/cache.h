// The noise cache in GLSL (thesis, 7.2 and 7.3; docs/noise-cache.md): the look-up that a picture's
// shader reads cached fields by, and the passes that reserve places, fill them and give them up.
// Knows fields by number, cell and the name of the function that computes them, nothing of scenes;
// calls no GL.
//
// The textures, for a cache of N^3 cells, N a power of two up to 128:
//   fathom_cache_hash   r32ui,   N^3     bits 0..20 a place, 21..23 its age, 24..31 the frame it
//   came in; or empty fathom_cache_keys   rgba32i, N^3     by place: the cell's x, y, z and its
//   field; + refused where it is too steep fathom_cache_pool   r32f,    (2N)^3  by place: a number
//   at each corner of the cell fathom_cache_wide   rgba32f, (2N)^3  the same, for vectors and
//   colours fathom_cache_index  rg32ui,  N^3     hash and keys in one, by slot: what a look-up
//   reads fathom_cache_free   r32ui,   N^3     a ring of the places that nobody has
//   fathom_cache_changed r32ui,  N^3     the slots that changed in this frame
//   fathom_cache_counts r32ui, a buffer  see Count
#pragma once

#include "ir/graph.h"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace fathom::glsl {

// h_i(k) = (k + O[i]) mod N in each axis, i the key's age (thesis, 7.1; Garcia et al. 2011): O by
// chance, once. Fields that have the same cell are moved apart, each by `cache_field_shift` more.
constexpr int cache_ages = 7; // the largest maximum age
constexpr std::array<std::array<int, 3>, cache_ages> cache_shifts{{{41, 87, 19},
                                                                   {6, 110, 75},
                                                                   {99, 33, 121},
                                                                   {70, 5, 54},
                                                                   {23, 62, 90},
                                                                   {115, 49, 2},
                                                                   {58, 126, 37}}};
constexpr std::array<int, 3> cache_field_shift{37, 83, 59};

constexpr int cache_place_bits = 21, cache_age_bits = 3;
constexpr std::uint32_t cache_empty = 0xffffffffu; // age 7, which no key reaches
constexpr std::uint32_t cache_nowhere = 0xffffffffu;
constexpr int cache_refused = 256; // in a key's field
// An index entry: x holds the cell's x, y and z over N, ten bits each (which with the slot and the
// age says the cell), and the highest bit where it is refused; y the place, the field from bit 21,
// the age from bit 29.
constexpr int cache_high_bits = 10;
constexpr int max_cache_fields = 256;
constexpr int cache_wishes = 4;  // cells that a pixel may ask for in one frame: a uvec4 of places
constexpr int cache_many = 8;    // hits from which on a pixel asks only for what is not there
constexpr int cache_sampled = 4; // one pixel in a square of that side is weighed

// The words of fathom_cache_counts. Places are taken from the ring at `Head` and given back at
// `Tail`; what is given back in a frame is taken in the next one at the earliest, from before
// `Limit`.
// `Changed` counts the entries of fathom_cache_changed: slots whose index is to be written anew. Of
// the pixels that are weighed, `Paid` counts the look-ups of those that were finished, `Wasted`
// those of others, and `Left` these; `Steps` those of all their marches.
enum class Count {
    Head,
    Tail,
    Limit,
    Inserted,
    Evicted,
    Deleted,
    Crowded,
    Full,
    Swept,
    Changed,
    Paid,
    Wasted,
    Left,
    Steps,
    Total
};

struct CachedText {
    std::string function; // what computes it
    ir::Type type = ir::Type::Float;
    double cell = 1, slope = 0;
};

// A picture's text stands for three: with `cache_defined` as a macro it reads cached values alone,
// counts and says by its depth, 0 or 1, whether the pixel is finished, and where its march first
// asked for a value; without it computes every field. With `cache_learns` it computes, too, from
// there on, and asks for some of the cells that it would have read.
constexpr const char *cache_defined = "FATHOM_CACHE", *cache_learns = "FATHOM_CACHE_LEARN";
// What fathom_counted says of a pixel beside its hits, in its two lowest bits; above them its
// steps.
enum class PixelState { Finished, Missed, Computed }; // Computed: what it wants cannot be cached
std::string cache_look_up(std::span<const CachedText> fields); // inputs, state and fathom_cached
std::string cache_reader(const CachedText &field, std::size_t number); // FUNCTION_cached(vec3)
std::string with_cache(const std::string &text, const char *defined = cache_defined);
std::string cache_fill(std::span<const CachedText> fields); // follows the fields' own functions
std::string cache_reserve();                                // whole texts
std::string cache_sweep();
std::string cache_publish();
std::string cache_tint();

} // namespace fathom::glsl
