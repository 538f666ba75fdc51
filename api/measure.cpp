#include <fathom/measure.h>

#include "api/mesh.h"
#include "api/mesh_advice.h"
#include "mesh/certify.h"
#include "mesh/clearance.h"
#include "mesh/measure_flat.h"

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
    result.message = advice_on_drawn(ir_of(scene), settings, made, std::nullopt);
    return result;
}

FlatMeasures measured_flat(const Scene &scene, const MeshOptions &options) {
    using fathom::mesh::Failure;
    const double thickness = scene.impl().origin->options.flat_thickness;
    if (!(thickness > 0))
        return without<FlatMeasures>({MeshStatus::BadOptions,
                                      "the scene is of solids: a drawing is compiled by "
                                      "CompileOptions::flat_thickness"});
    fathom::mesh::Settings settings = settings_of(options);
    if (settings.bounds) settings.bounds->lo[2] = -thickness, settings.bounds->hi[2] = thickness;
    ir::Box box;
    if (Refusal why = refusal_of(fathom::mesh::box_of(ir_of(scene), settings, box)))
        return without<FlatMeasures>(std::move(why));
    const fathom::mesh::Cut cut(ir_of(scene), settings, box);
    const fathom::mesh::Section drawn = fathom::mesh::section(cut, 2, 0);
    if (Refusal why = refusal_of(drawn.failure, drawn.place))
        return without<FlatMeasures>(std::move(why));
    if (drawn.contours.empty())
        return without<FlatMeasures>(
            refusal_of(drawn.area.hi > 0 ? Failure::Unseen : Failure::Empty));
    fathom::mesh::Progress progress;
    progress.report = options.progress;
    const fathom::mesh::FlatMeasures found =
        fathom::mesh::measure_flat(cut, thickness / 4, threads_of(settings), progress);
    if (progress.cancelled) return without<FlatMeasures>(refusal_of(Failure::Cancelled));
    if (Refusal why = refusal_of(found.failure)) return without<FlatMeasures>(std::move(why));
    FlatMeasures result;
    result.area = enclosure_of(found.area);
    result.perimeter = enclosure_of(found.perimeter);
    result.open_places = found.open_places;
    result.open_place = found.open_place;
    const fathom::mesh::ContourSums sums = fathom::mesh::sums_of(drawn.contours);
    for (std::size_t i = 0; i < 2; ++i) {
        result.center[i] = enclosure_of(found.center[i]);
        result.least[i] = enclosure_of(found.least[i]);
        result.greatest[i] = enclosure_of(found.greatest[i]);
        result.contours_least[i] = sums.box.lo[i];
        result.contours_greatest[i] = sums.box.hi[i];
    }
    result.contours_area = sums.area;
    result.contours_perimeter = sums.perimeter;
    result.contours_center = sums.center;
    result.outlines = sums.outlines;
    result.holes = sums.holes;
    result.rests_on = rests_on(found.used_bound);
    return result;
}

} // namespace

FlatMeasures measure_flat(const Scene &scene, const MeshOptions &options) noexcept {
    if (Refusal why = refusal_of(scene, options)) return without<FlatMeasures>(std::move(why));
    return guarded([&] { return measured_flat(scene, options); },
                   [](const Diagnostic &why) {
                       return without<FlatMeasures>({MeshStatus::TooLarge, why.message});
                   });
}

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
