/** @file
 *  Pictures of a scene, drawn on the CPU, and as files. By OpenGL: fathom/gl.h.
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
 *      const std::string png = fathom::encode_png(picture); // the bytes of a file
 *      std::printf("%dx%d, %zu bytes\n", picture.width, picture.height, png.size());
 *      return picture.complete && !png.empty() ? 0 : 1;
 *  }
 *  @endcode
 */
#pragma once

#include <fathom/scene.h>

#include <cstdint>

namespace fathom::FATHOM_V1 {

/** A rectangle of pixels; `x` and `y` of its upper left one, from the picture's top left. */
struct Region {
    int x = 0, y = 0, width = 0, height = 0;
};

struct PictureOptions {
    int width = 640, height = 360; /**< pixels, 1 to 65,536 each */
    int samples = 0;      /**< rays a pixel; 0: one, and 4 where it differs from those beside it */
    double time = 0;      /**< seconds, at which the scene's facts hold (`hold_at`) */
    unsigned threads = 0; /**< 0: as many as the machine has cores */
    int max_steps = 0; /**< evaluations that a ray may take; 0: what the scene says, else 65,536 */
    /** Called now and then by one thread at a time, with the share that is done; false cancels. */
    std::function<bool(double done)> progress;

    /** What is drawn of the picture, within it; none: all. */
    std::optional<Region> region;
    /** A pixel's first sample. The rays of samples 0, 1, 2 … are the same ones whichever are asked
     *  for, so that a picture can be divided by its samples. */
    int first_sample = 0;
    bool alpha = false;  /**< no background: alpha is how much of a pixel something covers */
    bool linear = false; /**< also Picture::linear */
    bool sums = false;   /**< also Picture::sums; with 1 to 256 samples */
    double turned = 0;   /**< radians that the camera goes around what it looks at, about y */
    /** Seconds for which the shutter is open, from `time` on: each sample has a moment of its own.
     *  With 1 sample or more. */
    double shutter = 0;
    /** Called as `progress` is, before it, with a part whose pixels are drawn, and the picture's
     *  bytes, of which other parts may be drawn meanwhile. With an open shutter, one sample's. */
    std::function<void(const Region &part, const std::vector<std::uint8_t> &rgba)> drawn;
};

/** `rgba`: rows from the top, 8 bits a channel, sRGB. Without memory for it, or after a
 *  cancellation, `complete` is false and what is missing is 0. Of options that no picture can have
 *  it is empty, and `remark` says why. A ray that is `undecided` ended
 *  neither in a hit nor in a miss: its steps were spent. It shows what it is nearest to. A ray that
 *  `passed` went through a surface without an inside, where the field is 0 and above 0 on both
 *  sides, as where a cut ends in the plane of what it cuts: nothing of it is drawn. */
struct Picture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba;
    bool complete = false;
    std::uint64_t undecided = 0;         /**< rays from the eye */
    std::uint64_t undecided_shadows = 0; /**< rays from lights */
    std::uint64_t passed = 0;            /**< rays from the eye */
    /** Where it was wanted: linear RGBA, the colours multiplied by alpha. */
    std::vector<float> linear;
    /** Where it was wanted: three numbers a pixel, the sums of its samples, linear. Sums of different
     *  samples of one pixel add without rounding, in any order (`picture_of_sums`). */
    std::vector<double> sums;
    std::uint64_t rays = 0;  /**< from the eye */
    std::uint64_t steps = 0; /**< of those: evaluations of the distance on their way; by the CPU */
    std::uint64_t evaluations = 0; /**< of the distance, for whatever purpose; by the CPU */
    std::string remark; /**< what is worth knowing of how it was drawn, for people; may be empty */
};

/** From the scene's camera, or framed where it has none. */
FATHOM_API Picture draw(const Scene &scene, const PictureOptions &options = {});

/** The evaluations that the ray through each pixel's centre takes, rows from the top. Empty where
 *  there is no such picture, or no memory. */
FATHOM_API std::vector<int> eye_steps(const Scene &scene, const PictureOptions &options = {});

/** The picture of `3 * width * height` sums of so many samples each; empty of another number. */
FATHOM_API Picture picture_of_sums(int width, int height, const std::vector<double> &sums,
                                   int samples);

/** The bytes of a PNG file. `note`, of ASCII, is kept in it as a text of the keyword `fathom`. Empty
 *  where the picture has no pixels, and without memory for it. */
FATHOM_API std::string encode_png(const Picture &picture, std::string_view note = {});

/** The bytes of a JPEG file, of a quality from 1 to 100, without alpha. Empty as for a PNG, and where
 *  a side is above 65,500 pixels. */
FATHOM_API std::string encode_jpeg(const Picture &picture, int quality = 90);

} // namespace fathom::FATHOM_V1
