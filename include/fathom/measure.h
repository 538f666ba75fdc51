/** @file
 *  What a solid measures: volume, area, centre, box, and how far two of them are apart; as numbers of
 *  a mesh, and as enclosures that are proved.
 *
 *  @code
 *  #include <fathom/measure.h>
 *  #include <cstdio>
 *
 *  int main() {
 *      const auto result = fathom::compile_text("box.sdf", "box([1, 2, 3])\n");
 *      if (!result) return 1;
 *      const fathom::Measures of = fathom::measure(*result.scene);
 *      if (!of) return std::fprintf(stderr, "%s\n", of.message.c_str()), 1;
 *      std::printf("volume %g, proved between %g and %g\n", of.mesh_volume, of.volume.lo, of.volume.hi);
 *      return of.volume.lo <= 6 && 6 <= of.volume.hi ? 0 : 1;
 *  }
 *  @endcode
 */
#pragma once

#include <fathom/mesh.h>

namespace fathom::FATHOM_V1 {

/** A number is proved to lie between these, both of them included. */
struct Enclosure {
    double lo = 0, hi = 0;
};

/** In the scene's units. What is proved rests on what `rests_on` names (docs/measure.md). */
struct Measures {
    MeshStatus status = MeshStatus::Done;
    std::string message; /**< why there is none, or what the mesh does not show, as Mesh::message */
    Enclosure volume;
    /** Of the surface; without an upper end (infinite) where there are `open_places`: boxes in which
     *  nothing bounds it, since the surface is not known to be a graph there. */
    Enclosure area;
    std::size_t open_places = 0;
    std::array<double, 3> open_place{}; /**< the middle of one of them */
    std::array<Enclosure, 3> center;
    std::array<Enclosure, 3> least, greatest; /**< the ends of the solid's box */
    /** Numbers of the mesh, of which nothing is proved: an error of the order of the square of its
     *  cells' side for a smooth surface, of the side at creases. They may lie beside what is proved. */
    double mesh_volume = 0, mesh_area = 0;
    std::array<double, 3> mesh_center{};
    Box mesh_box;
    std::size_t components = 0;        /**< of the mesh */
    long genus = 0;                    /**< of the mesh, all its components together */
    std::vector<std::string> rests_on; /**< as MeshCertificate::rests_on */
    explicit operator bool() const { return status == MeshStatus::Done; }
};

/** Makes a mesh of the solid, and divides its cells further. Of the options `certify` and `colors`
 *  are not read. */
FATHOM_API Measures measure(const Scene &scene, const MeshOptions &options = {}) noexcept;

/** Of a drawing: a scene of flat shapes that was compiled with `CompileOptions::flat_thickness`. */
struct FlatMeasures {
    MeshStatus status = MeshStatus::Done;
    std::string message; /**< why there is none */
    Enclosure area;
    /** The length of its border, holes and all; its upper end and `open_places` as Measures::area has
     *  them. */
    Enclosure perimeter;
    std::size_t open_places = 0;
    std::array<double, 2> open_place{};
    std::array<Enclosure, 2> center;
    std::array<Enclosure, 2> least, greatest; /**< the ends of its box */
    /** Numbers of contours that are drawn of it, of which nothing is proved. */
    double contours_area = 0, contours_perimeter = 0;
    std::array<double, 2> contours_center{};
    std::array<double, 2> contours_least{}, contours_greatest{};
    std::size_t outlines = 0, holes = 0; /**< the contours, by which side of them is filled */
    std::vector<std::string> rests_on;   /**< as MeshCertificate::rests_on */
    explicit operator bool() const { return status == MeshStatus::Done; }
};

/** `resolution` and `tolerance` are those of squares, as `slice` has them. BadOptions where the scene
 *  is not a drawing. */
FATHOM_API FlatMeasures measure_flat(const Scene &scene, const MeshOptions &options = {}) noexcept;

/** How far two solids are apart. */
struct Clearance {
    MeshStatus status = MeshStatus::Done;
    std::string message;
    /** The distance of their nearest points. 0 to 0: they have points in common. */
    Enclosure distance;
    std::array<Point, 2> near{}; /**< a point of each, `distance.hi` apart */
    std::vector<std::string> rests_on;
    explicit operator bool() const { return status == MeshStatus::Done; }
};

/** Of two scenes, parts of one (fathom/parts.h) for instance, at a time at which the facts of both
 *  hold. At most one may have no end. The enclosure is as narrow as `tolerance`, above 0, or as a
 *  counted amount of work makes it. `progress`: as MeshOptions::progress. */
FATHOM_API Clearance clearance(const Scene &a, const Scene &b, double tolerance, double time = 0,
                               const std::function<bool(double done)> &progress = {}) noexcept;

} // namespace fathom::FATHOM_V1
