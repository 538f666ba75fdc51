/** @file
 *  Pictures of a scene by OpenGL 3.3 or newer: without a window (by EGL), or in the host's own
 *  context. A library that was built without OpenGL has all of this, and `open` and `load` say so.
 *
 *  @code
 *  #include <fathom/gl.h>
 *  #include <cstdio>
 *
 *  int main() {
 *      const auto result = fathom::compile_text("ball.sdf", "sphere(1)\n");
 *      if (!result) return 1;
 *      fathom::GlPainter painter;
 *      fathom::Picture picture;
 *      fathom::PictureOptions options;
 *      options.width = 32;
 *      options.height = 24;
 *      if (const std::string why = painter.open(); !why.empty()) {
 *          std::printf("%s\n", why.c_str());
 *          picture = fathom::draw(*result.scene, options); // by the CPU
 *      } else if (painter.use(*result.scene).empty()) {
 *          picture = painter.draw(options);
 *      }
 *      std::printf("%dx%d\n", picture.width, picture.height);
 *      return picture.complete ? 0 : 1;
 *  }
 *  @endcode
 */
#pragma once

#include <fathom/picture.h>
#include <fathom/shader.h>

namespace fathom::FATHOM_V1 {

struct GlOptions {
    int max_steps = 0; /**< as PictureOptions::max_steps, which it stands for */
    bool noise_cache =
        false;         /**< through the noise cache (docs/noise-cache.md), where it can be had */
    bool still = true; /**< with it: each picture is drawn until the cache knows it; else once */
};

/** How many rows of its tables a scene's texts run over, by lists for cells of space; 0 without. */
struct GlLists {
    double in_cell = 0; /**< mean */
    double all = 0;     /**< without lists */
    int side = 0;       /**< cells along an axis */
};

/** Draws by OpenGL, in a context of its own that its calls make current; what EGL had current on the
 *  thread before is so again after each. Used by one thread at a time. None of its calls throws. */
class FATHOM_API GlPainter {
  public:
    GlPainter();
    GlPainter(GlPainter &&) noexcept;
    GlPainter &operator=(GlPainter &&) noexcept;
    ~GlPainter();

    /** Opens OpenGL. Empty; else a sentence that says what could not be had. */
    std::string open();
    bool is_open() const;
    std::string describe() const; /**< the renderer's and the version's names */
    bool is_software() const;     /**< draws on the processor, where `draw` is quicker */
    int largest_side() const;     /**< of a picture, in pixels; 0 where it is not open */

    /** The text that scenes are drawn by here, before the driver takes it. Empty where the scene has
     *  none, which `use` says. */
    std::string text(const Scene &scene) const;

    /** Gives the driver what draws the scene. What is to be said of it; where no diagnostic is an error
     *  it can be drawn. An error where it is not open. */
    std::vector<Diagnostic> use(const Scene &scene, const GlOptions &options = {});
    bool is_cached() const;            /**< through the noise cache */
    std::string exact_because() const; /**< why not, where it was wanted; else empty */
    double driver_seconds() const;     /**< that the driver took to build the scene's shader */

    /** The scene in use. Of the options it knows the size, samples, time, `turned`, `linear` and
     *  `progress`. One with a region, a first sample, sums, alpha or a shutter is not drawn: `remark`
     *  says so. */
    Picture draw(const PictureOptions &options = {});
    /** Draws the same, and gives nothing of it back: to be measured. False where it cannot be. */
    bool draw_for_nothing(const PictureOptions &options = {});

    GlLists lists() const;
    void remake_lists(); /**< to be measured */

    struct Impl;

  private:
    std::unique_ptr<Impl> impl_;
};

/** A shader of make_shader in a context of the host's own, as a window's: its textures, tables and
 *  uniforms are made by its reflection. One with the passes of the noise cache is drawn through a
 *  cache of its own, which it fills from frame to frame. For GL 3.3 and newer, and OpenGL ES 3.0.
 *
 *  All calls, and its end, want the context to be current in which it was loaded. What they change of
 *  the context's state is put back, but for what is bound to units of textures and images, and to the
 *  targets of copies and of texture buffers. None throws. */
class FATHOM_API GlShader {
  public:
    GlShader();
    GlShader(GlShader &&) noexcept;
    GlShader &operator=(GlShader &&) noexcept;
    ~GlShader();

    /** Builds a shader of `glsl330`, `glsl450` or `es300` in the current context, with its uniforms as
     *  the scene has them, in place of the one before. Cells of the cache that mean the same are kept.
     *  Empty; else why it cannot be drawn here, in the driver's words where it refuses it. What was
     *  loaded before stays then, but for lack of memory. */
    std::string load(const Shader &shader);

    /** Values of uniforms, by their names, from now on; of none that the shader does not have.
     *  `fathom_resolution` is set by `draw`. */
    void set(const std::vector<ShaderInput> &inputs);

    /** Draws over the lower left `width` by `height` pixels of the framebuffer that is bound. False
     *  where nothing is loaded or current, the size is below 1 or more than GL draws, or there is no
     *  memory. */
    bool draw(int width, int height);

    /** The share of the last frame's pixels that were drawn by cached values; 0 without the cache.
     *  Waits until the frame is drawn. */
    double cached_share() const;

    struct Impl;

  private:
    std::unique_ptr<Impl> impl_;
};

} // namespace fathom::FATHOM_V1
