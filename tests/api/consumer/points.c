/* The same in C. */
#include <fathom/c.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { COUNT = 1000000 };

int main(int count, char **arguments) {
    fathom_result *result = count == 2 ? fathom_compile_file(arguments[1]) : NULL;
    for (size_t i = 0; i < fathom_result_count(result); ++i)
        puts(fathom_result_message(result, i));
    fathom_field *field = fathom_field_make(fathom_result_scene(result), 0);
    float *points = calloc(3 * COUNT, sizeof *points), *distances = calloc(COUNT, sizeof *distances);
    if (!field || !points || !distances) return 1;
    for (size_t i = 0; i < COUNT; ++i) points[3 * i] = (float)i * 1e-6f;
    const int status = fathom_field_distances(field, points, COUNT, distances);
    const int right = status == FATHOM_OK && fabsf(distances[COUNT - 1]) < 1e-5f;
    printf("%g %g\n", distances[0], distances[COUNT - 1]);
    fathom_field_free(field);
    fathom_result_free(result);
    free(points);
    free(distances);
    return right ? 0 : 1;
}
