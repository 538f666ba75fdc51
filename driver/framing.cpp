// See framing.h.
#include "driver/framing.h"

#include "backend-cpu/prune/solid_box.h"

#include <cmath>

namespace fathom::driver {
namespace {

constexpr int moments = 16;         // of a scene that moves
constexpr double most_work = 200e6; // operations on boxes

// Spread over the whole time by the golden ratio, so that no period of the motion is met in step.
std::vector<double> times_of(const ir::Scene &scene, ir::FunctionId part) {
    std::vector<double> times{0};
    if (!scene.graph.reads(scene.graph.function(part).result).time) return times;
    constexpr double golden = 0.61803398874989485;
    for (int k = 1; k < moments; ++k)
        times.push_back(scene.render.time_end * (golden * k - std::floor(golden * k)));
    return times;
}

ir::Box over_time(const ir::Scene &scene, ir::FunctionId part, const ir::Box &domain,
                  double &work) {
    ir::Box box;
    for (const double time : times_of(scene, part))
        box = ir::hull(box, cpu::solid_box(scene, part, domain, time, work));
    return box;
}

} // namespace

void find_framing(ir::Scene &scene, Diagnostics &diagnostics) {
    if (scene.camera.given || scene.top_level.empty()) return;
    double work = most_work;
    if (scene.framed_together)
        scene.framed = over_time(scene, scene.framed_together, scene.framed, work);
    constexpr double far = cpu::endless_from;
    const ir::Box space{{-far, -far, -far}, {far, far, far}};
    bool endless = false;
    for (const ir::FunctionId part : scene.framed_alone) {
        const ir::Box box = over_time(scene, part, space, work);
        bool inside = true;
        for (std::size_t i = 0; i < 3; ++i)
            inside = inside && (box.empty() || (box.lo[i] > -far / 2 && box.hi[i] < far / 2));
        if (inside)
            scene.framed = ir::hull(scene.framed, box);
        else
            endless = true;
    }
    if (!scene.framed.empty() || work <= 0) return; // what was not found may be there
    const Span span = scene.top_level.front().span;
    if (endless)
        diagnostics
            .add(Code::NothingFramed, span,
                 "nothing of this scene has an end, so there is nothing to frame")
            .note("the view shows the surroundings of the origin")
            .help("write `camera(at: [3, 2, 5], look_at: [0, 0, 0])`, from where you want to see "
                  "it, or cut the solid off, as with `& box(10)`");
    else
        diagnostics
            .add(Code::NothingFramed, span, "this scene is empty: no point lies in the solid")
            .help("look for an intersection or a difference that leaves nothing over");
}

} // namespace fathom::driver
