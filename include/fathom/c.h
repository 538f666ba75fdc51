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
#include <stdint.h>

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
#define FATHOM_C_VERSION 3
FATHOM_C_API int fathom_c_version(void);
/** The library's own: "0.1.0" */
FATHOM_C_API const char *fathom_version(void);

/** What a call comes to: FATHOM_OK is 0. */
enum fathom_status {
    FATHOM_OK = 0,
    FATHOM_NO_MEMORY = 1,
    FATHOM_BAD_ARGUMENT = 2,
    FATHOM_CANCELLED = 3
};

/** Called now and then by one thread at a time, with the share that is done, 0 to 1, and with the
 *  caller's own word; 0 cancels the work. */
typedef int (*fathom_progress)(double done, void *own);

typedef struct fathom_result fathom_result; /**< of a compilation: a scene or errors */
typedef struct fathom_scene fathom_scene;
typedef struct fathom_field fathom_field;
typedef struct fathom_text fathom_text; /**< bytes that a call made */
typedef struct fathom_mesh fathom_mesh;
typedef struct fathom_options fathom_options;

/** How scenes are compiled: without a call of these, as if there were no options. The options are
 *  copied by a compilation, and may be freed or changed after it. Calls for one handle come from
 *  one thread at a time. */
FATHOM_C_API fathom_options *fathom_options_make(void);
FATHOM_C_API void fathom_options_free(fathom_options *options);
/** Sets a param by an expression of the language, as `-D name=text` does. */
FATHOM_C_API int fathom_options_define(fathom_options *options, const char *name, const char *text);
/** One more folder where imports are looked for. */
FATHOM_C_API int fathom_options_include(fathom_options *options, const char *folder);
/** What a scene may cost (docs/limits.md). */
FATHOM_C_API int fathom_options_limit(fathom_options *options, const char *name, const char *value);
/** The bytes of a file that a scene names, as fathom_text_make copies them, or null where there is no
 *  such file. The library frees the text. `path` is relative to the scene's text, with `/`. Called
 *  by the compiling thread, also by fathom_scene_with where it compiles again: `own` has to live as
 *  long as the scene. */
typedef fathom_text *(*fathom_file_provider)(const char *path, void *own);
/** Files come from the provider alone. */
FATHOM_C_API int fathom_options_files(fathom_options *options, fathom_file_provider provider,
                                      void *own);
/** What compilations found of fields, for the next ones: one that is given to all compilations of a
 *  text that is edited makes each prove only what the edit touched, and changes nothing else. Any
 *  number of threads may use one. `most_bytes`: how much it may hold; 0: 32 MiB. */
typedef struct fathom_cache fathom_cache;
FATHOM_C_API fathom_cache *fathom_cache_make(size_t most_bytes);
FATHOM_C_API void fathom_cache_free(fathom_cache *cache);
/** How many bounds were not in it when they were wanted, and how many bytes it holds. */
FATHOM_C_API size_t fathom_cache_searches(const fathom_cache *cache);
FATHOM_C_API size_t fathom_cache_bytes(const fathom_cache *cache);
/** Options and scenes keep what the cache holds: it may be freed before them. */
FATHOM_C_API int fathom_options_cache(fathom_options *options, const fathom_cache *cache);
/** Asked about once a millisecond, by the thread that compiles; where it gives anything but 0 the
 *  compilation ends within some milliseconds with the one error `cancelled`. */
typedef int (*fathom_cancelled)(void *own);
FATHOM_C_API int fathom_options_cancel(fathom_options *options, fathom_cancelled cancelled,
                                       void *own);
/** What a compilation does at present: reads the text, evaluates it, proves its bounds, makes the
 *  functions that are evaluated. */
enum fathom_phase {
    FATHOM_READ = 0,
    FATHOM_CHECK = 1,
    FATHOM_PROVE = 2,
    FATHOM_LOWER = 3,
    FATHOM_DONE = 4
};
/** Told as each phase begins, by that thread. */
typedef void (*fathom_entered)(int phase, void *own);
FATHOM_C_API int fathom_options_entered(fathom_options *options, fathom_entered entered, void *own);

/** `length`: bytes of `text`. Null only where there is no memory. */
FATHOM_C_API fathom_result *fathom_compile_text(const char *name, const char *text, size_t length);
FATHOM_C_API fathom_result *fathom_compile_file(const char *path);
/** The same with options, which may be null. */
FATHOM_C_API fathom_result *fathom_compile_text_with(const char *name, const char *text,
                                                     size_t length, const fathom_options *options);
FATHOM_C_API fathom_result *fathom_compile_file_with(const char *path,
                                                     const fathom_options *options);
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

/** What the bound rests on beside the proof, 0 to count - 1: "sphere: exact" (docs/trusted.md). */
FATHOM_C_API size_t fathom_scene_axiom_count(const fathom_scene *scene);
FATHOM_C_API const char *fathom_scene_axiom(const fathom_scene *scene, size_t index);
/** The end of the times that the facts hold for, in seconds; they begin at 0. */
FATHOM_C_API double fathom_scene_time_end(const fathom_scene *scene);

