// The noise cache's textures on the card (backend-glsl/cache.h says what each holds), and their
// reading back for statistics and tests. Needs a current context of GL 4.2; knows no scene and no
// shader.
#pragma once

#include "backend-glsl/cache.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace fathom::gl {

// How many cells a cache has, and what they hold.
struct CacheSize {
    int bits = 6;      // 2^bits cells an axis, 2 to 7
    int max_bits = 0;  // where more than `bits`: what it may grow to (cache_worth.h)
    bool wide = false; // vectors and colours, too
    std::uint64_t bytes() const;
};

// Where nobody says how many: 262,144 cells, and 2,097,152 in a view that needs more.
constexpr CacheSize usual_cache_size{.bits = 6, .max_bits = 7};

// What one frame did, and what is there after it.
struct CacheCounts {
    std::uint32_t inserted = 0, evicted = 0, deleted = 0;
    std::uint32_t crowded = 0; // not inserted: all their slots were taken in the same frame
    std::uint32_t full = 0;    // not inserted: nothing was free, or could be freed
    std::uint32_t swept = 0;   // of fields that changed
    std::uint32_t paid = 0, wasted = 0, left = 0, steps = 0; // of the pixels that are weighed
};

// Where a key of that age lies: the CPU's reading of thesis, 7.1.
std::array<int, 3> cache_slot(const std::array<int, 4> &key, int age, int bits);

// The textures of one noise cache.
class CacheStore {
  public:
    CacheStore() = default;
    ~CacheStore();
    CacheStore(const CacheStore &) = delete;
    CacheStore &operator=(const CacheStore &) = delete;

    bool make(const CacheSize &size); // empty; false where the card has no memory for it
    void clear();
    void begin_frame();                       // counts start again
    void bind_textures(int first_unit) const; // index, pool, wide

    const CacheSize &size() const { return size_; }
    int side() const { return 1 << size_.bits; }
    std::size_t cells() const { return std::size_t{1} << (3 * size_.bits); }
    unsigned hash() const { return hash_; }
    unsigned keys() const { return keys_; }
    unsigned pool() const { return pool_; }
    unsigned wide() const { return wide_; }
    unsigned index() const { return index_; }
    unsigned free() const { return free_; }
    unsigned changed() const { return changed_; }
    unsigned counts() const { return counts_texture_; }

    CacheCounts read_counts() const;
    // The same without waiting for the frame: they are set aside at its end, and read two frames
    // later, when the card has long been done.
    void set_counts_aside();
    std::optional<CacheCounts> counts_before() const;
    void forget_counts() { set_aside_ = 0; }

    // Everything, as it lies there: for statistics and tests.
    struct Dump {
        int bits = 0;
        std::vector<std::uint32_t> hash, free, counts;
        std::vector<std::array<std::uint32_t, 2>> index;
        std::vector<std::array<std::int32_t, 4>> keys; // by place
        std::vector<float> pool;                       // (2N)^3, x first
        std::vector<std::array<float, 4>> wide;        // the same, or empty
    };
    Dump dump(bool with_pool) const;

  private:
    void release();
    CacheSize size_;
    unsigned hash_ = 0, keys_ = 0, index_ = 0, pool_ = 0, wide_ = 0, free_ = 0, changed_ = 0;
    unsigned counts_ = 0, counts_texture_ = 0;
    std::array<unsigned, 3> aside_{}; // buffers, used in turn
    std::size_t set_aside_ = 0;       // how often
};

// How many keys there are, of each age and each field.
struct CacheOccupancy {
    std::size_t cells = 0, keys = 0;
    std::array<std::size_t, glsl::cache_ages> ages{};
    std::array<std::size_t, glsl::max_cache_fields> fields{};
};
CacheOccupancy occupancy(const CacheStore::Dump &dump);

// The first broken rule in words, or an empty text: each place is an entry's or free, once; each
// key lies at the slot of its age, once; and the index says the same.
std::string check_cache(const CacheStore::Dump &dump);

} // namespace fathom::gl
