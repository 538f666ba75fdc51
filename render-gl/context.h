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

    // Makes it current on this thread. False where it is current on another.
    bool make_current() const;

    Context(Context &&) noexcept;
    Context &operator=(Context &&) noexcept;
    ~Context();

  private:
    struct State;
    explicit Context(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

// Whether any context of OpenGL is current on this thread, by EGL or by GLX.
bool any_is_current();

// What EGL has current on this thread, which is so again where this ends.
class KeptCurrent {
  public:
    KeptCurrent();
    ~KeptCurrent();
    KeptCurrent(const KeptCurrent &) = delete;
    KeptCurrent &operator=(const KeptCurrent &) = delete;

  private:
    void *display_, *context_, *draw_, *read_; // EGL's handles
};

} // namespace fathom::gl