/** The params, 0 to count - 1. `values`: 4 numbers, those beyond `components` 0. */
FATHOM_C_API size_t fathom_scene_param_count(const fathom_scene *scene);
FATHOM_C_API const char *fathom_scene_param_name(const fathom_scene *scene, size_t index);
FATHOM_C_API const char *fathom_scene_param_label(const fathom_scene *scene, size_t index);
/** 0: a truth, 1: a whole number, 2: a number, 3 to 5: 2 to 4 numbers. */
FATHOM_C_API int fathom_scene_param_type(const fathom_scene *scene, size_t index);
/** 1 where setting it compiles the scene again, since it decides what shapes there are. */
FATHOM_C_API int fathom_scene_param_structural(const fathom_scene *scene, size_t index);
FATHOM_C_API int fathom_scene_param_components(const fathom_scene *scene, size_t index);
FATHOM_C_API void fathom_scene_param_value(const fathom_scene *scene, size_t index,
                                           double value[4]);
/** Infinite ends where the param has no range. */
FATHOM_C_API void fathom_scene_param_range(const fathom_scene *scene, size_t index, double lo[4],
                                           double hi[4]);
/** The scene with another value of one param, as a result of its own. */
FATHOM_C_API fathom_result *fathom_scene_with(const fathom_scene *scene, const char *name,
                                              const double *value, int components);

/** The marched distance at one time (fathom/field.h). Null without memory or a scene, and
 *  at a time for which the facts do not hold. */
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

/** The distances at the points of a lattice that fills the box, its faces among them, x the fastest:
 *  `counts[0] * counts[1] * counts[2]` numbers. A count is 2 or more. */
FATHOM_C_API int fathom_field_volume(const fathom_field *field, const float lo[3],
                                     const float hi[3], const size_t counts[3], float *distances);

/** A shader's text for a target, or null where the scene cannot be said in it. */
FATHOM_C_API fathom_text *fathom_scene_shader(const fathom_scene *scene, const char *target);
/** What a host has to bind to run that shader, as JSON (docs/shaders.md). */
FATHOM_C_API fathom_text *fathom_scene_reflection(const fathom_scene *scene, const char *target);
/** The scene in the YAML save format. */
FATHOM_C_API fathom_text *fathom_scene_yaml(const fathom_scene *scene);
/** A text of one's own, for a fathom_file_provider. */
FATHOM_C_API fathom_text *fathom_text_make(const char *bytes, size_t length);
/** A zero follows the last byte. */
FATHOM_C_API const char *fathom_text_bytes(const fathom_text *text);
FATHOM_C_API size_t fathom_text_length(const fathom_text *text);
FATHOM_C_API void fathom_text_free(fathom_text *text);

/** A picture, RGBA, 8 bits a channel, sRGB, rows from the top, into 4*width*height bytes.
 *  `samples`: rays a pixel; 0: one, and 4 where it differs from those beside it. */
FATHOM_C_API int fathom_scene_draw(const fathom_scene *scene, int width, int height, int samples,
                                   double time, unsigned char *rgba);

/** The same, which tells how far it is and can be given up; `progress` may be null. */
FATHOM_C_API int fathom_scene_draw_with(const fathom_scene *scene, int width, int height,
                                        int samples, double time, fathom_progress progress,
                                        void *own, unsigned char *rgba);

/** The surface as triangles (fathom/mesh.h). `tolerance`: the side of the cells that it is drawn by,
 *  in the scene's units; 0: `resolution` cells along the longest side, 1 to 8,000. Null only without
 *  memory or a scene; else the status says whether there is a mesh. `progress` may be null. */
FATHOM_C_API fathom_mesh *fathom_scene_mesh(const fathom_scene *scene, double tolerance,
                                            int resolution, double time, fathom_progress progress,
                                            void *own);
FATHOM_C_API void fathom_mesh_free(fathom_mesh *mesh);
/** 0: done, 1: cancelled, 2: no point lies in the solid, 3: no box holds it, 4: too fine, 5: too large,
 *  6: the field contradicts what was stated of it. */
FATHOM_C_API int fathom_mesh_status(const fathom_mesh *mesh);
FATHOM_C_API const char *fathom_mesh_message(const fathom_mesh *mesh);
/** Three numbers a vertex, three vertices a triangle, counterclockwise from outside. They belong to
 *  the mesh. */
FATHOM_C_API size_t fathom_mesh_vertex_count(const fathom_mesh *mesh);
FATHOM_C_API const float *fathom_mesh_vertices(const fathom_mesh *mesh);
FATHOM_C_API const float *fathom_mesh_normals(const fathom_mesh *mesh);
FATHOM_C_API size_t fathom_mesh_triangle_count(const fathom_mesh *mesh);
FATHOM_C_API const uint32_t *fathom_mesh_triangles(const fathom_mesh *mesh);
/** Cells that may hold surface that the mesh does not show. */
FATHOM_C_API size_t fathom_mesh_undecided(const fathom_mesh *mesh);
/** The bytes of a file; `suffix`: ".stl", ".obj", ".ply", ".glb" or ".3mf". */
FATHOM_C_API fathom_text *fathom_mesh_file(const fathom_mesh *mesh, const char *suffix);

#ifdef __cplusplus
}
#endif

#endif
