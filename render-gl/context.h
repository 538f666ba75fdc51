// A GL context without a window or a display, by EGL. Programs and passes do not need it: any
// current context will do.
#pragma once

#include <memory>
#include <string>
#include <variant>

namespace fathom::gl {

// An EGL context without a surface; current in the thread that made it.
class Context {
  public:
    // The newest core context from 4.6 down to 3.3: of the device EGL offers first, of Mesa without
    // a surface otherwise. It is current on this thread. Else a sentence that says what could not
    // be had.
    static std::variant<Context, std::string> make();

    std::string describe() const; // the renderer's and the version's names
    int version() const;          // 45 is 4.5

    Context(Context &&) noexcept;
    Context &operator=(Context &&) noexcept;
    ~Context();

  private:
    struct State;
    explicit Context(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

} // namespace fathom::gl
