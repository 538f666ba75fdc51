// Whether work in hand is no longer wanted: an edit came, a window was closed. Who asks for the work
// gives a function; who does it asks now and then, and ends soon with what says nothing.
#pragma once

#include <cstddef>
#include <functional>

namespace fathom {

class Stop {
  public:
    Stop() = default;
    // `asked` may be empty: then nothing stops. It is called from the thread that works.
    explicit Stop(std::function<bool()> asked) : asked_(std::move(asked)) {}

    // Once it said yes it says so for ever. Asks at most once in `often` calls' worth of steps.
    bool after(std::size_t steps) {
        since_ += steps;
        if (since_ < often) return stopped_;
        since_ = 0;
        return now();
    }
    bool now() { return stopped_ = stopped_ || (asked_ && asked_()); }
    bool stopped() const { return stopped_; } // asks nobody

  private:
    static constexpr std::size_t often =
        10'000; // steps of proof or scene time: about a millisecond
    std::function<bool()> asked_;
    std::size_t since_ = 0;
    bool stopped_ = false;
};

} // namespace fathom
