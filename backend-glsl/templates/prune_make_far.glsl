$# A compute pass: how far each cell's centre is from all surfaces (prune.h).

layout(local_size_x = 64) in;
layout(std430, binding = 2) writeonly buffer fathom_Far { float fathom_far_cells[]; };

void main() {
    int side = fathom_grid_side;
    int cell = int(gl_GlobalInvocationID.x);
    if (cell >= side * side * side) return;
    vec3 size = fathom_grid_size / float(side);
    vec3 center = fathom_grid_lo + (vec3(cell % side, cell / side % side, cell / (side * side)) + 0.5) * size;
    float extent = length(max(abs(fathom_grid_lo), abs(fathom_grid_lo + fathom_grid_size)));
    float d = $SDF(center);
    d -= 1e-5 * (extent + abs(d));
    fathom_far_cells[cell] = d > $FAR_FROM * length(size) ? d : 0.0;
}
