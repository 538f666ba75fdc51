// A picture kept on the graphics card: drawn when something in it changed, shown as often as a window wants.
// Knows nothing of windows; needs a current context.
#pragma once

#include "base/picture.h"
#include "render-gl/program.h"

namespace fathom::gl {

// The version that the current context has, 33 for 3.3; 0 where it has none.
int context_version();

class Canvas {
  public:
    Canvas() = default;
    ~Canvas();
    Canvas(const Canvas &) = delete;
    Canvas &operator=(const Canvas &) = delete;

    // Draws at the inputs' size and waits until it is done, so that what it took can be measured. False where the card
    // has no memory for it.
    bool draw(const Program &program, const FrameInputs &inputs, const std::vector<ir::Param> &params);
    bool empty() const { return width_ == 0; }

    // Fills the window's framebuffer with it, whatever the sizes.
    void show(int window_width, int window_height) const;

  private:
    bool resize(int width, int height);
    unsigned texture_ = 0, framebuffer_ = 0;
    int width_ = 0, height_ = 0;
};

void clear_window(int width, int height, float gray);

// What the window's back buffer holds, to be called before it is swapped.
Picture read_window(int width, int height);

} // namespace fathom::gl
