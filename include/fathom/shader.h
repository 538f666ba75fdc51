/** @file
 *  A scene as a shader, and what a host has to bind to run it.
 *
 *  @code
 *  #include <fathom/shader.h>
 *  #include <cstdio>
 *
 *  int main() {
 *      const auto result = fathom::compile_text("ball.sdf", "param r = 1 in 0.5..2\nsphere(r)\n");
 *      if (!result) return 1;
 *      fathom::ShaderOptions options;
 *      options.target = "glsl330";
 *      const auto shader = fathom::make_shader(*result.scene, options);
 *      if (!shader) return 1;
 *      for (const fathom::Uniform &u : shader->uniforms)
 *          std::printf("uniform %s for param %s\n", u.name.c_str(), u.param.c_str());
 *      std::printf("%zu bytes\n", shader->text.size());
 *      return 0;
 *  }
 *  @endcode
 */
#pragma once

#include <fathom/scene.h>

#include <cstdint>

namespace fathom::FATHOM_V1 {

/** The names of the targets, as `fathom compile --target` takes them. */
FATHOM_API std::vector<std::string> shader_targets();

/** What a target gives. */
struct ShaderTarget {
    std::string name;
    std::string suffix;       /**< of its files, with the dot: ".frag" */
    std::string field_target; /**< of a page: the target that writes its field alone; else empty */
    bool buffers = false;     /**< large tables may be a buffer (ShaderOptions::buffers) */
    bool noise_cache = false; /**< ShaderOptions::noise_cache goes with it */
};
/** All targets, in the order of `shader_targets`. */
FATHOM_API std::vector<ShaderTarget> shader_target_table();

struct ShaderOptions {
    std::string target = "glsl330";
    bool field_only = false;     /**< `float sdf(vec3)` and the material alone, no marcher */
    bool buffers = false;        /**< large tables as a buffer (Shader::tables), not as text */
    double time = 0;             /**< the moment of the camera, for targets without a host */
    std::string title = "scene"; /**< of a page */
    bool noise_cache = false;    /**< with the cache's hooks, and its passes (Shader::cache) */
};

/** A uniform of the text for a param of the scene. `location` is -1 unless the text gives one. */
struct Uniform {
    std::string name, param;
    Param::Type type = Param::Type::Float;
    int location = -1;
};

/** A texture that the host binds. Images are RGBA, linear, rows from the top; grids are distances,
 *  x the fastest. */
struct Texture {
    std::string name;
    bool grid = false;
    int width = 0, height = 0, depth = 1;
    std::vector<float> values; /**< 4 a pixel, 1 a sample of a grid */
};

/** Any uniform of the text, in its order: what the host sets for a frame, a param or a sampler. */
struct ShaderInput {
    std::string type{}, name{};  /**< GLSL's type, as `vec3` or `sampler2D` */
    std::vector<double> value{}; /**< for the scene's first view; empty of a sampler */
    std::string meaning{};       /**< of the frame's: what it is, with its unit; else empty */
    std::string param{};         /**< the param's name; else empty */
    int place = -1; /**< its location, or a sampler's binding; -1 where the text has none */
};

/** A field that a text reads through the noise cache. */
struct CachedField {
    bool wide = false;               /**< of vectors or colours, which lie in `fathom_cache_wide` */
    std::vector<std::string> params; /**< that it reads: where one moves, its cells are stale */
    double cost = 0;                 /**< of its value at a point, in nanoseconds on one machine */
    std::uint64_t meaning =
        0; /**< equal where fields, of any scenes, compute the same from these */
};

/** The passes of the noise cache (docs/noise-cache.md), each a fragment shader's text. All are empty where
 *  no field of the scene is worth keeping; the picture's text then computes all. */
struct CachePasses {
    std::string reserve, fill, publish, sweep;
    std::vector<CachedField> fields; /**< in the order of `fathom_cache_fields` */
    double scene_cost = 0;           /**< of the scene's distance at a point, all computed */
};

/** A checked shader. `text` is what docs/shaders.md describes; `words` is SPIR-V, for the target
 *  that is binary. */
struct Shader {
    std::string text;
    std::vector<std::uint32_t> words;
    std::vector<Uniform> uniforms;
    std::vector<ShaderInput> inputs;
    std::vector<Texture> textures;
    std::vector<float> tables; /**< RGBA32F texels of `fathom_tables`, where buffers were allowed */
    bool reads_time = false;
    CachePasses cache;      /**< where they were wanted */
    std::string reflection; /**< all of this but data and text, as JSON (docs/shaders.md) */
};

/** Nothing where the scene cannot be said in the target, or there is no such target; `diagnostics`,
 *  if given, then says why. */
FATHOM_API std::optional<Shader> make_shader(const Scene &scene, const ShaderOptions &options = {},
                                             std::vector<Diagnostic> *diagnostics = nullptr);

/** The inputs of the camera for a view of one's own: the shader's, gone around what it looks at by
 *  `around` radians about y and by `above` upwards (no farther than straight up or down), from
 *  `distance` times as far. Empty where the text has no camera, as a field alone. */
FATHOM_API std::vector<ShaderInput> turned_camera(const Shader &shader, double around, double above,
                                                  double distance = 1);

} // namespace fathom::FATHOM_V1
