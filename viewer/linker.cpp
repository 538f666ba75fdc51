#include "viewer/linker.h"

#include <chrono>
#include <fmt/format.h>

namespace fathom::viewer {

bool Linker::same_data(const glsl::Output &output, const ir::Scene &scene) const {
    if (output.tables.size() != table_floats_) return false;
    if (output.images.size() != images_.size() || output.grids.size() != grids_.size())
        return false;
    for (std::size_t i = 0; i < images_.size(); ++i) {
        const ir::ImageData &image = scene.images[output.images[i].index];
        if (image.width != images_[i].width || image.height != images_[i].height ||
            image.rgba != images_[i].rgba)
            return false;
    }
    for (std::size_t i = 0; i < grids_.size(); ++i) {
        const ir::GridData &grid = scene.grids[output.grids[i].index];
        if (grid.size != grids_[i].size || grid.values != grids_[i].values) return false;
    }
    return true;
}

Link Linker::link(const glsl::Output &output, const ir::Scene &scene) {
    Link result;
    Slots fresh{output.text, {}};
    if (linked_ && same_data(output, scene)) {
        if (auto values = values_in(slots_, output.text)) {
            result.edited = std::move(*values);
            return result;
        }
        if (auto wider = widened(slots_, output.text)) fresh = std::move(*wider);
    }
    const auto start = std::chrono::steady_clock::now();
    auto build = [&] {
        glsl::Output text = output;
        text.text = text_with_slots(fresh);
        return gl::Program::build(text, scene);
    };
    auto built = build();
    if (std::holds_alternative<gl::ProgramError>(built) && !fresh.edited.empty()) {
        fresh.edited.clear(); // a literal stood where only constants may: then it stays one
        built = build();
    }
    if (const auto *error = std::get_if<gl::ProgramError>(&built)) {
        result.error = fmt::format(
            "error[shader-invalid]: the graphics driver refuses the shader: {}\n  line {}: {}",
            error->message, error->line, error->source_line);
        return result;
    }
    result.program = std::move(std::get<gl::Program>(built));
    result.edited = *values_in(fresh, output.text);
    result.program->set_edited(result.edited);
    result.program->warm_up(scene.params);
    result.driver_ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    linked_ = true;
    slots_ = std::move(fresh);
    table_floats_ = output.tables.size();
    images_.clear();
    for (const glsl::Sampler &sampler : output.images)
        images_.push_back(scene.images[sampler.index]);
    grids_.clear();
    for (const glsl::Sampler &sampler : output.grids) grids_.push_back(scene.grids[sampler.index]);
    return result;
}

} // namespace fathom::viewer
