/** @file
 *  True distances to a solid's surface on a lattice, each within a stated error, and the bytes of
 *  OpenVDB, NRRD and NumPy files.
 *
 *  @code
 *  #include <fathom/volume.h>
 *  #include <cstdio>
 *
 *  int main() {
 *      const auto result = fathom::compile_text("ring.sdf", "torus(1, 0.3)\n");
 *      if (!result) return 1;
 *      fathom::VolumeOptions options;
 *      options.resolution = 24;
 *      const fathom::Volume volume = fathom::make_volume(*result.scene, options);
 *      if (!volume) return std::fprintf(stderr, "%s\n", volume.message.c_str()), 1;
 *      const std::string nrrd = fathom::nrrd_file(volume);
 *      std::printf("%zu voxels, within %g\n", volume.distances.size(), volume.error.value_or(0));
 *      return nrrd.empty() ? 1 : 0;
 *  }
 *  @endcode
 */
#pragma once

#include <fathom/mesh.h>

#include <span>

namespace fathom::FATHOM_V1 {

struct VolumeOptions {
    double side = 0;      /**< of a voxel, in the scene's units; 0: by `resolution` */
    int resolution = 128; /**< voxels along the longest side of the solid's box, 1 to 4,000 */
    /** 0: all voxels of a box about the solid. Else those alone that are nearer to the surface than so
     *  many voxels, 1 to 1,000. */
    double band = 0;
    std::optional<Box> bounds; /**< finite: the solid is cut off there */
    /** Instead of distances, what that one of the functions gives with which the scene was compiled
     *  (`CompileOptions::fields`): `Volume::values`, at all voxels of `bounds` or, without, of the
     *  solid's box. `band`, `colors` and `certify` say nothing then. */
    std::optional<std::size_t> field;
    double time = 0;      /**< seconds, at which the scene's facts hold (`hold_at`) */
    unsigned threads = 0; /**< 0: as many as the machine has cores */
    bool colors = false;  /**< also `Volume::colors`, of a band, where there are several */
    /** Prove what `Volume::error` says; without it there is none. Takes most of the time. */
    bool certify = true;
    /** Called now and then by one thread at a time, with the share that is done; false cancels. */
    std::function<bool(double done)> progress;
};

/** Voxel (i, j, k) is the point origin + side * (i, j, k), whose coordinates are whole multiples of the
 *  side. Distances are negative in the solid. */
struct Volume {
    MeshStatus status = MeshStatus::Done;
    std::string message; /**< why there is none, as Mesh::message */
    std::array<double, 3> origin{};
    double side = 0;
    std::array<int, 3> counts{};
    double band = 0; /**< as a length; 0: all voxels */
    /** Of all voxels, x the fastest; of a band, of those in `voxels`. None of a field. */
    std::vector<float> distances;
    /** Of a field: 1, or 3 of a vec3. 0: it is one of distances. */
    int components = 0;
    std::vector<float> values; /**< of a field: `components` numbers a voxel, of all voxels */
    std::vector<std::array<int, 3>> voxels;   /**< of a band, each once */
    std::vector<std::array<float, 3>> colors; /**< of each of these: of the surface nearest to it */
    /** Every distance is within this of the true one, and every voxel whose true distance is less than
     *  `band` less this is in the band. None: it was not to be proved, or cells stayed undecided. */
    std::optional<double> error;
    std::size_t undecided_cells = 0;   /**< in which surface may be that distances do not know of */
    std::vector<std::string> rests_on; /**< as MeshCertificate::rests_on */
    explicit operator bool() const { return status == MeshStatus::Done; }
};

FATHOM_API Volume make_volume(const Scene &scene, const VolumeOptions &options = {}) noexcept;

/** The bytes of an NRRD file with its place in space, or of a NumPy array indexed by [x, y, z], which
 *  has none; by [c, x, y, z] of a field of vectors. Of a volume of all voxels. Empty of a band, and
 *  where there is no memory for it. */
FATHOM_API std::string nrrd_file(const Volume &volume) noexcept;
FATHOM_API std::string npy_file(const Volume &volume) noexcept;

/** The bytes of an OpenVDB file: a level set `surface` of a band, with a grid `Cd` where it has colours;
 *  of a field a grid `name`, in which voxels whose numbers are all 0 are background; or why there are
 *  none: `message`. They are written by OpenVDB, which the module `libfathom-vdb.so` loads, beside the
 *  library or in a folder `fathom` beside it. */
struct VdbFile {
    std::string bytes, message;
};
FATHOM_API std::string vdb_obstacle() noexcept; /**< why there can be none here; empty: nothing */
FATHOM_API VdbFile vdb_file(const Volume &volume, const std::string &name = "density") noexcept;

/** A volume of a field, and what its grid is called. */
struct NamedVolume {
    std::string name;
    const Volume *volume = nullptr;
};
/** The same, with a grid for each of these, which have one `origin` and one `side`. */
FATHOM_API VdbFile vdb_file(std::span<const NamedVolume> volumes) noexcept;

} // namespace fathom::FATHOM_V1
