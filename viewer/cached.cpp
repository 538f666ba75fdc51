#include "viewer/cached.h"

#include <fmt/format.h>

namespace fathom::viewer {

void Cached::scene_changed() {
    view_.drop();
    why_not_.clear();
    requested_ = false;
    frames_ = 0;
    gl::start_again(choice);
}

void Cached::take(std::variant<gl::CachePrograms, std::string> programs) {
    requested_ = true;
    if (std::string *why = std::get_if<std::string>(&programs))
        why_not_ = std::move(*why);
    else
        why_not_ =
            view_.use(std::move(std::get<gl::CachePrograms>(programs)), gl::usual_cache_size);
}

void Cached::build(const ir::Scene &scene, int part_stride) {
    Diagnostics discarded; // the worker has told them
    take(gl::build_cache_programs(scene, {.part_stride = part_stride, .pick = true}, discarded));
}

bool Cached::draw(const gl::FrameInputs &inputs, const std::vector<ir::Param> &params,
                  bool show_misses) {
    gl::CacheSettings settings;
    settings.show_misses = show_misses;
    settings.weigh = !show_misses; // who looks at the misses wants to see the cache at work
    const std::size_t cells = view_.store().cells();
    if (!view_.draw(inputs, params, settings)) return false;
    if (view_.store().cells() != cells) gl::start_again(choice); // it has grown, and learns anew
    ++frames_;
    return true;
}

void Cached::count() {
    figures_.tally = view_.read_tally();
    figures_.counts = view_.store().read_counts();
    figures_.choice = choice;
    figures_.looked_up = view_.looked_up();
    if (counted_++ % count_cells_every == 0 || settled())
        figures_.occupancy = gl::occupancy(view_.store().dump(false));
}

std::string Cached::words() const {
    return fmt::format("noise cache: {} found, {} missed (red)", figures_.tally.hits,
                       figures_.tally.misses);
}

} // namespace fathom::viewer
