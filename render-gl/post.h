// From what a scene's shader wrote to what a window shows: the mean of the samples, colours for
// steps, slopes, the slice and the check, FXAA, outlines. Works on textures; knows no scene. Needs
// a current context.
#pragma once

#include <array>

namespace fathom::gl {

// What the colours of the window mean.
enum class Look { Picture, Heat, Bound, Slice, Check };

// How a picture is turned into colours.
struct PostSettings {
    Look look = Look::Picture;
    bool fxaa = true;    // smooths pictures of one sample
    int max_steps = 256; // Heat: red
    int outlined = 0;    // a part's number; 0: none
    int hovered = 0;
    int thickness = 1;     // of outlines, pixels
    double isolines = 0.1; // Slice: the distance from one line to the next
};

// The GL programs of post-processing.
class Post {
  public:
    Post() = default;
    ~Post();
    Post(const Post &) = delete;
    Post &operator=(const Post &) = delete;

    // Textures of the same size, all floats but `out`: the samples' sum, the picks, the probe (0:
    // there is none); draws over `out`'s framebuffer. False where the card has no memory for it.
    bool run(const PostSettings &settings, unsigned sum, int samples, unsigned picks,
             unsigned probe, unsigned out, int width, int height);

  private:
    bool prepare(int width, int height);
    unsigned resolve_ = 0, finish_ = 0; // programs
    unsigned texture_ = 0, framebuffer_ = 0;
    std::array<int, 2> size_{0, 0};
};

} // namespace fathom::gl
