#include "mesh/appearance.h"

#include "backend-cpu/trace/march.h"
#include "base/picture.h"
#include "ir/lower/lower.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace fathom::mesh {
namespace {

using cpu::Look;

Point clamped(const Point &color) {
    Point inside{};
    for (std::size_t i = 0; i < 3; ++i) inside[i] = color[i] > 0 ? std::min(color[i], 1.0f) : 0.0f;
    return inside;
}

// Emission has no upper end, but is finite.
Point at_least_none(const Point &color) {
    constexpr float most = 1e6f;
    Point inside{};
    for (std::size_t i = 0; i < 3; ++i) inside[i] = color[i] > 0 ? std::min(color[i], most) : 0.0f;
    return inside;
}

// Points with their normals, and which corner of the mesh each is: 3 * triangle + corner.
struct Asked {
    std::vector<Point> points, normals;
    std::vector<std::size_t> corners;
};

// From `from` so far to the triangle's middle.
Point towards_middle(const Mesh &mesh, std::size_t triangle, const Point &from, float share) {
    Point made{};
    for (std::size_t i = 0; i < 3; ++i) {
        float middle = 0;
        for (const std::uint32_t v : mesh.triangles[triangle]) middle += mesh.vertices[v][i] / 3;
        made[i] = from[i] + share * (middle - from[i]);
    }
    return made;
}

Point face_of(const Mesh &mesh, std::size_t triangle) {
    const auto &[a, b, c] = mesh.triangles[triangle];
    return face_normal(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
}

void ask(Asked &asked, const Mesh &mesh, std::size_t corner, float share) {
    const std::size_t triangle = corner / 3;
    asked.points.push_back(
        towards_middle(mesh, triangle, mesh.vertices[mesh.triangles[triangle][corner % 3]], share));
    asked.normals.push_back(face_of(mesh, triangle));
    asked.corners.push_back(corner);
}

// What a surface's properties are over the places where it was met.
struct SeenSurface {
    std::size_t count = 0;
    std::array<double, 10> sums{}, least{}, most{};
    void add(const Look &look) {
        std::array<double, 10> numbers{};
        for (std::size_t i = 0; i < 3; ++i) {
            numbers[i] = clamped(look.diffuse)[i];
            numbers[3 + i] = clamped(look.specular)[i];
            numbers[6 + i] = at_least_none(look.emission)[i];
        }
        numbers[9] = look.exponent > 0 ? std::min(look.exponent, 1e6f) : 0;
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            sums[i] += numbers[i];
            least[i] = count == 0 ? numbers[i] : std::min(least[i], numbers[i]);
            most[i] = count == 0 ? numbers[i] : std::max(most[i], numbers[i]);
        }
        ++count;
    }
    // The very number where all are one.
    float mean(std::size_t i) const {
        return static_cast<float>(differs(i, i + 1) ? sums[i] / static_cast<double>(count)
                                                    : least[i]);
    }
    bool differs(std::size_t from, std::size_t to) const {
        for (std::size_t i = from; i < to; ++i)
            if (least[i] != most[i]) return true;
        return false;
    }
};

std::string hexadecimal(const Point &color) {
    return fmt::format("{:02x}{:02x}{:02x}", srgb_byte(color[0]), srgb_byte(color[1]),
                       srgb_byte(color[2]));
}

Material material_of(const SeenSurface &seen, const std::string &name, bool unpainted) {
    Material made;
    for (std::size_t i = 0; i < 3; ++i) {
        made.diffuse[i] = seen.mean(i);
        made.specular[i] = seen.mean(3 + i);
        made.emission[i] = seen.mean(6 + i);
    }
    made.exponent = seen.mean(9);
    made.colored = seen.differs(0, 3);
    made.varies = seen.differs(3, 10);
    made.name = !name.empty()  ? name
                : unpainted    ? "unpainted"
                : made.colored ? "paint"
                               : hexadecimal(made.diffuse);
    return made;
}

// Looks depend on no view; a Stage has one.
cpu::Stage stage_of(const ir::Scene &scene, double time) {
    return cpu::prepare(scene, ir::view_of(scene, time, 1), 1, 1, time, cpu::Prune::Never);
}

std::vector<std::string> names_of_surfaces(const ir::Scene &scene) {
    const bool named = std::ranges::any_of(scene.shapes.materials,
                                           [](const ir::Material &m) { return !m.name.empty(); });
    return named ? ir::surface_names(scene) : std::vector<std::string>(scene.surfaces.size());
}

} // namespace

