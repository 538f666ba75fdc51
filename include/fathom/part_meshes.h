/** @file
 *  Each part of a scene as a closed mesh of its own.
 *
 *  @code
 *  #include <fathom/part_meshes.h>
 *  #include <cstdio>
 *
 *  int main() {
 *      const auto result = fathom::compile_text(
 *          "pair.sdf", "sphere(1)\nbox(1).translate(x: 0.8)\nbox(1).translate(x: 6)\n");
 *      if (!result) return 1;
 *      fathom::MeshOptions options;
 *      options.resolution = 60;
 *      const fathom::PartMeshes made = fathom::make_part_meshes(*result.scene, options);
 *      if (!made) return std::fprintf(stderr, "%s\n", made.message.c_str()), 1;
 *      std::vector<fathom::MeshObject> objects;
 *      for (const fathom::PartMesh &part : made.parts) objects.push_back({part.name, &part.mesh});
 *      const std::string glb = fathom::mesh_file(objects, fathom::MeshFormat::Glb, {});
 *      std::printf("%zu objects, %zu overlaps\n", objects.size(), made.overlaps.size());
 *      return objects.size() == 3 && made.overlaps.size() == 1 && !glb.empty() ? 0 : 1;
 *  }
 *  @endcode
 */
#pragma once

#include <fathom/mesh.h>
#include <fathom/parts.h>

namespace fathom::FATHOM_V1 {

/** A part and its mesh: all of its surface, also where that lies in other parts. */
struct PartMesh {
    std::string name; /**< Part::name */
    Place at;
    Mesh mesh;
};

/** A point that lies in two parts: `parts[first]` and `parts[second]`, first < second. */
struct PartOverlap {
    std::size_t first = 0, second = 0;
    Point at;
};

/** In the order of the text. */
struct PartMeshes {
    MeshStatus status =
        MeshStatus::Done; /**< of the first part that has no mesh and is not empty */
    std::string message;
    std::vector<PartMesh> parts;
    std::vector<Part> empty; /**< those that hold no point */
    /** A pair for each two parts of which a vertex of one lies in the other, a quarter of a cell deep
     *  or more. Two parts that are not listed may overlap by less than that, or between vertices. */
    std::vector<PartOverlap> overlaps;
    /** Not all pairs were looked at: that would have taken more than 50 million evaluations. */
    bool overlaps_incomplete = false;
    explicit operator bool() const { return status == MeshStatus::Done; }
};

/** Never throws. `options.resolution` counts cells along the longest side of the whole solid's box; a
 *  part has 16 along its own at least. A scene none of whose parts holds a point is Empty. */
FATHOM_API PartMeshes make_part_meshes(const Scene &scene,
                                       const MeshOptions &options = {}) noexcept;

} // namespace fathom::FATHOM_V1
