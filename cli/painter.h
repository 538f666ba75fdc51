// What draws the pictures of `fathom render`: GL or the CPU. Knows nothing of files.
#pragma once

#include "cli/frames.h"
#include "cli/terminal.h"

#include <fathom/gl.h>

#include <functional>

namespace fathom::cli {

// The command's samples a pixel: 0 for one, and more where a pixel is rough. Sums have one unless said.
int samples_of(const RenderCommand &command);

// Whether the command makes a part of a picture, opens a shutter, or leaves out the background: what
// the CPU alone does.
bool needs_cpu(const RenderCommand &command);

// Of the painter, which is not open where the CPU draws: "cpu", "gl", or "gl by cached values".
std::string_view maker_of(const v1::GlPainter &gl);

// Opens the painter where the command wants GL and it can be had. Once for a process.
Exit begin(v1::GlPainter &gl, const RenderCommand &command, Terminal &terminal);
// Once for a scene; nothing to do for the CPU.
Exit use(v1::GlPainter &gl, const v1::CompileResult &result, const RenderCommand &command,
         Terminal &terminal);

// A picture or a part of it. `progress` hears the share that is done. Not complete where it was
// interrupted, or there is no memory.
v1::Picture paint(v1::GlPainter &gl, const v1::Scene &scene, const RenderCommand &command,
                  const v1::Region &region, bool sums, const Moment &moment,
                  const std::function<void(double)> &progress, Terminal &terminal);

} // namespace fathom::cli
