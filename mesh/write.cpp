#include "mesh/write.h"

#include "base/picture.h"
#include "mesh/bytes.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <set>

namespace fathom::mesh {
namespace {

std::string stl_of(std::span<const Surface> objects) {
    constexpr std::size_t head = 80, triangle = 50;
    std::size_t count = 0;
    for (const Surface &mesh : objects) count += mesh.triangles.size();
    std::string bytes;
    bytes.reserve(head + 4 + triangle * count);
    bytes = "Binary STL by Fathom"; // never begins with `solid`, as texts do
    bytes.resize(head, ' ');
    put(bytes, static_cast<std::uint32_t>(count));
    for (const Surface &mesh : objects)
        for (const Triangle &t : mesh.triangles) {
            put(bytes, face_normal(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]));
            for (const std::uint32_t v : t) put(bytes, mesh.vertices[v]);
            put(bytes, std::uint16_t{0});
        }
    return bytes;
}

std::string ply_of(std::span<const Surface> objects) {
    std::size_t vertices = 0, triangles = 0;
    bool colored = !objects.empty();
    for (const Surface &mesh : objects) {
        vertices += mesh.vertices.size(), triangles += mesh.triangles.size();
        colored = colored && !mesh.colors.empty();
    }
    std::string bytes = fmt::format(
        "ply\nformat binary_little_endian 1.0\ncomment by Fathom\n"
        "element vertex {}\nproperty float x\nproperty float y\nproperty float z\n{}"
        "element face {}\nproperty list uchar uint vertex_indices\nend_header\n",
        vertices, colored ? "property uchar red\nproperty uchar green\nproperty uchar blue\n" : "",
        triangles);
    bytes.reserve(bytes.size() + 15 * vertices + 13 * triangles);
    for (const Surface &mesh : objects)
        for (std::size_t k = 0; k < mesh.vertices.size(); ++k) {
            put(bytes, mesh.vertices[k]);
            if (colored)
                for (const float c : mesh.colors[k]) put(bytes, srgb_byte(c));
        }
    std::uint32_t first = 0;
    for (const Surface &mesh : objects) {
        for (const Triangle &t : mesh.triangles) {
            put(bytes, std::uint8_t{3});
            for (const std::uint32_t v : t) put(bytes, first + v);
        }
        first += static_cast<std::uint32_t>(mesh.vertices.size());
    }
    return bytes;
}

} // namespace

Corners corners_of(const Surface &mesh) {
    Corners corners;
    corners.normals.assign(mesh.normals.begin(), mesh.normals.end());
    corners.indices.reserve(mesh.triangles.size());
    for (const Triangle &t : mesh.triangles) {
        const Point face =
            face_normal(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
        Triangle index = t;
        std::uint32_t own = 0; // the triangle's normal, once it is there
        for (std::size_t k = 0; k < 3; ++k) {
            if (!at_crease(mesh.normals[t[k]], face) || mesh.normals[t[k]] == face) continue;
            if (own == 0) {
                own = static_cast<std::uint32_t>(corners.normals.size());
                corners.normals.push_back(face);
            }
            index[k] = own;
        }
        corners.indices.push_back(index);
    }
    return corners;
}

MaterialTable table_of(std::span<const Surface> objects) {
    MaterialTable table;
    std::vector<Material> met; // as they were given
    for (const Surface &mesh : objects) {
        std::vector<std::uint32_t> &places = table.places.emplace_back();
        for (const Material &material : mesh.materials) {
            const auto same = std::ranges::find(met, material);
            places.push_back(static_cast<std::uint32_t>(same - met.begin()));
            if (same == met.end()) met.push_back(material);
        }
    }
    std::set<std::string> taken;
    std::map<std::string, int> counts;
    for (Material &material : met) {
        const std::string name = material.name;
        int &count = counts[name];
        for (++count; count > 1 || !taken.insert(name).second; ++count) {
            if (count == 1) continue;
            material.name = fmt::format("{}.{}", name, count);
            if (taken.insert(material.name).second) break;
        }
    }
    table.materials = std::move(met);
    return table;
}

Point corner_color(const Surface &mesh, std::size_t triangle, std::size_t corner) {
    if (!mesh.corners.empty()) return mesh.corners[triangle][corner];
    if (!mesh.colors.empty()) return mesh.colors[mesh.triangles[triangle][corner]];
    return {1, 1, 1};
}

std::optional<Point> only_color(const Surface &mesh) {
    if (mesh.colors.empty() || mesh.triangles.empty()) return std::nullopt;
    const Point first = corner_color(mesh, 0, 0);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (std::size_t c = 0; c < 3; ++c)
            if (corner_color(mesh, t, c) != first) return std::nullopt;
    return first;
}

std::string file_of(std::span<const Surface> objects, Format format, const FileOptions &options) {
    switch (format) {
    case Format::Stl: return stl_of(objects);
    case Format::Obj: return obj_of(objects, options);
    case Format::Ply: return ply_of(objects);
    case Format::Glb: return glb_of(objects, options);
    case Format::ThreeMf: return three_mf_of(objects, options);
    }
    return "";
}

} // namespace fathom::mesh
