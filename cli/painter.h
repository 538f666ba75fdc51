// What draws the pictures of `fathom render`: GL or the CPU. Knows nothing of files.
#pragma once

#include "backend-cpu/trace/march.h"
#include "base/picture.h"
#include "cli/compiled.h"
#include "cli/frames.h"
#include "render-gl/cache_passes.h"
#include "render-gl/context.h"
#include "render-gl/render.h"

#include <functional>
#include <memory>
#include <optional>

namespace fathom::cli {

// Made once for a process; its program once for a scene.
struct Painter {
    std::optional<gl::Context> context; // none: the CPU
    std::optional<gl::Program> program;
    std::unique_ptr<gl::CachedView> cache; // with --cache, where it can be had
};

// The command's samples a pixel: 0 for one, and more where a pixel is rough. Sums have one unless said.
int samples_of(const RenderCommand &command);

// Whether the command makes a part of a picture, opens a shutter, or leaves out the background: what
// the CPU alone does.
bool needs_cpu(const RenderCommand &command);

// "cpu", "gl", or "gl by cached values".
std::string_view maker_of(const Painter &painter);

// Makes the context of a GL painter, where the command wants one and it can be had.
Exit begin(Painter &painter, const RenderCommand &command, Terminal &terminal);
// Makes its program for a scene; nothing to do for the CPU.
Exit build(Painter &painter, const driver::Compilation &compilation, const RenderCommand &command,
           Terminal &terminal);

// A picture or a part of it, and how many of its rays ended neither in a hit nor in a miss.
struct Painted {
    Picture picture;
    std::vector<double> sums;  // by the CPU, where sums are wanted
    std::vector<float> linear; // RGBA, alpha multiplied into it; where the output is an EXR
    std::uint64_t rays = 0, undecided = 0, undecided_shadows = 0;
};

// `progress` hears the share that is done; `status` is what is worth knowing of how it was drawn.
// Nothing where it was interrupted, or there is no memory.
std::optional<Painted> paint(const Painter &painter, const ir::Scene &scene,
                             const RenderCommand &command, const cpu::Tile &region, bool sums,
                             const Moment &moment, const std::function<void(double)> &progress,
                             std::string &status, Terminal &terminal);

} // namespace fathom::cli
