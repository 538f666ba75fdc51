/** @file
 *  A scene's surface as a mesh of triangles, and the bytes of mesh files.
 *
 *  @code
 *  #include <fathom/mesh.h>
 *  #include <cstdio>
 *
 *  int main() {
 *      const auto result = fathom::compile_text("ring.sdf", "torus(1, 0.3)\n");
 *      if (!result) return 1;
 *      fathom::MeshOptions options;
 *      options.resolution = 24;
 *      const fathom::Mesh mesh = fathom::make_mesh(*result.scene, options);
 *      if (!mesh) return std::fprintf(stderr, "%s\n", mesh.message.c_str()), 1;
 *      const std::string stl = fathom::mesh_file(mesh, fathom::MeshFormat::Stl);
 *      std::printf("%zu triangles, %zu bytes\n", mesh.triangles.size(), stl.size());
 *      return stl.size() == 84 + 50 * mesh.triangles.size() ? 0 : 1;
 *  }
 *  @endcode
 */
#pragma once

#include <fathom/scene.h>

#include <cstdint>
#include <span>

namespace fathom::FATHOM_V1 {

/** How fine a mesh is, and of what. */
struct MeshOptions {
    /** The side of the cells that the surface is drawn by, at most, in the scene's units; the surface
     *  and the mesh are that near to each other, but where cells are undecided
     *  (docs/meshes.md). 0: by `resolution`. */
    double tolerance = 0;
    int resolution = 128;      /**< cells along the longest side of the solid's box, 1 to 8,000 */
    std::optional<Box> bounds; /**< finite: the solid is cut off there */
    double time = 0;           /**< seconds, at which the scene's facts hold (`hold_at`) */
    unsigned threads = 0;      /**< 0: as many as the machine has cores */
    bool certify = false;      /**< prove what `Mesh::certificate` says; takes longer */
    bool colors = false;       /**< also `Mesh::colors` */
    /** Fewer triangles: every point of the mesh with those of the cells has a point of the new one as
     *  near as this, in the scene's units; a certificate is of the new one. 0: none are left out. */
    double simplify = 0;
    /** Called now and then by one thread at a time, with the share that is done; false cancels. */
    std::function<bool(double done)> progress;
};

/** What came of it. */
enum class MeshStatus {
    Done,
    Cancelled,
    Empty,     /**< no point lies in the solid, or none of those in `bounds` */
    TooCoarse, /**< something may lie in it, but no corner of the finest cells */
    Endless,   /**< no box holds the solid: `bounds` cuts it off */
    TooFine,   /**< more than 8,192 cells a side, or than are counted, or single precision cannot
                *   tell them apart */
    TooLarge,  /**< more than there is memory for */
    Contradicted, /**< signs of the field are not as was stated: `estimate:` or `lipschitz:` is wrong */
    BadOptions /**< no mesh can have these options */
};

/** What is proved of a mesh, and what of it is a number of the mesh alone. docs/meshes.md has the
 *  argument, and what it rests on. */
struct MeshCertificate {
    /** The two distances hold everywhere, no cell is undecided, no place of the mesh unproved; and
     *  `shape_doubted` is false. */
    bool certified = false;
    /** Every point of the mesh has surface as near as this; every point of the surface has mesh as
     *  near as this, but for the undecided cells and the unproved places. */
    double mesh_to_surface = 0, surface_to_mesh = 0;
    /** Cells with places where parts of the solid touch, or are no farther apart than `seam_width`:
     *  what surface there may be between them is not in the mesh. */
    std::size_t seam_cells = 0;
    double seam_width = 0;
    std::size_t unproved_places = 0; /**< pieces of triangles without surface found near them */
    std::size_t components = 0;      /**< of the mesh */
    long genus = 0;                  /**< of the mesh, all its components together */
    /** It is proved that the solid's surface has as many components as the mesh, and handles. Else it
     *  is open in `shape_open` cells, one of them about `shape_place`; in none where it was not
     *  looked for, as where walls thinner than cells were drawn wider. `shape_why` says why, and what
     *  to write; it is empty where it is proved. In lower case. */
    bool shape_proved = false;
    std::string shape_why;
    std::size_t shape_open = 0;
    std::array<double, 3> shape_place{};
    /** Walls, gaps or edges are seen that cells are too large for: the solid may have another number
     *  of pieces and handles. `Mesh::message` says what shows them. */
    bool shape_doubted = false;
    /** The solid's volume lies between these. */
    double least_volume = 0, largest_volume = 0;
    /** So does the area of its surface. `largest_area` is infinite where in `open_places` of the
     *  smallest boxes it is not known how the surface runs, one of them about `open_place`;
     *  `area_why` says why, and what looks closer. */
    double least_area = 0, largest_area = 0;
    std::size_t open_places = 0;
    std::array<double, 3> open_place{};
    std::string area_why;
    /** Whether `largest_area` was looked for: not where the field's operations in all open cells are
     *  too many. `measure` looks for it all the same. */
    bool looked_for_area = true;
    double mesh_volume = 0, mesh_area = 0; /**< of the triangles */
    /** `intervals`, `single-precision`; `bound` where the proved bound left cells out. */
    std::vector<std::string> rests_on;
};

/** How the triangles of one paint look. Colours are linear, 0..1; `emission` may be more. */
struct MeshMaterial {
    /** What `material(name: ...)` calls it; else its colour, as `d94f2b`, or
     *  `paint` where it has several; `unpainted` where nobody painted. */
    std::string name;
    std::array<float, 3> diffuse{}, specular{}, emission{};
    float exponent = 0; /**< of Phong's highlight */
    /** The diffuse colour differs from corner to corner (`Mesh::corner_colors`); `diffuse` is its
     *  mean. */
    bool colored = false;
    /** So do `specular`, `emission` or `exponent`, whose means stand here. */
    bool varies = false;
};

/** What MeshOptions::simplify did. */
struct MeshSimplification {
    std::size_t triangles_before = 0;
    /** Of these, so many were not touched, since the colours of their corners differ: there paints
     *  meet. With MeshOptions::colors. */
    std::size_t colored_triangles = 0;
    /** So often a part of the mesh was done again, more carefully, or left as it was, since a check of
     *  it failed. */
    std::size_t refused = 0;
    bool undone =
        false; /**< the mesh is as it was: fewer triangles would have been another shape */
};

/** A closed, oriented 2-manifold that does not cross itself (docs/meshes.md says why). Vertices are
 *  single-precision coordinates in the scene's units and axes; `normals`, one a vertex, are means
 *  of the distance's gradients about there, of length 1, also at creases; `triangles` are
 *  counterclockwise as seen from outside. The same bytes on every machine and for any number of
 *  threads. Empty unless `status` is Done. */
struct Mesh {
    MeshStatus status = MeshStatus::Done;
    /** Why there is none; or what shows undecided cells; or how thin walls and gaps are that cells are
     *  too large for: there may be holes in them, also where a certificate says how far the mesh is
     *  from the surface. In lower case. */
    std::string message;
    std::vector<Point> vertices, normals;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    /** With MeshOptions::colors: the surface's own colour at each vertex, linear, 0..1, without light
     *  and highlights. A vertex has one colour: where two paints meet, they run into each other over
     *  a triangle. */
    std::vector<std::array<float, 3>> colors;
    /** With MeshOptions::colors, too: the paints of the surface; which of them each triangle has; and
     *  what that paint's colour is at each corner, so that paints end at the edges of triangles. */
    std::vector<MeshMaterial> materials;
    std::vector<std::uint32_t> material_of;
    std::vector<std::array<std::array<float, 3>, 3>> corner_colors;
    /** Cells in which there may be surface that the mesh does not show, since the bound is too loose
     *  to tell, or since what is there is thinner than the finest cells; the first 1,000 of them.
     *  With a certificate those in which surface may be farther from the mesh than a cell's side. */
    std::vector<Box> undecided;
    std::size_t undecided_cells = 0;                  /**< all of them */
    std::optional<MeshCertificate> certificate;       /**< with MeshOptions::certify */
    std::optional<MeshSimplification> simplification; /**< with MeshOptions::simplify */
    explicit operator bool() const { return status == MeshStatus::Done; }
};

/** Of a mesh's triangles; nothing of them is proved of the solid. */
struct MeshNumbers {
    std::size_t components = 0;
    long genus = 0; /**< all components together */
    double volume = 0, area = 0;
};
FATHOM_API MeshNumbers numbers_of(const Mesh &mesh) noexcept;

/** Never throws. Takes some 500 bytes of memory a triangle meanwhile. */
FATHOM_API Mesh make_mesh(const Scene &scene, const MeshOptions &options = {}) noexcept;

/** The formats of mesh files: binary STL, Wavefront OBJ, binary PLY, binary glTF 2.0, 3D Manufacturing
 *  Format. Only OBJ and GLB hold normals: each corner's, with creases of 30 degrees and more sharp.
 *  All but STL hold colours. A 3MF has z up, as printers do: (x, y, z) stands there as (x, -z, y). */
enum class MeshFormat { Stl, Obj, Ply, Glb, ThreeMf };

/** What a length of 1 is, for the formats that say it: 3MF (Unsaid: millimetres), and GLB (Unsaid:
 *  metres, in which it counts; else its object is scaled). */
enum class MeshUnit { Unsaid, Micron, Millimetre, Centimetre, Metre, Inch, Foot };

/** By a file name's suffix, `.stl`, `.obj`, `.ply`, `.glb` or `.3mf` in either case; or nothing. */
FATHOM_API std::optional<MeshFormat> mesh_format(std::string_view file_name) noexcept;

/** A mesh as an object of a file. */
struct MeshObject {
    std::string name;
    const Mesh *mesh = nullptr; /**< not none */
};

/** What a file says beside its meshes. */
struct MeshFileOptions {
    MeshUnit unit = MeshUnit::Unsaid;
    std::string name = "scene";   /**< of several objects together */
    std::string material_library; /**< of an OBJ: the name of the MTL file beside it; empty: none */
};

/** The bytes of a file of several objects: nodes of a GLB, below one; the components of one object of a
 *  3MF; `o` of an OBJ. An STL and a PLY hold all of them as one. Empty as below. */
FATHOM_API std::string mesh_file(const std::vector<MeshObject> &objects, MeshFormat format,
                                 const MeshFileOptions &options) noexcept;
/** The bytes of the MTL file that an OBJ of these objects names. */
FATHOM_API std::string material_library(const std::vector<MeshObject> &objects) noexcept;

/** The bytes of a file. `name`: the object's, where the format has one. Empty where there is no memory
 *  for it, or more than the format holds (a GLB: 4 GiB). */
FATHOM_API std::string mesh_file(const Mesh &mesh, MeshFormat format,
                                 std::string_view name = "scene",
                                 MeshUnit unit = MeshUnit::Unsaid) noexcept;

} // namespace fathom::FATHOM_V1
