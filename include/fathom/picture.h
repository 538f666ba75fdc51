/** @file
 *  Pictures of a scene, drawn on the CPU.
 *
 *  @code
 *  #include <fathom/picture.h>
 *  #include <cstdio>
 *
 *  int main() {
 *      const auto result = fathom::compile_text("ball.sdf", "sphere(1)\n");
 *      if (!result) return 1;
 *      fathom::PictureOptions options;
 *      options.width = 32;
 *      options.height = 24;
 *      const fathom::Picture picture = fathom::draw(*result.scene, options);
 *      std::printf("%dx%d, %zu bytes\n", picture.width, picture.height, picture.rgba.size());
 *      return picture.complete ? 0 : 1;
 *  }
 *  @endcode
 */
#pragma once

#include <fathom/scene.h>

#include <cstdint>

namespace fathom::FATHOM_V1 {

struct PictureOptions {
    int width = 640, height = 360; /**< pixels, 1 to 65,536 each */
    int samples = 0;      /**< rays a pixel; 0: one, and 4 where it differs from those beside it */
    double time = 0;      /**< seconds, in [0, Facts::time_end] */
    unsigned threads = 0; /**< 0: as many as the machine has cores */
    int max_steps = 0; /**< evaluations that a ray may take; 0: what the scene says, else 65,536 */
    /** Called now and then by one thread at a time, with the share that is done; false cancels. */
    std::function<bool(double done)> progress;
};

/** `rgba`: rows from the top, 8 bits a channel, sRGB. Without memory for it, or after a
 *  cancellation, `complete` is false and what is missing is 0. A ray that is `undecided` ended
 *  neither in a hit nor in a miss: its steps were spent, or it touched a surface that it did not
 *  cross. It shows what it is nearest to. */
struct Picture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba;
    bool complete = false;
    std::uint64_t undecided = 0;         /**< rays from the eye */
    std::uint64_t undecided_shadows = 0; /**< rays from lights */
};

/** From the scene's camera, or framed where it has none. */
FATHOM_API Picture draw(const Scene &scene, const PictureOptions &options = {});

} // namespace fathom::FATHOM_V1
