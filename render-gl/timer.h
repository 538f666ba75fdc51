// What the graphics card itself takes for what is drawn between begin and end (GL_TIME_ELAPSED,
// GL 3.3). Answers come some frames later; nothing waits for them. Needs a current context.
#pragma once

#include <array>
#include <optional>

namespace fathom::gl {

// Measures spans of GPU time without waiting.
class Timer {
  public:
    Timer() = default;
    ~Timer();
    Timer(const Timer &) = delete;
    Timer &operator=(const Timer &) = delete;

    bool begin(); // false where the card is too far behind for one more
    void end();
    std::optional<double> poll(); // the next answer that is there, in milliseconds, in order

  private:
    static constexpr std::size_t maximum = 8; // begun and not yet read
    std::array<unsigned, maximum> queries_{};
    std::size_t asked_ = 0, answered_ = 0;
    bool open_ = false;
};

} // namespace fathom::gl
