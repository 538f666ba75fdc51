#include "proof/bound_cache.h"

#include "base/hash.h"

#include <utility>

namespace fathom::proof {
namespace {

std::uint64_t hash_of(const BoundCache::Words &words) {
    std::uint64_t hash = words.size();
    for (std::uint32_t word : words) hash = hash_combine(hash, word);
    return hash;
}

} // namespace

std::size_t BoundCache::bytes_of(const Entry &entry) {
    constexpr std::size_t links = 64; // of the list and the table
    return sizeof entry + links + entry.asked.capacity() * sizeof(std::uint32_t);
}

BoundCache::Place BoundCache::find(const Words &asked, std::uint64_t hash) {
    const auto [first, last] = by_hash_.equal_range(hash);
    for (auto it = first; it != last; ++it)
        if (it->second->asked == asked) return it->second;
    return entries_.end();
}

std::optional<BoundCache::Answer> BoundCache::find(const Words &asked) {
    const std::uint64_t hash = hash_of(asked);
    const std::lock_guard lock(mutex_);
    const Place found = find(asked, hash);
    if (found == entries_.end()) {
        ++searches_;
        return std::nullopt;
    }
    entries_.splice(entries_.begin(), entries_, found);
    return found->answer;
}

void BoundCache::keep(Words asked, const Answer &answer) {
    Entry entry{std::move(asked), answer, 0};
    entry.hash = hash_of(entry.asked);
    const std::lock_guard lock(mutex_);
    if (bytes_of(entry) > max_bytes_ || find(entry.asked, entry.hash) != entries_.end()) return;
    bytes_ += bytes_of(entry);
    entries_.push_front(std::move(entry));
    by_hash_.emplace(entries_.front().hash, entries_.begin());
    while (bytes_ > max_bytes_) drop(std::prev(entries_.end()));
}

void BoundCache::drop(Place entry) {
    const auto [first, last] = by_hash_.equal_range(entry->hash);
    for (auto it = first; it != last; ++it)
        if (it->second == entry) {
            by_hash_.erase(it);
            break;
        }
    bytes_ -= bytes_of(*entry);
    entries_.erase(entry);
}

std::size_t BoundCache::searches() const {
    const std::lock_guard lock(mutex_);
    return searches_;
}
std::size_t BoundCache::bytes() const {
    const std::lock_guard lock(mutex_);
    return bytes_;
}

} // namespace fathom::proof
