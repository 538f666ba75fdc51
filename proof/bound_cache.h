// Bounds that were found, by all that they follow from: what one proof hands to the next, so that a
// field is searched anew only where itself, its region or the range of something that it reads has
// changed. It holds no name, no place and no node: places are those of the scene in hand.
#pragma once

#include "proof/field.h"

#include <cstdint>
#include <list>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <vector>

namespace fathom::proof {

// Owned by who compiles again and again; any number of threads may share one. What was not asked for
// longest goes first.
class BoundCache {
  public:
    static constexpr std::size_t usual_bytes = std::size_t{32} << 20;
    explicit BoundCache(std::size_t max_bytes = usual_bytes) : max_bytes_(max_bytes) {}

    using Words = std::vector<std::uint32_t>;
    struct Answer {
        FieldBound bound;
        std::size_t steps = 0; // of work, that finding it took
    };
    std::optional<Answer> find(const Words &asked);
    void keep(Words asked, const Answer &answer);

    std::size_t searches() const; // bounds that were not there when asked for
    std::size_t bytes() const;    // at most `max_bytes`

  private:
    struct Entry {
        Words asked;
        Answer answer;
        std::uint64_t hash = 0;
    };
    using Place = std::list<Entry>::iterator;
    Place find(const Words &asked, std::uint64_t hash);
    static std::size_t bytes_of(const Entry &entry);
    void drop(Place entry);

    mutable std::mutex mutex_;
    std::list<Entry> entries_; // asked for last, first
    std::unordered_multimap<std::uint64_t, Place> by_hash_;
    std::size_t max_bytes_, bytes_ = 0, searches_ = 0;
};

} // namespace fathom::proof
