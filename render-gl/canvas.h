// A picture cached on the graphics card: drawn when something in it changed, sample by sample,
// shown as often as a window wants. Beside the colours it keeps what each pixel shows (part,
// distance, steps, slope). Knows nothing of windows; needs a current context.
#pragma once

#include "base/picture.h"
#include "render-gl/passes.h"
#include "render-gl/post.h"
#include "render-gl/program.h"

#include <functional>
#include <optional>
#include <span>

namespace fathom::gl {

// A sentence where the driver lost the context, which then draws nothing any more; else nothing.
std::string lost_context();

// A part of the canvas, in pixels from its top left.
struct Tile {
    int x = 0, y = 0, width = 0, height = 0;
    friend bool operator==(const Tile &, const Tile &) = default;
};

// One view in its tile; the inputs' size and offset follow from tile and sample.
struct TileView {
    Tile tile;
    FrameInputs inputs;
};

// What a pixel shows: part 0 is none, t < 0 nothing at all; a slope below 0: the ray is undecided,
// and what is told is what it is nearest to.
struct Pick {
    int part = 0;
    float t = -1, steps = 0, slope = 0;
    bool undecided() const { return slope < 0; }
};

// A picture on the card with the data of its pixels.
class Canvas {
  public:
    Canvas() = default;
    ~Canvas();
    Canvas(const Canvas &) = delete;
    Canvas &operator=(const Canvas &) = delete;

    // Adds a sample of every view (ir::sample_offset), the first of them anew, and waits until it
    // is done. Of the canvas's rows only those from `row` on, `rows` of them: a slow picture is
    // drawn in bands from 0 down, and events are heard between them. What is shown stays until
    // finish(). False where the card has no memory for it.
    // A program by passes (passes.h) is drawn pass by pass until all rays are decided, or `patient`,
    // asked between two of them, says no: then decided() is false, and the same call goes on.
    bool draw(const Program &program, int width, int height, std::span<const TileView> views,
              const std::vector<ir::Param> &params, int sample, int row = 0, int rows = 1 << 24,
              const std::function<bool()> &patient = {});
    bool decided() const { return !begun_; }
    void give_up() { begun_ = false; } // the rest of what was begun is not wanted any more
    const Undecided &undecided() const { return passes_.undecided(); } // of all samples so far
    void set_turns(int turns) { turns_ = turns; } // of a pass; 0: as the program says
    // The same of a program with Instruments::Probe, at the size that was drawn last.
    bool probe(const Program &program, std::span<const TileView> views,
               const std::vector<ir::Param> &params);
    // Takes another framebuffer's colours (0) and picks (1), both RGBA32F, as the first sample.
    bool take(unsigned framebuffer, int width, int height);
    // Makes of it what is shown.
    void finish(const PostSettings &settings);
    // What is shown now is to be faded from, by show()'s share of it.
    void keep_before();

    bool empty() const { return shown_width_ == 0; }
    int width() const { return width_; }
    int height() const { return height_; }
    int samples() const { return samples_; }

    Pick pick(int x, int y) const; // from the top left
    // Rows from the top, four floats a pixel: the picks as pick() reads them, the probe as glsl's
    // marcher.h says.
    std::vector<float> read_picks() const { return read(picks_framebuffer_); }
    std::vector<float> read_probe() const { return read(probe_framebuffer_); }
    Picture read_picture() const; // what is shown, without a window

    // Fills the window's framebuffer, or another, with it, whatever the sizes; `before`: the share
    // of the picture that is faded from.
    void show(int window_width, int window_height, double before = 0, unsigned into = 0) const;

  private:
    bool resize(int width, int height);
    void draw_views(const Program &program, std::span<const TileView> views,
                    const std::vector<ir::Param> &params, int sample, bool linear, int row,
                    int rows, const Pass &pass);
    bool draw_passes(const Program &program, std::span<const TileView> views,
                     const std::vector<ir::Param> &params, int sample, int row, int rows,
                     const std::function<bool()> &patient);
    std::vector<float> read(unsigned framebuffer) const;

    unsigned sum_ = 0, picks_ = 0, probe_ = 0, shown_ = 0; // textures
    unsigned framebuffer_ = 0, picks_framebuffer_ = 0, probe_framebuffer_ = 0,
             shown_framebuffer_ = 0;
    unsigned before_ = 0, before_framebuffer_ = 0; // faded from
    std::optional<Program> fade_;
    int width_ = 0, height_ = 0, samples_ = 0; // samples: whole ones
    int shown_width_ = 0, shown_height_ = 0;
    bool probed_ = false; // the probe is of this size
    bool begun_ = false;  // some rays of what was drawn last go on
    int turns_ = 0;
    Passes passes_;
    Post post_;
};

// Another framebuffer's first colours over the whole window, both of that size.
void show_in_window(unsigned framebuffer, int width, int height);

// Fills the current framebuffer with a gray of 0..1.
void clear_window(int width, int height, float gray);

// What the window's back buffer holds, to be called before it is swapped.
Picture read_window(int width, int height);

} // namespace fathom::gl
