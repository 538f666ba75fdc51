#include <fathom/measure.h>

#include "api/mesh.h"
#include "api/mesh_advice.h"
#include "mesh/certify.h"
#include "mesh/clearance.h"

#include <cmath>

namespace fathom::v1 {
namespace {

template <class Result> Result without(Refusal why) {
    Result result;
    result.status = why.status;
    result.message = std::move(why.message);
    return result;
}

Enclosure enclosure_of(const fathom::mesh::Enclosure &of) { return {of.lo, of.hi}; }

Box box_of(const std::vector<fathom::mesh::Point> &points) {
    Box box{points[0], points[0]};
    for (const Point &p : points)
        for (std::size_t i = 0; i < 3; ++i) {
            box.lo[i] = std::min(box.lo[i], p[i]);
            box.hi[i] = std::max(box.hi[i], p[i]);
        }
    return box;
}

Measures measured(const Scene &scene, const MeshOptions &options) {
    constexpr double share = 0.5; // the mesh's, of the time
    const fathom::mesh::Settings settings = settings_of(options, share);
    const fathom::mesh::Made made = fathom::mesh::make_mesh(ir_of(scene), settings);
    if (made.failure != fathom::mesh::Failure::None)
        return without<Measures>(refusal_of(made, settings));
    fathom::mesh::Progress progress;
    progress.report = options.progress;
    progress.from = share;
    const fathom::mesh::Measures found =
        fathom::mesh::measure(ir_of(scene), settings, made, progress);
    if (progress.cancelled) return without<Measures>(refusal_of(fathom::mesh::Failure::Cancelled));
    Measures result;
    result.volume = enclosure_of(found.volume);
    result.area = enclosure_of(found.area);
    result.open_places = found.open_places;
    result.open_place = found.open_place;
    for (std::size_t i = 0; i < 3; ++i) {
        result.center[i] = enclosure_of(found.center[i]);
        result.least[i] = enclosure_of(found.least[i]);
        result.greatest[i] = enclosure_of(found.greatest[i]);
    }
    const fathom::mesh::MeshSums sums = fathom::mesh::sums_of(made.mesh);
    result.mesh_volume = sums.volume;
    result.mesh_area = sums.area;
    result.mesh_center = sums.center;
    result.mesh_box = box_of(made.mesh.vertices);
    const fathom::mesh::Form form = fathom::mesh::form_of(made.mesh);
    result.components = form.components;
    result.genus = form.genus;
    result.rests_on = rests_on(found.used_bound);
    result.message = advice_on_drawn(ir_of(scene), settings, made);
    return result;
}

} // namespace

Measures measure(const Scene &scene, const MeshOptions &options) noexcept {
    if (Refusal why = refusal_of(scene, options)) return without<Measures>(std::move(why));
    return guarded([&] { return measured(scene, options); },
                   [](const Diagnostic &why) {
                       return without<Measures>({MeshStatus::TooLarge, why.message});
                   });
}

Clearance clearance(const Scene &a, const Scene &b, double tolerance, double time,
                    const std::function<bool(double)> &progress) noexcept {
    MeshOptions options;
    options.time = time;
    options.tolerance = tolerance;
    for (const Scene *scene : {&a, &b})
        if (Refusal why = refusal_of(*scene, options)) return without<Clearance>(std::move(why));
    if (!(tolerance > 0))
        return without<Clearance>({MeshStatus::BadOptions, "a tolerance is a number above 0"});
    return guarded(
        [&] {
            fathom::mesh::Progress told;
            told.report = progress;
            const fathom::mesh::Clearance found =
                fathom::mesh::clearance(ir_of(a), ir_of(b), time, tolerance, told);
            if (Refusal why = refusal_of(found.failure)) return without<Clearance>(std::move(why));
            Clearance result;
            result.distance = enclosure_of(found.distance);
            result.near = found.near;
            result.rests_on = rests_on(found.used_bound);
            return result;
        },
        [](const Diagnostic &why) {
            return without<Clearance>({MeshStatus::TooLarge, why.message});
        });
}

} // namespace fathom::v1
