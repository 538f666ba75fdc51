/** @file
 *  Where planes cut a solid: contours, and the bytes of SVG, DXF and PNG files.
 *
 *  @code
 *  #include <fathom/slice.h>
 *  #include <cstdio>
 *
 *  int main() {
 *      const auto result = fathom::compile_text("ring.sdf", "torus(1, 0.3)\n");
 *      if (!result) return 1;
 *      const float heights[] = {0, 0.2f};
 *      const fathom::Slices cut = fathom::slice(*result.scene, fathom::Axis::Y, heights);
 *      if (!cut) return std::fprintf(stderr, "%s\n", cut.message.c_str()), 1;
 *      const std::string svg = fathom::svg_file(cut, 0);
 *      std::printf("%zu contours, %zu bytes\n", cut.slices[0].contours.size(), svg.size());
 *      return cut.slices[0].contours.size() == 2 ? 0 : 1;
 *  }
 *  @endcode
 */
#pragma once

#include <fathom/measure.h>
#include <fathom/picture.h>

namespace fathom::FATHOM_V1 {

enum class Axis { X, Y, Z };

/** A point of a plane. The plane is seen from where the coordinate along its axis is greater, with
 *  the scene's y up where it can be: of Z these are (x, y), of X (-z, y), of Y (x, -z). */
using PlanePoint = std::array<float, 2>;

struct PlaneBox {
    PlanePoint lo{}, hi{};
};

/** One plane's. Contours are closed, do not cross themselves or each other, and have the solid on their
 *  left: outlines are counterclockwise, holes clockwise. Their first point does not come again. */
struct Slice {
    float at = 0; /**< of the plane */
    std::vector<std::vector<PlanePoint>> contours;
    /** Every point of the contours has the border of the section as near as this; every point of that
     *  has a contour as near as that. Where not `certified`: but for the undecided squares. */
    double contours_to_border = 0, border_to_contours = 0;
    bool certified = false;          /**< no square is undecided */
    std::vector<PlaneBox> undecided; /**< the first 1,000 of them */
    std::size_t undecided_squares = 0;
    Enclosure area;           /**< of the section: proved */
    double contours_area = 0; /**< of what the contours bound; it may lie a little beside `area` */
};

struct Slices {
    MeshStatus status = MeshStatus::Done;
    std::string message; /**< why there are none; else what the contours may show in pieces */
    PlaneBox frame;      /**< holds all slices: the box of the solid, or MeshOptions::bounds */
    std::array<float, 2> along{}; /**< where that box begins and ends along the axis */
    double side = 0;              /**< of the squares in which contours are looked for, at most */
    std::vector<Slice> slices;    /**< by height; one that misses the solid has no contour */
    std::vector<std::string> rests_on; /**< as MeshCertificate::rests_on */
    explicit operator bool() const { return status == MeshStatus::Done; }
};

/** Cuts a solid at heights along an axis. Of the options `certify` and `colors` are not read;
 *  `resolution` is in squares along the longest side of the solid's box. */
FATHOM_API Slices slice(const Scene &scene, Axis axis, std::span<const float> heights,
                        const MeshOptions &options = {}) noexcept;

/** The bytes of an SVG file with slice k as one filled path. `title`: any words; without them its
 *  height. Empty without memory for it. */
FATHOM_API std::string svg_file(const Slices &slices, std::size_t k,
                                MeshUnit unit = MeshUnit::Unsaid,
                                std::string_view title = {}) noexcept;

/** The bytes of a DXF file (AutoCAD R12) with a closed polyline for each contour. */
FATHOM_API std::string dxf_file(const Slices &slices, std::size_t k,
                                MeshUnit unit = MeshUnit::Unsaid) noexcept;

/** Slice k in white on black; gray is the share of a pixel that lies in the solid. The frame lies in the
 *  middle, as large as it fits. Not `complete` without memory for it. */
FATHOM_API Picture slice_picture(const Slices &slices, std::size_t k, int width,
                                 int height) noexcept;

} // namespace fathom::FATHOM_V1