Point face_normal(const Point &a, const Point &b, const Point &c) {
    std::array<double, 3> u{}, v{};
    for (std::size_t i = 0; i < 3; ++i) {
        // Rounded as readers' own differences are, so that they find the same normal.
        u[i] = b[i] - a[i];
        v[i] = c[i] - a[i];
    }
    const std::array<double, 3> n{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                                  u[0] * v[1] - u[1] * v[0]};
    const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    Point unit{0, 0, 1};
    for (std::size_t i = 0; i < 3 && length > 0; ++i) unit[i] = static_cast<float>(n[i] / length);
    return unit;
}

bool at_crease(const Point &vertex_normal, const Point &face) {
    const double cosine = double(vertex_normal[0]) * face[0] + double(vertex_normal[1]) * face[1] +
                          double(vertex_normal[2]) * face[2];
    return !(cosine > crease_cosine);
}

std::vector<Point> colors_of(const ir::Scene &scene, double time, const Mesh &mesh, double arm) {
    std::vector<Point> colors;
    const cpu::Stage stage = stage_of(scene, time);
    for (const Look &look :
         cpu::looks_at(stage, mesh.vertices, mesh.normals, static_cast<float>(arm)))
        colors.push_back(clamped(look.diffuse));
    return colors;
}

Appearance appearance_of(const ir::Scene &scene, double time, const Mesh &mesh, double arm) {
    const cpu::Stage stage = stage_of(scene, time);
    const auto looks = [&](const Asked &asked) {
        return cpu::looks_at(stage, asked.points, asked.normals, static_cast<float>(arm));
    };
    const std::vector<Look> at =
        cpu::looks_at(stage, mesh.vertices, mesh.normals, static_cast<float>(arm));
    Appearance made;
    for (const Look &look : at) made.colors.push_back(clamped(look.diffuse));

    // The paint of each triangle.
    const std::size_t count = mesh.triangles.size();
    std::vector<std::int32_t> surface(count);
    std::vector<Look> middle_looks;
    Asked middles;
    for (std::size_t t = 0; t < count; ++t) {
        const auto &[a, b, c] = mesh.triangles[t];
        surface[t] = at[a].surface;
        if (at[b].surface != surface[t] || at[c].surface != surface[t])
            ask(middles, mesh, 3 * t, 1);
    }
    middle_looks = looks(middles);
    std::map<std::size_t, std::size_t> middle_of; // by triangle
    for (std::size_t k = 0; k < middle_looks.size(); ++k) {
        const std::size_t t = middles.corners[k] / 3;
        surface[t] = middle_looks[k].surface;
        middle_of[t] = k;
    }

    // The colours of its corners: at creases, and where the vertex has another paint, from a place
    // nearer to its middle.
    made.corners.resize(count);
    std::vector<std::size_t> open;
    std::vector<SeenSurface> seen(scene.surfaces.size());
    const auto take = [&](std::size_t corner, const Look &look) {
        made.corners[corner / 3][corner % 3] = clamped(look.diffuse);
        seen[static_cast<std::size_t>(look.surface)].add(look);
    };
    for (std::size_t t = 0; t < count; ++t) {
        const Point face = face_of(mesh, t);
        for (std::size_t c = 0; c < 3; ++c) {
            const std::uint32_t v = mesh.triangles[t][c];
            if (at[v].surface == surface[t] && !at_crease(mesh.normals[v], face))
                take(3 * t + c, at[v]);
            else
                open.push_back(3 * t + c);
        }
    }
    for (const float share : {0.0625f, 0.25f, 1.0f}) {
        Asked asked;
        for (const std::size_t corner : open) ask(asked, mesh, corner, share);
        const std::vector<Look> found = looks(asked);
        open.clear();
        for (std::size_t k = 0; k < found.size(); ++k) {
            const std::size_t corner = asked.corners[k];
            if (found[k].surface == surface[corner / 3])
                take(corner, found[k]);
            else if (share < 1)
                open.push_back(corner);
            else if (const auto middle = middle_of.find(corner / 3); middle != middle_of.end())
                take(corner, middle_looks[middle->second]);
            else // its three vertices have a paint that none of these places has
                take(corner, at[mesh.triangles[corner / 3][corner % 3]]);
        }
    }

    // What there is of materials, in the order of the surfaces.
    const std::vector<std::string> names = names_of_surfaces(scene);
    std::vector<std::uint32_t> place(scene.surfaces.size());
    for (std::size_t s = 0; s < seen.size(); ++s) {
        if (seen[s].count == 0) continue;
        place[s] = static_cast<std::uint32_t>(made.materials.size());
        made.materials.push_back(material_of(seen[s], names[s], s + 1 == seen.size()));
    }
    made.material_of.reserve(count);
    for (const std::int32_t s : surface)
        made.material_of.push_back(place[static_cast<std::size_t>(s)]);
    return made;
}

} // namespace fathom::mesh
