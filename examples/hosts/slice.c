/* A slice through a scene, as characters, by the C library: slice SCENE.sdf [PARAM VALUE]... */
#include <fathom/c.h>

#include <stdio.h>
#include <stdlib.h>

enum { COLUMNS = 64, ROWS = 32 };

static int say(const fathom_result *result) {
    for (size_t i = 0; i < fathom_result_count(result); ++i)
        fprintf(stderr, "%s:%d: %s\n", fathom_result_file(result, i), fathom_result_line(result, i),
                fathom_result_message(result, i));
    return fathom_result_scene(result) ? 0 : 1;
}

/* The scene's box in x and y, a little larger, or a box of ours where it has no end. */
static void frame(const fathom_scene *scene, float lo[3], float hi[3]) {
    if (!fathom_scene_bounds(scene, lo, hi))
        for (int i = 0; i < 3; ++i) lo[i] = -2, hi[i] = 2;
    for (int i = 0; i < 3; ++i) {
        const float more = 0.05f * (hi[i] - lo[i]);
        lo[i] -= more, hi[i] += more;
    }
}

int main(int count, char **arguments) {
    if (count < 2 || count % 2 != 0) {
        fprintf(stderr, "usage: slice SCENE.sdf [PARAM VALUE]...\n");
        return 2;
    }
    fathom_result *result = fathom_compile_file(arguments[1]);
    if (say(result)) return 1;
    for (int i = 2; i < count; i += 2) {
        const double value = atof(arguments[i + 1]);
        fathom_result *other =
            fathom_scene_with(fathom_result_scene(result), arguments[i], &value, 1);
        fathom_result_free(result);
        result = other;
        if (say(result)) return 1;
    }
    const fathom_scene *scene = fathom_result_scene(result);
    float lo[3], hi[3];
    frame(scene, lo, hi);
    static float points[ROWS * COLUMNS][3], distances[ROWS * COLUMNS];
    for (int i = 0; i < ROWS * COLUMNS; ++i) {
        points[i][0] = lo[0] + (hi[0] - lo[0]) * ((float)(i % COLUMNS) + 0.5f) / COLUMNS;
        points[i][1] = hi[1] - (hi[1] - lo[1]) * ((float)(i / COLUMNS) + 0.5f) / ROWS;
        points[i][2] = 0.5f * (lo[2] + hi[2]);
    }
    fathom_field *field = fathom_field_make(scene, 0);
    const int status = fathom_field_distances(field, points[0], ROWS * COLUMNS, distances);
    for (int i = 0; status == FATHOM_OK && i < ROWS * COLUMNS; ++i) {
        putchar(distances[i] < 0 ? '#' : distances[i] < 0.1f * (hi[0] - lo[0]) ? '.' : ' ');
        if (i % COLUMNS == COLUMNS - 1) putchar('\n');
    }
    printf("bound %g, %s\n", fathom_scene_lipschitz(scene),
           fathom_scene_exact(scene) ? "exact" : "a lower bound");
    fathom_field_free(field);
    fathom_result_free(result);
    return status;
}
