#include "viewer/cached.h"

#include <fmt/format.h>

namespace fathom::viewer {

std::string Cached::draw(const ir::Scene &scene, int part_stride, const gl::FrameInputs &inputs,
                         const std::vector<ir::Param> &params) {
    if (!taken_) {
        Diagnostics unheard; // the worker has told them
        if (std::string why = view_.use(scene, {}, unheard, {.part_stride = part_stride});
            !why.empty())
            return why;
        taken_ = true;
        frames_ = 0;
    }
    gl::CacheSettings settings;
    settings.show_misses = true;
    if (!view_.draw(inputs, params, settings))
        return "the graphics card has no memory for the noise cache";
    tally_ = view_.read_tally();
    ++frames_;
    return "";
}

std::string Cached::words() const {
    return fmt::format("noise cache: {} found, {} missed (red) in {} pixels", tally_.hits,
                       tally_.misses, tally_.computed);
}

} // namespace fathom::viewer
