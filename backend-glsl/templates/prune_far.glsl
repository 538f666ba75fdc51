$# The look-up of cells that hold no surface (prune.h). Needs prune_rows.

// How far the cells' centres are from all surfaces; 0 in a cell that holds some, or might.
layout(std430, binding = 2) readonly buffer fathom_Far { float fathom_far_cells[]; };

// How far back and ahead of p all is more than `margin` away from surfaces, by one ball that p is in.
vec2 fathom_clear(vec3 p, vec3 direction, float margin) {
    vec3 size = fathom_grid_size / float(fathom_grid_side);
    vec3 place = fathom_place(p);
    vec3 away = vec3(0.0);
    float radius;
    if (fathom_inside(place)) {
        ivec3 c = ivec3(place);
        away = p - (fathom_grid_lo + (vec3(c) + 0.5) * size);
        radius = fathom_far_cells[(c.z * fathom_grid_side + c.y) * fathom_grid_side + c.x];
    } else {
        radius = $OUTSIDE;
    }
    radius -= margin;
    float inside = radius * radius - dot(away, away);
    if (!(radius > 0.0 && inside > 0.0)) return vec2(0.0);
    float along = dot(away, direction);
    float half_chord = sqrt(along * along + inside);
    vec2 both = vec2(half_chord + along, half_chord - along);
    return both.y > $MIN_WAY * length(size) ? both : vec2(0.0);
}
