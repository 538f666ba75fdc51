// The bytes of mesh files. Coordinates are the mesh's floats, unchanged, and so are the axes; but a 3MF
// has z up as printers do, so there (x, y, z) is (x, -z, y).
#pragma once

#include "mesh/appearance.h"

#include <optional>
#include <span>
#include <string>

namespace fathom::mesh {

using Triangle = std::array<std::uint32_t, 3>;

// A mesh that lies elsewhere, as Mesh and Appearance; what there is of these may be empty.
struct Surface {
    std::span<const Point> vertices, normals;
    std::span<const Triangle> triangles;
    std::span<const Point> colors; // by vertex
    std::span<const std::array<Point, 3>> corners;
    std::span<const Material> materials;
    std::span<const std::uint32_t> material_of; // by triangle
    std::string_view name;                      // of this object
};

enum class Format : std::uint8_t {
    Stl,    // binary: triangles with their normals
    Obj,    // text: shared vertices with their colours, normals by corner, materials
    Ply,    // binary, little-endian: shared vertices with their colours
    Glb,    // glTF 2.0 in one file: vertices by corner normal and colour, a primitive a material
    ThreeMf // 3D Manufacturing Format: shared vertices, colours by corner
};

// What a length of 1 in the scene is, for the formats that say it: a 3MF names it, and in a GLB, which
// counts metres, the object is scaled. Unsaid: 3MF's millimetres, GLB's metres.
enum class Unit : std::uint8_t { Unsaid, Micron, Millimetre, Centimetre, Metre, Inch, Foot };

struct FileOptions {
    Unit unit = Unit::Unsaid;
    std::string_view name = "scene"; // of several objects together
    std::string_view library;        // of an OBJ: the file of its materials; none: it names none
};

// One object for each surface, or all in one where the format has no objects (STL, PLY). Empty where
// the format cannot hold so much: a GLB has at most 4 GiB.
std::string file_of(std::span<const Surface> objects, Format format,
                    const FileOptions &options = {});
// The materials of an OBJ (MTL).
std::string material_library_of(std::span<const Surface> objects);

// The colour of all of a surface, where it has one and the same.
std::optional<Point> only_color(const Surface &mesh);

// file_of's, each in a source of its own.
std::string obj_of(std::span<const Surface> objects, const FileOptions &options);
std::string glb_of(std::span<const Surface> objects, const FileOptions &options);
std::string three_mf_of(std::span<const Surface> objects, const FileOptions &options);

// What several of them need.

// Normals and where each corner finds its own.
struct Corners {
    std::vector<Point> normals;
    std::vector<Triangle> indices;
};
Corners corners_of(const Surface &mesh);

// The materials of several objects, equal ones once, each name once; and of each object where its
// own ones stand.
struct MaterialTable {
    std::vector<Material> materials;
    std::vector<std::vector<std::uint32_t>> places; // by object, by its material
};
MaterialTable table_of(std::span<const Surface> objects);

// The roughness, as glTF has it, whose highlight is as wide as Phong's of that exponent n: a Phong
// lobe about the mirrored direction is as wide as Blinn's with 4n about the half vector (Walter,
// Marschner, Li and Torrance 2007: 2/a^2 - 2 of a Beckmann lobe), and glTF's a is the roughness
// squared. So it is (2n + 1)^(-1/4).
float roughness_of(float exponent);

// The colour of a triangle's corner; white where there is none.
Point corner_color(const Surface &mesh, std::size_t triangle, std::size_t corner);

} // namespace fathom::mesh
