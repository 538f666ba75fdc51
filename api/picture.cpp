#include "api/impl.h"

#include "backend-cpu/trace/march.h"

namespace fathom::v1 {

Picture draw(const Scene &scene, const PictureOptions &options) {
    constexpr int max_side = 65536;
    Picture empty;
    if (options.width < 1 || options.height < 1 || options.width > max_side ||
        options.height > max_side || options.samples < 0)
        return empty;
    return guarded(
        [&] {
            const ir::Scene &from = ir_of(scene);
            const double aspect = static_cast<double>(options.width) / options.height;
            cpu::Stage stage = cpu::prepare(from, ir::view_of(from, options.time, aspect),
                                            options.width, options.height, options.time);
            if (options.max_steps > 0) stage.budget = options.max_steps;
            cpu::PictureOptions to;
            to.samples = options.samples;
            to.jobs = options.threads;
            cpu::Picture made =
                cpu::render(stage, to, [&](double done, const cpu::Tile &, const cpu::Picture &) {
                    return !options.progress || options.progress(done);
                });
            return Picture{made.width,    made.height,         std::move(made.rgba),
                           made.complete, made.work.undecided, made.work.undecided_shadows};
        },
        [&](const Diagnostic &) { return empty; });
}

} // namespace fathom::v1
