// A field apart from its scene, with the ranges of what it reads: all that its bound follows from, as
// words. A search looks at a copy that is made of these words alone, whether its answer is kept or
// not; so a bound that was kept is the one that a search would find.
#pragma once

#include "ir/passes/content.h"
#include "proof/bound_cache.h"

#include <functional>

namespace fathom::proof {

// What is wanted of a field; it stands in the words.
enum class Wanted : std::uint8_t { Bound, Deformed, Magnitude, Gap, GapInside };

class Question {
  public:
    Question(Flattening &context, const Ranges &ranges, NodeId field, Wanted wanted);

    void add(double number);
    void add(const Interval &interval);
    void add(const Cell &cell);
    void add(const Zone *zone);
    void add(const Budget &budget);

    // What is known of it, or else what `search` finds in a copy of the field with ranges of its
    // own. Takes the steps of the search off the context's work in both cases.
    using Search = std::function<FieldBound(Flattening &, const Ranges &, NodeId)>;
    FieldBound answer(const Search &search) &&;

  private:
    void add(std::uint32_t word) { words_.push_back(word); }
    void add_inputs(const ir::Content &content, const Ranges &ranges, NodeId field);
    FieldBound searched(const Search &search, Work &work) const;

    Flattening &context_;
    Ranges own_; // of the copy
    std::vector<bool> cached_;
    BoundCache::Words words_; // those of the content first
    std::size_t content_words_ = 0;
};

} // namespace fathom::proof
