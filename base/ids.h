// Typed indices into vectors: the project's only kind of reference between records.
// Knows nothing of what the records are.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

namespace fathom {

// An index into the vector of `Tag`s. A default-made id refers to nothing.
template <class Tag> struct Id {
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
    std::uint32_t index = none;

    constexpr Id() = default;
    constexpr explicit Id(std::size_t i) : index(static_cast<std::uint32_t>(i)) {}
    constexpr explicit operator bool() const { return index != none; }
    friend constexpr auto operator<=>(Id, Id) = default;
};

// A vector that is indexed by its own id type and by no other.
template <class T, class I = Id<T>> class Arena {
  public:
    I add(T value) {
        items_.push_back(std::move(value));
        return I{items_.size() - 1};
    }
    T &operator[](I id) { return items_[id.index]; }
    const T &operator[](I id) const { return items_[id.index]; }
    std::size_t size() const { return items_.size(); }
    bool empty() const { return items_.empty(); }
    I next() const { return I{items_.size()}; }
    void reserve(std::size_t size) { items_.reserve(size); }
    auto begin() { return items_.begin(); }
    auto end() { return items_.end(); }
    auto begin() const { return items_.begin(); }
    auto end() const { return items_.end(); }

  private:
    std::vector<T> items_;
};

} // namespace fathom

template <class Tag> struct std::hash<fathom::Id<Tag>> {
    std::size_t operator()(fathom::Id<Tag> id) const noexcept {
        return std::hash<std::uint32_t>{}(id.index);
    }
};
