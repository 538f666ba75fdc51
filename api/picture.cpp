#include "api/impl.h"

#include "backend-cpu/trace/march.h"

namespace fathom::v1 {

Picture draw(const Scene &scene, const PictureOptions &options) {
    constexpr int max_side = 65536;
    Picture empty;
    if (options.width < 1 || options.height < 1 || options.width > max_side ||
        options.height > max_side || options.samples < 1)
        return empty;
    return guarded(
        [&] {
            const ir::Scene &from = ir_of(scene);
            const double aspect = static_cast<double>(options.width) / options.height;
            const cpu::Stage stage = cpu::prepare(from, ir::view_of(from, options.time, aspect),
                                                  options.width, options.height, options.time);
            cpu::PictureOptions to;
            to.samples = options.samples;
            to.jobs = options.threads;
            cpu::Picture made =
                cpu::render(stage, to, [&](double done, const cpu::Tile &, const cpu::Picture &) {
                    return !options.progress || options.progress(done);
                });
            return Picture{made.width, made.height, std::move(made.rgba), made.complete};
        },
        [&](const Diagnostic &) { return empty; });
}

} // namespace fathom::v1
