// The bytes of mesh files. Coordinates are the mesh's floats, unchanged, in every format; lengths
// are the scene's, and so are the axes.
#pragma once

#include "mesh/polygons.h"

#include <span>
#include <string>

namespace fathom::mesh {

// A mesh that lies elsewhere, as Mesh.
struct Surface {
    std::span<const Point> vertices, normals;
    std::span<const std::array<std::uint32_t, 3>> triangles;
};

enum class Format : std::uint8_t {
    Stl, // binary: triangles with their normals
    Obj, // text: shared vertices, normals by corner
    Ply, // binary, little-endian: shared vertices
    Glb  // glTF 2.0 in one file: vertices by corner normal, one material
};

// `name`: what the object is called where the format has names. Empty where the format cannot hold so
// much: a GLB has at most 4 GiB.
std::string file_of(const Surface &mesh, Format format, std::string_view name);

} // namespace fathom::mesh
