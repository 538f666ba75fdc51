$# The look-up of the rows that matter in a cell (prune.h).

// Which rows of a long loop can matter in which cell (docs/performance.md).
layout(std430, binding = 0) readonly buffer fathom_Cells { uvec2 fathom_cells[]; };
layout(std430, binding = 1) readonly buffer fathom_Rows { uint fathom_rows[]; };
uniform vec3 fathom_grid_lo, fathom_grid_size;
uniform int fathom_grid_side; // 0: no lists

vec3 fathom_place(vec3 p) {
    return (p - fathom_grid_lo) * (float(fathom_grid_side) / fathom_grid_size);
}

bool fathom_inside(vec3 place) {
    return all(greaterThanEqual(place, vec3(0.0))) && all(lessThan(place, vec3(float(fathom_grid_side))));
}

// How far p is from all that has an end.
float fathom_off(vec3 p) {
    return length(max(max($LO - p, p - $HI), 0.0));
}

uvec2 fathom_list(vec3 p, int grid, uint rows) {
    vec3 place = fathom_place(p);
    if (!fathom_inside(place)) return uvec2(0u, rows);
    ivec3 c = ivec3(place);
    return fathom_cells[((grid * fathom_grid_side + c.z) * fathom_grid_side + c.y) * fathom_grid_side + c.x];
}
