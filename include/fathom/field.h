/** @file
 *  A scene's distance at points and over boxes, evaluated on the CPU.
 *
 *  @code
 *  #include <fathom/field.h>
 *  #include <cstdio>
 *
 *  int main() {
 *      const auto result = fathom::compile_text("ball.sdf", "sphere(1)\n");
 *      if (!result) return 1;
 *      const auto field = fathom::make_field(*result.scene);
 *      if (!field) return 1;
 *      const std::vector<fathom::Point> points{{0, 0, 0}, {2, 0, 0}};
 *      std::vector<float> distances(points.size());
 *      if (!field->distances(points, distances)) return 1;
 *      std::printf("%g %g\n", distances[0], distances[1]);
 *      return distances[1] == 1 ? 0 : 1;
 *  }
 *  @endcode
 */
#pragma once

#include <fathom/scene.h>

#include <span>

namespace fathom::FATHOM_V1 {

/** All numbers from `lo` to `hi`; infinite ends where nothing is known. */
struct Interval {
    float lo = 0, hi = 0;
};

/** The marched distance of a scene at one time: negative inside, |d| never more than the distance
 *  to the surface as far as the facts' status says. It is the field divided by its bound, so it may
 *  be less where the facts say that the field is not exact. It is continuous: the longer steps that
 *  pictures take by bounds of cells are not in it.
 *
 *  Values are those of single precision and the same on every machine. A Field is a value; any
 *  number of threads may evaluate one. As many values are computed as the shortest of a call's spans
 *  holds. A call gives false only where there is no memory; the values then mean nothing. */
class FATHOM_API Field {
  public:
    bool distances(std::span<const Point> points, std::span<float> distances) const noexcept;

    /** The distance and its gradient; at a kink, one of the sides' gradients. */
    bool gradients(std::span<const Point> points, std::span<float> distances,
                   std::span<Point> gradients) const noexcept;

    /** What the distance lies within over each box: an enclosure, not the least one. It holds every
     *  value that `distances` gives at points of the box. The boxes are finite. */
    bool intervals(std::span<const Box> boxes, std::span<Interval> intervals) const noexcept;

    /** The distances at the points of a lattice that fills the box, its faces among them: `counts`
     *  points along x, y and z, x the fastest. False, too, where a count is below 2, a side of the box
     *  is no finite number above 0, or the span is shorter than the lattice. */
    bool volume(const Box &box, const std::array<std::size_t, 3> &counts,
                std::span<float> distances) const noexcept;

    struct Impl;
    explicit Field(std::shared_ptr<const Impl> impl); // of the library's own use

  private:
    std::shared_ptr<const Impl> impl_;
};

/** The field of a scene with the params' present values. `time`: seconds, at which its
 *  facts hold (`hold_at`). Nothing at another, or where there is no memory for it. */
FATHOM_API std::optional<Field> make_field(const Scene &scene, double time = 0) noexcept;

} // namespace fathom::FATHOM_V1
