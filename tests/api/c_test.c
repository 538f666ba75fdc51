/* The C interface in C11, under AddressSanitizer: what is freed twice, read after its end or never freed ends the run. */
#include <fathom/c.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int failures = 0;

#define CHECK(condition)                                                                           \
    do {                                                                                           \
        if (!(condition)) {                                                                        \
            printf("%s:%d: %s\n", __FILE__, __LINE__, #condition);                                 \
            ++failures;                                                                            \
        }                                                                                          \
    } while (0)

static fathom_result *compiled(const char *text) {
    fathom_result *result = fathom_compile_text("test.sdf", text, strlen(text));
    CHECK(fathom_result_scene(result));
    return result;
}

static void diagnostics(void) {
    fathom_result *result = fathom_compile_text("a.sdf", "shpere(1)\n", 10);
    CHECK(!fathom_result_scene(result));
    CHECK(fathom_result_count(result) == 1);
    CHECK(fathom_result_severity(result, 0) == 0);
    CHECK(strcmp(fathom_result_code(result, 0), "unknown-name") == 0);
    CHECK(strcmp(fathom_result_file(result, 0), "a.sdf") == 0);
    CHECK(fathom_result_line(result, 0) == 1 && fathom_result_column(result, 0) == 1);
    CHECK(strcmp(fathom_result_code(result, 1), "") == 0);
    fathom_result_free(result);
}

static fathom_text *provide(const char *path, void *own) {
    ++*(int *)own;
    if (strcmp(path, "ball.sdf") != 0) return NULL;
    const char *text = "let part = sphere(2)\n";
    return fathom_text_make(text, strlen(text));
}

static void options(void) {
    int asked = 0;
    fathom_options *options = fathom_options_make();
    CHECK(fathom_options_files(options, provide, &asked) == FATHOM_OK);
    CHECK(fathom_options_define(options, "d", "3") == FATHOM_OK);
    CHECK(fathom_options_define(options, NULL, "3") == FATHOM_BAD_ARGUMENT);
    const char *text = "import \"ball.sdf\" as parts\nparam d = 1 in 0..9\nparts.part.translate(x: d)\n";
    fathom_result *result = fathom_compile_text_with("main.sdf", text, strlen(text), options);
    CHECK(asked > 0);
    fathom_options_free(options); /* the scene has its own copy */
    for (size_t i = 0; i < fathom_result_count(result); ++i) puts(fathom_result_message(result, i));
    float lo[3], hi[3]; /* for all values of the param */
    CHECK(fathom_scene_bounds(fathom_result_scene(result), lo, hi) == 1);
    CHECK(fabsf(lo[0] + 2) < 1e-3f && fabsf(hi[0] - 11) < 1e-3f);
    fathom_field *field = fathom_field_make(fathom_result_scene(result), 0);
    const float middle[3] = {3, 0, 0};
    float distance = 0;
    CHECK(fathom_field_distances(field, middle, 1, &distance) == FATHOM_OK && distance == -2);
    fathom_field_free(field);
    fathom_result_free(result);

    options = fathom_options_make();
    CHECK(fathom_options_limit(options, "nothing", "1") == FATHOM_OK);
    result = fathom_compile_text_with("a.sdf", "sphere(1)\n", 10, options);
    CHECK(!fathom_result_scene(result) && strcmp(fathom_result_code(result, 0), "usage") == 0);
    fathom_result_free(result);
    fathom_options_free(options);
}

static int yes(void *own) {
    ++*(int *)own;
    return 1;
}

static void note_phase(int phase, void *own) {
    int *phases = own;
    if (phases[0] < 8) phases[++phases[0]] = phase;
}

static void cache_cancellation_and_phases(void) {
    const char *text = "implicit(p => p.x + 0.3 * sin(p.y) * sin(3 * p.z), within: ball(4))\n";
    fathom_cache *cache = fathom_cache_make(0);
    fathom_options *options = fathom_options_make();
    int phases[9] = {0}; /* how many, then each */
    CHECK(fathom_options_cache(options, cache) == FATHOM_OK);
    CHECK(fathom_options_cache(options, NULL) == FATHOM_BAD_ARGUMENT);
    CHECK(fathom_options_entered(options, note_phase, phases) == FATHOM_OK);
    CHECK(fathom_options_entered(options, NULL, NULL) == FATHOM_BAD_ARGUMENT);
    fathom_result *first = fathom_compile_text_with("a.sdf", text, strlen(text), options);
    CHECK(fathom_result_scene(first));
    const size_t searches = fathom_cache_searches(cache);
    CHECK(searches > 0 && fathom_cache_bytes(cache) > 0);
    CHECK(phases[0] > 0 && phases[phases[0]] == FATHOM_DONE);
    for (int i = 2; i <= phases[0]; ++i) CHECK(phases[i - 1] < phases[i]);
    fathom_result *second = fathom_compile_text_with("a.sdf", text, strlen(text), options);
    CHECK(fathom_cache_searches(cache) == searches); /* all was found again */
    CHECK(fathom_scene_lipschitz(fathom_result_scene(first)) ==
          fathom_scene_lipschitz(fathom_result_scene(second)));
    fathom_cache_free(cache); /* the options keep what it holds */

    int asked = 0;
    CHECK(fathom_options_cancel(options, NULL, NULL) == FATHOM_BAD_ARGUMENT);
    CHECK(fathom_options_cancel(options, yes, &asked) == FATHOM_OK);
    fathom_result *third = fathom_compile_text_with("a.sdf", text, strlen(text), options);
    CHECK(asked > 0 && !fathom_result_scene(third));
    CHECK(fathom_result_count(third) == 1);
    CHECK(strcmp(fathom_result_code(third, 0), "cancelled") == 0);
    fathom_options_free(options);
    fathom_result_free(first);
    fathom_result_free(second);
    fathom_result_free(third);
}

static void params_and_facts(void) {
    fathom_result *result = compiled("param r = 1 in 0.5..2 \"Radius\"\nsphere(r)\n");
    const fathom_scene *scene = fathom_result_scene(result);
    CHECK(fathom_scene_param_count(scene) == 1);
    CHECK(strcmp(fathom_scene_param_name(scene, 0), "r") == 0);
    CHECK(fathom_scene_param_type(scene, 0) == 2 && fathom_scene_param_components(scene, 0) == 1);
    CHECK(!fathom_scene_param_structural(scene, 0));
    double lo[4], hi[4];
    fathom_scene_param_range(scene, 0, lo, hi);
    CHECK(lo[0] == 0.5 && hi[0] == 2);
    CHECK(fathom_scene_lipschitz(scene) == 1 && fathom_scene_proof(scene) == 0);
    CHECK(fathom_scene_exact(scene) == 1);
    CHECK(fathom_scene_axiom_count(scene) > 0 && fathom_scene_axiom(scene, 0)[0] != 0);
    CHECK(strcmp(fathom_scene_axiom(scene, 1000), "") == 0);

    const double larger = 1.5, huge = 3;
    fathom_result *other = fathom_scene_with(scene, "r", &larger, 1);
    fathom_field *field = fathom_field_make(fathom_result_scene(other), 0);
    fathom_result_free(other); /* a field outlives its scene */
    const float point[3] = {2, 0, 0};
    float distance = 0, gradient[3] = {0};
    CHECK(fathom_field_gradients(field, point, 1, &distance, gradient) == FATHOM_OK);
    CHECK(fabsf(distance - 0.5f) < 1e-5f && fabsf(gradient[0] - 1) < 1e-5f);
    fathom_field_free(field);

    other = fathom_scene_with(scene, "r", &huge, 1);
    CHECK(!fathom_result_scene(other) && strcmp(fathom_result_code(other, 0), "usage") == 0);
    fathom_result_free(other);
    fathom_result_free(result);
}

static void fields(void) {
    fathom_result *result = compiled("box(2)\n");
    fathom_field *field = fathom_field_make(fathom_result_scene(result), 0);
    const float box[6] = {-0.5f, -0.5f, -0.5f, 0.5f, 0.5f, 0.5f};
    float interval[2];
    CHECK(fathom_field_intervals(field, box, 1, interval) == FATHOM_OK);
    CHECK(interval[0] <= -1 && interval[1] >= -0.5f);
    const size_t counts[3] = {4, 3, 2}, one[3] = {1, 3, 2};
    const float lo[3] = {0, 0, 0}, hi[3] = {3, 2, 1};
    float *values = malloc(24 * sizeof *values); /* not one more */
    CHECK(fathom_field_volume(field, lo, hi, counts, values) == FATHOM_OK);
    CHECK(values[0] == -1 && values[3] == 2 && values[4] == 0 && values[12 + 1] == 0);
    CHECK(fathom_field_volume(field, lo, hi, one, values) == FATHOM_BAD_ARGUMENT);
    CHECK(fathom_field_volume(field, hi, lo, counts, values) == FATHOM_BAD_ARGUMENT);
    CHECK(fathom_field_distances(field, NULL, 1, values) == FATHOM_BAD_ARGUMENT);
    free(values);
    fathom_field_free(field);
    fathom_result_free(result);
}

static int give_up(double done, void *own) {
    (void)done;
    ++*(int *)own;
    return 0;
}

static void pictures_and_meshes(void) {
    fathom_result *result = compiled("sphere(1)\n");
    const fathom_scene *scene = fathom_result_scene(result);
    unsigned char *rgba = malloc(4 * 32 * 24);
    int calls = 0;
    CHECK(fathom_scene_draw(scene, 32, 24, 1, 0, rgba) == FATHOM_OK);
    CHECK(rgba[4 * (12 * 32 + 16) + 3] == 255);
    CHECK(fathom_scene_draw_with(scene, 32, 24, 1, 0, give_up, &calls, rgba) == FATHOM_CANCELLED);
    CHECK(calls > 0);
    CHECK(fathom_scene_draw(scene, 0, 24, 1, 0, rgba) == FATHOM_BAD_ARGUMENT);
    free(rgba);

    fathom_mesh *mesh = fathom_scene_mesh(scene, 0, 16, 0, NULL, NULL);
    CHECK(fathom_mesh_status(mesh) == 0 && fathom_mesh_triangle_count(mesh) > 100);
    const uint32_t *triangles = fathom_mesh_triangles(mesh);
    const float *vertices = fathom_mesh_vertices(mesh);
    for (size_t i = 0; i < 3 * fathom_mesh_triangle_count(mesh); ++i) {
        CHECK(triangles[i] < fathom_mesh_vertex_count(mesh));
        const float *v = vertices + 3 * triangles[i];
        CHECK(fabsf(sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) - 1) < 0.05f);
    }
    fathom_text *stl = fathom_mesh_file(mesh, ".stl");
    CHECK(fathom_text_length(stl) == 84 + 50 * fathom_mesh_triangle_count(mesh));
    CHECK(!fathom_mesh_file(mesh, ".doc"));
    fathom_text_free(stl);
    fathom_mesh_free(mesh);
    mesh = fathom_scene_mesh(scene, 0, 64, 0, give_up, &calls);
    CHECK(fathom_mesh_status(mesh) == 1 && fathom_mesh_vertex_count(mesh) == 0);
    fathom_mesh_free(mesh);
    fathom_result_free(result);
}

