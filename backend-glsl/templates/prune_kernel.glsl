$# A compute pass: the rows that can matter in each cell; BLENDED where they join by a smooth
$# minimum, else by the least value (prune.h).

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer fathom_Parents { uvec2 fathom_parents[]; };
layout(std430, binding = 1) readonly buffer fathom_Before { uint fathom_before[]; };
layout(std430, binding = 2) writeonly buffer fathom_Cells { uvec2 fathom_cells[]; };
layout(std430, binding = 3) writeonly buffer fathom_Rows { uint fathom_rows[]; };
layout(std430, binding = 4) buffer fathom_Total { uint fathom_total; };
uniform vec3 fathom_grid_lo, fathom_grid_size;
uniform int fathom_grid; // which of the scene's
uniform int fathom_grid_side, fathom_parent_side; // cells along an axis; 0: no parents, all rows
uniform uint fathom_room; // entries of fathom_rows

void main() {
    int side = fathom_grid_side;
    int cell = int(gl_GlobalInvocationID.x);
    if (cell >= side * side * side) return;
    ivec3 c = ivec3(cell % side, cell / side % side, cell / (side * side));
    vec3 size = fathom_grid_size / float(side);
    vec3 center = fathom_grid_lo + (vec3(c) + 0.5) * size;
    float extent = length(max(abs(fathom_grid_lo), abs(fathom_grid_lo + fathom_grid_size)));
    float reach = 0.501 * length(size) + 1e-6 * extent;
    uvec2 from = uvec2(0u, uint($ROWS));
    if (fathom_parent_side > 0) {
        ivec3 b = c * fathom_parent_side / side;
        from = fathom_parents[((fathom_grid * fathom_parent_side + b.z) * fathom_parent_side + b.y) *
                                  fathom_parent_side + b.x];
    }
    float margin = $SLOPE * reach + 1e-5 * extent;
    uint count = 0u;
$if BLENDED

    margin += max($BLEND_RADIUS(center), 0.0);
    uint begin = from.x, at = 0u, end = 0u;
    for (int turn = 0; turn < 2; ++turn) {
        float acc = $START(center);
        uint last = begin;
        for (uint k = begin; k < from.y; ++k) {
            uint row = fathom_before[k];
            float v = $VALUE(center, int(row));
            float apart = margin + 1e-5 * (abs(acc) + abs(v));
            if (v - acc >= apart) continue;
            if (turn == 0 && acc - v >= apart) {
                count = 0u;
                last = k;
            }
            acc = $JOINED(acc, center, int(row));
            if (turn == 0) {
                ++count;
                continue;
            }
            if (at < end) fathom_rows[at] = row;
            ++at;
        }
        if (turn == 1) break;
        begin = last;
        at = atomicAdd(fathom_total, count);
        end = at + count;
        fathom_cells[fathom_grid * side * side * side + cell] = uvec2(at, end);
        if (end < at || end > fathom_room) return;
    }
}
$else

    float least = $START(center);
    for (uint k = from.x; k < from.y; ++k) least = min(least, $VALUE(center, int(fathom_before[k])));
    float limit = least + margin + 1e-5 * abs(least);
    for (uint k = from.x; k < from.y; ++k) count += $VALUE(center, int(fathom_before[k])) > limit ? 0u : 1u;
    uint at = atomicAdd(fathom_total, count);
    fathom_cells[fathom_grid * side * side * side + cell] = uvec2(at, at + count);
    if (at + count < at || at + count > fathom_room) return;
    for (uint k = from.x; k < from.y; ++k) {
        uint row = fathom_before[k];
        if ($VALUE(center, int(row)) > limit) continue;
        fathom_rows[at] = row;
        ++at;
    }
}
$end
