// The bytes of mesh files. Coordinates are the mesh's floats, unchanged, and so are the axes; but a 3MF
// has z up as printers do, so there (x, y, z) is (x, -z, y).
#pragma once

#include "mesh/polygons.h"

#include <optional>
#include <span>
#include <string>

namespace fathom::mesh {

// A mesh that lies elsewhere, as Mesh.
struct Surface {
    std::span<const Point> vertices, normals;
    std::span<const std::array<std::uint32_t, 3>> triangles;
    std::span<const Point> colors; // by vertex, linear, 0..1; or none
};

enum class Format : std::uint8_t {
    Stl,    // binary: triangles with their normals
    Obj,    // text: shared vertices with their colours, normals by corner
    Ply,    // binary, little-endian: shared vertices with their colours
    Glb,    // glTF 2.0 in one file: vertices by corner normal, one material
    ThreeMf // 3D Manufacturing Format: shared vertices, colours by corner
};

// What a length of 1 in the scene is, for the formats that say it: a 3MF names it, and in a GLB, which
// counts metres, the object is scaled. Unsaid: 3MF's millimetres, GLB's metres.
enum class Unit : std::uint8_t { Unsaid, Micron, Millimetre, Centimetre, Metre, Inch, Foot };

// `name`: what the object is called where the format has names. Empty where the format cannot hold so
// much: a GLB has at most 4 GiB.
std::string file_of(const Surface &mesh, Format format, std::string_view name,
                    Unit unit = Unit::Unsaid);

// The colour of all vertices, where they have one and the same.
std::optional<Point> only_color(const Surface &mesh);
// The bytes of a 3MF: file_of's.
std::string three_mf_of(const Surface &mesh, std::string_view name, Unit unit);

} // namespace fathom::mesh