static void texts(void) {
    fathom_result *result = compiled("param r = 1 in 0.5..2\nsphere(r)\n");
    const fathom_scene *scene = fathom_result_scene(result);
    fathom_text *shader = fathom_scene_shader(scene, "es300");
    CHECK(strstr(fathom_text_bytes(shader), "uniform float param_r;"));
    fathom_text *json = fathom_scene_reflection(scene, "es300");
    CHECK(strstr(fathom_text_bytes(json), "\"param\": \"r\"") &&
          strstr(fathom_text_bytes(json), "\"range\": [[0.5], [2]]"));
    CHECK(!fathom_scene_shader(scene, "glsl1"));
    fathom_text *yaml = fathom_scene_yaml(scene);
    CHECK(fathom_text_length(yaml) == strlen(fathom_text_bytes(yaml)));
    fathom_text_free(yaml);
    fathom_text_free(json);
    fathom_text_free(shader);
    fathom_result_free(result);
}

static void nothing(void) {
    CHECK(fathom_result_count(NULL) == 0 && !fathom_result_scene(NULL));
    CHECK(!fathom_field_make(NULL, 0) && !fathom_scene_mesh(NULL, 0, 8, 0, NULL, NULL));
    CHECK(fathom_scene_draw(NULL, 1, 1, 1, 0, NULL) == FATHOM_BAD_ARGUMENT);
    CHECK(fathom_mesh_triangle_count(NULL) == 0 && !fathom_mesh_vertices(NULL));
    CHECK(!fathom_compile_text(NULL, "", 0) && !fathom_text_make(NULL, 3));
    fathom_result_free(NULL);
    fathom_field_free(NULL);
    fathom_mesh_free(NULL);
    fathom_text_free(NULL);
    fathom_options_free(NULL);
    fathom_cache_free(NULL);
    CHECK(fathom_cache_bytes(NULL) == 0);
    CHECK(fathom_c_version() == FATHOM_C_VERSION && fathom_version()[0] != 0);
}

int main(void) {
    diagnostics();
    options();
    cache_cancellation_and_phases();
    params_and_facts();
    fields();
    pictures_and_meshes();
    texts();
    nothing();
    return failures != 0;
}
