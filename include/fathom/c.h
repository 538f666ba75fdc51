/** @file
 *  The library for C and for the languages that bind to C: handles, numbers and texts. Every call
 *  gives a status or a null handle where it fails; no call throws, prints or ends the program.
 *  Texts are UTF-8. What a call hands out is freed by the function of its kind; a null handle is
 *  freed, and counted as empty, without harm. Handles may be used by any number of threads at once.
 *
 *  @code
 *  #include <fathom/c.h>
 *  #include <stdio.h>
 *
 *  int main(void) {
 *      fathom_result *result = fathom_compile_text("ball.sdf", "sphere(1)\n", 10);
 *      for (size_t i = 0; i < fathom_result_count(result); ++i)
 *          printf("%s\n", fathom_result_message(result, i));
 *      fathom_field *field = fathom_field_make(fathom_result_scene(result), 0.0);
 *      const float points[6] = {0, 0, 0, 2, 0, 0};
 *      float distances[2];
 *      const int status = fathom_field_distances(field, points, 2, distances);
 *      printf("%g %g\n", distances[0], distances[1]);
 *      fathom_field_free(field);
 *      fathom_result_free(result);
 *      return status;
 *  }
 *  @endcode
 */
#ifndef FATHOM_C_H
#define FATHOM_C_H

#include <stddef.h>

#if defined(_WIN32)
#define FATHOM_C_API
#else
#define FATHOM_C_API __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

/** The version of this interface. It grows by one with each change that adds functions; functions
 *  that are there keep their meaning. */
#define FATHOM_C_VERSION 1
FATHOM_C_API int fathom_c_version(void);

/** What a call comes to: FATHOM_OK is 0. */
enum fathom_status { FATHOM_OK = 0, FATHOM_NO_MEMORY = 1, FATHOM_BAD_ARGUMENT = 2 };

typedef struct fathom_result fathom_result; /**< of a compilation: a scene or errors */
typedef struct fathom_scene fathom_scene;
typedef struct fathom_field fathom_field;
typedef struct fathom_text fathom_text; /**< bytes that a call made */

/** `length`: bytes of `text`. Null only where there is no memory. */
FATHOM_C_API fathom_result *fathom_compile_text(const char *name, const char *text, size_t length);
FATHOM_C_API fathom_result *fathom_compile_file(const char *path);
FATHOM_C_API void fathom_result_free(fathom_result *result);

/** The scene, or null where there were errors. It belongs to the result. */
FATHOM_C_API const fathom_scene *fathom_result_scene(const fathom_result *result);

/** The diagnostics, 0 to count - 1. Texts belong to the result; an index beyond gives "" and 0.
 *  Severities: 0 an error, 1 a warning, 2 a note. Line and column are 0 without a place. */
FATHOM_C_API size_t fathom_result_count(const fathom_result *result);
FATHOM_C_API int fathom_result_severity(const fathom_result *result, size_t index);
FATHOM_C_API const char *fathom_result_code(const fathom_result *result, size_t index);
FATHOM_C_API const char *fathom_result_message(const fathom_result *result, size_t index);
FATHOM_C_API const char *fathom_result_help(const fathom_result *result, size_t index);
FATHOM_C_API const char *fathom_result_file(const fathom_result *result, size_t index);
FATHOM_C_API int fathom_result_line(const fathom_result *result, size_t index);
FATHOM_C_API int fathom_result_column(const fathom_result *result, size_t index);

/** The proved Lipschitz bound of the field as written; infinite without one. */
FATHOM_C_API double fathom_scene_lipschitz(const fathom_scene *scene);
/** 0: proved, 1: assumed, 2: estimated. */
FATHOM_C_API int fathom_scene_proof(const fathom_scene *scene);
/** 1 where the field is the distance; 0 where it is a lower bound of it. */
FATHOM_C_API int fathom_scene_exact(const fathom_scene *scene);
/** 1, and the box of all solids, or 0 where one has no end. */
FATHOM_C_API int fathom_scene_bounds(const fathom_scene *scene, float lo[3], float hi[3]);

/** The params, 0 to count - 1. `values`: 4 numbers, those beyond `components` 0. */
FATHOM_C_API size_t fathom_scene_param_count(const fathom_scene *scene);
FATHOM_C_API const char *fathom_scene_param_name(const fathom_scene *scene, size_t index);
FATHOM_C_API int fathom_scene_param_components(const fathom_scene *scene, size_t index);
FATHOM_C_API void fathom_scene_param_value(const fathom_scene *scene, size_t index,
                                           double value[4]);
FATHOM_C_API void fathom_scene_param_range(const fathom_scene *scene, size_t index, double lo[4],
                                           double hi[4]);
/** The scene with another value of one param, as a result of its own. */
FATHOM_C_API fathom_result *fathom_scene_with(const fathom_scene *scene, const char *name,
                                              const double *value, int components);

/** The marched distance at one time (fathom/field.h). Null without memory or a scene. */
FATHOM_C_API fathom_field *fathom_field_make(const fathom_scene *scene, double time);
FATHOM_C_API void fathom_field_free(fathom_field *field);
/** `points`: x, y, z of each of `count`; `gradients` and the ends of boxes too. */
FATHOM_C_API int fathom_field_distances(const fathom_field *field, const float *points,
                                        size_t count, float *distances);
FATHOM_C_API int fathom_field_gradients(const fathom_field *field, const float *points,
                                        size_t count, float *distances, float *gradients);
/** `boxes`: the lower end, then the upper one, of each; `intervals`: two numbers of each. */
FATHOM_C_API int fathom_field_intervals(const fathom_field *field, const float *boxes, size_t count,
                                        float *intervals);

/** A shader's text for a target, or null where the scene cannot be said in it. */
FATHOM_C_API fathom_text *fathom_scene_shader(const fathom_scene *scene, const char *target);
/** The scene in the YAML save format. */
FATHOM_C_API fathom_text *fathom_scene_yaml(const fathom_scene *scene);
FATHOM_C_API const char *fathom_text_bytes(const fathom_text *text);
FATHOM_C_API size_t fathom_text_length(const fathom_text *text);
FATHOM_C_API void fathom_text_free(fathom_text *text);

/** A picture, RGBA, 8 bits a channel, sRGB, rows from the top, into 4*width*height bytes.
 *  `samples`: rays a pixel; 0: one, and 4 where it differs from those beside it. */
FATHOM_C_API int fathom_scene_draw(const fathom_scene *scene, int width, int height, int samples,
                                   double time, unsigned char *rgba);

#ifdef __cplusplus
}
#endif

#endif
