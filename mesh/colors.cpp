#include "mesh/colors.h"

#include "backend-cpu/trace/march.h"

#include <algorithm>

namespace fathom::mesh {

std::vector<Point> colors_of(const ir::Scene &scene, double time, const Mesh &mesh, double arm) {
    // Colours depend on no view; a Stage has one.
    const cpu::Stage stage =
        cpu::prepare(scene, ir::view_of(scene, time, 1), 1, 1, time, cpu::Prune::Never);
    std::vector<Point> colors =
        cpu::diffuse_colors(stage, mesh.vertices, mesh.normals, static_cast<float>(arm));
    for (Point &color : colors)
        for (float &c : color) c = c > 0 ? std::min(c, 1.0f) : 0.0f;
    return colors;
}

} // namespace fathom::mesh
